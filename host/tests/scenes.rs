//! The paper's four scenes: what `fixtures/scenes` holds of them, and how near it comes to the figures of its Table 1.

use patchray_host::experiment::subject::{Family, letter};
use patchray_host::experiment::{Experiment, Rays};
use patchray_host::judge::{Agreement, Truth};
use patchray_host::scanline::{Outcome, Tally, rays_of};
use patchray_host::scene::camera::View;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::file::{self, Scene};
use patchray_host::scene::paper::{Figures, SCENES};
use patchray_host::scene::trace::{Acceptance, Method, Precision};
use patchray_host::settings::{Flags, Settings};
use patchray_host::viewed::{Viewed, Wishes};
use std::path::Path;

fn scene(name: &str) -> Scene {
    let path = format!("{}/../fixtures/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    file::read(Path::new(&path), OnInvalid::Refuse).expect("it is valid")
}

/// The picture that the tables measure.
fn picture(scene: &Scene) -> View {
    scene.description.camera.view([512, 512])
}

/// The scene ready for that picture by the original numerical method, at its own flatness.
fn viewed(scene: &Scene) -> Viewed {
    let flags = Flags {
        method: Some(Method::Newton),
        precision: Some(Precision::F64),
        acceptance: Some(Acceptance::Paper),
        ..Flags::default()
    };
    let settings = Settings::of_scene(&flags, &scene.description.trace, &scene.source).expect("it is valid");
    Viewed::build(&scene.model, &settings, &picture(scene), Wishes::PRIMARY).expect("there is memory")
}

/// Asserts that a figure is the paper's to 10 %.
fn assert_near(what: &str, found: u64, paper: u64) {
    assert!(found.abs_diff(paper) * 10 <= paper, "{what}: {found}, in the paper {paper}");
}

#[test]
fn surfaces_and_patches_are_the_papers() {
    for paper in SCENES {
        let (name, Figures { surfaces, patches, .. }) = (paper.name(), paper.figures);
        let scene = scene(name);
        assert_eq!(scene.model.surfaces.len() as u64, surfaces, "{name}");
        // The tables' scenes are polynomial, and bicubic throughout.
        let bicubic = scene.model.surfaces.iter().all(|s| !s.rational && (s.degree_u, s.degree_v) == (3, 3));
        assert!(bicubic, "{name}");
        let mut viewed = viewed(&scene);
        let (_, used) = viewed.tracer().expect("there is memory");
        assert_near(name, used.patches, patches);
    }
}

/// But for the fourth, whose backdrop fills the picture with columns, of which a ray meets front and back.
#[test]
fn intersection_points_of_three_scenes_are_the_papers() {
    let [original, ..] = letter(Family::Numerical);
    for paper in &SCENES[..3] {
        let Scene { model, description, source, .. } = paper.load().expect("it is valid");
        let picture = paper.camera(&description.camera).view([512, 512]);
        let flags = Flags { acceptance: Some(Acceptance::Paper), ..Flags::default() };
        let settings = Settings::of_scene(&flags, &description.trace, &source).expect("it is valid");
        let experiment = Experiment { model: &model, settings, step: &|| {} };
        let runs = experiment.measure(&[(original.clone(), Rays::Picture(&picture))], 0, None);
        let run = &runs.expect("there is memory")[0];
        assert_eq!((run.rays, run.gave_up), (512 * 512, 0), "{}", paper.name());
        assert_near(paper.name(), run.counts.of("intersection_points"), paper.figures.numerical.points[0]);
    }
}

/// What becomes of the picture's rays.
fn outcomes(viewed: &mut Viewed, picture: &View) -> Vec<Outcome> {
    let (tracer, _) = viewed.tracer().expect("there is memory");
    let (mut lane, mut tally, mut outcomes) = (tracer.lane(), Tally::default(), Vec::new());
    for line in 0..picture.scan_lines() {
        let samples = picture.scan_line(line);
        lane.trace_line(&samples, &rays_of(picture, line, &samples), &mut outcomes, &mut tally);
    }
    outcomes
}

/// What a method answers for a small picture of a scene: t, or nothing.
fn answers(scene: &Scene, settings: &Settings) -> Vec<Option<f64>> {
    let picture = scene.description.camera.view([96, 96]);
    let mut viewed = Viewed::build(&scene.model, settings, &picture, Wishes::PRIMARY).expect("there is memory");
    let outcomes = outcomes(&mut viewed, &picture);
    let t = |outcome: &Outcome| match outcome {
        Outcome::Hit(found) => Some(found.t),
        Outcome::Miss => None,
        other => panic!("{other:?}"),
    };
    outcomes.iter().map(t).collect()
}

/// With patches so coarse that the paper's rule loses hits, what is proved and clipped loses none, and finds none that is not
/// there; with more patches neither.
#[test]
fn what_is_proved_is_right_at_any_number_of_patches() {
    let mut lost = 0;
    for name in SCENES.map(|paper| paper.name()) {
        let scene = scene(name);
        let fine = Settings::of_scene(&Flags::default(), &scene.description.trace, &scene.source).expect("it is valid");
        assert_eq!(fine.acceptance, Acceptance::Proved);
        let expected = answers(&scene, &Settings { method: Method::Clipping, ..fine });
        for coarse in [1.0, 8.0, 64.0] {
            let settings = Settings { flatness: fine.flatness * coarse, ..fine };
            for method in [Method::Newton, Method::NewtonCoherent, Method::NewtonPredicted] {
                let differ = |acceptance| {
                    let found = answers(&scene, &Settings { method, acceptance, ..settings });
                    let differs = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
                        (Some(a), Some(b)) => (a - b).abs() > 1e-9 * b,
                        (a, b) => a.is_some() != b.is_some(),
                    };
                    found.iter().zip(&expected).filter(|&pair| differs(pair)).count()
                };
                assert_eq!(differ(Acceptance::Proved), 0, "{name}, {method:?}, flatness {}", settings.flatness);
                lost += differ(Acceptance::Paper);
            }
        }
    }
    // Else this has seen nothing.
    assert!(lost > 10, "{lost}");
}

