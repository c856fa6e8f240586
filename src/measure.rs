//! A piece of a surface, measured: how flat it is, its parallelogram, and the parallelepiped that encloses it.
//!
//! Source: W. Barth and W. Stürzlinger, "Efficient ray tracing for Bézier and B-spline surfaces", Computers & Graphics
//! 17(4), 1993. v1 and v2 are the means of opposite edges' chords, v3 their cross product. The box is centred on the
//! parallelogram in v1 and v2 and encloses all control points, so by the convex-hull property (weights > 0) it encloses the
//! piece; then it is padded against rounding.

use crate::domain::Domain;
use crate::patch::{Parallelepiped, Patch, SIDE_STEPS};
use crate::point::Point;
use crate::scalar::{Scalar, Vector3};
use crate::surface::{Net, SHEAR};

/// A departure: below this sine of the angle between v1 and v2 the shorter is replaced by one orthogonal to the longer. Padding a box
/// by ρ lengthens its edges by ρ over this sine, so smaller values make slivers fatter; larger ones spoil the starts on
/// sheared patches.
const LEAST_SINE: f64 = 0.05;

/// A net's piece, measured: what subdivision decides by, and what it stores.
#[derive(Clone, Copy, Debug)]
pub struct Measure<S> {
    /// The enclosing parallelepiped.
    pub bounds: Parallelepiped<S>,
    /// A bound of the distance between chord and surface along u, from second differences; of a rational net an estimate.
    pub bend_u: S,
    /// The same along v.
    pub bend_v: S,
    /// How far the corners are from a parallelogram's.
    pub twist: S,
    /// Lengths of v1 and v2.
    pub sides: [S; 2],
    stray: S,
    ratios: [S; 2],
}

impl<S: Scalar> Measure<S> {
    /// Measures a net: the control points of one piece of a surface, in the frame. `padding` is a length: by how much the
    /// box is larger than what it encloses, all around.
    pub fn of<P: Point<Scalar = S>>(net: &Net<'_, P>, padding: S) -> Self {
        let vector = |p: P| S::Vec3::from_array(p.position());
        let [p00, p10, p01, p11] = net.corners().map(vector);
        let centre = (p00 + p10 + p01 + p11) * S::from_f64(0.25);
        let v1 = (p10 - p00 + (p11 - p01)) * S::HALF;
        let v2 = (p01 - p00 + (p11 - p10)) * S::HALF;
        let (f1, f2, n, skewed) = edges(v1, v2);
        // Coordinates along f1 and f2 by the dual basis; n is a unit vector across both.
        let (across1, across2) = (f2.cross(n), n.cross(f1));
        let (dual1, dual2) = (across1 * (S::ONE / f1.dot(across1)), across2 * (S::ONE / f2.dot(across2)));
        let [mut a1, mut a2] = [S::ZERO; 2];
        let (mut low, mut high) = (S::INFINITY, -S::INFINITY);
        for &p in net.points() {
            let q = vector(p) - centre;
            a1 = a1.greater(q.dot(dual1).abs());
            a2 = a2.greater(q.dot(dual2).abs());
            let height = q.dot(n);
            low = low.lesser(height);
            high = high.greater(height);
        }
        // The padding is measured across the sides, so along a skew edge it is longer: |dual| is 1 / (distance of sides).
        let (a1, a2) = (a1 + padding * dual1.length(), a2 + padding * dual2.length());
        let (middle, thickness) = ((low + high) * S::HALF, (high - low) * S::HALF + padding);
        let (bend_u, bend_v) = bends(net);
        Measure {
            bounds: Parallelepiped::new(centre + n * middle, [f1 * a1, f2 * a2, n * thickness]),
            bend_u,
            bend_v,
            twist: (p00 - p10 - p01 + p11).length() * S::from_f64(0.25),
            sides: [v1.length(), v2.length()],
            // Sides of the parallelogram are v, those of the box 2 a f.
            ratios: [a1 + a1, a2 + a2],
            stray: if skewed || P::RATIONAL {
                S::INFINITY
            } else {
                stray(net, v1, v2) * a1.greater(a2) * S::from_f64(SHEAR)
            },
        }
    }

