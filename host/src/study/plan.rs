//! Which cells a study has, and their names, which stay the same from run to run and from machine to machine.

use std::str::FromStr;

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

use crate::number::Shortest;
use crate::scene::trace::{Acceptance, Method, Precision};
use crate::settings::Settings;

/// What differs between a cell and the default of its method and precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Knob {
    /// Nothing.
    Default,
    /// [`Settings::tolerance`].
    Tolerance,
    /// [`Settings::flatness`].
    Flatness,
    /// [`Settings::clip_threshold`].
    ClipThreshold,
    /// [`Settings::newton_iterations`].
    NewtonIterations,
    /// [`Settings::newton_starts`].
    NewtonStarts,
    /// [`Settings::acceptance`] is [`Acceptance::Paper`].
    Paper,
    /// The limit `newton-steps`.
    NewtonSteps,
    /// The limit `clip-steps`.
    ClipSteps,
    /// [`Settings::grid_density`].
    GridDensity,
}

impl Knob {
    /// All, in the order of a study.
    pub const ALL: [Knob; 10] = [
        Knob::Default,
        Knob::Tolerance,
        Knob::Flatness,
        Knob::ClipThreshold,
        Knob::NewtonIterations,
        Knob::NewtonStarts,
        Knob::Paper,
        Knob::NewtonSteps,
        Knob::ClipSteps,
        Knob::GridDensity,
    ];

    /// Its name in the names of cells.
    pub fn name(self) -> &'static str {
        match self {
            Knob::Default => "default",
            Knob::Tolerance => "tolerance",
            Knob::Flatness => "flatness",
            Knob::ClipThreshold => "clip-threshold",
            Knob::NewtonIterations => "newton-iterations",
            Knob::NewtonStarts => "newton-starts",
            Knob::Paper => "paper",
            Knob::NewtonSteps => "newton-steps",
            Knob::ClipSteps => "clip-steps",
            Knob::GridDensity => "grid-density",
        }
    }

    /// The values that it takes in this precision; one that says nothing where it has no value.
    fn values(self, precision: Precision) -> &'static [f64] {
        match (self, precision) {
            (Knob::Default | Knob::Paper, _) => &[f64::NAN],
            (Knob::Tolerance, Precision::F64) => &[1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15],
            (Knob::Tolerance, Precision::F32) => &[1e-3, 1e-4, 1e-5, 1e-6, 4e-7, 1e-7],
            (Knob::Flatness, _) => &[3e-2, 1e-2, 5e-3, 2e-3, 1e-3, 3e-4],
            (Knob::ClipThreshold, _) => &[0.05, 0.1, 0.15, 0.25, 0.3, 0.4, 0.5, 0.6],
            (Knob::NewtonIterations, _) => &[2.0, 3.0, 4.0, 6.0, 8.0],
            (Knob::NewtonStarts, _) => &[1.0, 2.0],
            (Knob::NewtonSteps, _) => &[4.0, 8.0, 16.0],
            (Knob::ClipSteps, _) => &[10.0, 20.0, 40.0, 80.0],
            (Knob::GridDensity, _) => &[0.25, 0.75, 1.5, 6.0, 12.0],
        }
    }

    /// Whether it means something to the method.
    fn concerns(self, method: Method) -> bool {
        let clips = matches!(method, Method::Clipping | Method::ClippingCoherent | Method::ClippingPredicted);
        match self {
            Knob::Default | Knob::Tolerance | Knob::Flatness => true,
            Knob::ClipThreshold | Knob::ClipSteps => clips,
            Knob::NewtonIterations | Knob::NewtonStarts | Knob::NewtonSteps => !clips,
            Knob::Paper => method != Method::Clipping,
            Knob::GridDensity => method.is_coherent() && !method.needs_view(),
        }
    }
}

/// One setting of one method in one precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// What differs from the default.
    pub knob: Knob,
    /// Its value; `None` for a knob without.
    pub value: Option<f64>,
}

impl Cell {
    /// Its name: the method, the precision, the knob, and the knob's value if it has one, such as
    /// `clipping.f64.tolerance.1e-6`. It is also the name of its file, but for the ending.
    pub fn id(&self) -> String {
        let Cell { method, precision, knob, value } = self;
        let value = value.map_or(String::new(), |value| format!(".{}", Shortest(value)));
        format!("{}.{}.{}{value}", method.name(), precision.name(), knob.name())
    }

