//! The starts of Newton's method on one patch that the ray meets.
//!
//! Source: Barth and Stürzlinger (1993), as the paper retells it: from the intersection with the parallelogram; if that
//! does not converge, from the entrance into the parallelepiped; then once more, from where is not said. In the critical
//! case of eq. (1) the entrance comes first.

use crate::contract::{Single, single_of};
use crate::fallback::Fallback;
use crate::limits::{Acceptance, Limit, Work};
use crate::newton::{Alone, Root, Solver};
use crate::patch::{Crossing, Patch};
use crate::point::Point;
use crate::region::Region;

/// Where to begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum First {
    /// At the parallelogram, or at the entrance if the patch is critical.
    AsCritical,
    /// At the entrance.
    Entrance,
}

/// The roots of a patch that the ray meets, to `found`, by the rule of [`Limits::acceptance`](crate::limits::Limits::acceptance).
/// The patch's starts may also lead to a root on another.
#[inline(always)]
pub(super) fn roots_of_patch<P: Point, F: Fallback<P>>(
    solver: &mut Solver<'_, '_, '_, P>,
    fallback: &mut F,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    first: First,
    work: &mut Work,
    mut found: impl FnMut(Root<P::Scalar>, &mut Work),
) -> Result<(), Limit> {
    let root = from_patch(solver, patch, crossing, first, work)?;
    if let Some(root) = root {
        found(root, work);
    }
    if solver.limits.acceptance == Acceptance::Proved {
        return other_roots(solver, fallback, patch, crossing, root, work, found);
    }
    Ok(())
}

/// Whether a root is proved to be all that the ray meets of a patch, or to leave it nothing.
#[inline(always)]
fn is_decided<P: Point>(
    solver: &Solver<'_, '_, '_, P>,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    root: &Option<Root<P::Scalar>>,
) -> bool {
    let (Some(root), Some(local)) = (root, &solver.last) else {
        return false;
    };
    (patch.at_most_once(crossing) && patch.domain().holds(root.u, root.v))
        || Alone::new(root, local, solver.surface.bend).within(patch.domain().bounds())
}

/// The roots of a patch, unless the one that its starts led to is proved to be all.
#[inline(never)]
fn other_roots<P: Point, F: Fallback<P>>(
    solver: &mut Solver<'_, '_, '_, P>,
    fallback: &mut F,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    root: Option<Root<P::Scalar>>,
    work: &mut Work,
    mut found: impl FnMut(Root<P::Scalar>, &mut Work),
) -> Result<(), Limit> {
    if is_decided(solver, patch, crossing, &root) {
        return Ok(());
    }
    let region = Region { sides: patch.domain().bounds(), ..Region::WHOLE };
    match single_of(solver, region, work)? {
        Single::Nothing => work.excluded += 1,
        Single::Root(root, _) => found(root, work),
        Single::Unproved if F::COMPLETE => {
            work.handed_over += 1;
            fallback.roots(&solver.surface, solver.planes, region, solver.limits, work, found)?;
        }
        Single::Unproved => work.unproved += 1,
    }
    Ok(())
}

/// Tries the starts of a patch in turn until one converges; `None`, counted as unresolved, if none does.
#[inline]
fn from_patch<P: Point>(
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
