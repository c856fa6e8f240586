//! What was measured of a cell, as a file of JSON lines.
//!
//! Each line is an object with a field `line` that says what it holds; see [`Line`]. A file begins with `cell` and ends with
//! `end`, so that one that was cut off is told from a whole one.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::errors::{Kind, Spread};
use super::machine::Machine;
use super::plan::Knob;
use crate::scene::trace::{Method, Precision};

/// What names a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// Its name.
    pub id: String,
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// What differs from the default.
    pub knob: Knob,
    /// The knob's value; `null` for a knob without.
    pub value: Option<f64>,
    /// All settings.
    pub settings: serde_json::Value,
}

/// How long it took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Seconds of each repetition, of intersecting alone, on one thread.
    pub repetitions: Vec<f64>,
    /// Seconds that the pace, `clipping` in f64 with default settings, took just before each.
    pub pace: Vec<f64>,
    /// The median of the repetitions, in seconds.
    pub median: f64,
    /// From the first to the third quartile, as a share of the median.
    pub spread: f64,
    /// The median of each repetition over its pace, which does not depend on what else the machine did meanwhile.
    pub paced: f64,
    /// Seconds from the model to the scene ready to trace.
    pub prepare: f64,
}

/// What was counted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Rays.
    pub rays: u64,
    /// Rays that hit.
    pub hit_rays: u64,
    /// Rays that hit by the oracle.
    pub oracle_hits: u64,
    /// Patches.
    pub patches: u64,
    /// Bytes lent for the scene and the view of it.
    pub bytes: u64,
    /// Bytes for each thread beside that.
    pub bytes_per_thread: u64,
    /// Answers that are right; those of rays that hit nothing among them.
    pub right: u64,
    /// The closest hit, but t is off by more than the allowance.
    pub off: u64,
    /// A hit on another sheet than the closest. These and those that are off are what tables call wrong.
    pub other_sheet: u64,
    /// No hit where there is one.
    pub missed: u64,
    /// A hit where there is none.
    pub phantom: u64,
    /// Answers unlike the oracle's where that is open.
    pub undecided: u64,
    /// Roots found more than once.
    pub doubled: u64,
    /// Rays given up, by limit.
    pub gave_up: BTreeMap<String, u64>,
    /// The kernel's counters.
    pub work: BTreeMap<String, u64>,
}

impl Counts {
    /// Rays given up.
    pub fn gave_up_in_all(&self) -> u64 {
        self.gave_up.values().sum()
    }

    /// Rays whose answer is lost: on another sheet, missed, phantom or given up.
    pub fn lost(&self) -> u64 {
        self.other_sheet + self.missed + self.phantom + self.gave_up_in_all()
    }

    /// Rays whose answer is not right: those, and the ones that are off. What is undecided is not among them.
    pub fn not_right(&self) -> u64 {
        self.off + self.lost()
    }

    /// Lost rays as a share of all rays.
    pub fn lost_share(&self) -> f64 {
        self.lost() as f64 / self.rays.max(1) as f64
    }
}

/// How far answers are off.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Of t, over hits on the closest sheet.
    pub t: Spread,
    /// The residual |S(u, v) − (o + t d)|, over all hits.
    pub residual: Spread,
}

/// A bad answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// Its pixel, [0, 0] being the top left one.
    pub pixel: [u32; 2],
    /// What is bad about it.
    pub kind: Kind,
    /// The t that was found; `null` without a hit.
    pub t: Option<f64>,
    /// The closest root; `null` where there is none.
    pub closest: Option<f64>,
    /// How far t is off, as a share of the diagonal.
    pub error: Option<f64>,
    /// How far the ray may move before the oracle's answer changes, as a share of the diagonal: near 0 where it grazes.
    pub margin: f64,
    /// The limit that ran out, where one did.
    pub limit: Option<String>,
    /// The command that traces the ray again.
    pub command: String,
}

/// What became of each pixel, and what it took: a character each, row by row from the top left.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Width and height.
    pub size: [u32; 2],
    /// What became of them; see [`pixel`](super::run::pixel).
    pub pixels: String,
    /// The steps that they took; see [`effort`](super::run::effort). Empty in a record that does not say.
    #[serde(default)]
    pub steps: String,
}

/// A line of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "line", rename_all = "kebab-case")]
pub enum Line {
    /// What was measured.
    Cell(Head),
    /// On what.
    Machine(Machine),
    /// How long it took.
    Time(Time),
    /// What was counted.
    Counts(Counts),
    /// How far answers are off.
    Errors(Errors),
    /// A bad answer; up to ten lines, the worst first.
    Worst(Worst),
    /// What became of each pixel.
    Map(Map),
    /// The cell could not be traced at all.
    Failed {
        /// Why.
        reason: String,
    },
    /// The last line.
    End,
}

