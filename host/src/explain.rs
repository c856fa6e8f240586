//! The story of one pixel's rays: what the method did for each, as the kernel tells it.
//!
//! The scan line is traced once more, to the same bits, in numbers that listen; see [`patchray::told`].

pub mod words;

use std::cell::RefCell;

use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray::story::Event;
use patchray::told::{Listener, Told};

use crate::lower::{FromFile, LowerError, Lowered, Stages};
use crate::prepared::{Others, is_rational, tracers};
use crate::scanline::{Outcome, Tally, rays_of};
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::scene::rays::RayLine;
use crate::scene::trace::Precision;
use crate::settings::Settings;
use patchray::limits::Work;

/// What became of one ray, and how.
#[derive(Clone, Debug)]
pub struct Story {
    /// The ray.
    pub ray: RayLine,
    /// What became of it.
    pub outcome: Outcome,
    /// What it took.
    pub work: Work,
    /// What the kernel told, in order.
    pub events: Vec<Event>,
    /// How long a unit of the scene's frame is, in the scene's units.
    pub unit: f64,
}

thread_local! {
    static HEARD: RefCell<Vec<Event>> = const { RefCell::new(Vec::new()) };
}

/// Writes down what it hears, on the thread that traces.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct Ear;

impl Listener for Ear {
    fn hear(event: Event) {
        HEARD.with_borrow_mut(|heard| heard.push(event));
    }
}

type Heard<S> = Told<S, Ear>;

/// The stories of a pixel's rays, one for each of its samples; `pixel` is its place from the left and the top.
///
/// # Errors
/// As [`Viewed::build`](crate::viewed::Viewed::build).
pub fn of_pixel(model: &Model, settings: &Settings, view: &View, pixel: [u32; 2]) -> Result<Vec<Story>, LowerError> {
    match (settings.precision, is_rational(model)) {
        (Precision::F32, false) => stories::<Plain<Heard<f32>>>(model, settings, view, pixel),
        (Precision::F64, false) => stories::<Plain<Heard<f64>>>(model, settings, view, pixel),
        (Precision::F32, true) => stories::<Weighted<Heard<f32>>>(model, settings, view, pixel),
        (Precision::F64, true) => stories::<Weighted<Heard<f64>>>(model, settings, view, pixel),
    }
}

fn stories<P: FromFile>(
    model: &Model,
    settings: &Settings,
    view: &View,
    [px, py]: [u32; 2],
) -> Result<Vec<Story>, LowerError> {
    let mut lowered = Lowered::<P>::for_picture(model, Stages::of(settings.method), settings, view)?;
    let unit = lowered.scene().frame().unscale().to_f64();
    let tracer = tracers(&mut lowered, view, settings, Others { closest: false, any: false })?.picture;
    let side = view.sampling.side();
    let mut stories = Vec::new();
    for line in side * py..side * (py + 1) {
        let samples = view.scan_line(line);
        let rays = rays_of(view, line, &samples);
        let (mut outcomes, mut tally) = (Vec::new(), Tally { each: Some(Vec::new()), ..Tally::default() });
        HEARD.take();
        tracer.lane().trace_line(&samples, &rays, &mut outcomes, &mut tally);
        let heard = HEARD.take();
        let mut told = heard.split(|event| *event == Event::Ray).skip(1);
        let works = tally.each.unwrap_or_default();
        for (sample, ((ray, outcome), work)) in (0..).zip(rays.into_iter().zip(outcomes).zip(works)) {
            // The kernel begins with none that it refuses.
            let begun = !matches!(outcome, Outcome::Refused(_) | Outcome::Invalid);
            let events = if begun { told.next().unwrap_or_default() } else { &[] };
            if sample / side == px {
                stories.push(Story { ray, outcome, work, events: events.to_vec(), unit });
            }
        }
    }
    Ok(stories)
}
