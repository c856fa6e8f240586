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
use crate::local::noise;
use crate::planes::Planes;
use crate::point::{Flat, Point};
use crate::region::Region;
use crate::root::Place;
use crate::scalar::Scalar;
use crate::surface::Surface;

/// What a projected net is, seen across the direction in which it is longest.
pub(crate) enum Across<S> {
    /// Apart from the ray by more than rounding.
    Apart,
    /// A line through the ray, along this unit vector, to the error of the net, and crossed by the ray once
    /// along each parameter line of u, or of v: what roots it may hold cannot be told apart.
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
    let (mut low, mut high) = (F::Scalar::INFINITY, F::Scalar::LEAST);
    for point in net {
        let [f, g] = point.f_g();
        let distance = g * along[0] - f * along[1];
        (low, high) = (low.lesser(distance), high.greater(distance));
    }
    let error = noise.error * (along[0].abs() + along[1].abs());
    if low > error || high < -error {
        return Across::Apart;
    }
    // Not the tolerance, within which a cubic contact still is one root and no other.
    if high - low <= error * F::Scalar::from_u32(4) && is_steady(degrees.columns(), net, along, noise) {
        return Across::Line(along);
    }
    Across::Open
}

/// Whether the distances along a unit vector grow, or fall, from each point of a net to the next in u, or in v, by more than
/// rounding. A net that is a line may be a root in one parameter alone, with others beside it.
fn is_steady<F: Flat>(columns: usize, net: &[F], [x, y]: [F::Scalar; 2], noise: &Noise<F::Scalar>) -> bool {
    let error = noise.error * F::Scalar::TWO * (x.abs() + y.abs());
    let extent = |[low, high]: [F::Scalar; 2], (&p, &q): (&F, &F)| {
        let [f, g] = (q - p).f_g();
        let step = f * x + g * y;
        [low.lesser(step), high.greater(step)]
    };
    let none = [F::Scalar::INFINITY, F::Scalar::LEAST];
    let along_u = net.iter().zip(net.iter().skip(columns)).fold(none, extent);
    let rows = net.chunks_exact(columns);
    let along_v = rows.fold(none, |both, row| row.iter().zip(row.iter().skip(1)).fold(both, extent));
    [along_u, along_v].iter().any(|[low, high]| *low > error || *high < -error)
}

/// How far the points of a region that can be told no closer pass the ray at most, by the measure of
/// [`Local::distance`](crate::newton::Local::distance).
#[inline(always)]
pub(crate) fn allowed<S: Scalar>(tolerance: S, error: S) -> S {
    tolerance * S::TWO + error * S::from_u32(16) + noise()
}

