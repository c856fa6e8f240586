//! Prepared tables of any bits: no panic, no work beyond the limits, by one method or another.

use crate::bytes::Bytes;
use crate::claims::within_limits;
use crate::common::{Kind, Prepared};
use crate::input::{Case, any_limits, in_kernel, interval, subdivision};
use crate::lane::{Lane, Way};
use crate::ready::{Takes, prepare};
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use crate::scribble::{Slot, scribble};
use patchray::limits::Limits;
use patchray::line::Window;
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::view::Camera;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let method = usize::from(bytes.byte()) % (Way::ALL.len() + InView::ALL.len());
    let case = Case::tame(&mut bytes, 3, 6);
    match (case.precision, case.weighted) {
        (Precision::F64, false) => any_bits::<Plain<f64>>(&case, method, bytes),
        (Precision::F32, false) => any_bits::<Plain<f32>>(&case, method, bytes),
        (Precision::F64, true) => any_bits::<Weighted<f64>>(&case, method, bytes),
        (Precision::F32, true) => any_bits::<Weighted<f32>>(&case, method, bytes),
    }
}

/// By a method of `Way::ALL`, or of those in a view.
fn any_bits<P: Kind + Slot>(case: &Case, method: usize, mut bytes: Bytes<'_>) {
    let way = Way::ALL.get(method).copied();
    let in_view = InView::ALL[method.saturating_sub(Way::ALL.len())];
    let takes = way.map_or(Takes::IN_VIEW, Way::takes);
    let Some(mut prepared) = prepare::<P>(&case.model, &subdivision(&mut bytes), takes) else {
        return;
    };
    let line = case.ray(&mut bytes);
    let limits = any_limits::<P::Scalar>(&mut bytes);
    let camera = in_kernel::<P::Scalar>(&case.camera(&mut bytes));
    let Prepared {
        header,
        points,
        surfaces,
        offsets,
        references,
        patches,
        first,
        nodes,
        links,
        grids,
        grid_offsets,
        grid_references,
    } = &mut prepared;
    for _ in 0..1 + bytes.below(4) {
        match bytes.below(12) {
            0 => scribble(&mut bytes, std::slice::from_mut(header)),
            1 => scribble(&mut bytes, points),
            2 => scribble(&mut bytes, surfaces),
            3 => scribble(&mut bytes, offsets),
            4 => scribble(&mut bytes, references),
            5 => scribble(&mut bytes, patches),
            6 => scribble(&mut bytes, first),
            7 => scribble(&mut bytes, nodes),
            8 => scribble(&mut bytes, links),
            9 => scribble(&mut bytes, grids),
            10 => scribble(&mut bytes, grid_offsets),
            _ => scribble(&mut bytes, grid_references),
        }
    }
    match way {
        Some(way) => of_no_view(way, &prepared, &line, &limits, case.model.surfaces.len()),
        None => of_view(in_view, &prepared, &camera, &limits, case.model.surfaces.len()),
    }
}

fn of_no_view<P: Kind>(way: Way, prepared: &Prepared<P>, line: &RayLine, limits: &Limits<P::Scalar>, surfaces: usize) {
    let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
    let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(line)) else {
        return;
    };
    let mut lane = Lane::<P>::new(surfaces);
    // Twice, so that the coherent ones have something to remember.
    for _ in 0..2 {
        let _ = lane.closest(way, prepared, 1, &ray, &interval, limits);
        within_limits(&lane.work, limits, way);
    }
    if let Some(lists) = lane.all_and_any(way, prepared, &ray, &interval, limits) {
        lists.work.iter().for_each(|work| within_limits(work, limits, way));
    }
}

fn of_view<P: Kind>(
    method: InView,
    prepared: &Prepared<P>,
    camera: &Camera<P::Scalar>,
    limits: &Limits<P::Scalar>,
    surfaces: usize,
) {
    let Ok(mut room) = ViewRoom::for_view(prepared, camera) else {
        return;
    };
    let Ok(view) = room.build(prepared, camera) else {
        return;
    };
    let one = P::Scalar::ONE;
    let window = Window { x: [-one, one], y: [P::Scalar::ZERO; 2] };
    let mut line_room = LineRoom::for_any(prepared, 5);
    let Ok(mut line) = line_room.line(&view, window) else {
        return;
    };
    let mut thread = Thread::<P>::new(surfaces);
    for x in [-0.5, 0.0, 0.03] {
        let Ok(ray) = view.ray([P::Scalar::from_f64(x), P::Scalar::ZERO], &Interval::ahead()) else {
            continue;
        };
        let _ = thread.trace(method, &view, &mut line, 1, &ray, limits);
        within_limits(&thread.work, limits, method);
    }
}
