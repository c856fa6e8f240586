//! Budgets in a view: never more work than they say, and giving up names the limit and never looks like an answer.

use crate::cameras::{cameras, inside, scaled};
use crate::common::{Kind, Prepared};
use crate::corpus::cases;
use crate::image::rows;
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use patchray::limits::{Extent, GaveUp, Limit, Limits, Work};
use patchray::line::Window;
use patchray::point::{Plain, Weighted};
use patchray::ray::{Hit, Interval};
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::parallelogram;

/// A budget by name: how to set it, and the counter that it bounds.
type Budget<S> = (Limit, fn(&mut Limits<S>, u32), fn(&Work) -> u32);

fn budgets<S: Scalar>() -> [Budget<S>; 5] {
    [
        (Limit::Patches, |l, n| l.patches = n, |w| w.patches_tested),
        (Limit::Spans, |l, n| l.spans = n, |w| w.spans_visited),
        (Limit::NewtonSteps, |l, n| l.newton_steps = n, |w| w.newton_steps),
        (Limit::ClipSteps, |l, n| l.clip_steps = n, |w| w.clip_steps),
        (Limit::Bisections, |l, n| l.bisections = n, |w| w.bisections),
    ]
}

/// Every budget from nothing to enough for some rays; how often each gave up.
fn every_budget<P: Kind>(name: &str) -> [u32; 5] {
    let case = cases().into_iter().find(|case| case.name == name).expect("the corpus has it");
    let prepared = Prepared::<P>::new(
        &case.model,
        1.0,
        &Subdivision { flatness: P::Scalar::from_f64(0.02), ..Default::default() },
    );
    let surfaces = &case.model.surfaces;
    let limits = Limits::<P::Scalar>::default();
    let mut gave_up = [0; 5];
    for named in cameras(surfaces).into_iter().take(2).chain(inside(surfaces).into_iter().take(1)) {
        let camera = scaled(&named.camera, 1.0);
        for method in InView::ALL {
            let mut room = ViewRoom::for_view(&prepared, &camera).unwrap();
            let view = room.build(&prepared, &camera).unwrap();
            for (number, row) in (0..).zip(rows(18, false, 0)) {
                let window = Window { x: [-1.0, 1.0].map(P::Scalar::from_f64), y: row.y.map(P::Scalar::from_f64) };
                let line_room = LineRoom::for_any(&prepared, 12);
                let (mut straight, mut again) = (line_room.clone(), line_room);
                let mut straight = straight.line(&view, window).unwrap();
                let mut thread = Thread::new(surfaces.len());
                let nothing = (thread.followed.clone(), thread.last);
                for place in &row.places {
                    let ray = view.ray(place.map(P::Scalar::from_f64), &Interval::ahead()).unwrap();
                    let memory = (thread.followed.clone(), thread.last);
                    let full = thread.trace(method, &view, &mut straight, number, &ray, &limits);
                    let full = full.expect("the default budgets are far from any ray of these");
                    let after = (thread.followed.clone(), thread.last);
                    for (b, (limit, set, counter)) in budgets::<P::Scalar>().into_iter().enumerate() {
                        // In a line of its own, which counts what building the list takes.
                        let mut run = |small: &Limits<P::Scalar>, memory: &(Vec<_>, _)| {
                            let mut line = again.line(&view, window).unwrap();
                            (thread.followed, thread.last) = memory.clone();
                            let answer = thread.trace(method, &view, &mut line, number, &ray, small);
                            let work = thread.work;
                            // Out of a budget, and then with enough: as if nothing had been.
                            (thread.followed, thread.last) = memory.clone();
                            let then = thread.trace(method, &view, &mut line, number, &ray, &limits);
                            (answer, work, then)
                        };
                        let (answer, used, then) = run(&limits, &memory);
                        assert_eq!([answer, then], [Ok(full); 2]);
                        let needed = counter(&used);
                        let some = (0..needed).step_by((needed as usize / 8).max(1));
                        for n in some.chain([needed.saturating_sub(1), needed, needed + 1]) {
                            let mut small = limits;
                            set(&mut small, n);
                            let (answer, work, then) = run(&small, &memory);
                            assert_eq!(then, Ok(full));
                            // The search that memory led, and the one without.
                            assert!(counter(&work) <= 2 * n, "{limit}: {} of {n}", counter(&work));
                            if n >= needed {
                                assert_eq!((answer, work), (Ok(full), used), "{limit} {n}");
                                continue;
                            }
                            // Short of what the ray needs: without memory it may need less.
                            let (alone, ..) = run(&small, &nothing);
                            if alone.is_ok() {
                                assert!(counter(&work) >= n);
                                // Another start may round otherwise.
                                let t = |answer: &Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>>| {
                                    answer.map(|hit| hit.map(|hit| hit.t.to_f64())).ok()
                                };
                                let near = match (t(&answer), t(&alone)) {
                                    (Some(Some(a)), Some(Some(b))) => {
                                        (a - b).abs() <= 64.0 * P::Scalar::EPSILON.to_f64() * b
                                    }
                                    (a, b) => a == b,
                                };
                                assert!(near, "{method:?} {limit} {n}");
                                continue;
                            }
                            // What memory led into may leave more to the rest than a search without it has.
                            if let Ok(hit) = answer {
                                assert!(counter(&work) > n && hit.is_some() == full.is_some());
                                continue;
                            }
                            let short = answer.expect_err("a budget that is too small is not an answer");
                            assert_eq!(short.limit, limit, "{method:?}");
                            assert!(counter(&work) >= n);
                            gave_up[b] += 1;
                        }
                    }
                    (thread.followed, thread.last) = after;
                }
            }
        }
    }
    gave_up
}

