//! Answers held against the oracle, which is asked of every ray: a method that proves its answers is no judge of another, since
//! what both share may be what is wrong.
//!
//! An answer counts only where the oracle is sure of it by a margin: what a ray moved by a rounding would answer otherwise is no
//! fault of the method. The quick oracle is asked first; it takes the one in double-double to convict. Margins and allowances are
//! those of the surfaces concerned: what else stands in the scene excuses nothing.

use crate::claims::{Exactness, size};
use crate::input::{Case, with_default_budgets};
use crate::lane::Answer;
use patchray::limits::{Limit, Limits};
use patchray::ray::{Hit, Incidence};
use patchray::scalar::Scalar;
use patchray_host::oracle::{DoubleDouble, OracleIn, Real, Verdict};
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;
use std::cell::OnceCell;

/// What is true of a ray, found out as far as it is asked for.
pub(crate) struct Truth<'c> {
    case: &'c Case,
    ray: RayLine,
    /// How large other coordinates are that take part.
    at_hand: f64,
    quick: Verdict,
    sure: OnceCell<Verdict>,
    clear: OnceCell<bool>,
}

/// What the original of a call answers to the same ray, which the call then has to answer, too, however hard it is.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Original {
    /// There is none, or it gives the ray up.
    Open,
    Answers,
    /// The call's ray is rounded otherwise, so that it need not answer what a rounding changes.
    AnswersRoundedOtherwise,
}

/// Parts that the oracle looks at of a surface. A pole met head on takes up to 2,000; rays that take more lie along a surface, and
/// nothing is known of them.
const DOMAINS: usize = 2500;

/// Parts of surfaces that the quick oracle leaves open, beyond which the other one is not asked, which would leave them open too.
const MANY: usize = 100;

/// Shares of a surface's size.
struct Shares {
    /// The margin from which on an answer is judged.
    judged: f64,
    /// That from which on there has to be one.
    clear: f64,
    /// How far a right answer may be off across the surface.
    across: f64,
    /// How far it may be off along the ray at most.
    most: f64,
}

impl Shares {
    const fn of(precision: Precision) -> Self {
        match precision {
            Precision::F64 => Shares { judged: 1e-12, clear: 1e-9, across: 1e-9, most: 1e-4 },
            // Where three roots all but fall together, a third of the digits is all that rounding leaves.
            Precision::F32 => Shares { judged: 2e-5, clear: 1e-4, across: 5e-6, most: 5e-3 },
        }
    }
}

impl<'c> Truth<'c> {
    pub(crate) fn new(case: &'c Case, ray: &RayLine, at_hand: f64) -> Self {
        let quick = verdict::<f64>(&case.model, ray, |surface| unit(surface, case.precision, at_hand));
        Truth { case, ray: *ray, at_hand, quick, sure: OnceCell::new(), clear: OnceCell::new() }
    }

    fn unit(&self, surface: &ModelSurface) -> f64 {
        unit(surface, self.case.precision, self.at_hand)
    }

    fn sure(&self) -> &Verdict {
        self.sure.get_or_init(|| verdict::<DoubleDouble>(&self.case.model, &self.ray, |surface| self.unit(surface)))
    }

    /// What a call answers under these limits, or, where it may not give up, under default budgets; it is right, was given up, or
    /// nothing is sure.
    pub(crate) fn judged<S: Scalar>(
        &self,
        name: &str,
        limits: &Limits<S>,
        original: Original,
        mut call: impl FnMut(&Limits<S>) -> Answer<S>,
    ) -> Answer<S> {
        let mut answer = call(limits);
        let answered = || match original {
            Original::Open => false,
            Original::Answers => true,
            Original::AnswersRoundedOtherwise => self.is_sure(),
        };
        if out_of_budget(&answer) && (answered() || self.is_clear()) {
            answer = call(&with_default_budgets(limits));
            let why = if original == Original::Open { "is clear" } else { "its original answers" };
            assert!(!out_of_budget(&answer), "{name}: {answer:?} under default budgets of a ray that {why}; {self}");
        }
        if let Ok(answer) = answer {
            let convicted =
                self.is_wrong(&answer, &self.quick) && self.is_sure() && self.is_wrong(&answer, self.sure());
            assert!(!convicted, "{name} answers {answer:?}; {self}");
        }
        answer
    }

