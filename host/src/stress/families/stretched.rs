//! Surfaces of extreme shape, parametrisation, weight or degree.

use glam::DVec3;

use crate::scene::model::{Model, ModelSurface};
use crate::scene::shapes::roots::{folded, grid_of_roots, spread};
use crate::scene::shapes::{Random, bumpy, parallelogram, single, sphere};
use crate::scene::trace::Precision;
use crate::stress::case::{Case, Draw, FEW, Family, Shot, mapped, onto, ray};

pub(super) const FAMILIES: [Family; 5] = [
    Family { name: "aspect", what: "slivers 1e3 to 1e9 times as long as wide", unjudged: FEW, cases: aspect },
    Family {
        name: "uneven",
        what: "control points spaced by ratios up to 1e12, so that speed differs as much",
        unjudged: FEW,
        cases: uneven,
    },
    Family { name: "weights", what: "weights that differ by 1e3 to 1e9", unjudged: FEW, cases: weights },
    Family { name: "degrees", what: "degrees from 1 × 15 and 2 × 12 to 15 × 15", unjudged: FEW, cases: degrees },
    Family { name: "many-roots", what: "up to 25 roots on a ray", unjudged: FEW, cases: many_roots },
];

fn aspect(draw: &mut Draw) -> Vec<Case> {
    let tilted = |p: DVec3| DVec3::new(0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z + 0.3 * p.x);
    let mut models = Vec::new();
    // What is narrower than the margin of the precision is seen to be missed, and no more.
    let widths = if draw.precision == Precision::F64 { [1e-3, 1e-6, 1e-9] } else { [1e-2, 1e-3, 1e-9] };
    for (seed, by) in (51..).zip(widths) {
        let flat = parallelogram([-0.5, -0.5, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        for surface in [bumpy(seed, [3, 3], [0.0; 3], 1.0, 0.2), bumpy(seed, [2, 1], [0.0; 3], 1.0, 0.1), flat] {
            models.push(mapped(&single(surface), |p| tilted(DVec3::new(p.x, p.y * by, p.z))));
        }
    }
    let mut cases = onto(draw, models);
    // Every other ray is aimed at the box, and passes the sliver at some distance.
    for case in &mut cases {
        if let Shot::Rays(rays) = &mut case.shot {
            let around = draw.rays_at(&case.model, draw.rays);
            rays.iter_mut().zip(around).step_by(2).for_each(|(ray, other)| *ray = other);
        }
    }
    cases
}

fn uneven(draw: &mut Draw) -> Vec<Case> {
    let spacings: [[f64; 4]; 4] =
        [[0.0, 1e-3, 1e-2, 1.0], [0.0, 1e-9, 1e-6, 1.0], [0.0, 1e-12, 1.0 - 1e-9, 1.0], [0.0, 0.0, 0.0, 1.0]];
    let mut models = Vec::new();
    for (seed, spacing) in (61..).zip(spacings) {
        for both in [false, true] {
            let mut surface = bumpy(seed, [3, 3], [0.0; 3], 2.0, 0.3);
            for (k, point) in surface.points.iter_mut().enumerate() {
                point[0] = spacing[k / 4];
                if both {
                    point[1] = spacing[3 - k % 4];
                }
            }
            models.push(single(surface));
        }
    }
    onto(draw, models)
}

fn weights(draw: &mut Draw) -> Vec<Case> {
    let mut random = Random(71);
    let mut models = Vec::new();
    for decades in [3.0, 6.0, 9.0] {
        for degrees in [[3, 3], [2, 5]] {
            let mut surface = bumpy(72, degrees, [0.0; 3], 2.0, 0.3);
            surface.rational = true;
            for point in &mut surface.points {
                point[3] = 10.0_f64.powf(random.within(-0.5, 0.5) * decades);
            }
            models.push(single(surface));
        }
        // One heavy point, which draws the middle of the surface towards it.
        let mut surface: ModelSurface = bumpy(73, [4, 4], [0.0; 3], 2.0, 0.3);
        surface.rational = true;
        surface.points[12][3] = 10.0_f64.powf(decades);
        models.push(single(surface));
    }
    onto(draw, models)
}

fn degrees(draw: &mut Draw) -> Vec<Case> {
    let all = [[1, 15], [15, 2], [2, 12], [7, 9], [15, 15], [1, 1]];
    let models = (81..).zip(all).map(|(seed, degrees)| single(bumpy(seed, degrees, [0.1, -0.2, 0.3], 2.0, 0.4)));
    let mut models: Vec<Model> = models.collect();
    models.push(sphere([0.0; 3], 1.0));
    onto(draw, models)
}

fn many_roots(draw: &mut Draw) -> Vec<Case> {
    let mut cases = Vec::new();
    let off = |draw: &mut Draw| DVec3::from_array(draw.random.point(1.0)) * draw.ladder().abs() * 0.1;
    for (count, n) in [(3, 3), (6, 2), (9, 1)] {
        let rays = (0..draw.rays / 5).map(|_| {
            let from = DVec3::new(-1.0, draw.random.within(0.1, 0.9), 0.0) + off(draw);
            ray(from, DVec3::X + off(draw))
        });
        let rays = rays.collect();
        cases.push(Case::of_rays(single(folded(&spread(count), n)), rays));
    }
    for [m, n] in [[5, 5], [8, 6]] {
        let rays = (0..draw.rays / 5).map(|_| ray(DVec3::NEG_Z + off(draw), DVec3::Z + off(draw)));
        let shot = Shot::Rays(rays.collect());
        let model = single(grid_of_roots(&spread(5), &spread(5), m, n));
        cases.push(Case { model, shot, exact: None });
    }
    cases
}
