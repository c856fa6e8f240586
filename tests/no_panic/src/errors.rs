//! The entry point that writes errors out: apart, because it alone links the formatting of `core`.

use core::fmt::{Display, Write};
use patchray::bspline::BSplineError;
use patchray::grid::GridError;
use patchray::limits::{GaveUp, Limit};
use patchray::pieces::PieceError;
use patchray::ray::RayError;
use patchray::scene::SceneError;
use patchray::subdivide::SubdivideError;
use patchray::surface::NetError;

/// Where text goes: a function of the caller's, which may refuse it.
#[derive(Debug)]
#[repr(C)]
pub struct Sink {
    take: unsafe extern "C" fn(text: *const u8, length: usize) -> bool,
}

impl Write for Sink {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        // SAFETY: the text is valid for the length of the call.
        if unsafe { (self.take)(text.as_ptr(), text.len()) } { Ok(()) } else { Err(core::fmt::Error) }
    }
}

/// One of each kind of error.
#[derive(Debug)]
pub struct Errors {
    limit: Limit,
    gave_up_single: GaveUp<f32>,
    gave_up_double: GaveUp<f64>,
    ray: RayError,
    net: NetError,
    spline: BSplineError,
    pieces: PieceError,
    scene: SceneError,
    subdivide: SubdivideError,
    grid: GridError,
}

/// Writes all errors; the number of those that the sink took.
#[unsafe(no_mangle)]
pub extern "C" fn reach_display_f64_plain(errors: &Errors, sink: &mut Sink) -> u32 {
    let all: [&dyn Display; 10] = [
        &errors.limit,
        &errors.gave_up_single,
        &errors.gave_up_double,
        &errors.ray,
        &errors.net,
        &errors.spline,
        &errors.pieces,
        &errors.scene,
        &errors.subdivide,
        &errors.grid,
    ];
    all.into_iter().map(|error| u32::from(write!(sink, "{error}").is_ok())).sum()
}
