//! Bernstein polynomials: bases, and sums over a control net with their derivatives.
//!
//! Written for anything that can be added and scaled ([`Linear`]): control points in space, with or without weights, and
//! nets projected on a ray's planes. Source: G. Farin, "Curves and Surfaces for CAGD", chapters on the Bernstein form.

use crate::parameter::Parameter;
use crate::scalar::Scalar;
use core::ops::{Add, Mul, Sub};
use heapless::vec::{Vec, VecView};

/// The highest degree in each direction.
pub const MAX_DEGREE: usize = 15;

/// What can be a coefficient of a Bernstein polynomial over `S`.
pub trait Linear<S>: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<S, Output = Self> {
    /// What a sum begins with.
    const ZERO: Self;
}

/// `N` numbers, added and scaled component by component.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuple<S, const N: usize>(pub [S; N]);

impl<S: Scalar, const N: usize> Add for Tuple<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Tuple(core::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<S: Scalar, const N: usize> Sub for Tuple<S, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Tuple(core::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl<S: Scalar, const N: usize> Mul<S> for Tuple<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: S) -> Self {
        Tuple(self.0.map(|c| c * factor))
    }
}

impl<S: Scalar, const N: usize> Linear<S> for Tuple<S, N> {
    const ZERO: Self = Tuple([S::ZERO; N]);
}

/// The value of a sum over a net, and its first partial derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<T> {
    /// S(u, v).
    pub point: T,
    /// ∂S/∂u.
    pub du: T,
    /// ∂S/∂v.
    pub dv: T,
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

/// One of the two parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The outer index of a net.
    U,
    /// The inner index of a net.
    V,
}

impl Direction {
    /// The other one.
    #[inline(always)]
    pub(crate) fn other(self) -> Self {
        match self {
            Direction::U => Direction::V,
            Direction::V => Direction::U,
        }
    }
}

impl core::fmt::Display for Direction {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Direction::U => "u",
            Direction::V => "v",
        })
    }
}

/// The degrees of a net in u and v, and with them the shape of the slice that holds it: u is the outer index.
///
/// Of 8 bits, so that degree + 1 is not 0 whatever it holds: rows of length 0 could not be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Degrees {
    pub(crate) u: u8,
    pub(crate) v: u8,
}

impl Degrees {
    /// Degrees of 1 to [`MAX_DEGREE`]; `None` for others.
    pub fn new(u: usize, v: usize) -> Option<Self> {
        let within = |degree| u8::try_from(degree).ok().filter(|_| (1..=MAX_DEGREE).contains(&degree));
        Some(Degrees { u: within(u)?, v: within(v)? })
    }

    /// The number of rows, of one u each.
    #[inline(always)]
    pub(crate) fn rows(self) -> usize {
        usize::from(self.u) + 1
    }

    /// The number of columns, of one v each.
    #[inline(always)]
    pub(crate) fn columns(self) -> usize {
        usize::from(self.v) + 1
    }
}

/// Value and first derivatives at (u, v) of the sum over what `part` takes from each element of `net`; slightly outside
/// [0, 1] the polynomials go on.
///
/// `basis` serves all degrees but 2 × 2 and 3 × 3, which are unrolled and leave it alone.
#[inline(always)]
pub(crate) fn jet<A: Parameter, P: Copy, T: Linear<A::Scalar>>(
    degrees: Degrees,
    net: &[P],
    [u, v]: [A; 2],
    basis: &mut BasisView<'_, A::Scalar>,
    part: impl Fn(P) -> T,
) -> Result<Jet<T>, Full> {
    // These two shapes are nearly all that models hold; unrolled, they run about twice as fast as the loops.
    if let (Degrees { u: 3, v: 3 }, Ok(net)) = (degrees, <&[P; 16]>::try_from(net)) {
        return Ok(jet_unrolled::<A::Scalar, P, T, 4, 3, 16>(net, &quadratic(u), &quadratic(v), part));
    }
    if let (Degrees { u: 2, v: 2 }, Ok(net)) = (degrees, <&[P; 9]>::try_from(net)) {
        return Ok(jet_unrolled::<A::Scalar, P, T, 3, 2, 9>(net, &linear(u), &linear(v), part));
    }
    jet_any_degree(degrees, net, [u, v], basis, part)
}

