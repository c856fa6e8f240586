//! Shapes with known equations, as Bézier surfaces.
//!
//! Round shapes are rational (see [`Arcs`]). Their coordinates and weights are rounded to f64, so a shape follows its
//! equation to about 1e-16 of its size. Neighbours share the bits of their common control points.

use super::model::{Model, ModelSurface};
use super::revolution::{Arcs, Curve, revolve};

pub mod roots;
pub mod weights;

/// Pseudo-random numbers: SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number
/// generators", 2014). The same seed gives the same numbers everywhere.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number, evenly spread over `low <= x < high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// The next point of the cube that reaches `half` to either side of 0.
    pub fn point(&mut self, half: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(-half, half))
    }
}

fn polynomial(degree_u: usize, degree_v: usize, points: Vec<[f64; 3]>) -> ModelSurface {
    ModelSurface {
        number: 0,
        degree_u,
        degree_v,
        rational: false,
        points: points.into_iter().map(|[x, y, z]| [x, y, z, 1.0]).collect(),
        knots: None,
    }
}

/// The polynomial surface of control points `at(i, j)`.
pub fn net(degree_u: usize, degree_v: usize, at: impl Fn(usize, usize) -> [f64; 3]) -> ModelSurface {
    let places = (0..=degree_u).flat_map(|i| (0..=degree_v).map(move |j| (i, j)));
    polynomial(degree_u, degree_v, places.map(|(i, j)| at(i, j)).collect())
}

/// A model of one surface.
pub fn single(surface: ModelSurface) -> Model {
    Model::numbered(vec![surface])
}

/// The bilinear surface with these corners, in the order (u, v) = (0, 0), (0, 1), (1, 0), (1, 1).
pub fn bilinear(corners: [[f64; 3]; 4]) -> ModelSurface {
    polynomial(1, 1, corners.to_vec())
}

/// The parallelogram `corner + u along_u + v along_v`, as a bilinear surface.
pub fn parallelogram(corner: [f64; 3], along_u: [f64; 3], along_v: [f64; 3]) -> ModelSurface {
    let at = |u: f64, v: f64| [0, 1, 2].map(|k| corner[k] + u * along_u[k] + v * along_v[k]);
    bilinear([at(0.0, 0.0), at(0.0, 1.0), at(1.0, 0.0), at(1.0, 1.0)])
}

/// The paraboloid z = x² + y² over the square of `half_width` about its apex, moved to have its `apex` there; biquadratic.
pub fn paraboloid(apex: [f64; 3], half_width: f64) -> ModelSurface {
    let a = half_width;
    let (line, square) = ([-a, 0.0, a], [a * a, -a * a, a * a]);
    let mut points = Vec::new();
    for i in 0..3 {
        for j in 0..3 {
            points.push([apex[0] + line[i], apex[1] + line[j], apex[2] + square[i] + square[j]]);
        }
    }
    polynomial(2, 2, points)
}

/// A surface of degrees `m`, `n` over a square of side `size` about `centre` in x and y, its control points' heights
/// spread at random over `height` to either side and its inner points moved sideways by up to a third of their spacing.
pub fn bumpy(seed: u64, [m, n]: [usize; 2], centre: [f64; 3], size: f64, height: f64) -> ModelSurface {
    let mut random = Random(seed);
    let mut points = Vec::new();
    for i in 0..=m {
        for j in 0..=n {
            let mut shift = |k: usize, degree: usize| {
                let inner = k > 0 && k < degree;
                let moved = random.within(-1.0, 1.0) / 3.0;
                (k as f64 + if inner { moved } else { 0.0 }) / degree as f64 - 0.5
            };
            let (x, y) = (shift(i, m), shift(j, n));
            let z = random.within(-height, height);
            points.push([centre[0] + size * x, centre[1] + size * y, centre[2] + z]);
        }
    }
    polynomial(m, n, points)
}

/// The model of these surfaces about the z axis, moved to have `centre` where their origin is.
fn about(centre: [f64; 3], mut surfaces: Vec<ModelSurface>) -> Model {
    for point in surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
        *point = [centre[0] + point[0], centre[1] + point[1], centre[2] + point[2], point[3]];
    }
    Model::numbered(surfaces)
}

/// The circle of radius 1 of `count` rational arcs.
fn circle(count: usize) -> Curve {
    Curve::circle(Arcs::Rational, 0.0, 360.0, count)
}

/// A sphere of 8 biquadratic octants. Each has an edge collapsed at a pole, the upper four at u = 1, the lower at u = 0.
pub fn sphere(centre: [f64; 3], radius: f64) -> Model {
    // The quarters of the profile from the equator up and from the south pole to the equator.
    let quarter = |from| Curve::circle(Arcs::Rational, from, 90.0, 1).map(|[x, y]| [radius * x, radius * y]);
    about(centre, [0.0, -90.0].into_iter().flat_map(|from| revolve(&quarter(from), &circle(4))).collect())
}

/// An open cylinder about the vertical axis through `centre`, of `height` half above and half below: 4 surfaces of
/// degrees 1 along the axis (u, upwards) and 2 around it.
pub fn cylinder(centre: [f64; 3], radius: f64, height: f64) -> Model {
    let profile = Curve::segment(1, [radius, -0.5 * height], [radius, 0.5 * height]);
    about(centre, revolve(&profile, &circle(4)))
}

