//! Every wrong input, one by one, has its code; and a refused call has written nothing but what is said where it is.

use crate::common::lower;
use crate::lent::{Arguments, InC, Method, Prepared, nets, no_memory};
use core::ptr::{null, null_mut};
use patchray::capi::*;
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{bumpy, single};
use std::ffi::CStr;

pub(crate) fn model() -> Model {
    Model::numbered(vec![
        bumpy(1, [3, 3], [0.0; 3], 1.0, 0.3),
        bumpy(2, [2, 2], [1.0, 0.0, 0.5], 1.0, 0.3),
        bumpy(3, [4, 1], [0.0, 1.0, -0.5], 1.0, 0.3),
    ])
}

/// Runs a check for all kinds of control points.
macro_rules! for_all {
    ($check:ident) => {
        $check::<Plain<f32>>();
        $check::<Weighted<f32>>();
        $check::<Plain<f64>>();
        $check::<Weighted<f64>>();
    };
}

/// A prepared scene with a ray that hits it.
fn prepared<P: InC>() -> Prepared<P::Scalar> {
    let mut prepared = Prepared::of::<P>(&model());
    let [origin, direction] = [[0.1, 0.1, 5.0], [0.0, 0.0, -1.0]].map(|v| v.map(P::Scalar::from_f64));
    prepared.ray = patchray_ray { origin, direction, ..prepared.ray };
    prepared
}

/// An address one byte on.
pub(crate) fn off<T>(address: *const T) -> *const T {
    address.wrapping_byte_add(1)
}

pub(crate) fn off_mut<T>(address: *mut T) -> *mut T {
    address.wrapping_byte_add(1)
}

/// Calls with spoilt arguments, which have to give the code and leave hit and work as they were.
fn refused<P: InC>(
    method: &Method<P::Scalar>,
    prepared: &mut Prepared<P::Scalar>,
    code: i32,
    what: &str,
    spoil: impl FnOnce(&mut Arguments<P::Scalar>),
) {
    let mark = P::Scalar::from_f64(-77.0);
    prepared.hit.t = mark;
    prepared.work.patches_tested = 77;
    let mut arguments = prepared.arguments();
    spoil(&mut arguments);
    // SAFETY: spoilt as little as the interface says that it sees.
    let got = unsafe { (method.call)(&arguments) };
    assert_eq!(name(got), name(code), "{} with {what}", method.name);
    assert!(prepared.hit.t == mark && prepared.work.patches_tested == 77, "{} with {what} wrote", method.name);
}

pub(crate) fn name(code: i32) -> &'static str {
    // SAFETY: a string that is never freed.
    unsafe { CStr::from_ptr(patchray_name(code)) }.to_str().unwrap()
}

#[test]
fn codes_have_names_of_their_own() {
    let names: Vec<_> = (-60..=1).filter_map(|code| Some(name(code)).filter(|name| *name != "unknown")).collect();
    assert_eq!(names.len(), 37);
    let unique: std::collections::BTreeSet<_> = names.iter().collect();
    assert_eq!(unique.len(), names.len());
    assert_eq!((name(PATCHRAY_OVERLAP), name(i32::MIN), name(2)), ("PATCHRAY_OVERLAP", "unknown", "unknown"));
    assert_eq!(patchray_layout(), PATCHRAY_LAYOUT);
}

