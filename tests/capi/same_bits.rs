//! Through the C interface a ray has the same answer and the same counters as in Rust, to the bit; and so has the teapot of
//! `methods.c`, of which Rust's hashes are written to the file that `PATCHRAY_HASHES` names.

use crate::common::{self, Kind, hard_surfaces};
use crate::lent::{InC, Prepared};
use crate::lent_lines::Views;
use crate::views;
use patchray::capi::*;
use patchray::limits::{GaveUp, Limits, Work};
use patchray::method::{ClipScratch, Remembered, Scratch, clipping, clipping_coherent, newton, newton_coherent};
use patchray::point::{Plain, Weighted};
use patchray::ray::{Hit, Interval, Ray};
use patchray::scalar::Scalar;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::Random;
use patchray_host::scene::teapot;

/// The teapot with coordinates that `float` holds, as the table in C has them.
fn teapot_in_float() -> Model {
    let mut model = teapot::model().unwrap();
    for point in model.surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
        *point = point.map(|c| f64::from(c as f32));
    }
    model
}

/// One ray by one of the four methods, in Rust.
struct InRust<P: Kind> {
    prepared: common::Prepared<P>,
    memory: Vec<Remembered<P::Scalar>>,
    scratch: Box<Scratch<P, 16, 256>>,
    clip: Box<ClipScratch<P, 16, 256, 64>>,
}

impl<P: Kind> InRust<P> {
    fn of(model: &Model) -> Self {
        let memory = vec![Remembered::EMPTY; model.surfaces.len()];
        let prepared = common::Prepared::of(model);
        InRust { prepared, memory, scratch: Box::new(Scratch::new()), clip: Box::new(ClipScratch::new()) }
    }

    fn closest(
        &mut self,
        method: usize,
        line: u32,
        ray: &Ray<P::Scalar>,
        interval: &Interval<P::Scalar>,
        work: &mut Work,
    ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
        let InRust { prepared, memory, scratch, clip } = self;
        let (scene, patches, tree, grids) = (prepared.scene(), prepared.patches(), prepared.tree(), prepared.grids());
        let (scene, limits) = (&scene, &Limits::default());
        let (scratch, room) = (&mut scratch.view(), &mut clip.view());
        match method {
            0 => clipping::closest(scene, ray, interval, limits, room, work),
            1 => clipping_coherent::closest(scene, &patches, &grids, memory, line, ray, interval, limits, room, work),
            2 => newton::closest(scene, &patches, &tree, ray, interval, limits, scratch, work),
            _ => newton_coherent::closest(scene, &patches, &grids, memory, line, ray, interval, limits, scratch, work),
        }
    }
}

/// A hit as the C interface writes it.
pub(crate) fn hit_in_c<S>(Hit { t, u, v, surface, incidence }: Hit<S>) -> patchray_hit<S> {
    patchray_hit { t, u, v, surface, incidence: incidence as u32 }
}

/// A hit's words, as they are hashed; `None` has none.
pub(crate) fn words<S: Scalar>(hit: Option<patchray_hit<S>>) -> Vec<u32> {
    let Some(patchray_hit { t, u, v, surface, incidence }) = hit else {
        return vec![];
    };
    let numbers = [t, u, v].into_iter().flat_map(|number| {
        if size_of::<S>() == 4 {
            return vec![(number.to_f64() as f32).to_bits()];
        }
        let bits = number.to_f64().to_bits();
        vec![bits as u32, (bits >> 32) as u32]
    });
    numbers.chain([surface, incidence]).collect()
}

