//! One clip of Bézier clipping: how much of a parameter's interval can hold roots.
//!
//! The projected net's signed distances to a line through the ray are the coefficients of a polynomial in Bernstein form;
//! where the convex hull of its control polygon does not meet zero, neither does the surface meet the ray.
//!
//! Source: T. Nishita, T. W. Sederberg and M. Kakimoto, "Ray tracing trimmed rational surface patches", SIGGRAPH 1990. With
//! corrections by S. Campagna, P. Slusallek and H.-P. Seidel, "Ray tracing of spline surfaces", The Visual Computer 13(6),
//! 1997, and by A. Efremov, V. Havran and H.-P. Seidel, "Robust and numerically stable Bézier clipping method for ray
//! tracing NURBS surfaces", SCCG 2005.

use crate::bernstein::{Degrees, Direction, MAX_DEGREE};
use crate::point::Flat;
use crate::scalar::Scalar;

/// What a clip leaves of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clip<S> {
    /// Nothing: there is no root.
    Nothing,
    /// The part [from, to] of the interval, counted across it from 0 to 1.
    Part([S; 2]),
    /// All of it, since the distances differ by no more than the tolerance: to clip on would be to clip noise.
    Settled,
}

/// What rounding may have done to a projected net.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise<S> {
    /// By how much each coefficient may be off.
    pub error: S,
    /// How far the surface may pass from the ray and still count as meeting it, times the least weight.
    pub tolerance: S,
}

/// The normal of the line to which distances are taken when `direction` is clipped, of a projected net with these corners.
///
/// The lines are Nishita, Sederberg and Kakimoto's: L_u, for clipping u, along the net's mean chord in v, and L_v along that in
/// u, so that distances to L_u change with u and hardly with v.
#[inline(always)]
pub(crate) fn normal<F: Flat>(corners: [F; 4], direction: Direction) -> [F::Scalar; 2] {
    let [p00, p10, p01, p11] = corners.map(position);
    let chord = |a: [F::Scalar; 2], b: [F::Scalar; 2], c: [F::Scalar; 2], d: [F::Scalar; 2]| {
        [b[0] - a[0] + (d[0] - c[0]), b[1] - a[1] + (d[1] - c[1])]
    };
    let (u, v) = (chord(p00, p10, p01, p11), chord(p00, p01, p10, p11));
    let dot = u[0] * v[0] + u[1] * v[1];
    let (uu, vv) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1]);
    // Lines that are all but parallel clip the same strip twice. Efremov, Havran and Seidel spread them from 60° on; but spread
    // lines no longer follow the chords, and clips then close in by a share instead of by squares: at 60° half of all
    // clips on the common teapot are of that kind, and a third of the time is lost. At 6° it is the other way round.
    if dot * dot <= F::Scalar::from_f64(0.99) * (uu * vv) && uu > F::Scalar::ZERO && vv > F::Scalar::ZERO {
        return turned(match direction {
            Direction::U => v,
            Direction::V => u,
        });
    }
    spread(u, v, direction)
}

/// The normal for lines 60° apart about the mean direction of two chords that are near parallel; if one is null, it is the
/// other turned by 90°.
#[cold]
#[inline(never)]
fn spread<S: Scalar>(u: [S; 2], v: [S; 2], direction: Direction) -> [S; 2] {
    let (mut u, mut v) = (unit(u), unit(v));
    if u == [S::ZERO; 2] {
        // Both are null of a net that is a loop, or a point: any two lines will do.
        u = if v == [S::ZERO; 2] { [S::ONE, S::ZERO] } else { turned(v) };
    }
    if v == [S::ZERO; 2] {
        v = turned(u);
    }
    let (dot, cross) = (u[0] * v[0] + u[1] * v[1], u[0] * v[1] - u[1] * v[0]);
    if dot.abs() > S::HALF {
        let sign = if dot < S::ZERO { -S::ONE } else { S::ONE };
        let mean = unit([u[0] + v[0] * sign, u[1] + v[1] * sign]);
        let (cos, sin) = (S::from_f64(0.866_025_403_784_438_6), S::HALF);
        // Each stays on its side of the mean.
        let sin = if cross * sign < S::ZERO { -sin } else { sin };
        let at = |sin: S| [mean[0] * cos - mean[1] * sin, mean[1] * cos + mean[0] * sin];
        (u, v) = (at(-sin), at(sin));
    }
    turned(match direction {
        Direction::U => v,
        Direction::V => u,
    })
}

