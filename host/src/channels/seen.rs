//! The channels of a view: what one ray through the middle of each pixel met of the surfaces, and what finding it took.
//!
//! Polygons are not among them: the kernel does not trace these.

use indicatif::ProgressBar;
use patchray::limits::Work;
use patchray::ray::Incidence;
use rayon::prelude::*;

use super::{Channel, Channels, Values};
use crate::batch::Lanes;
use crate::lower::LowerError;
use crate::scanline::{Outcome, Tally, rays_of};
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::scene::rays::RayLine;
use crate::scene::sampling::Sampling;
use crate::settings::Settings;
use crate::stress::truth::residual;
use crate::viewed::{Viewed, Wishes};

/// What counts and codes are where there is nothing to number.
pub const NONE: u32 = u32::MAX;

/// Codes of the channel `status`, in their order.
pub const STATUS: [&str; 6] = ["miss", "hit", "graze", GIVEN_UP, "refused", "contact"];

/// The code of rays that ran out of a budget.
pub const GIVEN_UP: &str = "gave up";

/// Codes of the channel `path`, in their order: what the answer took at most. Of a ray that meets several surfaces it is the last
/// of these that any of them took.
pub const PATHS: [&str; 6] = ["none", "verified", "list", "straight-forward", "full search", "bisection"];

/// What became of a pixel's ray.
struct Seen {
    met: Option<Met>,
    status: u32,
    work: Work,
}

/// Where it met a surface.
struct Met {
    distance: f64,
    point: [f64; 3],
    normal: Option<[f64; 3]>,
    at: [f64; 2],
    surface: usize,
    residual: f64,
}

/// A channel's name, and its number for a pixel.
type Of<T> = (&'static str, fn(&Seen) -> T);

/// A measure of what was met; no number where nothing was.
macro_rules! met {
    ($name:literal, $met:ident => $value:expr) => {
        ($name, |seen| seen.met.as_ref().map_or(f64::NAN, |$met| $value))
    };
}

const MEASURES: [Of<f64>; 10] = [
    // So that what is met is before what is not.
    ("Z", |seen| seen.met.as_ref().map_or(f64::INFINITY, |met| met.distance)),
    met!("P.X", met => met.point[0]),
    met!("P.Y", met => met.point[1]),
    met!("P.Z", met => met.point[2]),
    met!("N.X", met => met.normal.map_or(f64::NAN, |normal| normal[0])),
    met!("N.Y", met => met.normal.map_or(f64::NAN, |normal| normal[1])),
    met!("N.Z", met => met.normal.map_or(f64::NAN, |normal| normal[2])),
    met!("u", met => met.at[0]),
    met!("v", met => met.at[1]),
    met!("residual", met => met.residual),
];

const COUNTS: [Of<u32>; 10] = [
    ("surface", |seen| seen.met.as_ref().map_or(NONE, |met| met.surface as u32)),
    ("status", |seen| seen.status),
    ("path", |seen| path(&seen.work)),
    ("newton_starts", |seen| seen.work.newton_starts),
    ("newton_steps", |seen| seen.work.newton_steps),
    ("clip_steps", |seen| seen.work.clip_steps),
    ("bisections", |seen| seen.work.bisections),
    ("patches_tested", |seen| seen.work.patches_tested),
    ("voxels", |seen| seen.work.voxels_visited),
    ("spans", |seen| seen.work.spans_visited),
];

/// The channel of patches; of methods without patches there is none.
const PATCH: &str = "patch";

/// All names that a channel can have.
pub fn names() -> impl Iterator<Item = &'static str> {
    MEASURES.iter().map(|of| of.0).chain([PATCH]).chain(COUNTS.iter().map(|of| of.0))
}

fn path(work: &Work) -> u32 {
    // In the order of `PATHS`, from the last. A method that remembers nothing searches all by Newton's method.
    let full = work.full_searches > 0 || (work.newton_starts > 0 && work.verified == 0 && work.decided_by_list == 0);
    let took = [work.bisections > 0, full, work.clip_steps > 0, work.decided_by_list > 0, work.verified > 0];
    took.iter().position(|&took| took).map_or(0, |place| (PATHS.len() - 1 - place) as u32)
}

/// Traces a ray through the middle of each pixel of `view` and tells of all of them, on rayon's current threads.
///
/// # Errors
/// As [`Viewed::build`].
pub fn of_view(model: &Model, settings: &Settings, view: &View, bar: &ProgressBar) -> Result<Channels, LowerError> {
    let view = view.sampled(Sampling::One);
    let mut viewed = Viewed::build(model, settings, &view, Wishes::PRIMARY)?;
    let (tracer, used) = viewed.tracer()?;
    let lanes = Lanes::new(tracer.as_ref());
    let row = |line: u32| {
        let samples = view.scan_line(line);
        let rays = rays_of(&view, line, &samples);
        let (mut outcomes, mut tally) = (Vec::new(), Tally { each: Some(Vec::new()), ..Tally::default() });
        lanes.with(|lane| lane.trace_line(&samples, &rays, &mut outcomes, &mut tally));
        bar.inc(1);
        let each = tally.each.unwrap_or_default();
        let seen = rays.iter().zip(&outcomes).zip(each).map(|((ray, outcome), work)| seen(model, ray, outcome, work));
        seen.collect::<Vec<Seen>>()
    };
    let rows: Vec<Vec<Seen>> = (0..view.size[1]).into_par_iter().map(row).collect();
    drop(lanes);
    drop(tracer);
    let all: Vec<Seen> = rows.into_iter().flatten().collect();
    let measures = MEASURES.iter().map(|(name, of)| {
        let values = all.iter().map(|seen| of(seen) as f32).collect();
        Channel { name: (*name).to_owned(), values: Values::Real(values) }
    });
    let counts = COUNTS.iter().map(|(name, of)| {
        let values = all.iter().map(of).collect();
        Channel { name: (*name).to_owned(), values: Values::Count(values) }
    });
    let mut channels: Vec<Channel> = measures.chain(counts).collect();
    if used.patches > 0 {
        let patch = |seen: &Seen| seen.met.as_ref().and_then(|met| viewed.patch_at(met.surface, met.at));
        let values = all.par_iter().map(|seen| patch(seen).unwrap_or(NONE)).collect();
        channels.push(Channel { name: PATCH.to_owned(), values: Values::Count(values) });
    }
    Ok(Channels { size: view.size, all: channels })
}

fn seen(model: &Model, ray: &RayLine, outcome: &Outcome, work: Work) -> Seen {
    let (status, found) = match outcome {
        Outcome::Miss => (0, None),
        Outcome::Hit(found) => {
            let status = match found.incidence {
                Incidence::Crossing => 1,
                Incidence::Grazing => 2,
                Incidence::Contact => 5,
            };
            (status, Some(found))
        }
        // The closest that was found by then is no answer.
        Outcome::GaveUp { .. } => (3, None),
        Outcome::Refused(_) | Outcome::Invalid => (4, None),
    };
    let met = found.map(|found| {
        let length = ray.direction.iter().map(|part| part * part).sum::<f64>().sqrt();
        Met {
            distance: found.t * length,
            point: [0, 1, 2].map(|k| ray.origin[k] + found.t * ray.direction[k]),
            normal: found.normal.there(),
            at: [found.u, found.v],
            surface: found.surface,
            residual: model.surfaces.get(found.surface).map_or(f64::NAN, |surface| residual(surface, ray, found)),
        }
    });
    Seen { met, status, work }
}
