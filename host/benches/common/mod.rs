//! The models that the benches share: one per path through the kernel's evaluation.

// Each bench is a crate of its own and takes what it needs.
#![allow(dead_code)]

use patchray_host::scene::model::Model;
use patchray_host::scene::{shapes, teapot};

/// Newell's teapot: bicubic, polynomial; the unrolled path.
pub(crate) fn teapot() -> Model {
    teapot::model().expect("the built-in teapot is valid")
}

/// A sphere of rational 2 × 2 surfaces: the other unrolled path, with weights.
pub(crate) fn sphere() -> Model {
    shapes::sphere([0.0; 3], 1.0)
}

/// A bumpy surface of 5 × 5: the general path, short.
pub(crate) fn bumpy5() -> Model {
    shapes::single(shapes::bumpy(5, [5, 5], [0.0; 3], 2.0, 0.5))
}

/// A bumpy surface of 15 × 15: the general path at its longest.
pub(crate) fn bumpy15() -> Model {
    shapes::single(shapes::bumpy(15, [15, 15], [0.0; 3], 2.0, 0.5))
}
