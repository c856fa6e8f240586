//! The improved numerical method made to pay on today's machines: for the rays of a view.
//!
//! As in [`newton_coherent`](super::newton_coherent), Newton's method starts from what the previous ray left, and a testing
//! ray verifies the point that it finds. Departures from the paper, for speed where no other reason is said:
//! - the start is predicted: the previous (u, v) moves on by the derivatives that the last Newton steps gave;
//! - only the surface that the previous ray hit is tried first, and the testing ray meets the patches of all surfaces, so
//!   that one verification answers the ray; it ends at the closest point so far;
//! - a root that another surface's meets in depth is not judged, so that it does not depend on the memory which of surfaces
//!   that coincide is named;
//! - a search in full goes front to back over the patches of all surfaces, and ends where no other can be closer.
//!
//! Source: the paper's section "Improvement of Barth and Stürzlinger's Algorithm".

use super::ScratchView;
use super::follow::{Best, Claim, Followed, Following};
use super::starts::{First, roots_of_patch};
use crate::alone::Alone;
use crate::fallback::Fallback;
use crate::limits::{GaveUp, Limit, Limits, Work};
use crate::line::Line;
use crate::newton::{Decided, Solver};
use crate::parameter::Parameter;
use crate::patch::Patch;
use crate::planes::DepthRange;
use crate::point::Point;
use crate::ray::Hit;
use crate::scalar::Scalar;
use crate::span::InLine;
use crate::story::Event;
use crate::verify::{met_at_most_once, reaches};
use crate::view::{Facing, View, ViewRay};

/// The closest hit of a ray of a view: a hit, a miss, or out of a budget of `limits`.
///
/// `line` is the ray's. `memory` is lent, and to be left alone between rays of one scan line. `scan_line` numbers the line: a
/// number that no earlier line with this memory had begins with no coherence (at most 2³² − 2). `work` grows by what the call did.
#[inline]
pub fn closest_in_view<P: Point, F: Fallback<P>>(
    view: &View<'_, P>,
    line: &mut Line<'_, P::Scalar>,
    memory: &mut Following<'_, P::Scalar>,
    scan_line: u32,
    ray: &ViewRay<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    let last = core::mem::replace(&mut memory.last, u32::MAX);
    let before = work.spans_visited;
    match line.nearby(view.patches(), ray, limits, work) {
        Ok(Some(nearby)) => {
            let limits = &limits.beyond(work, before);
            closest_of_nearby(view, &nearby, memory, last, scan_line.wrapping_add(1), ray, limits, scratch, work)
        }
        Ok(None) => Ok(None),
        Err(limit) => Err(GaveUp { limit, best: None }),
    }
}

/// Of its own, so that a ray that can meet nothing costs no more than to see that.
#[inline(never)]
fn closest_of_nearby<P: Point, F: Fallback<P>>(
    view: &View<'_, P>,
    nearby: &InLine<'_, P::Scalar>,
    memory: &mut Following<'_, P::Scalar>,
    last: u32,
    stamp: u32,
    ray: &ViewRay<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    let ray = &view.facing(ray);
    let mut best = None;
    let ended = closest_so_far(view, nearby, memory, last, stamp, ray, limits, scratch, &mut best, work);
    let best = best.map(|Best { root, surface, .. }| root.hit(surface, ray.planes.t(root.depth)));
    match ended {
        Ok(()) => Ok(best),
        Err(limit) => Err(GaveUp { limit, best }),
    }
}

#[inline(always)]
fn closest_so_far<P: Point, F: Fallback<P>>(
    view: &View<'_, P>,
    nearby: &InLine<'_, P::Scalar>,
    memory: &mut Following<'_, P::Scalar>,
    last: u32,
    stamp: u32,
    ray: &Facing<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    best: &mut Option<Best<P::Parameter>>,
    work: &mut Work,
) -> Result<(), Limit> {
    let planes = &ray.planes;
    let start = memory.slots.get(last as usize).and_then(|slot| slot.predict(ray.place, stamp));
    let start = start.filter(|_| nearby.holds_surface(last));
    let first = if start.is_some() { last } else { nearby.first_surface().ok_or(Limit::Slot)? };
    let Some(surface) = view.surface(first as usize) else {
        return Err(Limit::Slot);
    };
    let again;
    let solver = Solver::new(&surface, planes, limits, scratch.flat, &mut scratch.basis);
    let mut search = Search { view, ray, nearby, solver, fallback: &mut scratch.fallback };
    let (mut resumed, mut led) = (false, false);
    if let (Some(start), Some(slot)) = (start, memory.slots.get_mut(last as usize)) {
        P::Scalar::tell(|| Event::Remembered(start.map(P::Scalar::to_f64)));
        // What the memory led into must not cost the ray its answer: see `led`.
        led = true;
        resumed = search.resume(start, slot, stamp, best, work).unwrap_or(false);
        work.start_failed += u32::from(!resumed);
        if !resumed {
            P::Scalar::tell(|| Event::StartFailed);
        }
    }
    if !resumed {
        if led {
            again = limits.beyond(work, work.spans_visited);
            (search.solver.limits, search.solver.decided) = (&again, Decided::Nothing);
        }
        *best = None;
        search.in_full(best, work)?;
    }
    if let Some(best) = best {
        memory.last = best.surface;
        // A root that a patch led to.
        if !best.kept {
            search.solver.turn_to(&view.surface(best.surface as usize).ok_or(Limit::Slot)?);
            let slot = memory.slots.get_mut(best.surface as usize).ok_or(Limit::Memory)?;
            match search.solver.local([best.root.u, best.root.v], work) {
                Ok(local) => slot.keep(&best.root, &local, ray, stamp),
                // Nothing is left for the next ray, and this one is answered.
                Err(Limit::NewtonSteps) => {}
                Err(limit) => return Err(limit),
            }
        }
    }
    Ok(())
}

