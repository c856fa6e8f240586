//! The way of a ray into the scene: its planes, from where it enters the scene's box.

use super::{Aabb, Frame, NEAR};
use crate::planes::{DepthRange, Planes};
use crate::ray::{Axis, Interval, Ray};
use crate::scalar::{Scalar, Vector3};

impl<S: Scalar> Frame<S> {
    /// The ray's two planes, with its origin moved to where the interval meets the scene's box, and the range of depths
    /// inside; `None` if they do not meet.
    #[inline(always)]
    pub fn enter(&self, ray: &Ray<S>, interval: &Interval<S>) -> Option<(Planes<S>, DepthRange<S>)> {
        let axis = ray.axis;
        let speed = axis.of(&ray.direction).abs();
        let direction = ray.direction.map(|c| c / speed);
        // Not from `direction`, so that neither division waits for the other.
        let inverse = ray.direction.map(|c| speed / c);
        let (mut origin, mut t_origin) = (self.relative(ray.origin), S::ZERO);
        if ray.far {
            (origin, t_origin) = self.approach(ray, axis)?;
        }
        let (near, far) = self.bounds.depths(&origin, &inverse)?;
        let start = near.greater((interval.min - t_origin) * speed);
        let end = far.lesser((interval.max - t_origin) * speed);
        if !(start <= end) {
            return None;
        }
        let origin = core::array::from_fn(|k| (origin[k] + direction[k] * start) * self.scale);
        let planes =
            Planes::new(axis, origin, direction, inverse, t_origin + start / speed, self.unscale / speed, *interval);
        Some((planes, DepthRange { min: S::ZERO, max: (end - start) * self.scale }))
    }

    /// The same for one surface whose coordinates, relative to its own origin, are much smaller than the scene's: the ray's origin
    /// is moved to where the ray passes the middle of the surface's box, which loses no digits to the way there. The planes are
    /// relative to `own`; `bounds` and `own` are given in the frame, and `reach` bounds the coordinates of the surface and of rays
    /// near it.
    #[cold]
    #[inline(never)]
    pub(crate) fn enter_near(
        &self,
        ray: &Ray<S>,
        interval: &Interval<S>,
        bounds: &Aabb<S>,
        own: [S; 3],
        reach: S,
    ) -> Option<(Planes<S>, DepthRange<S>)> {
        let axis = ray.axis;
        let speed = axis.of(&ray.direction).abs();
        let direction = ray.direction.map(|c| c / speed);
        let inverse = ray.direction.map(|c| speed / c);
        let bounds = bounds.relative(own);
        let middle = (axis.of(&bounds.low) + axis.of(&bounds.high)) * S::HALF * self.unscale;
        let (origin, t) = self.moved(ray, self.to_nets(own), axis, middle);
        let origin = origin.map(|c| c * self.scale);
        let (near, far) = bounds.depths(&origin, &inverse)?;
        let depth = |bound: S| (bound - t) * speed * self.scale;
        let range = DepthRange { min: near.greater(depth(interval.min)), max: far.lesser(depth(interval.max)) };
        if !(range.min <= range.max) {
            return None;
        }
        let planes = Planes::new(axis, origin, direction, inverse, t, self.unscale / speed, *interval);
        Some((planes.with_reach(reach), range))
    }

    /// Moves a far origin along the ray to about the scene; `None` if the ray passes it by.
    #[cold]
    #[inline(never)]
    fn approach(&self, ray: &Ray<S>, axis: Axis) -> Option<([S; 3], S)> {
        let middle = (axis.of(&self.bounds.low) + axis.of(&self.bounds.high)) * S::HALF;
        let (origin, t) = self.moved(ray, [S::ZERO; 3], axis, middle);
        // Where the ray crosses the box's middle plane it is at most a box away sideways, if it meets the box at all.
        let near = S::Vec3::from_array(origin).largest() <= self.reach * S::from_u32(NEAR);
        if near { Some((origin, t)) } else { None }
    }

