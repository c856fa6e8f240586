//! Where a surface has a normal, whatever its unit and its place, and where it has none.

extern crate std;

use super::*;
use crate::bernstein::Basis;
use crate::point::{Plain, Weighted};
use std::vec::Vec;

/// Control points `[x, y, z, w]` of a surface of these degrees, u outer.
#[derive(Clone)]
struct Shape {
    degrees: [usize; 2],
    points: Vec<[f64; 4]>,
}

/// A point of a shape in a number type, after scaling by `unit` and moving by `offset` units.
trait Made: Point {
    fn made(point: &[f64; 4], unit: f64, offset: f64) -> Self;
}

impl<S: Scalar> Made for Plain<S> {
    fn made(&[x, y, z, _]: &[f64; 4], unit: f64, offset: f64) -> Self {
        Plain([x, y, z].map(|c| S::from_f64(unit * (c + offset))))
    }
}

impl<S: Scalar> Made for Weighted<S> {
    fn made(&[x, y, z, w]: &[f64; 4], unit: f64, offset: f64) -> Self {
        Weighted::new([x, y, z].map(|c| S::from_f64(unit * (c + offset))), S::from_f64(w))
    }
}

impl Shape {
    fn normal<P: Made>(&self, at: [f64; 2], unit: f64, offset: f64) -> Option<[f64; 3]> {
        let points: Vec<P> = self.points.iter().map(|p| P::made(p, unit, offset)).collect();
        let net = Net::new(self.degrees[0], self.degrees[1], &points).unwrap();
        let [u, v] = at.map(P::Scalar::from_f64);
        let normal = net.normal(u, v, &mut Basis::<P::Scalar, 16>::new().view()).unwrap();
        normal.map(|normal| normal.map(|c| c.to_f64()))
    }

    /// In both precisions, in every unit, with weights and, if all are 1, without: asserts that at each place the normal is, but
    /// for its sign, as expected.
    fn check(&self, expected: impl Fn([f64; 2]) -> Option<[f64; 3]>, places: &[[f64; 2]]) {
        for &at in places {
            let expected = expected(at);
            for unit in [1.0, 3e-30, 7e-11, 5e6, 2e30] {
                let check = |found: Option<[f64; 3]>, allowance: f64, what: &str| {
                    let apart = expected.zip(found).map(|(a, b)| {
                        let length = b.iter().map(|c| c * c).sum::<f64>().sqrt();
                        let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                        cross.iter().fold((length - 1.0).abs(), |most, c| most.max(c.abs()))
                    });
                    assert_eq!(found.is_some(), expected.is_some(), "{what} at {at:?} in {unit:e}: {found:?}");
                    assert!(apart.is_none_or(|apart| apart < allowance), "{what} at {at:?} in {unit:e}: {found:?}");
                };
                check(self.normal::<Weighted<f32>>(at, unit, 0.0), 2e-4, "weighted f32");
                check(self.normal::<Weighted<f64>>(at, unit, 0.0), 1e-11, "weighted f64");
                if self.points.iter().all(|p| p[3] == 1.0) {
                    check(self.normal::<Plain<f32>>(at, unit, 0.0), 2e-4, "f32");
                    check(self.normal::<Plain<f64>>(at, unit, 0.0), 1e-11, "f64");
                }
            }
        }
    }

    /// The same surface with u and v exchanged.
    fn transposed(&self) -> Self {
        let [n, m] = self.degrees;
        let points = (0..=m).flat_map(|j| (0..=n).map(move |i| (i, j)));
        Shape { degrees: [m, n], points: points.map(|(i, j)| self.points[i * (m + 1) + j]).collect() }
    }
}

fn plain(degrees: [usize; 2], at: impl Fn(usize, usize) -> [f64; 3]) -> Shape {
    let places = (0..=degrees[0]).flat_map(|i| (0..=degrees[1]).map(move |j| (i, j)));
    let points = places.map(|(i, j)| at(i, j)).map(|[x, y, z]| [x, y, z, 1.0]).collect();
    Shape { degrees, points }
}

/// The quarter of a surface of revolution about the z axis, u along a profile of points [radius, height, weight].
fn turned(profile: &[[f64; 3]]) -> Shape {
    let arc = [[1.0, 0.0, 1.0], [1.0, 1.0, 0.5_f64.sqrt()], [0.0, 1.0, 1.0]];
    let points = profile.iter().flat_map(|&[radius, height, weight]| {
        arc.map(|[x, y, w]| [0.3 + radius * x, -0.2 + radius * y, height, weight * w])
    });
    Shape { degrees: [profile.len() - 1, 2], points: points.collect() }
}

