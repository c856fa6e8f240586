//! B-splines and Bézier surfaces by their definitions, in `f64`: nothing here is taken from the kernel but its points.

use patchray::bspline::BSpline;
use patchray::pieces::Part;
use patchray::point::Point;
use patchray::scalar::Scalar;
use patchray::surface::{Direction, Net};

/// A homogeneous point.
pub(crate) type P4 = [f64; 4];

/// The homogeneous point that the kernel holds.
pub(crate) fn exact<P: Point>(point: &P) -> P4 {
    let [x, y, z] = point.weighted_position().map(Scalar::to_f64);
    [x, y, z, point.weight().to_f64()]
}

/// From `a` to `b` as `t` goes from 0 to 1, exact at both ends.
pub(crate) fn mixed(a: f64, b: f64, t: f64) -> f64 {
    if t == 1.0 { b } else { a + (b - a) * t }
}

/// The B-splines of a degree that do not vanish between two neighbouring knots, at the share `t` of the way from the one to
/// the other, and the number of the first: the recurrence of M. G. Cox and C. de Boor, in the form of L. Piegl and W. Tiller,
/// "The NURBS Book", section 2.5. By the share, since a parameter far from 0 has no digits left for a short span.
fn basis(knots: &[f64], degree: usize, [from, to]: [f64; 2], t: f64) -> (usize, Vec<f64>) {
    let ends = |k: &usize| knots[*k] == from && knots[k + 1] == to;
    let span = (degree..knots.len() - degree - 1).find(ends).expect("there is such a span");
    let mut values = vec![1.0];
    for p in 1..=degree {
        let mut next = vec![0.0; p + 1];
        for (r, value) in values.iter().enumerate() {
            let (left, right) = (knots[span + 1 + r - p], knots[span + 1 + r]);
            next[r] += value * (((right - to) + (to - from) * (1.0 - t)) / (right - left));
            next[r + 1] += value * (((from - left) + (to - from) * t) / (right - left));
        }
        values = next;
    }
    (span - degree, values)
}

/// The homogeneous point of a B-spline at the shares (s, t) of the way through a part of it, from knot to knot.
pub(crate) fn blend<P: Point>(spline: &BSpline<'_, P>, part: &Part<f64>, [s, t]: [f64; 2]) -> P4 {
    let sides = [(Direction::U, part.u, s), (Direction::V, part.v, t)];
    let [(row, along_u), (column, along_v)] = sides.map(|(direction, ends, t)| {
        let knots: Vec<f64> = spline.knots(direction).iter().map(|knot| knot.to_f64()).collect();
        basis(&knots, spline.degree(direction), ends, t)
    });
    let stride = spline.size(Direction::V);
    let mut sum = [0.0; 4];
    for (i, a) in along_u.iter().enumerate() {
        for (j, b) in along_v.iter().enumerate() {
            let point = exact(&spline.points()[(row + i) * stride + column + j]);
            for k in 0..4 {
                sum[k] += a * b * point[k];
            }
        }
    }
    sum
}

/// The homogeneous point of a Bézier surface at (u, v), by de Casteljau's algorithm.
pub(crate) fn bezier<P: Point>(net: &Net<'_, P>, u: f64, v: f64) -> P4 {
    let line = |mut row: Vec<P4>, t: f64| {
        // Ends at one point, as each round leaves one less.
        while row.len() > 1 {
            row = row.windows(2).map(|pair| core::array::from_fn(|k| mixed(pair[0][k], pair[1][k], t))).collect();
        }
        row[0]
    };
    line(net.rows().map(|row| line(row.iter().map(exact).collect(), v)).collect(), u)
}
