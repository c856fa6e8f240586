//! The number types of the kernel behind one sealed trait: `f32` and `f64`, and either of them in [`Told`](crate::told::Told).
//!
//! Everything above this file is written once, for any [`Scalar`]. The operations are those whose results are the same
//! bits on every target: + − × ÷, square root, comparison, and scaling by a power of two. This is the only file that
//! names `libm` or `glam`'s types.

use crate::story::Event;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A floating-point type that the kernel computes in: `f32`, `f64`, or either of them in [`Told`](crate::told::Told).
pub trait Scalar:
    sealed::Sealed
    + Copy
    + Default
    + Debug
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + Send
    + Sync
    + 'static
{
    /// The vector of three such numbers: `glam::Vec3` or `glam::DVec3`, which are scalar code on every target.
    type Vec3: Vector3<Scalar = Self>;

    /// 0.
    const ZERO: Self;
    /// 1/2.
    const HALF: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// Positive infinity.
    const INFINITY: Self;
    /// Negative infinity.
    const LEAST: Self;
    /// The spacing of the numbers just above 1 (2⁻²³ or 2⁻⁵²).
    const EPSILON: Self;
    /// The largest finite number.
    const MAX: Self;
    /// The smallest positive number of full precision.
    const MIN_POSITIVE: Self;
    /// The largest k for which both 2^k and 2^−k are of full precision.
    const MAX_SCALE: i32;
    /// Default of [`Limits::tolerance`](crate::limits::Limits::tolerance): some nine roundings.
    const TOLERANCE: Self;

    /// The nearest number of this type; how constants are written.
    fn from_f64(value: f64) -> Self;
    /// The same number; exact, and for `f32` without arithmetic, which in `f64` is slow where hardware has only `f32`.
    fn from_f32(value: f32) -> Self;
    /// The same number in `f64`; exact.
    fn to_f64(self) -> f64;
    /// The nearest number of this type.
    fn from_u32(value: u32) -> Self;
    /// Rounded toward zero; 0 for NaN and below, the largest `u32` for what is above it.
    fn to_u32(self) -> u32;
    /// The number without its sign.
    fn abs(self) -> Self;
    /// Square root, correctly rounded; NaN below zero.
    fn sqrt(self) -> Self;
    /// Whether this is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// `self · 2^exponent`; exact unless the result is smaller than [`Scalar::MIN_POSITIVE`] or overflows.
    fn times_power_of_two(self, exponent: i32) -> Self;
    /// The k with 2^(k−1) ≤ |self| < 2^k, for finite numbers other than 0.
    fn binary_exponent(self) -> i32;

    /// Takes notice of what a search does; see [`story`](crate::story). Does nothing, and does not even ask what.
    #[inline(always)]
    fn tell(_event: impl FnOnce() -> Event) {}

    /// The smaller one; `self` when they compare equal or `other` is NaN. (`f64::min` may give either zero of −0 and +0.)
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// The larger one; `self` when they compare equal or `other` is NaN.
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
    /// The nearest number in `[low, high]`; a NaN stays.
    #[inline(always)]
    fn clamped(self, low: Self, high: Self) -> Self {
        if self < low {
            low
        } else if self > high {
            high
        } else {
            self
        }
    }
}

/// Three numbers as a vector, with the few operations that the kernel uses.
pub trait Vector3:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Neg<Output = Self> + Mul<Self::Scalar, Output = Self>
{
    /// The type of the components.
    type Scalar: Scalar;
    /// The zero vector.
    const ZERO: Self;
    /// From components.
    fn from_array(components: [Self::Scalar; 3]) -> Self;
    /// To components.
    fn to_array(self) -> [Self::Scalar; 3];
    /// Scalar product.
    fn dot(self, other: Self) -> Self::Scalar;
    /// Vector product.
    fn cross(self, other: Self) -> Self;
    /// The components without their signs.
    fn abs(self) -> Self;

