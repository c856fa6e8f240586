//! Answers held against the oracle, which is asked of every ray: a method that proves its answers is no judge of another, since
//! what both share may be what is wrong.
//!
//! An answer counts only where the oracle is sure of it by a margin: what a ray moved by a rounding would answer otherwise is no
//! fault of the method. The quick oracle is asked first; it takes the one in double-double to convict. Margins and allowances are
//! those of the surfaces that the answer and the truth name: what else stands in the scene excuses nothing.

use crate::claims::{Exactness, size};
use crate::common::{Kind, Prepared};
use crate::input::Case;
use crate::lane::Answer;
use patchray::bernstein::Basis;
use patchray::limits::{GaveUp, Limit};
use patchray_host::oracle::{DoubleDouble, OracleIn, Real, Verdict};
use patchray_host::scanline::{Outcome, found};
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;
use std::cell::OnceCell;

/// An answer as the harness has it.
pub(crate) fn outcome<P: Kind>(prepared: &Prepared<P>, answer: &Answer<P::Scalar>) -> Outcome {
    match answer {
        Ok(None) => Outcome::Miss,
        Err(gave_up) => Outcome::GaveUp { limit: gave_up.limit.name(), best: None },
        Ok(Some(hit)) => Outcome::Hit(found(&prepared.scene(), &mut Basis::new(), hit)),
    }
}

/// Whether a ray was given up for a budget: not for what was lent to the call, which no budget makes good.
pub(crate) fn out_of_budget<S>(answer: &Answer<S>) -> bool {
    let lent = [Limit::Hits, Limit::Scratch, Limit::Line, Limit::Memory, Limit::Slot];
    answer.as_ref().is_err_and(|gave_up| !lent.contains(&gave_up.limit))
}

/// What is true of a ray, found out as far as it is asked for.
pub(crate) struct Truth<'c> {
    case: &'c Case,
    ray: RayLine,
    /// How large other coordinates are that take part.
    at_hand: f64,
    quick: Sure,
    sure: OnceCell<Sure>,
    clear: OnceCell<bool>,
}

/// Parts that the oracle looks at of a surface. A pole met head on takes up to 2,000; rays that take more lie along a surface, and
/// nothing is known of them.
const DOMAINS: usize = 2500;

/// Parts of surfaces that the quick oracle leaves open, beyond which the other one is not asked, which would leave them open too.
const MANY: usize = 100;

/// A verdict with margins as lengths.
struct Sure {
    verdict: Verdict,
    /// 0 if what could not be resolved leaves the answer open.
    margin: f64,
}

impl Sure {
    fn of<R: Real>(model: &Model, ray: &RayLine) -> Self {
        let oracle = OracleIn::<R>::new(model).within(DOMAINS);
        let verdict = oracle.trace(ray.origin, ray.direction, ray.t_min, ray.t_max);
        let margin = verdict.margin * oracle.diagonal();
        Sure { verdict, margin }
    }
}

impl<'c> Truth<'c> {
    pub(crate) fn new(case: &'c Case, ray: &RayLine, at_hand: f64) -> Self {
        Truth {
            case,
            ray: *ray,
            at_hand,
            quick: Sure::of::<f64>(&case.model, ray),
            sure: OnceCell::new(),
            clear: OnceCell::new(),
        }
    }

    fn sure(&self) -> &Sure {
        self.sure.get_or_init(|| Sure::of::<DoubleDouble>(&self.case.model, &self.ray))
    }

    fn exact(&self, surface: &ModelSurface) -> f64 {
        Exactness::of(self.case.precision).length(surface, self.at_hand)
    }

    /// Shares of a surface's size: the margin from which on an answer is judged, that from which on there has to be one, and how
    /// far right answers may be off across the surface, and along the ray at most.
    fn shares(&self) -> [f64; 4] {
        match self.case.precision {
            Precision::F64 => [1e-12, 1e-9, 1e-9, 1e-4],
            // Where three roots all but fall together, a third of the digits is all that rounding leaves.
            Precision::F32 => [2e-5, 1e-4, 5e-6, 5e-3],
        }
    }

