//! What every answer is judged by: the oracle, and the surface itself.

use crate::corpus::Case;
use patchray_host::judge::Truth;
use patchray_host::oracle::Oracle;
use patchray_host::scanline::Found;
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::rays::RayLine;
use rayon::prelude::*;

/// How many rays a case gets: what the environment says, or else `usual`.
pub(crate) fn rays_per_case(usual: usize) -> usize {
    std::env::var("PATCHRAY_RAYS").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// What the oracle knows of a case's rays.
pub(crate) fn truths(case: &Case, rays: &[RayLine]) -> Vec<Truth> {
    let oracle = Oracle::new(&case.model);
    let judge = |ray: &RayLine| Truth::from(&oracle.trace(ray.origin, ray.direction, ray.t_min, ray.t_max));
    rays.par_iter().map(judge).collect()
}

/// |S(u, v) − (o + t d)| by de Casteljau's algorithm in `f64`, from the file's control points.
pub(crate) fn residual(surface: &ModelSurface, ray: &RayLine, found: &Found) -> f64 {
    let homogeneous = |&[x, y, z, w]: &[f64; 4]| [x * w, y * w, z * w, w];
    let collapse = |mut points: Vec<[f64; 4]>, t: f64| {
        while points.len() > 1 {
            points = points.windows(2).map(|p| std::array::from_fn(|k| (1.0 - t) * p[0][k] + t * p[1][k])).collect();
        }
        points[0]
    };
    let rows = surface.points.chunks(surface.degree_v + 1);
    let along = rows.map(|row| collapse(row.iter().map(homogeneous).collect(), found.v)).collect();
    let [x, y, z, w] = collapse(along, found.u);
    let gap = |k: usize, c: f64| c / w - (ray.origin[k] + found.t * ray.direction[k]);
    (gap(0, x).powi(2) + gap(1, y).powi(2) + gap(2, z).powi(2)).sqrt()
}
