//! Cameras and windows that no one means: refused by name, or answered right; never a panic, never a wrong answer.

use crate::agree::one_by_one;
use crate::cameras::{cameras, inside, looking, scaled};
use crate::common::{Kind, Prepared, add, is_rational};
use crate::compare::Judge;
use crate::corpus::{Case, cases};
use crate::image::{Row, ray_lines, rows, trace};
use crate::rooms::{Answer, InView, LineRoom, Thread, ViewRoom};
use patchray::limits::{Acceptance, Limit, Limits};
use patchray::line::Window;
use patchray::point::{Plain, Weighted};
use patchray::ray::{Interval, RayError};
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray::view::Camera;
use patchray_host::scene::trace::{Method, Precision};

fn coarse<P: Kind>(case: &Case) -> Prepared<P> {
    Prepared::new(&case.model, 1.0, &Subdivision { flatness: P::Scalar::from_f64(0.003), ..Subdivision::default() })
}

fn case(name: &str) -> Case {
    cases().into_iter().find(|case| case.name == name).expect("the corpus has it")
}

/// The same image by vectors whose lengths differ by any power of two: x and y, and so all places, are times its inverse.
fn any_length<P: Kind>(case: &Case, exponents: &[i32]) {
    let prepared = coarse::<P>(case);
    let camera = scaled::<P::Scalar>(&cameras(&case.model.surfaces)[0].camera, 1.0);
    let rows = rows(120, false, 0);
    for method in [InView::ClippingPredicted, InView::NewtonPredicted] {
        let run = |across: i32| {
            let by = |v: [P::Scalar; 3]| v.map(|c| c.times_power_of_two(across));
            let camera = Camera { right: by(camera.right), up: by(camera.up), ..camera };
            let scale = |c: f64| P::Scalar::from_f64(c).times_power_of_two(-across);
            let mut room = ViewRoom::for_view(&prepared, &camera).ok()?;
            let view = room.build(&prepared, &camera).ok()?;
            let mut thread = Thread::new(prepared.surfaces.len());
            let mut answers = Vec::new();
            for Row { y, places } in &rows {
                let window = Window { x: [-1.0, 1.0].map(scale), y: y.map(scale) };
                let mut line_room = LineRoom::for_any(&prepared, 9);
                let mut line = line_room.line(&view, window).unwrap();
                for place in places {
                    let ray = view.ray(place.map(scale), &Interval::ahead()).unwrap();
                    answers.push(thread.trace(method, &view, &mut line, 0, &ray, &Limits::default()));
                }
            }
            Some(answers)
        };
        let plain = run(0).unwrap();
        for &exponent in exponents {
            // A view that is refused is not wrong.
            let Some(answers) = run(exponent) else { continue };
            // What coherence predicts rounds otherwise where rates leave the type, and roots with it.
            let same = |one: &Answer<P::Scalar>, other: &Answer<P::Scalar>| match (one, other) {
                (Ok(Some(one)), Ok(Some(other))) => (one.t.to_f64() / other.t.to_f64() - 1.0).abs() < 1e-5,
                _ => one == other,
            };
            let differing = plain.iter().zip(&answers).filter(|(one, other)| !same(one, other)).count();
            assert_eq!(differing, 0, "{} {method:?}: across times 2^{exponent}", case.name);
        }
    }
}

#[test]
fn vectors_of_any_length_make_the_same_image() {
    for case in [case("teapot"), case("bumpy 5 x 5")] {
        any_length::<Plain<f32>>(&case, &[-120, -80, -60, -40, -20, 20, 40, 60, 80]);
        any_length::<Plain<f64>>(&case, &[-1000, -500, -300, 300, 500]);
    }
}

#[test]
fn nor_do_very_short_ones_lose_hits() {
    for case in [case("teapot"), case("bumpy 5 x 5")] {
        any_length::<Plain<f32>>(&case, &[-66, -69, -72, -74]);
        any_length::<Plain<f64>>(&case, &[-515, -525, -535]);
    }
}

