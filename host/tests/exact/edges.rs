//! Rays aimed exactly at edges and corners that surfaces share to the bit: between neighbours there is no way through.

use patchray::ray::Incidence;
use patchray_host::lower::Stages;
use patchray_host::prepared::Prepared;
use patchray_host::scanline::{Found, Outcome, Tally};
use patchray_host::scene::camera::View;
use patchray_host::scene::model::Model;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::sampling::Sampling;
use patchray_host::scene::shapes::{Random, bilinear, sphere, torus};
use patchray_host::scene::teapot;
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::stress::case::{Case, Draw, Shot};
use patchray_host::stress::truth::{in_precision, rays_of, size};
use rayon::prelude::*;

use crate::aim::{Aimed, Targets, aim, targets};
use crate::residual::{distance, most};
use crate::tools::{METHODS, OF_PICTURES, PRECISIONS, rays, settings, trace_view};

/// The sides of a plate's rows and columns, smallest in the middle.
const SIDES: [f64; 13] = [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0];

/// What the corners of a plate are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Plate {
    Flat,
    Bent,
    Weighted,
    Steep,
}

impl Plate {
    /// That of the weights.
    fn ratio(self) -> f64 {
        match self {
            Plate::Flat | Plate::Bent => 1.0,
            Plate::Weighted => 1e6,
            Plate::Steep => 1e9,
        }
    }
}

/// Rectangles side by side, those along its diagonal squares, about 0 or away from it.
fn plate(kind: Plate, middle: f64) -> Model {
    let mut random = Random(51);
    let half = SIDES.iter().sum::<f64>() / 2.0;
    let mut lines = vec![middle - half];
    for side in SIDES {
        lines.push(lines[lines.len() - 1] + side);
    }
    let corner = |x: f64, y: f64, random: &mut Random| {
        let z = if kind == Plate::Flat { 0.25 } else { 0.25 + 0.1 * (x - middle) * (y - middle) };
        let w = kind.ratio().powf(random.within(-0.5, 0.5));
        [x, y, z, w]
    };
    let corners: Vec<Vec<[f64; 4]>> =
        lines.iter().map(|&x| lines.iter().map(|&y| corner(x, y, &mut random)).collect()).collect();
    let mut surfaces = Vec::new();
    for i in 0..SIDES.len() {
        for j in 0..SIDES.len() {
            let mut surface = bilinear([[0.0; 3]; 4]);
            surface.rational = kind.ratio() > 1.0;
            surface.points = [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[a, b]| corners[i + a][j + b]).to_vec();
            surfaces.push(surface);
        }
    }
    Model::numbered(surfaces)
}

fn models() -> Vec<(&'static str, Model)> {
    vec![
        ("teapot", teapot::model().expect("the fixture is valid")),
        ("sphere", sphere([0.5, -0.25, 1.0], 1.5)),
        ("torus", torus([0.1, 0.2, 0.3], 1.0, 0.25, 4, 4)),
        ("plate", plate(Plate::Flat, 0.0)),
        ("plate away from 0", plate(Plate::Flat, 3.0)),
        ("plate, bent", plate(Plate::Bent, 0.0)),
        ("plate with weights", plate(Plate::Weighted, 0.0)),
    ]
}

/// What is wrong with an answer, if anything is; `slack` is how much more it may be off than where weights are even.
fn wrong(model: &Model, precision: Precision, aimed: &Aimed, outcome: &Outcome, slack: f64) -> Option<&'static str> {
    match outcome {
        Outcome::Hit(found) if found.t > aimed.t + aimed.off => Some("passed through"),
        // What is hit before is another surface, or another part of it, and no place where there is none.
        Outcome::Hit(found) if found.t < aimed.t - aimed.off => {
            let surface = &model.surfaces[found.surface];
            // A graze may be one of the net as its rounding leaves it, in a frame up to twice as large.
            let slack = slack * if found.incidence == Incidence::Crossing { 1.0 } else { 4.0 };
            // Of the ray's coordinates those that it comes from take part, too.
            let [here, there] = [0.0, found.t].map(|t| most(precision, surface, size(surface, model), &aimed.ray, t));
            let most = slack * f64::max(here, there);
            (distance(surface, &aimed.ray, found, most) > most).then_some("nothing there")
        }
        Outcome::Hit(_) => None,
        Outcome::Miss => Some("lost"),
        Outcome::GaveUp { .. } => Some("given up"),
        Outcome::Refused(_) | Outcome::Invalid => Some("refused"),
    }
}

/// Rays that are traced at a time.
const BLOCK: usize = 500;

