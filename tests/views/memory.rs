//! Memory of views and lines: what asking says is enough, one slot less says all that is missing, rubbish changes nothing.

use crate::cameras::{cameras, inside, scaled};
use crate::common::{Kind, Prepared, is_rational};
use crate::corpus::cases;
use crate::image::rows;
use crate::rooms::{InView, LineRoom, Thread, ViewRoom, slots};
use patchray::arena::Need;
use patchray::limits::Limits;
use patchray::line::{LineNeeds, Window};
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray::view::{Camera, RUN, View, ViewError, ViewNeeds, ViewRay};
use patchray_host::scene::model::Model;

fn coarse<P: Kind>(model: &Model) -> Prepared<P> {
    Prepared::new(model, 1.0, &Subdivision { flatness: P::Scalar::from_f64(0.005), ..Subdivision::default() })
}

/// The corpus, one model after another, and the first of its cameras and one inside.
fn each<P: Kind>(rational: bool, mut with: impl FnMut(&Prepared<P>, &Camera<P::Scalar>)) {
    for case in cases().iter().filter(|case| is_rational(&case.model) == rational) {
        let prepared = coarse::<P>(&case.model);
        let surfaces = &case.model.surfaces;
        for named in cameras(surfaces).into_iter().take(1).chain(inside(surfaces).into_iter().take(1)) {
            with(&prepared, &scaled(&named.camera, 1.0));
        }
    }
}

/// One slot less of each kind in turn.
fn one_less<const N: usize>(sizes: [usize; N]) -> impl Iterator<Item = [usize; N]> {
    let some = move |k: &usize| sizes[*k] > 0;
    (0..N).filter(some).map(move |k| core::array::from_fn(|i| sizes[i] - usize::from(i == k)))
}

#[test]
fn a_view_needs_what_it_says() {
    fn check<P: Kind>(prepared: &Prepared<P>, camera: &Camera<P::Scalar>) {
        let build = |sizes: [usize; 6]| {
            let mut room = ViewRoom::<P>::sized(sizes);
            room.build(prepared, camera).map(|_| ())
        };
        let Err(ViewError::Memory(needs)) = build([0; 6]) else { panic!("a view needs memory") };
        let sizes = slots(&needs);
        let (patches, surfaces) = (prepared.patches.len(), prepared.surfaces.len());
        let runs: usize = prepared.first.windows(2).map(|ends| ((ends[1] - ends[0]) as usize).div_ceil(RUN)).sum();
        assert_eq!(sizes, [prepared.points.len(), surfaces, patches, patches, runs, surfaces + 1]);
        assert_eq!(build(sizes), Ok(()));
        assert_eq!(build(sizes.map(|n| n + 3)), Ok(()));
        for given in one_less(sizes).chain([[0; 6]]) {
            let [points, surfaces, patches, sights, runs, first_runs] =
                core::array::from_fn(|k| Need { needed: sizes[k], given: given[k] });
            let needs = ViewNeeds { points, surfaces, patches, sights, runs, first_runs };
            assert_eq!(build(given), Err(ViewError::Memory(needs)));
        }
    }
    each::<Plain<f32>>(false, check);
    each::<Plain<f64>>(false, check);
    each::<Weighted<f32>>(true, check);
}

#[test]
fn a_line_needs_what_it_says() {
    fn check<P: Kind>(prepared: &Prepared<P>, camera: &Camera<P::Scalar>) {
        let mut room = ViewRoom::for_view(prepared, camera).unwrap();
        let view = room.build(prepared, camera).unwrap();
        for row in rows(100, true, 1) {
            let window = Window { x: [-0.7, 1.0].map(P::Scalar::from_f64), y: row.y.map(P::Scalar::from_f64) };
            let build = |[spans, active, buckets]: [usize; 3]| {
                let mut room = LineRoom::sized(spans, buckets);
                room.active.resize(active, 0);
                room.line(&view, window).map(|_| ())
            };
            let needs = build([0; 3]).expect_err("a line needs a bucket");
            let sizes = [needs.spans, needs.active, needs.buckets].map(|need| need.needed);
            assert!(sizes[0] <= prepared.patches.len() && sizes[1..] == [sizes[0], 1], "{sizes:?}");
            assert_eq!(build(sizes), Ok(()));
            assert_eq!(build(sizes.map(|n| n + 3)), Ok(()));
            for given in one_less(sizes) {
                let [spans, active, buckets] = core::array::from_fn(|k| Need { needed: sizes[k], given: given[k] });
                assert_eq!(build(given), Err(LineNeeds { spans, active, buckets }));
            }
        }
    }
    each::<Plain<f32>>(false, check);
    each::<Weighted<f64>>(true, check);
}

