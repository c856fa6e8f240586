//! The numbers that the oracle can work in: f64, and pairs of f64 ("double-double") of about 31 decimal digits.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A number that is the unevaluated sum of two f64, with the range of f64 and about 31 decimal digits.
///
/// An operation is off by at most 10 u², u = 2⁻⁵³, relative to its result, as long as no product or quotient is below
/// about 1e-290: a sum by 3, a product by 5, a square root by 25/8, a quotient by 9.8 (M. Joldeş, J.-M. Muller,
/// V. Popescu, "Tight and rigorous error bounds for basic building blocks of double-word arithmetic", ACM TOMS 44 (2017);
/// V. Lefèvre, N. Louvet, J.-M. Muller, J. Picot, L. Rideau, "Accurate calculation of Euclidean norms using double-word
/// arithmetic", ACM TOMS 49 (2023)). An infinite one is no operand: all but comparisons then give NaN.
pub type DoubleDouble = xprec::Df64;

/// What the oracle needs of a number.
///
/// What is computed as the difference of larger numbers is a `Real`; what has lost the digits that it is going to lose (a
/// margin, an error bound, an angle) is an f64, which such numbers round to.
pub trait Real:
    Copy
    + Debug
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
    /// Binary digits: those that operations are proved to leave.
    const BITS: usize;
    /// The unit of rounding that bounds are stated in, 2^(1 - `BITS`): at least twice the largest relative error of one
    /// operation.
    const EPS: f64;
    /// The margin below which an answer cannot be judged, as long as coordinates are not much larger than the model's
    /// extent: some thousand `EPS`, in units of the model's diagonal.
    const LEAST_MARGIN: f64;
    /// What [`Real::on_ray`] may be off by, as a part of the distance between the ray's origin and the point.
    const SLIP: f64;
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// Greater than all others.
    const INFINITY: Self;

    /// `x`, exactly.
    fn new(x: f64) -> Self;
    /// The nearest f64.
    fn to_f64(self) -> f64;
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// The magnitude.
    fn abs(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// Half of it, exactly.
    fn half(self) -> Self;
    /// The product with an f64.
    fn times(self, factor: f64) -> Self;
    /// Quotients of the same divisor.
    fn over<const N: usize>(numerators: [Self; N], divisor: Self) -> [Self; N];
    /// The order by size, with every NaN at an end.
    fn order(&self, other: &Self) -> Ordering;
    /// `origin + self direction`, to within `EPS` of the result and `SLIP` of the distance.
    fn on_ray(self, origin: f64, direction: f64) -> Self;

    /// `self - other`, rounded; either may be infinite.
    #[inline]
    fn less(self, other: Self) -> f64 {
        if self.is_finite() && other.is_finite() { (self - other).to_f64() } else { self.to_f64() - other.to_f64() }
    }

    /// The smaller of two; the other one of a NaN.
    #[inline]
    fn smaller(self, other: Self) -> Self {
        if self < other || other.partial_cmp(&other).is_none() { self } else { other }
    }

    /// The larger of two; the other one of a NaN.
    #[inline]
    fn larger(self, other: Self) -> Self {
        if self > other || other.partial_cmp(&other).is_none() { self } else { other }
    }

    /// The nearest number from 0 to 1; NaN stays.
    #[inline]
    fn clamp_unit(self) -> Self {
        if self < Self::ZERO {
            Self::ZERO
        } else if self > Self::ONE {
            Self::ONE
        } else {
            self
        }
    }
}

impl Real for f64 {
    const BITS: usize = f64::MANTISSA_DIGITS as usize;
    const EPS: f64 = f64::EPSILON;
    const LEAST_MARGIN: f64 = 1e-12;
    const SLIP: f64 = 0.0;
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    const INFINITY: f64 = f64::INFINITY;

    #[inline(always)]
    fn new(x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }

    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn half(self) -> f64 {
        0.5 * self
    }

    #[inline(always)]
    fn times(self, factor: f64) -> f64 {
        self * factor
    }

    #[inline(always)]
    fn over<const N: usize>(numerators: [f64; N], divisor: f64) -> [f64; N] {
        numerators.map(|x| x / divisor)
    }

    #[inline(always)]
    fn order(&self, other: &f64) -> Ordering {
        self.total_cmp(other)
    }

    /// A fused product and sum rounds once, so the point is as near to the ray as f64 can state one.
    #[inline(always)]
    fn on_ray(self, origin: f64, direction: f64) -> f64 {
        self.mul_add(direction, origin)
    }

    #[inline(always)]
    fn less(self, other: f64) -> f64 {
        self - other
    }

    #[inline(always)]
    fn smaller(self, other: f64) -> f64 {
        f64::min(self, other)
    }

    #[inline(always)]
    fn larger(self, other: f64) -> f64 {
        f64::max(self, other)
    }

    #[inline(always)]
    fn clamp_unit(self) -> f64 {
        self.clamp(0.0, 1.0)
    }
}

