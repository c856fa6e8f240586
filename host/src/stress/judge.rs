//! Answers to the rays of a case, held against what is true of them.

use super::case::Case;
use super::truth;
use crate::judge::{Agreement, Allowance, Truth, allowance};
use crate::lower::at_hand;
use crate::scanline::Outcome;
use crate::scene::rays::RayLine;
use crate::scene::trace::Precision;

/// What answers to a case are held against.
#[derive(Debug)]
pub struct Judge<'c> {
    pub(super) case: &'c Case,
    pub(super) rays: &'c [RayLine],
    pub(super) truths: Vec<Truth>,
    precision: Precision,
    /// The model's; of a model without extent 1.
    diagonal: f64,
    /// That of each surface.
    sizes: Vec<f64>,
    /// By how much, as a share of its size, rounding of the coordinates at hand may move a surface: at most sixteen units in the
    /// last place of numbers up to twice as large.
    rounding: f64,
}

impl<'c> Judge<'c> {
    /// By what is true of each ray: see [`truth::of_case`].
    pub fn new(case: &'c Case, rays: &'c [RayLine], precision: Precision) -> Self {
        Judge::by(case, rays, truth::of_case(case, rays), precision)
    }

    /// By these truths, one for each ray.
    pub fn by(case: &'c Case, rays: &'c [RayLine], truths: Vec<Truth>, precision: Precision) -> Self {
        let diagonal = case.model.control_box().map_or(0.0, |bounds| bounds.diagonal());
        let diagonal = if diagonal > 0.0 { diagonal } else { 1.0 };
        let surfaces = &case.model.surfaces;
        let sizes: Vec<f64> = surfaces.iter().map(|surface| truth::size(surface, &case.model)).collect();
        let coordinates = at_hand(&case.model, precision);
        let shares = coordinates.iter().zip(&sizes).map(|(largest, size)| largest / size);
        let rounding = 32.0 * unit(precision) * shares.fold(0.0, f64::max);
        Judge { case, rays, truths, precision, diagonal, sizes, rounding }
    }

    /// What is true of a ray, by its place; `None` if there is no such ray.
    pub fn truth(&self, place: usize) -> Option<&Truth> {
        self.truths.get(place)
    }

    /// The model's diagonal.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// The size of what a ray hits, in which margin and allowance are measured.
    pub fn size(&self, truth: &Truth) -> f64 {
        if truth.size > 0.0 { truth.size } else { self.diagonal }
    }

    /// The size of a surface.
    pub(super) fn size_of(&self, surface: usize) -> f64 {
        self.sizes.get(surface).copied().unwrap_or(self.diagonal)
    }

    /// Whether an answer to the ray in this place is wrong, and the truth sure enough to say so. One that was given up, or
    /// refused, is not wrong; nor one that is off across the ray by no more than `blur`, a length: of a small model far from the
    /// origin the tolerance, a share of its coordinates, is more than the allowance, a share of its size.
    pub fn is_lost(&self, place: usize, outcome: &Outcome, blur: f64) -> bool {
        let (Some(truth), Some(ray)) = (self.truths.get(place), self.rays.get(place)) else {
            return false;
        };
        let Allowance { across, most } = self.allowance(truth, ray);
        let size = self.size(truth);
        let allowance = Allowance { across: across.max(blur / size), most };
        let mut agreement = Agreement::default();
        agreement.add(outcome, truth, ray.direction, size, &allowance);
        self.is_judged(truth, ray) && agreement.wrong + agreement.missed + agreement.phantom > 0
    }

    /// Whether the truth of a ray is far enough from any other: also from what the rounding of coordinates as large as the ray's
    /// makes of it.
    pub(super) fn is_judged(&self, truth: &Truth, ray: &RayLine) -> bool {
        // A margin may be a share of the size of any surface that is nearly hit. What is clear by far is judged all the same.
        let rounding = self.slack(0.0, ray) / self.sizes.iter().copied().fold(self.diagonal, f64::min);
        let least = truth::least_margin(self.precision) + rounding;
        !truth.open && truth.margin >= least.min(truth::clear_margin(self.precision)) + self.rounding
    }

    /// Whether it is so far from any other that there is no excuse for giving the ray up.
    pub(super) fn is_clear(&self, truth: &Truth) -> bool {
        !truth.open && truth.margin >= truth::clear_margin(self.precision) + self.rounding
    }

    /// By how much, as a length, rounding can move a point of a ray: of t to the number type, and of the coordinates there.
    pub(super) fn slack(&self, t: f64, ray: &RayLine) -> f64 {
        let [x, y, z] = ray.direction;
        let place = [0, 1, 2].map(|k| (ray.origin[k] + t * ray.direction[k]).abs());
        let largest = place.into_iter().fold(0.0, f64::max);
        unit(self.precision) * (4.0 * t.abs() * x.hypot(y).hypot(z) + 16.0 * largest)
    }

    /// How far a right answer may be off along a ray, as shares of [`Judge::size`].
    pub fn allowance(&self, truth: &Truth, ray: &RayLine) -> Allowance {
        let Allowance { across, most } = allowance(self.precision);
        let slack = truth.closest.map_or(0.0, |t| self.slack(t, ray)) / self.size(truth);
        // Where three roots all but fall together, a third of the digits is all that rounding leaves.
        Allowance { across: across + slack, most: f64::max(most, unit(self.precision).cbrt()) + slack }
    }

    pub(super) fn agreement(&self, outcome: &Outcome, truth: &Truth, ray: &RayLine) -> Agreement {
        let mut agreement = Agreement::default();
        agreement.add(outcome, truth, ray.direction, self.size(truth), &self.allowance(truth, ray));
        agreement
    }

    /// Judged rays that are answered in one way and in another: a hit and a miss, or other t than the allowance lets pass.
    /// Those that either gave up do not count.
    pub(super) fn differences(&self, outcomes: &[Outcome], others: &[Outcome]) -> u64 {
        let pairs = outcomes.iter().zip(others).zip(self.truths.iter().zip(self.rays));
        let differ = pairs.filter(|((outcome, other), (truth, ray))| {
            if !self.is_judged(truth, ray) {
                return false;
            }
            let (closest, size) = match other {
                Outcome::Hit(found) => (Some(found.t), self.size_of(found.surface)),
                Outcome::Miss => (None, 0.0),
                _ => return false,
            };
            let other = Truth { closest, open: false, size, ..**truth };
            let agreement = self.agreement(outcome, &other, ray);
            agreement.wrong + agreement.missed + agreement.phantom > 0
        });
        differ.count() as u64
    }
}

/// The precision's unit of rounding.
fn unit(precision: Precision) -> f64 {
    match precision {
        Precision::F64 => f64::EPSILON,
        Precision::F32 => f64::from(f32::EPSILON),
    }
}
