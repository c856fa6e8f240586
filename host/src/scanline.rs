//! Drives rays along scan lines.
//!
//! A [`Lane`] is what one thread needs: scratch, and coherence memory that starts every scan line empty. Answers and
//! counters therefore depend on the lines alone, not on which thread traced them. The type hides point type, precision and
//! method behind one call per line; within a line all is monomorphic.

use std::collections::BTreeMap;
use std::marker::PhantomData;

use patchray::bernstein::Basis;
use patchray::limits::{Limits, Work};
use patchray::method::Remembered;
use patchray::point::Point;
use patchray::ray::{Hit, Incidence, Interval, RayError};
use patchray::reading::Switches;
use patchray::scalar::Scalar;
use patchray::scene::Scene;

use crate::clock::Clock;
use crate::lower::{ORDER, Place};
use crate::method::{Answer, Coherence, Hits, Method, Stopped, Task, Views};
use crate::scene::camera::View;
use crate::scene::rays::RayLine;
use crate::scene::sampling::ScanLine;

pub mod view;

/// A hit in `f64`, whatever it was computed in; exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Parameter along the ray, in units of its direction.
    pub t: f64,
    /// Surface parameter, in [0, 1].
    pub u: f64,
    /// Surface parameter, in [0, 1].
    pub v: f64,
    /// The surface's index in the model.
    pub surface: usize,
    /// The unit normal there, if there is one.
    pub normal: Normal,
    /// How the ray meets the surface there.
    pub incidence: Incidence,
}

/// The unit normal at a hit, along ∂S/∂u × ∂S/∂v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Normal {
    /// The surface has one there.
    There([f64; 3]),
    /// The surface has none there, as at the apex of a cone. It has this one at a place nearby.
    Nearby([f64; 3]),
    /// The surface has none there and none nearby, as one that is a curve.
    Nowhere,
}

impl Normal {
    /// The surface's, if it has one there.
    pub fn there(self) -> Option<[f64; 3]> {
        match self {
            Normal::There(normal) => Some(normal),
            Normal::Nearby(_) | Normal::Nowhere => None,
        }
    }

    /// What pictures show: where there is none that of a place nearby, so that the point looks as those around it do.
    pub fn shown(self) -> Option<[f64; 3]> {
        match self {
            Normal::There(normal) | Normal::Nearby(normal) => Some(normal),
            Normal::Nowhere => None,
        }
    }
}

/// What became of a ray. `H` is what it was asked for: one hit, the closest or any, or a list of all, which is not empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome<H = Found> {
    /// What was asked for.
    Hit(H),
    /// No hit.
    Miss,
    /// Out of a budget.
    GaveUp {
        /// The name of the budget.
        limit: &'static str,
        /// The closest hit, or the hits, found by then: not an answer.
        best: Option<H>,
    },
    /// The kernel refuses such a ray in this scene.
    Refused(RayError),
    /// The ray was marked as not valid, and was not traced.
    Invalid,
}

/// Sums over rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Rays, whatever became of them.
    pub rays: u64,
    /// Rays that hit, whether once or more often.
    pub hits: u64,
    /// Rays that were refused, or were not valid.
    pub invalid: u64,
    /// Rays given up, by the name of the limit that ran out.
    pub gave_up: BTreeMap<&'static str, u64>,
    /// The kernel's counters, in the order of [`Work::NAMES`].
    pub work: [u64; Work::COUNT],
    /// Processor seconds for making rays and answering them, summed over threads. Measured around whole lines; the
    /// conversion of numbers and the normals are outside.
    pub seconds: f64,
    /// What each ray took, in order: only if there is a list for it when rays are traced.
    pub each: Option<Vec<Work>>,
}

/// A ray's Newton steps and clips together.
pub fn steps(work: &Work) -> u32 {
    work.newton_steps.saturating_add(work.clip_steps)
}

