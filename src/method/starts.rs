//! The starts of Newton's method on one patch that the ray meets.
//!
//! Source: Barth and Stürzlinger (1993), as the paper retells it: from the intersection with the parallelogram; if that
//! does not converge, from the entrance into the parallelepiped; then once more, from where is not said. In the critical
//! case of eq. (1) the entrance comes first.

use crate::alone::Alone;
use crate::contract::{Single, single_of};
use crate::fallback::Fallback;
use crate::limits::{Acceptance, Limit, MAX_NEWTON_STARTS, Work};
use crate::newton::{Decided, Solver};
use crate::parameter::Parameter;
use crate::patch::{Crossing, Patch};
use crate::point::Point;
use crate::region::Region;
use crate::root::Root;
use crate::scalar::Scalar;
use crate::story::Event;

/// Where to begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum First {
    /// At the parallelogram, or at the entrance if the patch is critical.
    AsCritical,
    /// At the entrance.
    Entrance,
}

/// The roots of a patch that the ray meets, to `found`: the one that its starts lead to, which may be another's; and with a
/// fallback, under [`Acceptance::Proved`], all that the patch has.
#[inline(always)]
pub(super) fn roots_of_patch<P: Point, F: Fallback<P>>(
    solver: &mut Solver<'_, '_, '_, P>,
    fallback: &mut F,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    first: First,
    work: &mut Work,
    mut found: impl FnMut(Root<P::Parameter>, &mut Work),
) -> Result<(), Limit> {
    if F::COMPLETE && solver.limits.acceptance == Acceptance::Proved {
        return proved_roots(solver, fallback, patch, crossing, first, work, found);
    }
    if let Some(root) = from_patch(solver, patch, crossing, first, work)? {
        found(root, work);
    }
    Ok(())
}

/// The root that a patch's starts lead to and, unless that is proved to be all, the roots of the patch: of the second patch
/// that is handed over those of the whole surface. A pole's patches, or those along a fold, would else be handed over one by
/// one, and all be clipped down to the same points.
#[inline(never)]
fn proved_roots<P: Point, F: Fallback<P>>(
    solver: &mut Solver<'_, '_, '_, P>,
    fallback: &mut F,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    first: First,
    work: &mut Work,
    mut found: impl FnMut(Root<P::Parameter>, &mut Work),
) -> Result<(), Limit> {
    if solver.decided == Decided::Surface {
        return Ok(());
    }
    let root = from_patch(solver, patch, crossing, first, work)?;
    if let Some(root) = root {
        found(root, work);
        if is_decided(solver, patch, crossing, &root, work)? {
            return Ok(());
        }
    }
    let region = Region::between(patch.domain().bounds());
    match single_of(solver, region, work)? {
        Single::Nothing => {
            work.excluded += 1;
            P::Scalar::tell(|| Event::Excluded);
        }
        Single::Root(root, _) => found(root, work),
        Single::Unproved => {
            work.handed_over += 1;
            P::Scalar::tell(|| Event::HandedOver);
            let (decided, region) = match solver.decided {
                Decided::Nothing => (Decided::Patch, region),
                _ => (Decided::Surface, Region::WHOLE),
            };
            solver.decided = decided;
            fallback.roots(&solver.surface, solver.planes, region, solver.limits, work, found)?;
        }
    }
    Ok(())
}

/// Whether a root is proved to be all that the ray meets of a patch, or to leave it nothing.
fn is_decided<P: Point>(
    solver: &mut Solver<'_, '_, '_, P>,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    root: &Root<P::Parameter>,
    work: &mut Work,
) -> Result<bool, Limit> {
    if patch.at_most_once(crossing) && patch.domain().holds(root.u.number(), root.v.number()) {
        return Ok(true);
    }
    let local = solver.local([root.u, root.v], work)?;
    Ok(Alone::new::<P::Flat>(root, &local, solver.surface.shape.bend, solver.planes.reach())
        .within(patch.domain().bounds()))
}

/// Tries the starts of a patch in turn until one converges; `None`, counted as unresolved, if none does.
#[inline]
fn from_patch<P: Point>(
    solver: &mut Solver<'_, '_, '_, P>,
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    first: First,
    work: &mut Work,
) -> Result<Option<Root<P::Parameter>>, Limit> {
    let critical = patch.is_critical(crossing, solver.limits.critical_factor);
    work.critical += u32::from(critical);
    if critical {
        P::Scalar::tell(|| Event::Critical);
    }
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
    let (entrance, exit) = match crossing.pierces() {
        Some([first, last]) => (Some(patch.at(&first)), Some(patch.at(&last))),
        None => (None, None),
    };
    let others: [_; MAX_NEWTON_STARTS as usize] =
        if entrance_first { [entrance, patch.parallelogram(crossing), exit] } else { [entrance, exit, None] };
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
    P::Scalar::tell(|| Event::Unresolved);
    Ok(None)
}
