//! Measures methods on a scene for the paper's tables: on one thread, all in turn.

use crate::judge::{Agreement, Truth};
use crate::lower::{LowerError, Stages};
use crate::prepared::Prepared;
use crate::report::tables::{RaysKind, RaysRun, Run, SamplingRun};
use crate::report::times::Times;
use crate::scanline::{Lane, Outcome, Tally, Tracer, rays_of, row};
use crate::scene::appearance::Appearance;
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::scene::rays::RayLine;
use crate::scene::sampling::Sampling;
use crate::scene::shapes::Random;
use crate::scene::trace::Method;
use crate::settings::Settings;
use crate::viewed::{Viewed, Wishes};
use patchray::limits::Work;
use std::ops::Range;

/// A scene to measure methods on.
pub struct Scene<'s> {
    /// Its surfaces.
    pub model: &'s Model,
    /// What they look like: where its lights are.
    pub appearance: &'s Appearance,
    /// The picture, a sample per pixel.
    pub picture: View,
    /// How to trace, but for the method.
    pub settings: Settings,
    /// How often each method traces it for Tables 1 and 2; for the others, [`fewer`].
    pub repetitions: u32,
    /// Called after each pass of a method, [`passes`] times in all.
    pub step: &'s dyn Fn(),
}

/// The methods of Table 1 and of Table 2, the originals first, and whether they keep their memory from ray to ray.
const SUBJECTS: [[(Method, bool); 5]; 2] = [
    [
        (Method::Newton, true),
        (Method::NewtonCoherent, true),
        (Method::NewtonPredicted, true),
        (Method::NewtonCoherent, false),
        (Method::NewtonPredicted, false),
    ],
    [
        (Method::Clipping, true),
        (Method::ClippingCoherent, true),
        (Method::ClippingPredicted, true),
        (Method::ClippingCoherent, false),
        (Method::ClippingPredicted, false),
    ],
];

/// The methods of Table 3.
const SAMPLED: [Method; 4] =
    [Method::NewtonCoherent, Method::NewtonPredicted, Method::ClippingCoherent, Method::ClippingPredicted];

/// The methods of Table 4: original and improved.
const PAIRS: [[Method; 2]; 2] =
    [[Method::Newton, Method::NewtonCoherent], [Method::Clipping, Method::ClippingCoherent]];

/// How often [`Scene::step`] is called for the tables of one scene.
pub fn passes(repetitions: u32) -> u64 {
    // Those of Tables 1 and 2 are traced once more, to be judged.
    u64::from(repetitions) * 10 + 10 + u64::from(fewer(repetitions)) * (8 + 3 * 4 + 2)
}

/// How often methods trace what Tables 3 and 4 are of, which takes longer: half as often, rounded up.
pub fn fewer(repetitions: u32) -> u32 {
    repetitions.div_ceil(2)
}

/// What was measured for Tables 1 and 2.
pub struct Primary {
    /// The runs of both tables.
    pub runs: [Vec<Run>; 2],
    /// What became of the rays by Bézier clipping.
    pub outcomes: Vec<Outcome>,
    /// Surfaces, and patches.
    pub size: [u64; 2],
}

/// Traces a whole picture with a lane; `each` is given the outcomes of each scan line.
pub(crate) fn trace_picture(lane: &mut dyn Lane, picture: &View, tally: &mut Tally, each: impl FnMut(&[Outcome])) {
    trace_lines(lane, picture, 0..picture.scan_lines(), tally, each);
}

/// Traces some scan lines of a picture with a lane.
fn trace_lines(
    lane: &mut dyn Lane,
    picture: &View,
    lines: Range<u32>,
    tally: &mut Tally,
    mut each: impl FnMut(&[Outcome]),
) {
    let mut outcomes = Vec::new();
    for line in lines {
        let samples = picture.scan_line(line);
        outcomes.clear();
        lane.trace_line(&samples, &rays_of(picture, line, &samples), &mut outcomes, tally);
        each(&outcomes);
    }
}

/// The parts of a pass that methods do in turn: so many that what else goes on in the machine meanwhile disturbs all methods
/// alike, and so few that a part is some thousand rays, beside which filling the caches anew is nothing.
const PARTS: u32 = 32;