#[test]
fn wrong_addresses_are_refused() {
    fn check<P: InC>() {
        let mut p = prepared::<P>();
        for method in &P::METHODS {
            let m = |p: &mut _, code, what: &str, spoil: fn(&mut Arguments<P::Scalar>)| {
                refused::<P>(method, p, code, what, spoil);
            };
            m(&mut p, PATCHRAY_NULL, "no scene", |a| a.scene = null());
            m(&mut p, PATCHRAY_NULL, "no ray", |a| a.ray = null());
            m(&mut p, PATCHRAY_NULL, "no scratch", |a| a.scratch = null_mut());
            m(&mut p, PATCHRAY_NULL, "no hit", |a| a.hit = null_mut());
            m(&mut p, PATCHRAY_MISALIGNED, "a misaligned scene", |a| a.scene = off(a.scene));
            m(&mut p, PATCHRAY_MISALIGNED, "a misaligned ray", |a| a.ray = off(a.ray));
            m(&mut p, PATCHRAY_MISALIGNED, "misaligned limits", |a| a.limits = off(a.limits));
            m(&mut p, PATCHRAY_MISALIGNED, "misaligned scratch", |a| a.scratch = off_mut(a.scratch));
            m(&mut p, PATCHRAY_MISALIGNED, "scratch of half words", |a| a.scratch = a.scratch.wrapping_byte_add(4));
            m(&mut p, PATCHRAY_MISALIGNED, "a misaligned hit", |a| a.hit = off_mut(a.hit));
            m(&mut p, PATCHRAY_MISALIGNED, "misaligned work", |a| a.work = off_mut(a.work));
            m(&mut p, PATCHRAY_COUNT, "more scratch than there are addresses", |a| a.words = usize::MAX / 4);
            m(&mut p, PATCHRAY_COUNT, "scratch past the last address", |a| {
                a.scratch = (usize::MAX & !15) as *mut u64;
                a.words = 3;
            });
            m(&mut p, PATCHRAY_SCRATCH, "no word of scratch", |a| a.words = 0);
            if method.newton {
                m(&mut p, PATCHRAY_SCRATCH, "few words", |a| a.words = PATCHRAY_NEWTON_CUBIC_WORDS_F32 / 2);
            } else {
                m(&mut p, PATCHRAY_SCRATCH, "few words", |a| a.words = PATCHRAY_CLIP_CUBIC_WORDS_F32 / 2);
            }
            m(&mut p, PATCHRAY_OVERLAP, "scratch over the scene", |a| a.scratch = a.scene.cast_mut().cast());
            m(&mut p, PATCHRAY_OVERLAP, "work over the hit", |a| a.work = a.hit.cast());
            m(&mut p, PATCHRAY_OVERLAP, "a hit over the ray", |a| a.ray = a.hit.cast());
            m(&mut p, PATCHRAY_OVERLAP, "a hit in the scratch", |a| a.hit = a.scratch.wrapping_add(9).cast());
            m(&mut p, PATCHRAY_OVERLAP, "work over the limits", |a| a.work = a.limits.cast_mut().cast());
            // SAFETY: the scene is there.
            m(&mut p, PATCHRAY_OVERLAP, "work in the points", |a| {
                a.work = unsafe { (*a.scene).points }.cast_mut().cast()
            });
            // SAFETY: the scene is there.
            m(&mut p, PATCHRAY_OVERLAP, "a hit in the surfaces", |a| {
                a.hit = unsafe { (*a.scene).surfaces }.cast_mut().cast()
            });
            // SAFETY: the scene is there.
            m(&mut p, PATCHRAY_OVERLAP, "work in the voxels", |a| {
                a.work = unsafe { (*a.scene).offsets }.cast_mut().cast()
            });
            if method.patches {
                m(&mut p, PATCHRAY_NULL, "no patches", |a| a.patches = null());
                m(&mut p, PATCHRAY_MISALIGNED, "misaligned patches", |a| a.patches = off(a.patches));
                // SAFETY: the patches are there.
                let spoil = |a: &mut Arguments<_>| a.hit = unsafe { (*a.patches).patches }.cast_mut().cast();
                m(&mut p, PATCHRAY_OVERLAP, "a hit in the patches", spoil);
            }
            if method.tree {
                m(&mut p, PATCHRAY_NULL, "no tree", |a| a.tree = null());
                m(&mut p, PATCHRAY_MISALIGNED, "a misaligned tree", |a| a.tree = off(a.tree));
                // SAFETY: the tree is there.
                m(&mut p, PATCHRAY_OVERLAP, "work in the tree", |a| {
                    a.work = unsafe { (*a.tree).nodes }.cast_mut().cast()
                });
            }
            if method.grids {
                m(&mut p, PATCHRAY_NULL, "no grids", |a| a.grids = null());
                m(&mut p, PATCHRAY_MISALIGNED, "misaligned grids", |a| a.grids = off(a.grids));
                m(&mut p, PATCHRAY_NULL, "no coherence memory", |a| a.memory = null_mut());
                m(&mut p, PATCHRAY_MISALIGNED, "misaligned memory", |a| a.memory = off_mut(a.memory));
                m(&mut p, PATCHRAY_OVERLAP, "memory over the scratch", |a| a.memory = a.scratch.cast());
                m(&mut p, PATCHRAY_MEMORY, "a slot less than surfaces", |a| a.memory_len -= 1);
                m(&mut p, PATCHRAY_OPTION, "the number of no line", |a| a.line = u32::MAX);
                // SAFETY: the grids are there.
                let spoil = |a: &mut Arguments<_>| a.memory = unsafe { (*a.grids).references }.cast_mut().cast();
                m(&mut p, PATCHRAY_OVERLAP, "memory over the references", spoil);
            }
            // What may be NULL.
            let a = Arguments { limits: null(), work: null_mut(), ..p.arguments() };
            // SAFETY: a right call.
            assert_eq!(unsafe { (method.call)(&a) }, PATCHRAY_HIT, "{}", method.name);
        }
    }
    for_all!(check);
}

