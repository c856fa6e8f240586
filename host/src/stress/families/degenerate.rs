//! Surfaces without a normal somewhere, without an area, or on top of one another.

use glam::DVec3;

use crate::judge::Truth;
use crate::scene::model::{Model, ModelSurface};
use crate::scene::rays::RayLine;
use crate::scene::revolution::{Arcs, Curve, revolve};
use crate::scene::shapes::{bumpy, elevate, net, parallelogram, single, sphere};
use crate::stress::case::{Case, Draw, FEW, Family, onto, point, ray};

pub(super) const FAMILIES: [Family; 5] = [
    Family {
        name: "collapsed-edges",
        what: "bicubics with an edge drawn together to a point, or all but, seen from near that point",
        unjudged: FEW,
        cases: collapsed,
    },
    Family {
        name: "poles",
        what: "the poles of a sphere and the apex of a cone, met head on and 1e-1 to 1e-14 (f32: 1e-5) beside",
        unjudged: FEW,
        cases: poles,
    },
    Family { name: "cusps", what: "a surface that turns back in a cusp", unjudged: FEW, cases: cusps },
    Family {
        name: "coincident",
        what: "duplicates, the same surface in other degrees, planes in one plane",
        unjudged: FEW,
        cases: coincident,
    },
    Family {
        name: "no-area",
        what: "surfaces that are a point, a line or a triangle, before one that is not",
        unjudged: FEW,
        cases: no_area,
    },
];

fn collapsed(draw: &mut Draw) -> Vec<Case> {
    let mut cases = Vec::new();
    for seed in 0..6 {
        let mut surface = bumpy(31 + seed, [3, 3], [0.0; 3], 1.5, 0.4);
        let place = DVec3::new(0.7, -0.4, 0.2);
        let nearly = if seed % 3 == 2 { draw.ladder().abs() } else { 0.0 };
        for k in 0..4 {
            let at = if seed % 2 == 0 { k } else { 4 * k + 3 };
            let [x, y, z] = (place + DVec3::new(0.0, 1.0, 1.0) * (nearly * k as f64)).to_array();
            surface.points[at] = [x, y, z, 1.0];
        }
        let rays = (0..draw.rays / 6).map(|_| {
            // From the inside of the surface to the point, by steps.
            let [along, toward] = [draw.random.within(0.0, 1.0), draw.ladder().abs() * 9.0];
            let [u, v] = if seed % 2 == 0 { [toward, along] } else { [along, 1.0 - toward] };
            let target = point(&surface, u, v);
            draw.ray_to(target, 3.0)
        });
        let rays = rays.collect();
        cases.push(Case::of_rays(single(surface), rays));
    }
    cases
}

const CENTRE: DVec3 = DVec3::new(0.5, -0.25, 1.0);

/// A truth that nothing puts in doubt.
fn sure(closest: Option<f64>) -> Truth {
    Truth { closest, roots: usize::from(closest.is_some()), margin: 1.0, ..Truth::default() }
}

/// The roots of a t² + 2 b t + c, a not 0, in order; a negative discriminant is taken for rounding.
fn quadratic(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = (b * b - a * c).max(0.0).sqrt();
    // The root of larger size first: the other, as a difference, would lose its digits.
    let far = if b > 0.0 { -b - root } else { -b + root };
    let roots = if far == 0.0 { [0.0; 2] } else { [far / a, c / far] };
    if roots[0] <= roots[1] { roots } else { [roots[1], roots[0]] }
}

/// Where a line from outside first meets the sphere of radius 1.5: the oracle takes a pole for a border.
fn on_sphere(ray: &RayLine) -> Truth {
    let (o, d) = (DVec3::from_array(ray.origin) - CENTRE, DVec3::from_array(ray.direction));
    sure(Some(quadratic(d.dot(d), o.dot(d), o.dot(o) - 2.25)[0]))
}

/// Where a line from above that passes the apex closely, and steeper than the sides, meets the cone x² + y² = (1 − z)²,
/// 0 <= z <= 1: of the double cone's two sheets it meets each once, the lower one later.
fn on_cone(ray: &RayLine) -> Truth {
    let (o, d) = (DVec3::from_array(ray.origin) - DVec3::Z, DVec3::from_array(ray.direction));
    // From the height of the apex, so that what is small is known to its own digits.
    let level = -o.z / d.z;
    let [x, y] = [o.x + level * d.x, o.y + level * d.y];
    let [_, later] = quadratic(d.x * d.x + d.y * d.y - d.z * d.z, x * d.x + y * d.y, x * x + y * y);
    sure(Some(level + later))
}

