//! The writer of patch files.
use std::fmt::Write as _;

use super::super::model::Model;
use crate::number::Shortest;

/// The text of a patch file that reads back to the same bits, with surfaces numbered anew in their order.
pub fn write(model: &Model) -> String {
    let mut text = format!("{}\n", model.surfaces.len());
    for surface in &model.surfaces {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{} {}", surface.degree_u, surface.degree_v);
        for &[x, y, z, w] in &surface.points {
            let _ = write!(text, "{} {} {}", Shortest(x), Shortest(y), Shortest(z));
            let _ = if surface.rational { writeln!(text, " {}", Shortest(w)) } else { writeln!(text) };
        }
    }
    text
}
