//! Patch files, `.bpt`: the text format of the Utah teapot, with weights and comments.
//!
//! The first line is the number of surfaces. Each surface is a line `m n`, its degrees in u and v (1 to 15), then
//! (m+1)(n+1) lines, a control point each, u being the outer index: `x y z`, or `x y z w` throughout a rational surface,
//! where the weight w is above 0 and not multiplied in. A `#` starts a comment; blank lines are passed over.
//!
//! ```
//! use patchray_host::scene::{bpt, error::OnInvalid};
//! let text = "1      # one surface\n\
//!             1 1    # flat: degree 1 in u and in v\n\
//!             0 0 0\n\
//!             0 1 0\n\
//!             1 0 0\n\
//!             1 1 0\n";
//! let file = bpt::parse("square.bpt", text, OnInvalid::Refuse)?;
//! assert_eq!(file.model.surfaces[0].points[1], [0.0, 1.0, 0.0, 1.0]);
//! # Ok::<(), patchray_host::scene::error::InputError>(())
//! ```
use std::ops::Range;

use super::error::{InputError, OnInvalid, Skipped};
use super::model::ModelSurface;
use super::patches::PatchFile;
use super::source::{Counted, SourceText};
pub use writer::write;

mod writer;

/// The highest degree of a surface in either direction; the kernel's working nets are made for it.
pub const MAX_DEGREE: usize = 15;

/// Reads the text of a patch file.
///
/// # Errors
/// It is not in the format, or holds an invalid surface that is not to be skipped.
pub fn read(source: &SourceText, on_invalid: OnInvalid) -> Result<PatchFile, InputError> {
    Reader::new(source, on_invalid).file()
}

/// Reads `text`, a whole patch file; `name` stands for its path in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(name: &str, text: &str, on_invalid: OnInvalid) -> Result<PatchFile, InputError> {
    read(&SourceText::new(name, text), on_invalid)
}

/// A run of characters without a space, and the byte at which it starts.
#[derive(Clone, Copy)]
struct Token<'a> {
    text: &'a str,
    start: usize,
}

impl Token<'_> {
    fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }
}

/// A line with something on it.
type Line<'a> = Vec<Token<'a>>;

fn line_span(line: &[Token]) -> Range<usize> {
    line.first().map_or(0, |token| token.start)..line.last().map_or(0, |token| token.span().end)
}

struct Reader<'a> {
    source: &'a SourceText,
    on_invalid: OnInvalid,
    /// Where the next line starts.
    next: Counted,
    /// The line that was read last, for "the file ends here".
    last: Range<usize>,
}

/// Why a surface is not in the model.
enum Fault {
    /// Its numbers are not valid, but the next surface can be found.
    Value(InputError),
    /// Nothing behind this can be understood.
    Structure(InputError),
}

impl From<InputError> for Fault {
    fn from(error: InputError) -> Self {
        Self::Structure(error)
    }
}

impl<'a> Reader<'a> {
    fn new(source: &'a SourceText, on_invalid: OnInvalid) -> Self {
        let bom = if source.text().starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
        Self { source, on_invalid, next: Counted { offset: bom, lines: 0 }, last: 0..0 }
    }

    fn file(mut self) -> Result<PatchFile, InputError> {
        let count = self.count()?;
        let mut file = PatchFile::default();
        for number in 0.. {
            let Some(header) = self.header(number, count)? else {
                break;
            };
            match self.surface(number, &header) {
                Ok(surface) => file.model.surfaces.push(surface),
                Err(Fault::Value(InputError::Refused(why))) if self.on_invalid == OnInvalid::Skip => {
                    file.skipped.push(Skipped::from_refusal("surface", number, &why));
                }
                Err(Fault::Value(error) | Fault::Structure(error)) => return Err(error),
            }
        }
        Ok(file)
    }