#[test]
fn wrong_tables_are_refused() {
    fn check<P: InC>() {
        let mut p = prepared::<P>();
        let (scene, patches, tree, grids) = (p.scene, p.patches, p.tree, p.grids);
        let mut memory = vec![0_u64; 64];
        for method in &P::METHODS {
            let mut spoilt = |code, what: &str, spoil: &dyn Fn(&mut Prepared<P::Scalar>)| {
                spoil(&mut p);
                refused::<P>(method, &mut p, code, what, |_| {});
                (p.scene, p.patches, p.tree, p.grids) = (scene, patches, tree, grids);
            };
            for bit in 0..32 {
                spoilt(PATCHRAY_LAYOUT_DIFFERS, "a scene made otherwise", &|p| p.scene.layout ^= 1 << bit);
            }
            spoilt(PATCHRAY_LAYOUT_DIFFERS, "patches as a scene", &|p| p.scene.layout = p.patches.layout);
            spoilt(PATCHRAY_NULL, "no points", &|p| p.scene.points = null());
            spoilt(PATCHRAY_MISALIGNED, "misaligned points", &|p| p.scene.points = off(p.scene.points));
            spoilt(PATCHRAY_MISALIGNED, "misaligned surfaces", &|p| p.scene.surfaces = off(p.scene.surfaces));
            spoilt(PATCHRAY_MISALIGNED, "misaligned voxels", &|p| p.scene.offsets = off(p.scene.offsets));
            spoilt(PATCHRAY_MISALIGNED, "misaligned references", &|p| p.scene.references = off(p.scene.references));
            spoilt(PATCHRAY_COUNT, "endless points", &|p| p.scene.points_len = usize::MAX);
            spoilt(PATCHRAY_COUNT, "endless surfaces", &|p| p.scene.surfaces_len = usize::MAX);
            if method.patches {
                spoilt(PATCHRAY_LAYOUT_DIFFERS, "patches made otherwise", &|p| p.patches.layout += 1 << 8);
                spoilt(PATCHRAY_NULL, "no patches", &|p| p.patches.patches = null());
                spoilt(PATCHRAY_TABLES, "patches of no surface", &|p| p.patches.first_len = 1);
                spoilt(PATCHRAY_TABLES, "patches of a surface less", &|p| p.patches.first_len -= 1);
                spoilt(PATCHRAY_MISALIGNED, "misaligned first", &|p| p.patches.first = off(p.patches.first));
            }
            if method.tree {
                spoilt(PATCHRAY_LAYOUT_DIFFERS, "a tree made otherwise", &|p| p.tree.layout = p.grids.layout);
                spoilt(PATCHRAY_NULL, "no nodes", &|p| p.tree.nodes = null());
                spoilt(PATCHRAY_NULL, "no links", &|p| p.tree.links = null());
            }
            if method.grids {
                spoilt(PATCHRAY_LAYOUT_DIFFERS, "grids made otherwise", &|p| p.grids.layout = 0);
                spoilt(PATCHRAY_NULL, "no grids", &|p| p.grids.grids = null());
                spoilt(PATCHRAY_NULL, "no offsets", &|p| p.grids.offsets = null());
            }
            // Tables that are too short are seen where they are used: then a call has worked, and says so.
            let mut short = |code, what: &str, spoil: &dyn Fn(&mut Prepared<P::Scalar>)| {
                spoil(&mut p);
                let a = Arguments { memory: memory.as_mut_ptr().cast(), memory_len: 3, ..p.arguments() };
                // SAFETY: all that the shorter tables say is there.
                assert_eq!(name(unsafe { (method.call)(&a) }), name(code), "{} with {what}", method.name);
                (p.scene, p.patches, p.tree, p.grids) = (scene, patches, tree, grids);
            };
            short(PATCHRAY_TABLES, "too few points", &|p| p.scene.points_len = 3);
            short(PATCHRAY_TABLES, "too few voxels", &|p| p.scene.offsets_len = 1);
            if method.patches {
                short(PATCHRAY_TABLES, "too few patches", &|p| p.patches.patches_len = 0);
            }
            if method.tree {
                short(PATCHRAY_TABLES, "a tree without nodes", &|p| p.tree.nodes_len = 0);
            }
            if method.grids {
                short(PATCHRAY_TABLES, "no grid", &|p| p.grids.grids_len = 0);
            }
        }
    }
    for_all!(check);
}

