//! The scene's frame: one exact scale for all coordinates, and the place where a ray enters the scene.
//!
//! Coordinates are multiplied by one power of two, chosen from the largest |coordinate|, so that they lie within (−1, 1)
//! whatever the unit; they are never shifted by rounding, which would part edges that neighbours share to the bit. Instead a
//! ray's origin is moved, once, to where the ray enters the scene's box. Of a scene far from 0 the nets may be given relative
//! to an origin of their own, to which rays are then moved: [`exact_origin`] says where subtracting it rounds nothing.

use crate::ray::{Axis, Ray, RayError};
use crate::scalar::{Scalar, Vector3};

mod enter;

/// By how many roundings ([`Scalar::EPSILON`] in the frame, where coordinates are below 1) boxes are padded.
///
/// It covers the error of a coordinate difference to an origin up to 8 scenes away, of the moved origin, and of the
/// tests made with them, some 20 roundings of numbers up to 2 together; the rest is reserve. Larger is safe and makes thin
/// boxes thicker: in `f32` 64 roundings are 8e-6, a hundredth of a patch's thickness at the default flatness.
pub const PADDING: u32 = 64;

/// Origins farther from 0 than this many times the scene's largest |coordinate| are first brought near, with the product
/// t · direction carried to twice the precision. Nearer ones save that; they lose at most this many roundings.
pub(crate) const NEAR: u32 = 8;

/// A box with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Aabb<S> {
    /// The corner of least coordinates.
    pub low: [S; 3],
    /// The corner of largest coordinates.
    pub high: [S; 3],
}

impl<S: Scalar> Aabb<S> {
    /// The box around nothing; adding a point makes it that point.
    pub const EMPTY: Self = Aabb { low: [S::INFINITY; 3], high: [S::ZERO; 3] };

    /// The box of the one point 0.
    pub const ORIGIN: Self = Aabb { low: [S::ZERO; 3], high: [S::ZERO; 3] };

    /// Whether no point was added yet.
    pub fn is_empty(&self) -> bool {
        self.low.iter().zip(&self.high).any(|(l, h)| !(l <= h))
    }

    /// The smallest box that also holds `point`.
    #[must_use]
    pub fn with(self, point: [S; 3]) -> Self {
        if self.is_empty() {
            return Aabb { low: point, high: point };
        }
        let mut grown = self;
        for k in 0..3 {
            grown.low[k] = grown.low[k].lesser(point[k]);
            grown.high[k] = grown.high[k].greater(point[k]);
        }
        grown
    }

    /// The box as seen from `origin`; its sides are rounded.
    #[must_use]
    pub fn relative(self, origin: [S; 3]) -> Self {
        let from = |corner: [S; 3]| core::array::from_fn(|k| corner[k] - origin[k]);
        Aabb { low: from(self.low), high: from(self.high) }
    }

    /// The smallest box that also holds `other`.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        if other.is_empty() { self } else { self.with(other.low).with(other.high) }
    }

    /// The box with all sides moved outward by `by`.
    #[must_use]
    pub fn padded(self, by: S) -> Self {
        Aabb { low: self.low.map(|c| c - by), high: self.high.map(|c| c + by) }
    }

    /// The side lengths.
    pub fn sides(&self) -> [S; 3] {
        core::array::from_fn(|k| self.high[k] - self.low[k])
    }

    /// The length of the diagonal.
    pub fn diagonal(&self) -> S {
        S::Vec3::from_array(self.sides()).length()
    }

    /// The depths at which the line `origin + depth · direction` enters and leaves the box, `None` if it passes by.
    /// `inverse` is 1 / `direction`, component by component, infinite where that is 0: then both products are infinite, of
    /// one sign if the line passes by.
    ///
    /// A line in the very plane of a face makes 0 · ∞, a NaN, and may be taken to pass by. Boxes here are padded, so that
    /// nothing lies in their faces; telling the cases apart costs 4 % of a ray's instructions.
    #[inline(always)]
    pub(crate) fn depths(&self, origin: &[S; 3], inverse: &[S; 3]) -> Option<(S, S)> {
        let (mut near, mut far) = (-S::INFINITY, S::INFINITY);
        for k in 0..3 {
            let a = (self.low[k] - origin[k]) * inverse[k];
            let b = (self.high[k] - origin[k]) * inverse[k];
            near = near.greater(a.lesser(b));
            far = far.lesser(a.greater(b));
        }
        if near <= far { Some((near, far)) } else { None }
    }
}

