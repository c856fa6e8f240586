//! The rays of a view: what they share is prepared once, and each call traces a scan line of them.
//!
//! A line to a call, not a ray: what is known of a line's patches lives no longer than the call, so that a caller has less to
//! hold, and memory is made sure of once for all of a line's rays.

use super::lend::{Lending, Room};
use super::scratch;
use super::status::*;
use super::tables::{self, layout_of, view_header_in_c};
use super::trace::{Found, code_of};
use super::types::*;
use crate::layout::Table;
use crate::limits::{Limits, Work};
use crate::line::{Line, LineMemory, LineNeeds, Window};
use crate::method::{Following, clipping_predicted, newton_predicted};
use crate::point::Point;
use crate::ray::{Interval, RayError};
use crate::scalar::Scalar;
use crate::view::{Camera, View, ViewError, ViewMemory, ViewRay};

/// # Safety
/// All addresses that are neither null nor misaligned lead to memory as the counts beside them say, and tables to memory as
/// the counts in them say, which nothing else uses during the call.
pub(super) unsafe fn view_build<P: Point>(
    scene: *const patchray_scene<P::Scalar>,
    patches: *const patchray_patches<P::Scalar>,
    camera: *const patchray_camera<P::Scalar>,
    memory: *mut patchray_view_memory<P::Scalar>,
    view: *mut patchray_view<P::Scalar>,
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    // SAFETY: the caller's.
    let (lent, memory) = unsafe { lending.exchange(memory) }?;
    let out = lending.place(view)?;
    let points = lending.room::<_, P>(lent.points, lent.points_len)?;
    let surfaces = lending.room::<_, [P::Scalar; 2]>(lent.surfaces, lent.surfaces_len)?;
    let turned = lending.room(lent.patches, lent.patches_len)?;
    let sights = lending.room(lent.sights, lent.sights_len)?;
    let runs = lending.room(lent.runs, lent.runs_len)?;
    let first_runs = lending.room(lent.first_runs, lent.first_runs_len)?;
    // SAFETY: the caller's.
    let patchray_camera { eye, forward, right, up } = unsafe { lending.read(camera) }?;
    // SAFETY: the caller's.
    let table = unsafe { lending.read(scene) }?;
    // SAFETY: the caller's.
    let scene = unsafe { tables::scene_in::<P>(&mut lending, &table) }?;
    // SAFETY: the caller's.
    let of_patches = unsafe { lending.read(patches) }?;
    // SAFETY: the caller's.
    let (patches, _) = unsafe { tables::patches_in(&mut lending, &of_patches) }?;
    let camera = Camera { eye, forward, right, up };
    // Before anything is written.
    View::check(&scene, &patches, &camera).map_err(of_view)?;
    // SAFETY: the caller's.
    let room = unsafe {
        ViewMemory {
            points: points.open(),
            surfaces: surfaces.open(),
            patches: turned.open(),
            sights: sights.open(),
            runs: runs.open(),
            first_runs: first_runs.open(),
        }
    };
    let (lens, built) = match View::build(&scene, &patches, &camera, room) {
        Ok(view) => (view.lens(), Some(view.header())),
        Err(ViewError::Memory(needs)) => {
            let needs = [needs.points, needs.surfaces, needs.patches, needs.sights, needs.runs, needs.first_runs];
            (needs.map(|need| need.needed), None)
        }
        Err(error) => return Err(of_view(error)),
    };
    let [points, surfaces, patches_len, sights_len, runs, first_runs_len] = lens;
    let points_len = points.saturating_mul(size_of::<P>() / size_of::<P::Scalar>());
    let [surfaces_len, runs_len] = [surfaces, runs].map(|rows| rows.saturating_mul(2));
    let counted =
        patchray_view_memory { points_len, surfaces_len, patches_len, sights_len, runs_len, first_runs_len, ..lent };
    // SAFETY: the caller's.
    unsafe { memory.set(counted) };
    let header = view_header_in_c(&built.ok_or(PATCHRAY_MEMORY)?);
    // SAFETY: the caller's.
    unsafe {
        out.set(patchray_view {
            layout: layout_of::<P::Scalar>(Table::View, P::RATIONAL),
            header,
            scene: patchray_scene { points: lent.points, points_len, ..table },
            patches: patchray_patches { patches: lent.patches, patches_len, ..of_patches },
            surfaces: lent.surfaces,
            surfaces_len,
            sights: lent.sights,
            sights_len,
            runs: lent.runs,
            runs_len,
            first_runs: lent.first_runs,
            first_runs_len,
        });
    }
    Ok(PATCHRAY_OK)
}

/// What a call for a scan line is given, whatever the method.
pub(super) struct OfLine<S> {
    pub(super) view: *const patchray_view<S>,
    pub(super) line: *const patchray_line<S>,
    pub(super) memory: *mut patchray_line_memory<S>,
    pub(super) limits: *const patchray_limits<S>,
    pub(super) scratch: (*mut u64, usize),
    pub(super) hits: *mut patchray_hit<S>,
    pub(super) codes: *mut i32,
    pub(super) works: *mut patchray_work,
}

