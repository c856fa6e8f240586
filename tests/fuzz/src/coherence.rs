//! Coherence memory of any bits: where all that is answered is proved, coherent and original methods answer as the oracle does, and
//! the coherent ones answer whatever their originals do.

use crate::bytes::Bytes;
use crate::claims::{in_range, on_the_ray, within_limits, within_worst_case};
use crate::common::Kind;
use crate::input::{Case, OfKind, interval, limits, subdivision, with_kind};
use crate::lane::{Lane, Way};
use crate::ready::prepare_apart;
use crate::scribble::scribble;
use crate::truth::{Original, Truth};
use patchray::limits::{Acceptance, Limits};
use patchray::scalar::Scalar;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let way = bytes.one_of(&[Way::NewtonCoherentProving, Way::ClippingCoherent, Way::NewtonProving]);
    let case = Case::tame(&mut bytes, 3, 6);
    with_kind(&case, bytes, Coherence(way));
}

/// By this, and by the method that it is the coherent form of.
struct Coherence(Way);

impl OfKind for Coherence {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let Coherence(way) = self;
        let surfaces = case.model.surfaces.len();
        let Some(prepared) = prepare_apart::<P>(&case.model, &subdivision(&mut bytes), way.takes()) else {
            return;
        };
        let mut lane = Lane::<P>::new(surfaces);
        let mut scan_line = bytes.count();
        let limits = Limits { acceptance: Acceptance::Proved, ..limits::<P::Scalar>(&mut bytes) };
        let mut line = case.ray(&mut bytes);
        for _ in 0..1 + bytes.below(5) {
            match bytes.below(4) {
                0 => line = case.ray(&mut bytes),
                // Next to the one before, as along a scan line.
                1 | 2 => {
                    let axis = bytes.below(3);
                    let step = f64::from(bytes.byte() as i8) / 4096.0;
                    let moved = line.direction[axis] + step * line.direction[(axis + 1) % 3];
                    line.direction[axis] = crate::input::in_precision(moved, case.precision);
                }
                _ => {
                    scan_line = if bytes.rarely(2) { bytes.count() } else { scan_line };
                    scribble(&mut bytes, &mut lane.remembered);
                }
            }
            let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
            let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(&line)) else {
                continue;
            };
            let range = [interval.min(), interval.max()];
            let truth = Truth::new(case, &line, 0.0);
            let mut original = Original::Open;
            for way in [way.original().unwrap_or(Way::Clipping), way] {
                let kept = lane.remembered.clone();
                let extent = way.extent(&prepared, limits.acceptance);
                let bound = if way.original().is_some() { original } else { Original::Open };
                let answer = truth.judged(&format!("{way:?}"), &limits, bound, |limits| {
                    // Memory as it was: what a search leaves there would help the next.
                    lane.remembered.clone_from(&kept);
                    let answer = lane.closest(way, &prepared, scan_line, &ray, &interval, limits);
                    within_limits(&lane.work, limits, way);
                    within_worst_case(&lane.work, limits, &extent, way);
                    answer
                });
                original = if answer.is_ok() { Original::Answers } else { Original::Open };
                for hit in answer.into_iter().flatten() {
                    in_range(&hit, range, surfaces, way);
                    on_the_ray(&hit, case, &line, &limits, 0.0, way);
                }
            }
        }
    }
}
