//! Surfaces that a line meets as often as a polynomial has roots.

use super::{elevate, net};
use crate::scene::model::ModelSurface;

/// The Bernstein coefficients of ∏ (x − r) over `roots`, times a power of two that brings the largest near 1.
pub fn product(roots: &[f64]) -> Vec<f64> {
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
pub fn spread(count: usize) -> Vec<f64> {
    (0..count).map(|k| (k as f64 + 0.5) / count as f64).collect()
}

/// The graph z = ∏ (x − r) over the unit square: a line along x at z = 0 meets it at each root.
pub fn folded(roots: &[f64], n: usize) -> ModelSurface {
    let (m, c) = (roots.len(), product(roots));
    net(m, n, |i, j| [i as f64 / m as f64, j as f64 / n as f64, c[i]])
}

/// S = (∏ (u − r), ∏ (v − s), u + v/16), raised to degrees m and n: a line along z meets it at each pair of roots.
pub fn grid_of_roots(r: &[f64], s: &[f64], m: usize, n: usize) -> ModelSurface {
    let (p, q) = (product(r), product(s));
    let (a, b) = (r.len(), s.len());
    elevate(&net(a, b, |i, j| [p[i], q[j], i as f64 / a as f64 + j as f64 / b as f64 / 16.0]), m, n)
}
