//! Rays at seams, edges and corners.

use glam::DVec3;

use crate::scene::model::{Model, ModelSurface};
use crate::scene::shapes::{bumpy, cylinder, parallelogram, single, sphere, torus};
use crate::scene::teapot;
use crate::stress::case::{Case, Draw, FEW, Family, away, point, ray};

pub(super) const FAMILIES: [Family; 2] = [
    Family {
        name: "seams",
        what: "aimed at edges and corners that neighbours share to the bit: teapot, sphere, torus, cylinder",
        unjudged: FEW,
        cases: seams,
    },
    Family {
        name: "borders",
        what: "1e-1 to 1e-14 (f32: 1e-5) within and beyond edges and corners that nothing continues",
        unjudged: FEW,
        cases: borders,
    },
];

/// The corners of a surface's edge by number: u = 0, u = 1, v = 0, v = 1.
fn at_edge(edge: usize, along: f64) -> [f64; 2] {
    let across = (edge % 2) as f64;
    if edge < 2 { [across, along] } else { [along, across] }
}

/// The control points of an edge.
fn edge_points(surface: &ModelSurface, edge: usize) -> Vec<[f64; 4]> {
    let (m, n) = (surface.degree_u, surface.degree_v);
    match edge {
        0 => (0..=n).map(|j| surface.points[j]).collect(),
        1 => (0..=n).map(|j| surface.points[m * (n + 1) + j]).collect(),
        2 => (0..=m).map(|i| surface.points[i * (n + 1)]).collect(),
        _ => (0..=m).map(|i| surface.points[i * (n + 1) + n]).collect(),
    }
}

/// The edges that another surface shares to the bit and that are no points.
fn shared_edges(model: &Model) -> Vec<(usize, usize)> {
    let edges: Vec<_> = model
        .surfaces
        .iter()
        .enumerate()
        .flat_map(|(number, surface)| (0..4).map(move |edge| ((number, edge), edge_points(surface, edge))))
        .filter(|(_, points)| points.iter().any(|point| point != &points[0]))
        .collect();
    let same = |a: &[[f64; 4]], b: &[[f64; 4]]| a == b || a.iter().eq(b.iter().rev());
    let shared = edges
        .iter()
        .filter(|(place, points)| edges.iter().any(|(other, others)| other.0 != place.0 && same(points, others)));
    shared.map(|(place, _)| *place).collect()
}

fn seams(draw: &mut Draw) -> Vec<Case> {
    let models = [
        teapot::model().unwrap_or_default(),
        sphere([0.5, -0.25, 1.0], 1.5),
        torus([0.0; 3], 1.0, 0.25, 4, 4),
        cylinder([0.3, -0.1, 0.2], 0.7, 1.1),
    ];
    let rays = draw.rays / models.len();
    let cases = models.into_iter().map(|model| {
        let edges = shared_edges(&model);
        let distance = away(&model);
        let lines = (0..rays).map(|_| {
            let &(number, edge) = draw.pick(&edges);
            // Every eighth at a corner.
            let along = if draw.random.within(0.0, 8.0) < 1.0 { 1.0 } else { draw.random.within(0.0, 1.0) };
            let [u, v] = at_edge(edge, along);
            let target = point(&model.surfaces[number], u, v);
            draw.ray_to(target, distance)
        });
        let lines = lines.collect();
        Case::of_rays(model, lines)
    });
    cases.collect()
}

fn borders(draw: &mut Draw) -> Vec<Case> {
    let models = [
        single(parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])),
        single(parallelogram([0.1, 0.2, 0.3], [1.0, 0.5, 0.0], [-0.25, 1.0, 0.5])),
        single(bumpy(101, [3, 3], [0.1, -0.2, 0.3], 1.0, 0.2)),
        single(bumpy(102, [5, 2], [0.0; 3], 1.0, 0.2)),
    ];
    let rays = draw.rays / models.len();
    let cases = models.into_iter().map(|model| {
        let surface = &model.surfaces[0];
        let lines = (0..rays).map(|_| {
            let edge = draw.random.within(0.0, 4.0) as usize;
            let corner = draw.random.within(0.0, 4.0) < 1.0;
            let along = if corner { (edge % 2) as f64 } else { draw.random.within(0.0, 1.0) };
            let [u, v] = at_edge(edge.min(3), along);
            let on = point(surface, u, v);
            let across = (on - point(surface, 0.5, 0.5)).normalize();
            // Steep, so that distance in space is distance as the ray sees it.
            let tilt = DVec3::from_array(draw.random.point(0.2));
            let along = DVec3::NEG_Z + tilt;
            ray(on + across * draw.ladder() - along * 2.0, along)
        });
        let lines = lines.collect();
        Case::of_rays(model, lines)
    });
    cases.collect()
}
