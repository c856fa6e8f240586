//! Rational surfaces with weights of any arrangement up to a ratio of 1e9, and rays at places that are chosen in space, where
//! parameters of such weights would name next to none.

use std::collections::BTreeMap;

use glam::DVec3;
use patchray::ray::Incidence;
use patchray_host::judge::Truth;
use patchray_host::oracle::{DoubleDouble, Real};
use patchray_host::scanline::{Found, Outcome};
use patchray_host::scene::camera::View;
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::sampling::Sampling;
use patchray_host::scene::shapes::weights::{Sheet, Weights, point_anywhere, point_from_both_ends};
use patchray_host::scene::shapes::{Random, net, single};
use patchray_host::scene::trace::Precision;
use patchray_host::stress::case::{Case, Draw, Shot, away, ray};
use patchray_host::stress::forms::meet_bilinear;
use patchray_host::stress::judge::Judge;
use patchray_host::stress::truth::{self, in_precision, rays_of, size};
use rayon::prelude::*;

use crate::tools::{METHODS, OF_PICTURES, PRECISIONS, index, rays, told, trace, trace_view};

/// Rays of a surface.
const RAYS: usize = 40;

/// The sides of a picture, which is traced in place of rays of any kind for one surface in eight.
const SIDES: [u32; 2] = [8, 5];

/// The least sine of the angle between a ray and a plane for which the number type holds more than that it is a tangent.
fn steep(precision: Precision) -> f64 {
    match precision {
        Precision::F64 => 1e-5,
        Precision::F32 => 4e-3,
    }
}

/// What rounding a net's sums leaves of a point in `f32`, as a length: of a degree of 15 it is more than judges elsewhere allow
/// for.
fn blur(surface: &ModelSurface, precision: Precision) -> f64 {
    let sums = 16 + surface.degree_u + surface.degree_v;
    let rounding = if precision == Precision::F32 { 2.0 * f64::from(f32::EPSILON) } else { 0.0 };
    rounding * sums as f64 * size(surface, &single(surface.clone()))
}

/// A surface in a plane across an axis, which its control points, being a rectangle's lattice, fill whatever their weights.
fn flat(draw: &mut Draw) -> ModelSurface {
    let [m, n] = *draw.pick(&[[1, 1], [1, 1], [3, 3], [15, 1], [1, 15], [2, 5]]);
    let [x, y, height] = draw.random.point(1.0);
    let [wide, high] = [0; 2].map(|_| draw.random.within(0.5, 2.0));
    let turn = index(&mut draw.random, 3);
    let of = |low: f64, side: f64, k: usize, degree: usize| {
        if k == degree { low + side } else { low + side * (k as f64 / degree as f64) }
    };
    net(m, n, |i, j| {
        let p = [of(x, wide, i, m), of(y, high, j, n), height];
        [0, 1, 2].map(|k| p[(k + turn) % 3])
    })
}

/// The axis across the plane of the surface, if it has one.
fn across(surface: &ModelSurface) -> Option<usize> {
    (0..3).find(|&k| surface.points.iter().all(|point| point[k] == surface.points[0][k]))
}

/// Where a ray meets a surface that fills a rectangle across an axis.
fn meet_rectangle(surface: &ModelSurface, axis: usize, ray: &RayLine, precision: Precision) -> Truth {
    let number = DoubleDouble::new;
    let speed = DVec3::from_array(ray.direction).length();
    let sine = (ray.direction[axis] / speed).abs();
    if sine < steep(precision) {
        return Truth { open: true, ..Truth::default() };
    }
    let t = (number(surface.points[0][axis]) - number(ray.origin[axis])) / number(ray.direction[axis]);
    let mut inside = f64::INFINITY;
    for k in (0..3).filter(|&k| k != axis) {
        let (low, high) = surface
            .points
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (f64::min(low, p[k]), f64::max(high, p[k])));
        let at = t.on_ray(ray.origin[k], ray.direction[k]);
        inside = inside.min((at - number(low)).to_f64()).min((number(high) - at).to_f64());
    }
    let size = size(surface, &single(surface.clone()));
    let hit = (inside >= 0.0).then(|| t.to_f64());
    Truth {
        closest: hit,
        roots: usize::from(hit.is_some()),
        margin: inside.abs() * sine / size,
        size,
        cosine: Some(sine),
        ..Truth::default()
    }
}

