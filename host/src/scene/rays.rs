//! Ray batches: CSV files with a ray a line.
//!
//! The header names the columns, in any order: `ox,oy,oz` the origin and `dx,dy,dz` the direction; optionally `tmin` and
//! `tmax`, the range of t that counts (0 and infinity without them, or where their field is empty; `-inf` and `inf` are a
//! whole line), and `line`, the number of the scan line, a whole number (without it the file is one scan line). A ray is
//! origin + t · direction; the direction is not normalised, and t is in units of it.
//!
//! ```
//! use patchray_host::scene::{error::OnInvalid, rays};
//! let text = "ox,oy,oz,dx,dy,dz,tmin,tmax\n0,0,5,0,0,-2,-inf,\n";
//! let batch = rays::parse("rays.csv", text, OnInvalid::Refuse)?;
//! assert_eq!(batch.rays[0].direction, [0.0, 0.0, -2.0]);
//! assert_eq!((batch.rays[0].t_min, batch.rays[0].t_max), (f64::NEG_INFINITY, f64::INFINITY));
//! # Ok::<(), patchray_host::scene::error::InputError>(())
//! ```
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use csv::StringRecord;

use super::error::{InputError, OnInvalid, Refusal, Skipped};
use super::source::Excerpt;
use columns::{Columns, LINE, NAMES, T_MAX, T_MIN, allowed, shown};

mod columns;

/// A ray as its file states it, in the file's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayLine {
    /// Where t is 0.
    pub origin: [f64; 3],
    /// The way of the ray for t from 0 to 1; not normalised.
    pub direction: [f64; 3],
    /// The smallest t that counts; may be negative, and minus infinity.
    pub t_min: f64,
    /// The largest t that counts; may be infinity.
    pub t_max: f64,
    /// The number of the scan line: coherence is carried between consecutive rays with the same one.
    pub scan_line: u64,
    /// Whether the ray can be traced. Otherwise its numbers are as the file has them, and only its place in the batch counts.
    pub valid: bool,
}

/// What was read from a ray file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RayBatch {
    /// The rays, an entry per line of the file in its order.
    pub rays: Vec<RayLine>,
    /// How many of them are not valid; 0 unless the reader was told to skip.
    pub invalid: usize,
    /// The first that is not valid. (The only one kept: a batch may hold millions.)
    pub first_invalid: Option<Skipped>,
}

/// Reads the ray file at `path`; `-` is standard input.
///
/// # Errors
/// The file cannot be read, is not in the format, or holds an invalid ray that is not to be skipped.
pub fn read(path: &Path, on_invalid: OnInvalid) -> Result<RayBatch, InputError> {
    Rays::open(path, on_invalid)?.0.batch()
}

/// An open ray file, read block by block, so that a batch of any length takes the memory of a block.
pub struct Rays(Reader<Box<dyn ReadSeek>>);

/// What a ray file is read from: an error shows its line again.
trait ReadSeek: Read + Seek {}

impl<R: Read + Seek> ReadSeek for R {}

/// A check of a ray beyond what the file's format asks for: why it cannot be traced, if it cannot.
pub type CheckRay<'a> = &'a dyn Fn(&RayLine) -> Option<String>;

impl Rays {
    /// Opens the ray file at `path` and reads its header; `-` is standard input. A pipe is read whole.
    ///
    /// # Errors
    /// The file cannot be read, or its header is not one.
    pub fn open(path: &Path, on_invalid: OnInvalid) -> Result<Self, InputError> {
        let unreadable = |reason| InputError::unreadable(path, reason);
        let whole = |input: &mut dyn Read| {
            let mut bytes = Vec::new();
            input.read_to_end(&mut bytes).map(|_| Cursor::new(bytes)).map_err(unreadable)
        };
        let input: Box<dyn ReadSeek> = if path == Path::new("-") {
            Box::new(whole(&mut io::stdin().lock())?)
        } else {
            let mut file = File::open(path).map_err(unreadable)?;
            if file.metadata().map_err(unreadable)?.is_file() {
                Box::new(file)
            } else {
                // A pipe gives a line only once, and an error shows it again.
                Box::new(whole(&mut file)?)
            }
        };
        Ok(Rays(Reader::new(&path.display().to_string(), input, on_invalid)?))
    }