#[test]
fn wrong_rays_and_limits_are_refused() {
    fn check<P: InC>() {
        let nan = P::Scalar::from_f64(f64::NAN);
        let (infinity, zero, one) = (P::Scalar::INFINITY, P::Scalar::ZERO, P::Scalar::ONE);
        let mut p = prepared::<P>();
        let (ray, limits) = (p.ray, p.limits);
        for method in &P::METHODS {
            let mut spoilt = |code, what: &str, spoil: &dyn Fn(&mut Prepared<P::Scalar>)| {
                spoil(&mut p);
                refused::<P>(method, &mut p, code, what, |_| {});
                (p.ray, p.limits) = (ray, limits);
            };
            for k in 0..3 {
                spoilt(PATCHRAY_RAY_NAN, "an origin of NaN", &|p| p.ray.origin[k] = nan);
                spoilt(PATCHRAY_RAY_NAN, "a direction of NaN", &|p| p.ray.direction[k] = nan);
                spoilt(PATCHRAY_RAY_INFINITE, "an infinite origin", &|p| p.ray.origin[k] = infinity);
                spoilt(PATCHRAY_RAY_INFINITE, "an infinite direction", &|p| p.ray.direction[k] = -infinity);
            }
            spoilt(PATCHRAY_RAY_DIRECTION, "no direction", &|p| p.ray.direction = [zero; 3]);
            let tiny = P::Scalar::MIN_POSITIVE;
            spoilt(PATCHRAY_RAY_RANGE, "a vanishing direction", &|p| p.ray.direction = [tiny; 3]);
            spoilt(PATCHRAY_RAY_INTERVAL, "t_min of NaN", &|p| p.ray.t_min = nan);
            spoilt(PATCHRAY_RAY_INTERVAL, "t_max of NaN", &|p| p.ray.t_max = nan);
            spoilt(PATCHRAY_RAY_INTERVAL, "t_min after t_max", &|p| (p.ray.t_min, p.ray.t_max) = (one, zero));
            let infinity = P::Scalar::INFINITY;
            spoilt(PATCHRAY_RAY_INTERVAL, "infinities", &|p| (p.ray.t_min, p.ray.t_max) = (infinity, -infinity));
            spoilt(PATCHRAY_OPTION, "a tolerance of NaN", &|p| p.limits.tolerance = nan);
            spoilt(PATCHRAY_OPTION, "a critical factor of NaN", &|p| p.limits.critical_factor = nan);
            spoilt(PATCHRAY_OPTION, "an infinite threshold", &|p| p.limits.clip_threshold = infinity);
            spoilt(PATCHRAY_OPTION, "an acceptance of its own", &|p| p.limits.acceptance = 2);
            // Nothing would be found, which once was said to be a miss.
            spoilt(PATCHRAY_OPTION, "a negative tolerance", &|p| p.limits.tolerance = -one);
            spoilt(PATCHRAY_OPTION, "no iteration", &|p| p.limits.newton_iterations = 0);
            spoilt(PATCHRAY_OPTION, "no start", &|p| p.limits.newton_starts = 0);
            spoilt(PATCHRAY_OPTION, "more starts than there are", &|p| p.limits.newton_starts = 4);
            // Budgets that run out: neither a hit nor a miss, and counted.
            let mut out = |code, spoil: &dyn Fn(&mut patchray_limits<P::Scalar>)| {
                spoil(&mut p.limits);
                p.forget();
                // SAFETY: a right call.
                let got = unsafe { (method.call)(&p.arguments()) };
                p.limits = limits;
                assert_eq!(name(got), name(code), "{}", method.name);
                assert_eq!(p.hit.surface, PATCHRAY_NO_SURFACE);
            };
            out(PATCHRAY_GAVE_UP_SURFACES, &|limits| limits.surfaces = 0);
            out(PATCHRAY_GAVE_UP_VOXELS, &|limits| limits.voxels = 0);
            if method.newton {
                out(PATCHRAY_GAVE_UP_NEWTON_STEPS, &|limits| limits.newton_steps = 0);
                out(PATCHRAY_GAVE_UP_PATCHES, &|limits| limits.patches = 0);
            } else {
                out(PATCHRAY_GAVE_UP_CLIP_STEPS, &|limits| (limits.clip_steps, limits.newton_steps) = (0, 100));
            }
            if method.tree {
                out(PATCHRAY_GAVE_UP_NODES, &|limits| limits.nodes = 0);
            }
        }
    }
    for_all!(check);
}

