//! Where a ray all but follows a surface: what lies across the line that the surface there is seen as.
//!
//! Near a tangent the projected surface is folded: seen along the ray it is all but a line, and the two lines of a clip, which
//! both cross that one, tell nothing of how far the fold is from the ray. Along the fold a region cannot be bisected until it
//! is smaller than what parts it from the ray, squared; but across, the distances are those of a parabola, and a region as
//! large as its own way to the fold is told from the ray. So work grows by the logarithm of the margin, not by its inverse.
//!
//! Ours; Efremov, Havran and Seidel (2005) spread the lines, which parts neither case.

use crate::bernstein::{BasisView, Degrees, Full};
use crate::clip::{Noise, corners};
use crate::limits::Limit;
use crate::local::Exactness;
use crate::parameter::Parameter;
use crate::planes::Planes;
use crate::point::{Flat, Point};
use crate::ray::Incidence;
use crate::region::Region;
use crate::root::Place;
use crate::scalar::Scalar;
use crate::surface::Surface;

/// What a projected net is, seen across the direction in which it is longest.
pub(crate) enum Across<S> {
    /// Apart from the ray by more than rounding.
    Apart,
    /// A line through the ray, along this unit vector, to the error of the net, whose places on the ray are one stretch: what roots
    /// it may hold cannot be told apart.
    Line([S; 2]),
    /// Neither.
    Open,
}

/// What a projected net is across its longer diagonal.
#[cold]
#[inline(never)]
pub(crate) fn across<F: Flat>(degrees: Degrees, net: &[F], noise: &Noise<F::Scalar>) -> Across<F::Scalar> {
    let [p00, p10, p01, p11] = corners(degrees, net);
    let diagonals = [[p11[0] - p00[0], p11[1] - p00[1]], [p01[0] - p10[0], p01[1] - p10[1]]];
    let [first, second] = diagonals.map(|[x, y]| x * x + y * y);
    let [x, y] = if first >= second { diagonals[0] } else { diagonals[1] };
    let largest = x.abs().greater(y.abs());
    // Corners in one place, as those of a loop, name no direction; nor do those of a net that is one point.
    if !(largest > F::Scalar::ZERO) {
        return Across::Open;
    }
    let [x, y] = [x / largest, y / largest];
    let length = (x * x + y * y).sqrt();
    let along = [x / length, y / length];
    let error = noise.error * (along[0].abs() + along[1].abs());
    let (mut low, mut high, mut thin) = (F::Scalar::INFINITY, F::Scalar::LEAST, true);
    let three = F::Scalar::from_u32(3);
    for point in net {
        let [f, g] = point.f_g();
        let distance = g * along[0] - f * along[1];
        let off = if F::RATIONAL { error * point.weight() } else { F::Scalar::ZERO };
        (low, high) = (low.lesser(distance - off), high.greater(distance + off));
        // Not the tolerance, within which a cubic contact still is one root and no other.
        thin &= !F::RATIONAL || distance.abs() <= off * three;
    }
    // Of others all points are off by the same.
    if !F::RATIONAL {
        thin = low.abs().greater(high.abs()) <= error * three;
        (low, high) = (low - error, high + error);
    }
    if low > F::Scalar::ZERO || high < F::Scalar::ZERO {
        return Across::Apart;
    }
    if thin && is_one_stretch(degrees.columns(), net, along, noise) { Across::Line(along) } else { Across::Open }
}

