//! Newton's method in a region of a surface that is proved to hold one root at most.
//!
//! Source: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4, 1969.

use crate::bernstein::BasisView;
use crate::limits::{Limit, Limits, Work};
use crate::local::{Exactness, Local};
use crate::newton::Solver;
use crate::parameter::Parameter;
use crate::planes::Planes;
use crate::point::Point;
use crate::region::Region;
use crate::root::{Place, Root};
use crate::scalar::Scalar;
use crate::surface::Surface;

/// What contracting a region came to.
pub(crate) enum Contraction<A: Parameter> {
    /// Nothing is proved: the region may hold more than one root.
    Open,
    /// The region is done with: where its root is, if it has one.
    Done(Option<Place<A>>),
}

/// What a proof of at most one root came to.
pub(crate) enum Single<A: Parameter> {
    /// There is none.
    Nothing,
    /// One, and the surface there to first order.
    Root(Root<A>, Local<A>),
    /// There may be more than one.
    Unproved,
}

/// Regions over which the surface may stray farther than this, as a share of its largest coordinate, are clipped on without
/// asking whether they hold one root at most: few would be proved to, and asking costs a third of a clip. Ten times as much
/// costs 2 % more instructions on the common teapot.
const PROVABLE: f64 = 0.0025;

/// Whether it is worth asking of a region of these widths.
#[inline(always)]
pub(crate) fn is_provable<P: Point>(
    surface: &Surface<'_, P>,
    widths: [P::Scalar; 2],
    exact: &Exactness<P::Scalar>,
) -> bool {
    surface.strays(widths) <= P::Scalar::from_f64(PROVABLE) * exact.reach
}

