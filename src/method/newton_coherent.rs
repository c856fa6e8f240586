//! The improved numerical method: scan-line coherence, and a testing ray that verifies the closest hit.
//!
//! The first ray of a scan line that meets a surface searches the surface's grid; a departure: only up to the closest point. For the
//! next ray Newton's method starts at the previous (u, v); from the point it finds, a testing ray goes back toward the origin. If
//! the testing ray meets only the patch that holds the point, and meets it once by eq. (1), the point is the closest. Otherwise
//! Newton's method from the patches that it meets decides.
//!
//! Source: the paper's section "Improvement of Barth and Stürzlinger's Algorithm". Where its text leaves a choice:
//! - ours: a ray that misses a surface whose box it meets empties the surface's memory, so that the next one searches in full;
//! - ours: patches are decided in the order in which the testing ray meets them, and no list is kept;
//! - ours: from a listed patch Newton's method tries the entrance of the ray, then the parallelogram and the exit: the paper's
//!   entrance of the testing ray is none where that begins inside;
//! - ours: a point that no listed patch holds cannot be judged, and the surface is searched in full.

use super::starts::{First, roots_of_patch};
use super::{Remembered, ScratchView, keep_closest, led};
use crate::fallback::Fallback;
use crate::grid::Grids;
use crate::limits::{GaveUp, Limit, Limits, Work};
use crate::newton::Solver;
use crate::patch::Patches;
use crate::planes::DepthRange;
use crate::point::Point;
use crate::ray::{Hit, Interval, Ray};
use crate::reading::{Ours, Reading};
use crate::root::Root;
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::story::Event;
use crate::sweep::InGrid;
use crate::verify::{met_at_most_once, testing_ray};

/// The closest hit of `ray` in `interval`: a hit, a miss, or out of a budget of `limits`.
///
/// `patches` and `grids` have to come from this scene's surfaces. `memory` is lent, a slot per surface; between rays of one
/// scan line it is to be left alone. `scan_line` numbers the line: a number that no earlier line with this memory had
/// begins with no coherence (at most 2³² − 2). `work` is set to what the call did.
pub fn closest<P: Point, F: Fallback<P>>(
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    grids: &Grids<'_, P::Scalar>,
    memory: &mut [Remembered<P::Scalar>],
    scan_line: u32,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    closest_by(Ours, scene, patches, grids, memory, scan_line, ray, interval, limits, scratch, work)
}

/// [`closest`] by another reading of the paper.
#[inline(always)]
pub fn closest_by<P: Point, F: Fallback<P>>(
    reading: impl Reading,
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    grids: &Grids<'_, P::Scalar>,
    memory: &mut [Remembered<P::Scalar>],
    scan_line: u32,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    led(scan_line.wrapping_add(1), work, |stamp, recalled, work| {
        scene.closest(reading, ray, interval, limits, work, |surface, planes, range, work| {
            let number = surface.number as usize;
            let grid = grids.of_surface(number).ok_or(Limit::Slot)?;
            let patches = patches.of_surface(number).ok_or(Limit::Slot)?;
            let slot = memory.get_mut(number).ok_or(Limit::Memory)?;
            let solver = Solver::new(surface, planes, limits, scratch.flat, &mut scratch.basis);
            let along = InGrid { grid, patches };
            Search { reading, solver, fallback: &mut scratch.fallback, along, range }.run(slot, stamp, recalled, work)
        })
    })
}

/// One ray and one surface.
struct Search<'a, 's, 'm, P: Point, F, R> {
    reading: R,
    solver: Solver<'a, 's, 'm, P>,
    fallback: &'a mut F,
    along: InGrid<'a, P::Scalar>,
    range: DepthRange<P::Scalar>,
}

