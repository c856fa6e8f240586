//! `patchray stress`: stiff and extreme cases, every answer held against an oracle in double-double.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use super::outputs::{Outputs, StatsOutputs};
use super::{Failure, hear_parts, pool, progress};
use crate::output::{self, Output};
use crate::report::stress::{Report, families};
use crate::report::table::Style;
use crate::scene::nearest::did_you_mean;
use crate::scene::trace::Precision;
use crate::settings::{Flags, Settings};
use crate::stats::{Asked, SCHEMA, to_json};
use crate::stress::bounds::{Bounds, RAYS, SEED, broken};
use crate::stress::case::Family;
use crate::stress::families::all;
use crate::stress::run::{Plan, family};

/// The command line of `stress`.
#[derive(Args, Clone, Debug)]
pub struct StressArgs {
    /// The families to run, by name [default: all]
    pub families: Vec<String>,
    /// Print the families, and trace nothing
    #[arg(long, help_heading = "Cases")]
    pub list: bool,
    /// What surfaces and rays are drawn from
    #[arg(long, value_name = "N", default_value_t = SEED, help_heading = "Cases")]
    pub seed: u64,
    /// About how many rays each family has
    #[arg(long, value_name = "N", default_value_t = RAYS, value_parser = at_least_60, help_heading = "Cases")]
    pub rays: usize,
    /// Write what was measured as the bounds that are not to be missed
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub record: Option<PathBuf>,
    /// Print the table as Markdown
    #[arg(long, help_heading = "Output")]
    pub markdown: bool,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// Families share their rays among up to 30 cases.
fn at_least_60(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if (60..=10_000_000).contains(&number) => Ok(number),
        _ => Err("write a whole number from 60 to 10000000".to_owned()),
    }
}

fn wanted(names: &[String]) -> Result<Vec<Family>, Failure> {
    let all = all();
    let known: Vec<&str> = all.iter().map(|family| family.name).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Failure::Usage {
            message: format!("there is no family `{unknown}`{}", did_you_mean(unknown, &known).unwrap_or_default()),
            help: "--list prints all families".to_owned(),
        });
    }
    let families = all.into_iter().filter(|family| names.is_empty() || names.iter().any(|name| name == family.name));
    Ok(families.collect())
}

/// Traces the families, and prints what became of their rays.
///
/// # Errors
/// Flags that do not go together, an output that cannot be written, or bounds that were missed.
pub fn run(args: &StressArgs) -> Result<(), Failure> {
    let StressArgs { seed, rays, record, markdown, flags, .. } = args;
    let stdout = Path::new("-");
    let families_wanted = wanted(&args.families)?;
    if args.list {
        let text = families(&families_wanted).to_text(if *markdown { Style::Markdown } else { Style::Text });
        return Ok(output::write(stdout, |out| out.write_all(text.as_bytes()))?);
    }
    let output = flags.output.as_deref().or((!flags.json && flags.stats.as_deref() != Some(stdout)).then_some(stdout));
    Outputs::new(output, &[], flags)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let mut out = output.map(Output::create).transpose()?;

    let settings = Settings::of_flags(flags);
    hear_parts(flags.method, Asked::Closest, settings.parts)?;
    let plan = Plan { settings: &settings, seed: *seed, rays: *rays };
    let precisions: Vec<Precision> = match flags.precision {
        Some(precision) => vec![precision],
        None => vec![Precision::F64, Precision::F32],
    };
    let bar = progress((families_wanted.len() * precisions.len()) as u64, "tracing", flags.quiet);
    let threads = pool(settings.threads)?;
    let mut rows = Vec::new();
    for hard in &families_wanted {
        for &precision in &precisions {
            let of_method = |method| flags.method.is_none_or(|wanted| wanted == method);
            rows.extend(threads.install(|| family(hard, precision, &plan, of_method)));
            bar.inc(1);
        }
    }
    bar.finish_and_clear();

    let mut missed: Vec<String> = rows.iter().flat_map(|row| broken(row, &families_wanted)).collect();
    // Recorded figures are of these cases and settings only.
    let defaults = Settings { threads: settings.threads, ..Settings::of_flags(&Flags::default()) };
    let same = Settings { method: defaults.method, precision: defaults.precision, ..settings } == defaults;
    if same && *seed == SEED && *rays == RAYS && record.is_none() {
        let bounds = Bounds::recorded().map_err(Failure::Internal)?;
        missed.extend(rows.iter().flat_map(|row| bounds.exceeded(row)));
    }
    if let Some(path) = record {
        let text = to_json(&Bounds::of(&rows));
        output::write(path, |out| out.write_all(text.as_bytes()))?;
    }
    let report = Report {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        seed: *seed,
        rays: *rays,
        acceptance: settings.acceptance,
        rows,
        missed,
    };
    stats_outputs.finish(&report)?;
    if let Some(mut out) = out.take() {
        let text = report.to_text(if *markdown { Style::Markdown } else { Style::Text });
        out.write_all(text.as_bytes()).map_err(|reason| out.failed(reason))?;
        out.finish()?;
    }
    if report.missed.is_empty() { Ok(()) } else { Err(Failure::No { missed: report.missed.len() }) }
}
