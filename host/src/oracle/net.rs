//! Homogeneous Bernstein nets: halving and evaluation by de Casteljau's algorithm.
//!
//! A net of degrees `(m, n)` is a slice of `(m + 1)(n + 1)` homogeneous points `[w a, w b, w c, w]`, u being the outer
//! index. Source: G. Farin, *Curves and Surfaces for CAGD*, 5th edition, sections 4.2, 14.2 and 15.4.

use super::real::Real;

/// A homogeneous point or vector: three coordinates, already multiplied by the weight, and the weight.
pub(super) type Point<R> = [R; 4];

/// One more than the highest degree of a surface.
pub(super) const MAX_ORDER: usize = 16;

/// The degrees `(m, n)` of a surface in u and v, each from 1 to 15.
#[derive(Clone, Copy, Debug)]
pub(super) struct Degrees {
    /// Degree in u.
    pub(super) m: usize,
    /// Degree in v.
    pub(super) n: usize,
}

impl Degrees {
    /// The number of control points.
    pub(super) fn points(self) -> usize {
        (self.m + 1) * (self.n + 1)
    }

    /// The higher of the two.
    pub(super) fn highest(self) -> usize {
        if self.m > self.n { self.m } else { self.n }
    }
}

/// A parameter direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axis {
    /// Along u.
    U,
    /// Along v.
    V,
}

/// Halves `net` across `axis` at the middle of its domain: `low` and `high` become the nets of the two halves. All three
/// slices hold `degrees.points()` points.
pub(super) fn halve<R: Real>(
    degrees: Degrees,
    net: &[Point<R>],
    axis: Axis,
    low: &mut [Point<R>],
    high: &mut [Point<R>],
) {
    let (lines, step, degree, stride) = match axis {
        Axis::U => (degrees.n + 1, 1, degrees.m, degrees.n + 1),
        Axis::V => (degrees.m + 1, degrees.n + 1, degrees.n, 1),
    };
    let mut c = [[R::ZERO; 4]; MAX_ORDER];
    for line in 0..lines {
        let start = line * step;
        for k in 0..=degree {
            c[k] = net[start + k * stride];
        }
        low[start] = c[0];
        high[start + degree * stride] = c[degree];
        for r in 1..=degree {
            for k in 0..=degree - r {
                for x in 0..4 {
                    c[k][x] = (c[k][x] + c[k + 1][x]).half();
                }
            }
            low[start + r * stride] = c[0];
            high[start + (degree - r) * stride] = c[degree - r];
        }
    }
}

/// A homogeneous curve's point and first two derivatives at `t`, from `degree + 1` control points, which are used up.
pub(super) fn curve_jet<R: Real>(degree: usize, c: &mut [Point<R>; MAX_ORDER], t: R) -> [Point<R>; 3] {
    let s = R::ONE - t;
    let lerp = |a: Point<R>, b: Point<R>| {
        let mut p = [R::ZERO; 4];
        for x in 0..4 {
            p[x] = s * a[x] + t * b[x];
        }
        p
    };
    let mut second = [R::ZERO; 4];
    let mut count = degree + 1;
    // Ends at the two points whose difference is the tangent.
    while count > 2 {
        if count == 3 {
            let scale = (degree * (degree - 1)) as f64;
            for x in 0..4 {
                second[x] = ((c[2][x] - c[1][x]) - (c[1][x] - c[0][x])).times(scale);
            }
        }
        for k in 0..count - 1 {
            c[k] = lerp(c[k], c[k + 1]);
        }
        count -= 1;
    }
    let mut first = [R::ZERO; 4];
    for x in 0..4 {
        first[x] = (c[1][x] - c[0][x]).times(degree as f64);
    }
    [lerp(c[0], c[1]), first, second]
}

/// A homogeneous surface point with its derivatives up to the second.
pub(super) struct Jet<R> {
    /// The point.
    pub(super) point: Point<R>,
    /// First derivatives, by u and by v.
    pub(super) first: [Point<R>; 2],
    /// Second derivatives: uu, uv, vv.
    pub(super) second: [Point<R>; 3],
}

