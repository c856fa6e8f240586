//! Newton's method: a surface and a ray, from one start, in the two-dimensional system of the ray's planes.
//!
//! Source: the paper's section "Performance Comparison of Barth and Stürzlinger's Algorithm": the control net is projected
//! on the two planes, once for all starts of a ray on a surface, and the two-dimensional system is solved on it.
//!
//! A step is judged by what it leaves, which Taylor's theorem bounds before it is taken
//! ([`Net::bend`](crate::surface::Net::bend)), so the last step needs no evaluation after it. A small step alone is never
//! enough.

use crate::bernstein::{self, BasisView, Degrees, Full};
use crate::limits::{Limit, Limits, Work, spend};
use crate::planes::{Planes, project_net};
use crate::point::{Flat, Point};
use crate::ray::Hit;
use crate::scalar::Scalar;
use crate::story::Event;
use crate::surface::{Net, Surface};
use heapless::vec::VecView;

/// A root: where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Surface parameter, in [0, 1].
    pub u: S,
    /// Surface parameter, in [0, 1].
    pub v: S,
    /// Depth along the ray, in the frame.
    pub depth: S,
    /// Whether the ray is tangent to working precision: at an angle to the surface whose sine is below 4 √tolerance. A
    /// displacement of the ray by the tolerance may then merge this root with another, and t, u and v are known to about
    /// half the digits.
    pub grazing: bool,
}

impl<S: Scalar> Root<S> {
    /// That it was found.
    fn told(&self) -> Event {
        let Root { u, v, depth, grazing } = *self;
        Event::Root { at: [u, v].map(S::to_f64), depth: depth.to_f64(), grazing }
    }

    /// The root as a hit, at the ray's parameter `t`, of a surface.
    #[inline(always)]
    pub(crate) fn hit(self, surface: u32, t: S) -> Hit<S> {
        Hit { t, u: self.u, v: self.v, surface, grazing: self.grazing }
    }
}

