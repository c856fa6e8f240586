//! Loading what a command works on: a scene or a patch file, without what cannot be traced.

use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use super::{Failure, say};
use crate::lower::{LowerError, Stages};
use crate::prepared::{Prepared, unfit_for};
use crate::scene::bpt;
use crate::scene::error::{OnInvalid, Skipped};
use crate::scene::file::{self, Description, Scene};
use crate::scene::model::Model;
use crate::scene::trace::Precision;
use crate::settings::{Flags, Settings};

/// Surfaces, and how to trace them.
pub struct Loaded {
    /// The surfaces.
    pub model: Model,
    /// Which of them come from which file, by index.
    pub files: Vec<(String, Range<usize>)>,
    /// What the scene file says, if there is one.
    pub description: Option<Description>,
    /// How to trace.
    pub settings: Settings,
}

/// Loads a scene file and the patch files that it names.
///
/// # Errors
/// A file is refused.
pub fn scene(path: &Path, flags: &Flags) -> Result<Loaded, Failure> {
    let scene = file::read(path, flags.on_invalid())?;
    let Scene { source, description, model, files } = scene;
    let settings = Settings::of_scene(flags, &description.trace, &source)?;
    for file in &files {
        name_skipped(&file.skipped);
    }
    let files = files.into_iter().map(|file| (file.path.display().to_string(), file.surfaces)).collect();
    Loaded { model, files, description: Some(description), settings }.fit(flags.on_invalid())
}

/// Loads a patch file; `-` is standard input.
///
/// # Errors
/// The file is refused.
pub fn patches(path: &Path, flags: &Flags) -> Result<Loaded, Failure> {
    let file = bpt::read(path, flags.on_invalid())?;
    name_skipped(&file.skipped);
    let files = vec![(path.display().to_string(), 0..file.model.surfaces.len())];
    let settings = Settings::of_flags(flags);
    Loaded { model: file.model, files, description: None, settings }.fit(flags.on_invalid())
}

fn name_skipped(skipped: &[Skipped]) {
    for one in skipped {
        say(format_args!("{one}"));
    }
}

impl Loaded {
    /// Refuses surfaces that the precision cannot hold, or leaves them out.
    fn fit(mut self, on_invalid: OnInvalid) -> Result<Self, Failure> {
        let unfit = unfit_for(&self.model, self.settings.precision);
        let precision = match self.settings.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        };
        for (index, reason) in &unfit {
            let file = self.file_of(*index).to_owned();
            let number = self.number_of(*index);
            if on_invalid == OnInvalid::Skip {
                say(format_args!("surface {number} left out ({file}): in {precision}, {reason}"));
                continue;
            }
            return Err(Failure::Refused {
                file,
                reason: format!("in {precision}, surface {number} is not valid: {reason}"),
                help: "use --precision f64 or other units, or --skip-invalid to leave such surfaces out".to_owned(),
            });
        }
        // From the last, so that the indices of those before stay.
        for (index, _) in unfit.iter().rev() {
            self.model.surfaces.remove(*index);
            for (_, range) in &mut self.files {
                range.start -= usize::from(range.start > *index);
                range.end -= usize::from(range.end > *index);
            }
        }
        Ok(self)
    }

    /// The file that holds the surface with this index in the model.
    pub fn file_of(&self, index: usize) -> &str {
        self.files.iter().find(|(_, range)| range.contains(&index)).map_or("", |(file, _)| file)
    }

    /// The number in its file of the surface with this index in the model.
    pub fn number_of(&self, index: usize) -> usize {
        self.model.surfaces.get(index).map_or(index, |surface| surface.number)
    }

    /// Lowers the surfaces for the method of the settings, and says how many seconds that took.
    ///
    /// # Errors
    /// As [`Prepared::build`].
    pub fn prepare(&self) -> Result<(Prepared, f64), LowerError> {
        let begin = Instant::now();
        let prepared = Prepared::build(&self.model, Stages::of(self.settings.method), &self.settings)?;
        Ok((prepared, begin.elapsed().as_secs_f64()))
    }
}