/// Traces a scan line: `room` makes the method's scratch of words, and `trace` answers a ray. The slots are coherence memory.
///
/// # Safety
/// As for [`view_build`].
#[inline(always)]
unsafe fn line<P: Point, R>(
    given: OfLine<P::Scalar>,
    (slots, count): (*mut patchray_followed<P::Scalar>, usize),
    room: impl FnOnce(Room<u64>) -> Result<R, Code>,
    mut trace: impl FnMut(
        &View<'_, P>,
        &mut Line<'_, P::Scalar>,
        &mut Following<'_, P::Scalar>,
        u32,
        &ViewRay<P::Scalar>,
        &Limits<P::Scalar>,
        &mut R,
        &mut Work,
    ) -> Found<P::Scalar>,
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    // SAFETY: the caller's.
    let (lent, counts) = unsafe { lending.exchange(given.memory) }?;
    // SAFETY: the caller's.
    let asked = unsafe { lending.read(given.line) }?;
    let rays = asked.places_len / 2;
    let words = lending.room(given.scratch.0, given.scratch.1)?;
    let hits = lending.room::<_, patchray_hit<P::Scalar>>(given.hits, rays)?;
    let codes = lending.room::<_, i32>(given.codes, rays)?;
    let works = lending.room::<_, patchray_work>(given.works, if given.works.is_null() { 0 } else { rays })?;
    // SAFETY: the caller's.
    let places = unsafe { lending.slots::<_, [P::Scalar; 2]>(asked.places, asked.places_len) }?;
    // SAFETY: the caller's.
    let limits = unsafe { lending.read_if_any(given.limits) }?;
    let limits = limits.map_or(Ok(Limits::default()), |limits| limits.checked())?;
    // SAFETY: the caller's.
    let view = unsafe { tables::view::<P>(&mut lending, given.view) }?;
    // SAFETY: the caller's.
    let slots = unsafe { lending.slot_each(slots, count, view.surfaces().len()) }?;
    // At the beginning of a line no surface was the last one.
    let memory = &mut Following { slots, last: u32::MAX };
    // Set once by the caller: to clear it for each line would cost more than many a line's rays.
    // SAFETY: the caller's.
    let lent_slots = unsafe {
        LineMemory {
            spans: lending.memory(lent.spans, lent.spans_len)?,
            active: lending.memory(lent.active, lent.active_len)?,
            buckets: lending.memory(lent.buckets, lent.buckets_len)?,
        }
    };
    let interval = Interval::new(asked.t_min, asked.t_max).ok_or(PATCHRAY_RAY_INTERVAL)?;
    let window = Window { x: asked.x, y: asked.y };
    let has_extent = window.x[0] <= window.x[1] && window.y[0] <= window.y[1];
    if !(has_extent && asked.places_len.is_multiple_of(2) && tables::is_number_of_line(asked.number)) {
        return Err(PATCHRAY_OPTION);
    }
    let mut line = match Line::build(&view, window, lent_slots) {
        Ok(line) => line,
        Err(LineNeeds { spans, active, buckets }) => {
            let [spans_len, active_len, buckets_len] = [spans, active, buckets].map(|need| need.needed);
            // SAFETY: the caller's.
            unsafe { counts.set(patchray_line_memory { spans_len, active_len, buckets_len, ..lent }) };
            return Err(PATCHRAY_MEMORY);
        }
    };
    // SAFETY: the caller's.
    let mut scratch = room(words)?;
    // SAFETY: the caller's.
    let (hits, codes, works) = unsafe { (hits.open(), codes.open(), works.open()) };
    let mut works = works.iter_mut();
    for ((place, hit), code) in places.iter().zip(hits).zip(codes) {
        let mut work = Work::default();
        (*hit, *code) = match view.ray(*place, &interval) {
            Ok(ray) => code_of(trace(&view, &mut line, memory, asked.number, &ray, &limits, &mut scratch, &mut work)),
            Err(error) => (None.into(), of_place(place, error)),
        };
        if let Some(place) = works.next() {
            *place = work.into();
        }
    }
    Ok(PATCHRAY_OK)
}

/// Why there is no ray of a place. For the kernel NaN is out of view: to tell would cost each ray some instructions.
#[cold]
fn of_place<S: Scalar>(place: &[S; 2], error: RayError) -> Code {
    of_ray(RayError::of_not_finite(place.iter()).unwrap_or(error))
}

/// # Safety
/// As for [`view_build`].
#[inline(always)]
pub(super) unsafe fn clipping_predicted_line<P: Point>(
    given: OfLine<P::Scalar>,
    slots: (*mut patchray_followed<P::Scalar>, usize),
) -> Result<Code, Code> {
    // SAFETY: the caller's.
    unsafe { line::<P, _>(given, slots, |words| scratch::clip::<P>(words), clipping_predicted::closest_in_view) }
}

/// # Safety
/// As for [`view_build`].
#[inline(always)]
pub(super) unsafe fn newton_predicted_line<P: Point>(
    given: OfLine<P::Scalar>,
    slots: (*mut patchray_followed<P::Scalar>, usize),
) -> Result<Code, Code> {
    // SAFETY: the caller's.
    unsafe { line::<P, _>(given, slots, |words| scratch::newton::<P>(words), newton_predicted::closest_in_view) }
}
