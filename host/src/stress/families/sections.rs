//! Rays in planes that cut a surface along its parameter lines, where all of it but one curve falls together.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};

use crate::scene::model::{Model, ModelSurface};
use crate::scene::rays::RayLine;
use crate::scene::revolution::{Arcs, Curve, revolve};
use crate::scene::shapes::{net, single};
use crate::stress::case::{Case, Draw, FEW, Family, away, mapped, point, ray};

pub(super) const FAMILIES: [Family; 1] = [Family {
    name: "sections",
    what: "lofts, slanted extrusions and surfaces of revolution, met in planes of constant u or v, 1e-1 to 1e-14 (f32: 1e-5) off or tilted",
    unjudged: FEW,
    cases: sections,
}];

/// How many models there are of each kind.
const EACH: usize = 24;

fn sections(draw: &mut Draw) -> Vec<Case> {
    let rays = draw.rays.div_ceil(EACH);
    let mut cases = Vec::new();
    for number in 0..EACH {
        // Half of them with axes along which coordinates are exact.
        let turn = match number % 2 {
            0 => DMat3::IDENTITY,
            _ => DMat3::from_quat(DQuat::from_axis_angle(draw.direction(), draw.random.within(0.0, TAU))),
        };
        for kind in [Kind::Extrusion, Kind::Loft, Kind::Revolution] {
            let model = match kind {
                Kind::Extrusion => single(loft(draw, 1, true)),
                Kind::Loft => single(loft(draw, 1 + number % 4 / 2, false)),
                Kind::Revolution => revolution(draw),
            };
            let rays = (0..rays).map(|_| {
                let surface = draw.pick(&model.surfaces).clone();
                let across = kind != Kind::Revolution || draw.random.within(0.0, 1.0) < 0.5;
                let chord = chord(draw, &surface, across);
                let normal = match kind {
                    Kind::Extrusion | Kind::Loft => DVec3::X,
                    Kind::Revolution if across => DVec3::Z,
                    // The plane holds the axis.
                    Kind::Revolution => DVec3::Z.cross(chord[0]).normalize_or(DVec3::X),
                };
                in_plane(draw, chord, normal, away(&model))
            });
            let rays = rays.collect();
            let model = if draw.random.within(0.0, 1.0) < 0.5 { exchanged(model) } else { model };
            cases.push(turned(turn, &model, rays));
        }
    }
    cases
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Extrusion,
    Loft,
    Revolution,
}

/// A surface through `degree` + 1 curves in parallel planes x = 0 to 1: `one` that is moved, or each its own. A few have weights
/// by row and by column, which leave the planes where they are.
///
/// A curve is a graph that a line along it meets about as often as its degree: a Legendre polynomial, whose control points are
/// binomial coefficients of alternating sign (R. T. Farouki, "Legendre-Bernstein basis transformations", 2000), each made larger
/// or smaller by up to a half.
fn loft(draw: &mut Draw, degree: usize, one: bool) -> ModelSurface {
    let along = *draw.pick(&[2, 3, 3, 4, 5, 9]);
    let high = 10.0_f64.powf(-draw.random.within(0.0, 2.0));
    let curve = |draw: &mut Draw| -> Vec<[f64; 2]> {
        let mut next = high;
        let heights = (0..=along).map(|j| {
            let height = next * draw.random.within(0.5, 1.5);
            next *= -((along - j) as f64) / (j + 1) as f64;
            [j as f64 / along as f64, height]
        });
        heights.collect()
    };
    let first = curve(draw);
    let curves: Vec<_> = (0..=degree).map(|_| if one { first.clone() } else { curve(draw) }).collect();
    let shift = draw.random.point(1.0);
    let mut surface = net(degree, along, |i, j| {
        let (x, [y, z]) = (i as f64 / degree as f64, curves[i][j]);
        [x, y + shift[1] * x, z + shift[2] * x]
    });
    if draw.random.within(0.0, 3.0) < 1.0 {
        let [rows, columns] =
            [degree, along].map(|last| (0..=last).map(|_| draw.random.within(-2.0, 2.0).exp2()).collect::<Vec<_>>());
        for (k, point) in surface.points.iter_mut().enumerate() {
            point[3] = rows[k / (along + 1)] * columns[k % (along + 1)];
        }
        surface.rational = true;
    }
    surface
}

/// A wavy vase: a cubic profile about z.
fn revolution(draw: &mut Draw) -> Model {
    let waves: Vec<f64> = (0..4).map(|_| draw.random.within(0.2, 1.0)).collect();
    let profile = Curve::segment(3, [0.0, -1.0], [0.0, 1.0]).map(|[_, z]| {
        let k = (1.5 * (z + 1.0)).round() as usize;
        [waves[k], z]
    });
    let kind = *draw.pick(&[Arcs::Rational, Arcs::Polynomial]);
    Model::numbered(revolve(&profile, &Curve::circle(kind, 0.0, 360.0, 4)))
}

/// Two points of a curve of constant u, or else of constant v: a ray through both meets the surface at least twice.
fn chord(draw: &mut Draw, surface: &ModelSurface, of_u: bool) -> [DVec3; 2] {
    let [fixed, from, to] = [0; 3].map(|_| draw.random.within(0.02, 0.98));
    [from, to].map(|running| if of_u { point(surface, fixed, running) } else { point(surface, running, fixed) })
}

/// A ray in a plane of this normal, through both points or through one, or a little off the plane, or tilted.
fn in_plane(draw: &mut Draw, [on, other]: [DVec3; 2], normal: DVec3, distance: f64) -> RayLine {
    let (first, second) = normal.any_orthonormal_pair();
    let (sin, cos) = draw.random.within(0.0, TAU).sin_cos();
    let any = first * cos + second * sin;
    let chord = (other - on).normalize_or(any);
    let (off, tilt) = (draw.ladder(), draw.ladder());
    let [off, tilt] = *draw.pick(&[[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [off, 0.0], [0.0, tilt]]);
    let along = *draw.pick(&[chord, chord, any]) + normal * tilt;
    ray(on + normal * off - along * distance, along)
}

/// A model and its rays, turned about the origin.
fn turned(turn: DMat3, model: &Model, rays: Vec<RayLine>) -> Case {
    let rays = rays.into_iter().map(|ray| {
        let [origin, direction] = [ray.origin, ray.direction].map(|v| (turn * DVec3::from_array(v)).to_array());
        RayLine { origin, direction, ..ray }
    });
    Case::of_rays(mapped(model, |point| turn * point), rays.collect())
}

/// Each surface with its parameters exchanged.
fn exchanged(model: Model) -> Model {
    let surfaces = model.surfaces.into_iter().map(|surface| {
        let (n, m) = (surface.degree_u, surface.degree_v);
        let points: Vec<_> =
            (0..=m).flat_map(|j| (0..=n).map(move |i| i * (m + 1) + j)).map(|k| surface.points[k]).collect();
        ModelSurface { degree_u: m, degree_v: n, points, ..surface }
    });
    Model { surfaces: surfaces.collect() }
}
