//! Views and their scan lines through the C interface.

use super::arguments::{Prepared, VOXELS, words};
use super::field::{Call, Field};
use super::rust::{in_c, is_answered, limits_in_rust};
use crate::bytes::Bytes;
use crate::common::Kind;
use crate::input::{Case, in_kernel};
use crate::lent_lines::{Arguments, Views};
use crate::ready::{Takes, prepare_within};
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use crate::scribble::{Slot, scribble};
use patchray::capi::*;
use patchray::line::Window;
use patchray::method::Followed;
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::view::{Camera, ViewError};
use std::ops::Range;

/// The functions: a view's preparation, and lines.
pub(super) const FUNCTIONS: u8 = 3;

/// In the order of [`Views::LINES`].
const METHODS: [InView; 2] = [InView::ClippingPredicted, InView::NewtonPredicted];

/// What a view or a line of it is made of.
pub(super) struct Lines<P: Views> {
    prepared: Prepared<P>,
    camera_in_rust: Camera<P::Scalar>,
    camera: *mut patchray_camera<P::Scalar>,
    view_memory: *mut patchray_view_memory<P::Scalar>,
    view: *mut patchray_view<P::Scalar>,
    line: *mut patchray_line<P::Scalar>,
    line_memory: *mut patchray_line_memory<P::Scalar>,
    memory: *mut patchray_followed<P::Scalar>,
    memory_len: usize,
    hits: *mut patchray_hit<P::Scalar>,
    codes: *mut i32,
    works: *mut patchray_work,
    rays: usize,
    /// The line's method; none for the preparation.
    method: Option<usize>,
    /// The code that the view's preparation was refused with.
    stopped: Option<i32>,
    pub(super) written: Vec<Range<usize>>,
}

impl<P: Views + Kind + Slot> Lines<P> {
    /// What a function takes, in a field; `None` if the field does not hold it, or nothing can be prepared.
    pub(super) fn of(case: &Case, function: usize, field: &mut Field, bytes: &mut Bytes<'_>) -> Option<Self> {
        let method = function.checked_sub(1);
        // With scene and patches made ready, as for `newton`.
        let prepared = Prepared::<P>::of(case, 5, field, bytes)?;
        if prepared.stopped.is_some() {
            return None;
        }
        let camera_in_rust = in_kernel::<P::Scalar>(&case.camera(bytes));
        let Camera { eye, forward, right, up } = camera_in_rust;
        let side = |bytes: &mut Bytes<'_>| P::Scalar::from_f64(f64::from(bytes.byte() as i8) / 128.0);
        let y = side(bytes);
        let mut places = vec![[side(bytes), y]];
        for _ in 0..bytes.below(4) {
            let step = P::Scalar::from_f64(f64::from(bytes.byte() as i8) / 1024.0);
            places.push([places[places.len() - 1][0] + step, y]);
        }
        let surfaces = case.model.surfaces.len();
        let one = P::Scalar::ONE;
        // SAFETY: plain numbers and null addresses; each place is one for as much.
        let mut lines = unsafe {
            let in_field = field.take::<[P::Scalar; 2]>(places.len())?;
            in_field.copy_from_nonoverlapping(places.as_ptr(), places.len());
            let line = patchray_line {
                places: in_field.cast::<P::Scalar>().cast_const(),
                places_len: 2 * places.len(),
                x: [-one, one],
                y: [y; 2],
                t_min: (*prepared.ray).t_min,
                t_max: (*prepared.ray).t_max,
                number: bytes.count().min(u32::MAX - 1),
            };
            Lines {
                camera_in_rust,
                camera: field.put(patchray_camera { eye, forward, right, up })?,
                view_memory: field.put(core::mem::zeroed())?,
                view: field.put(core::mem::zeroed())?,
                line: field.put(line)?,
                line_memory: field.put(core::mem::zeroed())?,
                memory: field.take::<Followed<P::Scalar>>(surfaces)?.cast(),
                memory_len: surfaces,
                hits: field.take(places.len())?,
                codes: field.take(places.len())?,
                works: field.take(places.len())?,
                rays: places.len(),
                method,
                stopped: None,
                written: vec![],
                prepared,
            }
        };
        // SAFETY: there are so many slots, laid out alike.
        let slots = unsafe { core::slice::from_raw_parts_mut(lines.memory.cast(), surfaces) };
        slots.fill(Followed::<P::Scalar>::EMPTY);
        scribble(bytes, slots);
        lines.look(field, bytes)?;
        Some(lines)
    }

