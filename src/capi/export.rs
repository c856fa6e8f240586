//! The functions of the C interface, for each kind of control points and precision.
//!
//! All take addresses that may be anything, and have one requirement in common: an address that is neither null nor
//! misaligned leads to memory as the count beside it says (of one struct, if there is none), and tables to memory as the
//! counts in them say, which nothing else uses during the call.
#![allow(clippy::missing_safety_doc)] // Said above for all; the header says it in its head.

use super::status::Code;
use super::types::*;
use super::{prepare, trace};
use crate::point::{Plain, Weighted};

/// The one number of a call's two kinds of ends.
#[inline(always)]
pub(super) fn code(result: Result<Code, Code>) -> i32 {
    match result {
        Ok(code) | Err(code) => code,
    }
}

/// The version of the tables that this library knows: to be compared with PATCHRAY_LAYOUT, which the header knows.
#[unsafe(no_mangle)]
pub extern "C" fn patchray_layout() -> u32 {
    PATCHRAY_LAYOUT
}

/// The functions of one kind of control points, by their names.
macro_rules! functions {
    (
        $s:ident, $p:ty,
        $(#[$scene_build_doc:meta])* scene_build: $scene_build:ident,
        $(#[$patches_build_doc:meta])* patches_build: $patches_build:ident,
        $(#[$clipping_closest_doc:meta])* clipping_closest: $clipping_closest:ident,
        $(#[$clipping_any_doc:meta])* clipping_any: $clipping_any:ident,
        $(#[$clipping_all_doc:meta])* clipping_all: $clipping_all:ident,
        $(#[$clipping_coherent_closest_doc:meta])* clipping_coherent_closest: $clipping_coherent_closest:ident,
        $(#[$newton_closest_doc:meta])* newton_closest: $newton_closest:ident,
        $(#[$newton_any_doc:meta])* newton_any: $newton_any:ident,
        $(#[$newton_coherent_closest_doc:meta])* newton_coherent_closest: $newton_coherent_closest:ident,
        $(#[$normal_doc:meta])* normal: $normal:ident,
    ) => {
        $(#[$scene_build_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $scene_build(
            nets: *const patchray_net<$s>,
            nets_len: usize,
            options: *const patchray_options<$s>,
            memory: *mut patchray_scene_memory<$s>,
            scene: *mut patchray_scene<$s>,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { prepare::scene_build::<$p>(nets, nets_len, options, memory, scene) })
        }

        $(#[$patches_build_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $patches_build(
            scene: *const patchray_scene<$s>,
            options: *const patchray_options<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            memory: *mut patchray_patches_memory<$s>,
            patches: *mut patchray_patches<$s>,
            tree: *mut patchray_tree<$s>,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { prepare::patches_build::<$p>(scene, options, scratch, scratch_words, memory, patches, tree) })
        }

        $(#[$clipping_closest_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $clipping_closest(
            scene: *const patchray_scene<$s>,
            ray: *const patchray_ray<$s>,
            limits: *const patchray_limits<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            hit: *mut patchray_hit<$s>,
            work: *mut patchray_work,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::clipping_closest::<$p>(scene, ray, limits, (scratch, scratch_words), (hit, work)) })
        }

        $(#[$clipping_any_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $clipping_any(
            scene: *const patchray_scene<$s>,
            ray: *const patchray_ray<$s>,
            limits: *const patchray_limits<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            hit: *mut patchray_hit<$s>,
            work: *mut patchray_work,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::clipping_any::<$p>(scene, ray, limits, (scratch, scratch_words), (hit, work)) })
        }

        $(#[$clipping_all_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $clipping_all(
            scene: *const patchray_scene<$s>,
            ray: *const patchray_ray<$s>,
            limits: *const patchray_limits<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            hits: *mut patchray_hit<$s>,
            hits_len: usize,
            found: *mut usize,
            work: *mut patchray_work,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::clipping_all::<$p>(scene, ray, limits, (scratch, scratch_words), (hits, hits_len), (found, work)) })
        }

        $(#[$clipping_coherent_closest_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $clipping_coherent_closest(
            scene: *const patchray_scene<$s>,
            patches: *const patchray_patches<$s>,
            grids: *const patchray_grids<$s>,
            memory: *mut patchray_remembered<$s>,
            memory_len: usize,
            scan_line: u32,
            ray: *const patchray_ray<$s>,
            limits: *const patchray_limits<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            hit: *mut patchray_hit<$s>,
            work: *mut patchray_work,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::clipping_coherent_closest::<$p>((scene, patches, grids), (memory, memory_len, scan_line), ray, limits, (scratch, scratch_words), (hit, work)) })
        }

        $(#[$newton_closest_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $newton_closest(
            scene: *const patchray_scene<$s>,
            patches: *const patchray_patches<$s>,
            tree: *const patchray_tree<$s>,
            ray: *const patchray_ray<$s>,
            limits: *const patchray_limits<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            hit: *mut patchray_hit<$s>,
            work: *mut patchray_work,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::newton_closest::<$p>((scene, patches, tree), ray, limits, (scratch, scratch_words), (hit, work)) })
        }

        $(#[$newton_any_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $newton_any(
            scene: *const patchray_scene<$s>,
            patches: *const patchray_patches<$s>,
            tree: *const patchray_tree<$s>,
            ray: *const patchray_ray<$s>,
            limits: *const patchray_limits<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            hit: *mut patchray_hit<$s>,
            work: *mut patchray_work,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::newton_any::<$p>((scene, patches, tree), ray, limits, (scratch, scratch_words), (hit, work)) })
        }

        $(#[$newton_coherent_closest_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $newton_coherent_closest(
            scene: *const patchray_scene<$s>,
            patches: *const patchray_patches<$s>,
            grids: *const patchray_grids<$s>,
            memory: *mut patchray_remembered<$s>,
            memory_len: usize,
            scan_line: u32,
            ray: *const patchray_ray<$s>,
            limits: *const patchray_limits<$s>,
            scratch: *mut u64,
            scratch_words: usize,
            hit: *mut patchray_hit<$s>,
            work: *mut patchray_work,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::newton_coherent_closest::<$p>((scene, patches, grids), (memory, memory_len, scan_line), ray, limits, (scratch, scratch_words), (hit, work)) })
        }

        $(#[$normal_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $normal(
            scene: *const patchray_scene<$s>,
            hit: *const patchray_hit<$s>,
            normal: *mut [$s; 3],
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::normal::<$p>(scene, hit, normal) })
        }
    };
}

