//! What the oracle says of a method's answers, ray by ray.

use std::time::Instant;

use patchray::ray::Incidence;
use rayon::prelude::*;
use serde::Serialize;

use crate::oracle::{Oracle, Verdict};
use crate::scanline::{Found, Outcome, row};
use crate::scene::camera::View;
use crate::scene::rays::RayLine;
use crate::scene::trace::Precision;

/// How far a right answer may be off along the ray, as shares of a size: the model's diagonal, or that of the surface hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allowance {
    /// Off across the surface: along the ray it is this over |cos(d, n)|, n being the normal at the hit.
    pub across: f64,
    /// The most along the ray. Where the ray all but grazes, 1/|cos| would allow anything.
    pub most: f64,
}

/// The allowance of each precision. On the common view at 512 × 512, the answers on the right sheet are off by at most what
/// the third column says, and the nearest one on another sheet by 2.4e-5, as `across` measures: in f32, 1e-4 would count ten
/// of those as right.
///
/// | precision | across | seen | most |
/// | --- | --- | --- | --- |
/// | f64 | 1e-9 | 1.7e-14 | 1e-4 |
/// | f32 | 5e-6 | 8.6e-7 | 1e-3 |
pub fn allowance(precision: Precision) -> Allowance {
    match precision {
        Precision::F64 => Allowance { across: 1e-9, most: 1e-4 },
        Precision::F32 => Allowance { across: 5e-6, most: 1e-3 },
    }
}

/// What the oracle found on a ray, as much as judging takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// The closest root.
    pub closest: Option<f64>,
    /// The number of roots.
    pub roots: usize,
    /// Whether an unresolved part leaves the answer open.
    pub open: bool,
    /// How far the ray may be displaced before the answer changes kind, as a share of the size of what it hits or nearly hits:
    /// see [`Verdict::margin`].
    pub margin: f64,
    /// The size of what the closest root lies on; 0 where nobody said, and the model's diagonal is meant.
    pub size: f64,
    /// Where the ray enters and leaves within so little depth that an answer may take it for a graze: the root at which it
    /// leaves. An answer that says so may name any point from the closest root up to there.
    pub leaves: Option<f64>,
    /// The cosine between ray and normal at the closest root; `None` where it is not known, and the normal of an answer is asked.
    pub cosine: Option<f64>,
    /// Whether the ray lies in the surface from the closest root on: that root is then as sharp as the surface's outline, and
    /// its angle to the surface excuses nothing.
    pub contact: bool,
}

/// Where a ray that lies in a surface crosses the outline, the angle between them has a sine of a tenth at least.
const OUTLINE: f64 = 0.1;

impl From<&Verdict> for Truth {
    fn from(verdict: &Verdict) -> Self {
        Truth {
            closest: verdict.roots.first().map(|root| root.t),
            roots: verdict.roots.len(),
            open: verdict.unresolved > 0 && verdict.margin == 0.0,
            margin: verdict.margin,
            size: verdict.roots.first().map_or(0.0, |root| root.unit),
            cosine: verdict.roots.first().map(|root| root.cosine),
            ..Truth::default()
        }
    }
}

/// What the oracle found in a picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OracleStats {
    /// Rays.
    pub rays: u64,
    /// Rays that hit.
    pub hit_rays: u64,
    /// Roots of all rays.
    pub roots: u64,
    /// Rays whose answer the oracle leaves open.
    pub open: u64,
    /// Summed over threads.
    pub seconds: f64,
}

/// What the oracle says of each of the picture's rays, on rayon's current threads; `step` is called as often as it has scan
/// lines.
pub fn ask(oracle: &Oracle, picture: &View, step: impl Fn() + Sync) -> (Vec<Truth>, OracleStats) {
    let lines: Vec<(Vec<Truth>, f64)> = (0..picture.scan_lines())
        .into_par_iter()
        .map(|line| {
            let begin = Instant::now();
            let truth = |ray: &RayLine| Truth::from(&oracle.trace(ray.origin, ray.direction, ray.t_min, ray.t_max));
            let truths = row(picture, line).iter().map(truth).collect();
            step();
            (truths, begin.elapsed().as_secs_f64())
        })
        .collect();
    let seconds = lines.iter().map(|(_, seconds)| seconds).sum();
    let truths: Vec<Truth> = lines.into_iter().flat_map(|(truths, _)| truths).collect();
    let stats = OracleStats {
        rays: truths.len() as u64,
        hit_rays: truths.iter().filter(|truth| truth.closest.is_some()).count() as u64,
        roots: truths.iter().map(|truth| truth.roots as u64).sum(),
        open: truths.iter().filter(|truth| truth.open).count() as u64,
        seconds,
    };
    (truths, stats)
}

/// How often a method agreed with the oracle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Agreement {
    /// The same hit, or none in both.
    pub right: u64,
    /// Another sheet, or t off by more than the allowance.
    pub wrong: u64,
    /// No hit where there is one.
    pub missed: u64,
    /// A hit where there is none.
    pub phantom: u64,
    /// Neither hit nor miss: the method gave the ray up, or refused it.
    pub unanswered: u64,
    /// Unlike the oracle, where the oracle could not resolve all it saw.
    pub undecided: u64,
}

impl Agreement {
    /// The agreement over a picture, ray by ray.
    pub fn of(outcomes: &[Outcome], truths: &[Truth], picture: &View, diagonal: f64, precision: Precision) -> Self {
        let (mut agreement, allowance) = (Agreement::default(), allowance(precision));
        let directions = (0..picture.scan_lines()).flat_map(|line| row(picture, line)).map(|ray| ray.direction);
        for ((outcome, truth), direction) in outcomes.iter().zip(truths).zip(directions) {
            agreement.add(outcome, truth, direction, diagonal, &allowance);
        }
        agreement
    }