/// The value alone of what [`jet`] gives.
#[inline(always)]
pub(crate) fn value<A: Parameter, P: Copy, T: Linear<A::Scalar>>(
    degrees: Degrees,
    net: &[P],
    [u, v]: [A; 2],
    basis: &mut BasisView<'_, A::Scalar>,
    part: impl Fn(P) -> T,
) -> Result<T, Full> {
    if let (Degrees { u: 3, v: 3 }, Ok(net)) = (degrees, <&[P; 16]>::try_from(net)) {
        return Ok(value_unrolled::<A::Scalar, P, T, 4, 16>(net, &raised(&quadratic(u)), &raised(&quadratic(v)), part));
    }
    if let (Degrees { u: 2, v: 2 }, Ok(net)) = (degrees, <&[P; 9]>::try_from(net)) {
        return Ok(value_unrolled::<A::Scalar, P, T, 3, 9>(net, &raised(&linear(u)), &raised(&linear(v)), part));
    }
    Ok(jet_any_degree(degrees, net, [u, v], basis, part)?.point)
}

#[inline(never)]
fn jet_any_degree<A: Parameter, P: Copy, T: Linear<A::Scalar>>(
    degrees: Degrees,
    net: &[P],
    [u, v]: [A; 2],
    basis: &mut BasisView<'_, A::Scalar>,
    part: impl Fn(P) -> T,
) -> Result<Jet<T>, Full> {
    basis.fill(degrees, [u, v])?;
    let mut jet = Jet { point: T::ZERO, du: T::ZERO, dv: T::ZERO };
    for (row, &[b, b1, _]) in net.chunks_exact(degrees.columns()).zip(basis.u.iter()) {
        let (mut point, mut dv) = (T::ZERO, T::ZERO);
        for (&p, &[c, c1, _]) in row.iter().zip(basis.v.iter()) {
            let p = part(p);
            point = point + p * c;
            dv = dv + p * c1;
        }
        jet.point = jet.point + point * b;
        jet.du = jet.du + point * b1;
        jet.dv = jet.dv + dv * b;
    }
    Ok(jet)
}

impl<S: Scalar> BasisView<'_, S> {
    /// Fills both bases.
    pub(crate) fn fill<A: Parameter<Scalar = S>>(&mut self, degrees: Degrees, [u, v]: [A; 2]) -> Result<(), Full> {
        bernstein(usize::from(degrees.u), u, self.u)?;
        bernstein(usize::from(degrees.v), v, self.v)
    }
}

