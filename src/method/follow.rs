//! Coherence memory that predicts: where on a surface the next ray of a scan line will meet it.
//!
//! (u, v) of the last ray are extrapolated by their derivatives in the image's x and y, which the last Newton step computed
//! all but; by second derivatives, which follow from how the first ones change from ray to ray; and, as far as a ray goes
//! the way of the last one, by the third derivative that makes values and derivatives at both of its ends agree. In a row of
//! the image that is the cubic through the last two rays (Hermite); jittered rays stray from it to all sides.
//!
//! Source for the second derivatives: M. J. D. Powell's symmetric form of Broyden's update, "A new algorithm for unconstrained
//! optimization", 1970: of all symmetric matrices that explain the last change it is the one nearest to the old.

use crate::limits::Work;
use crate::local::{Exactness, Local};
use crate::parameter::Parameter;
use crate::planes::Planes;
use crate::root::Root;
use crate::scalar::Scalar;
use crate::view::Facing;

/// What the previous ray of a scan line left on one surface: a slot of memory that the caller lends, one per surface and
/// thread. Pairs are of u and v, or of x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Followed<S> {
    /// (x, y) of the ray.
    place: [S; 2],
    /// (u, v) of its point.
    at: [S; 2],
    /// Their derivatives in x and in y.
    slopes: [[S; 2]; 2],
    /// Half their second derivatives in xx, those in xy, and half those in yy.
    bends: [[S; 2]; 3],
    /// What the last way added to them more than the mean of the derivatives at its ends says.
    excess: [S; 2],
    /// The way from the ray before to this one, over the square of its length; 0 if there was none.
    way: [S; 2],
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
    pub const EMPTY: Self = Followed {
        place: [S::ZERO; 2],
        at: [S::ZERO; 2],
        slopes: [[S::ZERO; 2]; 2],
        bends: [[S::ZERO; 2]; 3],
        excess: [S::ZERO; 2],
        way: [S::ZERO; 2],
        stamp: 0,
    };

    /// Where the ray at (x, y) of scan line `stamp` is predicted to meet the surface; `None` without memory of that line.
    #[inline(always)]
    pub(super) fn predict(&self, place: [S; 2], stamp: u32) -> Option<[S; 2]> {
        if self.stamp != stamp || stamp == 0 {
            return None;
        }
        let (x, y) = (place[0] - self.place[0], place[1] - self.place[1]);
        let along = x * self.way[0] + y * self.way[1];
        let third = along * along * (S::from_u32(3) + along + along);
        let ([by_x, by_y], [xx, xy, yy]) = (&self.slopes, &self.bends);
        let parameter = |k: usize| {
            let smooth = x * (by_x[k] + x * xx[k] + y * xy[k]) + y * (by_y[k] + y * yy[k]);
            self.at[k] + smooth - third * self.excess[k]
        };
        Some([parameter(0), parameter(1)])
    }

    /// Keeps a root that a ray found, near which `local` holds.
    #[inline(always)]
    pub(super) fn keep<A: Parameter<Scalar = S>>(
        &mut self,
        root: &Root<A>,
        local: &Local<A>,
        ray: &Facing<S>,
        stamp: u32,
    ) {
        let rates = local.rates(ray.planes.reach(), root.depth + ray.ahead, ray.turning);
        self.go_on(root.at(), rates, ray.place, stamp);
    }

    /// Goes on to the point (u, v) of the ray at (x, y); `rates` are its derivatives in x and in y, if they are known.
    #[inline(always)]
    fn go_on(&mut self, at: [S; 2], rates: Option<[[S; 2]; 2]>, place: [S; 2], stamp: u32) {
        let (x, y) = (place[0] - self.place[0], place[1] - self.place[1]);
        let square = x * x + y * y;
        let goes_on = self.stamp == stamp && self.slopes != [[S::ZERO; 2]; 2] && square > S::ZERO;
        if let (true, Some([by_x, by_y])) = (goes_on, &rates) {
            let inverse = S::ONE / square;
            let (over_x, over_y) = (x * inverse, y * inverse);
            for k in 0..2 {
                let ([old_x, old_y], [xx, xy, yy]) = (&self.slopes, &mut self.bends);
                let excess = at[k] - self.at[k] - ((old_x[k] + by_x[k]) * x + (old_y[k] + by_y[k]) * y) * S::HALF;
                // What the derivatives changed by, less what the second ones made expect.
                let change_x = by_x[k] - old_x[k] - ((xx[k] + xx[k]) * x + xy[k] * y);
                let change_y = by_y[k] - old_y[k] - (xy[k] * x + (yy[k] + yy[k]) * y);
                let share = (change_x * over_x + change_y * over_y) * S::HALF;
                xx[k] += (change_x - share * x) * over_x;
                yy[k] += (change_y - share * y) * over_y;
                xy[k] += change_x * over_y + (change_y - (share + share) * y) * over_x;
                self.excess[k] = excess;
            }
            (self.place, self.at, self.slopes, self.way) = (place, at, [*by_x, *by_y], [over_x, over_y]);
        } else {
            let slopes = rates.unwrap_or([[S::ZERO; 2]; 2]);
            *self = Followed { place, at, slopes, stamp, ..Self::EMPTY };
        }
    }
}

/// The closest root so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best<A: Parameter> {
    pub(super) root: Root<A>,
    pub(super) surface: u32,
    /// Whether it is kept for the next ray already.
    pub(super) kept: bool,
}

impl<S: Scalar, A: Parameter<Scalar = S>> Best<A> {
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

/// The root that memory led to, while the testing ray judges it.
///
/// Where surfaces coincide, or meet at an edge, rounding alone would say which of their roots is closer, and it depends on the
/// start: which surface is named must not depend on what the memory held. So a root that another surface's meets in depth is
/// not judged, and the ray is searched in full, by starts that are the same for all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Claim<S> {
    surface: u32,
    depth: S,
    /// How far apart in depth roots may be said to be that are one: each is off by the tolerance.
    tie: S,
}

impl<S: Scalar> Claim<S> {
    /// Of a root that memory led to on a surface.
    #[inline(always)]
    pub(super) fn of<A: Parameter<Scalar = S>>(root: &Root<A>, surface: u32, exact: &Exactness<S>) -> Self {
        Claim { surface, depth: root.depth, tie: exact.allowed() * S::from_u32(4) }
    }

    /// How far to look for what may be closer than the best root so far, or contest this one.
    #[inline(always)]
    pub(super) fn up_to<A: Parameter<Scalar = S>>(&self, best: Option<&Best<A>>) -> S {
        best.map_or(self.depth, |best| best.root.depth) + self.tie
    }

    /// Whether a root that was found on a surface contests it: another one's, at its depth.
    #[inline(always)]
    pub(super) fn is_contested_by<A: Parameter<Scalar = S>>(&self, root: &Root<A>, surface: u32) -> bool {
        surface != self.surface && (root.depth - self.depth).abs() <= self.tie
    }
}

#[cfg(test)]
mod tests;
