//! Views and their scan lines: any surfaces, cameras, windows and limits, and coherence memory of any bits, through the methods
//! for the rays of a view, one at a time; one that proves what it answers beside its original, which traces ray by ray, both held
//! against the oracle.

use crate::bytes::Bytes;
use crate::claims::{in_range, on_the_ray, within_limits, within_worst_case};
use crate::common::{Kind, Prepared};
use crate::input::{Case, OfKind, any_limits, in_kernel, interval, limits, number, subdivision, with_kind};
use crate::lane::{Lane, Way};
use crate::ready::{Takes, prepare};
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use crate::scribble::scribble;
use crate::truth::{Original, Truth};
use patchray::limits::{Acceptance, Extent, Limits};
use patchray::line::Window;
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray_host::scene::rays::RayLine;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let method = bytes.one_of(&InView::ALL);
    let case = Case::any(&mut bytes, 3);
    with_kind(&case, bytes, Views(method));
}

struct Views(InView);

impl OfKind for Views {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let Views(method) = self;
        let surfaces = case.model.surfaces.len();
        // The original of a method that answers rightly whatever the ray meets, if it is asked to prove it.
        let original = match method {
            InView::NewtonPredicted => None,
            InView::ClippingPredicted => Some(Way::Clipping),
            InView::NewtonPredictedProving => Some(Way::NewtonProving),
        };
        let takes = if original == Some(Way::NewtonProving) { Way::NewtonProving.takes() } else { Takes::IN_VIEW };
        let Some(prepared) = prepare::<P>(&case.model, &subdivision(&mut bytes), takes) else {
            return;
        };
        let camera = case.camera(&mut bytes);
        let in_kernel = in_kernel::<P::Scalar>(&camera);
        // Where all is proved, answers are compared; else all that is asked is that bounds are kept.
        let compared = !bytes.rarely(2) && case.is_tame();
        let limits: Limits<P::Scalar> = if compared {
            Limits { acceptance: Acceptance::Proved, ..limits(&mut bytes) }
        } else {
            any_limits(&mut bytes)
        };
        let side = |bytes: &mut Bytes<'_>| P::Scalar::from_f64(f64::from(bytes.byte() as i8) / 128.0);
        let y = side(&mut bytes);
        let any = !compared && bytes.rarely(4);
        let mut end = || if any { number(&mut bytes) } else { P::Scalar::ONE };
        let window = Window { x: [-end(), end()], y: if any { [end(), end()] } else { [y, y] } };
        let interval = if bytes.rarely(4) { Interval::new(number(&mut bytes), number(&mut bytes)) } else { None };
        let interval = interval.unwrap_or(Interval::ahead());
        let buckets = 1 + bytes.below(20);
        let scan_line = bytes.count();
        let mut places = vec![[side(&mut bytes), y]];
        for _ in 0..bytes.below(4) {
            let [x, _] = places[places.len() - 1];
            let step = f64::from(bytes.byte() as i8) / 1024.0;
            places.push([x + P::Scalar::from_f64(step), y]);
        }
        let mut thread = Thread::<P>::new(surfaces);
        scribble(&mut bytes, &mut thread.followed);
        thread.last = bytes.count();
        let at_hand = camera.eye.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let original = original.filter(|_| compared);
        let Ok(mut room) = ViewRoom::for_view(&prepared, &in_kernel) else {
            return;
        };
        let view = room.build(&prepared, &in_kernel).expect("as was asked for");
        let asked = LineRoom::sized(0, 0).line(&view, window).map(|_| ()).expect_err("buckets are needed");
        let spans = asked.spans.needed;
        let mut line_room = LineRoom::sized(spans, buckets);
        let mut line = line_room.line(&view, window).expect("as was asked for");
        let extent = Extent {
            surfaces: surfaces as u32,
            patches: prepared.patches.len() as u32,
            spans: spans as u32,
            walks: 2,
            clipped: match method {
                InView::NewtonPredicted => false,
                InView::ClippingPredicted => true,
                InView::NewtonPredictedProving => limits.acceptance == Acceptance::Proved,
            },
            ..Extent::default()
        };
        let mut lane = Lane::<P>::new(surfaces);
        for place in places {
            let ray_line = ray_line(&camera, place, &interval);
            let Ok(ray) = view.ray(place, &interval) else {
                continue;
            };
            let kept = (thread.followed.clone(), thread.last);
            let mut trace = |limits: &Limits<P::Scalar>| {
                // Memory as it was: what a search leaves there would help the next.
                thread.followed.clone_from(&kept.0);
                thread.last = kept.1;
                let answer = thread.trace(method, &view, &mut line, scan_line, &ray, limits);
                within_limits(&thread.work, limits, method);
                within_worst_case(&thread.work, limits, &extent, method);
                answer
            };
            let answer = match original {
                Some(original) => {
                    let truth = Truth::new(case, &ray_line, at_hand);
                    let original = alone(&mut lane, original, &prepared, &ray_line, &truth, &limits);
                    truth.judged(&format!("{method:?}"), &limits, original, trace)
                }
                None => trace(&limits),
            };
            if let Some(hit) = answer.unwrap_or_else(|gave_up| gave_up.best) {
                let ahead = interval.min().greater(P::Scalar::ZERO);
                in_range(&hit, [ahead, interval.max()], surfaces, method);
                if case.is_tame() {
                    on_the_ray(&hit, case, &ray_line, &limits, at_hand, method);
                }
            }
        }
    }
}

/// Judges a ray by the original method, which traces it by itself; whether it answers.
fn alone<P: Kind>(
    lane: &mut Lane<P>,
    way: Way,
    prepared: &Prepared<P>,
    line: &RayLine,
    truth: &Truth<'_>,
    limits: &Limits<P::Scalar>,
) -> Original {
    let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
    let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(line)) else {
        return Original::Open;
    };
    let trace = |limits: &Limits<P::Scalar>| lane.closest(way, prepared, 0, &ray, &interval, limits);
    match truth.judged(&format!("{way:?}"), limits, Original::Open, trace) {
        Ok(_) => Original::AnswersRoundedOtherwise,
        Err(_) => Original::Open,
    }
}

/// The ray of a place, as the oracle takes it.
fn ray_line<S: Scalar>(camera: &patchray::view::Camera<f64>, place: [S; 2], interval: &Interval<S>) -> RayLine {
    let [x, y] = place.map(Scalar::to_f64);
    let direction = [0, 1, 2].map(|k| camera.forward[k] + x * camera.right[k] + y * camera.up[k]);
    let (t_min, t_max) = (interval.min().to_f64().max(0.0), interval.max().to_f64());
    RayLine { origin: camera.eye, direction, t_min, t_max, scan_line: 0, valid: true }
}
