//! Rays aimed exactly at edges and corners that surfaces share to the bit: between neighbours there is no way through.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use glam::DVec3;
use patchray::ray::Incidence;
use patchray_host::lower::Stages;
use patchray_host::prepared::Prepared;
use patchray_host::scanline::{Found, Outcome, Tally};
use patchray_host::scene::camera::View;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::sampling::Sampling;
use patchray_host::scene::shapes::{Random, bilinear, sphere, torus};
use patchray_host::scene::teapot;
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::stress::case::{Case, Draw, Shot, away, point, ray};
use patchray_host::stress::truth::{in_precision, rays_of, size};
use rayon::prelude::*;

use crate::residual::{distance, most};
use crate::tools::{IN_VIEW, METHODS, PRECISIONS, index, rays, settings, trace_view};

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

/// A place at a border of a surface: its edges are u = 0, u = 1, v = 0, v = 1.
#[derive(Clone, Copy, Debug)]
struct Side {
    surface: usize,
    edge: usize,
}

impl Side {
    fn parameters(self, along: f64) -> [f64; 2] {
        let across = (self.edge % 2) as f64;
        if self.edge < 2 { [across, along] } else { [along, across] }
    }

    /// The control points, and those of the next row.
    fn rows(self, surface: &ModelSurface) -> [Vec<[f64; 4]>; 2] {
        let (m, n) = (surface.degree_u, surface.degree_v);
        let of = |inward: usize| match self.edge {
            0 => (0..=n).map(|j| surface.points[inward * (n + 1) + j]).collect(),
            1 => (0..=n).map(|j| surface.points[(m - inward) * (n + 1) + j]).collect(),
            2 => (0..=m).map(|i| surface.points[i * (n + 1) + inward]).collect(),
            _ => (0..=m).map(|i| surface.points[i * (n + 1) + n - inward]).collect(),
        };
        [of(0), of(1)]
    }
}

/// An edge that two surfaces share, the second of them perhaps in the other order.
#[derive(Clone, Debug)]
struct Shared {
    sides: [Side; 2],
    reversed: bool,
}

/// A corner that surfaces share, with the two directions in which each of them leaves it.
#[derive(Clone, Debug)]
struct Corner {
    place: DVec3,
    wedges: Vec<[DVec3; 2]>,
}

fn position(point: &[f64; 4]) -> DVec3 {
    DVec3::new(point[0], point[1], point[2])
}

/// What there is to aim at.
#[derive(Clone, Debug)]
struct Targets {
    shared: Vec<Shared>,
    corners: Vec<Corner>,
}

fn targets(model: &Model) -> Targets {
    let bits = |row: &[[f64; 4]]| row.iter().map(|p| p.map(|c| (c + 0.0).to_bits())).collect::<Vec<_>>();
    let mut edges: BTreeMap<Vec<[u64; 4]>, Vec<(Side, bool)>> = BTreeMap::new();
    // By its end, the ways in which a surface leaves a corner.
    let mut ends: BTreeMap<[u64; 3], BTreeMap<usize, Vec<DVec3>>> = BTreeMap::new();
    for (number, surface) in model.surfaces.iter().enumerate() {
        for edge in 0..4 {
            let side = Side { surface: number, edge };
            let [row, _] = side.rows(surface);
            if row.iter().all(|point| position(point) == position(&row[0])) {
                continue;
            }
            let (forth, mut back) = (bits(&row), bits(&row));
            back.reverse();
            let reversed = back < forth;
            edges.entry(if reversed { back } else { forth }).or_default().push((side, reversed));
            let mut other = row.clone();
            other.reverse();
            for row in [row, other] {
                let from = position(&row[0]);
                let to = row.iter().map(position).find(|&to| to != from).unwrap_or(from);
                let key = from.to_array().map(|c| (c + 0.0).to_bits());
                ends.entry(key).or_default().entry(number).or_default().push((to - from).normalize_or_zero());
            }
        }
    }
    let pairs = edges.into_values().filter_map(|sides| match sides[..] {
        [(a, forth), (b, back)] => Some(Shared { sides: [a, b], reversed: forth != back }),
        _ => None,
    });
    let corners = ends.into_iter().filter_map(|(key, ways)| {
        let wedges = ways.into_values().map(|ways| <[DVec3; 2]>::try_from(ways).ok()).collect::<Option<Vec<_>>>()?;
        (wedges.len() > 2).then_some(Corner { place: DVec3::from_array(key.map(f64::from_bits)), wedges })
    });
    Targets { shared: pairs.collect(), corners: corners.collect() }
}