/// Slots that another view filled: all wrong at once.
#[test]
fn what_was_in_the_slots_changes_nothing() {
    fn check<P: Kind>(prepared: &Prepared<P>, camera: &Camera<P::Scalar>) {
        let whole = Interval::ahead();
        let mut clean = ViewRoom::for_view(prepared, camera).unwrap();
        let mut dirty = clean.clone();
        let elsewhere =
            Camera { eye: camera.eye.map(|c| c * P::Scalar::HALF), right: camera.up, up: camera.right, ..*camera };
        dirty.build(prepared, &elsewhere).unwrap();
        dirty.patches.rotate_left(1);
        dirty.points.reverse();
        dirty.sights.reverse();
        dirty.first_runs.fill(u32::MAX);
        dirty.runs.fill([P::Scalar::from_f64(f64::NAN); 2]);
        clean.build(prepared, camera).unwrap();
        dirty.build(prepared, camera).unwrap();
        assert_eq!((&clean.points, &clean.surfaces, &clean.patches), (&dirty.points, &dirty.surfaces, &dirty.patches));
        assert_eq!((&clean.sights, &clean.runs, &clean.first_runs), (&dirty.sights, &dirty.runs, &dirty.first_runs));
        let view: View<'_, P> = clean.build(prepared, camera).unwrap();
        let mut used = LineRoom::for_any(prepared, 20);
        for row in rows(60, false, 0) {
            // Each bucket, and each place in the list, names a span that is not there, or another one.
            used.buckets.fill(row.places.len() as u32 * 7);
            used.active.fill(u32::MAX - 1);
            let window = Window { x: [-1.0, 1.0].map(P::Scalar::from_f64), y: row.y.map(P::Scalar::from_f64) };
            let mut fresh = LineRoom::for_any(prepared, 20);
            let mut fresh = fresh.line(&view, window).unwrap();
            let mut used = used.line(&view, window).unwrap();
            let (mut one, mut other) = (Thread::new(prepared.surfaces.len()), Thread::new(prepared.surfaces.len()));
            for place in row.places {
                let ray = view.ray(place.map(P::Scalar::from_f64), &whole).unwrap();
                let limits = Limits::default();
                let one_answer = one.trace(InView::NewtonPredicted, &view, &mut fresh, 0, &ray, &limits);
                let other_answer = other.trace(InView::NewtonPredicted, &view, &mut used, 0, &ray, &limits);
                assert_eq!((one_answer, one.work), (other_answer, other.work));
            }
        }
    }
    each::<Plain<f32>>(false, check);
    each::<Weighted<f64>>(true, check);
}

/// Coherence memory of fewer slots than surfaces is told apart from a miss, and so is a ray of another line, or scratch
/// that is too small.
#[test]
fn what_is_missing_is_named() {
    use patchray::limits::Limit;
    let case = &cases()[0];
    let prepared = coarse::<Plain<f64>>(&case.model);
    let camera = cameras(&case.model.surfaces)[0].camera;
    for method in InView::ALL {
        let mut room = ViewRoom::for_view(&prepared, &camera).unwrap();
        let view = room.build(&prepared, &camera).unwrap();
        let mut line_room = LineRoom::for_any(&prepared, 20);
        let mut line = line_room.line(&view, Window { x: [-0.5, 0.5], y: [0.0, 0.0] }).unwrap();
        let ray = |place| view.ray(place, &Interval::ahead()).unwrap();
        let limit = |slots, ray: ViewRay<f64>, line: &mut _| {
            let mut thread = Thread::new(slots);
            thread.trace(method, &view, line, 0, &ray, &Limits::default()).err().map(|gave_up| gave_up.limit)
        };
        assert_eq!(limit(32, ray([0.0, 0.0]), &mut line), None);
        assert_eq!(limit(0, ray([0.0, 0.0]), &mut line), Some(Limit::Memory), "{method:?}");
        for elsewhere in [[0.0, 0.1], [0.0, -0.1], [0.51, 0.0], [-0.51, 0.0]] {
            assert_eq!(limit(32, ray(elsewhere), &mut line), Some(Limit::Line), "{method:?}");
        }
        // And after that as before.
        assert_eq!(limit(32, ray([0.0, 0.0]), &mut line), None);
    }
}
