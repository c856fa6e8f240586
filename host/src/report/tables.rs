//! The paper's experiment as tables: what was measured, with the paper's figures beside it, for people and for programs.

use serde::Serialize;

use super::table::{Style, Table, grouped, percent, seconds};
use crate::experiment::Run;
use crate::experiment::cost::Model;
use crate::experiment::subject::Family;
use crate::judge::{Agreement, OracleStats};
use crate::scene::paper::{Figures, Improvement};
use crate::scene::trace::{Acceptance, Precision};

mod ablation;
mod document;
mod letter;

/// All that was measured. Serialised, it is what `--json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// [`SCHEMA`](crate::stats::SCHEMA).
    pub schema: u32,
    /// The kernel's version.
    pub version: &'static str,
    /// Width and height of the pictures of Tables 1 and 2.
    pub size: [u32; 2],
    /// Those of all other pictures.
    pub small: [u32; 2],
    /// The precision of the methods.
    pub precision: Precision,
    /// Their acceptance.
    pub acceptance: Acceptance,
    /// How often each method traced each scene for Tables 1 and 2.
    pub repetitions: u32,
    /// The same of all else.
    pub fewer: u32,
    /// How many scenes were measured at a time, each on a thread of its own, which the oracle had for it.
    pub threads: u32,
    /// Seconds that all took.
    pub seconds: f64,
    /// The scenes.
    pub scenes: Vec<SceneReport>,
}

/// What was measured on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct SceneReport {
    /// Its file's name without the ending.
    pub name: &'static str,
    /// What the paper says of it.
    pub paper: Figures,
    /// Its surfaces.
    pub surfaces: u64,
    /// Its patches.
    pub patches: u64,
    /// Seconds that preparing it took.
    pub preparation: Preparation,
    /// What the oracle found; `None` if it was not asked.
    pub oracle: Option<OracleStats>,
    /// The numerical methods.
    pub numerical: FamilyReport,
    /// The clipping methods.
    pub clipping: FamilyReport,
}

/// Seconds that preparing a scene took, of one run.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Preparation {
    /// The uniform grid over surfaces: all that the original clipping needs.
    pub surfaces: f64,
    /// That, patches and binary trees.
    pub trees: f64,
    /// That, patches and regular grids.
    pub grids: f64,
}

/// What was measured of one family of methods on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct FamilyReport {
    /// To the letter: the original, the improved, and the improved with nothing kept.
    pub letter: Vec<Run>,
    /// The original and the improved by other cameras.
    pub cameras: Vec<CameraReport>,
    /// The original and the improved by four rays per pixel.
    pub samplings: Vec<SamplingReport>,
    /// The original and the improved on rays that are not coherent.
    pub incoherent: Vec<IncoherentReport>,
    /// A part at a time, from the original to ours.
    pub ladder: Vec<Run>,
    /// One change at a time.
    pub changes: Vec<ChangeReport>,
    /// The cost model of the ladder's first step and the improved method to the letter.
    pub cost: Model,
}

/// The original and the improved method by one camera.
#[derive(Clone, Debug, Serialize)]
pub struct CameraReport {
    /// The camera.
    pub name: &'static str,
    /// The runs.
    pub runs: Vec<Run>,
}

/// A method with four rays per pixel.
#[derive(Clone, Debug, Serialize)]
pub struct SamplingReport {
    /// With uniform samples.
    pub uniform: Run,
    /// With jittered samples.
    pub jittered: Run,
}

/// The original and the improved method on other rays.
#[derive(Clone, Debug, Serialize)]
pub struct IncoherentReport {
    /// Which rays.
    pub rays: &'static str,
    /// The runs.
    pub runs: Vec<Run>,
}

/// The original and the improved method with one thing changed, beside what they are without the change.
#[derive(Clone, Debug, Serialize)]
pub struct ChangeReport {
    /// What was changed.
    pub name: &'static str,
    /// To the letter.
    pub before: Vec<Run>,
    /// With the change.
    pub after: Vec<Run>,
}

impl SceneReport {
    fn family(&self, family: Family) -> &FamilyReport {
        match family {
            Family::Numerical => &self.numerical,
            Family::Clipping => &self.clipping,
        }
    }

    fn improvement(&self, family: Family) -> &Improvement {
        match family {
            Family::Numerical => &self.paper.numerical,
            Family::Clipping => &self.paper.clipping,
        }
    }
}

/// By what share the second of two runs takes less time than the first; NaN of fewer.
fn gain(runs: &[Run]) -> f64 {
    match runs {
        [original, improved, ..] => improved.gain_over(original),
        _ => f64::NAN,
    }
}

