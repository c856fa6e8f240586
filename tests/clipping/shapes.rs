//! What is done to the surfaces of this suite.

use patchray_host::scene::model::Model;

/// The model with every control point moved by `map`.
pub(crate) fn mapped(model: &Model, map: impl Fn([f64; 3]) -> [f64; 3]) -> Model {
    let mut model = model.clone();
    for point in model.surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
        let [x, y, z] = map([point[0], point[1], point[2]]);
        *point = [x, y, z, point[3]];
    }
    model
}

/// A shear that leaves no axis where it was, exact for short numbers; and the same of directions.
pub(crate) fn askew([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.25 * y - 0.5 * z, y - 0.125 * x + 0.75 * z, z + 0.375 * x + 0.5 * y]
}
