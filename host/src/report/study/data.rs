//! The figures of a study's page, as data for programs.

use clap::ValueEnum;
use serde::Serialize;

use super::{FAILED, Point, StudyReport, page, tables};
use crate::scene::trace::{Method, Precision};
use crate::stats::SCHEMA;
use crate::study::machine::Machine;
use crate::study::plan::Knob;
use crate::study::record::{Counts, Errors, Worst};

/// What `report --json` prints: all figures of the page, but for the maps, which the study's folder has.
#[derive(Clone, Debug, Serialize)]
pub struct Data<'r> {
    /// [`SCHEMA`].
    pub schema: u32,
    /// The scene, for people.
    pub scene: &'r str,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The model's surfaces.
    pub surfaces: u64,
    /// The model's diagonal.
    pub diagonal: f64,
    /// Which method and setting to take, in a sentence.
    pub answer: String,
    /// The share of lost rays above which a cell counts as failed.
    pub failed_above: f64,
    /// On what it was measured.
    pub machines: Vec<OnMachine<'r>>,
    /// The cells that were traced, in the study's order.
    pub cells: Vec<CellData<'r>>,
    /// What acceptance `proved` costs, for each method that another acceptance answers differently.
    pub acceptance: Vec<Price>,
    /// The worst answers of the cells with default settings.
    pub worst: Vec<WorstOf<'r>>,
    /// Cells that could not be traced at all.
    pub not_traced: Vec<Absent<'r>>,
    /// Cells that are not there; `reason` says why if one is there that cannot be read.
    pub missing: Vec<Absent<'r>>,
}

/// A machine, and how many cells it measured.
#[derive(Clone, Debug, Serialize)]
pub struct OnMachine<'r> {
    /// The machine, and the build that ran on it.
    #[serde(flatten)]
    pub machine: &'r Machine,
    /// Its cells.
    pub cells: usize,
}

/// What a cell came to.
#[derive(Clone, Debug, Serialize)]
pub struct CellData<'r> {
    /// Its name.
    pub id: &'r str,
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// What differs from the default.
    pub knob: Knob,
    /// The knob's value; `null` for a knob without.
    pub value: Option<f64>,
    /// Whether more rays are lost than [`Data::failed_above`].
    pub failed: bool,
    /// Nanoseconds per ray, at the pace that is common to all cells.
    pub ns_per_ray: f64,
    /// The spread of the bare times, from the first to the third quartile, as a share of their median.
    pub spread: f64,
    /// How often it was timed.
    pub repetitions: usize,
    /// Seconds from the model to the scene ready to trace.
    pub prepare_seconds: f64,
    /// What was counted.
    pub counts: &'r Counts,
    /// How far answers are off.
    pub errors: &'r Errors,
}

/// What it costs a method to be sure. Of pairs, the first is acceptance `paper`, the other `proved`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Price {
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// Nanoseconds per ray, at the pace that is common to all cells.
    pub ns_per_ray: [f64; 2],
    /// The second over the first.
    pub time_ratio: f64,
    /// Answers that are not right: off, on another sheet, missed, phantom, or given up.
    pub not_right: [u64; 2],
    /// The rays of each.
    pub rays: u64,
}

/// A bad answer, and the cell that gave it.
#[derive(Clone, Debug, Serialize)]
pub struct WorstOf<'r> {
    /// The cell's name.
    pub id: &'r str,
    /// The answer.
    #[serde(flatten)]
    pub worst: &'r Worst,
}

/// A cell of which there are no figures.
#[derive(Clone, Debug, Serialize)]
pub struct Absent<'r> {
    /// Its name.
    pub id: &'r str,
    /// Why.
    pub reason: Option<&'r str>,
}

/// The price of acceptance `proved`, for each method and precision that was measured under both with default settings.
pub(super) fn prices(points: &[Point]) -> Vec<Price> {
    let mut prices = Vec::new();
    for &precision in Precision::value_variants().iter().rev() {
        for &method in Method::value_variants() {
            let find = |knob: Knob, acceptance: &str| {
                points.iter().find(|point| {
                    let head = &point.record.head;
                    point.is(method, precision) && head.knob == knob && head.settings["acceptance"] == acceptance
                })
            };
            // A study that was asked for the paper's acceptance throughout has no price to tell.
            let Some((paper, proved)) = find(Knob::Paper, "paper").zip(find(Knob::Default, "proved")) else { continue };
            prices.push(Price {
                method,
                precision,
                ns_per_ray: [paper, proved].map(|point| point.ns),
                time_ratio: proved.ns / paper.ns,
                not_right: [paper, proved].map(|point| point.measured.counts.not_right()),
                rays: proved.measured.counts.rays,
            });
        }
    }
    prices
}

impl StudyReport {
    /// The figures of the page, for programs.
    pub fn data(&self) -> Data<'_> {
        let points = self.points();
        Data {
            schema: SCHEMA,
            scene: &self.manifest.scene,
            size: self.manifest.size,
            surfaces: self.manifest.surfaces,
            diagonal: self.manifest.diagonal,
            // The names in it are plain, so that nothing but the marks around them makes it HTML.
            answer: page::answer(&points).replace("<code>", "`").replace("</code>", "`"),
            failed_above: FAILED,
            machines: self.machines().into_iter().map(|(machine, cells)| OnMachine { machine, cells }).collect(),
            cells: points.iter().map(CellData::of).collect(),
            acceptance: prices(&points),
            worst: tables::worst_of(&points)
                .into_iter()
                .map(|(point, worst)| WorstOf { id: &point.record.head.id, worst })
                .collect(),
            not_traced: self.not_traced().map(|(id, reason)| Absent { id, reason: Some(reason) }).collect(),
            missing: self.missing.iter().map(|(id, reason)| Absent { id, reason: reason.as_deref() }).collect(),
        }
    }
}

impl<'r> CellData<'r> {
    fn of(point: &Point<'r>) -> Self {
        let Point { record, measured, ns } = *point;
        let head = &record.head;
        CellData {
            id: &head.id,
            method: head.method,
            precision: head.precision,
            knob: head.knob,
            value: head.value,
            failed: point.failed(),
            ns_per_ray: ns,
            spread: measured.time.spread,
            repetitions: measured.time.repetitions.len(),
            prepare_seconds: measured.time.prepare,
            counts: &measured.counts,
            errors: &measured.errors,
        }
    }
}
