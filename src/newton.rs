//! Newton's method: a surface and a ray, from one start, in the two-dimensional system of the ray's planes.
//!
//! Source: the paper's section "Performance Comparison of Barth and Stürzlinger's Algorithm": the control net is projected
//! on the two planes, once for all starts of a ray on a surface, and the two-dimensional system is solved on it.
//!
//! A step is judged by what it leaves, which Taylor's theorem bounds before it is taken
//! ([`Net::bend`](crate::surface::Net::bend)), so the last step needs no evaluation after it. A small step alone is never
//! enough.

use crate::bernstein::{BasisView, Full};
use crate::limits::{Limit, Limits, Work};
use crate::local::{Local, noise};
use crate::planes::{Planes, project_net};
use crate::point::Point;
use crate::root::{Place, Root};
use crate::scalar::Scalar;
use crate::story::Event;
use crate::surface::Surface;
use heapless::vec::VecView;

/// A root, and the surface near it to first order.
type Followed<S> = (Root<S>, Local<S>);

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
        self.project()?;
        let flat = self.flat.get(..self.surface.net.points().len()).ok_or(Limit::Scratch)?;
        Local::step_at(at, self.surface.net.degrees(), flat, self.basis, self.limits, work)
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
            let local = Local::step_at([u, v], surface.net.degrees(), flat, self.basis, limits, work)?;
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

#[cfg(test)]
mod tests;
