//! Scenes prepared through the C interface, and calls whose arguments tests spoil one by one.

use crate::common::{Kind, lower};
use core::ptr::{null, null_mut};
use patchray::capi::*;
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray_host::scene::model::Model;

/// All that a function of one ray takes.
#[derive(Clone, Copy)]
pub struct Arguments<S> {
    pub scene: *const patchray_scene<S>,
    pub patches: *const patchray_patches<S>,
    pub tree: *const patchray_tree<S>,
    pub grids: *const patchray_grids<S>,
    pub memory: *mut patchray_remembered<S>,
    pub memory_len: usize,
    pub line: u32,
    pub ray: *const patchray_ray<S>,
    pub limits: *const patchray_limits<S>,
    pub scratch: *mut u64,
    pub words: usize,
    pub hit: *mut patchray_hit<S>,
    pub work: *mut patchray_work,
}

/// A function of one ray, what it takes, and its name.
pub struct Method<S> {
    pub name: &'static str,
    pub patches: bool,
    pub tree: bool,
    pub grids: bool,
    pub newton: bool,
    pub call: unsafe fn(&Arguments<S>) -> i32,
}

/// The functions for one kind of control points.
pub trait InC: Kind {
    const SCENE: unsafe extern "C" fn(
        *const patchray_net<Self::Scalar>,
        usize,
        *const patchray_options<Self::Scalar>,
        *mut patchray_scene_memory<Self::Scalar>,
        *mut patchray_scene<Self::Scalar>,
    ) -> i32;
    const PATCHES: unsafe extern "C" fn(
        *const patchray_scene<Self::Scalar>,
        *const patchray_options<Self::Scalar>,
        *mut u64,
        usize,
        *mut patchray_patches_memory<Self::Scalar>,
        *mut patchray_patches<Self::Scalar>,
        *mut patchray_tree<Self::Scalar>,
    ) -> i32;
    const GRIDS: unsafe extern "C" fn(
        *const patchray_patches<Self::Scalar>,
        *const patchray_options<Self::Scalar>,
        *mut patchray_grids_memory<Self::Scalar>,
        *mut patchray_grids<Self::Scalar>,
    ) -> i32;
    const ALL: unsafe extern "C" fn(
        *const patchray_scene<Self::Scalar>,
        *const patchray_ray<Self::Scalar>,
        *const patchray_limits<Self::Scalar>,
        *mut u64,
        usize,
        *mut patchray_hit<Self::Scalar>,
        usize,
        *mut usize,
        *mut patchray_work,
    ) -> i32;
    const NORMAL: unsafe extern "C" fn(
        *const patchray_scene<Self::Scalar>,
        *const patchray_hit<Self::Scalar>,
        *mut [Self::Scalar; 3],
    ) -> i32;
    const LIMITS: unsafe extern "C" fn(*mut patchray_limits<Self::Scalar>) -> i32;
    const OPTIONS: unsafe extern "C" fn(*mut patchray_options<Self::Scalar>) -> i32;
    /// In the order of the hashes of `methods.c`; then those of any hit.
    const METHODS: [Method<Self::Scalar>; 6];
}

macro_rules! in_c {
    ($point:ty, $scene:ident $patches:ident $grids:ident $all:ident $normal:ident $limits:ident $options:ident
        $clipping:ident $clipping_coherent:ident $newton:ident $newton_coherent:ident $clipping_any:ident $newton_any:ident) => {
        impl InC for $point {
            const SCENE: unsafe extern "C" fn(
                *const patchray_net<Self::Scalar>,
                usize,
                *const patchray_options<Self::Scalar>,
                *mut patchray_scene_memory<Self::Scalar>,
                *mut patchray_scene<Self::Scalar>,
            ) -> i32 = $scene;
            const PATCHES: unsafe extern "C" fn(
                *const patchray_scene<Self::Scalar>,
                *const patchray_options<Self::Scalar>,
                *mut u64,
                usize,
                *mut patchray_patches_memory<Self::Scalar>,
                *mut patchray_patches<Self::Scalar>,
                *mut patchray_tree<Self::Scalar>,
            ) -> i32 = $patches;
            const GRIDS: unsafe extern "C" fn(
                *const patchray_patches<Self::Scalar>,
                *const patchray_options<Self::Scalar>,
                *mut patchray_grids_memory<Self::Scalar>,
                *mut patchray_grids<Self::Scalar>,
            ) -> i32 = $grids;
            const ALL: unsafe extern "C" fn(
                *const patchray_scene<Self::Scalar>,
                *const patchray_ray<Self::Scalar>,
                *const patchray_limits<Self::Scalar>,
                *mut u64,
                usize,
                *mut patchray_hit<Self::Scalar>,
                usize,
                *mut usize,
                *mut patchray_work,
            ) -> i32 = $all;
            const NORMAL: unsafe extern "C" fn(
                *const patchray_scene<Self::Scalar>,
                *const patchray_hit<Self::Scalar>,
                *mut [Self::Scalar; 3],
            ) -> i32 = $normal;
            const LIMITS: unsafe extern "C" fn(*mut patchray_limits<Self::Scalar>) -> i32 = $limits;
            const OPTIONS: unsafe extern "C" fn(*mut patchray_options<Self::Scalar>) -> i32 = $options;
            const METHODS: [Method<Self::Scalar>; 6] = [
                of_scene("clipping", |a| unsafe {
                    $clipping(a.scene, a.ray, a.limits, a.scratch, a.words, a.hit, a.work)
                }),
                of_grids("clipping-coherent", false, |a| unsafe {
                    $clipping_coherent(
                        a.scene,
                        a.patches,
                        a.grids,
                        a.memory,
                        a.memory_len,
                        a.line,
                        a.ray,
                        a.limits,
                        a.scratch,
                        a.words,
                        a.hit,
                        a.work,
                    )
                }),
                of_tree("newton", |a| unsafe {
                    $newton(a.scene, a.patches, a.tree, a.ray, a.limits, a.scratch, a.words, a.hit, a.work)
                }),
                of_grids("newton-coherent", true, |a| unsafe {
                    $newton_coherent(
                        a.scene,
                        a.patches,
                        a.grids,
                        a.memory,
                        a.memory_len,
                        a.line,
                        a.ray,
                        a.limits,
                        a.scratch,
                        a.words,
                        a.hit,
                        a.work,
                    )
                }),
                of_scene("any by clipping", |a| unsafe {
                    $clipping_any(a.scene, a.ray, a.limits, a.scratch, a.words, a.hit, a.work)
                }),
                of_tree("any by newton", |a| unsafe {
                    $newton_any(a.scene, a.patches, a.tree, a.ray, a.limits, a.scratch, a.words, a.hit, a.work)
                }),
            ];
        }
    };
}

