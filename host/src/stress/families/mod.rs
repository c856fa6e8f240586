//! All families, one file for each way of being hard.

mod borders;
mod contact;
mod degenerate;
mod grazing;
mod jumps;
mod layers;
mod placed;
mod sections;
mod sizes;
mod stalled;
mod stretched;
mod thin;
mod weighted;

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
        &weighted::FAMILIES,
        &sizes::FAMILIES,
        &thin::FAMILIES,
        &stalled::FAMILIES,
        &sections::FAMILIES,
        &jumps::FAMILIES,
        &contact::FAMILIES,
    ]
    .concat()
}