/// What is true of the rays: by a closed form of what is flat or bilinear; how sure it is of the latter, and all of others, by
/// the oracle.
fn truths(case: &Case, rays: &[RayLine], precision: Precision) -> Vec<Truth> {
    let surface = &case.model.surfaces[0];
    if let Some(axis) = across(surface) {
        return rays.iter().map(|ray| meet_rectangle(surface, axis, ray, precision)).collect();
    }
    let mut truths = truth::of_case(case, rays);
    if [surface.degree_u, surface.degree_v] == [1, 1] {
        for (truth, ray) in truths.iter_mut().zip(rays) {
            truth.closest = meet_bilinear(surface, ray).iter().map(|root| root.t).find(|&t| t >= 0.0);
        }
    }
    truths
}

/// Weights of an arrangement that is drawn; of a ratio up to 1e9, and that in one of four.
fn weighted(draw: &mut Draw, mut surface: ModelSurface) -> (ModelSurface, f64) {
    let ratio = 10_f64.powf(draw.random.within(0.0, 12.0).min(9.0));
    let arrangement = match index(&mut draw.random, 5) {
        0 => *draw.pick(&Weights::FALLING),
        1 => *draw.pick(&Weights::GRADED),
        2 => {
            // One point alone is heavy, or light.
            let place = index(&mut draw.random, surface.points.len());
            let [one, others] = *draw.pick(&[[1.0, 1.0 / ratio], [1.0 / ratio, 1.0]]);
            surface.rational = true;
            for (k, point) in surface.points.iter_mut().enumerate() {
                point[3] = if k == place { one } else { others };
            }
            return (surface, ratio);
        }
        _ => Weights::Any,
    };
    (arrangement.of(surface, ratio, &mut draw.random), ratio)
}

/// A place of the surface, and one beside it for a third of them.
fn target(draw: &mut Draw, surface: &ModelSurface, ratio: f64) -> DVec3 {
    let on: DVec3 = point_anywhere(surface, ratio, &mut draw.random).into();
    if index(&mut draw.random, 3) > 0 {
        return on;
    }
    // Beyond or within a border or a corner of a border, by any of the steps that can be judged.
    let [s, corner] = [0; 2].map(|_| draw.random.within(0.0, 1.0));
    let along = if corner < 0.2 { [0.0, 1.0] } else { [s, 1.0 - s] };
    let end = *draw.pick(&[[0.0, 1.0], [1.0, 0.0]]);
    let [u, v] = *draw.pick(&[[along, end], [end, along]]);
    let border = DVec3::from_array(point_from_both_ends(surface, u, v));
    border + (border - on).normalize_or_zero() * draw.ladder()
}

