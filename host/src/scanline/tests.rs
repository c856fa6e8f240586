use clap::ValueEnum;

use super::*;
use crate::batch::Batch;
use crate::lower::Stages;
use crate::method::NewtonCoherent;
use crate::prepared::Prepared;
use crate::scene::shapes::{Random, sphere};
use crate::scene::teapot;
use crate::scene::trace::{Method as Which, Precision};
use crate::settings::Settings;

/// Rays towards the teapot, some past it, in lines of uneven length.
fn rays(count: usize) -> Vec<RayLine> {
    let mut random = Random(5);
    let ray = |k: usize| {
        let along = k as f64 / count as f64;
        let target = [random.within(-0.02, 0.02) + 6.0 * along - 3.0, random.within(-0.02, 0.02), 1.2 + along];
        let origin = [1.0, -9.0, 4.0];
        RayLine {
            origin,
            direction: [0, 1, 2].map(|axis| target[axis] - origin[axis]),
            t_min: 0.0,
            t_max: f64::INFINITY,
            scan_line: ((k / 7) % 5 + k / 100) as u64,
            valid: k % 50 != 3,
        }
    };
    (0..count).map(ray).collect()
}

fn traced(settings: &Settings, rays: &[RayLine], block: usize) -> (Vec<Outcome>, Tally) {
    let model = teapot::model().expect("the fixture is valid");
    let prepared = Prepared::build(&model, Stages::of(settings.method), settings).expect("there is memory");
    let tracer = prepared.tracer(settings);
    let mut batch = Batch::new(tracer.as_ref());
    let outcomes = rays.chunks(block).flat_map(|block| batch.trace(block)).collect();
    let mut tally = batch.tally().clone();
    tally.seconds = 0.0;
    (outcomes, tally)
}

#[test]
fn blocks_and_threads_change_nothing() {
    let rays = rays(600);
    for &method in Which::value_variants().iter().filter(|method| !method.needs_view()) {
        for precision in [Precision::F32, Precision::F64] {
            let settings = Settings { method, precision, flatness: 0.005, ..Settings::default() };
            let whole = traced(&settings, &rays, rays.len());
            assert!(whole.1.hits > 300 && whole.1.invalid == 12, "{:?}", whole.1);
            for block in [1, 64] {
                assert_eq!(traced(&settings, &rays, block), whole, "{method:?} {precision:?} {block}");
            }
            let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("three threads");
            assert_eq!(pool.install(|| traced(&settings, &rays, 100)), whole);
        }
    }
}

/// Minus infinity and infinity are bounds of t like others, and no t is infinite.
#[test]
fn rays_may_be_whole_lines_or_have_one_end() {
    let infinity = f64::INFINITY;
    let ended = |from: f64, to: f64| {
        let mut rays = rays(300);
        for ray in &mut rays {
            // From within the teapot, so that it is met on both sides.
            ray.origin = [0, 1, 2].map(|axis| ray.origin[axis] + ray.direction[axis]);
            (ray.t_min, ray.t_max, ray.valid) = (from, to, true);
        }
        rays
    };
    for &method in Which::value_variants().iter().filter(|method| !method.needs_view()) {
        for precision in [Precision::F32, Precision::F64] {
            let settings = Settings { method, precision, flatness: 0.005, ..Settings::default() };
            let answers = |from, to| traced(&settings, &ended(from, to), 300).0;
            let whole = answers(-infinity, infinity);
            let t = |outcome: &Outcome| match outcome {
                Outcome::Hit(found) => Some(found.t),
                _ => None,
            };
            let behind = whole.iter().filter_map(t).filter(|t| *t < 0.0).count();
            assert!(behind > 100, "{method:?} {precision:?}: {behind}");
            assert_eq!(whole, answers(-1e6, 1e6), "{method:?} {precision:?}");
            assert_eq!(answers(-infinity, 0.0), answers(-1e6, 0.0), "{method:?} {precision:?}");
            assert_eq!(answers(0.0, infinity), answers(0.0, 1e6), "{method:?} {precision:?}");
            for end in [-infinity, infinity] {
                assert!(answers(end, end).iter().all(|outcome| *outcome == Outcome::Miss), "{method:?} {precision:?}");
            }
        }
    }
}

