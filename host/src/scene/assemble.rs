//! From what a scene file says to surfaces and polygons in their places: files read, shapes made, groups used.
use std::collections::HashMap;
use std::collections::hash_map;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::contents::{Contents, Entry, What};
use super::error::InputError;
use super::file::SceneFile;
use super::model::{Model, ModelSurface};
use super::patches::PatchFile;
use super::polygon::{Fault, Polygon};
use super::source::SourceText;
use super::transform::Transform;

/// The most entries and polygons that all uses of groups may put into a scene. Groups of groups would let a few lines ask
/// for more than there is memory for.
const MAX_PLACED: usize = 1 << 16;

/// The most surfaces of a scene: of bicubics some 700 MB before anything is traced. A torus of the most surfaces fits.
const MAX_SURFACES: usize = 1 << 20;

/// Surfaces and polygons in the scene's units.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Assembled {
    /// The surfaces, those of one entry after those of the one before.
    pub(super) model: Model,
    /// Where they come from, in order.
    pub(super) files: Vec<SceneFile>,
    /// For each surface the index of its material among the named ones; `None` for the scene's own.
    pub(super) materials: Vec<Option<usize>>,
    /// The polygons, each with its material likewise.
    pub(super) polygons: Vec<(Polygon, Option<usize>)>,
}

/// Where the contents of a scene or of a group are put, and of which material they are unless they name one.
#[derive(Clone, Copy, Debug)]
struct Place {
    transform: Transform,
    material: Option<usize>,
}

struct Assembler<'a, F> {
    source: &'a SourceText,
    groups: &'a [Contents],
    fetch: F,
    /// The files read so far, by name.
    read: HashMap<PathBuf, (PathBuf, PatchFile)>,
    /// How many entries and polygons groups have put into the scene.
    placed: usize,
    out: Assembled,
}

/// Puts everything where it belongs. `fetch` reads a file and gives its path too; each is read once.
pub(super) fn assemble(
    source: &SourceText,
    contents: &Contents,
    groups: &[Contents],
    fetch: impl FnMut(&Path) -> Result<(PathBuf, PatchFile), InputError>,
) -> Result<Assembled, InputError> {
    let mut assembler = Assembler { source, groups, fetch, read: HashMap::new(), placed: 0, out: Assembled::default() };
    assembler.put(contents, Place { transform: Transform::IDENTITY, material: None }, 0..0)?;
    // What is wrong is told also of a file that only unused groups name.
    for entry in groups.iter().flat_map(|group| &group.surfaces) {
        if let What::File(file) = &entry.what
            && !assembler.read.contains_key(file)
        {
            assembler.file(file, entry)?;
        }
    }
    Ok(assembler.out)
}

impl<F: FnMut(&Path) -> Result<(PathBuf, PatchFile), InputError>> Assembler<'_, F> {
    /// Puts the contents, which the bytes `span` of the scene file ask for, in their place. Ends since groups do not hold
    /// themselves.
    fn put(&mut self, contents: &Contents, place: Place, span: Range<usize>) -> Result<(), InputError> {
        for (polygon, material) in &contents.polygons {
            match polygon.transformed(&place.transform) {
                Ok(polygon) => self.out.polygons.push((polygon, material.or(place.material))),
                Err(Fault::TooLarge) => {
                    let message = "transforms make a polygon of this group too large";
                    return Err(self.source.refuse(span, message, "this group", "write smaller numbers"));
                }
                // One that its place makes too thin could not be seen either.
                Err(_) => {}
            }
        }
        for entry in &contents.surfaces {
            let place =
                Place { transform: entry.transform.then(place.transform), material: entry.material.or(place.material) };
            if place.transform.collapses() {
                let message = "the factors of `scale` of nested groups multiply to 0, which leaves nothing to see";
                return Err(self.source.refuse(entry.span.clone(), message, "of this", "write larger factors"));
            }
            match &entry.what {
                What::File(file) => {
                    let (path, mut file) = self.file(file, entry)?;
                    self.make_room(file.model.surfaces.len(), entry)?;
                    let surfaces = std::mem::take(&mut file.model.surfaces);
                    self.add(path, surfaces, file, place, entry)?;
                }
                What::Shape(shape) => {
                    let path = PathBuf::from(self.source.name());
                    self.make_room(shape.count(), entry)?;
                    self.add(path, shape.surfaces(), PatchFile::default(), place, entry)?;
                }
                What::Group(group) => {
                    let Some(group) = self.groups.get(*group) else {
                        continue;
                    };
                    self.placed += group.surfaces.len() + group.polygons.len();
                    if self.placed > MAX_PLACED {
                        return Err(self.source.refuse(
                            entry.span.clone(),
                            format!("groups put more than {MAX_PLACED} things into the scene"),
                            "more than that with this one",
                            "use the groups less often",
                        ));
                    }
                    self.put(group, place, entry.span.clone())?;
                }
            }
        }
        Ok(())
    }

    /// The file that an entry names; what was left out of it is told the first time only.
    fn file(&mut self, name: &Path, entry: &Entry) -> Result<(PathBuf, PatchFile), InputError> {
        match self.read.entry(name.to_owned()) {
            hash_map::Entry::Occupied(known) => {
                let (path, file) = known.get().clone();
                Ok((path, PatchFile { skipped: Vec::new(), ..file }))
            }
            hash_map::Entry::Vacant(new) => {
                let read = (self.fetch)(name).map_err(|error| match error {
                    InputError::Unreadable { .. } => self.source.refuse(
                        entry.span.clone(),
                        error.to_string(),
                        "this file",
                        "check the path; it is taken from the folder of the scene file",
                    ),
                    refused => refused,
                })?;
                Ok(new.insert(read).clone())
            }
        }
    }

    /// Refuses an entry that would bring more surfaces than a scene may have, before they are made.
    fn make_room(&self, surfaces: usize, entry: &Entry) -> Result<(), InputError> {
        if self.out.model.surfaces.len() + surfaces <= MAX_SURFACES {
            return Ok(());
        }
        let message = format!("the scene has more than {MAX_SURFACES} surfaces");
        let help = "ask for fewer around and across, or use groups less often";
        Err(self.source.refuse(entry.span.clone(), message, "more than that with these", help))
    }

    fn add(
        &mut self,
        path: PathBuf,
        mut surfaces: Vec<ModelSurface>,
        PatchFile { splines, skipped, .. }: PatchFile,
        place: Place,
        entry: &Entry,
    ) -> Result<(), InputError> {
        for point in surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
            let [x, y, z, weight] = *point;
            let moved @ [x, y, z] = place.transform.point([x, y, z]);
            if !moved.iter().all(|coordinate| coordinate.is_finite()) {
                let help = "write smaller numbers";
                let message = "transforms move these surfaces to infinity";
                return Err(self.source.refuse(entry.span.clone(), message, "these", help));
            }
            *point = [x, y, z, weight];
        }
        let first = self.out.model.surfaces.len();
        self.out.materials.resize(first + surfaces.len(), place.material);
        self.out.model.surfaces.append(&mut surfaces);
        let surfaces = first..self.out.model.surfaces.len();
        self.out.files.push(SceneFile { path, surfaces, splines, skipped });
        Ok(())
    }
}