/// Bernstein polynomials of `degree` at `t` with two derivatives, into `out`; from those of degree − 2, raised twice.
fn bernstein<A: Parameter>(degree: usize, at: A, out: &mut VecView<Terms<A::Scalar>>) -> Result<(), Full> {
    out.clear();
    out.resize(degree + 1, [A::Scalar::ZERO; 3]).map_err(|_| Full)?;
    let (t, s) = (at.number(), at.rest());
    // Degree n − 2 (or 0) first: binomial · t^i going up, · s^(n−2−i) going down.
    let low = degree.saturating_sub(2);
    let mut power = A::Scalar::ONE;
    if let Some(row) = BINOMIALS.get(low) {
        for (terms, &binomial) in out.iter_mut().zip(row).take(low + 1) {
            terms[0] = power * A::Scalar::from_u32(u32::from(binomial));
            power = power * t;
        }
    }
    power = A::Scalar::ONE;
    for terms in out.iter_mut().take(low + 1).rev() {
        terms[0] = terms[0] * power;
        power = power * s;
    }
    // Each raise: B_i^k = s B_i^(k−1) + t B_(i−1)^(k−1), B_i^k' = k (B_(i−1)^(k−1) − B_i^(k−1)), likewise once more.
    for k in low + 1..=degree {
        let order = A::Scalar::from_u32(k as u32);
        let [mut left, mut left1] = [A::Scalar::ZERO; 2];
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

/// The Bernstein polynomials of degree 1, and 1 − t and t.
#[inline(always)]
fn linear<A: Parameter>(at: A) -> ([A::Scalar; 2], [A::Scalar; 2]) {
    let both = [at.rest(), at.number()];
    (both, both)
}

/// The Bernstein polynomials of degree 2, and 1 − t and t.
#[inline(always)]
fn quadratic<A: Parameter>(at: A) -> ([A::Scalar; 3], [A::Scalar; 2]) {
    let (t, s) = (at.number(), at.rest());
    let st = s * t;
    ([s * s, st + st, t * t], [s, t])
}

/// The polynomial with these coefficients and its derivative over the degree, by way of the two polynomials of the degree
/// below: the last level of de Casteljau's algorithm. `LESS` is one less than `ORDER`.
///
/// Half as many numbers to hold as with values and derivatives of all Bernstein polynomials, so that they stay in registers.
#[inline(always)]
fn blend<S: Scalar, T: Linear<S>, const ORDER: usize, const LESS: usize>(
    coefficients: [T; ORDER],
    (below, [s, t]): &([S; LESS], [S; 2]),
) -> [T; 2] {
    const { assert!(LESS + 1 == ORDER && LESS > 0) }
    let (mut first, mut second) = (coefficients[0] * below[0], coefficients[1] * below[0]);
    for k in 1..LESS {
        first = first + coefficients[k] * below[k];
        second = second + coefficients[k + 1] * below[k];
    }
    [first * *s + second * *t, second - first]
}

/// The Bernstein polynomials of the degree above.
#[inline(always)]
fn raised<S: Scalar, const LESS: usize, const ORDER: usize>((below, [s, t]): &([S; LESS], [S; 2])) -> [S; ORDER] {
    const { assert!(LESS + 1 == ORDER) }
    let mut all = [S::ZERO; ORDER];
    for k in 0..LESS {
        all[k] += below[k] * *s;
        all[k + 1] = below[k] * *t;
    }
    all
}

/// [`value`] for an order known when compiling; `N` is `ORDER²`.
#[inline(always)]
fn value_unrolled<S: Scalar, P: Copy, T: Linear<S>, const ORDER: usize, const N: usize>(
    net: &[P; N],
    u: &[S; ORDER],
    v: &[S; ORDER],
    part: impl Fn(P) -> T,
) -> T {
    const { assert!(ORDER * ORDER == N) }
    let mut value = T::ZERO;
    for i in 0..ORDER {
        let mut row = part(net[i * ORDER]) * v[0];
        for j in 1..ORDER {
            row = row + part(net[i * ORDER + j]) * v[j];
        }
        value = if i == 0 { row * u[0] } else { value + row * u[i] };
    }
    value
}

/// [`jet`] for an order known when compiling; `N` is `ORDER²`.
#[inline(always)]
fn jet_unrolled<S: Scalar, P: Copy, T: Linear<S>, const ORDER: usize, const LESS: usize, const N: usize>(
    net: &[P; N],
    u: &([S; LESS], [S; 2]),
    v: &([S; LESS], [S; 2]),
    part: impl Fn(P) -> T,
) -> Jet<T> {
    const { assert!(ORDER * ORDER == N) }
    let (mut points, mut slopes) = ([T::ZERO; ORDER], [T::ZERO; ORDER]);
    for i in 0..ORDER {
        let mut row = [T::ZERO; ORDER];
        for j in 0..ORDER {
            row[j] = part(net[i * ORDER + j]);
        }
        [points[i], slopes[i]] = blend::<S, T, ORDER, LESS>(row, v);
    }
    let ([point, du], [dv, _]) = (blend::<S, T, ORDER, LESS>(points, u), blend::<S, T, ORDER, LESS>(slopes, u));
    let degree = S::from_u32(LESS as u32);
    Jet { point, du: du * degree, dv: dv * degree }
}

#[cfg(test)]
mod tests;
