//! What the tests share: the methods, a model traced by one of them, and how to say what went wrong.

use patchray_host::lower::Stages;
use patchray_host::prepared::Prepared;
use patchray_host::scanline::{Found, Outcome, Tally, rays_of};
use patchray_host::scene::camera::View;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::shapes::Random;
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::settings::Settings;
use patchray_host::viewed::{Viewed, Wishes};

/// The methods for any rays.
pub(crate) const METHODS: [Method; 4] =
    [Method::Clipping, Method::Newton, Method::ClippingCoherent, Method::NewtonCoherent];

/// All, for the rays of a picture.
pub(crate) const OF_PICTURES: [Method; 6] = [
    Method::Clipping,
    Method::Newton,
    Method::ClippingCoherent,
    Method::NewtonCoherent,
    Method::ClippingPredicted,
    Method::NewtonPredicted,
];

/// Both precisions.
pub(crate) const PRECISIONS: [Precision; 2] = [Precision::F64, Precision::F32];

/// How many rays a test traces: what the environment says, or else `usual`.
pub(crate) fn rays(usual: usize) -> usize {
    std::env::var("PATCHRAY_RAYS").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// The defaults with this method and precision.
pub(crate) fn settings(method: Method, precision: Precision) -> Settings {
    Settings { method, precision, ..Settings::default() }
}

/// What a method answers to each ray, all of them on one scan line.
pub(crate) fn trace(model: &Model, rays: &[RayLine], method: Method, precision: Precision) -> Vec<Outcome> {
    let settings = settings(method, precision);
    let prepared = Prepared::build(model, Stages::of(method), &settings).expect("there is memory");
    let mut outcomes = Vec::new();
    prepared.tracer(&settings).lane().trace(rays, false, &mut outcomes, &mut Tally::default());
    assert_eq!(outcomes.len(), rays.len());
    outcomes
}

/// What a method answers to each ray of a picture.
pub(crate) fn trace_view(model: &Model, view: &View, method: Method, precision: Precision) -> Vec<Outcome> {
    let settings = settings(method, precision);
    let mut viewed = Viewed::build(model, &settings, view, Wishes::PRIMARY).expect("it is a view");
    let (tracer, _) = viewed.tracer().expect("it is a view");
    let mut lane = tracer.lane();
    let (mut outcomes, mut tally) = (Vec::new(), Tally::default());
    for line in 0..view.scan_lines() {
        let samples = view.scan_line(line);
        lane.trace_line(&samples, &rays_of(view, line, &samples), &mut outcomes, &mut tally);
    }
    outcomes
}

/// A whole number below `below`.
pub(crate) fn index(random: &mut Random, below: usize) -> usize {
    (random.within(0.0, below as f64) as usize).min(below - 1)
}

/// The surface as its file would have it, and the ray, for a message.
pub(crate) fn told(surface: &ModelSurface, ray: &RayLine) -> String {
    let points = surface.points.iter().map(|[x, y, z, w]| format!("{x:?} {y:?} {z:?} {w:?}\n"));
    let [o, d] = [ray.origin, ray.direction].map(|v| v.map(|c| format!("{c:?}")).join(","));
    format!("1\n{} {}\n{}ray {o},{d}", surface.degree_u, surface.degree_v, points.collect::<String>())
}

/// The hits of each ray by a method that can tell all of them; `None` of a ray that it gave up.
pub(crate) fn all_hits(
    model: &Model,
    rays: &[RayLine],
    method: Method,
    precision: Precision,
) -> Vec<Option<Vec<Found>>> {
    let settings = settings(method, precision);
    let prepared = Prepared::build(model, Stages::of(method), &settings).expect("there is memory");
    let tracer = prepared.tracer_of_all(&settings).expect("an original method");
    let mut outcomes = Vec::new();
    tracer.lane().trace(rays, false, &mut outcomes, &mut Tally::default());
    let told = outcomes.into_iter().map(|outcome| match outcome {
        Outcome::Hit(hits) => Some(hits),
        Outcome::Miss => Some(Vec::new()),
        _ => None,
    });
    told.collect()
}
