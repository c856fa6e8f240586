//! The paper's tables: what was measured, with the paper's figures beside it, for people and for programs.

use serde::Serialize;

use super::table::{Style, Table, grouped, percent, seconds};
use super::times::Times;
use crate::judge::{Agreement, OracleStats};
use crate::scene::paper::{Figures, Improvement};
use crate::scene::trace::{Acceptance, Method, Precision};

/// All that was measured. Serialised, it is what `--json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// [`SCHEMA`](crate::stats::SCHEMA).
    pub schema: u32,
    /// The kernel's version.
    pub version: &'static str,
    /// Width and height of the pictures.
    pub size: [u32; 2],
    /// The precision of the methods.
    pub precision: Precision,
    /// Their acceptance.
    pub acceptance: Acceptance,
    /// How often each method traced each scene for Tables 1 and 2.
    pub repetitions: u32,
    /// The threads of the oracle: all times are of one thread.
    pub oracle_threads: u32,
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
    /// What the oracle found; `None` if it was not asked.
    pub oracle: Option<OracleStats>,
    /// Table 1: the numerical methods, the original first.
    pub numerical: Vec<Run>,
    /// Table 2: the clipping methods, the original first.
    pub clipping: Vec<Run>,
    /// Table 3.
    pub sampling: Vec<SamplingRun>,
    /// Table 4.
    pub rays: Vec<RaysRun>,
}

/// A method on the primary rays of a picture.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// The method.
    pub method: Method,
    /// Whether rays left something to the next. Without, what is gained over the original is owed to the order of
    /// search and its early end.
    pub coherence: bool,
    /// Its times, of intersecting alone.
    pub times: Times,
    /// By what share it takes less time than the original.
    pub gain: f64,
    /// Rays.
    pub rays: u64,
    /// Rays that hit.
    pub hit_rays: u64,
    /// Rays given up.
    pub gave_up: u64,
    /// The paper's "intersection points".
    pub intersection_points: u64,
    /// How many of them are more than the roots that there are on their ray, so that roots must have been found twice.
    pub found_twice: Option<u64>,
    /// What the oracle says of its answers.
    pub agreement: Option<Agreement>,
}

/// A method with four rays per pixel.
#[derive(Clone, Debug, Serialize)]
pub struct SamplingRun {
    /// The method.
    pub method: Method,
    /// Its times with uniform samples.
    pub uniform: Times,
    /// Its times with jittered samples.
    pub jittered: Times,
    /// By what share jittered samples take less time than uniform ones: less than 0 where they take more.
    pub gain: f64,
}

/// What kind of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RaysKind {
    /// The primary rays, one by one, along scan lines.
    Primary,
    /// The same in random order.
    Shuffled,
    /// From where primary rays hit to the first light.
    Shadow,
}

impl RaysKind {
    fn name(self) -> &'static str {
        match self {
            RaysKind::Primary => "primary",
            RaysKind::Shuffled => "primary, shuffled",
            RaysKind::Shadow => "shadow",
        }
    }
}

/// An original and its improved method on rays that are traced one by one.
#[derive(Clone, Debug, Serialize)]
pub struct RaysRun {
    /// Which rays.
    pub kind: RaysKind,
    /// How many.
    pub rays: u64,
    /// The original method.
    pub method: Method,
    /// Its times.
    pub original: Times,
    /// The times of the improved method.
    pub coherent: Times,
    /// By what share that takes less time.
    pub gain: f64,
    /// The paper's "intersection points" of both.
    pub intersection_points: [u64; 2],
    /// The times of the original method asked for any hit, which is what shadows need.
    pub any_hit: Option<Times>,
}

const FIGURE: (&str, bool) = ("Scene", false);
const PATCHES: (&str, bool) = ("Patches/surfaces", true);

impl Report {
    /// The report as tables and notes.
    pub fn to_text(&self, style: Style) -> String {
        let tables = [
            self.improvement("Table 1. Barth and Stürzlinger's algorithm", |scene| {
                (&scene.numerical, &scene.paper.numerical)
            }),
            self.improvement("Table 2. Bézier clipping", |scene| (&scene.clipping, &scene.paper.clipping)),
            self.samplings(),
            self.rays(),
        ];
        let mut text: String = tables.iter().map(|table| table.to_text(style) + "\n").collect();
        for note in self.notes() {
            text += &note;
            text += if style == Style::Markdown { "\n\n" } else { "\n" };
        }
        text.truncate(text.trim_end().len());
        text + "\n"
    }

