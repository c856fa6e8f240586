//! One surface of low degree and one ray, by one of the methods that prove what they answer, against the oracle.

use crate::bytes::Bytes;
use crate::common::Kind;
use crate::input::{Case, OfKind, interval, limits, subdivision, with_kind};
use crate::lane::{Lane, Way};
use crate::ready::prepare;
use crate::truth::{alike, none_lost, outcome};
use patchray::scalar::Scalar;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let choice = bytes.byte();
    let case = Case::tame(&mut bytes, 1, 3);
    with_kind(&case, bytes, Honest(choice));
}

/// By which method, and whether the oracle is asked in any case.
struct Honest(u8);

/// One input in so many asks the oracle, whatever the answers.
const ORACLE: usize = 8;

impl OfKind for Honest {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let options = subdivision(&mut bytes);
        let line = case.ray(&mut bytes);
        let limits = limits::<P::Scalar>(&mut bytes);
        let proving: Vec<_> = Way::ALL.into_iter().filter(|way| way.proves(limits.acceptance)).collect();
        let Honest(choice) = self;
        let way = proving[usize::from(choice) / ORACLE % proving.len()];
        let Some(prepared) = prepare::<P>(&case.model, &options, way.takes()) else {
            return;
        };
        let [origin, direction] = [line.origin, line.direction].map(|v| v.map(P::Scalar::from_f64));
        let (Ok(ray), Some(interval)) = (prepared.scene().ray(origin, direction), interval(&line)) else {
            return;
        };
        let mut lane = Lane::<P>::new(1);
        let mut answer = |way| {
            let answer = lane.closest(way, &prepared, 0, &ray, &interval, &limits);
            (format!("{way:?} {:?}", limits.acceptance), outcome(&prepared, &answer))
        };
        let mut answers = vec![answer(way)];
        // The oracle takes longer than many methods: most answers are held against clipping's first.
        if usize::from(choice) % ORACLE != 0 && way != Way::Clipping {
            answers.push(answer(Way::Clipping));
            if alike(case, &answers[0].1, &answers[1].1) {
                return;
            }
        }
        none_lost(case, &line, &answers);
    }
}
