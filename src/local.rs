//! A projected surface near a point, to first order: what one step of Newton's method is made of.

use crate::bernstein::{self, BasisView, Degrees, Full, Jet};
use crate::limits::{Limit, Limits, Work, spend};
use crate::parameter::Parameter;
use crate::planes::Planes;
use crate::point::{Flat, Point};
use crate::scalar::Scalar;
use crate::story::Event;
use crate::surface::{Shape, Surface};

/// How exactly one ray can meet one surface: lengths in the frame, as [`Local::distance`] measures them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exactness<S> {
    /// How far from the ray a root may lie.
    pub(crate) tolerance: S,
    /// What rounding alone may make of the distance between the ray and a point of the surface.
    pub(crate) rounding: S,
    /// The longest side of the surface's box.
    pub(crate) size: S,
    /// Bounds the coordinates, of the surface and of the ray near it.
    pub(crate) reach: S,
}

impl<S: Scalar> Exactness<S> {
    /// Of a ray and a surface: to the share of the surface's size that `limits` say, and not below what rounding of its coordinates
    /// and of the ray's leaves.
    #[inline(always)]
    pub(crate) fn of<P: Point<Scalar = S>>(surface: &Surface<'_, P>, planes: &Planes<S>, limits: &Limits<S>) -> Self {
        let (Degrees { u, v }, Shape { size, .. }) = (surface.net.degrees(), surface.shape);
        // Of the projection, and of the sums of products of which evaluation consists.
        let roundings = S::from_u32(8 + u32::from(u) + u32::from(v));
        Exactness {
            tolerance: (limits.tolerance * size).greater(planes.noise()),
            rounding: S::EPSILON * roundings * planes.reach(),
            size,
            reach: planes.reach(),
        }
    }

    /// The sine below which an angle between ray and surface makes a hit grazing.
    #[inline(always)]
    pub(crate) fn graze(&self) -> S {
        (self.tolerance / self.size).sqrt() * S::from_u32(GRAZE)
    }

    /// By how much a point of the projected net may be off: some three roundings of numbers below 4 times the coordinates;
    /// twice that, so that an edge which two surfaces share but for its last bits is lost by neither. The sides of regions
    /// round, too, and a rational surface may move by its degree in roundings where a parameter moves by two.
    #[inline(always)]
    pub(crate) fn of_net<F: Flat<Scalar = S>>(&self, degrees: Degrees) -> S {
        let both = u32::from(degrees.u) + u32::from(degrees.v);
        let roundings = if F::RATIONAL { 8 + both } else { both.max(8) };
        S::EPSILON * S::from_u32(roundings) * self.reach
    }

    /// How far a point may be from the ray, and the ray still meet the surface there: of a ray between two surfaces that share an
    /// edge each finds the point on its own side of the edge, or beyond it by what rounding may have done.
    #[inline(always)]
    pub(crate) fn allowed(&self) -> S {
        self.tolerance + self.rounding
    }
}

/// The sine of a grazing angle is at most so many times the square root of the tolerance's share of the surface. Larger calls more
/// hits grazing, smaller leaves some clear ones less exact than their angle says.
const GRAZE: u32 = 4;

/// The projected surface near a point, to first order: what one step of Newton's method is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local<A: Parameter> {
    /// (u, v) of the point.
    pub(crate) at: [A; 2],
    f_g: [A::Scalar; 2],
    du: [A::Scalar; 2],
    dv: [A::Scalar; 2],
    determinant: A::Scalar,
    /// The product of the derivatives' lengths.
    size: A::Scalar,
    /// The weight at the point, by which all else is divided: products of several would vanish where it is small.
    pub(crate) weight: A::Scalar,
    /// The weight's derivatives, as shares of it; 0 without weights.
    slopes: [A::Scalar; 2],
}

impl<S: Scalar, A: Parameter<Scalar = S>> Local<A> {
    /// Of a projected net, at (u, v).
    #[inline(always)]
    pub(crate) fn at<F: Flat<Scalar = S, Parameter = A>>(
        at: [A; 2],
        degrees: Degrees,
        net: &[F],
        basis: &mut BasisView<'_, S>,
    ) -> Result<Self, Limit> {
        let jet = bernstein::jet(degrees, net, at, basis, |p| p).map_err(|Full| Limit::Scratch)?;
        let Jet { mut point, mut du, mut dv } = jet;
        let (weight, mut slopes) = (point.weight(), [S::ZERO; 2]);
        if F::RATIONAL {
            let inverse = S::ONE / weight;
            (point, du, dv) = (point * inverse, du * inverse, dv * inverse);
            // Of a point without weight that is constant.
            slopes = [du.weight(), dv.weight()];
        }
        let (f_g, [fu, gu], [fv, gv]) = (point.f_g(), du.f_g(), dv.f_g());
        let determinant = fu * gv - gu * fv;
        let size = (fu.abs() + gu.abs()) * (fv.abs() + gv.abs());
        Ok(Local { at, f_g, du: [fu, gu], dv: [fv, gv], determinant, size, weight, slopes })
    }

