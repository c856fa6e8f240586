//! Surfaces of very different sizes in one scene, and small ones with a mate far away.

use glam::DVec3;

use crate::scene::model::{Model, ModelSurface};
use crate::scene::shapes::{bumpy, parallelogram, single, sphere};
use crate::scene::trace::Precision;
use crate::stress::case::{Case, Draw, FEW, Family, mapped, point, ray};

pub(super) const FAMILIES: [Family; 2] = [
    Family {
        name: "sizes",
        what: "sizes 1 to 1e9 in one scene, each before the next larger one, met within and beyond their borders",
        unjudged: FEW,
        cases: sizes,
    },
    Family {
        name: "mates",
        what: "a small surface and a mate 1e3 to 1e9 times as large, or as far away, near 0 or far from it",
        unjudged: FEW,
        cases: mates,
    },
];

/// A ray onto the surface, from three sizes of it away: half of them by steps within or beyond its border.
fn near_border(draw: &mut Draw, surface: &ModelSurface, size: f64) -> crate::scene::rays::RayLine {
    let [along, across] = [draw.random.within(0.0, 1.0), draw.random.within(0.0, 1.0)];
    let edge = draw.random.within(0.0, 8.0) as usize;
    let (u, v) = match edge {
        0 => (0.0, along),
        1 => (1.0, along),
        2 => (along, 0.0),
        3 => (along, 1.0),
        _ => (along, across),
    };
    let on = point(surface, u, v);
    let outward = (on - point(surface, 0.5, 0.5)).normalize_or(DVec3::X);
    let target = if edge < 4 { on + outward * (draw.ladder() * size) } else { on };
    let along = DVec3::NEG_Z + DVec3::from_array(draw.random.point(0.2));
    ray(target - along * (3.0 * size), along)
}

fn sizes(draw: &mut Draw) -> Vec<Case> {
    let of = |seed: u64, size: f64, turn: bool| {
        let surface = bumpy(seed, [3, 3], [0.0; 3], size, 0.1 * size);
        let flat = parallelogram([-0.5 * size, -0.5 * size, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]);
        let surface = if turn { surface } else { flat };
        mapped(&single(surface), |p| p - DVec3::Z * (0.7 * size)).surfaces
    };
    let mut cases = Vec::new();
    for (seed, turned) in [(121, [true, false, true, false]), (122, [false, true, false, true])] {
        let scales = [1.0, 1e3, 1e6, 1e9];
        let surfaces = scales.into_iter().zip(turned).flat_map(|(size, turn)| of(seed, size, turn)).collect();
        let model = Model::numbered(surfaces);
        let rays = (0..draw.rays / 2).map(|_| {
            let place = (draw.random.within(0.0, 4.0) as usize).min(3);
            near_border(draw, &model.surfaces[place], scales[place])
        });
        let rays = rays.collect();
        cases.push(Case::of_rays(model, rays));
    }
    cases
}

fn mates(draw: &mut Draw) -> Vec<Case> {
    let smalls: [Vec<ModelSurface>; 3] = [
        vec![parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])],
        vec![bumpy(123, [3, 3], [0.3, -0.2, 0.1], 1.0, 0.2)],
        sphere([0.1, 0.2, 0.3], 0.5).surfaces,
    ];
    let mut cases = Vec::new();
    let rays = draw.rays.div_ceil(3 * 4 * 2);
    for small in smalls {
        for far in [1e3, 1e6, 1e9, 1e9] {
            // The small one far from 0 has no more digits than its coordinates.
            let place = match draw.precision {
                Precision::F64 => draw.random.within(0.0, 6.0),
                Precision::F32 => draw.random.within(0.0, 3.0),
            };
            let offset = *draw.pick(&[0.0, 10.0_f64.powf(place)]);
            let direction = *draw.pick(&[DVec3::X, DVec3::new(0.0, -1.0, 1.0), DVec3::new(0.7, -0.9, 1.0)]);
            let small = mapped(&Model::numbered(small.clone()), |p| p + direction * offset);
            let floor = parallelogram([-0.5 * far, -0.5 * far, -0.01 * far], [far, 0.0, 0.0], [0.0, far, 0.0]);
            let away = parallelogram([far, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
            for mate in [floor, away] {
                let count = small.surfaces.len();
                let model = Model::numbered([small.surfaces.clone(), vec![mate]].concat());
                let lines = (0..rays).map(|_| {
                    let place = (draw.random.within(0.0, count as f64) as usize).min(count - 1);
                    near_border(draw, &model.surfaces[place], 1.0)
                });
                let lines = lines.collect();
                cases.push(Case::of_rays(model, lines));
            }
        }
    }
    cases
}