impl<P: Point, F: Fallback<P>, R: Reading> Search<'_, '_, '_, P, F, R> {
    /// The closest point in the ray's interval, and what to remember of it.
    #[inline(always)]
    fn run(
        mut self,
        slot: &mut Remembered<P::Scalar>,
        stamp: u32,
        recalled: &mut bool,
        work: &mut Work,
    ) -> Result<Option<Root<P::Parameter>>, Limit> {
        let previous = slot.recall(stamp).filter(|_| self.reading.coherence());
        *recalled |= previous.is_some();
        let found = match self.resume(previous, work)? {
            Some(root) => Some(root),
            None => self.in_full(work)?,
        };
        *slot = Remembered::of(found, stamp);
        // A point behind the closest hit so far, or behind the interval, verified, proves a miss before it. It is not held
        // against the surface's box: a root may lie off by Newton's tolerance, which is more than a thin box's padding.
        Ok(found.filter(|root| self.solver.planes.t_in_interval(root.depth).is_some()))
    }

    /// The point found from the previous one's (u, v), verified or replaced by a closer one; `None` if the surface has to
    /// be searched in full.
    fn resume(
        &mut self,
        previous: Option<[P::Scalar; 2]>,
        work: &mut Work,
    ) -> Result<Option<Root<P::Parameter>>, Limit> {
        let Some(start) = previous else {
            return Ok(None);
        };
        P::Scalar::tell(|| Event::Remembered(start.map(P::Scalar::to_f64)));
        // A point before the interval says nothing about what lies in it.
        let point = self.solver.solve(start, work)?.filter(|root| !self.solver.planes.is_before_interval(root.depth));
        let verified = match point {
            Some(point) if self.reading.verification() => self.verify(point, work)?,
            Some(point) => {
                work.intersection_points += u32::from(self.solver.planes.t_in_interval(point.depth).is_some());
                Some(point)
            }
            None => None,
        };
        work.start_failed += u32::from(verified.is_none());
        if verified.is_none() {
            P::Scalar::tell(|| Event::StartFailed);
        }
        Ok(verified)
    }

    /// The testing ray: the point itself if it is the closest, a closer one that it leads to, or `None` if it cannot tell.
    fn verify(&mut self, point: Root<P::Parameter>, work: &mut Work) -> Result<Option<Root<P::Parameter>>, Limit> {
        let Search { solver, fallback, along, range, .. } = self;
        let (planes, limits) = (solver.planes, solver.limits);
        let mut closest = Some(point);
        let (mut owners, mut alone) = (0_u32, true);
        work.intersection_points += u32::from(planes.t_in_interval(point.depth).is_some());
        testing_ray(along, planes, &point, range.min, limits, work, |listed, work| {
            if listed.owner {
                owners += 1;
                if met_at_most_once(listed.patch, listed.crossing, limits) {
                    return Ok(true);
                }
            }
            alone = false;
            let first = First::Entrance;
            roots_of_patch(solver, *fallback, listed.patch, listed.crossing, first, work, |root, work| {
                keep_closest(&mut closest, root, planes, &mut work.intersection_points);
            })?;
            Ok(true)
        })?;
        if owners == 0 {
            return Ok(None);
        }
        if alone {
            work.verified += 1;
            P::Scalar::tell(|| Event::Verified);
        } else {
            work.decided_by_list += 1;
            P::Scalar::tell(|| Event::DecidedByList);
        }
        Ok(closest)
    }

    /// The closest root by a search along the ray, front to back, that ends where nothing farther on can hold a closer one; by the
    /// paper's letter, with the surface.
    fn in_full(&mut self, work: &mut Work) -> Result<Option<Root<P::Parameter>>, Limit> {
        let (planes, limits) = (self.solver.planes, self.solver.limits);
        work.full_searches += 1;
        P::Scalar::tell(|| Event::FullSearch);
        let Search { reading, solver, fallback, along, range } = self;
        let mut best: Option<Root<P::Parameter>> = None;
        along.ahead(planes, range, limits, work, |patch, crossing, work| {
            if crossing.overlaps(range) {
                roots_of_patch(solver, *fallback, patch, crossing, First::AsCritical, work, |root, work| {
                    keep_closest(&mut best, root, planes, &mut work.intersection_points);
                })?;
            }
            // A root counts only once the walk has come to it: a patch not met yet may hold a closer one.
            Ok(best.filter(|_| reading.early_end()).map_or(P::Scalar::INFINITY, |root| root.depth))
        })?;
        Ok(best)
    }
}
