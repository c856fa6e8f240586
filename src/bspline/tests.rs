//! What is a B-spline and what is not; shares and parameters at the ends of the numbers.

use super::*;
use crate::point::{Plain, Weighted};

/// Six points in u, five in v.
const KNOTS_U: [f64; 9] = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 3.0, 3.0, 3.0];
const KNOTS_V: [f64; 8] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

fn points() -> [Weighted<f64>; 30] {
    core::array::from_fn(|k| Weighted::new([k as f64, (k % 5) as f64, (k % 3) as f64], 1.0 + k as f64))
}

/// The error of this surface with another list of knots in u or in v.
fn refused(degrees: [usize; 2], u: &[f64], v: &[f64]) -> Option<BSplineError> {
    BSpline::new(degrees[0], degrees[1], u, v, &points()).err()
}

#[test]
fn degrees_knots_and_points_are_refused_by_name() {
    use Direction::{U, V};
    assert_eq!(refused([2, 2], &KNOTS_U, &KNOTS_V), None);
    for degree in [0, 16, usize::MAX] {
        assert_eq!(refused([degree, 2], &KNOTS_U, &KNOTS_V), Some(BSplineError::Degree { direction: U, degree }));
        assert_eq!(refused([2, degree], &KNOTS_U, &KNOTS_V), Some(BSplineError::Degree { direction: V, degree }));
    }
    let need = |needed, given| Need { needed, given };
    assert_eq!(refused([2, 2], &KNOTS_U[..5], &KNOTS_V), Some(BSplineError::Knots { direction: U, need: need(6, 5) }));
    assert_eq!(refused([2, 4], &KNOTS_U, &KNOTS_V), Some(BSplineError::Knots { direction: V, need: need(10, 8) }));
    assert_eq!(refused([2, 2], &KNOTS_U, &[]), Some(BSplineError::Knots { direction: V, need: need(6, 0) }));
    assert_eq!(refused([2, 2], &KNOTS_U[..8], &KNOTS_V), Some(BSplineError::Points(need(25, 30))));
    assert_eq!(refused([2, 1], &KNOTS_U, &KNOTS_V), Some(BSplineError::Points(need(36, 30))));

    for (index, bad) in [(0, f64::NAN), (4, f64::INFINITY), (7, f64::NEG_INFINITY)] {
        let mut v = KNOTS_V;
        v[index] = bad;
        assert_eq!(refused([2, 2], &KNOTS_U, &v), Some(BSplineError::KnotNotFinite { direction: V, index }));
    }
    for index in 1..8 {
        let mut v = KNOTS_V;
        v[index] = v[index - 1] - 0.5;
        assert_eq!(refused([2, 2], &KNOTS_U, &v), Some(BSplineError::Decreasing { direction: V, index }));
    }

    for bad in [0, 17, 29] {
        let mut list = points();
        list[bad] = Weighted::new([0.0, f64::INFINITY, 0.0], 1.0);
        assert_eq!(BSpline::new(2, 2, &KNOTS_U, &KNOTS_V, &list).err(), Some(BSplineError::NotFinite(bad)));
        list[bad] = Weighted::new([0.0; 3], f64::NAN);
        assert_eq!(BSpline::new(2, 2, &KNOTS_U, &KNOTS_V, &list).err(), Some(BSplineError::NotFinite(bad)));
        for weight in [0.0, -0.0, -1.0] {
            list[bad] = Weighted::new([1.0; 3], weight);
            assert_eq!(BSpline::new(2, 2, &KNOTS_U, &KNOTS_V, &list).err(), Some(BSplineError::Weight(bad)));
        }
    }
}

#[test]
fn knots_may_be_repeated_as_often_as_the_surface_holds_together() {
    use Direction::U;
    let u = |knots: [f64; 9]| refused([2, 2], &knots, &KNOTS_V);
    // Twice inside is as often as the degree.
    assert_eq!(u([0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0]), None);
    assert_eq!(
        u([0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 3.0, 4.0, 5.0]),
        Some(BSplineError::Multiplicity { direction: U, index: 5, most: 2 })
    );
    // At the ends, clamped or not, once more.
    assert_eq!(u([-1.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0]), None);
    assert_eq!(u([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 5.0, 5.0, 6.0]), None);
    assert_eq!(
        u([0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0]),
        Some(BSplineError::Multiplicity { direction: U, index: 3, most: 3 })
    );
    assert_eq!(
        u([0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0]),
        Some(BSplineError::Multiplicity { direction: U, index: 8, most: 3 })
    );
    // Nothing between the ends.
    for knots in [[0.0; 9], [0.0, 1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 3.0, 4.0]] {
        assert_eq!(u(knots), Some(BSplineError::Empty { direction: U, first: 2, last: 6 }));
    }
    // Zeros of either sign are one knot.
    assert_eq!(
        u([0.0, -0.0, 0.0, -0.0, 1.0, 2.0, 3.0, 3.0, 3.0]),
        Some(BSplineError::Multiplicity { direction: U, index: 3, most: 3 })
    );
}