    /// The same as a step of Newton's method: counted, and told.
    #[inline(always)]
    pub(crate) fn step_at<F: Flat<Scalar = S, Parameter = A>>(
        at: [A; 2],
        degrees: Degrees,
        net: &[F],
        basis: &mut BasisView<'_, S>,
        limits: &Limits<S>,
        work: &mut Work,
    ) -> Result<Self, Limit> {
        spend(&mut work.newton_steps, limits.newton_steps, Limit::NewtonSteps)?;
        let local = Local::at(at, degrees, net, basis)?;
        S::tell(|| Event::Step { at: at.map(|c| c.number().to_f64()), residual: local.distance().to_f64() });
        Ok(local)
    }

    /// How far the point is from the ray: |f| + |g|.
    #[inline(always)]
    pub(crate) fn distance(&self) -> S {
        let [f, g] = self.f_g;
        f.abs() + g.abs()
    }

    /// The point in the two planes' system: f and g.
    pub(crate) fn off(&self) -> [S; 2] {
        self.f_g
    }

    /// The point's distance from the ray in the direction of a unit vector of the two planes' system, and its derivatives by u
    /// and v (of the numerator, over the weight).
    pub(crate) fn seen_along(&self, [x, y]: [S; 2]) -> (S, [S; 2]) {
        let along = |[f, g]: [S; 2]| f * x + g * y;
        (along(self.f_g), [along(self.du), along(self.dv)])
    }

    /// Whether the ray is tangent, from the derivatives of the depth (of a rational surface over the weight); see
    /// [`Incidence`](crate::ray::Incidence). A pole has no tangent plane, and is not.
    #[inline(always)]
    pub(crate) fn is_tangent(&self, [depth_u, depth_v]: [S; 2], exact: &Exactness<S>) -> bool {
        // The surface's normal in the system of the two planes and depth, in which the ray is (0, 0, 1).
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let normal = [gu * depth_v - depth_u * gv, depth_u * fv - fu * depth_v, self.determinant];
        let [a, b, c] = normal.map(S::abs);
        c < exact.graze() * (a + b + c)
    }