/// What was measured of a cell that could be traced.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// How long it took.
    pub time: Time,
    /// What was counted.
    pub counts: Counts,
    /// How far answers are off.
    pub errors: Errors,
    /// The worst answers, up to ten.
    pub worst: Vec<Worst>,
    /// What became of each pixel.
    pub map: Map,
}

/// All of a cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// What names it.
    pub head: Head,
    /// On what it was measured.
    pub machine: Machine,
    /// What was measured, or why nothing could be.
    pub result: Result<Measured, String>,
}

impl Record {
    /// The record as the text of its file.
    pub fn to_text(&self) -> String {
        let mut lines = vec![Line::Cell(self.head.clone()), Line::Machine(self.machine.clone())];
        match &self.result {
            Ok(Measured { time, counts, errors, worst, map }) => {
                lines.extend([Line::Time(time.clone()), Line::Counts(counts.clone()), Line::Errors(errors.clone())]);
                lines.extend(worst.iter().cloned().map(Line::Worst));
                lines.push(Line::Map(map.clone()));
            }
            Err(reason) => lines.push(Line::Failed { reason: reason.clone() }),
        }
        lines.push(Line::End);
        // Only maps with keys that are no text can fail, and there are none.
        lines.iter().map(|line| serde_json::to_string(line).unwrap_or_default() + "\n").collect()
    }

    /// The record that a file holds.
    ///
    /// # Errors
    /// What is wrong with the text, with its line.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (mut head, mut machine, mut failed, mut ended) = (None, None, None, false);
        let (mut time, mut counts, mut errors, mut worst, mut map) = (None, None, None, Vec::new(), None);
        for (number, line) in text.lines().enumerate() {
            let line = serde_json::from_str(line).map_err(|error| format!("line {}: {error}", number + 1))?;
            match line {
                Line::Cell(line) => head = Some(line),
                Line::Machine(line) => machine = Some(line),
                Line::Time(line) => time = Some(line),
                Line::Counts(line) => counts = Some(line),
                Line::Errors(line) => errors = Some(line),
                Line::Worst(line) => worst.push(line),
                Line::Map(line) => map = Some(line),
                Line::Failed { reason } => failed = Some(reason),
                Line::End => ended = true,
            }
        }
        let lacks = |what: &str| format!("the line `{what}` is missing");
        if !ended {
            return Err(lacks("end"));
        }
        let result = match failed {
            Some(reason) => Err(reason),
            None => Ok(Measured {
                time: time.ok_or_else(|| lacks("time"))?,
                counts: counts.ok_or_else(|| lacks("counts"))?,
                errors: errors.ok_or_else(|| lacks("errors"))?,
                worst,
                map: map.ok_or_else(|| lacks("map"))?,
            }),
        };
        let (head, machine) = (head.ok_or_else(|| lacks("cell"))?, machine.ok_or_else(|| lacks("machine"))?);
        Ok(Record { head, machine, result })
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::settings::Settings;
    use crate::study::plan::Cell;

    /// A record of `cell` with these seconds, this error and so many lost rays of a thousand.
    pub(crate) fn record(cell: &Cell, seconds: f64, error: f64, lost: u64) -> Record {
        let settings = cell.settings(&Settings::default());
        let spread = Spread::of(&[error; 10]);
        let measured = Measured {
            time: Time {
                repetitions: vec![seconds; 3],
                pace: vec![1.0; 3],
                median: seconds,
                spread: 0.0,
                paced: seconds,
                prepare: 0.1,
            },
            counts: Counts { rays: 1000, hit_rays: 500, right: 1000 - lost, missed: lost, ..Counts::default() },
            errors: Errors { t: spread.clone(), residual: spread },
            worst: vec![Worst {
                pixel: [1, 2],
                kind: Kind::Off,
                t: Some(1.0),
                closest: Some(1.0 + error),
                error: Some(error),
                margin: 0.5,
                limit: None,
                command: format!("patchray study --only {} --pixel 1,2", cell.id()),
            }],
            map: Map { size: [2, 1], pixels: ".a".to_owned(), steps: ".c".to_owned() },
        };
        Record {
            head: Head {
                id: cell.id(),
                method: cell.method,
                precision: cell.precision,
                knob: cell.knob,
                value: cell.value,
                settings: serde_json::to_value(settings).expect("plain"),
            },
            machine: Machine::this(),
            result: Ok(measured),
        }
    }

    #[test]
    fn a_record_reads_back_and_half_of_it_does_not() {
        let cell = crate::study::plan::plan(None, None)[30];
        let whole = record(&cell, 0.25, 1e-15, 3);
        assert_eq!(Record::parse(&whole.to_text()).expect("valid"), whole);
        let failed = Record { result: Err("no room".to_owned()), ..whole.clone() };
        assert_eq!(Record::parse(&failed.to_text()).expect("valid"), failed);
        let text = whole.to_text();
        for cut in [text.len() / 2, text.len() - "{\"line\":\"end\"}\n".len()] {
            assert!(Record::parse(&text[..cut]).is_err());
        }
        assert!(Record::parse("").is_err());
    }
}
