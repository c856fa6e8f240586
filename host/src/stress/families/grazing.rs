//! Rays that all but touch: ladders of tangents, each a little above or below the surface.

use glam::DVec3;

use crate::scene::shapes::{elevate, net, paraboloid, parallelogram, single, sphere};
use crate::stress::case::{Case, Draw, Family, MANY, ray};

pub(super) const FAMILIES: [Family; 4] = [
    Family {
        name: "grazing-paraboloid",
        what: "tangents of z = x² + y², moved 1e-1 to 1e-14 (f32: 1e-5) to either side",
        unjudged: MANY,
        cases: on_paraboloid,
    },
    Family { name: "grazing-sphere", what: "the same of a rational sphere", unjudged: MANY, cases: on_sphere },
    Family {
        name: "grazing-cubic",
        what: "z = x³ along x: three roots, or one, that all but fall together",
        unjudged: MANY,
        cases: cubic_contact,
    },
    Family {
        name: "grazing-plane",
        what: "planes seen edge on, in their plane and 1e-1 to 1e-14 (f32: 1e-5) off or tilted",
        unjudged: MANY,
        cases: edge_on,
    },
];

fn on_paraboloid(draw: &mut Draw) -> Vec<Case> {
    let rays = (0..draw.rays).map(|_| {
        let [x, y] = [0; 2].map(|_| draw.random.within(-0.7, 0.7));
        let (sin, cos) = draw.random.within(0.0, std::f64::consts::TAU).sin_cos();
        let along = DVec3::new(cos, sin, 2.0 * (x * cos + y * sin));
        ray(DVec3::new(x, y, x * x + y * y + draw.ladder()) - 2.0 * along, along)
    });
    let rays = rays.collect();
    vec![Case::of_rays(single(paraboloid([0.0; 3], 1.0)), rays)]
}

fn on_sphere(draw: &mut Draw) -> Vec<Case> {
    let centre = DVec3::new(0.5, -0.25, 1.0);
    let rays = (0..draw.rays).map(|_| {
        let normal = draw.direction();
        let along = normal.any_orthonormal_vector();
        let along = glam::DQuat::from_axis_angle(normal, draw.random.within(0.0, std::f64::consts::TAU)) * along;
        ray(centre + normal * (1.5 * (1.0 + draw.ladder())) - along * 4.0, along)
    });
    let rays = rays.collect();
    vec![Case::of_rays(sphere(centre.to_array(), 1.5), rays)]
}

fn cubic_contact(draw: &mut Draw) -> Vec<Case> {
    let height = [-1.0, 1.0, -1.0, 1.0];
    let graph = net(3, 1, |i, j| [(2.0 * i as f64 - 3.0) / 3.0, 2.0 * j as f64 - 1.0, height[i]]);
    let rays = (0..draw.rays).map(|_| {
        let (slope, off) = (draw.ladder(), draw.ladder());
        // Either ladder alone, and both.
        let [slope, off] = *draw.pick(&[[slope, 0.0], [0.0, off], [slope, off]]);
        let along = DVec3::new(1.0, draw.random.within(-0.2, 0.2), slope);
        ray(DVec3::new(0.0, draw.random.within(-0.5, 0.5), off) - along * 2.0, along)
    });
    let rays = rays.collect();
    vec![Case::of_rays(single(graph), rays)]
}

fn edge_on(draw: &mut Draw) -> Vec<Case> {
    let flat = parallelogram([-1.0, -1.0, 0.25], [2.0, 0.0, 0.0], [0.5, 2.0, 0.0]);
    let tilted = parallelogram([-1.0, -1.0, 0.0], [2.0, 0.5, 1.0], [-0.5, 2.0, 0.25]);
    let mut cases = Vec::new();
    for surface in [flat.clone(), elevate(&flat, 3, 3), tilted.clone(), elevate(&tilted, 3, 3)] {
        let corner = |k: usize| DVec3::from_slice(&surface.points[k][..3]);
        let (m, n) = (surface.degree_u, surface.degree_v);
        let (origin, along_u, along_v) = (corner(0), corner(m * (n + 1)) - corner(0), corner(n) - corner(0));
        let normal = along_u.cross(along_v).normalize();
        let rays = (0..draw.rays / 4).map(|_| {
            let [a, b, c, d] = [0; 4].map(|_| draw.random.within(-0.2, 1.2));
            let (from, to) = (origin + along_u * a + along_v * b, origin + along_u * c + along_v * d);
            let (high, low) = (draw.ladder(), draw.ladder());
            let [high, low] = *draw.pick(&[[high, high], [high, low], [0.0, high], [0.0, 0.0]]);
            let (from, to) = (from + normal * high, to + normal * low);
            ray(from - (to - from) * 2.0, to - from)
        });
        let rays = rays.collect();
        cases.push(Case::of_rays(single(surface), rays));
    }
    cases
}
