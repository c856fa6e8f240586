//! The entry points of views: a view, its rays, its lines, and the methods for them, over memory and structs of any bits.

use crate::Lent;
use crate::entries::{Found, LentPatches, LentScene, ORDER, PENDING, POINTS};
use patchray::limits::{Limits, Work};
use patchray::line::{Line, LineMemory, LineNeeds, Window};
use patchray::method::{ClipScratch, Followed, Following, Scratch, clipping_predicted, newton_predicted};
use patchray::patch::Patch;
use patchray::point::Point;
use patchray::ray::{Interval, RayError};
use patchray::scalar::Scalar;
use patchray::span::Span;
use patchray::view::{Camera, Sight, View, ViewError, ViewMemory, ViewRay};

/// A view's memory.
#[derive(Debug)]
#[repr(C)]
pub struct LentView<P: Point> {
    points: Lent<P>,
    surfaces: Lent<[P::Scalar; 2]>,
    patches: Lent<Patch<P::Scalar>>,
    sights: Lent<Sight<P::Scalar>>,
    runs: Lent<[P::Scalar; 2]>,
    first_runs: Lent<u32>,
}

impl<P: Point> LentView<P> {
    /// # Safety
    /// See [`Lent::slots`].
    unsafe fn memory<'m>(&self) -> ViewMemory<'m, P> {
        // SAFETY: the caller keeps the contract of `slots`.
        let (points, surfaces, patches) = unsafe { (self.points.slots(), self.surfaces.slots(), self.patches.slots()) };
        // SAFETY: likewise.
        let (sights, runs, first_runs) = unsafe { (self.sights.slots(), self.runs.slots(), self.first_runs.slots()) };
        ViewMemory { points, surfaces, patches, sights, runs, first_runs }
    }
}

/// A line's memory.
#[derive(Debug)]
#[repr(C)]
pub struct LentLine<S> {
    spans: Lent<Span<S>>,
    active: Lent<u32>,
    buckets: Lent<u32>,
}

impl<S: Scalar> LentLine<S> {
    /// # Safety
    /// See [`Lent::slots`].
    unsafe fn memory<'m>(&self) -> LineMemory<'m, S> {
        // SAFETY: the caller keeps the contract of `slots`.
        let (spans, active, buckets) = unsafe { (self.spans.slots(), self.active.slots(), self.buckets.slots()) };
        LineMemory { spans, active, buckets }
    }
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn view<P: Point>(
    scene: &LentScene<P>,
    patches: &LentPatches<P::Scalar>,
    camera: &Camera<P::Scalar>,
    memory: &LentView<P>,
    out: &mut Result<View<'static, P>, ViewError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, patches, memory) = unsafe { (scene.view(), patches.patches(), memory.memory()) };
    *out = View::build(&scene, &patches, camera, memory);
}

extern "C" fn view_ray<P: Point>(
    view: &View<'static, P>,
    place: &[P::Scalar; 2],
    interval: &Interval<P::Scalar>,
    out: &mut Result<ViewRay<P::Scalar>, RayError>,
) {
    *out = view.ray(*place, interval);
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn line<P: Point>(
    view: &View<'static, P>,
    window: &Window<P::Scalar>,
    memory: &LentLine<P::Scalar>,
    out: &mut Result<Line<'static, P::Scalar>, LineNeeds>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    *out = Line::build(view, *window, unsafe { memory.memory() });
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn seen_newton<P: Point>(
    view: &View<'static, P>,
    line: &mut Line<'static, P::Scalar>,
    memory: &Lent<Followed<P::Scalar>>,
    last: &mut u32,
    scan_line: u32,
    ray: &ViewRay<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut Scratch<P, ORDER, POINTS>,
    work: &mut Work,
    out: &mut Found<P::Scalar>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let mut memory = Following { slots: unsafe { memory.slots() }, last: *last };
    *out =
        newton_predicted::closest_in_view(view, line, &mut memory, scan_line, ray, limits, &mut scratch.view(), work);
    *last = memory.last;
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn seen_clipping<P: Point>(
    view: &View<'static, P>,
    line: &mut Line<'static, P::Scalar>,
    memory: &Lent<Followed<P::Scalar>>,
    last: &mut u32,
    scan_line: u32,
    ray: &ViewRay<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ClipScratch<P, ORDER, POINTS, PENDING>,
    work: &mut Work,
    out: &mut Found<P::Scalar>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let mut memory = Following { slots: unsafe { memory.slots() }, last: *last };
    *out =
        clipping_predicted::closest_in_view(view, line, &mut memory, scan_line, ray, limits, &mut scratch.view(), work);
    *last = memory.last;
}

export! { view view_ray line seen_newton seen_clipping }