/// The direction about the axis that the parameter `v` of such a quarter has.
fn about(v: f64) -> [f64; 2] {
    let weights = [(1.0 - v) * (1.0 - v), 2.0 * v * (1.0 - v) * 0.5_f64.sqrt(), v * v];
    let [x, y] = [weights[0] + weights[1], weights[1] + weights[2]];
    let length = x.hypot(y);
    [x / length, y / length]
}

const ALONG: [f64; 5] = [0.0, 0.125, 0.5, 0.8, 1.0];

fn places(u: f64) -> Vec<[f64; 2]> {
    ALONG.iter().map(|&v| [u, v]).collect()
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn the_pole_of_a_sphere_has_a_normal() {
    let half = 0.5_f64.sqrt();
    let octant = turned(&[[1.0, 0.0, 1.0], [1.0, 1.0, half], [0.0, 1.0, 1.0]]);
    octant.check(|_| Some(UP), &places(1.0));
    // Nearer to the pole than roots are found, which side of it a place is on is not known.
    octant.check(|_| Some(UP), &places(1.0 - 1e-13));
    octant.transposed().check(|_| Some(UP), &places(1.0).iter().map(|[u, v]| [*v, *u]).collect::<Vec<_>>());
    let expected = |[_, v]: [f64; 2]| {
        let [x, y] = about(v);
        Some([x, y, 0.0])
    };
    octant.check(expected, &places(0.0));
    // Where coordinates are many times the radius they round more, and with them what is one point.
    for offset in [10.0, 300.0, 5000.0] {
        for at in places(1.0) {
            for found in
                [octant.normal::<Weighted<f32>>(at, 1.0, offset), octant.normal::<Weighted<f64>>(at, 1.0, offset)]
            {
                assert!(found.is_none_or(|normal| normal[2].abs() > 0.9), "{offset} {at:?}: {found:?}");
            }
            assert!(octant.normal::<Weighted<f64>>(at, 1.0, offset).is_some());
            assert!(offset > 100.0 || octant.normal::<Weighted<f32>>(at, 1.0, offset).is_some());
        }
    }
}

#[test]
fn the_apex_of_a_cone_has_none() {
    for (radius, height) in [(1.0, 1.0), (0.01, 1.0), (1.0, 0.02)] {
        let cone = turned(&[[0.0, height, 1.0], [radius, 0.0, 1.0]]);
        cone.check(|_| None, &places(0.0));
        cone.check(|_| None, &places(1e-14));
        let side = |[_, v]: [f64; 2]| {
            let ([x, y], length) = (about(v), f64::hypot(radius, height));
            Some([x * height / length, y * height / length, radius / length])
        };
        cone.check(side, &places(0.5));
        cone.check(side, &places(1.0));
        cone.transposed().check(|_| None, &[[0.3, 0.0], [1.0, 0.0]]);
    }
    // Of two that meet in the middle of one surface.
    let both = turned(&[[-1.0, -1.0, 1.0], [1.0, 1.0, 1.0]]);
    both.check(|_| None, &places(0.5));
    // A horn, the sides of which are tangent to the axis.
    turned(&[[0.0, 1.0, 1.0], [0.0, 0.5, 1.0], [0.5, 0.0, 1.0]]).check(|_| None, &places(0.0));
}

#[test]
fn a_collapsed_edge_of_a_bicubic_has_one_if_its_neighbours_lie_in_a_plane_with_it() {
    // Heights of the second row above the plane; the others are anywhere.
    let with = |heights: [f64; 4]| {
        plain([3, 3], |i, j| {
            let (i, j) = (i as f64, j as f64);
            let height = if i == 1.0 { heights[j as usize] } else { 0.1 * i * (i - 1.0) * (1.0 - 0.3 * j) };
            [0.7 + i * (1.0 - 0.4 * j), 0.1 + i * (0.2 + 0.3 * j), height - 0.4]
        })
    };
    let smooth = with([0.0; 4]);
    smooth.check(|_| Some(UP), &places(0.0));
    smooth.transposed().check(|_| Some(UP), &[[0.0, 0.0], [0.6, 0.0]]);
    for heights in [[0.3, 0.0, 0.0, 0.0], [0.0, 0.0, 0.02, 0.0], [0.1, 0.2, 0.2, 0.1]] {
        let pointed = with(heights);
        pointed.check(|_| None, &places(0.0));
        pointed.transposed().check(|_| None, &[[0.0, 0.0], [0.6, 0.0]]);
        // The sign is that of the way from the middle, on which it is known.
        assert!(pointed.normal::<Plain<f64>>([1e-6, 0.5], 1.0, 0.0).is_some());
    }
    // The limit is that from inside, with its sign.
    for at in places(0.0) {
        let near = smooth.normal::<Plain<f64>>([1e-5, at[1]], 1.0, 0.0).unwrap();
        let there = smooth.normal::<Plain<f64>>(at, 1.0, 0.0).unwrap();
        assert!(near[2] * there[2] > 0.0);
    }
}

#[test]
fn a_flat_triangle_has_one_everywhere() {
    let normal = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    // Two vectors across it.
    let on = |a: f64, b: f64| [0.25 + a + b, -0.5 + 2.0 * a, 0.125 - b];
    let all: Vec<[f64; 2]> = [0.0, 0.3, 1.0].iter().flat_map(|&u| places(u)).collect();
    for degrees in [[1, 1], [3, 3], [2, 5]] {
        let [n, m] = degrees.map(|degree| degree as f64);
        plain(degrees, |i, j| on(i as f64 / n, (i * j) as f64 / (n * m))).check(|_| Some(normal), &all);
    }
    // The four points of a corner in one place.
    let corner = plain([3, 3], |i, j| if i + j < 2 { on(0.0, 0.0) } else { on(i as f64, j as f64) });
    corner.check(|_| Some(normal), &all);
}

#[test]
fn a_point_and_a_curve_have_none() {
    let all: Vec<[f64; 2]> = [0.0, 0.3, 0.5, 1.0].iter().flat_map(|&u| places(u)).collect();
    plain([3, 2], |_, _| [0.3, -0.7, 0.1]).check(|_| None, &all);
    plain([2, 2], |_, _| [0.0; 3]).check(|_| None, &all);
    plain([1, 2], |i, j| [0.25, 0.5, -0.75].map(|c| c * (i + j) as f64)).check(|_| None, &all);
    plain([1, 3], |_, j| [j as f64, (j * j) as f64, 0.5]).check(|_| None, &all);
}

/// Where a surface turns back on itself, its two sheets have one tangent plane.
#[test]
fn a_cusp_has_one_and_a_corner_without_speed_if_it_is_flat() {
    // x = (2 u − 1)², y = (2 u − 1)³, along z.
    let [x, y] = [[1.0, -1.0, -1.0 / 3.0, 1.0], [-1.0, 1.0, -1.0, 1.0]];
    let x = [x[0], -1.0 / 3.0, x[2], x[3]];
    let cusp = plain([3, 1], |i, j| [x[i], y[i], j as f64]);
    let across = [0.0, 1.0, 0.0];
    cusp.check(|_| Some(across), &places(0.5));
    // Two control points of an edge in one: the surface leaves along different planes, unless the others lie in one.
    let corner = |height: f64| {
        plain([2, 2], |i, j| match (i, j) {
            (1, 0) => [0.0; 3],
            (i, j) => [i as f64, j as f64, height * (i * j) as f64],
        })
    };
    corner(0.0).check(|_| Some(UP), &[[0.0, 0.0]]);
    corner(0.3).check(|_| None, &[[0.0, 0.0]]);
}

/// Nets that no one means give no normal of numbers that are none.
#[test]
fn what_is_not_finite_has_none() {
    for bad in [f64::NAN, f64::INFINITY, f64::MAX] {
        for k in 0..4 {
            let mut shape = plain([1, 1], |i, j| [i as f64, j as f64, 0.0]);
            shape.points[k][k % 3] = bad;
            for at in [[0.0, 0.0], [0.5, 0.5], [1.0, 0.25]] {
                for found in [shape.normal::<Plain<f64>>(at, 1.0, 0.0), shape.normal::<Weighted<f64>>(at, 1.0, 0.0)] {
                    assert!(found.is_none_or(|normal| normal.iter().all(|c| c.is_finite())), "{bad} {found:?}");
                }
            }
        }
    }
}
