//! `patchray report`: what a study measured, as one page with its diagrams.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use super::outputs::{Outputs, StatsOutputs};
use super::study::refused;
use super::{Failure, say};
use crate::output;
use crate::report::study::StudyReport;
use crate::settings::Flags;
use crate::study::folder::Folder;

/// The command line of `report`.
#[derive(Args, Clone, Debug)]
pub struct ReportArgs {
    /// The folder that `study` filled, or is filling
    pub folder: PathBuf,
    /// The page to write [default: report.html in the folder]; its diagrams are written beside it, as SVG files
    #[arg(long, short, value_name = "FILE", help_heading = "Output")]
    pub output: Option<PathBuf>,
    /// Write the figures of the page as JSON; `-` is standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub stats: Option<PathBuf>,
    /// Print JSON on standard output: what --stats writes
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// No summary; warnings and errors stay
    #[arg(long, short, help_heading = "Output")]
    pub quiet: bool,
}

/// Draws the page, and says what is missing.
///
/// # Errors
/// Flags that do not go together, no study in the folder, or the page cannot be written.
pub fn run(args: &ReportArgs) -> Result<(), Failure> {
    let folder = Folder::open(&args.folder).map_err(refused)?;
    let path = args.output.clone().unwrap_or_else(|| args.folder.join("report.html"));
    let flags = Flags { stats: args.stats.clone(), json: args.json, ..Flags::default() };
    let files = folder.files();
    Outputs::new(Some(&path), &[], &flags)?.spare(files.iter().map(PathBuf::as_path))?;
    let stats_outputs = StatsOutputs::create(&flags)?;
    let (records, missing) = folder.read_all();
    let report = StudyReport { manifest: folder.manifest.clone(), records, missing };
    let stdout = path == Path::new("-");
    let stem = path.file_stem().filter(|_| !stdout).map_or("report".into(), |stem| stem.to_string_lossy().into_owned());
    let rendered = report.render(&stem);
    if !stdout {
        for drawing in &rendered.drawings {
            let file = path.with_file_name(format!("{stem}-{}.svg", drawing.name));
            output::write(&file, |out| out.write_all(drawing.svg.as_bytes()))?;
        }
    }
    // Last, so that a page that is there has its diagrams.
    output::write(&path, |out| out.write_all(rendered.html.as_bytes()))?;
    stats_outputs.finish(&report.data())?;
    for (id, reason) in &report.missing {
        let reason = reason.as_ref().map_or(String::new(), |reason| format!(" (its file is not whole: {reason})"));
        say(format_args!("missing: {id}{reason}"));
    }
    if !args.quiet {
        let [cells, missing] = [report.records.len(), report.missing.len()];
        say(format_args!("{cells} cells drawn, {missing} missing: {}", path.display()));
    }
    Ok(())
}
