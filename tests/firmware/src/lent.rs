//! Static memory that is lent once.

#![allow(unsafe_code)]

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicBool, Ordering};

/// A value in static memory, to be lent once.
#[derive(Debug)]
pub struct Lent<T> {
    value: UnsafeCell<T>,
    lent: AtomicBool,
}

// SAFETY: the value is reached through `lend` alone, which gives it to one borrower. These programs have one thread and no
// interrupts, so that no other call comes between reading the mark and setting it.
unsafe impl<T: Send> Sync for Lent<T> {}

impl<T> Lent<T> {
    /// Not lent yet.
    pub const fn new(value: T) -> Self {
        Lent { value: UnsafeCell::new(value), lent: AtomicBool::new(false) }
    }

    /// The value, for good; `None` from the second call on.
    #[expect(clippy::mut_from_ref, reason = "the mark makes it the only one")]
    pub fn lend(&'static self) -> Option<&'static mut T> {
        if self.lent.load(Ordering::Relaxed) {
            return None;
        }
        self.lent.store(true, Ordering::Relaxed);
        // SAFETY: the mark says that this is the only borrow there will ever be.
        Some(unsafe { &mut *self.value.get() })
    }
}
