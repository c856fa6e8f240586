//! The verbs, and how each of them may end.

pub mod aov;
pub mod bake;
pub mod demo;
pub mod diff;
pub mod info;
pub mod interrupt;
pub mod load;
pub mod merge;
pub mod pixel;
pub mod preview;
pub mod query;
pub mod render;
pub mod report;
pub mod stress;
pub mod study;
pub mod tables;

use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::{HumanCount, ProgressBar, ProgressState, ProgressStyle};
use miette::Diagnostic;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::Serialize;
use thiserror::Error;

use crate::lower::LowerError;
use crate::output::{Output, OutputError};
use crate::picture::rows::Rows;
use crate::scene::error::InputError;
use crate::settings::Flags;
use crate::stats::{Asked, Stats, to_json};

/// Why a command did not do what it was asked to.
#[derive(Debug, Error, Diagnostic)]
pub enum Failure {
    /// The flags do not go together.
    #[error("{message}")]
    Usage {
        /// What is wrong.
        message: String,
        /// What to write instead.
        #[help]
        help: String,
    },
    /// An input file was refused.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Input(#[from] InputError),
    /// What a file holds cannot be traced.
    #[error("`{file}` is refused: {reason}")]
    Refused {
        /// The file.
        file: String,
        /// What in it, and why.
        reason: String,
        /// What to do about it.
        #[help]
        help: String,
    },
    /// The scene could not be built.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Lower(#[from] LowerError),
    /// An output could not be written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Output(#[from] OutputError),
    /// The answer is no: bounds were missed, which the output names.
    #[error("{missed} bounds are missed")]
    #[diagnostic(help("the output names them, below the table"))]
    No {
        /// How many.
        missed: usize,
    },
    /// The answer is no: pictures are not the same.
    #[error("they are not the same: {how}")]
    Differ {
        /// In what.
        how: String,
    },
    /// The answer is no: a picture is not whole.
    #[error("rows {rows} are in none of the parts")]
    #[diagnostic(help("draw them with --rows {rows}, and merge all parts again"))]
    Missing {
        /// The rows.
        rows: Rows,
    },
    /// Somebody stopped it.
    #[error("stopped: {kept}")]
    Interrupted {
        /// What is kept of the work.
        kept: String,
    },
    /// Something that should not happen.
    #[error("internal error: {0}")]
    Internal(String),
}

impl Failure {
    /// The exit code: 1 the answer is no, 2 usage, 3 input refused, 4 capacity, 5 internal or I/O, 130 interrupted; 0 if whoever
    /// read the output went away.
    pub fn code(&self) -> u8 {
        match self {
            Failure::No { .. } | Failure::Differ { .. } | Failure::Missing { .. } => 1,
            Failure::Usage { .. } => 2,
            Failure::Input(_) | Failure::Refused { .. } => 3,
            Failure::Lower(LowerError::Surface { .. } | LowerError::Vanishes { .. } | LowerError::NoView { .. }) => 3,
            Failure::Lower(LowerError::Internal(_)) => 5,
            Failure::Lower(_) => 4,
            Failure::Output(error) if error.is_broken_pipe() => 0,
            Failure::Output(_) | Failure::Internal(_) => 5,
            // As shells report a process that Ctrl-C has ended.
            Failure::Interrupted { .. } => 130,
        }
    }
}

/// Says something on standard error. That nobody can hear it is no reason to end.
pub fn say(text: std::fmt::Arguments) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Where a path leads, however it is spelled: links followed, and of a file that is not there yet the folder's.
fn place(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let beside = || Some(folder.canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(beside).unwrap_or_else(|| path.to_owned())
}

/// Refuses flags that send more than one thing to standard output, two things to one file, or anything to an input.
pub(crate) fn check_outputs(output: Option<&Path>, inputs: &[&Path], flags: &Flags) -> Result<(), Failure> {
    let stdout = Path::new("-");
    let usage = |message: &str, help: &str| Err(Failure::Usage { message: message.to_owned(), help: help.to_owned() });
    let to_stdout = [output == Some(stdout), flags.stats.as_deref() == Some(stdout), flags.json];
    if to_stdout.iter().filter(|&&to| to).count() > 1 {
        return usage("two outputs would go to standard output", "name a file for one of them, with -o or --stats");
    }
    let file = |path: Option<&Path>| path.filter(|path| *path != stdout).map(place);
    let (output, stats) = (file(output), file(flags.stats.as_deref()));
    // A device such as /dev/null takes any number of outputs.
    if output.is_some() && output == stats && output.as_deref().is_some_and(|path| !path.exists() || path.is_file()) {
        return usage("-o and --stats name the same file", "name two files");
    }
    for input in inputs.iter().filter_map(|input| file(Some(input))) {
        if input.is_file() && (output.as_ref() == Some(&input) || stats.as_ref() == Some(&input)) {
            return usage("an output would replace an input", "name another file with -o or --stats");
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

/// Threads for one command.
pub(crate) fn pool(threads: u32) -> Result<ThreadPool, Failure> {
    let pool = ThreadPoolBuilder::new().num_threads(threads as usize).build();
    pool.map_err(|error| Failure::Internal(format!("{threads} threads could not be started: {error}")))
}

/// A progress bar of `length` steps; it shows only on a terminal, and not with `--quiet`.
pub(crate) fn progress(length: u64, what: &'static str, quiet: bool) -> ProgressBar {
    bar(length, what, quiet, ProgressStyle::with_template("{msg} [{wide_bar}] {percent} % {eta}"))
}

/// The same of rows of a picture, of so many rays each.
pub(crate) fn progress_in_rows(length: u64, rays: u64, what: &'static str, quiet: bool) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} [{wide_bar}] {pos} of {len} rows, {rays} rays/s, {eta} left");
    let rate = move |state: &ProgressState, text: &mut dyn fmt::Write| {
        // What does not fit on the terminal is left out.
        let _ = write!(text, "{}", HumanCount((state.per_sec() * rays as f64) as u64));
    };
    bar(length, what, quiet, style.map(|style| style.with_key("rays", rate)))
}

fn bar(
    length: u64,
    what: &'static str,
    quiet: bool,
    style: Result<ProgressStyle, indicatif::style::TemplateError>,
) -> ProgressBar {
    if quiet || !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length).with_message(what);
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// The line that sums a run up.
pub(crate) fn summary(stats: &Stats) -> String {
    let rays = stats.rays.max(1) as f64;
    let hits = match (stats.asked, stats.work.get("intersection_points")) {
        (Asked::All, Some(points)) => format!("{} that hit, {points} points", stats.hit_rays),
        _ => format!("{} hits", stats.hit_rays),
    };
    format!(
        "{} rays, {hits}; prepared in {:.3} s, intersected in {:.3} s ({:.0} ns per ray)",
        stats.rays,
        stats.prepare_seconds,
        stats.intersect_seconds,
        stats.intersect_seconds / rays * 1e9,
    )
}

/// Says how many rays were given up, if any were.
pub(crate) fn say_gave_up(stats: &Stats) {
    for (limit, count) in &stats.gave_up_by_limit {
        say(format_args!("{count} of {} rays gave up: the limit on {limit} ran out", stats.rays));
    }
}
