//! A projected surface near a point, to first order: what one step of Newton's method is made of.

use crate::bernstein::{self, BasisView, Degrees, Full};
use crate::limits::{Limit, Limits, Work, spend};
use crate::point::{Flat, Point};
use crate::scalar::Scalar;
use crate::story::Event;

/// The projected surface near a point, to first order: what one step of Newton's method is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local<S> {
    /// (u, v) of the point.
    pub(crate) at: [S; 2],
    f_g: [S; 2],
    du: [S; 2],
    dv: [S; 2],
    determinant: S,
    /// The product of the derivatives' lengths.
    size: S,
    /// The weight at the point: all else is multiplied by it.
    pub(crate) weight: S,
}

impl<S: Scalar> Local<S> {
    /// Of a projected net, at (u, v).
    #[inline(always)]
    pub(crate) fn at<F: Flat<Scalar = S>>(
        at: [S; 2],
        degrees: Degrees,
        net: &[F],
        basis: &mut BasisView<'_, S>,
    ) -> Result<Self, Limit> {
        let jet = bernstein::jet(degrees, net, at, basis, |p| p).map_err(|Full| Limit::Scratch)?;
        let (f_g, [fu, gu], [fv, gv]) = (jet.point.f_g(), jet.du.f_g(), jet.dv.f_g());
        let determinant = fu * gv - gu * fv;
        let size = (fu.abs() + gu.abs()) * (fv.abs() + gv.abs());
        Ok(Local { at, f_g, du: [fu, gu], dv: [fv, gv], determinant, size, weight: jet.point.weight() })
    }

    /// The same as a step of Newton's method: counted, and told.
    #[inline(always)]
    pub(crate) fn step_at<F: Flat<Scalar = S>>(
        at: [S; 2],
        degrees: Degrees,
        net: &[F],
        basis: &mut BasisView<'_, S>,
        limits: &Limits<S>,
        work: &mut Work,
    ) -> Result<Self, Limit> {
        spend(&mut work.newton_steps, limits.newton_steps, Limit::NewtonSteps)?;
        let local = Local::at(at, degrees, net, basis)?;
        S::tell(|| Event::Step { at: at.map(S::to_f64), residual: local.distance().to_f64() });
        Ok(local)
    }

    /// How far the point is from the ray: |f| + |g|.
    #[inline(always)]
    pub(crate) fn distance(&self) -> S {
        self.residual() / self.weight
    }

    /// |f| + |g|, times the weight.
    #[inline(always)]
    pub(crate) fn residual(&self) -> S {
        let [f, g] = self.f_g;
        f.abs() + g.abs()
    }

    /// The point's distance from the ray in the direction of a unit vector of the two planes' system, and its derivatives by u
    /// and v; all times the weight.
    pub(crate) fn seen_along(&self, [x, y]: [S; 2]) -> (S, [S; 2]) {
        let along = |[f, g]: [S; 2]| f * x + g * y;
        (along(self.f_g), [along(self.du), along(self.dv)])
    }

    /// Whether the ray is tangent, from the derivatives of the depth; see [`Root::grazing`]. A pole has no tangent plane,
    /// and is not.
    #[inline(always)]
    pub(crate) fn is_tangent(&self, [depth_u, depth_v]: [S; 2], tolerance: S) -> bool {
        // The surface's normal in the system of the two planes and depth, in which the ray is (0, 0, 1).
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let normal = [gu * depth_v - depth_u * gv, depth_u * fv - fu * depth_v, self.determinant];
        let [a, b, c] = normal.map(S::abs);
        c < sine(tolerance) * (a + b + c)
    }

    /// Whether the ray is seen to be no tangent from f and g alone, which is true of most roots: the derivatives of depth are at
    /// most the degrees times twice the coordinates' `reach`.
    #[inline(always)]
    pub(crate) fn is_steep(&self, degrees: Degrees, reach: S, tolerance: S) -> bool {
        let [deepest_u, deepest_v] = [degrees.u, degrees.v].map(|n| S::from_u32(2 * u32::from(n)) * reach);
        let ([fu, gu], [fv, gv], c) = (self.du, self.dv, self.determinant.abs());
        c >= sine(tolerance) * ((fu.abs() + gu.abs()) * deepest_v + (fv.abs() + gv.abs()) * deepest_u + c)
    }

