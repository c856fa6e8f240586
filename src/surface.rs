//! A Bézier surface: control net, degrees, weights; evaluation, derivatives, normal, halving, restriction to a domain.
//!
//! A surface of degrees n × m is S(u, v) = Σ B_i^n(u) B_j^m(v) P_ij with u and v in [0, 1]; control points are stored with
//! u as the outer index. Rational surfaces are kept homogeneous, (wx, wy, wz, w), so that the same sums serve both.
//! Source: G. Farin, "Curves and Surfaces for CAGD", chapters on Bernstein form, de Casteljau and rational surfaces.

use crate::arena::Need;
pub use crate::bernstein::Direction;
use crate::bernstein::{self, BasisView, Degrees, Full, Jet, Linear, MAX_DEGREE};
use crate::casteljau;
use crate::parameter::Parameter;
use crate::point::Point;
use crate::scalar::{Scalar, Vector3};
use heapless::vec::VecView;

mod normal;

/// Why a control net is not a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NetError {
    /// The degree in u is not within 1 to [`MAX_DEGREE`].
    DegreeU(usize),
    /// The degree in v is not within 1 to [`MAX_DEGREE`].
    DegreeV(usize),
    /// The number of points is not (n + 1)(m + 1).
    Points(Need),
    /// The point of this index has a coordinate that is NaN or infinite.
    NotFinite(usize),
    /// The point of this index has a weight that is not positive.
    Weight(usize),
    /// The net's own origin, or a point beside it, is not finite; or the points lie an eighth of the scene or more from it,
    /// along an axis.
    Origin,
    /// The net is so much smaller than its scene that its sides would lose digits to the least number of the type: by 2¹⁰³ in
    /// `f32`, by 2⁹⁷⁰ in `f64`. (One whose points are all the same has no sides to lose.)
    Small,
}

impl core::fmt::Display for NetError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            NetError::DegreeU(n) => write!(f, "degree {n} in u is not within 1 to {MAX_DEGREE}"),
            NetError::DegreeV(m) => write!(f, "degree {m} in v is not within 1 to {MAX_DEGREE}"),
            NetError::Points(need) => write!(f, "{} control points, not {}", need.given, need.needed),
            NetError::NotFinite(k) => write!(f, "control point {k} is not finite"),
            NetError::Weight(k) => write!(f, "the weight of control point {k} is not positive"),
            NetError::Origin => f.write_str("the control points are not near the net's own origin"),
            NetError::Small => f.write_str("it is too small beside the rest of the scene for this precision"),
        }
    }
}

impl core::error::Error for NetError {}

/// A control net: a view of lent points. See the module's head for the order of the points.
#[derive(Clone, Copy, Debug)]
pub struct Net<'m, P> {
    degrees: Degrees,
    points: &'m [P],
}

impl<'m, P: Point> Net<'m, P> {
    /// A view of `points` as a surface of these degrees; checks the degrees and the number of points.
    pub fn new(degree_u: usize, degree_v: usize, points: &'m [P]) -> Result<Self, NetError> {
        if !(1..=MAX_DEGREE).contains(&degree_u) {
            return Err(NetError::DegreeU(degree_u));
        }
        if !(1..=MAX_DEGREE).contains(&degree_v) {
            return Err(NetError::DegreeV(degree_v));
        }
        let needed = (degree_u + 1) * (degree_v + 1);
        if points.len() != needed {
            return Err(NetError::Points(Need { needed, given: points.len() }));
        }
        // Both are at most MAX_DEGREE here.
        Ok(Net { degrees: Degrees { u: degree_u as u8, v: degree_v as u8 }, points })
    }

    /// Also checks every point: finite, and with a positive weight.
    pub fn checked(degree_u: usize, degree_v: usize, points: &'m [P]) -> Result<Self, NetError> {
        let net = Net::new(degree_u, degree_v, points)?;
        for (k, point) in points.iter().enumerate() {
            let weight = point.weight();
            if point.weighted_position().iter().any(|c| !c.is_finite()) || !weight.is_finite() {
                return Err(NetError::NotFinite(k));
            }
            if weight <= P::Scalar::ZERO {
                return Err(NetError::Weight(k));
            }
        }
        Ok(net)
    }

    /// The degree in u.
    #[inline]
    pub fn degree_u(&self) -> usize {
        usize::from(self.degrees.u)
    }

    /// The degree in v.
    #[inline]
    pub fn degree_v(&self) -> usize {
        usize::from(self.degrees.v)
    }

