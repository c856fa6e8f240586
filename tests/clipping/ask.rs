//! One ray through all of clipping's functions, and what has to hold of their answers whatever the ray.

use crate::common::{Built, Kind};
use patchray::limits::{GaveUp, Limit, Limits, Work};
use patchray::method::{ClipScratch, clipping};
use patchray::ray::{Hit, Incidence, Interval};
use patchray::scalar::Scalar;

/// Room for every degree, and for more regions than numbers of 53 bits can be halved apart.
pub(crate) type Room<P> = ClipScratch<P, 16, 256, 64>;

/// Hits that a list holds where it is to be long enough.
pub(crate) const MANY: usize = 128;

/// A hit, a miss, or what ran out.
pub(crate) type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// A ray: origin, direction, and the values of t that count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub(crate) origin: [f64; 3],
    pub(crate) direction: [f64; 3],
    pub(crate) range: [f64; 2],
}

impl Query {
    /// All that lies ahead of `origin`.
    pub(crate) fn new(origin: [f64; 3], direction: [f64; 3]) -> Self {
        Query { origin, direction, range: [0.0, f64::INFINITY] }
    }

    /// Rounded to `f32`, so that both precisions trace what the oracle judges.
    pub(crate) fn exact(self) -> Self {
        let round = |v: [f64; 3]| v.map(|c| f64::from(c as f32));
        Query { origin: round(self.origin), direction: round(self.direction), ..self }
    }

    pub(crate) fn interval<S: Scalar>(&self) -> Interval<S> {
        let [from, to] = self.range.map(S::from_f64);
        Interval::new(from, to).unwrap()
    }
}

/// What a ray was answered; `any_hit`'s answer is compared with these and left.
#[derive(Clone, Debug)]
pub(crate) struct Answers<S> {
    /// By `all_hits`, and its list.
    pub(crate) all: Result<(), GaveUp<S>>,
    pub(crate) hits: Vec<Hit<S>>,
    pub(crate) closest: Answer<S>,
    /// What each of the three took.
    pub(crate) work: [Work; 3],
}

/// Asks all three, and checks what holds of any ray: budgets kept, hits in order and in range, one story told by all.
pub(crate) fn ask<P: Kind>(
    built: &Built<P>,
    query: &Query,
    limits: &Limits<P::Scalar>,
    room: &mut Room<P>,
) -> Answers<P::Scalar> {
    let scene = built.scene();
    let (origin, d) = (query.origin.map(P::Scalar::from_f64), query.direction.map(P::Scalar::from_f64));
    let ray = scene.ray(origin, d).unwrap_or_else(|error| panic!("{error}: {query:?}"));
    let interval = query.interval();
    let mut list = heapless::Vec::<_, MANY>::new();
    let mut work = [Work::default(); 3];
    let [a, b, c] = &mut work;
    let all = clipping::all_hits(&scene, &ray, &interval, limits, &mut room.view(), &mut list, a);
    let closest = clipping::closest(&scene, &ray, &interval, limits, &mut room.view(), b);
    let any = clipping::any_hit(&scene, &ray, &interval, limits, &mut room.view(), c);
    let hits = list.to_vec();
    for work in &work {
        assert!(work.clip_steps <= limits.clip_steps && work.bisections <= limits.bisections, "{work:?} {query:?}");
        assert!(work.newton_steps <= limits.newton_steps, "{work:?} {query:?}");
        assert!(work.surfaces_tested <= limits.surfaces && work.voxels_visited <= limits.voxels);
        assert!(work.bisection_cases <= scene.len() as u32 && work.bisection_cases <= work.bisections);
        // Nothing but clips, bisections and steps of the contraction: no patches, no trees, no starts.
        assert_eq!((work.patches_tested, work.nodes_visited, work.newton_starts), (0, 0, 0));
    }
    assert!(hits.windows(2).all(|pair| pair[0].t <= pair[1].t), "{hits:?} {query:?}");
    let closest_hit = closest.as_ref().map_or_else(|gave_up| gave_up.best, |hit| *hit);
    for hit in hits.iter().chain(&closest_hit) {
        let [zero, one] = [P::Scalar::ZERO, P::Scalar::ONE];
        assert!(interval.min() <= hit.t && hit.t <= interval.max(), "{hit:?} {query:?}");
        assert!(zero <= hit.u && hit.u <= one && zero <= hit.v && hit.v <= one, "{hit:?} {query:?}");
        assert!((hit.surface as usize) < scene.len());
    }
    if all.is_ok() {
        // The whole search ended, and the others do no more than it.
        let closest = closest.unwrap_or_else(|error| panic!("{error}: {query:?}"));
        assert_eq!(closest.is_some(), !hits.is_empty(), "{query:?}");
        if let (Some(closest), Some(first)) = (closest, hits.first()) {
            // A graze beyond its surface's box, which the closest hit so far hides, is known to half the digits.
            let graze = first.surface != closest.surface && hits.contains(&closest);
            let near = limits.tolerance.sqrt().to_f64() * 8.0 * built.scene().frame().diagonal().to_f64();
            let apart = (closest.t - first.t).abs().to_f64() * crate::common::norm(query.direction);
            let apart = apart * f64::from(built.scene().frame().exponent()).exp2();
            assert!(closest.t == first.t || (graze && apart < near), "{closest:?} {hits:?} {query:?}");
        }
        let any = any.unwrap_or_else(|error| panic!("{error}: {query:?}"));
        assert_eq!(any.is_some(), !hits.is_empty(), "{query:?}");
        assert!(any.is_none_or(|any| is_one_of(&any, &hits, built, query)), "{any:?} is none of {hits:?}: {query:?}");
    }
    Answers { all, hits, closest, work }
}

