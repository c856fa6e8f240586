//! Tables 1 to 4: the paper's methods to the letter.

use super::{
    FamilyReport, IncoherentReport, Report, SCENE, SamplingReport, Table, extent, gain, grouped, intersection_points,
    percent, seconds, wrong_missed_phantom,
};
use crate::experiment::subject::Family;
use crate::scene::paper::Figures;

/// What stands in a column where nothing is to be said.
fn blank() -> String {
    String::new()
}

impl Report {
    /// Table 1 or 2.
    pub(super) fn improvements(&self, number: u32, family: Family) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            let (figures, paper) = (&scene.paper, scene.improvement(family));
            for (place, name) in ["paper, original", "paper, improved"].into_iter().enumerate() {
                let first = place == 0;
                rows.push(vec![
                    if first { format!("Fig. {}", figures.figure) } else { blank() },
                    if first { format!("{}/{}", figures.patches, figures.surfaces) } else { blank() },
                    name.to_owned(),
                    seconds(paper.seconds[place]),
                    blank(),
                    if first { blank() } else { percent(paper.gain) },
                    blank(),
                    grouped(paper.points[place]),
                    blank(),
                    blank(),
                    blank(),
                    blank(),
                ]);
            }
            let FamilyReport { letter, .. } = scene.family(family);
            for (place, run) in letter.iter().enumerate() {
                let first = place == 0;
                let [wrong, missed, phantom] = wrong_missed_phantom(run);
                rows.push(vec![
                    if first { scene.name.to_owned() } else { blank() },
                    if first { format!("{}/{}", scene.patches, scene.surfaces) } else { blank() },
                    format!("{}, {}", run.subject.method.name(), run.subject.name),
                    seconds(run.times.median),
                    percent(run.times.spread),
                    letter.first().filter(|_| !first).map_or(blank(), |original| percent(run.gain_over(original))),
                    if place == 1 { extent(&scene.family(family).gains()) } else { blank() },
                    grouped(intersection_points(run)),
                    run.found_twice.map_or(blank(), grouped),
                    wrong,
                    missed,
                    phantom,
                ]);
            }
        }
        let columns = vec![
            SCENE,
            ("Patches/surfaces", true),
            ("Method", false),
            ("Time s", true),
            ("Spread %", true),
            ("Gain %", true),
            ("By five cameras %", true),
            ("Intersection points", true),
            ("Twice", true),
            ("Wrong", true),
            ("Missed", true),
            ("Phantom", true),
        ];
        let of = match family {
            Family::Numerical => "Barth and Stürzlinger's algorithm",
            Family::Clipping => "Bézier clipping",
        };
        let setting = self.setting(self.size, "primary rays");
        Table { title: format!("Table {number}. {of} to the letter: {setting}"), columns, rows }
    }

    /// Table 3.
    pub(super) fn samplings(&self) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            let Figures { figure, sampling, .. } = &scene.paper;
            let [uniform, jittered] = sampling.seconds.map(seconds);
            rows.push(vec![
                format!("Fig. {figure}"),
                "paper, improved numerical".to_owned(),
                uniform,
                blank(),
                jittered,
                blank(),
                percent(sampling.gain),
            ]);
            let all = Family::ALL.into_iter().flat_map(|family| &scene.family(family).samplings);
            for (place, SamplingReport { uniform, jittered }) in all.enumerate() {
                rows.push(vec![
                    if place == 0 { scene.name.to_owned() } else { blank() },
                    format!("{}, {}", uniform.subject.method.name(), uniform.subject.name),
                    seconds(uniform.times.median),
                    percent(uniform.times.spread),
                    seconds(jittered.times.median),
                    percent(jittered.times.spread),
                    percent(jittered.gain_over(uniform)),
                ]);
            }
        }
        let columns = vec![
            SCENE,
            ("Method", false),
            ("Uniform s", true),
            ("Spread %", true),
            ("Jittered s", true),
            ("Spread %", true),
            ("Performance %", true),
        ];
        let setting = self.setting(self.small, "four primary rays per pixel");
        Table { title: format!("Table 3. Uniform and jittered sampling, to the letter: {setting}"), columns, rows }
    }

    /// Table 4.
    pub(super) fn incoherent(&self) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            let all = Family::ALL.into_iter().flat_map(|family| &scene.family(family).incoherent);
            for (place, IncoherentReport { rays, runs }) in all.enumerate() {
                let [original, improved, ..] = runs.as_slice() else { continue };
                rows.push(vec![
                    if place == 0 { scene.name.to_owned() } else { blank() },
                    (*rays).to_owned(),
                    grouped(original.rays),
                    improved.subject.method.name().to_owned(),
                    seconds(original.times.median),
                    seconds(improved.times.median),
                    percent(original.times.spread.max(improved.times.spread)),
                    percent(gain(runs)),
                ]);
            }
        }
        let columns = vec![
            SCENE,
            ("Rays", false),
            ("Number", true),
            ("Method", false),
            ("Original s", true),
            ("Improved s", true),
            ("Spread %", true),
            ("Gain %", true),
        ];
        let setting = self.setting(self.small, "rays that are not coherent");
        Table { title: format!("Table 4. Where the paper expects little, to the letter: {setting}"), columns, rows }
    }
}
