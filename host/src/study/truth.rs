//! What the oracle says of a picture's rays, with all their roots.

use rayon::prelude::*;

use crate::judge::Truth;
use crate::oracle::Oracle;
use crate::scanline::row;
use crate::scene::camera::View;
use crate::scene::rays::RayLine;

/// What the oracle says of a ray.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayTruth {
    /// The answer.
    pub truth: Truth,
    /// The parameters of all roots along the ray, sorted.
    pub roots: Vec<f64>,
}

/// What the oracle says of one ray.
pub fn of_ray(oracle: &Oracle, ray: &RayLine) -> RayTruth {
    let verdict = oracle.trace(ray.origin, ray.direction, ray.t_min, ray.t_max);
    RayTruth { truth: Truth::from(&verdict), roots: verdict.roots.iter().map(|root| root.t).collect() }
}

/// What the oracle says of each ray of the picture, in order, on rayon's current threads; `step` is called once for each
/// scan line.
pub fn of_picture(oracle: &Oracle, picture: &View, step: impl Fn() + Sync) -> Vec<RayTruth> {
    let lines: Vec<Vec<RayTruth>> = (0..picture.scan_lines())
        .into_par_iter()
        .map(|line| {
            let truths = row(picture, line).iter().map(|ray| of_ray(oracle, ray)).collect();
            step();
            truths
        })
        .collect();
    lines.concat()
}
