//! The testing ray: from a found point back toward the ray's origin, to see whether the point is the closest.
//!
//! Source: the paper's section "Improvement of Barth and Stürzlinger's Algorithm". The testing ray walks the grid and
//! meets patches; the caller learns of each as it is met, so that no list is stored (a departure in order only).
//! Newton's methods decide by the list ([`testing_ray`]), the clipping methods ask for yes or no ([`verdict`]).

use crate::limits::{Acceptance, Limit, Limits, Work};
use crate::parameter::Parameter;
use crate::patch::{Crossing, Patch};
use crate::planes::{DepthRange, Planes};
use crate::reading::Reading;
use crate::root::Root;
use crate::scalar::Scalar;
use crate::story::Event;
use crate::sweep::InGrid;

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

/// Sends a testing ray from `root` back to depth `nearest`, and calls `visit` with each patch whose box it meets, once each,
/// from the point toward the origin, as long as `visit` says so.
#[inline(always)]
pub fn testing_ray<S: Scalar, A: Parameter<Scalar = S>>(
    along: &InGrid<'_, S>,
    planes: &Planes<S>,
    root: &Root<A>,
    nearest: S,
    limits: &Limits<S>,
    work: &mut Work,
    mut visit: impl FnMut(&Listed<'_, S>, &mut Work) -> Result<bool, Limit>,
) -> Result<(), Limit> {
    let range = DepthRange { min: nearest, max: root.depth };
    S::tell(|| Event::Testing);
    along.back(planes, &range, limits, work, |patch, crossing, work| {
        let owner = patch.domain().holds(root.u.number(), root.v.number());
        // The owner's box holds the point; another's counts if it reaches between point and origin.
        if owner || reaches(crossing, &range) {
            S::tell(|| Event::Listed { owner });
            visit(&Listed { patch, crossing, owner }, work)
        } else {
            Ok(true)
        }
    })
}

/// Whether the ray is taken to meet the patch once at most.
#[inline(always)]
pub fn met_at_most_once<S: Scalar>(patch: &Patch<S>, crossing: &Crossing<S>, limits: &Limits<S>) -> bool {
    match limits.acceptance {
        Acceptance::Paper => !patch.is_critical(crossing, limits.critical_factor),
        Acceptance::Proved => patch.at_most_once(crossing),
    }
}

/// What the testing ray says of a point, without Newton's method: yes, or why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// No point of the surface lies before it.
    Closest,
    /// The ray may meet the patch that holds it more than once; or, ours, no listed patch holds it.
    Critical,
    /// Another patch lies between it and the origin.
    Hidden {
        /// That patch only adjoins the one that holds the point: boxes of neighbours overlap at their border.
        by_neighbour: bool,
    },
}

/// The testing ray's answer, yes or no, for `root`: the clipping methods' verification.
///
/// Source: the paper's section "An Improvement of Bézier Clipping".
pub fn verdict<S: Scalar, A: Parameter<Scalar = S>>(
    reading: impl Reading,
    along: &InGrid<'_, S>,
    planes: &Planes<S>,
    root: &Root<A>,
    nearest: S,
    limits: &Limits<S>,
    work: &mut Work,
) -> Result<Verdict, Limit> {
    let mut owner = None;
    let mut critical = false;
    let mut other = None;
    testing_ray(along, planes, root, nearest, limits, work, |listed, _| {
        if listed.owner {
            owner = Some(listed.patch.domain());
            critical = !met_at_most_once(listed.patch, listed.crossing, limits);
        } else if other.is_none() {
            other = Some(listed.patch.domain());
        }
        Ok(!reading.quick_verdict() || !critical && (owner.is_none() || other.is_none()))
    })?;
    Ok(match (owner, other) {
        _ if critical => Verdict::Critical,
        (None, _) => Verdict::Critical,
        (Some(_), None) => Verdict::Closest,
        (Some(owner), Some(other)) => Verdict::Hidden { by_neighbour: owner.adjoins(other) },
    })
}

/// Whether the ray is inside the box anywhere in the range.
#[inline(always)]
pub(crate) fn reaches<S: Scalar>(crossing: &Crossing<S>, range: &DepthRange<S>) -> bool {
    crossing.overlaps(range)
        && match crossing.pierces() {
            Some([entrance, exit]) => entrance.depth <= range.max && exit.depth >= range.min,
            None => true,
        }
}

#[cfg(test)]
mod tests;
