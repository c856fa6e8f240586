//! Whether a surface comes near a point of a ray: by halving, each part dropped only where its hull is proved to be too far.
//!
//! Parameters in f64 may be too coarse to name a point of a surface: where weights fall toward u = 1, a step of u is long in
//! space. So what a hit's u and v say is not asked for, only whether the surface has such a point at all.

use super::net::{Axis, Degrees, Point, halve};
use super::real::{DoubleDouble, Real};
use super::{is_valid, surface::norm};
use crate::scene::model::ModelSurface;

/// Parts looked at before the question is left open: a point at the distance asked about takes some hundreds.
const MAX_PARTS: usize = 20_000;

/// Halvings of one parameter, after which it has no digits left.
const MAX_HALVINGS: u32 = 100;

/// Whether a surface is proved to have no point within `distance` of `origin + t direction`, in double-double. A surface that is
/// not valid, and a question that work runs out on, are not proved.
pub fn is_farther(surface: &ModelSurface, origin: [f64; 3], direction: [f64; 3], t: f64, distance: f64) -> bool {
    type Number = DoubleDouble;
    if !(is_valid(surface) && t.is_finite() && distance >= 0.0) {
        return false;
    }
    let degrees = Degrees { m: surface.degree_u, n: surface.degree_v };
    let count = degrees.points();
    let place = [0, 1, 2].map(|k| Number::new(t).on_ray(origin[k], direction[k]));
    if !place.iter().all(|c| c.is_finite()) {
        return false;
    }
    let from_place = |point: &[f64; 4]| {
        let w = Number::new(point[3]);
        let [x, y, z] = [0, 1, 2].map(|k| (Number::new(point[k]) - place[k]) * w);
        [x, y, z, w]
    };
    let mut nets: Vec<Point<Number>> = surface.points.iter().map(from_place).collect();
    let mut stack = vec![[0_u32; 2]];
    let mut current = nets.clone();
    for _ in 0..MAX_PARTS {
        let Some(halvings) = stack.pop() else {
            return true;
        };
        current.copy_from_slice(&nets[stack.len() * count..]);
        nets.truncate(stack.len() * count);
        let places: Vec<[f64; 3]> =
            current.iter().map(|&[x, y, z, w]| Number::over([x, y, z], w).map(Number::to_f64)).collect();
        if gap(&places) > distance {
            continue;
        }
        let Degrees { m, n } = degrees;
        if [0, n, m * (n + 1), m * (n + 1) + n].iter().any(|&k| norm(places[k]) <= distance) {
            return false;
        }
        let Some(axis) = longer(degrees, &places, halvings) else {
            return false;
        };
        let first = nets.len();
        nets.resize(first + 2 * count, [Number::ZERO; 4]);
        let (low, high) = nets[first..].split_at_mut(count);
        halve(degrees, &current, axis, low, high);
        let deeper = match axis {
            Axis::U => [halvings[0] + 1, halvings[1]],
            Axis::V => [halvings[0], halvings[1] + 1],
        };
        stack.extend([deeper; 2]);
    }
    false
}

/// How far the box of these points is from 0.
fn gap(places: &[[f64; 3]]) -> f64 {
    norm([0, 1, 2].map(|k| {
        let (low, high) = places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
            (f64::min(low, place[k]), f64::max(high, place[k]))
        });
        f64::max(low, -high).max(0.0)
    }))
}

/// The direction in which the net is longer, of those that can be halved.
fn longer(degrees: Degrees, places: &[[f64; 3]], halvings: [u32; 2]) -> Option<Axis> {
    let Degrees { m, n } = degrees;
    let apart = |a: usize, b: usize| norm([0, 1, 2].map(|k| places[b][k] - places[a][k]));
    let mut along = [0.0_f64; 2];
    for i in 0..=m {
        for j in 0..=n {
            let at = i * (n + 1) + j;
            if i < m {
                along[0] = along[0].max(apart(at, at + n + 1));
            }
            if j < n {
                along[1] = along[1].max(apart(at, at + 1));
            }
        }
    }
    match halvings.map(|count| count < MAX_HALVINGS) {
        [true, true] if along[0] >= along[1] => Some(Axis::U),
        [true, false] => Some(Axis::U),
        [_, true] => Some(Axis::V),
        [false, false] => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit square at z = 0, with a weight for u = 0 and for u = 1.
    fn square(weights: [f64; 2]) -> ModelSurface {
        let points = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]].map(|[x, y]| [x, y, 0.0, weights[x as usize]]);
        ModelSurface { number: 0, degree_u: 1, degree_v: 1, rational: true, points: points.to_vec(), knots: None }
    }

    #[test]
    fn a_square_is_as_far_as_it_is_whatever_its_weights() {
        for weights in [[1.0, 1.0], [1.0, 1e-9], [1e-9, 1.0]] {
            let farther = |x: f64, z: f64, distance: f64| {
                is_farther(&square(weights), [x, 0.3, 8.0], [0.0, 0.0, -1.0], 8.0 - z, distance)
            };
            for height in [0.0, 1e-3, 0.25] {
                for x in [0.0, 0.123, 0.5, 0.999] {
                    assert!(!farther(x, height, height + 1e-15));
                    assert!(height == 0.0 || farther(x, height, 0.999 * height));
                }
            }
            assert!(farther(1.0 + 1e-6, 0.0, 0.99e-6) && !farther(1.0 + 1e-6, 0.0, 1.01e-6), "beyond an edge");
        }
    }
}