    /// Adds the answer to the ray of this `direction`; the allowance is in shares of `size`.
    pub fn add(&mut self, outcome: &Outcome, truth: &Truth, direction: [f64; 3], size: f64, allowance: &Allowance) {
        let near = |found, t| is_near(found, t, truth, direction, size, allowance);
        let count = match (outcome, truth.closest) {
            (Outcome::GaveUp { .. } | Outcome::Refused(_) | Outcome::Invalid, _) => &mut self.unanswered,
            (Outcome::Miss, None) => &mut self.right,
            (Outcome::Hit(found), Some(t)) if near(found, t) => &mut self.right,
            _ if truth.open => &mut self.undecided,
            (Outcome::Miss, Some(_)) => &mut self.missed,
            (Outcome::Hit(_), None) => &mut self.phantom,
            (Outcome::Hit(_), Some(_)) => &mut self.wrong,
        };
        *count += 1;
    }
}

fn is_near(found: &Found, t: f64, truth: &Truth, direction: [f64; 3], size: f64, allowance: &Allowance) -> bool {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let speed = dot(direction, direction).sqrt();
    // Where there is no normal, nothing excuses more than straight on.
    let of_answer = || found.normal.shown().map_or(1.0, |normal| dot(normal, direction).abs() / speed);
    let cosine = truth.cosine.filter(|&cosine| cosine > 0.0).unwrap_or_else(of_answer);
    let cosine = if truth.contact { OUTLINE } else { cosine };
    let allowed = (allowance.across / cosine).min(allowance.most) * size;
    let last = truth.leaves.filter(|_| found.incidence != Incidence::Crossing).unwrap_or(t);
    (t - found.t) * speed <= allowed && (found.t - last) * speed <= allowed
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::scanline::Normal;

    fn hit(t: f64, normal: Option<[f64; 3]>) -> Outcome {
        let normal = normal.map_or(Normal::Nowhere, Normal::There);
        Outcome::Hit(Found { t, u: 0.5, v: 0.5, surface: 0, normal, incidence: Incidence::Crossing })
    }

    fn judged(outcome: Outcome, closest: Option<f64>, open: bool) -> Agreement {
        let mut agreement = Agreement::default();
        let truth = Truth { closest, roots: usize::from(closest.is_some()), open, margin: 1.0, ..Truth::default() };
        agreement.add(&outcome, &truth, [0.0, 0.0, 2.0], 10.0, &allowance(Precision::F64));
        agreement
    }

    #[test]
    fn each_answer_is_one_kind() {
        let none = Agreement::default();
        assert_eq!(judged(Outcome::Miss, None, false), Agreement { right: 1, ..none });
        assert_eq!(judged(Outcome::Miss, Some(1.0), false), Agreement { missed: 1, ..none });
        assert_eq!(judged(hit(1.0, None), None, false), Agreement { phantom: 1, ..none });
        assert_eq!(judged(hit(1.0, None), None, true), Agreement { undecided: 1, ..none });
        assert_eq!(judged(hit(2.0, None), Some(1.0), false), Agreement { wrong: 1, ..none });
        let gave_up = Outcome::GaveUp { limit: "patches", best: None };
        assert_eq!(judged(gave_up, None, false), Agreement { unanswered: 1, ..none });
    }

    #[test]
    fn a_graze_is_right_up_to_where_the_ray_leaves_and_contact_where_it_begins() {
        let up = Some([0.0, 0.0, 1.0]);
        let right = |outcome: Outcome, truth: Truth| {
            let mut agreement = Agreement::default();
            agreement.add(&outcome, &truth, [0.0, 0.0, 2.0], 10.0, &allowance(Precision::F64));
            agreement.right == 1
        };
        let graze = |t: f64| {
            Outcome::Hit(Found {
                t,
                u: 0.5,
                v: 0.5,
                surface: 0,
                normal: Normal::There([0.0, 0.0, 1.0]),
                incidence: Incidence::Grazing,
            })
        };
        let thin = Truth { closest: Some(1.0), leaves: Some(1.1), margin: 1.0, ..Truth::default() };
        assert!(right(graze(1.05), thin) && right(graze(1.1), thin) && right(hit(1.0, up), thin));
        assert!(!right(graze(1.2), thin) && !right(graze(0.9), thin) && !right(hit(1.1, up), thin));
        assert!(!right(graze(f64::NAN), thin));
        let along = Truth { closest: Some(1.0), contact: true, margin: 1.0, ..Truth::default() };
        let flat = Some([0.0, 1.0, 0.0]);
        assert!(right(hit(1.0 + 4e-8, flat), along) && !right(hit(1.0 + 6e-8, flat), along));
    }

    #[test]
    fn the_allowance_grows_toward_the_silhouette_up_to_its_most() {
        // Half a unit of t is a length of 1, that is 0.1 of the diagonal.
        let off = |share: f64| 1.0 + 5.0 * share;
        let up = Some([0.0, 0.0, 1.0]);
        assert_eq!(judged(hit(off(0.9e-9), up), Some(1.0), false).right, 1);
        assert_eq!(judged(hit(off(1.2e-9), up), Some(1.0), false).wrong, 1);
        let slanted = Some([0.0, 0.999_949_998_749_937_5, 0.01]);
        assert_eq!(judged(hit(off(0.9e-7), slanted), Some(1.0), false).right, 1);
        assert_eq!(judged(hit(off(1.2e-7), slanted), Some(1.0), false).wrong, 1);
        let grazed = Some([0.0, 1.0, 0.0]);
        assert_eq!(judged(hit(off(0.9e-4), grazed), Some(1.0), false).right, 1);
        assert_eq!(judged(hit(off(1.2e-4), grazed), Some(1.0), false).wrong, 1);
    }
}
