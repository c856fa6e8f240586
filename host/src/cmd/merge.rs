//! `patchray merge`: parts of a picture in, the picture out.

use std::path::PathBuf;

use clap::Args;

use super::outputs::Outputs;
use super::{Failure, say};
use crate::output;
use crate::picture::part::{Part, PartError};
use crate::settings::Flags;

/// The command line of `merge`.
#[derive(Args, Clone, Debug)]
pub struct MergeArgs {
    /// The parts: what `render --rows` wrote, or an interrupted run has left
    #[arg(required = true)]
    pub parts: Vec<PathBuf>,
    /// The picture to write; `-` is standard output
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// No summary; warnings and errors stay
    #[arg(long, short)]
    pub quiet: bool,
}

/// Puts the parts together: the picture is, byte for byte, what one run draws.
///
/// # Errors
/// A file that is no part, or of another picture; rows that are in none; or an output that cannot be written.
pub fn run(args: &MergeArgs) -> Result<(), Failure> {
    let MergeArgs { parts, output, quiet } = args;
    Outputs::of_picture(Some(output), &[], &Flags::default())?.spare(parts.iter().map(PathBuf::as_path))?;
    let mut whole: Option<Part> = None;
    for path in parts {
        let refused = |reason: PartError| Failure::Refused {
            file: path.display().to_string(),
            reason: reason.to_string(),
            help: "merge parts of one picture, drawn by `patchray render` with --rows".to_owned(),
        };
        let part = Part::read(path).map_err(refused)?;
        match &mut whole {
            None => whole = Some(part),
            Some(whole) => whole.join(part).map_err(refused)?,
        }
    }
    let whole = whole.ok_or_else(|| Failure::Internal("no parts".to_owned()))?;
    let picture = whole.whole().ok_or_else(|| Failure::Missing { rows: whole.missing() })?;
    output::write(output, |png| picture.write_png(png))?;
    let [width, height] = picture.size();
    if !quiet {
        say(format_args!("{} parts, {width} x {height} pixels", parts.len()));
    }
    Ok(())
}
