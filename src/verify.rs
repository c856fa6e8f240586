//! The testing ray: from a found point back toward the ray's origin, to see whether the point is the closest.
//!
//! Source: the paper's section "Improvement of Barth and Stürzlinger's Algorithm". The testing ray walks the grid and
//! meets patches; the caller learns of each as it is met, so that no list is stored (a departure in order only).

use crate::grid::Grid;
use crate::limits::{Limit, Limits, Work};
use crate::newton::Root;
use crate::patch::{Crossing, Patch};
use crate::planes::{DepthRange, Planes};
use crate::scalar::Scalar;
use crate::sweep::sweep;

/// A patch whose parallelepiped the testing ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Listed<'p, S> {
    /// The patch.
    pub patch: &'p Patch<S>,
    /// How the ray, as a line, passes its box.
    pub crossing: &'p Crossing<S>,
    /// Whether its domain holds the point to be verified.
    pub owner: bool,
}

/// Sends a testing ray from `root` back to depth `nearest`, and calls `visit` with each patch of `patches` whose box it
/// meets, once each, from the point toward the origin.
#[inline(always)]
pub fn testing_ray<S: Scalar>(
    grid: &Grid<'_, S>,
    patches: &[Patch<S>],
    planes: &Planes<S>,
    root: &Root<S>,
    nearest: S,
    limits: &Limits<S>,
    work: &mut Work,
    mut visit: impl FnMut(&Listed<'_, S>, &mut Work) -> Result<(), Limit>,
) -> Result<(), Limit> {
    let inverse = planes.inverse().map(|c| -c);
    let range = DepthRange { min: nearest, max: root.depth };
    let walk = grid.walk(&planes.at(root.depth), &inverse, root.depth - nearest);
    sweep(walk, patches, planes, limits, work, |patch, crossing, work| {
        let owner = patch.domain().holds(root.u, root.v);
        // The owner's box holds the point; another's counts if it reaches between point and origin.
        if owner || reaches(crossing, &range) {
            visit(&Listed { patch, crossing, owner }, work)?;
        }
        Ok(S::INFINITY)
    })
}

/// Whether the ray is inside the box anywhere in the range.
#[inline(always)]
fn reaches<S: Scalar>(crossing: &Crossing<S>, range: &DepthRange<S>) -> bool {
    crossing.overlaps(range)
        && match crossing.pierces() {
            Some([entrance, exit]) => entrance.depth <= range.max && exit.depth >= range.min,
            None => true,
        }
}

#[cfg(test)]
mod tests;
