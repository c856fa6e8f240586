//! How far a method's answers are off, ray by ray and in all.

use serde::{Deserialize, Serialize};

use super::truth::RayTruth;
use crate::judge::{Agreement, Allowance};
use crate::report::times::quantile;
use crate::scanline::Outcome;
use crate::scene::model::Model;
use crate::scene::rays::RayLine;

/// What an answer is, by the oracle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// No hit, rightly.
    Nothing,
    /// The closest hit, to the allowance.
    Right,
    /// The closest hit, but t is off by more than the allowance.
    Off,
    /// A hit, but another root is nearer to it than the closest is, or none is near: more than a hundredth of the diagonal
    /// away.
    OtherSheet,
    /// No hit where there is one.
    Missed,
    /// A hit where there is none.
    Phantom,
    /// Given up, or refused.
    GaveUp,
    /// Unlike the oracle, which leaves the answer open.
    Undecided,
}

impl Kind {
    /// Whether the answer is lost: not the closest hit, nor a miss where there is none.
    pub fn is_lost(self) -> bool {
        matches!(self, Kind::OtherSheet | Kind::Missed | Kind::Phantom | Kind::GaveUp)
    }

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Nothing => "right: no hit",
            Kind::Right => "right",
            Kind::Off => "off",
            Kind::OtherSheet => "other sheet",
            Kind::Missed => "missed",
            Kind::Phantom => "phantom",
            Kind::GaveUp => "gave up",
            Kind::Undecided => "undecided",
        }
    }
}

/// An answer, held against the oracle's. Lengths are shares of the model's diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// What it is.
    pub kind: Kind,
    /// How far the hit is off along the ray; `None` without a hit in both.
    pub error: Option<f64>,
    /// How far the point at the answer's (u, v) is from the point at its t; `None` without a hit.
    pub residual: Option<f64>,
}

/// How far from the closest root, as a share of the diagonal, a hit may be to count as that root: one farther off is a graze
/// of something before it, which the oracle sees pass by.
const FAR: f64 = 1e-2;

/// What answers are held against.
#[derive(Clone, Copy, Debug)]
pub struct Judge<'m> {
    /// The surfaces as their file has them.
    pub model: &'m Model,
    /// The model's diagonal.
    pub diagonal: f64,
    /// What counts as right.
    pub allowance: Allowance,
}

impl Judge<'_> {
    /// Judges the answer to a ray.
    pub fn judge(&self, outcome: &Outcome, ray: &RayLine, RayTruth { truth, roots }: &RayTruth) -> Judged {
        let mut agreement = Agreement::default();
        agreement.add(outcome, truth, ray.direction, self.diagonal, &self.allowance);
        let Outcome::Hit(found) = outcome else {
            let kind = match agreement {
                Agreement { right: 1, .. } => Kind::Nothing,
                Agreement { undecided: 1, .. } => Kind::Undecided,
                Agreement { missed: 1, .. } => Kind::Missed,
                _ => Kind::GaveUp,
            };
            return Judged { kind, error: None, residual: None };
        };
        let length = |vector: [f64; 3]| vector[0].hypot(vector[1]).hypot(vector[2]);
        let speed = length(ray.direction);
        let nearest = roots.iter().map(|t| (t - found.t).abs()).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        let kind = match agreement {
            Agreement { right: 1, .. } => Kind::Right,
            Agreement { undecided: 1, .. } => Kind::Undecided,
            Agreement { phantom: 1, .. } => Kind::Phantom,
            _ if nearest.is_some_and(|(place, off)| place == 0 && off * speed <= FAR * self.diagonal) => Kind::Off,
            _ => Kind::OtherSheet,
        };
        let error = truth.closest.map(|t| (found.t - t).abs() * speed / self.diagonal);
        let point = self.model.surfaces.get(found.surface).map(|surface| surface.point(found.u, found.v));
        let residual = point.map(|point| {
            length([0, 1, 2].map(|k| point[k] - (ray.origin[k] + found.t * ray.direction[k]))) / self.diagonal
        });
        Judged { kind, error, residual }
    }
}

/// How errors, or residuals, are spread. Shares of the model's diagonal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// How many there are.
    pub count: u64,
    /// The root of the mean of their squares.
    pub rms: f64,
    /// What half of them do not exceed.
    pub median: f64,
    /// What 99.9 % of them do not exceed.
    pub most: f64,
    /// The largest.
    pub max: f64,
    /// How many lie in each half of a decade: the first bin is below [`Spread::LEAST`], the next goes from there to √10
    /// times that, and so on; the last has all above.
    pub bins: Vec<u64>,
}

impl Spread {
    /// Where the second bin begins.
    pub const LEAST: f64 = 1e-18;

    /// How many bins there are: up to 1.
    pub const BINS: usize = 38;

