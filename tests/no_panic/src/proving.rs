//! The entry points of Newton's methods that fall back on clipping.

use crate::Lent;
use crate::entries::{Asked, Found, LentGrids, LentPatches, LentScene, ORDER, PENDING, POINTS};
use patchray::limits::{Limits, Work};
use patchray::line::Line;
use patchray::method::{
    ClipScratch, Followed, Following, Remembered, Scratch, newton, newton_coherent, newton_predicted,
};
use patchray::point::Point;
use patchray::ray::RayError;
use patchray::view::{View, ViewRay};

/// What a ray needs.
#[derive(Debug)]
#[repr(C)]
pub struct Room<P: Point> {
    newton: Scratch<P, ORDER, POINTS>,
    clips: ClipScratch<P, ORDER, POINTS, PENDING>,
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn proving_newton<P: Point>(
    scene: &LentScene<P>,
    patches: &LentPatches<P::Scalar>,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    Room { newton, clips }: &mut Room<P>,
    work: &mut Work,
    out: &mut Result<Found<P::Scalar>, RayError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, tree, patches) = unsafe { (scene.view(), patches.tree(), patches.patches()) };
    *out = asked.ray(&scene).map(|(ray, interval)| {
        let scratch = &mut newton.view_with(clips.view());
        newton::closest(&scene, &patches, &tree, &ray, &interval, limits, scratch, work)
    });
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn proving_coherent<P: Point>(
    scene: &LentScene<P>,
    patches: &LentPatches<P::Scalar>,
    grids: &LentGrids<P::Scalar>,
    memory: &Lent<Remembered<P::Scalar>>,
    scan_line: u32,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    Room { newton, clips }: &mut Room<P>,
    work: &mut Work,
    out: &mut Result<Found<P::Scalar>, RayError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, patches, grids, memory) = unsafe { (scene.view(), patches.patches(), grids.view(), memory.slots()) };
    *out = asked.ray(&scene).map(|(ray, interval)| {
        let scratch = &mut newton.view_with(clips.view());
        newton_coherent::closest(&scene, &patches, &grids, memory, scan_line, &ray, &interval, limits, scratch, work)
    });
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn proving_predicted<P: Point>(
    view: &View<'static, P>,
    line: &mut Line<'static, P::Scalar>,
    memory: &Lent<Followed<P::Scalar>>,
    last: &mut u32,
    scan_line: u32,
    ray: &ViewRay<P::Scalar>,
    limits: &Limits<P::Scalar>,
    Room { newton, clips }: &mut Room<P>,
    work: &mut Work,
    out: &mut Found<P::Scalar>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let mut memory = Following { slots: unsafe { memory.slots() }, last: *last };
    let scratch = &mut newton.view_with(clips.view());
    *out = newton_predicted::closest_in_view(view, line, &mut memory, scan_line, ray, limits, scratch, work);
    *last = memory.last;
}

export! { proving_newton proving_coherent proving_predicted }
