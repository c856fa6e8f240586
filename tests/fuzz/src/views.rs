//! Views and their scan lines: any surfaces, cameras, windows and limits, and coherence memory of any bits, through the methods
//! for the rays of a view, one at a time; one that proves what it answers beside its original, both held against the oracle.

use crate::bytes::Bytes;
use crate::claims::{in_range, on_the_ray, within_limits, within_worst_case};
use crate::common::Kind;
use crate::input::{Case, OfKind, any_limits, in_kernel, limits, number, subdivision, with_kind};
use crate::ready::{Takes, prepare};
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use crate::scribble::scribble;
use crate::truth::Truth;
use patchray::limits::{Acceptance, Extent, Limits};
use patchray::line::Window;
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Method;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let method = bytes.one_of(&InView::ALL);
    let case = Case::any(&mut bytes, 3);
    with_kind(&case, bytes, Views(method));
}

struct Views(InView);

/// Whether a method answers rightly whatever the ray meets, as far as numbers can tell, if it is asked to prove it.
fn proves(method: InView) -> bool {
    !matches!(method, InView::Newton | InView::NewtonCoherent | InView::NewtonPredicted)
}

impl OfKind for Views {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let Views(method) = self;
        let surfaces = case.model.surfaces.len();
        let Some(prepared) = prepare::<P>(&case.model, &subdivision(&mut bytes), Takes::in_view(method)) else {
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
        scribble(&mut bytes, &mut thread.remembered);
        scribble(&mut bytes, &mut thread.followed);
        thread.last = bytes.count();
        let at_hand = camera.eye.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let lines: Vec<_> = places.iter().map(|&place| ray_line(&camera, place, &interval)).collect();
        let proving = compared && proves(method);
        let truths: Vec<_> = lines.iter().filter(|_| proving).map(|line| Truth::new(case, line, at_hand)).collect();
        // Which of the rays the original answers, for the method that is made of it.
        let mut answered = vec![false; places.len()];
        let both = [original(method).unwrap_or(InView::ClippingBare), method];
        for &method in if proving { &both[..] } else { &both[1..] } {
            let Ok(mut room) = ViewRoom::for_view(&prepared, method.has_patches(), &in_kernel) else {
                return;
            };
            let view = room.build(&prepared, method.has_patches(), &in_kernel).expect("as was asked for");
            let asked = LineRoom::sized(0, 0).line(&view, method, window).map(|_| ()).expect_err("buckets are needed");
            let spans = asked.spans.needed;
            let mut line_room = LineRoom::sized(spans, buckets);
            let mut line = line_room.line(&view, method, window).expect("as was asked for");
            let clips = matches!(method.judged_as(), Method::Clipping | Method::ClippingCoherent);
            let extent = Extent {
                surfaces: surfaces as u32,
                patches: if method.has_patches() { prepared.patches.len() as u32 } else { 0 },
                spans: spans as u32,
                walks: if method.remembers() { 2 } else { 0 },
                clipped: clips || method.falls_back() && limits.acceptance == Acceptance::Proved,
                ..Extent::default()
            };
            for (k, (&place, ray_line)) in places.iter().zip(&lines).enumerate() {
                let Ok(ray) = view.ray(place, &interval) else {
                    continue;
                };
                let kept = (thread.remembered.clone(), thread.followed.clone(), thread.last);
                let mut trace = |limits: &Limits<P::Scalar>| {
                    // Memory as it was: what a search leaves there would help the next.
                    thread.remembered.clone_from(&kept.0);
                    thread.followed.clone_from(&kept.1);
                    thread.last = kept.2;
                    let answer = thread.trace(method, &view, &mut line, scan_line, &ray, limits);
                    within_limits(&thread.work, limits, method);
                    within_worst_case(&thread.work, limits, &extent, method);
                    answer
                };
                let answer = match truths.get(k) {
                    Some(truth) => {
                        let bound = answered[k] && original(method).is_some();
                        truth.judged(&format!("{method:?}"), &limits, bound, trace)
                    }
                    None => trace(&limits),
                };
                answered[k] = answer.is_ok();
                if let Some(hit) = answer.unwrap_or_else(|gave_up| gave_up.best) {
                    let ahead = interval.min().greater(P::Scalar::ZERO);
                    in_range(&hit, [ahead, interval.max()], surfaces, method);
                    if case.is_tame() {
                        on_the_ray(&hit, case, ray_line, &limits, at_hand, method);
                    }
                }
            }
        }
    }
}

/// The method without memory that a coherent or predicted one is made of.
fn original(method: InView) -> Option<InView> {
    match method {
        InView::NewtonCoherent | InView::NewtonPredicted => Some(InView::Newton),
        InView::ClippingCoherent | InView::ClippingPredicted => Some(InView::Clipping),
        InView::NewtonCoherentProving | InView::NewtonPredictedProving => Some(InView::NewtonProving),
        _ => None,
    }
}

/// The ray of a place, as the oracle takes it.
fn ray_line<S: Scalar>(camera: &patchray::view::Camera<f64>, place: [S; 2], interval: &Interval<S>) -> RayLine {
    let [x, y] = place.map(Scalar::to_f64);
    let direction = [0, 1, 2].map(|k| camera.forward[k] + x * camera.right[k] + y * camera.up[k]);
    let (t_min, t_max) = (interval.min().to_f64().max(0.0), interval.max().to_f64());
    RayLine { origin: camera.eye, direction, t_min, t_max, scan_line: 0, valid: true }
}
