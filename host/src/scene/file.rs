//! Scene files: TOML that names surfaces and says how to look at them.
//!
//! Every field is described in `fixtures/scenes/README.md`, with an example that uses them all. The least that there can be:
//!
//! ```
//! use patchray_host::scene::file;
//! let text = r#"
//!     surfaces = [{ torus = { major = 2, minor = 0.5 }, transform = [{ translate = [0, 0, 1] }] }]
//!
//!     [camera]
//!     eye = [8, -9, 7]
//!     look_at = [0, 0, 1.5]
//! "#;
//! let description = file::parse("scene.toml", text)?;
//! assert_eq!(description.image.size, [512, 512]);
//! # Ok::<(), patchray_host::scene::error::InputError>(())
//! ```
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use super::appearance::{Appearance, BACKGROUND, Image, ImageTable, Material, MaterialTable};
use super::assemble::{Assembled, assemble};
use super::camera::{Camera, CameraTable};
use super::check::Check;
use super::contents::{self, Contents, EntryTable, GroupTable, Names};
use super::error::{InputError, OnInvalid, Skipped};
use super::light::{Light, LightTable};
use super::model::Model;
use super::patches::{self, PatchFile};
use super::polygon::PolygonTable;
use super::source::SourceText;
use super::spline::SplineSummary;
use super::trace::{TraceSettings, TraceTable};
use refusal::refusal;

mod refusal;
mod strict;

/// What a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// The table `[image]`.
    pub image: Image,
    /// The table `[camera]`.
    pub camera: Camera,
    /// The table `[light]`, or the tables `[[lights]]`. By default one light.
    pub lights: Vec<Light>,
    /// The table `[material]`: of everything that names no other.
    pub material: Material,
    /// The tables of `[materials]`, sorted by name.
    pub materials: Vec<Material>,
    /// The colour where there is nothing: red, green and blue, linear, 0 to 1. By default white.
    pub background: [f64; 3],
    /// The lists `surfaces`, at least one, and `polygons`.
    pub contents: Contents,
    /// The tables of `[groups]`, sorted by name.
    pub groups: Vec<Contents>,
    /// The table `[trace]`.
    pub trace: TraceSettings,
}

/// A scene file with the surfaces that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The text of the scene file, for errors of later checks.
    pub source: SourceText,
    /// What it says.
    pub description: Description,
    /// The surfaces of all its entries one after another, in their places, each with its number in its own file or shape.
    pub model: Model,
    /// Where they come from, in order.
    pub files: Vec<SceneFile>,
    /// What they look like, and the polygons.
    pub appearance: Appearance,
}

/// A patch file of a scene, as often as the scene uses it. For a generated shape it is the scene file itself.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// Its path, from the current folder.
    pub path: PathBuf,
    /// Which surfaces of the scene's model come from it, by index there.
    pub surfaces: Range<usize>,
    /// The B-splines whose pieces are among them.
    pub splines: Vec<SplineSummary>,
    /// Its surfaces that were left out, at its first use; empty unless the reader was told to skip.
    pub skipped: Vec<Skipped>,
}

impl Scene {
    /// Where the surface with this index in the model comes from.
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
    fetch: impl FnMut(&Path) -> Result<(PathBuf, PatchFile), InputError>,
) -> Result<Scene, InputError> {
    let description = describe(&source)?;
    let Description { contents, groups, lights, material, materials, background, .. } = &description;
    let Assembled { model, files, materials: of_surfaces, polygons } = assemble(&source, contents, groups, fetch)?;
    // The scene's own material comes first.
    let index = |named: Option<usize>| named.map_or(0, |named| named + 1);
    let appearance = Appearance {
        lights: lights.clone(),
        materials: [material].into_iter().chain(materials).copied().collect(),
        surfaces: of_surfaces.into_iter().map(index).collect(),
        polygons: polygons.into_iter().map(|(polygon, named)| (polygon, index(named))).collect(),
        background: *background,
    };
    Ok(Scene { source, description, model, files, appearance })
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
    lights: Option<Spanned<Vec<LightTable>>>,
    material: Option<MaterialTable>,
    #[serde(default)]
    materials: BTreeMap<Spanned<String>, MaterialTable>,
    background: Option<Spanned<Vec<f64>>>,
    surfaces: Option<Vec<Spanned<EntryTable>>>,
    #[serde(default)]
    polygons: Vec<PolygonTable>,
    #[serde(default)]
    groups: BTreeMap<Spanned<String>, GroupTable>,
    trace: Option<TraceTable>,
}

fn describe(source: &SourceText) -> Result<Description, InputError> {
    let table: DescriptionTable = strict::from_str(source.text()).map_err(|error| refusal(source, &error))?;
    let check = Check { source };
    let missing =
        |what: &str, help: &str| source.refuse(0..0, format!("the scene has no {what}"), "in this file", help);
    let surfaces = match table.surfaces {
        Some(list) if !list.is_empty() => list,
        _ => {
            let help = "name the patch files at the top: `surfaces = [{ file = \"teapot.bpt\" }]`";
            return Err(missing("surfaces", help));
        }
    };
    let Some(camera) = &table.camera else {
        let help = "add a table `[camera]` with `eye` and `look_at`, or with `eye`, `forward`, `right` and `up`";
        return Err(missing("camera", help));
    };
    let names = Names {
        materials: table.materials.keys().map(|name| name.get_ref().as_str()).collect(),
        groups: table.groups.keys().map(|name| name.get_ref().as_str()).collect(),
    };
    Ok(Description {
        image: table.image.map_or(Ok(Image::default()), |image| image.check(&check))?,
        camera: CameraTable::check(camera, &check)?,
        lights: lights(table.light, table.lights, &check)?,
        material: table.material.map_or(Ok(Material::default()), |material| material.check(&check))?,
        materials: table.materials.values().map(|material| material.check(&check)).collect::<Result<_, _>>()?,
        background: table.background.map_or(Ok(BACKGROUND), |colour| check.colour("`background`", &colour))?,
        contents: Contents::check(&surfaces, &table.polygons, &names, &check)?,
        groups: contents::groups(&table.groups, &names, &check)?,
        trace: table.trace.map_or(Ok(TraceSettings::default()), |trace| trace.check(&check))?,
    })
}

/// The lights: one, or a list, which may be empty.
fn lights(
    one: Option<LightTable>,
    list: Option<Spanned<Vec<LightTable>>>,
    check: &Check,
) -> Result<Vec<Light>, InputError> {
    match (one, list) {
        (None, None) => Ok(vec![Light::default()]),
        (Some(light), None) => Ok(vec![light.check(check)?]),
        (None, Some(list)) => list.get_ref().iter().map(|light| light.check(check)).collect(),
        (Some(_), Some(list)) => Err(check.source.refuse(
            list.span(),
            "there are both `light` and `lights`",
            "one or the other",
            "write a table `[[lights]]` for each light",
        )),
    }
}

#[cfg(test)]
mod tests;
