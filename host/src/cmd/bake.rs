//! `patchray bake`: what a method borrows of a scene, as tables in source for firmware.

use std::path::{Path, PathBuf};

use clap::Args;

use super::load::{self, Loaded};
use super::outputs::Outputs;
use super::{Failure, say};
use crate::lower::Stages;
use crate::output;
use crate::prepared::Prepared;
use crate::settings::Flags;

/// The command line of `bake`.
#[derive(Args, Clone, Debug)]
pub struct BakeArgs {
    /// A file of surfaces (.bpt, or NURBS-Python's .json), or a scene file (.toml)
    pub file: PathBuf,
    /// Write the tables as a Rust module; `-` is standard output
    #[arg(long, value_name = "FILE", required_unless_present = "c", help_heading = "Output")]
    pub rust: Option<PathBuf>,
    /// Write the tables as a header in C, whose names begin with the file's; `-` is standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub c: Option<PathBuf>,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// Writes the tables.
///
/// # Errors
/// Flags that do not go together, bad input, too little memory, or an output that cannot be written.
pub fn run(args: &BakeArgs) -> Result<(), Failure> {
    let BakeArgs { file, rust, c, flags } = args;
    if flags.output.is_some() || flags.stats.is_some() || flags.json {
        return Err(Failure::Usage {
            message: "`bake` writes tables alone".to_owned(),
            help: "name their file with --rust or --c, and ask `info` for their bytes".to_owned(),
        });
    }
    let named = [("--rust", rust), ("--c", c)].map(|(flag, path)| Some((flag, path.as_deref()?)));
    let named: Vec<_> = named.into_iter().flatten().collect();
    let outputs = Outputs::new(None, &named, flags)?;
    let Loaded { model, settings, .. } = load::scene_or_patches(file, flags, &outputs)?;
    let prepared = Prepared::build(&model, Stages::of(settings.method), &settings)?;
    let baked = prepared.baked(settings.method);
    let name = name(file);
    if let Some(path) = rust {
        output::write(path, |out| baked.write_rust(&name, out))?;
    }
    if let Some(path) = c {
        output::write(path, |out| baked.write_c(&name, &identifier(path), out))?;
    }
    if !flags.quiet {
        say(format_args!("{} bytes of tables for {}", baked.bytes(), settings.method.name()));
    }
    Ok(())
}

/// The file's name without its folder, which is of no use elsewhere, on one line.
fn name(file: &Path) -> String {
    let name = file.file_name().map_or("standard input".into(), |name| name.to_string_lossy());
    name.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

/// What the names in a header begin with: the name of its file without folder and ending, as far as C has such names.
fn identifier(path: &Path) -> String {
    let stem = path.file_stem().map_or("scene".into(), |stem| stem.to_string_lossy());
    let name: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|first: char| first.is_ascii_alphabetic()) { name } else { format!("scene_{name}") }
}