/// The exact product of two f64, as long as it is above about 1e-290.
#[inline]
fn product(a: f64, b: f64) -> DoubleDouble {
    DoubleDouble::new(a) * b
}

impl Real for DoubleDouble {
    // 32 u² = 2⁻¹⁰¹ is at least twice the error of any operation.
    const BITS: usize = 102;
    const EPS: f64 = 8.0 * f64::EPSILON * f64::EPSILON;
    const LEAST_MARGIN: f64 = 1e-26;
    const SLIP: f64 = Self::EPS * f64::EPSILON;
    const ZERO: DoubleDouble = DoubleDouble::new(0.0);
    const ONE: DoubleDouble = DoubleDouble::new(1.0);
    const INFINITY: DoubleDouble = DoubleDouble::new(f64::INFINITY);

    #[inline]
    fn new(x: f64) -> DoubleDouble {
        DoubleDouble::new(x)
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.hi()
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.hi().is_finite() && self.lo().is_finite()
    }

    #[inline]
    fn abs(self) -> DoubleDouble {
        if self.hi() < 0.0 { -self } else { self }
    }

    #[inline]
    fn sqrt(self) -> DoubleDouble {
        DoubleDouble::sqrt(self)
    }

    #[inline]
    fn half(self) -> DoubleDouble {
        DoubleDouble::new_full(0.5 * self.hi(), 0.5 * self.lo())
    }

    #[inline]
    fn times(self, factor: f64) -> DoubleDouble {
        self * factor
    }

    /// A division takes longer than all else, and most divisors are weights of 1.
    #[inline]
    fn over<const N: usize>(numerators: [DoubleDouble; N], divisor: DoubleDouble) -> [DoubleDouble; N] {
        if divisor == Self::ONE {
            return numerators;
        }
        let inverse = divisor.recip();
        numerators.map(|x| x * inverse)
    }

    #[inline]
    fn order(&self, other: &DoubleDouble) -> Ordering {
        self.hi().total_cmp(&other.hi()).then(self.lo().total_cmp(&other.lo()))
    }

    /// Both halves of `self` have an exact product with the direction; the first nearly cancels the origin of a ray that
    /// comes from far, which costs nothing, and the second is small.
    #[inline]
    fn on_ray(self, origin: f64, direction: f64) -> DoubleDouble {
        (product(self.hi(), direction) + origin) + product(self.lo(), direction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_rounding_are_the_digits() {
        fn unit<R: Real>() -> f64 {
            2f64.powi(1 - R::BITS as i32)
        }
        assert_eq!(f64::EPS, unit::<f64>());
        assert_eq!(DoubleDouble::EPS, unit::<DoubleDouble>());
    }

    #[test]
    fn double_double_keeps_its_digits_from_tiny_to_huge() {
        let near = |a: DoubleDouble, b: DoubleDouble| {
            let error = (a - b).abs().to_f64();
            assert!(error <= 2.0 * DoubleDouble::EPS * b.abs().to_f64(), "{a:?} {b:?}");
        };
        let third = DoubleDouble::ONE / DoubleDouble::new(3.0);
        for exponent in [-660, -300, -1, 0, 1, 300, 660] {
            let unit = 2f64.powi(exponent);
            let mut x = third.times(unit);
            for k in 1..200 {
                x += third.times(unit * k as f64);
                let y = DoubleDouble::new(1.0 + k as f64).sqrt() / x;
                near(x * y * (x * y), DoubleDouble::new(1.0 + k as f64));
                near(y / third * third, y);
                near(DoubleDouble::over([third], x)[0] * x, third);
                assert_eq!(x.half() + x.half(), x);
                assert_eq!((x - x.half()).half().half().to_f64(), 0.125 * x.to_f64());
            }
        }
    }

    #[test]
    fn infinities_differ_by_infinities() {
        let [one, infinity] = [DoubleDouble::ONE, DoubleDouble::INFINITY];
        assert_eq!(infinity.less(one), f64::INFINITY);
        assert_eq!(one.less(infinity), f64::NEG_INFINITY);
        assert!(DoubleDouble::new(f64::NAN).less(one).is_nan());
        assert_eq!(DoubleDouble::new(f64::NAN).smaller(one), one);
        assert_eq!(one.larger(DoubleDouble::new(f64::NAN)), one);
        assert!(infinity > one && -infinity < one);
    }

    #[test]
    fn a_point_of_a_ray_from_afar_loses_nothing() {
        // 1/3 in f64 times 3 2^80, against the origin: what is left is known exactly.
        let t = DoubleDouble::new(3.0 * 2f64.powi(80)) + DoubleDouble::new(0.125);
        let left = t.on_ray(-(2f64.powi(80)), 1.0 / 3.0);
        // 3 RN(1/3) = 1 - 2^-54.
        let expected = DoubleDouble::new(-(2f64.powi(26))) + DoubleDouble::new(1.0 / 3.0).times(0.125);
        assert_eq!(left, expected);
    }
}
