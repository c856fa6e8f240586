//! What a gain would be on a machine of other costs, by what methods count.
//!
//! A method's time is taken to be that of its Newton steps, or its clips, and of its tests: nodes, patches and voxels, and boxes of
//! surfaces, all of one cost. One number is free: how many tests a step costs.

use serde::Serialize;

use super::subject::Family;
use super::{Counts, Run};

/// What a method counted, as far as the model goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Work {
    /// Newton steps and clips.
    pub steps: u64,
    /// Nodes, patches, voxels and boxes of surfaces that were tested.
    pub tests: u64,
}

impl Work {
    /// That of these counters.
    pub fn of(counts: &Counts) -> Self {
        let sum = |names: &[&str]| names.iter().map(|name| counts.of(name)).sum();
        Work {
            steps: sum(&["newton_steps", "clip_steps"]),
            tests: sum(&["nodes_visited", "patches_tested", "voxels_visited", "surfaces_tested"]),
        }
    }

    /// Its time, in tests, where a step costs `ratio` of them.
    fn time(&self, ratio: f64) -> f64 {
        ratio * self.steps as f64 + self.tests as f64
    }
}

/// What the model says of an original and its improved method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Model {
    /// Of the original, and of the improved method.
    pub work: [Work; 2],
    /// How many tests a step would have to cost for the paper's gain; `None` where no cost gives it.
    pub ratio: Option<f64>,
    /// The gain where steps are all that costs.
    pub most: f64,
}

/// The family's step, in words.
pub fn step_of(family: Family) -> &'static str {
    match family {
        Family::Numerical => "Newton step",
        Family::Clipping => "clip",
    }
}

impl Model {
    /// The model of what was measured; `gain` is the paper's.
    pub fn of(original: &Run, improved: &Run, gain: f64) -> Self {
        let work = [original, improved].map(|run| Work::of(&run.counts));
        Model { work, ratio: ratio(work, gain), most: 1.0 - work[1].steps as f64 / work[0].steps as f64 }
    }

    /// The gain where a step costs `ratio` tests.
    pub fn gain(&self, ratio: f64) -> f64 {
        1.0 - self.work[1].time(ratio) / self.work[0].time(ratio)
    }
}

/// The ratio at which the improved method takes less by this share: (1 − gain) (r a + b) = r a' + b'.
fn ratio([original, improved]: [Work; 2], gain: f64) -> Option<f64> {
    let rest = 1.0 - gain;
    let by_tests = improved.tests as f64 - rest * original.tests as f64;
    let by_steps = rest * original.steps as f64 - improved.steps as f64;
    let ratio = by_tests / by_steps;
    (ratio.is_finite() && ratio >= 0.0).then_some(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_gives_the_gain() {
        // Half of the steps for twice the tests: nothing is gained where a step costs two tests, half at most.
        let work = [Work { steps: 100, tests: 100 }, Work { steps: 50, tests: 200 }];
        assert_eq!(ratio(work, 0.0), Some(2.0));
        let model = Model { work, ratio: ratio(work, 0.2), most: 0.5 };
        let at = model.ratio.expect("20 % are within reach");
        assert!((model.gain(at) - 0.2).abs() < 1e-12);
        assert_eq!((ratio(work, 0.5), ratio(work, 0.6)), (None, None));
    }
}