    /// The patch over `domain`.
    pub fn patch(&self, domain: Domain) -> Patch<S> {
        let steps = S::from_u32(SIDE_STEPS);
        let sides = self.ratios.map(|ratio| (ratio * steps).to_u32().min(u32::from(u16::MAX)) as u16);
        Patch { bounds: self.bounds, stray: self.stray, sides, domain }
    }
}

/// The directions of the box's edges: v1 and v2, unless they are too short or too nearly parallel, their unit normal, and
/// whether one was replaced.
fn edges<V: Vector3>(v1: V, v2: V) -> (V, V, V, bool) {
    let (l1, l2) = (v1.length(), v2.length());
    let n = v1.unit().cross(v2.unit());
    if n.length() >= V::Scalar::from_f64(LEAST_SINE) {
        return (v1, v2, n.unit(), false);
    }
    // Of a point, of a line, of a sliver: the longer edge stays, or an axis if there is none.
    let axis =
        |k: usize| V::from_array(core::array::from_fn(|i| if i == k { V::Scalar::ONE } else { V::Scalar::ZERO }));
    let longer = if l1 >= l2 { v1 } else { v2 };
    let longer = if longer.length() > V::Scalar::ZERO { longer } else { axis(0) };
    let along = longer.unit();
    let shorter = if l1 >= l2 { v2 } else { v1 };
    let rest = shorter - along * along.dot(shorter);
    // What is left of a parallel edge may be all rounding; then the axis most across will do.
    let [x, y, z] = along.abs().to_array();
    let across = axis(if x <= y && x <= z {
        0
    } else if y <= z {
        1
    } else {
        2
    });
    let trusted = rest.length() > longer.length() * V::Scalar::from_f64(1e-3);
    let rest = if trusted { rest.unit() } else { (across - along * along.dot(across)).unit() };
    let rest = rest * longer.length();
    let (f1, f2) = if l1 >= l2 { (longer, rest) } else { (rest, longer) };
    (f1, f2, f1.unit().cross(f2.unit()).unit(), true)
}

/// Bounds of the deviation from the chord in u and in v: n (n − 1)/8 times the largest second difference.
fn bends<P: Point>(net: &Net<'_, P>) -> (P::Scalar, P::Scalar) {
    let columns = net.degree_v() + 1;
    let along_v = net.rows().fold(P::Scalar::ZERO, |most, row| most.greater(second_difference(row, 1)));
    let factor = |degree: usize| P::Scalar::from_u32((degree * (degree - 1)) as u32) * P::Scalar::from_f64(0.125);
    (second_difference(net.points(), columns) * factor(net.degree_u()), along_v * factor(net.degree_v()))
}

/// The longest second difference of points `stride` apart.
fn second_difference<P: Point>(points: &[P], stride: usize) -> P::Scalar {
    let later = |steps: usize| points.iter().skip(steps * stride).map(|p| V::<P>::from_array(p.position()));
    let triples = later(0).zip(later(1)).zip(later(2));
    triples.fold(P::Scalar::ZERO, |most, ((a, b), c)| most.greater((a - b * P::Scalar::TWO + c).length()))
}

/// A bound of |S_u − v1| + |S_v − v2| over a polynomial piece, parameters counted across the piece.
fn stray<P: Point>(net: &Net<'_, P>, v1: V<P>, v2: V<P>) -> P::Scalar {
    let (n, m) = (P::Scalar::from_u32(net.degree_u() as u32), P::Scalar::from_u32(net.degree_v() as u32));
    let along_v = net.rows().fold(P::Scalar::ZERO, |most, row| most.greater(first_difference(row, 1, m, v2)));
    first_difference(net.points(), net.degree_v() + 1, n, v1) + along_v
}

/// The most by which `factor` times a difference of points `stride` apart is off `mean`.
fn first_difference<P: Point>(points: &[P], stride: usize, factor: P::Scalar, mean: V<P>) -> P::Scalar {
    let later = |steps: usize| points.iter().skip(steps * stride).map(|p| V::<P>::from_array(p.position()));
    later(0).zip(later(1)).fold(P::Scalar::ZERO, |most, (a, b)| most.greater(((b - a) * factor - mean).length()))
}

type V<P> = <<P as Point>::Scalar as Scalar>::Vec3;

#[cfg(test)]
mod tests;
