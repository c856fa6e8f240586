//! Surfaces that a line meets often, or badly.

use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::shapes::elevate;

/// The Bernstein coefficients of ∏ (x − r) over `roots`, times a power of two that brings the largest near 1.
pub(crate) fn product(roots: &[f64]) -> Vec<f64> {
    let mut c = vec![1.0];
    for &r in roots {
        let degree = c.len();
        let at = |i: usize| {
            let low = if i < degree { (degree - i) as f64 * -r * c[i] } else { 0.0 };
            let high = if i > 0 { i as f64 * (1.0 - r) * c[i - 1] } else { 0.0 };
            (low + high) / degree as f64
        };
        c = (0..=degree).map(at).collect();
    }
    let largest = c.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let by = largest.log2().floor().exp2();
    c.iter().map(|x| x / by).collect()
}

/// `count` roots spread over (0, 1).
pub(crate) fn spread(count: usize) -> Vec<f64> {
    (0..count).map(|k| (k as f64 + 0.5) / count as f64).collect()
}

/// A surface of control points `at(i, j)`.
pub(crate) fn surface(m: usize, n: usize, at: impl Fn(usize, usize) -> [f64; 3]) -> ModelSurface {
    let points = (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j)));
    let points = points.map(|(i, j)| at(i, j)).map(|[x, y, z]| [x, y, z, 1.0]).collect();
    ModelSurface { number: 0, degree_u: m, degree_v: n, rational: false, points, knots: None }
}

/// The graph z = ∏ (x − r) over the unit square: a line along x at z = 0 meets it at each root.
pub(crate) fn folded(roots: &[f64], n: usize) -> ModelSurface {
    let (m, c) = (roots.len(), product(roots));
    surface(m, n, |i, j| [i as f64 / m as f64, j as f64 / n as f64, c[i]])
}

/// S = (∏ (u − r), ∏ (v − s), u + v/16), raised to degrees m and n: a line along z meets it at each pair of roots.
pub(crate) fn grid_of_roots(r: &[f64], s: &[f64], m: usize, n: usize) -> ModelSurface {
    let (p, q) = (product(r), product(s));
    let (a, b) = (r.len(), s.len());
    elevate(&surface(a, b, |i, j| [p[i], q[j], i as f64 / a as f64 + j as f64 / b as f64 / 16.0]), m, n)
}

/// The model with every control point moved by `map`.
pub(crate) fn mapped(model: &Model, map: impl Fn([f64; 3]) -> [f64; 3]) -> Model {
    let mut model = model.clone();
    for point in model.surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
        let [x, y, z] = map([point[0], point[1], point[2]]);
        *point = [x, y, z, point[3]];
    }
    model
}

/// A shear that leaves no axis where it was, exact for short numbers; and the same of directions.
pub(crate) fn askew([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.25 * y - 0.5 * z, y - 0.125 * x + 0.75 * z, z + 0.375 * x + 0.5 * y]
}
