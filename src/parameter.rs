//! A parameter of a surface, u or v, in [0, 1], as finely as space needs.
//!
//! A polynomial surface moves, per unit of a parameter, by no more than its degree times its size, so that a number in [0, 1] tells
//! its points apart to rounding. A rational one does not: with weights 1 and 10⁻⁹ at both ends of u, half of space lies within
//! 10⁻⁹ of u = 1, where numbers are 10⁻¹⁶ apart. But with x = u / (1 − u) the position is Σ w_i C(n, i) x^i P_i over the same
//! without P_i: a mean of the control points, whose derivative by log x is the covariance of i and P_i, at most n / 2 times their
//! extent, whatever the weights. So both u and 1 − u, each to the relative precision of its type, tell any rational surface's
//! points apart to n roundings of its size.

use crate::scalar::Scalar;
use core::fmt::Debug;

/// A parameter as surfaces of one kind hold it: [`Number`] for polynomial ones, [`BothEnds`] for rational ones.
pub trait Parameter: Copy + Debug + PartialEq + Send + Sync + 'static {
    /// The type of the numbers.
    type Scalar: Scalar;

    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;

    /// The parameter of this number, which may be somewhat outside [0, 1].
    fn new(number: Self::Scalar) -> Self;
    /// The nearest number.
    fn number(self) -> Self::Scalar;
    /// What is left up to 1.
    fn rest(self) -> Self::Scalar;
    /// Moved on by a step, which may lead outside [0, 1].
    #[must_use]
    fn plus(self, step: Self::Scalar) -> Self;
    /// The step from another one to this.
    fn minus(self, other: Self) -> Self::Scalar;
    /// Whether another one lies farther on.
    fn is_below(self, other: Self) -> bool;
    /// Whether another one lies here or farther on.
    fn is_at_most(self, other: Self) -> bool;
    /// The part `share` of the way from this one to a later one; `rest` is 1 − `share`, as finely as the caller knows it.
    #[must_use]
    fn toward(self, later: Self, share: Self::Scalar, rest: Self::Scalar) -> Self;

    /// The one in the middle between two.
    #[must_use]
    fn middle(low: Self, high: Self) -> Self;
    /// This one counted over [0, `whole`] instead of [0, 1].
    #[must_use]
    fn part_of(self, whole: Self) -> Self;

    /// The nearest one between two others.
    #[must_use]
    #[inline(always)]
    fn held(self, low: Self, high: Self) -> Self {
        if self.is_below(low) {
            low
        } else if high.is_below(self) {
            high
        } else {
            self
        }
    }

    /// The later one; `self` when they compare equal.
    #[must_use]
    #[inline(always)]
    fn later(self, other: Self) -> Self {
        if self.is_below(other) { other } else { self }
    }

    /// The earlier one; `self` when they compare equal.
    #[must_use]
    #[inline(always)]
    fn earlier(self, other: Self) -> Self {
        if other.is_below(self) { other } else { self }
    }
}

/// A parameter as one number.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Number<S>(S);

impl<S: Scalar> Parameter for Number<S> {
    type Scalar = S;
    const ZERO: Self = Number(S::ZERO);
    const ONE: Self = Number(S::ONE);

    #[inline(always)]
    fn new(number: S) -> Self {
        Number(number)
    }
    #[inline(always)]
    fn number(self) -> S {
        self.0
    }
    #[inline(always)]
    fn rest(self) -> S {
        S::ONE - self.0
    }
    #[inline(always)]
    fn plus(self, step: S) -> Self {
        Number(self.0 + step)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> S {
        self.0 - other.0
    }
    #[inline(always)]
    fn is_below(self, other: Self) -> bool {
        self.0 < other.0
    }
    #[inline(always)]
    fn is_at_most(self, other: Self) -> bool {
        self.0 <= other.0
    }
    #[inline(always)]
    fn toward(self, later: Self, share: S, _rest: S) -> Self {
        if share == S::ONE { later } else { Number(self.0 + (later.0 - self.0) * share) }
    }
    #[inline(always)]
    fn middle(low: Self, high: Self) -> Self {
        Number((low.0 + high.0) * S::HALF)
    }
    #[inline(always)]
    fn part_of(self, whole: Self) -> Self {
        Number(self.0 / whole.0)
    }
}

/// A parameter as its distances from 0 and from 1.
///
/// Their sum is 1 but for rounding: a rational surface depends on their ratio alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct BothEnds<S> {
    from_zero: S,
    to_one: S,
}

