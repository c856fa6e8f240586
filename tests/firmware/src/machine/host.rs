//! The host: it counts no instructions.

/// Nothing.
#[derive(Debug)]
pub(super) struct Own;

/// Always 0.
pub type Reading = u32;

impl Own {
    pub(super) fn new() -> Self {
        Own
    }

    pub(super) fn read(&self) -> Reading {
        0
    }

    pub(super) fn instructions(&self, begin: Reading, end: Reading) -> u64 {
        u64::from(end.wrapping_sub(begin))
    }
}

pub(super) fn say(text: &str) {
    eprint!("{text}");
}