    fn setting(&self, rays: &str) -> String {
        let [width, height] = self.size;
        let precision = match self.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        };
        format!("{width} × {height}, {rays}, {precision}, one thread")
    }

    /// Table 1 or 2.
    fn improvement<'s>(
        &'s self,
        title: &str,
        part: impl Fn(&'s SceneReport) -> (&'s Vec<Run>, &'s Improvement),
    ) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            let (runs, paper) = part(scene);
            let figures = &scene.paper;
            for (place, name) in ["paper, original", "paper, improved"].into_iter().enumerate() {
                let gain = if place == 0 { String::new() } else { percent(paper.gain) };
                let head = if place == 0 {
                    [format!("Fig. {}", figures.figure), format!("{}/{}", figures.patches, figures.surfaces)]
                } else {
                    [String::new(), String::new()]
                };
                let cells = [name.to_owned(), seconds(paper.seconds[place]), String::new(), gain];
                let mut row: Vec<String> = head.into_iter().chain(cells).collect();
                row.push(grouped(paper.points[place]));
                row.extend([const { String::new() }; 4]);
                rows.push(row);
            }
            for (place, run) in runs.iter().enumerate() {
                let head = if place == 0 {
                    [scene.name.to_owned(), format!("{}/{}", scene.patches, scene.surfaces)]
                } else {
                    [String::new(), String::new()]
                };
                rows.push(head.into_iter().chain(run.cells(place == 0)).collect());
            }
        }
        let columns = vec![
            FIGURE,
            PATCHES,
            ("Algorithm", false),
            ("Time s", true),
            ("Spread %", true),
            ("Gain %", true),
            ("Intersection points", true),
            ("Twice", true),
            ("Wrong", true),
            ("Missed", true),
            ("Phantom", true),
        ];
        Table { title: format!("{title}: {}", self.setting("primary rays")), columns, rows }
    }

    /// Table 3.
    fn samplings(&self) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            let Figures { figure, patches, surfaces, sampling, .. } = &scene.paper;
            let [uniform, jittered] = sampling.seconds.map(seconds);
            let paper = "paper, improved numerical".to_owned();
            let head = [format!("Fig. {figure}"), format!("{patches}/{surfaces}"), paper];
            let cells = [uniform, jittered, String::new(), percent(sampling.gain)];
            rows.push(head.into_iter().chain(cells).collect());
            for (place, SamplingRun { method, uniform, jittered, gain }) in scene.sampling.iter().enumerate() {
                let head = if place == 0 {
                    [scene.name.to_owned(), format!("{}/{}", scene.patches, scene.surfaces)]
                } else {
                    [String::new(), String::new()]
                };
                let spread = uniform.spread.max(jittered.spread);
                let cells = [
                    method.name().to_owned(),
                    seconds(uniform.median),
                    seconds(jittered.median),
                    percent(spread),
                    percent(*gain),
                ];
                rows.push(head.into_iter().chain(cells).collect());
            }
        }
        let columns = vec![
            FIGURE,
            PATCHES,
            ("Algorithm", false),
            ("Uniform s", true),
            ("Jittered s", true),
            ("Spread %", true),
            ("Performance %", true),
        ];
        let title = format!("Table 3. Uniform and jittered sampling: {}", self.setting("four primary rays per pixel"));
        Table { title, columns, rows }
    }

    /// Table 4.
    fn rays(&self) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            for (place, run) in scene.rays.iter().enumerate() {
                let RaysRun { kind, rays, method, original, coherent, gain, intersection_points, any_hit } = run;
                let [points, of_coherent] = intersection_points.map(grouped);
                rows.push(vec![
                    if place == 0 { scene.name.to_owned() } else { String::new() },
                    kind.name().to_owned(),
                    grouped(*rays),
                    method.name().to_owned(),
                    seconds(original.median),
                    seconds(coherent.median),
                    percent(original.spread.max(coherent.spread)),
                    percent(*gain),
                    points,
                    of_coherent,
                    any_hit.as_ref().map_or(String::new(), |times| seconds(times.median)),
                ]);
            }
        }
        let columns = vec![
            FIGURE,
            ("Rays", false),
            ("Number", true),
            ("Algorithm", false),
            ("Original s", true),
            ("Coherent s", true),
            ("Spread %", true),
            ("Gain %", true),
            ("Points, original", true),
            ("Points, coherent", true),
            ("Original, any hit s", true),
        ];
        let title = format!("Table 4. Where coherence does not pay: {}", self.setting("rays one by one"));
        Table { title, columns, rows }
    }

    fn notes(&self) -> Vec<String> {
        let Report { repetitions, .. } = self;
        let fewer =
            self.scenes.iter().flat_map(|scene| &scene.sampling).map(|run| run.uniform.repetitions.len()).next();
        let fewer = fewer.unwrap_or(0);
        let mut notes = vec![
            format!(
                "Times are of intersecting alone, without preparation and shading: medians of {repetitions} \
                 repetitions ({fewer} in Tables 3 and 4), all methods of a scene in turn; the spread is from the \
                 first to the third quartile. A gain is the median of the repetitions' gains. The paper's times are \
                 of 512 × 512 pixels, on a Pentium II of 300 MHz."
            ),
            "\"Nothing kept\" is the method with its memory emptied before each ray: what it then gains over the \
             original is owed to its order of search and its early end, and not to coherence."
                .to_owned(),
            "Tables 1 to 3 are of views: surfaces are searched front to back, by what each scan line can see, by the \
             originals too. Table 4 is of any rays, by trees and grids; there surfaces are searched in the order of \
             the grid's cells, which is front to back only roughly, and more points are found."
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
            "Table 3: performance is what jittered samples save over uniform ones, as a gain is: \
             below 0 they cost time; the spread is the larger of both."
                .to_owned(),
            "Table 4: shuffled rays come in no order; shadow rays go from the hits to the first light. Points are \
             intersection points. \"Any hit\" ends at the first hit between a point and the light, whichever it is."
                .to_owned(),
        ];
        if self.scenes.iter().any(|scene| scene.oracle.is_some()) {
            notes.push(
                "By the oracle: \"twice\" are intersection points in excess of the roots on their ray; \"wrong\" are pixels \
                 with a hit that is not the closest, \"missed\" with none where there is one, \"phantom\" with one where \
                 there is none."
                    .to_owned(),
            );
        }
        for SceneReport { name, oracle, numerical, clipping, .. } in &self.scenes {
            if let Some(OracleStats { rays, hit_rays, roots, open, .. }) = oracle {
                let [rays, hits, roots, open] = [*rays, *hit_rays, *roots, *open].map(grouped);
                notes.push(format!(
                    "Oracle on {name}: of {rays} rays {hits} hit, with {roots} roots in all; {open} answers are left open."
                ));
            }
            for run in numerical.iter().chain(clipping) {
                let undecided = run.agreement.map_or(0, |agreement| agreement.undecided);
                if run.gave_up > 0 || undecided > 0 {
                    notes.push(format!(
                        "{} on {name}: {} rays were given up, {undecided} answers are undecided.",
                        run.name(),
                        run.gave_up
                    ));
                }
            }
        }
        notes
    }
}

impl Run {
    fn name(&self) -> String {
        let kept = if self.coherence { "" } else { ", nothing kept" };
        format!("{}{kept}", self.method.name())
    }

    fn cells(&self, original: bool) -> [String; 9] {
        let count =
            |part: fn(&Agreement) -> u64| self.agreement.as_ref().map_or(String::new(), |all| part(all).to_string());
        [
            self.name(),
            seconds(self.times.median),
            percent(self.times.spread),
            if original { String::new() } else { percent(self.gain) },
            grouped(self.intersection_points),
            self.found_twice.map_or(String::new(), grouped),
            count(|all| all.wrong),
            count(|all| all.missed),
            count(|all| all.phantom),
        ]
    }
}

#[cfg(test)]
mod tests;
