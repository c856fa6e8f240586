//! Coherence memory of any bits: what a caller may lend.
#![allow(unsafe_code, reason = "slots are plain numbers whose fields the kernel keeps to itself")]

use crate::common::index;
use crate::rooms::Thread;
use patchray::method::Followed;
use patchray::point::Point;
use patchray::scalar::Scalar;
use patchray_host::scene::shapes::Random;

/// Scalars in a slot before its stamp.
const SCALARS: usize = 18;

/// Rubbish in all slots: numbers that may be, that may not, NaN, infinities, and stamps that are those of `scan_line` by chance.
pub(crate) fn fill<P: Point>(thread: &mut Thread<P>, scan_line: u32, random: &mut Random) {
    for slot in &mut thread.followed {
        let address: *mut Followed<P::Scalar> = slot;
        // SAFETY: `Followed` is `repr(C)`, of so many scalars and a stamp, for which any bits are valid.
        unsafe { write::<P::Scalar>(address.cast(), scan_line, random) };
    }
    thread.last = match index(random, 8) {
        0 => u32::MAX,
        1 => thread.followed.len() as u32,
        2 => bits(random) as u32,
        _ => index(random, thread.followed.len()) as u32,
    };
}

/// # Safety
/// `slot` points to so many scalars and a `u32`, which may be written.
unsafe fn write<S: Scalar>(slot: *mut S, scan_line: u32, random: &mut Random) {
    let likely = index(random, 3) > 0;
    for k in 0..SCALARS {
        let number = if likely && k < 4 { S::from_f64(random.within(0.0, 1.0)) } else { number(random) };
        // SAFETY: as above.
        unsafe { slot.add(k).write(number) };
    }
    let stamp = if index(random, 4) == 0 { bits(random) as u32 } else { scan_line.wrapping_add(1) };
    // SAFETY: as above.
    unsafe { slot.add(SCALARS).cast::<u32>().write(stamp) };
}

fn bits(random: &mut Random) -> u64 {
    let half = |random: &mut Random| random.within(0.0, 4_294_967_296.0) as u64;
    half(random) << 32 | half(random)
}

fn number<S: Scalar>(random: &mut Random) -> S {
    match index(random, 10) {
        0 => S::from_f64(f64::NAN),
        1 => S::INFINITY,
        2 => S::LEAST,
        3 => S::MAX,
        4 => S::ZERO,
        // Of any exponent that the type has.
        5 => S::from_f64(f64::from_bits(bits(random))),
        6 => S::ONE.times_power_of_two(index(random, 250) as i32 - 125),
        _ => S::from_f64(random.within(-1.5, 1.5)),
    }
}