const fn of_scene<S>(name: &'static str, call: unsafe fn(&Arguments<S>) -> i32) -> Method<S> {
    Method { name, patches: false, tree: false, grids: false, newton: false, call }
}

const fn of_tree<S>(name: &'static str, call: unsafe fn(&Arguments<S>) -> i32) -> Method<S> {
    Method { name, patches: true, tree: true, grids: false, newton: true, call }
}

const fn of_grids<S>(name: &'static str, newton: bool, call: unsafe fn(&Arguments<S>) -> i32) -> Method<S> {
    Method { name, patches: true, tree: false, grids: true, newton, call }
}

in_c!(Plain<f32>, patchray_scene_build_f32 patchray_patches_build_f32 patchray_grids_build_f32 patchray_clipping_all_f32
    patchray_normal_f32 patchray_limits_default_f32 patchray_options_default_f32 patchray_clipping_closest_f32
    patchray_clipping_coherent_closest_f32 patchray_newton_closest_f32 patchray_newton_coherent_closest_f32
    patchray_clipping_any_f32 patchray_newton_any_f32);
in_c!(Weighted<f32>, patchray_scene_build_f32_weighted patchray_patches_build_f32_weighted patchray_grids_build_f32
    patchray_clipping_all_f32_weighted patchray_normal_f32_weighted patchray_limits_default_f32 patchray_options_default_f32
    patchray_clipping_closest_f32_weighted patchray_clipping_coherent_closest_f32_weighted
    patchray_newton_closest_f32_weighted patchray_newton_coherent_closest_f32_weighted
    patchray_clipping_any_f32_weighted patchray_newton_any_f32_weighted);
in_c!(Plain<f64>, patchray_scene_build_f64 patchray_patches_build_f64 patchray_grids_build_f64 patchray_clipping_all_f64
    patchray_normal_f64 patchray_limits_default_f64 patchray_options_default_f64 patchray_clipping_closest_f64
    patchray_clipping_coherent_closest_f64 patchray_newton_closest_f64 patchray_newton_coherent_closest_f64
    patchray_clipping_any_f64 patchray_newton_any_f64);
in_c!(Weighted<f64>, patchray_scene_build_f64_weighted patchray_patches_build_f64_weighted patchray_grids_build_f64
    patchray_clipping_all_f64_weighted patchray_normal_f64_weighted patchray_limits_default_f64 patchray_options_default_f64
    patchray_clipping_closest_f64_weighted patchray_clipping_coherent_closest_f64_weighted
    patchray_newton_closest_f64_weighted patchray_newton_coherent_closest_f64_weighted
    patchray_clipping_any_f64_weighted patchray_newton_any_f64_weighted);

/// Words that are enough for all.
pub const WORDS: usize = PATCHRAY_CLIP_WORDS_F64;

/// Nets as a program in C has them; the points stay where they are.
pub fn nets<P: InC>(model: &Model, points: &[Vec<P>]) -> Vec<patchray_net<P::Scalar>> {
    let numbers = size_of::<P>() / size_of::<P::Scalar>();
    let nets = model.surfaces.iter().zip(points).map(|(surface, points)| patchray_net {
        points: points.as_ptr().cast(),
        points_len: points.len() * numbers,
        degree_u: surface.degree_u as u32,
        degree_v: surface.degree_v as u32,
    });
    nets.collect()
}

