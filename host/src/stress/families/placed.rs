//! Ordinary surfaces in extreme places and units, and rays in theirs.

use glam::DVec3;

use crate::scene::model::Model;
use crate::scene::rays::RayLine;
use crate::scene::shapes::{bumpy, single, sphere, torus};
use crate::scene::teapot;
use crate::scene::trace::Precision;
use crate::stress::case::{Case, Draw, FEW, Family, away, mapped};

pub(super) const FAMILIES: [Family; 6] = [
    Family { name: "scales", what: "coordinates from 1e-30 to 1e30", unjudged: FEW, cases: scales },
    Family { name: "offsets", what: "models 1e1 to 1e9 of their size away from 0", unjudged: FEW, cases: offsets },
    Family {
        name: "origins",
        what: "rays from 1e3 to 1e12 sizes away, from inside, and from the surface",
        unjudged: FEW,
        cases: origins,
    },
    Family { name: "lengths", what: "directions of length 1e-20 to 1e20", unjudged: FEW, cases: lengths },
    Family {
        name: "axes",
        what: "directions with zeros, negative zeros, and numbers of no weight beside others",
        unjudged: FEW,
        cases: axes,
    },
    Family {
        name: "intervals",
        what: "ranges of t that begin or end near roots, or behind the origin",
        unjudged: FEW,
        cases: intervals,
    },
];

/// Three models of size about 1: polynomial, rational and of many surfaces.
fn ordinary() -> [Model; 3] {
    let small = |model: &Model| mapped(model, |p| p * 0.125);
    [
        single(bumpy(91, [3, 3], [0.1, -0.2, 0.05], 0.8, 0.2)),
        torus([0.1, 0.0, -0.1], 0.3, 0.125, 4, 4),
        teapot::model().map_or_else(|_| sphere([0.0; 3], 0.5), |model| small(&model)),
    ]
}

/// Cases of all ordinary models with rays onto them, changed by each of `changes`.
fn changed<C: Copy>(
    draw: &mut Draw,
    changes: &[C],
    change: impl Fn(&mut Draw, C, Model, Vec<RayLine>) -> Case,
) -> Vec<Case> {
    let rays = draw.rays.div_ceil(3 * changes.len());
    let mut cases = Vec::new();
    for &by in changes {
        for model in ordinary() {
            let lines = draw.rays_onto(&model, rays);
            cases.push(change(draw, by, model, lines));
        }
    }
    cases
}

fn scales(draw: &mut Draw) -> Vec<Case> {
    changed(draw, &[1e-30, 1e-20, 1e-10, 1e-3, 1e4, 1e10, 1e20, 1e30], |_, by, model, mut rays| {
        for ray in &mut rays {
            // Directions stay short: t is then as large as the model.
            ray.origin = ray.origin.map(|c| c * by);
        }
        Case::of_rays(mapped(&model, |p| p * by), rays)
    })
}

fn offsets(draw: &mut Draw) -> Vec<Case> {
    changed(draw, &[1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9], |draw, by, model, mut rays| {
        // Toward a face, an edge or a corner of space.
        let along = *draw.pick(&[DVec3::X, DVec3::new(0.0, -1.0, 1.0), DVec3::new(0.7, -0.9, 1.0)]);
        for ray in &mut rays {
            ray.origin = (DVec3::from_array(ray.origin) + along * by).to_array();
        }
        Case::of_rays(mapped(&model, |p| p + along * by), rays)
    })
}

fn origins(draw: &mut Draw) -> Vec<Case> {
    let far = if draw.precision == Precision::F64 { 1e12 } else { 1e6 };
    changed(draw, &[1e3, 1e3 * far / 1e6, far, 1e-3, 0.0], |draw, by, model, mut rays| {
        for ray in &mut rays {
            let direction = DVec3::from_array(ray.direction);
            let mut origin = DVec3::from_array(ray.origin);
            if by > 1.0 {
                origin -= direction * by;
                // From so far away only a direction of few digits has points near the model that are known to the last.
                let digits = |x: f64| (x * 4096.0).round() / 4096.0;
                let short = DVec3::from_array(direction.to_array().map(digits));
                origin = DVec3::from_array(ray.origin) - short * by.log2().round().exp2();
                ray.direction = short.to_array();
            } else {
                // Near a point of the surface, which the ray was aimed at; then the point itself is not counted.
                origin += direction * (away(&model) - by);
                if by == 0.0 {
                    ray.t_min = *draw.pick(&[1e-3, -1e-3, 1e-2]);
                }
            }
            ray.origin = origin.to_array();
        }
        Case::of_rays(model, rays)
    })
}

fn lengths(draw: &mut Draw) -> Vec<Case> {
    changed(draw, &[1e-20, 1e-10, 1e-3, 1e5, 1e10, 1e20], |_, by, model, mut rays| {
        for ray in &mut rays {
            ray.direction = ray.direction.map(|c| c * by);
        }
        Case::of_rays(model, rays)
    })
}

fn axes(draw: &mut Draw) -> Vec<Case> {
    changed(draw, &[0.0, -0.0, 1e-300, -1e-45, 1e-17], |draw, by, model, mut rays| {
        let distance = away(&model);
        for ray in &mut rays {
            let target = DVec3::from_array(ray.origin) + DVec3::from_array(ray.direction) * distance;
            let kept = *draw.pick(&[1_usize, 2, 4, 3, 5, 6]);
            let direction = [0, 1, 2].map(|k| if kept >> k & 1 == 1 { ray.direction[k] } else { by });
            ray.direction = direction;
            ray.origin = (target - DVec3::from_array(direction).normalize() * distance).to_array();
        }
        Case::of_rays(model, rays)
    })
}

fn intervals(draw: &mut Draw) -> Vec<Case> {
    changed(draw, &[0, 1, 2, 3], |draw, kind, model, mut rays| {
        let distance = away(&model);
        for ray in &mut rays {
            // Rays are aimed at a root from this far away.
            let near = distance + draw.ladder();
            [ray.t_min, ray.t_max] = match kind {
                0 => [near, f64::INFINITY],
                1 => [0.0, near],
                2 => [near - 0.05, near],
                _ => {
                    ray.origin =
                        (DVec3::from_array(ray.origin) + DVec3::from_array(ray.direction) * 2.0 * distance).to_array();
                    [-2.0 * distance, near - 2.0 * distance]
                }
            };
        }
        Case::of_rays(model, rays)
    })
}
