//! Clipping with coherence gives clipping's answers, whatever its memory holds and in whatever order rays come.

use crate::ask::{Answer, Answers, Query, Room, ask};
use crate::common::{Built, Kind, Prepared, direction, index};
use patchray::limits::{Acceptance, Limits, Work};
use patchray::method::{Remembered, clipping_coherent};
use patchray::point::Plain;
use patchray::scalar::Scalar;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::shapes::{Random, bumpy, single};
use patchray_host::scene::teapot;

/// One ray by clipping with coherence.
pub(crate) fn trace<P: Kind>(
    prepared: &Prepared<P>,
    memory: &mut [Remembered<P::Scalar>],
    line: u32,
    query: &Query,
    limits: &Limits<P::Scalar>,
    room: &mut Room<P>,
) -> (Answer<P::Scalar>, Work) {
    let (scene, patches, grids) = (prepared.scene(), prepared.patches(), prepared.grids());
    let (origin, d) = (query.origin.map(P::Scalar::from_f64), query.direction.map(P::Scalar::from_f64));
    let ray = scene.ray(origin, d).unwrap();
    let (interval, mut work) = (query.interval(), Work::default());
    let room = &mut room.view();
    let answer =
        clipping_coherent::closest(&scene, &patches, &grids, memory, line, &ray, &interval, limits, room, &mut work);
    (answer, work)
}

/// Rays in order against clipping's own closest hits: the same where the rule is proved, nearly always by the paper's.
pub(crate) fn agree<P: Kind>(prepared: &Prepared<P>, name: &str, rays: &[(Query, u32, Answers<P::Scalar>)]) {
    let mut room = Room::<P>::new();
    for acceptance in [Acceptance::Proved, Acceptance::Paper] {
        let limits = Limits { acceptance, ..Default::default() };
        let mut memory = vec![Remembered::EMPTY; prepared.scene().len()];
        let (mut differ, mut verified, mut refused) = (0, 0, 0);
        for (query, line, answers) in rays {
            let (answer, work) = trace(prepared, &mut memory, *line, query, &limits, &mut room);
            verified += work.verified;
            refused += work.refused_as_critical + work.refused_by_list;
            let same = match (&answer, &answers.closest) {
                (Ok(Some(a)), Ok(Some(b))) => same_hit(a.t.to_f64(), b.t.to_f64(), P::Scalar::EPSILON.to_f64()),
                (a, b) => a == b,
            };
            if !same {
                differ += 1;
                println!("{name} {acceptance:?}: {answer:?} {:?} {query:?}", answers.closest);
            }
        }
        println!("{name} {acceptance:?}: {differ} of {} differ, {verified} verified, {refused} not", rays.len());
        let allowed = if acceptance == Acceptance::Proved { 0 } else { rays.len() / 500 };
        assert!(differ <= allowed, "{name} {acceptance:?}: {differ}");
    }
}

/// The same root, found along another way.
fn same_hit(a: f64, b: f64, epsilon: f64) -> bool {
    (a - b).abs() <= 1e4 * epsilon * (1.0 + b.abs())
}

/// Rays of the common view, 256 to a line, and clipping's answers.
fn common_view<P: Kind>(lines: u32) -> Vec<(Query, u32, Answers<P::Scalar>)> {
    let built = Built::<P>::new(&teapot::model().unwrap(), 1.0);
    let view = teapot::common_scene().unwrap().description.camera.view([256, 256]);
    let mut room = Room::<P>::new();
    let mut all = vec![];
    for line in 0..lines {
        for ray in patchray_host::scanline::row(&view, 256 * line / lines) {
            let RayLine { origin, direction, .. } = ray;
            let query = Query::new(origin, direction).exact();
            all.push((query, line, ask(&built, &query, &Limits::default(), &mut room)));
        }
    }
    all
}

#[test]
fn in_any_order_of_rays() {
    fn check<P: Kind>() {
        let prepared = Prepared::<P>::of(&teapot::model().unwrap());
        let mut rays = common_view::<P>(48);
        agree(&prepared, "scan lines", &rays);
        rays.reverse();
        agree(&prepared, "reversed", &rays);
        let mut random = Random(75);
        for k in (1..rays.len()).rev() {
            rays.swap(k, index(&mut random, k + 1));
        }
        agree(&prepared, "shuffled", &rays);
        // And as if all were one scan line: what the last ray left is of any other.
        rays.iter_mut().for_each(|ray| ray.1 = 0);
        agree(&prepared, "shuffled, one line", &rays);
    }
    check::<Plain<f64>>();
    check::<Plain<f32>>();
}

