//! Where the outputs of a verb go: no two to one place, and none over an input.

use std::io::Write;
use std::path::{Path, PathBuf};

use image::ImageFormat;
use serde::Serialize;

use super::Failure;
use crate::output::{Output, OutputError};
use crate::settings::Flags;
use crate::stats::to_json;

/// Where a path leads, however it is spelled: links followed, and of a file that is not there yet the folder's.
fn place(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let beside = || Some(folder.canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(beside).unwrap_or_else(|| path.to_owned())
}

fn usage(message: &str, help: &str) -> Failure {
    Failure::Usage { message: message.to_owned(), help: help.to_owned() }
}

/// The files that a verb will write, each with the flag that names it: no two are one. Whatever reads an input is given them,
/// so that none is written over.
#[derive(Debug, Default)]
pub(crate) struct Outputs<'f>(Vec<(&'f str, PathBuf)>);

impl<'f> Outputs<'f> {
    /// The same where `-o` names a picture, whose name is to promise no other format than PNG.
    ///
    /// # Errors
    /// It does, or see [`Outputs::new`].
    pub(crate) fn of_picture(
        picture: Option<&Path>,
        more: &[(&'f str, &Path)],
        flags: &Flags,
    ) -> Result<Self, Failure> {
        if let Some(Ok(format)) = picture.map(ImageFormat::from_path)
            && format != ImageFormat::Png
        {
            return Err(usage("pictures are written as PNG", "name a file that ends in .png; `--aov` writes OpenEXR"));
        }
        Outputs::new(picture, more, flags)
    }

    /// Those of `-o` and of the flags, and `more`, each with its own flag.
    ///
    /// # Errors
    /// More than one would go to standard output, or two to one file.
    pub(crate) fn new(output: Option<&Path>, more: &[(&'f str, &Path)], flags: &Flags) -> Result<Self, Failure> {
        let named = [("-o", output), ("--stats", flags.stats.as_deref())];
        let named = named.into_iter().filter_map(|(flag, path)| Some((flag, path?))).chain(more.iter().copied());
        let (to_stdout, to_files): (Vec<_>, Vec<_>) = named.partition(|(_, path)| *path == Path::new("-"));
        if to_stdout.len() + usize::from(flags.json) > 1 {
            let help = "name a file for one of them, with -o or --stats";
            return Err(usage("two outputs would go to standard output", help));
        }
        let mut taken: Vec<(&str, PathBuf)> = Vec::new();
        for (flag, path) in to_files {
            let place = place(path);
            // A device such as /dev/null takes any number of outputs.
            let holds_one = !place.exists() || place.is_file();
            if let Some((other, _)) = taken.iter().find(|(_, other)| holds_one && *other == place) {
                let both = if *other == flag { format!("two {flag}") } else { format!("{other} and {flag}") };
                return Err(usage(&format!("{both} name the same file"), "name two files"));
            }
            taken.push((flag, place));
        }
        Ok(Outputs(taken))
    }

    /// Refuses inputs that one of them would replace.
    pub(crate) fn spare<'p>(&self, inputs: impl IntoIterator<Item = &'p Path>) -> Result<(), Failure> {
        let inputs = inputs.into_iter().filter(|input| *input != Path::new("-")).map(place);
        for input in inputs.filter(|input| input.is_file()) {
            if let Some((flag, _)) = self.0.iter().find(|(_, place)| *place == input) {
                return Err(usage("an output would replace an input", &format!("name another file with {flag}")));
            }
        }
        Ok(())
    }
}

/// The open outputs for [`Stats`].
pub(crate) struct StatsOutputs(Vec<Output>);

impl StatsOutputs {
    /// Opens the outputs that the flags ask for, before any long work.
    pub(crate) fn create(flags: &Flags) -> Result<Self, OutputError> {
        let json = flags.json.then_some(Path::new("-"));
        let paths = flags.stats.as_deref().into_iter().chain(json);
        Ok(StatsOutputs(paths.map(Output::create).collect::<Result<_, _>>()?))
    }

    /// Writes the statistics to all of them.
    pub(crate) fn finish(self, stats: &impl Serialize) -> Result<(), OutputError> {
        let text = to_json(stats);
        for mut output in self.0 {
            output.write_all(text.as_bytes()).map_err(|reason| output.failed(reason))?;
            output.finish()?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two channels to one file once left the second alone; and two to `/dev/null` were refused, where all else may go.
    #[test]
    fn two_outputs_need_two_files() {
        let flags = Flags::default();
        let refused = |more: &[(&str, &str)]| {
            let more: Vec<_> = more.iter().map(|&(flag, path)| (flag, Path::new(path))).collect();
            Outputs::new(Some(Path::new("a.png")), &more, &flags).is_err()
        };
        assert!(!refused(&[("--aov", "b.png"), ("--aov", "c.png")]));
        assert!(refused(&[("--aov", "a.png")]) && refused(&[("--aov", "b.png"), ("--aov", "./b.png")]));
        assert!(!refused(&[("--aov", "/dev/null"), ("--aov", "/dev/null")]));
    }
}