    /// The ray's point at which the coordinate along `axis`, the ray's steepest, is `middle`, and its t: rounded about once. In the
    /// nets' coordinates, relative to `own`.
    fn moved(&self, ray: &Ray<S>, own: [S; 3], axis: Axis, middle: S) -> ([S; 3], S) {
        let (mut origin, mut t) = (ray.origin, S::ZERO);
        // What rounding takes of them, to be given back where it is not small any more.
        let mut lost = [S::ZERO; 3];
        for k in 0..3 {
            for from in [self.origin[k], own[k]] {
                let (difference, rest) = exact_difference(origin[k], from);
                (origin[k], lost[k]) = (difference, lost[k] + rest);
            }
        }
        // Twice: the first step is exact sideways but off along the ray by the rounding of a far t; the second is not.
        for _ in 0..2 {
            let step = (middle - axis.of(&origin)) / axis.of(&ray.direction);
            origin = core::array::from_fn(|k| exact_product_sum(step, ray.direction[k], origin[k]) + lost[k]);
            lost = [S::ZERO; 3];
            t += step;
        }
        (origin, t)
    }
}

/// a − b, rounded, and what rounding took of it (Knuth's difference).
fn exact_difference<S: Scalar>(a: S, b: S) -> (S, S) {
    let difference = a - b;
    let part = difference - a;
    (difference, (a - (difference - part)) - (b + part))
}

/// a · b + c, rounded about once, by Dekker's product and Knuth's sum, without fused arithmetic.
///
/// Source: T. J. Dekker, "A floating-point technique for extending the available precision", 1971. Where the product's
/// splitting overflows, plain arithmetic.
fn exact_product_sum<S: Scalar>(a: S, b: S, c: S) -> S {
    // 2^⌈p/2⌉ + 1 for a significand of p bits; EPSILON is 2^(1−p).
    let bits = 2 - S::EPSILON.binary_exponent();
    let splitter = S::ONE.times_power_of_two((bits + 1) / 2) + S::ONE;
    let split = |x: S| {
        let wide = x * splitter;
        let high = wide - (wide - x);
        (high, x - high)
    };
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    let error = al * bl - (((product - ah * bh) - al * bh) - ah * bl);
    let sum = product + c;
    let part = sum - product;
    let rest = (product - (sum - part)) + (c - part);
    let exact = sum + (error + rest);
    if exact.is_finite() { exact } else { sum }
}

#[cfg(test)]
mod tests {
    use super::super::exact_origin;
    use super::super::tests::unit_frame;
    use super::*;

    #[test]
    fn a_far_origin_loses_nothing_sideways() {
        // From 10⁹ scenes away in f64, or 10⁵ in f32, plain arithmetic is off by 10⁻⁷ or 10⁻² of the scene.
        fn far<S: Scalar>(distance: f64, tolerance: f64) {
            let frame = unit_frame::<S>();
            let direction = [1.0, 0.3, -0.7];
            let origin = direction.map(|c| S::from_f64(-c * distance));
            let direction = direction.map(S::from_f64);
            let ray = frame.ray(origin, direction).unwrap();
            let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
            // Both vectors in f64 are exact here, and so is the sideways offset to about 1e-16 · distance.
            let (o, d) = (origin.map(S::to_f64), direction.map(S::to_f64));
            let offset = |k: usize| o[k] - o[0] / d[0] * d[k];
            let found = planes.origin().map(|c| c.to_f64() * 2.0);
            for k in 1..3 {
                let expected = offset(k) + found[0] / d[0] * d[k];
                assert!((found[k] - expected).abs() < tolerance, "{} {}", found[k], expected);
            }
        }
        far::<f64>(1e9, 1e-6);
        far::<f32>(1e5, 1e-6);
    }