impl<S: Scalar> Parameter for BothEnds<S> {
    type Scalar = S;
    const ZERO: Self = BothEnds { from_zero: S::ZERO, to_one: S::ONE };
    const ONE: Self = BothEnds { from_zero: S::ONE, to_one: S::ZERO };

    #[inline(always)]
    fn new(number: S) -> Self {
        BothEnds { from_zero: number, to_one: S::ONE - number }
    }
    #[inline(always)]
    fn number(self) -> S {
        self.from_zero
    }
    #[inline(always)]
    fn rest(self) -> S {
        self.to_one
    }
    #[inline(always)]
    fn plus(self, step: S) -> Self {
        BothEnds { from_zero: self.from_zero + step, to_one: self.to_one - step }
    }
    #[inline(always)]
    fn minus(self, other: Self) -> S {
        // By the end that is nearer, from which both are known better.
        if self.from_zero + other.from_zero <= S::ONE {
            self.from_zero - other.from_zero
        } else {
            other.to_one - self.to_one
        }
    }
    #[inline(always)]
    fn is_below(self, other: Self) -> bool {
        self.minus(other) < S::ZERO
    }
    #[inline(always)]
    fn is_at_most(self, other: Self) -> bool {
        self.minus(other) <= S::ZERO
    }
    #[inline(always)]
    fn toward(self, later: Self, share: S, rest: S) -> Self {
        if rest == S::ZERO {
            return later;
        }
        if share == S::ZERO {
            return self;
        }
        let width = later.minus(self);
        // Sums of what is not negative, so that neither distance loses digits.
        BothEnds { from_zero: self.from_zero + width * share, to_one: later.to_one + width * rest }
    }
    #[inline(always)]
    fn middle(low: Self, high: Self) -> Self {
        BothEnds { from_zero: (low.from_zero + high.from_zero) * S::HALF, to_one: (low.to_one + high.to_one) * S::HALF }
    }
    #[inline(always)]
    fn part_of(self, whole: Self) -> Self {
        let inverse = S::ONE / whole.from_zero;
        BothEnds { from_zero: self.from_zero * inverse, to_one: whole.minus(self) * inverse }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws<A: Parameter>() {
        let [zero, half, one] = [A::ZERO, A::new(A::Scalar::HALF), A::ONE];
        assert!(zero.is_below(half) && half.is_below(one) && !half.is_below(half));
        assert_eq!(zero.toward(one, A::Scalar::HALF, A::Scalar::HALF), half);
        assert_eq!(
            [zero.toward(half, A::Scalar::ONE, A::Scalar::ZERO), half.later(zero), half.earlier(one)],
            [half; 3]
        );
        assert_eq!([one.plus(A::Scalar::HALF), zero.plus(-A::Scalar::HALF)].map(|t| t.held(zero, one)), [one, zero]);
        assert_eq!(one.plus(A::Scalar::HALF).minus(one), A::Scalar::HALF);
    }

    #[test]
    fn both_kinds_keep_the_laws() {
        laws::<Number<f32>>();
        laws::<BothEnds<f32>>();
    }

    #[test]
    fn near_one_a_step_is_as_fine_as_near_zero() {
        let near = BothEnds::<f64>::ONE.plus(-1e-30);
        assert!(near.is_below(Parameter::ONE) && near.rest() == 1e-30 && near.number() == 1.0);
        let middle = near.toward(Parameter::ONE, 0.5, 0.5);
        assert_eq!((middle.rest(), middle.minus(near)), (5e-31, 5e-31));
        assert_eq!(BothEnds::new(0.25).plus(0.5).minus(BothEnds::new(0.25)), 0.5);
    }
}