    /// The control points, u outer.
    pub fn points(&self) -> &'m [P] {
        self.points
    }

    /// The rows of the net: for each index in u, the points along v.
    pub fn rows(&self) -> core::slice::ChunksExact<'m, P> {
        self.points.chunks_exact(self.degrees.columns())
    }

    /// The corners P_00, P_n0, P_0m, P_nm.
    pub fn corners(&self) -> [P; 4] {
        let row = self.degree_v();
        let last = self.degree_u() * (row + 1);
        [0, last, row, last + row].map(|k| self.points.get(k).copied().unwrap_or(P::EMPTY))
    }

    /// Both degrees.
    pub fn degrees(&self) -> Degrees {
        self.degrees
    }

    /// Point and first derivatives at (u, v), homogeneous if there are weights; slightly outside [0, 1] the polynomials go
    /// on.
    #[inline]
    pub fn jet(&self, u: P::Scalar, v: P::Scalar, basis: &mut BasisView<'_, P::Scalar>) -> Result<Jet<P>, Full> {
        self.jet_at([u, v].map(P::Parameter::new), basis)
    }

    /// The same where parameters are held as finely as space needs.
    #[inline(always)]
    pub(crate) fn jet_at(&self, at: [P::Parameter; 2], basis: &mut BasisView<'_, P::Scalar>) -> Result<Jet<P>, Full> {
        bernstein::jet(self.degrees(), self.points, at, basis, |p| p)
    }

    /// Value at (u, v) of what `part` takes from each control point.
    #[inline(always)]
    pub(crate) fn value_of<T: Linear<P::Scalar>>(
        &self,
        at: [P::Parameter; 2],
        basis: &mut BasisView<'_, P::Scalar>,
        part: impl Fn(P) -> T,
    ) -> Result<T, Full> {
        bernstein::value(self.degrees(), self.points, at, basis, part)
    }

    /// The position at (u, v), weight divided out.
    pub fn position(
        &self,
        u: P::Scalar,
        v: P::Scalar,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<[P::Scalar; 3], Full> {
        Ok(self.value_of([u, v].map(P::Parameter::new), basis, |p| p)?.position())
    }

    /// The control net of the part over [u0, u1] × [v0, v1], by de Casteljau's algorithm, into `out` (whose old content
    /// is dropped). A domain at the border of [0, 1] keeps that border's control points to the bit.
    pub fn restrict(&self, u: [P::Scalar; 2], v: [P::Scalar; 2], out: &mut VecView<P>) -> Result<(), Full> {
        out.clear();
        out.extend_from_slice(self.points).map_err(|_| Full)?;
        casteljau::restrict(self.degrees, out, Direction::U, u.map(P::Parameter::new));
        casteljau::restrict(self.degrees, out, Direction::V, v.map(P::Parameter::new));
        Ok(())
    }

    /// The two halves in one direction, at parameter 1/2.
    pub fn halve(&self, direction: Direction, low: &mut VecView<P>, high: &mut VecView<P>) -> Result<(), Full> {
        let (all, half) = ([P::Scalar::ZERO, P::Scalar::ONE], P::Scalar::HALF);
        let (front, back) = ([P::Scalar::ZERO, half], [half, P::Scalar::ONE]);
        match direction {
            Direction::U => self.restrict(front, all, low).and(self.restrict(back, all, high)),
            Direction::V => self.restrict(all, front, low).and(self.restrict(all, back, high)),
        }
    }
}

/// A surface of a scene, as the methods take it.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'m, P: Point> {
    /// Its number in the scene, from 0.
    pub number: u32,
    /// Its control net, in the frame, relative to [`Shape::origin`].
    pub net: Net<'m, P>,
    /// What is known of it beforehand.
    pub shape: Shape<P::Scalar>,
}

/// What is known of a surface beforehand: plain numbers, in the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Shape<S> {
    /// See [`Net::bend`].
    pub bend: [S; 3],
    /// The longest side of the box of its control points: what the tolerance is a share of.
    pub size: S,
    /// Its largest |coordinate|: what rounding is a share of.
    pub reach: S,
    /// Its least weight; 1 without weights.
    pub lightest: S,
    /// Where the net's coordinates are 0, in the frame: 0, unless the surface has an origin of its own.
    pub origin: [S; 3],
}

impl<S: Scalar> Shape<S> {
    /// Of nothing.
    pub const EMPTY: Self =
        Shape { bend: [S::ZERO; 3], size: S::ZERO, reach: S::ZERO, lightest: S::ZERO, origin: [S::ZERO; 3] };

    /// Of a net in the frame, without an origin of its own.
    pub(crate) fn of<P: Point<Scalar = S>>(net: &Net<'_, P>) -> Self {
        let longest = |vector: [S; 3]| S::Vec3::from_array(vector).largest();
        let (mut reach, mut low, mut high) = (S::ZERO, [S::INFINITY; 3], [S::LEAST; 3]);
        for point in net.points().iter().map(|point| point.position()) {
            reach = reach.greater(longest(point));
            low = core::array::from_fn(|k| low[k].lesser(point[k]));
            high = core::array::from_fn(|k| high[k].greater(point[k]));
        }
        let sides = core::array::from_fn(|k| high[k] - low[k]);
        let lightest = net.points().iter().fold(S::INFINITY, |least, point| least.lesser(point.weight()));
        let shape = Shape { size: longest(sides), reach, lightest, ..Shape::EMPTY };
        Shape { bend: net.bend(shape.unit()), ..shape }
    }