/// The projected surface near a point, to first order: what one step of Newton's method is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local<S> {
    /// (u, v) of the point.
    at: [S; 2],
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

    /// How far the point is from the ray: |f| + |g|.
    #[inline(always)]
    pub(crate) fn distance(&self) -> S {
        self.residual() / self.weight
    }

    /// That it was looked at.
    pub(crate) fn told(&self) -> Event {
        Event::Step { at: self.at.map(S::to_f64), residual: self.distance().to_f64() }
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
    fn is_tangent(&self, [depth_u, depth_v]: [S; 2], tolerance: S) -> bool {
        // The surface's normal in the system of the two planes and depth, in which the ray is (0, 0, 1).
        let ([fu, gu], [fv, gv]) = (self.du, self.dv);
        let normal = [gu * depth_v - depth_u * gv, depth_u * fv - fu * depth_v, self.determinant];
        let [a, b, c] = normal.map(S::abs);
        c < sine(tolerance) * (a + b + c)
    }

    /// Whether the ray is seen to be no tangent from f and g alone, which is true of most roots: the derivatives of depth are at
    /// most the degrees times twice the coordinates' `reach`.
    #[inline(always)]
    fn is_steep(&self, degrees: Degrees, reach: S, tolerance: S) -> bool {
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
    fn is_regular_enough<P: Point<Scalar = S>>(&self, tolerance: S) -> bool {
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

/// A root around which no other can lie: how near is told by the surface's derivatives near the root and by how much they can
/// change.
///
/// With δ the way from the root to another one, J the Jacobian at a point that lies off the root by σ, and b the bounds of
/// [`Net::bend`](crate::surface::Net::bend), Taylor's theorem gives |J δ| ≤ (b₀ (|δ_u| + 2 σ_u) + b₁ σ_v) |δ_u| + (b₁ (|δ_u| + σ_u) +
/// b₂ (|δ_v| + 2 σ_v)) |δ_v|. Let the brackets be at most α and β. With |δ| ≤ (a, b) · |J δ|, where a and b are the row sums of |J⁻¹|, this is
/// |J δ| ≤ (a α + b β) |J δ|: so where a α + b β < 1, there is no δ but 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Alone<S> {
    root: [S; 2],
    /// σ.
    off: [S; 2],
    /// a and b.
    inverse: [S; 2],
    bend: [S; 3],
}

impl<S: Scalar> Alone<S> {
    /// Of a root on a surface, near which `local` holds.
    #[inline(always)]
    pub(crate) fn new(root: &Root<S>, local: &Local<S>, bend: [S; 3]) -> Self {
        let (root, [u, v]) = ([root.u, root.v], local.at);
        let off = [(root[0] - u).abs(), (root[1] - v).abs()];
        // A Jacobian that may be all rounding says nothing.
        let one = if local.may_be_singular() { S::INFINITY } else { S::ONE };
        Alone { root, off, inverse: local.inverse_bounds(one), bend }
    }

    /// Whether it is proved that no other root lies in a rectangle of the surface's domain. A NaN proves nothing.
    #[inline(always)]
    pub(crate) fn within(&self, [[u0, u1], [v0, v1]]: [[S; 2]; 2]) -> bool {
        let Alone { root: [u, v], off: [off_u, off_v], inverse: [a, b], bend: [uu, uv, vv] } = *self;
        // The farther of two sides, without a branch that nothing could foretell.
        let farther = |t: S, low: S, high: S| (t - (low + high) * S::HALF).abs() + (high - low) * S::HALF;
        let (far_u, far_v) = (farther(u, u0, u1), farther(v, v0, v1));
        let alpha = uu * (far_u + off_u + off_u) + uv * off_v;
        let beta = uv * (far_u + off_u) + vv * (far_v + off_v + off_v);
        a * alpha + b * beta < S::from_f64(0.999)
    }
}

/// A root, and the surface near it to first order.
type Followed<S> = (Root<S>, Local<S>);

/// Where a search ended: (u, v), and the surface there or nearby.
pub(crate) struct Place<S> {
    pub(crate) at: [S; 2],
    pub(crate) local: Local<S>,
}

impl<S: Scalar> Place<S> {
    /// The root there; `whole` is the surface's projected net.
    #[inline(always)]
    pub(crate) fn root<P: Point<Scalar = S>>(
        &self,
        net: &Net<'_, P>,
        whole: &[P::Flat],
        planes: &Planes<S>,
        limits: &Limits<S>,
        basis: &mut BasisView<'_, S>,
    ) -> Result<Root<S>, Limit> {
        if !self.local.is_steep(net.degrees(), planes.reach() * weighted::<P>(), limits.tolerance) {
            return self.shallow_root(net, whole, planes, limits, basis);
        }
        let depth = planes.depth_on(net, self.at, basis).map_err(|Full| Limit::Scratch)?;
        let [u, v] = self.at;
        let root = Root { u, v, depth, grazing: false };
        S::tell(|| root.told());
        Ok(root)
    }

    /// The same where the ray may be tangent, or the surface is of very uneven speed.
    #[cold]
    #[inline(never)]
    fn shallow_root<P: Point<Scalar = S>>(
        &self,
        net: &Net<'_, P>,
        whole: &[P::Flat],
        planes: &Planes<S>,
        limits: &Limits<S>,
        basis: &mut BasisView<'_, S>,
    ) -> Result<Root<S>, Limit> {
        let along = planes.depth_derivatives(net, self.at, basis).map_err(|Full| Limit::Scratch)?;
        let grazing = self.local.is_tangent(along, limits.tolerance);
        let whole_domain = [[S::ZERO, S::ONE]; 2];
        let Place { at, local } = Place::polished(self.at, whole_domain, net.degrees(), whole, basis)?;
        let mut depth = planes.depth_on(net, at, basis).map_err(|Full| Limit::Scratch)?;
        if !grazing {
            // Where the least step of u or v that the number type holds is a way in space, the depth is known better than they
            // can be said.
            let unsaid =
                |step: &[S; 2]| step.iter().all(|c| c.abs() <= S::EPSILON * S::from_u32(4)) && !local.may_be_singular();
            if let Some([du, dv]) = local.step().filter(unsaid) {
                depth += (along[0] * du + along[1] * dv) / local.weight;
            }
        }
        let [u, v] = at;
        let root = Root { u, v, depth, grazing };
        S::tell(|| root.told());
        Ok(root)
    }

    /// The place at (u, v) of a projected net.
    #[inline(always)]
    pub(crate) fn look<F: Flat<Scalar = S>>(
        at: [S; 2],
        degrees: Degrees,
        net: &[F],
        basis: &mut BasisView<'_, S>,
    ) -> Result<Self, Limit> {
        Ok(Place { at, local: Local::at(at, degrees, net, basis)? })
    }

    /// Where a few of Newton's steps lead from (u, v) within a rectangle of the domain, as long as each brings the ray nearer.
    /// What a tolerance leaves across the ray is, along it, more by the inverse of the angle, or for cubic contact a third of the
    /// digits.
    #[cold]
    #[inline(never)]
    pub(crate) fn polished<F: Flat<Scalar = S>>(
        at: [S; 2],
        within: [[S; 2]; 2],
        degrees: Degrees,
        net: &[F],
        basis: &mut BasisView<'_, S>,
    ) -> Result<Self, Limit> {
        let mut place = Place::look(at, degrees, net, basis)?;
        for _ in 0..POLISHING {
            // Along a line that the ray follows, rounding alone would choose where to go.
            let Some(step) = place.local.step().filter(|_| !place.local.may_be_singular()) else {
                break;
            };
            let to = |k: usize| (place.at[k] + step[k]).clamped(within[k][0], within[k][1]);
            let next = Place::look([to(0), to(1)], degrees, net, basis)?;
            if !(next.local.distance() < place.local.distance()) {
                break;
            }
            place = next;
        }
        Ok(place)
    }
}

/// By how much more than a plain surface's the derivatives of a rational one may be: both its parts, numerator and weight, are
/// bounded apart.
#[inline(always)]
fn weighted<P: Point>() -> P::Scalar {
    if P::RATIONAL { P::Scalar::from_u32(4) } else { P::Scalar::ONE }
}

/// Steps that polishing is worth: from the tolerance of `f32` three reach its rounding, and from within the error of a net of
/// 15 × 15 two mostly do.
const POLISHING: u32 = 3;

/// The sine below which an angle between ray and surface makes a hit grazing. Of a tolerance below rounding it is that of
/// rounding: what a Jacobian of nothing but roundings says is no angle.
#[inline(always)]
fn sine<S: Scalar>(tolerance: S) -> S {
    tolerance.greater(noise()).sqrt() * S::from_u32(4)
}

/// One ray and one surface.
#[derive(Debug)]
pub struct Solver<'a, 's, 'm, P: Point> {
    /// The surface.
    pub surface: Surface<'m, P>,
    /// The ray.
    pub planes: &'a Planes<P::Scalar>,
    /// Bounds on the work.
    pub limits: &'a Limits<P::Scalar>,
    /// Room for the projected net.
    pub(crate) flat: &'a mut VecView<P::Flat>,
    pub(crate) basis: &'a mut BasisView<'s, P::Scalar>,
    /// Whether `flat` holds the net: it is projected for the first start, since most rays that reach a surface's box give
    /// none.
    projected: bool,
    /// How much of the surface the ray's fallback has decided.
    pub(crate) decided: Decided,
}

/// How much of a surface has been searched for all roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Decided {
    /// Nothing.
    Nothing,
    /// One patch.
    Patch,
    /// All of it.
    Surface,
}