/// Evaluates `net` at `(u, v)`.
pub(super) fn surface_jet<R: Real>(degrees: Degrees, net: &[Point<R>], u: R, v: R) -> Jet<R> {
    let mut columns = [[[R::ZERO; 4]; MAX_ORDER]; 3];
    let mut row = [[R::ZERO; 4]; MAX_ORDER];
    for i in 0..=degrees.m {
        let start = i * (degrees.n + 1);
        row[..=degrees.n].copy_from_slice(&net[start..=start + degrees.n]);
        let jet = curve_jet(degrees.n, &mut row, v);
        for k in 0..3 {
            columns[k][i] = jet[k];
        }
    }
    let [point, by_u, by_uu] = curve_jet(degrees.m, &mut columns[0], u);
    let [by_v, by_uv, _] = curve_jet(degrees.m, &mut columns[1], u);
    let [by_vv, _, _] = curve_jet(degrees.m, &mut columns[2], u);
    Jet { point, first: [by_u, by_v], second: [by_uu, by_uv, by_vv] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// z = u³ − 2 u v², x = u, y = v, with a weight of 1 + u + v throughout.
    fn cubic() -> (Degrees, Vec<Point<f64>>) {
        let degrees = Degrees { m: 4, n: 3 };
        // Bernstein coefficients of the powers of a parameter, by degree.
        let power = |d: usize, k: usize, i: usize| {
            let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, j| c * (n - j) as f64 / (j + 1) as f64);
            if i < k { 0.0 } else { choose(i, k) / choose(d, k) }
        };
        let mut net = Vec::new();
        for i in 0..=4 {
            for j in 0..=3 {
                let term = |a, b| power(4, a, i) * power(3, b, j);
                // The weight times x, y and z, multiplied out.
                net.push([
                    term(1, 0) + term(2, 0) + term(1, 1),
                    term(0, 1) + term(1, 1) + term(0, 2),
                    term(3, 0) + term(4, 0) + term(3, 1) - 2.0 * (term(1, 2) + term(2, 2) + term(1, 3)),
                    term(0, 0) + term(1, 0) + term(0, 1),
                ]);
            }
        }
        (degrees, net)
    }

    #[test]
    fn a_jet_is_that_of_the_polynomial() {
        let (degrees, net) = cubic();
        let (u, v) = (0.3, 0.8);
        let jet = surface_jet(degrees, &net, u, v);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} is not {b}");
        near(jet.point[3], 1.0 + u + v);
        near(jet.point[2], (1.0 + u + v) * (u * u * u - 2.0 * u * v * v));
        near(jet.first[0][0], 1.0 + 2.0 * u + v);
        near(jet.first[1][1], 1.0 + u + 2.0 * v);
        near(jet.second[0][0], 2.0);
        near(jet.second[1][0], 1.0);
        near(jet.second[2][1], 2.0);
        near(jet.second[2][2], -4.0 * u * (1.0 + u + 3.0 * v));
    }

    #[test]
    fn halves_are_the_surface() {
        let (degrees, net) = cubic();
        for axis in [Axis::U, Axis::V] {
            let mut halves = [net.clone(), net.clone()];
            let [low, high] = &mut halves;
            halve(degrees, &net, axis, low, high);
            for (k, half) in halves.iter().enumerate() {
                let (u, v) = (0.37, 0.61);
                let (whole_u, whole_v) = match axis {
                    Axis::U => (0.5 * (u + k as f64), v),
                    Axis::V => (u, 0.5 * (v + k as f64)),
                };
                let a = surface_jet(degrees, half, u, v).point;
                let b = surface_jet(degrees, &net, whole_u, whole_v).point;
                for x in 0..4 {
                    assert!((a[x] - b[x]).abs() < 1e-14);
                }
            }
        }
    }
}
