//! The two planes of a ray, in the scene's frame.
//!
//! A ray is the intersection of two planes; a point's signed distances to them are its two coordinates in the system that
//! Newton's method and Bézier clipping solve. The paper takes two orthogonal planes; ours are sheared (a departure): both
//! contain the axis along which the ray is steepest, so that projecting costs two products instead of six. The distance
//! √(f² + g²) so measured is at least the point's true distance from the ray, and at most √3 times it.

use crate::bernstein::{BasisView, Full, Jet, Linear, Tuple};
use crate::point::{Flat, Point};
use crate::ray::{Axis, Interval};
use crate::scalar::Scalar;
use crate::surface::Net;
use heapless::vec::VecView;

/// A stretch of a ray by depth: distance from the moved origin along the ray's steepest axis, in the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthRange<S> {
    /// The nearest depth.
    pub min: S,
    /// The farthest depth.
    pub max: S,
}

/// A ray as its two planes, with the origin moved into the scene's box.
#[derive(Clone, Copy, Debug)]
pub struct Planes<S> {
    /// The steepest axis and the two others.
    axes: [Axis; 3],
    /// How much the two other coordinates grow per unit of the steepest one; within [−1, 1].
    slopes: [S; 2],
    origin: [S; 3],
    /// The origin in the order of `axes`: kept so because reordering it per point would go through memory.
    ordered: [S; 3],
    /// What the two planes, and depth, make of the origin; for a box's three vectors 0, which is subtracted as well: four
    /// equal operations cost vector units less than one that differs.
    constants: [[S; 4]; 3],
    /// ±1: the direction along the steepest axis, per unit of depth.
    forward: S,
    direction: [S; 3],
    inverse: [S; 3],
    t_origin: S,
    t_per_depth: S,
    interval: Interval<S>,
    /// Bounds all coordinates: 1 in the frame, 2 where it is turned.
    reach: S,
}

/// The place of the centre among a box's four numbers of an axis, the others being its three vectors'.
pub(crate) const CENTRE: usize = 2;

/// A box's three vectors and its centre in the two planes' system, side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns<S> {
    pub(crate) f: [S; 4],
    pub(crate) g: [S; 4],
    pub(crate) depth: [S; 4],
}

/// What a ray's planes make of a vector or a point: its coordinates f and g in the two planes' system, and its depth.
#[derive(Clone, Copy, Debug)]
pub struct Projected<S> {
    /// Signed distance to the first plane, along the first of the two flatter axes.
    pub f: S,
    /// Signed distance to the second plane.
    pub g: S,
    /// Depth (of a vector: difference in depth).
    pub depth: S,
}

impl<S: Scalar> Planes<S> {
    /// From the parts that [`Frame::enter`](crate::frame::Frame::enter) has.
    #[inline(always)]
    pub(crate) fn new(
        axis: Axis,
        origin: [S; 3],
        direction: [S; 3],
        inverse: [S; 3],
        t_origin: S,
        t_per_depth: S,
        interval: Interval<S>,
    ) -> Self {
        let (first, second) = axis.others();
        let forward = axis.of(&direction);
        let slopes = [first.of(&direction) * forward, second.of(&direction) * forward];
        let ordered = [axis.of(&origin), first.of(&origin), second.of(&origin)];
        let mut constants = [[S::ZERO; 4]; 3];
        constants[0][CENTRE] = ordered[1] - slopes[0] * ordered[0];
        constants[1][CENTRE] = ordered[2] - slopes[1] * ordered[0];
        constants[2][CENTRE] = ordered[0] * forward;
        Planes {
            constants,
            axes: [axis, first, second],
            slopes,
            origin,
            ordered,
            forward,
            direction,
            inverse,
            t_origin,
            t_per_depth,
            interval,
            reach: S::ONE,
        }
    }

    /// Of a ray of a view: steepest along the third axis, which it goes forward. It has no use for inverses.
    #[inline(always)]
    pub(crate) fn turned(
        origin: [S; 3],
        direction: [S; 3],
        t_origin: S,
        t_per_depth: S,
        interval: Interval<S>,
    ) -> Self {
        let planes = Planes::new(Axis::Z, origin, direction, [S::ZERO; 3], t_origin, t_per_depth, interval);
        Planes { reach: S::TWO, ..planes }
    }

    /// The same where coordinates are bounded by `reach`.
    #[inline(always)]
    pub(crate) fn with_reach(self, reach: S) -> Self {
        Planes { reach, ..self }
    }

    /// What a depth of the same ray's other planes, which count from elsewhere, is here: at least, whatever is rounded. What is
    /// infinite stays.
    #[inline(always)]
    pub(crate) fn depth_from(&self, other: &Self, depth: S) -> S {
        if !depth.is_finite() {
            return depth;
        }
        let (t, offset) = (other.t(depth), other.t_origin.abs() + self.t_origin.abs());
        (t - self.t_origin + (t.abs() + offset) * (S::EPSILON * S::from_u32(4))) / self.t_per_depth
    }

    /// The moved origin, in the frame: where depth is 0.
    pub fn origin(&self) -> [S; 3] {
        self.origin
    }