    /// Replaces the rays of `batch` by the next ones, at most `most`, and adds to its count of those that are not valid;
    /// no rays means the end. A ray that `check` finds fault with is not valid either.
    ///
    /// # Errors
    /// The file cannot be read, is not in the format, or holds an invalid ray that is not to be skipped.
    pub fn next(&mut self, most: usize, check: CheckRay, batch: &mut RayBatch) -> Result<(), InputError> {
        batch.rays.clear();
        self.0.block(most, check, batch)
    }

    /// How far into the file reading has come, in bytes.
    pub fn position(&self) -> u64 {
        self.0.input.position().byte()
    }
}

/// Reads `text`, a whole ray file; `name` stands for its path in errors.
///
/// # Errors
/// As [`read`], the text being there.
pub fn parse(name: &str, text: &str, on_invalid: OnInvalid) -> Result<RayBatch, InputError> {
    Reader::new(name, Cursor::new(text), on_invalid)?.batch()
}

/// What an error points at.
#[derive(Clone, Copy)]
enum At {
    Field(usize),
    WholeLine,
}

/// What is wrong with a line.
struct Fault {
    at: At,
    message: String,
    help: String,
}

struct Reader<R> {
    name: String,
    input: csv::Reader<R>,
    on_invalid: OnInvalid,
    columns: Columns,
    /// The fields of the header.
    fields: usize,
    /// The number of the next ray.
    number: usize,
}

impl<R: Read + Seek> Reader<R> {
    fn new(name: &str, input: R, on_invalid: OnInvalid) -> Result<Self, InputError> {
        // The header is read like any line, and lines of any length are let through, so that all messages are ours.
        let input = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(input);
        let columns = Columns::default();
        let mut reader = Self { name: name.to_owned(), input, on_invalid, columns, fields: 0, number: 0 };
        let mut header = StringRecord::new();
        if !reader.next(&mut header)? {
            let fault = Fault {
                at: At::WholeLine,
                message: "the file is empty".to_owned(),
                help: format!("the first line names the columns: {}", allowed()),
            };
            return Err(reader.refusal(&header, fault).into());
        }
        reader.columns = match columns::of_header(&header) {
            Ok(columns) => columns,
            Err(fault) => return Err(reader.refusal(&header, fault).into()),
        };
        reader.fields = header.len();
        Ok(reader)
    }

    /// All rays.
    fn batch(mut self) -> Result<RayBatch, InputError> {
        let mut batch = RayBatch::default();
        self.block(usize::MAX, &|_| None, &mut batch)?;
        Ok(batch)
    }

    /// Appends the next rays, at most `most`.
    fn block(&mut self, most: usize, check: CheckRay, batch: &mut RayBatch) -> Result<(), InputError> {
        let mut record = StringRecord::new();
        // Ends with the file, or with the block.
        while batch.rays.len() < most && self.next(&mut record)? {
            let mut ray = match ray(&record, &self.columns, self.fields) {
                Ok(ray) => ray,
                Err(fault) => return Err(self.refusal(&record, fault).into()),
            };
            let fault = invalid(&record, &self.columns, &ray).or_else(|| {
                let help = "bring origin, direction and surfaces to like sizes, or use --precision f64";
                check(&ray).map(|message| Fault { at: At::WholeLine, message, help: help.to_owned() })
            });
            if let Some(fault) = fault {
                if self.on_invalid == OnInvalid::Refuse {
                    return Err(self.refusal(&record, fault).into());
                }
                if batch.first_invalid.is_none() {
                    let why = self.refusal(&record, fault);
                    batch.first_invalid = Some(Skipped::from_refusal("ray", self.number, &why));
                }
                ray.valid = false;
                batch.invalid += 1;
            }
            batch.rays.push(ray);
            self.number += 1;
        }
        Ok(())
    }

