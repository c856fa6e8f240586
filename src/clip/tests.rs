extern crate std;

use super::*;
use crate::bernstein::Tuple;
use crate::reading::Switches;
use patchray_host::scene::shapes::Random;
use std::vec::Vec;

/// No noise at all.
const EXACT: Noise<f64> = Noise { error: 0.0, tolerance: 0.0 };

/// The net of a plane seen straight on, with f = u − `u` and g = v − `v`: both clips are exact.
fn plane(degrees: Degrees, [u, v]: [f64; 2]) -> Vec<Tuple<f64, 2>> {
    let share = |k: usize, degree: u8| k as f64 / f64::from(degree);
    let rows = 0..degrees.rows();
    rows.flat_map(|i| (0..degrees.columns()).map(move |j| Tuple([share(i, degrees.u) - u, share(j, degrees.v) - v])))
        .collect()
}

#[test]
fn a_plane_is_clipped_to_a_point_whatever_its_degrees() {
    for (n, m) in [(1, 1), (2, 2), (3, 3), (2, 3), (1, 15), (15, 15)] {
        let degrees = Degrees { u: n, v: m };
        let net = plane(degrees, [0.3, 0.8]);
        for (direction, at) in [(Direction::U, 0.3), (Direction::V, 0.8)] {
            let Clip::Part([from, to]) = clip(degrees, &net, direction, &EXACT) else { panic!("{degrees:?}") };
            assert!(from <= at && at <= to && to - from < 1e-14, "{degrees:?} {direction:?} {from} {to}");
        }
    }
}

#[test]
fn a_net_on_one_side_holds_nothing_and_one_that_touches_its_end_does() {
    let degrees = Degrees { u: 3, v: 3 };
    assert_eq!(clip(degrees, &plane(degrees, [-0.1, 0.5]), Direction::U, &EXACT), Clip::Nothing);
    assert_eq!(clip(degrees, &plane(degrees, [0.5, 1.0 + 1e-15]), Direction::V, &EXACT), Clip::Nothing);
    let Clip::Part([from, to]) = clip(degrees, &plane(degrees, [0.0, 0.5]), Direction::U, &EXACT) else { panic!() };
    assert!(from == 0.0 && to < 1e-14);
}

/// Half the error below zero is not separated from it: an empty clip by rounding would be a hole in the surface.
#[test]
fn separated_by_less_than_the_error_is_not_separated() {
    let degrees = Degrees { u: 3, v: 3 };
    let net = plane(degrees, [-1e-14, 0.5]);
    assert_eq!(clip(degrees, &net, Direction::U, &EXACT), Clip::Nothing);
    let clipped = clip(degrees, &net, Direction::U, &Noise { error: 2e-14, tolerance: 0.0 });
    assert!(matches!(clipped, Clip::Part([0.0, to]) if to < 1e-13), "{clipped:?}");
}

/// A clip by the hull of what is stored would cut off the roots of what was meant: each coefficient may be off by the error.
#[test]
fn no_root_is_clipped_off_by_noise() {
    let mut random = Random(71);
    let degrees = Degrees { u: 3, v: 3 };
    let mut clipped_off_without = 0;
    for _ in 0..2000 {
        let root = [random.within(0.0, 1.0), random.within(0.0, 1.0)];
        let error = 1e-9;
        let net: Vec<_> = plane(degrees, root)
            .into_iter()
            .map(|Tuple(f_g)| Tuple(f_g.map(|c| c + random.within(-error, error))))
            .collect();
        for direction in [Direction::U, Direction::V] {
            let at = root[direction as usize];
            let holds = |error| match clip(degrees, &net, direction, &Noise { error, tolerance: 0.0 }) {
                Clip::Part([from, to]) => from <= at && at <= to,
                other => panic!("{other:?}"),
            };
            assert!(holds(error), "{root:?}");
            clipped_off_without += u32::from(!holds(0.0));
        }
    }
    // The hull of noisy distances is a little wider than that of the others, which mostly covers it.
    assert!(clipped_off_without > 50, "{clipped_off_without}");
}

/// The hull is that of all points: a chord from the end alone crosses later than one from a low point near it.
#[test]
fn the_hull_of_a_wavy_polygon_counts_every_pair() {
    let heights = [1.0, 0.001, -1.0, 2.0];
    let net: Vec<_> = heights.iter().flat_map(|&h| [0.0, 0.3, 0.6, 1.0].map(|v| Tuple([h, v - 0.5]))).collect();
    // Along v g changes and f does not, so f is the distance that u is clipped by.
    let Clip::Part([from, to]) = clip(Degrees { u: 3, v: 3 }, &net, Direction::U, &EXACT) else { panic!() };
    assert!((from - 1.001 / 1.001 / 3.0 * (1.0 + 0.001 / 1.001)).abs() < 1e-3 && from < 1.0 / 3.0 + 1e-3, "{from}");
    assert!((to - (1.0 - 2.0 / 9.0)).abs() < 1e-12, "{to}");
}

