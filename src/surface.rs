//! A Bézier surface: control net, degrees, weights; evaluation, derivatives, normal, halving, restriction to a domain.
//!
//! A surface of degrees n × m is S(u, v) = Σ B_i^n(u) B_j^m(v) P_ij with u and v in [0, 1]; control points are stored with
//! u as the outer index. Rational surfaces are kept homogeneous, (wx, wy, wz, w), so that the same sums serve both.
//! Source: G. Farin, "Curves and Surfaces for CAGD", chapters on Bernstein form, de Casteljau and rational surfaces.

use crate::arena::Need;
use crate::scalar::{Scalar, Vector3};
use core::ops::{Add, Mul, Sub};
use heapless::vec::{Vec, VecView};

/// The highest degree in each direction.
pub const MAX_DEGREE: usize = 15;

mod sealed {
    pub trait Sealed {}
    impl<S> Sealed for super::Plain<S> {}
    impl<S> Sealed for super::Weighted<S> {}
}

/// A control point: [`Plain`] for polynomial surfaces, [`Weighted`] for rational ones. A scene uses one kind throughout,
/// so that a polynomial scene links no rational code.
pub trait Point:
    sealed::Sealed
    + Copy
    + Default
    + core::fmt::Debug
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Self::Scalar, Output = Self>
    + Send
    + Sync
    + 'static
{
    /// The type of the coordinates.
    type Scalar: Scalar;
    /// Whether there are weights.
    const RATIONAL: bool;
    /// All zero: what a sum begins with, and a slot that holds nothing.
    const EMPTY: Self;
    /// Position times weight.
    fn weighted_position(self) -> [Self::Scalar; 3];
    /// The weight; 1 for a plain point.
    fn weight(self) -> Self::Scalar;
    /// The position: weight divided out.
    fn position(self) -> [Self::Scalar; 3];
    /// Scaled by powers of two: the position by 2^`position`, the weight by 2^`weight`.
    fn rescaled(self, position: i32, weight: i32) -> Self;
}

/// A control point without weight: x, y, z.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plain<S>(pub [S; 3]);

/// A control point with its weight multiplied in: wx, wy, wz, w.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weighted<S>([S; 4]);

impl<S: Scalar> Weighted<S> {
    /// The point at `position` with `weight`, which has to be positive to make a valid surface.
    pub fn new(position: [S; 3], weight: S) -> Self {
        let [x, y, z] = position;
        Weighted([x * weight, y * weight, z * weight, weight])
    }
}

macro_rules! componentwise {
    ($point:ident, $($k:literal)*) => {
        impl<S: Scalar> Add for $point<S> {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                $point([$(self.0[$k] + other.0[$k]),*])
            }
        }
        impl<S: Scalar> Sub for $point<S> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                $point([$(self.0[$k] - other.0[$k]),*])
            }
        }
        impl<S: Scalar> Mul<S> for $point<S> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, factor: S) -> Self {
                $point([$(self.0[$k] * factor),*])
            }
        }
    };
}
componentwise!(Plain, 0 1 2);
componentwise!(Weighted, 0 1 2 3);

impl<S: Scalar> Point for Plain<S> {
    type Scalar = S;
    const RATIONAL: bool = false;
    const EMPTY: Self = Plain([S::ZERO; 3]);
    #[inline(always)]
    fn weighted_position(self) -> [S; 3] {
        self.0
    }
    #[inline(always)]
    fn weight(self) -> S {
        S::ONE
    }
    #[inline(always)]
    fn position(self) -> [S; 3] {
        self.0
    }
    fn rescaled(self, position: i32, _weight: i32) -> Self {
        Plain(self.0.map(|c| c.times_power_of_two(position)))
    }
}