/// A surface with its rays.
fn case(draw: &mut Draw, number: usize) -> Case {
    let surface = match number % 6 {
        0 | 1 => flat(draw),
        2 => Sheet::Twisted.surface(&mut draw.random),
        3 => Sheet::Bicubic.surface(&mut draw.random),
        4 => Sheet::Long.surface(&mut draw.random),
        _ => Sheet::Wide.surface(&mut draw.random),
    };
    let (surface, ratio) = weighted(draw, surface);
    let model = single(surface);
    let surface = &model.surfaces[0];
    let distance = away(&model);
    if number / 6 % 8 == 7 {
        let toward = draw.direction();
        let aim = target(draw, surface, ratio);
        let right = toward.any_orthonormal_vector();
        let view = View {
            eye: (aim - toward * distance).to_array(),
            forward: (toward * distance).to_array(),
            right: (right * 0.5).to_array(),
            up: (right.cross(toward) * 0.5).to_array(),
            size: SIDES,
            sampling: Sampling::One,
        };
        let round = |v: [f64; 3]| v.map(|c| if draw.precision == Precision::F32 { f64::from(c as f32) } else { c });
        let View { eye, forward, right, up, .. } = view;
        let [eye, forward, right, up] = [eye, forward, right, up].map(round);
        return Case { model, shot: Shot::Picture(View { eye, forward, right, up, ..view }), exact: None };
    }
    let lines = (0..RAYS).map(|_| {
        let target = target(draw, surface, ratio);
        let mut direction = draw.direction();
        // Some all but along a plane, down to where it cannot be told from a tangent.
        if let Some(axis) = across(surface)
            && index(&mut draw.random, 3) == 0
        {
            direction[axis] *= steep(draw.precision).powf(draw.random.within(0.0, 1.0));
        }
        ray(target - direction * distance, direction * 2_f64.powf(draw.random.within(-2.0, 2.0)))
    });
    let lines = lines.collect();
    Case::of_rays(model, lines)
}

/// What became of rays.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    rays: usize,
    judged: usize,
    hits: usize,
    lost: usize,
    given_up: usize,
    /// Of those lost or given up, by what does not hold yet.
    short: usize,
}

/// What does not hold yet. In `f32` weights may make a curve of much of a surface, to rounding, and which of its points the ray
/// meets is not told: then t is less exact than of even weights, but never without being called a graze. And of steep weights
/// so many patches are made that the spans of a view's scan line run out.
fn is_short(precision: Precision, outcome: &Outcome) -> bool {
    match outcome {
        Outcome::Hit(found) => precision == Precision::F32 && found.incidence != Incidence::Crossing,
        Outcome::GaveUp { limit, .. } => *limit == "spans",
        _ => false,
    }
}

#[test]
fn no_ray_is_lost_on_a_rational_surface() {
    let count = rays(600).div_ceil(RAYS);
    let kinds: Vec<_> = PRECISIONS.iter().flat_map(|&precision| (0..count).map(move |n| (precision, n))).collect();
    let parts: Vec<_> = kinds
        .par_iter()
        .map(|&(precision, number)| {
            let mut draw = Draw { random: Random(Random(number as u64).bits()), rays: RAYS, precision };
            let case = in_precision(&case(&mut draw, number), precision);
            let lines = rays_of(&case);
            let judge = Judge::by(&case, &lines, truths(&case, &lines, precision), precision);
            let blur = blur(&case.model.surfaces[0], precision);
            let methods: &[_] = if let Shot::Picture(_) = case.shot { &OF_PICTURES } else { &METHODS };
            let (mut counts, mut wrong) = (BTreeMap::new(), Vec::new());
            for &method in methods {
                let outcomes = match &case.shot {
                    Shot::Rays(_) => trace(&case.model, &lines, method, precision),
                    Shot::Picture(view) => trace_view(&case.model, view, method, precision),
                };
                let count: &mut Count = counts.entry((precision.name(), method.name())).or_default();
                for (place, (outcome, ray)) in outcomes.iter().zip(&lines).enumerate() {
                    let truth = judge.truth(place).expect("one for each ray");
                    let judged = !truth.open && truth.margin >= truth::least_margin(precision);
                    let clear = !truth.open && truth.margin >= truth::clear_margin(precision);
                    let lost = judge.is_lost(place, outcome, blur);
                    let given_up = clear && matches!(outcome, Outcome::GaveUp { .. } | Outcome::Refused(_));
                    count.rays += 1;
                    count.judged += usize::from(judged);
                    count.hits += usize::from(judged && truth.closest.is_some());
                    count.lost += usize::from(lost);
                    count.given_up += usize::from(given_up);
                    let short = (lost || given_up) && is_short(precision, outcome);
                    count.short += usize::from(short);
                    if (lost || given_up) && !short {
                        let (name, precision) = (method.name(), precision.name());
                        let told = told(&case.model.surfaces[0], ray);
                        wrong.push(format!("{name} {precision} case {number}: {outcome:?}\n{truth:?}\n{told}"));
                    }
                }
            }
            (counts, wrong)
        })
        .collect();
    let (mut counts, mut wrong) = (BTreeMap::<_, Count>::new(), Vec::new());
    for (part, lines) in parts {
        wrong.extend(lines);
        for (name, part) in part {
            let sum = counts.entry(name).or_default();
            sum.rays += part.rays;
            sum.judged += part.judged;
            sum.hits += part.hits;
            sum.lost += part.lost;
            sum.given_up += part.given_up;
            sum.short += part.short;
        }
    }
    for (name, count) in &counts {
        println!("{name:?} {count:?}");
        // What is judged must not be the exception, nor hits.
        assert!(300 * count.short <= count.rays.max(900), "{name:?} {count:?}");
        assert!(5 * count.judged > 2 * count.rays && 6 * count.hits > count.rays, "{name:?} {count:?}");
    }
    for line in &wrong {
        println!("{}", line.lines().take(2).collect::<Vec<_>>().join(" "));
    }
    assert!(wrong.is_empty(), "{} wrong, the first:\n{}", wrong.len(), wrong[..wrong.len().min(10)].join("\n\n"));
}

