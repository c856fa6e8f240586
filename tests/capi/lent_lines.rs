//! The functions of views and scan lines through the C interface, for each kind of control points.

use crate::lent::InC;
use patchray::capi::*;
use patchray::point::{Plain, Weighted};

/// All that a function of one scan line takes.
#[derive(Clone, Copy)]
pub struct Arguments<S> {
    pub view: *const patchray_view<S>,
    pub line: *const patchray_line<S>,
    pub line_memory: *mut patchray_line_memory<S>,
    /// Of coherence.
    pub memory: *mut patchray_followed<S>,
    pub memory_len: usize,
    pub limits: *const patchray_limits<S>,
    pub scratch: *mut u64,
    pub words: usize,
    pub hits: *mut patchray_hit<S>,
    pub codes: *mut i32,
    pub works: *mut patchray_work,
}

pub type OfLine<S> = unsafe fn(&Arguments<S>) -> i32;

/// The functions for one kind of control points.
pub trait Views: InC {
    const VIEW: unsafe extern "C" fn(
        *const patchray_scene<Self::Scalar>,
        *const patchray_patches<Self::Scalar>,
        *const patchray_camera<Self::Scalar>,
        *mut patchray_view_memory<Self::Scalar>,
        *mut patchray_view<Self::Scalar>,
    ) -> i32;
    /// By clipping, then by Newton's method.
    const LINES: [OfLine<Self::Scalar>; 2];
}

macro_rules! views {
    ($point:ty, $view:ident, $($line:ident)*) => {
        impl Views for $point {
            const VIEW: unsafe extern "C" fn(
                *const patchray_scene<Self::Scalar>,
                *const patchray_patches<Self::Scalar>,
                *const patchray_camera<Self::Scalar>,
                *mut patchray_view_memory<Self::Scalar>,
                *mut patchray_view<Self::Scalar>,
            ) -> i32 = $view;
            const LINES: [OfLine<Self::Scalar>; 2] = [$(|a| unsafe {
                $line(
                    a.view,
                    a.line,
                    a.line_memory,
                    a.memory,
                    a.memory_len,
                    a.limits,
                    a.scratch,
                    a.words,
                    a.hits,
                    a.codes,
                    a.works,
                )
            },)*];
        }
    };
}
views!(Plain<f32>, patchray_view_build_f32, patchray_clipping_predicted_line_f32 patchray_newton_predicted_line_f32);
views!(Weighted<f32>, patchray_view_build_f32_weighted, patchray_clipping_predicted_line_f32_weighted
    patchray_newton_predicted_line_f32_weighted);
views!(Plain<f64>, patchray_view_build_f64, patchray_clipping_predicted_line_f64 patchray_newton_predicted_line_f64);
views!(Weighted<f64>, patchray_view_build_f64_weighted, patchray_clipping_predicted_line_f64_weighted
    patchray_newton_predicted_line_f64_weighted);