/// The vector's direction; zero for zero.
fn unit<S: Scalar>([x, y]: [S; 2]) -> [S; 2] {
    let largest = x.abs().greater(y.abs());
    if !(largest > S::ZERO) {
        return [S::ZERO; 2];
    }
    let [x, y] = [x / largest, y / largest];
    let length = (x * x + y * y).sqrt();
    [x / length, y / length]
}

/// The vector turned by 90°.
#[inline(always)]
fn turned<S: Scalar>([x, y]: [S; 2]) -> [S; 2] {
    [-y, x]
}

#[inline(always)]
fn position<F: Flat>(point: F) -> [F::Scalar; 2] {
    let weight = point.weight();
    point.f_g().map(|c| c / weight)
}

/// Clips the interval of one parameter of a projected net.
///
/// A clip is wider than the hull's by what rounding may have done, so no root is lost to rounding.
#[inline(always)]
pub(crate) fn clip<F: Flat>(
    degrees: Degrees,
    net: &[F],
    direction: Direction,
    normal: [F::Scalar; 2],
    noise: &Noise<F::Scalar>,
) -> Clip<F::Scalar> {
    // As in evaluation, the shapes of nearly all models are unrolled.
    if let (Degrees { u: 3, v: 3 }, Ok(net)) = (degrees, <&[F; 16]>::try_from(net)) {
        return hull_at_zero(&extents::<F, 4, 16>(net, direction, normal), normal, noise);
    }
    if let (Degrees { u: 2, v: 2 }, Ok(net)) = (degrees, <&[F; 9]>::try_from(net)) {
        return hull_at_zero(&extents::<F, 3, 9>(net, direction, normal), normal, noise);
    }
    clip_any_degree(degrees, net, direction, normal, noise)
}

#[inline(never)]
fn clip_any_degree<F: Flat>(
    degrees: Degrees,
    net: &[F],
    direction: Direction,
    normal: [F::Scalar; 2],
    noise: &Noise<F::Scalar>,
) -> Clip<F::Scalar> {
    let mut all = [[F::Scalar::INFINITY, F::Scalar::LEAST]; MAX_DEGREE + 1];
    let order = match direction {
        Direction::U => degrees.rows(),
        Direction::V => degrees.columns(),
    };
    let Some(extents) = all.get_mut(..order) else {
        return Clip::Settled;
    };
    for (i, row) in net.chunks_exact(degrees.columns()).enumerate() {
        for (j, &point) in row.iter().enumerate() {
            let along = match direction {
                Direction::U => i,
                Direction::V => j,
            };
            if let Some(extent) = extents.get_mut(along) {
                let distance = distance(point, normal);
                *extent = [extent[0].lesser(distance), extent[1].greater(distance)];
            }
        }
    }
    hull_at_zero(extents, normal, noise)
}

/// For each index in one direction the least and the largest distance of the net's points; `N` is `ORDER²`.
#[inline(always)]
fn extents<F: Flat, const ORDER: usize, const N: usize>(
    net: &[F; N],
    direction: Direction,
    normal: [F::Scalar; 2],
) -> [[F::Scalar; 2]; ORDER] {
    const { assert!(ORDER * ORDER == N) }
    let mut distances = [F::Scalar::ZERO; N];
    for k in 0..N {
        distances[k] = distance(net[k], normal);
    }
    match direction {
        Direction::U => extents_of::<F::Scalar, ORDER, N>(&distances, |k, i| k * ORDER + i),
        Direction::V => extents_of::<F::Scalar, ORDER, N>(&distances, |k, i| i * ORDER + k),
    }
}

