//! All hits of a ray, in a list that the caller lends.

use crate::limits::{GaveUp, Limit, Limits, Work};
use crate::planes::{DepthRange, Planes};
use crate::point::Point;
use crate::ray::{Hit, Interval, Ray};
use crate::root::Root;
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::surface::Surface;
use heapless::vec::VecView;

/// Hits in order of t, each once.
pub(super) struct Collected<'h, S> {
    hits: &'h mut VecView<Hit<S>>,
    /// Whether there were more than the list holds.
    overflowed: bool,
}

impl<S: Scalar> Collected<'_, S> {
    /// Adds a root of a surface, if it lies in the ray's interval and was not found before; counts it in `points`.
    ///
    /// A full list keeps the closest ones.
    pub(super) fn add<P: Point<Scalar = S>>(
        &mut self,
        root: Root<S>,
        surface: &Surface<'_, P>,
        planes: &Planes<S>,
        tolerance: S,
        points: &mut u32,
    ) {
        let Some(t) = planes.t_in_interval(root.depth) else {
            return;
        };
        let known = |hit: &Hit<S>| {
            hit.surface == surface.number && surface.same_root([hit.u, hit.v], [root.u, root.v], tolerance)
        };
        if self.hits.iter().any(known) {
            return;
        }
        *points += 1;
        let hit = root.hit(surface.number, t);
        let mut next = hit;
        // Ends with the list: from the hit's place on, each one moves on by one.
        for slot in self.hits.iter_mut() {
            if precedes(&next, slot) {
                core::mem::swap(slot, &mut next);
            }
        }
        self.overflowed |= self.hits.push(next).is_err();
    }
}

/// By t; of equal ones by surface and parameters, so that the order does not depend on that of the search.
fn precedes<S: Scalar>(a: &Hit<S>, b: &Hit<S>) -> bool {
    (a.t, a.surface, a.u, a.v) < (b.t, b.surface, b.u, b.v)
}

/// Fills `hits` with all hits over all surfaces; `search` adds those of one surface.
#[inline(always)]
pub(super) fn all_hits<P: Point>(
    scene: &Scene<'_, P>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    hits: &mut VecView<Hit<P::Scalar>>,
    work: &mut Work,
    mut search: impl FnMut(
        &Surface<'_, P>,
        &Planes<P::Scalar>,
        DepthRange<P::Scalar>,
        &mut Collected<'_, P::Scalar>,
        &mut Work,
    ) -> Result<(), Limit>,
) -> Result<(), GaveUp<P::Scalar>> {
    hits.clear();
    let mut all = Collected { hits, overflowed: false };
    let ended = scene.visit(ray, interval, limits, work, |surface, planes, range, work| {
        search(surface, planes, range, &mut all, work)?;
        Ok(P::Scalar::INFINITY)
    });
    match ended {
        Ok(()) if !all.overflowed => Ok(()),
        Ok(()) => Err(GaveUp { limit: Limit::Hits, best: all.hits.first().copied() }),
        Err(limit) => Err(GaveUp { limit, best: all.hits.first().copied() }),
    }
}

/// Whatever hit is found first; `search` looks for one on one surface.
#[inline(always)]
pub(super) fn any_hit<P: Point>(
    scene: &Scene<'_, P>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    work: &mut Work,
    mut search: impl FnMut(
        &Surface<'_, P>,
        &Planes<P::Scalar>,
        DepthRange<P::Scalar>,
        &mut Work,
    ) -> Result<Option<Root<P::Scalar>>, Limit>,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    let mut any = None;
    let ended = scene.visit(ray, interval, limits, work, |surface, planes, range, work| {
        any = search(surface, planes, range, work)?.map(|root| root.hit(surface.number, planes.t(root.depth)));
        Ok(if any.is_some() { P::Scalar::LEAST } else { P::Scalar::INFINITY })
    });
    match ended {
        // What runs out after the hit was found, while surfaces of its voxel are passed over, changes nothing.
        Err(limit) if any.is_none() => Err(GaveUp { limit, best: None }),
        _ => Ok(any),
    }
}