/// A torus about the vertical axis through `centre`: the circle of radius `minor` swept along that of radius `major`, of
/// `around` surfaces along the great circle and `across` along the small one, each count at least 3; biquadratic.
pub fn torus(centre: [f64; 3], major: f64, minor: f64, around: usize, across: usize) -> Model {
    let section = circle(across).map(|[x, y]| [major + minor * x, minor * y]);
    about(centre, revolve(&section, &circle(around)))
}

/// The same surface with u and v exchanged. It counts as one that its file states as Bézier.
pub fn exchanged(surface: &ModelSurface) -> ModelSurface {
    let columns = surface.degree_v + 1;
    let points = (0..columns).flat_map(|j| surface.points.iter().skip(j).step_by(columns).copied()).collect();
    ModelSurface { degree_u: surface.degree_v, degree_v: surface.degree_u, points, knots: None, ..*surface }
}

/// The same surface with degrees raised to `m` and `n`, each at least its own (Farin, section 5.1).
pub fn elevate(surface: &ModelSurface, m: usize, n: usize) -> ModelSurface {
    let raise = |row: Vec<[f64; 4]>| {
        let degree = row.len();
        let mut raised = vec![row[0]];
        for i in 1..degree {
            let part = i as f64 / degree as f64;
            raised.push([0, 1, 2, 3].map(|k| part * row[i - 1][k] + (1.0 - part) * row[i][k]));
        }
        raised.push(row[degree - 1]);
        raised
    };
    let transpose = |rows: Vec<Vec<[f64; 4]>>| -> Vec<Vec<[f64; 4]>> {
        (0..rows[0].len()).map(|j| rows.iter().map(|row| row[j]).collect()).collect()
    };
    let to = |rows: Vec<Vec<[f64; 4]>>, degree: usize| -> Vec<Vec<[f64; 4]>> {
        let raise_to = |mut row: Vec<[f64; 4]>| {
            // Ends since each turn adds a point.
            while row.len() <= degree {
                row = raise(row);
            }
            row
        };
        rows.into_iter().map(raise_to).collect()
    };
    let homogeneous = |&[x, y, z, w]: &[f64; 4]| [x * w, y * w, z * w, w];
    let rows = surface.points.chunks(surface.degree_v + 1).map(|row| row.iter().map(homogeneous).collect()).collect();
    let raised = transpose(to(transpose(to(rows, n)), m));
    ModelSurface {
        number: 0,
        degree_u: m,
        degree_v: n,
        rational: surface.rational,
        points: raised.into_iter().flatten().map(|[x, y, z, w]| [x / w, y / w, z / w, w]).collect(),
        knots: surface.knots,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The point of a surface at (u, v), by the definition of the Bernstein polynomials.
    fn point(surface: &ModelSurface, u: f64, v: f64) -> [f64; 3] {
        let bernstein = |n: usize, k: usize, t: f64| {
            let choose = (0..k).fold(1.0, |c, j| c * (n - j) as f64 / (j + 1) as f64);
            choose * t.powi(k as i32) * (1.0 - t).powi((n - k) as i32)
        };
        let mut sum = [0.0; 4];
        for i in 0..=surface.degree_u {
            for j in 0..=surface.degree_v {
                let [x, y, z, w] = surface.points[i * (surface.degree_v + 1) + j];
                let b = w * bernstein(surface.degree_u, i, u) * bernstein(surface.degree_v, j, v);
                for (s, x) in sum.iter_mut().zip([x, y, z, 1.0]) {
                    *s += b * x;
                }
            }
        }
        [0, 1, 2].map(|k| sum[k] / sum[3])
    }

    /// Checks that `equation` vanishes all over `model`, to 1e-14.
    fn check(model: &Model, surfaces: usize, equation: impl Fn([f64; 3]) -> f64) {
        assert_eq!(model.surfaces.len(), surfaces);
        for surface in &model.surfaces {
            for i in 0..=8 {
                for j in 0..=8 {
                    let residual = equation(point(surface, i as f64 / 8.0, j as f64 / 8.0));
                    assert!(residual.abs() < 1e-14, "{residual}");
                }
            }
        }
    }

    #[test]
    fn shapes_obey_their_equations() {
        let c = [0.5, -1.0, 2.0];
        let from = |p: [f64; 3]| [p[0] - c[0], p[1] - c[1], p[2] - c[2]];
        check(&sphere(c, 1.5), 8, |p| {
            let [x, y, z] = from(p);
            (x * x + y * y + z * z).sqrt() - 1.5
        });
        check(&cylinder(c, 0.75, 2.0), 4, |p| {
            let [x, y, _] = from(p);
            x.hypot(y) - 0.75
        });
        for (around, across) in [(4, 4), (3, 5), (8, 3)] {
            check(&torus(c, 2.0, 0.5, around, across), around * across, |p| {
                let [x, y, z] = from(p);
                (x.hypot(y) - 2.0).hypot(z) - 0.5
            });
        }
        check(&single(paraboloid(c, 1.25)), 1, |p| {
            let [x, y, z] = from(p);
            z - x * x - y * y
        });
    }

    #[test]
    fn raising_the_degree_leaves_the_surface() {
        for surface in [&sphere([0.0; 3], 1.0).surfaces[2], &bumpy(7, [3, 2], [0.0; 3], 2.0, 0.5)] {
            let raised = elevate(surface, 7, 15);
            assert_eq!((raised.degree_u, raised.degree_v, raised.points.len()), (7, 15, 128));
            for (u, v) in [(0.0, 0.0), (0.3, 0.9), (1.0, 0.5)] {
                let (a, b) = (point(surface, u, v), point(&raised, u, v));
                assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-14));
            }
        }
    }
}
