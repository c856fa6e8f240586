//! Files of surfaces, whatever their format: [`bpt`], or the JSON of [`nurbs_python`].
use std::path::Path;

use super::error::{InputError, OnInvalid, Skipped};
use super::model::Model;
use super::source::SourceText;
use super::spline::SplineSummary;
use super::{bpt, nurbs_python};

/// What was read from a file of surfaces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchFile {
    /// The surfaces, each with its number in the file; of a B-spline its pieces, with its number.
    pub model: Model,
    /// The B-splines whose pieces are in the model, in the file's order.
    pub splines: Vec<SplineSummary>,
    /// The surfaces that were left out; empty unless the reader was told to skip.
    pub skipped: Vec<Skipped>,
}

/// Reads the file at `path`; `-` is standard input.
///
/// `.bpt` and `.json` say which format it is. In a file of another name, a text that begins with a brace is JSON.
///
/// # Errors
/// The file cannot be read, is not in its format, or holds an invalid surface that is not to be skipped.
pub fn read(path: &Path, on_invalid: OnInvalid) -> Result<PatchFile, InputError> {
    let source = SourceText::read(path)?;
    let named = |name: &str| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(name));
    let braced = || source.text().trim_start_matches('\u{feff}').trim_start().starts_with('{');
    if named("json") || (!named("bpt") && braced()) {
        nurbs_python::read(&source, on_invalid)
    } else {
        bpt::read(&source, on_invalid)
    }
}