impl Tally {
    /// Adds what another part of the work came to.
    pub fn add(&mut self, other: &Tally) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.invalid += other.invalid;
        for (limit, count) in &other.gave_up {
            *self.gave_up.entry(limit).or_default() += count;
        }
        for (sum, part) in self.work.iter_mut().zip(other.work) {
            *sum += part;
        }
        self.seconds += other.seconds;
        if let (Some(each), Some(others)) = (&mut self.each, &other.each) {
            each.extend(others);
        }
    }

    /// Counts what became of a ray.
    fn count_outcome<H>(&mut self, outcome: &Outcome<H>) {
        match outcome {
            Outcome::Hit(_) => self.hits += 1,
            Outcome::Miss => {}
            Outcome::GaveUp { limit, .. } => *self.gave_up.entry(limit).or_default() += 1,
            Outcome::Refused(_) | Outcome::Invalid => self.invalid += 1,
        }
    }

    /// Rays given up.
    pub fn gave_up_in_all(&self) -> u64 {
        self.gave_up.values().sum()
    }

    /// A counter of [`Work`] by name; 0 for a name that it has not.
    pub fn count(&self, name: &str) -> u64 {
        Work::NAMES.iter().zip(self.work).find_map(|(&known, count)| (known == name).then_some(count)).unwrap_or(0)
    }
}

/// The rays of scan line `line`: of a row of pixels where each has one sample, else of half of it.
pub fn row(view: &View, line: u32) -> Vec<RayLine> {
    rays_of(view, line, &view.scan_line(line))
}

/// The rays of the samples of scan line `line`.
pub fn rays_of(view: &View, line: u32, samples: &ScanLine) -> Vec<RayLine> {
    let ray = |&sample| RayLine {
        origin: view.eye,
        direction: view.towards(sample),
        t_min: 0.0,
        t_max: f64::INFINITY,
        scan_line: u64::from(line),
        valid: true,
    };
    samples.samples.iter().map(ray).collect()
}

/// Bytes that each thread needs beside the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LaneBytes {
    /// Coherence memory.
    pub coherence: u64,
    /// What can be seen along a scan line, for the rays of a view.
    pub line: u64,
    /// Scratch, for surfaces of any degrees.
    pub scratch: u64,
}

/// What one thread needs to trace lines with one method. `H` is what rays are asked for, as in [`Outcome`].
pub trait Lane<H = Found>: Send {
    /// Traces `rays` one after another, as the beginning of a scan line, or as its continuation if `continues`. Outcomes are
    /// appended, one per ray; sums are added to `tally`.
    fn trace(&mut self, rays: &[RayLine], continues: bool, outcomes: &mut Vec<Outcome<H>>, tally: &mut Tally);

    /// Traces a scan line of the picture that the tracer was made for: `rays` are those of `line`'s samples.
    fn trace_line(&mut self, line: &ScanLine, rays: &[RayLine], outcomes: &mut Vec<Outcome<H>>, tally: &mut Tally) {
        let _ = line;
        self.trace(rays, false, outcomes, tally);
    }
}

/// A scene ready to be traced with one method.
pub trait Tracer<H = Found>: Send + Sync {
    /// A lane over it. Lanes of one tracer are alike.
    fn lane(&self) -> Box<dyn Lane<H> + '_>;

    /// What a lane takes.
    fn lane_bytes(&self) -> LaneBytes;

    /// Whether a scan line has to stay with one lane.
    fn is_coherent(&self) -> bool;

    /// Why the kernel would refuse a ray, if it would.
    fn refusal(&self, ray: &RayLine) -> Option<RayError>;
}

/// The tracer of a method.
#[derive(Clone, Copy, Debug)]
pub struct MethodTracer<'m, M, P: Point> {
    views: Views<'m, P>,
    limits: Limits<P::Scalar>,
    switches: Option<Switches>,
    method: PhantomData<M>,
}

impl<'m, M: Method<P>, P: Point> MethodTracer<'m, M, P> {
    /// The tracer of the method `M`, such as [`Newton`](crate::method::Newton), over `views` and under `limits`, by another reading
    /// of the paper if `switches` say so.
    pub fn new(views: Views<'m, P>, limits: Limits<P::Scalar>, switches: Option<Switches>) -> Self {
        MethodTracer { views, limits, switches, method: PhantomData }
    }

    /// Slots of coherence memory that a lane needs.
    fn slots(&self) -> usize {
        if M::COHERENT { self.views.scene.len() } else { 0 }
    }
}

