//! Scratch in words that the caller lends: of two sizes, for surfaces up to degrees 3 x 3 and for all.

use super::lend::Room;
use super::status::{Code, PATCHRAY_SCRATCH};
use crate::clipper::ClipRoom;
use crate::method::{ClipScratch, Scratch, ScratchView};
use crate::point::{Point, Weighted};
use crate::subdivide::{SubdivideScratch, SubdivideScratchView};

/// Scratch in words of 8 bytes, for Newton's methods on surfaces up to degrees 3 x 3; as all here for both kinds of control
/// points.
pub const PATCHRAY_NEWTON_CUBIC_WORDS_F32: usize = 39;
/// The same, for any degrees.
pub const PATCHRAY_NEWTON_WORDS_F32: usize = 435;
/// Scratch for the clipping methods, up to degrees 3 x 3.
pub const PATCHRAY_CLIP_CUBIC_WORDS_F32: usize = 408;
/// The same, for any degrees.
pub const PATCHRAY_CLIP_WORDS_F32: usize = 1164;
/// Scratch for patches, up to degrees 3 x 3.
pub const PATCHRAY_SUBDIVIDE_CUBIC_WORDS_F32: usize = 205;
/// The same, for any degrees.
pub const PATCHRAY_SUBDIVIDE_WORDS_F32: usize = 685;
/// Newton's methods in double precision, up to degrees 3 x 3.
pub const PATCHRAY_NEWTON_CUBIC_WORDS_F64: usize = 75;
/// The same, for any degrees.
pub const PATCHRAY_NEWTON_WORDS_F64: usize = 867;
/// The clipping methods in double precision, up to degrees 3 x 3.
pub const PATCHRAY_CLIP_CUBIC_WORDS_F64: usize = 810;
/// The same, for any degrees.
pub const PATCHRAY_CLIP_WORDS_F64: usize = 2322;
/// Patches in double precision, up to degrees 3 x 3.
pub const PATCHRAY_SUBDIVIDE_CUBIC_WORDS_F64: usize = 237;
/// The same, for any degrees.
pub const PATCHRAY_SUBDIVIDE_WORDS_F64: usize = 1197;

/// Domains that wait to be clipped: more than numbers of 53 bits can be halved apart.
const PENDING: usize = 64;

/// Makes scratch in lent words: the largest kind that fits, and its view.
macro_rules! largest_of {
    ($words:expr, $($kind:ty),+) => {{
        const { assert!($(align_of::<$kind>() <= align_of::<u64>())&&+) }
        let (first, bytes): (*mut u64, usize) = $words.raw();
        $(if size_of::<$kind>() <= bytes {
            let place = first.cast::<$kind>();
            // SAFETY: the caller's; the place is aligned and large enough.
            let scratch = unsafe {
                place.write(<$kind>::new());
                &mut *place
            };
            return Ok(scratch.view());
        })+
        Err(PATCHRAY_SCRATCH)
    }};
}

/// # Safety
/// Nothing else reads or writes the words before the call ends.
#[inline(always)]
pub(super) unsafe fn newton<'c, P: Point>(words: Room<u64>) -> Result<ScratchView<'c, P>, Code> {
    largest_of!(words, Scratch<P, 16, 256>, Scratch<P, 4, 16>)
}

/// # Safety
/// As for [`newton`].
#[inline(always)]
pub(super) unsafe fn clip<'c, P: Point>(words: Room<u64>) -> Result<ClipRoom<'c, P>, Code> {
    largest_of!(words, ClipScratch<P, 16, 256, PENDING>, ClipScratch<P, 4, 16, PENDING>)
}

/// # Safety
/// As for [`newton`].
#[inline(always)]
pub(super) unsafe fn subdivide<'c, P: Point>(words: Room<u64>) -> Result<SubdivideScratchView<'c, P>, Code> {
    largest_of!(words, SubdivideScratch<P, 256>, SubdivideScratch<P, 16>)
}

/// That as many words as stated are enough; on 64 bits, where counts are largest, no more than needed.
macro_rules! enough {
    ($($words:ident $kind:ty;)*) => {
        const _: () = {
            $(assert!(size_of::<$kind>() <= 8 * $words);)*
            $(assert!(size_of::<usize>() < 8 || size_of::<$kind>() + 8 > 8 * $words);)*
        };
    };
}
enough! {
    PATCHRAY_NEWTON_CUBIC_WORDS_F32 Scratch<Weighted<f32>, 4, 16>;
    PATCHRAY_NEWTON_WORDS_F32 Scratch<Weighted<f32>, 16, 256>;
    PATCHRAY_CLIP_CUBIC_WORDS_F32 ClipScratch<Weighted<f32>, 4, 16, PENDING>;
    PATCHRAY_CLIP_WORDS_F32 ClipScratch<Weighted<f32>, 16, 256, PENDING>;
    PATCHRAY_SUBDIVIDE_CUBIC_WORDS_F32 SubdivideScratch<Weighted<f32>, 16>;
    PATCHRAY_SUBDIVIDE_WORDS_F32 SubdivideScratch<Weighted<f32>, 256>;
    PATCHRAY_NEWTON_CUBIC_WORDS_F64 Scratch<Weighted<f64>, 4, 16>;
    PATCHRAY_NEWTON_WORDS_F64 Scratch<Weighted<f64>, 16, 256>;
    PATCHRAY_CLIP_CUBIC_WORDS_F64 ClipScratch<Weighted<f64>, 4, 16, PENDING>;
    PATCHRAY_CLIP_WORDS_F64 ClipScratch<Weighted<f64>, 16, 256, PENDING>;
    PATCHRAY_SUBDIVIDE_CUBIC_WORDS_F64 SubdivideScratch<Weighted<f64>, 16>;
    PATCHRAY_SUBDIVIDE_WORDS_F64 SubdivideScratch<Weighted<f64>, 256>;
}
