//! How deep the stack grew: what lies below it is painted at the start, and what is still painted at the end was not reached.
#![allow(unsafe_code)]

use core::ptr;

/// The paint.
const PAINT: u32 = 0xc5c5_c5c5;

/// How much is painted at most, in words: far more than any program here reaches.
const MOST: usize = 8 << 10;

/// Words left alone below this function's own, which `paint` and what it calls may use.
const OWN: usize = 64;

unsafe extern "C" {
    /// Where static memory ends.
    #[cfg_attr(target_arch = "arm", link_name = "__sheap")]
    #[cfg_attr(target_arch = "riscv32", link_name = "__estack")]
    static STATICS_END: u32;
    /// Where the stack begins, at its upper end.
    #[link_name = "_stack_start"]
    static STACK_START: u32;
}

/// What was painted.
#[derive(Debug)]
pub(crate) struct Painted {
    low: *const u32,
    words: usize,
}

/// Paints what lies between static memory and the stack.
#[inline(never)]
pub(crate) fn paint() -> Painted {
    let mut here = 0_u32;
    let top = ptr::addr_of_mut!(here).wrapping_sub(OWN);
    let bottom = ptr::addr_of!(STATICS_END);
    let words = ((top as usize).saturating_sub(bottom as usize) / 4).min(MOST);
    let low = top.wrapping_sub(words);
    for word in 0..words {
        // SAFETY: it lies between static memory and the words that this function's frame may use, where nothing is.
        unsafe { low.wrapping_add(word).write_volatile(PAINT) }
    }
    Painted { low, words }
}

impl Painted {
    /// Bytes from the stack's beginning to the lowest word that lost its paint.
    pub(crate) fn used(&self) -> usize {
        // SAFETY: what was painted is memory.
        let is_painted = |word: &usize| unsafe { self.low.wrapping_add(*word).read_volatile() } == PAINT;
        let untouched = (0..self.words).take_while(is_painted).count();
        (ptr::addr_of!(STACK_START) as usize).saturating_sub(self.low.wrapping_add(untouched) as usize)
    }
}