    /// What one unit of depth adds to a point, in the frame; ±1 along the steepest axis.
    pub fn direction(&self) -> [S; 3] {
        self.direction
    }

    /// The ray's point at a depth, in the frame.
    #[inline(always)]
    pub fn at(&self, depth: S) -> [S; 3] {
        core::array::from_fn(|k| self.origin[k] + self.direction[k] * depth)
    }

    /// A bound of the coordinates' sizes.
    pub(crate) fn reach(&self) -> S {
        self.reach
    }

    /// Distances from the ray up to this are rounding of a few sums.
    #[inline(always)]
    pub(crate) fn noise(&self) -> S {
        S::EPSILON * S::TWO * self.reach
    }

    /// 1 / direction, component by component; infinite where the direction is 0.
    pub fn inverse(&self) -> [S; 3] {
        self.inverse
    }

    /// A vector in the two planes' system.
    #[inline(always)]
    pub fn vector(&self, vector: &[S; 3]) -> Projected<S> {
        let [steep, first, second] = self.axes;
        self.shear(steep.of(vector), first.of(vector), second.of(vector))
    }

    /// A point of the frame in the two planes' system: (0, 0) on the ray.
    #[inline(always)]
    pub fn point(&self, point: &[S; 3]) -> Projected<S> {
        let [steep, first, second] = self.axes;
        let [o, o1, o2] = self.ordered;
        self.shear(steep.of(point) - o, first.of(point) - o1, second.of(point) - o2)
    }

    /// A box's three vectors and its centre at once, given by their components along each axis.
    ///
    /// The origin enters as one constant per plane, rounded once more than in [`Planes::point`].
    #[inline(always)]
    pub(crate) fn columns(&self, axes: &[[S; 4]; 3]) -> Columns<S> {
        let [steep, first, second] = self.axes.map(|axis| &axes[axis as usize]);
        let [slope1, slope2] = self.slopes;
        let [c1, c2, c3] = &self.constants;
        Columns {
            f: core::array::from_fn(|k| first[k] - slope1 * steep[k] - c1[k]),
            g: core::array::from_fn(|k| second[k] - slope2 * steep[k] - c2[k]),
            depth: core::array::from_fn(|k| steep[k] * self.forward - c3[k]),
        }
    }

    /// A control point or a sum of them, times its weight (1 for a plain one): f, g and depth are multiplied by it too.
    #[inline(always)]
    pub fn weighted<P: Point<Scalar = S>>(&self, point: P) -> Projected<S> {
        if !P::RATIONAL {
            return self.point(&point.weighted_position());
        }
        let [steep, first, second] = self.axes;
        let ([o, o1, o2], w) = (self.ordered, point.weight());
        let p = point.weighted_position();
        self.shear(steep.of(&p) - o * w, first.of(&p) - o1 * w, second.of(&p) - o2 * w)
    }

    /// The depth of the point at (u, v) of a net.
    #[inline(always)]
    pub(crate) fn depth_on<P: Point<Scalar = S>>(
        &self,
        net: &Net<'_, P>,
        at: [P::Parameter; 2],
        basis: &mut BasisView<'_, S>,
    ) -> Result<S, Full> {
        let place = match self.axes[0] {
            Axis::X => place_on::<P, 0>(net, at, basis),
            Axis::Y => place_on::<P, 1>(net, at, basis),
            Axis::Z => place_on::<P, 2>(net, at, basis),
        }?;
        Ok((place - self.ordered[0]) * self.forward)
    }

    /// The derivatives in u and v of the depth of a net's point.
    pub(crate) fn depth_derivatives<P: Point<Scalar = S>>(
        &self,
        net: &Net<'_, P>,
        at: [P::Parameter; 2],
        basis: &mut BasisView<'_, S>,
    ) -> Result<[S; 2], Full> {
        let [steep, ..] = self.axes;
        let Jet { point, du, dv } = net.jet_at(at, basis)?;
        let (place, forward) = (steep.of(&point.position()), self.forward / point.weight());
        let along = |d: P, weight: S| (steep.of(&d.weighted_position()) - place * weight) * forward;
        // Of a plain point the weight is constant, and its derivative 0.
        let weight = |d: P| if P::RATIONAL { d.weight() } else { S::ZERO };
        Ok([along(du, weight(du)), along(dv, weight(dv))])
    }

    #[inline(always)]
    fn shear(&self, along: S, first: S, second: S) -> Projected<S> {
        let [slope1, slope2] = self.slopes;
        Projected { f: first - slope1 * along, g: second - slope2 * along, depth: along * self.forward }
    }

    /// The caller's t at a depth.
    #[inline(always)]
    pub fn t(&self, depth: S) -> S {
        self.t_origin + depth * self.t_per_depth
    }

    /// How much t grows over a stretch of depth.
    #[inline(always)]
    pub(crate) fn time(&self, stretch: S) -> S {
        stretch * self.t_per_depth
    }