/// Newton's method, in a region that is proved to hold at most one root: ends with that root, or with the proof that there
/// is none.
///
/// Over the region the surface departs from its linear part at the middle by at most σ ([`Surface::strays`]). With J the
/// Jacobian there, the projection is injective on the region if J⁻¹ turns 2 σ into less than half a width in each parameter,
/// and a root lies no farther than J⁻¹ turns σ into from where the step leads (R. Krawczyk, "Newton-Algorithmen zur Bestimmung
/// von Nullstellen mit Fehlerschranken", Computing 4, 1969). So each step at least halves the region. `error` is how far
/// rounding may have moved the region's sides, as a distance in space.
#[inline(always)]
pub(crate) fn contract<P: Point>(
    surface: &Surface<'_, P>,
    whole: &[P::Flat],
    mut region: Region<P::Parameter>,
    error: P::Scalar,
    exact: &Exactness<P::Scalar>,
    limits: &Limits<P::Scalar>,
    basis: &mut BasisView<'_, P::Scalar>,
    work: &mut Work,
) -> Result<Contraction<P::Parameter>, Limit> {
    if !is_provable(surface, region.widths(), exact) {
        return Ok(Contraction::Open);
    }
    let loose = Exactness { rounding: exact.rounding + error, ..*exact };
    // Ends: each turn counts a step against its budget; and the region halves until the number type holds no more.
    loop {
        let halves = region.widths().map(|width| width * P::Scalar::HALF);
        let middle = region.middle();
        let local = Local::step_at(middle, surface.net.degrees(), whole, basis, limits, work)?;
        let bound = surface.strays(halves);
        let strays = local.unweighted::<P::Flat>(bound);
        let [along_u, along_v] = local.inverse_bounds(strays);
        // A NaN or a singular Jacobian proves nothing; nor does one that may be all rounding, as of a flat net seen edge on.
        let proved =
            !local.may_be_singular(exact.reach) && along_u + along_u < halves[0] && along_v + along_v < halves[1];
        let Some([du, dv]) = local.step().filter(|_| proved) else {
            return Ok(Contraction::Open);
        };
        let next = [middle[0].plus(du), middle[1].plus(dv)];
        // A distance is that of the numerator over the weight, which over a region that is proved varies little.
        let heaviest = P::Scalar::from_u32(if P::RATIONAL { 4 } else { 1 });
        let [slack_u, slack_v] = local.inverse_bounds(strays + loose.allowed() * heaviest);
        let near = [[next[0].plus(-slack_u), next[0].plus(slack_u)], [next[1].plus(-slack_v), next[1].plus(slack_v)]];
        // A root is proved to lie there; and the step, shorter than all that the region allows for, leaves no more than the
        // tolerance.
        // Of a rational surface the rounding of the step may be more, where the weight falls.
        let regular = !P::RATIONAL || local.is_regular_enough::<P::Flat>([du, dv], exact);
        let lands = local.is_linear::<P::Flat>(surface.strays([du, dv]), [du, dv], exact) && regular;
        if region.encloses(near) && lands {
            return Ok(Contraction::Done(Some(Place { at: next, local })));
        }
        let smaller = region.meet(near);
        // As small as it gets: the surface strays no farther over it, or rounding keeps it from halving again.
        let stays = |smaller: &Region<P::Parameter>| {
            let widths = smaller.widths();
            (0..2).all(|k| widths[k] > halves[k] * P::Scalar::from_f64(1.5))
        };
        if local.is_linear::<P::Flat>(bound, halves, exact) || smaller.as_ref().is_some_and(stays) {
            let off =
                |next: [P::Parameter; 2], held: [P::Parameter; 2]| [next[0].minus(held[0]), next[1].minus(held[1])];
            let (mut local, mut next, held) = (local, next, region.nearest(next));
            let seen = !P::RATIONAL || (next == held && lands);
            if !(seen && local.may_hold(off(next, held), exact)) {
                // What the step leaves across the ray is within the tolerance, but where the ray is all but tangent it carries
                // far along the surface, and toward the border a weight may fall, by which distances grow: one more from the
                // border says on which side of it the root lies.
                local = Local::step_at(held, surface.net.degrees(), whole, basis, limits, work)?;
                let Some([du, dv]) = local.step() else {
                    return Ok(Contraction::Open);
                };
                next = [held[0].plus(du), held[1].plus(dv)];
            }
            // A root that rounding has moved out of its region is where it is, if by no more than what is allowed for: of
            // neighbours that meet where the ray is all but tangent, each may find it in the other. One beyond the surface's
            // edge is held there. Of a rational surface it is held beside the region, beyond which the weight may fall to
            // nothing.
            let [slack_u, slack_v] = local.inverse_bounds(loose.allowed());
            let may_lie = |[u, v]: [P::Parameter; 2]| {
                region.meet([[u.plus(-slack_u), u.plus(slack_u)], [v.plus(-slack_v), v.plus(slack_v)]]).is_some()
            };
            let within = if P::RATIONAL { region.around(P::Scalar::HALF) } else { Region::WHOLE };
            let at = within.nearest(next);
            if may_lie(next) && local.may_hold(off(next, at), exact) {
                if !P::RATIONAL {
                    return Ok(Contraction::Done(Some(Place { at, local })));
                }
                // What is bounded is the numerator: where the weight falls, all of it may be small, and the point far from the
                // ray. So the place is looked at.
                let place = Place::look(at, surface.net.degrees(), whole, basis)?;
                let on_the_ray = place.local.distance() <= loose.allowed();
                return Ok(if on_the_ray { Contraction::Done(Some(place)) } else { Contraction::Open });
            }
            let on_edge = if local.at == held { local.on_edge(next, exact) } else { None };
            return Ok(Contraction::Done(on_edge.filter(|&at| may_lie(at)).map(|at| Place { at, local })));
        }
        match smaller {
            Some(smaller) => region = smaller,
            None => return Ok(Contraction::Done(None)),
        }
    }
}

/// The root in a region, if it is proved to hold one at most; `whole` is the surface's net, projected.
#[inline(always)]
pub(crate) fn single<P: Point>(
    surface: &Surface<'_, P>,
    planes: &Planes<P::Scalar>,
    whole: &[P::Flat],
    region: Region<P::Parameter>,
    exact: &Exactness<P::Scalar>,
    limits: &Limits<P::Scalar>,
    basis: &mut BasisView<'_, P::Scalar>,
    work: &mut Work,
) -> Result<Single<P::Parameter>, Limit> {
    Ok(match contract(surface, whole, region, P::Scalar::ZERO, exact, limits, basis, work)? {
        Contraction::Done(Some(place)) => {
            let root = place.root(&surface.net, whole, planes, exact, basis)?;
            Single::Root(root, place.local)
        }
        Contraction::Done(None) => Single::Nothing,
        Contraction::Open => Single::Unproved,
    })
}

/// [`single`] of the surface that a solver is at.
pub(crate) fn single_of<P: Point>(
    solver: &mut Solver<'_, '_, '_, P>,
    region: Region<P::Parameter>,
    work: &mut Work,
) -> Result<Single<P::Parameter>, Limit> {
    solver.project()?;
    let Solver { surface, planes, limits, exact, flat, basis, .. } = solver;
    let whole = flat.get(..surface.net.points().len()).ok_or(Limit::Scratch)?;
    single(surface, planes, whole, region, exact, limits, basis, work)
}
