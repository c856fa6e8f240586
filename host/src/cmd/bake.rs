//! `patchray bake`: what a method borrows of a scene, as tables in source for firmware.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};

use super::load::{self, Loaded};
use super::outputs::Outputs;
use super::{Failure, say};
use crate::lower::Stages;
use crate::output;
use crate::prepared::Prepared;
use crate::settings::Flags;

/// The command line of `bake`.
#[derive(Args, Clone, Debug)]
#[command(group = ArgGroup::new("tables").required(true).multiple(true))]
pub struct BakeArgs {
    /// A file of surfaces (.bpt, or NURBS-Python's .json), or a scene file (.toml)
    pub file: PathBuf,
    /// Write the tables as a Rust module; `-` is standard output
    #[arg(long, value_name = "FILE", group = "tables", help_heading = "Output")]
    pub rust: Option<PathBuf>,
    /// Write the tables as a header in C, whose names begin with the file's; `-` is standard output
    #[arg(long, value_name = "FILE", group = "tables", help_heading = "Output")]
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
    let is_free =
        name.starts_with(|first: char| first.is_ascii_alphabetic()) && !RESERVED.split(' ').any(|word| word == name);
    if is_free { name } else { format!("scene_{name}") }
}

/// What neither C11 nor C++17 takes as a name of one's own.
const RESERVED: &str = "\
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t class compl const \
    const_cast constexpr continue decltype default delete do double dynamic_cast else enum explicit export extern \
    false float for friend goto if inline int long main mutable namespace new noexcept not not_eq nullptr operator or \
    or_eq private protected public register reinterpret_cast restrict return short signed sizeof static static_assert \
    static_cast struct switch template this thread_local throw true try typedef typeid typename union unsigned using \
    virtual void volatile wchar_t while xor xor_eq";

#[cfg(test)]
mod tests {
    use super::*;

    /// `int.h` once began with `static const patchray_scene_f64 int`.
    #[test]
    fn names_in_c_are_names() {
        let named = |path: &str| identifier(Path::new(path));
        assert_eq!(["teapot.h", "out/my teapot.h", "2nd.h"].map(named), ["teapot", "my_teapot", "scene_2nd"]);
        assert_eq!(["int.h", "class.h", "main.h"].map(named), ["scene_int", "scene_class", "scene_main"]);
    }
}