/// Of some places the one that the ray meets first, in its interval if one is; `None` if it passes all of them by more than
/// is allowed. The tolerance and the error are those of points.
pub(crate) fn first_met<P: Point, const N: usize>(
    surface: &Surface<'_, P>,
    planes: &Planes<P::Scalar>,
    places: [Place<P::Scalar>; N],
    [tolerance, error]: [P::Scalar; 2],
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Option<Place<P::Scalar>>, Limit> {
    let allowed = allowed(tolerance, error);
    let rounding = error * P::Scalar::from_u32(4) + noise();
    // In order of worth: whether it lies before the interval, or is held by no more than its net's error; whether it passes the
    // ray by more than rounding, as where the surface leaves the ray slowly all within the tolerance; and its depth.
    let mut least = None;
    let mut best = None;
    for place in places {
        let distance = place.local.distance();
        if !(distance <= allowed) {
            continue;
        }
        let depth = planes.depth_on(&surface.net, place.at, basis).map_err(|Full| Limit::Scratch)?;
        let far = distance > tolerance * P::Scalar::TWO + noise::<P::Scalar>();
        let faults = [planes.is_before_interval(depth), far, distance > rounding];
        if least.is_none_or(|least| (faults, depth) < least) {
            (least, best) = (Some((faults, depth)), Some(place));
        }
    }
    Ok(best)
}

/// The place that a few of Newton's steps lead to from a point of a region, as long as each brings the ray nearer: no farther
/// from the region than [`REACH`] times its width. A root that lies beside the region, and is found from there too, is a better
/// answer than the point of the region that the error of its net lets pass for one.
pub(crate) fn polished<P: Point>(
    surface: &Surface<'_, P>,
    whole: &[P::Flat],
    region: &Region<P::Scalar>,
    at: [P::Scalar; 2],
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Place<P::Scalar>, Limit> {
    let around = region.sides.map(|[low, high]| {
        let reach = (high - low) * P::Scalar::from_u32(REACH);
        [P::Scalar::ZERO.greater(low - reach), P::Scalar::ONE.lesser(high + reach)]
    });
    Place::polished(at, around, surface.net.degrees(), whole, basis)
}

/// See [`polished`]. Less leaves more of the roots of cubic contact a third of the digits; more may lead to another root, and
/// leave the region's own to its neighbours.
const REACH: u32 = 8;

/// Steps toward the line's zero: of a region small enough to be seen as a line the first is all but exact.
const STEPS: u32 = 3;

/// Of a region that is seen as a line along `along`, the place on the ray that it meets first: the middle of the part of the
/// region that is on the ray, or one of its ends. `None` if the ray passes by, or a part of the region has to be looked at.
#[cold]
#[inline(never)]
pub(crate) fn on_line<P: Point>(
    surface: &Surface<'_, P>,
    planes: &Planes<P::Scalar>,
    whole: &[P::Flat],
    region: &Region<P::Scalar>,
    along: [P::Scalar; 2],
    within: [P::Scalar; 2],
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<Option<Place<P::Scalar>>, Limit> {
    let mut look = |at| Place::look(at, surface.net.degrees(), whole, basis);
    let widths = region.widths();
    // The shortest way to where the distance along the line is 0, in shares of the region's widths; and how that distance grows.
    let toward = |place: &Place<P::Scalar>| {
        let (off, grows) = place.local.seen_along(along);
        let grows = [grows[0] * widths[0], grows[1] * widths[1]];
        let square = grows[0] * grows[0] + grows[1] * grows[1];
        (square > P::Scalar::ZERO).then(|| (grows, grows.map(|c| -off * c / square)))
    };
    let moved =
        |at: [P::Scalar; 2], [du, dv]: [P::Scalar; 2]| region.nearest([at[0] + du * widths[0], at[1] + dv * widths[1]]);
    let mut middle = look(region.middle())?;
    let mut grows = [P::Scalar::ZERO; 2];
    for _ in 0..STEPS {
        let Some((slope, step)) = toward(&middle) else { break };
        grows = slope;
        middle = look(moved(middle.at, step))?;
    }
    // Where the line of zero leaves the region: as far along it as its widths go, and back onto it.
    let steepest = grows[0].abs().greater(grows[1].abs());
    let mut ends = [middle.at; 2];
    if steepest > P::Scalar::ZERO {
        let [a, b] = grows.map(|c| c / steepest);
        for (end, way) in ends.iter_mut().zip([[-b, a], [b, -a]]) {
            let mut share = P::Scalar::ONE;
            for k in 0..2 {
                let [low, high] = region.sides[k];
                let (from, by) = (middle.at[k], way[k] * widths[k]);
                let room = if by > P::Scalar::ZERO { high - from } else { from - low };
                if room < by.abs() * share {
                    share = room / by.abs();
                }
            }
            *end = moved(middle.at, way.map(|c| c * share));
        }
    }
    let mut places = [look(ends[0])?, look(ends[1])?];
    for place in &mut places {
        for _ in 0..STEPS {
            if let Some((_, step)) = toward(place) {
                *place = look(moved(place.at, step))?;
            }
        }
    }
    // A region may be thin alone, with a root like any other: then Newton's method comes nearer to it, and the ends do not.
    let middle = polished(surface, whole, region, middle.at, basis)?;
    let [first, second] = places;
    // Of a line that may reach into the interval from outside, a smaller part has to be looked at.
    let [tolerance, error] = within;
    let (mut inside, mut before, mut behind) = (false, false, false);
    for place in [&middle, &first, &second] {
        let depth = planes.depth_on(&surface.net, place.at, basis).map_err(|Full| Limit::Scratch)?;
        let unknown = !(place.local.distance() <= allowed(tolerance, error));
        inside |= !unknown && planes.t_in_interval(depth).is_some();
        before |= unknown || planes.is_before_interval(depth);
        behind |= unknown || !planes.is_before_interval(depth);
    }
    if !inside && before && behind {
        return Ok(None);
    }
    first_met(surface, planes, [middle, first, second], within, basis)
}

#[cfg(test)]
mod tests;
