//! Scene files: TOML that names surfaces and says how to look at them.
//!
//! Only `surfaces` and `[camera]` are needed; the fields and their defaults are those of [`Description`] and its parts.
//! Files of surfaces, in any format of [`patches`], are taken from the folder of the scene file.
//!
//! ```
//! use patchray_host::scene::file;
//! let text = r#"
//!     surfaces = [{ file = "../patches/teapot.bpt" }]
//!     background = [0.9, 0.9, 1]
//!
//!     [image]
//!     size = [640, 480]
//!
//!     [camera] # or by vectors: eye, forward, right, up
//!     eye = [8, -9, 7]
//!     look_at = [0, 0, 1.5]
//!     up = [0, 0, 1]
//!     fov = 35
//!
//!     [light]
//!     position = [5, -10, 15]
//!     colour = [1, 1, 0.9]
//!
//!     [material]
//!     colour = [0.8, 0.5, 0.3]
//!     ambient = 0.1
//!     diffuse = 0.7
//!     highlight = 0.4
//!     shininess = 60
//!
//!     [trace]
//!     method = "clipping-coherent"
//!     precision = "f64"
//!     acceptance = "paper"
//!     newton_iterations = 12
//!     newton_starts = 3
//!     clip_threshold = 0.2
//!     flatness = 0.0005
//!     grid_density = 4.0
//!     threads = 2
//!
//!     [trace.limits]
//!     voxels = 10000
//! "#;
//! let description = file::parse("scene.toml", text)?;
//! assert_eq!(description.image.size, [640, 480]);
//! assert_eq!(description.trace.limits[0].value, 10_000);
//! # Ok::<(), patchray_host::scene::error::InputError>(())
//! ```
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use super::appearance::{BACKGROUND, Image, ImageTable, Light, LightTable, Material, MaterialTable};
use super::camera::{Camera, CameraTable};
use super::check::Check;
use super::error::{InputError, OnInvalid, Skipped};
use super::model::Model;
use super::nearest::did_you_mean;
use super::patches::{self, PatchFile};
use super::source::SourceText;
use super::spline::SplineSummary;
use super::trace::{TraceSettings, TraceTable};

/// What a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// The table `[image]`.
    pub image: Image,
    /// The table `[camera]`.
    pub camera: Camera,
    /// The table `[light]`.
    pub light: Light,
    /// The table `[material]`.
    pub material: Material,
    /// The colour where no surface is: red, green and blue, linear, 0 to 1. By default white.
    pub background: [f64; 3],
    /// The list `surfaces`, at least one.
    pub surfaces: Vec<SurfaceSource>,
    /// The table `[trace]`.
    pub trace: TraceSettings,
}

/// An entry of `surfaces`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceSource {
    /// The patch file as written, taken from the folder of the scene file.
    pub file: PathBuf,
    /// The bytes of the scene file that name it.
    pub span: Range<usize>,
}

/// A scene file with the surfaces that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The text of the scene file, for errors of later checks.
    pub source: SourceText,
    /// What it says.
    pub description: Description,
    /// The surfaces of all its files one after another, each with its number in its own file.
    pub model: Model,
    /// The files, in order.
    pub files: Vec<SceneFile>,
}

/// A patch file of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// Its path, from the current folder.
    pub path: PathBuf,
    /// Which surfaces of the scene's model come from it, by index there.
    pub surfaces: Range<usize>,
    /// The B-splines whose pieces are among them.
    pub splines: Vec<SplineSummary>,
    /// Its surfaces that were left out; empty unless the reader was told to skip.
    pub skipped: Vec<Skipped>,
}

impl Scene {
    /// The file that holds the surface with this index in the model.
    pub fn file_of(&self, index: usize) -> Option<&SceneFile> {
        self.files.iter().find(|file| file.surfaces.contains(&index))
    }
}

/// Reads the scene file at `path` and the patch files that it names; `on_invalid` is for the surfaces in those.
///
/// # Errors
/// One of the files cannot be read, is not in its format, or says something that cannot be.
pub fn read(path: &Path, on_invalid: OnInvalid) -> Result<Scene, InputError> {
    let source = SourceText::read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    load(source, |file| {
        let path = folder.join(file);
        patches::read(&path, on_invalid).map(|file| (path, file))
    })
}

