//! The text of an input file, and the part of it that an error shows.
use std::fs;
use std::io::{self, Read};
use std::ops::Range;
use std::path::Path;

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::error::{InputError, Refusal};

/// The text of an input file with the name that errors show.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceText {
    name: String,
    text: String,
}

impl SourceText {
    /// A text that is in memory; `name` stands for the file's path in errors.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into() }
    }

    /// Reads the file at `path`; `-` is standard input.
    ///
    /// # Errors
    /// The file cannot be read, or is not UTF-8 (the place is that of the first byte that is not).
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let name = path.display().to_string();
        let mut bytes = Vec::new();
        let read = if path == Path::new("-") {
            io::stdin().lock().read_to_end(&mut bytes).map(|_| ())
        } else {
            fs::read(path).map(|contents| bytes = contents)
        };
        read.map_err(|reason| InputError::unreadable(path, reason))?;
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self { name, text }),
            Err(error) => {
                let start = error.utf8_error().valid_up_to();
                let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
                let end = start + text[start..].chars().next().map_or(0, char::len_utf8);
                Err(Self { name, text }.refuse(
                    start..end,
                    "the file is not text: this byte does not belong to any UTF-8 character",
                    "not UTF-8",
                    "save the file as plain text in UTF-8 (ASCII will do)",
                ))
            }
        }
    }

    /// The name that errors show.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The error that refuses the file because of the bytes `span`: `message` says what is wrong, `label` stands under the
    /// underlined text, `help` says what to write instead.
    pub fn refuse(
        &self,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> InputError {
        self.refuse_near(Counted::default(), span, message, label, help)
    }

    /// As [`refuse`](Self::refuse), with lines counted from a place near `span`: counting from the start of the file for
    /// each of many refusals would take the square of its length.
    pub(super) fn refuse_near(
        &self,
        counted: Counted,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> InputError {
        let excerpt = Excerpt::of(&self.text, span.clone(), counted);
        Refusal::new(&self.name, excerpt, span, message.into(), label.into(), help.into()).into()
    }
}

/// A place in a text up to which lines are counted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counted {
    /// The byte.
    pub(super) offset: usize,
    /// The ends of lines before it.
    pub(super) lines: usize,
}

/// How many bytes of text an excerpt keeps on either side of what it is about. More shows more of a long line; less keeps
/// a report readable when a file of megabytes is one line. Reached only by lines longer than this.
const MARGIN: usize = 120;

/// A few lines of a file around a place, with offsets, lines and columns as in the whole file.
///
/// An error carries this instead of the whole text, which may be gigabytes.
#[derive(Clone, Debug, PartialEq)]
pub struct Excerpt {
    text: String,
    /// Byte offset of `text` in the file.
    offset: usize,
    /// Lines of the file before the line in which `text` starts.
    line: usize,
    /// Characters of that line before `text`.
    column: usize,
}

impl Excerpt {
    /// The excerpt of `text`, a whole file, around the bytes `span`.
    pub(super) fn of(text: &str, span: Range<usize>, counted: Counted) -> Self {
        let start = char_start(text, span.start);
        let end = char_start(text, span.end.clamp(start, start + MARGIN));
        let this_line = line_start(text, start);
        let first = char_start(text, start.saturating_sub(MARGIN)).max(line_start(text, this_line.saturating_sub(1)));
        let mut next_lines = text[end..].match_indices('\n').map(|(at, _)| end + at + 1);
        let last = next_lines.nth(1).unwrap_or(text.len());
        let last = last.min(char_start(text, end + MARGIN));
        let first_line_start = line_start(text, first);
        let bytes = text.as_bytes();
        let line = if first < counted.offset {
            counted.lines - newlines(&bytes[first..counted.offset])
        } else {
            counted.lines + newlines(&bytes[counted.offset..first])
        };
        Self {
            text: text[first..last].to_owned(),
            offset: first,
            line,
            column: text[first_line_start..first].chars().count(),
        }
    }

    /// An excerpt that is one line, `line` (counted from 1) of the file, which starts at byte `offset` of it.
    pub(super) fn of_line(text: &str, line: usize, offset: usize, span: Range<usize>) -> Self {
        let within = span.start.saturating_sub(offset)..span.end.saturating_sub(offset);
        let mut excerpt = Self::of(text, within, Counted::default());
        excerpt.offset += offset;
        excerpt.line += line.saturating_sub(1);
        excerpt
    }

    /// Line and column, both from 1 and the column in characters, of the byte at `offset` of the file.
    pub(super) fn place(&self, offset: usize) -> (usize, usize) {
        let local = char_start(&self.text, offset.saturating_sub(self.offset));
        let start = line_start(&self.text, local);
        let before = if start == 0 { self.column } else { 0 };
        (self.line + newlines(&self.text.as_bytes()[..local]) + 1, before + self.text[start..local].chars().count() + 1)
    }

    /// The part of `span`, bytes of the file, that the excerpt shows.
    pub(super) fn shown(&self, span: Range<usize>) -> Range<usize> {
        let end = self.offset + self.text.len();
        let start = span.start.clamp(self.offset, end);
        start..span.end.clamp(start, end)
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let local = span.offset().checked_sub(self.offset).ok_or(MietteError::OutOfBounds)?;
        let local = SourceSpan::from((local, span.len()));
        let contents = self.text.read_span(&local, lines_before, lines_after)?;
        let offset = self.offset + contents.span().offset();
        let (line, column) = self.place(offset);
        Ok(Box::new(MietteSpanContents::new(
            contents.data(),
            SourceSpan::from((offset, contents.span().len())),
            line - 1,
            column - 1,
            contents.line_count(),
        )))
    }
}

fn newlines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&byte| byte == b'\n').count()
}

fn line_start(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or(0, |newline| newline + 1)
}

/// The start of the character that holds the byte `at`, or the end of the text.
fn char_start(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at).rev().find(|&start| text.is_char_boundary(start)).unwrap_or(0)
}