/// The origin nearest to the box's middle from which no coordinate in the box is known worse than from 0: relative to it, all
/// points of the box are exact.
///
/// Along each axis it is the middle, if no coordinate in the box is more than twice another and none is 0 or of another sign;
/// else 0. Differences from the middle then are exact (P. H. Sterbenz, *Floating-point computation*, 1974, theorem 4.3.1).
/// A scene whose offset from 0 is many times its size keeps the digits that its coordinates have only if its nets are given
/// so: see [`SceneOptions::origin`](crate::scene::SceneOptions::origin).
pub fn exact_origin<S: Scalar>(bounds: &Aabb<S>) -> [S; 3] {
    core::array::from_fn(|k| {
        let (low, high) = (bounds.low[k], bounds.high[k]);
        // Half of each first: their sum might overflow.
        let middle = low * S::HALF + high * S::HALF;
        let near = if low > S::ZERO { high * S::HALF <= low } else { high < S::ZERO && low * S::HALF >= high };
        // Halves of the least numbers round, and a box around nothing has infinite sides.
        if near && middle.is_finite() && middle.abs() * S::EPSILON >= S::MIN_POSITIVE { middle } else { S::ZERO }
    })
}

/// The scene's frame. All of the kernel's stored coordinates are in it; rays and hits are in the caller's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Frame<S> {
    scale: S,
    unscale: S,
    /// Where the nets' coordinates are 0, in the caller's coordinates.
    origin: [S; 3],
    /// The box of the control points, in the nets' coordinates, padded.
    bounds: Aabb<S>,
    /// The nets' largest |coordinate|.
    reach: S,
    /// The diagonal of the unpadded box, in the frame.
    diagonal: S,
    /// Caller's coordinates times 2^`exponent` are the frame's.
    exponent: i32,
}

impl<S: Scalar> Frame<S> {
    /// The frame of a scene whose control points fill `bounds`, in the caller's coordinates.
    pub fn new(bounds: Aabb<S>) -> Self {
        let bounds = if bounds.is_empty() { Aabb::ORIGIN } else { bounds };
        let reach = S::Vec3::from_array(bounds.low).largest().greater(S::Vec3::from_array(bounds.high).largest());
        let exponent = if reach > S::ZERO { -reach.binary_exponent() } else { 0 };
        let exponent = exponent.clamp(-S::MAX_SCALE, S::MAX_SCALE);
        let scale = S::ONE.times_power_of_two(exponent);
        let inside = Aabb { low: bounds.low.map(|c| c * scale), high: bounds.high.map(|c| c * scale) };
        Frame {
            exponent,
            scale,
            unscale: S::ONE.times_power_of_two(-exponent),
            origin: [S::ZERO; 3],
            bounds: bounds.padded(reach * S::EPSILON * S::from_u32(PADDING)),
            reach,
            diagonal: inside.diagonal(),
        }
    }

    /// The same for control points that are given relative to `origin`, a point in the coordinates of rays, such as
    /// [`exact_origin`] says.
    #[must_use]
    pub fn with_origin(self, origin: [S; 3]) -> Self {
        Frame { origin, ..self }
    }

    /// The frame that holds these numbers. For tables; see [`LAYOUT`](crate::LAYOUT).
    ///
    /// They are its scale and the inverse; by coordinate axis, the origin and the least and largest corner of the nets' padded
    /// box; the nets' largest |coordinate|, and the diagonal of the box in the frame; and [`Frame::exponent`].
    pub const fn from_numbers(scales: [S; 2], corners: [[S; 3]; 3], sizes: [S; 2], exponent: i32) -> Self {
        let ([scale, unscale], [origin, low, high], [reach, diagonal]) = (scales, corners, sizes);
        Frame { scale, unscale, origin, bounds: Aabb { low, high }, reach, diagonal, exponent }
    }

    /// What [`Frame::from_numbers`] takes.
    pub const fn numbers(&self) -> ([S; 2], [[S; 3]; 3], [S; 2], i32) {
        let corners = [self.origin, self.bounds.low, self.bounds.high];
        ([self.scale, self.unscale], corners, [self.reach, self.diagonal], self.exponent)
    }

    /// The k by which coordinates are scaled: a coordinate in the frame is the nets' times 2^k.
    pub fn exponent(&self) -> i32 {
        self.exponent
    }

    /// Where the nets' coordinates are 0, in the caller's coordinates.
    pub fn origin(&self) -> [S; 3] {
        self.origin
    }

    /// A point of the nets' coordinates in the frame; exact.
    pub fn from_nets(&self, point: [S; 3]) -> [S; 3] {
        point.map(|c| c.times_power_of_two(self.exponent))
    }

    /// A point of the nets' coordinates that lies in the frame; exact.
    pub(crate) fn to_nets(self, point: [S; 3]) -> [S; 3] {
        point.map(|c| c * self.unscale)
    }