/// A scene with all that methods need, prepared through the C interface. Words are of 8 bytes, so that all is aligned.
pub struct Prepared<S> {
    pub scene: patchray_scene<S>,
    pub patches: patchray_patches<S>,
    pub tree: patchray_tree<S>,
    pub grids: patchray_grids<S>,
    pub ray: patchray_ray<S>,
    pub limits: patchray_limits<S>,
    pub scratch: Vec<u64>,
    pub hit: patchray_hit<S>,
    pub work: patchray_work,
    memory: Vec<u64>,
    surfaces: usize,
    _lent: Vec<Vec<u64>>,
}

pub fn no_memory<S>() -> (patchray_scene_memory<S>, patchray_patches_memory<S>, patchray_grids_memory<S>) {
    // SAFETY: of null addresses and counts of 0.
    unsafe { core::mem::zeroed() }
}

fn take<T>(lent: &mut Vec<Vec<u64>>, count: usize) -> *mut T {
    lent.push(vec![u64::MAX; (count * size_of::<T>()).div_ceil(8)]);
    lent.last_mut().map_or(null_mut(), |words| words.as_mut_ptr().cast())
}

impl<S: Scalar> Prepared<S> {
    pub fn of<P: InC<Scalar = S>>(model: &Model) -> Self {
        let points: Vec<Vec<P>> = model.surfaces.iter().map(|surface| lower(surface, 1.0)).collect();
        let nets = nets(model, &points);
        let lent = &mut Vec::new();
        let (mut of_scene, mut of_patches, mut of_grids) = no_memory::<S>();
        let mut scratch = vec![0; WORDS];
        // SAFETY: all zeros is a table of no library.
        let (mut scene, mut patches, mut tree, mut grids) = unsafe { core::mem::zeroed() };
        for code in [PATCHRAY_MEMORY, PATCHRAY_OK] {
            // SAFETY: all addresses are those of memory as large as said, here and below.
            assert_eq!(code, unsafe { P::SCENE(nets.as_ptr(), nets.len(), null(), &mut of_scene, &mut scene) });
            if code == PATCHRAY_MEMORY {
                of_scene.points = take(lent, of_scene.points_len);
                of_scene.surfaces = take(lent, of_scene.surfaces_len);
                of_scene.offsets = take(lent, of_scene.offsets_len);
                of_scene.references = take(lent, of_scene.references_len);
            }
        }
        for code in [PATCHRAY_MEMORY, PATCHRAY_OK] {
            let (first, words) = (scratch.as_mut_ptr(), scratch.len());
            assert_eq!(code, unsafe {
                P::PATCHES(&scene, null(), first, words, &mut of_patches, &mut patches, &mut tree)
            });
            if code == PATCHRAY_MEMORY {
                of_patches.patches = take(lent, of_patches.patches_len);
                of_patches.first = take(lent, of_patches.first_len);
                of_patches.nodes = take(lent, of_patches.nodes_len);
                of_patches.links = take(lent, of_patches.links_len);
            }
        }
        for code in [PATCHRAY_MEMORY, PATCHRAY_OK] {
            assert_eq!(code, unsafe { P::GRIDS(&patches, null(), &mut of_grids, &mut grids) });
            if code == PATCHRAY_MEMORY {
                of_grids.grids = take(lent, of_grids.grids_len);
                of_grids.offsets = take(lent, of_grids.offsets_len);
                of_grids.references = take(lent, of_grids.references_len);
            }
        }
        let surfaces = nets.len();
        let mut prepared = Prepared {
            scene,
            patches,
            tree,
            grids,
            ray: patchray_ray { origin: [S::ZERO; 3], direction: [S::ONE; 3], t_min: S::ZERO, t_max: S::INFINITY },
            // SAFETY: plain numbers.
            limits: unsafe { core::mem::zeroed() },
            scratch,
            // SAFETY: plain numbers.
            hit: unsafe { core::mem::zeroed() },
            // SAFETY: plain numbers.
            work: unsafe { core::mem::zeroed() },
            memory: vec![0; (surfaces * size_of::<patchray_remembered<S>>()).div_ceil(8)],
            surfaces,
            _lent: core::mem::take(lent),
        };
        assert_eq!(PATCHRAY_OK, unsafe { P::LIMITS(&mut prepared.limits) });
        prepared
    }

    /// What a right call takes.
    pub fn arguments(&mut self) -> Arguments<S> {
        Arguments {
            scene: &raw const self.scene,
            patches: &raw const self.patches,
            tree: &raw const self.tree,
            grids: &raw const self.grids,
            memory: self.memory.as_mut_ptr().cast(),
            memory_len: self.surfaces,
            line: 0,
            ray: &raw const self.ray,
            limits: &raw const self.limits,
            scratch: self.scratch.as_mut_ptr(),
            words: self.scratch.len(),
            hit: &raw mut self.hit,
            work: &raw mut self.work,
        }
    }

    /// How many surfaces the scene has.
    pub fn surfaces(&self) -> usize {
        self.surfaces
    }

    /// Coherence memory as at first.
    pub fn forget(&mut self) {
        self.memory.fill(0);
    }
}
