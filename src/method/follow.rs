//! Coherence memory that predicts: where on a surface the next ray of a scan line will meet it.
//!
//! (u, v) along the line are extrapolated by the cubic through the last two rays' values and derivatives (Hermite), for steps
//! of uneven length. The derivatives come from the last Newton steps, which computed all that they need.

use crate::limits::Work;
use crate::newton::{Local, Root};
use crate::planes::Planes;
use crate::scalar::Scalar;
use crate::view::Facing;

/// What the previous ray of a scan line left on one surface: a slot of memory that the caller lends, one per surface and
/// thread.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Followed<S> {
    /// (u, v) of its point.
    at: [S; 2],
    /// By how much they change per unit of x, per its square and per its cube.
    rates: [[S; 2]; 3],
    /// Where in the line the ray was.
    x: S,
    /// The scan line that it belongs to, plus one; 0 holds nothing. So nothing need be cleared between scan lines.
    stamp: u32,
}

/// Coherence memory of one thread.
#[derive(Debug)]
pub struct Following<'m, S> {
    /// A slot per surface. What they hold at first does not matter, but for speed.
    pub slots: &'m mut [Followed<S>],
    /// The surface that the previous ray hit.
    pub last: u32,
}

impl<S: Scalar> Followed<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self = Followed { at: [S::ZERO; 2], rates: [[S::ZERO; 2]; 3], x: S::ZERO, stamp: 0 };

    /// Where the ray at `x` of scan line `stamp` is predicted to meet the surface; `None` without memory of that line.
    #[inline(always)]
    pub(super) fn predict(&self, x: S, stamp: u32) -> Option<[S; 2]> {
        if self.stamp != stamp || stamp == 0 {
            return None;
        }
        let step = x - self.x;
        let [first, second, third] = &self.rates;
        Some(core::array::from_fn(|k| self.at[k] + step * (first[k] + step * (second[k] + step * third[k]))))
    }

    /// Keeps what a ray found.
    #[inline(always)]
    pub(super) fn keep(&mut self, &Best { root, rate, .. }: &Best<S>, ray: &Facing<S>, stamp: u32) {
        let x = ray.x;
        let at = [root.u, root.v];
        let mut rates = [rate, [S::ZERO; 2], [S::ZERO; 2]];
        let (step, old) = (x - self.x, self.rates[0]);
        if self.stamp == stamp && rate != [S::ZERO; 2] && old != [S::ZERO; 2] && step != S::ZERO {
            let inverse = S::ONE / step;
            for k in 0..2 {
                let mean = (at[k] - self.at[k]) * inverse;
                rates[1][k] = (old[k] + rate[k] + rate[k] - mean - mean - mean) * inverse;
                rates[2][k] = (old[k] + rate[k] - mean - mean) * (inverse * inverse);
            }
        }
        *self = Followed { at, rates, x, stamp };
    }
}

/// The closest root so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best<S> {
    pub(super) root: Root<S>,
    pub(super) surface: u32,
    /// How fast (u, v) moves along the line there, per unit of x; 0 if that is not known.
    pub(super) rate: [S; 2],
}

impl<S: Scalar> Best<S> {
    /// A root of a ray on a surface, near which `local` holds.
    #[inline(always)]
    pub(super) fn new(root: Root<S>, surface: u32, local: &Local<S>, ray: &Facing<S>) -> Self {
        let rate = local.rate(root.depth + ray.ahead, ray.turning).unwrap_or([S::ZERO; 2]);
        Best { root, surface, rate }
    }

    /// Counts a root as an intersection point if it lies in the ray's interval, and keeps it if it is closer; of equal ones that
    /// of the lower surface, so that the answer does not depend on the order of search.
    #[inline(always)]
    pub(super) fn keep(best: &mut Option<Self>, found: Self, planes: &Planes<S>, work: &mut Work) {
        let Best { root: Root { depth, .. }, surface, .. } = found;
        if planes.t_in_interval(depth).is_some() {
            work.intersection_points += 1;
            let closer = |old: &Self| depth < old.root.depth || (depth == old.root.depth && surface < old.surface);
            if best.as_ref().is_none_or(closer) {
                *best = Some(found);
            }
        }
    }
}
