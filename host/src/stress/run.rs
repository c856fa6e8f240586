//! Traces the cases of a family by every method, and holds each answer against the truth.

use std::collections::BTreeMap;

use patchray::limits::Work;
use patchray::ray::Incidence;
use serde::{Deserialize, Serialize};

use super::case::{Case, Draw, Family, Shot};
use super::judge::Judge;
use super::truth;
use crate::experiment::trace_picture;
use crate::lower::{LowerError, Stages};
use crate::prepared::Prepared;
use crate::scanline::{Outcome, Tally, steps};
use crate::scene::rays::RayLine;
use crate::scene::shapes::Random;
use crate::scene::trace::{Acceptance, Method, Precision};
use crate::settings::Settings;
use crate::viewed::{Viewed, Wishes};

/// What a method made of a family's rays.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Rays, of all cases that the method traces.
    pub rays: u64,
    /// Rays whose answer rounding may change: not judged.
    pub unjudged: u64,
    /// Judged, and right; a ray that is none, refused.
    pub right: u64,
    /// Judged: another sheet, or t off by more than the allowance.
    pub wrong: u64,
    /// Judged: no hit where there is one.
    pub missed: u64,
    /// Judged: a hit where there is none.
    pub phantom: u64,
    /// Refused by the kernel, although they are rays: t cannot be held by the number type.
    pub refused: u64,
    /// Given up, by limit; judged or not.
    pub gave_up: BTreeMap<String, u64>,
    /// Given up, although clear: by [`truth::clear_margin`].
    pub gave_up_clear: u64,
    /// Of a coherent method: judged rays that the original answers in another way.
    pub differ: Option<u64>,
    /// The same under the paper's rule of acceptance.
    pub differ_by_paper: Option<u64>,
    /// The largest distance between the surface's point at a hit's (u, v) and the ray's at its t, less what rounding of its
    /// coordinates and of the ray at hand leaves, as a share of the surface's size; of hits where the ray crosses the surface.
    pub residual: f64,
    /// The most Newton steps and clips that a ray took.
    pub steps: u64,
    /// The most that a ray may take by the stated worst case.
    pub most_steps: u64,
    /// Rays that did more than the stated worst case, in any counter.
    pub beyond: u64,
    /// Answers with a number that is NaN or infinite.
    pub not_finite: u64,
    /// Cases that could not be traced, and why.
    pub refused_cases: Vec<String>,
}

impl Score {
    /// Judged answers that are not right.
    pub fn lost(&self) -> u64 {
        self.wrong + self.missed + self.phantom
    }

    /// Rays given up.
    pub fn gave_up_in_all(&self) -> u64 {
        self.gave_up.values().sum()
    }

    /// The share of rays that are not judged.
    pub fn unjudged_share(&self) -> f64 {
        if self.rays == 0 { 0.0 } else { self.unjudged as f64 / self.rays as f64 }
    }
}

/// A family's score by one method in one precision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The family's name.
    pub family: String,
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// What became of its rays.
    pub score: Score,
}

/// How a family is run.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'s> {
    /// Limits and acceptance; its method and precision are not looked at.
    pub settings: &'s Settings,
    /// What the cases are drawn from.
    pub seed: u64,
    /// About how many rays a case has, or a family has whose cases share them.
    pub rays: usize,
}

/// The methods, each original before those that are held against it.
const METHODS: [Method; 6] = [
    Method::Newton,
    Method::NewtonCoherent,
    Method::NewtonPredicted,
    Method::Clipping,
    Method::ClippingCoherent,
    Method::ClippingPredicted,
];

/// The method that an improved one is held against.
fn original(method: Method) -> Option<Method> {
    match method {
        Method::NewtonCoherent | Method::NewtonPredicted => Some(Method::Newton),
        Method::ClippingCoherent | Method::ClippingPredicted => Some(Method::Clipping),
        Method::Newton | Method::Clipping => None,
    }
}

/// Runs a family in one precision by the methods that `wanted` admits and that can trace it; rayon's current threads ask the
/// oracle.
pub fn family(family: &Family, precision: Precision, plan: &Plan, wanted: impl Fn(Method) -> bool) -> Vec<Row> {
    // Of its own, so that a family's rays do not depend on which others are run.
    let seed = family.name.bytes().fold(plan.seed, |seed, byte| Random(seed ^ u64::from(byte)).bits());
    let mut draw = Draw { random: Random(seed), rays: plan.rays, precision };
    let cases: Vec<Case> = (family.cases)(&mut draw).iter().map(|case| truth::in_precision(case, precision)).collect();
    let mut scores: BTreeMap<usize, Score> = BTreeMap::new();
    for case in &cases {
        let rays = truth::rays_of(case);
        let judge = Judge::new(case, &rays, precision);
        let mut originals: Vec<(Method, Vec<Outcome>)> = Vec::new();
        for (place, &method) in METHODS.iter().enumerate() {
            let needed = METHODS.iter().any(|&other| wanted(other) && original(other) == Some(method));
            if !(wanted(method) || needed) || method.needs_view() && matches!(case.shot, Shot::Rays(_)) {
                continue;
            }
            let score = scores.entry(place).or_default();
            let settings = Settings { method, precision, ..*plan.settings };
            let answers = match trace(case, &rays, &settings) {
                Ok(answers) => answers,
                Err(error) => {
                    score.refused_cases.push(error.to_string());
                    continue;
                }
            };
            add(&judge, &answers, score);
            let by_original = original(method)
                .and_then(|original| originals.iter().find(|(other, _)| *other == original))
                .map(|(_, outcomes)| outcomes);
            if let Some(by_original) = by_original {
                *score.differ.get_or_insert(0) += judge.differences(&answers.outcomes, by_original);
                let settings = Settings { acceptance: Acceptance::Paper, ..settings };
                if let Ok(answers) = trace(case, &rays, &settings) {
                    *score.differ_by_paper.get_or_insert(0) += judge.differences(&answers.outcomes, by_original);
                }
            }
            originals.push((method, answers.outcomes));
        }
    }
    let rows = scores.into_iter().filter(|(place, _)| wanted(METHODS[*place]));
    rows.map(|(place, score)| Row { family: family.name.to_owned(), method: METHODS[place], precision, score })
        .collect()
}

