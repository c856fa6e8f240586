//! `patchray query`: a batch of rays in, exact hits out.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use patchray::ray::Incidence;

use super::load::{self, Loaded};
use super::outputs::{Outputs, StatsOutputs};
use super::{Failure, hear_parts, pool, progress, say, say_gave_up, summary};
use crate::batch::Batch;
use crate::number::Number;
use crate::output::{Output, OutputError};
use crate::report::answers::{self, Answer, Answers};
use crate::scanline::{Found, LaneBytes, Outcome, Tally, Tracer};
use crate::scene::rays::{RayBatch, Rays};
use crate::scene::trace::{Method, Precision};
use crate::settings::{Flags, Settings};
use crate::stats::{Asked, Stats, Used};

/// The command line of `query`.
#[derive(Args, Clone, Debug)]
pub struct QueryArgs {
    /// The surfaces (.bpt, or NURBS-Python's .json), or a scene file (.toml)
    pub patches: PathBuf,
    /// The ray file (CSV)
    pub rays: PathBuf,
    /// All hits of each ray, a line each in order of t, and not the closest alone
    ///
    /// A point on an edge is a hit of each surface, and of each piece of a B-spline, that has the edge. A ray with more than
    /// 256 hits is given up (gave-up:hits), with the closest 256 in lines whose `hit` is 0. `--method clipping` finds all
    /// there are; `newton` only those to which the starts of a patch lead, and of two in one patch it may find one. A coherent
    /// method looks for the closest hit alone, and is refused.
    #[arg(long, conflicts_with = "any", help_heading = "Tracing")]
    pub all: bool,
    /// Any hit of each ray: the first that is found, and not the closest
    ///
    /// That is what shadows ask for. `--method clipping` proves a miss; `newton` may miss a hit, as it may the closest. A
    /// coherent method looks for the closest hit alone, and is refused.
    #[arg(long, help_heading = "Tracing")]
    pub any: bool,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

impl QueryArgs {
    fn asked(&self) -> Asked {
        match (self.all, self.any) {
            (true, _) => Asked::All,
            (_, true) => Asked::Any,
            _ => Asked::Closest,
        }
    }
}

/// How many rays are read, traced and written at a time. More take more memory (some 400 bytes each); fewer give threads
/// less to share.
const BLOCK: usize = 1 << 16;

/// The same where each may have as many hits as can be told, of 80 bytes each.
const BLOCK_OF_ALL: usize = 1 << 13;

/// Answers the rays. Rays are read and answers written block by block; answers on standard output may therefore come
/// before a later line of the ray file is refused, while a file is there whole or not at all.
///
/// # Errors
/// Flags that do not go together, bad input, too little memory, or an output that cannot be written; no output file is left
/// behind then.
pub fn run(args: &QueryArgs) -> Result<(), Failure> {
    let QueryArgs { patches, rays, flags, .. } = args;
    let stdin = Path::new("-");
    if patches == stdin && rays == stdin {
        return Err(Failure::Usage {
            message: "both inputs are standard input".to_owned(),
            help: "name a file for one of them".to_owned(),
        });
    }
    let asked = args.asked();
    if asked != Asked::Closest && Settings::of_flags(flags).method.is_coherent() {
        return Err(only_the_closest());
    }
    let output = flags.output.as_deref().unwrap_or(Path::new("-"));
    let outputs = Outputs::new(Some(output), &[], flags)?;
    outputs.spare([rays.as_path()])?;
    let loaded = load::scene_or_patches(patches, flags, &outputs)?;
    let settings = &loaded.settings;
    if settings.method.needs_view() {
        return Err(only_views(settings.method));
    }
    hear_parts(Some(settings.method), asked, settings.parts)?;
    let reader = Rays::open(rays, flags.on_invalid())?;
    let mut out = Output::create(output)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let (prepared, prepare_seconds) = loaded.prepare()?;

    let answers = Answers::new(&mut out).map_err(|reason| OutputError::failed(output, reason))?;
    let length = fs::metadata(rays).map_or(0, |file| file.len());
    let round = Round { loaded: &loaded, output, reader, answers, length, quiet: flags.quiet };
    let done = match asked {
        Asked::Closest => round.answer(prepared.tracer(settings).as_ref(), BLOCK, |outcome| [outcome])?,
        Asked::Any => {
            let tracer = prepared.tracer_of_any(settings).ok_or_else(only_the_closest)?;
            round.answer(tracer.as_ref(), BLOCK, |outcome| [outcome])?
        }
        Asked::All => {
            let tracer = prepared.tracer_of_all(settings).ok_or_else(only_the_closest)?;
            round.answer(tracer.as_ref(), BLOCK_OF_ALL, each_hit)?
        }
    };
    let Done { tally, lane, last } = &done;
    let used = Used::of_rays(&prepared, settings, prepare_seconds);
    let mut stats = Stats::new(patches.display().to_string(), settings, Used { lane: *lane, ..used }, tally);
    stats.asked = asked;
    stats.ray_file = Some(rays.display().to_string());
    out.finish()?;
    stats_outputs.finish(&stats)?;
    if let Some(first) = &last.first_invalid {
        say(format_args!("{} of {} rays are not valid, the first: {first}", last.invalid, stats.rays));
    }
    say_gave_up(&stats);
    if !flags.quiet {
        say(format_args!("{}", summary(&stats)));
    }
    Ok(())
}

/// The failure for asking a method of views for the rays of a file.
fn only_views(method: Method) -> Failure {
    let (name, instead) = (method.name(), method.of_any_rays().name());
    Failure::Usage {
        message: format!("`{name}` traces the rays of one view alone, and a ray file may hold any"),
        help: format!(
            "it predicts from what all rays from one eye share; use --method {instead}, or a method without coherence, here, \
             and {name} with `render`"
        ),
    }
}

/// The failure for asking a coherent method for more than it looks for.
fn only_the_closest() -> Failure {
    Failure::Usage {
        message: "a coherent method looks for the closest hit alone".to_owned(),
        help: "use --method clipping (or newton) with --all and --any".to_owned(),
    }
}

/// The way of the rays from their file to that of the answers.
struct Round<'a, W: io::Write> {
    loaded: &'a Loaded,
    /// The name of what `answers` go to.
    output: &'a Path,
    reader: Rays,
    answers: Answers<W>,
    /// The bytes of the ray file.
    length: u64,
    quiet: bool,
}

