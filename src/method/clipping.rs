//! The original subdivision method: Bézier clipping.
//!
//! Each surface that the ray may meet is projected and clipped, without patches and without a grid. All its roots are found and
//! count as intersection points, and the closest is the answer. Departures: a whole surface behind the closest hit so far is left
//! out, and so is one whose projected control points all lie to one side.
//!
//! Source: Nishita, Sederberg and Kakimoto (1990); the paper's section "Clipping Process of Bézier Clipping". See
//! [`crate::clipper`].

use super::{collect, keep_closest};
use crate::clipper::{ClipRoom, Clipper};
use crate::limits::{GaveUp, Limits, Work};
use crate::point::Point;
use crate::ray::{Hit, Interval, Ray};
use crate::reading::{Ours, Reading};
use crate::region::Order;
use crate::scene::Scene;
use heapless::vec::VecView;

/// The closest hit of `ray` in `interval`: a hit, a miss, or out of a budget of `limits`. `work` is set to what the call
/// did.
pub fn closest<P: Point>(
    scene: &Scene<'_, P>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    closest_by(Ours, scene, ray, interval, limits, room, work)
}

/// [`closest`] by another reading of the paper.
#[inline(always)]
pub fn closest_by<P: Point>(
    reading: impl Reading,
    scene: &Scene<'_, P>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    scene.closest(reading, ray, interval, limits, work, |surface, planes, _, work| {
        let mut best = None;
        let mut clipper = Clipper { surface, planes, limits, room };
        let mut roots = clipper.roots_by(reading, Order::Any)?;
        // Ends with the roots.
        while let Some(root) = roots.next(work)? {
            keep_closest(&mut best, root, planes, &mut work.intersection_points);
        }
        Ok(best)
    })
}

/// All hits of `ray` in `interval`, into `hits` (whose old content is dropped), in order of t. A point on an edge that
/// surfaces share is a hit of each.
///
/// More hits than the list holds are [`Limit::Hits`](crate::limits::Limit::Hits); it then holds the closest. Out of another
/// budget, it holds those found by then. `work` is set to what the call did.
pub fn all_hits<P: Point>(
    scene: &Scene<'_, P>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    hits: &mut VecView<Hit<P::Scalar>>,
    work: &mut Work,
) -> Result<(), GaveUp<P::Scalar>> {
    collect::all_hits(scene, ray, interval, limits, hits, work, |surface, planes, _, all, work| {
        let mut clipper = Clipper { surface, planes, limits, room };
        let mut roots = clipper.roots(Order::Any)?;
        // Ends with the roots.
        while let Some(root) = roots.next(work)? {
            if let Some(old) = roots.replaced() {
                all.forget(&old.hit(surface.number, planes.t(old.depth)));
            }
            all.add(root, surface, planes, limits, &mut work.intersection_points);
        }
        Ok(())
    })
}

/// A hit of `ray` in `interval`, the first that is found, not the closest: for shadows, and whether there is one at all.
/// `work` is set to what the call did.
pub fn any_hit<P: Point>(
    scene: &Scene<'_, P>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    collect::any_hit(scene, ray, interval, limits, work, |surface, planes, _, work| {
        let mut any = None;
        let mut clipper = Clipper { surface, planes, limits, room };
        let mut roots = clipper.roots(Order::Any)?;
        // Ends with the roots.
        while let Some(root) = roots.next(work)? {
            keep_closest(&mut any, root, planes, &mut work.intersection_points);
            if any.is_some() {
                break;
            }
        }
        Ok(any)
    })
}
