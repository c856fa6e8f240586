//! The root of a domain that holds at most one, or the proof that it holds none.
//!
//! On the domain D = [0, 1]², in its own parameters, T(x) = x − A F(x) contracts by q < 1, so P T, with P the projection
//! onto D, has one fixed point x* there. It is a root if T(x*) lies in D; otherwise D holds none. (Banach's theorem;
//! that Newton's method leaves D proves nothing.) F is evaluated on the whole surface, not on the halved net.

use super::injectivity::Derivatives;
use super::net::{Degrees, Point, surface_jet};
use super::real::Real;

/// A domain of a surface: its lower corner and its extent in u and v, both dyadic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Domain<R> {
    /// The least (u, v).
    pub(super) corner: [R; 2],
    /// The extents.
    pub(super) size: [f64; 2],
}

impl<R: Real> Domain<R> {
    /// All of a surface.
    pub(super) fn whole() -> Domain<R> {
        Domain { corner: [R::ZERO; 2], size: [1.0; 2] }
    }

    /// The surface's parameters at a point of the domain, itself from 0 to 1.
    pub(super) fn at(&self, x: [R; 2]) -> [R; 2] {
        [0, 1].map(|k| self.corner[k] + x[k].times(self.size[k]))
    }
}

/// What an injective domain holds.
#[derive(Clone, Copy, Debug)]
pub(super) enum Content<R> {
    /// One root, at these parameters of the surface. It may lie outside the domain by no more than rounding.
    Root([R; 2]),
    /// No root; the plane distance from the ray is at least about this, in homogeneous units.
    Nothing(f64),
}

/// Newton steps before the fixed-matrix iteration takes over: a domain with q ≤ 1/2 converges in about 5 in f64, and
/// every step doubles the digits.
const fn newton_steps<R: Real>() -> usize {
    7 + R::BITS.ilog2() as usize
}

/// Steps with the fixed matrix: enough to halve the radius from 1/2 to the least floor.
const fn matrix_steps<R: Real>() -> usize {
    R::BITS
}

/// Finds what `domain` holds, its derivative coefficients having q ≤ 1/2. `error` bounds the rounding error of a
/// homogeneous plane distance on the domain when evaluated on `net`, the whole surface's.
pub(super) fn content<R: Real>(
    degrees: Degrees,
    net: &[Point<R>],
    domain: Domain<R>,
    d: &Derivatives<R>,
    error: f64,
) -> Content<R> {
    let evaluate = |x: [R; 2]| {
        let [u, v] = domain.at(x);
        surface_jet(degrees, net, u, v)
    };
    let coarsest = if domain.size[0] < domain.size[1] { domain.size[0] } else { domain.size[1] };
    // No step can be told from zero below this: the error of F through A, and that of the surface's parameters.
    let floor = d.inverse_norm() * error + 2.0 * R::EPS / coarsest;

    let newton = |x: [R; 2]| {
        let jet = evaluate(x);
        let [a, b] = [0, 1].map(|k| jet.first[k].map(|y| y.times(domain.size[k])));
        let f = jet.point;
        let determinant = a[0] * b[1] - a[1] * b[0];
        R::over([f[0] * b[1] - f[1] * b[0], a[0] * f[1] - a[1] * f[0]], determinant)
    };
    let small = |step: [R; 2], part: f64| step.iter().all(|s| s.abs().to_f64() <= part * floor);

    // Newton from the centre: if it settles within the domain, that is the one root. The step after a small one brings
    // the digits that the floor, a bound for the whole domain, does not promise.
    let mut x = [R::ONE.half(); 2];
    let mut settled = false;
    for _ in 0..newton_steps::<R>() {
        let step = newton(x);
        x = [x[0] - step[0], x[1] - step[1]];
        if small(step, 2.0) {
            if settled {
                if x.iter().all(|y| (R::ZERO..=R::ONE).contains(y)) {
                    return Content::Root(domain.at(x));
                }
                break;
            }
            settled = true;
        }
        if !x.iter().all(|y| (-1.0..=2.0).contains(&y.to_f64())) {
            break;
        }
    }

    // Ends when the radius, halved by every step but for the floor, is near it; the floor is above EPS.
    let mut x = [R::ONE.half(); 2];
    let mut radius = 0.5;
    for _ in 0..matrix_steps::<R>() {
        if radius <= 4.0 * floor {
            break;
        }
        let f = evaluate(x).point;
        radius = d.contraction * radius + floor;
        let mut outside = 0.0;
        for k in 0..2 {
            let moved = x[k] - (d.inverse[k][0] * f[0] + d.inverse[k][1] * f[1]);
            x[k] = moved.clamp_unit();
            let beyond = (moved - x[k]).abs().to_f64();
            if beyond > outside {
                outside = beyond;
            }
        }
        if outside > radius {
            return Content::Nothing((outside - radius) / d.inverse_norm());
        }
    }
    let step = newton(x);
    if small(step, 16.0) {
        x = [x[0] - step[0], x[1] - step[1]];
    }
    Content::Root(domain.at(x))
}

#[cfg(test)]
mod tests {
    use super::super::injectivity::{derivatives, mean_derivatives};
    use super::*;

    /// The root of F = (x − a + (x − a)²/8, y − b) on the unit square, as a 2 × 1 net.
    fn solve(a: f64, b: f64) -> Content<f64> {
        let degrees = Degrees { m: 2, n: 1 };
        // Coefficients of c0 + c1 x + x²/8 in degree 2.
        let (c0, c1) = (-a + a * a / 8.0, 1.0 - a / 4.0);
        let first = [c0, c0 + 0.5 * c1, c0 + c1 + 0.125];
        let mut net = Vec::new();
        for f in first {
            net.push([f, -b, 0.0, 1.0]);
            net.push([f, 1.0 - b, 0.0, 1.0]);
        }
        let d = derivatives(degrees, &net, mean_derivatives(degrees, &net), 1e-16);
        assert!(d.contraction < 0.5);
        content(degrees, &net, Domain::whole(), &d, 1e-16)
    }

    #[test]
    fn a_root_inside_is_found_and_one_outside_is_not() {
        for (a, b) in [(0.3, 0.6), (0.999999, 1e-9), (0.5, 0.5)] {
            let Content::Root([u, v]) = solve(a, b) else {
                panic!("a root was lost");
            };
            assert!((u - a).abs() < 1e-15 && (v - b).abs() < 1e-15);
        }
        for (a, b) in [(1.3, 0.5), (-1e-9, 0.5), (0.2, 1.0 + 1e-13), (1.5, -2.0)] {
            assert!(matches!(solve(a, b), Content::Nothing(gap) if gap > 0.0), "{a} {b}");
        }
    }

    #[test]
    fn a_root_on_the_border_belongs_to_the_domain() {
        for (a, b) in [(1.0, 0.5), (0.0, 0.0), (1.0, 1.0), (0.25, 1.0 + 1e-17)] {
            assert!(matches!(solve(a, b), Content::Root(_)), "{a} {b}");
        }
    }
}
