//! Where a ray meets a surface: the place that a search ended at, and the root there.

use crate::bernstein::{BasisView, Degrees, Full};
use crate::limits::{Limit, Limits};
use crate::local::Local;
use crate::planes::Planes;
use crate::point::{Flat, Point};
use crate::ray::Hit;
use crate::scalar::Scalar;
use crate::story::Event;
use crate::surface::Net;

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