/// The sine between the ray and a neighbour below which nothing is asked.
const STEEP: f64 = 0.05;

impl Shared {
    /// The place at `along`, and the least sine by which the ray passes between both surfaces, which then lie on either side of
    /// the edge as the ray sees them; `None` where it might slip by.
    fn at(&self, model: &Model, along: f64, d: DVec3) -> Option<(DVec3, f64)> {
        let [a, b] = self.sides;
        let other = if self.reversed { 1.0 - along } else { along };
        let place = |side: Side, along: f64| {
            let surface = &model.surfaces[side.surface];
            let [u, v] = side.parameters(along);
            point(surface, u, v)
        };
        let on = place(a, along);
        let step = 1e-4;
        let (low, high) = ((along - step).max(0.0), (along + step).min(1.0));
        let edge = (place(a, high) - place(a, low)).normalize_or_zero();
        // Inward, of either surface, as the ray sees it.
        let into = |side: Side, along: f64| {
            let surface = &model.surfaces[side.surface];
            let [u, v] = side.parameters(along);
            let inward = |c: f64| if c == 0.0 { step } else { 1.0 - step };
            let [u, v] = if side.edge < 2 { [inward(u), v] } else { [u, inward(v)] };
            let way = point(surface, u, v) - on;
            (way - edge * way.dot(edge)).normalize_or_zero()
        };
        let sine = |way: DVec3| edge.cross(way).dot(d);
        let [one, two] = [sine(into(a, along)), sine(into(b, other))];
        let least = one.abs().min(two.abs());
        (one * two < 0.0 && least > STEEP).then_some((on, least))
    }
}