#[test]
fn every_budget_from_nothing_to_enough() {
    for gave_up in [
        every_budget::<Plain<f32>>("teapot"),
        every_budget::<Plain<f64>>("bumpy 5 x 5"),
        every_budget::<Weighted<f64>>("torus"),
    ] {
        println!("gave up on {gave_up:?}");
        assert!(gave_up[..4].iter().all(|&n| n > 20), "{gave_up:?}");
    }
}

/// What a method may do in a scene seen in lines of so many spans.
fn extent<P: Kind>(prepared: &Prepared<P>, method: InView, spans: usize) -> Extent {
    Extent {
        surfaces: prepared.surfaces.len() as u32,
        patches: prepared.patches.len() as u32,
        spans: spans as u32,
        walks: 2,
        clipped: method == InView::ClippingPredicted,
        ..Default::default()
    }
}

/// No ray does more than [`Limits::worst_case`] says, in any counter.
#[test]
fn no_ray_passes_the_worst_case() {
    fn check<P: Kind>(name: &str) {
        let case = cases().into_iter().find(|case| case.name == name).expect("the corpus has it");
        let options = Subdivision { flatness: P::Scalar::from_f64(0.02), ..Default::default() };
        let (prepared, limits) = (Prepared::<P>::new(&case.model, 1.0, &options), Limits::default());
        let surfaces = &case.model.surfaces;
        for named in cameras(surfaces).into_iter().chain(inside(surfaces)) {
            let camera = scaled(&named.camera, 1.0);
            for method in InView::ALL {
                let mut room = ViewRoom::for_view(&prepared, &camera).unwrap();
                let view = room.build(&prepared, &camera).unwrap();
                let mut thread = Thread::new(surfaces.len());
                for (number, row) in (0..).zip(rows(80, true, 0)) {
                    let window = Window { x: [-1.0, 1.0].map(P::Scalar::from_f64), y: row.y.map(P::Scalar::from_f64) };
                    let spans = LineRoom::sized(0, 0).line(&view, window).map(|_| ()).unwrap_err().spans.needed;
                    let worst = limits.worst_case(&extent(&prepared, method, spans)).counts();
                    let mut line_room = LineRoom::for_any(&prepared, 12);
                    let mut line = line_room.line(&view, window).unwrap();
                    for place in &row.places {
                        let ray = view.ray(place.map(P::Scalar::from_f64), &Interval::ahead()).unwrap();
                        let _ = thread.trace(method, &view, &mut line, number, &ray, &limits);
                        for (k, (count, worst)) in thread.work.counts().into_iter().zip(worst).enumerate() {
                            assert!(count <= worst, "{method:?} {}: {count} of {worst}", Work::NAMES[k]);
                        }
                    }
                }
            }
        }
    }
    check::<Plain<f32>>("teapot");
    check::<Plain<f64>>("bumpy 2 x 12");
    check::<Weighted<f64>>("torus");
}

/// A tower of sheets across the ray, farthest first: each span comes into the list before all others.
#[test]
fn the_worst_case_of_spans_is_come_near() {
    let mut nearest = 0.0_f64;
    for count in [1, 2, 5, 40, 300] {
        let at = |k: i32| if count == 1 { 0.0 } else { f64::from(k) / f64::from(count) };
        let sheets = (0..count).map(|k| parallelogram([-0.5, -0.5, at(k)], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
        let prepared = Prepared::<Plain<f64>>::of(&Model::numbered(sheets.collect()));
        // From above and from below, so that one of the two is the worst order.
        for eye in [4.0, -4.0] {
            let camera = patchray::view::Camera {
                eye: [0.1, 0.05, eye],
                forward: [0.0, 0.0, -eye],
                right: [1.0, 0.0, 0.0],
                up: [0.0, 1.0, 0.0],
            };
            for method in InView::ALL {
                let mut room = ViewRoom::for_view(&prepared, &camera).unwrap();
                let view = room.build(&prepared, &camera).unwrap();
                let mut line_room = LineRoom::for_any(&prepared, 1);
                let mut line = line_room.line(&view, Window { x: [0.0, 0.0], y: [0.0, 0.0] }).unwrap();
                // Beside all sheets but within their outlines would be worse still; behind them is as far as a ray goes here.
                let beyond = Interval::new(100.0, 200.0).unwrap();
                let ray = view.ray([0.0, 0.0], &beyond).unwrap();
                let mut thread = Thread::new(prepared.surfaces.len());
                let answer = thread.trace(method, &view, &mut line, 0, &ray, &Limits::default());
                assert_eq!(answer, Ok(None), "{method:?}");
                let worst = Limits::<f64>::default().worst_case(&extent(&prepared, method, count as usize));
                let (spans, most) = (thread.work.spans_visited, worst.spans_visited);
                println!("{count} sheets from {eye}, {method:?}: {spans} of {most}");
                assert!(spans <= most);
                nearest = nearest.max(f64::from(spans) / f64::from(most));
            }
        }
    }
    println!("{nearest} of the worst case");
    assert!(nearest > 0.98);
}