    /// Makes the view ready, and memory for a line; for the preparation itself, the memory for it.
    fn look(&mut self, field: &mut Field, bytes: &mut Bytes<'_>) -> Option<()> {
        // SAFETY: all is in its place, and what is not lent is null.
        unsafe {
            let code = self.build();
            if code != PATCHRAY_MEMORY {
                self.stopped = Some(code);
                return Some(());
            }
            let memory = &mut *self.view_memory;
            memory.points = field.take::<P>(memory.points_len / (size_of::<P>() / size_of::<P::Scalar>()))?.cast();
            memory.surfaces = field.take::<[P::Scalar; 2]>(memory.surfaces_len / 2)?.cast();
            memory.patches = field.take(memory.patches_len)?;
            memory.sights = field.take(memory.sights_len)?;
            memory.runs = field.take::<[P::Scalar; 2]>(memory.runs_len / 2)?.cast();
            memory.first_runs = field.take(memory.first_runs_len)?;
            if self.method.is_none() {
                return Some(());
            }
            assert_eq!(self.build(), PATCHRAY_OK, "a view with what it asked for");
            let spans = memory.patches_len;
            let line = &mut *self.line_memory;
            (line.spans, line.spans_len) = (field.take(spans)?, spans);
            (line.active, line.active_len) = (field.take(spans)?, spans);
            line.buckets_len = 1 + bytes.below(20);
            line.buckets = field.take(line.buckets_len)?;
        }
        Some(())
    }

    unsafe fn build(&self) -> i32 {
        // SAFETY: the caller's.
        unsafe { P::VIEW(self.prepared.scene, self.prepared.patches, self.camera, self.view_memory, self.view) }
    }

    /// Calls the function.
    ///
    /// # Safety
    /// Its arguments are in their places.
    pub(super) unsafe fn call(&self) -> i32 {
        // SAFETY: the caller's.
        unsafe {
            let Some(method) = self.method else {
                return self.build();
            };
            (P::LINES[method])(&Arguments {
                view: self.view,
                line: self.line,
                line_memory: self.line_memory,
                memory: self.memory,
                memory_len: self.memory_len,
                limits: self.prepared.limits,
                scratch: self.prepared.scratch,
                words: self.prepared.scratch_words,
                hits: self.hits,
                codes: self.codes,
                works: self.works,
            })
        }
    }

    /// Other addresses and counts.
    pub(super) fn spoil(&mut self, call: &mut Call<'_, '_, '_>) {
        // SAFETY: structs that hold addresses are in their places.
        unsafe { if self.method.is_some() { self.spoil_line(call) } else { self.spoil_view(call) } }
        self.written = call.written();
    }

    /// # Safety
    /// Structs that hold addresses are in their places, here and below.
    unsafe fn spoil_view(&mut self, call: &mut Call<'_, '_, '_>) {
        // SAFETY: the caller's.
        unsafe {
            self.prepared.spoil_scene(call);
            self.prepared.spoil_patches(call);
            self.camera = call.one(self.camera, false);
            let memory = &mut *self.view_memory;
            (memory.points, memory.points_len) = call.slots::<_, P>(memory.points, memory.points_len, true);
            (memory.surfaces, memory.surfaces_len) =
                call.slots::<_, [P::Scalar; 2]>(memory.surfaces, memory.surfaces_len, true);
            (memory.patches, memory.patches_len) = call.many(memory.patches, memory.patches_len, true);
            (memory.sights, memory.sights_len) = call.many(memory.sights, memory.sights_len, true);
            (memory.runs, memory.runs_len) = call.slots::<_, [P::Scalar; 2]>(memory.runs, memory.runs_len, true);
            (memory.first_runs, memory.first_runs_len) = call.many(memory.first_runs, memory.first_runs_len, true);
        }
        self.view_memory = call.holder(self.view_memory, true);
        self.view = call.one(self.view, true);
    }