    /// Whether, with this largest |component|, squares neither overflow nor lose what counts.
    #[inline(always)]
    fn has_squares(largest: Self::Scalar) -> bool {
        let (square, epsilon) = (largest * largest, Self::Scalar::EPSILON);
        square * (epsilon * epsilon) > Self::Scalar::MIN_POSITIVE && square < Self::Scalar::MAX * Self::Scalar::EPSILON
    }
    /// Length; scaled by the largest component first where it would overflow or vanish on the way.
    #[inline]
    fn length(self) -> Self::Scalar {
        let largest = self.largest();
        if Self::has_squares(largest) {
            return self.dot(self).sqrt();
        }
        if largest > Self::Scalar::ZERO && largest < Self::Scalar::INFINITY {
            let exponent = largest.binary_exponent();
            let [x, y, z] = self.to_array().map(|c| c.times_power_of_two(-exponent));
            (x * x + y * y + z * z).sqrt().times_power_of_two(exponent)
        } else {
            largest
        }
    }
    /// The vector over its length; zero if its length is zero.
    #[inline]
    fn unit(self) -> Self {
        let largest = self.largest();
        if Self::has_squares(largest) {
            let length = self.dot(self).sqrt();
            return Self::from_array(self.to_array().map(|c| c / length));
        }
        if !(largest > Self::Scalar::ZERO && largest < Self::Scalar::INFINITY) {
            return Self::ZERO;
        }
        let exponent = largest.binary_exponent();
        let scaled = self.to_array().map(|c| c.times_power_of_two(-exponent));
        let [x, y, z] = scaled;
        let length = (x * x + y * y + z * z).sqrt();
        Self::from_array(scaled.map(|c| c / length))
    }
    /// The largest |component|; a NaN component is passed over.
    #[inline]
    fn largest(self) -> Self::Scalar {
        let [x, y, z] = self.abs().to_array();
        Self::Scalar::ZERO.greater(x).greater(y).greater(z)
    }
}

macro_rules! scalar {
    ($float:ident, $vec3:ident, $sqrt:path, $scale:path, $exponent:path, $tolerance:expr) => {
        impl Scalar for $float {
            type Vec3 = glam::$vec3;
            const ZERO: Self = 0.0;
            const HALF: Self = 0.5;
            const ONE: Self = 1.0;
            const TWO: Self = 2.0;
            const INFINITY: Self = $float::INFINITY;
            const LEAST: Self = $float::NEG_INFINITY;
            const EPSILON: Self = $float::EPSILON;
            const MAX: Self = $float::MAX;
            const MIN_POSITIVE: Self = $float::MIN_POSITIVE;
            const MAX_SCALE: i32 = $float::MAX_EXP - 2;
            const TOLERANCE: Self = $tolerance;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn from_f32(value: f32) -> Self {
                $float::from(value)
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn from_u32(value: u32) -> Self {
                value as $float
            }
            #[inline(always)]
            fn to_u32(self) -> u32 {
                self as u32
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
            #[inline]
            fn times_power_of_two(self, exponent: i32) -> Self {
                $scale(self, exponent)
            }
            #[inline]
            fn binary_exponent(self) -> i32 {
                $exponent(self).1
            }
        }

        impl Vector3 for glam::$vec3 {
            type Scalar = $float;
            const ZERO: Self = glam::$vec3::ZERO;
            #[inline(always)]
            fn from_array(components: [$float; 3]) -> Self {
                glam::$vec3::from_array(components)
            }
            #[inline(always)]
            fn to_array(self) -> [$float; 3] {
                glam::$vec3::to_array(&self)
            }
            #[inline(always)]
            fn dot(self, other: Self) -> $float {
                glam::$vec3::dot(self, other)
            }
            #[inline(always)]
            fn cross(self, other: Self) -> Self {
                glam::$vec3::cross(self, other)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                glam::$vec3::abs(self)
            }
        }
    };
}

scalar!(f32, Vec3, libm::sqrtf, libm::scalbnf, libm::frexpf, 1e-6);
scalar!(f64, DVec3, libm::sqrt, libm::scalbn, libm::frexp, 2e-15);

#[cfg(test)]
mod tests {
    use super::*;

    fn laws<S: Scalar>() {
        assert_eq!(S::from_f64(0.75).binary_exponent(), 0);
        assert_eq!(S::ONE.binary_exponent(), 1);
        assert_eq!(S::ONE.times_power_of_two(-3), S::from_f64(0.125));
        assert_eq!(S::ONE.times_power_of_two(S::MAX_SCALE) * S::ONE.times_power_of_two(-S::MAX_SCALE), S::ONE);
        assert!(S::ONE.times_power_of_two(-S::MAX_SCALE) >= S::MIN_POSITIVE);
        // Squares of such components overflow; the length does not.
        let long = S::Vec3::from_array([S::MAX * S::HALF, S::ZERO, S::ZERO]);
        assert_eq!(long.length(), S::MAX * S::HALF);
        assert_eq!(long.unit().to_array(), [S::ONE, S::ZERO, S::ZERO]);
        let short = S::Vec3::from_array([S::ZERO, -S::MIN_POSITIVE, S::ZERO]);
        assert_eq!(short.unit().to_array(), [S::ZERO, -S::ONE, S::ZERO]);
        assert_eq!(S::Vec3::ZERO.unit().to_array(), [S::ZERO; 3]);
    }

    #[test]
    fn both_types_keep_the_laws() {
        laws::<f32>();
        laws::<f64>();
    }

    #[test]
    fn a_nan_never_wins_a_comparison() {
        assert_eq!(1.0_f64.lesser(f64::NAN), 1.0);
        assert_eq!(1.0_f64.greater(f64::NAN), 1.0);
        assert!(0.0_f64.lesser(-0.0).is_sign_positive());
    }
}