#[test]
fn a_spline_says_what_it_is() {
    let points = points();
    let spline = BSpline::new(2, 2, &KNOTS_U, &KNOTS_V, &points).expect("valid");
    let both = [Direction::U, Direction::V];
    assert_eq!(both.map(|direction| spline.degree(direction)), [2, 2]);
    assert_eq!(both.map(|direction| spline.size(direction)), [6, 5]);
    assert_eq!(both.map(|direction| spline.spans(direction)), [3, 3]);
    assert_eq!(both.map(|direction| spline.domain(direction)), [[0.0, 3.0], [2.0, 5.0]]);
    assert_eq!(both.map(|direction| spline.knots(direction).len()), [9, 8]);
    assert_eq!(spline.points().len(), 30);
}

#[test]
fn a_bezier_surface_is_its_own_piece() {
    let net: [Plain<f32>; 6] = core::array::from_fn(|k| Plain([0.1, 0.7 * k as f32, -0.3]));
    let (u, v) = ([-1.0, -1.0, 3.0, 3.0], [5.0, 5.0, 5.0, 7.5, 7.5, 7.5]);
    let spline = [BSpline::new(1, 2, &u, &v, &net).expect("valid")];
    let (mut points, mut pieces) = ([Plain([9.0; 3]); 6], [Piece::EMPTY; 1]);
    let memory = PieceMemory { points: &mut points, pieces: &mut pieces };
    let pieces = Pieces::build(&spline, memory).expect("there is room");
    assert_eq!(pieces.net(0).expect("there").points(), &net);
    assert_eq!(pieces.all()[0].part(), Part { u: [-1.0, 3.0], v: [5.0, 7.5] });
    assert!(pieces.net(1).is_none() && !pieces.is_empty());
    assert_eq!((pieces.nets().count(), pieces.nets_array::<1>().is_some()), (1, true));
    assert!(pieces.nets_array::<0>().is_none() && pieces.nets_array::<2>().is_none());
    let hit = |surface| Hit { t: 0.0, u: 0.25, v: 1.0, surface, grazing: false };
    assert_eq!(pieces.in_knots(&hit(0)), Some(InKnots { spline: 0, u: 0.0, v: 7.5 }));
    assert_eq!(pieces.in_knots(&hit(1)), None);
}

/// Memory that nobody filled names no net.
#[test]
fn slots_of_another_size_hold_no_net() {
    let points = [Plain([0.0_f32; 3]); 4];
    let piece = |first, degree| Piece { first, degree_u: degree, degree_v: degree, ..Piece::EMPTY };
    let slots = [piece(0, 1), piece(1, 1), piece(u32::MAX, 1), piece(0, u32::MAX), piece(0, 0)];
    let pieces = Pieces::new(&points, &slots);
    assert_eq!([0, 1, 2, 3, 4].map(|k| pieces.net(k).is_some()), [true, false, false, false, false]);
    assert_eq!(pieces.nets().count(), 1);
}

fn sums_of_shares<S: Scalar>() {
    let least = S::MIN_POSITIVE * S::EPSILON;
    for [low, x, high] in [
        [-S::MAX, S::ZERO, S::MAX],
        [-S::MAX, S::MAX, S::MAX],
        [-S::MAX, least, S::MAX],
        [S::ZERO, least, S::MAX],
        [S::ZERO, least, least + least],
        [S::ONE, S::ONE, S::ONE + S::EPSILON],
        [-least, S::ZERO, S::ONE],
    ] {
        let [a, b] = shares(low, x, high);
        assert!(a >= S::ZERO && b >= S::ZERO && a <= S::ONE && b <= S::ONE, "{low:?} {x:?} {high:?}: {a:?} {b:?}");
        assert!((a + b - S::ONE).abs() <= S::EPSILON);
    }
}

#[test]
fn shares_never_overflow() {
    sums_of_shares::<f32>();
    sums_of_shares::<f64>();
}

fn parameters_keep_order<S: Scalar>() {
    let (tiny, next) = (S::MIN_POSITIVE * S::EPSILON, S::ONE + S::EPSILON);
    let third = S::ONE / S::from_u32(3);
    for [low, high] in [
        [S::ZERO, S::ONE],
        [-S::MAX, S::MAX],
        [S::ONE, next],
        [-next, -S::ONE],
        [-third, S::ONE],
        [S::ZERO, tiny],
        [third, S::MAX],
        [-S::MAX, -tiny],
        [-tiny, S::MAX],
        [S::from_f64(0.1), S::from_f64(0.7)],
    ] {
        assert_eq!([between([low, high], S::ZERO), between([low, high], S::ONE)], [low, high]);
        assert_eq!([between([low, high], -third), between([low, high], next)], [low, high]);
        let mut last = low;
        for k in 0..=3000_u32 {
            let at = between([low, high], S::from_u32(k) / S::from_u32(3000));
            assert!(at >= last && at <= high, "{low:?} {high:?} at {k}: {at:?} after {last:?}");
            last = at;
        }
    }
}

#[test]
fn parameters_go_from_knot_to_knot_and_never_back() {
    parameters_keep_order::<f32>();
    parameters_keep_order::<f64>();
}
