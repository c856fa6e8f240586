//! The refusal of what is no TOML, or TOML of other kinds of values than a scene has, in the words of scene files.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::super::error::InputError;
use super::super::nearest::did_you_mean;
use super::super::source::SourceText;

/// The refusal for what the TOML reader did not accept.
pub(super) fn refusal(source: &SourceText, error: &toml::de::Error) -> InputError {
    let span = error.span().unwrap_or(0..0);
    let message = error.message().trim().replace('\n', ": ");
    // An unknown name is told with the names that would do: "unknown field `x`, expected one of `a`, `b`".
    let (message, label, help) = match &quoted(&message)[..] {
        [unknown, known @ ..] if message.starts_with("unknown ") && !known.is_empty() => (
            format!("there is no `{unknown}` here{}", did_you_mean(unknown, known).unwrap_or_default()),
            "unknown",
            format!("write one of {}", known.join(", ")),
        ),
        _ if message.starts_with("missing field") => (message.clone(), "in here", "add the field".to_owned()),
        _ if message.starts_with("invalid") => {
            let (message, help) = wrong_value(source, &span, &message);
            (message, "not as expected", help)
        }
        _ if message.ends_with("number overflowed") => (message, "too large", "write a smaller number".to_owned()),
        _ => (message.clone(), "here", "the file is TOML: `name = value` and `[table]`; strings in quotes".to_owned()),
    };
    source.refuse(span, message, label, help)
}

/// The names in backticks.
fn quoted(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

/// A reader's refusal of a value, such as "invalid type: string "big", expected f64", without names of this program's types;
/// and what to write instead.
fn wrong_value(source: &SourceText, span: &Range<usize>, message: &str) -> (String, String) {
    let Some((found, expected)) = message.rsplit_once(", expected ") else {
        return (message.to_owned(), "correct this value".to_owned());
    };
    let found = match found {
        "invalid type: sequence" => "invalid type: list",
        "invalid type: map" => "invalid type: table",
        _ => found,
    };
    let correct = "correct this value".to_owned();
    let (expected, help) = match expected {
        "u64" => ("a whole number, 0 or more", correct),
        "i128" => ("a whole number", correct),
        "f64" => ("a number", correct),
        "a sequence" => ("a list in brackets", form(source, span, true).unwrap_or(correct)),
        "a map" => ("a table for each name", form(source, span, false).unwrap_or(correct)),
        _ if expected.starts_with("a table of ") => {
            let fields = || format!("write a table `{{ name = value }}` of {}", quoted(expected).join(", "));
            ("a table, such as `{ name = value }`", form(source, span, false).unwrap_or_else(fields))
        }
        _ if expected.starts_with("one of ") => {
            let names: Vec<_> = quoted(expected).iter().map(|name| format!("\"{name}\"")).collect();
            (expected, format!("write one of {}", names.join(", ")))
        }
        _ => (expected, correct),
    };
    (format!("{found}, expected {expected}"), help)
}

/// How the table or the list of tables at `span` is to be written, if it has a name of which more can be said than its kind.
fn form(source: &SourceText, span: &Range<usize>, list: bool) -> Option<String> {
    let document = DeValue::Table(DeTable::parse(source.text()).ok()?.into_inner());
    let names = names_to(&document, span)?;
    let known = match names.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["light"] => "write `[light]` for one light, `[[lights]]` for each of several",
        ["lights"] => "write `[[lights]]` for each light, or `[light]` for one alone",
        ["material"] => "write `[material]` for what names none, `[materials.NAME]` for one with a name",
        ["materials"] | ["materials", _] => {
            "write `[materials.NAME]` for one with a name, `[material]` for what names none"
        }
        ["groups"] | ["groups", _] => "write `[groups.NAME]` for each group",
        _ => "",
    };
    if !known.is_empty() {
        return Some(known.to_owned());
    }
    // Only what has a line of its own is pointed at with its brackets and name.
    let header = source.text().get(span.clone())?.trim_matches(['[', ']']).trim();
    let written = names.last().is_some_and(|name| header.ends_with(name.as_str()));
    written.then(|| if list { format!("write `[[{header}]]`") } else { format!("write `[{header}]`") })
}

/// The names that lead to the part of `value` at `span`; parts of lists have none.
fn names_to(value: &DeValue<'_>, span: &Range<usize>) -> Option<Vec<String>> {
    let inside = |part: &toml::Spanned<DeValue<'_>>| {
        if part.span() == *span { Some(Vec::new()) } else { names_to(part.get_ref(), span) }
    };
    match value {
        DeValue::Table(table) => table.iter().find_map(|(name, part)| {
            let mut names = inside(part)?;
            names.insert(0, name.get_ref().to_string());
            Some(names)
        }),
        DeValue::Array(list) => list.iter().find_map(inside),
        _ => None,
    }
}
