//! What became of the stiff and extreme cases, for people and for programs.

use serde::Serialize;

use super::table::{Style, Table, grouped, percent};
use crate::scene::trace::Acceptance;
use crate::stress::case::Family;
use crate::stress::run::{Row, Score};

/// All that was traced. Serialised, it is what `--json` prints.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// [`SCHEMA`](crate::stats::SCHEMA).
    pub schema: u32,
    /// The kernel's version.
    pub version: &'static str,
    /// What the cases were drawn from.
    pub seed: u64,
    /// About how many rays a family has.
    pub rays: usize,
    /// The rule of acceptance.
    pub acceptance: Acceptance,
    /// A row per family, method and precision.
    pub rows: Vec<Row>,
    /// The bounds that were missed, in words.
    pub missed: Vec<String>,
}

/// A count, or nothing where it is 0: what went wrong is then easy to see.
fn count(number: u64) -> String {
    if number == 0 { String::new() } else { grouped(number) }
}

/// A length as a power of ten with a digit.
fn share(number: f64) -> String {
    format!("{number:.0e}")
}

fn gave_up(score: &Score) -> String {
    let all = score.gave_up.iter().map(|(limit, count)| format!("{} {limit}", grouped(*count)));
    all.collect::<Vec<_>>().join(", ")
}

impl Report {
    /// The table.
    pub fn table(&self) -> Table {
        let columns = vec![
            ("family", false),
            ("method", false),
            ("precision", false),
            ("rays", true),
            ("unjudged %", true),
            ("right", true),
            ("wrong", true),
            ("missed", true),
            ("phantom", true),
            ("refused", true),
            ("gave up", false),
            ("differ", true),
            ("by paper", true),
            ("residual", true),
            ("worst steps", true),
            ("may take", true),
        ];
        let mut before = String::new();
        let rows = self.rows.iter().map(|row| {
            let Score { rays, right, wrong, missed, phantom, refused, differ, differ_by_paper, .. } = row.score;
            let family = if row.family == before { String::new() } else { row.family.clone() };
            before.clone_from(&row.family);
            let none = || "-".to_owned();
            vec![
                family,
                row.method.name().to_owned(),
                row.precision.name().to_owned(),
                grouped(rays),
                percent(row.score.unjudged_share()),
                grouped(right),
                count(wrong),
                count(missed),
                count(phantom),
                count(refused),
                gave_up(&row.score),
                differ.map_or_else(none, grouped),
                differ_by_paper.map_or_else(none, grouped),
                share(row.score.residual),
                grouped(row.score.steps),
                grouped(row.score.most_steps),
            ]
        });
        let title = format!(
            "Stiff and extreme cases, acceptance {}, seed {}: rays held against an oracle in double-double",
            self.acceptance.name(),
            self.seed
        );
        Table { title, columns, rows: rows.collect() }
    }

    /// The table, what could not be traced, and what was missed.
    pub fn to_text(&self, style: Style) -> String {
        let mut text = self.table().to_text(style);
        let mut refused: Vec<String> = Vec::new();
        for row in &self.rows {
            for reason in &row.score.refused_cases {
                let line = format!("{} in {}: refused: {reason}", row.family, row.precision.name());
                if !refused.contains(&line) {
                    refused.push(line);
                }
            }
        }
        let missed = self.missed.iter().map(|missed| format!("bound missed: {missed}"));
        for line in refused.into_iter().chain(missed) {
            text.push_str(&format!("\n{line}\n"));
        }
        text
    }
}

/// What the families are, as a table.
pub fn families(all: &[Family]) -> Table {
    let rows = all.iter().map(|family| vec![family.name.to_owned(), family.what.to_owned()]);
    Table {
        title: "Families".to_owned(),
        columns: vec![("family", false), ("what is hard", false)],
        rows: rows.collect(),
    }
}
