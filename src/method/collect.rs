//! All hits of a ray, in a list that the caller lends.

use crate::limits::{GaveUp, Limit, Limits, Work};
use crate::local::Exactness;
use crate::parameter::Parameter;
use crate::planes::{DepthRange, Planes};
use crate::point::Point;
use crate::ray::{Hit, Incidence, Interval, Ray};
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
    /// Takes out a hit for which another one stands. (By u and v, too: a surface that crosses itself is met twice at one t.)
    pub(super) fn forget(&mut self, hit: &Hit<S>) {
        self.hits.retain(|other| other != hit);
    }

    /// Adds a root of a surface, if it lies in the ray's interval and was not found before; counts it in `points`. Of a root that
    /// cannot be told from one that was found the nearer stays.
    ///
    /// A full list keeps the closest ones.
    pub(super) fn add<P: Point<Scalar = S>>(
        &mut self,
        root: Root<P::Parameter>,
        surface: &Surface<'_, P>,
        planes: &Planes<S>,
        limits: &Limits<S>,
        points: &mut u32,
    ) {
        let Some(t) = planes.t_in_interval(root.depth) else {
            return;
        };
        let exact = Exactness::of(surface, planes, limits);
        // What is allowed across the ray is more along it, most where the ray all but grazes.
        let near = planes.time(exact.allowed() / exact.graze());
        let known = |hit: &Hit<S>| {
            let together = (hit.t - t).abs() <= near || (crosses_not(hit.incidence) && crosses_not(root.incidence));
            let at = [hit.u, hit.v].map(P::Parameter::new);
            hit.surface == surface.number && together && surface.same_root(at, [root.u, root.v], exact.tolerance)
        };
        let hit = root.hit(surface.number, t);
        if let Some(old) = self.hits.iter().find(|hit| known(hit)) {
            if old.t <= t {
                return;
            }
            let old = *old;
            self.forget(&old);
        } else {
            *points += 1;
        }
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

/// Whether the ray is tangent, or goes along the surface: two such roots may be one that rounding has parted.
fn crosses_not(incidence: Incidence) -> bool {
    incidence != Incidence::Crossing
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
    ) -> Result<Option<Root<P::Parameter>>, Limit>,
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
