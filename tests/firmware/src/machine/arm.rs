//! Cortex-M: instructions are counted by SysTick, whose ticks the emulator derives from them.
#![allow(unsafe_code)]

use core::arch::asm;
use core::ptr;

// What starts the program.
use cortex_m_rt as _;

/// Control, reload value and current value of SysTick, in the order of their addresses.
const SYSTICK: usize = 0xe000_e010;

/// SysTick counts down through this many bits.
const MASK: u32 = 0xff_ffff;

/// Rounds of a loop of two instructions, by which ticks are compared with instructions.
const ROUNDS: u32 = 500_000;

/// How many ticks so many instructions took.
#[derive(Debug)]
pub(super) struct Own {
    ticks: u64,
    instructions: u64,
}

/// A value of SysTick.
pub type Reading = u32;

fn write(register: usize, value: u32) {
    let address = ptr::with_exposed_provenance_mut::<u32>(SYSTICK + 4 * register);
    // SAFETY: the register is there on every Cortex-M, nothing else uses it, and its interrupt stays off.
    unsafe { address.write_volatile(value) }
}

impl Own {
    pub(super) fn new() -> Self {
        write(1, MASK);
        write(2, 0);
        // Enabled, from the processor's clock.
        write(0, 5);
        let mut own = Own { ticks: 1, instructions: 1 };
        let begin = own.read();
        // SAFETY: it touches nothing but its register and the flags. Ends: it counts down to 0.
        unsafe { asm!("1:", "subs {0}, #1", "bne 1b", inout(reg) ROUNDS => _, options(nomem, nostack)) }
        let ticks = own.instructions(begin, own.read());
        own.ticks = ticks;
        own.instructions = 2 * u64::from(ROUNDS);
        own
    }

    #[inline(always)]
    pub(super) fn read(&self) -> Reading {
        let address = ptr::with_exposed_provenance::<u32>(SYSTICK + 8);
        // SAFETY: as for writing; reading changes nothing.
        unsafe { address.read_volatile() }
    }

    pub(super) fn instructions(&self, begin: Reading, end: Reading) -> u64 {
        let ticks = u64::from(begin.wrapping_sub(end) & MASK);
        (ticks * self.instructions).checked_div(self.ticks).unwrap_or(0)
    }
}

pub(super) fn say(text: &str) {
    super::semihosting::write(text);
}

/// An operation of the emulator.
pub(super) fn call(operation: usize, argument: usize) {
    // SAFETY: the emulator reads the block that `argument` points to, and writes the result's register.
    unsafe {
        asm!("bkpt #0xab", inout("r0") operation => _, in("r1") argument, options(nostack, preserves_flags));
    }
}