#[test]
fn scratch_for_cubics_serves_cubics_only() {
    fn check<P: InC>() {
        let double = size_of::<P::Scalar>() == 8;
        let newton = if double { PATCHRAY_NEWTON_CUBIC_WORDS_F64 } else { PATCHRAY_NEWTON_CUBIC_WORDS_F32 };
        let clip = if double { PATCHRAY_CLIP_CUBIC_WORDS_F64 } else { PATCHRAY_CLIP_CUBIC_WORDS_F32 };
        for (degrees, code) in [([3, 3], PATCHRAY_HIT), ([4, 1], PATCHRAY_SCRATCH)] {
            let mut p = Prepared::of::<P>(&single(bumpy(1, degrees, [0.0; 3], 1.0, 0.1)));
            let [origin, direction] = [[0.4, 0.4, 5.0], [0.0, 0.0, -1.0]].map(|v| v.map(P::Scalar::from_f64));
            p.ray = patchray_ray { origin, direction, ..p.ray };
            for method in &P::METHODS {
                let words = if method.newton { newton } else { clip };
                let mut scratch = vec![u64::MAX; words];
                let a = Arguments { scratch: scratch.as_mut_ptr(), words, ..p.arguments() };
                // SAFETY: a right call.
                assert_eq!(name(unsafe { (method.call)(&a) }), name(code), "{} {degrees:?}", method.name);
            }
        }
    }
    for_all!(check);
}

#[test]
fn wrong_nets_are_refused_with_their_number() {
    fn check<P: InC>() {
        let model = model();
        let points: Vec<Vec<P>> = model.surfaces.iter().map(|surface| lower(surface, 1.0)).collect();
        let right = nets(&model, &points);
        let built = prepared::<P>().scene;
        let refused = |code, wrong: u32, nets: &[patchray_net<P::Scalar>], options: *const _| {
            let (mut memory, ..) = no_memory::<P::Scalar>();
            let mut scene = built;
            // SAFETY: the nets' points are there as far as the nets say.
            let got = unsafe { P::SCENE(nets.as_ptr(), nets.len(), options, &mut memory, &mut scene) };
            assert_eq!(name(got), name(code));
            if wrong != PATCHRAY_NO_SURFACE {
                assert_eq!(memory.wrong_surface, wrong);
                assert_eq!(memory.points_len, 0);
            }
            assert_eq!(scene.points, built.points);
        };
        let spoilt = |code, spoil: &dyn Fn(&mut patchray_net<P::Scalar>)| {
            let mut nets = right.clone();
            spoil(&mut nets[1]);
            refused(code, 1, &nets, null());
        };
        spoilt(PATCHRAY_DEGREE, &|net| net.degree_u = 0);
        spoilt(PATCHRAY_DEGREE, &|net| net.degree_v = 16);
        spoilt(PATCHRAY_DEGREE, &|net| net.degree_u = u32::MAX);
        spoilt(PATCHRAY_POINTS, &|net| net.degree_u = 3);
        spoilt(PATCHRAY_POINTS, &|net| net.points_len -= 1);
        spoilt(PATCHRAY_POINTS, &|net| net.points_len += 1);
        spoilt(PATCHRAY_POINTS, &|net| net.points_len = 0);
        spoilt(PATCHRAY_NULL, &|net| net.points = null());
        spoilt(PATCHRAY_MISALIGNED, &|net| net.points = off(net.points));
        spoilt(PATCHRAY_COUNT, &|net| net.points_len = usize::MAX);
        for bad in [f64::NAN, f64::INFINITY] {
            let mut numbers: Vec<P::Scalar> = vec![P::Scalar::ONE; right[1].points_len];
            numbers[5] = P::Scalar::from_f64(bad);
            spoilt(PATCHRAY_POINT_NOT_FINITE, &|net| net.points = numbers.as_ptr());
        }
        // A surface that the number type cannot hold beside one so much larger.
        let vanishing: Vec<P> = lower(&model.surfaces[1], if size_of::<P::Scalar>() == 4 { 1e-36 } else { 1e-300 });
        spoilt(PATCHRAY_SMALL, &|net| net.points = vanishing.as_ptr().cast());
        if P::RATIONAL {
            for bad in [0.0, -1.0] {
                let mut numbers: Vec<P::Scalar> = vec![P::Scalar::ONE; right[1].points_len];
                numbers[7] = P::Scalar::from_f64(bad);
                spoilt(PATCHRAY_WEIGHT, &|net| net.points = numbers.as_ptr());
            }
        }
        // Options, in every preparation.
        // SAFETY: plain numbers.
        let mut options: patchray_options<P::Scalar> = unsafe { core::mem::zeroed() };
        // SAFETY: an address of options.
        assert_eq!(unsafe { P::OPTIONS(&mut options) }, PATCHRAY_OK);
        let nan = P::Scalar::from_f64(f64::NAN);
        let wrong: [fn(&mut patchray_options<P::Scalar>, P::Scalar); 4] = [
            |options, bad| options.scene_density = bad,
            |options, bad| options.flatness = bad,
            |options, bad| options.grid_density = bad,
            |options, bad| options.origin[2] = bad,
        ];
        for spoil in wrong {
            let mut bad = options;
            spoil(&mut bad, nan);
            refused(PATCHRAY_OPTION, PATCHRAY_NO_SURFACE, &right, &bad);
        }
        refused(PATCHRAY_MISALIGNED, PATCHRAY_NO_SURFACE, &right, off(&options));
    }
    for_all!(check);
}

