//! The columns of a ray file, by name.
use csv::StringRecord;

use super::super::nearest::did_you_mean;
use super::{At, Fault};

/// The columns of a ray file, in the order of [`Columns`].
pub(super) const NAMES: [&str; 9] = ["ox", "oy", "oz", "dx", "dy", "dz", "tmin", "tmax", "line"];
/// How many of them, from the first, every file has.
pub(super) const REQUIRED: usize = 6;
pub(super) const T_MIN: usize = 6;
pub(super) const T_MAX: usize = 7;
pub(super) const LINE: usize = 8;

/// For each column by name, which field of a line holds it.
pub(super) type Columns = [Option<usize>; NAMES.len()];

/// The list of columns for messages.
pub(super) fn allowed() -> String {
    format!("{}, and optionally {}", NAMES[..REQUIRED].join(","), NAMES[REQUIRED..].join(", "))
}

/// The columns that a header names.
pub(super) fn of_header(header: &StringRecord) -> Result<Columns, Fault> {
    let fault = |at, message| Err(Fault { at, message, help: format!("the columns are {}, in any order", allowed()) });
    let mut columns = Columns::default();
    for (field, name) in header.iter().map(str::trim).enumerate() {
        if field == 0 && name.parse::<f64>().is_ok() {
            return fault(
                At::WholeLine,
                "the first line holds numbers where the names of the columns should be".to_owned(),
            );
        }
        match NAMES.iter().position(|&known| known == name) {
            Some(column) if columns[column].is_some() => {
                return fault(At::Field(field), format!("the column `{name}` stands twice"));
            }
            Some(column) => columns[column] = Some(field),
            None => {
                let suggestion = did_you_mean(name, &NAMES).unwrap_or_default();
                return fault(At::Field(field), format!("there is no column `{}`{suggestion}", shown(name)));
            }
        }
    }
    match (0..REQUIRED).find(|&column| columns[column].is_none()) {
        Some(column) => fault(At::WholeLine, format!("the column `{}` is missing", NAMES[column])),
        None => Ok(columns),
    }
}

/// A text of the file, short enough for a message.
pub(super) fn shown(text: &str) -> String {
    text.chars().take(40).collect()
}
