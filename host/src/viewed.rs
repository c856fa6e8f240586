//! A scene made ready for one picture and one method: by the kernel's view of it if the method needs one, else for rays one by
//! one.

use std::time::Instant;

use patchray::limits::Work;

use crate::lower::{LowerError, Stages};
use crate::memory::Bytes;
use crate::prepared::{Others, Prepared, Tracers};
use crate::scanline::Tracer;
use crate::scene::appearance::Appearance;
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::settings::Settings;
use crate::stats::Used;

/// How a picture is to be traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wishes {
    /// Whether rays that are none of the picture's are traced, such as those that mirrors send on.
    pub others: bool,
    /// Whether rays are traced that ask whether something lies on them, such as those to lights.
    pub any: bool,
}

impl Wishes {
    /// Primary rays alone.
    pub const PRIMARY: Self = Wishes { others: false, any: false };

    /// What drawing a scene of this appearance takes.
    pub fn of(appearance: &Appearance) -> Self {
        let others = appearance.materials.iter().any(|material| material.reflect > 0.0);
        Wishes { others, any: appearance.has_shadow_rays() }
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
    /// Seconds from the model to here.
    seconds: f64,
}

impl Viewed {
    /// Lowers the model and takes the memory of the view, if the method needs one.
    ///
    /// # Errors
    /// As [`Prepared::for_picture`].
    pub fn build(model: &Model, settings: &Settings, picture: &View, wishes: Wishes) -> Result<Self, LowerError> {
        let begin = Instant::now();
        let Settings { method, .. } = *settings;
        let mut stages = Stages::of(method);
        if wishes.others {
            stages = stages.and(Stages::of(method.of_any_rays()));
        }
        if wishes.any {
            stages = stages.and(Stages::of(method.of_any_hits()));
        }
        let prepared = Prepared::for_picture(model, stages, settings, picture)?;
        let seconds = begin.elapsed().as_secs_f64();
        Ok(Viewed { prepared, settings: *settings, picture: *picture, wishes, stages, seconds })
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
        self.prepared.worst_case(&self.settings)
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
    /// As [`Prepared::tracers`].
    pub fn tracers(&mut self) -> Result<(Tracers<'_>, Used), LowerError> {
        let begin = Instant::now();
        let Viewed { prepared, settings, picture, wishes, stages, seconds } = self;
        let mut bytes: Bytes = prepared.bytes(*stages);
        bytes.add_all(&prepared.view_bytes());
        let (surfaces, patches) = (prepared.surfaces(), prepared.patches());
        let others = Others { closest: wishes.others, any: wishes.any };
        let tracers = prepared.tracers(picture, settings, others)?;
        let mut lane = tracers.picture.lane_bytes();
        if let Some(any) = &tracers.any {
            lane.scratch += any.lane_bytes().scratch;
        }
        let prepare_seconds = *seconds + begin.elapsed().as_secs_f64();
        Ok((tracers, Used { surfaces, patches, bytes, prepare_seconds, lane }))
    }
}
