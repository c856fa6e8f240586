//! One clip of Bézier clipping: how much of a parameter's interval can hold roots.
//!
//! The projected net's signed distances to a line through the ray are the coefficients of a polynomial in Bernstein form;
//! where the convex hull of its control polygon does not meet zero, neither does the surface meet the ray.
//!
//! Source: T. Nishita, T. W. Sederberg and M. Kakimoto, "Ray tracing trimmed rational surface patches", SIGGRAPH 1990. A
//! departure: the paper's clipping is corrected after Campagna, Slusallek and Seidel (1997), by a rule that the paper does not
//! state; here lines that are near parallel are spread instead, as by A. Efremov, V. Havran and H.-P. Seidel, "Robust and
//! numerically stable Bézier clipping method for ray tracing NURBS surfaces", SCCG 2005.

use crate::bernstein::{Degrees, Direction, MAX_DEGREE};
use crate::point::Flat;
use crate::reading::{Ours, Reading};
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

/// What rounding may have done to a projected net. Of a rational net each coefficient is off by that times its own weight: a bound
/// for the heaviest would drown what is light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise<S> {
    /// By how much each point may be off.
    pub error: S,
    /// How far the surface may pass from the ray and still count as meeting it.
    pub tolerance: S,
}

impl<S: Scalar> Noise<S> {
    /// By how much a point's distances to a line with this normal may be off.
    #[inline(always)]
    fn across(&self, normal: [S; 2]) -> S {
        let [a, b] = normal.map(S::abs);
        self.error * (a + b)
    }
}

/// The corners of a projected net: at (u, v) = (0, 0), (1, 0), (0, 1), (1, 1).
#[inline(always)]
pub(crate) fn corners<F: Flat>(degrees: Degrees, net: &[F]) -> [[F::Scalar; 2]; 4] {
    let columns = degrees.columns();
    let last = net.len().saturating_sub(columns);
    [0, last, columns - 1, last + columns - 1].map(|k| net.get(k).copied().unwrap_or(F::ZERO).position())
}

/// The sums of a net's two chords along u, and along v, from its corners.
#[inline(always)]
pub(crate) fn chords<S: Scalar>([p00, p10, p01, p11]: [[S; 2]; 4]) -> [[S; 2]; 2] {
    let chord = |a: [S; 2], b: [S; 2], c: [S; 2], d: [S; 2]| [b[0] - a[0] + (d[0] - c[0]), b[1] - a[1] + (d[1] - c[1])];
    [chord(p00, p10, p01, p11), chord(p00, p01, p10, p11)]
}

/// The normal of the line to which distances are taken when `direction` is clipped, of a projected net with these corners.
///
/// The lines are Nishita, Sederberg and Kakimoto's: L_u, for clipping u, along the net's mean chord in v, and L_v along that in
/// u, so that distances to L_u change with u and hardly with v.
#[inline(always)]
fn normal<F: Flat>(reading: impl Reading, corners: [[F::Scalar; 2]; 4], direction: Direction) -> [F::Scalar; 2] {
    let [u, v] = chords(corners);
    let dot = u[0] * v[0] + u[1] * v[1];
    let (uu, vv) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1]);
    // Lines that are all but parallel clip the same strip twice. Efremov, Havran and Seidel spread them from 60° on; but spread
    // lines no longer follow the chords, and clips then close in by a share instead of by squares: at 60° half of all
    // clips on the common teapot are of that kind, and a third of the time is lost. At 6° it is the other way round.
    // What is so small that digits vanish is looked at with care; and so are null chords.
    let square = uu * vv;
    let apart = !reading.spread_lines() || dot * dot <= F::Scalar::from_f64(PARALLEL) * square;
    if apart && square * F::Scalar::EPSILON > F::Scalar::MIN_POSITIVE {
        let [x, y] = turned(match direction {
            Direction::U => v,
            Direction::V => u,
        });
        // Of a light net what it is multiplied by could vanish.
        let inverse = if F::RATIONAL { F::Scalar::ONE / x.abs().greater(y.abs()) } else { F::Scalar::ONE };
        return [x * inverse, y * inverse];
    }
    spread(u, v, direction)
}