/// Whether the places on the ray of a net that is a line along a unit vector are one stretch, as far as the net tells: the
/// distances along grow, or fall, from each point to the next in one parameter by more than rounding, and change their sign once at
/// most along either end of it.
///
/// Then the ray meets each parameter line once at most, and those that it meets within the net are the parameters at which the
/// one end lies on this side and the other on that. By the variation diminishing property of Bernstein polynomials that is an
/// interval. Of a sheet between two curves, which a plane through the ray cuts in a curve, it is more than one where the ray meets
/// that curve more than once.
fn is_one_stretch<F: Flat>(columns: usize, net: &[F], [x, y]: [F::Scalar; 2], noise: &Noise<F::Scalar>) -> bool {
    let error = noise.error * (x.abs() + y.abs());
    let along = |p: F| {
        let [f, g] = p.f_g();
        f * x + g * y
    };
    let extent = |[low, high]: [F::Scalar; 2], (&p, &q): (&F, &F)| {
        let (step, off) = (along(q - p), error * (p.weight() + q.weight()));
        [low.lesser(step - off), high.greater(step + off)]
    };
    let steady = |[low, high]: [F::Scalar; 2]| low > F::Scalar::ZERO || high < F::Scalar::ZERO;
    let none = [F::Scalar::INFINITY, F::Scalar::LEAST];
    let along_u = net.iter().zip(net.iter().skip(columns)).fold(none, extent);
    let rows = net.chunks_exact(columns);
    let along_v = rows.clone().fold(none, |both, row| row.iter().zip(row.iter().skip(1)).fold(both, extent));
    let seen = |p: &F| (along(*p), error * p.weight());
    let [first_row, last_row] = [rows.clone().next(), rows.clone().next_back()].map(|row| row.unwrap_or(&[]));
    let column = |k: usize| net.iter().skip(k).step_by(columns);
    steady(along_u) && [first_row, last_row].iter().all(|row| changes_sign_once(row.iter().map(seen)))
        || steady(along_v) && [0, columns - 1].iter().all(|&k| changes_sign_once(column(k).map(seen)))
}

/// Whether numbers, each off by what stands beside it at most, change their sign once at most. Of those that may be 0 only some at
/// one end, or between two signs, are let pass: others may hide a change and another one back. Where all may be 0, all lie on the
/// ray.
fn changes_sign_once<S: Scalar>(numbers: impl Iterator<Item = (S, S)>) -> bool {
    let (mut changes, mut before, mut unsure) = (0, None, false);
    for (number, off) in numbers {
        let positive = if number > off {
            true
        } else if number < -off {
            false
        } else {
            unsure = true;
            continue;
        };
        changes += match before {
            Some(before) if before == positive => 2 * i32::from(unsure),
            Some(_) => 1,
            None => i32::from(unsure),
        };
        (before, unsure) = (Some(positive), false);
    }
    before.is_none() || changes + i32::from(unsure) <= 1
}

/// A place on the ray, and what the ray does there at least.
pub(crate) struct Met<A: Parameter> {
    pub(crate) place: Place<A>,
    pub(crate) incidence: Incidence,
}

