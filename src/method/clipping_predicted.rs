//! The improved subdivision method made to pay on today's machines: for the rays of a view.
//!
//! As in [`clipping_coherent`](super::clipping_coherent), the region around the previous ray's (u, v) is dealt with first, and a
//! testing ray verifies the root found there. Departures from the paper, for speed where no other reason is said:
//! - the region is a narrow window around a predicted (u, v): the previous one moves on by the derivatives that Newton's
//!   last steps gave; a window that is not proved to hold one root at most, or holds none, is lost;
//! - the testing ray meets the patches of all surfaces, so that one verification answers the ray, and of each patch that
//!   it meets the domain is clipped, of the surface's own net: the paper weighs this too, and leaves it for the memory that
//!   patches of their own would take;
//! - a root that another surface's meets in depth is not judged, so that it does not depend on the memory which of surfaces
//!   that coincide is named;
//! - a search in full clips the domains of the patches that the ray meets, of all surfaces, front to back, and ends where no
//!   other can be closer.
//!
//! Clipping finds all roots in a domain, so the answer is as sure as that of [`clipping`](super::clipping), whatever the memory
//! held.
//!
//! Source: the paper's section "An Improvement of Bézier Clipping".

use super::follow::{Best, Claim, Followed, Following};
use crate::alone::Alone;
use crate::clipper::{ClipRoom, Clipper};
use crate::contract::Single;
use crate::limits::{Acceptance, GaveUp, Limit, Limits, Work};
use crate::line::Line;
use crate::local::Exactness;
use crate::parameter::Parameter;
use crate::patch::Patch;
use crate::planes::DepthRange;
use crate::point::Point;
use crate::ray::{Hit, Incidence};
use crate::region::Region;
use crate::scalar::Scalar;
use crate::span::InLine;
use crate::story::Event;
use crate::surface::Surface;
use crate::verify::{met_at_most_once, reaches};
use crate::view::{Facing, View, ViewRay};

/// Half the width of the window around the predicted (u, v). Wider finds more roots that were predicted badly; narrower is
/// proved more often to hold one root at most.
const WINDOW: f64 = 0.002;

/// The closest hit of a ray of a view: a hit, a miss, or out of a budget of `limits`.
///
/// `line` is the ray's. `memory` is lent, and to be left alone between rays of one scan line. `scan_line` numbers the line: a
/// number that no earlier line with this memory had begins with no coherence (at most 2³² − 2). `work` grows by what the call did.
#[inline]
pub fn closest_in_view<P: Point>(
    view: &View<'_, P>,
    line: &mut Line<'_, P::Scalar>,
    memory: &mut Following<'_, P::Scalar>,
    scan_line: u32,
    ray: &ViewRay<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    let last = core::mem::replace(&mut memory.last, u32::MAX);
    let before = work.spans_visited;
    match line.nearby(view.patches(), ray, limits, work) {
        Ok(Some(nearby)) => {
            let limits = &limits.beyond(work, before);
            closest_of_nearby(view, &nearby, memory, last, scan_line.wrapping_add(1), ray, limits, room, work)
        }
        Ok(None) => Ok(None),
        Err(limit) => Err(GaveUp { limit, best: None }),
    }
}

/// Of its own, so that a ray that can meet nothing costs no more than to see that.
#[inline(never)]
fn closest_of_nearby<P: Point>(
    view: &View<'_, P>,
    nearby: &InLine<'_, P::Scalar>,
    memory: &mut Following<'_, P::Scalar>,
    last: u32,
    stamp: u32,
    ray: &ViewRay<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    let ray = &view.facing(ray);
    let mut best = None;
    let ended = closest_so_far(view, nearby, memory, last, stamp, ray, limits, room, &mut best, work);
    let best = best.map(|Best { root, surface, .. }| root.hit(surface, ray.planes.t(root.depth)));
    match ended {
        Ok(()) => Ok(best),
        Err(limit) => Err(GaveUp { limit, best }),
    }
}