    /// # Safety
    /// See [`Lines::spoil_view`].
    unsafe fn spoil_line(&mut self, call: &mut Call<'_, '_, '_>) {
        // SAFETY: the caller's.
        let (view, line, memory) = unsafe { (&mut *self.view, &mut *self.line, &mut *self.line_memory) };
        macro_rules! spoil {
            ($($holder:ident.$($field:ident).+ $len:ident, $slot:ty;)*) => {$(
                let place = &mut $holder$(.$field)+;
                let (first, len) = call.slots::<_, $slot>(place.cast_mut(), spoil!(@len $holder $($field)+, $len), false);
                *place = first;
                spoil!(@set $holder $($field)+, $len, len);
            )*};
            (@len $holder:ident $field:ident, $len:ident) => { $holder.$len };
            (@len $holder:ident $outer:ident $field:ident, $len:ident) => { $holder.$outer.$len };
            (@set $holder:ident $field:ident, $len:ident, $value:ident) => { $holder.$len = $value };
            (@set $holder:ident $outer:ident $field:ident, $len:ident, $value:ident) => { $holder.$outer.$len = $value };
        }
        spoil! {
            view.scene.points points_len, P;
            view.scene.surfaces surfaces_len, patchray_surface<P::Scalar>;
            view.scene.offsets offsets_len, u32;
            view.scene.references references_len, u32;
            view.patches.patches patches_len, patchray_patch<P::Scalar>;
            view.patches.first first_len, u32;
            view.surfaces surfaces_len, [P::Scalar; 2];
            view.sights sights_len, patchray_sight<P::Scalar>;
            view.runs runs_len, [P::Scalar; 2];
            view.first_runs first_runs_len, u32;
        }
        self.view = call.holder(self.view, false);
        // Places come with hits, codes and works: more of them there is no room for, but for more than any memory has.
        let rays = call.fewer_or_endless(self.rays);
        line.places_len = rays.saturating_mul(2);
        line.places = call.fixed::<[P::Scalar; 2]>(line.places.cast_mut().cast(), rays, false).cast::<P::Scalar>();
        self.line = call.holder(self.line, false);
        self.hits = call.fixed(self.hits, rays, true);
        self.codes = call.fixed(self.codes, rays, true);
        self.works = call.fixed_if_any(self.works, rays);
        (memory.spans, memory.spans_len) = call.many(memory.spans, memory.spans_len, true);
        (memory.active, memory.active_len) = call.many(memory.active, memory.active_len, true);
        (memory.buckets, memory.buckets_len) = call.many(memory.buckets, memory.buckets_len, true);
        self.line_memory = call.holder(self.line_memory, true);
        (self.memory, self.memory_len) = call.many(self.memory, self.memory_len, true);
        let prepared = &mut self.prepared;
        prepared.limits = call.bounds_if_any(prepared.limits);
        (prepared.scratch, prepared.scratch_words) = call.many(prepared.scratch, prepared.scratch_words, true);
    }

    /// Any bits in what calls read, but for addresses and counts; budgets stay small.
    pub(super) fn scribble(&mut self, bytes: &mut Bytes<'_>) {
        self.prepared.scribble(bytes);
        for _ in 0..bytes.below(4) {
            // SAFETY: all is in its place, and of numbers; what is not there is null.
            unsafe {
                let (view, line) = (&mut *self.view, &mut *self.line);
                let any = match bytes.below(11) {
                    0 => words(self.camera, 1),
                    1 => words(&raw mut view.layout, 1),
                    2 => words(&raw mut view.header, 1),
                    3 => words(view.surfaces.cast_mut(), view.surfaces_len),
                    4 => words(view.sights.cast_mut(), view.sights_len),
                    5 => words(view.runs.cast_mut(), view.runs_len),
                    6 => words(view.first_runs.cast_mut(), view.first_runs_len),
                    7 => words(&raw mut line.x, 2),
                    8 => words(&raw mut line.t_min, 2),
                    9 => words(view.scene.points.cast_mut(), view.scene.points_len),
                    _ => words(view.patches.patches.cast_mut(), view.patches.patches_len),
                };
                scribble(bytes, any);
            }
        }
    }

