//! What misleads a method that remembers the ray before: scan lines that jump between rays of all kinds.

use glam::DVec3;

use crate::scene::model::{Model, ModelSurface};
use crate::scene::rays::RayLine;
use crate::scene::shapes::weights::{Sheet, Weights};
use crate::scene::shapes::{bumpy, net, single};
use crate::stress::case::{COARSE, Case, Draw, FEW, Family, away, mapped, point, ray};

pub(super) const FAMILIES: [Family; 2] = [
    Family {
        name: "slivers",
        what: "slivers with unit and with uneven weights, along scan lines that jump between rays of all kinds",
        unjudged: COARSE,
        cases: slivers,
    },
    Family {
        name: "jumps",
        what: "a tip, a sliver, a cusp, a steep sheet and a hill in one scene, along scan lines that jump between them",
        unjudged: FEW,
        cases: jumps,
    },
];

/// Rays to a scan line: memory lives that long.
const LINE: usize = 24;

/// One of the kinds of rays: onto a surface, at the box, along a ruling, along the surface.
fn any_kind(draw: &mut Draw, model: &Model) -> RayLine {
    let surface = draw.pick(&model.surfaces).clone();
    let [u, v, a, b] = [0; 4].map(|_| draw.random.within(0.0, 1.0));
    let on = point(&surface, u, v);
    match draw.random.within(0.0, 4.0) as usize {
        0 => draw.ray_to(on, away(model)),
        1 => draw.rays_at(model, 1)[0],
        2 => {
            let along = point(&surface, u, 1.0) - point(&surface, u, 0.0);
            let along = along.normalize_or(DVec3::X) + DVec3::from_array(draw.random.point(1.0)) * draw.ladder();
            ray(on - along * away(model), along)
        }
        _ => {
            let along = (point(&surface, a, b) - on).normalize_or(DVec3::Y);
            let along = along + DVec3::from_array(draw.random.point(0.3));
            ray(on - along * away(model), along)
        }
    }
}

/// The model's case, with rays of all kinds in no order but that some come twice.
fn in_lines(draw: &mut Draw, model: Model, rays: usize) -> Case {
    let mut lines: Vec<RayLine> = Vec::new();
    for k in 0..rays {
        let mut next = match lines.last() {
            Some(last) if draw.random.within(0.0, 6.0) < 1.0 => *last,
            _ => any_kind(draw, &model),
        };
        next.scan_line = (k / LINE) as u64;
        lines.push(next);
    }
    Case::of_rays(model, lines)
}

/// A sliver 1e1 to 1e4 times as long as wide: a curve that turns back once, drawn along itself a little.
fn sliver(draw: &mut Draw) -> ModelSurface {
    let width = 10.0_f64.powf(-draw.random.within(1.0, 4.0));
    let [m, n] = *draw.pick(&[[3, 3], [3, 1], [2, 2], [1, 4]]);
    let curve: Vec<DVec3> = (0..=n).map(|_| DVec3::from_array(draw.random.point(1.0))).collect();
    let drift: Vec<DVec3> = (0..=n).map(|_| DVec3::from_array(draw.random.point(1.0))).collect();
    net(m, n, |i, j| (curve[j] + drift[j] * (width * i as f64 / m as f64)).to_array())
}

fn slivers(draw: &mut Draw) -> Vec<Case> {
    let rays = draw.rays.div_ceil(12).max(2 * LINE);
    let cases = (0..12).map(|number| {
        let mut surface = sliver(draw);
        if number % 2 == 1 {
            let ratio = 10.0_f64.powf(draw.random.within(0.5, 3.0));
            surface = Weights::Any.of(surface, ratio, &mut draw.random);
        }
        in_lines(draw, single(surface), rays)
    });
    cases.collect()
}

fn jumps(draw: &mut Draw) -> Vec<Case> {
    let rays = draw.rays.div_ceil(4);
    let cases = (0..4).map(|number| {
        let mut tip = bumpy(141 + number, [4, 2], [0.0; 3], 1.0, 0.2);
        for point in &mut tip.points[..6] {
            *point = [0.1, 0.2, 0.8, 1.0];
        }
        let cusp = net(3, 1, |i, j| {
            let (square, cube) = ([1.0, -0.3125, -0.3125, 1.0], [-1.0, 1.0, -1.0, 1.0]);
            [0.5 * square[i], j as f64 - 0.5, 0.5 * cube[i]]
        });
        let hill = bumpy(151 + number, [3, 3], [0.0; 3], 1.5, 0.3);
        let ratio = 10.0_f64.powf(draw.random.within(0.5, 4.0));
        let sheet = Sheet::ALL[number as usize].surface(&mut draw.random);
        let steep = draw.pick(&Weights::FALLING).of(sheet, ratio, &mut draw.random);
        let all = [tip, cusp, hill, steep, sliver(draw)];
        // Each overlaps the next as seen from most sides.
        let surfaces = all.into_iter().zip(0..).flat_map(|(surface, k)| {
            let moved = |p: DVec3| p + DVec3::new(0.7, 0.4, -0.5) * f64::from(k);
            mapped(&single(surface), moved).surfaces
        });
        let mut surfaces: Vec<_> = surfaces.collect();
        for surface in &mut surfaces {
            surface.rational = true;
        }
        in_lines(draw, Model::numbered(surfaces), rays)
    });
    cases.collect()
}
