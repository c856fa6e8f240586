//! The paper's experiment: methods on a scene's rays, each by itself on one thread, all in turn.

use std::ops::Range;

use patchray::limits::Work;
use serde::Serialize;

use crate::judge::{Agreement, Truth};
use crate::lower::{LowerError, Stages};
use crate::prepared::Prepared;
use crate::report::times::Times;
use crate::scanline::{Lane, Outcome, Tally, Tracer, rays_of};
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::scene::rays::RayLine;
use crate::settings::Settings;
use crate::viewed::{Viewed, Wishes};

pub mod cost;
pub mod rays;
pub mod subject;

use subject::Subject;

/// A scene to measure methods on.
pub struct Experiment<'s> {
    /// Its surfaces.
    pub model: &'s Model,
    /// How to trace, but for what subjects say.
    pub settings: Settings,
    /// Called after each pass of a method.
    pub step: &'s (dyn Fn() + Sync),
}

/// What a method is measured on.
#[derive(Clone, Copy)]
pub enum Rays<'r> {
    /// Those of a picture.
    Picture(&'r View),
    /// Any, in scan lines.
    Lines(&'r [Vec<RayLine>]),
}

/// What was measured of a method.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// The method.
    pub subject: Subject,
    /// Its times, of intersecting alone.
    pub times: Times,
    /// Rays.
    pub rays: u64,
    /// Rays that hit.
    pub hit_rays: u64,
    /// Rays given up.
    pub gave_up: u64,
    /// The kernel's counters.
    pub counts: Counts,
    /// How many of the intersection points are more than the roots that there are on their ray, so that roots must have been found
    /// twice.
    pub found_twice: Option<u64>,
    /// What the oracle says of its answers.
    pub agreement: Option<Agreement>,
}

impl Run {
    /// By what share it takes less time than another that was measured with it.
    pub fn gain_over(&self, other: &Run) -> f64 {
        self.times.gain_over(&other.times)
    }
}

/// The kernel's counters, summed over rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Counts([u64; Work::COUNT]);

impl Counts {
    /// These counters by their names, and no others.
    #[cfg(test)]
    pub(crate) fn of_named(named: &[(&str, u64)]) -> Self {
        Counts(Work::NAMES.map(|name| named.iter().find(|(known, _)| *known == name).map_or(0, |&(_, count)| count)))
    }

    /// A counter by its name in [`Work`]; 0 for a name that there is not.
    pub fn of(&self, name: &str) -> u64 {
        Work::NAMES.iter().zip(self.0).find_map(|(&known, count)| (known == name).then_some(count)).unwrap_or(0)
    }
}

impl Serialize for Counts {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Work::NAMES.iter().zip(self.0))
    }
}

/// The parts of a pass that methods do in turn: so many that what else goes on in the machine meanwhile disturbs all methods
/// alike, and so few that a part is some thousand rays, beside which filling the caches anew is nothing.
const PARTS: u32 = 32;

impl Rays<'_> {
    /// How many scan lines there are.
    fn lines(&self) -> u32 {
        match self {
            Rays::Picture(picture) => picture.scan_lines(),
            Rays::Lines(lines) => lines.len() as u32,
        }
    }

    /// Traces some scan lines; `each` is given the outcomes of each.
    fn trace(&self, lane: &mut dyn Lane, lines: Range<u32>, tally: &mut Tally, mut each: impl FnMut(&[Outcome])) {
        let mut outcomes = Vec::new();
        for line in lines {
            outcomes.clear();
            match self {
                Rays::Picture(picture) => {
                    let samples = picture.scan_line(line);
                    lane.trace_line(&samples, &rays_of(picture, line, &samples), &mut outcomes, tally);
                }
                Rays::Lines(lines) => {
                    let line = lines.get(line as usize).map(Vec::as_slice).unwrap_or_default();
                    lane.trace(line, false, &mut outcomes, tally);
                }
            }
            each(&outcomes);
        }
    }
}

/// Traces a whole picture with a lane; `each` is given the outcomes of each scan line.
pub(crate) fn trace_picture(lane: &mut dyn Lane, picture: &View, tally: &mut Tally, each: impl FnMut(&[Outcome])) {
    Rays::Picture(picture).trace(lane, 0..picture.scan_lines(), tally, each);
}

/// How many points are more than the roots that there are on their ray.
pub(crate) fn found_twice(each: &[Work], truths: &[Truth]) -> u64 {
    let excess =
        |(each, truth): (&Work, &Truth)| u64::from(each.intersection_points).saturating_sub(truth.roots as u64);
    each.iter().zip(truths).filter(|(_, truth)| !truth.open).map(excess).sum()
}

