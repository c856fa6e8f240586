//! The stories of rays: that they are of the same rays, to the bit, and leave nothing out that is counted.

use patchray::limits::Work;
use patchray::story::Event;
use patchray_host::explain::{Story, of_pixel};
use patchray_host::lower::LowerError;
use patchray_host::scanline::{Outcome, Tally, rays_of};
use patchray_host::scene::camera::View;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::file;
use patchray_host::scene::model::Model;
use patchray_host::scene::sampling::Sampling;
use patchray_host::scene::teapot::common_scene;
use patchray_host::scene::trace::{Acceptance, Method, Precision};
use patchray_host::settings::Settings;
use patchray_host::viewed::{Viewed, Wishes};

use clap::ValueEnum;
use std::path::Path;

/// How often each thing was told that is counted too.
fn told(events: &[Event]) -> Work {
    let mut work = Work::default();
    for event in events {
        match event {
            Event::SceneVoxel | Event::Voxel => work.voxels_visited += 1,
            Event::Node { .. } => work.nodes_visited += 1,
            Event::Patch { .. } => work.patches_tested += 1,
            Event::Critical => work.critical += 1,
            Event::Excluded => work.excluded += 1,
            Event::HandedOver => work.handed_over += 1,
            Event::Unresolved => work.unresolved += 1,
            Event::Start(_) => work.newton_starts += 1,
            Event::Step { .. } => work.newton_steps += 1,
            Event::Clip { .. } => work.clip_steps += 1,
            Event::Bisection => work.bisections += 1,
            Event::Verified => work.verified += 1,
            Event::DecidedByList => work.decided_by_list += 1,
            Event::StartFailed => work.start_failed += 1,
            Event::FullSearch => work.full_searches += 1,
            _ => {}
        }
    }
    work
}

/// The counters without those of which no story tells.
fn counted(work: &Work) -> Work {
    Work {
        surfaces_tested: 0,
        spans_visited: 0,
        intersection_points: 0,
        bisection_cases: 0,
        refused_as_critical: 0,
        refused_by_list: 0,
        refused_by_neighbour: 0,
        ..*work
    }
}

/// What a scan line's rays come to without a listener.
fn silent(model: &Model, settings: &Settings, view: &View, line: u32) -> (Vec<Outcome>, Vec<Work>) {
    let mut viewed = Viewed::build(model, settings, view, Wishes::PRIMARY).expect("it is valid");
    let (tracer, _) = viewed.tracer().expect("it was just made ready");
    let samples = view.scan_line(line);
    let (mut outcomes, mut tally) = (Vec::new(), Tally { each: Some(Vec::new()), ..Tally::default() });
    tracer.lane().trace_line(&samples, &rays_of(view, line, &samples), &mut outcomes, &mut tally);
    (outcomes, tally.each.unwrap_or_default())
}

/// Holds the stories of some pixels of a row against its rays without a listener; how many events there were.
fn agree(model: &Model, settings: &Settings, view: &View, row: u32) -> usize {
    let side = view.sampling.side();
    let lines: Vec<_> = (side * row..side * (row + 1)).map(|line| silent(model, settings, view, line)).collect();
    let mut events = 0;
    for px in (0..view.size[0]).step_by(9) {
        let stories = of_pixel(model, settings, view, [px, row]).expect("it is valid");
        let places =
            lines.iter().flat_map(|line| (side * px..side * (px + 1)).map(move |sample| (line, sample as usize)));
        assert_eq!(stories.len(), (side * side) as usize);
        for (story, ((outcomes, works), sample)) in stories.iter().zip(places) {
            let what = format!("{:?} {:?} {px},{row}", settings.method, settings.precision);
            assert_eq!((&story.outcome, story.work), (&outcomes[sample], works[sample]), "{what}");
            assert_eq!(told(&story.events), counted(&story.work), "{what}");
            assert!(story.words(model, |surface| surface.to_string()).lines().count() >= 3);
            events += story.events.len();
        }
    }
    events
}

#[test]
fn stories_are_of_the_same_rays_and_leave_nothing_out() {
    let scene = common_scene().expect("the built-in scene is valid");
    let view = scene.description.camera.view([64, 48]);
    for &method in Method::value_variants() {
        for (precision, acceptance) in [
            (Precision::F64, Acceptance::Proved),
            (Precision::F32, Acceptance::Proved),
            (Precision::F64, Acceptance::Paper),
            (Precision::F32, Acceptance::Paper),
        ] {
            let settings = Settings { method, precision, acceptance, ..Settings::default() };
            let events = agree(&scene.model, &settings, &view, 25);
            assert!(events >= 20, "{method:?} {precision:?}: {events}");
        }
    }
    let settings = Settings { method: Method::NewtonPredicted, ..Settings::default() };
    assert!(agree(&scene.model, &settings, &view.sampled(Sampling::Jittered), 20) > 100);
}

/// From so far away the kernel has no view of it, and the methods that need none have stories all the same.
#[test]
fn rays_of_no_view_have_stories_too() {
    let scene = common_scene().expect("the built-in scene is valid");
    let near = scene.description.camera.view([40, 30]);
    // As large in the picture: the teapot is about 0.03 of its forward vector from the eye.
    let (eye, forward) =
        ([0, 1, 2].map(|k| near.eye[k] - 0.03 * 399.0 * near.forward[k]), near.forward.map(|c| 400.0 * c));
    let view = View { eye, forward, ..near };
    for method in [Method::Newton, Method::NewtonCoherent, Method::Clipping, Method::ClippingCoherent] {
        let settings = Settings { method, ..Settings::default() };
        assert!(agree(&scene.model, &settings, &view, 15) >= 5, "{method:?}");
    }
    for method in [Method::NewtonPredicted, Method::ClippingPredicted] {
        let settings = Settings { method, ..Settings::default() };
        assert!(matches!(of_pixel(&scene.model, &settings, &view, [20, 15]), Err(LowerError::NoView { .. })));
    }
}

#[test]
fn rational_surfaces_have_stories_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("sphere.toml");
    let text = "surfaces = [{ sphere = { radius = 1 } }]\n[camera]\neye = [0, -5, 1]\nlook_at = [0, 0, 0]\n";
    std::fs::write(&path, text).expect("written");
    let scene = file::read(Path::new(&path), OnInvalid::Refuse).expect("a scene");
    let view = scene.description.camera.view([48, 32]);
    for &method in Method::value_variants() {
        let settings = Settings { method, ..Settings::default() };
        assert!(agree(&scene.model, &settings, &view, 16) >= 5, "{method:?}");
    }
}

#[test]
fn a_ray_that_is_given_up_has_a_story() {
    let scene = common_scene().expect("the built-in scene is valid");
    let view = scene.description.camera.view([64, 48]);
    let mut settings = Settings { method: Method::Newton, ..Settings::default() };
    settings.limits.newton_steps = 1;
    let [story]: [Story; 1] =
        of_pixel(&scene.model, &settings, &view, [32, 25]).expect("it is valid").try_into().expect("one ray");
    let words = story.words(&scene.model, |surface| format!("surface {surface}"));
    assert!(words.contains("it is given up: the limit on newton-steps ran out"), "{words}");
    assert!(words.contains("step 1:") && !words.contains("step 2:"), "{words}");
}
