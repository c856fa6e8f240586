//! What every call has to keep, whatever it was given.

use crate::input::Case;
use patchray::limits::{Extent, Limits, Work};
use patchray::ray::Hit;
use patchray::scalar::Scalar;
use patchray_host::oracle::is_farther;
use patchray_host::scanline::{Found, Normal};
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;
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

/// The largest distance between a hit and its surface, and what it is made of: a share of the surface's size, some roundings of
/// the largest coordinate at hand, and the rounding of t.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exactness {
    /// A share of the surface's size.
    share: f64,
    /// The precision's unit of rounding.
    pub(crate) unit: f64,
    /// Its least positive number, which is how far apart numbers are about 0.
    least: f64,
}

/// Roundings of the largest coordinate; and more of them for each degree of u and of v, since evaluation is a sum over rows of sums
/// over columns.
const ROUNDINGS: [f64; 2] = [16.0, 8.0];

/// By how much more any hit may be off, however hard its surface: the clipping methods work on projected nets, whose error is
/// that of all control points. (Of rays that are clear, [`crate::truth`] asks more.)
const OF_NETS: f64 = 8.0;

impl Exactness {
    pub(crate) fn of(precision: Precision) -> Self {
        match precision {
            Precision::F64 => Exactness { share: 1e-14, unit: f64::EPSILON, least: f64::from_bits(1) },
            Precision::F32 => {
                Exactness { share: 2e-6, unit: f64::from(f32::EPSILON), least: f64::from(f32::from_bits(1)) }
            }
        }
    }

    /// As a length, of a surface, where coordinates of other things as large as `at_hand` take part. Nothing that stands elsewhere
    /// in the scene does.
    pub(crate) fn length(self, surface: &ModelSurface, at_hand: f64) -> f64 {
        let [least, per_degree] = ROUNDINGS;
        let roundings = least + per_degree * (surface.degree_u + surface.degree_v) as f64;
        self.share * size(surface) + roundings * self.unit * largest_coordinate(surface).max(at_hand)
    }

    /// What rounding t moves the ray's point by, along the ray.
    pub(crate) fn of_t(self, t: f64, ray: &RayLine) -> f64 {
        let [x, y, z] = ray.direction;
        2.0 * (self.unit * t.abs() + self.least) * x.hypot(y).hypot(z)
    }
}

/// A surface's size: the diagonal of the box of its control points.
pub(crate) fn size(surface: &ModelSurface) -> f64 {
    let extent = |k: usize| {
        let all = surface.points.iter().map(move |point| point[k]);
        all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
    };
    extent(0).hypot(extent(1)).hypot(extent(2))
}

fn largest_coordinate(surface: &ModelSurface) -> f64 {
    let coordinates = surface.points.iter().flat_map(|[x, y, z, _]| [x, y, z]);
    coordinates.fold(0.0, |most, c| most.max(c.abs()))
}

/// How far a surface's weights are apart.
fn weight_ratio(surface: &ModelSurface) -> f64 {
    let weights = surface.points.iter().map(|&[.., w]| w);
    weights.clone().fold(0.0, f64::max) / weights.fold(f64::INFINITY, f64::min)
}

/// The ray's point at a hit's t is a point of the surface, to what rounding of the surface's own coordinates leaves, and to the
/// tolerance where a larger one than the default is asked for. `at_hand` is how large other coordinates are that take part.
///
/// (u, v) may be too coarse to name that point, where weights are far apart: it may be any of the surface's.
///
/// Cases whose numbers leave no such claim are passed over: a tolerance that is no small number, coordinates whose products
/// leave `f64`, weights so far apart that quotients lose their digits, or so small that coordinates times weights, which is
/// what the kernel is given, lose theirs.
pub(crate) fn on_the_ray<S: Scalar>(
    hit: &Hit<S>,
    case: &Case,
    ray: &RayLine,
    limits: &Limits<S>,
    at_hand: f64,
    what: impl Debug,
) {
    let surface = &case.model.surfaces[hit.surface as usize];
    let largest = largest_coordinate(surface);
    let ratio = weight_ratio(surface);
    let tolerance = if limits.tolerance > S::TOLERANCE { limits.tolerance.to_f64() } else { 0.0 };
    let fits = |c: f64| c == 0.0 || (1e-30..1e30).contains(&c.abs());
    let all_fit = [largest].iter().chain(&ray.origin).chain(&ray.direction).all(|&c| fits(c));
    let least = S::MIN_POSITIVE.to_f64() / S::EPSILON.to_f64();
    let given = |&[x, y, z, w]: &[f64; 4]| [x, y, z].iter().all(|&c| c == 0.0 || (c * w).abs() >= least);
    let small = limits.tolerance.is_finite() && tolerance < 0.01;
    if !(all_fit && largest > 0.0 && small && ratio < 1e10 && surface.points.iter().all(given)) {
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
    let exactness = Exactness::of(case.precision);
    let rounding = OF_NETS * exactness.length(surface, at_hand) + exactness.of_t(found.t, ray);
    let allowed = rounding + 2.0 * tolerance * size(surface);
    if residual(surface, ray, &found) <= allowed {
        return;
    }
    // By how many times, as a power of two.
    let farther = |times: f64| is_farther(surface, ray.origin, ray.direction, found.t, times * allowed);
    let times = (0..100).map(|k| f64::from(k).exp2()).take_while(|&times| farther(times)).last();
    assert!(
        times.is_none(),
        "{what:?}: {hit:?} is off its surface by {times:?} times the {allowed:e} allowed; {:?} {:?} {ray:?} {limits:?} {:?}",
        case.precision,
        case.numbers,
        case.model.surfaces
    );
}