/// Where there is no normal pictures show one of a place nearby; of a surface that has none anywhere there is none to show.
#[test]
fn a_hit_without_a_normal_shows_one_nearby() {
    let near = |surface| {
        let model = crate::scene::shapes::single(surface);
        let Ok(Prepared::PlainF64(lowered)) = Prepared::build(&model, Stages::NONE, &Settings::default()) else {
            panic!("it is polynomial")
        };
        let hit = Hit { t: 1.0, u: 0.0, v: 0.25, surface: 0, incidence: Default::default() };
        found(&lowered.scene(), &mut Basis::new(), &hit).normal
    };
    // Three sides of a pyramid's edge as rows about its tip.
    let pointed = crate::scene::shapes::net(1, 2, |i, j| [(i * j) as f64, (i * j * j) as f64, i as f64]);
    let shown = near(pointed);
    assert!(matches!(shown, Normal::Nearby(_)) && shown.there().is_none(), "{shown:?}");
    let length: f64 = shown.shown().expect("it is near").iter().map(|c| c * c).sum();
    assert!((length - 1.0).abs() < 1e-12);
    let curve = crate::scene::shapes::net(1, 2, |_, j| [j as f64, (j * j) as f64, 0.0]);
    assert_eq!(near(curve), Normal::Nowhere);
    let flat = crate::scene::shapes::net(1, 1, |i, j| [i as f64, (i * j) as f64, 0.0]);
    assert_eq!(near(flat).there().map(|[x, y, z]| [x, y, z.abs()]), Some([0.0, 0.0, 1.0]));
}

#[test]
fn coherence_stays_within_a_line() {
    let mut rays = rays(200);
    let settings = Settings { method: Which::NewtonCoherent, flatness: 0.005, ..Settings::default() };
    rays.iter_mut().for_each(|ray| ray.scan_line = 7);
    let (one_line, tally) = traced(&settings, &rays, 50);
    assert!(tally.count("verified") + tally.count("decided_by_list") > 50);
    (0..).zip(&mut rays).for_each(|(number, ray)| ray.scan_line = number);
    let (no_coherence, tally) = traced(&settings, &rays, 50);
    assert_eq!(tally.count("verified") + tally.count("decided_by_list"), 0);
    for (a, b) in one_line.iter().zip(&no_coherence) {
        assert_eq!(matches!(a, Outcome::Hit(_)), matches!(b, Outcome::Hit(_)));
    }
}

#[test]
fn line_numbers_start_again_before_they_run_out() {
    let model = sphere([0.0; 3], 1.0);
    let settings = Settings { method: Which::NewtonCoherent, ..Settings::default() };
    let prepared = Prepared::build(&model, Stages::of(settings.method), &settings).expect("there is memory");
    let Prepared::WeightedF64(lowered) = &prepared else { panic!("a sphere is rational") };
    let tracer = MethodTracer::<NewtonCoherent, _>::new(Views::of(lowered), settings.limits(), None);
    let mut lane = MethodLane {
        tracer: &tracer,
        scratch: Default::default(),
        basis: Basis::new(),
        memory: vec![Remembered::EMPTY; 8],
        line: u32::MAX - 4,
        ready: Vec::new(),
        found: Vec::new(),
    };
    let ray = RayLine {
        origin: [0.1, 0.2, 5.0],
        direction: [0.0, 0.0, -1.0],
        t_min: 0.0,
        t_max: f64::INFINITY,
        scan_line: 0,
        valid: true,
    };
    let (mut outcomes, mut tally) = (Vec::new(), Tally::default());
    for _ in 0..6 {
        lane.trace(&[ray], false, &mut outcomes, &mut tally);
        assert!(lane.line < u32::MAX - 1);
    }
    assert_eq!((tally.hits, tally.count("start_failed"), tally.count("verified")), (6, 0, 0));
    assert!(outcomes.iter().all(|outcome| *outcome == outcomes[0]));
}

#[test]
fn a_ray_that_the_precision_cannot_hold_is_refused() {
    let settings = Settings { precision: Precision::F32, flatness: 0.01, ..Settings::default() };
    let mut ray = rays(1)[0];
    ray.direction = [1e-60, 0.0, 0.0];
    let (outcomes, tally) = traced(&settings, &[ray], 1);
    assert_eq!(outcomes, [Outcome::Refused(RayError::ZeroDirection)]);
    assert_eq!(tally.invalid, 1);
}
