//! Answers held against the oracle.
//!
//! An answer counts only where the oracle is sure of it by a margin: what a ray moved by a rounding would answer otherwise is no
//! fault of the method. The quick oracle is asked first; it takes the one in double-double to convict.

use crate::claims;
use crate::common::{Kind, Prepared};
use crate::input::Case;
use crate::lane::Answer;
use patchray::bernstein::Basis;
use patchray::scalar::Scalar;
use patchray_host::judge::Truth;
use patchray_host::oracle::Oracle;
use patchray_host::scanline::{Outcome, found};
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;
use patchray_host::stress::case::Case as StressCase;
use patchray_host::stress::judge::Judge;

/// An answer as the harness has it.
pub(crate) fn outcome<P: Kind>(prepared: &Prepared<P>, answer: &Answer<P::Scalar>) -> Outcome {
    match answer {
        Ok(None) => Outcome::Miss,
        Err(gave_up) => Outcome::GaveUp { limit: gave_up.limit.name(), best: None },
        Ok(Some(hit)) => Outcome::Hit(found(&prepared.scene(), &mut Basis::new(), hit)),
    }
}

/// No answer is lost: where the oracle is sure of a ray, each is as it says, or was given up. `answers` are named.
pub(crate) fn none_lost(case: &Case, ray: &RayLine, answers: &[(String, Outcome)]) {
    let stress = StressCase::of_rays(case.model.clone(), vec![*ray]);
    let verdict = Oracle::new(&case.model).trace(ray.origin, ray.direction, ray.t_min, ray.t_max);
    let rays = [*ray];
    let quick = Judge::by(&stress, &rays, vec![Truth::from(&verdict)], case.precision);
    let blur = case.model.surfaces.iter().map(|surface| blur(surface, case)).fold(0.0, f64::max);
    if !answers.iter().any(|(_, outcome)| quick.is_lost(0, outcome, blur)) {
        return;
    }
    // Along a line that is all of a surface the oracle has roots each of which blurs into the next, and takes them for one, which
    // may lie outside the interval.
    if case.model.surfaces.iter().any(|surface| !has_area(surface)) {
        return;
    }
    let sure = Judge::new(&stress, &rays, case.precision);
    // What moving the ray by as much as roots may lie off it changes is no loss: in `f32`, of weights far apart, that is more than
    // the judge's least margin.
    let truth = sure.truth(0).copied().unwrap_or_default();
    let margin = truth.margin * sure.diagonal();
    if blur > margin {
        return;
    }
    // At a shallow angle the same moves the root along the ray by more than the judge lets pass of any.
    let most = sure.allowance(&truth, ray).most * sure.diagonal();
    if verdict.roots.first().is_some_and(|root| blur > most * root.cosine) {
        return;
    }
    for (name, outcome) in answers {
        assert!(
            !sure.is_lost(0, outcome, blur),
            "{name} answers {outcome:?}, the oracle {:?}; case {:?}, ray {ray:?}, surfaces {:?}",
            truth,
            (case.precision, case.numbers),
            case.model.surfaces
        );
    }
}

/// See [`claims::blur`].
fn blur(surface: &ModelSurface, case: &Case) -> f64 {
    let (unit, tolerance) = match case.precision {
        Precision::F64 => (f64::EPSILON, f64::TOLERANCE),
        Precision::F32 => (f64::from(f32::EPSILON), f64::from(f32::TOLERANCE)),
    };
    claims::blur(surface, claims::largest_coordinate(case), unit, tolerance)
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

/// Whether two answers to a ray say the same, as far as it can be told without the oracle; one that was given up says nothing.
pub(crate) fn alike(case: &Case, one: &Outcome, other: &Outcome) -> bool {
    match (one, other) {
        (Outcome::GaveUp { .. }, _) | (_, Outcome::GaveUp { .. }) => true,
        (Outcome::Hit(one), Outcome::Hit(other)) => {
            let near = match case.precision {
                Precision::F64 => 1e-9,
                Precision::F32 => 1e-5,
            };
            (one.t - other.t).abs() <= near * one.t.abs().max(other.t.abs())
        }
        (Outcome::Miss, Outcome::Miss) => true,
        _ => false,
    }
}
