use super::*;
use crate::parameter::{BothEnds, Number};
use heapless::Vec;

fn region(u: [f64; 2], v: [f64; 2]) -> Region<Number<f64>> {
    Region::between([u, v])
}

/// Four regions wait, the previous point in one of them. The order is the prior region, its neighbours, the rest; "the
/// newest first, and of its halves the better one", which keeps to one side of the first bisection, takes the far corner of
/// that side before a neighbour across it.
#[test]
fn the_prior_region_then_its_neighbours_then_the_rest() {
    // A strip of four in u; the prior region is the second, at the border of the first bisection.
    let strip = [0.0, 0.25, 0.5, 0.75].map(|u| region([u, u + 0.25], [0.0, 1.0]));
    let [far, prior, across, farthest] = strip;
    let point = [0.49, 0.3].map(Number::new);
    // Whatever the order in which they came.
    for turn in 0..4 {
        let mut pending = Vec::<_, 4>::new();
        let mut order = Order::around(Some(point));
        for k in 0..4 {
            order.push(strip[(k + turn) % 4], &mut pending, 4).unwrap();
        }
        assert_eq!(order.push(prior, &mut pending, 4), Err(Limit::PendingDomains));
        let taken: Vec<_, 4> = core::iter::from_fn(|| order.pop(&mut pending)).collect();
        // Both adjoin the prior region; the nearer one to the point is first. The last one is the only one that does not.
        assert_eq!(taken, [prior, across, far, farthest]);
    }
}

/// The rank of a neighbour is not its distance: a near region that does not adjoin the prior one comes after a farther
/// one that does.
#[test]
fn neighbours_come_before_what_is_only_near() {
    let prior = region([0.0, 0.5], [0.0, 0.2]);
    let neighbour = region([0.5, 1.0], [0.0, 0.2]);
    let near = region([0.0, 0.5], [0.3, 1.0]);
    let mut pending = Vec::<_, 4>::new();
    let mut order = Order::around(Some([0.1, 0.19].map(Number::new)));
    for region in [near, neighbour, prior] {
        order.push(region, &mut pending, 4).unwrap();
    }
    let taken: Vec<_, 4> = core::iter::from_fn(|| order.pop(&mut pending)).collect();
    assert_eq!(taken, [prior, neighbour, near]);
}

#[test]
fn a_prior_region_that_is_bisected_leaves_its_half_as_the_prior_one() {
    let mut pending = Vec::<_, 8>::new();
    let mut order = Order::around(Some([0.1, 0.1].map(Number::new)));
    let [low, high] = Region::WHOLE.halves(Direction::U).unwrap();
    order.push(high, &mut pending, 8).unwrap();
    order.push(low, &mut pending, 8).unwrap();
    assert_eq!(order.pop(&mut pending), Some(low));
    let [a, b] = low.halves(Direction::V).unwrap();
    order.push(a, &mut pending, 8).unwrap();
    order.push(b, &mut pending, 8).unwrap();
    assert_eq!(order.pop(&mut pending), Some(a));
    // Both adjoin the quarter, and are as far from the point: the one that has waited longer is first.
    assert_eq!([order.pop(&mut pending), order.pop(&mut pending)], [Some(high), Some(b)]);
    assert_eq!(order.pop(&mut pending), None);
}

#[test]
fn without_a_point_the_newest_is_first() {
    let mut pending = Vec::<_, 8>::new();
    let mut order = Order::around(None);
    let [low, high] = Region::<Number<f64>>::WHOLE.halves(Direction::V).unwrap();
    order.push(low, &mut pending, 8).unwrap();
    order.push(high, &mut pending, 1).unwrap_err();
    order.push(high, &mut pending, 8).unwrap();
    assert_eq!([order.pop(&mut pending), order.pop(&mut pending)], [Some(high), Some(low)]);
}

#[test]
fn parts_keep_ends_exact_and_halving_ends() {
    let mut part = region([0.1, 0.3], [0.0, 1.0]);
    part.narrow(Direction::U, [0.0, 1.0]);
    assert_eq!(part.sides[0], [0.1, 0.3].map(Number::new));
    part.narrow(Direction::U, [0.5, 1.0]);
    assert!((part.sides[0][0].number() - 0.2).abs() < 1e-16 && part.sides[0][1].number() == 0.3);
    let mut halvings = 0;
    let mut at = Region::<Number<f32>>::WHOLE;
    while let Some([_, high]) = at.halves(Direction::U) {
        at = high;
        halvings += 1;
        assert!(halvings < 30, "{at:?}");
    }
    assert!(at.widths()[0] <= f32::EPSILON);
    // Nothing is in common with a rectangle beside, and a border with one that adjoins.
    let left = region([0.0, 0.5], [0.0, 1.0]);
    assert_eq!(left.meet(region([0.6, 1.0], [0.0, 1.0]).sides), None);
    assert_eq!(left.meet(region([0.5, 1.0], [0.25, 2.0]).sides), Some(region([0.5, 0.5], [0.25, 1.0])));
    assert_eq!(left.meet(region([f64::NAN, 1.0], [0.0, 1.0]).sides), Some(left));
}

/// A part that ends 1e-10 before 1 ends there, though no number tells its end from 1.
#[test]
fn a_number_that_rounds_to_one_is_not_one() {
    let end = BothEnds::<f32>::ZERO.toward(BothEnds::ONE, 1.0, 1e-10);
    assert_eq!((end.number(), end.rest()), (1.0, 1e-10));
    assert!(end.is_below(BothEnds::ONE) && !BothEnds::ONE.is_at_most(end));
    // Only without a rest the way is at its end.
    assert_eq!(BothEnds::<f32>::ZERO.toward(BothEnds::ONE, 1.0, 0.0), BothEnds::ONE);
    // So a rational surface's region can still be halved where a polynomial one's cannot.
    let last = Region { sides: [[end, BothEnds::ONE]; 2], next: Direction::U };
    let [low, high] = last.halves(Direction::U).unwrap();
    assert_eq!([low.widths()[0], high.widths()[0]], [5e-11; 2]);
    assert!(
        !last.encloses([[BothEnds::ZERO, BothEnds::ONE]; 2]) && last.holds([BothEnds::ONE; 2]) && last.holds([end; 2])
    );
    let share = 1.0 - 1e-10_f32;
    assert!(Region::<Number<f32>>::between([[share, 1.0]; 2]).halves(Direction::U).is_none());
}
