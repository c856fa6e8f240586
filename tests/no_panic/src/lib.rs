#![no_std]
//! The kernel's whole public face behind entry points that take everything from outside: raw memory, numbers, options.
//! The optimiser learns nothing about them, so a panic that stays in the linked code is one that some caller can reach,
//! be it with memory that the kernel never filled.
//!
//! Nothing here runs: `check` links the library and looks at what is left. Each entry point is named
//! `reach_WHAT_SCALAR_POINT`.

// The control is a program of its own, so that it is built in no time.
#[cfg(not(feature = "planted"))]
#[macro_use]
mod export;
#[cfg(not(feature = "planted"))]
mod entries;
#[cfg(not(feature = "planted"))]
mod errors;
#[cfg(not(feature = "planted"))]
mod proving;
#[cfg(not(feature = "planted"))]
mod views;

/// Called by nothing but the panic handler, and defined nowhere: where it is wanted, a panic is reachable.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn patchray_panic_is_reachable() -> !;
    }
    // SAFETY: no program with this call can be linked, so none runs it.
    unsafe { patchray_panic_is_reachable() }
}

/// Memory that a caller lends: any address, any length, any content.
#[derive(Debug)]
#[repr(C)]
pub struct Lent<T> {
    first: *mut T,
    count: usize,
}

impl<T> Lent<T> {
    /// The slots.
    ///
    /// # Safety
    /// `first` points to `count` slots that nothing else uses while the slice lives.
    pub(crate) unsafe fn slots<'m>(&self) -> &'m mut [T] {
        // SAFETY: as above.
        unsafe { core::slice::from_raw_parts_mut(self.first, self.count) }
    }
}

/// The control of `check`: an index that a caller chooses.
///
/// # Safety
/// See [`Lent::slots`].
#[cfg(feature = "planted")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn reach_planted_f32_plain(slots: &Lent<f32>, index: usize) -> f32 {
    // SAFETY: the caller keeps the contract of `slots`.
    let slots = unsafe { slots.slots() };
    slots[index]
}
