use clap::ValueEnum;

use crate::scanline::row;
use crate::scanline::{Outcome, Tally};
use crate::scene::camera::{Camera, View};
use crate::scene::model::Model;
use crate::scene::sampling::Sampling;
use crate::scene::teapot;
use crate::scene::trace::{Method, Precision};
use crate::settings::Settings;
use crate::settings::switches::{On, Switch};
use crate::viewed::{Viewed, Wishes};

/// What became of the picture's rays, and the sums without the seconds.
fn traced(model: &Model, settings: &Settings, picture: &View) -> (Vec<Outcome>, Tally) {
    let mut viewed = Viewed::build(model, settings, picture, Wishes::PRIMARY).expect("there is memory");
    let (tracer, used) = viewed.tracer().expect("it was just made ready");
    assert_eq!(used.lane.line > 0, settings.method.needs_view());
    let (mut lane, mut outcomes, mut tally) = (tracer.lane(), Vec::new(), Tally::default());
    for line in 0..picture.scan_lines() {
        lane.trace_line(&picture.scan_line(line), &row(picture, line), &mut outcomes, &mut tally);
    }
    (outcomes, Tally { seconds: 0.0, ..tally })
}

/// The common view, with this many pixels on a side.
fn picture(side: u32) -> View {
    teapot::common_scene().expect("the fixture is valid").description.camera.view([side, side])
}

fn teapot() -> Model {
    teapot::model().expect("the fixture is valid")
}

#[test]
fn a_view_and_single_rays_hit_alike() {
    let model = teapot();
    for sampling in [Sampling::One, Sampling::Jittered] {
        let picture = picture(48).sampled(sampling);
        for method in [Method::NewtonPredicted, Method::ClippingPredicted] {
            for precision in [Precision::F32, Precision::F64] {
                let settings = Settings { method, precision, flatness: 0.005, ..Settings::default() };
                let (in_view, tally) = traced(&model, &settings, &picture);
                let one_by_one = Settings { method: method.of_any_rays(), ..settings };
                let (alone, _) = traced(&model, &one_by_one, &picture);
                assert_eq!(tally.rays, in_view.len() as u64);
                let mut others = 0;
                for (a, b) in in_view.iter().zip(&alone) {
                    match (a, b) {
                        (Outcome::Hit(a), Outcome::Hit(b)) => {
                            let off = if precision == Precision::F32 { 1e-3 } else { 1e-9 };
                            others += usize::from((a.t - b.t).abs() > off * b.t);
                        }
                        (Outcome::Miss, Outcome::Miss) => {}
                        _ => panic!("{method:?} {precision:?} {a:?} {b:?}"),
                    }
                }
                // Near silhouettes eq. (1) lets one of two points on a patch pass for the closest; which one is chance.
                assert!(others <= 2, "{method:?} {precision:?}: {others} other points");
            }
        }
    }
}

#[test]
fn coherence_changes_work_and_no_hits() {
    let (model, picture) = (teapot(), picture(40));
    for &method in Method::value_variants() {
        let settings = Settings { method, flatness: 0.005, ..Settings::default() };
        let (with, tally) = traced(&model, &settings, &picture);
        let forgetful = Settings { parts: On::ALL.without(&[Switch::Coherence]), ..settings };
        let (without, other) = traced(&model, &forgetful, &picture);
        assert_eq!(other.count("verified") + other.count("decided_by_list") + other.count("start_failed"), 0);
        assert_eq!(tally.count("verified") > 0, method.is_coherent(), "{method:?}");
        for (a, b) in with.iter().zip(&without) {
            assert_eq!(matches!(a, Outcome::Hit(_)), matches!(b, Outcome::Hit(_)), "{method:?}");
        }
    }
}

#[test]
fn line_numbers_start_again_before_they_run_out() {
    use super::{ViewLane, ViewTracer};
    use crate::lower::{Lowered, Preparation, Stages};
    use crate::method::in_view::NewtonPredicted;
    use crate::scanline::Lane;
    use patchray::bernstein::Basis;
    use patchray::limits::Limits;
    use patchray::method::Followed;
    use patchray::point::Plain;
    use patchray::span::Span;

    let picture = picture(32);
    let mut lowered = Lowered::<Plain<f64>>::build(&teapot(), Stages::PATCHES, &Preparation::default()).expect("built");
    lowered.take_view(&picture, u64::MAX).expect("there is memory");
    let (views, seen) = lowered.seen(&picture).expect("it was just taken");
    let tracer = ViewTracer::<NewtonPredicted, _>::new((views.scene, seen), &picture, Limits::default(), false, None);
    let mut lane = ViewLane {
        tracer: &tracer,
        scratch: Default::default(),
        basis: Basis::new(),
        slots: vec![Followed::EMPTY; 32],
        number: u32::MAX - 100,
        spans: vec![Span::EMPTY; tracer.needs.spans.needed],
        active: vec![0; tracer.needs.active.needed],
        buckets: vec![0; 16],
        ready: Vec::new(),
        found: Vec::new(),
        others: None,
    };
    let (mut outcomes, mut tally) = (Vec::new(), Tally::default());
    for _ in 0..6 {
        lane.trace_line(&picture.scan_line(16), &row(&picture, 16), &mut outcomes, &mut tally);
        assert!(lane.number < u32::MAX - 1);
    }
    assert_eq!(lane.number, 4 * 33);
    assert_eq!((tally.rays, tally.count("verified"), tally.count("start_failed")), (6 * 32, 0, 0));
    assert!(outcomes.chunks(32).all(|line| line == &outcomes[..32]));
    // Rays of no line are not for it.
    let before = tally.gave_up_in_all();
    lane.trace(&row(&picture, 16), false, &mut outcomes, &mut tally);
    assert_eq!(tally.gave_up_in_all() - before, 32);
}

#[test]
fn what_is_no_view_is_traced_ray_by_ray_or_refused() {
    let model = teapot();
    let far = Camera::LookAt { eye: [0.0, -500.0, 1.5], look_at: [0.0, 0.0, 1.5], up: [0.0, 0.0, 1.0], fov: 1.0 };
    let wide = Camera::LookAt { eye: [0.0, -6.0, 1.5], look_at: [0.0, 0.0, 1.5], up: [0.0, 0.0, 1.0], fov: 100.0 };
    for (camera, reason) in [(far, "eight times"), (wide, "45 degrees")] {
        let picture = camera.view([24, 24]);
        for &method in Method::value_variants() {
            let settings = Settings { method, flatness: 0.01, ..Settings::default() };
            match Viewed::build(&model, &settings, &picture, Wishes::PRIMARY) {
                Ok(mut viewed) => {
                    assert!(!method.needs_view());
                    let (tracer, _) = viewed.tracer().expect("it was just made ready");
                    let (mut outcomes, mut tally) = (Vec::new(), Tally::default());
                    tracer.lane().trace_line(&picture.scan_line(12), &row(&picture, 12), &mut outcomes, &mut tally);
                    assert!(tally.hits > 0 && tally.invalid == 0, "{tally:?}");
                }
                Err(error) => {
                    assert!(method.needs_view());
                    assert!(error.to_string().contains(reason), "{error}");
                }
            }
        }
    }
}