/// Coherence memory of any bits, as a caller's static may hold them.
fn memory_of<S: Scalar>(u: S, v: S, stamp: u32) -> Remembered<S> {
    /// As [`Remembered`] lies in memory.
    #[derive(Clone, Copy)]
    #[repr(C)]
    struct Raw<S> {
        u: S,
        v: S,
        stamp: u32,
    }
    assert_eq!(size_of::<Raw<S>>(), size_of::<Remembered<S>>());
    let raw = Raw { u, v, stamp };
    // SAFETY: both are plain numbers in the same order, by `repr(C)`, for which any bits are valid.
    #[allow(unsafe_code)]
    unsafe {
        core::mem::transmute_copy(&raw)
    }
}

/// Whatever lies in the memory, under the scan line's own stamp: the answers are clipping's.
#[test]
fn rubbish_in_the_memory() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
    {
        let model = teapot::model().unwrap();
        let (prepared, built) = (Prepared::<Plain<S>>::of(&model), Built::<Plain<S>>::new(&model, 1.0));
        let limits = Limits { acceptance: Acceptance::Proved, ..Default::default() };
        let (mut room, mut random) = (Room::new(), Random(76));
        let nan = S::from_f64(f64::NAN);
        let numbers = [nan, S::INFINITY, -S::INFINITY, S::MAX, -S::ONE, S::from_f64(1e9), S::ZERO, S::ONE, S::HALF];
        let mut bisected = 0;
        for line in 0..1500 {
            let (at, d) = (random.point(1.2), direction(&mut random, 0.0));
            let query = Query::new(core::array::from_fn(|k| at[k] - 6.0 * d[k] + [0.0, 0.0, 1.5][k]), d);
            let truth = ask(&built, &query, &limits, &mut room).closest;
            let mut some = || numbers[index(&mut random, numbers.len())];
            let mut memory: Vec<_> = (0..32).map(|_| memory_of(some(), some(), line + 1)).collect();
            for _ in 0..3 {
                let (answer, work) = trace(&prepared, &mut memory, line, &query, &limits, &mut room);
                bisected += work.bisection_cases;
                let same = match (&answer, &truth) {
                    (Ok(Some(a)), Ok(Some(b))) => same_hit(a.t.to_f64(), b.t.to_f64(), S::EPSILON.to_f64()),
                    (a, b) => a == b,
                };
                assert!(same, "{answer:?} {truth:?} {query:?}");
            }
        }
        assert!(bisected > 100, "{bisected}");
    }
    check::<f64>();
    check::<f32>();
}

/// A ray that gives up, or is refused, between two others changes neither answer nor work of the next by more than an empty
/// memory or that of the ray before would.
#[test]
fn a_ray_that_gives_up_leaves_nothing_harmful() {
    let model = single(bumpy(77, [3, 3], [0.0; 3], 2.0, 0.9));
    let prepared = Prepared::<Plain<f64>>::of(&model);
    let built = Built::<Plain<f64>>::new(&model, 1.0);
    let limits = Limits { acceptance: Acceptance::Proved, ..Default::default() };
    let (mut room, mut random) = (Room::new(), Random(78));
    let mut gave_up = 0;
    for line in 0..400 {
        let mut memory = [Remembered::EMPTY];
        let (eye, to) = (random.point(3.0), random.point(0.8));
        let mut last = memory;
        for step in 0..6 {
            let d = core::array::from_fn(|k| to[k] - eye[k] + 0.01 * f64::from(step));
            let query = Query::new(eye, d);
            let tight = Limits { clip_steps: 1 + step % 4, ..limits };
            let (answer, _) = trace(&prepared, &mut memory, line, &query, &tight, &mut room);
            if answer.is_err() {
                gave_up += 1;
                assert!(memory == last || memory == [Remembered::EMPTY], "{memory:?}");
            }
            assert!(prepared.scene().ray([f64::NAN; 3], d).is_err());
            let truth = ask(&built, &query, &limits, &mut room).closest.unwrap();
            let (answer, _) = trace(&prepared, &mut memory, line, &query, &limits, &mut room);
            let answer = answer.unwrap();
            assert_eq!(answer.is_some(), truth.is_some());
            if let (Some(a), Some(b)) = (answer, truth) {
                assert!(same_hit(a.t, b.t, f64::EPSILON), "{a:?} {b:?}");
            }
            last = memory;
        }
    }
    assert!(gave_up > 200, "{gave_up}");
}
