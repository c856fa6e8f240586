//! What decides a patch of which Newton's method proves nothing. A program chooses it by a type, so that one without holds no
//! code of Bézier clipping.
//!
//! Under [`Acceptance::Proved`](crate::limits::Acceptance::Proved) a patch that the ray meets is proved to hold no root or one,
//! by Newton's method, or is handed over. Without a fallback nothing of a patch is proved but that it is met once at most.

use crate::clipper::{ClipRoom, Clipper};
use crate::limits::{Limit, Limits, Work};
use crate::planes::Planes;
use crate::point::Point;
use crate::reading::Ours;
use crate::region::{Order, Region};
use crate::root::Root;
use crate::surface::Surface;

/// What finds the roots of a patch that was handed over.
pub trait Fallback<P: Point> {
    /// Whether it finds all, or is none.
    const COMPLETE: bool;

    /// All points where the ray's line meets a region of the surface, to `found`.
    fn roots(
        &mut self,
        surface: &Surface<'_, P>,
        planes: &Planes<P::Scalar>,
        region: Region<P::Parameter>,
        limits: &Limits<P::Scalar>,
        work: &mut Work,
        found: impl FnMut(Root<P::Parameter>, &mut Work),
    ) -> Result<(), Limit>;
}

/// No fallback: a patch is judged by its starts, as in the paper.
#[derive(Clone, Copy, Debug)]
pub struct NoFallback;

impl<P: Point> Fallback<P> for NoFallback {
    const COMPLETE: bool = false;

    fn roots(
        &mut self,
        _: &Surface<'_, P>,
        _: &Planes<P::Scalar>,
        _: Region<P::Parameter>,
        _: &Limits<P::Scalar>,
        _: &mut Work,
        _: impl FnMut(Root<P::Parameter>, &mut Work),
    ) -> Result<(), Limit> {
        Ok(())
    }
}

/// Bézier clipping of the region, under the same limits.
impl<P: Point> Fallback<P> for ClipRoom<'_, P> {
    const COMPLETE: bool = true;

    fn roots(
        &mut self,
        surface: &Surface<'_, P>,
        planes: &Planes<P::Scalar>,
        region: Region<P::Parameter>,
        limits: &Limits<P::Scalar>,
        work: &mut Work,
        mut found: impl FnMut(Root<P::Parameter>, &mut Work),
    ) -> Result<(), Limit> {
        let mut clipper = Clipper { surface, planes, limits, room: self };
        clipper.project()?;
        let mut roots = clipper.search(Ours, Order::Any, Some(region))?;
        // Ends with the roots, whose search counts clips against a budget.
        while let Some(root) = roots.next(work)? {
            found(root, work);
        }
        Ok(())
    }
}
