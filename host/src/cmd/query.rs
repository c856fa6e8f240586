//! `patchray query`: a batch of rays in, exact hits out.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;

use super::load::{self, Loaded};
use super::{Failure, StatsOutputs, check_outputs, pool, progress, say, say_gave_up, summary};
use crate::number::Number;
use crate::output::{Output, OutputError};
use crate::report::answers::{self, Answer, Answers};
use crate::scanline::{Batch, Found, Outcome};
use crate::scene::rays::{RayBatch, Rays};
use crate::scene::trace::Precision;
use crate::settings::Flags;
use crate::stats::Stats;

/// The command line of `query`.
#[derive(Args, Clone, Debug)]
pub struct QueryArgs {
    /// The surfaces (.bpt, or NURBS-Python's .json)
    pub patches: PathBuf,
    /// The ray file (CSV)
    pub rays: PathBuf,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// How many rays are read, traced and written at a time. More take more memory (some 400 bytes each); fewer give threads
/// less to share.
const BLOCK: usize = 1 << 16;

/// Answers the rays. Rays are read and answers written block by block; answers on standard output may therefore come
/// before a later line of the ray file is refused, while a file is there whole or not at all.
///
/// # Errors
/// Bad input, too little memory, or an output that cannot be written; no output file is left behind then.
pub fn run(args: &QueryArgs) -> Result<(), Failure> {
    let QueryArgs { patches, rays, flags } = args;
    let stdin = Path::new("-");
    if patches == stdin && rays == stdin {
        return Err(Failure::Usage {
            message: "both inputs are standard input".to_owned(),
            help: "name a file for one of them".to_owned(),
        });
    }
    let output = flags.output.as_deref().unwrap_or(Path::new("-"));
    check_outputs(Some(output), &[patches, rays], flags)?;
    let loaded = load::patches(patches, flags)?;
    let settings = &loaded.settings;
    let mut reader = Rays::open(rays, flags.on_invalid())?;
    let mut out = Output::create(output)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let (prepared, prepare_seconds) = loaded.prepare()?;
    let tracer = prepared.tracer(settings);
    let refusal = |ray: &_| tracer.refusal(ray).map(|error| format!("the ray cannot be traced: {error}"));

    let length = fs::metadata(rays).map_or(0, |file| file.len());
    let bar = progress(length, "answering", flags.quiet);
    let pool = pool(settings.threads)?;
    let mut traced = Batch::new(tracer.as_ref());
    let mut batch = RayBatch::default();
    let failed = |reason: io::Error| OutputError::Failed { path: output.display().to_string(), reason };
    let mut answers = Answers::new(&mut out).map_err(failed)?;
    // Ends with the ray file, of which each round takes a block.
    loop {
        reader.next(BLOCK, &refusal, &mut batch)?;
        if batch.rays.is_empty() {
            break;
        }
        for outcome in pool.install(|| traced.trace(&batch.rays)) {
            let written = match settings.precision {
                Precision::F32 => answers.push(&answer(&outcome, &loaded, |number| number as f32)),
                Precision::F64 => answers.push(&answer(&outcome, &loaded, |number| number)),
            };
            written.map_err(failed)?;
        }
        bar.set_position(reader.position());
    }
    answers.finish().map_err(failed)?;
    bar.finish_and_clear();

    let mut stats = Stats::new(patches.display().to_string(), settings, &prepared, prepare_seconds, traced.tally());
    stats.ray_file = Some(rays.display().to_string());
    out.finish()?;
    stats_outputs.finish(&stats)?;
    if let Some(first) = &batch.first_invalid {
        say(format_args!("{} of {} rays are not valid, the first: {first}", batch.invalid, stats.rays));
    }
    say_gave_up(&stats);
    if !flags.quiet {
        say(format_args!("{}", summary(&stats)));
    }
    Ok(())
}

/// The line of a ray, its numbers brought back by `narrow` to the precision in which they were computed.
fn answer<S: Number>(outcome: &Outcome, loaded: &Loaded, narrow: impl Fn(f64) -> S) -> Answer<'static, S> {
    let line = |found: &Found| {
        let [u, v] = loaded.parameters_of(found.surface, found.u, found.v);
        answers::Found {
            t: narrow(found.t),
            u: narrow(u),
            v: narrow(v),
            patch: loaded.number_of(found.surface),
            normal: found.normal.map(|normal| normal.map(&narrow)),
        }
    };
    match outcome {
        Outcome::Hit(found) if found.grazing => Answer::Graze(line(found)),
        Outcome::Hit(found) => Answer::Hit(line(found)),
        Outcome::Miss => Answer::Miss,
        Outcome::GaveUp { limit, best } => Answer::GaveUp { limit, best: best.as_ref().map(line) },
        Outcome::Refused(_) | Outcome::Invalid => Answer::Invalid,
    }
}
