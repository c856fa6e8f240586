//! Drives the rays of a picture along its scan lines by what they share: the kernel's views.

use std::marker::PhantomData;

use patchray::arena::Need;
use patchray::bernstein::Basis;
use patchray::limits::{Limit, Limits, Work};
use patchray::line::{Line, LineMemory, LineNeeds, Window};
use patchray::method::{Followed, Following};
use patchray::point::Point;
use patchray::ray::{Hit, Interval, RayError};
use patchray::scalar::Scalar;
use patchray::scene::Scene;
use patchray::span::Span;
use patchray::view::View;

use super::{BLOCK, Found, Lane, LaneBytes, Outcome, Tally, Traced, Tracer, outcome};
use crate::clock::Clock;
use crate::lower::ORDER;
use crate::method::in_view::ViewMethod;
use crate::scene::camera;
use crate::scene::rays::RayLine;
use crate::scene::sampling::ScanLine;

/// Buckets of a scan line. Fewer make the list of spans be rebuilt from longer chains, more are cleared and passed for
/// nothing: on the common view 64 to 1,024 take the same time to 3 %.
const BUCKETS: usize = 256;

/// The tracer of a method for the scan lines of one picture. Rays that are none of them, such as those that mirrors
/// send on, are left to another tracer.
pub struct ViewTracer<'m, M, P: Point> {
    scene: Scene<'m, P>,
    view: View<'m, P>,
    limits: Limits<P::Scalar>,
    /// Whether rays leave something to the next.
    coherence: bool,
    needs: LineNeeds,
    others: Option<Box<dyn Tracer + 'm>>,
    method: PhantomData<M>,
}

impl<'m, M: ViewMethod<P>, P: Point> ViewTracer<'m, M, P> {
    /// The tracer of the method `M` for the scan lines of `picture`, of which `view` is the kernel's view. It asks the
    /// kernel for the memory of each scan line, to lend the most. Without `coherence` it begins anew with every ray: what it
    /// then gains is owed to its order of search alone. `others` traces all other rays; without it they are given up.
    pub fn new(
        (scene, view): (Scene<'m, P>, View<'m, P>),
        picture: &camera::View,
        limits: Limits<P::Scalar>,
        coherence: bool,
        others: Option<Box<dyn Tracer + 'm>>,
    ) -> Self {
        let mut tracer =
            ViewTracer { scene, view, limits, coherence, needs: LineNeeds::default(), others, method: PhantomData };
        for line in 0..picture.scan_lines() {
            let nothing = LineMemory { spans: &mut [], active: &mut [], buckets: &mut [] };
            if let Err(needs) = tracer.line(&picture.scan_line(line), nothing) {
                let most = |a: Need, b: Need| Need { needed: a.needed.max(b.needed), given: 0 };
                let LineNeeds { spans, active, buckets } = tracer.needs;
                tracer.needs = LineNeeds {
                    spans: most(spans, needs.spans),
                    active: most(active, needs.active),
                    buckets: most(buckets, needs.buckets),
                };
            }
        }
        tracer
    }

    /// A scan line, ready for its rays.
    fn line<'l>(&self, line: &ScanLine, memory: LineMemory<'l, P::Scalar>) -> Result<Line<'l, P::Scalar>, LineNeeds> {
        let x = |sample: Option<&[f64; 2]>| sample.map_or(P::Scalar::ZERO, |&[x, _]| P::Scalar::from_f64(x));
        let (first, last) = (x(line.samples.first()), x(line.samples.last()));
        let [a, b] = line.sy.map(P::Scalar::from_f64);
        let window = Window { x: [first, last], y: if a < b { [a, b] } else { [b, a] } };
        Line::build(&self.view, window, memory)
    }
}

/// What a lane of the method `M` takes of `surfaces` surfaces for scan lines of these needs.
fn lane_bytes<M: ViewMethod<P>, P: Point>(surfaces: usize, needs: &LineNeeds) -> LaneBytes {
    let LineNeeds { spans, active, buckets } = needs;
    let numbers = active.needed + buckets.needed.max(BUCKETS);
    LaneBytes {
        coherence: (surfaces * size_of::<Followed<P::Scalar>>()) as u64,
        line: (spans.needed * size_of::<Span<P::Scalar>>() + numbers * size_of::<u32>()) as u64,
        scratch: size_of::<M::Scratch>() as u64,
    }
}

/// The most that a lane of the method `M` can take, wherever a view looks from: with all patches in one line.
pub fn most_lane_bytes<M: ViewMethod<P>, P: Point>(surfaces: usize, patches: usize) -> LaneBytes {
    let need = Need { needed: patches, given: 0 };
    lane_bytes::<M, P>(surfaces, &LineNeeds { spans: need, active: need, buckets: Need::default() })
}