    /// A point of the caller's coordinates in the nets': rounded once per coordinate unless the origin is 0.
    #[inline(always)]
    pub(crate) fn relative(&self, point: [S; 3]) -> [S; 3] {
        core::array::from_fn(|k| point[k] - self.origin[k])
    }

    /// The diagonal of the control points' box, in the frame.
    pub fn diagonal(&self) -> S {
        self.diagonal
    }

    /// A length in the frame that covers the rounding of box tests: [`PADDING`] roundings at coordinates of 1.
    pub fn padding() -> S {
        S::EPSILON * S::from_u32(PADDING)
    }

    /// Units of the frame per caller's unit, a power of two.
    pub(crate) fn scale(&self) -> S {
        self.scale
    }

    /// Caller's units per unit of the frame.
    pub fn unscale(&self) -> S {
        self.unscale
    }

    /// A length, in the caller's units, such that its quotient by a ray's speed along its steepest axis bounds all t in the
    /// scene a few times over, for rays from `origin`.
    pub(crate) fn farthest(&self, origin: [S; 3]) -> S {
        let distance = S::Vec3::from_array(self.relative(origin)).largest();
        ((distance + self.reach) * S::from_u32(8)).greater(self.unscale)
    }

    /// Makes a ray; refuses NaN, infinity, a zero direction, and one whose t in the scene the type could not hold.
    pub fn ray(&self, origin: [S; 3], direction: [S; 3]) -> Result<Ray<S>, RayError> {
        let all = || origin.iter().chain(&direction);
        // A sum of magnitudes is finite exactly if all terms are, unless it overflows; only then look closer.
        let sum = all().fold(S::ZERO, |sum, c| sum + c.abs());
        if !sum.is_finite()
            && let Some(error) = RayError::of_not_finite(all())
        {
            return Err(error);
        }
        let axis = Axis::dominant(&direction);
        let speed = axis.of(&direction).abs();
        if !(speed > S::ZERO) {
            return Err(RayError::ZeroDirection);
        }
        let distance = S::Vec3::from_array(self.relative(origin)).largest();
        // t grows to (distance + reach) / speed, a few times over on the way, and a step of depth is unscale / speed; said
        // without divisions, which cost more than all the rest here. A product that overflows or vanishes says the same.
        let held = self.farthest(origin) < S::MAX * speed && self.unscale * S::EPSILON >= S::MIN_POSITIVE * speed;
        if !held {
            return Err(RayError::Unrepresentable);
        }
        Ok(Ray { origin, direction, axis, far: distance > self.reach * S::from_u32(NEAR) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn unit_frame<S: Scalar>() -> Frame<S> {
        Frame::new(Aabb { low: [-S::ONE; 3], high: [S::ONE; 3] })
    }

    #[test]
    fn the_scale_is_a_power_of_two_at_any_size() {
        for exponent in [-1000, -300, -3, 0, 5, 300, 1000] {
            let size = 1.5 * 2.0_f64.powi(exponent);
            let frame = Frame::new(Aabb { low: [-size; 3], high: [0.0; 3] });
            assert_eq!(frame.exponent(), -(exponent + 1));
            assert_eq!(frame.reach * frame.scale, 0.75);
        }
        // At both ends of the type the scale is held back so that it and its inverse stay exact.
        assert!(Frame::new(Aabb { low: [f32::MAX; 3], high: [f32::MAX; 3] }).scale > 0.0);
        assert!(Frame::new(Aabb { low: [f32::from_bits(1); 3], high: [f32::from_bits(1); 3] }).scale.is_finite());
        assert_eq!(Frame::<f64>::new(Aabb::EMPTY).diagonal(), 0.0);
    }

    #[test]
    fn bad_rays_are_refused_by_name() {
        let frame = unit_frame::<f32>();
        let one = [1.0; 3];
        assert_eq!(frame.ray([f32::NAN, 0.0, 0.0], one), Err(RayError::NotANumber));
        assert_eq!(frame.ray(one, [0.0, f32::INFINITY, 0.0]), Err(RayError::Infinite));
        assert_eq!(frame.ray(one, [0.0, -0.0, 0.0]), Err(RayError::ZeroDirection));
        assert_eq!(frame.ray(one, [1e-44, 0.0, 0.0]), Err(RayError::Unrepresentable));
        assert_eq!(frame.ray(one, [1e38; 3]), Err(RayError::Unrepresentable));
        assert!(frame.ray([f32::MAX; 3], [f32::MAX / 2.0; 3]).is_err());
        assert!(frame.ray([1e30; 3], [1e20; 3]).is_ok());
        // The sum of these magnitudes overflows although each is finite: not to be called infinite.
        assert_eq!(unit_frame::<f64>().ray([1e308; 3], [1e308; 3]), Err(RayError::Unrepresentable));
    }
}