    /// No counter of an answer is beyond its budget.
    pub(super) fn within_limits(&self) {
        if self.method.is_none() || self.works.is_null() || self.prepared.limits.is_null() {
            return;
        }
        // SAFETY: the call had them read and written there; places are no more than there were.
        unsafe {
            let limits = &*self.prepared.limits;
            for k in 0..(*self.line).places_len / 2 {
                super::arguments::within(&*self.works.add(k), limits);
            }
        }
    }

    /// Calls the function with all as it is to be, and asks the same of Rust.
    pub(super) fn as_in_rust(&mut self, case: &Case) {
        // SAFETY: all is in its place, here and below.
        let subdivision = unsafe { self.prepared.subdivision() };
        let takes = Takes { patches: true, tree: true, grids: false };
        let Some(prepared) = prepare_within::<P>(&case.model, &subdivision, VOXELS, takes) else {
            panic!("it is prepared in C");
        };
        let room = ViewRoom::for_view(&prepared, &self.camera_in_rust);
        if let Some(code) = self.stopped {
            let error = room.map(|_| ()).expect_err("in C there is none");
            let fits = match error {
                ViewError::Flat => code == PATCHRAY_CAMERA_FLAT,
                ViewError::Far | ViewError::Near => code == PATCHRAY_CAMERA_FAR,
                ViewError::Ray(_) => (PATCHRAY_RAY_RANGE..=PATCHRAY_RAY_NAN).contains(&code),
                ViewError::Patches | ViewError::TooLarge | ViewError::Memory(_) => false,
            };
            assert!(fits, "{error}, and in C {code}");
            return;
        }
        let mut room = room.expect("there is one in C");
        let view = room.build(&prepared, &self.camera_in_rust).expect("as was asked for");
        let surfaces = case.model.surfaces.len();
        let mut thread = Thread::<P>::new(surfaces);
        // SAFETY: slots are laid out alike.
        unsafe {
            thread.followed.copy_from_slice(core::slice::from_raw_parts(self.memory.cast(), surfaces));
        }
        thread.last = u32::MAX;
        // SAFETY: all is in its place.
        let code = unsafe { self.call() };
        let Some(method) = self.method else {
            return assert_eq!(code, PATCHRAY_OK);
        };
        if code == PATCHRAY_SCRATCH {
            return assert!(self.prepared.is_short_of(case));
        }
        // SAFETY: likewise.
        let (line, memory, limits) = unsafe { (*self.line, *self.line_memory, limits_in_rust(&*self.prepared.limits)) };
        let Some(interval) = Interval::new(line.t_min, line.t_max) else {
            return assert_eq!(code, PATCHRAY_RAY_INTERVAL);
        };
        assert_eq!(code, PATCHRAY_OK);
        let method = METHODS[method];
        let mut lines = LineRoom::sized(memory.spans_len, memory.buckets_len);
        let mut in_rust = lines.line(&view, Window { x: line.x, y: line.y }).expect("there is memory in C");
        for k in 0..self.rays {
            // SAFETY: there are so many of each.
            let (place, hit, code, work) = unsafe {
                let place = *line.places.cast::<[P::Scalar; 2]>().add(k);
                (place, *self.hits.add(k), *self.codes.add(k), *self.works.add(k))
            };
            let Ok(ray) = view.ray(place, &interval) else {
                assert!((PATCHRAY_RAY_OUT_OF_VIEW..=PATCHRAY_RAY_NAN).contains(&code), "{code}");
                continue;
            };
            // A ray that met a surface of more than its scratch: from there on the line's memory is another.
            if code == PATCHRAY_SCRATCH {
                return assert!(self.prepared.is_short_of(case));
            }
            let answer = thread.trace(method, &view, &mut in_rust, line.number, &ray, &limits);
            assert_eq!(work, patchray_work::from(thread.work), "{answer:?}");
            is_answered(code, &answer);
            let expected = answer.unwrap_or_else(|gave_up| gave_up.best).map(in_c);
            assert_eq!((hit.surface != PATCHRAY_NO_SURFACE).then_some(hit), expected);
        }
    }
}
