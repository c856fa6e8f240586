//! What scores must not exceed: what must hold of any, and what is recorded of the default seed and rays.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::case::Family;
use super::run::{Row, Score};
use crate::scene::trace::{Method, Precision};

/// The seed that bounds are recorded for.
pub const SEED: u64 = 1;

/// The rays per family or case that bounds are recorded for.
pub const RAYS: usize = 600;

/// The bounds that come with the program.
const RECORDED: &str = include_str!("../../../fixtures/recorded/stress.json");

/// By what factor a residual may exceed the recorded one: it is a rounding error.
const RESIDUAL: f64 = 2.0;

/// What is recorded of a row: see the fields of [`Score`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bound {
    lost: u64,
    gave_up: u64,
    refused: u64,
    refused_cases: u64,
    differ: u64,
    residual: f64,
    steps: u64,
}

impl Bound {
    fn of(score: &Score) -> Self {
        Bound {
            lost: score.lost(),
            gave_up: score.gave_up_in_all(),
            refused: score.refused,
            refused_cases: score.refused_cases.len() as u64,
            differ: score.differ.unwrap_or(0),
            residual: score.residual,
            steps: score.steps,
        }
    }
}

/// Bounds by `family/method/precision`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Bounds(BTreeMap<String, Bound>);

fn key(row: &Row) -> String {
    format!("{}/{}/{}", row.family, row.method.name(), row.precision.name())
}

impl Bounds {
    /// Those that are recorded.
    ///
    /// # Errors
    /// The recorded file is not in the format.
    pub fn recorded() -> Result<Self, String> {
        serde_json::from_str(RECORDED).map_err(|error| format!("fixtures/recorded/stress.json: {error}"))
    }

    /// What to record of these rows.
    pub fn of(rows: &[Row]) -> Self {
        Bounds(rows.iter().map(|row| (key(row), Bound::of(&row.score))).collect())
    }

    /// What a row exceeds of what is recorded of it.
    pub fn exceeded(&self, row: &Row) -> Vec<String> {
        let key = key(row);
        let Some(bound) = self.0.get(&key) else { return vec![format!("{key}: no bound is recorded")] };
        let is = Bound::of(&row.score);
        let counts = [
            ("judged rays lost", is.lost, bound.lost),
            ("rays given up", is.gave_up, bound.gave_up),
            ("rays refused", is.refused, bound.refused),
            ("cases refused", is.refused_cases, bound.refused_cases),
            ("rays answered unlike the original", is.differ, bound.differ),
            ("steps of one ray", is.steps, bound.steps),
        ];
        let counts = counts.iter().filter(|(_, is, bound)| is > bound);
        let mut exceeded: Vec<String> =
            counts.map(|(what, is, bound)| format!("{key}: {is} {what}, recorded are {bound}")).collect();
        if !(is.residual <= RESIDUAL * bound.residual) {
            exceeded.push(format!("{key}: residual {:.1e}, recorded is {:.1e}", is.residual, bound.residual));
        }
        exceeded
    }
}

/// What a row breaks of what must hold of any seed.
pub fn broken(row: &Row, families: &[Family]) -> Vec<String> {
    let (key, score) = (key(row), &row.score);
    let mut broken = Vec::new();
    let mut say = |count: u64, what: &str| {
        if count > 0 {
            broken.push(format!("{key}: {count} {what}"));
        }
    };
    if matches!(row.method, Method::Clipping) {
        say(score.lost(), "judged rays lost");
    }
    say(score.gave_up_clear, "clear rays given up");
    say(score.beyond, "rays beyond the stated worst case");
    say(score.not_finite, "answers that are not finite");
    let most = families.iter().find(|family| family.name == row.family).map_or([0.0; 2], |family| family.unjudged);
    let most = match row.precision {
        Precision::F64 => most[0],
        Precision::F32 => most[1],
    };
    if score.unjudged_share() > most {
        say((100.0 * score.unjudged_share()) as u64, "% of the rays are not judged");
    }
    broken
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(score: Score) -> Row {
        Row { family: "poles".to_owned(), method: Method::Clipping, precision: Precision::F64, score }
    }

    #[test]
    fn each_bound_can_be_exceeded() {
        let recorded = Score { rays: 100, residual: 1e-15, steps: 9, ..Score::default() };
        let bounds = Bounds::of(&[row(recorded.clone())]);
        assert_eq!(bounds.exceeded(&row(recorded.clone())), [""; 0]);
        for worse in [
            Score { wrong: 1, ..recorded.clone() },
            Score { gave_up: [("patches".to_owned(), 1)].into(), ..recorded.clone() },
            Score { refused: 1, ..recorded.clone() },
            Score { refused_cases: vec![String::new()], ..recorded.clone() },
            Score { differ: Some(1), ..recorded.clone() },
            Score { steps: 10, ..recorded.clone() },
            Score { residual: 3e-15, ..recorded.clone() },
            Score { residual: f64::NAN, ..recorded.clone() },
        ] {
            assert_eq!(bounds.exceeded(&row(worse)).len(), 1);
        }
        assert_eq!(Bounds::default().exceeded(&row(recorded)).len(), 1, "a row without a bound is no good row");
    }

    #[test]
    fn what_must_hold_of_any_seed_can_be_broken() {
        let families = crate::stress::families::all();
        let good = Score { rays: 100, unjudged: 30, ..Score::default() };
        assert_eq!(broken(&row(good.clone()), &families), [""; 0]);
        for bad in [
            Score { missed: 1, ..good.clone() },
            Score { gave_up_clear: 1, ..good.clone() },
            Score { beyond: 1, ..good.clone() },
            Score { not_finite: 1, ..good.clone() },
            Score { unjudged: 31, ..good.clone() },
        ] {
            assert_eq!(broken(&row(bad), &families).len(), 1);
        }
    }
}
