//! Newton's method: a surface and a ray, from one start, in the two-dimensional system of the ray's planes.
//!
//! Source: the paper's section "Performance Comparison of Barth and Stürzlinger's Algorithm": the control net is projected
//! on the two planes, once for all starts of a ray on a surface, and the two-dimensional system is solved on it.
//!
//! The paper says no more of the iteration. Ours:
//! - a step is judged by what it leaves, which Taylor's theorem bounds before it is taken
//!   ([`Net::bend`](crate::surface::Net::bend)), so the last step needs no evaluation after it; a small step alone is never
//!   enough;
//! - a step that does not lead closer is halved;
//! - an iterate beyond an edge is held there, and given up if the next one goes as far;
//! - a root beyond an edge by less than the tolerance is looked at from the edge.

use crate::bernstein::{BasisView, Full};
use crate::limits::{Limit, Limits, Work};
use crate::local::{Exactness, Local};
use crate::parameter::Parameter;
use crate::planes::{Planes, project_net};
use crate::point::Point;
use crate::root::{Place, Root};
use crate::scalar::Scalar;
use crate::story::Event;
use crate::surface::Surface;
use heapless::vec::VecView;

/// A root, and the surface near it to first order.
type Followed<A> = (Root<A>, Local<A>);

/// One ray and one surface.
#[derive(Debug)]
pub struct Solver<'a, 's, 'm, P: Point> {
    /// The surface.
    pub surface: Surface<'m, P>,
    /// The ray.
    pub planes: &'a Planes<P::Scalar>,
    /// Bounds on the work.
    pub limits: &'a Limits<P::Scalar>,
    /// How exactly they can meet.
    pub(crate) exact: Exactness<P::Scalar>,
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
        let exact = Exactness::of(surface, planes, limits);
        Solver { surface: *surface, planes, limits, exact, flat, basis, projected: false, decided: Decided::Nothing }
    }

    /// Solves from `start`; `None` if the iteration leads to no root, which does not prove that there is none.
    ///
    /// The iteration may leave the patch that gave the start: it works on the whole surface.
    pub fn solve(&mut self, start: [P::Scalar; 2], work: &mut Work) -> Result<Option<Root<P::Parameter>>, Limit> {
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
    ) -> Result<Option<Followed<P::Parameter>>, Limit> {
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
    fn root(&mut self, place: &Place<P::Parameter>) -> Result<Root<P::Parameter>, Limit> {
        let flat = self.flat.get(..self.surface.net.points().len()).ok_or(Limit::Scratch)?;
        place.root(&self.surface.net, flat, self.planes, &self.exact, self.basis)
    }

    /// The surface at (u, v) to first order.
    pub(crate) fn local(&mut self, at: [P::Parameter; 2], work: &mut Work) -> Result<Local<P::Parameter>, Limit> {
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
            self.exact = Exactness::of(surface, self.planes, self.limits);
        }
    }

    /// Where the iteration comes to.
    #[inline(always)]
    fn iterate(&mut self, start: [P::Scalar; 2], work: &mut Work) -> Result<Option<Place<P::Parameter>>, Limit> {
        let zero = P::Scalar::ZERO;
        let held = |at: [P::Parameter; 2]| at.map(|t| t.held(P::Parameter::ZERO, P::Parameter::ONE));
        self.project()?;
        let (surface, limits, exact) = (&self.surface, self.limits, &self.exact);
        let noise = self.planes.noise();
        let flat = self.flat.get(..surface.net.points().len()).ok_or(Limit::Scratch)?;
        work.newton_starts += 1;
        let mut at = held(start.map(P::Parameter::new));
        P::Scalar::tell(|| Event::Start(at.map(|t| t.number().to_f64())));
        let mut from = at;
        let mut step = [zero; 2];
        let mut last = P::Scalar::INFINITY;
        let mut halvings = 0;
        let mut beyond_before = P::Scalar::INFINITY;
        let mut at_edge = false;
        // Ends: a fixed number of evaluations.
        for _ in 0..limits.newton_iterations {
            let local = Local::step_at(at, surface.net.degrees(), flat, self.basis, limits, work)?;
            let residual = local.distance();
            // The residual before the Jacobian: at a pole the root is valid though the Jacobian is singular.
            if residual <= noise {
                return Ok(Some(Place { at, local }));
            }
            // Ours: damping. A NaN counts as growth.
            if !(residual < last) {
                if halvings >= limits.newton_halvings {
                    return Ok(None);
                }
                halvings += 1;
                step = step.map(|c| c * P::Scalar::HALF);
                at = [from[0].plus(step[0]), from[1].plus(step[1])];
                continue;
            }
            let Some([du, dv]) = local.step() else {
                return Ok(None);
            };
            let next = [at[0].plus(du), at[1].plus(dv)];
            let on_surface = held(next);
            let off = [next[0].minus(on_surface[0]), next[1].minus(on_surface[1])];
            if local.is_linear::<P::Flat>(surface.strays([du, dv]), [du, dv], exact)
                && local.is_regular_enough::<P::Flat>([du, dv], exact)
            {
                // Ours: converged; what is left to see is whether the root lies on the surface or beyond its edge. Of a root on
                // an edge the step may leave as much on the far side as on the near: neighbours must not both refuse it. Toward
                // an edge the weight may fall, by which distances grow: of what is held there it is to be looked at there.
                let seen = !P::RATIONAL || at_edge || off == [zero; 2];
                if seen && local.may_hold(off, exact) {
                    return Ok(Some(Place { at: on_surface, local }));
                }
                // Ours: what the step leaves across the ray is within the tolerance, but where the ray is all but tangent it carries
                // far along the surface: one more, from the edge, says on which side of it the root lies.
                if at_edge {
                    return Ok(local.on_edge(next, exact).map(|at| Place { at, local }));
                }
                at_edge = true;
                (at, last) = (on_surface, P::Scalar::INFINITY);
                continue;
            }
            // Ours: an iterate outside is held at the edge, where a root may lie; one that goes on as far is leaving for good.
            let beyond = off[0].abs() + off[1].abs();
            if !(beyond + beyond <= beyond_before) {
                return Ok(None);
            }
            beyond_before = if beyond > zero { beyond } else { P::Scalar::INFINITY };
            (from, last, halvings) = (at, residual, 0);
            step = [on_surface[0].minus(at[0]), on_surface[1].minus(at[1])];
            at = on_surface;
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests;