impl<S: Scalar> Point for Weighted<S> {
    type Scalar = S;
    const RATIONAL: bool = true;
    const EMPTY: Self = Weighted([S::ZERO; 4]);
    #[inline(always)]
    fn weighted_position(self) -> [S; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }
    #[inline(always)]
    fn weight(self) -> S {
        self.0[3]
    }
    #[inline(always)]
    fn position(self) -> [S; 3] {
        let [x, y, z, w] = self.0;
        [x / w, y / w, z / w]
    }
    fn rescaled(self, position: i32, weight: i32) -> Self {
        let [x, y, z, w] = self.0;
        let both = position.saturating_add(weight);
        Weighted([
            x.times_power_of_two(both),
            y.times_power_of_two(both),
            z.times_power_of_two(both),
            w.times_power_of_two(weight),
        ])
    }
}

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
}

impl core::fmt::Display for NetError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            NetError::DegreeU(n) => write!(f, "degree {n} in u is not within 1 to {MAX_DEGREE}"),
            NetError::DegreeV(m) => write!(f, "degree {m} in v is not within 1 to {MAX_DEGREE}"),
            NetError::Points(need) => write!(f, "{} control points, not {}", need.given, need.needed),
            NetError::NotFinite(k) => write!(f, "control point {k} is not finite"),
            NetError::Weight(k) => write!(f, "the weight of control point {k} is not positive"),
        }
    }
}

impl core::error::Error for NetError {}

/// Point and first partial derivatives of a surface, homogeneous if the surface is rational.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<P> {
    /// S(u, v).
    pub point: P,
    /// ∂S/∂u.
    pub du: P,
    /// ∂S/∂v.
    pub dv: P,
}

/// Room for the Bernstein polynomials of one evaluation, in u and in v: each needs degree + 1 slots.
#[derive(Debug)]
pub struct BasisView<'s, S> {
    /// Of the degree in u.
    pub u: &'s mut VecView<Terms<S>>,
    /// Of the degree in v.
    pub v: &'s mut VecView<Terms<S>>,
}

/// B_i^n(t) with its first and second derivative.
pub type Terms<S> = [S; 3];

/// Room for one basis in each direction; `ORDER` is the highest degree + 1.
#[derive(Debug)]
pub struct Basis<S, const ORDER: usize> {
    u: Vec<Terms<S>, ORDER>,
    v: Vec<Terms<S>, ORDER>,
}

impl<S, const ORDER: usize> Basis<S, ORDER> {
    /// Empty, usable in a static.
    pub const fn new() -> Self {
        Basis { u: Vec::new(), v: Vec::new() }
    }

    /// The view that evaluation takes.
    pub fn view(&mut self) -> BasisView<'_, S> {
        BasisView { u: &mut self.u, v: &mut self.v }
    }
}

impl<S, const ORDER: usize> Default for Basis<S, ORDER> {
    fn default() -> Self {
        Self::new()
    }
}

/// A basis is too small for the degree of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

/// A control net: a view of lent points. See the module's head for the order of the points.
#[derive(Clone, Copy, Debug)]
pub struct Net<'m, P> {
    degree_u: usize,
    degree_v: usize,
    points: &'m [P],
}

