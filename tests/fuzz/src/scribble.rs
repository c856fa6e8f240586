//! Lent slots with any bits in them.
#![allow(unsafe_code, reason = "slots are plain numbers whose fields the kernel keeps to itself")]

use crate::bytes::Bytes;
use patchray::grid::GridSlot;
use patchray::method::{Followed, Remembered};
use patchray::patch::{Parallelepiped, Patch};
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray::scene::{SceneHeader, SurfaceSlot};
use patchray::span::Span;

/// A slot of plain numbers.
///
/// # Safety
/// Any bits are a valid value.
pub(crate) unsafe trait Slot: Copy {}

macro_rules! slots {
    ($($slot:ident)*) => {
        $(
            // SAFETY: it holds floating-point numbers and unsigned ones, or slots of these, and nothing else.
            unsafe impl<S: Scalar> Slot for $slot<S> {}
        )*
    };
}

slots! { GridSlot Span Followed Remembered Parallelepiped Patch Plain Weighted SceneHeader SurfaceSlot }

// SAFETY: any bits are a number.
unsafe impl Slot for u32 {}

/// Writes some bytes, numbers or rubbish throughout, as `bytes` say; 0 leaves the slots as they are.
pub(crate) fn scribble<T: Slot>(bytes: &mut Bytes<'_>, slots: &mut [T]) {
    let size = size_of_val(slots);
    if size == 0 {
        return;
    }
    let memory: *mut u8 = slots.as_mut_ptr().cast();
    let write = |at: usize, value: &[u8]| {
        for (k, &byte) in value.iter().enumerate().take_while(|(k, _)| at + k < size) {
            // SAFETY: it lies within the slots, which are lent for writing, and may hold any bits.
            unsafe { memory.add(at + k).write(byte) };
        }
    };
    match bytes.below(6) {
        0..5 => {
            for _ in 0..bytes.below(5) {
                // Numbers of four bytes, or of eight, begin there.
                let at = usize::from(bytes.u16()) * 4 % size;
                match bytes.below(6) {
                    0 => write(at, &[bytes.byte()]),
                    1 => write(at, &bytes.array::<4>()),
                    2 => write(at, &bytes.array::<8>()),
                    3 => write(at, &u32::from(bytes.byte()).to_le_bytes()),
                    4 => write(at, &(f32::from(bytes.byte() as i8) / 64.0).to_le_bytes()),
                    _ => write(at, &(f64::from(bytes.byte() as i8) / 64.0).to_le_bytes()),
                }
            }
        }
        _ => {
            // Any bits, or one small count in all places.
            let mut pattern = bytes.array::<16>();
            if pattern[15] & 1 == 0 {
                let [count, ..] = pattern;
                pattern = [u32::from(count % 4); 4].map(u32::to_le_bytes).concat().try_into().expect("four times four");
            }
            for at in (0..size).step_by(16) {
                write(at, &pattern);
            }
        }
    }
}
