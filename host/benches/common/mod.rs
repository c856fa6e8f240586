//! The models that the benches share: one per path through the kernel's evaluation.

use patchray_host::scene::model::Model;
use patchray_host::scene::{shapes, teapot};

/// Newell's teapot: bicubic, polynomial; the unrolled path.
pub fn teapot() -> Model {
    teapot::model().expect("the built-in teapot is valid")
}

/// A sphere of rational 2 × 2 surfaces: the other unrolled path, with weights.
pub fn sphere() -> Model {
    shapes::sphere([0.0; 3], 1.0)
}

/// A bumpy surface of 5 × 5: the general path, short.
pub fn bumpy5() -> Model {
    shapes::single(shapes::bumpy(5, [5, 5], [0.0; 3], 2.0, 0.5))
}

/// A bumpy surface of 15 × 15: the general path at its longest.
pub fn bumpy15() -> Model {
    shapes::single(shapes::bumpy(15, [15, 15], [0.0; 3], 2.0, 0.5))
}
