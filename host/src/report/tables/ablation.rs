//! Tables 5 to 8: what each part is worth.

use super::{ChangeReport, Report, SCENE, Table, gain, grouped, intersection_points, percent, seconds};
use crate::experiment::Run;
use crate::experiment::cost::{Model, step_of};
use crate::experiment::subject::Family;
use crate::judge::Agreement;

/// Pixels that are not as the oracle has them.
fn not_right(run: &Run) -> String {
    let sum = |all: &Agreement| all.wrong + all.missed + all.phantom;
    run.agreement.as_ref().map_or(String::new(), |all| grouped(sum(all)))
}

impl Report {
    /// Table 5 or 6.
    pub(super) fn ladders(&self, number: u32, family: Family) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            let ladder = &scene.family(family).ladder;
            let mut before: Option<&Run> = None;
            for (place, run) in ladder.iter().enumerate() {
                let over = |other: Option<&Run>| other.map_or(String::new(), |other| percent(run.gain_over(other)));
                let count = |name: &str| grouped(run.counts.of(name));
                let own = match family {
                    Family::Numerical => [count("newton_starts"), count("newton_steps")],
                    Family::Clipping => [count("clip_steps"), count("newton_steps")],
                };
                let mut row = vec![
                    if place == 0 { scene.name.to_owned() } else { String::new() },
                    run.subject.name.to_owned(),
                    seconds(run.times.median),
                    percent(run.times.spread),
                    over(before),
                    over(ladder.first().filter(|_| place > 0)),
                ];
                row.extend(own);
                row.extend(["nodes_visited", "patches_tested", "voxels_visited"].map(count));
                row.push(grouped(intersection_points(run)));
                row.push(not_right(run));
                rows.push(row);
                before = Some(run);
            }
        }
        let (solves, steps, of) = match family {
            Family::Numerical => ("Solves", "Newton steps", "numerical"),
            Family::Clipping => ("Clips", "Newton steps", "clipping"),
        };
        let columns = vec![
            SCENE,
            ("Part", false),
            ("Time s", true),
            ("Spread %", true),
            ("Gain of the part %", true),
            ("Gain in all %", true),
            (solves, true),
            (steps, true),
            ("Nodes", true),
            ("Patches", true),
            ("Voxels", true),
            ("Points", true),
            ("Not right", true),
        ];
        let setting = self.setting(self.small, "primary rays");
        Table { title: format!("Table {number}. A part at a time, {of} methods: {setting}"), columns, rows }
    }

    /// Table 7.
    pub(super) fn changes(&self) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            let mut first = true;
            for family in Family::ALL {
                for ChangeReport { name, before, after } in &scene.family(family).changes {
                    let ([old, old_improved, ..], [new, new_improved, ..]) = (before.as_slice(), after.as_slice())
                    else {
                        continue;
                    };
                    rows.push(vec![
                        if std::mem::take(&mut first) { scene.name.to_owned() } else { String::new() },
                        family.improved().name().to_owned(),
                        (*name).to_owned(),
                        percent(new.gain_over(old)),
                        percent(new_improved.gain_over(old_improved)),
                        percent(gain(before)),
                        percent(gain(after)),
                        grouped(intersection_points(old)),
                        grouped(intersection_points(new)),
                        grouped(intersection_points(old_improved)),
                        grouped(intersection_points(new_improved)),
                    ]);
                }
            }
        }
        let columns = vec![
            SCENE,
            ("Methods", false),
            ("Changed", false),
            ("Original saves %", true),
            ("Improved saves %", true),
            ("Gain before %", true),
            ("Gain after %", true),
            ("Points, original", true),
            ("After", true),
            ("Points, improved", true),
            ("After", true),
        ];
        let setting = self.setting(self.small, "primary rays");
        Table { title: format!("Table 7. One change at a time: {setting}"), columns, rows }
    }

    /// Table 8.
    pub(super) fn costs(&self) -> Table {
        let mut rows = Vec::new();
        for scene in &self.scenes {
            for (place, family) in Family::ALL.into_iter().enumerate() {
                let model @ Model { work: [original, improved], ratio, most } = &scene.family(family).cost;
                let at = |ratio: f64| percent(model.gain(ratio));
                rows.push(vec![
                    if place == 0 { scene.name.to_owned() } else { String::new() },
                    step_of(family).to_owned(),
                    grouped(original.steps),
                    grouped(improved.steps),
                    grouped(original.tests),
                    grouped(improved.tests),
                    percent(scene.improvement(family).gain),
                    ratio.map_or_else(|| "none".to_owned(), |ratio| format!("{ratio:.1}")),
                    at(3.0),
                    at(10.0),
                    at(30.0),
                    percent(*most),
                ]);
            }
        }
        let columns = vec![
            SCENE,
            ("Step", false),
            ("Steps, original", true),
            ("Improved", true),
            ("Tests, original", true),
            ("Improved", true),
            ("Paper's gain %", true),
            ("At a step of .. tests", true),
            ("Gain at 3 %", true),
            ("At 10 %", true),
            ("At 30 %", true),
            ("At most %", true),
        ];
        let title =
            "Table 8. Which costs would give the paper's gains, by the counts of its methods to the letter".to_owned();
        Table { title, columns, rows }
    }
}
