//! The answer to a ray is its own: whatever rays came before it, in whatever order, and whatever the memory held.

use crate::agree::{By, one_by_one};
use crate::cameras::{Named, cameras, inside, scaled};
use crate::common::{Kind, Prepared, index, is_rational};
use crate::compare::Judge;
use crate::corpus::{Case, cases};
use crate::image::{Row, Seen, ray_lines, rows};
use crate::judging::rays_per_case;
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use crate::rubbish;
use patchray::limits::{Acceptance, Limits};
use patchray::line::Window;
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::Random;
use patchray_host::scene::trace::{Method, Precision};
use rayon::prelude::*;

/// Rays per case and camera, unless the environment says otherwise.
const RAYS: usize = 130;

/// In which order rays come, by line and place in it; and whether memory is filled with rubbish now and then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    Forward,
    Backward,
    Shuffled,
    /// From the middle of each line, each ray twice, and every third once more with the one before it.
    Repeated,
    Rubbish,
    ShuffledRubbish,
}

const OTHERS: [Course; 5] =
    [Course::Backward, Course::Shuffled, Course::Repeated, Course::Rubbish, Course::ShuffledRubbish];

impl Course {
    fn has_rubbish(self) -> bool {
        matches!(self, Course::Rubbish | Course::ShuffledRubbish)
    }

    fn over(self, count: usize, random: &mut Random) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        match self {
            Course::Forward | Course::Rubbish => {}
            Course::Backward => order.reverse(),
            Course::Shuffled | Course::ShuffledRubbish => {
                for k in (1..count).rev() {
                    order.swap(k, index(random, k + 1));
                }
            }
            Course::Repeated => {
                order.rotate_left(count / 2);
                let thrice =
                    |k: usize| if k.is_multiple_of(3) { vec![k, k, k.saturating_sub(1), k] } else { vec![k, k] };
                order = order.into_iter().flat_map(thrice).collect();
            }
        }
        order
    }
}

/// All answers to a ray, for each ray in the order of the rows.
fn trace<P: Kind>(
    prepared: &Prepared<P>,
    named: &Named,
    rows: &[Row],
    method: InView,
    course: Course,
    acceptance: Acceptance,
) -> Vec<Vec<Seen<P::Scalar>>> {
    let camera = scaled(&named.camera, 1.0);
    let limits = Limits { acceptance, ..Limits::default() };
    let mut room = ViewRoom::for_view(prepared, &camera).expect("the camera is a good one");
    let view = room.build(prepared, &camera).expect("what was asked for is enough");
    let mut thread = Thread::new(prepared.surfaces.len());
    let mut line_room = LineRoom::for_any(prepared, 50);
    let mut random = Random(0x0bad_cafe);
    let width = rows[0].places.len();
    let mut answers = vec![Vec::new(); rows.len() * width];
    for number in course.over(rows.len(), &mut random) {
        let row = &rows[number];
        let window = Window { x: [-1.0, 1.0].map(P::Scalar::from_f64), y: row.y.map(P::Scalar::from_f64) };
        let mut line = line_room.line(&view, window).expect("there is room for all");
        for k in course.over(width, &mut random) {
            // Never a scan line's number twice, but for repeated lines, whose memory is then as good as any.
            if course.has_rubbish() && index(&mut random, 2) == 0 {
                rubbish::fill(&mut thread, number as u32, &mut random);
            }
            let ray = view.ray(row.places[k].map(P::Scalar::from_f64), &Interval::ahead());
            let answer = ray.map(|ray| thread.trace(method, &view, &mut line, number as u32, &ray, &limits));
            answers[number * width + k].push(answer);
        }
    }
    answers
}