    /// The surfaces that an answer and the truth name.
    fn concerned(&self, answer: &Outcome, verdict: &Verdict) -> impl Iterator<Item = &'c ModelSurface> {
        let answered = if let Outcome::Hit(found) = answer { Some(found.surface) } else { None };
        let case = self.case;
        answered.into_iter().chain(verdict.roots.first().map(|root| root.surface)).map(|k| &case.model.surfaces[k])
    }

    /// Whether an answer is not what a verdict says, however sure. One that was given up is not wrong.
    fn is_wrong(&self, answer: &Outcome, verdict: &Verdict) -> bool {
        match (answer, verdict.roots.first()) {
            (Outcome::Miss, None) => false,
            (Outcome::Hit(found), Some(root)) => {
                let [.., across, most] = self.shares();
                let largest =
                    |of: &dyn Fn(&ModelSurface) -> f64| self.concerned(answer, verdict).map(of).fold(0.0, f64::max);
                let across = largest(&|surface| (across * size(surface)).max(4.0 * self.exact(surface)));
                let most = largest(&|surface| most * size(surface));
                let [x, y, z] = self.ray.direction;
                let rounding = 2.0 * Exactness::of(self.case.precision).of_t(root.t, &self.ray);
                let allowed = (across / root.cosine).min(most.max(across)) + rounding;
                let off = (found.t - root.t).abs() * x.hypot(y).hypot(z);
                off.is_nan() || off > allowed
            }
            (Outcome::Miss, Some(_)) | (Outcome::Hit(_), None) => true,
            _ => false,
        }
    }

    /// The least margin by which a verdict has to be sure to convict this answer.
    fn least_margin(&self, answer: &Outcome, verdict: &Verdict) -> f64 {
        let [judged, ..] = self.shares();
        let least = |surface: &ModelSurface| (judged * size(surface)).max(4.0 * self.exact(surface));
        self.concerned(answer, verdict).map(least).fold(0.0, f64::max)
    }

    /// An answer is right, was given up, or nothing is sure.
    pub(crate) fn holds(&self, name: &str, answer: &Outcome) {
        if !self.is_wrong(answer, &self.quick.verdict) || !self.can_be_judged() {
            return;
        }
        let Sure { verdict, margin } = self.sure();
        assert!(
            !(*margin >= self.least_margin(answer, verdict) && self.is_wrong(answer, verdict)),
            "{name} answers {answer:?}, the oracle {:?} of {}, by a margin of {margin:e}; case {:?}, ray {:?}, surfaces {:?}",
            verdict.roots.first(),
            verdict.roots.len(),
            (self.case.precision, self.case.numbers),
            self.ray,
            self.case.model.surfaces
        );
    }

    /// Whether the ray is as clear of each surface, seen alone, as default budgets have to suffice for.
    pub(crate) fn is_clear(&self) -> bool {
        let [_, clear, ..] = self.shares();
        let of = |surface: &ModelSurface| {
            let model = Model::numbered(vec![surface.clone()]);
            let margin = Sure::of::<DoubleDouble>(&model, &self.ray).margin;
            margin >= (clear * size(surface)).max(4.0 * self.exact(surface))
        };
        *self.clear.get_or_init(|| self.can_be_judged() && self.case.model.surfaces.iter().all(of))
    }

    /// Whether the oracle in double-double can tell more than how long it takes.
    fn can_be_judged(&self) -> bool {
        // Along a line that is all of a surface the oracle has roots each of which blurs into the next, and takes them for one,
        // which may lie outside the interval.
        self.quick.verdict.unresolved <= MANY && self.case.model.surfaces.iter().all(has_area)
    }

    /// No ray that is clear is given up for a default budget, nor one that the original of the method answers.
    pub(crate) fn not_given_up<S>(&self, name: &str, answer: &Answer<S>, answered: bool) {
        let Err(GaveUp { limit, .. }) = answer else { return };
        if !out_of_budget(answer) || !(answered || self.is_clear()) {
            return;
        }
        panic!(
            "{name} gives up for {limit:?} under default budgets of a ray that {}; the oracle {:?}; case {:?}, ray {:?}, surfaces {:?}",
            if answered { "its original answers" } else { "is clear" },
            self.sure().verdict,
            (self.case.precision, self.case.numbers),
            self.ray,
            self.case.model.surfaces
        );
    }
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