/// The times of several subjects that each have a number of lines to trace, a part of them in turn: `trace` says how many
/// seconds its lines took, of the subject and how many there are of all.
fn in_turn<T>(
    scene: &Scene,
    repetitions: u32,
    subjects: &mut [T],
    lines_of: impl Fn(&T) -> u32,
    mut trace: impl FnMut(&mut T, Range<u32>) -> f64,
) -> Vec<Times> {
    let mut seconds = vec![Vec::new(); subjects.len()];
    for _ in 0..repetitions {
        let mut pass = vec![0.0; subjects.len()];
        for part in 0..PARTS {
            for (subject, seconds) in subjects.iter_mut().zip(&mut pass) {
                let lines = u64::from(lines_of(subject));
                let edge = |part: u32| (lines * u64::from(part) / u64::from(PARTS)) as u32;
                *seconds += trace(subject, edge(part)..edge(part + 1));
            }
        }
        for (seconds, pass) in seconds.iter_mut().zip(pass) {
            seconds.push(pass);
            (scene.step)();
        }
    }
    seconds.into_iter().map(Times::of).collect()
}

/// How many points are more than the roots that there are on their ray.
pub(crate) fn found_twice(each: &[Work], truths: &[Truth]) -> u64 {
    let excess =
        |(each, truth): (&Work, &Truth)| u64::from(each.intersection_points).saturating_sub(truth.roots as u64);
    each.iter().zip(truths).filter(|(_, truth)| !truth.open).map(excess).sum()
}

