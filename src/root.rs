//! Where a ray meets a surface: the place that a search ended at, and the root there.

use crate::bernstein::{BasisView, Degrees, Full};
use crate::limits::Limit;
use crate::local::{Exactness, Local};
use crate::parameter::Parameter;
use crate::planes::Planes;
use crate::point::{Flat, Point};
use crate::ray::{Hit, Incidence};
use crate::scalar::Scalar;
use crate::story::Event;
use crate::surface::Net;

/// A root: where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<A: Parameter> {
    /// Surface parameter, in [0, 1].
    pub u: A,
    /// Surface parameter, in [0, 1].
    pub v: A,
    /// Depth along the ray, in the frame.
    pub depth: A::Scalar,
    /// How the ray meets the surface.
    pub incidence: Incidence,
    /// Whether u and v turn one way around the ray there, or the other: two neighbouring crossings differ in it.
    pub turned: bool,
}

impl<S: Scalar, A: Parameter<Scalar = S>> Root<A> {
    /// (u, v), as the nearest numbers.
    #[inline(always)]
    pub fn at(&self) -> [S; 2] {
        [self.u, self.v].map(|t| t.number().clamped(S::ZERO, S::ONE))
    }

    /// That it was found.
    fn told(&self) -> Event {
        let Root { u, v, depth, incidence, .. } = *self;
        Event::Root { at: [u, v].map(|c| c.number().to_f64()), depth: depth.to_f64(), incidence }
    }

    /// The root as a hit, at the ray's parameter `t`, of a surface.
    #[inline(always)]
    pub(crate) fn hit(self, surface: u32, t: S) -> Hit<S> {
        let [u, v] = self.at();
        Hit { t, u, v, surface, incidence: self.incidence }
    }
}

/// Where a search ended: (u, v), and the surface there or nearby.
#[derive(Clone, Copy)]
pub(crate) struct Place<A: Parameter> {
    pub(crate) at: [A; 2],
    pub(crate) local: Local<A>,
}

impl<S: Scalar, A: Parameter<Scalar = S>> Place<A> {
    /// The root there; `whole` is the surface's projected net.
    #[inline(always)]
    pub(crate) fn root<P: Point<Scalar = S, Parameter = A>>(
        &self,
        net: &Net<'_, P>,
        whole: &[P::Flat],
        planes: &Planes<S>,
        exact: &Exactness<S>,
        basis: &mut BasisView<'_, S>,
    ) -> Result<Root<A>, Limit> {
        if !self.local.is_steep::<P::Flat>(net.degrees(), exact) {
            return self.shallow_root(net, whole, planes, exact, basis);
        }
        let depth = planes.depth_on(net, self.at, basis).map_err(|Full| Limit::Scratch)?;
        let [u, v] = self.at;
        let root = Root { u, v, depth, incidence: Incidence::Crossing, turned: self.local.is_turned() };
        S::tell(|| root.told());
        Ok(root)
    }

    /// The same where the ray may be tangent, or the surface is of very uneven speed.
    #[cold]
    #[inline(never)]
    fn shallow_root<P: Point<Scalar = S, Parameter = A>>(
        &self,
        net: &Net<'_, P>,
        whole: &[P::Flat],
        planes: &Planes<S>,
        exact: &Exactness<S>,
        basis: &mut BasisView<'_, S>,
    ) -> Result<Root<A>, Limit> {
        let along = planes.depth_derivatives(net, self.at, basis).map_err(|Full| Limit::Scratch)?;
        let grazing = self.local.is_tangent(along, exact);
        let whole_domain = [[A::ZERO, A::ONE]; 2];
        let Place { at, local } = Place::polished(self.at, whole_domain, net.degrees(), whole, exact, false, basis)?;
        let mut depth = planes.depth_on(net, at, basis).map_err(|Full| Limit::Scratch)?;
        if !grazing {
            // Where the least step of u or v that can be told there is a way in space, the depth is known better than they can
            // be said.
            let told = |at: A, step: S| at.plus(step * S::from_f64(0.25)) != at;
            let unsaid =
                |&[du, dv]: &[S; 2]| !told(at[0], du) && !told(at[1], dv) && !local.may_be_singular(exact.reach);
            if let Some([du, dv]) = local.step().filter(unsaid) {
                depth += along[0] * du + along[1] * dv;
            }
        }
        let [u, v] = at;
        let incidence = if grazing { Incidence::Grazing } else { Incidence::Crossing };
        let root = Root { u, v, depth, incidence, turned: local.is_turned() };
        S::tell(|| root.told());
        Ok(root)
    }

    /// The place at (u, v) of a projected net.
    #[inline(always)]
    pub(crate) fn look<F: Flat<Scalar = S, Parameter = A>>(
        at: [A; 2],
        degrees: Degrees,
        net: &[F],
        basis: &mut BasisView<'_, S>,
    ) -> Result<Self, Limit> {
        Ok(Place { at, local: Local::at(at, degrees, net, basis)? })
    }

    /// Where a few of Newton's steps lead from (u, v) within a rectangle of the domain, as long as each brings the ray nearer, or
    /// the one after it does if `patient`: where a weight falls, what the first leaves of second order is more than what is left of
    /// a shallow root's distance. In a large rectangle such a step may lead to another root.
    /// What a tolerance leaves across the ray is, along it, more by the inverse of the angle, or for cubic contact a third of the
    /// digits.
    #[cold]
    #[inline(never)]
    pub(crate) fn polished<F: Flat<Scalar = S, Parameter = A>>(
        at: [A; 2],
        within: [[A; 2]; 2],
        degrees: Degrees,
        net: &[F],
        exact: &Exactness<S>,
        patient: bool,
        basis: &mut BasisView<'_, S>,
    ) -> Result<Self, Limit> {
        let mut best = Place::look(at, degrees, net, basis)?;
        let (mut place, mut waited) = (best, !patient);
        for _ in 0..POLISHING {
            // On a line that the ray follows, rounding alone would choose where to go.
            if place.local.may_be_singular(exact.reach) && place.local.distance() <= exact.rounding {
                break;
            }
            let Some(step) = place.local.step() else {
                break;
            };
            let to = |k: usize| place.at[k].plus(step[k]).held(within[k][0], within[k][1]);
            place = Place::look([to(0), to(1)], degrees, net, basis)?;
            if place.local.distance() < best.local.distance() {
                best = place;
            } else if core::mem::replace(&mut waited, true) {
                break;
            }
        }
        Ok(best)
    }
}

/// Steps that polishing is worth: from the tolerance of `f32` three reach its rounding, and from within the error of a net of
/// 15 × 15 two mostly do.
const POLISHING: u32 = 3;
