//! Why an input file was refused, and where.
use std::fmt;
use std::io;
use std::ops::Range;
use std::path::Path;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use super::source::Excerpt;

/// An input file that cannot be used. Rendered by `miette`, a refusal shows file, line and column, the underlined source and
/// what to write instead. Either kind ends the command with exit code 3.
#[derive(Debug, Error, Diagnostic)]
pub enum InputError {
    /// The file cannot be read at all.
    #[error("cannot read `{name}`: {reason}")]
    Unreadable {
        /// The path as given.
        name: String,
        /// What the operating system said.
        reason: io::Error,
        /// What to do about it.
        #[help]
        help: String,
    },
    /// The file was read, and what it says is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Refused(#[from] Box<Refusal>),
}

impl InputError {
    /// The error of a file that cannot be read, with advice for the common reasons.
    pub fn unreadable(path: &Path, reason: io::Error) -> Self {
        let help = match reason.kind() {
            io::ErrorKind::NotFound => "check the path; it is taken from the current folder",
            io::ErrorKind::PermissionDenied => "make the file readable for this user",
            io::ErrorKind::IsADirectory => "name a file in this folder",
            _ => "check that the path names a readable file",
        };
        Self::Unreadable { name: path.display().to_string(), reason, help: help.to_owned() }
    }

    /// Where the error is, for a refusal.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Unreadable { .. } => None,
            Self::Refused(refusal) => Some(&refusal.place),
        }
    }
}

/// What is wrong in a file, where, and what to write instead.
#[derive(Debug, Error, Diagnostic)]
#[error("{message}")]
pub struct Refusal {
    message: String,
    label: String,
    #[help]
    help: String,
    place: Place,
    #[source_code]
    excerpt: NamedSource<Excerpt>,
    #[label("{label}")]
    span: SourceSpan,
}

impl Refusal {
    /// A refusal because of the bytes `span` of the file `name`, around which `excerpt` was cut.
    pub(super) fn new(
        name: &str,
        excerpt: Excerpt,
        span: Range<usize>,
        message: String,
        label: String,
        help: String,
    ) -> Box<Self> {
        let (line, column) = excerpt.place(span.start);
        let place = Place { file: name.to_owned(), line, column };
        let shown = excerpt.shown(span);
        let excerpt = NamedSource::new(name, excerpt);
        Box::new(Self { message, label, help, place, excerpt, span: shown.into() })
    }
}

/// A place in a file; prints as `file:line:column`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file's path as given.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)
    }
}

/// What a reader does with a surface or a ray whose numbers are not valid (NaN, infinity, a weight that is not above 0, a
/// zero direction). Damage that hides where the next one starts is refused in either case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnInvalid {
    /// Refuse the file.
    #[default]
    Refuse,
    /// Go on without it, and say so.
    Skip,
}

/// Something that was left out because it is not valid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// What it is, `surface` or `ray`.
    pub kind: &'static str,
    /// Its number in its file, from 0.
    pub number: usize,
    /// Where it went wrong.
    pub place: Place,
    /// Why, as the refusal would have said.
    pub reason: String,
}

impl Skipped {
    /// What was left out, where it would otherwise have been refused with `error`.
    pub(super) fn from_refusal(kind: &'static str, number: usize, refusal: &Refusal) -> Self {
        Self { kind, number, place: refusal.place.clone(), reason: refusal.message.clone() }
    }
}

impl fmt::Display for Skipped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} left out ({}): {}", self.kind, self.number, self.place, self.reason)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use miette::{GraphicalReportHandler, GraphicalTheme};

    use super::super::source::SourceText;
    use super::*;

    /// The report as a person sees it, without colour.
    pub(crate) fn rendered(error: &InputError) -> String {
        let mut report = String::new();
        let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
        handler.with_width(200).render_report(&mut report, error).expect("rendering to a string");
        report
    }

    /// Asserts the place as `file:line:column`, that the message holds `message`, and that the report shows the place.
    pub(crate) fn assert_refused<T>(result: Result<T, InputError>, place: &str, message: &str) {
        let Err(error) = result else { panic!("not refused: {message}") };
        let report = rendered(&error);
        let found = error.place().expect("a refusal").to_string();
        assert_eq!(found, place, "{report}");
        assert!(error.to_string().contains(message), "`{error}` lacks `{message}`");
        assert!(report.contains(&format!("[{place}]")), "{report}");
        assert!(report.contains("help: "), "{report}");
    }

    fn refuse(text: &str, span: Range<usize>) -> Result<(), InputError> {
        Err(SourceText::new("f", text).refuse(span, "wrong", "here", "do this"))
    }

    #[test]
    fn report_shows_place_source_and_help() {
        let Err(error) = refuse("one\ntwo three\nfour\n", 8..13) else { unreachable!() };
        let report = rendered(&error);
        assert!(report.contains("[f:2:5]"), "{report}");
        assert!(report.contains("2 │ two three"), "{report}");
        assert!(report.contains("╰── here"), "{report}");
        assert!(report.contains("help: do this"), "{report}");
    }

    #[test]
    fn places_at_the_ends_of_a_text() {
        assert_refused(refuse("", 0..0), "f:1:1", "wrong");
        assert_refused(refuse("a", 0..1), "f:1:1", "wrong");
        assert_refused(refuse("a\n\nb", 3..4), "f:3:1", "wrong");
        assert_refused(refuse("a\r\nbc\r\n", 4..5), "f:2:2", "wrong");
    }

    #[test]
    fn columns_count_characters() {
        assert_refused(refuse("x\näöü 1\n", 9..10), "f:2:5", "wrong");
    }

    #[test]
    fn a_long_line_is_cut() {
        let text = format!("first\n{}é!{}\nlast\n", "é".repeat(5000), "x".repeat(100_000));
        let at = text.find('!').expect("it is there");
        let result = refuse(&text, at..at + 90_000);
        let report = rendered(result.as_ref().expect_err("refused"));
        assert!(report.len() < 3000, "{}", report.len());
        assert_refused(result, "f:2:5002", "wrong");
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = SourceText::read(Path::new("no/such/file.bpt")).expect_err("missing");
        assert!(error.to_string().starts_with("cannot read `no/such/file.bpt`: "), "{error}");
        assert!(error.place().is_none());
    }
}
