//! What a study measured, as one page of HTML with its diagrams in it, and as SVG files.

mod charts;
pub mod data;
mod maps;
mod page;
mod tables;

use std::collections::BTreeMap;

use self::maps::Shown;
use crate::scene::trace::{Method, Precision};
use crate::study::folder::Manifest;
use crate::study::machine::Machine;
use crate::study::plan::Knob;
use crate::study::record::{Measured, Record};

/// All that a report is made of.
#[derive(Clone, Debug)]
pub struct StudyReport {
    /// What the study is of.
    pub manifest: Manifest,
    /// The finished cells, in the study's order.
    pub records: Vec<Record>,
    /// The names of those that are missing, with why if one is there that cannot be read.
    pub missing: Vec<(String, Option<String>)>,
}

/// A diagram with the name of its file, without the ending.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawing {
    /// The name.
    pub name: String,
    /// What it shows, for a caption.
    pub caption: String,
    /// The SVG document.
    pub svg: String,
}

/// A page, and the diagrams in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rendered {
    /// The page.
    pub html: String,
    /// The diagrams.
    pub drawings: Vec<Drawing>,
}

/// The share of rays from which on a cell counts as failed: those whose answer is lost.
const FAILED: f64 = 1e-3;

/// A cell that was measured, with its time where all machines and all disturbances are alike.
#[derive(Clone, Copy)]
struct Point<'r> {
    record: &'r Record,
    measured: &'r Measured,
    /// Nanoseconds per ray, at the pace that is common to all cells.
    ns: f64,
}

impl Point<'_> {
    /// Whether too many of its answers are lost for its error to mean anything.
    fn failed(&self) -> bool {
        self.measured.counts.lost_share() > FAILED
    }

    fn is(&self, method: Method, precision: Precision) -> bool {
        (self.record.head.method, self.record.head.precision) == (method, precision)
    }

    /// What it is, in a line.
    fn tip(&self) -> String {
        let counts = &self.measured.counts;
        format!(
            "{}: {:.0} ns per ray, 99.9 % of errors below {:.1e}, {} of {} rays lost",
            self.record.head.id,
            self.ns,
            self.measured.errors.t.most,
            counts.lost(),
            counts.rays
        )
    }

    /// The value of a knob in it, whether it is the cell's own or a default.
    fn value_of(&self, knob: Knob) -> Option<f64> {
        let head = &self.record.head;
        let setting = |name: &str| head.settings.get(name).and_then(serde_json::Value::as_f64);
        let limit = |name: &str| head.settings.get("limits")?.get(name)?.as_f64();
        match knob {
            Knob::Default | Knob::Paper => None,
            Knob::Tolerance => setting("tolerance").or(Some(match head.precision {
                Precision::F32 => f64::from(<f32 as patchray::scalar::Scalar>::TOLERANCE),
                Precision::F64 => <f64 as patchray::scalar::Scalar>::TOLERANCE,
            })),
            Knob::Flatness => setting("flatness"),
            Knob::ClipThreshold => setting("clip_threshold"),
            Knob::NewtonIterations => setting("newton_iterations"),
            Knob::NewtonStarts => setting("newton_starts"),
            Knob::NewtonSteps => limit("newton-steps"),
            Knob::ClipSteps => limit("clip-steps"),
            Knob::GridDensity => setting("grid_density"),
        }
    }
}

impl StudyReport {
    /// The page and its diagrams; the diagrams' files are to lie beside the page, under their names with `stem` before.
    pub fn render(&self, stem: &str) -> Rendered {
        let points = self.points();
        let drawings = charts::all(&points);
        let heat = [Shown::Error, Shown::Work].map(|shown| (maps::legend(shown), maps::all(&points, shown)));
        let html = page::html(self, &points, &drawings, &heat, stem);
        let heat = heat.into_iter().filter(|(_, maps)| !maps.is_empty());
        let heat = heat.flat_map(|(legend, maps)| [legend].into_iter().chain(maps));
        let drawings = drawings.into_iter().flat_map(|(_, drawings)| drawings).chain(heat).collect();
        Rendered { html, drawings }
    }

    /// The machines that measured it, and how many cells each.
    fn machines(&self) -> BTreeMap<&Machine, usize> {
        let mut all = BTreeMap::new();
        for record in &self.records {
            *all.entry(&record.machine).or_default() += 1;
        }
        all
    }

    /// The names of the cells that could not be traced, with why.
    fn not_traced(&self) -> impl Iterator<Item = (&str, &str)> {
        self.records.iter().filter_map(|record| Some((record.head.id.as_str(), record.result.as_ref().err()?.as_str())))
    }

    /// The cells that were measured. Their times are brought to one pace, so that those of a busy minute, or of another
    /// machine, do not count as slow.
    fn points(&self) -> Vec<Point<'_>> {
        let measured = || self.records.iter().filter_map(|record| Some((record, record.result.as_ref().ok()?)));
        let paces: Vec<f64> = measured()
            .flat_map(|(_, measured)| {
                measured.time.pace.iter().map(|seconds| seconds / measured.counts.rays.max(1) as f64)
            })
            .collect();
        let pace = super::times::quantile(&paces, 0.5) * 1e9;
        measured().map(|(record, measured)| Point { record, measured, ns: measured.time.paced * pace }).collect()
    }
}

#[cfg(test)]
mod tests;
