//! Measures cells: judges each answer once, then times the cells in turn.

use super::errors::{Judge, Judged, Kind, Spread};
use super::machine::Machine;
use super::plan::Cell;
use super::record::{Counts, Errors, Head, Map, Measured, Record, Time, Worst};
use super::replay;
use super::subject::Subject;
use super::truth::RayTruth;
use crate::experiment::{found_twice, trace_picture};
use crate::judge::{Truth, allowance};
use crate::report::times::{Times, quantile};
use crate::scanline::{Lane, Outcome, Tally, row, steps};
use crate::scene::trace::{Method, Precision};
use crate::settings::Settings;
use crate::stats::Used;
use crate::viewed::{Viewed, Wishes};

/// A study under way.
pub struct Study<'s> {
    /// What it is of.
    pub subject: &'s Subject,
    /// What the oracle says of its picture.
    pub truths: &'s [RayTruth],
    /// How often each cell is timed.
    pub repetitions: u32,
    /// Called after each pass of a cell, [`passes`] times for each.
    pub step: &'s dyn Fn(),
}

/// How often [`Study::step`] is called for a cell.
pub fn passes(repetitions: u32) -> u64 {
    u64::from(repetitions) + 1
}

/// The cells that are measured together, in turn: at most twelve, of one knob and precision.
pub fn groups(cells: &[Cell]) -> impl Iterator<Item = &[Cell]> {
    let alike = cells.chunk_by(|a, b| (a.knob, a.precision) == (b.knob, b.precision));
    alike.flat_map(|alike| alike.chunks(12))
}

/// The scene made ready for a cell.
pub(crate) fn viewed(subject: &Subject, cell: &Cell) -> Result<Viewed, String> {
    let settings = cell.settings(&subject.settings);
    Viewed::build(&subject.model, &settings, &subject.picture, Wishes::PRIMARY).map_err(|error| error.to_string())
}

/// The character of a [`Map`] for an answer: `.` for no hit, rightly; for the closest hit a letter from `a` to `z` by the
/// error of t, `a` being below 1e-17 of the diagonal and each letter on ten times as much; and `O` another sheet, `M`
/// missed, `P` phantom, `G` given up, `U` undecided.
pub fn pixel(judged: &Judged) -> char {
    match judged.kind {
        Kind::Nothing => '.',
        Kind::Right | Kind::Off => {
            let decade = judged.error.unwrap_or(0.0).log10().floor() + 18.0;
            // An error of 0 has a logarithm of minus infinity; the cast holds the rest within 0 to 25.
            char::from(b'a' + (decade.clamp(0.0, 25.0) as u8))
        }
        Kind::OtherSheet => 'O',
        Kind::Missed => 'M',
        Kind::Phantom => 'P',
        Kind::GaveUp => 'G',
        Kind::Undecided => 'U',
    }
}

/// The character of [`Map::steps`] for a ray of so many steps: `.` for none; else a letter from `a` to `z`, `a` being one
/// step and every second letter on twice as many.
pub fn effort(steps: u32) -> char {
    if steps == 0 {
        return '.';
    }
    let half_octaves = 2.0 * f64::from(steps).log2();
    char::from(b'a' + half_octaves.clamp(0.0, 25.0) as u8)
}

/// How many bad answers a record names.
const WORST: usize = 10;

/// What times are paced by.
const PACE: Cell =
    Cell { method: Method::Clipping, precision: Precision::F64, knob: super::plan::Knob::Default, value: None };

