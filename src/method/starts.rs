//! The starts of Newton's method on one patch that the ray meets.
//!
//! Source: Barth and Stürzlinger (1993), as the paper retells it: from the intersection with the parallelogram; if that
//! does not converge, from the entrance into the parallelepiped; then once more, from where is not said. In the critical
//! case of eq. (1) the entrance comes first.

use crate::limits::{Limit, Work};
use crate::newton::{Root, Solver};
use crate::patch::{Crossing, Patch};
use crate::point::Point;

/// Where to begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum First {
    /// At the parallelogram, or at the entrance if the patch is critical.
    AsCritical,
    /// At the entrance.
    Entrance,
}

/// Tries the starts of a patch in turn until one converges; `None`, counted as unresolved, if none does.
#[inline]
pub(super) fn from_patch<P: Point>(
    solver: &mut Solver<'_, '_, '_, P>,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    first: First,
    work: &mut Work,
) -> Result<Option<Root<P::Scalar>>, Limit> {
    let critical = patch.is_critical(crossing, solver.limits.critical_factor);
    work.critical += u32::from(critical);
    let entrance_first = critical || first == First::Entrance;
    let mut starts_left = solver.limits.newton_starts;
    if !entrance_first && starts_left > 0 {
        if let Some(start) = patch.parallelogram(crossing) {
            starts_left -= 1;
            if let Some(root) = solver.solve(start, work)? {
                return Ok(Some(root));
            }
        }
    }
    // Ours: the third start is the exit, or the parallelogram where the entrance came first.
    let pierces = crossing.pierces().map(|ends| ends.map(|end| patch.at(&end)));
    let [entrance, exit] = pierces.map_or([None, None], |ends| ends.map(Some));
    let others = if entrance_first { [entrance, patch.parallelogram(crossing), exit] } else { [entrance, exit, None] };
    for start in others.into_iter().flatten() {
        if starts_left == 0 {
            break;
        }
        starts_left -= 1;
        if let Some(root) = solver.solve(start, work)? {
            return Ok(Some(root));
        }
    }
    work.unresolved += 1;
    Ok(None)
}