#[test]
fn preparations_refuse_wrong_memory() {
    fn check<P: InC>() {
        let model = model();
        let points: Vec<Vec<P>> = model.surfaces.iter().map(|surface| lower(surface, 1.0)).collect();
        let nets = nets(&model, &points);
        let p = prepared::<P>();
        let (none, no_patches, no_grids) = no_memory::<P::Scalar>();
        let mut room = vec![u64::MAX; 400_000];
        let first: *mut u64 = room.as_mut_ptr();
        let at = |word: usize| first.wrapping_add(word);
        // A scene.
        let build = |mut memory: patchray_scene_memory<P::Scalar>| {
            let mut scene = p.scene;
            // SAFETY: memory is as large as said.
            let code = unsafe { P::SCENE(nets.as_ptr(), nets.len(), null(), &mut memory, &mut scene) };
            (code, memory)
        };
        let (code, needs) = build(none);
        assert_eq!(code, PATCHRAY_MEMORY);
        let right = patchray_scene_memory {
            points: at(0).cast(),
            surfaces: at(1000).cast(),
            offsets: at(2000).cast(),
            references: at(3000).cast(),
            ..needs
        };
        assert_eq!(build(right).0, PATCHRAY_OK);
        let spoilt = |code, spoil: &dyn Fn(&mut patchray_scene_memory<P::Scalar>)| {
            let mut memory = right;
            spoil(&mut memory);
            let (got, after) = build(memory);
            assert_eq!(name(got), name(code));
            if code == PATCHRAY_MEMORY {
                assert_eq!(
                    [after.points_len, after.surfaces_len, after.offsets_len, after.references_len],
                    [needs.points_len, needs.surfaces_len, needs.offsets_len, needs.references_len]
                );
            }
        };
        spoilt(PATCHRAY_MEMORY, &|memory| memory.points_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.surfaces_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.offsets_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.references_len -= 1);
        spoilt(PATCHRAY_NULL, &|memory| memory.points = null_mut());
        spoilt(PATCHRAY_NULL, &|memory| memory.references = null_mut());
        spoilt(PATCHRAY_MISALIGNED, &|memory| memory.surfaces = off_mut(memory.surfaces));
        spoilt(PATCHRAY_COUNT, &|memory| memory.offsets_len = usize::MAX);
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.offsets = memory.references);
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.surfaces = memory.points.cast());
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.points = nets[2].points.cast_mut());
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.surfaces = nets.as_ptr().cast_mut().cast());
        // The scene's place.
        let mut memory = right;
        // SAFETY: memory is as large as said.
        assert_eq!(PATCHRAY_NULL, unsafe { P::SCENE(nets.as_ptr(), 3, null(), &mut memory, null_mut()) });
        assert_eq!(PATCHRAY_NULL, unsafe { P::SCENE(nets.as_ptr(), 3, null(), null_mut(), at(5000).cast()) });
        assert_eq!(PATCHRAY_NULL, unsafe { P::SCENE(null(), 3, null(), &mut memory, at(5000).cast()) });
        assert_eq!(PATCHRAY_OVERLAP, unsafe { P::SCENE(nets.as_ptr(), 3, null(), &mut memory, at(8).cast()) });
        assert_eq!(PATCHRAY_COUNT, unsafe {
            P::SCENE(nets.as_ptr(), usize::MAX, null(), &mut memory, at(5000).cast())
        });
        // A scene of nothing.
        let mut nothing = none;
        // SAFETY: likewise.
        assert_eq!(PATCHRAY_MEMORY, unsafe { P::SCENE(null(), 0, null(), &mut nothing, at(5000).cast()) });
        assert_eq!((nothing.points_len, nothing.surfaces_len), (0, 0));

        // Patches and trees.
        let mut words = vec![0_u64; 2000];
        let scratch = words.as_mut_ptr();
        let subdivide = |memory: &mut patchray_patches_memory<P::Scalar>, words: usize, scene, options, tree| {
            let (mut patches, mut made) = (p.patches, p.tree);
            let made = if tree { &raw mut made } else { null_mut() };
            // SAFETY: memory is as large as said.
            unsafe { P::PATCHES(scene, options, scratch, words, memory, &mut patches, made) }
        };
        let mut needs = no_patches;
        assert_eq!(subdivide(&mut needs, 2000, &p.scene, null(), true), PATCHRAY_MEMORY);
        let right = patchray_patches_memory {
            patches: at(0).cast(),
            first: at(200_000).cast(),
            nodes: at(210_000).cast(),
            links: at(390_000).cast(),
            ..needs
        };
        let spoilt = |code, spoil: &dyn Fn(&mut patchray_patches_memory<P::Scalar>)| {
            let mut memory = right;
            spoil(&mut memory);
            assert_eq!(name(subdivide(&mut memory, 2000, &p.scene, null(), true)), name(code));
        };
        assert!(needs.patches_len * size_of::<patchray_patch<P::Scalar>>() < 1_600_000 && needs.links_len < 20_000);
        spoilt(PATCHRAY_OK, &|_| {});
        spoilt(PATCHRAY_MEMORY, &|memory| memory.patches_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.first_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.nodes_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.links_len -= 1);
        spoilt(PATCHRAY_NULL, &|memory| memory.patches = null_mut());
        spoilt(PATCHRAY_MISALIGNED, &|memory| memory.nodes = off_mut(memory.nodes));
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.links = memory.patches.cast());
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.first = p.scene.offsets.cast_mut());
        let mut memory = right;
        assert_eq!(subdivide(&mut memory, 2000, null(), null(), true), PATCHRAY_NULL);
        assert_eq!(subdivide(&mut memory, 9, &p.scene, null(), true), PATCHRAY_SCRATCH);
        let mut few = right;
        // SAFETY: plain numbers, then written.
        let mut options: patchray_options<P::Scalar> = unsafe { core::mem::zeroed() };
        // SAFETY: an address of options.
        unsafe { P::OPTIONS(&mut options) };
        options.patches_per_surface = 1;
        assert_eq!(subdivide(&mut few, 2000, &p.scene, &options, true), PATCHRAY_PATCHES);
        assert_eq!(few.wrong_surface, 0);
        // Without a tree neither is asked for.
        let mut bare = no_patches;
        assert_eq!(subdivide(&mut bare, 2000, &p.scene, null(), false), PATCHRAY_MEMORY);
        assert_eq!((bare.nodes_len, bare.links_len, bare.patches_len), (0, 0, right.patches_len));

        // Grids.
        let grid = |memory: &mut patchray_grids_memory<P::Scalar>, patches| {
            let mut grids = p.grids;
            // SAFETY: memory is as large as said.
            unsafe { P::GRIDS(patches, null(), memory, &mut grids) }
        };
        let mut needs = no_grids;
        assert_eq!(grid(&mut needs, &p.patches), PATCHRAY_MEMORY);
        let right = patchray_grids_memory {
            grids: at(0).cast(),
            offsets: at(1000).cast(),
            references: at(100_000).cast(),
            ..needs
        };
        let spoilt = |code, spoil: &dyn Fn(&mut patchray_grids_memory<P::Scalar>)| {
            let mut memory = right;
            spoil(&mut memory);
            assert_eq!(name(grid(&mut memory, &p.patches)), name(code));
        };
        spoilt(PATCHRAY_OK, &|_| {});
        spoilt(PATCHRAY_MEMORY, &|memory| memory.grids_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.offsets_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.references_len -= 1);
        spoilt(PATCHRAY_NULL, &|memory| memory.offsets = null_mut());
        spoilt(PATCHRAY_MISALIGNED, &|memory| memory.grids = off_mut(memory.grids));
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.offsets = memory.references);
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.offsets = p.patches.first.cast_mut());
        let mut memory = right;
        assert_eq!(grid(&mut memory, null()), PATCHRAY_NULL);
        let mut otherwise = p.patches;
        otherwise.layout = p.scene.layout;
        assert_eq!(grid(&mut memory, &otherwise), PATCHRAY_LAYOUT_DIFFERS);
        let mut short = p.patches;
        short.patches_len = 1;
        assert_eq!(grid(&mut memory, &short), PATCHRAY_TABLES);
    }
    for_all!(check);
}