impl Study<'_> {
    /// Measures some cells, in turn.
    ///
    /// # Errors
    /// The scene cannot be traced at all, by the method that asks the least of it.
    pub fn measure(&self, cells: &[Cell]) -> Result<Vec<Record>, String> {
        let mut pace = viewed(self.subject, &PACE)?;
        let (pace, _) = pace.tracer().map_err(|error| error.to_string())?;
        let mut pace = pace.lane();
        let mut all: Vec<Result<Viewed, String>> = cells.iter().map(|cell| viewed(self.subject, cell)).collect();
        let tracers: Vec<_> = all
            .iter_mut()
            .map(|viewed| match viewed {
                Ok(viewed) => viewed.tracer().map_err(|error| error.to_string()),
                Err(reason) => Err(reason.clone()),
            })
            .collect();
        let mut lanes: Vec<_> =
            tracers.iter().map(|tracer| tracer.as_ref().ok().map(|(tracer, _)| tracer.lane())).collect();
        let mut judged = Vec::new();
        for (cell, lane) in cells.iter().zip(&mut lanes) {
            judged.push(lane.as_mut().map(|lane| self.judge(cell, lane.as_mut())));
            (self.step)();
        }
        let mut seconds = vec![(Vec::new(), Vec::new()); cells.len()];
        for _ in 0..self.repetitions {
            for (lane, (own, paces)) in lanes.iter_mut().zip(&mut seconds) {
                if let Some(lane) = lane {
                    paces.push(self.pass(pace.as_mut()));
                    own.push(self.pass(lane.as_mut()));
                }
                (self.step)();
            }
        }
        let machine = Machine::this();
        let parts = cells.iter().zip(&tracers).zip(judged).zip(seconds);
        let records = parts.map(|(((cell, tracer), judged), seconds)| Record {
            head: self.head(cell),
            machine: machine.clone(),
            result: match (tracer, judged) {
                (Ok((_, used)), Some(judged)) => Ok(judged.measured(used, seconds)),
                (Err(reason), _) => Err(reason.clone()),
                (Ok(_), None) => Err("it was not traced".to_owned()),
            },
        });
        Ok(records.collect())
    }

    fn head(&self, cell: &Cell) -> Head {
        // How many threads there are says nothing of what one of them does.
        let settings = Settings { threads: 1, ..cell.settings(&self.subject.settings) };
        Head {
            id: cell.id(),
            method: cell.method,
            precision: cell.precision,
            knob: cell.knob,
            value: cell.value,
            // Plain numbers and names can always be said.
            settings: serde_json::to_value(settings).unwrap_or_default(),
        }
    }

    /// How many seconds it takes to trace the picture.
    fn pass(&self, lane: &mut dyn Lane) -> f64 {
        let mut tally = Tally::default();
        trace_picture(lane, &self.subject.picture, &mut tally, |_| {});
        tally.seconds
    }

    /// Traces the picture, and holds each answer against the oracle's.
    fn judge(&self, cell: &Cell, lane: &mut dyn Lane) -> Answers {
        let Subject { picture, model, .. } = self.subject;
        let judge = Judge { model, diagonal: self.subject.diagonal(), allowance: allowance(cell.precision) };
        let mut tally = Tally { each: Some(Vec::new()), ..Tally::default() };
        let mut outcomes = Vec::new();
        trace_picture(lane, picture, &mut tally, |line| outcomes.extend_from_slice(line));
        let truths: Vec<Truth> = self.truths.iter().map(|ray| ray.truth).collect();
        let each = tally.each.take().unwrap_or_default();
        let doubled = found_twice(&each, &truths);
        let rays = (0..picture.scan_lines()).flat_map(|line| row(picture, line));
        let (mut errors, mut residuals, mut pixels) = (Vec::new(), Vec::new(), String::new());
        let (mut counts, mut bad) = (Counts { doubled, ..Counts::default() }, Vec::new());
        counts.oracle_hits = truths.iter().filter(|truth| truth.closest.is_some()).count() as u64;
        for (place, ((outcome, truth), ray)) in outcomes.iter().zip(self.truths).zip(rays).enumerate() {
            let judged = judge.judge(outcome, &ray, truth);
            pixels.push(pixel(&judged));
            residuals.extend(judged.residual);
            let count = match judged.kind {
                Kind::Nothing | Kind::Right => &mut counts.right,
                Kind::Off => &mut counts.off,
                Kind::OtherSheet => &mut counts.other_sheet,
                Kind::Missed => &mut counts.missed,
                Kind::Phantom => &mut counts.phantom,
                Kind::Undecided => &mut counts.undecided,
                // Counted by its limit, below.
                Kind::GaveUp => &mut 0,
            };
            *count += 1;
            if matches!(judged.kind, Kind::Right | Kind::Off) {
                errors.extend(judged.error);
            }
            if judged.kind.is_lost() || judged.error.is_some_and(|error| error > 0.0) {
                bad.push((place, judged));
            }
        }
        let margin = |place: usize| truths.get(place).map_or(0.0, |truth| truth.margin);
        // Lost answers first, of them those of rays that are far from any change; then the largest errors.
        bad.sort_by(|(a, one), (b, other)| {
            let lost = other.kind.is_lost().cmp(&one.kind.is_lost());
            let safe = if one.kind.is_lost() { margin(*b).total_cmp(&margin(*a)) } else { std::cmp::Ordering::Equal };
            lost.then(safe).then(other.error.unwrap_or(0.0).total_cmp(&one.error.unwrap_or(0.0)))
        });
        let width = picture.size[0].max(1) as usize;
        let worst = bad.into_iter().take(WORST).map(|(place, judged)| {
            // Pictures are at most 32,768 wide and high.
            let pixel = [(place % width) as u32, (place / width) as u32];
            let outcome = outcomes.get(place);
            Worst {
                pixel,
                kind: judged.kind,
                t: outcome.and_then(|outcome| if let Outcome::Hit(found) = outcome { Some(found.t) } else { None }),
                closest: truths.get(place).and_then(|truth| truth.closest),
                error: judged.error,
                margin: margin(place),
                limit: outcome.and_then(|outcome| match outcome {
                    Outcome::GaveUp { limit, .. } => Some((*limit).to_owned()),
                    _ => None,
                }),
                command: replay::command(self.subject, cell, pixel),
            }
        });
        let (worst, t, residual) = (worst.collect(), Spread::of(&errors), Spread::of(&residuals));
        let map = Map { size: picture.size, pixels, steps: each.iter().map(|each| effort(steps(each))).collect() };
        Answers { tally, counts, errors: Errors { t, residual }, worst, map }
    }
}