/// Images a millionth wide, as wide as a view may be, and from an eye next to a surface.
#[test]
fn fields_of_any_width_and_eyes_near_a_surface() {
    fn check<P: Kind>(case: &Case, precision: Precision) {
        let prepared = coarse::<P>(case);
        let judge = Judge::new(case, precision);
        let bounds = case.model.control_box().unwrap();
        let centre: [f64; 3] = core::array::from_fn(|k| (bounds.min[k] + bounds.max[k]) / 2.0);
        let from = |distance: f64| add(centre, distance * bounds.diagonal(), [0.5, -0.7, 0.5]);
        let point = case.model.surfaces[0].points[0];
        let corner = [point[0], point[1], point[2]];
        let all = [
            ("a millionth", looking(from(1.5), centre, 1e-6)),
            ("all", looking(from(1.5), centre, 0.999)),
            ("near a surface", looking(add(corner, 1e-3, [0.4, 0.3, -0.6]), centre, 0.7)),
            ("very near a surface", looking(add(corner, 1e-6, [0.4, 0.3, -0.6]), centre, 0.7)),
            ("on a surface", looking(corner, centre, 0.7)),
        ];
        for (name, camera) in all {
            let rows = rows(200, false, 0);
            let rays = ray_lines(&camera, &rows);
            for method in InView::ALL {
                // Of two roots on one patch, one of them the eye, Newton's method finds one or the other.
                if name == "on a surface" && method.judged_as() == Method::NewtonCoherent {
                    continue;
                }
                let limits = Limits { acceptance: Acceptance::Proved, ..Limits::default() };
                let in_view = trace(&prepared, &scaled(&camera, 1.0), &rows, method, &limits);
                let alone = one_by_one(&prepared, method.judged_as(), &rays, &limits);
                for ((ray, one), other) in rays.iter().zip(&alone).zip(&in_view) {
                    let differ = judge.differ(&prepared, method, ray, [one, other]);
                    let place = format!("{} {name} {method:?} {precision:?} {ray:?}", case.name);
                    assert!(!differ, "{place}: {one:?} by itself, {other:?} in a view");
                }
            }
        }
    }
    for case in cases() {
        if is_rational(&case.model) {
            check::<Weighted<f32>>(&case, Precision::F32);
            check::<Weighted<f64>>(&case, Precision::F64);
        } else {
            check::<Plain<f32>>(&case, Precision::F32);
            check::<Plain<f64>>(&case, Precision::F64);
        }
    }
}

/// Vectors that all but lie in a plane, up to where the view refuses them: a row and the whole image agree on where things are.
#[test]
fn all_but_flat_cameras() {
    fn check<P: Kind>(case: &Case, tilts: &[f64]) {
        let prepared = coarse::<P>(case);
        let straight = cameras(&case.model.surfaces)[0].camera;
        let mut refused = 0;
        for &tilt in tilts {
            // `right` leans so far along `forward`, or against it, that only this share of it goes across.
            for lean in [1.0, -1.0] {
                let right = add(straight.right.map(|c| c * tilt), lean, straight.forward);
                let camera = scaled::<P::Scalar>(&Camera { right, ..straight }, 1.0);
                let Ok(mut room) = ViewRoom::for_view(&prepared, &camera) else {
                    refused += 1;
                    continue;
                };
                let view = room.build(&prepared, &camera).unwrap();
                let (mut one, mut other) = (Thread::new(prepared.surfaces.len()), Thread::new(prepared.surfaces.len()));
                let mut differing = 0;
                let all = [P::Scalar::LEAST, P::Scalar::INFINITY];
                let (mut first, mut second) = (LineRoom::for_any(&prepared, 1), LineRoom::for_any(&prepared, 9));
                let mut of_image = first.line(&view, Window { x: all, y: all }).unwrap();
                for k in -40..=40 {
                    let y = P::Scalar::from_f64(f64::from(k) / 50.0);
                    let window = Window { x: [-P::Scalar::ONE, P::Scalar::ONE], y: [y, y] };
                    let mut of_row = second.line(&view, window).unwrap();
                    for j in -100..=100 {
                        let x = P::Scalar::from_f64(f64::from(j) / 100.0);
                        let Ok(ray) = view.ray([x, y], &Interval::ahead()) else { continue };
                        let limits = Limits::default();
                        let clipped = one.trace(InView::ClippingPredicted, &view, &mut of_image, 0, &ray, &limits);
                        let solved = other.trace(InView::NewtonPredicted, &view, &mut of_row, 0, &ray, &limits);
                        let kinds = [clipped.unwrap().is_some(), solved.unwrap().is_some()];
                        differing += u32::from(kinds[0] != kinds[1]);
                    }
                }
                assert!(differing <= 2, "{}: {tilt:e} {lean}: {differing} differ", case.name);
            }
        }
        assert!(refused > 0);
    }
    check::<Plain<f32>>(&case("teapot"), &[0.3, 0.03, 3e-3, 1e-3, 5e-4, 1e-4, 1e-5]);
    check::<Plain<f64>>(&case("teapot"), &[0.3, 3e-3, 1e-6, 1e-10, 3e-12, 1e-13]);
}