/// What outcomes of the method `M` tell: [`Found`], or a list of them.
pub type Told<M, P> = <<M as Method<P>>::Hits as Hits<<P as Point>::Scalar>>::Of<Found>;

impl<M: Method<P>, P: Point> Tracer<Told<M, P>> for MethodTracer<'_, M, P> {
    fn lane(&self) -> Box<dyn Lane<Told<M, P>> + '_> {
        Box::new(MethodLane {
            tracer: self,
            scratch: M::Scratch::default(),
            basis: Basis::new(),
            memory: vec![Remembered::EMPTY; self.slots()],
            line: 0,
            ready: Vec::new(),
            found: Vec::new(),
        })
    }

    fn lane_bytes(&self) -> LaneBytes {
        LaneBytes {
            coherence: (self.slots() * size_of::<Remembered<P::Scalar>>()) as u64,
            line: 0,
            scratch: size_of::<M::Scratch>() as u64,
        }
    }

    fn is_coherent(&self) -> bool {
        M::COHERENT
    }

    fn refusal(&self, ray: &RayLine) -> Option<RayError> {
        let (place, origin) = Place::of(ray.origin, self.views.scene.frame().origin());
        self.views.at(place).scene.ray(origin, ray.direction.map(P::Scalar::from_f64)).err()
    }
}

/// A ray in the method's precision; `None` where it is not to be traced.
type Ready<S> = Option<(Place, [S; 3], [S; 3], Interval<S>)>;

/// A ray's answer, or why the kernel refused it; `None` where it was not traced.
type Traced<H> = Option<Result<Answer<H>, RayError>>;

struct MethodLane<'t, M: Method<P>, P: Point> {
    tracer: &'t MethodTracer<'t, M, P>,
    scratch: M::Scratch,
    basis: Basis<P::Scalar, ORDER>,
    memory: Vec<Remembered<P::Scalar>>,
    /// The number of the scan line. It stamps the memory of this lane, and no other's.
    line: u32,
    ready: Vec<Ready<P::Scalar>>,
    found: Vec<Traced<M::Hits>>,
}

/// The counters of rays, one after another. A ray's are summed after the next ray: read at once, they would wait for the
/// kernel's last stores.
struct Counting<'s> {
    sums: &'s mut [u64; Work::COUNT],
    each: Option<&'s mut Vec<Work>>,
    works: [Work; 2],
    rays: usize,
}

impl<'s> Counting<'s> {
    fn new(tally: &'s mut Tally) -> Self {
        Counting { sums: &mut tally.work, each: tally.each.as_mut(), works: [Work::default(); 2], rays: 0 }
    }

    /// The counters of the next ray.
    #[inline(always)]
    fn next(&mut self) -> &mut Work {
        let work = &mut self.works[self.rays & 1];
        if self.rays >= 2 {
            add(self.sums, &mut self.each, work);
        }
        self.rays += 1;
        *work = Work::default();
        work
    }

    /// Sums what is left.
    fn end(mut self) {
        for ray in self.rays.saturating_sub(2)..self.rays {
            add(self.sums, &mut self.each, &self.works[ray & 1]);
        }
    }
}

#[inline(always)]
fn add(sums: &mut [u64; Work::COUNT], each: &mut Option<&mut Vec<Work>>, work: &Work) {
    for (sum, count) in sums.iter_mut().zip(work.counts()) {
        *sum += u64::from(count);
    }
    if let Some(each) = each {
        each.push(*work);
    }
}

/// Rays that are made ready and traced at a time: few enough for their numbers to stay in the nearest cache beside the
/// scene's, enough for reading the clock around them not to count.
const BLOCK: usize = 64;

impl<M: Method<P>, P: Point> Lane<Told<M, P>> for MethodLane<'_, M, P> {
    fn trace(&mut self, rays: &[RayLine], continues: bool, outcomes: &mut Vec<Outcome<Told<M, P>>>, tally: &mut Tally) {
        if !continues {
            begin_line(&mut self.line, &mut self.memory);
        }
        tally.rays += rays.len() as u64;
        for block in rays.chunks(BLOCK) {
            self.ready.clear();
            let origin = self.tracer.views.scene.frame().origin();
            self.ready.extend(block.iter().map(|ray| ready(ray, origin)));
            self.trace_ready(tally);
            for traced in self.found.drain(..) {
                let outcome = outcome(&self.tracer.views.scene, &mut self.basis, traced);
                tally.count_outcome(&outcome);
                outcomes.push(outcome);
            }
        }
    }
}

