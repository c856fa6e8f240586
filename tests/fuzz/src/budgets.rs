//! Budgets from 0 up: a call does no more than they say, and a larger one takes no answer back.

use crate::bytes::Bytes;
use crate::claims::{in_range, within_limits};
use crate::common::Kind;
use crate::input::{Case, OfKind, any_limits, any_subdivision, budgets_of, in_kernel, interval, with_kind};
use crate::lane::{Answer, Lane, Way};
use crate::ready::{Takes, prepare};
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use crate::scribble::scribble;
use patchray::limits::{Limits, Work};
use patchray::line::Window;
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use std::fmt::Debug;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let method = usize::from(bytes.byte()) % (Way::ALL.len() + InView::ALL.len());
    let case = Case::any(&mut bytes, 3);
    match Way::ALL.get(method) {
        Some(&way) => with_kind(&case, bytes, OfNoView(way)),
        None => with_kind(&case, bytes, OfView(InView::ALL[method - Way::ALL.len()])),
    }
}

/// A ray of no view.
struct OfNoView(Way);

impl OfKind for OfNoView {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let OfNoView(way) = self;
        let surfaces = case.model.surfaces.len();
        let Some(prepared) = prepare::<P>(&case.model, &any_subdivision(&mut bytes), way.takes()) else {
            return;
        };
        let line = case.ray(&mut bytes);
        let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
        let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(&line)) else {
            return;
        };
        let mut lane = Lane::<P>::new(surfaces);
        let remembers = matches!(way, Way::NewtonCoherent | Way::NewtonCoherentProving | Way::ClippingCoherent);
        scribble(&mut bytes, &mut lane.remembered);
        let (kept, scan_line) = (lane.remembered.clone(), bytes.count());
        larger_and_smaller(&mut bytes, [interval.min(), interval.max()], surfaces, way, remembers, |limits| {
            lane.remembered.clone_from(&kept);
            let answer = lane.closest(way, &prepared, scan_line, &ray, &interval, limits);
            (answer, lane.work)
        });
    }
}

/// A ray of a view, and one before it on its line, which leaves something to remember.
struct OfView(InView);

impl OfKind for OfView {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let OfView(method) = self;
        let surfaces = case.model.surfaces.len();
        let Some(prepared) = prepare::<P>(&case.model, &any_subdivision(&mut bytes), Takes::IN_VIEW) else {
            return;
        };
        let camera = in_kernel::<P::Scalar>(&case.camera(&mut bytes));
        let Ok(mut room) = ViewRoom::for_view(&prepared, &camera) else {
            return;
        };
        let view = room.build(&prepared, &camera).expect("as was asked for");
        let [before, x, y] = [0; 3].map(|_| P::Scalar::from_f64(f64::from(bytes.byte() as i8) / 128.0));
        let one = P::Scalar::ONE;
        let window = Window { x: [-one, one], y: [y, y] };
        let range = [P::Scalar::ZERO, P::Scalar::INFINITY];
        let (Ok(first), Ok(ray)) = (view.ray([before, y], &Interval::ahead()), view.ray([x, y], &Interval::ahead()))
        else {
            return;
        };
        let mut line_room = LineRoom::for_any(&prepared, 1 + bytes.below(20));
        let mut thread = Thread::<P>::new(surfaces);
        scribble(&mut bytes, &mut thread.followed);
        thread.last = bytes.count();
        let scan_line = bytes.count();
        let mut line = line_room.line(&view, window).expect("as many spans as there can be");
        let _ = thread.trace(method, &view, &mut line, scan_line, &first, &any_limits(&mut bytes));
        let (followed, last) = (thread.followed.clone(), thread.last);
        larger_and_smaller(&mut bytes, range, surfaces, method, true, |limits| {
            thread.followed.clone_from(&followed);
            thread.last = last;
            // The list of a line is of the rays before, too: each call begins with the same.
            let mut line = line_room.line(&view, window).expect("as before");
            let answer = thread.trace(method, &view, &mut line, scan_line, &ray, limits);
            (answer, thread.work)
        });
    }
}

/// Runs a call with some budgets, with others that are smaller by a little or by much, and with others smaller still.
fn larger_and_smaller<S: Scalar>(
    bytes: &mut Bytes<'_>,
    range: [S; 2],
    surfaces: usize,
    method: impl Debug + Copy,
    remembers: bool,
    mut call: impl FnMut(&Limits<S>) -> (Answer<S>, Work),
) {
    let mut limits = any_limits::<S>(bytes);
    let mut larger: Option<(Limits<S>, Work, Answer<S>)> = None;
    for _ in 0..3 {
        let (answer, work) = call(&limits);
        within_limits(&work, &limits, method);
        if let Some(hit) = answer.unwrap_or_else(|gave_up| gave_up.best) {
            in_range(&hit, range, surfaces, (method, &limits));
        }
        if let Some((most, more_work, more)) = larger {
            // With memory a bound may have been met, and the ray searched without it.
            let unbounded = answer.is_ok()
                && (!remembers || (alone(&work, &limits) && most.pending_domains == limits.pending_domains));
            if unbounded {
                // No bound was met, so that a larger one changes nothing at all.
                assert_eq!((more, more_work), (answer, work), "{method:?}: with {most:?}, and with {limits:?}");
            }
            let (more, less) = (more_work.counts(), work.counts());
            let grows = more.iter().zip(less).all(|(&more, less)| less <= more);
            assert!(grows || remembers, "{method:?}: {work:?} of {more_work:?}");
        }
        larger = Some((limits, work, answer));
        for budget in budgets_of(&mut limits) {
            *budget = match bytes.below(4) {
                0 | 1 => *budget,
                2 => budget.saturating_sub(u32::from(bytes.byte())),
                _ => (*budget).min(u32::from(bytes.byte()) / 2),
            };
        }
    }
}

/// Whether every budget was left some of: then no search ran out.
fn alone<S: Scalar>(work: &Work, limits: &Limits<S>) -> bool {
    [
        (work.surfaces_tested, limits.surfaces),
        (work.nodes_visited, limits.nodes),
        (work.patches_tested, limits.patches),
        (work.voxels_visited, limits.voxels),
        (work.spans_visited, limits.spans),
        (work.newton_steps, limits.newton_steps),
        (work.clip_steps, limits.clip_steps),
        (work.bisections, limits.bisections),
    ]
    .iter()
    .all(|(count, budget)| count < budget)
}