/// Whether a hit is one of a list, in which a root stands for those that it cannot be told from and that were found before it:
/// where the ray all but grazes half the digits are known, and where it lies in the surface they are anywhere from where that
/// begins.
fn is_one_of<P: Kind>(hit: &Hit<P::Scalar>, hits: &[Hit<P::Scalar>], built: &Built<P>, query: &Query) -> bool {
    let scene = built.scene();
    let size = scene.frame().diagonal().to_f64();
    let unit = crate::common::norm(query.direction) * f64::from(scene.frame().exponent()).exp2();
    let tolerance = P::Scalar::TOLERANCE.to_f64();
    hits.iter().filter(|listed| listed.surface == hit.surface).any(|listed| {
        let apart = (hit.t - listed.t).to_f64() * unit;
        // Two grazes may be of contact of higher order, as flat as a fourth power in the families here.
        let grazes = listed.incidence != Incidence::Crossing && hit.incidence != Incidence::Crossing;
        let digits = if grazes { 0.25 } else { 0.5 };
        let near = 8.0 * tolerance.powf(digits) * size;
        apart >= -near && (apart <= near || listed.incidence == Incidence::Contact)
    })
}

/// The bound that a call ran out of.
pub(crate) fn limit<T, S>(answer: &Result<T, GaveUp<S>>) -> Option<Limit> {
    answer.as_ref().err().map(|gave_up| gave_up.limit)
}

/// The most that rays took, by family.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Most {
    pub(crate) rays: u32,
    pub(crate) clip_steps: u32,
    pub(crate) bisections: u32,
    pub(crate) newton_steps: u32,
    pub(crate) gave_up: u32,
}

impl Most {
    pub(crate) fn add<S>(&mut self, answers: &Answers<S>) {
        let [all, ..] = &answers.work;
        self.rays += 1;
        self.gave_up += u32::from(answers.all.is_err());
        self.clip_steps = self.clip_steps.max(all.clip_steps);
        self.bisections = self.bisections.max(all.bisections);
        self.newton_steps = self.newton_steps.max(all.newton_steps);
    }
}