impl<M: Method<P>, P: Point> MethodLane<'_, M, P> {
    /// Traces what is ready, into `found`; this is what is timed.
    fn trace_ready(&mut self, tally: &mut Tally) {
        self.found.clear();
        let MethodTracer { views, limits, switches, .. } = self.tracer;
        let of_nets = &views.at(Place::Nets);
        let clock = Clock::start();
        let mut counting = Counting::new(tally);
        self.found.extend(self.ready.iter().map(|ready| {
            let work = counting.next();
            ready.as_ref().map(|(place, origin, direction, interval)| {
                let views = if *place == Place::File { views } else { of_nets };
                let ray = &views.scene.ray(*origin, *direction)?;
                let coherence = Coherence { memory: &mut self.memory, line: self.line };
                let task = &Task { ray, interval, limits, switches: *switches };
                Ok(M::answer(views, coherence, task, &mut self.scratch, work))
            })
        }));
        counting.end();
        tally.seconds += clock.seconds();
    }
}

/// Goes on to the number of a new scan line.
fn begin_line<S: Scalar>(line: &mut u32, memory: &mut [Remembered<S>]) {
    // The method allows numbers up to 2^32 - 2; before they run out, the memory is emptied and they start again.
    if *line >= u32::MAX - 2 {
        memory.fill(Remembered::EMPTY);
        *line = 0;
    }
    *line += 1;
}

/// What became of a ray, in `f64` and with normals.
fn outcome<H: Hits<P::Scalar>, P: Point>(
    scene: &Scene<'_, P>,
    basis: &mut Basis<P::Scalar, ORDER>,
    traced: Traced<H>,
) -> Outcome<H::Of<Found>> {
    let mut told = |hits: H| hits.each(|hit| found(scene, basis, hit));
    match traced {
        None => Outcome::Invalid,
        Some(Err(error)) => Outcome::Refused(error),
        Some(Ok(Ok(None))) => Outcome::Miss,
        Some(Ok(Ok(Some(hits)))) => Outcome::Hit(told(hits)),
        Some(Ok(Err(Stopped { limit, best }))) => Outcome::GaveUp { limit: limit.name(), best: best.map(told) },
    }
}

/// How far toward the middle of its surface a place is nearby, as a share of the way.
const NEARBY: f64 = 1e-3;

/// A hit of a scene in `f64`, with its normal.
pub fn found<P: Point>(scene: &Scene<'_, P>, basis: &mut Basis<P::Scalar, ORDER>, hit: &Hit<P::Scalar>) -> Found {
    // The basis is large enough for every degree.
    let mut normal = |hit: &Hit<P::Scalar>| {
        scene.normal(hit, &mut basis.view()).ok().flatten().map(|normal| normal.map(Scalar::to_f64))
    };
    let normal = normal(hit).map(Normal::There).unwrap_or_else(|| {
        let inward = |c: P::Scalar| c + (P::Scalar::HALF - c) * P::Scalar::from_f64(NEARBY);
        let nearby = Hit { u: inward(hit.u), v: inward(hit.v), ..*hit };
        normal(&nearby).map_or(Normal::Nowhere, Normal::Nearby)
    });
    Found {
        t: hit.t.to_f64(),
        u: hit.u.to_f64(),
        v: hit.v.to_f64(),
        surface: hit.surface as usize,
        normal,
        incidence: hit.incidence,
    }
}

/// The ray in the method's precision, of a scene with this origin. Rounding keeps the order of `t_min` and `t_max`.
fn ready<S: Scalar>(ray: &RayLine, origin: [S; 3]) -> Ready<S> {
    let (place, origin) = Place::of(ray.origin, origin);
    let interval = Interval::new(S::from_f64(ray.t_min), S::from_f64(ray.t_max));
    interval.filter(|_| ray.valid).map(|interval| (place, origin, ray.direction.map(S::from_f64), interval))
}

#[cfg(test)]
mod tests;
