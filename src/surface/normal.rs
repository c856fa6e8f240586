//! The normal of a surface, and whether there is one.
//!
//! Where both first derivatives are there and not parallel it is their product, N = ∂S/∂u × ∂S/∂v, of unit length. Elsewhere N
//! vanishes, and the normal is the limit of N over its length. Nearby, N is its terms of lowest order, a form in the way
//! (a, b) from (u, v) with vectors for coefficients; all ways lead to the same tangent plane if all coefficients are parallel.

use super::{Net, V};
use crate::bernstein::{BasisView, Direction, Full, Jet};
use crate::parameter::Parameter;
use crate::point::Point;
use crate::scalar::{Scalar, Vector3};

/// What rounding is measured by: how large a net is.
struct Extent<S> {
    /// By how much a component of a first derivative may be off, where the weight is that of the heaviest point.
    off: S,
    /// The largest |coordinate|.
    reach: S,
    /// The largest weight; 1 without weights.
    heaviest: S,
    /// What coordinates are multiplied by 2 to the power of, so that products of derivatives neither overflow nor vanish.
    exponent: i32,
}

/// A surface to second order about a point, in units in which no coordinate is above 1.
struct Nearby<P: Point> {
    point: V<P>,
    /// In u and v.
    first: [V<P>; 2],
    /// In uu, uv and vv.
    second: [V<P>; 3],
    /// By how much the point, first and second derivatives may be off, in any component.
    off: [P::Scalar; 3],
}

/// A vector, or several, and by how much a component may be off.
struct Known<T, S> {
    value: T,
    off: S,
}

/// By how many times what a vector may be off it has to be longer for its direction to be known.
const KNOWN: u32 = 16;