    /// Reads the next line that is not blank; whether there was one.
    fn next(&mut self, record: &mut StringRecord) -> Result<bool, InputError> {
        self.input.read_record(record).map_err(|error| self.broken(error))
    }

    /// The error for a line that is no CSV, or that could not be read.
    fn broken(&mut self, error: csv::Error) -> InputError {
        let position = error.position().cloned();
        match (error.into_kind(), position) {
            (csv::ErrorKind::Io(reason), _) => InputError::unreadable(Path::new(&self.name), reason),
            (_, Some(position)) => {
                let mut record = StringRecord::new();
                record.set_position(Some(position));
                let fault = Fault {
                    at: At::WholeLine,
                    message: "the line is not text in UTF-8".to_owned(),
                    help: "save the file as plain text in UTF-8 (ASCII will do)".to_owned(),
                };
                self.refusal(&record, fault).into()
            }
            (kind, None) => InputError::unreadable(Path::new(&self.name), io::Error::other(format!("{kind:?}"))),
        }
    }

    /// The refusal of the file because of the line of `record`. The line is read again from the file, since the record has
    /// lost spaces and quotes.
    fn refusal(&mut self, record: &StringRecord, fault: Fault) -> Box<Refusal> {
        let (start, line) = record.position().map_or((0, 1), |at| (at.byte() as usize, at.line() as usize));
        // A line that cannot be read again is shown empty; the message and the place still stand.
        let (blank, bytes) = self.reread(start as u64).unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        let text = text.trim_end_matches(['\n', '\r']);
        let span = match fault.at {
            At::WholeLine => 0..text.len(),
            At::Field(field) => field_span(text, field),
        };
        let span = start + span.start..start + span.end;
        let excerpt = Excerpt::of_line(text, line + blank, start, span.clone());
        Refusal::new(&self.name, excerpt, span, fault.message, "here".to_owned(), fault.help)
    }

    /// The first line that is not blank from byte `start` of the file, and how many lines were passed over to get there.
    /// Leaves the file where it was, since the reader goes on from there.
    fn reread(&mut self, start: u64) -> io::Result<(usize, Vec<u8>)> {
        let input = self.input.get_mut();
        let here = input.stream_position()?;
        input.seek(SeekFrom::Start(start))?;
        let mut lines = BufReader::new(input.by_ref().take(LONGEST));
        let (mut blank, mut line) = (0, Vec::new());
        // Ends with the bytes that may be taken.
        while lines.read_until(b'\n', &mut line)? > 0 && line.iter().all(|byte| b"\r\n".contains(byte)) {
            blank += 1;
            line.clear();
        }
        input.seek(SeekFrom::Start(here))?;
        Ok((blank, line))
    }
}

/// How many bytes of a line an error looks at. More finds a field further out on a line that is not of this format anyway.
const LONGEST: u64 = 1 << 16;

/// The bytes of field `index` of a line, without the spaces around it.
fn field_span(line: &str, index: usize) -> Range<usize> {
    let mut quoted = false;
    let mut start = 0;
    let mut field = 0;
    for (at, byte) in line.bytes().enumerate() {
        match byte {
            b'"' => quoted = !quoted,
            b',' if !quoted && field == index => return trimmed(line, start..at),
            b',' if !quoted => (field, start) = (field + 1, at + 1),
            _ => {}
        }
    }
    trimmed(line, start..line.len())
}

fn trimmed(line: &str, span: Range<usize>) -> Range<usize> {
    let text = &line[span.clone()];
    let start = span.start + (text.len() - text.trim_start().len());
    start..(start + text.trim().len())
}