/// Of some places of a region whose points all are on the ray, or on a line in the surface that is, the one that the ray meets
/// first, in its interval if one is; `None` if it passes all of them by more than is allowed, and the net's error.
pub(crate) fn first_met<P: Point, const N: usize>(
    surface: &Surface<'_, P>,
    planes: &Planes<P::Scalar>,
    places: [Place<P::Parameter>; N],
    exact: &Exactness<P::Scalar>,
    error: P::Scalar,
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Option<Met<P::Parameter>>, Limit> {
    let allowed = exact.allowed() + error;
    // Of a stretch, in order of worth: whether it lies before the interval; whether it passes the ray by more than rounding, as
    // where the surface leaves the ray slowly all within the tolerance; if it is held by no more than its net's error, its
    // distance; and its depth.
    let mut first = None;
    // Of one root, the place that is nearest to the ray.
    let mut nearest_to_ray: Option<Place<P::Parameter>> = None;
    let (mut nearest, mut farthest) = (P::Scalar::INFINITY, P::Scalar::LEAST);
    for place in places {
        let distance = place.local.distance();
        if !(distance <= allowed) {
            continue;
        }
        let depth = planes.depth_on(&surface.net, place.at, basis).map_err(|Full| Limit::Scratch)?;
        (nearest, farthest) = (nearest.lesser(depth), farthest.greater(depth));
        let faults = [planes.is_before_interval(depth), distance > exact.rounding + planes.noise()];
        let rank = (faults, distance.greater(exact.allowed()), depth);
        if first.is_none_or(|(least, _)| rank < least) {
            first = Some((rank, place));
        }
        if !planes.is_before_interval(depth) && nearest_to_ray.is_none_or(|old| distance < old.local.distance()) {
            nearest_to_ray = Some(place);
        }
    }
    let Some((_, first)) = first else { return Ok(None) };
    let place = nearest_to_ray.unwrap_or(first);
    let stretch = farthest - nearest;
    let in_contact = stretch > exact.size * P::Scalar::from_f64(CONTACT);
    let mut incidence = Incidence::Crossing;
    if in_contact || stretch > exact.allowed() * P::Scalar::from_u32(BESIDE) {
        // Roots may be apart that cannot be told apart, or the ray may follow the surface; or what is allowed across the ray, to
        // both sides of one root, is so much along it.
        let [depth_u, depth_v] =
            planes.depth_derivatives(&surface.net, place.at, basis).map_err(|Full| Limit::Scratch)?;
        let [by_u, by_v] = place.local.inverse_bounds(allowed + allowed);
        let explained = depth_u.abs() * by_u + depth_v.abs() * by_v;
        if place.local.may_be_singular(exact.reach) || !(stretch <= explained) {
            incidence = if in_contact { Incidence::Contact } else { Incidence::Grazing };
        }
    }
    let place = if incidence == Incidence::Crossing { place } else { first };
    // What is held by no more than its net's error may as well be a ray that all but meets the surface.
    if place.local.distance() > exact.allowed() {
        incidence = incidence.max(Incidence::Grazing);
    }
    Ok(Some(Met { place, incidence }))
}

/// A ray is in contact with a surface along a stretch longer than this share of the surface's size. Where it is shorter, it is
/// that of a tangent to a curved surface, which rounding does not part from the surface at once.
pub(crate) const CONTACT: f64 = 1.0 / 64.0;

/// What lies apart along the ray by no more than so many times what is allowed across it may be one root: of a ray that is steeper
/// than the inverse of this, it is. Larger takes roots for one that shallow rays have; smaller calls more of them grazing.
pub(crate) const BESIDE: u32 = 64;

/// The place that a few of Newton's steps lead to from a point of a region, as long as each brings the ray nearer: no farther
/// from the region than [`REACH`] times its width. A root that lies beside the region, and is found from there too, is a better
/// answer than the point of the region that the error of its net lets pass for one.
pub(crate) fn polished<P: Point>(
    surface: &Surface<'_, P>,
    whole: &[P::Flat],
    region: &Region<P::Parameter>,
    at: [P::Parameter; 2],
    exact: &Exactness<P::Scalar>,
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Place<P::Parameter>, Limit> {
    let around = region.around(P::Scalar::from_u32(REACH)).sides;
    Place::polished(at, around, surface.net.degrees(), whole, exact, true, basis)
}

/// See [`polished`]. Less leaves more of the roots of cubic contact a third of the digits; more may lead to another root, and
/// leave the region's own to its neighbours.
const REACH: u32 = 8;

/// Steps toward the line's zero: of a region small enough to be seen as a line the first is all but exact.
const STEPS: u32 = 3;

/// Where a line leaves a region, and by which of its sides, of u or of v, if by one.
type End<A> = ([A; 2], Option<(bool, A)>);

/// Of a region that is seen as a line along `along`, the place on the ray that it meets first: the middle of the part of the
/// region that is on the ray, or one of its ends. `None` if the ray passes by, or a part of the region has to be looked at.
#[cold]
#[inline(never)]
pub(crate) fn on_line<P: Point>(
    surface: &Surface<'_, P>,
    planes: &Planes<P::Scalar>,
    whole: &[P::Flat],
    region: &Region<P::Parameter>,
    along: [P::Scalar; 2],
    exact: &Exactness<P::Scalar>,
    error: P::Scalar,
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Option<Met<P::Parameter>>, Limit> {
    let mut look = |at| Place::look(at, surface.net.degrees(), whole, basis);
    let widths = region.widths();
    // The distance along the line, and how it grows with shares of the region's widths.
    let slope = |place: &Place<P::Parameter>| {
        let (off, grows) = place.local.seen_along(along);
        (off, [grows[0] * widths[0], grows[1] * widths[1]])
    };
    let moved = |at: [P::Parameter; 2], [du, dv]: [P::Scalar; 2]| {
        region.nearest([at[0].plus(du * widths[0]), at[1].plus(dv * widths[1])])
    };
    let mut middle = look(region.middle())?;
    let mut grows = [P::Scalar::ZERO; 2];
    for _ in 0..STEPS {
        // The shortest way to where the distance is 0.
        let (off, by) = slope(&middle);
        let square = by[0] * by[0] + by[1] * by[1];
        if !(square > P::Scalar::ZERO) {
            break;
        }
        grows = by;
        middle = look(moved(middle.at, by.map(|c| -off * c / square)))?;
    }
    // Where the line of zero leaves the region: as far along it as its widths go, and then along the side that was come to.
    let steepest = grows[0].abs().greater(grows[1].abs());
    let mut ends = [(middle.at, None); 2];
    if steepest > P::Scalar::ZERO {
        let [a, b] = grows.map(|c| c / steepest);
        for (end, way) in ends.iter_mut().zip([[-b, a], [b, -a]]) {
            let (mut share, mut side) = (P::Scalar::ONE, None);
            for k in 0..2 {
                let [low, high] = region.sides[k];
                let (from, by) = (middle.at[k], way[k] * widths[k]);
                let forward = by > P::Scalar::ZERO;
                let room = if forward { high.minus(from) } else { from.minus(low) };
                if room < by.abs() * share {
                    (share, side) = (room / by.abs(), Some((k == 1, if forward { high } else { low })));
                }
            }
            *end = (moved(middle.at, way.map(|c| c * share)), side);
        }
    }
    let mut reached = |(mut at, side): End<P::Parameter>| {
        let Some((mut fixed, on_side)) = side else { return look(at) };
        at[usize::from(fixed)] = on_side;
        let mut place = look(at)?;
        for _ in 0..2 * STEPS {
            // Which parameter is free, as a number that is no more than 1 for all to see.
            let (free, (off, by)) = (usize::from(!fixed), slope(&place));
            let step = -off / by[free] * widths[free];
            if off == P::Scalar::ZERO || !step.is_finite() {
                break;
            }
            let next = place.at[free].plus(step);
            let mut at = place.at;
            at[free] = next.held(region.sides[free][0], region.sides[free][1]);
            // Past the corner the line leaves by the other side.
            if at[free] != next {
                fixed = !fixed;
            }
            place = look(at)?;
        }
        Ok(place)
    };
    let [first, second] = [reached(ends[0])?, reached(ends[1])?];
    // Of a line that may reach into the interval from outside, a smaller part has to be looked at.
    let (mut inside, mut before, mut behind) = (false, false, false);
    let mut known = true;
    // What is not apart from the ray by the net's error, across the line, may be |f| + |g| of twice that: less would leave places
    // that are neither passed nor on the ray.
    let held = error + error;
    let is_known = |place: &Place<P::Parameter>| place.local.distance() <= exact.allowed() + held;
    for place in [&middle, &first, &second] {
        let depth = planes.depth_on(&surface.net, place.at, basis).map_err(|Full| Limit::Scratch)?;
        let unknown = !is_known(place);
        known &= !unknown;
        inside |= !unknown && planes.t_in_interval(depth).is_some();
        before |= unknown || planes.is_before_interval(depth);
        behind |= unknown || !planes.is_before_interval(depth);
    }
    // Likewise where the steps toward the line were led astray, as they may be in a region as large as a bent sheet that a plane
    // through the ray cuts; or of a line that the ray follows, if its ends are not found, since it is bent, or if it begins before
    // the interval and goes on in it, and so is met where the interval begins.
    let followed = middle.local.may_be_singular(exact.reach) && (!known || (inside && before));
    if (!inside && before && behind) || (region.is_divisible() && (!is_known(&middle) || followed)) {
        return Ok(None);
    }
    // A region may be thin alone, with a root like any other: then Newton's method comes nearer to it, and the ends do not.
    let middle = polished(surface, whole, region, middle.at, exact, basis)?;
    first_met(surface, planes, [middle, first, second], exact, held, basis)
}

#[cfg(test)]
mod tests;
