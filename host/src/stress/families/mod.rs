//! All families, one file for each way of being hard.

mod borders;
mod degenerate;
mod grazing;
mod layers;
mod placed;
mod stretched;

use super::case::Family;

/// All families, in the order of the table.
pub fn all() -> Vec<Family> {
    [
        &grazing::FAMILIES[..],
        &degenerate::FAMILIES,
        &stretched::FAMILIES,
        &placed::FAMILIES,
        &borders::FAMILIES,
        &layers::FAMILIES,
    ]
    .concat()
}
