//! What a patch file holds: surfaces by control points, as written.

/// A Bézier surface as its file states it, in the file's units.
///
/// `points` holds `(degree_u + 1) * (degree_v + 1)` control points `[x, y, z, w]`, u being the outer index: the point
/// of row `i` (u) and column `j` (v) is `points[i * (degree_v + 1) + j]`. The weight is *not* multiplied in; it is 1
/// throughout a polynomial surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelSurface {
    /// Degree in u, 1 to 15.
    pub degree_u: usize,
    /// Degree in v, 1 to 15.
    pub degree_v: usize,
    /// Whether the file gave weights (lines of four numbers).
    pub rational: bool,
    /// The control points.
    pub points: Vec<[f64; 4]>,
}

/// The surfaces of one file, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The surfaces.
    pub surfaces: Vec<ModelSurface>,
}