impl Scene<'_> {
    /// The scene made ready for a method and a picture.
    fn viewed(&self, method: Method, coherence: bool, picture: &View) -> Result<Viewed, LowerError> {
        let settings = Settings { method, ..self.settings };
        Viewed::build(self.model, &settings, picture, Wishes { coherence, ..Wishes::PRIMARY })
    }

    /// Tables 1 and 2; answers are judged by the `truths`, if there are any.
    ///
    /// # Errors
    /// As [`Viewed::build`].
    pub fn primary(&self, truths: Option<&[Truth]>) -> Result<Primary, LowerError> {
        let subjects = SUBJECTS.as_flattened();
        let viewed = subjects.iter().map(|&(method, coherence)| self.viewed(method, coherence, &self.picture));
        let mut viewed = viewed.collect::<Result<Vec<_>, _>>()?;
        let tracers = viewed.iter_mut().map(Viewed::tracer).collect::<Result<Vec<_>, _>>()?;
        let size = tracers.first().map_or([0; 2], |(_, used)| [used.surfaces, used.patches]);
        let mut lanes: Vec<_> = tracers.iter().map(|(tracer, _)| tracer.lane()).collect();
        let diagonal = self.model.control_box().map_or(0.0, |bounds| bounds.diagonal());
        let mut by_clipping = Vec::new();
        let mut judged = Vec::new();
        for (lane, (method, _)) in lanes.iter_mut().zip(subjects) {
            let mut tally = Tally { each: Some(Vec::new()), ..Tally::default() };
            let mut outcomes = Vec::new();
            trace_picture(lane.as_mut(), &self.picture, &mut tally, |line| outcomes.extend_from_slice(line));
            let agreement =
                truths.map(|truths| Agreement::of(&outcomes, truths, &self.picture, diagonal, self.settings.precision));
            let each = tally.each.take().unwrap_or_default();
            judged.push((tally, agreement, truths.map(|truths| found_twice(&each, truths))));
            if *method == Method::Clipping {
                by_clipping = outcomes;
            }
            (self.step)();
        }
        let scan_lines = self.picture.scan_lines();
        let times = in_turn(
            self,
            self.repetitions,
            &mut lanes,
            |_| scan_lines,
            |lane, lines| {
                let mut tally = Tally::default();
                trace_lines(lane.as_mut(), &self.picture, lines, &mut tally, |_| {});
                tally.seconds
            },
        );
        let mut runs = [Vec::new(), Vec::new()];
        let mut measured = subjects.iter().zip(&times).zip(judged).enumerate();
        for (table, runs) in runs.iter_mut().enumerate() {
            let first = table * SUBJECTS[table].len();
            let of_table = measured.by_ref().take(SUBJECTS[table].len());
            runs.extend(of_table.map(|(_, ((&(method, coherence), own), (tally, agreement, found_twice)))| Run {
                method,
                coherence,
                times: own.clone(),
                gain: own.gain_over(&times[first]),
                rays: tally.rays,
                hit_rays: tally.hits,
                gave_up: tally.gave_up_in_all(),
                intersection_points: tally.count("intersection_points"),
                found_twice,
                agreement,
            }));
        }
        Ok(Primary { runs, outcomes: by_clipping, size })
    }

    /// Table 3.
    ///
    /// # Errors
    /// As [`Viewed::build`].
    pub fn samplings(&self) -> Result<Vec<SamplingRun>, LowerError> {
        let pictures = [Sampling::Uniform, Sampling::Jittered].map(|sampling| self.picture.sampled(sampling));
        let subjects: Vec<_> = SAMPLED.iter().flat_map(|&method| pictures.map(|picture| (method, picture))).collect();
        let viewed = subjects.iter().map(|(method, picture)| self.viewed(*method, true, picture));
        let mut viewed = viewed.collect::<Result<Vec<_>, _>>()?;
        let tracers = viewed.iter_mut().map(Viewed::tracer).collect::<Result<Vec<_>, _>>()?;
        let lanes = tracers.iter().map(|(tracer, _)| tracer.lane());
        let mut lanes: Vec<_> = lanes.zip(&subjects).map(|(lane, (_, picture))| (lane, picture)).collect();
        let scan_lines = |(_, picture): &(_, &View)| picture.scan_lines();
        let times = in_turn(self, fewer(self.repetitions), &mut lanes, scan_lines, |(lane, picture), lines| {
            let mut tally = Tally::default();
            trace_lines(lane.as_mut(), picture, lines, &mut tally, |_| {});
            tally.seconds
        });
        let run = |(&method, times): (&Method, &[Times])| {
            let [uniform, jittered] = times else { return None };
            let (uniform, jittered) = (uniform.clone(), jittered.clone());
            Some(SamplingRun { method, gain: jittered.gain_over(&uniform), uniform, jittered })
        };
        Ok(SAMPLED.iter().zip(times.chunks(2)).filter_map(run).collect())
    }

    /// Table 4. `outcomes` are those of the picture's rays, which shadow rays begin at.
    ///
    /// # Errors
    /// As [`Prepared::build`].
    pub fn one_by_one(&self, outcomes: &[Outcome]) -> Result<Vec<RaysRun>, LowerError> {
        let prepared = Prepared::build(self.model, Stages::ALL, &self.settings)?;
        let lines: Vec<Vec<RayLine>> = (0..self.picture.scan_lines()).map(|line| row(&self.picture, line)).collect();
        let mut runs = Vec::new();
        for kind in [RaysKind::Primary, RaysKind::Shuffled, RaysKind::Shadow] {
            let lines = match kind {
                RaysKind::Primary => lines.clone(),
                RaysKind::Shuffled => shuffled(&lines),
                RaysKind::Shadow => self.shadows(&lines, outcomes),
            };
            runs.extend(self.pairs(&prepared, kind, &lines));
        }
        Ok(runs)
    }

    fn pairs(&self, prepared: &Prepared, kind: RaysKind, lines: &[Vec<RayLine>]) -> Vec<RaysRun> {
        let mut tracers: Vec<Box<dyn Tracer + '_>> = Vec::new();
        for &method in PAIRS.as_flattened() {
            tracers.push(prepared.tracer(&Settings { method, ..self.settings }));
        }
        if kind == RaysKind::Shadow {
            let any =
                PAIRS.iter().filter_map(|&[method, _]| prepared.tracer_of_any(&Settings { method, ..self.settings }));
            tracers.extend(any);
        }
        let mut lanes: Vec<_> = tracers.iter().map(|tracer| (tracer.lane(), 0)).collect();
        let count = lines.len() as u32;
        let times = in_turn(
            self,
            fewer(self.repetitions),
            &mut lanes,
            |_| count,
            |(lane, points), part| {
                let (mut tally, mut outcomes) = (Tally::default(), Vec::new());
                let first = part.start == 0;
                for line in lines.get(part.start as usize..part.end as usize).unwrap_or_default() {
                    outcomes.clear();
                    lane.trace(line, false, &mut outcomes, &mut tally);
                }
                *points = if first { 0 } else { *points } + tally.count("intersection_points");
                tally.seconds
            },
        );
        let (pairs, any) = times.split_at(2 * PAIRS.len());
        let rays = lines.iter().map(|line| line.len() as u64).sum();
        let run = |(place, (&[method, _], times)): (usize, (&[Method; 2], &[Times]))| {
            let [original, coherent] = times else { return None };
            Some(RaysRun {
                kind,
                rays,
                method,
                gain: coherent.gain_over(original),
                original: original.clone(),
                coherent: coherent.clone(),
                intersection_points: [2 * place, 2 * place + 1].map(|k| lanes.get(k).map_or(0, |(_, points)| *points)),
                any_hit: any.get(place).cloned(),
            })
        };
        PAIRS.iter().zip(pairs.chunks(2)).enumerate().filter_map(run).collect()
    }

    /// For each ray that hit, a ray from there to the first light, in the same scan line.
    fn shadows(&self, lines: &[Vec<RayLine>], outcomes: &[Outcome]) -> Vec<Vec<RayLine>> {
        let light = self.appearance.lights.first().and_then(|light| light.position).unwrap_or(self.picture.eye);
        let mut outcomes = outcomes.iter();
        let shadow = |(ray, outcome): (&RayLine, &Outcome)| {
            let Outcome::Hit(found) = outcome else { return None };
            let origin = [0, 1, 2].map(|k| ray.origin[k] + found.t * ray.direction[k]);
            let direction = [0, 1, 2].map(|k| light[k] - origin[k]);
            Some(RayLine { origin, direction, t_min: CLEAR, t_max: 1.0, ..*ray })
        };
        lines.iter().map(|line| line.iter().zip(outcomes.by_ref()).filter_map(shadow).collect()).collect()
    }
}