impl<P: Point> Net<'_, P> {
    /// The unit normal at (u, v), along ∂S/∂u × ∂S/∂v; `None` where the surface has none.
    ///
    /// Where that product vanishes, the normal is its limit, if all ways to the point lead to the same tangent plane: as at the
    /// pole of a sphere, or at an edge that is collapsed in a plane. Its sign is then that on the way from the middle of the
    /// domain; at a cusp that holds the middle, that toward larger u or v. A line of constant u or v that is a single point counts
    /// as that point: at the apex of a cone the ways to the points of the collapsed edge lead to different planes, and there is no
    /// normal. Nor is there one of a surface that is a point or a curve.
    ///
    /// Derivatives up to the second decide. Where they do not, as where two rows of control points are one point, or only by
    /// less than what rounding may have done to them, there is no normal either.
    pub fn normal(
        &self,
        u: P::Scalar,
        v: P::Scalar,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<Option<[P::Scalar; 3]>, Full> {
        let extent = self.extent();
        let Jet { point, du, dv } = self.jet(u, v, basis)?;
        let (inverse, place) = (P::Scalar::ONE / point.weight(), V::<P>::from_array(point.position()));
        let [su, sv] = [du, dv].map(|d| {
            let along = V::<P>::from_array(d.weighted_position());
            if P::RATIONAL { (along - place * d.weight()) * inverse } else { along }
        });
        let (regular, longest) = (su.cross(sv), su.largest().greater(sv.largest()));
        let length = regular.largest();
        // What overflows, or vanishes by underflow, is left to the careful way.
        if length > extent.off * (extent.heaviest * inverse) * longest && length.is_finite() {
            return Ok(unit::<P>(regular));
        }
        self.limit_of_normals([u, v], &extent, basis)
    }

    /// The same where ∂S/∂u × ∂S/∂v vanishes, or is too large or small a number.
    #[cold]
    #[inline(never)]
    fn limit_of_normals(
        &self,
        at: [P::Scalar; 2],
        extent: &Extent<P::Scalar>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<Option<[P::Scalar; 3]>, Full> {
        let extent = &extent.scaled();
        let here = self.nearby(at, extent, basis)?;
        let [su, sv] = here.first;
        let regular = su.cross(sv);
        if regular.largest() > here.off[1] * su.largest().greater(sv.largest()) {
            return Ok(unit::<P>(regular));
        }
        let Some(limit) = here.limit(at.map(|c| P::Scalar::HALF - c)).filter(|limit| here.touches(limit)) else {
            return Ok(None);
        };
        for (direction, degree) in [(Direction::U, self.degrees.u), (Direction::V, self.degrees.v)] {
            if !here.vanishes(direction) {
                continue;
            }
            // Around a line that is a point the surface is a cone over a curve of this degree, which lies in a plane if one more of
            // its points do than the degree says.
            let (mut is_point, mut is_plane) = (true, true);
            for i in 0..=degree {
                let mut place = at;
                place[direction as usize] = P::Scalar::from_u32(u32::from(i)) / P::Scalar::from_u32(u32::from(degree));
                let there = self.nearby(place, extent, basis)?;
                is_point &= (there.point - here.point).largest() <= there.off[0].greater(here.off[0]);
                is_plane &= there.touches(&limit);
            }
            if is_point && !is_plane {
                return Ok(None);
            }
        }
        Ok(unit::<P>(limit.value))
    }

    /// The surface about (u, v).
    fn nearby(
        &self,
        at: [P::Scalar; 2],
        extent: &Extent<P::Scalar>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<Nearby<P>, Full> {
        basis.fill(self.degrees(), at.map(P::Parameter::new))?;
        // sums[i][j]: i derivatives in u, j in v.
        let mut sums = [[P::ZERO; 3]; 3];
        for (row, b) in self.rows().zip(basis.u.iter()) {
            let mut along = [P::ZERO; 3];
            for (&p, c) in row.iter().zip(basis.v.iter()) {
                for k in 0..3 {
                    along[k] = along[k] + p * c[k];
                }
            }
            for i in 0..3 {
                for j in 0..3 {
                    sums[i][j] = sums[i][j] + along[j] * b[i];
                }
            }
        }
        let vector = |p: P| V::<P>::from_array(p.weighted_position());
        let [[s, sv, svv], [su, suv, _], [suu, _, _]] = sums;
        let scaled = |v: V<P>| V::<P>::from_array(v.to_array().map(|c| c.times_power_of_two(extent.exponent)));
        let four = P::Scalar::from_u32(4);
        let offs = |weights: P::Scalar| {
            let first = extent.off * weights;
            [first * four, first, first * weights * four * self.highest_degree()]
        };
        if !P::RATIONAL {
            return Ok(Nearby {
                point: scaled(vector(s)),
                first: [su, sv].map(|p| scaled(vector(p))),
                second: [suu, suv, svv].map(|p| scaled(vector(p))),
                off: offs(P::Scalar::ONE),
            });
        }
        // Quotient rule, from w·S = X.
        let inverse = P::Scalar::ONE / s.weight();
        let point = vector(s) * inverse;
        let two = P::Scalar::TWO;
        let d_u = (vector(su) - point * su.weight()) * inverse;
        let d_v = (vector(sv) - point * sv.weight()) * inverse;
        let d_uu = (vector(suu) - d_u * (two * su.weight()) - point * suu.weight()) * inverse;
        let d_uv = (vector(suv) - d_v * su.weight() - d_u * sv.weight() - point * suv.weight()) * inverse;
        let d_vv = (vector(svv) - d_v * (two * sv.weight()) - point * svv.weight()) * inverse;
        Ok(Nearby {
            point: scaled(point),
            first: [d_u, d_v].map(scaled),
            second: [d_uu, d_uv, d_vv].map(scaled),
            off: offs(extent.heaviest * inverse),
        })
    }

    /// How large the net is.
    fn extent(&self) -> Extent<P::Scalar> {
        let first = V::<P>::from_array(self.corners()[0].position());
        let (mut size, mut reach) = (P::Scalar::ZERO, P::Scalar::ZERO);
        let mut heaviest = if P::RATIONAL { P::Scalar::ZERO } else { P::Scalar::ONE };
        for p in self.points {
            let point = V::<P>::from_array(p.position());
            size = size.greater((point - first).largest());
            reach = reach.greater(point.largest());
            if P::RATIONAL {
                heaviest = heaviest.greater(p.weight());
            }
        }
        // Of first derivatives what is below this share of the size is rounding: a few dozen operations went into each. So it is
        // of a place that is nearer to a collapsed edge than roots are found. Control points are themselves off by the rounding
        // of their coordinates.
        let share = (P::Scalar::EPSILON * P::Scalar::from_u32(64)).greater(P::Scalar::from_f64(4e-13));
        let off = share * size + P::Scalar::EPSILON * P::Scalar::from_u32(4) * self.highest_degree() * reach;
        Extent { off, reach, heaviest, exponent: 0 }
    }

    /// The higher one of its degrees.
    fn highest_degree(&self) -> P::Scalar {
        P::Scalar::from_u32(u32::from(self.degrees.u.max(self.degrees.v)))
    }
}

impl<S: Scalar> Extent<S> {
    /// In units in which no coordinate is above 1.
    fn scaled(&self) -> Self {
        let some = self.reach > S::ZERO && self.reach.is_finite();
        let exponent = if some { -self.reach.binary_exponent() } else { 0 };
        let [off, reach] = [self.off, self.reach].map(|c| c.times_power_of_two(exponent));
        Extent { off, reach, exponent, ..*self }
    }
}

impl<P: Point> Nearby<P> {
    /// Whether the first derivative in a direction is no more than rounding.
    fn vanishes(&self, direction: Direction) -> bool {
        self.first[direction as usize].largest() <= self.off[1] * P::Scalar::from_u32(4)
    }

    /// Whether both do.
    fn both_vanish(&self) -> bool {
        self.vanishes(Direction::U) && self.vanishes(Direction::V)
    }

    /// Of the product N of the first derivatives, which vanishes here, the terms of lowest order nearby: the coefficients of a and
    /// b or, if both derivatives vanish, of a², ab and b².
    fn forms(&self) -> Known<[V<P>; 3], P::Scalar> {
        let ([su, sv], [suu, suv, svv], [_, off1, off2]) = (self.first, self.second, self.off);
        let (first, second) =
            (su.largest().greater(sv.largest()), suu.largest().greater(suv.largest()).greater(svv.largest()));
        let four = P::Scalar::from_u32(4);
        if self.both_vanish() {
            Known { value: [suu.cross(suv), suu.cross(svv), suv.cross(svv)], off: four * second * off2 }
        } else {
            let value = [suu.cross(sv) + su.cross(suv), suv.cross(sv) + su.cross(svv), V::<P>::ZERO];
            Known { value, off: four * (second * off1 + first * off2) }
        }
    }

    /// The direction of N on the way (a, b); if that is not known, as on the way along a cusp, that on another way.
    fn limit(&self, [a, b]: [P::Scalar; 2]) -> Option<Known<V<P>, P::Scalar>> {
        let Known { value: [f, g, h], off } = self.forms();
        let [p, q, r] = if self.both_vanish() { [a * a, a * b, b * b] } else { [a, b, P::Scalar::ZERO] };
        let on_the_way = Known { value: f * p + g * q + h * r, off: off * (p.abs() + q.abs() + r.abs()) };
        let others = [f, g, h].map(|value| Known { value, off });
        let known = |v: &Known<V<P>, P::Scalar>| v.value.largest() > v.off * P::Scalar::from_u32(KNOWN);
        if known(&on_the_way) {
            return Some(on_the_way);
        }
        let longer = |a: Known<V<P>, _>, b: Known<V<P>, _>| if b.value.largest() > a.value.largest() { b } else { a };
        others.into_iter().reduce(longer).filter(known)
    }

    /// Whether all ways from here lead to the plane with this normal, as far as is known.
    fn touches(&self, limit: &Known<V<P>, P::Scalar>) -> bool {
        let Known { value, off } = self.forms();
        let length = limit.value.largest();
        value.iter().all(|form| {
            let apart = form.cross(limit.value).largest();
            apart <= P::Scalar::TWO * (off * length + limit.off * form.largest())
        })
    }
}

/// A vector over its length, if that can be said.
fn unit<P: Point>(vector: V<P>) -> Option<[P::Scalar; 3]> {
    let unit = vector.unit().to_array();
    let is_one = unit.iter().all(|c| c.is_finite()) && unit.iter().any(|c| *c != P::Scalar::ZERO);
    if is_one { Some(unit) } else { None }
}

#[cfg(test)]
mod tests;
