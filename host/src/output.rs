//! Output files that are there whole or not at all.
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};

use miette::Diagnostic;
use tempfile::NamedTempFile;
use thiserror::Error;

/// An output that could not be written; the command ends with exit code 5.
#[derive(Debug, Error, Diagnostic)]
pub enum OutputError {
    /// The path names a folder.
    #[error("cannot write `{path}`: it is a folder")]
    #[diagnostic(help("name a file in it, such as `{path}/out.csv`"))]
    IsFolder {
        /// The path as given.
        path: String,
    },
    /// The folder of the file does not exist.
    #[error("cannot write `{path}`: there is no folder `{folder}`")]
    #[diagnostic(help("make the folder first, or write elsewhere"))]
    NoFolder {
        /// The path as given.
        path: String,
        /// The part of it that is missing.
        folder: String,
    },
    /// Anything else that the operating system said.
    #[error("cannot write `{path}`: {reason}")]
    #[diagnostic(help("check the path, its permissions and the room on the disk"))]
    Failed {
        /// The path as given, `-` for standard output.
        path: String,
        /// What the operating system said.
        reason: io::Error,
    },
}

impl OutputError {
    /// The error for a write to `path` that failed because of `reason`.
    pub fn failed(path: &Path, reason: io::Error) -> Self {
        Self::Failed { path: path.display().to_string(), reason }
    }

    /// Whether whoever read the output has gone away, as `head` does.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Self::Failed { reason, .. } if reason.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// An output being written. It goes to a temporary file beside the target, which takes the target's place in
/// [`finish`](Self::finish); dropped before that, it leaves the target as it was. Standard output (`-`) and what is no
/// plain file, such as a pipe or a device, are written straight.
///
/// A process that is killed leaves the temporary file, `.patchray-*.tmp`.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    sink: BufWriter<Sink>,
}

#[derive(Debug)]
enum Sink {
    Stdout(Stdout),
    Straight(File),
    Replacing { file: NamedTempFile, target: PathBuf },
}

impl Output {
    /// Starts to write to `path`; `-` is standard output. A link is followed.
    ///
    /// # Errors
    /// The path is a folder, its folder does not exist, or the temporary file cannot be made.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let sink = if path == Path::new("-") { Sink::Stdout(io::stdout()) } else { Sink::at(path)? };
        Ok(Self { path: path.to_owned(), sink: BufWriter::new(sink) })
    }

    /// Writes out what is pending and puts the file in its place.
    ///
    /// # Errors
    /// The rest cannot be written, or the file cannot be put in its place; the target is then as it was.
    pub fn finish(mut self) -> Result<(), OutputError> {
        let done = self.sink.flush();
        done.map_err(|reason| failed(&self.path, reason))?;
        // Nothing is pending any more, so that taking the buffer apart loses nothing.
        match self.sink.into_parts().0 {
            Sink::Stdout(_) | Sink::Straight(_) => Ok(()),
            Sink::Replacing { file, target } => {
                file.persist(target).map(|_| ()).map_err(|error| failed(&self.path, error.error))
            }
        }
    }

    /// The error for a write to this output that failed because of `reason`.
    pub fn failed(&self, reason: io::Error) -> OutputError {
        failed(&self.path, reason)
    }
}

/// Writes the whole of `path` by `fill`; `-` is standard output.
///
/// # Errors
/// As [`Output::create`] and [`Output::finish`], or what `fill` ran into; the target is then as it was.
pub fn write(path: &Path, fill: impl FnOnce(&mut Output) -> io::Result<()>) -> Result<(), OutputError> {
    let mut output = Output::create(path)?;
    fill(&mut output).map_err(|reason| output.failed(reason))?;
    output.finish()
}