    /// Whether an answer is not what a verdict says, however sure.
    fn is_wrong<S: Scalar>(&self, answer: &Option<Hit<S>>, verdict: &Verdict) -> bool {
        let (Some(hit), Some(root)) = (answer, verdict.roots.first()) else {
            return answer.is_some() || !verdict.roots.is_empty();
        };
        let Shares { clear, across, most, .. } = Shares::of(self.case.precision);
        let is_clear = verdict.margin >= clear;
        let exactness = Exactness::of(self.case.precision);
        let concerned = [root.surface, hit.surface as usize].map(|k| &self.case.model.surfaces[k]);
        let largest = |of: &dyn Fn(f64, f64) -> f64| {
            let of = concerned.map(|surface| of(size(surface), exactness.length(surface, self.at_hand)));
            of[0].max(of[1])
        };
        let grazing = largest(&|size, exact| 64.0 * (exact / size).sqrt());
        // Of surfaces that share the edge that the ray meets, it may graze one and cross the other.
        let same = hit.surface as usize == root.surface;
        if is_clear && same && hit.incidence != Incidence::Crossing && root.cosine > grazing {
            return true;
        }
        // What is clear is as exact as rounding leaves it.
        let across = largest(&|size, exact| (4.0 * exact).max(if is_clear { 0.0 } else { across * size }));
        let most = largest(&|size, exact| (4.0 * exact).max(most * size));
        let [x, y, z] = self.ray.direction;
        let off = (hit.t.to_f64() - root.t).abs() * x.hypot(y).hypot(z);
        let allowed = (across / root.cosine).min(most) + 2.0 * exactness.of_t(root.t, &self.ray);
        off.is_nan() || off > allowed
    }

    /// Whether the ray is as clear of each surface, seen alone, as default budgets have to suffice for: all along its line,
    /// which is searched whatever the interval.
    fn is_clear(&self) -> bool {
        let Shares { clear, .. } = Shares::of(self.case.precision);
        let line = RayLine { t_min: f64::NEG_INFINITY, t_max: f64::INFINITY, ..self.ray };
        let of = |surface: &ModelSurface| {
            let model = Model::numbered(vec![surface.clone()]);
            let verdict = verdict::<DoubleDouble>(&model, &line, |surface| self.unit(surface));
            verdict.margin >= clear && verdict.unresolved == 0
        };
        *self.clear.get_or_init(|| self.can_be_judged() && self.case.model.surfaces.iter().all(of))
    }

    /// Whether the ray, moved by as much as rounding moves it, is answered alike.
    fn is_sure(&self) -> bool {
        self.can_be_judged() && self.sure().margin >= Shares::of(self.case.precision).judged
    }

    /// Whether the oracle in double-double can tell more than how long it takes.
    fn can_be_judged(&self) -> bool {
        // Along a line that is all of a surface the oracle has roots each of which blurs into the next, and takes them for one,
        // which may lie outside the interval.
        self.quick.unresolved <= MANY && self.case.model.surfaces.iter().all(has_area)
    }
}

impl std::fmt::Display for Truth<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Case { precision, numbers, model, .. } = self.case;
        let Verdict { roots, margin, unresolved } = self.sure();
        write!(f, "the oracle {:?} of {}, margin {margin:e}, {unresolved} unresolved; ", roots.first(), roots.len())?;
        write!(f, "{precision:?} {numbers:?}, ray {:?}, surfaces {:?}", self.ray, model.surfaces)
    }
}

fn verdict<R: Real>(model: &Model, ray: &RayLine, unit: impl Fn(&ModelSurface) -> f64) -> Verdict {
    let oracle = OracleIn::<R>::measured_by(model, unit).within(DOMAINS);
    oracle.trace(ray.origin, ray.direction, ray.t_min, ray.t_max)
}

/// What margins of a surface are shares of: its size, or as much more as the rounding of its coordinates takes.
fn unit(surface: &ModelSurface, precision: Precision, at_hand: f64) -> f64 {
    let exact = Exactness::of(precision).length(surface, at_hand);
    size(surface).max(4.0 * exact / Shares::of(precision).judged).max(f64::MIN_POSITIVE)
}

/// Whether a ray was given up for a budget: not for what was lent to the call, which no budget makes good.
fn out_of_budget<S>(answer: &Answer<S>) -> bool {
    let lent = [Limit::Hits, Limit::Scratch, Limit::Line, Limit::Memory, Limit::Slot];
    answer.as_ref().is_err_and(|gave_up| !lent.contains(&gave_up.limit))
}

/// Whether a surface's control points lie neither all in one point nor on one line.
fn has_area(surface: &ModelSurface) -> bool {
    let from = |point: &[f64; 4]| [0, 1, 2].map(|k| point[k] - surface.points[0][k]);
    let size = |[x, y, z]: [f64; 3]| x.hypot(y).hypot(z);
    let longest = surface.points.iter().map(from).max_by(|a, b| size(*a).total_cmp(&size(*b)));
    let [a, b, c] = longest.unwrap_or_default();
    let least = size([a, b, c]) * size([a, b, c]) * 1e-9;
    let across = |[x, y, z]: [f64; 3]| size([b * z - c * y, c * x - a * z, a * y - b * x]);
    surface.points.iter().map(from).any(|point| across(point) > least)
}
