//! The parameter domain of a patch: a part of [0, 1]² by repeated halving.

use crate::scalar::Scalar;

/// How often a surface may be halved in each direction: domains are then exact in both number types, and fit 16 bits.
pub const MAX_LEVEL: u32 = 14;

/// A part of a surface's domain by repeated halving: `[i, i + 1] / 2^level` in each direction, held as `2^level + i`.
/// Half-open, but for the last one, so that each (u, v) lies in exactly one patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Domain {
    u: u16,
    /// The top bit marks a patch that is not flat: it was kept because the depth ran out.
    v: u16,
}

const ROUGH: u16 = 1 << 15;

impl Domain {
    /// The whole surface.
    pub const WHOLE: Self = Domain { u: 1, v: 1 };

    /// What a slot holds before it is filled: zeros, of which static memory takes no flash.
    pub(crate) const EMPTY: Self = Domain { u: 0, v: 0 };

    /// The domain that holds these numbers, of u and of v.
    pub(crate) const fn from_numbers([u, v]: [u16; 2]) -> Self {
        Domain { u, v }
    }

    /// What it holds, of u and of v.
    pub(crate) const fn numbers(self) -> [u16; 2] {
        [self.u, self.v]
    }

    /// How often it was halved in u and in v.
    pub fn levels(self) -> [u32; 2] {
        [self.u, self.v & !ROUGH].map(level)
    }

    /// The halves in u, or in v.
    pub(crate) fn halves(self, along_u: bool) -> [Self; 2] {
        let Domain { u, v } = self;
        [0, 1].map(|side| if along_u { Domain { u: u << 1 | side, v } } else { Domain { u, v: v << 1 | side } })
    }

    /// The same domain, marked as not flat.
    pub(crate) fn rough(self) -> Self {
        Domain { u: self.u, v: self.v | ROUGH }
    }

    /// Whether the patch is not flat: then every ray counts as critical there.
    #[inline(always)]
    pub fn is_rough(self) -> bool {
        self.v & ROUGH != 0
    }

    /// `[u0, u1]` and `[v0, v1]`, exact.
    #[inline(always)]
    pub fn bounds<S: Scalar>(self) -> [[S; 2]; 2] {
        let side = |index: u16| {
            let width = width::<S>(index);
            // Index i of 2^level, held as 2^level + i.
            let first = S::from_u32(u32::from(index)) * width - S::ONE;
            [first, first + width]
        };
        // Not by `map`, which a compiler may leave out of line.
        [side(self.u), side(self.v & !ROUGH)]
    }

    /// Whether it holds (u, v); exactly one domain of a subdivision does, for any (u, v) in [0, 1]².
    #[inline]
    pub fn holds<S: Scalar>(self, u: S, v: S) -> bool {
        // The finest interval that holds the parameter, then its ancestor at this domain's level.
        let cells = 1_u32 << MAX_LEVEL;
        let ancestor = |t: S, index: u16| {
            let cell = (t * S::from_u32(cells)).to_u32().min(cells - 1);
            (cells | cell) >> (MAX_LEVEL - level(index).min(MAX_LEVEL)) == u32::from(index)
        };
        ancestor(u, self.u) && ancestor(v, self.v & !ROUGH)
    }

    /// Whether it and another have a point in common, borders included.
    pub fn adjoins(self, other: Self) -> bool {
        // Both ends in steps of the finest level.
        let ends = |index: u16| {
            let (level, index) = (level(index).min(MAX_LEVEL), u32::from(index));
            let first = index.wrapping_sub(1 << level) << (MAX_LEVEL - level);
            [first, first.wrapping_add(1 << (MAX_LEVEL - level))]
        };
        let overlap = |a: u16, b: u16| {
            let (a, b) = (ends(a), ends(b));
            a[0] <= b[1] && b[0] <= a[1]
        };
        overlap(self.u, other.u) && overlap(self.v & !ROUGH, other.v & !ROUGH)
    }

    /// The parameters at (a, b) of the local coordinates, −1 to 1 across the domain.
    #[inline(always)]
    pub(crate) fn parameters<S: Scalar>(self, a: S, b: S) -> [S; 2] {
        let at = |local: S, index: u16| {
            let width = width::<S>(index);
            // Index i of 2^level at the middle of its interval: (i + 1/2) · width − 1, the leading bit's 1.
            (S::from_u32(u32::from(index)) + S::HALF * (local + S::ONE)) * width - S::ONE
        };
        [at(a, self.u), at(b, self.v & !ROUGH)]
    }
}

#[inline(always)]
fn level(index: u16) -> u32 {
    15_u32.saturating_sub(index.leading_zeros())
}

/// 2^−level.
#[inline(always)]
fn width<S: Scalar>(index: u16) -> S {
    const WIDTHS: [f32; 16] = {
        let mut widths = [1.0; 16];
        let mut level = 1;
        while level < 16 {
            widths[level] = widths[level - 1] * 0.5;
            level += 1;
        }
        widths
    };
    // The mask says to the compiler what is so in any case.
    S::from_f32(WIDTHS[level(index) as usize & 15])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_adjoin_across_levels_and_others_do_not() {
        let [low, high] = Domain::WHOLE.halves(true);
        let [first, second] = low.halves(true);
        assert!(low.adjoins(high) && second.adjoins(high) && !first.adjoins(high) && !high.adjoins(first));
        assert!(first.adjoins(first) && Domain::WHOLE.adjoins(first.rough()));
        // At a corner, of different levels in v too.
        let [near, far] = second.halves(false);
        assert!(near.adjoins(high.halves(false)[1]) && !near.adjoins(high.halves(false)[1].halves(false)[1]));
        assert!(far.rough().adjoins(high.halves(false)[0]));
        // Any bits, as in memory that nobody filled.
        let rubbish = Domain { u: 0, v: u16::MAX };
        let _ = rubbish.adjoins(high) | high.adjoins(rubbish);
    }
}