/// The least sine of the angle between a ray and a plane at which nothing that `f64` holds lets the ray pass for a tangent.
const CROSSING: f64 = 1e-3;

/// A plane is a plane whatever the weights of its points, which bend only what u and v are there. (In `f32`, where they make a
/// curve of much of its domain to rounding, nothing tells the one from the other.)
#[test]
fn a_ray_that_crosses_a_plane_is_no_tangent_of_it() {
    let precision = Precision::F64;
    let count = rays(8000).div_ceil(RAYS);
    let parts: Vec<_> = (0..count)
        .into_par_iter()
        .map(|number| {
            let mut draw = Draw { random: Random(Random(number as u64).bits()), rays: RAYS, precision };
            let surface = flat(&mut draw);
            let (surface, ratio) = weighted(&mut draw, surface);
            let axis = across(&surface).expect("it is flat");
            let model = single(surface);
            let (surface, distance) = (&model.surfaces[0], away(&model));
            let lines = (0..RAYS).map(|_| {
                let target: DVec3 = point_anywhere(surface, ratio, &mut draw.random).into();
                let mut direction = draw.direction();
                direction[axis] *= CROSSING.powf(draw.random.within(0.0, 1.0));
                ray(target - direction * distance, direction)
            });
            let lines: Vec<_> = lines.collect();
            let sine = |ray: &RayLine| ray.direction[axis].abs() / DVec3::from_array(ray.direction).length();
            let mut called = Vec::new();
            for method in METHODS {
                let outcomes = trace(&model, &lines, method, precision);
                for (outcome, ray) in outcomes.iter().zip(&lines).filter(|(_, ray)| sine(ray) > CROSSING) {
                    let truth = meet_rectangle(surface, axis, ray, precision);
                    let clear = truth.margin >= truth::clear_margin(precision);
                    let Outcome::Hit(Found { incidence, .. }) = outcome else { continue };
                    if clear && *incidence != Incidence::Crossing {
                        let (name, told) = (method.name(), told(surface, ray));
                        called.push(format!("{name} case {number}: {outcome:?}\n{truth:?}\n{told}"));
                    }
                }
            }
            called
        })
        .collect();
    let called = parts.concat();
    println!("{} of {}", called.len(), count * RAYS * METHODS.len());
    assert!(called.is_empty(), "{} called, the first:\n{}", called.len(), called[0]);
}