impl Corner {
    /// The same of a corner: as the ray sees them, its surfaces surround it once.
    fn at(&self, d: DVec3) -> Option<(DVec3, f64)> {
        let right = d.any_orthonormal_vector();
        let up = d.cross(right);
        let (mut sum, mut least) = (0.0, 1.0);
        for wedge in &self.wedges {
            let [a, b] = wedge.map(|way| [way.dot(right), way.dot(up)]);
            let (sine, cosine) = (a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
            sum += sine.atan2(cosine).abs();
            least = f64::min(least, wedge[0].cross(wedge[1]).normalize_or_zero().dot(d).abs());
        }
        ((sum - TAU).abs() < 1e-6 && sum > PI && least > STEEP).then_some((self.place, least))
    }
}

/// A ray at an edge or a corner, where it has to be met, and by how much t may be off.
#[derive(Clone, Copy, Debug)]
struct Aimed {
    ray: RayLine,
    t: f64,
    off: f64,
}

/// Rays from outside of the model, or from near by, in numbers of the precision.
fn aim(draw: &mut Draw, model: &Model, targets: &Targets, count: usize) -> Vec<Aimed> {
    let size = away(model) / 1.5;
    let (unit, share) = match draw.precision {
        Precision::F64 => (f64::EPSILON, 1e-14),
        Precision::F32 => (f64::from(f32::EPSILON), 2e-6),
    };
    let precision = draw.precision;
    let round = |v: DVec3| match precision {
        Precision::F64 => v,
        Precision::F32 => v.as_vec3().as_dvec3(),
    };
    let mut aimed = Vec::new();
    // Ends: of directions drawn at random most pass between neighbours.
    while aimed.len() < count {
        let d = draw.direction();
        let at = if targets.shared.is_empty() || index(&mut draw.random, 5) == 0 {
            draw.pick(&targets.corners).at(d)
        } else {
            let along = if index(&mut draw.random, 4) == 0 { 0.5 } else { draw.random.within(0.01, 0.99) };
            draw.pick(&targets.shared).at(model, along, d)
        };
        let Some((on, sine)) = at else { continue };
        let distance = size * *draw.pick(&[1.5, 0.5, 0.01]);
        let (origin, direction) = (round(on - d * distance), round(d));
        let t = (on - origin).dot(direction) / direction.length_squared();
        let mut ray = ray(origin, direction);
        let largest = [on, origin].iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let off = (share * size + 16.0 * unit * largest) / sine;
        // Half of them alone with the edge, half with all else that the ray meets.
        if index(&mut draw.random, 2) == 0 {
            let [low, high] = [t - 4.0 * off, t + 4.0 * off];
            ray.t_min = round(DVec3::splat(low)).x.max(0.0);
            ray.t_max = round(DVec3::splat(high)).x;
        }
        aimed.push(Aimed { ray, t, off });
    }
    aimed
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
            let mut failures = Vec::new();
            for method in METHODS {
                let settings = settings(method, *precision);
                let prepared = Prepared::build(&model, Stages::of(method), &settings).expect("there is memory");
                let tracer = prepared.tracer(&settings);
                let parts: Vec<Vec<String>> = (0..blocks)
                    .into_par_iter()
                    .map(|block| {
                        let seed = Random(block as u64).bits();
                        let mut draw = Draw { random: Random(seed), rays: 0, precision: *precision };
                        let aimed = aim(&mut draw, &model, &targets, BLOCK);
                        let lines: Vec<RayLine> = aimed.iter().map(|aimed| aimed.ray).collect();
                        let mut outcomes = Vec::new();
                        tracer.lane().trace(&lines, false, &mut outcomes, &mut Tally::default());
                        let told = |(aimed, outcome): (&Aimed, &Outcome)| {
                            let what = wrong(&model, *precision, aimed, outcome, 1.0)?;
                            let (method, precision) = (method.name(), precision.name());
                            Some(format!("{name} {method} {precision}: {what}: {aimed:?} {outcome:?}"))
                        };
                        aimed.iter().zip(&outcomes).filter_map(told).collect()
                    })
                    .collect();
                failures.extend(parts.into_iter().flatten());
            }
            failures
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
    let count = rays(90_000).div_ceil(BLOCK);
    for precision in PRECISIONS {
        let model = in_precision(&Case::of_rays(plate(Plate::Steep, 0.0), Vec::new()), precision).model;
        let targets = targets(&model);
        let settings = settings(Method::Clipping, precision);
        let prepared = Prepared::build(&model, Stages::of(Method::Clipping), &settings).expect("there is memory");
        let tracer = prepared.tracer(&settings);
        let parts: Vec<Vec<String>> = (0..count)
            .into_par_iter()
            .map(|block| {
                let mut draw = Draw { random: Random(Random(block as u64).bits()), rays: 0, precision };
                let aimed = aim(&mut draw, &model, &targets, BLOCK);
                let lines: Vec<RayLine> = aimed.iter().map(|aimed| aimed.ray).collect();
                let mut outcomes = Vec::new();
                tracer.lane().trace(&lines, false, &mut outcomes, &mut Tally::default());
                let told = |(aimed, outcome): (&Aimed, &Outcome)| {
                    // The surfaces are solved in the scene's frame, where their coordinates are down to an eighth of the largest.
                    let what = wrong(&model, precision, aimed, outcome, 8.0)?;
                    Some(format!("{}: {what}: {aimed:?} {outcome:?}", precision.name()))
                };
                aimed.iter().zip(&outcomes).filter_map(told).collect()
            })
            .collect();
        let failures = parts.concat();
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
                for method in IN_VIEW {
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
