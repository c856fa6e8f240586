//! Loading what a command works on: a scene or a patch file, without what cannot be traced.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use super::outputs::Outputs;
use super::{Failure, hear_parts, say};
use crate::lower::{LowerError, Stages};
use crate::prepared::{Prepared, unfit_for};
use crate::scene::appearance::Appearance;
use crate::scene::error::{OnInvalid, Skipped};
use crate::scene::file::{self, Description, Scene};
use crate::scene::model::Model;
use crate::scene::patches;
use crate::scene::spline::SplineSummary;
use crate::scene::trace::Precision;
use crate::settings::{Flags, Settings};
use crate::stats::Asked;

/// Surfaces, and how to trace them.
pub struct Loaded {
    /// The surfaces.
    pub model: Model,
    /// Which of them come from which file.
    pub files: Vec<LoadedFile>,
    /// What the scene file says, if there is one, and what its surfaces look like.
    pub scene: Option<(Description, Appearance)>,
    /// How to trace.
    pub settings: Settings,
}

/// A file of surfaces.
pub struct LoadedFile {
    /// Its name, as given.
    pub name: String,
    /// The surfaces that come from it, by their index in the model.
    pub surfaces: Range<usize>,
    /// The B-splines whose pieces are among them.
    pub splines: Vec<SplineSummary>,
}

/// Loads a scene file, which `.toml` at the end of its name says it is, or else a patch file.
///
/// # Errors
/// A file is refused, or one of `outputs` would replace it.
pub(crate) fn scene_or_patches(path: &Path, flags: &Flags, outputs: &Outputs) -> Result<Loaded, Failure> {
    let is_scene = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    if is_scene { scene(path, flags, outputs) } else { patches(path, flags, outputs) }
}

/// Loads a scene file and the patch files that it names.
///
/// # Errors
/// A file is refused, or one of `outputs` would replace it.
pub(crate) fn scene(path: &Path, flags: &Flags, outputs: &Outputs) -> Result<Loaded, Failure> {
    outputs.spare([path])?;
    let scene = file::read(path, flags.on_invalid())?;
    let Scene { source, description, model, files, appearance } = scene;
    outputs.spare(files.iter().map(|file| file.path.as_path()))?;
    let settings = Settings::of_scene(flags, &description.trace, &source)?;
    hear_parts(Some(settings.method), Asked::Closest, settings.parts)?;
    for file in &files {
        name_skipped(&file.skipped);
    }
    let files = files.into_iter().map(|file| LoadedFile {
        name: file.path.display().to_string(),
        surfaces: file.surfaces,
        splines: file.splines,
    });
    let files = files.inspect(LoadedFile::name_trims).collect();
    Loaded { model, files, scene: Some((description, appearance)), settings }.fit(flags.on_invalid())
}

/// Loads a patch file; `-` is standard input.
///
/// # Errors
/// The file is refused, or one of `outputs` would replace it.
pub(crate) fn patches(path: &Path, flags: &Flags, outputs: &Outputs) -> Result<Loaded, Failure> {
    outputs.spare([path])?;
    let file = patches::read(path, flags.on_invalid())?;
    name_skipped(&file.skipped);
    let name = path.display().to_string();
    let files = vec![LoadedFile { name, surfaces: 0..file.model.surfaces.len(), splines: file.splines }];
    files.iter().for_each(LoadedFile::name_trims);
    let settings = Settings::of_flags(flags);
    hear_parts(Some(settings.method), Asked::Closest, settings.parts)?;
    Loaded { model: file.model, files, scene: None, settings }.fit(flags.on_invalid())
}

fn name_skipped(skipped: &[Skipped]) {
    for one in skipped {
        say(format_args!("{one}"));
    }
}

impl LoadedFile {
    /// Says which surfaces are larger than their file means them to be.
    fn name_trims(&self) {
        for spline in self.splines.iter().filter(|spline| spline.trims_ignored > 0) {
            let SplineSummary { surface, trims_ignored, .. } = spline;
            say(format_args!(
                "surface {surface} is taken whole ({}): trimming curves ignored: {trims_ignored}",
                self.name
            ));
        }
    }
}

impl Loaded {
    /// Refuses surfaces that the precision cannot hold, or leaves them out; a B-spline with all its pieces.
    fn fit(mut self, on_invalid: OnInvalid) -> Result<Self, Failure> {
        // Ends: each turn leaves one out at least.
        loop {
            let unfit = unfit_for(&self.model, self.settings.precision);
            if unfit.is_empty() {
                return Ok(self);
            }
            self.leave_out(&unfit, on_invalid)?;
        }
    }

    fn leave_out(&mut self, unfit: &[(usize, String)], on_invalid: OnInvalid) -> Result<(), Failure> {
        let precision = match self.settings.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        };
        let mut left_out = BTreeSet::new();
        for (index, reason) in unfit {
            let Some(file) = self.file_of(*index) else {
                continue;
            };
            let (name, number) = (file.name.clone(), self.number_of(*index));
            if on_invalid == OnInvalid::Skip {
                if left_out.contains(index) {
                    continue;
                }
                say(format_args!("surface {number} left out ({name}): in {precision}, {reason}"));
                // The pieces of one surface follow one another.
                let range = file.surfaces.clone();
                let of_it = |piece: &usize| range.contains(piece) && self.number_of(*piece) == number;
                left_out.extend((range.start..=*index).rev().take_while(of_it));
                left_out.extend((*index..range.end).take_while(of_it));
                continue;
            }
            return Err(Failure::Refused {
                file: name,
                reason: format!("in {precision}, surface {number} is not valid: {reason}"),
                help: "use --precision f64 or other units, or --skip-invalid to leave such surfaces out".to_owned(),
            });
        }
        // From the last, so that the indices of those before stay.
        for &index in left_out.iter().rev() {
            let removed = self.model.surfaces.remove(index);
            if let Some((_, appearance)) = &mut self.scene {
                appearance.surfaces.remove(index);
            }
            for file in &mut self.files {
                if removed.knots.is_some() && file.surfaces.contains(&index) {
                    file.splines.retain(|spline| spline.surface != removed.number);
                }
                file.surfaces.start -= usize::from(file.surfaces.start > index);
                file.surfaces.end -= usize::from(file.surfaces.end > index);
            }
        }
        Ok(())
    }

    /// The file that holds the surface with this index in the model.
    pub fn file_of(&self, index: usize) -> Option<&LoadedFile> {
        self.files.iter().find(|file| file.surfaces.contains(&index))
    }

    /// The number in its file of the surface with this index in the model.
    pub fn number_of(&self, index: usize) -> usize {
        self.model.surfaces.get(index).map_or(index, |surface| surface.number)
    }

    /// The number under which answers name the surface with this index in the model: its number in the patch file, or in a
    /// scene, where two files may have the same ones, its number among all surfaces that are traced.
    pub fn answered_number_of(&self, index: usize) -> usize {
        if self.scene.is_some() { index } else { self.number_of(index) }
    }

    /// The parameters, as its file has them, of a point of the surface with this index in the model.
    pub fn parameters_of(&self, index: usize, u: f64, v: f64) -> [f64; 2] {
        self.model.surfaces.get(index).map_or([u, v], |surface| surface.parameters(u, v))
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