impl Experiment<'_> {
    /// Measures each subject on its rays, as often as is said, and once before: answers are then judged by the `truths`, those of
    /// the first subject's picture, if there are any.
    ///
    /// # Errors
    /// As [`Prepared::build`] and [`Viewed::build`].
    pub fn measure(
        &self,
        subjects: &[(Subject, Rays<'_>)],
        repetitions: u32,
        truths: Option<&[Truth]>,
    ) -> Result<Vec<Run>, LowerError> {
        let bend = |subject: &Subject| subject.parts.0.bend_halving;
        let in_view = |subject: &Subject| subject.method.needs_view();
        let prepare = |bend_halving: bool| {
            let of = subjects.iter().find(|(subject, _)| bend(subject) == bend_halving && !in_view(subject));
            let settings = of.map(|(subject, _)| subject.settings(&self.settings));
            settings.map(|settings| Prepared::build(self.model, Stages::ALL, &settings)).transpose()
        };
        let (by_bend, by_turning) = (prepare(true)?, prepare(false)?);
        let mut viewed = Vec::new();
        for (subject, rays) in subjects {
            let settings = subject.settings(&self.settings);
            viewed.push(match rays {
                Rays::Picture(picture) if in_view(subject) => {
                    Some(Viewed::build(self.model, &settings, picture, Wishes::PRIMARY)?)
                }
                _ => None,
            });
        }
        let mut tracers: Vec<Box<dyn Tracer + '_>> = Vec::new();
        for ((subject, _), viewed) in subjects.iter().zip(&mut viewed) {
            let prepared = if bend(subject) { &by_bend } else { &by_turning };
            match (viewed, prepared) {
                (Some(viewed), _) => tracers.push(viewed.tracer()?.0),
                (None, Some(prepared)) => tracers.push(prepared.tracer(&subject.settings(&self.settings))),
                (None, None) => {
                    let message = format!("{} has rays of no picture", subject.name);
                    return Err(LowerError::Internal(message));
                }
            }
        }
        let mut lanes: Vec<_> = tracers.iter().map(|tracer| tracer.lane()).collect();
        let mut runs = Vec::new();
        for (lane, (subject, rays)) in lanes.iter_mut().zip(subjects) {
            runs.push(self.once(lane.as_mut(), subject, *rays, truths));
            (self.step)();
        }
        let mut seconds = vec![Vec::new(); subjects.len()];
        for _ in 0..repetitions {
            let mut pass = vec![0.0; subjects.len()];
            for part in 0..PARTS {
                for ((lane, (_, rays)), seconds) in lanes.iter_mut().zip(subjects).zip(&mut pass) {
                    let lines = u64::from(rays.lines());
                    let edge = |part: u32| (lines * u64::from(part) / u64::from(PARTS)) as u32;
                    let mut tally = Tally::default();
                    rays.trace(lane.as_mut(), edge(part)..edge(part + 1), &mut tally, |_| {});
                    *seconds += tally.seconds;
                }
            }
            for (seconds, pass) in seconds.iter_mut().zip(pass) {
                seconds.push(pass);
                (self.step)();
            }
        }
        for (run, seconds) in runs.iter_mut().zip(seconds) {
            run.times = Times::of(seconds);
        }
        Ok(runs)
    }

    /// What becomes of a picture's rays by a subject for any rays.
    ///
    /// # Errors
    /// As [`Prepared::build`].
    pub fn outcomes(&self, subject: &Subject, picture: &View) -> Result<Vec<Outcome>, LowerError> {
        let settings = subject.settings(&self.settings);
        let prepared = Prepared::build(self.model, Stages::of(subject.method), &settings)?;
        let mut outcomes = Vec::new();
        let mut keep = |line: &[Outcome]| outcomes.extend_from_slice(line);
        trace_picture(prepared.tracer(&settings).lane().as_mut(), picture, &mut Tally::default(), &mut keep);
        Ok(outcomes)
    }

    /// Traces all rays once, to count and to judge.
    fn once(&self, lane: &mut dyn Lane, subject: &Subject, rays: Rays<'_>, truths: Option<&[Truth]>) -> Run {
        let mut tally = Tally { each: truths.map(|_| Vec::new()), ..Tally::default() };
        let mut outcomes = Vec::new();
        rays.trace(lane, 0..rays.lines(), &mut tally, |line| outcomes.extend_from_slice(line));
        let diagonal = self.model.control_box().map_or(0.0, |bounds| bounds.diagonal());
        let agreement = match (truths, rays) {
            (Some(truths), Rays::Picture(picture)) => {
                Some(Agreement::of(&outcomes, truths, picture, diagonal, self.settings.precision))
            }
            _ => None,
        };
        let each = tally.each.take().unwrap_or_default();
        Run {
            subject: subject.clone(),
            times: Times::of(Vec::new()),
            rays: tally.rays,
            hit_rays: tally.hits,
            gave_up: tally.gave_up_in_all(),
            counts: Counts(tally.work),
            found_twice: truths.map(|truths| found_twice(&each, truths)),
            agreement,
        }
    }
}

#[cfg(test)]
mod tests;
