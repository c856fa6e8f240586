//! Why a model could not be lowered.

use miette::Diagnostic;
use thiserror::Error;

/// Why a model could not be lowered.
#[derive(Debug, Error, Diagnostic)]
pub enum LowerError {
    /// A surface that the number type cannot hold.
    #[error("surface {number} cannot be traced: {reason}")]
    #[diagnostic(help("use --precision f64 or other units, or --skip-invalid to leave such surfaces out"))]
    Surface {
        /// Its index in the model.
        index: usize,
        /// Its number in its file.
        number: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// The model has an extent in the file and none in the number type.
    #[error("the model shrinks to a point in f32: its diagonal is {diagonal:e}")]
    #[diagnostic(help("use --precision f64, larger units, or an origin nearer to the model"))]
    Vanishes {
        /// The diagonal of its control points, in the file's units.
        diagonal: f64,
    },
    /// A surface makes too many patches.
    #[error("surface {number} needs more patches than it is given: more than {given}")]
    #[diagnostic(help("raise --limit patches-per-surface=N, or subdivide less with a larger --flatness"))]
    Patches {
        /// Its number in its file.
        number: usize,
        /// The most that it may make.
        given: u32,
    },
    /// More memory than the limit `arena-bytes` allows.
    #[error("the scene needs at least {needed} bytes of memory and is given {given}: {detail}")]
    #[diagnostic(help("raise --limit arena-bytes=N, or make fewer patches (--flatness) and voxels (--grid-density)"))]
    Arena {
        /// Bytes needed, by all stages so far.
        needed: u64,
        /// Bytes allowed.
        given: u64,
        /// The bytes by kind.
        detail: String,
    },
    /// The system has not as much memory.
    #[error("the system does not give the {needed} bytes of memory that the scene's {kind} need")]
    #[diagnostic(help("make fewer patches (--flatness) and voxels (--grid-density), or use --precision f32"))]
    System {
        /// Bytes needed for this kind of slot.
        needed: u64,
        /// Which kind of slot.
        kind: &'static str,
    },
    /// A method that traces nothing but the rays of one view, and a picture whose rays the kernel cannot take for these.
    #[error("`{method}` cannot draw this picture: {reason}")]
    #[diagnostic(help(
        "it traces the rays of one view, within 45 degrees of its middle and from an eye near the scene; use --method \
         newton, newton-coherent, clipping or clipping-coherent, or another camera"
    ))]
    NoView {
        /// The method.
        method: &'static str,
        /// What is not as in a view.
        reason: String,
    },
    /// More surfaces, points, patches or voxels than the kernel can number.
    #[error("the scene is too large: {0}")]
    #[diagnostic(help("make fewer patches (--flatness) and voxels (--grid-density), or split the scene"))]
    TooLarge(String),
    /// The kernel contradicted itself; a defect.
    #[error("building the scene failed: {0}")]
    Internal(String),
}