    /// Refuses the file because of `span`, which is on the line read last or before it.
    fn refuse(
        &self,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> InputError {
        self.source.refuse_near(self.next, span, message, label, help)
    }

    /// The first line: the number of surfaces. Nothing is allocated by it, as it may lie.
    fn count(&mut self) -> Result<u64, InputError> {
        let Some(line) = self.line() else {
            return Err(self.refuse(
                0..0,
                "the file is empty",
                "nothing here",
                "the first line is the number of surfaces; then each surface: a line with its degrees, and its points",
            ));
        };
        match line[..] {
            [token] if token.text.parse::<u64>().is_ok() => Ok(token.text.parse().unwrap_or(0)),
            _ => Err(self.refuse(
                line_span(&line),
                "the first line is not the number of surfaces",
                "expected one whole number",
                "write the number of surfaces alone on the first line, such as `32`",
            )),
        }
    }

    /// The line of degrees of surface `number`; `None` after the last one.
    fn header(&mut self, number: usize, count: u64) -> Result<Option<Line<'a>>, InputError> {
        let line = self.line();
        match line {
            None if number as u64 == count => Ok(None),
            None => Err(self.refuse(
                self.last.clone(),
                format!("the file holds {number} of the {count} surfaces that its first line promises"),
                "the file ends after this",
                format!("add the missing surfaces, or write `{number}` as the first line"),
            )),
            // Points behind a complete surface are too many points of it, whether or not another surface is due.
            Some(line) if number > 0 && matches!(line.len(), 3 | 4) => Err(self.refuse(
                line_span(&line),
                format!("surface {} has more points than its degrees say", number - 1),
                "one point too many",
                "a surface of degrees m n has (m+1)(n+1) points: correct the degrees, or remove the points",
            )),
            Some(line) if number as u64 == count => Err(self.refuse(
                line_span(&line),
                format!("the file goes on after the {count} surfaces that its first line promises"),
                "nothing is expected here",
                "correct the number of surfaces in the first line, or remove what is too much",
            )),
            Some(line) => Ok(Some(line)),
        }
    }