    /// Whether the ray is seen to be no tangent from f and g alone, which is true of most roots: the derivatives of depth are
    /// at most the degrees times twice the coordinates' reach. (Of a rational surface both its parts, numerator and weight, are
    /// bounded apart.)
    #[inline(always)]
    pub(crate) fn is_steep<F: Flat<Scalar = S, Parameter = A>>(&self, degrees: Degrees, exact: &Exactness<S>) -> bool {
        let twice = if F::RATIONAL { 8 } else { 2 };
        let reach = if F::RATIONAL { exact.reach / self.weight } else { exact.reach };
        let [deepest_u, deepest_v] = [degrees.u, degrees.v].map(|n| S::from_u32(twice * u32::from(n)) * reach);
        let ([fu, gu], [fv, gv], c) = (self.du, self.dv, self.determinant.abs());
        let all = (fu.abs() + gu.abs()) * deepest_v + (fv.abs() + gv.abs()) * deepest_u + c;
        // By squares, since a small machine may take the root by a call. What vanishes or overflows is not seen to be steep.
        c * c * exact.size > S::from_u32(GRAZE * GRAZE) * exact.tolerance * (all * all)
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

    /// Whether the Jacobian's determinant is below 0.
    #[inline(always)]
    pub(crate) fn is_turned(&self) -> bool {
        self.determinant < S::ZERO
    }

    /// Whether rounding alone may make the determinant what it is: each of its four factors is off by some roundings of
    /// coordinates below twice `reach`, not of its own size.
    #[inline(always)]
    pub(crate) fn may_be_singular(&self, reach: S) -> bool {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let lengths = fu.abs() + gu.abs() + (fv.abs() + gv.abs());
        !(self.determinant.abs() > S::EPSILON * S::from_u32(32) * reach * lengths)
    }

    /// The least weight that a surface may have no farther from here than by this step, or 0, as a share of that here: to first
    /// order, and half of that.
    #[inline(always)]
    fn lightest<F: Flat<Scalar = S, Parameter = A>>(&self, [du, dv]: [S; 2]) -> S {
        if !F::RATIONAL {
            return S::ONE;
        }
        let [by_u, by_v] = self.slopes;
        (S::ONE - (by_u * du).abs() - (by_v * dv).abs()).greater(S::ZERO) * S::HALF
    }

    /// What is bounded times the weight, as [`Net::bend`](crate::surface::Net::bend) is, as it is here.
    #[inline(always)]
    pub(crate) fn unweighted<F: Flat<Scalar = S, Parameter = A>>(&self, bound: S) -> S {
        if F::RATIONAL { bound / self.weight } else { bound }
    }

    /// Whether a surface that strays from its linear part here by no more than this, times the weight, does so by no more than the
    /// tolerance all along a step.
    #[inline(always)]
    pub(crate) fn is_linear<F: Flat<Scalar = S, Parameter = A>>(
        &self,
        strays: S,
        step: [S; 2],
        exact: &Exactness<S>,
    ) -> bool {
        self.unweighted::<F>(strays) <= exact.tolerance * self.lightest::<F>(step)
    }

    /// Whether the step leads to within the tolerance as far as rounding is concerned, of which Taylor's theorem says nothing:
    /// the determinant's share of it, see [`Local::may_be_singular`], is one of the step, and so of the residual. Of a flat net
    /// seen edge on all of the determinant may be rounding.
    #[inline(always)]
    pub(crate) fn is_regular_enough<F: Flat<Scalar = S, Parameter = A>>(
        &self,
        step: [S; 2],
        exact: &Exactness<S>,
    ) -> bool {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let lengths = fu.abs() + gu.abs() + (fv.abs() + gv.abs());
        let mut rounding = S::EPSILON * S::from_u32(32) * exact.reach * lengths;
        // Derivatives over a weight may be as much larger, and so may what they are off by.
        if F::RATIONAL {
            rounding += S::EPSILON * S::from_u32(16) * self.size;
        }
        // The weight may fall along the step, by which distances grow.
        self.distance() * rounding <= exact.allowed() * self.determinant.abs() * self.lightest::<F>(step)
    }

    /// How fast the root moves, in u and in v, if the ray's slopes change as fast as each of these: f and g at a fixed place on
    /// the surface then change by that times the distance from the eye.
    #[inline(always)]
    pub(crate) fn rates(&self, reach: S, distance: S, slopes: [[S; 2]; 2]) -> Option<[[S; 2]; 2]> {
        if self.may_be_singular(reach) {
            return None;
        }
        let share = distance / self.determinant;
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let rate = |[f, g]: [S; 2]| [(gv * f - fv * g) * share, (fu * g - gu * f) * share];
        let [first, second] = slopes;
        // One by one, for `map` of a nested array may stay a call, whose results come through memory.
        Some([rate(first), rate(second)])
    }

    /// How far in u and in v the inverse of the Jacobian carries an error of this length in f and g.
    #[inline(always)]
    pub(crate) fn inverse_bounds(&self, error: S) -> [S; 2] {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let share = error / self.determinant.abs();
        [(fv.abs() + gv.abs()) * share, (fu.abs() + gu.abs()) * share]
    }

    /// Of a point on an edge from which a step leads beyond it: the place on the edge that the ray meets, if it passes the edge
    /// by no more than is allowed. Where u and v lead all but the same way, as the ray sees it, rounding moves a root along the
    /// edge, and out of it, by far more than the edge is off the ray; so the edge is followed alone. Then of two neighbours not
    /// both refuse a ray between them.
    #[cold]
    #[inline(never)]
    pub(crate) fn on_edge(&self, next: [A; 2], exact: &Exactness<S>) -> Option<[A; 2]> {
        for k in 0..2 {
            let free = 1 - k;
            let ([fd, gd], [f, g]) = ([self.du, self.dv][free], self.f_g);
            let step = -(fd * f + gd * g) / (fd * fd + gd * gd);
            let left = (f + fd * step).abs() + (g + gd * step).abs();
            let along = self.at[free].plus(step);
            let is_beyond = next[k].held(A::ZERO, A::ONE) != next[k] && next[k].held(A::ZERO, A::ONE) == self.at[k];
            if is_beyond && left <= exact.allowed() && along.held(A::ZERO, A::ONE) == along {
                let mut place = self.at;
                place[free] = along;
                return Some(place);
            }
        }
        (self.distance() <= exact.allowed()).then_some(self.at)
    }

    /// Whether a root may be held back by `off`, in u and v, from where the step leads: not judged by parameters, but by how
    /// far the ray sees the point move.
    #[inline(always)]
    pub(crate) fn may_hold(&self, off: [S; 2], exact: &Exactness<S>) -> bool {
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let moved = off[0].abs() * (fu.abs() + gu.abs()) + off[1].abs() * (fv.abs() + gv.abs());
        moved <= exact.allowed()
    }
}
