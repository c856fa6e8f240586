//! Pieces at the ends of memory; shares and parameters at the ends of the numbers.

use super::*;
use crate::point::Plain;
use crate::ray::Incidence;

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
    let hit = |surface| Hit { t: 0.0, u: 0.25, v: 1.0, surface, incidence: Incidence::Crossing };
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