    fn surface(&mut self, number: usize, header: &[Token<'a>]) -> Result<ModelSurface, Fault> {
        let [m, n] = *header else {
            return Err(Fault::Structure(self.refuse(
                line_span(header),
                format!("surface {number} does not start with its two degrees"),
                "expected `m n`",
                "write the degrees in u and in v, such as `3 3`, and then the points",
            )));
        };
        let (degree_u, degree_v) = (self.degree(number, m, 'u')?, self.degree(number, n, 'v')?);
        let mut fault = None;
        for (degree, token, direction) in [(degree_u, m, 'u'), (degree_v, n, 'v')] {
            if degree == 0 || degree > MAX_DEGREE as u64 {
                fault = fault.or(Some(self.refuse(
                    token.span(),
                    format!("surface {number} has degree {degree} in {direction}"),
                    format!("not from 1 to {MAX_DEGREE}"),
                    if degree == 0 {
                        "a curve is no surface: raise the degree to 1 at least"
                    } else {
                        "split the surface or reduce its degree"
                    },
                )));
            }
        }
        let expected = degree_u.saturating_add(1).saturating_mul(degree_v.saturating_add(1));
        let whole = format!("{expected} points of degrees {} {}", m.text, n.text);
        let mut points = Vec::new();
        let mut arity = None;
        for index in 0..expected {
            let Some(line) = self.line() else {
                return Err(Fault::Structure(self.refuse(
                    self.last.clone(),
                    format!("surface {number} is cut off: it has {index} of the {whole}"),
                    "the file ends after this",
                    "add the missing points, or correct the degrees",
                )));
            };
            self.check_arity(number, index, &whole, &line, &mut arity)?;
            match self.point(number, index, &line) {
                // A faulty surface is only passed over; its points need not fit a net.
                Ok(point) if fault.is_none() => points.push(point),
                Ok(_) => {}
                Err(Fault::Value(error)) => fault = fault.or(Some(error)),
                Err(structure) => return Err(structure),
            }
        }
        match fault {
            Some(error) => Err(Fault::Value(error)),
            None => Ok(ModelSurface {
                number,
                // Both are at most MAX_DEGREE here.
                degree_u: degree_u as usize,
                degree_v: degree_v as usize,
                rational: arity == Some(4),
                points,
                knots: None,
            }),
        }
    }

    fn degree(&self, number: usize, token: Token, direction: char) -> Result<u64, InputError> {
        token.text.parse().map_err(|_| {
            self.refuse(
                token.span(),
                format!("the degree of surface {number} in {direction} is not a whole number from 1 to {MAX_DEGREE}"),
                "not a degree",
                "write two whole numbers, the degrees in u and in v, such as `3 3`",
            )
        })
    }

    /// Refuses a line that is not three or four numbers, as many as the points of its surface before it.
    fn check_arity(
        &self,
        number: usize,
        index: u64,
        whole: &str,
        line: &[Token],
        arity: &mut Option<usize>,
    ) -> Result<(), InputError> {
        let point = format!("point {index} of surface {number}");
        let (message, help) = match (line.len(), *arity) {
            (2, _) => (
                format!("surface {number} is cut off: it has {index} of the {whole}"),
                "these two numbers look like the degrees of the next surface: add the missing points before them",
            ),
            (found, None) if found == 3 || found == 4 => {
                *arity = Some(found);
                return Ok(());
            }
            (found, Some(expected)) if found == expected => return Ok(()),
            (found @ (3 | 4), Some(expected)) => (
                format!("{point} has {found} numbers, those before it {expected}"),
                "write every point of a surface as `x y z`, or every one as `x y z w` (w = 1 where there is no weight)",
            ),
            (found, _) => {
                (format!("{point} has {found} numbers"), "write a point as `x y z`, or `x y z w` with a weight")
            }
        };
        Err(self.source.refuse(line_span(line), message, "not a point as expected", help))
    }

    fn point(&self, number: usize, index: u64, line: &[Token]) -> Result<[f64; 4], Fault> {
        let mut point = [0.0, 0.0, 0.0, 1.0];
        let mut fault = None;
        for (slot, token) in line.iter().enumerate() {
            let name = ["x", "y", "z", "the weight"][slot];
            let of = format!("of point {index} of surface {number}");
            let Ok(value) = token.text.parse::<f64>() else {
                return Err(Fault::Structure(self.refuse(
                    token.span(),
                    format!("{name} {of} is not a number: `{}`", token.text.chars().take(40).collect::<String>()),
                    "not a number",
                    "write a decimal number, such as `-1.5` or `2e-3`",
                )));
            };
            let wrong = if value.is_nan() {
                Some(("is not a number (NaN)", "write a finite number"))
            } else if value.is_infinite() && token.text.contains(|c: char| c.is_ascii_digit()) {
                Some(("is too large for a 64-bit floating point number", "use smaller units: at most 1.7e308"))
            } else if value.is_infinite() {
                Some(("is infinite", "write a finite number; a point at infinity needs another form of the surface"))
            } else if slot == 3 && value <= 0.0 {
                Some(("is not above 0", "write a weight above 0; it is not multiplied into x, y and z"))
            } else {
                None
            };
            if let (Some((wrong, help)), true) = (wrong, fault.is_none()) {
                let message = format!("{name} {of} {wrong}");
                fault = Some(self.refuse(token.span(), message, "not valid", help));
            }
            point[slot] = value;
        }
        fault.map_or(Ok(point), |error| Err(Fault::Value(error)))
    }

    /// The next line with something on it.
    fn line(&mut self) -> Option<Line<'a>> {
        let text = self.source.text();
        // Ends with the text, of which every round takes a line.
        while self.next.offset < text.len() {
            let start = self.next.offset;
            let end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
            // The last line may have no end.
            let ended = usize::from(end < text.len());
            self.next = Counted { offset: end + ended, lines: self.next.lines + ended };
            let content = text[start..end].split('#').next().unwrap_or("");
            let line: Line = content
                .split_ascii_whitespace()
                .map(|word| Token { text: word, start: start + offset_in(content, word) })
                .collect();
            if !line.is_empty() {
                self.last = line_span(&line);
                return Some(line);
            }
        }
        None
    }
}

/// The byte of `text` at which `part`, a part of it, starts.
fn offset_in(text: &str, part: &str) -> usize {
    part.as_ptr() as usize - text.as_ptr() as usize
}

#[cfg(test)]
mod tests;