impl FamilyReport {
    /// The gains by all cameras, the fitted one first.
    fn gains(&self) -> Vec<f64> {
        let others = self.cameras.iter().map(|camera| gain(&camera.runs));
        [gain(&self.letter)].into_iter().chain(others).collect()
    }
}

const SCENE: (&str, bool) = ("Scene", false);

/// The least and the largest of some shares, in percent.
fn extent(shares: &[f64]) -> String {
    let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = shares.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if least <= largest { format!("{} to {}", percent(least), percent(largest)) } else { String::new() }
}

fn intersection_points(run: &Run) -> u64 {
    run.counts.of("intersection_points")
}

/// Pixels that are not as the oracle has them, by kinds.
fn wrong_missed_phantom(run: &Run) -> [String; 3] {
    let count = |part: fn(&Agreement) -> u64| run.agreement.as_ref().map_or(String::new(), |all| grouped(part(all)));
    [count(|all| all.wrong), count(|all| all.missed), count(|all| all.phantom)]
}

impl Report {
    /// The report as tables and notes; in Markdown as a document that can be read by itself.
    pub fn to_text(&self, style: Style) -> String {
        match style {
            Style::Text => {
                let tables = self.tables().into_iter().map(|table| table.to_text(style) + "\n");
                tables.collect::<String>() + &self.notes().join("\n") + "\n"
            }
            Style::Markdown => self.document(),
        }
    }

    fn tables(&self) -> Vec<Table> {
        let [numerical, clipping] = Family::ALL;
        vec![
            self.improvements(1, numerical),
            self.improvements(2, clipping),
            self.samplings(),
            self.incoherent(),
            self.ladders(5, numerical),
            self.ladders(6, clipping),
            self.changes(),
            self.costs(),
        ]
    }

    fn setting(&self, [width, height]: [u32; 2], rays: &str) -> String {
        format!("{width} × {height}, {rays}, {}, one thread", self.precision.name())
    }

    /// What a reader of tables has to know.
    fn notes(&self) -> Vec<String> {
        let Report { repetitions, fewer, threads, .. } = self;
        let mut notes = vec![
            format!(
                "Times are processor seconds of intersecting alone, without preparation and shading: medians of {repetitions} \
                 repetitions in Tables 1 and 2 and of {fewer} in the others, all methods of a scene in turn, {threads} scenes at a \
                 time. A spread is from the first to the third quartile, as a share of the median. A gain is the median of the \
                 repetitions' gains. The paper's times are of 512 × 512 pixels, on a Pentium II of 300 MHz."
            ),
            "An intersection point is a root in the ray's interval, each time it is found; \"twice\" are those in excess of the \
             roots on their ray, by the oracle."
                .to_owned(),
            "\"Nothing kept\" is the improved method with its memory emptied before each ray: its difference to the improved one \
             is what coherence is worth."
                .to_owned(),
            match self.acceptance {
                Acceptance::Paper => {
                    "What a patch may hold is believed as in the paper (`--acceptance paper`): by eq. (1), and a patch whose \
                     starts lead to no root is taken for missed. Nothing falls back on clipping."
                }
                Acceptance::Proved => {
                    "What a patch may hold is proved (`--acceptance proved`), or left to clipping: the times are not those \
                     of the paper's methods alone."
                }
            }
            .to_owned(),
        ];
        for scene in &self.scenes {
            let Preparation { surfaces, trees, grids } = scene.preparation;
            let [surfaces, trees, grids] = [surfaces, trees, grids].map(seconds);
            notes.push(format!(
                "Preparation of {}: {surfaces} s for the grid over surfaces, {trees} s with patches and trees, {grids} s with \
                 patches and grids.",
                scene.name
            ));
            if let Some(OracleStats { rays, hit_rays, roots, open, .. }) = &scene.oracle {
                let [rays, hits, roots, open] = [*rays, *hit_rays, *roots, *open].map(grouped);
                notes.push(format!(
                    "Oracle on {}: of {rays} rays {hits} hit, with {roots} roots in all; {open} answers are left open.",
                    scene.name
                ));
            }
            for family in Family::ALL {
                let of = scene.family(family);
                for run in of.letter.iter().chain(&of.ladder) {
                    let undecided = run.agreement.map_or(0, |agreement| agreement.undecided);
                    if run.gave_up > 0 || undecided > 0 {
                        notes.push(format!(
                            "{}, {}, on {}: {} rays were given up, {undecided} answers are undecided.",
                            run.subject.method.name(),
                            run.subject.name,
                            scene.name,
                            run.gave_up
                        ));
                    }
                }
            }
        }
        notes
    }
}

#[cfg(test)]
mod tests;
