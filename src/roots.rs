//! The roots that one ray was found to have on one surface, each once.
//!
//! A root on the border between two regions is found in both; one at a collapsed edge, all of whose parameters name one
//! point, in every region that touches the edge.

use crate::bernstein::BasisView;
use crate::graze::{BESIDE, CONTACT};
use crate::limits::Limit;
use crate::local::{Exactness, Local};
use crate::parameter::Parameter;
use crate::planes::Planes;
use crate::point::Point;
use crate::ray::Incidence;
use crate::root::Root;
use crate::scalar::Scalar;
use crate::surface::Surface;
use heapless::vec::VecView;

/// The roots seen so far, and what it takes to compare them.
pub(crate) struct Seen<'a, 'm, P: Point> {
    pub(crate) surface: &'a Surface<'m, P>,
    pub(crate) planes: &'a Planes<P::Scalar>,
    /// The surface's projected net.
    pub(crate) whole: &'a [P::Flat],
    pub(crate) exact: &'a Exactness<P::Scalar>,
}

/// What a root is to those seen before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sighting<A: Parameter> {
    /// Another one.
    New,
    /// One of them.
    Known,
    /// Not to be told from this one, but met before it.
    Nearer(Root<A>),
}

impl<P: Point> Seen<'_, '_, P> {
    /// Adds a root to those seen, and says what it is.
    #[inline(always)]
    pub(crate) fn add(
        &self,
        root: &mut Root<P::Parameter>,
        roots: &mut VecView<Root<P::Parameter>>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<Sighting<P::Parameter>, Limit> {
        if !roots.is_empty()
            && let Some(known) = self.compare(root, roots, basis)?
        {
            return Ok(known);
        }
        // Those for which there is no room may be found again.
        let _ = roots.push(*root);
        Ok(Sighting::New)
    }

    /// What a root is if it is one of those seen; `None` of another one.
    #[inline(never)]
    fn compare(
        &self,
        root: &mut Root<P::Parameter>,
        roots: &mut VecView<Root<P::Parameter>>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<Option<Sighting<P::Parameter>>, Limit> {
        // A tolerance across the ray is more along it.
        let near = self.exact.allowed() * P::Scalar::from_u32(BESIDE);
        for old in roots.iter_mut() {
            // On a straight line that the ray follows all points are one root; those outside the interval must not stand for
            // the ones within.
            if self.planes.t_in_interval(old.depth).is_none() {
                continue;
            }
            let apart = (old.depth - root.depth).abs();
            // Of two roots between which the ray has been on the surface's other side one is turned and the other is not: where the
            // ray crosses it, they are two, however near they are.
            let cross = [old.incidence, root.incidence].contains(&Incidence::Crossing);
            if cross && old.turned != root.turned && apart > near {
                continue;
            }
            let same = self.surface.same_root([old.u, old.v], [root.u, root.v], self.exact.tolerance);
            if same || ((apart <= near || !cross) && self.joins(old, root, basis)?) {
                if apart > self.exact.size * P::Scalar::from_f64(CONTACT) {
                    root.incidence = Incidence::Contact;
                }
                let first = root.depth < old.depth && self.planes.t_in_interval(root.depth).is_some();
                if first {
                    return Ok(Some(Sighting::Nearer(core::mem::replace(old, *root))));
                }
                return Ok(Some(Sighting::Known));
            }
        }
        Ok(None)
    }

    /// Whether the ray passes within what is allowed of the surface all the way from one root to another: at three places of
    /// uneven shares, so that roots that lie evenly are not taken for a way between two of them.
    fn joins(
        &self,
        a: &Root<P::Parameter>,
        b: &Root<P::Parameter>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<bool, Limit> {
        for share in [P::Scalar::from_f64(0.381), P::Scalar::HALF, P::Scalar::from_f64(0.803)] {
            let at = [a.u.plus(b.u.minus(a.u) * share), a.v.plus(b.v.minus(a.v) * share)];
            let degrees = self.surface.net.degrees();
            if !(Local::at(at, degrees, self.whole, basis)?.distance() <= self.exact.allowed()) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