/// Distances that differ by less than the tolerance are not clipped: what is left of them is noise, and bisecting it would
/// never end.
#[test]
fn what_varies_by_less_than_the_tolerance_is_settled() {
    let degrees = Degrees { u: 3, v: 3 };
    let net: Vec<_> = plane(degrees, [0.5, 0.5]).into_iter().map(|Tuple([f, g])| Tuple([f * 1e-9, g])).collect();
    let noise = Noise { error: 0.0, tolerance: 1e-8 };
    assert_eq!(clip(degrees, &net, Direction::U, &noise), Clip::Settled);
    assert!(matches!(clip(degrees, &net, Direction::V, &noise), Clip::Part(_)));
}

/// Chords along u and along v fall on one line where the ray is tangent, and both clips would clip the same strip.
#[test]
fn lines_are_never_near_parallel() {
    let corners = |u: [f64; 2], v: [f64; 2]| [[0.0, 0.0], u, v, [u[0] + v[0], u[1] + v[1]]];
    let angle = |u: [f64; 2], v: [f64; 2]| {
        let [a, b] =
            [Direction::U, Direction::V].map(|direction| normal::<Tuple<f64, 2>>(Ours, corners(u, v), direction));
        let (cross, dot) = (a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        cross.abs().atan2(dot.abs()).to_degrees()
    };
    for (u, v) in [
        ([1.0, 0.0], [1.0, 0.0]),
        ([1.0, 0.0], [-1.0, 1e-3]),
        ([1e-9, 1e-9], [1.0, 1.0 + 1e-9]),
        ([1.0, 2.0], [-2.0, -4.0]),
    ] {
        assert!((angle(u, v) - 60.0).abs() < 0.1, "{u:?} {v:?}: {}", angle(u, v));
    }
    // Null lines: of a collapsed edge, of a net whose chords cancel, of a point.
    for (u, v) in [([0.0, 0.0], [0.3, 0.4]), ([1.0, -1.0], [0.0, 0.0]), ([0.0; 2], [0.0; 2])] {
        assert!((angle(u, v) - 90.0).abs() < 1e-9, "{u:?} {v:?}: {}", angle(u, v));
    }
    // Others are the chords' own, and follow them exactly.
    assert_eq!(normal::<Tuple<f64, 2>>(Ours, corners([1.0, 0.0], [1.0, 0.5]), Direction::U), [-1.0, 2.0]);
    assert!((angle([1.0, 0.0], [1.0, 0.2]) - 0.2_f64.atan().to_degrees()).abs() < 1e-9);
    // Each spread line stays on the side of its own chord.
    let [a, b] =
        [Direction::U, Direction::V].map(|d| normal::<Tuple<f64, 2>>(Ours, corners([1.0, 0.0], [1.0, 0.01]), d));
    let [c, d] =
        [Direction::U, Direction::V].map(|d| normal::<Tuple<f64, 2>>(Ours, corners([1.0, 0.0], [1.0, -0.01]), d));
    assert!(a[0] * b[1] - a[1] * b[0] < 0.0 && c[0] * d[1] - c[1] * d[0] > 0.0, "{a:?} {b:?} {c:?} {d:?}");
}

/// Distances are homogeneous: a weight scales a point's distance, never its side.
#[test]
fn weights_do_not_move_what_a_clip_keeps() {
    let degrees = Degrees { u: 2, v: 2 };
    let weights = [1.0, 0.5, 3.0];
    let rational: Vec<_> = (0..9)
        .map(|k| {
            let (i, j) = (k / 3, k % 3);
            let w: f64 = weights[i] * weights[j];
            Tuple([(i as f64 / 2.0 - 0.25) * w, (j as f64 / 2.0 - 0.75) * w, w])
        })
        .collect();
    for direction in [Direction::U, Direction::V] {
        // The root in u of Σ B_i w_i (i/2 − 1/4), and in v of the like, by bisection.
        let target = if direction == Direction::U { 0.25 } else { 0.75 };
        let value = |t: f64| {
            let b = [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
            (0..3).map(|k| b[k] * weights[k] * (k as f64 / 2.0 - target)).sum::<f64>()
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if value(middle) < 0.0 { low = middle } else { high = middle }
        }
        let Clip::Part([from, to]) = clip(degrees, &rational, direction, &EXACT) else { panic!() };
        assert!(from <= low && high <= to && to - from < 0.75, "{direction:?} {from} {to} {low}");
    }
}

/// Without spreading, lines follow the chords however nearly parallel these are.
#[test]
fn lines_along_near_parallel_chords_are_spread_unless_the_letter_is_kept() {
    let corners = [[0.0; 2], [1.0, 0.0], [1.0, 0.01], [2.0, 0.01]];
    let of = |reading: Switches| normal::<Tuple<f64, 2>>(reading, corners, Direction::U);
    assert_eq!(of(Switches::letter()), [-0.02, 2.0]);
    assert_eq!(of(Switches::ours()), normal::<Tuple<f64, 2>>(Ours, corners, Direction::U));
    assert_ne!(of(Switches::ours()), of(Switches::letter()));
}
