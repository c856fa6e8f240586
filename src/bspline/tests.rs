//! What is a B-spline and what is not.

use super::*;
use crate::point::Weighted;

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