/// What a hash begins with.
pub(crate) const START: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV-1a over the bytes of words, the least first.
pub(crate) fn fold(hash: &mut u64, words: impl IntoIterator<Item = u32>) {
    for byte in words.into_iter().flat_map(u32::to_le_bytes) {
        *hash = (*hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
}

/// The lines of `methods.c`.
fn lines<P: Views>(precision: &str, out: &mut String) {
    let model = teapot_in_float();
    let (mut rust, mut c) = (InRust::<P>::of(&model), Prepared::of::<P>(&model));
    for (number, method) in P::METHODS.iter().take(4).enumerate() {
        rust.memory.fill(Remembered::EMPTY);
        c.forget();
        let (mut hash, mut hash_in_c, mut hits) = (START, START, 0);
        for (row, column) in (0..64_u32).flat_map(|row| (0..64_u32).map(move |column| (row, column))) {
            let (x, y) = ((16.0 * f64::from(column) - 504.0) / 512.0, (504.0 - 16.0 * f64::from(row)) / 512.0);
            let direction = [-222.75 + 68.0 * x - 24.0 * y, 297.0 + 51.0 * x + 32.0 * y, -198.0 + 75.0 * y];
            let [origin, direction] = [[7.6171875, -9.3203125, 7.59375], direction].map(|v| v.map(P::Scalar::from_f64));
            let t_max = P::Scalar::from_f64(1e30);
            let ray = rust.prepared.scene().ray(origin, direction).unwrap();
            let interval = Interval::new(P::Scalar::ZERO, t_max).unwrap();
            let mut work = Work::default();
            let hit = rust.closest(number, row, &ray, &interval, &mut work).unwrap();
            fold(
                &mut hash,
                [u32::from(hit.is_some())].into_iter().chain(words(hit.map(hit_in_c))).chain(work.counts()),
            );
            hits += u32::from(hit.is_some());

            c.ray = patchray_ray { origin, direction, t_min: P::Scalar::ZERO, t_max };
            let mut arguments = c.arguments();
            (arguments.line, arguments.limits) = (row, core::ptr::null());
            // SAFETY: the arguments of a right call.
            let code = unsafe { (method.call)(&arguments) };
            let hit = (code == PATCHRAY_HIT).then_some(c.hit);
            // SAFETY: 22 numbers of 32 bits.
            let counts: [u32; Work::COUNT] = unsafe { core::mem::transmute(c.work) };
            fold(&mut hash_in_c, [code as u32].into_iter().chain(words(hit)).chain(counts));
        }
        assert_eq!(hash, hash_in_c, "{} in {precision}", method.name);
        *out += &format!("{} {precision} {hits} {hash:x}\n", method.name);
    }
    views::lines::<P>(&model, precision, out);
}

#[test]
fn the_teapot_has_the_same_hashes() {
    let mut text = String::new();
    lines::<Plain<f32>>("f32", &mut text);
    lines::<Plain<f64>>("f64", &mut text);
    if let Ok(path) = std::env::var("PATCHRAY_HASHES") {
        std::fs::write(path, text).unwrap();
    }
}

#[test]
fn hard_surfaces_have_the_same_answers() {
    fn agree<P: InC>(name: &str, model: &Model) {
        let (mut rust, mut c) = (InRust::<P>::of(model), Prepared::of::<P>(model));
        let mut random = Random(7);
        for method in 0..4 {
            for line in 0..60 {
                let [from, to] = [random.point(12.0), random.point(2.0)];
                let direction = [0, 1, 2].map(|k| to[k] - from[k]).map(P::Scalar::from_f64);
                let origin = from.map(P::Scalar::from_f64);
                let Ok(ray) = rust.prepared.scene().ray(origin, direction) else {
                    continue;
                };
                let mut work = Work::default();
                // Every third ray is a whole line.
                let t_min = if line % 3 == 0 { -P::Scalar::INFINITY } else { P::Scalar::ZERO };
                let t_max = P::Scalar::INFINITY;
                let interval = Interval::new(t_min, t_max).expect("it holds every t");
                let found = rust.closest(method, line, &ray, &interval, &mut work);
                c.ray = patchray_ray { origin, direction, t_min, t_max };
                let mut arguments = c.arguments();
                arguments.line = line;
                // SAFETY: the arguments of a right call.
                let code = unsafe { (P::METHODS[method].call)(&arguments) };
                let best = match found {
                    Ok(hit) => {
                        assert_eq!(code, i32::from(hit.is_some()), "{name}");
                        hit
                    }
                    Err(GaveUp { best, .. }) => {
                        assert!(code <= PATCHRAY_GAVE_UP_SURFACES, "{name}: {code}");
                        best
                    }
                };
                assert_eq!(best.map_or(PATCHRAY_NO_SURFACE, |hit| hit.surface), c.hit.surface, "{name}");
                if let Some(hit) = best {
                    assert_eq!(words(Some(hit_in_c(hit))), words(Some(c.hit)), "{name}");
                    let mut normal = [P::Scalar::ZERO; 3];
                    // SAFETY: addresses of what is asked for.
                    assert_eq!(unsafe { P::NORMAL(&c.scene, &c.hit, &mut normal) }, PATCHRAY_OK);
                    let mut basis = patchray::bernstein::Basis::<_, 16>::new();
                    let in_rust =
                        rust.prepared.scene().normal(&hit, &mut basis.view()).expect("the basis is large enough");
                    assert_eq!(normal, in_rust.unwrap_or([P::Scalar::ZERO; 3]), "{name}");
                }
                assert_eq!(patchray_work::from(work), c.work, "{name}");
            }
        }
    }
    for (name, model) in hard_surfaces() {
        if !common::is_rational(&model) {
            agree::<Plain<f32>>(name, &model);
            agree::<Plain<f64>>(name, &model);
        }
        agree::<Weighted<f32>>(name, &model);
        agree::<Weighted<f64>>(name, &model);
    }
}

/// What a list with this much room holds of the hits of a ray.
fn list_of(c: &mut Prepared<f64>, room: usize) -> (i32, Vec<patchray_hit<f64>>) {
    let mut hits = vec![c.hit; room];
    let (mut found, a) = (usize::MAX, c.arguments());
    // SAFETY: addresses of as much as said.
    let code = unsafe {
        patchray_clipping_all_f64(
            a.scene,
            a.ray,
            a.limits,
            a.scratch,
            a.words,
            hits.as_mut_ptr(),
            room,
            &mut found,
            a.work,
        )
    };
    hits.truncate(found);
    (code, hits)
}

#[test]
fn all_hits_come_in_order_and_a_short_list_holds_the_closest() {
    let model = teapot_in_float();
    let mut c = Prepared::of::<Plain<f64>>(&model);
    // Through handle, body and spout.
    c.ray = patchray_ray { origin: [-10.0, 0.01, 1.9], direction: [1.0, 0.0, 0.0], t_min: 0.0, t_max: 1e9 };
    let (code, all) = list_of(&mut c, 40);
    assert_eq!(code, PATCHRAY_HIT);
    assert!(all.len() >= 6 && all.is_sorted_by(|a, b| a.t <= b.t), "{all:?}");
    for room in 0..all.len() {
        let (code, some) = list_of(&mut c, room);
        assert_eq!((code, &some[..]), (PATCHRAY_GAVE_UP_HITS, &all[..room]));
    }
    // As a whole line it is met at the same places, whichever of its points is the origin.
    c.ray = patchray_ray { origin: [0.0, 0.01, 1.9], t_min: f64::NEG_INFINITY, t_max: f64::INFINITY, ..c.ray };
    let (code, whole) = list_of(&mut c, 40);
    assert_eq!((code, whole.len()), (PATCHRAY_HIT, all.len()));
    assert!(
        whole.iter().zip(&all).all(|(a, b)| (a.t + 10.0 - b.t).abs() < 1e-9 && a.surface == b.surface),
        "{whole:?}"
    );
    assert!(whole[0].t < 0.0);
    // No t is infinite.
    for end in [f64::NEG_INFINITY, f64::INFINITY] {
        (c.ray.t_min, c.ray.t_max) = (end, end);
        assert_eq!(list_of(&mut c, 40), (PATCHRAY_MISS, vec![]));
    }
    c.ray = patchray_ray { origin: [-10.0, 0.01, 1.9], t_min: 0.0, t_max: 1.0, ..c.ray };
    // SAFETY: as above.
    let a = c.arguments();
    let (mut hit, mut found) = (c.hit, 9);
    let code = unsafe {
        patchray_clipping_all_f64(a.scene, a.ray, a.limits, a.scratch, a.words, &mut hit, 1, &mut found, a.work)
    };
    assert_eq!((code, found), (PATCHRAY_MISS, 0));
}
