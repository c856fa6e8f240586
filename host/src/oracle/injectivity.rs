//! Proof that a domain holds at most one root: its preconditioned Jacobian stays near the identity.
//!
//! With A the inverse of the mean Jacobian of the homogeneous plane distances F and q the largest row sum of |I − A J|
//! over the Bernstein coefficients of J, q < 1 makes A F injective on the domain, since x − A F(x) contracts by q.
//! Source: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4 (1969), with
//! the convex hull of the coefficients in place of an interval extension.

use super::net::{Degrees, Point};
use super::real::Real;

/// What the derivative coefficients of a net say, in parameters that run from 0 to 1 over its domain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Derivatives<R> {
    /// The inverse of the mean Jacobian, row by row; meaningless if `contraction` is infinite.
    pub(super) inverse: [[R; 2]; 2],
    /// q, rounding included: below 1, the net holds at most one root. Infinite if the mean Jacobian is singular.
    pub(super) contraction: f64,
    /// A bound on the sum of the two derivatives of the weight.
    pub(super) weight_slope: f64,
    /// The largest difference between a derivative coefficient and its mean.
    pub(super) variation: f64,
    /// A bound on the rounding error of a derivative coefficient.
    pub(super) rounding: f64,
}

impl<R: Real> Derivatives<R> {
    /// The largest row sum of |A|.
    pub(super) fn inverse_norm(&self) -> f64 {
        let [a, b] = self.inverse.map(|row| row[0].to_f64().abs() + row[1].to_f64().abs());
        if a > b { a } else { b }
    }

    /// How far the ray may move sideways with the net still proved to hold at most one root, given that it is so now.
    ///
    /// Moving it by δ takes δ w from F, and so δ ∇w from J: nothing for a polynomial net, which stays as it is for any δ.
    pub(super) fn steadiness(&self) -> f64 {
        if self.weight_slope > 0.0 {
            (1.0 - self.contraction) / (self.inverse_norm() * self.weight_slope)
        } else {
            f64::INFINITY
        }
    }
}

fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

/// The differences of neighbouring control points along u, then along v, times the degree: of the two plane distances
/// and of the weight.
fn coefficients<R: Real>(degrees: Degrees, net: &[Point<R>], mut each: impl FnMut(usize, [R; 3])) {
    let Degrees { m, n } = degrees;
    let difference = |a: Point<R>, b: Point<R>, degree: usize| [0, 1, 3].map(|k| (b[k] - a[k]).times(degree as f64));
    for i in 0..m {
        for j in 0..=n {
            let at = i * (n + 1) + j;
            each(0, difference(net[at], net[at + n + 1], m));
        }
    }
    for i in 0..=m {
        for j in 0..n {
            let at = i * (n + 1) + j;
            each(1, difference(net[at], net[at + 1], n));
        }
    }
}

/// The mean derivatives of the two homogeneous plane distances. All Bernstein polynomials of a degree have the same
/// integral, so the mean of the coefficients is the mean over the domain; inner differences cancel.
pub(super) fn mean_derivatives<R: Real>(degrees: Degrees, net: &[Point<R>]) -> [[R; 2]; 2] {
    let Degrees { m, n } = degrees;
    let mut mean = [[R::ZERO; 2]; 2];
    for k in 0..2 {
        for j in 0..=n {
            mean[0][k] += (net[m * (n + 1) + j][k] - net[j][k]) / R::new((n + 1) as f64);
        }
        for i in 0..=m {
            mean[1][k] += (net[i * (n + 1) + n][k] - net[i * (n + 1)][k]) / R::new((m + 1) as f64);
        }
    }
    mean
}