impl<M: ViewMethod<P>, P: Point> Tracer for ViewTracer<'_, M, P> {
    fn lane(&self) -> Box<dyn Lane + '_> {
        Box::new(ViewLane {
            tracer: self,
            scratch: M::Scratch::default(),
            basis: Basis::new(),
            slots: vec![Followed::EMPTY; self.scene.len()],
            number: 0,
            spans: vec![Span::EMPTY; self.needs.spans.needed],
            active: vec![0; self.needs.active.needed],
            buckets: vec![0; self.needs.buckets.needed.max(BUCKETS)],
            ready: Vec::new(),
            found: Vec::new(),
            others: self.others.as_ref().map(|others| others.lane()),
        })
    }

    fn lane_bytes(&self) -> LaneBytes {
        let own = lane_bytes::<M, P>(self.scene.len(), &self.needs);
        let others = self.others.as_ref().map_or(LaneBytes::default(), |others| others.lane_bytes());
        LaneBytes { coherence: own.coherence + others.coherence, scratch: own.scratch + others.scratch, ..own }
    }

    fn is_coherent(&self) -> bool {
        true
    }

    fn refusal(&self, ray: &RayLine) -> Option<RayError> {
        let [origin, direction] = [ray.origin, ray.direction].map(|vector| vector.map(P::Scalar::from_f64));
        self.scene.ray(origin, direction).err()
    }
}

struct ViewLane<'t, M: ViewMethod<P>, P: Point> {
    tracer: &'t ViewTracer<'t, M, P>,
    scratch: M::Scratch,
    basis: Basis<P::Scalar, ORDER>,
    slots: Vec<Followed<P::Scalar>>,
    /// The last number that was given to a scan line.
    number: u32,
    spans: Vec<Span<P::Scalar>>,
    active: Vec<u32>,
    buckets: Vec<u32>,
    /// The places of rays in the image, in the method's precision.
    ready: Vec<[P::Scalar; 2]>,
    found: Vec<Traced<Hit<P::Scalar>>>,
    others: Option<Box<dyn Lane + 't>>,
}

impl<M: ViewMethod<P>, P: Point> Lane for ViewLane<'_, M, P> {
    fn trace(&mut self, rays: &[RayLine], continues: bool, outcomes: &mut Vec<Outcome>, tally: &mut Tally) {
        if let Some(others) = &mut self.others {
            return others.trace(rays, continues, outcomes, tally);
        }
        for _ in rays {
            let outcome = Outcome::GaveUp { limit: Limit::Line.name(), best: None };
            tally.rays += 1;
            tally.count_outcome(&outcome);
            outcomes.push(outcome);
        }
    }

    fn trace_line(&mut self, line: &ScanLine, rays: &[RayLine], outcomes: &mut Vec<Outcome>, tally: &mut Tally) {
        let step = u32::from(!self.tracer.coherence);
        let mut number = self.begin_line(line, step);
        let ViewLane { tracer, scratch, basis, slots, spans, active, buckets, ready, found, .. } = self;
        let ViewTracer { view, limits, scene, .. } = tracer;
        tally.rays += rays.len() as u64;
        let clock = Clock::start();
        let of_line = tracer.line(line, LineMemory { spans, active, buckets });
        tally.seconds += clock.seconds();
        let mut of_line = of_line.ok();
        // At the beginning of a line no surface was the last one.
        let mut memory = Following { slots, last: u32::MAX };
        let ahead = Interval::ahead();
        for block in line.samples.chunks(BLOCK) {
            ready.clear();
            ready.extend(block.iter().map(|sample| sample.map(P::Scalar::from_f64)));
            found.clear();
            let clock = Clock::start();
            // Of a view the kernel goes on counting from ray to ray.
            let mut work = Work::default();
            let mut each = tally.each.as_mut();
            if let Some(line) = &mut of_line {
                found.extend(ready.iter().map(|&place| {
                    number += step;
                    let before = each.is_some().then_some(work);
                    let answer = view.ray(place, &ahead).map(|ray| {
                        let answer = M::closest(view, line, &mut memory, number, &ray, limits, scratch, &mut work);
                        answer.map_err(Into::into)
                    });
                    if let (Some(each), Some(before)) = (&mut each, before) {
                        each.push(work.since(&before));
                    }
                    Some(answer)
                }));
            }
            tally.seconds += clock.seconds();
            for (sum, count) in tally.work.iter_mut().zip(work.counts()) {
                *sum += u64::from(count);
            }
            // Nothing was found only if a line needed more memory than any: then the rays were not traced.
            found.resize_with(block.len(), || None);
            for traced in found.drain(..) {
                let outcome: Outcome<Found> = outcome(scene, basis, traced);
                tally.count_outcome(&outcome);
                outcomes.push(outcome);
            }
        }
    }
}

impl<M: ViewMethod<P>, P: Point> ViewLane<'_, M, P> {
    /// The number of a new scan line; with a `step` of 1 each of its rays has the next one, and none is left to the
    /// next.
    fn begin_line(&mut self, line: &ScanLine, step: u32) -> u32 {
        let last = (line.samples.len() as u32).saturating_mul(step).saturating_add(1);
        // The method allows numbers up to 2^32 - 2; before they run out, the memory is emptied and they start again.
        if self.number >= u32::MAX.saturating_sub(last).saturating_sub(1) {
            self.slots.fill(Followed::EMPTY);
            self.number = 0;
        }
        let number = self.number + 1;
        self.number += last;
        number
    }
}

#[cfg(test)]
mod tests;