    #[test]
    fn a_scene_far_from_zero_keeps_its_digits() {
        // A box of extent 1, a million extents from 0 along one axis and around 0 along another: f32 has 1/16 left there.
        let bounds = Aabb { low: [1e6_f32, -0.5, -3.0], high: [1e6 + 1.0, 0.5, -2.0] };
        let origin = exact_origin(&bounds);
        assert_eq!(origin, [1e6 + 0.5, 0.0, -2.5]);
        let relative = |c: [f32; 3]| core::array::from_fn(|k| c[k] - origin[k]);
        let frame = Frame::new(Aabb { low: relative(bounds.low), high: relative(bounds.high) }).with_origin(origin);
        for distance in [1.0, 64.0, 1e5] {
            // Every number here is exact, and so is the point that the ray meets.
            let ray = frame.ray([1e6 + 0.25 - distance, 0.125, -2.25], [1.0, 0.0, 0.0]).unwrap();
            let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
            let [_, y, z] = planes.origin().map(|c| c / frame.scale());
            assert_eq!([y, z], [0.125, 0.25]);
            let depth = (-0.25 * frame.scale() - planes.origin()[0]) * planes.direction()[0];
            assert!((planes.t(depth) - distance).abs() <= 2.0 * f32::EPSILON * distance);
        }
        // Where subtracting would round, or gain nothing, the origin stays.
        for [low, high] in [[0.0, 1.0], [1.0, 2.5], [-1.0, 1.0], [1e-45, 1e-45], [f32::INFINITY, 0.0]] {
            assert_eq!(exact_origin(&Aabb { low: [low; 3], high: [high; 3] }), [0.0; 3]);
        }
    }

    /// No bound of t may come to a NaN on the way to depths, which would hide what lies ahead.
    #[test]
    fn infinite_bounds_are_as_bounds_beyond_the_scene() {
        fn check<S: Scalar>(far: f64) {
            let frame = unit_frame::<S>();
            let [none, all] = [S::ZERO, S::INFINITY];
            for length in [1e-20, 1.0, 1e15] {
                for distance in [0.0, 1.0, 2.0 * f64::from(NEAR), far] {
                    for (axis, side) in [(0, 1.0), (1, -1.0), (2, 1.0), (0, -1.0)] {
                        // Toward the scene, or away from it, or in it; some components of the direction are 0.
                        let mut direction = [0.0; 3];
                        direction[axis] = side * length;
                        let mut origin = [0.125, -0.25, 0.0625];
                        origin[axis] -= distance;
                        let ray = frame.ray(origin.map(S::from_f64), direction.map(S::from_f64)).unwrap();
                        let entered = |min: S, max: S| {
                            let entered = frame.enter(&ray, &Interval::new(min, max).unwrap());
                            entered.map(|(planes, range)| (planes.origin(), planes.t(S::ZERO), range))
                        };
                        let beyond = S::from_f64(1e3 * (1.0 + distance) / length);
                        let whole = entered(-all, all);
                        assert!(whole.is_some() && whole == entered(-beyond, beyond));
                        let (origin, t, range) = whole.unwrap();
                        assert!(t.is_finite() && range.max.is_finite() && range.min == none && range.max > none);
                        assert!(origin.iter().all(|c| c.abs() < S::ONE));
                        // The planes bound t by the same interval.
                        let (planes, _) = frame.enter(&ray, &Interval::new(-all, all).unwrap()).unwrap();
                        for depth in [none, range.max] {
                            assert!(!planes.is_before_interval(depth));
                            assert_eq!(planes.t_in_interval(depth), Some(planes.t(depth)));
                        }
                        let middle = planes.t(range.max * S::HALF);
                        assert!(entered(-all, middle).is_some() && entered(middle, all).is_some());
                        assert_eq!(entered(-all, middle), entered(-beyond, middle));
                        assert_eq!(entered(middle, all), entered(middle, beyond));
                        assert!(entered(-all, -beyond).is_none() && entered(beyond, all).is_none());
                        // No t is infinite.
                        assert!(entered(all, all).is_none() && entered(-all, -all).is_none());
                    }
                }
            }
        }
        check::<f64>(1e9);
        check::<f32>(1e5);
    }

    #[test]
    fn an_origin_inside_is_not_moved() {
        let frame = unit_frame::<f64>();
        let ray = frame.ray([0.25, 0.5, -0.125], [0.0, 1.0, 0.0]).unwrap();
        let (planes, range) = frame.enter(&ray, &Interval::ahead()).unwrap();
        assert_eq!(planes.origin(), [0.125, 0.25, -0.0625]);
        assert!(range.min == 0.0 && (range.max - 0.25).abs() < 1e-12);
    }
}
