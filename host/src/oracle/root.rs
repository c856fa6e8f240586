//! What is to be known of a root once it is found: its depth, its angle to the ray, and how far it is from its end.
//!
//! Derivatives of a rational surface by the quotient rule (Farin, section 13.3); the distance to the silhouette from the
//! normal curvature, as of a circle of curvature seen from outside.

use super::contraction::Domain;
use super::edges::EDGES;
use super::net::{Degrees, Point, surface_jet};
use super::real::Real;
use super::surface::{Chart, Ray, Surface, norm};

/// A root of one surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found<R> {
    pub(super) surface: usize,
    pub(super) uv: [R; 2],
    /// The ray's parameter.
    pub(super) t: R,
    /// The depth in the model's frame.
    pub(super) depth: R,
    /// How far `depth` may be off by rounding.
    pub(super) blur: f64,
    /// How far apart in space neighbouring parameters of its chart are there.
    pub(super) fineness: f64,
    /// The cosine of the angle between ray and normal; 0 if there is no normal.
    pub(super) cosine: f64,
    /// How far the ray may move sideways before this root ends, in lengths: see [`super::Root::margin`].
    pub(super) margin: f64,
    /// The unit of its surface; of a root on several the largest.
    pub(super) unit: f64,
}

impl<R: Real> Ray<'_, R> {
    /// The root at the parameters `x` of the chart's net, with its margin.
    pub(super) fn measure(&self, surface: &Surface<R>, chart: &Chart<R>, x: [R; 2]) -> Found<R> {
        let jet = surface_jet(surface.degrees, chart.net, x[0], x[1]);
        let uv = chart.covers.at(x);
        let w = jet.point[3];
        let point = R::over([jet.point[0], jet.point[1], jet.point[2]], w);
        // The quotient rule, for the first derivatives and then for the second.
        let first = jet.first.map(|d| R::over([0, 1, 2].map(|k| d[k] - d[3] * point[k]), w));
        let second = [(0, 0), (0, 1), (1, 1)].map(|(a, b)| {
            let d = jet.second[a + b];
            let [wa, wb] = [jet.first[a][3], jet.first[b][3]];
            let scaled = |k: usize| d[k] - d[3] * point[k] - wa * first[b][k] - wb * first[a][k];
            R::over([0, 1, 2].map(scaled), w).map(R::to_f64)
        });
        let [a, b] = first;
        let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        // Of the angles and curvatures made of these, rounding takes no more digits than it takes of them.
        let normal = normal.map(R::to_f64);
        let [a, b] = first.map(|d| d.map(R::to_f64));
        let fineness = R::EPS * (norm(a) * x[0].abs().to_f64() + norm(b) * x[1].abs().to_f64());
        let area = norm(normal);
        let cosine = if area > 0.0 { normal[2].abs() / area } else { 0.0 };

        // The fold: along the tangent T nearest to the ray the surface turns away with its curvature there.
        let [nx, ny, nz] = normal.map(|x| x / area);
        let sine = (nx * nx + ny * ny).sqrt();
        // T = (e_z − n_z n) / |..|, in parameters: (T × S_v · n, S_u × T · n) / |S_u × S_v|.
        let tangent = [-nz * nx / sine, -nz * ny / sine, sine];
        let triple = |p: [f64; 3], q: [f64; 3]| {
            ((p[1] * q[2] - p[2] * q[1]) * nx + (p[2] * q[0] - p[0] * q[2]) * ny + (p[0] * q[1] - p[1] * q[0]) * nz)
                / area
        };
        let (ku, kv) = (triple(tangent, b), triple(a, tangent));
        let curvature = [0, 1, 2]
            .map(|k| second[0][k] * ku * ku + 2.0 * second[1][k] * ku * kv + second[2][k] * kv * kv)
            .iter()
            .zip([nx, ny, nz])
            .map(|(s, n)| s * n)
            .sum::<f64>()
            .abs();
        let mut margin = if cosine == 0.0 { 0.0 } else { self.diagonal };
        let fold = 0.5 * cosine * cosine / curvature;
        if fold < margin {
            margin = fold;
        }

        // The borders, by the parallelogram of the first derivatives as the ray sees it. How far they are is told from the
        // end that they are at: near 1 the parameter itself is too coarse.
        let Domain { corner, size } = chart.covers;
        let run = |across: usize, end: usize| {
            let run = match end {
                0 => corner[across] + x[across].times(size[across]),
                _ => (R::ONE - corner[across] - R::new(size[across])) + (R::ONE - x[across]).times(size[across]),
            };
            run.abs().to_f64() / size[across]
        };
        for edge in 0..EDGES {
            let (across, along) = (edge / 2, 1 - edge / 2);
            let rim = [a, b][along];
            let distance = run(across, edge % 2) * normal[2].abs() / (rim[0] * rim[0] + rim[1] * rim[1]).sqrt();
            if distance < margin && !self.edges.continues(surface.first_edge + edge, uv[along], self.frame.direction())
            {
                margin = distance;
            }
        }
        Found {
            surface: surface.number,
            uv: uv.map(R::clamp_unit),
            t: self.frame.parameter(point[2]),
            depth: self.frame.start() + point[2],
            blur: 4.0 * (f64::max(chart.error, chart.blur) + fineness) / f64::max(cosine, least_cosine::<R>())
                + R::EPS * self.frame.start().abs().to_f64(),
            fineness,
            cosine,
            margin,
            unit: surface.unit,
        }
    }
}

/// The cosine below which a root is a double one as far as rounding can tell: of the size of a square root of `EPS`.
fn least_cosine<R: Real>() -> f64 {
    1e-8 * (R::EPS / f64::EPSILON).sqrt()
}

/// The parameters of the corner, the middle of a side, or the centre of `domain` that is nearest to the ray. A collapsed
/// edge that the ray meets is one of the sides.
pub(super) fn nearest_point<R: Real>(degrees: Degrees, net: &[Point<R>], domain: Domain<R>) -> [R; 2] {
    let mut best = (f64::INFINITY, [R::ZERO; 2]);
    for k in 0..9 {
        let uv = domain.at([k / 3, k % 3].map(|x| R::new(0.5 * x as f64)));
        let p = surface_jet(degrees, net, uv[0], uv[1]).point.map(R::to_f64);
        let distance = p[0].hypot(p[1]) / p[3];
        if distance < best.0 {
            best = (distance, uv);
        }
    }
    best.1
}