/// One of the two parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The outer index of the net.
    U,
    /// The inner index of the net.
    V,
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
        Ok(Net { degree_u, degree_v, points })
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
    pub fn degree_u(&self) -> usize {
        self.degree_u
    }

    /// The degree in v.
    pub fn degree_v(&self) -> usize {
        self.degree_v
    }

    /// The control points, u outer.
    pub fn points(&self) -> &'m [P] {
        self.points
    }

    /// The rows of the net: for each index in u, the points along v.
    pub fn rows(&self) -> core::slice::ChunksExact<'m, P> {
        self.points.chunks_exact(self.degree_v + 1)
    }

    /// The corners P_00, P_n0, P_0m, P_nm.
    pub fn corners(&self) -> [P; 4] {
        let row = self.degree_v;
        let last = self.degree_u * (row + 1);
        [0, last, row, last + row].map(|k| self.points.get(k).copied().unwrap_or(P::EMPTY))
    }

    /// Point and first derivatives at (u, v); slightly outside [0, 1] the polynomials go on.
    ///
    /// `basis` serves all degrees but 2 × 2 and 3 × 3, which are unrolled and leave it alone.
    #[inline]
    pub fn jet(&self, u: P::Scalar, v: P::Scalar, basis: &mut BasisView<'_, P::Scalar>) -> Result<Jet<P>, Full> {
        // These two shapes are nearly all that models hold; unrolled, they run about twice as fast as the loops.
        if self.degree_u == 3 && self.degree_v == 3 {
            if let Ok(points) = <&[P; 16]>::try_from(self.points) {
                return Ok(jet_unrolled::<P, 4, 4, 16>(points, &cubic(u), &cubic(v)));
            }
        }
        if self.degree_u == 2 && self.degree_v == 2 {
            if let Ok(points) = <&[P; 9]>::try_from(self.points) {
                return Ok(jet_unrolled::<P, 3, 3, 9>(points, &quadratic(u), &quadratic(v)));
            }
        }
        self.jet_any_degree(u, v, basis)
    }

    #[inline(never)]
    fn jet_any_degree(&self, u: P::Scalar, v: P::Scalar, basis: &mut BasisView<'_, P::Scalar>) -> Result<Jet<P>, Full> {
        bernstein(self.degree_u, u, basis.u)?;
        bernstein(self.degree_v, v, basis.v)?;
        let mut jet = Jet { point: P::EMPTY, du: P::EMPTY, dv: P::EMPTY };
        for (row, &[b, b1, _]) in self.rows().zip(basis.u.iter()) {
            let (mut point, mut dv) = (P::EMPTY, P::EMPTY);
            for (&p, &[c, c1, _]) in row.iter().zip(basis.v.iter()) {
                point = point + p * c;
                dv = dv + p * c1;
            }
            jet.point = jet.point + point * b;
            jet.du = jet.du + point * b1;
            jet.dv = jet.dv + dv * b;
        }
        Ok(jet)
    }

    /// The position at (u, v), weight divided out.
    pub fn position(
        &self,
        u: P::Scalar,
        v: P::Scalar,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<[P::Scalar; 3], Full> {
        Ok(self.jet(u, v, basis)?.point.position())
    }

    /// The unit normal at (u, v), along ∂S/∂u × ∂S/∂v; zero where the surface has none.
    ///
    /// Where a first derivative vanishes (a collapsed edge) or both are parallel, the normal's limit from the middle of
    /// the domain is taken, from the second derivatives.
    pub fn normal(
        &self,
        u: P::Scalar,
        v: P::Scalar,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<[P::Scalar; 3], Full> {
        let (first, second) = self.derivatives(u, v, basis)?;
        let [su, sv] = first;
        let [suu, suv, svv] = second;
        // What is below this share of the largest product is rounding: a few dozen operations went into each factor.
        let noise = P::Scalar::EPSILON * P::Scalar::from_u32(64);
        let size = |a: V<P>, b: V<P>| a.largest() * b.largest();
        let regular = su.cross(sv);
        let scale = self.size();
        if regular.largest() > noise * scale * su.largest().greater(sv.largest()) {
            return Ok(regular.unit().to_array());
        }
        // To first order along (a, b), the way to the middle of the domain.
        let (a, b) = (P::Scalar::HALF - u, P::Scalar::HALF - v);
        let (turn_u, turn_v) = (suu * a + suv * b, suv * a + svv * b);
        let limit = turn_u.cross(sv) + su.cross(turn_v);
        if limit.largest() > noise * (size(turn_u, sv) + size(su, turn_v)).greater(noise * scale * scale) {
            return Ok(limit.unit().to_array());
        }
        // Both derivatives vanish: to second order.
        Ok(turn_u.cross(turn_v).unit().to_array())
    }

    /// First derivatives in u and v, and second ones in uu, uv, vv, of the position.
    #[allow(clippy::type_complexity)]
    fn derivatives(
        &self,
        u: P::Scalar,
        v: P::Scalar,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<([V<P>; 2], [V<P>; 3]), Full> {
        bernstein(self.degree_u, u, basis.u)?;
        bernstein(self.degree_v, v, basis.v)?;
        // sums[i][j]: i derivatives in u, j in v.
        let mut sums = [[P::EMPTY; 3]; 3];
        for (row, b) in self.rows().zip(basis.u.iter()) {
            let mut along = [P::EMPTY; 3];
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
        if !P::RATIONAL {
            return Ok(([su, sv].map(vector), [suu, suv, svv].map(vector)));
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
        Ok(([d_u, d_v], [d_uu, d_uv, d_vv]))
    }

    /// The largest |coordinate difference| between a control point and the first one: what rounding is measured by.
    fn size(&self) -> P::Scalar {
        let first = self.corners()[0].position();
        self.points.iter().fold(P::Scalar::ZERO, |size, p| {
            let q = p.position();
            size.greater((V::<P>::from_array(q) - V::<P>::from_array(first)).largest())
        })
    }

    /// The control net of the part over [u0, u1] × [v0, v1], by de Casteljau's algorithm, into `out` (whose old content
    /// is dropped). A domain at the border of [0, 1] keeps that border's control points to the bit.
    pub fn restrict(&self, u: [P::Scalar; 2], v: [P::Scalar; 2], out: &mut VecView<P>) -> Result<(), Full> {
        out.clear();
        out.extend_from_slice(self.points).map_err(|_| Full)?;
        let (rows, columns) = (self.degree_u + 1, self.degree_v + 1);
        for column in 0..columns {
            restrict_line(out, column, columns, rows, u);
        }
        for row in 0..rows {
            restrict_line(out, row * columns, 1, columns, v);
        }
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
    /// Its control net, in the frame.
    pub net: Net<'m, P>,
    /// See [`Net::bend`].
    pub bend: [P::Scalar; 3],
}

impl<P: Point> Net<'_, P> {
    /// Bounds b such that one Newton step (du, dv) from anywhere leaves a distance of at most
    /// `b[0] · du² + b[1] · |du dv| + b[2] · dv²` to the ray, by Taylor's theorem: from the second differences of the control
    /// points, which bound the second derivatives, times the √3 of sheared planes. For nets in the frame, where coordinates
    /// are below 1.
    ///
    /// A rational surface's numerator and weight are bounded apart, over the smallest weight; the ray's origin adds up to
    /// √3 · √3 times the weight's part.
    pub fn bend(&self) -> [P::Scalar; 3] {
        let scalar = |k: usize| P::Scalar::from_u32(k as u32);
        let least = self.points.iter().fold(P::Scalar::INFINITY, |least, p| least.lesser(p.weight()));
        let size = |difference: P| {
            let position = V::<P>::from_array(difference.weighted_position()).length() * P::Scalar::from_f64(SHEAR);
            if P::RATIONAL { (position + difference.weight().abs() * scalar(3)) / least } else { position }
        };
        let (n, m, columns) = (self.degree_u, self.degree_v, self.degree_v + 1);
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

/// De Casteljau twice on `count` points, `stride` apart from `first` on: keep what is below `to`, then what is above
/// `from`.
fn restrict_line<P: Point>(points: &mut [P], first: usize, stride: usize, count: usize, [from, to]: [P::Scalar; 2]) {
    let (zero, one) = (P::Scalar::ZERO, P::Scalar::ONE);
    let at = |k: usize| first + k * stride;
    let mut blend = |low: usize, high: usize, into: usize, t: P::Scalar| {
        if let (Some(&p), Some(&q)) = (points.get(at(low)), points.get(at(high))) {
            if let Some(slot) = points.get_mut(at(into)) {
                *slot = p * (one - t) + q * t;
            }
        }
    };
    if to != one {
        for level in 1..count {
            for k in (level..count).rev() {
                blend(k - 1, k, k, to);
            }
        }
    }
    if from != zero && to > zero {
        let t = from / to;
        for level in 1..count {
            for k in 0..count - level {
                blend(k, k + 1, k, t);
            }
        }
    }
}

/// Bernstein polynomials of `degree` at `t` with two derivatives, into `out`; from those of degree − 2, raised twice.
fn bernstein<S: Scalar>(degree: usize, t: S, out: &mut VecView<Terms<S>>) -> Result<(), Full> {
    out.clear();
    out.resize(degree + 1, [S::ZERO; 3]).map_err(|_| Full)?;
    let s = S::ONE - t;
    // Degree n − 2 (or 0) first: binomial · t^i going up, · s^(n−2−i) going down.
    let low = degree.saturating_sub(2);
    let mut power = S::ONE;
    if let Some(row) = BINOMIALS.get(low) {
        for (terms, &binomial) in out.iter_mut().zip(row).take(low + 1) {
            terms[0] = power * S::from_u32(u32::from(binomial));
            power = power * t;
        }
    }
    power = S::ONE;
    for terms in out.iter_mut().take(low + 1).rev() {
        terms[0] = terms[0] * power;
        power = power * s;
    }
    // Each raise: B_i^k = s B_i^(k−1) + t B_(i−1)^(k−1), B_i^k' = k (B_(i−1)^(k−1) − B_i^(k−1)), likewise once more.
    for k in low + 1..=degree {
        let order = S::from_u32(k as u32);
        let [mut left, mut left1] = [S::ZERO; 2];
        for terms in out.iter_mut() {
            let [here, here1, _] = *terms;
            *terms = [s * here + t * left, order * (left - here), order * (left1 - here1)];
            (left, left1) = (here, here1);
        }
    }
    Ok(())
}

/// Pascal's triangle up to the degree from which [`bernstein`] raises.
const BINOMIALS: [[u16; MAX_DEGREE]; MAX_DEGREE - 1] = {
    let mut rows = [[0; MAX_DEGREE]; MAX_DEGREE - 1];
    let mut n = 0;
    while n < MAX_DEGREE - 1 {
        rows[n][0] = 1;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

/// Values and derivatives of the cubic Bernstein polynomials.
#[inline(always)]
fn cubic<S: Scalar>(t: S) -> [[S; 2]; 4] {
    let three = S::from_u32(3);
    let s = S::ONE - t;
    let (ss, tt, st) = (s * s, t * t, s * t);
    let (st3, ss3, tt3) = (three * st, three * ss, three * tt);
    let st6 = st3 + st3;
    [[ss * s, -ss3], [st3 * s, ss3 - st6], [st3 * t, st6 - tt3], [tt * t, tt3]]
}

/// Values and derivatives of the quadratic Bernstein polynomials.
#[inline(always)]
fn quadratic<S: Scalar>(t: S) -> [[S; 2]; 3] {
    let s = S::ONE - t;
    let (s2, t2) = (s + s, t + t);
    [[s * s, -s2], [s2 * t, s2 - t2], [t * t, t2]]
}

/// [`Net::jet`] for an order known when compiling; `N` is `R · C`.
#[inline(always)]
fn jet_unrolled<P: Point, const R: usize, const C: usize, const N: usize>(
    points: &[P; N],
    bu: &[[P::Scalar; 2]; R],
    bv: &[[P::Scalar; 2]; C],
) -> Jet<P> {
    const { assert!(R * C == N && R > 0 && C > 0) }
    // Along u first: the points of a row stand side by side in memory, and all its coordinates take the same factor.
    let mut value = [P::EMPTY; C];
    let mut slope = [P::EMPTY; C];
    for i in 0..R {
        for j in 0..C {
            let point = points[i * C + j];
            value[j] = value[j] + point * bu[i][0];
            slope[j] = slope[j] + point * bu[i][1];
        }
    }
    let mut jet = Jet { point: P::EMPTY, du: P::EMPTY, dv: P::EMPTY };
    for j in 0..C {
        jet.point = jet.point + value[j] * bv[j][0];
        jet.du = jet.du + slope[j] * bv[j][0];
        jet.dv = jet.dv + value[j] * bv[j][1];
    }
    jet
}
