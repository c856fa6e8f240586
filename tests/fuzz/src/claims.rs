//! What every call has to keep, whatever it was given.

use crate::common::allowances::RESIDUAL;
use crate::input::Case;
use patchray::limits::{Extent, Limits, Work};
use patchray::ray::Hit;
use patchray::scalar::Scalar;
use patchray_host::scanline::{Found, Normal};
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::rays::RayLine;
use patchray_host::stress::truth::residual;
use std::fmt::Debug;

/// No counter is beyond its budget.
pub(crate) fn within_limits<S: Scalar>(work: &Work, limits: &Limits<S>, what: impl Debug) {
    for (name, count, budget) in [
        ("surfaces", work.surfaces_tested, limits.surfaces),
        ("nodes", work.nodes_visited, limits.nodes),
        ("patches", work.patches_tested, limits.patches),
        ("voxels", work.voxels_visited, limits.voxels),
        ("spans", work.spans_visited, limits.spans),
        ("newton-steps", work.newton_steps, limits.newton_steps),
        ("clip-steps", work.clip_steps, limits.clip_steps),
        ("bisections", work.bisections, limits.bisections),
    ] {
        // A search that memory led and that ran out is begun once more without it, by budgets of its own.
        let most = budget.saturating_mul(2);
        assert!(count <= most, "{what:?}: {count} {name}, of which {most} are allowed");
    }
}

/// No counter is beyond the stated worst case.
pub(crate) fn within_worst_case<S: Scalar>(work: &Work, limits: &Limits<S>, extent: &Extent, what: impl Debug) {
    let worst = limits.worst_case(extent).counts();
    for ((name, count), worst) in Work::NAMES.iter().zip(work.counts()).zip(worst) {
        assert!(count <= worst, "{what:?}: {count} {name}, {worst} in the worst case");
    }
}

/// A hit's numbers are finite, t lies in the ray's interval, (u, v) in the unit square, and the surface is one.
pub(crate) fn in_range<S: Scalar>(hit: &Hit<S>, [t_min, t_max]: [S; 2], surfaces: usize, what: impl Debug) {
    let Hit { t, u, v, surface, .. } = *hit;
    assert!(t.is_finite() && t_min <= t && t <= t_max, "{what:?}: t of {hit:?} is not within {t_min:?} and {t_max:?}");
    assert!([u, v].iter().all(|&c| S::ZERO <= c && c <= S::ONE), "{what:?}: (u, v) of {hit:?}");
    assert!((surface as usize) < surfaces, "{what:?}: {surface} of {surfaces} surfaces");
}

/// By how much more than rounding may account for in one evaluation a root may lie off its ray: the clipping methods work on
/// projected nets, whose error is that of all control points.
const OF_NETS: f64 = 8.0;

/// By how much, as a length, a root of a surface may lie off its ray: by the tolerance, and by what rounding leaves, of (u, v) not
/// least, across whose last digit a rational surface moves by as much more as its weights are apart.
pub(crate) fn blur(surface: &ModelSurface, largest: f64, unit: f64, tolerance: f64) -> f64 {
    let degrees = (surface.degree_u + surface.degree_v) as f64;
    let rounding = unit * f64::from(RESIDUAL) * degrees * weight_ratio(surface);
    // Coordinates are scaled to below 1, and to a half at least.
    OF_NETS * 2.0 * largest * (tolerance.max(0.0) + rounding)
}

/// The largest coordinate of a case's control points.
pub(crate) fn largest_coordinate(case: &Case) -> f64 {
    let points = case.model.surfaces.iter().flat_map(|surface| &surface.points);
    points.flat_map(|[x, y, z, _]| [x, y, z]).fold(0.0, |most, c| most.max(c.abs()))
}

/// How far a surface's weights are apart.
fn weight_ratio(surface: &ModelSurface) -> f64 {
    let weights = surface.points.iter().map(|&[.., w]| w);
    weights.clone().fold(0.0, f64::max) / weights.fold(f64::INFINITY, f64::min)
}

/// The point of the surface at a hit's (u, v) is the ray's point at its t, to the tolerance and what rounding leaves.
///
/// Cases whose numbers leave no such claim are passed over: a tolerance that is no small number, coordinates whose products
/// leave `f64`, weights so far apart that quotients lose their digits, or so small that coordinates times weights, which is
/// what the kernel is given, lose theirs.
pub(crate) fn on_the_ray<S: Scalar>(hit: &Hit<S>, case: &Case, ray: &RayLine, limits: &Limits<S>, what: impl Debug) {
    let surface = &case.model.surfaces[hit.surface as usize];
    let largest = largest_coordinate(case);
    let ratio = weight_ratio(surface);
    let tolerance = limits.tolerance.to_f64();
    let fits = |c: f64| c == 0.0 || (1e-30..1e30).contains(&c.abs());
    let all_fit = [largest].iter().chain(&ray.origin).chain(&ray.direction).all(|&c| fits(c));
    let least = S::MIN_POSITIVE.to_f64() / S::EPSILON.to_f64();
    let given = |&[x, y, z, w]: &[f64; 4]| [x, y, z].iter().all(|&c| c == 0.0 || (c * w).abs() >= least);
    if !(all_fit && largest > 0.0 && tolerance < 0.01 && ratio < 1e3 && surface.points.iter().all(given)) {
        return;
    }
    let found = Found {
        t: hit.t.to_f64(),
        u: hit.u.to_f64(),
        v: hit.v.to_f64(),
        surface: hit.surface as usize,
        normal: Normal::Nowhere,
        incidence: hit.incidence,
    };
    let reach = ray.origin.iter().fold(largest, |most, c| most.max(c.abs()));
    let [x, y, z] = ray.direction;
    let unit = S::EPSILON.to_f64();
    // What rounding t can move a point by; and what rounding the origin's way to the scene can.
    let slack = 4.0 * unit * (found.t.abs() * x.hypot(y).hypot(z) + reach);
    let allowed = blur(surface, largest, unit, tolerance) + slack;
    let off = residual(surface, ray, &found);
    assert!(
        off <= allowed,
        "{what:?}: {hit:?} is {off:e} off its ray, {allowed:e} are allowed; {:?} {:?} {ray:?} {limits:?} {surface:?}",
        case.precision,
        case.numbers
    );
}
