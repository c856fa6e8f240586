//! Polygons: what is flat in a scene, such as a floor. They are no surfaces, and no method of the kernel sees them.
use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::error::InputError;
use super::transform::Transform;
use crate::vector::{cross, dot, length, subtract};

/// A plane polygon without holes, convex or not, whose edges meet only at its vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: Vec<[f64; 3]>,
    normal: [f64; 3],
    /// The two axes along which the polygon is seen as a plane figure: all but that of the normal's largest part.
    axes: [usize; 2],
}

/// How far a vertex may be from the plane of the others, and how thin a polygon may be, as a share of its perimeter.
const FLAT: f64 = 1e-6;

/// What is wrong with vertices that make no polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Fewer than three.
    TooFew,
    /// So far apart that squares of lengths are not finite.
    TooLarge,
    /// All on one line, or almost; or edges that cross so that as much is turned left as right.
    Thin,
    /// One is off the plane of the others.
    NotPlane,
    /// Two edges meet elsewhere than at the vertex that they share.
    Crossing,
}

impl Polygon {
    /// The polygon with these vertices, in order around it.
    ///
    /// # Errors
    /// They make no plane polygon.
    pub fn new(vertices: Vec<[f64; 3]>) -> Result<Self, Fault> {
        if vertices.len() < 3 {
            return Err(Fault::TooFew);
        }
        // The sum over edges is twice the area, along the normal (M. E. Newell's rule).
        let (mut area, mut perimeter) = ([0.0; 3], 0.0);
        for [a, b] in edges(&vertices) {
            let [from, to] = [a, b].map(|vertex| subtract(vertex, vertices[0]));
            area = [0, 1, 2].map(|k| area[k] + cross(from, to)[k]);
            perimeter += length(subtract(b, a));
        }
        let size = length(area);
        if !(size.is_finite() && (perimeter * perimeter).is_finite()) {
            return Err(Fault::TooLarge);
        }
        if size <= FLAT * perimeter * perimeter {
            return Err(Fault::Thin);
        }
        let normal = area.map(|x| x / size);
        let off = vertices.iter().map(|&vertex| dot(normal, subtract(vertex, vertices[0])).abs());
        if off.fold(0.0, f64::max) > FLAT * perimeter {
            return Err(Fault::NotPlane);
        }
        let largest = (0..3).fold(0, |best, k| if normal[k].abs() > normal[best].abs() { k } else { best });
        let axes = [(largest + 1) % 3, (largest + 2) % 3];
        let polygon = Polygon { vertices, normal, axes };
        if polygon.crosses_itself() { Err(Fault::Crossing) } else { Ok(polygon) }
    }

    /// The polygon moved.
    ///
    /// # Errors
    /// That makes it too thin or too large.
    pub fn transformed(&self, transform: &Transform) -> Result<Self, Fault> {
        Self::new(self.vertices.iter().map(|&vertex| transform.point(vertex)).collect())
    }

    /// The unit normal; which of the two depends on the order of the vertices.
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// The t, strictly between `t_min` and `t_max`, at which a ray meets the polygon.
    pub fn intersect(&self, origin: [f64; 3], direction: [f64; 3], t_min: f64, t_max: f64) -> Option<f64> {
        let t = dot(self.normal, subtract(self.vertices[0], origin)) / dot(self.normal, direction);
        // A ray along the plane has no such t, or an infinite one.
        if !(t > t_min && t < t_max && t.is_finite()) {
            return None;
        }
        self.holds([0, 1, 2].map(|k| origin[k] + t * direction[k])).then_some(t)
    }

    /// Whether a point of the plane is inside: a line from it to one side meets an odd number of edges.
    fn holds(&self, point: [f64; 3]) -> bool {
        let [x, y] = self.seen(point);
        let mut inside = false;
        for edge in edges(&self.vertices) {
            let [a, b] = edge.map(|vertex| self.seen(vertex));
            if (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
                inside = !inside;
            }
        }
        inside
    }

    fn seen(&self, point: [f64; 3]) -> [f64; 2] {
        self.axes.map(|axis| point[axis])
    }

    fn crosses_itself(&self) -> bool {
        let edges: Vec<_> = edges(&self.vertices).map(|edge| edge.map(|vertex| self.seen(vertex))).collect();
        let count = edges.len();
        (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j))).any(|(i, j)| {
            let (first, second) = (edges[i], edges[j]);
            if j == i + 1 {
                on(first, second[1]) || on(second, first[0])
            } else if (j + 1) % count == i {
                on(second, first[1]) || on(first, second[0])
            } else {
                let apart = |[a, b]: [[f64; 2]; 2], other: [[f64; 2]; 2]| {
                    let [p, q] = other.map(|point| turn(a, b, point));
                    (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0)
                };
                let ends = |edge: [[f64; 2]; 2], other: [[f64; 2]; 2]| other.iter().any(|&point| on(edge, point));
                let collinear = first.iter().all(|&point| turn(second[0], second[1], point) == 0.0);
                ends(first, second)
                    || ends(second, first)
                    || (!collinear && !apart(first, second) && !apart(second, first))
            }
        })
    }
}

/// The edges, from the first vertex on.
fn edges(vertices: &[[f64; 3]]) -> impl Iterator<Item = [[f64; 3]; 2]> {
    (0..vertices.len()).map(|k| [vertices[k], vertices[(k + 1) % vertices.len()]])
}

