//! Surfaces, rays and limits of any bits through the methods for rays of no view, one at a time.

use crate::bytes::Bytes;
use crate::claims::{in_range, on_the_ray, within_limits, within_worst_case};
use crate::common::Kind;
use crate::input::{Case, OfKind, any_limits, any_subdivision, interval, with_kind};
use crate::lane::{Lane, Way};
use crate::ready::prepare_apart;
use crate::scribble::scribble;
use patchray::scalar::Scalar;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let way = bytes.one_of(&Way::ALL);
    let case = Case::any(&mut bytes, 3);
    with_kind(&case, bytes, Methods(way));
}

struct Methods(Way);

impl OfKind for Methods {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let Methods(way) = self;
        let Some(prepared) = prepare_apart::<P>(&case.model, &any_subdivision(&mut bytes), way.takes()) else {
            return;
        };
        let mut lane = Lane::<P>::new(case.model.surfaces.len());
        let scan_line = bytes.count();
        scribble(&mut bytes, &mut lane.remembered);
        for _ in 0..1 + bytes.below(3) {
            let line = case.ray(&mut bytes);
            let limits = any_limits::<P::Scalar>(&mut bytes);
            let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
            let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(&line)) else {
                continue;
            };
            let range = [interval.min(), interval.max()];
            let answer = lane.closest(way, &prepared, scan_line, &ray, &interval, &limits);
            within_limits(&lane.work, &limits, way);
            let extent = way.extent(&prepared, limits.acceptance);
            within_worst_case(&lane.work, &limits, &extent, way);
            // What was found before a bound ran out is a root too, if no answer.
            let found = answer.unwrap_or_else(|gave_up| gave_up.best);
            let lists = lane.all_and_any(way, &prepared, &ray, &interval, &limits);
            let mut hits: Vec<_> = found.into_iter().collect();
            if let Some(lists) = lists {
                for work in &lists.work {
                    within_limits(work, &limits, way);
                    within_worst_case(work, &limits, &extent, way);
                }
                hits.extend(lists.any.unwrap_or_else(|gave_up| gave_up.best));
                hits.extend(lists.found);
                hits.extend(lists.all.map_or_else(|gave_up| gave_up.best, |_| None));
            }
            for hit in &hits {
                in_range(hit, range, case.model.surfaces.len(), way);
                on_the_ray(hit, case, &line, &limits, 0.0, way);
            }
        }
    }
}
