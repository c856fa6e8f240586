//! What must hold of the kernel, and of the harness's readers, whatever they are given.
//!
//! A target is a plain function of bytes that panics where a claim is broken. libFuzzer drives it (`tests/fuzz/run`), and so do
//! the tests of the kernel (`tests/fuzz_replay.rs`), with the committed corpus, past failures and random bytes.
//!
//! `input` turns bytes into what a target is about; any bytes are a valid input, and where they end, zeros follow. `claims`
//! holds what is asserted of every call.

#[path = "../../common/mod.rs"]
mod common;
#[path = "../../bspline/reference.rs"]
mod reference;
#[allow(dead_code)] // A suite of its own uses more of it.
#[path = "../../views/rooms.rs"]
mod rooms;

#[cfg(feature = "capi")]
#[allow(dead_code, unreachable_pub, unsafe_code, clippy::type_complexity)] // Likewise, and of addresses.
#[path = "../../capi/lent.rs"]
mod lent;
#[cfg(feature = "capi")]
#[allow(unreachable_pub, unsafe_code, clippy::type_complexity)] // Likewise.
#[path = "../../capi/lent_lines.rs"]
mod lent_lines;

mod bytes;
mod claims;
mod input;
mod lane;
mod ready;
mod scribble;
mod shapes;
mod truth;

mod budgets;
#[cfg(feature = "capi")]
mod capi;
mod coherence;
mod honest;
mod methods;
mod preparation;
mod readers;
mod splines;
mod tables;
mod views;

/// What a target checks of some bytes.
pub type Check = fn(&[u8]);

/// All targets, by the names of their programs and folders.
pub const TARGETS: &[(&str, Check)] = &[
    ("methods", methods::check),
    ("honest", honest::check),
    ("coherence", coherence::check),
    ("views", views::check),
    ("budgets", budgets::check),
    ("tables", tables::check),
    ("preparation", preparation::check),
    ("splines", splines::check),
    ("readers", readers::check),
    #[cfg(feature = "capi")]
    ("capi", capi::check),
];

/// Runs a target by its name.
///
/// # Panics
/// There is no such target, or a claim is broken.
pub fn check(target: &str, bytes: &[u8]) {
    let (_, check) = TARGETS.iter().find(|(name, _)| *name == target).expect("one of `TARGETS`");
    check(bytes);
}