/// The derivatives of `net`, whose homogeneous coefficients are exact to within `error`.
pub(super) fn derivatives<R: Real>(
    degrees: Degrees,
    net: &[Point<R>],
    mean: [[R; 2]; 2],
    error: f64,
) -> Derivatives<R> {
    let rounding = 2.0 * degrees.highest() as f64 * error;
    let [u, v] = mean;
    let determinant = u[0] * v[1] - u[1] * v[0];
    let size = (u[0].abs() + u[1].abs()) * (v[0].abs() + v[1].abs());
    let regular = determinant.abs().to_f64() > 4.0 * R::EPS * size.to_f64();
    let inverse = [[v[1] / determinant, -v[0] / determinant], [-u[1] / determinant, u[0] / determinant]];
    let mut largest = [[R::ZERO; 2]; 2];
    let mut variation = 0.0;
    let mut weight_slopes = [0.0; 2];
    coefficients(degrees, net, |column, d| {
        weight_slopes[column] = larger(d[2].abs().to_f64(), weight_slopes[column]);
        for row in 0..2 {
            let identity = if row == column { R::ONE } else { R::ZERO };
            let product = inverse[row][0] * d[0] + inverse[row][1] * d[1];
            largest[row][column] = larger((product - identity).abs(), largest[row][column]);
            variation = larger((d[row] - mean[column][row]).abs().to_f64(), variation);
        }
    });
    let mut result = Derivatives {
        inverse,
        contraction: f64::INFINITY,
        weight_slope: weight_slopes[0] + weight_slopes[1],
        variation,
        rounding,
    };
    if regular {
        let rows = largest.map(|row| row[0] + row[1]);
        result.contraction = larger(rows[0], rows[1]).to_f64() + 2.0 * rounding * result.inverse_norm();
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plane distances (u + k u v, v) of a bilinear net.
    fn sheared(k: f64) -> Vec<Point<f64>> {
        let point = |u: f64, v: f64| [u + k * u * v, v, 0.0, 1.0];
        vec![point(0.0, 0.0), point(0.0, 1.0), point(1.0, 0.0), point(1.0, 1.0)]
    }

    fn contraction(net: &[Point<f64>]) -> f64 {
        let degrees = Degrees { m: 1, n: 1 };
        derivatives(degrees, net, mean_derivatives(degrees, net), 0.0).contraction
    }

    #[test]
    fn an_affine_net_has_none_and_a_bilinear_one_its_twist() {
        assert!(contraction(&sheared(0.0)) < 1e-15);
        // J = [[1 + k v, k u], [0, 1]] with mean [[1 + k/2, k/2], [0, 1]]: both deviations are k/2 over 1 + k/2.
        let k = 0.4;
        assert!((contraction(&sheared(k)) - k / (1.0 + 0.5 * k)).abs() < 1e-15);
    }

    #[test]
    fn a_rational_net_stays_injective_as_far_as_it_is_steady() {
        let degrees = Degrees { m: 1, n: 1 };
        // The plane distances (u - 1/2, v - 1/2) with weights 1, 1, 1 + k, 1 + k, of a ray moved by `x` along the first.
        let of = |k: f64, x: f64| {
            let net = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(u, v): (f64, f64)| {
                let w = 1.0 + k * u;
                [w * (u - 0.5 - x), w * (v - 0.5), 0.0, w]
            });
            derivatives(degrees, &net, mean_derivatives(degrees, &net), 0.0)
        };
        assert_eq!(of(0.0, 0.0).steadiness(), f64::INFINITY);
        let steady = of(0.25, 0.0).steadiness();
        assert!(steady > 0.5 && steady < 10.0, "{steady}");
        for side in [-1.0, 1.0] {
            assert!(of(0.25, 0.99 * side * steady).contraction < 1.0);
        }
        assert!(of(0.25, 4.5).contraction >= 1.0);
    }

    #[test]
    fn a_net_that_folds_over_is_not_called_injective() {
        // The determinant 1 + k v changes its sign at v = 1/2.
        assert!(contraction(&sheared(-2.0)) >= 1.0);
        assert!(contraction(&sheared(-1.5)) >= 1.0);
        let flat = vec![[0.0, 1.0, 0.0, 1.0]; 4];
        assert_eq!(contraction(&flat), f64::INFINITY);
    }
}