/// What a method answers wrongly to so many blocks of rays; see [`wrong`] for `slack`.
fn failures(
    model: &Model,
    targets: &Targets,
    (method, precision): (Method, Precision),
    blocks: usize,
    slack: f64,
) -> Vec<String> {
    let settings = settings(method, precision);
    let prepared = Prepared::build(model, Stages::of(method), &settings).expect("there is memory");
    let tracer = prepared.tracer(&settings);
    let parts: Vec<Vec<String>> = (0..blocks)
        .into_par_iter()
        .map(|block| {
            let mut draw = Draw { random: Random(Random(block as u64).bits()), rays: 0, precision };
            let aimed = aim(&mut draw, model, targets, BLOCK);
            let lines: Vec<RayLine> = aimed.iter().map(|aimed| aimed.ray).collect();
            let mut outcomes = Vec::new();
            tracer.lane().trace(&lines, false, &mut outcomes, &mut Tally::default());
            let told = |(aimed, outcome): (&Aimed, &Outcome)| {
                let what = wrong(model, precision, aimed, outcome, slack)?;
                Some(format!("{} {}: {what}: {aimed:?} {outcome:?}", method.name(), precision.name()))
            };
            aimed.iter().zip(&outcomes).filter_map(told).collect()
        })
        .collect();
    parts.concat()
}

#[test]
fn no_ray_is_lost_between_two_neighbours() {
    let models = models();
    let blocks = rays(7000).div_ceil(BLOCK * models.len());
    let kinds: Vec<_> = models.iter().flat_map(|model| PRECISIONS.map(|precision| (model, precision))).collect();
    let failures: Vec<String> = kinds
        .par_iter()
        .flat_map(|((name, model), precision)| {
            let model = in_precision(&Case::of_rays(model.clone(), Vec::new()), *precision).model;
            let targets = targets(&model);
            println!("{name} {}: {} edges, {} corners", precision.name(), targets.shared.len(), targets.corners.len());
            assert!(targets.shared.len() >= 12 && !targets.corners.is_empty(), "{name}");
            let of = |method| failures(&model, &targets, (method, *precision), blocks, 1.0);
            METHODS.into_iter().flat_map(of).map(|line| format!("{name} {line}")).collect::<Vec<_>>()
        })
        .collect();
    let all = 8 * blocks * BLOCK * models.len();
    for failure in &failures {
        println!("{failure}");
    }
    println!("{all} rays, {} wrong", failures.len());
    assert!(failures.is_empty(), "{} of {all}:\n{}", failures.len(), failures[..failures.len().min(20)].join("\n"));
}

/// Beside an edge along which weights fall by 1e9 a step beyond it, or beyond a region, leads far.
#[test]
fn no_ray_is_lost_between_neighbours_of_steep_weights() {
    let blocks = rays(90_000).div_ceil(BLOCK);
    for precision in PRECISIONS {
        let model = in_precision(&Case::of_rays(plate(Plate::Steep, 0.0), Vec::new()), precision).model;
        // The surfaces are solved in the scene's frame, where their coordinates are down to an eighth of the largest.
        let failures = failures(&model, &targets(&model), (Method::Clipping, precision), blocks, 8.0);
        assert!(failures.is_empty(), "{}:\n{}", failures.len(), failures[..failures.len().min(10)].join("\n"));
    }
}

/// As pictures, for the methods that trace no other rays: each pixel's ray is at a corner of four squares, or at an edge.
#[test]
fn no_pixel_is_lost_between_two_neighbours() {
    for precision in PRECISIONS {
        for (seed, bend) in [(1, 0.0), (2, 0.25)] {
            let mut random = Random(seed);
            let mut squares = Vec::new();
            let heights: Vec<f64> = (0..13 * 13).map(|_| random.within(-bend, bend)).collect();
            for i in 0..12 {
                for j in 0..12 {
                    let corner = |a: usize, b: usize| [a as f64 - 6.0, b as f64 - 6.0, heights[a * 13 + b]];
                    squares.push(bilinear([corner(i, j), corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1)]));
                }
            }
            let model = Model::numbered(squares);
            // The rays of 20 x 20 pixels are apart by 1, or a half, at the plate, whose heights move a crossing aside by less.
            for (side, eye, right, up) in [
                (10, [0.5, 0.5, 64.0], [5.0, 0.0, 0.0], [0.0, 5.0, 0.0]),
                (21, [0.0, 0.0, 64.0], [5.25, 0.0, 0.0], [0.0, 5.25, 0.0]),
                (21, [-0.25, 0.25, 64.0], [5.25, 5.25, 0.0], [-5.25, 5.25, 0.0]),
            ] {
                let forward = [-eye[0], -eye[1], -64.0];
                let view = View { eye, forward, right, up, size: [side, side], sampling: Sampling::One };
                let case = Case { model: model.clone(), shot: Shot::Picture(view), exact: None };
                let lines = rays_of(&in_precision(&case, precision));
                let within = |ray: &RayLine| {
                    [0, 1].iter().all(|&k| {
                        let at = ray.origin[k] - ray.direction[k] / ray.direction[2] * ray.origin[2];
                        at.abs() < 5.9
                    })
                };
                for method in OF_PICTURES {
                    let outcomes = trace_view(&model, &view, method, precision);
                    for (outcome, ray) in outcomes.iter().zip(&lines).filter(|(_, ray)| within(ray)) {
                        let hit = matches!(outcome, Outcome::Hit(Found { t, .. }) if (t - 1.0).abs() < 0.01);
                        assert!(hit, "{} {} {ray:?}: {outcome:?}", method.name(), precision.name());
                    }
                }
            }
        }
    }
}
