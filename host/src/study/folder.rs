//! The folder of a study: `study.json`, which says what it is of, and a file per finished cell.
//!
//! Every file is there whole or not at all, so that a study can be stopped at any time, and several machines can fill one
//! folder, or folders of their own that are put together later.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::record::Record;
use crate::output::{self, OutputError};
use crate::stats::{SCHEMA, to_json};

/// What a study is of. Results of two studies that differ in it do not belong together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`SCHEMA`].
    pub schema: u32,
    /// The scene, for people.
    pub scene: String,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The sum of the bits of all control points and of the camera: two scenes of one name differ in it.
    pub fingerprint: String,
    /// The model's surfaces.
    pub surfaces: u64,
    /// The model's diagonal.
    pub diagonal: f64,
    /// The settings that cells differ from.
    pub settings: serde_json::Value,
    /// The names of all cells.
    pub cells: Vec<String>,
}

impl Manifest {
    /// Of which results this is, beside its cells: machines may be given different parts.
    fn is_of_the_same(&self, other: &Manifest) -> bool {
        let own = Manifest { cells: Vec::new(), ..self.clone() };
        own == Manifest { cells: Vec::new(), ..other.clone() }
    }
}

/// The folder of a study.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    /// What it is of.
    pub manifest: Manifest,
}

/// Why a folder cannot be used.
#[derive(Debug)]
pub enum FolderError {
    /// It holds results of something else.
    Other(String),
    /// There is no study in it, or what is there cannot be read.
    Unreadable(String),
    /// It cannot be written.
    Output(OutputError),
}

const MANIFEST: &str = "study.json";

/// What the names of cells' files end with.
const ENDING: &str = "jsonl";

impl Folder {
    /// The folder at `path`, made if it is not there, for a study of what `manifest` says; cells that an earlier one named
    /// stay.
    ///
    /// # Errors
    /// It holds results of another study, or cannot be written.
    pub fn create(path: &Path, mut manifest: Manifest) -> Result<Self, FolderError> {
        fs::create_dir_all(path).map_err(|reason| FolderError::Output(OutputError::failed(path, reason)))?;
        let file = path.join(MANIFEST);
        if file.exists() {
            let earlier = Folder::open(path)?.manifest;
            if !earlier.is_of_the_same(&manifest) {
                return Err(FolderError::Other(format!(
                    "`{}` holds a study of {} at {} × {}, or with other settings",
                    path.display(),
                    earlier.scene,
                    earlier.size[0],
                    earlier.size[1]
                )));
            }
            let mut cells = earlier.cells;
            cells.extend(manifest.cells.iter().filter(|cell| !cells.contains(cell)).cloned().collect::<Vec<_>>());
            manifest.cells = cells;
        }
        output::write(&file, |out| out.write_all(to_json(&manifest).as_bytes())).map_err(FolderError::Output)?;
        Ok(Folder { path: path.to_owned(), manifest })
    }

    /// The folder of a study that was begun.
    ///
    /// # Errors
    /// There is none.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        let file = path.join(MANIFEST);
        let unreadable = |reason: String| FolderError::Unreadable(format!("{}: {reason}", file.display()));
        let text = fs::read_to_string(&file).map_err(|error| unreadable(error.to_string()))?;
        let manifest: Manifest = serde_json::from_str(&text).map_err(|error| unreadable(error.to_string()))?;
        if manifest.schema != SCHEMA {
            return Err(unreadable(format!("its schema is {}, and this program reads {SCHEMA}", manifest.schema)));
        }
        Ok(Folder { path: path.to_owned(), manifest })
    }

    /// All files that it has or is to have.
    pub fn files(&self) -> Vec<PathBuf> {
        let cells = self.manifest.cells.iter().map(|id| self.file_of(id));
        cells.chain([self.path.join(MANIFEST)]).collect()
    }

    fn file_of(&self, id: &str) -> PathBuf {
        self.path.join(format!("{id}.{ENDING}"))
    }

    /// Whether the cell of this name is finished.
    pub fn has(&self, id: &str) -> bool {
        self.read(id).is_ok()
    }

    /// The record of the cell of this name.
    ///
    /// # Errors
    /// There is none, or it is not whole: why.
    pub fn read(&self, id: &str) -> Result<Record, String> {
        let text = fs::read_to_string(self.file_of(id)).map_err(|error| error.to_string())?;
        let record = Record::parse(&text)?;
        if record.head.id == id { Ok(record) } else { Err(format!("it is of the cell `{}`", record.head.id)) }
    }

    /// Writes a record: whole, or not at all.
    ///
    /// # Errors
    /// It cannot be written; an earlier one is then as it was.
    pub fn write(&self, record: &Record) -> Result<(), OutputError> {
        output::write(&self.file_of(&record.head.id), |out| out.write_all(record.to_text().as_bytes()))
    }

    /// The records of all finished cells in the study's order, and the names of those that are missing, each with why if it
    /// is there but cannot be read.
    pub fn read_all(&self) -> (Vec<Record>, Vec<(String, Option<String>)>) {
        let (mut records, mut missing) = (Vec::new(), Vec::new());
        for id in &self.manifest.cells {
            match self.read(id) {
                Ok(record) => records.push(record),
                Err(reason) => missing.push((id.clone(), self.file_of(id).exists().then_some(reason))),
            }
        }
        (records, missing)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::plan::plan;
    use super::super::record::tests::record;
    use super::*;

    /// The manifest of a study of nothing.
    pub(crate) fn manifest(cells: &[&str]) -> Manifest {
        Manifest {
            schema: SCHEMA,
            scene: "nothing".to_owned(),
            size: [2, 1],
            fingerprint: "0".to_owned(),
            surfaces: 1,
            diagonal: 1.0,
            settings: serde_json::Value::Null,
            cells: cells.iter().map(|&cell| cell.to_owned()).collect(),
        }
    }

    #[test]
    fn finished_cells_are_known_and_half_of_one_is_not_finished() {
        let place = tempfile::tempdir().expect("a temporary folder");
        let cells = plan(None, None);
        let ids: Vec<String> = cells.iter().take(3).map(|cell| cell.id()).collect();
        let names: Vec<&str> = ids.iter().map(String::as_str).collect();
        let folder = Folder::create(place.path(), manifest(&names)).expect("made");
        for cell in &cells[..2] {
            folder.write(&record(cell, 1.0, 1e-9, 0)).expect("written");
        }
        let file = folder.file_of(&ids[1]);
        let text = fs::read_to_string(&file).expect("there");
        fs::write(&file, &text[..text.len() / 2]).expect("cut");
        assert!(folder.has(&ids[0]) && !folder.has(&ids[1]) && !folder.has(&ids[2]));
        let (records, missing) = Folder::open(place.path()).expect("there").read_all();
        assert_eq!((records.len(), records[0].head.id.as_str()), (1, names[0]));
        assert_eq!((missing[0].0.as_str(), missing[0].1.is_some()), (names[1], true));
        assert_eq!(missing[1], (ids[2].clone(), None));
    }

    #[test]
    fn results_of_two_studies_stay_apart() {
        let place = tempfile::tempdir().expect("a temporary folder");
        Folder::create(place.path(), manifest(&["a"])).expect("made");
        let both = Folder::create(place.path(), manifest(&["b", "a"])).expect("the same study");
        assert_eq!(both.manifest.cells, ["a", "b"]);
        let other = Manifest { size: [3, 3], ..manifest(&["a"]) };
        assert!(matches!(Folder::create(place.path(), other), Err(FolderError::Other(_))));
        assert!(matches!(Folder::open(&place.path().join("no")), Err(FolderError::Unreadable(_))));
    }
}