impl<'a, 's, 'm, P: Point> Solver<'a, 's, 'm, P> {
    /// A solver with lent room for the projected net and for evaluating it.
    #[inline(always)]
    pub fn new(
        surface: &Surface<'m, P>,
        planes: &'a Planes<P::Scalar>,
        limits: &'a Limits<P::Scalar>,
        flat: &'a mut VecView<P::Flat>,
        basis: &'a mut BasisView<'s, P::Scalar>,
    ) -> Self {
        Solver { surface: *surface, planes, limits, flat, basis, projected: false, decided: Decided::Nothing }
    }

    /// Solves from `start`; `None` if the iteration leads to no root, which does not prove that there is none.
    ///
    /// The iteration may leave the patch that gave the start: it works on the whole surface.
    pub fn solve(&mut self, start: [P::Scalar; 2], work: &mut Work) -> Result<Option<Root<P::Scalar>>, Limit> {
        match self.iterate(start, work)? {
            Some(place) => self.root(&place).map(Some),
            None => {
                P::Scalar::tell(|| Event::Stuck);
                Ok(None)
            }
        }
    }

    /// As [`Solver::solve`], and the surface there to first order.
    #[inline(always)]
    pub(crate) fn follow(
        &mut self,
        start: [P::Scalar; 2],
        work: &mut Work,
    ) -> Result<Option<Followed<P::Scalar>>, Limit> {
        match self.iterate(start, work)? {
            Some(place) => Ok(Some((self.root(&place)?, place.local))),
            None => {
                P::Scalar::tell(|| Event::Stuck);
                Ok(None)
            }
        }
    }

    /// The root at a place that the iteration came to.
    #[inline(always)]
    fn root(&mut self, place: &Place<P::Scalar>) -> Result<Root<P::Scalar>, Limit> {
        let flat = self.flat.get(..self.surface.net.points().len()).ok_or(Limit::Scratch)?;
        place.root(&self.surface.net, flat, self.planes, self.limits, self.basis)
    }

    /// The surface at (u, v) to first order.
    pub(crate) fn local(&mut self, at: [P::Scalar; 2], work: &mut Work) -> Result<Local<P::Scalar>, Limit> {
        spend(&mut work.newton_steps, self.limits.newton_steps, Limit::NewtonSteps)?;
        self.project()?;
        let flat = self.flat.get(..self.surface.net.points().len()).ok_or(Limit::Scratch)?;
        let local = Local::at(at, self.surface.net.degrees(), flat, self.basis)?;
        P::Scalar::tell(|| local.told());
        Ok(local)
    }

