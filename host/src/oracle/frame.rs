//! The frame of one ray: its origin moved near the model, two unit normals and its own unit direction.
//!
//! A point's first two coordinates in this frame are its signed distances from two orthogonal planes that contain the
//! ray (T. Nishita, T. W. Sederberg, M. Kakimoto, "Ray tracing trimmed rational surface patches", 1990, section 2); the
//! third is its depth, a length along the ray.

use super::net::Point;
use super::real::Real;

/// A ray's frame.
#[derive(Clone, Debug)]
pub(super) struct Frame<R> {
    /// The ray's origin and direction as given.
    ray: [[f64; 3]; 2],
    /// The frame's origin: the ray's point nearest to a centre, as far as numbers can state it.
    origin: [R; 3],
    /// What that point may be off by, apart from the rounding of its coordinates.
    slip: f64,
    /// The ray's parameter at that point.
    shift: R,
    /// The depth of the frame's origin in the frame that this one was moved from; 0 of one that was not.
    start: R,
    /// The length of the ray's direction.
    length: R,
    /// The normals of the two planes and the ray's direction, all of length 1.
    axes: [[R; 3]; 3],
}

fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit<R: Real>(a: [R; 3]) -> [R; 3] {
    R::over(a, dot(a, a).sqrt())
}

impl<R: Real> Frame<R> {
    /// The frame of the ray `origin + t direction`, for what lies about `centre`; `None` if a number is not finite, the
    /// direction is zero, or the parameter of the point nearest to `centre` is beyond all numbers.
    pub(super) fn new(origin: [f64; 3], direction: [f64; 3], centre: [R; 3]) -> Option<Frame<R>> {
        let largest = direction.iter().fold(0.0, |m: f64, x| if x.abs() > m { x.abs() } else { m });
        if !(origin.iter().chain(&direction).all(|x| x.is_finite()) && largest > 0.0) {
            return None;
        }
        let scaled = R::over(direction.map(R::new), R::new(largest));
        let along = unit(scaled);
        let length = dot(scaled, scaled).sqrt().times(largest);
        let mut least = 0;
        for k in 1..3 {
            if along[k].abs() < along[least].abs() {
                least = k;
            }
        }
        let mut axis = [R::ZERO; 3];
        axis[least] = R::ONE;
        let first = unit(cross(axis, along));
        let axes = [first, cross(along, first), along];
        let ray = [origin, direction];
        let unmoved =
            Frame { ray, origin: origin.map(R::new), slip: 0.0, shift: R::ZERO, start: R::ZERO, length, axes };
        unmoved.about(centre).map(|frame| Frame { start: R::ZERO, ..frame })
    }

    /// The same ray's frame for what lies about another `centre`; `None` as of [`Frame::new`].
    ///
    /// Of a small surface far from the middle of its model, points in the model's frame would be rounded to the model's size.
    pub(super) fn about(&self, centre: [R; 3]) -> Option<Frame<R>> {
        let [origin, direction] = self.ray;
        let to_centre = [0, 1, 2].map(|k| centre[k] - R::new(origin[k]));
        let distance = dot(to_centre, self.axes[2]);
        let shift = distance / self.length;
        let moved = [0, 1, 2].map(|k| shift.on_ray(origin[k], direction[k]));
        let valid = self.length.is_finite() && shift.is_finite() && moved.iter().all(|x| x.is_finite());
        valid.then(|| Frame {
            origin: moved,
            slip: R::SLIP * distance.to_f64().abs(),
            shift,
            start: (shift - self.shift) * self.length,
            ..self.clone()
        })
    }

    /// The depth of the frame's origin in the frame that it was moved from.
    pub(super) fn start(&self) -> R {
        self.start
    }

    /// The ray's unit direction in the model's coordinates.
    pub(super) fn direction(&self) -> [R; 3] {
        self.axes[2]
    }

    /// The ray's parameter at a depth.
    pub(super) fn parameter(&self, depth: R) -> R {
        self.shift + depth / self.length
    }

    /// The depth at a parameter of the ray; infinite parameters have infinite depths.
    pub(super) fn depth(&self, t: f64) -> R {
        if t.is_infinite() { R::new(t) } else { (R::new(t) - self.shift) * self.length }
    }

    /// A control point `[x, y, z, w]` in the frame, homogeneous.
    pub(super) fn project(&self, point: Point<R>) -> Point<R> {
        let offset = [0, 1, 2].map(|k| point[k] - self.origin[k]);
        let [a, b, c] = self.axes.map(|axis| dot(axis, offset) * point[3]);
        [a, b, c, point[3]]
    }

    /// A bounding box in the frame: its centre there and half its extent along each axis.
    pub(super) fn project_box(&self, centre: [R; 3], half: [R; 3]) -> ([R; 3], [R; 3]) {
        let offset = [0, 1, 2].map(|k| centre[k] - self.origin[k]);
        (self.axes.map(|axis| dot(axis, offset)), self.axes.map(|axis| dot(axis.map(R::abs), half)))
    }

    /// A bound on the error of a projected point, per unit of weight, for points within `reach` of the frame's origin:
    /// 3 roundings of a scalar product, 1 of the difference, 1 of the weight, 5 of the axes, and the moved origin's own.
    pub(super) fn error(&self, reach: f64) -> f64 {
        R::EPS * (6.0 * reach + dot(self.origin, self.origin).sqrt().to_f64()) + self.slip
    }
}

#[cfg(test)]
mod tests {
    use super::super::real::DoubleDouble;
    use super::*;

    #[test]
    fn a_point_on_the_ray_projects_to_zero_at_any_length_of_direction() {
        for scale in [1e-150, 1.0, 3e100] {
            let d = [0.25 * scale, -1.5 * scale, 0.75 * scale];
            let frame = Frame::new([4.0, 20.0, -8.0], d, [1.0, 1.0, 1.0]).unwrap();
            // The ray's point at t = 12 / scale.
            let p = frame.project([7.0, 2.0, 1.0, 1.0]);
            assert!(p[0].abs() < 1e-14 && p[1].abs() < 1e-14, "{p:?}");
            assert!((frame.parameter(p[2]) * scale - 12.0).abs() < 1e-13);
            assert!((frame.depth(12.0 / scale) - p[2]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_far_origin_costs_no_digits() {
        // The ray's points have exact coordinates, 1e12 away from the model.
        let t = 2f64.powi(40);
        let frame = Frame::new([1.0 - 3.0 * t, 2.0 + t, 3.0], [3.0, -1.0, 0.0], [1.0, 2.0, 3.0]).unwrap();
        let p = frame.project([1.0, 2.0, 3.0, 1.0]);
        assert!(p[0].abs() < 1e-15 && p[1].abs() < 1e-15, "{p:?}");
        assert!((frame.parameter(p[2]) - t).abs() <= 2.0 * f64::EPS * t);
    }

    #[test]
    fn what_is_no_ray_has_no_frame() {
        for (o, d) in [
            ([0.0; 3], [0.0; 3]),
            ([f64::NAN, 0.0, 0.0], [1.0; 3]),
            ([0.0; 3], [f64::INFINITY, 0.0, 0.0]),
            ([1e200, 0.0, 0.0], [1e-200, 0.0, 0.0]),
        ] {
            assert!(Frame::new(o, d, [0.0; 3]).is_none());
            assert!(Frame::new(o, d, [DoubleDouble::ZERO; 3]).is_none());
        }
    }
}
