//! Budgets from 0 up: a call does no more than they say, and a larger one takes no answer back.

use crate::bytes::Bytes;
use crate::claims::{in_range, within_limits};
use crate::common::Kind;
use crate::input::{Case, OfKind, any_limits, any_subdivision, budgets_of, interval, with_kind};
use crate::lane::{Lane, Way};
use crate::ready::prepare;
use crate::scribble::scribble;
use patchray::scalar::Scalar;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let case = Case::any(&mut bytes, 3);
    with_kind(&case, bytes, Budgets);
}

struct Budgets;

impl OfKind for Budgets {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let surfaces = case.model.surfaces.len();
        let Some(prepared) = prepare::<P>(&case.model, &any_subdivision(&mut bytes)) else {
            return;
        };
        let line = case.ray(&mut bytes);
        let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
        let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(&line)) else {
            return;
        };
        let mut lane = Lane::<P>::new(surfaces);
        scribble(&mut bytes, &mut lane.remembered);
        let (kept, scan_line) = (lane.remembered.clone(), bytes.count());
        let most = any_limits::<P::Scalar>(&mut bytes);
        for way in Way::ALL {
            let mut run = |limits: &_| {
                lane.remembered.clone_from(&kept);
                let answer = lane.closest(way, &prepared, scan_line, &ray, &interval, limits);
                within_limits(&lane.work, limits, way);
                (answer, lane.work)
            };
            let (full, used) = run(&most);
            // Some budgets smaller than those, by a little or by much, and others smaller still.
            let mut small = most;
            let mut steps = vec![(most, full, used)];
            for _ in 0..2 {
                for budget in budgets_of(&mut small) {
                    *budget = match bytes.below(4) {
                        0 | 1 => *budget,
                        2 => budget.saturating_sub(u32::from(bytes.byte())),
                        _ => (*budget).min(u32::from(bytes.byte()) / 2),
                    };
                }
                let (answer, work) = run(&small);
                steps.push((small, answer, work));
            }
            for (limits, answer, _) in &steps {
                if let Some(hit) = answer.unwrap_or_else(|gave_up| gave_up.best) {
                    in_range(&hit, [interval.min(), interval.max()], surfaces, (way, limits));
                }
            }
            // The larger, and then the smaller.
            for pair in steps.windows(2) {
                let [(larger, most, used), (smaller, least, took)] = pair else { unreachable!("pairs") };
                if least.is_ok() {
                    // No bound was met, so that a larger one changes nothing at all.
                    assert_eq!((most, used), (least, took), "{way:?}: with {larger:?}, and with {smaller:?}");
                }
                let (more, less) = (used.counts(), took.counts());
                assert!(more.iter().zip(less).all(|(&more, less)| less <= more), "{way:?}: {took:?} of {used:?}");
            }
        }
    }
}