#[inline(always)]
fn extents_of<S: Scalar, const ORDER: usize, const N: usize>(
    distances: &[S; N],
    at: impl Fn(usize, usize) -> usize,
) -> [[S; 2]; ORDER] {
    let mut extents = [[S::ZERO; 2]; ORDER];
    for k in 0..ORDER {
        let [mut low, mut high] = [distances[at(k, 0)]; 2];
        for i in 1..ORDER {
            let distance = distances[at(k, i)];
            (low, high) = (low.lesser(distance), high.greater(distance));
        }
        extents[k] = [low, high];
    }
    extents
}

/// Signed distance from a line through the ray with this normal, times the normal's length and the point's weight.
#[inline(always)]
fn distance<F: Flat>(point: F, normal: [F::Scalar; 2]) -> F::Scalar {
    let [f, g] = point.f_g();
    f * normal[0] + g * normal[1]
}

/// Where the convex hull of the points (k / degree, `extents[k]`) meets zero.
#[inline(always)]
fn hull_at_zero<S: Scalar>(extents: &[[S; 2]], normal: [S; 2], noise: &Noise<S>) -> Clip<S> {
    let [a, b] = normal.map(S::abs);
    let error = noise.error * (a + b);
    let all = extents.iter().fold([S::INFINITY, S::LEAST], |all, e| [all[0].lesser(e[0]), all[1].greater(e[1])]);
    // Nothing only if it is separated from zero by more than rounding. A NaN clips nothing.
    if all[0] > error || all[1] < -error {
        return Clip::Nothing;
    }
    if all[1] - all[0] <= noise.tolerance * a.greater(b) + error * S::from_u32(4) {
        return Clip::Settled;
    }
    let last = extents.len().saturating_sub(1);
    let degree = S::from_u32(last as u32);
    let from = crossing(extents.iter(), error) / degree;
    let to = crossing(extents.iter().rev(), error) / degree;
    // A few roundings went into each.
    let slack = S::EPSILON * S::from_u32(4);
    let (from, to) = (from - slack, S::ONE - (to - slack));
    let (from, to) = (S::ZERO.greater(from), S::ONE.lesser(to));
    if from < to { Clip::Part([from, to]) } else { Clip::Part([S::ZERO, S::ONE]) }
}

/// The first abscissa, counted from 0 by control points, where the hull of widened extents meets zero; 0 if the first one
/// does.
#[inline(always)]
fn crossing<'e, S: Scalar>(extents: impl Iterator<Item = &'e [S; 2]> + Clone, error: S) -> S {
    let Some(&[low, high]) = extents.clone().next() else {
        return S::ZERO;
    };
    let (low, high) = (low - error, high + error);
    if !(low > S::ZERO || high < S::ZERO) {
        return S::ZERO;
    }
    let above = low > S::ZERO;
    let heights = extents.map(|&[low, high]| if above { low - error } else { -high - error });
    // Each pair of a point above and a later one not above is a chord of the hull; the first crossing of any is the hull's.
    // As a fraction, whose parts are positive, so that comparing needs no division.
    let [mut numerator, mut denominator] = [S::ONE, S::ZERO];
    let mut i = S::ZERO;
    let mut rest = heights;
    while let Some(a) = rest.next() {
        if !(a > S::ZERO) {
            break;
        }
        let mut k = i;
        for b in rest.clone() {
            k += S::ONE;
            if b <= S::ZERO {
                let (crossed, height) = (k * a - i * b, a - b);
                if crossed * denominator < numerator * height {
                    (numerator, denominator) = (crossed, height);
                }
            }
        }
        i += S::ONE;
    }
    if denominator > S::ZERO { numerator / denominator } else { S::ZERO }
}

#[cfg(test)]
mod tests;