#[test]
fn lists_of_hits_refuse_wrong_addresses() {
    fn check<P: InC>() {
        let mut p = prepared::<P>();
        let (a, mut hits, mut found) = (p.arguments(), vec![p.hit; 4], 0);
        let list = |hits, count, found, words| {
            // SAFETY: addresses of as much as said, or refused.
            unsafe { P::ALL(a.scene, a.ray, a.limits, a.scratch, words, hits, count, found, a.work) }
        };
        let (first, found): (*mut _, *mut usize) = (hits.as_mut_ptr(), &raw mut found);
        assert_eq!(list(first, 4, found, a.words), PATCHRAY_HIT);
        assert_eq!(list(null_mut(), 4, found, a.words), PATCHRAY_NULL);
        assert_eq!(list(null_mut(), 0, found, a.words), PATCHRAY_GAVE_UP_HITS);
        assert_eq!(list(first, 4, null_mut(), a.words), PATCHRAY_NULL);
        assert_eq!(list(off_mut(first), 3, found, a.words), PATCHRAY_MISALIGNED);
        assert_eq!(list(first, usize::MAX, found, a.words), PATCHRAY_COUNT);
        assert_eq!(list(a.scratch.cast(), 4, found, a.words), PATCHRAY_OVERLAP);
        assert_eq!(list(first, 4, a.scratch.cast(), a.words), PATCHRAY_OVERLAP);
        assert_eq!(list(first, 4, found, 10), PATCHRAY_SCRATCH);
    }
    for_all!(check);
}