fn poles(draw: &mut Draw) -> Vec<Case> {
    let cone = Curve::segment(1, [1.0, 0.0], [0.0, 1.0]);
    let cone = Model::numbered(revolve(&cone, &Curve::circle(Arcs::Rational, 0.0, 360.0, 4)));
    let beside = |draw: &mut Draw| {
        let [x, y] = [draw.ladder(), draw.ladder()];
        *draw.pick(&[[x, y], [x, 0.0], [0.0, y], [0.0, 0.0]])
    };
    let onto_sphere = (0..draw.rays / 2).map(|_| {
        let [x, y] = beside(draw);
        let pole = if draw.random.within(0.0, 1.0) < 0.5 { DVec3::Z } else { DVec3::NEG_Z };
        let target = (pole + DVec3::new(x, y, 0.0)).normalize();
        loop {
            // Ends: the half space of directions that meet the pole from outside, well off a tangent, is a third of all.
            let along = draw.direction();
            if along.dot(pole) < -0.3 {
                return ray(CENTRE + target * 1.5 - along * 3.0, along);
            }
        }
    });
    let onto_sphere: Vec<RayLine> = onto_sphere.collect();
    let onto_cone = (0..draw.rays / 2).map(|_| {
        let [x, y] = beside(draw);
        let target = DVec3::new(x, y, 1.0 - x.hypot(y));
        loop {
            // Ends as above. Steep enough to enter through the cone and not to pass it.
            let along = draw.direction();
            if along.z < -0.8 {
                return ray(target - along * 2.0, along);
            }
        }
    });
    let onto_cone: Vec<RayLine> = onto_cone.collect();
    vec![
        Case::of_form(sphere(CENTRE.to_array(), 1.5), onto_sphere, |_, ray| on_sphere(ray)),
        Case::of_form(cone, onto_cone, |_, ray| on_cone(ray)),
    ]
}

fn cusps(draw: &mut Draw) -> Vec<Case> {
    // (t², t³) for t from −1 to 1, drawn along y and bent a little.
    let (square, cube) = ([1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0], [-1.0, 1.0, -1.0, 1.0]);
    let surface = net(3, 2, |i, j| [square[i], j as f64 - 1.0, cube[i] + if j == 1 { 0.25 } else { 0.0 }]);
    let rays = (0..draw.rays).map(|_| {
        let [near, any, v] = [0.5 + 0.5 * draw.ladder(), draw.random.within(0.0, 1.0), draw.random.within(0.0, 1.0)];
        let u = *draw.pick(&[near, any, any]);
        // On one of the two sheets, or beside the edge in which they meet.
        let off = *draw.pick(&[0.0, 0.0, 0.0, 1.0]) * draw.ladder();
        let target = point(&surface, u, v) + DVec3::X * off;
        draw.ray_to(target, 4.0)
    });
    let rays = rays.collect();
    vec![Case::of_rays(single(surface), rays)]
}

fn coincident(draw: &mut Draw) -> Vec<Case> {
    let hill = bumpy(41, [3, 3], [0.1, -0.2, 0.3], 2.0, 0.4);
    let square = parallelogram([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    let slanted = parallelogram([-1.5, 0.0, 0.0], [1.5, -1.5, 0.0], [1.5, 1.5, 0.0]);
    let turned = |surface: &ModelSurface| {
        let points = surface.points.iter().rev().copied().collect();
        ModelSurface { points, ..surface.clone() }
    };
    let mut twice = sphere([0.0; 3], 1.0).surfaces;
    twice.extend(twice.clone());
    let models = [
        vec![hill.clone(), hill.clone(), hill.clone()],
        vec![hill.clone(), turned(&hill), elevate(&hill, 5, 7)],
        vec![square.clone(), slanted, elevate(&square, 3, 3)],
        twice,
    ];
    let models = models.map(Model::numbered);
    onto(draw, models.to_vec())
}

fn no_area(draw: &mut Draw) -> Vec<Case> {
    let flat = parallelogram([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    let models = vec![
        net(3, 3, |_, _| [0.25, 0.5, 0.75]),
        net(3, 3, |i, j| [0.1 * (i + j) as f64, 0.25, 0.5]),
        net(2, 1, |i, _| [i as f64 - 1.0, 0.5 - 0.3 * i as f64, 0.5]),
        net(1, 1, |i, j| if i == 0 { [0.0, 0.0, 0.5] } else { [0.5, j as f64, 0.5] }),
    ];
    let model = Model::numbered([models, vec![flat]].concat());
    let rays = draw.rays_at(&model, draw.rays);
    vec![Case::of_rays(model, rays)]
}