/// How many answers differ from those of a forward course with clean memory; and how many there were.
fn compare<P: Kind>(case: &Case, precision: Precision, acceptance: Acceptance, method: InView) -> [usize; 2] {
    let options = Subdivision { flatness: P::Scalar::from_f64(0.003), ..Subdivision::default() };
    let prepared = Prepared::<P>::new(&case.model, 1.0, &options);
    let judge = Judge::new(case, precision);
    let surfaces = &case.model.surfaces;
    let all = cameras(surfaces).into_iter().step_by(3).chain(inside(surfaces).into_iter().take(1));
    let each = |(k, named): (usize, Named)| {
        let rows = rows(rays_per_case(RAYS), k == 1, 77 + k as u64);
        let rays = ray_lines(&named.camera, &rows);
        let straight = trace(&prepared, &named, &rows, method, Course::Forward, acceptance);
        let mut count = [0; 2];
        for course in OTHERS {
            let others = trace(&prepared, &named, &rows, method, course, acceptance);
            for ((ray, one), others) in rays.iter().zip(&straight).zip(&others) {
                for other in others {
                    let differ = judge.differ(&prepared, method, ray, [&one[0], other]);
                    if differ && count[0] < 3 {
                        println!(
                            "{} {} {course:?} {method:?} {precision:?} {ray:?}: {one:?} {other:?}",
                            case.name, named.name
                        );
                    }
                    count[0] += usize::from(differ);
                    count[1] += 1;
                }
            }
        }
        count
    };
    let all: Vec<_> = all.enumerate().collect();
    all.into_par_iter().map(each).reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

fn suite(acceptance: Acceptance, methods: &[InView]) {
    let mut failures = Vec::new();
    for case in cases() {
        for &method in methods {
            for precision in [Precision::F32, Precision::F64] {
                let [differing, answers] = match (precision, is_rational(&case.model)) {
                    (Precision::F32, false) => compare::<Plain<f32>>(&case, precision, acceptance, method),
                    (Precision::F32, true) => compare::<Weighted<f32>>(&case, precision, acceptance, method),
                    (Precision::F64, false) => compare::<Plain<f64>>(&case, precision, acceptance, method),
                    (Precision::F64, true) => compare::<Weighted<f64>>(&case, precision, acceptance, method),
                };
                let line =
                    format!("{} {method:?} {precision:?} {acceptance:?}: {differing} of {answers} differ", case.name);
                println!("{line}");
                if differing > 0 {
                    failures.push(line);
                }
            }
        }
    }
    assert!(failures.is_empty(), "answers depend on what came before:\n{}", failures.join("\n"));
}

#[test]
fn answers_depend_on_nothing_but_the_ray() {
    suite(Acceptance::Proved, &InView::ALL);
}

#[test]
fn nor_do_those_of_clipping_by_the_papers_rule() {
    suite(Acceptance::Paper, &[InView::ClippingPredicted]);
}

/// How many answers name a surface of the second copy of a model that is there twice; and how many hits there were.
fn second_named<P: Kind>(case: &Case, acceptance: Acceptance, method: By) -> [usize; 2] {
    let options = Subdivision { flatness: P::Scalar::from_f64(0.003), ..Subdivision::default() };
    let twice = Model::numbered(case.model.surfaces.iter().chain(&case.model.surfaces).cloned().collect());
    let prepared = Prepared::<P>::new(&twice, 1.0, &options);
    let first = case.model.surfaces.len();
    let each = |(k, named): (usize, Named)| {
        let rows = rows(rays_per_case(RAYS), k == 1, 77 + k as u64);
        let answers: Vec<_> = match method {
            By::View(method) => {
                let courses = OTHERS.into_iter().chain([Course::Forward]);
                courses
                    .flat_map(|course| trace(&prepared, &named, &rows, method, course, acceptance))
                    .flatten()
                    .collect()
            }
            // What the coherent ones remember of each surface may be of different rays, if other rays came in between.
            By::Rays(method) => {
                let limits = Limits { acceptance, ..Limits::default() };
                one_by_one(&prepared, method, &ray_lines(&named.camera, &rows), &limits)
            }
        };
        let mut count = [0; 2];
        for hit in answers.into_iter().filter_map(|answer| answer.ok()?.ok()?) {
            count[0] += usize::from(hit.surface as usize >= first);
            count[1] += 1;
        }
        count
    };
    let all: Vec<_> = cameras(&case.model.surfaces).into_iter().step_by(3).enumerate().collect();
    all.into_par_iter().map(each).reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

/// Started from what was remembered, the roots of two surfaces that coincide differ by roundings: a picture of them once
/// showed the one or the other, ray by ray.
#[test]
fn of_surfaces_that_coincide_the_first_is_named() {
    let mut failures = Vec::new();
    // Not the coherent one of Newton's: from each surface's own memory it finds the roots of both, which differ by roundings.
    let by_rays = [Method::Newton, Method::Clipping, Method::ClippingCoherent].map(By::Rays);
    for case in cases() {
        for method in InView::ALL.map(By::View).into_iter().chain(by_rays) {
            for acceptance in [Acceptance::Paper, Acceptance::Proved] {
                let of_precisions = if is_rational(&case.model) {
                    [
                        second_named::<Weighted<f32>>(&case, acceptance, method),
                        second_named::<Weighted<f64>>(&case, acceptance, method),
                    ]
                } else {
                    [
                        second_named::<Plain<f32>>(&case, acceptance, method),
                        second_named::<Plain<f64>>(&case, acceptance, method),
                    ]
                };
                for ([second, hits], precision) in of_precisions.into_iter().zip([Precision::F32, Precision::F64]) {
                    println!("{} {method:?} {precision:?} {acceptance:?}: {second} of {hits}", case.name);
                    if second > 0 {
                        failures.push(format!(
                            "{} {method:?} {precision:?} {acceptance:?}: {second} of {hits} hits",
                            case.name
                        ));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "hits of the second copy:\n{}", failures.join("\n"));
}
