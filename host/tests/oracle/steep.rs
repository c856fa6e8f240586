//! What the methods were once wrong on, so that the oracle is not wrong with them: weights up to 1e9 that fall toward either end
//! of a parameter, mates far away, and pipes as thin as a rounding of their length.

use crate::truth::*;
use glam::DVec3;
use patchray_host::oracle::{DoubleDouble, OracleIn, Real};
use patchray_host::scene::model::Model;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::revolution::{Arcs, Curve, revolve};
use patchray_host::scene::shapes::weights::{Sheet, Weights, point_anywhere};
use patchray_host::scene::shapes::{Random, parallelogram, single};
use patchray_host::scene::trace::Precision;
use patchray_host::stress::case::{Draw, away, mapped, ray};
use patchray_host::stress::forms::{meet_bilinear, meet_pipe};
use patchray_host::stress::truth::size;

in_either!(
    weights_that_fall_toward_any_end
    graded_weights_and_any
    a_far_mate_changes_nothing
);

fn draw(seed: u64) -> Draw {
    Draw { random: Random(seed), rays: 0, precision: Precision::F64 }
}

/// Rays onto all of the surface, and some at its box.
fn rays(draw: &mut Draw, model: &Model, ratio: f64, count: usize) -> Vec<RayLine> {
    let mut rays = draw.rays_at(model, count / 4);
    for _ in rays.len()..count {
        let target = point_anywhere(&model.surfaces[0], ratio, &mut draw.random).into();
        rays.push(draw.ray_to(target, away(model)));
    }
    rays
}

/// The roots ahead of the ray.
fn ahead(model: &Model, ray: &RayLine) -> Vec<f64> {
    let roots = meet_bilinear(&model.surfaces[0], ray);
    roots.iter().map(|root| root.t).filter(|&t| t >= 0.0).collect()
}

fn check<R: Real>(seed: u64, arrangements: &[Weights], count: usize) {
    let mut draw = draw(seed);
    let mut tally = Tally::of::<R>();
    for sheet in [Sheet::Square, Sheet::Twisted] {
        for decades in [1.0, 3.0, 5.0, 7.0, 9.0] {
            for &arrangement in arrangements {
                let ratio = 10f64.powf(decades);
                let surface = sheet.surface(&mut draw.random);
                let model = single(arrangement.of(surface, ratio, &mut draw.random));
                let oracle = OracleIn::<R>::new(&model);
                for ray in rays(&mut draw, &model, ratio, count) {
                    let verdict = oracle.trace(ray.origin, ray.direction, 0.0, f64::INFINITY);
                    // At a graze a double root's digits are lost to the rounding of the surface itself.
                    if verdict.roots.iter().any(|root| root.cosine < 1e-2) {
                        continue;
                    }
                    let what = format!("{sheet:?} {arrangement:?} {ratio:e} {ray:?}");
                    tally.add(&what, &verdict, &ahead(&model, &ray), size(&model.surfaces[0], &model), false);
                }
            }
        }
    }
    // Parameters that are spread for all ratios name points next to a border, too.
    tally.expect(0.85, 0.0, [0.6, 0.95]);
}

fn weights_that_fall_toward_any_end<R: Real>(fewer: usize) {
    check::<R>(31, &Weights::FALLING, 80 / fewer);
}

fn graded_weights_and_any<R: Real>(fewer: usize) {
    let mut all = Weights::GRADED.to_vec();
    all.extend([Weights::Any; 8]);
    check::<R>(32, &all, 40 / fewer);
}