#[inline(always)]
fn closest_so_far<P: Point>(
    view: &View<'_, P>,
    nearby: &InLine<'_, P::Scalar>,
    memory: &mut Following<'_, P::Scalar>,
    last: u32,
    stamp: u32,
    ray: &Facing<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    best: &mut Option<Best<P::Parameter>>,
    work: &mut Work,
) -> Result<(), Limit> {
    let start = memory.slots.get(last as usize).and_then(|slot| slot.predict(ray.place, stamp));
    let again;
    let mut search =
        Search { view, ray, limits, nearby, room, projected: None, decided: None, claim: None, contested: false };
    let (mut resumed, mut led) = (false, false);
    let start = start.filter(|_| search.nearby.holds_surface(last));
    if let (Some(start), Some(slot)) = (start, memory.slots.get_mut(last as usize)) {
        P::Scalar::tell(|| Event::Remembered(start.map(P::Scalar::to_f64)));
        // What the memory led into must not cost the ray its answer: see `led`.
        led = true;
        resumed = search.resume(last, start, slot, stamp, best, work).unwrap_or(false);
        work.start_failed += u32::from(!resumed);
        if !resumed {
            P::Scalar::tell(|| Event::StartFailed);
        }
    }
    if !resumed {
        if led {
            again = limits.beyond(work, work.spans_visited);
            (search.limits, search.claim, search.decided) = (&again, None, None);
        }
        *best = None;
        search.in_full(best, work)?;
    }
    if let Some(best) = best {
        memory.last = best.surface;
        // A root that a patch led to.
        if !best.kept {
            let surface = view.surface(best.surface as usize).ok_or(Limit::Slot)?;
            let slot = memory.slots.get_mut(best.surface as usize).ok_or(Limit::Memory)?;
            match search.clipper(&surface)?.local([best.root.u, best.root.v], work) {
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
struct Search<'a, 's, 'm, P: Point> {
    view: &'a View<'m, P>,
    ray: &'a Facing<P::Scalar>,
    limits: &'a Limits<P::Scalar>,
    nearby: &'a InLine<'a, P::Scalar>,
    room: &'a mut ClipRoom<'s, P>,
    /// The surface whose projected net the room holds.
    projected: Option<u32>,
    /// The surface of which all was clipped that the ray may meet.
    decided: Option<u32>,
    /// The root that memory led to, while it is judged, and whether it is contested.
    claim: Option<Claim<P::Scalar>>,
    contested: bool,
}

impl<'s, 'm, P: Point> Search<'_, 's, 'm, P> {
    /// The root in the window around the predicted (u, v), verified or replaced by a closer one; whether so: if
    /// not, the ray has to be searched in full.
    fn resume(
        &mut self,
        surface: u32,
        start: [P::Scalar; 2],
        slot: &mut Followed<P::Scalar>,
        stamp: u32,
        best: &mut Option<Best<P::Parameter>>,
        work: &mut Work,
    ) -> Result<bool, Limit> {
        let (ray, limits, nearby) = (self.ray, self.limits, self.nearby);
        let ([u, v], half) = (start, P::Scalar::from_f64(WINDOW));
        let Some(window) = Region::WHOLE.meet(Region::between([[u - half, u + half], [v - half, v + half]]).sides)
        else {
            return Ok(false);
        };
        let Some(of_window) = self.view.surface(surface as usize) else {
            return Err(Limit::Slot);
        };
        let single = self.clipper(&of_window)?.single(window, work)?;
        let Single::Root(point, local) = single else {
            return Ok(false);
        };
        if ray.planes.t_in_interval(point.depth).is_none() {
            return Ok(false);
        }
        work.intersection_points += 1;
        // At once, and not when it is known to be the closest: the next ray's start waits for it.
        slot.keep(&point, &local, ray, stamp);
        *best = Some(Best { root: point, surface, kept: true });
        P::Scalar::tell(|| Event::Testing);
        let alone = Alone::new::<P::Flat>(&point, &local, of_window.shape.bend, ray.planes.reach());
        // Patches of the point's own sheet, where it is proved to be the only point, need no test.
        let exempt = |number: u32, patch: &Patch<P::Scalar>| number == surface && alone.within(patch.domain().bounds());
        let claim = Claim::of(&point, surface, &Exactness::of(&of_window, &ray.planes, limits));
        self.claim = Some(claim);
        let mut verified = true;
        let up_to = claim.up_to(best.as_ref());
        nearby.visit(&ray.planes, up_to, limits, work, exempt, |number, patch, crossing, work| {
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
            self.clip(number, patch, best, work)?;
            Ok(if self.contested { P::Scalar::LEAST } else { claim.up_to(best.as_ref()) })
        })?;
        if self.contested {
            (self.claim, self.decided) = (None, None);
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

    /// The closest root by clipping what the ray meets, front to back, that ends where nothing farther on can be closer.
    fn in_full(&mut self, best: &mut Option<Best<P::Parameter>>, work: &mut Work) -> Result<(), Limit> {
        let (ray, limits, nearby) = (self.ray, self.limits, self.nearby);
        work.full_searches += 1;
        P::Scalar::tell(|| Event::FullSearch);
        nearby.visit(
            &ray.planes,
            ray.range.max,
            limits,
            work,
            |_, _| false,
            |number, patch, crossing, work| {
                let range = DepthRange { min: ray.range.min, max: best.map_or(ray.range.max, |best| best.root.depth) };
                if crossing.overlaps(&range) {
                    self.clip(number, patch, best, work)?;
                }
                Ok(best.map_or(ray.range.max, |best| best.root.depth))
            },
        )
    }

    /// All roots in the domain of one patch; under [`Acceptance::Proved`], where these are not plain, those of the region that all
    /// patches span which the ray meets of the surface, as [`clipping`](super::clipping) finds them: a fold that the ray all
    /// but touches is taken for met or not by the tolerance for a region's net, and each patch along it would be
    /// another chance. Of one surface, so that the list is walked once more at most.
    fn clip(
        &mut self,
        number: u32,
        patch: &Patch<P::Scalar>,
        best: &mut Option<Best<P::Parameter>>,
        work: &mut Work,
    ) -> Result<(), Limit> {
        if self.decided == Some(number) {
            return Ok(());
        }
        let (before, bisections) = (*best, work.bisections);
        let grazing = self.clip_region(number, Region::between(patch.domain().bounds()), best, work)?;
        let plain = !grazing && work.bisections == bisections;
        if let Some(decided) = self.decided {
            // Found in another region than the root before, it may be that of a surface that coincides: the first is named.
            if let (Some(old), Some(new)) = (before, &*best)
                && old.surface == decided
                && old.surface < new.surface
                && Claim::of(&old.root, decided, &self.exact_on(decided)?).is_contested_by(&new.root, new.surface)
            {
                *best = before;
            }
            return Ok(());
        }
        if plain || self.limits.acceptance == Acceptance::Paper {
            return Ok(());
        }
        let (ray, limits, nearby) = (self.ray, self.limits, self.nearby);
        let mut region = Region::between(patch.domain().bounds());
        let others = |surface: u32, _: &Patch<P::Scalar>| surface != number;
        nearby.visit(&ray.planes, ray.range.max, limits, work, others, |_, patch, _, _| {
            region = region.joined(&Region::between(patch.domain().bounds()));
            Ok(ray.range.max)
        })?;
        self.decided = Some(number);
        *best = before;
        self.clip_region(number, region, best, work)?;
        Ok(())
    }

    /// All roots in a rectangle of a surface's domain; whether any of them is grazing.
    fn clip_region(
        &mut self,
        number: u32,
        region: Region<P::Parameter>,
        best: &mut Option<Best<P::Parameter>>,
        work: &mut Work,
    ) -> Result<bool, Limit> {
        let surface = self.view.surface(number as usize).ok_or(Limit::Slot)?;
        let (planes, claim) = (&self.ray.planes, self.claim);
        let (mut grazing, mut contested) = (false, false);
        self.clipper(&surface)?.roots_within(region, work, |root, work| {
            grazing |= root.incidence != Incidence::Crossing;
            contested |= claim.is_some_and(|claim| claim.is_contested_by(&root, number));
            Best::keep(best, Best { root, surface: number, kept: false }, planes, work);
        })?;
        self.contested |= contested;
        Ok(grazing)
    }

    /// How exactly the ray can meet a surface.
    fn exact_on(&self, number: u32) -> Result<Exactness<P::Scalar>, Limit> {
        let surface = self.view.surface(number as usize).ok_or(Limit::Slot)?;
        Ok(Exactness::of(&surface, &self.ray.planes, self.limits))
    }

    /// A clipper of a surface, its net projected.
    fn clipper<'c>(&'c mut self, surface: &'c Surface<'m, P>) -> Result<Clipper<'c, 's, 'm, P>, Limit> {
        let mut clipper = Clipper { surface, planes: &self.ray.planes, limits: self.limits, room: &mut *self.room };
        if self.projected != Some(surface.number) {
            clipper.project()?;
            self.projected = Some(surface.number);
        }
        Ok(clipper)
    }
}