    /// The step to where both distances would be 0; `None` if the Jacobian is singular to working precision.
    #[inline(always)]
    pub(crate) fn step(&self) -> Option<[S; 2]> {
        if self.determinant.abs() <= S::EPSILON * self.size {
            return None;
        }
        let inverse = S::ONE / self.determinant;
        let ([f, g], [fu, gu], [fv, gv]) = (self.f_g, self.du, self.dv);
        Some([(fv * g - gv * f) * inverse, (gu * f - fu * g) * inverse])
    }

    /// Whether rounding alone may make the determinant what it is: each of its four factors is off by some roundings of
    /// coordinates below 2 times the weight, not of its own size.
    #[inline(always)]
    pub(crate) fn may_be_singular(&self) -> bool {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let lengths = fu.abs() + gu.abs() + (fv.abs() + gv.abs());
        !(self.determinant.abs() > S::EPSILON * S::from_u32(32) * lengths * self.weight)
    }

    /// Whether the step leads to within the tolerance as far as rounding is concerned, of which Taylor's theorem says nothing:
    /// the determinant's share of it, see [`Local::may_be_singular`], is one of the step, and so of the residual. Of a flat net
    /// seen edge on all of the determinant may be rounding.
    #[inline(always)]
    pub(crate) fn is_regular_enough<P: Point<Scalar = S>>(&self, tolerance: S) -> bool {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let lengths = fu.abs() + gu.abs() + (fv.abs() + gv.abs());
        // Distances are residuals over the weight, which may fall along the step.
        let falls = if P::RATIONAL { S::from_u32(16) } else { S::ONE };
        let rounding = S::EPSILON * S::from_u32(32) * falls;
        self.residual() * rounding * lengths <= (tolerance + noise()) * self.determinant.abs()
    }

    /// How fast the root moves, in u and in v, if the ray's slopes change as fast as each of these: f and g at a fixed place on
    /// the surface then change by that times the distance from the eye.
    #[inline(always)]
    pub(crate) fn rates(&self, distance: S, slopes: [[S; 2]; 2]) -> Option<[[S; 2]; 2]> {
        if self.may_be_singular() {
            return None;
        }
        let share = distance * self.weight / self.determinant;
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let rate = |[f, g]: [S; 2]| [(gv * f - fv * g) * share, (fu * g - gu * f) * share];
        let [first, second] = slopes;
        // One by one, for `map` of a nested array may stay a call, whose results come through memory.
        Some([rate(first), rate(second)])
    }

    /// How far in u and in v the inverse of the Jacobian carries an error of this length in f and g, times the weight.
    #[inline(always)]
    pub(crate) fn inverse_bounds(&self, error: S) -> [S; 2] {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let share = error / self.determinant.abs();
        [(fv.abs() + gv.abs()) * share, (fu.abs() + gu.abs()) * share]
    }

    /// Whether a root may be held back by `off`, in u and v, from where the step leads: not judged by parameters, but by how
    /// far the ray sees the point move.
    #[inline(always)]
    pub(crate) fn may_hold(&self, off: [S; 2], tolerance: S) -> bool {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let moved = off[0].abs() * (fu.abs() + gu.abs()) + off[1].abs() * (fv.abs() + gv.abs());
        moved <= (tolerance + noise()) * S::TWO * self.weight
    }
}

/// The sine below which an angle between ray and surface makes a hit grazing. Of a tolerance below rounding it is that of
/// rounding: what a Jacobian of nothing but roundings says is no angle.
#[inline(always)]
fn sine<S: Scalar>(tolerance: S) -> S {
    tolerance.greater(noise()).sqrt() * S::from_u32(4)
}

/// Residuals up to this, in the frame, are rounding of the evaluation: a few sums of numbers below 1.
#[inline(always)]
pub(crate) fn noise<S: Scalar>() -> S {
    S::EPSILON * S::TWO
}
