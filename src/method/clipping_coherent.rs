//! The improved subdivision method: Bézier clipping with scan-line coherence, and a testing ray that verifies the closest
//! hit.
//!
//! Along a scan line, a surface whose roots clips alone can part (the straight-forward case) is clipped as ever. Where
//! regions have to be bisected, the one that holds the previous ray's (u, v) is dealt with first, then those that adjoin it,
//! then the rest. From the first root found a testing ray goes back toward the origin; if it says that no patch can hide the
//! root, the rest is left alone, else all of it is clipped.
//!
//! Source: the paper's section "An Improvement of Bézier Clipping". Where its text leaves a choice:
//! - ours: a ray that misses a surface whose box it meets empties the surface's memory, so that the next one clips directly;
//! - ours: a root before the interval says nothing about what lies in it, and is not the first root;
//! - ours: a root is not verified when no region waits any more;
//! - ours: if no region that waits holds the previous (u, v), the nearest is first.

use super::{Remembered, keep_closest, led};
use crate::clipper::{ClipRoom, Clipper};
use crate::grid::Grids;
use crate::limits::{GaveUp, Limit, Limits, Work};
use crate::parameter::Parameter;
use crate::patch::Patches;
use crate::point::Point;
use crate::ray::{Hit, Interval, Ray};
use crate::reading::{Ours, Reading};
use crate::region::Order;
use crate::root::Root;
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::story::Event;
use crate::sweep::InGrid;
use crate::verify::{Verdict, verdict};

/// The closest hit of `ray` in `interval`: a hit, a miss, or out of a budget of `limits`.
///
/// `patches` and `grids` have to come from this scene's surfaces. `memory` is lent, a slot per surface; between rays of one
/// scan line it is to be left alone. `scan_line` numbers the line: a number that no earlier line with this memory had
/// begins with no coherence (at most 2³² − 2). `work` is set to what the call did.
pub fn closest<P: Point>(
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    grids: &Grids<'_, P::Scalar>,
    memory: &mut [Remembered<P::Scalar>],
    scan_line: u32,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    closest_by(Ours, scene, patches, grids, memory, scan_line, ray, interval, limits, room, work)
}

/// [`closest`] by another reading of the paper.
#[inline(always)]
pub fn closest_by<P: Point>(
    reading: impl Reading,
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    grids: &Grids<'_, P::Scalar>,
    memory: &mut [Remembered<P::Scalar>],
    scan_line: u32,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    room: &mut ClipRoom<'_, P>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    led(scan_line.wrapping_add(1), work, |stamp, recalled, work| {
        scene.closest(reading, ray, interval, limits, work, |surface, planes, range, work| {
            let number = surface.number as usize;
            let grid = grids.of_surface(number).ok_or(Limit::Slot)?;
            let patches = patches.of_surface(number).ok_or(Limit::Slot)?;
            let slot = memory.get_mut(number).ok_or(Limit::Memory)?;
            let clipper = Clipper { surface, planes, limits, room };
            search(reading, clipper, &InGrid { grid, patches }, range.min, slot, stamp, recalled, work)
        })
    })
}

/// The closest root on one surface in the ray's interval, and what to remember of it.
#[inline(always)]
fn search<P: Point>(
    reading: impl Reading,
    mut clipper: Clipper<'_, '_, '_, P>,
    along: &InGrid<'_, P::Scalar>,
    nearest: P::Scalar,
    slot: &mut Remembered<P::Scalar>,
    stamp: u32,
    recalled: &mut bool,
    work: &mut Work,
) -> Result<Option<Root<P::Parameter>>, Limit> {
    let previous = slot.recall(stamp).filter(|_| reading.coherence());
    *recalled |= previous.is_some();
    let (planes, limits) = (clipper.planes, clipper.limits);
    let mut best = None;
    // The closest root at all but those before the interval: what the next ray begins at.
    let mut closest: Option<Root<P::Parameter>> = None;
    let mut first = previous.is_some();
    if let Some(previous) = previous {
        P::Scalar::tell(|| Event::Remembered(previous.map(P::Scalar::to_f64)));
    }
    let mut roots = clipper.roots_by(reading, Order::around(previous.map(|at| at.map(P::Parameter::new))))?;
    // Ends with the roots.
    while let Some(root) = roots.next(work)? {
        if planes.is_before_interval(root.depth) {
            continue;
        }
        keep_closest(&mut best, root, planes, &mut work.intersection_points);
        if closest.is_none_or(|old| root.depth < old.depth) {
            closest = Some(root);
        }
        if !(first && roots.regions_wait()) {
            continue;
        }
        first = false;
        let verdict = if reading.verification() {
            verdict(reading, along, planes, &root, nearest, limits, work)?
        } else {
            Verdict::Closest
        };
        P::Scalar::tell(|| if verdict == Verdict::Closest { Event::Verified } else { Event::Refused });
        match verdict {
            Verdict::Closest => {
                work.verified += 1;
                break;
            }
            Verdict::Critical => work.refused_as_critical += 1,
            Verdict::Hidden { by_neighbour } => {
                work.refused_by_list += 1;
                work.refused_by_neighbour += u32::from(by_neighbour);
            }
        }
    }
    *slot = Remembered::of(closest, stamp);
    // A root behind the closest hit so far, verified, proves a miss before it.
    Ok(best)
}