    /// That of these numbers, none of which is negative; all 0 without any.
    pub fn of(numbers: &[f64]) -> Self {
        let mut bins = vec![0; Self::BINS];
        for &number in numbers {
            let place = if number < Self::LEAST { 0.0 } else { 1.0 + (2.0 * (number / Self::LEAST).log10()).floor() };
            bins[(place as usize).min(Self::BINS - 1)] += 1;
        }
        if numbers.is_empty() {
            return Spread { bins, ..Spread::default() };
        }
        let count = numbers.len() as f64;
        Spread {
            count: numbers.len() as u64,
            rms: (numbers.iter().map(|x| x * x).sum::<f64>() / count).sqrt(),
            median: quantile(numbers, 0.5),
            most: quantile(numbers, 0.999),
            max: numbers.iter().fold(0.0, |max, &x| if x > max { x } else { max }),
            bins,
        }
    }
}

#[cfg(test)]
mod tests {
    use patchray::ray::Incidence;

    use super::*;
    use crate::judge::{Truth, allowance};
    use crate::scanline::{Found, Normal};
    use crate::scene::model::ModelSurface;
    use crate::scene::trace::Precision;

    /// The sheet z = u v over the unit square, with one heavy corner.
    fn model() -> Model {
        let points = vec![[0., 0., 0., 1.], [0., 1., 0., 1.], [1., 0., 0., 1.], [1., 1., 1., 3.]];
        let surface = ModelSurface { number: 0, degree_u: 1, degree_v: 1, rational: true, points, knots: None };
        Model { surfaces: vec![surface] }
    }

    #[test]
    fn answers_are_told_apart() {
        let model = model();
        let judge = Judge { model: &model, diagonal: 3_f64.sqrt(), allowance: allowance(Precision::F64) };
        // At u = v = 1/2 the heavy corner has half of the weight.
        let ray = RayLine {
            origin: [2. / 3., 2. / 3., -1.0],
            direction: [0.0, 0.0, 1.0],
            t_min: 0.0,
            t_max: f64::INFINITY,
            scan_line: 0,
            valid: true,
        };
        let hit = |t| {
            Outcome::Hit(Found {
                t,
                u: 0.5,
                v: 0.5,
                surface: 0,
                normal: Normal::Nowhere,
                incidence: Incidence::Crossing,
            })
        };
        let truth = |roots: &[f64]| RayTruth {
            truth: Truth {
                closest: roots.first().copied(),
                roots: roots.len(),
                open: false,
                margin: 1.0,
                ..Truth::default()
            },
            roots: roots.to_vec(),
        };
        let judged = |outcome, roots: &[f64]| judge.judge(&outcome, &ray, &truth(roots));
        let right = judged(hit(1.5), &[1.5, 4.0]);
        assert_eq!((right.kind, right.error), (Kind::Right, Some(0.0)));
        assert!(right.residual.is_some_and(|residual| residual < 1e-15), "{right:?}");
        let off = judged(hit(1.5 + 3_f64.sqrt() / 1000.0), &[1.5, 4.0]);
        assert_eq!(off.kind, Kind::Off);
        assert!(
            (off.error.expect("both hit") - 1e-3).abs() < 1e-12 && (off.residual.expect("a hit") - 1e-3).abs() < 1e-12
        );
        assert_eq!(judged(hit(3.9), &[1.5, 4.0]).kind, Kind::OtherSheet);
        assert_eq!(judged(hit(1.4), &[1.5, 4.0]).kind, Kind::OtherSheet);
        assert_eq!(judged(hit(3.9), &[]).kind, Kind::Phantom);
        assert_eq!(judged(Outcome::Miss, &[]).kind, Kind::Nothing);
        assert_eq!(judged(Outcome::Miss, &[1.5]).kind, Kind::Missed);
        assert_eq!(judged(Outcome::GaveUp { limit: "patches", best: None }, &[1.5]).kind, Kind::GaveUp);
    }

    #[test]
    fn spreads() {
        let numbers: Vec<f64> = (0..1000).map(|k| if k == 7 { 3e-3 } else { 4e-17 }).collect();
        let spread = Spread::of(&numbers);
        assert_eq!((spread.count, spread.median, spread.max), (1000, 4e-17, 3e-3));
        assert!((spread.rms - 3e-3 / 1000_f64.sqrt()).abs() < 1e-12);
        // From 1e-17.5 to 1e-17 is the bin before.
        assert_eq!((spread.bins[4], spread.bins[1 + 30], spread.bins.len()), (999, 1, Spread::BINS));
        let ends = Spread::of(&[0.0, 5.0]);
        assert_eq!((ends.bins[0], ends.bins[Spread::BINS - 1]), (1, 1));
        assert_eq!(Spread::of(&[]).max, 0.0);
    }
}