    /// Whether its coordinates are so much smaller than the scene's that rays have to be brought near it with care: for others
    /// the rounding of the scene's is hardly more than that of its own.
    #[inline(always)]
    pub(crate) fn is_apart(&self) -> bool {
        self.reach < S::from_f32(APART)
    }

    /// Whether its net has an origin of its own.
    pub(crate) fn is_moved(&self) -> bool {
        self.origin != [S::ZERO; 3]
    }

    /// Bounds the coordinates of the surface and of rays near it.
    #[inline(always)]
    pub(crate) fn unit(&self) -> S {
        if self.is_apart() { self.reach * S::TWO } else { S::ONE }
    }
}

/// See [`Shape::is_apart`]: the largest |coordinate| of a scene is between 1/2 and 1. Larger makes more rays be brought near with
/// care, some 200 instructions for each surface that such a ray comes to; smaller lets surfaces be met less exactly, by up to
/// its inverse times the rounding of their own coordinates.
pub(crate) const APART: f32 = 0.125;

impl<P: Point> Surface<'_, P> {
    /// How far from the ray one Newton step of (du, dv) may lead, times the weight there, whatever the ray and the place: see
    /// [`Net::bend`].
    #[inline(always)]
    pub fn strays(&self, [du, dv]: [P::Scalar; 2]) -> P::Scalar {
        let [uu, uv, vv] = self.shape.bend;
        uu * (du * du) + uv * (du * dv).abs() + vv * (dv * dv)
    }

    /// Whether two points where a ray meets the surface are one to within `tolerance`: if on the way from one to the other,
    /// in (u, v), the surface strays from the ray by no more.
    pub fn same_root(&self, a: [P::Parameter; 2], b: [P::Parameter; 2], tolerance: P::Scalar) -> bool {
        // Between two zeros, a function whose second-order part over the whole way is s strays by a quarter of it at most. The
        // roots themselves may be off by the tolerance.
        let lightest = if P::RATIONAL { self.shape.lightest } else { P::Scalar::ONE };
        self.strays([a[0].minus(b[0]), a[1].minus(b[1])]) <= tolerance * P::Scalar::from_u32(8) * lightest
    }
}

impl<P: Point> Net<'_, P> {
    /// Bounds b such that one Newton step (du, dv) from anywhere leaves a distance of at most
    /// `b[0] · du² + b[1] · |du dv| + b[2] · dv²` to the ray, times the weight there, by Taylor's theorem: from the second
    /// differences of the control points, which bound the second derivatives, times the √3 of sheared planes. `reach` bounds the
    /// coordinates, of the net and of the ray's origin.
    ///
    /// A rational surface's numerator and weight are bounded apart; the ray's origin adds up to √3 · √3 times the weight's part.
    pub fn bend(&self, reach: P::Scalar) -> [P::Scalar; 3] {
        let scalar = |k: usize| P::Scalar::from_u32(k as u32);
        let size = |difference: P| {
            let position = V::<P>::from_array(difference.weighted_position()).length() * P::Scalar::from_f64(SHEAR);
            if P::RATIONAL { position + difference.weight().abs() * scalar(3) * reach } else { position }
        };
        let (n, m, columns) = (self.degree_u(), self.degree_v(), self.degrees.columns());
        let second = |points: &[P], stride: usize| {
            let from = |k: usize| points.iter().skip(k * stride).copied();
            let triples = from(0).zip(from(1)).zip(from(2));
            triples.fold(P::Scalar::ZERO, |most, ((a, b), c)| most.greater(size(a - b - (b - c))))
        };
        let along_u = second(self.points, columns);
        let along_v = self.rows().fold(P::Scalar::ZERO, |most, row| most.greater(second(row, 1)));
        let mixed = self.rows().zip(self.rows().skip(1)).fold(P::Scalar::ZERO, |most, (row, next)| {
            let quads = row.windows(2).zip(next.windows(2));
            quads.fold(most, |most, (a, b)| match (a, b) {
                (&[p, q], &[r, s]) => most.greater(size(p - q - (r - s))),
                _ => most,
            })
        });
        let half = P::Scalar::HALF;
        [along_u * scalar(n * (n - 1)) * half, mixed * scalar(n * m), along_v * scalar(m * (m - 1)) * half]
    }
}

/// Just above √3, by which sheared planes may lengthen a vector.
pub(crate) const SHEAR: f64 = 1.7321;

type V<P> = <<P as Point>::Scalar as Scalar>::Vec3;

#[cfg(test)]
mod tests;
