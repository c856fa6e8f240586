//! RISC-V: it counts its instructions itself.
#![allow(unsafe_code)]

use core::arch::asm;

// What starts the program.
use riscv_rt as _;

/// Nothing beside the processor's own counter.
#[derive(Debug)]
pub(super) struct Own;

/// The lower half of the counter: a ray takes less than what that holds.
pub type Reading = u32;

impl Own {
    pub(super) fn new() -> Self {
        Own
    }

    #[inline(always)]
    pub(super) fn read(&self) -> Reading {
        let count: u32;
        // SAFETY: it reads a counter.
        unsafe { asm!("csrr {0}, minstret", out(reg) count, options(nostack)) }
        count
    }

    pub(super) fn instructions(&self, begin: Reading, end: Reading) -> u64 {
        u64::from(end.wrapping_sub(begin))
    }
}

pub(super) fn say(text: &str) {
    super::semihosting::write(text);
}

/// An operation of the emulator.
pub(super) fn call(operation: usize, argument: usize) {
    // SAFETY: the emulator reads the block that `argument` points to, and writes the result's register. It knows the call by
    // these three instructions, uncompressed and within one page.
    unsafe {
        asm!(
            ".option push",
            ".option norvc",
            ".balign 16",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inout("a0") operation => _,
            in("a1") argument,
            options(nostack),
        );
    }
}
