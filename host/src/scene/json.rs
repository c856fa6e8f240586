//! JSON text of which every part knows its place in the file, so that a check of a number can point at it.
//!
//! The text is cut into parts by `serde_json`, which checks all of it at once; a part is understood only when it is asked
//! for, and its place is where its text lies in the file's.
use std::cell::Cell;
use std::fmt;
use std::ops::Range;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::error::Category;
use serde_json::value::RawValue;

use super::error::InputError;
use super::nearest::nearest;
use super::source::{Counted, SourceText};

/// A whole file.
pub(super) struct Document<'s> {
    source: &'s SourceText,
    /// The text as JSON: what is none but is often written is replaced, byte for byte; see [`masked`].
    text: String,
    /// Near what is being read, so that a refusal need not count lines from the start.
    counted: Cell<Counted>,
}

impl<'s> Document<'s> {
    /// A document over the text of a file.
    pub(super) fn new(source: &'s SourceText) -> Self {
        Self { source, text: masked(source.text()), counted: Cell::default() }
    }

    /// The outermost value.
    ///
    /// # Errors
    /// The text is not JSON.
    pub(super) fn root(&self) -> Result<Node<'_>, InputError> {
        // A mark of the byte order may precede the text; parts are found by their address, so that it does not matter.
        let text = self.text.trim_start_matches('\u{feff}');
        match serde_json::from_str::<&RawValue>(text) {
            Ok(raw) => Ok(Node { document: self, text: raw.get() }),
            Err(error) => Err(self.refuse_syntax(text, &error)),
        }
    }

    fn refuse_syntax(&self, text: &str, error: &serde_json::Error) -> InputError {
        let line = text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum::<usize>();
        let at = self.text.len() - text.len() + line + error.column().saturating_sub(1);
        let (message, label, help) = if text.trim_start().is_empty() {
            ("the file is empty", "nothing here", "write what `geomdl.exchange.export_json` writes")
        } else if error.classify() == Category::Eof {
            ("the file is cut off: it ends within a value", "the file ends here", "add what is missing")
        } else {
            ("the file is not JSON", "not expected here", "JSON has numbers, \"text\", [lists] and {\"name\": value}")
        };
        let message = if error.classify() == Category::Syntax {
            let told = error.to_string();
            format!("{message}: {}", told.split(" at line ").next().unwrap_or_default())
        } else {
            message.to_owned()
        };
        self.source.refuse(at..at + 1, message, label, help)
    }
}

/// The text with Python's `NaN`, `Infinity` and `-Infinity`, which JSON has not, as strings of the same length. So the rest
/// of the file can be read, and the refusal can say which number it is.
fn masked(text: &str) -> String {
    let mut masked = String::with_capacity(text.len());
    let (mut quoted, mut escaped) = (false, false);
    let mut rest = text;
    // Ends with the text, of which every round takes a character at least.
    while let Some(first) = rest.chars().next() {
        let mut taken = first.len_utf8();
        let word = if quoted { None } else { literal(rest) };
        if let Some((word, stand_in)) = word {
            masked.push_str(stand_in);
            taken = word.len();
        } else {
            masked.push(first);
            if quoted && escaped {
                escaped = false;
            } else if quoted && first == '\\' {
                escaped = true;
            } else if first == '"' {
                quoted = !quoted;
            }
        }
        rest = &rest[taken..];
    }
    masked
}

/// The literal with which a text begins, and what stands in for it.
fn literal(text: &str) -> Option<(&'static str, &'static str)> {
    const LITERALS: [(&str, &str); 3] = [("NaN", "\"N\""), ("Infinity", "\"Infini\""), ("-Infinity", "\"-Infini\"")];
    LITERALS.into_iter().find(|(word, _)| {
        text.strip_prefix(word).is_some_and(|rest| !rest.starts_with(|next: char| next.is_alphanumeric()))
    })
}

/// A value of a document.
#[derive(Clone, Copy)]
pub(super) struct Node<'d> {
    document: &'d Document<'d>,
    text: &'d str,
}

/// The names and values of an object, in the file's order.
pub(super) struct Object<'d> {
    node: Node<'d>,
    fields: Vec<(String, &'d RawValue)>,
    known: &'static [&'static str],
}

impl<'d> Node<'d> {
    fn inside(self, raw: &'d RawValue) -> Node<'d> {
        Node { document: self.document, text: raw.get() }
    }

    /// The bytes of the file that hold the value.
    fn bytes(self) -> Range<usize> {
        let start = self.text.as_ptr() as usize - self.document.text.as_ptr() as usize;
        start..start + self.text.len()
    }

    /// What to underline: the value, or of one over several lines how it begins.
    fn span(self) -> Range<usize> {
        let bytes = self.bytes();
        bytes.start..bytes.start + self.text.find('\n').unwrap_or(self.text.len())
    }

    /// The text as it is written.
    fn written(self) -> &'d str {
        &self.document.source.text()[self.bytes()]
    }

    /// What stands here, for a message.
    fn what(self) -> String {
        let written = self.written();
        match written.as_bytes().first() {
            Some(b'{') => "an object".to_owned(),
            Some(b'[') => "a list".to_owned(),
            _ => format!("`{}`", written.chars().take(40).collect::<String>()),
        }
    }