/// Alone, and with a mate, a surface's roots are the same and its margins shares of its own size.
fn a_far_mate_changes_nothing<R: Real>(fewer: usize) {
    let mut draw = draw(33);
    let (mut hits, mut misses) = (0, 0);
    for far in [1e3, 1e6, 1e9] {
        for sheet in Sheet::ALL {
            let surface = sheet.surface(&mut draw.random);
            let alone = single(Weights::Any.of(surface, 10.0, &mut draw.random));
            let floor = parallelogram([-0.5 * far, -0.5 * far, -4.0 - far], [far, 0.0, 0.0], [0.0, far, far]);
            let away = parallelogram([far, far, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
            let rays = rays(&mut draw, &alone, 10.0, 400 / fewer);
            for mate in [floor, away] {
                let beside = Model::numbered(vec![alone.surfaces[0].clone(), mate]);
                let [alone, beside] = [&alone, &beside].map(|model| {
                    let unit = |surface: &_| size(surface, model);
                    (OracleIn::<R>::measured_by(model, unit), model)
                });
                for ray in &rays {
                    // Short of the mate.
                    let trace =
                        |(oracle, _): &(OracleIn<R>, &Model)| oracle.trace(ray.origin, ray.direction, 0.0, 50.0);
                    let (one, other) = (trace(&alone), trace(&beside));
                    let mate = |root: &&patchray_host::oracle::Root| root.surface == 0;
                    let others: Vec<_> = other.roots.iter().filter(mate).collect();
                    if others.len() < other.roots.len() {
                        continue;
                    }
                    // f64 tells depths in the scene to its size.
                    let near = if R::BITS > 60 { 1e-14 } else { 1e-14 + 1e-15 * far };
                    if one.margin > JUDGED + near {
                        assert!(other.margin > JUDGED, "{far} {sheet:?}: {one:?} {other:?}");
                        assert_eq!(one.roots.is_empty(), others.is_empty(), "{far} {sheet:?}: {one:?} {other:?}");
                    }
                    assert!(other.margin <= one.margin * 1.001 + near, "{far} {sheet:?}: {one:?} {other:?}");
                    let (Some(a), Some(b)) = (one.roots.first(), others.first()) else {
                        misses += 1;
                        continue;
                    };
                    hits += 1;
                    assert_eq!(a.unit, b.unit);
                    let blur = rounding::<R>() * (a.blur + b.blur) * a.unit;
                    assert!((a.t - b.t).abs() <= 1e-14 + blur, "{far} {sheet:?}: {one:?} {other:?}");
                }
            }
        }
    }
    println!("{hits} hits, {misses} misses");
    assert!(hits > 4000 / fewer && misses > 500 / fewer, "{hits} {misses}");
}

/// The pipe of this thickness along x.
fn pipe(thickness: f64) -> Model {
    let profile = Curve::segment(1, [0.5 * thickness, -0.5], [0.5 * thickness, 0.5]);
    let upright = Model::numbered(revolve(&profile, &Curve::circle(Arcs::Rational, 0.0, 360.0, 4)));
    mapped(&upright, |p| DVec3::new(p.z, p.x, p.y))
}

#[test]
fn both_roots_of_a_thin_pipe() {
    let mut random = Random(34);
    let mut pairs = 0;
    for exponent in 1..=14 {
        let thickness = 10f64.powi(-exponent);
        let model = pipe(thickness);
        let oracle = OracleIn::<DoubleDouble>::measured_by(&model, |surface| size(surface, &model));
        for _ in 0..60 {
            let (sin, cos) = random.within(1.0, 60.0f64).to_radians().sin_cos();
            let (y, z) = random.within(0.0, 6.3).sin_cos();
            let along = DVec3::new(cos, sin * y, sin * z);
            let [x, y, z] = [0.1, 0.3 * thickness, 0.3 * thickness].map(|half| random.within(-half, half));
            let line = ray(DVec3::new(x, y, z) - along * 0.125, along);
            let roots = meet_pipe([0.5 * thickness; 2], &line).expect("it passes through the pipe");
            let verdict = oracle.trace(line.origin, line.direction, 0.0, 0.25);
            let seen: Vec<f64> = verdict.roots.iter().map(|root| root.t).collect();
            if roots[0] < 0.0 || roots[1] > 0.25 {
                continue;
            }
            pairs += 1;
            assert_eq!(seen.len(), 2, "{thickness:e} {line:?}: {verdict:?} {roots:?}");
            assert_eq!(verdict.unresolved, 0, "{thickness:e}: {verdict:?}");
            for (t, seen) in roots.iter().zip(seen) {
                // The pipe's own numbers are rounded.
                assert!(
                    (t - seen).abs() <= 1e-16 + 1e-14 * (roots[1] - roots[0]),
                    "{thickness:e}: {verdict:?} {roots:?}"
                );
            }
            assert!(verdict.margin > 1e-6 * thickness && verdict.margin < thickness, "{thickness:e}: {verdict:?}");
        }
    }
    assert!(pairs > 600, "{pairs}");
}
