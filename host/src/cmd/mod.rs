//! The verbs, and how each of them may end.

pub mod aov;
pub mod bake;
pub mod demo;
pub mod diff;
pub mod info;
pub mod interrupt;
pub mod load;
pub mod merge;
mod outputs;
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
use std::time::Duration;

use indicatif::{HumanCount, ProgressBar, ProgressState, ProgressStyle};
use miette::Diagnostic;
use rayon::{ThreadPool, ThreadPoolBuilder};
use thiserror::Error;

use crate::lower::LowerError;
use crate::output::OutputError;
use crate::picture::rows::Rows;
use crate::scene::error::InputError;
use crate::scene::trace::Method;
use crate::settings::switches::{On, Switch};
use crate::stats::{Asked, Stats};

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
    /// The answer is no, and has been told as far as it was asked for.
    #[error("no")]
    Told,
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
            Failure::No { .. } | Failure::Differ { .. } | Failure::Told | Failure::Missing { .. } => 1,
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

/// Refuses to leave out parts of the paper's methods where nothing would come of it: of several methods at once (`None`), of one
/// that has none of them, or where more than the closest hit is asked for.
pub(crate) fn hear_parts(method: Option<Method>, asked: Asked, parts: On) -> Result<(), Failure> {
    let (heard, of): (&[Switch], _) = match method {
        None => (&[], "several methods".to_owned()),
        Some(method) if method.needs_view() => {
            (&[Switch::Coherence, Switch::BendHalving], format!("`{}`", method.name()))
        }
        Some(_) if asked != Asked::Closest => (&[Switch::BendHalving], "--all and --any".to_owned()),
        Some(_) => return Ok(()),
    };
    if parts.with(heard) == On::ALL {
        return Ok(());
    }
    Err(Failure::Usage {
        message: format!("--by-the-letter and --without are not for {of}"),
        help:
            "the parts are those of the paper's four methods, and of the closest hit: name one of these with --method"
                .to_owned(),
    })
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
    let (Some(gave_up), Some(rays)) = (stats.gave_up_by_kind, stats.rays_by_kind) else {
        return;
    };
    for (what, count, of) in [
        ("mirrored rays", gave_up.mirrored, rays.mirrored),
        ("rays to lights", gave_up.shadow, rays.shadow),
        ("rays of shadow maps", gave_up.map, rays.map),
    ] {
        if count > 0 {
            say(format_args!("{count} of {of} {what} have no answer: pixels that need them show it"));
        }
    }
}