/// Above 0 if a, b, c turn left, below if they turn right.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether a point lies on an edge.
fn on([a, b]: [[f64; 2]; 2], point: [f64; 2]) -> bool {
    let between = |k: usize| a[k].min(b[k]) <= point[k] && point[k] <= a[k].max(b[k]);
    turn(a, b, point) == 0.0 && between(0) && between(1)
}

/// An entry of `polygons` as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PolygonTable {
    vertices: Spanned<Vec<Spanned<Vec<f64>>>>,
    pub(super) material: Option<Spanned<String>>,
}

impl PolygonTable {
    pub(super) fn check(&self, check: &Check) -> Result<Polygon, InputError> {
        let vertices = self.vertices.get_ref().iter().map(|vertex| check.triple("a vertex", vertex));
        let vertices = vertices.collect::<Result<Vec<_>, _>>()?;
        Polygon::new(vertices).map_err(|fault| {
            let (message, help) = match fault {
                Fault::TooFew => ("a polygon has at least three vertices", "add the missing ones"),
                Fault::TooLarge => ("this polygon is too large", "write smaller numbers"),
                Fault::Thin => (
                    "this polygon has no area",
                    "write the vertices in their order around it, and not all of them on one line",
                ),
                Fault::NotPlane => (
                    "the vertices of this polygon do not lie in one plane",
                    "move the one that is off it, or cut the polygon into triangles",
                ),
                Fault::Crossing => (
                    "two edges of this polygon cross or touch",
                    "write the vertices in their order around it, each once",
                ),
            };
            check.source.refuse(self.vertices.span(), message, "these vertices", help)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An L of six corners in the plane z = 1, its notch at the upper right.
    fn notched() -> Polygon {
        let corners = [[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]];
        Polygon::new(corners.map(|[x, y]| [x, y, 1.0]).to_vec()).expect("a polygon")
    }

    #[test]
    fn rays_hit_inside_and_miss_the_notch() {
        let polygon = notched();
        assert_eq!(polygon.normal(), [0.0, 0.0, 1.0]);
        let down = |x: f64, y: f64| polygon.intersect([x, y, 5.0], [0.0, 0.0, -2.0], 0.0, f64::INFINITY);
        for (x, y) in [(0.5, 0.5), (1.5, 0.5), (0.5, 1.5), (0.999, 1.0)] {
            assert_eq!(down(x, y), Some(2.0), "{x} {y}");
        }
        for (x, y) in [(1.5, 1.5), (1.001, 1.0), (-0.1, 0.5), (0.5, 2.1), (3.0, 1.0)] {
            assert_eq!(down(x, y), None, "{x} {y}");
        }
    }

    #[test]
    fn hits_outside_the_range_and_along_the_plane_are_none() {
        let polygon = notched();
        assert_eq!(polygon.intersect([0.5, 0.5, 5.0], [0.0, 0.0, -2.0], 0.0, 2.0), None);
        assert_eq!(polygon.intersect([0.5, 0.5, 5.0], [0.0, 0.0, -2.0], 2.0, 9.0), None);
        assert_eq!(polygon.intersect([0.5, 0.5, 5.0], [0.0, 0.0, 2.0], 0.0, 9.0), None);
        assert_eq!(polygon.intersect([-5.0, 0.5, 1.0], [1.0, 0.0, 0.0], 0.0, f64::INFINITY), None);
        assert_eq!(polygon.intersect([-5.0, 0.5, 2.0], [1.0, 0.0, 0.0], 0.0, f64::INFINITY), None);
    }

    #[test]
    fn what_is_no_polygon() {
        let flat = |corners: &[[f64; 2]]| Polygon::new(corners.iter().map(|&[x, y]| [y, 3.0, x]).collect());
        assert_eq!(flat(&[[0., 0.], [1., 0.]]), Err(Fault::TooFew));
        assert_eq!(flat(&[[0., 0.], [1., 1.], [2., 2.], [3., 3.]]), Err(Fault::Thin));
        assert_eq!(flat(&[[1., 1.]; 4]), Err(Fault::Thin));
        assert_eq!(flat(&[[0., 0.], [1e200, 0.], [0., 1e200]]), Err(Fault::TooLarge));
        // A bow tie whose halves are not alike, a vertex on an edge, and an edge that runs back along another.
        assert_eq!(flat(&[[0., 0.], [3., 3.], [3., 0.], [0., 1.]]), Err(Fault::Crossing));
        assert_eq!(flat(&[[0., 0.], [4., 0.], [4., 4.], [2., 0.], [0., 4.]]), Err(Fault::Crossing));
        assert_eq!(flat(&[[0., 0.], [4., 0.], [4., 4.], [4., 1.]]), Err(Fault::Crossing));
        let bent = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.01]];
        assert_eq!(Polygon::new(bent.to_vec()), Err(Fault::NotPlane));
        assert!(flat(&[[0., 0.], [2., 0.], [1., 0.5], [2., 2.]]).is_ok());
        // A vertex in the middle of a straight side is none too many.
        assert!(flat(&[[0., 0.], [1., 0.], [2., 0.], [2., 2.]]).is_ok());
    }
}