functions! {
    f32, Plain<f32>,
    /// Builds a scene of nets: checks them, copies their control points into lent memory, and builds the grid over them.
    ///
    /// Asked with counts of 0 it answers PATCHRAY_MEMORY, and the counts say what is needed. On PATCHRAY_OK the counts say
    /// what is used, and the scene holds the addresses: the memory has to stay where it is for as long as the scene is used.
    /// nets are needed no more. On errors about one surface memory->wrong_surface is its number.
    scene_build: patchray_scene_build_f32,
    /// Subdivides a scene's surfaces into patches, in lent memory; and builds the trees over them, which only newton needs, if
    /// tree is not NULL. Counts as for scene_build; of nodes and links only with a tree. scratch: SUBDIVIDE words.
    patches_build: patchray_patches_build_f32,
    /// The closest hit by Bezier clipping: all roots are found, and no table but the scene is needed. Returns PATCHRAY_HIT,
    /// PATCHRAY_MISS or a negative code. scratch: CLIP words. limits and work may be NULL. After PATCHRAY_GAVE_UP_... hit is the
    /// closest one so far, which is no answer.
    clipping_closest: patchray_clipping_closest_f32,
    /// A hit by clipping, the first that is found, not the closest: for shadows. A miss is sure.
    clipping_any: patchray_clipping_any_f32,
    /// All hits by clipping, in order of t, PATCHRAY_MAX_HITS at most; found is set to how many stand in hits. More than
    /// hits_len are PATCHRAY_GAVE_UP_HITS, and the closest stand there.
    clipping_all: patchray_clipping_all_f32,
    /// The closest hit by clipping with scan-line coherence; coherence memory and scan lines as for newton_coherent_closest, all
    /// else as for clipping_closest.
    clipping_coherent_closest: patchray_clipping_coherent_closest_f32,
    /// The closest hit by the original numerical method: Newton's method from each patch that the ray meets. Returns
    /// PATCHRAY_HIT, PATCHRAY_MISS (not proved: a patch of which no start led to a root counts as missed), or a negative code.
    /// scratch: NEWTON words. limits and work may be NULL. After PATCHRAY_GAVE_UP_... hit is the closest one so far, which is
    /// no answer.
    newton_closest: patchray_newton_closest_f32,
    /// A hit by newton, the first that is found, not the closest: for shadows. A miss is not proved, as of newton_closest.
    newton_any: patchray_newton_any_f32,
    /// The closest hit by the improved numerical method, with scan-line coherence: rays of one scan line follow one another
    /// closely, and each begins where the last one ended. memory has a slot per surface and is left alone between rays; zeros at
    /// first. scan_line numbers the line, from 0 to 0xfffffffe: a number that no earlier line with this memory had begins anew.
    /// All else as for newton_closest.
    newton_coherent_closest: patchray_newton_coherent_closest_f32,
    /// The unit normal at a hit, along dS/du x dS/dv; 0, 0, 0 where the surface has none, as at the apex of a cone.
    normal: patchray_normal_f32,
}

