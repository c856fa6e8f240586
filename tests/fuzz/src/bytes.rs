//! Bytes taken from the front, one choice after another.

/// What is left of an input. Where it ends, zeros follow, so that every input is one.
#[derive(Clone, Debug)]
pub(crate) struct Bytes<'b> {
    rest: &'b [u8],
}

impl<'b> Bytes<'b> {
    pub(crate) fn new(rest: &'b [u8]) -> Self {
        Bytes { rest }
    }

    pub(crate) fn array<const N: usize>(&mut self) -> [u8; N] {
        let mut taken = [0; N];
        let count = N.min(self.rest.len());
        let (front, rest) = self.rest.split_at(count);
        taken[..count].copy_from_slice(front);
        self.rest = rest;
        taken
    }

    pub(crate) fn byte(&mut self) -> u8 {
        let [byte] = self.array();
        byte
    }

    /// A whole number from 0 to `count` − 1.
    pub(crate) fn below(&mut self, count: u8) -> usize {
        usize::from(self.byte() % count)
    }

    /// One of these.
    pub(crate) fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[usize::from(self.byte()) % all.len()]
    }

    /// True for one byte in `count`, and not for 0, so that an input that ends early is an ordinary one.
    pub(crate) fn rarely(&mut self, count: u8) -> bool {
        self.below(count) == usize::from(count - 1)
    }

    pub(crate) fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.array())
    }

    pub(crate) fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.array())
    }

    pub(crate) fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.array())
    }

    /// A count of any size: small ones, and any bits.
    pub(crate) fn count(&mut self) -> u32 {
        match self.below(4) {
            0 => u32::from(self.byte() % 8),
            1 => u32::from(self.byte()),
            2 => u32::from(self.u16()),
            _ => self.u32(),
        }
    }

    /// All that is left.
    pub(crate) fn rest(self) -> &'b [u8] {
        self.rest
    }
}