    /// Whether a depth lies before the caller's interval.
    #[inline(always)]
    pub fn is_before_interval(&self, depth: S) -> bool {
        self.t(depth) < self.interval.min
    }

    /// The caller's t at a depth, if it lies in the caller's interval.
    #[inline(always)]
    pub fn t_in_interval(&self, depth: S) -> Option<S> {
        let t = self.t(depth);
        if self.interval.min <= t && t <= self.interval.max { Some(t) } else { None }
    }
}

/// The coordinate along an axis of the point at (u, v) of a net.
#[inline(never)]
fn place_on<P: Point, const AXIS: usize>(
    net: &Net<'_, P>,
    at: [P::Parameter; 2],
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<P::Scalar, Full> {
    let along = |p: P| p.weighted_position()[AXIS];
    if P::RATIONAL {
        let Tuple([place, weight]) = net.value_of(at, basis, |p| Tuple([along(p), p.weight()]))?;
        Ok(place / weight)
    } else {
        let Tuple([place]) = net.value_of(at, basis, |p| Tuple([along(p)]))?;
        Ok(place)
    }
}

/// The net of a surface projected on a ray's planes, into the front of `out`, which grows to hold it: what Newton's method
/// and Bézier clipping solve on.
#[inline]
pub fn project_net<'o, P: Point>(
    net: &Net<'_, P>,
    planes: &Planes<P::Scalar>,
    out: &'o mut VecView<P::Flat>,
) -> Result<&'o [P::Flat], Full> {
    let points = net.points();
    if out.len() < points.len() {
        out.resize(points.len(), P::Flat::ZERO).map_err(|_| Full)?;
    }
    let out = out.get_mut(..points.len()).ok_or(Full)?;
    // The axes' order is settled outside of the loop.
    match planes.axes[0] {
        Axis::X => project_along::<P, 0>(points, planes, out),
        Axis::Y => project_along::<P, 1>(points, planes, out),
        Axis::Z => project_along::<P, 2>(points, planes, out),
    }
    Ok(out)
}

#[inline(never)]
fn project_along<P: Point, const AXIS: usize>(points: &[P], planes: &Planes<P::Scalar>, out: &mut [P::Flat]) {
    let ([o, o1, o2], [slope1, slope2]) = (planes.ordered, planes.slopes);
    for (slot, &point) in out.iter_mut().zip(points) {
        let (p, w) = (point.weighted_position(), point.weight());
        let [along, first, second] = [p[AXIS], p[(AXIS + 1) % 3], p[(AXIS + 2) % 3]];
        let [along, first, second] = if P::RATIONAL {
            [along - o * w, first - o1 * w, second - o2 * w]
        } else {
            [along - o, first - o1, second - o2]
        };
        *slot = P::Flat::new(first - slope1 * along, second - slope2 * along, w);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Aabb, Frame};
    use crate::point::{Plain, Weighted};

    #[test]
    fn points_of_the_ray_project_to_zero_whatever_the_steepest_axis() {
        let frame = Frame::new(Aabb { low: [-0.75; 3], high: [0.75; 3] });
        for direction in [[3.0, 1.0, -2.0], [1.0, -3.0, 2.0], [-1.0, 2.0, -3.0], [0.0, 0.0, 1.0]] {
            let ray = frame.ray([0.125, -0.25, 0.0625], direction).unwrap();
            let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
            for t in [0.0, 0.0625, 0.125] {
                let p = planes.point(&ray.at(t));
                assert!(p.f.abs() + p.g.abs() < 1e-15, "{p:?}");
                assert!((planes.t(p.depth) - t).abs() < 1e-15);
            }
            // A weight multiplies all three, and its point stays on the ray.
            let w = planes.weighted(Weighted::new(ray.at(0.125), 4.0));
            assert!(w.f.abs() + w.g.abs() < 1e-14 && (planes.t(w.depth / 4.0) - 0.125).abs() < 1e-15);
            let mut out = heapless::Vec::<_, 4>::new();
            let points = [Plain(ray.at(0.125)); 4];
            let flat = project_net(&Net::new(1, 1, &points).unwrap(), &planes, &mut out).unwrap();
            assert!(flat.len() == 4 && flat.iter().all(|q| q.0.iter().all(|c| c.abs() < 1e-15)));
        }
    }

    #[test]
    fn the_sheared_distance_bounds_the_true_one() {
        let frame = Frame::new(Aabb { low: [-1.0_f64; 3], high: [1.0; 3] });
        let ray = frame.ray([0.0; 3], [1.0, 1.0, 1.0]).unwrap();
        let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
        for k in 0..100 {
            let angle = f64::from(k) * 0.0628;
            let (c, s) = (libm::cos(angle), libm::sin(angle));
            // A unit vector across the ray.
            let (a, b) = (libm::sqrt(0.5), libm::sqrt(1.0 / 6.0));
            let across = planes.vector(&[c * a + s * b, -c * a + s * b, -2.0 * s * b]);
            let sheared = libm::hypot(across.f, across.g);
            assert!((1.0 - 1e-12..=3.0_f64.sqrt() + 1e-12).contains(&sheared), "{sheared}");
        }
    }
}
