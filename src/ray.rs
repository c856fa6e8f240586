//! A ray, the stretch of it that counts, and what it hits.

use crate::scalar::Scalar;

/// A ray `origin + t · direction`, in the caller's coordinates; the direction need not be of unit length.
///
/// Made by [`Frame::ray`](crate::frame::Frame::ray), which refuses what cannot be traced, so that a `Ray` is valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray<S> {
    pub(crate) origin: [S; 3],
    pub(crate) direction: [S; 3],
    /// The axis along which the direction is steepest.
    pub(crate) axis: Axis,
    /// Whether the origin is far from the scene, so that it has to be moved with care.
    pub(crate) far: bool,
}

impl<S: Scalar> Ray<S> {
    /// Where t = 0, in the caller's coordinates.
    pub fn origin(&self) -> [S; 3] {
        self.origin
    }

    /// What one unit of t adds, in the caller's coordinates.
    pub fn direction(&self) -> [S; 3] {
        self.direction
    }

    /// The point `origin + t · direction`, in the caller's coordinates.
    pub fn at(&self, t: S) -> [S; 3] {
        let [x, y, z] = self.origin;
        let [dx, dy, dz] = self.direction;
        [x + t * dx, y + t * dy, z + t * dz]
    }
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second coordinate.
    Y,
    /// The third coordinate.
    Z,
}

impl Axis {
    /// The axis of the largest |component|; the first of equal ones.
    #[inline(always)]
    pub(crate) fn dominant<S: Scalar>(vector: &[S; 3]) -> Axis {
        let [x, y, z] = vector.map(S::abs);
        if x >= y {
            if x >= z { Axis::X } else { Axis::Z }
        } else if y >= z {
            Axis::Y
        } else {
            Axis::Z
        }
    }

    /// The component along this axis.
    #[inline(always)]
    pub(crate) fn of<S: Scalar>(self, vector: &[S; 3]) -> S {
        vector[self as usize]
    }

    /// The two other axes, in cyclic order.
    #[inline(always)]
    pub(crate) fn others(self) -> (Axis, Axis) {
        match self {
            Axis::X => (Axis::Y, Axis::Z),
            Axis::Y => (Axis::Z, Axis::X),
            Axis::Z => (Axis::X, Axis::Y),
        }
    }
}

/// Why a ray was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayError {
    /// A coordinate of origin or direction is NaN.
    NotANumber,
    /// A coordinate of origin or direction is infinite.
    Infinite,
    /// The direction is (0, 0, 0).
    ZeroDirection,
    /// Somewhere in the scene the ray's t is too large, or steps of t too small, for the number type.
    Unrepresentable,
    /// Of a [view](crate::view): the ray is more than 45° off the view's direction, or not a number.
    OutOfView,
}

impl RayError {
    /// What is wrong with the first of these numbers that is not finite, if one is not.
    #[cold]
    #[inline(never)]
    pub(crate) fn of_not_finite<'n, S: Scalar + 'n>(numbers: impl Iterator<Item = &'n S>) -> Option<Self> {
        let mut numbers = numbers.filter(|c| !c.is_finite());
        numbers.next().map(|c| if c.abs() == S::INFINITY { RayError::Infinite } else { RayError::NotANumber })
    }
}

impl core::fmt::Display for RayError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            RayError::NotANumber => "a coordinate is NaN",
            RayError::Infinite => "a coordinate is infinite",
            RayError::ZeroDirection => "the direction is zero",
            RayError::Unrepresentable => "its t in the scene, or small steps of it, cannot be held by the number type",
            RayError::OutOfView => "it is more than 45 degrees off the view's direction",
        })
    }
}

impl core::error::Error for RayError {}

/// The values of t that count, `[t_min, t_max]`, in units of the ray's direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<S> {
    pub(crate) min: S,
    pub(crate) max: S,
}

impl<S: Scalar> Interval<S> {
    /// `[t_min, t_max]`; `None` if one of them is NaN or `t_min > t_max`. Either may be infinite.
    pub fn new(t_min: S, t_max: S) -> Option<Self> {
        if t_min <= t_max { Some(Interval { min: t_min, max: t_max }) } else { None }
    }

    /// `[0, ∞]`: all that lies ahead of the origin.
    pub fn ahead() -> Self {
        Interval { min: S::ZERO, max: S::INFINITY }
    }

    /// The smallest t that counts.
    pub fn min(&self) -> S {
        self.min
    }

    /// The largest t that counts.
    pub fn max(&self) -> S {
        self.max
    }
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<S> {
    /// Parameter along the ray, in units of its direction.
    pub t: S,
    /// Surface parameter, in [0, 1].
    pub u: S,
    /// Surface parameter, in [0, 1].
    pub v: S,
    /// The surface's number in its scene, from 0.
    pub surface: u32,
    /// How the ray meets the surface there.
    pub incidence: Incidence,
}

/// How a ray meets a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Incidence {
    /// The ray passes through the surface.
    #[default]
    Crossing = 0,
    /// The ray is tangent to working precision: at an angle to the surface whose sine is below 4 √tolerance. A displacement of
    /// the ray by the tolerance may then merge this root with another, and t, u and v are known to about half the digits. So is
    /// a root called that roots beside it cannot be told from, or that lies off the ray by more than the tolerance and
    /// rounding, but by no more than what rounding may have made of the surface's control points: that is of shallow rays, or
    /// of uneven weights.
    Grazing = 1,
    /// The ray lies in the surface for a stretch, to working precision. t is where the stretch begins.
    Contact = 2,
}
