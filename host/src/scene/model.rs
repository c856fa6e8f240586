//! What a patch file holds: surfaces by control points, as written.
use patchray::pieces::Part;

/// A Bézier surface as its file states it, in the file's units.
///
/// `points` holds `(degree_u + 1) * (degree_v + 1)` control points `[x, y, z, w]`, u being the outer index: the point
/// of row `i` (u) and column `j` (v) is `points[i * (degree_v + 1) + j]`. The weight is *not* multiplied in; it is 1
/// throughout a polynomial surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelSurface {
    /// Number in its file, from 0. It counts surfaces that were left out, so it need not be an index.
    pub number: usize,
    /// Degree in u, 1 to 15.
    pub degree_u: usize,
    /// Degree in v, 1 to 15.
    pub degree_v: usize,
    /// Whether the file gave weights (lines of four numbers).
    pub rational: bool,
    /// The control points.
    pub points: Vec<[f64; 4]>,
    /// Of a piece of a B-spline, the knots between which it lies. `None` for a surface that its file states as Bézier, whose
    /// parameters are 0 to 1.
    pub knots: Option<Part<f64>>,
}

impl ModelSurface {
    /// The parameters, as the file's surface has them, of the point at (u, v), each from 0 to 1.
    pub fn parameters(&self, u: f64, v: f64) -> [f64; 2] {
        match self.knots {
            Some(part) => part.in_knots(u, v),
            None => [u, v],
        }
    }
}

impl ModelSurface {
    /// The point at (u, v), each from 0 to 1, by de Casteljau's scheme in `f64` on the control points of the file.
    pub fn point(&self, u: f64, v: f64) -> [f64; 3] {
        let weighted = |&[x, y, z, w]: &[f64; 4]| [x * w, y * w, z * w, w];
        let blend = |points: &mut Vec<[f64; 4]>, t: f64| {
            // Ends: each round leaves one point less.
            while points.len() > 1 {
                for k in 0..points.len() - 1 {
                    let (low, high) = (points[k], points[k + 1]);
                    points[k] = [0, 1, 2, 3].map(|axis| (1.0 - t) * low[axis] + t * high[axis]);
                }
                points.pop();
            }
            points.first().copied().unwrap_or_default()
        };
        let rows = self.points.chunks(self.degree_v + 1);
        let mut column: Vec<[f64; 4]> = rows.map(|row| blend(&mut row.iter().map(weighted).collect(), v)).collect();
        let [x, y, z, w] = blend(&mut column, u);
        [x / w, y / w, z / w]
    }
}

/// The surfaces of one file, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The surfaces.
    pub surfaces: Vec<ModelSurface>,
}

impl Model {
    /// A model of these surfaces, numbered in their order.
    pub fn numbered(mut surfaces: Vec<ModelSurface>) -> Model {
        for (number, surface) in surfaces.iter_mut().enumerate() {
            surface.number = number;
        }
        Model { surfaces }
    }

    /// The smallest box around all control points; `None` without any.
    pub fn control_box(&self) -> Option<ControlBox> {
        ControlBox::around(self.surfaces.iter().flat_map(|surface| &surface.points))
    }
}

/// A box with its sides along the axes, in the file's units. By the convex hull property it holds the surfaces whose
/// control points it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlBox {
    /// The smallest coordinates.
    pub min: [f64; 3],
    /// The largest coordinates.
    pub max: [f64; 3],
}

impl ControlBox {
    /// The smallest box around these points; `None` without any.
    pub fn around<'p>(points: impl IntoIterator<Item = &'p [f64; 4]>) -> Option<ControlBox> {
        let mut points = points.into_iter();
        let &[x, y, z, _] = points.next()?;
        let mut control_box = ControlBox { min: [x, y, z], max: [x, y, z] };
        for point in points {
            for axis in 0..3 {
                control_box.min[axis] = control_box.min[axis].min(point[axis]);
                control_box.max[axis] = control_box.max[axis].max(point[axis]);
            }
        }
        Some(control_box)
    }

    /// The length of the diagonal.
    pub fn diagonal(&self) -> f64 {
        let [dx, dy, dz] = [0, 1, 2].map(|axis| self.max[axis] - self.min[axis]);
        dx.hypot(dy).hypot(dz)
    }
}
