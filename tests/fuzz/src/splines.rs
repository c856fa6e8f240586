//! B-splines of any knots: refused, or cut into pieces that are the spline, in memory of any size.

use crate::bytes::Bytes;
use crate::common::Kind;
use crate::common::allowances::PIECE_PER_DEGREE;
use crate::input::{Case, Numbers, OfKind, in_precision, number, with_kind};
use crate::preparation::lend;
use crate::ready::Stage;
use crate::reference::{bezier, blend, exact};
use patchray::bernstein::MAX_DEGREE;
use patchray::bspline::BSpline;
use patchray::pieces::{Part, Piece, PieceError, PieceMemory, Pieces};
use patchray::ray::{Hit, Incidence};
use patchray::scalar::Scalar;
use patchray::surface::Direction;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    // Only its numbers and its kind of point are taken.
    let case = Case::any(&mut bytes, 1);
    with_kind(&case, bytes, Splines);
}

struct Splines;

/// Knots that go up by small steps, or by none; or any numbers.
fn knots<S: Scalar>(bytes: &mut Bytes<'_>, case: &Case, degree: usize) -> Vec<S> {
    let count = match bytes.below(4) {
        0 => usize::from(bytes.byte() % 40),
        1 => 2 * (degree + 1),
        _ => 2 * (degree + 1) + bytes.below(6),
    };
    let kind = bytes.byte();
    if kind & 7 == 7 {
        return (0..count).map(|_| number(bytes)).collect();
    }
    let mut at = Numbers::Coarse.draw(bytes, case.precision);
    let step = |bytes: &mut Bytes<'_>| match bytes.byte() {
        step if step < 100 => 0.0,
        step if kind & 8 == 0 => f64::from(step) / 64.0,
        step => f64::from(i32::from(step) - 180).exp2(),
    };
    let clamped = kind & 16 == 0;
    let mut next = |k: usize| {
        let at_an_end = k <= degree || k + degree >= count;
        if !clamped || !at_an_end {
            at = in_precision(at + step(bytes), case.precision);
        }
        at
    };
    let mut knots: Vec<f64> = (0..count).map(&mut next).collect();
    if clamped && count > 2 * (degree + 1) || knots.first() == knots.last() {
        // The far end lies beyond all others.
        let last = knots.last().copied().unwrap_or(0.0) + 1.0;
        let from = knots.len().saturating_sub(degree + 1);
        knots[from..].fill(last);
    }
    knots.into_iter().map(S::from_f64).collect()
}

impl OfKind for Splines {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let degree = |bytes: &mut Bytes<'_>| {
            if bytes.rarely(16) { bytes.count() as usize } else { 1 + bytes.below(4) }
        };
        let degrees = [0; 2].map(|_| degree(&mut bytes));
        let [u, v] = degrees.map(|degree| knots::<P::Scalar>(&mut bytes, case, degree.min(MAX_DEGREE)));
        let sizes =
            [(&u, degrees[0]), (&v, degrees[1])].map(|(knots, n)| knots.len().saturating_sub(n.saturating_add(1)));
        let count =
            if bytes.rarely(16) { usize::from(bytes.byte()) } else { sizes[0].saturating_mul(sizes[1]).min(1600) };
        let weights = case.weighted && bytes.rarely(2);
        let point = |_| {
            let [x, y, z] = [0; 3].map(|_| case.number(&mut bytes));
            let w = if weights { (1.0 + f64::from(bytes.byte())) / 64.0 } else { 1.0 };
            P::lower(&[x, y, z, w], 1.0)
        };
        let points: Vec<P> = (0..count).map(point).collect();
        let Ok(spline) = BSpline::new(degrees[0], degrees[1], &u, &v, &points) else {
            return;
        };
        let splines = [spline, spline];
        let splines = &splines[..1 + bytes.below(2)];
        let (mut points, mut pieces) = (vec![], vec![]);
        let cut = lend(&mut bytes, |[of_points, of_pieces]| {
            (points, pieces) = (vec![P::EMPTY; of_points], vec![Piece::EMPTY; of_pieces]);
            match Pieces::build(splines, PieceMemory { points: &mut points, pieces: &mut pieces }) {
                Ok(_) => Stage::Done,
                Err(PieceError::Memory(needs)) => Stage::Lacks([needs.points, needs.pieces]),
                Err(PieceError::TooLarge) => Stage::Refused,
            }
        });
        assert!(cut, "a B-spline that is valid is cut");
        let cut = Pieces::new(&points, &pieces);
        let each = spline.spans(Direction::U) * spline.spans(Direction::V);
        assert_eq!((cut.len(), cut.nets().count()), (each * splines.len(), each * splines.len()));
        are_the_spline(&cut, &spline, case);
        let [u, v] = [0; 2].map(|_| P::Scalar::from_f64(f64::from(bytes.byte()) / 255.0));
        for (surface, piece) in (0..).zip(cut.all()) {
            let place = cut
                .in_knots(&Hit { t: u, u, v, surface, incidence: Incidence::Crossing })
                .expect("there is such a piece");
            let Part { u: [u0, u1], v: [v0, v1] } = piece.part();
            assert!(u0 <= place.u && place.u <= u1 && v0 <= place.v && place.v <= v1, "{place:?} of {piece:?}");
            assert_eq!(place.spline, piece.spline());
        }
    }
}

/// The pieces' points are the spline's.
fn are_the_spline<P: Kind>(cut: &Pieces<'_, P>, spline: &BSpline<'_, P>, case: &Case) {
    let numbers = spline.points().iter().flat_map(exact);
    let largest = numbers.fold(0.0, |most: f64, c| most.max(c.abs()));
    let spread = [Direction::U, Direction::V].iter().flat_map(|&direction| spline.knots(direction));
    // In `f64` the reference has no more digits than the pieces, nor a wider range.
    let in_range = |c: f64| c == 0.0 || (1e-30..1e30).contains(&c.abs());
    if !case.is_tame() || !in_range(largest) || !spread.clone().all(|knot| in_range(knot.to_f64())) {
        return;
    }
    let degrees = spline.degree(Direction::U) + spline.degree(Direction::V);
    let allowed = largest * P::Scalar::EPSILON.to_f64() * (f64::from(PIECE_PER_DEGREE) * degrees as f64);
    for (net, piece) in cut.nets().zip(cut.all()) {
        let Part { u, v } = piece.part();
        let part = Part { u: u.map(Scalar::to_f64), v: v.map(Scalar::to_f64) };
        for at in [[0.0, 0.0], [1.0, 0.25], [0.5, 1.0]] {
            let (found, expected) = (bezier(&net, at[0], at[1]), blend(spline, &part, at));
            let off = (0..4).fold(0.0, |off: f64, k| off.max((found[k] - expected[k]).abs()));
            assert!(off <= allowed, "{piece:?} at {at:?}: {off:e} off, {allowed:e} are allowed");
        }
    }
}
