//! Closed forms in double-double: where a ray meets a weighted bilinear surface, a flat one among them, and a pipe.
//!
//! They share nothing with the oracle but its numbers.

use crate::oracle::{DoubleDouble, Real};
use crate::scene::model::ModelSurface;
use crate::scene::rays::RayLine;

type Number = DoubleDouble;

/// A root by a closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormRoot {
    /// The ray's parameter.
    pub t: f64,
    /// The logarithms of u / (1 - u) and v / (1 - v), which tell how near either end is.
    pub place: [f64; 2],
}

fn dot(a: [Number; 3], b: [Number; 3]) -> Number {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [Number; 3], b: [Number; 3]) -> [Number; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The roots of a x² + 2 b x + c, in order, without cancellation; none of 0 = c.
fn quadratic(a: Number, b: Number, c: Number) -> Vec<Number> {
    let discriminant = b * b - a * c;
    if discriminant < Number::ZERO {
        return Vec::new();
    }
    let root = discriminant.sqrt();
    let far = if b < Number::ZERO { root - b } else { -b - root };
    let mut roots = Vec::new();
    if a != Number::ZERO {
        roots.push(far / a);
    }
    if far != Number::ZERO {
        roots.push(c / far);
    } else if a != Number::ZERO {
        roots.push(Number::ZERO);
    }
    roots.sort_by(|a, b| a.order(b));
    roots
}

/// Where a ray, a line of any t, meets a surface of degrees 1 × 1 with weights, in order of t. In U = u / (1 - u) and V alike
/// each of two planes through the ray gives a + b V + c U + e U V = 0, whose coefficients are the corners' distances times their
/// weights; U out of both is a quadratic in V.
pub fn meet_bilinear(surface: &ModelSurface, ray: &RayLine) -> Vec<FormRoot> {
    let d = ray.direction.map(Number::new);
    let origin = ray.origin.map(Number::new);
    let least = (0..3).min_by(|&a, &b| ray.direction[a].abs().total_cmp(&ray.direction[b].abs())).unwrap_or(0);
    let mut axis = [Number::ZERO; 3];
    axis[least] = Number::ONE;
    let first = cross(axis, d);
    let normals = [first, cross(d, first)];
    let corners = [0, 1, 2, 3].map(|k| {
        let point = surface.points.get(k).copied().unwrap_or_default();
        ([0, 1, 2].map(|axis| Number::new(point[axis]) - origin[axis]), Number::new(point[3]))
    });
    let [x, y] = normals.map(|normal| corners.map(|(corner, weight)| dot(normal, corner) * weight));
    // In the order of the corners: 1, V, U, U V.
    let a = x[1] * y[3] - y[1] * x[3];
    let c = x[0] * y[2] - y[0] * x[2];
    let b = (x[0] * y[3] + x[1] * y[2] - y[0] * x[3] - y[1] * x[2]).half();
    let mut roots = Vec::new();
    for v in quadratic(a, b, c) {
        // Of the two planes the one whose divisor is the larger share of what it is made of.
        let divisor = |p: &[Number; 4]| p[2] + v * p[3];
        let part = |p: &[Number; 4]| divisor(p).abs().to_f64() / (p[2].abs() + v.abs() * p[3].abs()).to_f64();
        let plane = if part(&x) >= part(&y) { &x } else { &y };
        let u = -(plane[0] + v * plane[1]) / divisor(plane);
        if !(v > Number::ZERO && u > Number::ZERO) {
            continue;
        }
        let shares = [Number::ONE, v, u, u * v];
        let (mut along, mut weights) = (Number::ZERO, Number::ZERO);
        for (share, (corner, weight)) in shares.into_iter().zip(corners) {
            along += share * weight * dot(corner, d);
            weights += share * weight;
        }
        let t = along / (weights * dot(d, d));
        roots.push(FormRoot { t: t.to_f64(), place: [u, v].map(|x| x.to_f64().ln()) });
    }
    roots.sort_by(|a, b| a.t.total_cmp(&b.t));
    roots
}

/// Where a line meets the pipe y²/b² + z²/c² = 1 along x, of half widths b and c: both roots, or none.
pub fn meet_pipe(half_widths: [f64; 2], ray: &RayLine) -> Option<[f64; 2]> {
    let scaled = |v: [f64; 3]| [0, 1].map(|k| Number::new(v[k + 1]) / Number::new(half_widths[k]));
    let [o, d] = [ray.origin, ray.direction].map(scaled);
    let plane = |a: [Number; 2], b: [Number; 2]| a[0] * b[0] + a[1] * b[1];
    // From the point nearest to the axis, where nothing cancels.
    let speed = plane(d, d);
    let nearest = -plane(o, d) / speed;
    let across = o[0] * d[1] - o[1] * d[0];
    let inside = speed - across * across;
    if !(inside >= Number::ZERO) {
        return None;
    }
    let half = inside.sqrt() / speed;
    Some([(nearest - half).to_f64(), (nearest + half).to_f64()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shapes::{bilinear, parallelogram};
    use crate::stress::case::ray;
    use glam::DVec3;

    #[test]
    fn a_saddle_is_met_twice_and_a_steep_square_once() {
        // z = x y over [-1, 1]².
        let saddle = bilinear([[-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]);
        let along = ray(DVec3::new(-2.0, -2.0, 0.25), DVec3::new(1.0, 1.0, 0.0));
        let roots = meet_bilinear(&saddle, &along);
        assert_eq!(roots.iter().map(|root| root.t).collect::<Vec<_>>(), [1.5, 2.5]);
        let mut square = parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        for (point, weight) in square.points.iter_mut().zip([1.0, 1.0, 1e-9, 1e-9]) {
            point[3] = weight;
        }
        let down = |x: f64| meet_bilinear(&square, &ray(DVec3::new(x, 0.25, 1.0), DVec3::NEG_Z));
        for x in [1e-12, 0.5, 0.75, 1.0 - 1e-12] {
            let roots = down(x);
            assert_eq!(roots.len(), 1, "{x}: {roots:?}");
            assert_eq!(roots[0].t, 1.0);
            assert!((roots[0].place[0] - (1e9 * x / (1.0 - x)).ln()).abs() < 1e-3);
        }
        assert!(down(-1e-12).is_empty() && down(1.0 + 1e-12).is_empty());
    }

    #[test]
    fn a_pipe_is_met_on_either_side_of_its_axis() {
        let across = ray(DVec3::new(0.0, 0.0, 2.0), DVec3::NEG_Z);
        assert_eq!(meet_pipe([0.5, 0.25], &across), Some([1.75, 2.25]));
        let aside = ray(DVec3::new(0.0, 0.6, 2.0), DVec3::NEG_Z);
        assert_eq!(meet_pipe([0.5, 0.25], &aside), None);
    }
}