#[test]
fn normals_and_defaults_refuse_wrong_addresses() {
    fn check<P: InC>() {
        let mut p = prepared::<P>();
        // SAFETY: a right call.
        assert_eq!(unsafe { (P::METHODS[0].call)(&p.arguments()) }, PATCHRAY_HIT);
        let mut normal = [P::Scalar::ZERO; 3];
        let nan = P::Scalar::from_f64(f64::NAN);
        // SAFETY: addresses of what is asked for, or refused, here and below.
        unsafe {
            assert_eq!(P::NORMAL(null(), &p.hit, &mut normal), PATCHRAY_NULL);
            assert_eq!(P::NORMAL(&p.scene, null(), &mut normal), PATCHRAY_NULL);
            assert_eq!(P::NORMAL(&p.scene, &p.hit, null_mut()), PATCHRAY_NULL);
            assert_eq!(P::NORMAL(&p.scene, off(&p.hit), &mut normal), PATCHRAY_MISALIGNED);
            assert_eq!(P::NORMAL(&p.scene, &p.hit, (&raw mut p.hit).cast()), PATCHRAY_OVERLAP);
            assert_eq!(P::NORMAL(&p.scene, &patchray_hit { u: nan, ..p.hit }, &mut normal), PATCHRAY_OPTION);
            assert_eq!(P::NORMAL(&p.scene, &patchray_hit { surface: 3, ..p.hit }, &mut normal), PATCHRAY_TABLES);
            assert_eq!(P::LIMITS(null_mut()), PATCHRAY_NULL);
            assert_eq!(P::LIMITS(off_mut(&raw mut p.limits)), PATCHRAY_MISALIGNED);
            assert_eq!(P::OPTIONS(null_mut()), PATCHRAY_NULL);
        }
        assert_eq!(normal, [P::Scalar::ZERO; 3]);
    }
    for_all!(check);
}