/// The scene that `source` describes, with patch files fetched by `fetch`, which gives their path too.
pub(super) fn load(
    source: SourceText,
    mut fetch: impl FnMut(&Path) -> Result<(PathBuf, PatchFile), InputError>,
) -> Result<Scene, InputError> {
    let description = describe(&source)?;
    let (mut model, mut files) = (Model::default(), Vec::new());
    for surfaces in &description.surfaces {
        let (path, mut file) = fetch(&surfaces.file).map_err(|error| match error {
            InputError::Unreadable { .. } => source.refuse(
                surfaces.span.clone(),
                error.to_string(),
                "this file",
                "check the path; it is taken from the folder of the scene file",
            ),
            refused => refused,
        })?;
        let first = model.surfaces.len();
        model.surfaces.append(&mut file.model.surfaces);
        let surfaces = first..model.surfaces.len();
        files.push(SceneFile { path, surfaces, splines: file.splines, skipped: file.skipped });
    }
    Ok(Scene { source, description, model, files })
}

/// Reads `text`, a whole scene file, without the files that it names; `name` stands for its path in errors.
///
/// # Errors
/// The text is not TOML, or says something that cannot be.
pub fn parse(name: &str, text: &str) -> Result<Description, InputError> {
    describe(&SourceText::new(name, text))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DescriptionTable {
    image: Option<ImageTable>,
    camera: Option<Spanned<CameraTable>>,
    light: Option<LightTable>,
    material: Option<MaterialTable>,
    background: Option<Spanned<Vec<f64>>>,
    surfaces: Option<Spanned<Vec<SurfaceTable>>>,
    trace: Option<TraceTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceTable {
    file: Spanned<String>,
}

fn describe(source: &SourceText) -> Result<Description, InputError> {
    let table: DescriptionTable = toml::from_str(source.text()).map_err(|error| refusal(source, &error))?;
    let check = Check { source };
    let missing =
        |what: &str, help: &str| source.refuse(0..0, format!("the scene has no {what}"), "in this file", help);
    let surfaces = match table.surfaces {
        Some(list) if !list.get_ref().is_empty() => list.into_inner(),
        _ => {
            let help = "name the patch files at the top: `surfaces = [{ file = \"teapot.bpt\" }]`";
            return Err(missing("surfaces", help));
        }
    };
    let Some(camera) = &table.camera else {
        let help = "add a table `[camera]` with `eye` and `look_at`, or with `eye`, `forward`, `right` and `up`";
        return Err(missing("camera", help));
    };
    Ok(Description {
        image: table.image.map_or(Ok(Image::default()), |image| image.check(&check))?,
        camera: CameraTable::check(camera, &check)?,
        light: table.light.map_or(Ok(Light::default()), |light| light.check(&check))?,
        material: table.material.map_or(Ok(Material::default()), |material| material.check(&check))?,
        background: table.background.map_or(Ok(BACKGROUND), |colour| check.colour("`background`", &colour))?,
        surfaces: surfaces
            .into_iter()
            .map(|entry| SurfaceSource { span: entry.file.span(), file: entry.file.into_inner().into() })
            .collect(),
        trace: table.trace.map_or(Ok(TraceSettings::default()), |trace| trace.check(&check))?,
    })
}

/// The refusal for what the TOML reader did not accept.
fn refusal(source: &SourceText, error: &toml::de::Error) -> InputError {
    let message = error.message().trim().replace('\n', ": ");
    // An unknown name is told with the names that would do: "unknown field `x`, expected one of `a`, `b`".
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let (message, label, help) = match &names[..] {
        [unknown, known @ ..] if message.starts_with("unknown ") && !known.is_empty() => (
            format!("there is no `{unknown}` here{}", did_you_mean(unknown, known).unwrap_or_default()),
            "unknown",
            format!("write one of {}", known.join(", ")),
        ),
        _ if message.starts_with("missing field") => (message.clone(), "in here", "add the field".to_owned()),
        _ if message.starts_with("invalid") => (message.clone(), "not as expected", "correct this value".to_owned()),
        _ => (message.clone(), "here", "the file is TOML: `name = value` and `[table]`; strings in quotes".to_owned()),
    };
    source.refuse(error.span().unwrap_or(0..0), message, label, help)
}

#[cfg(test)]
mod tests;