impl Sink {
    fn at(path: &Path) -> Result<Self, OutputError> {
        let shown = || path.display().to_string();
        // The target is what a link leads to: replacing the link would leave its target behind.
        let (target, existing) = match fs::canonicalize(path) {
            Ok(target) => {
                let existing = fs::metadata(&target).map_err(|reason| failed(path, reason))?;
                (target, Some(existing))
            }
            // Nothing is there, or a link that leads to nothing yet.
            Err(_) => match fs::read_link(path) {
                Ok(target) => (path.parent().unwrap_or(Path::new("")).join(target), None),
                Err(_) => (path.to_owned(), None),
            },
        };
        if existing.as_ref().is_some_and(fs::Metadata::is_dir) || shown().ends_with('/') {
            return Err(OutputError::IsFolder { path: shown().trim_end_matches('/').to_owned() });
        }
        if existing.as_ref().is_some_and(|existing| !existing.is_file()) {
            // Renaming over a device or a pipe would put a plain file in its place.
            let file = OpenOptions::new().write(true).open(&target).map_err(|reason| failed(path, reason))?;
            return Ok(Self::Straight(file));
        }
        if existing.is_some() {
            // Renaming asks nothing of the file that it replaces; one that may not be written is not to be replaced.
            OpenOptions::new().write(true).open(&target).map_err(|reason| failed(path, reason))?;
        }
        let folder = match target.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        if !folder.is_dir() {
            return Err(OutputError::NoFolder { path: shown(), folder: folder.display().to_string() });
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".patchray-").suffix(".tmp");
        if let Some(permissions) = for_everyone() {
            builder.permissions(permissions);
        }
        let file = builder.tempfile_in(folder).map_err(|reason| failed(path, reason))?;
        if let Some(existing) = existing {
            // Set afterwards, since the user's mask would take some away.
            file.as_file().set_permissions(existing.permissions()).map_err(|reason| failed(path, reason))?;
        }
        Ok(Self::Replacing { file, target })
    }
}

/// What a new file is made with, before the user's mask; a temporary file by itself is its owner's alone.
#[cfg(unix)]
fn for_everyone() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn for_everyone() -> Option<Permissions> {
    None
}

fn failed(path: &Path, reason: io::Error) -> OutputError {
    OutputError::Failed { path: path.display().to_string(), reason }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.sink.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Stdout(stdout) => stdout.write(bytes),
            Self::Straight(file) => file.write(bytes),
            Self::Replacing { file, .. } => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Stdout(stdout) => stdout.flush(),
            Self::Straight(file) => file.flush(),
            Self::Replacing { file, .. } => file.flush(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a temporary folder")
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("it can be listed");
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn whole_file_or_the_old_one() {
        let folder = folder();
        let path = folder.path().join("out.csv");
        write(&path, |out| out.write_all(b"first")).expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"first");

        let error = write(&path, |out| {
            out.write_all(&[b'x'; 100_000])?;
            Err(io::Error::other("the ray ran away"))
        });
        let error = error.expect_err("it failed").to_string();
        assert_eq!(error, format!("cannot write `{}`: the ray ran away", path.display()));
        assert_eq!(fs::read(&path).expect("there"), b"first");

        let mut dropped = Output::create(&path).expect("created");
        dropped.write_all(b"half").expect("written");
        assert_eq!(names(folder.path()).len(), 2);
        drop(dropped);
        assert_eq!(names(folder.path()), ["out.csv"]);
    }

    #[test]
    fn folders_are_named() {
        let folder = folder();
        let error = Output::create(folder.path()).expect_err("a folder");
        assert!(error.to_string().ends_with("it is a folder"), "{error}");
        let missing = folder.path().join("no/out.csv");
        let error = Output::create(&missing).expect_err("no folder");
        assert!(error.to_string().contains("there is no folder `"), "{error}");
        assert!(error.help().is_some());
        assert!(names(folder.path()).is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn permissions_and_links_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = folder();
        let (path, link) = (folder.path().join("real"), folder.path().join("link"));
        fs::write(&path, "old").expect("written");
        fs::set_permissions(&path, Permissions::from_mode(0o666)).expect("set");
        symlink(&path, &link).expect("linked");
        write(&link, |out| out.write_all(b"new")).expect("written");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read(&path).expect("there"), b"new");
        assert_eq!(fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o666);

        let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
        fs::write(&plain, "").expect("written");
        write(&ours, |_| Ok(())).expect("written");
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }

    #[cfg(unix)]
    #[test]
    fn devices_stay_devices() {
        let null = Path::new("/dev/null");
        write(null, |out| out.write_all(b"gone")).expect("written");
        assert!(!fs::metadata(null).expect("there").is_file());
    }
}