    /// Refuses the file because of this value.
    pub(super) fn refuse(
        self,
        message: impl Into<String>,
        label: impl Into<String>,
        help: impl Into<String>,
    ) -> InputError {
        self.document.source.refuse_near(self.document.counted.get(), self.span(), message, label, help)
    }

    /// Counts the lines up to here, for the refusals that follow.
    pub(super) fn count_lines(self) {
        let (before, start) = (self.document.counted.get(), self.bytes().start);
        if let Some(between) = self.document.text.as_bytes().get(before.offset..start) {
            let lines = before.lines + between.iter().filter(|&&byte| byte == b'\n').count();
            self.document.counted.set(Counted { offset: start, lines });
        }
    }

    /// The names and values of an object; `what` says what it is, and `known` which names it may have: others may be slips.
    pub(super) fn object(self, what: fmt::Arguments, known: &'static [&'static str]) -> Result<Object<'d>, InputError> {
        match serde_json::from_str::<Fields>(self.text) {
            Ok(Fields(fields)) => Ok(Object { node: self, fields, known }),
            Err(_) => Err(self.refuse(
                format!("{what} is {}", self.what()),
                "not an object",
                "write names and values in braces: `{\"name\": value}`",
            )),
        }
    }

    /// The values of a list.
    pub(super) fn list(self, what: fmt::Arguments) -> Result<Vec<Node<'d>>, InputError> {
        match serde_json::from_str::<Vec<&RawValue>>(self.text) {
            Ok(values) => Ok(values.into_iter().map(|raw| self.inside(raw)).collect()),
            Err(_) => Err(self.refuse(
                format!("{what} is {}", self.what()),
                "not a list",
                "write values in brackets, with commas between them",
            )),
        }
    }

    /// A text.
    pub(super) fn text(self, what: fmt::Arguments) -> Result<String, InputError> {
        serde_json::from_str(self.text).map_err(|_| {
            self.refuse(format!("{what} is {}", self.what()), "not a text", "write a text in quotation marks")
        })
    }

    /// A whole number.
    pub(super) fn whole(self, what: fmt::Arguments) -> Result<u64, InputError> {
        self.text.parse().map_err(|_| {
            self.refuse(
                format!("{what} is {}", self.what()),
                "not a whole number of at least 0",
                "write a whole number, such as `3`",
            )
        })
    }

    /// A finite number, the nearest that 64 bits hold.
    pub(super) fn number(self, what: fmt::Arguments) -> Result<f64, InputError> {
        let written = self.written();
        let (wrong, help) = match (written, self.text.parse::<f64>()) {
            (_, Ok(value)) if value.is_finite() => return Ok(value),
            (_, Ok(_)) => ("is too large for a 64-bit floating point number", "use smaller units: at most 1.7e308"),
            ("NaN", _) => ("is not a number (NaN)", "write a finite number"),
            ("Infinity" | "-Infinity", _) => ("is infinite", "write a finite number"),
            _ => {
                return Err(self.refuse(
                    format!("{what} is not a number: {}", self.what()),
                    "not a number",
                    "write a decimal number, such as `-1.5` or `2e-3`, without quotation marks",
                ));
            }
        };
        Err(self.refuse(format!("{what} {wrong}"), "not valid", help))
    }

    /// Whether it is `null`, which stands for nothing.
    pub(super) fn is_null(self) -> bool {
        self.text == "null"
    }
}

impl<'d> Object<'d> {
    /// The value of a name. Of a name that is repeated it is the last, as Python reads it.
    pub(super) fn find(&self, name: &str) -> Option<Node<'d>> {
        let field = self.fields.iter().rev().find(|(known, _)| known == name);
        field.map(|(_, raw)| self.node.inside(raw))
    }

    /// The value of a name that has to be there; `what` says what the object is.
    pub(super) fn get(&self, name: &str, what: fmt::Arguments) -> Result<Node<'d>, InputError> {
        self.find(name).ok_or_else(|| {
            let unknown = |name: &&str| !self.known.contains(name);
            let names: Vec<&str> = self.fields.iter().map(|(name, _)| name.as_str()).filter(unknown).collect();
            let alike = nearest(name, &names).map_or(String::new(), |alike| format!(" (is it `{alike}`?)"));
            self.node.refuse(format!("{what} has no `{name}`{alike}"), "in here", format!("add `\"{name}\": ...`"))
        })
    }
}

/// What an object holds, in order.
struct Fields<'d>(Vec<(String, &'d RawValue)>);

impl<'d> Deserialize<'d> for Fields<'d> {
    fn deserialize<D: Deserializer<'d>>(deserializer: D) -> Result<Self, D::Error> {
        struct Collect;
        impl<'d> Visitor<'d> for Collect {
            type Value = Fields<'d>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'d>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut fields = Vec::new();
                // Ends with the object.
                while let Some(field) = map.next_entry()? {
                    fields.push(field);
                }
                Ok(Fields(fields))
            }
        }
        deserializer.deserialize_map(Collect)
    }
}
