//! The functions of views in the C interface: see [`export`](super::export).
#![allow(clippy::missing_safety_doc)] // As there.

use super::export::code;
use super::types::*;
use super::view;
use crate::point::{Plain, Weighted};

/// The functions of views, of one kind of control points.
macro_rules! functions_of_views {
    (
        $s:ident, $p:ty,
        $(#[$build_doc:meta])* view_build: $build:ident,
        $($(#[$line_doc:meta])* $line:ident: $line_name:ident,)*
    ) => {
        $(#[$build_doc])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $build(
            scene: *const patchray_scene<$s>,
            patches: *const patchray_patches<$s>,
            camera: *const patchray_camera<$s>,
            memory: *mut patchray_view_memory<$s>,
            view: *mut patchray_view<$s>,
        ) -> i32 {
            // SAFETY: the caller's.
            code(unsafe { view::view_build::<$p>(scene, patches, camera, memory, view) })
        }

        $(
            $(#[$line_doc])*
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $line_name(
                view: *const patchray_view<$s>,
                line: *const patchray_line<$s>,
                line_memory: *mut patchray_line_memory<$s>,
                memory: *mut patchray_followed<$s>,
                memory_len: usize,
                limits: *const patchray_limits<$s>,
                scratch: *mut u64,
                scratch_words: usize,
                hits: *mut patchray_hit<$s>,
                codes: *mut i32,
                works: *mut patchray_work,
            ) -> i32 {
                let given =
                    view::OfLine { view, line, memory: line_memory, limits, scratch: (scratch, scratch_words), hits, codes, works };
                // SAFETY: the caller's.
                code(unsafe { view::$line::<$p>(given, (memory, memory_len)) })
            }
        )*
    };
}

functions_of_views! {
    f32, Plain<f32>,
    /// Turns a scene and its patches to a camera, for tracing scan lines of its image. Counts as for scene_build. The view goes on
    /// reading the surfaces, offsets and references of the scene and the first of the patches; their points and patches it has
    /// turned. Codes of rays are of the camera's three vectors.
    view_build: patchray_view_build_f32,
    /// Traces a scan line by clipping around where the hit is predicted: of each ray the hit, in codes what
    /// patchray_clipping_closest would return, and in works, unless it is NULL, what was done; each has as many slots as the line
    /// has rays. memory has a slot per surface. Returns PATCHRAY_OK, or a negative code, after which nothing was written but counts.
    /// scratch: CLIP words.
    clipping_predicted_line: patchray_clipping_predicted_line_f32,
    /// The same by Newton's method from where the hit is predicted, the fastest of all. scratch: NEWTON words.
    newton_predicted_line: patchray_newton_predicted_line_f32,
}

functions_of_views! {
    f32, Weighted<f32>,
    /// As patchray_view_build_f32, of control points with weights.
    view_build: patchray_view_build_f32_weighted,
    /// As patchray_clipping_predicted_line_f32, of control points with weights.
    clipping_predicted_line: patchray_clipping_predicted_line_f32_weighted,
    /// As patchray_newton_predicted_line_f32, of control points with weights.
    newton_predicted_line: patchray_newton_predicted_line_f32_weighted,
}

functions_of_views! {
    f64, Plain<f64>,
    /// As patchray_view_build_f32, in double precision.
    view_build: patchray_view_build_f64,
    /// As patchray_clipping_predicted_line_f32, in double precision.
    clipping_predicted_line: patchray_clipping_predicted_line_f64,
    /// As patchray_newton_predicted_line_f32, in double precision.
    newton_predicted_line: patchray_newton_predicted_line_f64,
}

functions_of_views! {
    f64, Weighted<f64>,
    /// As patchray_view_build_f32, in double precision, of control points with weights.
    view_build: patchray_view_build_f64_weighted,
    /// As patchray_clipping_predicted_line_f32, in double precision, of control points with weights.
    clipping_predicted_line: patchray_clipping_predicted_line_f64_weighted,
    /// As patchray_newton_predicted_line_f32, in double precision, of control points with weights.
    newton_predicted_line: patchray_newton_predicted_line_f64_weighted,
}