/// The ray on a line; refuses what no number can be read from.
fn ray(record: &StringRecord, columns: &Columns, fields: usize) -> Result<RayLine, Fault> {
    if record.len() != fields {
        return Err(Fault {
            at: At::WholeLine,
            message: format!("the line has {} fields, the header {fields}", record.len()),
            help: "write a number for every column of the header, with commas between them".to_owned(),
        });
    }
    let number = |column: usize, default: Option<f64>| match (columns[column], default) {
        (None, default) => Ok(default.unwrap_or_default()),
        (Some(field), Some(default)) if record[field].trim().is_empty() => Ok(default),
        (Some(field), _) => record[field].trim().parse::<f64>().map_err(|_| Fault {
            at: At::Field(field),
            message: not_a("number", &record[field], column),
            help: "write a decimal number, such as `-1.5` or `2e-3`".to_owned(),
        }),
    };
    let scan_line = match columns[LINE] {
        None => 0,
        Some(field) => record[field].trim().parse().map_err(|_| Fault {
            at: At::Field(field),
            message: not_a("whole number", &record[field], LINE),
            help: "number the scan lines from 0, or leave the column out if the file is one scan line".to_owned(),
        })?,
    };
    Ok(RayLine {
        origin: [number(0, None)?, number(1, None)?, number(2, None)?],
        direction: [number(3, None)?, number(4, None)?, number(5, None)?],
        t_min: number(T_MIN, Some(0.0))?,
        t_max: number(T_MAX, Some(f64::INFINITY))?,
        scan_line,
        valid: true,
    })
}

fn not_a(what: &str, field: &str, column: usize) -> String {
    match field.trim() {
        "" => format!("the field of column `{}` is empty", NAMES[column]),
        text => format!("`{}` in column `{}` is not a {what}", shown(text), NAMES[column]),
    }
}

/// Why a ray cannot be traced, if it cannot.
fn invalid(record: &StringRecord, columns: &Columns, ray: &RayLine) -> Option<Fault> {
    let field = |column: usize| columns[column].map_or(At::WholeLine, At::Field);
    let fault = |at, message: String, help: &str| Some(Fault { at, message, help: help.to_owned() });
    let [ox, oy, oz] = ray.origin;
    let [dx, dy, dz] = ray.direction;
    for (column, value) in [ox, oy, oz, dx, dy, dz, ray.t_min, ray.t_max].into_iter().enumerate() {
        let name = NAMES[column];
        // Digits that come to infinity are a number out of range, not the word.
        let overflow = || columns[column].is_some_and(|at| record[at].contains(|c: char| c.is_ascii_digit()));
        if value.is_nan() {
            return fault(field(column), format!("`{name}` is not a number (NaN)"), "write a number");
        }
        if value.is_infinite() && overflow() {
            let help = "use smaller units: at most 1.7e308";
            return fault(field(column), format!("`{name}` is too large for a 64-bit floating point number"), help);
        }
        if value.is_infinite() && ![T_MIN, T_MAX].contains(&column) {
            let help = "write a finite number; only `tmin` may be `-inf`, and `tmax` `inf`";
            return fault(field(column), format!("`{name}` is infinite"), help);
        }
    }
    if ray.direction == [0.0; 3] {
        return fault(At::WholeLine, "the direction is zero".to_owned(), "give dx, dy or dz a value other than 0");
    }
    if ray.t_min > ray.t_max {
        let at = if columns[T_MAX].is_some() { field(T_MAX) } else { field(T_MIN) };
        let message = format!("`tmin` is {} and above `tmax`, which is {}", ray.t_min, ray.t_max);
        return fault(at, message, "write a range of t with `tmin` at most `tmax`");
    }
    // No t is infinite, so that such a range is empty although its ends are in order.
    for (column, value, none) in [(T_MIN, ray.t_min, f64::INFINITY), (T_MAX, ray.t_max, f64::NEG_INFINITY)] {
        if value == none {
            let message = format!("`{}` is {none}, which leaves no t", NAMES[column]);
            return fault(field(column), message, "write a range of t; `-inf` to `inf` is a whole line");
        }
    }
    None
}

#[cfg(test)]
mod tests;