/// Windows of NaN, infinite, empty, the wrong way round: a ray outside is told apart from a miss, one inside is answered.
#[test]
fn windows_of_any_numbers() {
    let case = case("bumpy 5 x 5");
    let prepared = coarse::<Plain<f64>>(&case);
    let camera = cameras(&case.model.surfaces)[0].camera;
    let (nan, infinite, tiny) = (f64::NAN, f64::INFINITY, f64::from_bits(1));
    for method in InView::ALL {
        let mut room = ViewRoom::for_view(&prepared, &camera).unwrap();
        let view = room.build(&prepared, &camera).unwrap();
        let expected = {
            let mut line_room = LineRoom::for_any(&prepared, 9);
            let window = Window { x: [-1.0, 1.0], y: [0.0, 0.0] };
            let mut line = line_room.line(&view, window).unwrap();
            let ray = view.ray([0.0, 0.0], &Interval::ahead()).unwrap();
            Thread::new(1).trace(method, &view, &mut line, 0, &ray, &Limits::default())
        };
        assert!(matches!(expected, Ok(Some(_))));
        for buckets in [1, 2, 5000] {
            for (x, y, covers) in [
                ([-1.0, 1.0], [0.0, 0.0], true),
                ([0.0, 0.0], [0.0, 0.0], true),
                ([-0.0, 0.0], [-0.0, -0.0], true),
                ([-tiny, tiny], [-tiny, tiny], true),
                ([-infinite, infinite], [-infinite, infinite], true),
                ([-infinite, 0.0], [0.0, infinite], true),
                ([f64::MIN, f64::MAX], [f64::MIN, f64::MAX], true),
                ([nan, 1.0], [0.0, 0.0], false),
                ([-1.0, nan], [0.0, 0.0], false),
                ([-1.0, 1.0], [nan, nan], false),
                ([1.0, -1.0], [0.0, 0.0], false),
                ([0.1, 0.2], [0.0, 0.0], false),
                ([-1.0, 1.0], [0.1, infinite], false),
            ] {
                let mut line_room = LineRoom::for_any(&prepared, buckets);
                let mut line = line_room.line(&view, Window { x, y }).unwrap();
                let ray = view.ray([0.0, 0.0], &Interval::ahead()).unwrap();
                let answer = Thread::new(1).trace(method, &view, &mut line, 0, &ray, &Limits::default());
                if covers {
                    assert_eq!(answer, expected, "{method:?} {x:?} {y:?}");
                } else {
                    assert_eq!(answer.unwrap_err().limit, Limit::Line, "{method:?} {x:?} {y:?}");
                }
            }
        }
        for place in [[nan, 0.0], [0.0, nan], [infinite, 0.0], [0.0, -infinite], [f64::MAX, 0.0]] {
            assert_eq!(view.ray(place, &Interval::ahead()).err(), Some(RayError::OutOfView));
        }
    }
}

/// The interval is kept to at both its ends, and what lies behind the eye is no hit even where t may be negative.
#[test]
fn intervals_are_kept_to() {
    let case = case("sphere");
    let prepared = coarse::<Weighted<f64>>(&case);
    let camera = cameras(&case.model.surfaces)[0].camera;
    for method in InView::ALL {
        let mut room = ViewRoom::for_view(&prepared, &camera).unwrap();
        let view = room.build(&prepared, &camera).unwrap();
        let mut line_room = LineRoom::for_any(&prepared, 9);
        let mut line = line_room.line(&view, Window { x: [-1.0, 1.0], y: [0.0, 0.0] }).unwrap();
        let mut closest = |min: f64, max: f64| {
            let ray = view.ray([0.1, 0.0], &Interval::new(min, max).unwrap()).unwrap();
            let answer =
                Thread::new(prepared.surfaces.len()).trace(method, &view, &mut line, 0, &ray, &Limits::default());
            answer.unwrap().map(|hit| hit.t)
        };
        let front = closest(0.0, f64::INFINITY).unwrap();
        let back = closest(front + 1e-9, f64::INFINITY).unwrap();
        assert!(back > front + 1e-3, "{method:?}");
        assert_eq!(closest(f64::NEG_INFINITY, f64::INFINITY), Some(front));
        assert_eq!(closest(f64::NEG_INFINITY, -1e-9), None);
        assert_eq!(closest(0.0, front - 1e-9), None);
        assert_eq!(closest(front + 1e-9, back - 1e-9), None);
        assert_eq!(closest(back + 1e-9, f64::INFINITY), None);
        assert!(closest(front - 1e-9, front + 1e-9).is_some() && closest(back - 1e-9, back + 1e-9).is_some());
    }
}

/// From inside, at the flatness that is the default, within the budgets that are.
#[test]
fn an_eye_inside_a_model_of_many_patches_is_answered() {
    let case = case("teapot");
    let prepared = Prepared::<Plain<f64>>::of(&case.model);
    let camera = inside(&case.model.surfaces)[0].camera;
    for method in InView::ALL {
        let answers = trace(&prepared, &camera, &rows(20, false, 0), method, &Limits::default());
        let gave_up = answers.iter().filter(|seen| matches!(seen, Ok(Err(_)))).count();
        assert_eq!(gave_up, 0, "{method:?}: {gave_up} of {}: {:?}", answers.len(), answers[0]);
    }
}