functions! {
    f32, Weighted<f32>,
    /// As patchray_scene_build_f32, of control points with weights.
    scene_build: patchray_scene_build_f32_weighted,
    /// As patchray_patches_build_f32, of control points with weights.
    patches_build: patchray_patches_build_f32_weighted,
    /// As patchray_clipping_closest_f32, of control points with weights.
    clipping_closest: patchray_clipping_closest_f32_weighted,
    /// As patchray_clipping_any_f32, of control points with weights.
    clipping_any: patchray_clipping_any_f32_weighted,
    /// As patchray_clipping_all_f32, of control points with weights.
    clipping_all: patchray_clipping_all_f32_weighted,
    /// As patchray_clipping_coherent_closest_f32, of control points with weights.
    clipping_coherent_closest: patchray_clipping_coherent_closest_f32_weighted,
    /// As patchray_newton_closest_f32, of control points with weights.
    newton_closest: patchray_newton_closest_f32_weighted,
    /// As patchray_newton_any_f32, of control points with weights.
    newton_any: patchray_newton_any_f32_weighted,
    /// As patchray_newton_coherent_closest_f32, of control points with weights.
    newton_coherent_closest: patchray_newton_coherent_closest_f32_weighted,
    /// As patchray_normal_f32, of control points with weights.
    normal: patchray_normal_f32_weighted,
}

functions! {
    f64, Plain<f64>,
    /// As patchray_scene_build_f32, in double precision.
    scene_build: patchray_scene_build_f64,
    /// As patchray_patches_build_f32, in double precision.
    patches_build: patchray_patches_build_f64,
    /// As patchray_clipping_closest_f32, in double precision.
    clipping_closest: patchray_clipping_closest_f64,
    /// As patchray_clipping_any_f32, in double precision.
    clipping_any: patchray_clipping_any_f64,
    /// As patchray_clipping_all_f32, in double precision.
    clipping_all: patchray_clipping_all_f64,
    /// As patchray_clipping_coherent_closest_f32, in double precision.
    clipping_coherent_closest: patchray_clipping_coherent_closest_f64,
    /// As patchray_newton_closest_f32, in double precision.
    newton_closest: patchray_newton_closest_f64,
    /// As patchray_newton_any_f32, in double precision.
    newton_any: patchray_newton_any_f64,
    /// As patchray_newton_coherent_closest_f32, in double precision.
    newton_coherent_closest: patchray_newton_coherent_closest_f64,
    /// As patchray_normal_f32, in double precision.
    normal: patchray_normal_f64,
}

functions! {
    f64, Weighted<f64>,
    /// As patchray_scene_build_f32, in double precision, of control points with weights.
    scene_build: patchray_scene_build_f64_weighted,
    /// As patchray_patches_build_f32, in double precision, of control points with weights.
    patches_build: patchray_patches_build_f64_weighted,
    /// As patchray_clipping_closest_f32, in double precision, of control points with weights.
    clipping_closest: patchray_clipping_closest_f64_weighted,
    /// As patchray_clipping_any_f32, in double precision, of control points with weights.
    clipping_any: patchray_clipping_any_f64_weighted,
    /// As patchray_clipping_all_f32, in double precision, of control points with weights.
    clipping_all: patchray_clipping_all_f64_weighted,
    /// As patchray_clipping_coherent_closest_f32, in double precision, of control points with weights.
    clipping_coherent_closest: patchray_clipping_coherent_closest_f64_weighted,
    /// As patchray_newton_closest_f32, in double precision, of control points with weights.
    newton_closest: patchray_newton_closest_f64_weighted,
    /// As patchray_newton_any_f32, in double precision, of control points with weights.
    newton_any: patchray_newton_any_f64_weighted,
    /// As patchray_newton_coherent_closest_f32, in double precision, of control points with weights.
    newton_coherent_closest: patchray_newton_coherent_closest_f64_weighted,
    /// As patchray_normal_f32, in double precision, of control points with weights.
    normal: patchray_normal_f64_weighted,
}

/// The functions that know nothing of control points.
macro_rules! functions_of_scalars {
    (
        $s:ident,
        $(#[$grids_doc:meta])* grids_build: $grids_build:ident,
        $(#[$options_doc:meta])* options_default: $options_default:ident,
        $(#[$limits_doc:meta])* limits_default: $limits_default:ident,
    ) => {
        $(#[$grids_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $grids_build(
            patches: *const patchray_patches<$s>,
            options: *const patchray_options<$s>,
            memory: *mut patchray_grids_memory<$s>,
            grids: *mut patchray_grids<$s>,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { prepare::grids_build(patches, options, memory, grids) })
        }

        $(#[$options_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $options_default(options: *mut patchray_options<$s>) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::default_to(options, patchray_options::defaults()) })
        }

        $(#[$limits_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $limits_default(limits: *mut patchray_limits<$s>) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { trace::default_to(limits, patchray_limits::defaults()) })
        }
    };
}

functions_of_scalars! {
    f32,
    /// Builds the grid over the patches of each surface, which the coherent methods need. Counts as for scene_build.
    grids_build: patchray_grids_build_f32,
    /// Writes the default options: for the teapot about the paper's 7,594 patches.
    options_default: patchray_options_default_f32,
    /// Writes the default limits: the paper's values where it gives one, and budgets a hundred times what the hardest ray of
    /// the teapot needs.
    limits_default: patchray_limits_default_f32,
}

functions_of_scalars! {
    f64,
    /// As patchray_grids_build_f32, in double precision.
    grids_build: patchray_grids_build_f64,
    /// As patchray_options_default_f32, in double precision.
    options_default: patchray_options_default_f64,
    /// As patchray_limits_default_f32, in double precision.
    limits_default: patchray_limits_default_f64,
}
