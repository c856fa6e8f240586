//! One surface of low degree, or one with a mate, and one ray, by one of the methods that prove what they answer. The oracle is
//! asked of every ray, whatever the answer.

use crate::bytes::Bytes;
use crate::claims::on_the_ray;
use crate::common::Kind;
use crate::input::{Case, OfKind, interval, limits, subdivision, with_kind};
use crate::lane::{Lane, Way};
use crate::ready::prepare_apart;
use crate::truth::{Original, Truth};
use patchray::scalar::Scalar;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let choice = bytes.byte();
    let case = Case::tame(&mut bytes, 1, 3);
    with_kind(&case, bytes, Honest(choice));
}

/// By which method.
struct Honest(u8);

/// So many choices in turn are the same method.
const ALIKE: usize = 8;

impl OfKind for Honest {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let options = subdivision(&mut bytes);
        let line = case.ray(&mut bytes);
        let limits = limits::<P::Scalar>(&mut bytes);
        let proving: Vec<_> = Way::ALL.into_iter().filter(|way| way.proves(limits.acceptance)).collect();
        let Honest(choice) = self;
        let way = proving[usize::from(choice) / ALIKE % proving.len()];
        let Some(prepared) = prepare_apart::<P>(&case.model, &options, way.takes()) else {
            return;
        };
        let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
        let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(&line)) else {
            return;
        };
        let mut lane = Lane::<P>::new(case.model.surfaces.len());
        let name = format!("{way:?} {:?}", limits.acceptance);
        let answer = Truth::new(case, &line, 0.0)
            .judged(&name, &limits, Original::Open, |limits| lane.closest(way, &prepared, 0, &ray, &interval, limits));
        for hit in answer.into_iter().flatten() {
            on_the_ray(&hit, case, &line, &limits, 0.0, &name);
        }
    }
}
