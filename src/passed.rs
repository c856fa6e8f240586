//! Proofs that the ray passes a region by: where its net is all within the error of the ray, and no clip tells.
//!
//! Ours, by Taylor's theorem ([`Net::bend`](crate::surface::Net::bend)).

use crate::bernstein::BasisView;
use crate::clip::unit;
use crate::limits::Limit;
use crate::local::{Exactness, Local};
use crate::part::Part;
use crate::point::Point;
use crate::region::Region;
use crate::scalar::Scalar;
use crate::surface::Surface;

/// Whether the ray is proved to pass all of a region by more than rounding: it passes a corner by more than the others lie from
/// that, as the net tells; or, within the net's error, by what [`passes`] says.
#[cold]
#[inline(never)]
pub(crate) fn all_pass<P: Point>(
    surface: &Surface<'_, P>,
    whole: &[P::Flat],
    part: &Part<'_, P::Flat>,
    exact: &Exactness<P::Scalar>,
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<bool, Limit> {
    let [[u, _], [v, _]] = part.region.sides;
    let corner = Local::at([u, v], surface.net.degrees(), whole, basis)?;
    if corner.distance() > part.extent() + part.error + exact.rounding {
        return Ok(true);
    }
    passes(surface, whole, &part.region, None, exact, basis)
}

/// Whether the ray is proved by Taylor's theorem to pass all of a region by more than rounding in the direction of this unit vector
/// of the two planes' system, or in that in which it passes the middle.
#[cold]
#[inline(never)]
pub(crate) fn passes<P: Point>(
    surface: &Surface<'_, P>,
    whole: &[P::Flat],
    region: &Region<P::Parameter>,
    direction: Option<[P::Scalar; 2]>,
    exact: &Exactness<P::Scalar>,
    basis: &mut BasisView<'_, P::Scalar>,
) -> Result<bool, Limit> {
    let [half_u, half_v] = region.widths().map(|width| width * P::Scalar::HALF);
    let local = Local::at(region.middle(), surface.net.degrees(), whole, basis)?;
    // Of a rational surface all is of the numerator over the weight at the middle.
    let (off, [by_u, by_v]) = local.seen_along(direction.unwrap_or_else(|| unit(local.off())));
    let strays = local.unweighted::<P::Flat>(surface.strays([half_u, half_v]));
    Ok(off.abs() > by_u.abs() * half_u + by_v.abs() * half_v + strays + exact.rounding)
}
