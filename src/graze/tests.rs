use super::*;
use crate::bernstein::{Direction, Tuple};
use crate::clip::{Clip, clip};

const DEGREES: Degrees = Degrees { u: 2, v: 2 };

/// f = `line(u, v)`, g = `height` · (u − v)² + `gap`, both in Bernstein form of degree 2 × 2: a fold along u + v = 1, seen as a
/// line along f, that passes the ray by the gap.
fn fold(line: impl Fn(usize, usize) -> f64, height: f64, gap: f64) -> [Tuple<f64, 2>; 9] {
    let square = |k: usize| if k == 2 { 1.0 } else { 0.0 };
    core::array::from_fn(|k| {
        let (i, j) = (k / 3, k % 3);
        let g = square(i) + square(j) - 0.5 * (i * j) as f64;
        Tuple([line(i, j), height * g + gap])
    })
}

fn sum(i: usize, j: usize) -> f64 {
    0.5 * (i + j) as f64 - 1.0
}

const NOISE: Noise<f64> = Noise { error: 1e-15, tolerance: 4e-13 };

#[test]
fn a_fold_that_no_clip_parts_from_the_ray_is_parted_across() {
    let net = fold(sum, 1.0, 0.55);
    for direction in [Direction::U, Direction::V] {
        assert!(!matches!(clip(DEGREES, &net, direction, &NOISE), Clip::Nothing), "{direction:?}");
    }
    assert!(matches!(across(DEGREES, &net, &NOISE), Across::Apart));
    assert!(matches!(across(DEGREES, &net.map(|p| Tuple([p.0[0], -p.0[1]])), &NOISE), Across::Apart));
    // Two roots, where the fold lies on the other side.
    assert!(matches!(across(DEGREES, &fold(sum, 1.0, -0.1), &NOISE), Across::Open));
}

#[test]
fn what_rounding_alone_parts_is_a_line() {
    let Across::Line([x, y]) = across(DEGREES, &fold(sum, 1e-16, 0.0), &NOISE) else { panic!("it is a line") };
    assert!((x.abs() - 1.0).abs() < 1e-12 && y.abs() < 1e-12);
    // Within the tolerance is not enough: of three roots that all but fall together the true one would not be told.
    assert!(matches!(across(DEGREES, &fold(sum, 1e-13, 0.0), &NOISE), Across::Open));
}

/// Nine roots of a surface that is thin in v were once taken for one.
#[test]
fn a_line_that_the_ray_crosses_twice_is_none() {
    let twice = |i: usize, _: usize| [0.3, -0.5, 0.3][i];
    assert!(!matches!(across(DEGREES, &fold(twice, 0.0, 0.0), &NOISE), Across::Line(_)));
}

#[test]
fn a_loop_names_no_direction() {
    let point = [Tuple([0.0, 0.0]); 9];
    assert!(matches!(across(DEGREES, &point, &NOISE), Across::Open));
}
