//! The original numerical method: Barth and Stürzlinger's, with Newton's method in the two-dimensional system.
//!
//! The ray is traced through the binary tree of each surface that it may meet. Every patch whose parallelepiped it meets
//! gives Newton's method a start; all roots count as intersection points, and the closest is the answer. A departure: patches
//! and surfaces behind the closest hit on the surfaces before are left out.
//!
//! Source: Barth and Stürzlinger (1993); the paper's section "Barth and Stürzlinger's Algorithm".

use super::starts::{First, roots_of_patch};
use super::{ScratchView, collect, keep_closest};
use crate::fallback::Fallback;
use crate::limits::{GaveUp, Limit, Limits, Work};
use crate::newton::Solver;
use crate::patch::Patches;
use crate::planes::{DepthRange, Planes};
use crate::point::Point;
use crate::ray::{Hit, Interval, Ray};
use crate::reading::{Ours, Reading};
use crate::root::Root;
use crate::scene::Scene;
use crate::surface::Surface;
use crate::tree::Tree;
use heapless::vec::VecView;

/// The closest hit of `ray` in `interval`: a hit, a miss, or out of a budget of `limits`.
///
/// `patches` and `tree` have to come from this scene's surfaces. `work` is set to what the call did. A patch whose starts
/// all fail is taken for no hit, as in the paper, so a miss is not proved.
pub fn closest<P: Point, F: Fallback<P>>(
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    tree: &Tree<'_, P::Scalar>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    closest_by(Ours, scene, patches, tree, ray, interval, limits, scratch, work)
}

/// [`closest`] by another reading of the paper.
#[inline(always)]
pub fn closest_by<P: Point, F: Fallback<P>>(
    reading: impl Reading,
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    tree: &Tree<'_, P::Scalar>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    scene.closest(reading, ray, interval, limits, work, |surface, planes, range, work| {
        let mut best = None;
        roots(surface, patches, tree, planes, range, limits, scratch, work, |root, work| {
            keep_closest(&mut best, root, planes, &mut work.intersection_points);
            true
        })?;
        Ok(best)
    })
}

/// All hits of `ray` in `interval` that Newton's method finds, into `hits` (whose old content is dropped), in order of t. A
/// point on an edge that surfaces share is a hit of each.
///
/// Complete only as far as each patch is met once at most, and its starts lead to that root: of two roots on one patch it
/// finds one. [`clipping::all_hits`](super::clipping::all_hits) finds all. More hits than the list holds are
/// [`Limit::Hits`]; it then holds the closest. `work` is set to what the call did.
pub fn all_hits<P: Point, F: Fallback<P>>(
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    tree: &Tree<'_, P::Scalar>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    hits: &mut VecView<Hit<P::Scalar>>,
    work: &mut Work,
) -> Result<(), GaveUp<P::Scalar>> {
    collect::all_hits(scene, ray, interval, limits, hits, work, |surface, planes, range, all, work| {
        roots(surface, patches, tree, planes, range, limits, scratch, work, |root, work| {
            all.add(root, surface, planes, limits, &mut work.intersection_points);
            true
        })
    })
}

/// A hit of `ray` in `interval`, the first that is found, not the closest. A miss is not proved, as in [`closest`]. `work`
/// is set to what the call did.
pub fn any_hit<P: Point, F: Fallback<P>>(
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    tree: &Tree<'_, P::Scalar>,
    ray: &Ray<P::Scalar>,
    interval: &Interval<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
    collect::any_hit(scene, ray, interval, limits, work, |surface, planes, range, work| {
        let mut any = None;
        roots(surface, patches, tree, planes, range, limits, scratch, work, |root, work| {
            keep_closest(&mut any, root, planes, &mut work.intersection_points);
            any.is_none()
        })?;
        Ok(any)
    })
}

/// The roots from all patches of one surface along the ray, through its binary tree, to `found`, which says whether to go on.
#[inline(always)]
fn roots<P: Point, F: Fallback<P>>(
    surface: &Surface<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    tree: &Tree<'_, P::Scalar>,
    planes: &Planes<P::Scalar>,
    range: DepthRange<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ScratchView<'_, P, F>,
    work: &mut Work,
    mut found: impl FnMut(Root<P::Parameter>, &mut Work) -> bool,
) -> Result<(), Limit> {
    let number = surface.number as usize;
    let mut descent = tree.of_surface(patches, number).ok_or(Limit::Slot)?;
    let mut solver = Solver::new(surface, planes, limits, scratch.flat, &mut scratch.basis);
    // Ends with the tree.
    while let Some((patch, crossing)) = descent.next_patch(planes, limits, work)? {
        if !crossing.overlaps(&range) {
            continue;
        }
        let (fallback, mut go_on) = (&mut scratch.fallback, true);
        roots_of_patch(&mut solver, fallback, patch, &crossing, First::AsCritical, work, |root, work| {
            go_on = found(root, work) && go_on;
        })?;
        if !go_on {
            break;
        }
    }
    Ok(())
}
