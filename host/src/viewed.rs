//! A scene made ready for one picture: by the kernel's view of it where there is one, else for rays one by one.

use std::time::Instant;

use patchray::limits::Work;

use crate::lower::{LowerError, Stages};
use crate::memory::Bytes;
use crate::prepared::{Others, Prepared, Tracers};
use crate::scanline::Tracer;
use crate::scanline::view::LineOptions;
use crate::scene::appearance::Appearance;
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::scene::trace::Method;
use crate::settings::Settings;
use crate::stats::Used;

/// How a picture is to be traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wishes {
    /// Whether to trace the rays of a scan line by what they share, where that can be done. Else they are traced one by
    /// one, which is for comparing the two.
    pub view: bool,
    /// Whether `clipping` is given patches, by which a scan line tells what part of a surface a ray may meet. On the
    /// common view, one thread, they halve the time per ray (677 to 333 ns), and the 27 ms that making them takes are
    /// won back after some 80,000 rays; but the scene then takes 2.3 MB instead of 31 KB.
    pub patches: bool,
    /// Whether rays leave something to the next: see [`LineOptions::coherence`].
    pub coherence: bool,
    /// Whether rays that are none of the picture's are traced, such as those that mirrors send on.
    pub others: bool,
    /// Whether rays are traced that ask whether something lies on them, such as those to lights.
    pub any: bool,
}

impl Wishes {
    /// Primary rays alone, by the means of the method.
    pub const PRIMARY: Self = Wishes { view: true, patches: false, coherence: true, others: false, any: false };

    /// What drawing a scene of this appearance takes.
    pub fn of(appearance: &Appearance) -> Self {
        let others = appearance.materials.iter().any(|material| material.reflect > 0.0);
        Wishes { others, any: appearance.has_shadow_rays(), ..Wishes::PRIMARY }
    }
}

/// A scene made ready for one picture and one method.
#[derive(Clone, Debug)]
pub struct Viewed {
    prepared: Prepared,
    settings: Settings,
    picture: View,
    wishes: Wishes,
    stages: Stages,
    /// Whether there is a view.
    view: bool,
    /// Seconds from the model to here.
    seconds: f64,
}

impl Viewed {
    /// Lowers the model and takes the memory of the view.
    ///
    /// # Errors
    /// As [`Prepared::build`]; and a picture that its method cannot trace: [`LowerError::NoView`].
    pub fn build(model: &Model, settings: &Settings, picture: &View, wishes: Wishes) -> Result<Self, LowerError> {
        let begin = Instant::now();
        let Settings { method, .. } = *settings;
        let no_view = match wishes.view {
            true => Prepared::build(model, Stages::NONE, settings)?.no_view(picture),
            false => Some("its rays are to be traced one by one".to_owned()),
        };
        let view = no_view.is_none();
        if let Some(reason) = no_view.filter(|_| method.needs_view()) {
            return Err(LowerError::NoView { method: method.name(), reason });
        }
        let rays = Stages::of(method.of_any_rays());
        let of_view = match method {
            Method::Clipping if wishes.patches => Stages::PATCHES,
            _ => Stages::of_view(method),
        };
        let mut stages = match (view, wishes.others) {
            (false, _) => rays,
            (true, false) => of_view,
            (true, true) => of_view.and(rays),
        };
        if wishes.any {
            stages = stages.and(Stages::of(method.of_any_hits()));
        }
        let mut prepared = Prepared::build(model, stages, settings)?;
        if view {
            prepared.take_view(picture, settings)?;
        }
        let seconds = begin.elapsed().as_secs_f64();
        Ok(Viewed { prepared, settings: *settings, picture: *picture, wishes, stages, view, seconds })
    }

    /// The same for another method that needs the same stages, and for another picture from the same camera: what was
    /// made is copied and not made again.
    ///
    /// # Errors
    /// A picture that cannot be traced as a view.
    pub fn with(&self, method: Method, coherence: bool, picture: &View) -> Result<Self, LowerError> {
        if let Some(reason) = self.prepared.no_view(picture) {
            return Err(LowerError::NoView { method: method.name(), reason });
        }
        let (settings, wishes) = (Settings { method, ..self.settings }, Wishes { coherence, ..self.wishes });
        Ok(Viewed { settings, wishes, picture: *picture, ..self.clone() })
    }

    /// Whether the rays of a scan line are traced by what they share.
    pub fn has_view(&self) -> bool {
        self.view
    }

    /// The settings that it was made for.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// As [`Prepared::patch_at`].
    pub fn patch_at(&self, surface: usize, at: [f64; 2]) -> Option<u32> {
        self.prepared.patch_at(surface, at)
    }

    /// The most work that one of the picture's rays can take.
    pub fn worst_case(&self) -> Work {
        if self.view {
            self.prepared.worst_case_in_view(&self.settings)
        } else {
            self.prepared.worst_case(&self.settings)
        }
    }

    /// The tracer of the picture's scan lines, and what was used for it.
    ///
    /// # Errors
    /// As [`Viewed::tracers`].
    pub fn tracer(&mut self) -> Result<(Box<dyn Tracer + '_>, Used), LowerError> {
        self.tracers().map(|(tracers, used)| (tracers.picture, used))
    }

    /// The tracers of the picture's rays, and what was used for them.
    ///
    /// # Errors
    /// As [`Prepared::view_tracers`].
    pub fn tracers(&mut self) -> Result<(Tracers<'_>, Used), LowerError> {
        let begin = Instant::now();
        let Viewed { prepared, settings, picture, wishes, stages, view, seconds } = self;
        let mut bytes: Bytes = prepared.bytes(*stages);
        bytes.add_all(&prepared.view_bytes(*stages));
        let (surfaces, patches) = (prepared.surfaces(), prepared.patches());
        let others = Others { closest: wishes.others, any: wishes.any };
        let tracers = if *view {
            let options = LineOptions { patches: stages.patches, coherence: wishes.coherence };
            prepared.view_tracers(picture, settings, options, others)?
        } else {
            prepared.tracers(settings, others)
        };
        let mut lane = tracers.picture.lane_bytes();
        if let Some(any) = &tracers.any {
            lane.scratch += any.lane_bytes().scratch;
        }
        let prepare_seconds = *seconds + begin.elapsed().as_secs_f64();
        Ok((tracers, Used { surfaces, patches, bytes, prepare_seconds, lane }))
    }
}
