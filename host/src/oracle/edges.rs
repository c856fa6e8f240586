//! Which borders of the surfaces are seams, where a neighbour carries on, and which are outer borders.
//!
//! Two edges are one seam if they have the same control points, in either order, to within rounding, and weights in the
//! same ratios. Neighbours that share a curve in another form (another degree, a part of it, points apart by more than
//! rounding) count as having outer borders there, which can only lower a margin.

use super::net::{Degrees, MAX_ORDER, Point, curve_jet};
use super::real::Real;

/// The four edges of a surface, by number: u = 0, u = 1, v = 0, v = 1.
pub(super) const EDGES: usize = 4;

/// A surface's edge and how it continues.
#[derive(Clone, Debug)]
struct Edge<R> {
    /// The homogeneous control points of the edge.
    curve: Vec<Point<R>>,
    /// Those of the row next to it.
    inner: Vec<Point<R>>,
    /// Numbers of the edges that are one seam with this, and whether they run the other way.
    partners: Vec<(usize, bool)>,
}

/// All edges of a model.
#[derive(Clone, Debug)]
pub(super) struct Edges<R> {
    edges: Vec<Edge<R>>,
}

/// One edge's control points `[x, y, z, w]` and those of the row next to it, of a net that is not multiplied out.
fn rows<R: Real>(degrees: Degrees, points: &[Point<R>], edge: usize) -> [Vec<Point<R>>; 2] {
    let Degrees { m, n } = degrees;
    let along_v = |i: usize| (0..=n).map(|j| points[i * (n + 1) + j]).collect();
    let along_u = |j: usize| (0..=m).map(|i| points[i * (n + 1) + j]).collect();
    match edge {
        0 => [along_v(0), along_v(1)],
        1 => [along_v(m), along_v(m - 1)],
        2 => [along_u(0), along_u(1)],
        _ => [along_u(n), along_u(n - 1)],
    }
}

fn homogeneous<R: Real>(points: &[Point<R>]) -> Vec<Point<R>> {
    points.iter().map(|p| [p[0] * p[3], p[1] * p[3], p[2] * p[3], p[3]]).collect()
}

/// Whether two control polygons are the same to within `tolerance`.
fn same<'a, R: Real>(a: &[Point<R>], b: impl ExactSizeIterator<Item = &'a Point<R>>, tolerance: f64) -> bool {
    let mut ratio = None;
    a.len() == b.len()
        && a.iter().zip(b).all(|(p, q)| {
            let weights = p[3] / q[3];
            let first = *ratio.get_or_insert(weights);
            (weights / first - R::ONE).abs().to_f64() <= 8.0 * R::EPS
                && (0..3).all(|k| (p[k] - q[k]).abs().to_f64() <= tolerance)
        })
}

impl<R: Real> Edges<R> {
    /// The edges of surfaces given by degrees and control points; those of surface `s` are numbers `4 s` to `4 s + 3`.
    /// Points are the same if no coordinate differs by more than `share` of the edge's largest.
    pub(super) fn new<'a>(surfaces: impl Iterator<Item = (Degrees, &'a [Point<R>])>, share: f64) -> Edges<R> {
        let mut polygons = Vec::new();
        let mut edges = Vec::new();
        for (degrees, points) in surfaces {
            for number in 0..EDGES {
                let [curve, inner] = rows(degrees, points, number);
                edges.push(Edge { curve: homogeneous(&curve), inner: homogeneous(&inner), partners: Vec::new() });
                polygons.push(curve);
            }
        }
        // Same polygons have the same least x: only edges that adjoin in this order need a comparison.
        let least = |k: usize| polygons[k].iter().fold(R::INFINITY, |m, p| if p[0] < m { p[0] } else { m });
        let mut order: Vec<(R, usize)> = (0..polygons.len()).map(|k| (least(k), k)).collect();
        order.sort_by(|a, b| a.0.order(&b.0));
        let largest = |polygon: &[Point<R>]| {
            let coordinates = polygon.iter().flat_map(|p| &p[..3]);
            coordinates.fold(0.0, |m, x| f64::max(m, x.abs().to_f64()))
        };
        for (position, &(x, a)) in order.iter().enumerate() {
            let tolerance = share * largest(&polygons[a]);
            for &(other, b) in &order[position + 1..] {
                if other > x + R::new(tolerance) {
                    break;
                }
                let forward = same(&polygons[a], polygons[b].iter(), tolerance);
                if forward || same(&polygons[a], polygons[b].iter().rev(), tolerance) {
                    edges[a].partners.push((b, !forward));
                    edges[b].partners.push((a, !forward));
                }
            }
        }
        Edges { edges }
    }

    /// Whether, seen along `direction`, another surface carries on across this edge at its parameter `s`: some surface
    /// with the same edge lies on its other side. It does not at an outer border, nor at a crease whose two sides fall
    /// on one another in that view; a collapsed edge, having no sides, never continues.
    pub(super) fn continues(&self, edge: usize, s: R, direction: [R; 3]) -> bool {
        let edge = &self.edges[edge];
        let side = |e: &Edge<R>, s: R, tangent: [R; 3]| {
            let [on, _, _] = evaluate(&e.curve, s);
            let [off, _, _] = evaluate(&e.inner, s);
            let inward = [0, 1, 2].map(|k| off[k] / off[3] - on[k] / on[3]);
            direction[0] * (tangent[1] * inward[2] - tangent[2] * inward[1])
                + direction[1] * (tangent[2] * inward[0] - tangent[0] * inward[2])
                + direction[2] * (tangent[0] * inward[1] - tangent[1] * inward[0])
        };
        let [on, by_s, _] = evaluate(&edge.curve, s);
        let tangent = [0, 1, 2].map(|k| by_s[k] - on[k] / on[3] * by_s[3]);
        let own = side(edge, s, tangent);
        edge.partners.iter().any(|&(other, reversed)| {
            let s = if reversed { R::ONE - s } else { s };
            side(&self.edges[other], s, tangent) * own < R::ZERO
        })
    }
}

fn evaluate<R: Real>(curve: &[Point<R>], s: R) -> [Point<R>; 3] {
    let mut c = [[R::ZERO; 4]; MAX_ORDER];
    c[..curve.len()].copy_from_slice(curve);
    curve_jet(curve.len() - 1, &mut c, s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof over the ridge x = 0: two bilinear surfaces, the second running the other way along it.
    fn roof() -> Edges<f64> {
        let one = Degrees { m: 1, n: 1 };
        let left = [[-1.0, 0.0, -1.0, 1.0], [-1.0, 1.0, -1.0, 1.0], [0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]];
        let right = [[0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [1.0, 1.0, -1.0, 1.0], [1.0, 0.0, -1.0, 1.0]];
        Edges::new([(one, &left[..]), (one, &right[..])].into_iter(), 1e-15)
    }

    #[test]
    fn a_seam_continues_unless_seen_as_a_crease() {
        let edges = roof();
        let ridge = [1, EDGES];
        for edge in ridge {
            assert!(edges.continues(edge, 0.3, [0.0, 0.0, -1.0]), "from above");
            assert!(!edges.continues(edge, 0.3, [1.0, 0.0, 0.1]), "from the side");
        }
        for edge in (0..2 * EDGES).filter(|e| !ridge.contains(e)) {
            assert!(!edges.continues(edge, 0.3, [0.0, 0.0, -1.0]), "an outer border");
        }
    }
}