/// One ray.
struct Search<'a, 's, 'm, P: Point, F> {
    view: &'a View<'m, P>,
    ray: &'a Facing<P::Scalar>,
    nearby: &'a InLine<'a, P::Scalar>,
    solver: Solver<'a, 's, 'm, P>,
    fallback: &'a mut F,
}

impl<P: Point, F: Fallback<P>> Search<'_, '_, '_, P, F> {
    /// The point found from the predicted (u, v), verified or replaced by a closer one; whether so: if not,
    /// the ray has to be searched in full.
    fn resume(
        &mut self,
        start: [P::Scalar; 2],
        slot: &mut Followed<P::Scalar>,
        stamp: u32,
        best: &mut Option<Best<P::Parameter>>,
        work: &mut Work,
    ) -> Result<bool, Limit> {
        let Search { view, ray, nearby, solver, fallback } = self;
        let (planes, limits, surface) = (&ray.planes, solver.limits, solver.surface.number);
        let Some((point, local)) = solver.follow(start, work)? else {
            return Ok(false);
        };
        if planes.t_in_interval(point.depth).is_none() {
            return Ok(false);
        }
        work.intersection_points += 1;
        // At once, and not when it is known to be the closest: the next ray's start waits for it.
        slot.keep(&point, &local, ray, stamp);
        *best = Some(Best { root: point, surface, kept: true });
        P::Scalar::tell(|| Event::Testing);
        let alone = Alone::new::<P::Flat>(&point, &local, solver.surface.shape.bend, planes.reach());
        // Patches of the point's own sheet, where it is proved to be the only point, need no test.
        let exempt = |number: u32, patch: &Patch<P::Scalar>| number == surface && alone.within(patch.domain().bounds());
        let claim = Claim::of(&point, surface, &solver.exact);
        let (mut verified, mut contested) = (true, false);
        let up_to = claim.up_to(best.as_ref());
        nearby.visit(planes, up_to, limits, work, exempt, |number, patch, crossing, work| {
            let farthest = claim.up_to(best.as_ref());
            let owner = number == surface && patch.domain().holds(point.u.number(), point.v.number());
            let known = if owner {
                met_at_most_once(patch, crossing, limits)
            } else {
                !reaches(crossing, &DepthRange { min: ray.range.min, max: farthest })
            };
            P::Scalar::tell(|| Event::Listed { owner });
            if known {
                return Ok(farthest);
            }
            verified = false;
            solver.turn_to(&view.surface(number as usize).ok_or(Limit::Slot)?);
            roots_of_patch(solver, *fallback, patch, crossing, First::Entrance, work, |root, work| {
                contested |= claim.is_contested_by(&root, number);
                Best::keep(best, Best { root, surface: number, kept: false }, planes, work);
            })?;
            Ok(if contested { P::Scalar::LEAST } else { claim.up_to(best.as_ref()) })
        })?;
        if contested {
            solver.decided = Decided::Nothing;
            return Ok(false);
        }
        if verified {
            work.verified += 1;
            P::Scalar::tell(|| Event::Verified);
        } else {
            work.decided_by_list += 1;
            P::Scalar::tell(|| Event::DecidedByList);
        }
        Ok(true)
    }

    /// The closest point by a search along the ray, front to back, that ends where nothing farther on can be closer.
    fn in_full(&mut self, best: &mut Option<Best<P::Parameter>>, work: &mut Work) -> Result<(), Limit> {
        let Search { view, ray, nearby, solver, fallback } = self;
        let (planes, limits) = (&ray.planes, solver.limits);
        work.full_searches += 1;
        P::Scalar::tell(|| Event::FullSearch);
        nearby.visit(
            planes,
            ray.range.max,
            limits,
            work,
            |_, _| false,
            |number, patch, crossing, work| {
                let range = DepthRange { min: ray.range.min, max: best.map_or(ray.range.max, |best| best.root.depth) };
                if crossing.overlaps(&range) {
                    solver.turn_to(&view.surface(number as usize).ok_or(Limit::Slot)?);
                    roots_of_patch(solver, *fallback, patch, crossing, First::AsCritical, work, |root, work| {
                        Best::keep(best, Best { root, surface: number, kept: false }, planes, work);
                    })?;
                }
                Ok(best.map_or(ray.range.max, |best| best.root.depth))
            },
        )
    }
}
