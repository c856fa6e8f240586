//! `patchray tables`: the paper's tables, measured, with the paper's figures beside ours.

use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use clap::Args;

use super::outputs::{Outputs, StatsOutputs};
use super::{Failure, pool, progress};
use crate::judge;
use crate::measure::{Primary, Scene, passes};
use crate::oracle::Oracle;
use crate::output::Output;
use crate::report::table::Style;
use crate::report::tables::{Report, SceneReport};
use crate::scene::paper::{PaperScene, SCENES};
use crate::scene::trace::Acceptance;
use crate::settings::{Flags, Settings, SizeFlag};
use crate::stats::SCHEMA;

/// The command line of `tables`.
#[derive(Args, Clone, Debug)]
pub struct TablesArgs {
    /// The size of the pictures.
    #[command(flatten)]
    pub size: SizeFlag,
    /// How often each method traces each scene for Tables 1 and 2, at least 1; for Tables 3 and 4 half as often
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000),
        help_heading = "Tracing")]
    pub repetitions: u32,
    /// Leave out the oracle, and with it what pixels are wrong; saves a part of the time
    #[arg(long, help_heading = "Tracing")]
    pub skip_oracle: bool,
    /// Print the tables as Markdown
    #[arg(long, help_heading = "Output")]
    pub markdown: bool,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// The size at which the paper measures.
const SIZE: [u32; 2] = [512, 512];

/// Measures the tables on the paper's four scenes, and prints them.
///
/// # Errors
/// Flags that do not go together, too little memory, or an output that cannot be written.
pub fn run(args: &TablesArgs) -> Result<(), Failure> {
    let TablesArgs { size, repetitions, skip_oracle, markdown, flags } = args;
    if flags.method.is_some() {
        return Err(Failure::Usage {
            message: "`tables` compares all methods".to_owned(),
            help: "leave --method out; `render` traces a scene with one method".to_owned(),
        });
    }
    let stdout = Path::new("-");
    let output = flags.output.as_deref().or((!flags.json && flags.stats.as_deref() != Some(stdout)).then_some(stdout));
    Outputs::new(output, &[], flags)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let mut out = output.map(Output::create).transpose()?;

    let begin = Instant::now();
    let size = size.size.unwrap_or(SIZE);
    let mut scenes = Vec::new();
    let mut common = Settings::of_flags(flags);
    for paper in &SCENES {
        let (report, settings) = measure(paper, size, *repetitions, *skip_oracle, flags)?;
        common = settings;
        scenes.push(report);
    }
    let report = Report {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        size,
        precision: common.precision,
        acceptance: common.acceptance,
        repetitions: *repetitions,
        oracle_threads: common.threads,
        seconds: begin.elapsed().as_secs_f64(),
        scenes,
    };
    stats_outputs.finish(&report)?;
    if let Some(mut out) = out.take() {
        let text = report.to_text(if *markdown { Style::Markdown } else { Style::Text });
        out.write_all(text.as_bytes()).map_err(|reason| out.failed(reason))?;
        out.finish()?;
    }
    Ok(())
}

/// All tables of one scene.
fn measure(
    paper: &PaperScene,
    size: [u32; 2],
    repetitions: u32,
    skip_oracle: bool,
    flags: &Flags,
) -> Result<(SceneReport, Settings), Failure> {
    let scene = paper.load()?;
    let settings = Settings {
        // What the paper measured; proofs and their fallback would be measured too.
        acceptance: flags.acceptance.unwrap_or(Acceptance::Paper),
        ..Settings::of_scene(flags, &scene.description.trace, &scene.source)?
    };
    let picture = scene.description.camera.view(size);
    let asked = if skip_oracle {
        None
    } else {
        let bar = progress(u64::from(picture.scan_lines()), "asking the oracle", flags.quiet);
        let oracle = Oracle::new(&scene.model);
        let asked = pool(settings.threads)?.install(|| judge::ask(&oracle, &picture, || bar.inc(1)));
        bar.finish_and_clear();
        Some(asked)
    };
    let bar = progress(passes(repetitions), "measuring", flags.quiet);
    let subject = Scene {
        model: &scene.model,
        appearance: &scene.appearance,
        picture,
        settings,
        repetitions,
        step: &|| bar.inc(1),
    };
    let Primary { runs: [numerical, clipping], outcomes, size: [surfaces, patches] } =
        subject.primary(asked.as_ref().map(|(truths, _)| truths.as_slice()))?;
    let sampling = subject.samplings()?;
    let rays = subject.one_by_one(&outcomes)?;
    bar.finish_and_clear();
    let report = SceneReport {
        name: paper.name(),
        paper: paper.figures,
        surfaces,
        patches,
        oracle: asked.map(|(_, stats)| stats),
        numerical,
        clipping,
        sampling,
        rays,
    };
    Ok((report, settings))
}
