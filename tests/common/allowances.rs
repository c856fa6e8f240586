//! Every error allowance of the suites, and why it is as large as it is.
//!
//! All are in roundings, that is in units of [`Scalar::EPSILON`], of the largest number that takes part; a scene's
//! coordinates lie below 1 in its frame.

use patchray::scalar::Scalar;

/// A surface's point and derivatives: a basis of degree n takes some 2n products, the sums over n + 1 rows and columns as
/// many again, and half of the roundings cancel. Of degree 15, worst of all degree pairs.
pub const EVALUATION: u32 = 12;

/// The same for a rational surface: numerator and weight are each as good, their quotient has both errors.
pub const RATIONAL_EVALUATION: u32 = 32;

/// Restriction to a part and evaluation there: two passes of de Casteljau's algorithm in each direction, of up to 15 levels
/// with two roundings each, before the evaluation.
pub const RESTRICTION: u32 = 24;

/// A B-spline's piece against the B-spline, both summed in `f64`, for each degree of u and of v: one less than the degree
/// twice, of means with four roundings each, not all of one sign.
pub const PIECE_PER_DEGREE: u32 = 2;

/// Samples of a patch against its box: what the padding is there to cover must not need all of it.
pub const ENCLOSURE: u32 = 0;

/// A root's distance from the ray beyond the tolerance it was asked for: rounding of one evaluation and one projection.
pub const RESIDUAL: u32 = 24;

/// A Taylor remainder compared with its bound: the rounding of two evaluations, projected.
pub const REMAINDER: u32 = 48;

/// `roundings` as a number of this type.
pub fn roundings<S: Scalar>(roundings: u32) -> S {
    S::EPSILON * S::from_u32(roundings)
}
