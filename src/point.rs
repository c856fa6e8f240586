//! Control points: plain and weighted, in space and projected on a ray's planes.
//!
//! Points with weights are homogeneous, (wx, wy, wz, w), so that the same sums serve both kinds.

use crate::bernstein::{Linear, Tuple};
use crate::parameter::{BothEnds, Number, Parameter};
use crate::scalar::Scalar;
use core::ops::{Add, Mul, Sub};

mod sealed {
    pub trait Sealed {}
    impl<S> Sealed for super::Plain<S> {}
    impl<S> Sealed for super::Weighted<S> {}
}

/// A control point: [`Plain`] for polynomial surfaces, [`Weighted`] for rational ones. A scene uses one kind throughout,
/// so that a polynomial scene links no rational code.
pub trait Point:
    sealed::Sealed + Copy + Default + core::fmt::Debug + PartialEq + Linear<Self::Scalar> + Send + Sync + 'static
{
    /// The type of the coordinates.
    type Scalar: Scalar;
    /// How the surface's parameters are held.
    type Parameter: Parameter<Scalar = Self::Scalar>;
    /// The point projected on a ray's two planes: f and g, times the weight, which comes third if there is one.
    type Flat: Flat<Scalar = Self::Scalar, Parameter = Self::Parameter>;
    /// Whether there are weights.
    const RATIONAL: bool;
    /// All zero: a slot that holds nothing.
    const EMPTY: Self = Self::ZERO;
    /// Position times weight.
    fn weighted_position(self) -> [Self::Scalar; 3];
    /// The weight; 1 for a plain point.
    fn weight(self) -> Self::Scalar;
    /// The position: weight divided out.
    fn position(self) -> [Self::Scalar; 3];
    /// Scaled by powers of two: the position by 2^`position`, the weight by 2^`weight`.
    fn rescaled(self, position: i32, weight: i32) -> Self;
    /// The position multiplied by a matrix, given by its rows.
    fn turned(self, rows: &[[Self::Scalar; 3]; 3]) -> Self;
}

/// A control point without weight: x, y, z.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plain<S>(pub [S; 3]);

/// A control point with its weight multiplied in: wx, wy, wz, w.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weighted<S>([S; 4]);

impl<S: Scalar> Weighted<S> {
    /// The point at `position` with `weight`, which has to be positive to make a valid surface.
    pub fn new(position: [S; 3], weight: S) -> Self {
        let [x, y, z] = position;
        Weighted([x * weight, y * weight, z * weight, weight])
    }

    /// The point that holds these numbers: wx, wy, wz and w. For tables; see [`LAYOUT`](crate::LAYOUT).
    pub const fn from_numbers(numbers: [S; 4]) -> Self {
        Weighted(numbers)
    }

    /// What it holds: wx, wy, wz and w.
    pub const fn numbers(&self) -> [S; 4] {
        self.0
    }
}

/// A control point projected on a ray's two planes.
pub trait Flat: Linear<Self::Scalar> + core::fmt::Debug + PartialEq + Send + Sync + 'static {
    /// The type of the coordinates.
    type Scalar: Scalar;
    /// How the surface's parameters are held.
    type Parameter: Parameter<Scalar = Self::Scalar>;
    /// Whether there are weights.
    const RATIONAL: bool;
    /// From f and g, both times the weight, and the weight.
    fn new(f: Self::Scalar, g: Self::Scalar, weight: Self::Scalar) -> Self;
    /// f and g, times the weight.
    fn f_g(self) -> [Self::Scalar; 2];
    /// The weight; of a point without one 1.
    fn weight(self) -> Self::Scalar;
    /// f and g, weight divided out.
    #[inline(always)]
    fn position(self) -> [Self::Scalar; 2] {
        let weight = self.weight();
        // Not by `map`, which a compiler may leave out of line.
        let [f, g] = self.f_g();
        [f / weight, g / weight]
    }
}

impl<S: Scalar> Flat for Tuple<S, 2> {
    type Scalar = S;
    type Parameter = Number<S>;
    const RATIONAL: bool = false;
    #[inline(always)]
    fn new(f: S, g: S, _weight: S) -> Self {
        Tuple([f, g])
    }
    #[inline(always)]
    fn f_g(self) -> [S; 2] {
        self.0
    }
    #[inline(always)]
    fn weight(self) -> S {
        S::ONE
    }
}

impl<S: Scalar> Flat for Tuple<S, 3> {
    type Scalar = S;
    type Parameter = BothEnds<S>;
    const RATIONAL: bool = true;
    #[inline(always)]
    fn new(f: S, g: S, weight: S) -> Self {
        Tuple([f, g, weight])
    }
    #[inline(always)]
    fn f_g(self) -> [S; 2] {
        [self.0[0], self.0[1]]
    }
    #[inline(always)]
    fn weight(self) -> S {
        self.0[2]
    }
}

macro_rules! componentwise {
    ($point:ident, $($k:literal)*) => {
        impl<S: Scalar> Add for $point<S> {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                $point([$(self.0[$k] + other.0[$k]),*])
            }
        }
        impl<S: Scalar> Sub for $point<S> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                $point([$(self.0[$k] - other.0[$k]),*])
            }
        }
        impl<S: Scalar> Mul<S> for $point<S> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, factor: S) -> Self {
                $point([$(self.0[$k] * factor),*])
            }
        }
        impl<S: Scalar> Linear<S> for $point<S> {
            const ZERO: Self = $point([S::ZERO; [$($k),*].len()]);
        }
    };
}
componentwise!(Plain, 0 1 2);
componentwise!(Weighted, 0 1 2 3);

impl<S: Scalar> Point for Plain<S> {
    type Scalar = S;
    const RATIONAL: bool = false;
    type Parameter = Number<S>;
    type Flat = Tuple<S, 2>;
    #[inline(always)]
    fn weighted_position(self) -> [S; 3] {
        self.0
    }
    #[inline(always)]
    fn weight(self) -> S {
        S::ONE
    }
    #[inline(always)]
    fn position(self) -> [S; 3] {
        self.0
    }
    fn rescaled(self, position: i32, _weight: i32) -> Self {
        Plain(self.0.map(|c| c.times_power_of_two(position)))
    }
    #[inline]
    fn turned(self, rows: &[[S; 3]; 3]) -> Self {
        Plain(rows.map(|row| product(&row, &self.0)))
    }
}

impl<S: Scalar> Point for Weighted<S> {
    type Scalar = S;
    const RATIONAL: bool = true;
    type Parameter = BothEnds<S>;
    type Flat = Tuple<S, 3>;
    #[inline(always)]
    fn weighted_position(self) -> [S; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }
    #[inline(always)]
    fn weight(self) -> S {
        self.0[3]
    }
    #[inline(always)]
    fn position(self) -> [S; 3] {
        let [x, y, z, w] = self.0;
        [x / w, y / w, z / w]
    }
    fn rescaled(self, position: i32, weight: i32) -> Self {
        let [x, y, z, w] = self.0;
        let both = position.saturating_add(weight);
        Weighted([
            x.times_power_of_two(both),
            y.times_power_of_two(both),
            z.times_power_of_two(both),
            w.times_power_of_two(weight),
        ])
    }
    #[inline]
    fn turned(self, rows: &[[S; 3]; 3]) -> Self {
        let [x, y, z] = rows.map(|row| product(&row, &self.weighted_position()));
        Weighted([x, y, z, self.0[3]])
    }
}

#[inline(always)]
fn product<S: Scalar>(a: &[S; 3], b: &[S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