/// The square of the cosine from which on two chords are all but parallel: see [`normal`] for what it trades.
const PARALLEL: f64 = 0.99;

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
    if dot * dot > S::from_f64(PARALLEL) {
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
pub(crate) fn unit<S: Scalar>([x, y]: [S; 2]) -> [S; 2] {
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
pub(crate) fn turned<S: Scalar>([x, y]: [S; 2]) -> [S; 2] {
    [-y, x]
}

/// Clips the interval of one parameter of a projected net, (n + 1)(m + 1) points for degrees n × m, u outer.
///
/// A clip is wider than the hull's by what rounding may have done, so no root is lost to rounding.
#[inline(always)]
pub fn clip<F: Flat>(degrees: Degrees, net: &[F], direction: Direction, noise: &Noise<F::Scalar>) -> Clip<F::Scalar> {
    clip_by(Ours, degrees, net, direction, noise)
}

/// [`clip`] by another reading of the paper.
#[inline(always)]
pub(crate) fn clip_by<F: Flat>(
    reading: impl Reading,
    degrees: Degrees,
    net: &[F],
    direction: Direction,
    noise: &Noise<F::Scalar>,
) -> Clip<F::Scalar> {
    // As in evaluation, the shapes of nearly all models are unrolled.
    if let (Degrees { u: 3, v: 3 }, Ok(net)) = (degrees, <&[F; 16]>::try_from(net)) {
        return clip_unrolled::<F, 4, 16>(reading, net, direction, noise);
    }
    if let (Degrees { u: 2, v: 2 }, Ok(net)) = (degrees, <&[F; 9]>::try_from(net)) {
        return clip_unrolled::<F, 3, 9>(reading, net, direction, noise);
    }
    clip_any_degree(reading, degrees, net, direction, noise)
}

#[inline(never)]
fn clip_any_degree<F: Flat>(
    reading: impl Reading,
    degrees: Degrees,
    net: &[F],
    direction: Direction,
    noise: &Noise<F::Scalar>,
) -> Clip<F::Scalar> {
    let (rows, columns) = (degrees.rows(), degrees.columns());
    let normal = normal::<F>(reading, corners(degrees, net), direction);
    let mut extents = [[F::Scalar::INFINITY, F::Scalar::LEAST]; MAX_DEGREE + 1];
    let error = noise.across(normal);
    for (i, row) in net.chunks_exact(columns).enumerate() {
        for (j, &point) in row.iter().enumerate() {
            let along = match direction {
                Direction::U => i,
                Direction::V => j,
            };
            if let Some(extent) = extents.get_mut(along) {
                let [low, high] = distances(point, normal, error);
                *extent = [extent[0].lesser(low), extent[1].greater(high)];
            }
        }
    }
    let order = match direction {
        Direction::U => rows,
        Direction::V => columns,
    };
    hull_at_zero::<F, _>(&extents, order, normal, noise, net)
}

/// [`clip`] for an order known when compiling; `N` is `ORDER²`.
#[inline(always)]
fn clip_unrolled<F: Flat, const ORDER: usize, const N: usize>(
    reading: impl Reading,
    net: &[F; N],
    direction: Direction,
    noise: &Noise<F::Scalar>,
) -> Clip<F::Scalar> {
    const { assert!(ORDER * ORDER == N && ORDER > 1) }
    let normal = normal::<F>(reading, [net[0], net[N - ORDER], net[ORDER - 1], net[N - 1]].map(F::position), direction);
    let error = noise.across(normal);
    let mut all = [[F::Scalar::ZERO; 2]; N];
    for k in 0..N {
        all[k] = distances(net[k], normal, error);
    }
    let extents = match direction {
        Direction::U => extents::<F::Scalar, ORDER, N>(&all, |k, i| k * ORDER + i),
        Direction::V => extents::<F::Scalar, ORDER, N>(&all, |k, i| i * ORDER + k),
    };
    hull_at_zero::<F, _>(&extents, ORDER, normal, noise, net)
}

/// For each index in one direction the least and the largest distance.
#[inline(always)]
fn extents<S: Scalar, const ORDER: usize, const N: usize>(
    distances: &[[S; 2]; N],
    at: impl Fn(usize, usize) -> usize,
) -> [[S; 2]; ORDER] {
    let mut extents = [[S::ZERO; 2]; ORDER];
    for k in 0..ORDER {
        let [mut low, mut high] = distances[at(k, 0)];
        for i in 1..ORDER {
            let [least, largest] = distances[at(k, i)];
            (low, high) = (low.lesser(least), high.greater(largest));
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

/// The least and the largest that it may be, of a rational net: of others, whose errors are all alike, they are widened when
/// compared.
#[inline(always)]
fn distances<F: Flat>(point: F, normal: [F::Scalar; 2], error: F::Scalar) -> [F::Scalar; 2] {
    let (distance, off) = (distance(point, normal), if F::RATIONAL { error * point.weight() } else { F::Scalar::ZERO });
    if F::RATIONAL { [distance - off, distance + off] } else { [distance; 2] }
}

/// Where the convex hull of the points (k / (order − 1), `extents[k]`) meets zero; `order` is at most `N`.
#[inline(always)]
fn hull_at_zero<F: Flat, const N: usize>(
    extents: &[[F::Scalar; 2]; N],
    order: usize,
    normal: [F::Scalar; 2],
    noise: &Noise<F::Scalar>,
    net: &[F],
) -> Clip<F::Scalar> {
    let [a, b] = normal.map(F::Scalar::abs);
    let error = noise.across(normal);
    let tolerance = noise.tolerance * a.greater(b) + error * F::Scalar::TWO;
    // What widens the extents when they are compared.
    let error = if F::RATIONAL { F::Scalar::ZERO } else { error };
    let order = order.min(N);
    let [mut least, mut largest] = extents[0];
    for k in 1..order {
        let [low, high] = extents[k];
        (least, largest) = (least.lesser(low), largest.greater(high));
    }
    // Nothing only if it is separated from zero by more than rounding. A NaN clips nothing.
    if least > error || largest < -error {
        return Clip::Nothing;
    }
    let settled = if F::RATIONAL {
        // Of points, and not of coefficients, among which what is light would count for nothing.
        let within = |point: &F| distance(*point, normal).abs() <= tolerance * point.weight();
        net.iter().all(within)
    } else {
        largest - least <= tolerance
    };
    if settled {
        return Clip::Settled;
    }
    // An end that holds zero is not clipped.
    let last = order - 1;
    let degree = F::Scalar::from_u32(last as u32);
    // A few roundings went into each.
    let slack = F::Scalar::EPSILON * F::Scalar::from_u32(4);
    // No k is beyond `last`; said again, because where arithmetic is done by calls, closures may be left out of line, and then
    // this is not seen there.
    let forward = |k: usize| extents[k.min(N - 1)];
    let backward = |k: usize| extents[last.wrapping_sub(k).min(N - 1)];
    let from = clear::<F::Scalar, N>(order, forward, error).map_or(F::Scalar::ZERO, |at| at / degree - slack);
    let to = clear::<F::Scalar, N>(order, backward, error)
        .map_or(F::Scalar::ONE, |at| F::Scalar::ONE - (at / degree - slack));
    let (from, to) = (F::Scalar::ZERO.greater(from), F::Scalar::ONE.lesser(to));
    if from < to { Clip::Part([from, to]) } else { Clip::Part([F::Scalar::ZERO, F::Scalar::ONE]) }
}

/// How far from its end the hull is clear of zero, counted by control points; `None` if the first extent holds zero.
#[inline(always)]
fn clear<S: Scalar, const N: usize>(order: usize, extent: impl Fn(usize) -> [S; 2], error: S) -> Option<S> {
    let [low, high] = extent(0);
    if low > error {
        Some(crossing::<S, N>(order, |k| extent(k)[0] - error))
    } else if high < -error {
        Some(crossing::<S, N>(order, |k| -extent(k)[1] - error))
    } else {
        None
    }
}

/// The first abscissa, counted by control points, where the hull of heights, the first of them above zero, comes down to
/// zero.
#[inline(always)]
fn crossing<S: Scalar, const N: usize>(order: usize, height: impl Fn(usize) -> S) -> S {
    let mut heights = [S::ZERO; N];
    for k in 0..order {
        heights[k] = height(k);
    }
    // Each pair of a point above and a later one not above is a chord of the hull; the first crossing of any is the hull's.
    // Products of heights are not compared, for those of small surfaces with small weights vanish.
    let mut first = S::INFINITY;
    for i in 0..order {
        let a = heights[i];
        if !(a > S::ZERO) {
            break;
        }
        for k in i + 1..order {
            let b = heights[k];
            if b <= S::ZERO {
                let (crossed, drop) = (S::from_u32(k as u32) * a - S::from_u32(i as u32) * b, a - b);
                if crossed < first * drop {
                    first = crossed / drop;
                }
            }
        }
    }
    if first.is_finite() { first } else { S::ZERO }
}

#[cfg(test)]
mod tests;