    /// How it is traced: `base` but for what the cell names.
    pub fn settings(&self, base: &Settings) -> Settings {
        let Cell { method, precision, .. } = *self;
        let mut settings = Settings { method, precision, ..*base };
        let value = self.value.unwrap_or(f64::NAN);
        // The counts among the values are small whole numbers.
        let count = value as u32;
        match self.knob {
            Knob::Default => {}
            Knob::Tolerance => settings.tolerance = Some(value),
            Knob::Flatness => settings.flatness = value,
            Knob::ClipThreshold => settings.clip_threshold = value,
            Knob::NewtonIterations => settings.newton_iterations = count,
            Knob::NewtonStarts => settings.newton_starts = count,
            Knob::Paper => settings.acceptance = Acceptance::Paper,
            Knob::NewtonSteps => settings.limits.newton_steps = count,
            Knob::ClipSteps => settings.limits.clip_steps = count,
            Knob::GridDensity => settings.grid_density = value,
        }
        settings
    }
}

/// All cells, or those of one method or one precision. Cells of one knob's value follow one another.
pub fn plan(method: Option<Method>, precision: Option<Precision>) -> Vec<Cell> {
    let mut cells = Vec::new();
    for knob in Knob::ALL {
        for &precision in Precision::value_variants().iter().filter(|&&own| precision.is_none_or(|only| only == own)) {
            for &value in knob.values(precision) {
                let methods = Method::value_variants().iter().filter(|&&own| method.is_none_or(|only| only == own));
                cells.extend(methods.filter(|&&method| knob.concerns(method)).map(|&method| Cell {
                    method,
                    precision,
                    knob,
                    value: (!value.is_nan()).then_some(value),
                }));
            }
        }
    }
    cells
}

/// A part of a study for one of several machines: every `count`-th cell, from the `index`-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to `count`.
    pub index: usize,
    /// How many parts there are.
    pub count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let part = text.split_once('/').and_then(|(index, count)| {
            let (index, count) = (index.trim().parse().ok()?, count.trim().parse().ok()?);
            (1..=count).contains(&index).then_some(Shard { index, count })
        });
        part.ok_or("write I/N, a part from 1 to N, such as 1/4".to_owned())
    }
}

impl Shard {
    /// Its cells.
    pub fn of<T>(self, cells: Vec<T>) -> Vec<T> {
        let own = |(place, cell)| (place % self.count == self.index - 1).then_some(cell);
        cells.into_iter().enumerate().filter_map(own).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_stay() {
        let cells = plan(None, None);
        let ids: BTreeSet<String> = cells.iter().map(Cell::id).collect();
        assert_eq!((ids.len(), cells.len()), (cells.len(), 336));
        for id in [
            "clipping.f64.default",
            "newton.f32.tolerance.4e-7",
            "newton-predicted.f64.flatness.0.03",
            "clipping-coherent.f32.clip-threshold.0.05",
            "clipping-predicted.f64.paper",
            "newton-coherent.f64.grid-density.0.25",
            "newton.f32.newton-steps.8",
        ] {
            assert!(ids.contains(id), "{id}");
        }
    }

    #[test]
    fn a_cell_moves_one_setting() {
        let base = Settings { threads: 1, ..Settings::default() };
        for cell in plan(None, None) {
            let own = Settings { method: cell.method, precision: cell.precision, ..base };
            let [own, moved] = [own, cell.settings(&base)].map(|all| {
                let value = serde_json::to_value(all).expect("plain");
                let mut fields: Vec<(String, String)> = Vec::new();
                for (name, value) in value.as_object().expect("an object") {
                    match value.as_object() {
                        Some(limits) => {
                            fields.extend(limits.iter().map(|(name, value)| (name.clone(), value.to_string())))
                        }
                        None => fields.push((name.clone(), value.to_string())),
                    }
                }
                fields
            });
            let moved = own.iter().zip(&moved).filter(|(own, moved)| own != moved).count();
            assert_eq!(moved, usize::from(cell.knob != Knob::Default), "{}", cell.id());
        }
    }

    #[test]
    fn filters_leave_out_and_change_no_name() {
        let all: BTreeSet<String> = plan(None, None).iter().map(Cell::id).collect();
        let some = plan(Some(Method::Clipping), Some(Precision::F32));
        assert!(some.len() > 20 && some.iter().all(|cell| all.contains(&cell.id())));
    }

    #[test]
    fn shards_part_the_list() {
        let cells = plan(None, None);
        let parts: Vec<Cell> = (1..=7).flat_map(|index| Shard { index, count: 7 }.of(cells.clone())).collect();
        let ids: BTreeSet<String> = parts.iter().map(Cell::id).collect();
        assert_eq!((parts.len(), ids.len()), (cells.len(), cells.len()));
        assert_eq!("2/3".parse(), Ok(Shard { index: 2, count: 3 }));
        for text in ["0/3", "4/3", "3", "a/b", "1/0", "-1/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
