//! Where the outputs of a verb go: no two to one place, and none over an input.

use std::io::Write;
use std::path::{Path, PathBuf};

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

/// Refuses flags that send more than one thing to standard output, two things to one file, or anything to an input.
pub(crate) fn check_outputs(output: Option<&Path>, inputs: &[&Path], flags: &Flags) -> Result<(), Failure> {
    check_all(output, &[], inputs, flags)
}

/// The same of a verb with more outputs than one, each of its own flag.
pub(crate) fn check_all(
    output: Option<&Path>,
    more: &[(&str, &Path)],
    inputs: &[&Path],
    flags: &Flags,
) -> Result<(), Failure> {
    let usage = |message: &str, help: &str| Err(Failure::Usage { message: message.to_owned(), help: help.to_owned() });
    let named = [("-o", output), ("--stats", flags.stats.as_deref())];
    let named = named.into_iter().filter_map(|(flag, path)| Some((flag, path?))).chain(more.iter().copied());
    let (to_stdout, to_files): (Vec<_>, Vec<_>) = named.partition(|(_, path)| *path == Path::new("-"));
    if to_stdout.len() + usize::from(flags.json) > 1 {
        return usage("two outputs would go to standard output", "name a file for one of them, with -o or --stats");
    }
    let mut taken: Vec<(&str, PathBuf)> = Vec::new();
    for (flag, path) in to_files {
        let place = place(path);
        // A device such as /dev/null takes any number of outputs.
        let holds_one = !place.exists() || place.is_file();
        if let Some((other, _)) = taken.iter().find(|(_, other)| holds_one && *other == place) {
            let both = if *other == flag { format!("two {flag}") } else { format!("{other} and {flag}") };
            return usage(&format!("{both} name the same file"), "name two files");
        }
        taken.push((flag, place));
    }
    let inputs = inputs.iter().filter(|input| **input != Path::new("-")).map(|input| place(input));
    for input in inputs.filter(|input| input.is_file()) {
        if let Some((flag, _)) = taken.iter().find(|(_, place)| *place == input) {
            return usage("an output would replace an input", &format!("name another file with {flag}"));
        }
    }
    Ok(())
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
            check_all(Some(Path::new("a.png")), &more, &[], &flags).is_err()
        };
        assert!(!refused(&[("--aov", "b.png"), ("--aov", "c.png")]));
        assert!(refused(&[("--aov", "a.png")]) && refused(&[("--aov", "b.png"), ("--aov", "./b.png")]));
        assert!(!refused(&[("--aov", "/dev/null"), ("--aov", "/dev/null")]));
    }
}
