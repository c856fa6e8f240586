//! `patchray diff`: whether two pictures are the same, and how they differ.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use super::Failure;
use super::outputs::Outputs;
use crate::channels::difference::{Difference, OfChannel};
use crate::channels::{Channels, read};
use crate::output::{self, Output};
use crate::settings::Flags;
use crate::stats::to_json;

/// The command line of `diff`.
#[derive(Args, Clone, Debug)]
pub struct DiffArgs {
    /// A picture: PNG of 8 bits a channel, or OpenEXR
    pub first: PathBuf,
    /// Another one
    pub second: PathBuf,
    /// How far apart numbers may be that count as the same: of PNG steps of 255, of OpenEXR the channel's units
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0, value_parser = distance)]
    pub tolerance: f64,
    /// Write a picture of what differs (PNG)
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Print the numbers as JSON
    #[arg(long)]
    pub json: bool,
    /// Print nothing: the exit code says it all
    #[arg(long, short, conflicts_with = "json")]
    pub quiet: bool,
}

fn distance(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| *number >= 0.0 && number.is_finite());
    number.ok_or("write a finite number, 0 or more".to_owned())
}

/// Compares the pictures.
///
/// # Errors
/// They differ; one cannot be read; or an output cannot be written.
pub fn run(args: &DiffArgs) -> Result<(), Failure> {
    let DiffArgs { first, second, tolerance, output, json, quiet } = args;
    let flags = Flags { json: *json, ..Flags::default() };
    Outputs::of_picture(output.as_deref(), &[], &flags)?.spare([first.as_path(), second.as_path()])?;
    let [a, b] = [load(first)?, load(second)?];
    let Some(difference) = Difference::of(&a, &b, *tolerance) else {
        let [a, b] = [a, b].map(|channels| channels.size.map(|side| side.to_string()).join(" x "));
        let how = format!("the first has {a} pixels, the second {b}");
        return Err(if *quiet { Failure::Told } else { Failure::Differ { how } });
    };
    if let Some(path) = output {
        let picture = difference.picture(&a);
        output::write(path, |png| picture.write_png(png))?;
    }
    if !quiet {
        let text = if *json { to_json(&difference) } else { table(&difference) };
        let mut out = Output::create(Path::new("-"))?;
        out.write_all(text.as_bytes()).map_err(|reason| out.failed(reason))?;
        out.finish()?;
    }
    if difference.is_none() {
        return Ok(());
    }
    // How they differ is what was printed.
    Err(Failure::Told)
}

fn load(path: &Path) -> Result<Channels, Failure> {
    read::read(path).map_err(|reason| Failure::Refused {
        file: path.display().to_string(),
        reason: reason.to_string(),
        help: "compare PNG of 8 bits a channel, or OpenEXR".to_owned(),
    })
}

fn table(difference: &Difference) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |args: std::fmt::Arguments| {
        let _ = writeln!(text, "{args}");
    };
    line(format_args!(
        "{:<16}{:>10}{:>12}{:>14}{:>14}{:>14}  at",
        "channel", "differing", "no distance", "largest", "mean", "rms"
    ));
    for OfChannel { name, differing, without_distance, largest, at, mean, rms } in &difference.channels {
        let at = at.map_or("-".to_owned(), |[x, y]| format!("{x},{y}"));
        line(format_args!(
            "{name:<16}{differing:>10}{without_distance:>12}{largest:>14.6e}{mean:>14.6e}{rms:>14.6e}  {at}"
        ));
    }
    for (names, whose) in [(&difference.only_in_first, "first"), (&difference.only_in_second, "second")] {
        if !names.is_empty() {
            line(format_args!("only in the {whose}: {}", names.join(", ")));
        }
    }
    line(format_args!("{} of {} pixels differ", difference.differing, difference.pixels));
    text
}