/// What a method answered, and what each ray took.
struct Answers {
    outcomes: Vec<Outcome>,
    /// Newton steps and clips, per ray.
    steps: Vec<u64>,
    /// Rays that did more than the stated worst case.
    beyond: u64,
    most_steps: u64,
}

/// The steps of each ray.
fn steps_of(each: &[Work]) -> Vec<u64> {
    each.iter().map(|each| u64::from(steps(each))).collect()
}

fn trace(case: &Case, rays: &[RayLine], settings: &Settings) -> Result<Answers, LowerError> {
    let mut outcomes = Vec::with_capacity(rays.len());
    match &case.shot {
        Shot::Rays(_) => {
            let prepared = Prepared::build(&case.model, Stages::of(settings.method), settings)?;
            let worst = prepared.worst_case(settings);
            let tracer = prepared.tracer(settings);
            let mut lane = tracer.lane();
            let (mut steps, mut beyond) = (Vec::new(), 0);
            for line in rays.chunk_by(|a, b| a.scan_line == b.scan_line) {
                for (place, ray) in line.iter().enumerate() {
                    let mut tally = Tally { each: Some(Vec::new()), ..Tally::default() };
                    lane.trace(std::slice::from_ref(ray), place > 0, &mut outcomes, &mut tally);
                    let over = tally.work.iter().zip(worst.counts()).any(|(&did, may)| did > u64::from(may));
                    beyond += u64::from(over);
                    // A ray that is refused is not traced.
                    steps.push(steps_of(tally.each.as_deref().unwrap_or_default()).first().copied().unwrap_or(0));
                }
            }
            Ok(Answers { outcomes, steps, beyond, most_steps: most_steps(&worst) })
        }
        Shot::Picture(view) => {
            let mut viewed = Viewed::build(&case.model, settings, view, Wishes::PRIMARY)?;
            let worst = viewed.worst_case();
            let (tracer, _) = viewed.tracer()?;
            let mut lane = tracer.lane();
            let mut tally = Tally { each: Some(Vec::new()), ..Tally::default() };
            trace_picture(lane.as_mut(), view, &mut tally, |line| outcomes.extend_from_slice(line));
            let steps = steps_of(tally.each.as_deref().unwrap_or_default());
            let most_steps = most_steps(&worst);
            let beyond = steps.iter().filter(|&&steps| steps > most_steps).count() as u64;
            Ok(Answers { outcomes, steps, beyond, most_steps })
        }
    }
}

fn most_steps(worst: &Work) -> u64 {
    u64::from(worst.newton_steps) + u64::from(worst.clip_steps)
}

/// Adds what became of a case's rays.
fn add(judge: &Judge, answers: &Answers, score: &mut Score) {
    score.rays += answers.outcomes.len() as u64;
    score.beyond += answers.beyond;
    score.most_steps = score.most_steps.max(answers.most_steps);
    score.steps = answers.steps.iter().copied().fold(score.steps, u64::max);
    for ((outcome, truth), ray) in answers.outcomes.iter().zip(&judge.truths).zip(judge.rays) {
        if let Outcome::GaveUp { limit, .. } = outcome {
            *score.gave_up.entry((*limit).to_owned()).or_default() += 1;
            score.gave_up_clear += u64::from(judge.is_clear(truth));
            continue;
        }
        if let Outcome::Refused(_) | Outcome::Invalid = outcome {
            *if truth::is_no_ray(ray) { &mut score.right } else { &mut score.refused } += 1;
            continue;
        }
        if truth::is_no_ray(ray) {
            score.wrong += 1;
            continue;
        }
        if let Outcome::Hit(found) = outcome {
            let numbers = [found.t, found.u, found.v];
            score.not_finite += u64::from(!numbers.iter().all(|x| x.is_finite()));
            if let Some(surface) =
                judge.case.model.surfaces.get(found.surface).filter(|_| found.incidence == Incidence::Crossing)
            {
                // What t cannot say any better is no fault of the answer.
                let off = truth::residual(surface, ray, found) - judge.slack(found.t, ray);
                score.residual = score.residual.max(off / judge.size_of(found.surface));
            }
        }
        if !judge.is_judged(truth, ray) {
            score.unjudged += 1;
            continue;
        }
        let agreement = judge.agreement(outcome, truth, ray);
        score.right += agreement.right;
        score.wrong += agreement.wrong;
        score.missed += agreement.missed;
        score.phantom += agreement.phantom;
    }
}