/// What it came to.
struct Done {
    tally: Tally,
    lane: LaneBytes,
    /// The last block; it counts the rays that are not valid.
    last: RayBatch,
}

impl<W: io::Write> Round<'_, W> {
    /// Traces all rays with `tracer`, `block` at a time; `lines` says what is written of an outcome.
    fn answer<H: Send, L: IntoIterator<Item = Outcome>>(
        self,
        tracer: &dyn Tracer<H>,
        block: usize,
        lines: impl Fn(Outcome<H>) -> L,
    ) -> Result<Done, Failure> {
        let Round { loaded, output, mut reader, mut answers, length, quiet } = self;
        let failed = |reason: io::Error| OutputError::failed(output, reason);
        let refusal = |ray: &_| tracer.refusal(ray).map(|error| format!("the ray cannot be traced: {error}"));
        let bar = progress(length, "answering", quiet);
        let pool = pool(loaded.settings.threads)?;
        let mut traced = Batch::new(tracer);
        let mut batch = RayBatch::default();
        // Ends with the ray file, of which each round takes a block.
        loop {
            reader.next(block, &refusal, &mut batch)?;
            if batch.rays.is_empty() {
                break;
            }
            for outcome in pool.install(|| traced.trace(&batch.rays)) {
                let lines = lines(outcome).into_iter();
                let written = match loaded.settings.precision {
                    Precision::F32 => answers.push(lines.map(|line| answer(&line, loaded, |number| number as f32))),
                    Precision::F64 => answers.push(lines.map(|line| answer(&line, loaded, |number| number))),
                };
                written.map_err(failed)?;
            }
            bar.set_position(reader.position());
        }
        answers.finish().map_err(failed)?;
        bar.finish_and_clear();
        Ok(Done { tally: traced.tally().clone(), lane: tracer.lane_bytes(), last: batch })
    }
}

/// A list of hits as an outcome per hit; at least one, whatever became of the ray.
fn each_hit(outcome: Outcome<Vec<Found>>) -> Vec<Outcome> {
    match outcome {
        Outcome::Hit(all) => all.into_iter().map(Outcome::Hit).collect(),
        Outcome::GaveUp { limit, best: Some(all) } => {
            all.into_iter().map(|one| Outcome::GaveUp { limit, best: Some(one) }).collect()
        }
        Outcome::GaveUp { limit, best: None } => vec![Outcome::GaveUp { limit, best: None }],
        Outcome::Miss => vec![Outcome::Miss],
        Outcome::Refused(error) => vec![Outcome::Refused(error)],
        Outcome::Invalid => vec![Outcome::Invalid],
    }
}

/// A line of answers, its numbers brought back by `narrow` to the precision in which they were computed.
fn answer<S: Number>(outcome: &Outcome, loaded: &Loaded, narrow: impl Fn(f64) -> S) -> Answer<'static, S> {
    let line = |found: &Found| {
        let [u, v] = loaded.parameters_of(found.surface, found.u, found.v);
        answers::Found {
            t: narrow(found.t),
            u: narrow(u),
            v: narrow(v),
            patch: loaded.answered_number_of(found.surface),
            normal: found.normal.there().map(|normal| normal.map(&narrow)),
        }
    };
    match outcome {
        Outcome::Hit(found) => match found.incidence {
            Incidence::Crossing => Answer::Hit(line(found)),
            Incidence::Grazing => Answer::Graze(line(found)),
            Incidence::Contact => Answer::Contact(line(found)),
        },
        Outcome::Miss => Answer::Miss,
        Outcome::GaveUp { limit, best } => Answer::GaveUp { limit, best: best.as_ref().map(line) },
        Outcome::Refused(_) | Outcome::Invalid => Answer::Invalid,
    }
}
