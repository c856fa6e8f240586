//! One surface of low degree and one ray, by every method, against the oracle.

use crate::bytes::Bytes;
use crate::common::Kind;
use crate::input::{Case, OfKind, interval, limits, subdivision, with_kind};
use crate::lane::{Lane, Way};
use crate::ready::prepare;
use crate::truth::{none_lost, outcome};
use patchray::scalar::Scalar;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let case = Case::tame(&mut bytes, 1, 3);
    with_kind(&case, bytes, Honest);
}

struct Honest;

impl OfKind for Honest {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let Some(prepared) = prepare::<P>(&case.model, &subdivision(&mut bytes)) else {
            return;
        };
        let line = case.ray(&mut bytes);
        let limits = limits::<P::Scalar>(&mut bytes);
        let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
        let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(&line)) else {
            return;
        };
        let mut lane = Lane::<P>::new(1);
        let ways = Way::ALL.into_iter().filter(|way| way.proves(limits.acceptance));
        let answers: Vec<_> = ways
            .map(|way| {
                let answer = lane.closest(way, &prepared, 0, &ray, &interval, &limits);
                (format!("{way:?} {:?}", limits.acceptance), outcome(&prepared, &answer))
            })
            .collect();
        none_lost(case, &line, &answers);
    }
}