    /// Sees to it that `flat` holds the projected net.
    #[inline(always)]
    pub(crate) fn project(&mut self) -> Result<(), Limit> {
        if !self.projected {
            project_net(&self.surface.net, self.planes, self.flat).map_err(|Full| Limit::Scratch)?;
            self.projected = true;
        }
        Ok(())
    }

    /// Goes over to another surface, if it is another.
    #[inline(always)]
    pub(crate) fn turn_to(&mut self, surface: &Surface<'m, P>) {
        if self.surface.number != surface.number {
            P::Scalar::tell(|| Event::Surface(surface.number));
            (self.surface, self.projected, self.decided) = (*surface, false, Decided::Nothing);
        }
    }

    /// Where the iteration comes to.
    #[inline(always)]
    fn iterate(&mut self, start: [P::Scalar; 2], work: &mut Work) -> Result<Option<Place<P::Scalar>>, Limit> {
        let (zero, one) = (P::Scalar::ZERO, P::Scalar::ONE);
        self.project()?;
        let (surface, limits) = (&self.surface, self.limits);
        let flat = self.flat.get(..surface.net.points().len()).ok_or(Limit::Scratch)?;
        work.newton_starts += 1;
        let [mut u, mut v] = start.map(|t| t.clamped(zero, one));
        P::Scalar::tell(|| Event::Start([u.to_f64(), v.to_f64()]));
        let (mut from_u, mut from_v) = (u, v);
        let (mut step_u, mut step_v) = (zero, zero);
        let mut last = P::Scalar::INFINITY;
        let mut halvings = 0;
        let mut beyond_before = P::Scalar::INFINITY;
        let mut at_edge = false;
        // Ends: a fixed number of evaluations.
        for _ in 0..limits.newton_iterations {
            spend(&mut work.newton_steps, limits.newton_steps, Limit::NewtonSteps)?;
            let local = Local::at([u, v], surface.net.degrees(), flat, self.basis)?;
            P::Scalar::tell(|| local.told());
            let residual = local.residual();
            // The residual before the Jacobian: at a pole the root is valid though the Jacobian is singular.
            if residual <= noise::<P::Scalar>() * local.weight {
                return Ok(Some(Place { at: [u, v], local }));
            }
            // Damping. A NaN counts as growth.
            if !(residual < last) {
                if halvings >= limits.newton_halvings {
                    return Ok(None);
                }
                halvings += 1;
                (step_u, step_v) = (step_u * P::Scalar::HALF, step_v * P::Scalar::HALF);
                (u, v) = (from_u + step_u, from_v + step_v);
                continue;
            }
            let Some([du, dv]) = local.step() else {
                return Ok(None);
            };
            let (next_u, next_v) = (u + du, v + dv);
            let (held_u, held_v) = (next_u.clamped(zero, one), next_v.clamped(zero, one));
            if surface.strays([du, dv]) <= limits.tolerance && local.is_regular_enough::<P>(limits.tolerance) {
                // Converged; what is left to see is whether the root lies on the surface or beyond its edge. Of a root on
                // an edge the step may leave as much on the far side as on the near: neighbours must not both refuse it. Toward
                // an edge the weight may fall, by which distances grow: of what is held there it is to be looked at there.
                let off = [next_u - held_u, next_v - held_v];
                let seen = !P::RATIONAL || at_edge || off == [zero; 2];
                if seen && local.may_hold(off, limits.tolerance) {
                    return Ok(Some(Place { at: [held_u, held_v], local }));
                }
                // What the step leaves across the ray is within the tolerance, but where the ray is all but tangent it carries
                // far along the surface: one more, from the edge, says on which side of it the root lies.
                if at_edge {
                    return Ok(None);
                }
                at_edge = true;
                (u, v, last) = (held_u, held_v, P::Scalar::INFINITY);
                continue;
            }
            // An iterate outside is held at the edge, where a root may lie; one that goes on as far is leaving for good.
            let beyond = (next_u - held_u).abs() + (next_v - held_v).abs();
            if !(beyond + beyond <= beyond_before) {
                return Ok(None);
            }
            beyond_before = if beyond > zero { beyond } else { P::Scalar::INFINITY };
            (from_u, from_v, last, halvings) = (u, v, residual, 0);
            (step_u, step_v) = (held_u - u, held_v - v);
            (u, v) = (held_u, held_v);
        }
        Ok(None)
    }
}

/// Residuals up to this, in the frame, are rounding of the evaluation: a few sums of numbers below 1.
#[inline(always)]
pub(crate) fn noise<S: Scalar>() -> S {
    S::EPSILON * S::TWO
}

#[cfg(test)]
mod tests;
