//! The command `patchray`.

use std::io::IsTerminal;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use miette::MietteHandlerOpts;
use patchray_host::cmd::{Failure, bake, demo, diff, info, merge, query, render, report, stress, study, tables};

/// Traces rays against Bézier surfaces themselves, without tessellation.
///
/// Without a verb it draws the built-in teapot with every method, compares each pixel with the oracle, and prints a table.
///
/// Exit codes: 0 done, 1 the answer is no, 2 usage, 3 input refused, 4 capacity, 5 internal or I/O, 130 interrupted.
#[derive(Parser, Debug)]
#[command(name = "patchray", version, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    verb: Option<Verb>,
    #[command(flatten)]
    demo: demo::DemoArgs,
}

#[derive(Subcommand, Debug)]
enum Verb {
    /// Draw a scene
    Render(render::RenderArgs),
    /// Put parts of a picture together, drawn with `render --rows`: the same bytes as of one run
    Merge(merge::MergeArgs),
    /// Say whether two pictures are the same, and how they differ: exit code 0 if they are, 1 if not
    Diff(diff::DiffArgs),
    /// Answer a batch of rays
    Query(query::QueryArgs),
    /// Say what a file holds, and the memory that each method needs for it
    Info(info::InfoArgs),
    /// Write what a method borrows of a scene as tables in source, so that firmware holds them in flash and prepares nothing
    Bake(bake::BakeArgs),
    /// Measure the paper's tables on its four scenes, with the paper's figures beside ours
    Tables(tables::TablesArgs),
    /// Measure the error and the run time of every method, with one setting at a time moved from its default
    ///
    /// Each cell of the study, a method in a precision with a setting, is traced on one thread, held against the oracle, and
    /// written as a file of JSON lines into the folder that `-o` names, `target/study` if it names none. Cells whose file is
    /// there are not measured again, so that a study can be stopped and resumed, and spread over machines with `--shard`;
    /// `patchray report` draws what is there. The picture has 256 × 256 pixels unless `--size` says otherwise.
    Study(study::StudyArgs),
    /// Trace stiff and extreme cases by every method, and hold each answer against an oracle in double-double
    ///
    /// A row of the table is a family of cases by a method in a precision: how many of its rays could not be judged, because
    /// rounding may change their answer; what became of the others; how many a coherent method answers unlike the original,
    /// and how many it would by the paper's rule of acceptance; the largest distance between surface and ray at a hit, as a
    /// share of the model's diagonal; and the most Newton steps and clips that a ray took, and may take. With the default
    /// seed, rays and settings the figures are held against those recorded; a bound that is missed makes the exit code 1.
    Stress(stress::StressArgs),
    /// Draw what a study measured, as one page
    Report(report::ReportArgs),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match &cli.verb {
        None => demo::run(&cli.demo),
        Some(Verb::Render(args)) => render::run(args),
        Some(Verb::Diff(args)) => diff::run(args),
        Some(Verb::Merge(args)) => merge::run(args),
        Some(Verb::Query(args)) => query::run(args),
        Some(Verb::Info(args)) => info::run(args),
        Some(Verb::Bake(args)) => bake::run(args),
        Some(Verb::Tables(args)) => tables::run(args),
        Some(Verb::Study(args)) => study::run(args),
        Some(Verb::Report(args)) => report::run(args),
        Some(Verb::Stress(args)) => stress::run(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => report(failure),
    }
}

/// How wide messages are where there is no terminal: wide enough that places and names stay on one line.
const WIDTH: usize = 240;

/// Prints why the command failed; the exit code that goes with it.
fn report(failure: Failure) -> ExitCode {
    let code = failure.code();
    if code != 0 && !matches!(failure, Failure::Told) {
        if !std::io::stderr().is_terminal() {
            // Fails only if a hook is set already; the default then does as well.
            let _ = miette::set_hook(Box::new(|_| Box::new(MietteHandlerOpts::new().width(WIDTH).build())));
        }
        patchray_host::cmd::say(format_args!("{:?}", miette::Report::new(failure)));
    }
    ExitCode::from(code)
}
