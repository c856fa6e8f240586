//! Many rays on many threads: lanes to borrow, and a long row of rays traced block by block.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use crate::scanline::{Found, Lane, Outcome, Tally, Tracer};
use crate::scene::rays::RayLine;

/// Lanes that threads borrow: as many are made as are in use at once.
pub struct Lanes<'t, H = Found> {
    tracer: &'t dyn Tracer<H>,
    idle: Mutex<Vec<Box<dyn Lane<H> + 't>>>,
}

impl<'t, H> Lanes<'t, H> {
    /// No lanes yet.
    pub fn new(tracer: &'t dyn Tracer<H>) -> Self {
        Lanes { tracer, idle: Mutex::new(Vec::new()) }
    }

    /// Runs `work` with a lane.
    pub fn with<R>(&self, work: impl FnOnce(&mut dyn Lane<H>) -> R) -> R {
        let mut lane = self.take();
        let result = work(lane.as_mut());
        self.give(lane);
        result
    }

    fn take(&self) -> Box<dyn Lane<H> + 't> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        idle.unwrap_or_else(|| self.tracer.lane())
    }

    fn give(&self, lane: Box<dyn Lane<H> + 't>) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(lane);
    }
}

/// How many rays of a long line one job takes, where the order of rays does not matter. Fewer spread better over threads;
/// more ask for the clock less often.
const SHARE: usize = 1024;

/// Traces a long row of rays block by block. A scan line is a run of rays with one number; it may go on from block to block.
pub struct Batch<'t, H = Found> {
    lanes: Lanes<'t, H>,
    /// The lane of the line that the last block ended with, and the number of that line.
    open: Option<(Box<dyn Lane<H> + 't>, u64)>,
    tally: Tally,
}

impl<'t, H: Send> Batch<'t, H> {
    /// Nothing traced yet.
    pub fn new(tracer: &'t dyn Tracer<H>) -> Self {
        Batch { lanes: Lanes::new(tracer), open: None, tally: Tally::default() }
    }

    /// What was done so far.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Traces the next rays, on rayon's current threads; an outcome per ray, in order. How rays are cut into blocks changes
    /// neither outcomes nor counters.
    pub fn trace(&mut self, rays: &[RayLine]) -> Vec<Outcome<H>> {
        let coherent = self.lanes.tracer.is_coherent();
        let lines = rays.chunk_by(|a, b| a.scan_line == b.scan_line);
        let jobs: Vec<&[RayLine]> =
            if coherent { lines.collect() } else { lines.flat_map(|line| line.chunks(SHARE)).collect() };
        let (Some(first), Some(last)) = (rays.first(), rays.last()) else {
            return Vec::new();
        };
        let open = self.open.take().and_then(|(lane, line)| {
            if coherent && line == first.scan_line {
                return Some(lane);
            }
            self.lanes.give(lane);
            None
        });
        let open = Mutex::new(open);
        let still_open = Mutex::new(None);
        let lanes = &self.lanes;
        let done: Vec<(Vec<Outcome<H>>, Tally)> = jobs
            .par_iter()
            .enumerate()
            .map(|(number, line)| {
                let carried =
                    if number == 0 { open.lock().unwrap_or_else(PoisonError::into_inner).take() } else { None };
                let continues = carried.is_some();
                let mut lane = carried.unwrap_or_else(|| lanes.take());
                let (mut outcomes, mut tally) = (Vec::with_capacity(line.len()), Tally::default());
                lane.trace(line, continues, &mut outcomes, &mut tally);
                if number + 1 == jobs.len() {
                    *still_open.lock().unwrap_or_else(PoisonError::into_inner) = Some(lane);
                } else {
                    lanes.give(lane);
                }
                (outcomes, tally)
            })
            .collect();
        let still_open = still_open.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.open = still_open.map(|lane| (lane, last.scan_line));
        let mut outcomes = Vec::with_capacity(rays.len());
        for (part, tally) in done {
            outcomes.extend(part);
            self.tally.add(&tally);
        }
        outcomes
    }
}
