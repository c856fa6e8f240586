//! The roots that one ray was found to have on one surface, each once.
//!
//! A root on the border between two regions is found in both; one at a collapsed edge, all of whose parameters name one
//! point, in every region that touches the edge.

use crate::bernstein::BasisView;
use crate::limits::{Limit, Limits};
use crate::local::Local;
use crate::planes::Planes;
use crate::point::Point;
use crate::root::Root;
use crate::scalar::Scalar;
use crate::surface::Surface;

/// The roots seen so far, and what it takes to compare them.
pub(crate) struct Seen<'a, 'm, P: Point> {
    pub(crate) surface: &'a Surface<'m, P>,
    pub(crate) planes: &'a Planes<P::Scalar>,
    /// The surface's projected net.
    pub(crate) whole: &'a [P::Flat],
    pub(crate) roots: &'a [Root<P::Scalar>],
    /// How far the surface may pass the ray and count as meeting it, by the measure of [`Local::distance`].
    pub(crate) allowed: P::Scalar,
}

impl<P: Point> Seen<'_, '_, P> {
    /// Whether this root is one of them.
    #[inline(always)]
    pub(crate) fn holds(
        &self,
        root: &Root<P::Scalar>,
        limits: &Limits<P::Scalar>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<bool, Limit> {
        if self.roots.is_empty() { Ok(false) } else { self.is_among(root, limits, basis) }
    }

    #[inline(never)]
    fn is_among(
        &self,
        root: &Root<P::Scalar>,
        limits: &Limits<P::Scalar>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<bool, Limit> {
        // A tolerance across the ray is more along it; but where the ray is all but tangent, to take two roots for one by
        // depth alone would lose the nearer of a pair.
        let near = limits.tolerance * P::Scalar::from_u32(64);
        for old in self.roots {
            // On a straight line that the ray follows all points are one root; those outside the interval must not stand for
            // the ones within.
            if self.planes.t_in_interval(old.depth).is_none() {
                continue;
            }
            let same = self.surface.same_root([old.u, old.v], [root.u, root.v], limits.tolerance);
            if same || ((old.depth - root.depth).abs() <= near && self.joins(old, root, basis)?) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the ray passes within what is allowed of the surface all the way from one root to another: at three places of
    /// uneven shares, so that roots that lie evenly are not taken for a way between two of them.
    fn joins(
        &self,
        a: &Root<P::Scalar>,
        b: &Root<P::Scalar>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<bool, Limit> {
        for share in [P::Scalar::from_f64(0.381), P::Scalar::HALF, P::Scalar::from_f64(0.803)] {
            let at = [a.u + (b.u - a.u) * share, a.v + (b.v - a.v) * share];
            let degrees = self.surface.net.degrees();
            if !(Local::at(at, degrees, self.whole, basis)?.distance() <= self.allowed) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