/// How many pixels a method in `f32` answers otherwise than Bézier clipping does in `f64`, by the allowances of
/// `patchray_host::judge`, and without leaving out those that `f32` cannot tell.
fn wrong_in_f32(scene: &Scene, method: Method, truths: &[Truth], picture: &View) -> u64 {
    let flags = Flags { method: Some(method), precision: Some(Precision::F32), ..Flags::default() };
    let settings = Settings::of_scene(&flags, &scene.description.trace, &scene.source).expect("it is valid");
    let mut viewed = Viewed::build(&scene.model, &settings, picture, Wishes::PRIMARY).expect("there is memory");
    let outcomes = outcomes(&mut viewed, picture);
    let diagonal = scene.model.control_box().expect("it is not empty").diagonal();
    let agreement = Agreement::of(&outcomes, truths, picture, diagonal, Precision::F32);
    assert_eq!(agreement.unanswered, 0);
    agreement.wrong + agreement.missed + agreement.phantom
}

/// Of a ray that all but touches a fold `f32` cannot tell whether it meets it. Where clipping clips one patch after another along
/// the fold, each is a chance to take it for met; it must not be wrong more often for it than Newton's method in the same view, but
/// for a few of the rays. That points are turned to the view rounds them once more, for which either is wrong more often than its
/// original, which traces ray by ray.
#[test]
fn predicted_methods_are_wrong_of_few_rays_in_f32() {
    for name in SCENES.map(|paper| paper.name()) {
        let scene = scene(name);
        let picture = picture(&scene);
        let fine = Settings::of_scene(&Flags::default(), &scene.description.trace, &scene.source).expect("it is valid");
        let settings = Settings { method: Method::Clipping, ..fine };
        let mut viewed = Viewed::build(&scene.model, &settings, &picture, Wishes::PRIMARY).expect("there is memory");
        let truth = |outcome: &Outcome| match outcome {
            Outcome::Hit(found) => Truth { closest: Some(found.t), ..Truth::default() },
            _ => Truth::default(),
        };
        let truths: Vec<Truth> = outcomes(&mut viewed, &picture).iter().map(truth).collect();
        let wrong = |method| wrong_in_f32(&scene, method, &truths, &picture);
        let [newton, clipping] = [Method::NewtonPredicted, Method::ClippingPredicted].map(wrong);
        assert!(clipping <= newton + newton / 10, "{name}: {clipping}, {newton}");
        for (predicted, original) in [(newton, Method::Newton), (clipping, Method::Clipping)] {
            let original = wrong(original);
            assert!(predicted <= 3 * original, "{name}: {predicted}, {original}");
        }
    }
}

/// Neighbours have the same control points along the edge that they share, to the bit, wherever they are put.
#[test]
fn no_torus_or_ring_has_a_crack() {
    for (name, each) in [("toruses", 8), ("rings", 12)] {
        let scene = scene(name);
        for torus in scene.model.surfaces.chunks(each) {
            // In a closed net of bicubics there are 9 points for each surface.
            let mut points: Vec<_> =
                torus.iter().flat_map(|s| &s.points).map(|point| point.map(f64::to_bits)).collect();
            points.sort_unstable();
            points.dedup();
            assert_eq!(points.len(), 9 * each, "{name}");
        }
    }
}