/// Where on its way to the light a shadow ray begins, so that it does not meet the point that it leaves.
const CLEAR: f64 = 1e-4;

/// The rays in random order, in lines as long as before: always the same order.
fn shuffled(lines: &[Vec<RayLine>]) -> Vec<Vec<RayLine>> {
    let mut rays: Vec<RayLine> = lines.concat();
    let mut random = Random(1);
    for last in (1..rays.len()).rev() {
        rays.swap(last, (random.bits() % (last as u64 + 1)) as usize);
    }
    rays.chunks(lines.first().map_or(1, |line| line.len().max(1))).map(<[RayLine]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::teapot::common_scene;
    use std::cell::Cell;

    #[test]
    fn every_table_is_measured() {
        let loaded = common_scene().expect("the fixture is valid");
        let (picture, steps) = (loaded.description.camera.view([24, 20]), Cell::new(0));
        let scene = Scene {
            model: &loaded.model,
            appearance: &loaded.appearance,
            picture,
            settings: Settings { flatness: 0.01, ..Settings::default() },
            repetitions: 2,
            step: &|| steps.set(steps.get() + 1),
        };
        let oracle = crate::oracle::Oracle::new(&loaded.model);
        let (truths, _) = crate::judge::ask(&oracle, &picture, || {});
        let Primary { runs, outcomes, size } = scene.primary(Some(&truths)).expect("there is memory");
        assert_eq!(size[0], 32);
        let hits = outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Hit(_))).count();
        for runs in &runs {
            assert_eq!((runs.len(), runs[0].gain), (5, 0.0));
            for run in runs {
                assert_eq!((run.rays, run.hit_rays as usize, run.times.repetitions.len()), (480, hits, 2));
                let agreement = run.agreement.expect("it was judged");
                assert!(agreement.right >= 478, "{agreement:?}");
                assert!(run.found_twice.expect("it was judged") < run.intersection_points);
            }
        }
        assert_eq!(scene.samplings().expect("there is memory").len(), 4);
        let rays = scene.one_by_one(&outcomes).expect("there is memory");
        let counts: Vec<u64> = rays.iter().map(|run| run.rays).collect();
        let hits = hits as u64;
        assert_eq!(counts, [480, 480, 480, 480, hits, hits]);
        assert!(rays.iter().all(|run| run.any_hit.is_some() == (run.kind == RaysKind::Shadow)));
        assert_eq!(steps.get(), passes(2));
    }

    #[test]
    fn shuffling_loses_no_ray() {
        let picture = common_scene().expect("the fixture is valid").description.camera.view([7, 5]);
        let lines: Vec<Vec<RayLine>> = (0..5).map(|line| row(&picture, line)).collect();
        let other = shuffled(&lines);
        assert!(other.iter().all(|line| line.len() == 7) && other != lines);
        let sorted = |lines: &[Vec<RayLine>]| {
            let mut keys: Vec<_> = lines.iter().flatten().map(|ray| ray.direction.map(f64::to_bits)).collect();
            keys.sort_unstable();
            keys
        };
        assert_eq!(sorted(&lines), sorted(&other));
    }

    #[test]
    fn points_beyond_the_roots_were_found_twice() {
        let truth = |roots, open| Truth { closest: Some(1.0), roots, open, margin: 1.0, ..Truth::default() };
        let truths = [truth(2, false), truth(2, false), truth(0, true)];
        let each =
            [1, 5, 7].map(|intersection_points| Work { intersection_points, newton_steps: 9, ..Work::default() });
        assert_eq!(found_twice(&each, &truths), 3);
    }
}
