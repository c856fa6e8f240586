//! What is true of a case: its numbers rounded to the precision, and the oracle's verdict on those.

use rayon::prelude::*;

use super::case::{Case, Exact, Shot};
use crate::judge::Truth;
use crate::oracle::{DoubleDouble, OracleIn, Real};
use crate::scanline::{Found, row};
use crate::scene::model::{ControlBox, Model, ModelSurface};
use crate::scene::rays::RayLine;
use crate::scene::trace::Precision;

/// The number rounded to the precision.
fn rounded(precision: Precision, x: f64) -> f64 {
    match precision {
        Precision::F64 => x,
        Precision::F32 => f64::from(x as f32),
    }
}

/// The case in numbers that the precision holds, so that method and oracle are given the same.
pub fn in_precision(case: &Case, precision: Precision) -> Case {
    let round = |x: f64| rounded(precision, x);
    let surfaces = case.model.surfaces.iter().map(|surface| {
        let points = surface.points.iter().map(|point| point.map(round)).collect();
        ModelSurface { points, ..surface.clone() }
    });
    let shot = match &case.shot {
        Shot::Rays(rays) => Shot::Rays(
            rays.iter()
                .map(|ray| RayLine {
                    origin: ray.origin.map(round),
                    direction: ray.direction.map(round),
                    t_min: round(ray.t_min),
                    t_max: round(ray.t_max),
                    ..*ray
                })
                .collect(),
        ),
        Shot::Picture(view) => Shot::Picture(*view),
    };
    Case { model: Model { surfaces: surfaces.collect() }, shot, exact: case.exact.clone() }
}

/// The rays of a case, in order.
pub fn rays_of(case: &Case) -> Vec<RayLine> {
    match &case.shot {
        Shot::Rays(rays) => rays.clone(),
        Shot::Picture(view) => (0..view.scan_lines()).flat_map(|line| row(view, line)).collect(),
    }
}

/// What is true of each ray of a case, on rayon's current threads.
pub fn of_case(case: &Case, rays: &[RayLine]) -> Vec<Truth> {
    if let Some(Exact(exact)) = &case.exact {
        return rays.iter().map(|ray| exact(&case.model, ray)).collect();
    }
    let oracle = OracleIn::<DoubleDouble>::measured_by(&case.model, |surface| size(surface, &case.model));
    rays.par_iter().map(|ray| Truth::from(&oracle.trace(ray.origin, ray.direction, ray.t_min, ray.t_max))).collect()
}

/// Whether a ray is one that has to be refused: NaN, infinite, or without a direction.
pub fn is_no_ray(ray: &RayLine) -> bool {
    !ray.origin.iter().chain(&ray.direction).all(|x| x.is_finite()) || ray.direction == [0.0; 3]
}

/// What margins and allowances of a surface are shares of: the diagonal of its box. A surface that is a point has none, and is
/// as large as its model, or 1.
pub fn size(surface: &ModelSurface, model: &Model) -> f64 {
    let of = |bounds: Option<ControlBox>| bounds.map(|bounds| bounds.diagonal()).filter(|&size| size > 0.0);
    of(ControlBox::around(&surface.points)).or_else(|| of(model.control_box())).unwrap_or(1.0)
}

/// The margin, as a share of a surface's size, from which on an answer in this precision is judged.
pub fn least_margin(precision: Precision) -> f64 {
    match precision {
        Precision::F64 => 1e-12,
        Precision::F32 => 2e-5,
    }
}

/// The margin, as a share of a surface's size, from which on a ray must not be given up: what is nearer to another answer may
/// take more work than there is.
pub fn clear_margin(precision: Precision) -> f64 {
    match precision {
        Precision::F64 => 1e-9,
        Precision::F32 => 1e-4,
    }
}

/// How far the surface's point at the (u, v) of a hit is from the ray's point at its t, in the units of the model.
pub fn residual(surface: &ModelSurface, ray: &RayLine, found: &Found) -> f64 {
    type Number = DoubleDouble;
    let blend = |points: &mut Vec<[Number; 4]>, t: f64| {
        let t = Number::new(t);
        // Ends: each round leaves one point less.
        while points.len() > 1 {
            for k in 0..points.len() - 1 {
                let (low, high) = (points[k], points[k + 1]);
                points[k] = [0, 1, 2, 3].map(|axis| low[axis] + t * (high[axis] - low[axis]));
            }
            points.pop();
        }
        points.first().copied().unwrap_or([Number::ZERO; 4])
    };
    let weighted = |&[x, y, z, w]: &[f64; 4]| {
        let [x, y, z, w] = [x, y, z, w].map(Number::new);
        [x * w, y * w, z * w, w]
    };
    let rows = surface.points.chunks(surface.degree_v + 1);
    let mut column: Vec<_> = rows.map(|row| blend(&mut row.iter().map(weighted).collect(), found.v)).collect();
    let [x, y, z, w] = blend(&mut column, found.u);
    let t = Number::new(found.t);
    let off = [x, y, z].map(|c| c / w);
    let off = [0, 1, 2].map(|k| (off[k] - t.on_ray(ray.origin[k], ray.direction[k])).to_f64());
    off[0].hypot(off[1]).hypot(off[2])
}
