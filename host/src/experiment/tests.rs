use super::*;
use crate::experiment::subject::{Family, changes, ladder, letter};
use crate::scene::teapot::common_scene;
use std::sync::atomic::{AtomicU64, Ordering};

#[test]
fn every_subject_is_measured_and_judged() {
    let loaded = common_scene().expect("the fixture is valid");
    let (picture, steps) = (loaded.description.camera.view([24, 20]), AtomicU64::new(0));
    let oracle = crate::oracle::Oracle::new(&loaded.model);
    let (truths, _) = crate::judge::ask(&oracle, &picture, || {});
    let settings = Settings { flatness: 0.01, ..Settings::default() };
    let step = || {
        steps.fetch_add(1, Ordering::Relaxed);
    };
    let experiment = Experiment { model: &loaded.model, settings, step: &step };
    for family in Family::ALL {
        let changes = changes(family);
        let subjects = letter(family).into_iter().chain(ladder(family));
        let subjects = subjects.chain(changes.iter().flat_map(|change| change.subjects.clone()));
        let subjects: Vec<_> = subjects.map(|subject| (subject, Rays::Picture(&picture))).collect();
        steps.store(0, Ordering::Relaxed);
        let runs = experiment.measure(&subjects, 2, Some(&truths)).expect("there is memory");
        assert_eq!((runs.len(), steps.load(Ordering::Relaxed)), (subjects.len(), 3 * subjects.len() as u64));
        for (run, (subject, _)) in runs.iter().zip(&subjects) {
            assert_eq!((&run.subject, run.rays, run.gave_up), (subject, 480, 0));
            assert_eq!((run.hit_rays, run.times.repetitions.len()), (runs[0].hit_rays, 2), "{}", subject.name);
            let agreement = run.agreement.expect("it was judged");
            let believed = !subject.parts.0.verification;
            // A hit to a coarse tolerance is wrong by that, and a hit all the same.
            let found = agreement.right + if subject.tolerance.is_some() { agreement.wrong } else { 0 };
            assert!(found >= if believed { 470 } else { 478 }, "{}: {agreement:?}", subject.name);
            assert!(run.found_twice.expect("it was judged") < run.counts.of("intersection_points"));
        }
    }
}

#[test]
fn rays_in_any_lines_are_those_of_the_picture() {
    let loaded = common_scene().expect("the fixture is valid");
    let picture = loaded.description.camera.view([24, 20]);
    let settings = Settings { flatness: 0.01, ..Settings::default() };
    let experiment = Experiment { model: &loaded.model, settings, step: &|| {} };
    let [original, ..] = letter(Family::Numerical);
    let outcomes = experiment.outcomes(&original, &picture).expect("there is memory");
    let of_picture = rays::lines(&picture);
    let (shuffled, shadows) = (rays::shuffled(&of_picture), rays::shadows(&of_picture, &outcomes, [5.0, -5.0, 9.0]));
    let hits = outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Hit(_))).count() as u64;
    let lines = [&of_picture, &shuffled, &shadows].map(|lines| (original.clone(), Rays::Lines(lines.as_slice())));
    let runs = experiment.measure(&lines, 0, None).expect("there is memory");
    assert_eq!([0, 1, 2].map(|k: usize| runs[k].rays), [480, 480, hits]);
    assert_eq!([0, 1].map(|k: usize| runs[k].hit_rays), [hits, hits]);
    // Of the original nothing depends on the order of rays.
    assert_eq!(runs[0].counts, runs[1].counts);
}

#[test]
fn points_beyond_the_roots_were_found_twice() {
    let truth = |roots, open| Truth { closest: Some(1.0), roots, open, margin: 1.0, ..Truth::default() };
    let truths = [truth(2, false), truth(2, false), truth(0, true)];
    let each = [1, 5, 7].map(|intersection_points| Work { intersection_points, newton_steps: 9, ..Work::default() });
    assert_eq!(found_twice(&each, &truths), 3);
}