/// What a cell answered.
struct Answers {
    tally: Tally,
    counts: Counts,
    errors: Errors,
    worst: Vec<Worst>,
    map: Map,
}

impl Answers {
    fn measured(self, used: &Used, (own, pace): (Vec<f64>, Vec<f64>)) -> Measured {
        let Answers { tally, mut counts, errors, worst, map } = self;
        let ratios: Vec<f64> = own.iter().zip(&pace).map(|(own, pace)| own / pace).collect();
        let Times { repetitions, median, spread } = Times::of(own);
        counts.rays = tally.rays;
        counts.hit_rays = tally.hits;
        counts.patches = used.patches;
        counts.bytes = used.bytes.total();
        counts.bytes_per_thread = used.lane.coherence + used.lane.line + used.lane.scratch;
        counts.gave_up = tally.gave_up.iter().map(|(&limit, &count)| (limit.to_owned(), count)).collect();
        if tally.invalid > 0 {
            counts.gave_up.insert("refused".to_owned(), tally.invalid);
        }
        let work = patchray::limits::Work::NAMES.iter().zip(tally.work);
        counts.work = work.map(|(&name, count)| (name.to_owned(), count)).collect();
        let paced = quantile(&ratios, 0.5);
        let time = Time { repetitions, pace, median, spread, paced, prepare: used.prepare_seconds };
        Measured { time, counts, errors, worst, map }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::Agreement;
    use crate::oracle::Oracle;
    use crate::scene::teapot::common_scene;
    use crate::study::plan::{Knob, plan};
    use crate::study::truth::of_picture;

    /// The fewest steps that a letter stands for.
    fn steps_of(letter: char) -> f64 {
        if letter == '.' { 0.0 } else { 2_f64.powf(f64::from(letter as u32 - 'a' as u32) / 2.0) }
    }

    #[test]
    fn what_is_counted_is_what_the_judge_of_other_verbs_counts() {
        let scene = common_scene().expect("the fixture is valid");
        let picture = scene.description.camera.view([32, 24]);
        let settings = Settings { flatness: 0.01, ..Settings::default() };
        let subject = Subject {
            name: "teapot".to_owned(),
            argument: None,
            patches: "teapot.bpt".to_owned(),
            model: scene.model,
            picture,
            settings,
            words: String::new(),
        };
        let truths = of_picture(&Oracle::new(&subject.model), &picture, || {});
        let study = Study { subject: &subject, truths: &truths, repetitions: 2, step: &|| {} };
        let of = |knob: Knob, value: f64| {
            let cells = plan(Some(Method::Newton), Some(Precision::F64)).into_iter();
            cells
                .filter(move |cell| cell.knob == knob && (value.is_nan() || cell.value == Some(value)))
                .collect::<Vec<_>>()
        };
        let cells = [of(Knob::Default, f64::NAN), of(Knob::Tolerance, 1e-3), of(Knob::NewtonSteps, 4.0)].concat();
        assert_eq!(cells.len(), 3);
        let records = study.measure(&cells).expect("it can be traced");
        let plain: Vec<Truth> = truths.iter().map(|truth| truth.truth).collect();
        let mut losses = Vec::new();
        for (cell, record) in cells.iter().zip(&records) {
            let mut outcomes = Vec::new();
            let mut viewed = viewed(&subject, cell).expect("there is memory");
            let (tracer, _) = viewed.tracer().expect("it was just made ready");
            trace_picture(tracer.lane().as_mut(), &picture, &mut Tally::default(), |line| {
                outcomes.extend_from_slice(line)
            });
            let agreement = Agreement::of(&outcomes, &plain, &picture, subject.diagonal(), cell.precision);
            let Ok(Measured { time, counts, errors, worst, map }) = &record.result else { panic!("{record:?}") };
            assert_eq!((counts.rays, counts.right), (32 * 24, agreement.right), "{}", cell.id());
            assert_eq!(
                [counts.off + counts.other_sheet, counts.missed, counts.phantom, counts.gave_up_in_all()],
                [agreement.wrong, agreement.missed, agreement.phantom, agreement.unanswered]
            );
            assert_eq!((time.repetitions.len(), time.pace.len(), worst.len()), (2, 2, 10));
            assert_eq!(map.pixels.chars().filter(|c| c.is_lowercase()).count() as u64, errors.t.count);
            assert_eq!(map.steps.len(), map.pixels.len());
            // Half an octave says a ray's steps to a factor of √2, so that their sum cannot be farther off.
            let least: f64 = map.steps.chars().map(steps_of).sum();
            let steps = counts.work["newton_steps"] + counts.work["clip_steps"];
            assert!((least..1.42 * least).contains(&(steps as f64)), "{}: {steps} and {least}", cell.id());
            losses.push((counts.lost(), errors.t.max, counts.gave_up.clone()));
        }
        assert!(losses[0].1 < 1e-12 && losses[0].2.is_empty());
        assert!(losses[0].0 == 0 && losses[1].0 > 0, "a loose tolerance shows: {losses:?}");
        assert!(losses[2].2.get("newton-steps").is_some_and(|&count| count > 10), "a small budget shows: {losses:?}");
    }

    #[test]
    fn groups_hold_all_and_are_small() {
        let cells = plan(None, None);
        let groups: Vec<&[Cell]> = groups(&cells).collect();
        assert!(groups.iter().all(|group| group.len() <= 12 && group.iter().all(|cell| cell.knob == group[0].knob)));
        assert_eq!(groups.concat().len(), cells.len());
    }

    #[test]
    fn pixels_tell_errors_by_decade() {
        let judged = |kind, error| Judged { kind, error, residual: None };
        let letters = [0.0, 5e-17, 5e-16, 0.5, 1e9].map(|error| pixel(&judged(Kind::Right, Some(error))));
        assert_eq!(letters, ['a', 'b', 'c', 'r', 'z']);
        assert_eq!(pixel(&judged(Kind::Missed, None)), 'M');
    }

    #[test]
    fn letters_tell_steps_by_half_an_octave() {
        assert_eq!([0, 1, 2, 3, 4, 7, 256, u32::MAX].map(effort), ['.', 'a', 'c', 'd', 'e', 'f', 'q', 'z']);
    }
}
