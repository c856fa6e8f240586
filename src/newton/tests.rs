use super::*;
use crate::bernstein::Basis;
use crate::frame::{Aabb, Frame};
use crate::parameter::Number;
use crate::point::{Plain, Weighted};
use crate::ray::{Incidence, Interval};
use crate::surface::{Net, Shape};

/// The sheet z = 0 over the square of side 1/2 about 0, as a graph of u and v.
const SHEET: [Plain<f64>; 4] =
    [Plain([-0.25, -0.25, 0.0]), Plain([-0.25, 0.25, 0.0]), Plain([0.25, -0.25, 0.0]), Plain([0.25, 0.25, 0.0])];

fn straight_down(x: f64, y: f64) -> Result<Option<Root<Number<f64>>>, Limit> {
    let frame = Frame::new(Aabb { low: [-0.5; 3], high: [0.5; 3] });
    let ray = frame.ray([x, y, 2.0], [0.0, 0.0, -1.0]).unwrap();
    let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
    let net = Net::new(1, 1, &SHEET).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let (limits, mut work) = (Limits::default(), Work::default());
    let (mut flat, mut basis) = (heapless::Vec::<_, 4>::new(), Basis::<f64, 2>::new());
    Solver::new(&surface, &planes, &limits, &mut flat, &mut basis.view()).solve([0.5; 2], &mut work)
}

/// Just beyond the edge is on it, by as much as the ray can tell; farther is not.
#[test]
fn the_edge_is_as_wide_as_the_tolerance() {
    let tolerance = Limits::<f64>::default().tolerance;
    for (beyond, found) in [(0.0, true), (0.5 * tolerance, true), (10.0 * tolerance, false), (1e-3, false)] {
        for sign in [-1.0, 1.0] {
            let at = sign * (0.25 + beyond);
            for [x, y] in [[at, 0.03], [0.03, at]] {
                let root = straight_down(x, y).unwrap();
                assert_eq!(root.is_some(), found, "{beyond} {sign}");
                if let Some(root) = root {
                    let [u, v] = root.at();
                    let across = if y == 0.03 { u } else { v };
                    assert_eq!(across, if sign < 0.0 { 0.0 } else { 1.0 });
                }
            }
        }
    }
}

/// Along x over the trough z = x² one derivative of the projected surface vanishes at the bottom, and the other does not: seen
/// from the ray alone nothing is parallel, and only the depth tells that the ray is tangent.
#[test]
fn tangent_means_an_angle_not_a_small_determinant() {
    let trough = [0.0625, -0.0625, 0.0625];
    let points: [Plain<f64>; 6] = core::array::from_fn(|k| {
        let (i, j) = (k / 2, k % 2);
        Plain([i as f64 * 0.25 - 0.25, j as f64 * 0.5 - 0.25, trough[i]])
    });
    let frame = Frame::new(Aabb { low: [-0.5; 3], high: [0.5; 3] });
    let net = Net::new(2, 1, &points).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let (mut flat, mut basis) = (heapless::Vec::<_, 6>::new(), Basis::<f64, 3>::new());
    for (height, incidence) in [(1e-2, Incidence::Crossing), (1e-8, Incidence::Crossing), (1e-15, Incidence::Grazing)] {
        let ray = frame.ray([-0.4, 0.1, height], [1.0, 0.0, 0.0]).unwrap();
        let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
        let (limits, mut work) = (Limits { newton_iterations: 40, ..Limits::default() }, Work::default());
        let mut basis = basis.view();
        let mut solver = Solver::new(&surface, &planes, &limits, &mut flat, &mut basis);
        let root = solver.solve([0.2, 0.5], &mut work).unwrap().unwrap();
        assert_eq!(root.incidence, incidence, "{height} {root:?}");
    }
}

/// A flat net seen edge on: the ray lies in its plane, so that the Jacobian is all rounding, and so is any step that it makes.
/// Such a step is not to be believed: it led 0.02 off the ray, since of a flat net nothing is left to Taylor's theorem.
#[test]
fn a_step_by_a_singular_jacobian_is_not_believed() {
    let height = 6.65087890625;
    let points: [Plain<f64>; 6] = core::array::from_fn(|k| Plain([(k / 3) as f64 - 1.0, (k % 3) as f64 - 1.0, height]));
    let bounds = points.iter().fold(Aabb::EMPTY, |all, point| all.with(point.0));
    let frame = Frame::new(bounds);
    let scaled = points.map(|point| Plain(frame.from_nets(point.0)));
    let net = Net::new(1, 2, &scaled).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let (limits, mut random) = (Limits::default(), 7_u32);
    let (mut flat, mut basis) = (heapless::Vec::<_, 6>::new(), Basis::<f64, 3>::new());
    let mut share = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(random >> 16) / 65_536.0
    };
    let (mut roots, mut none) = (0, 0);
    for _ in 0..4000 {
        let (from, to) = ([6.0 + share(), 6.0 + share()], [-share(), 2.0 * share() - 1.0]);
        let ray = frame.ray([from[0], from[1], height], [to[0] - from[0], to[1] - from[1], 0.0]).unwrap();
        let Some((planes, _)) = frame.enter(&ray, &Interval::ahead()) else { continue };
        let (mut work, mut basis) = (Work::default(), basis.view());
        let solved = Solver::new(&surface, &planes, &limits, &mut flat, &mut basis)
            .solve([share(), share()], &mut work)
            .unwrap();
        let Some(root) = solved else {
            none += 1;
            continue;
        };
        let point = net.position(root.u.number(), root.v.number(), &mut basis).unwrap();
        let (o, d) = (planes.origin(), planes.direction());
        let off = (0..3).fold(0.0, |off: f64, k| off.max((point[k] - o[k] - d[k] * root.depth).abs()));
        assert!(off <= 8.0 * limits.tolerance, "{root:?} is {off:e} off the ray");
        roots += 1;
    }
    assert!(roots + none > 3000 && none > 100, "{roots} {none}");
}

/// A surface of straight lines from a pole, and a ray along one of them: all but singular, but by more than the step refuses.
/// With a tolerance far below rounding no angle was too small to be one, and steps were believed that led 1e-5 off the ray.
#[test]
fn a_tolerance_below_rounding_makes_no_jacobian_regular() {
    let pole = [3.0; 3];
    let points =
        [([-0.0625, -0.0625, -5.125], 4.0), (pole, 0.796875), ([3.0, 0.0625, 0.0], 0.015625), (pole, 0.765625)];
    let bounds = points.iter().fold(Aabb::EMPTY, |all, (point, _)| all.with(*point));
    let frame = Frame::new(bounds);
    let scaled = points.map(|(point, weight)| Weighted::new(frame.from_nets(point), weight / 4.0));
    let net = Net::new(1, 1, &scaled).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let limits = Limits { tolerance: 1e-52, ..Limits::default() };
    let (mut flat, mut basis) = (heapless::Vec::<_, 4>::new(), Basis::<f64, 2>::new());
    let mut basis = basis.view();
    for k in 0..64 {
        let along = net.position(f64::from(k) / 63.0, 0.5, &mut basis).unwrap();
        let towards = [0, 1, 2].map(|axis| along[axis] - frame.from_nets(pole)[axis]);
        let ray = frame.ray(pole, towards).unwrap();
        let Some((planes, _)) = frame.enter(&ray, &Interval::ahead()) else { continue };
        for start in (0..256).map(|start| [f64::from(start % 16) / 15.0, f64::from(start / 16) / 15.0]) {
            let mut work = Work::default();
            let mut solver = Solver::new(&surface, &planes, &limits, &mut flat, &mut basis);
            let Some(root) = solver.solve(start, &mut work).unwrap() else { continue };
            let point = net.position(root.u.number(), root.v.number(), &mut basis).unwrap();
            let (o, d) = (planes.origin(), planes.direction());
            let off = (0..3).fold(0.0, |off: f64, k| off.max((point[k] - o[k] - d[k] * root.depth).abs()));
            assert!(off <= 1e-9, "{root:?} is {off:e} off the ray");
        }
    }
}

/// Lines from a pole again, where weights fall by 256, and a ray from the pole that all but follows one of them: the determinant
/// is three times what its rounding may be, so that the step to the pole is off by a millionth.
#[test]
fn a_step_by_a_determinant_that_is_partly_rounding_is_not_the_last() {
    let (pole, low, high) = ([0.0; 3], -0.0625, 5.75);
    let base = [
        ([low, 0.25, low], 1.453125),
        ([high, high, low], 1.453125),
        ([high, high, low], 4.0),
        ([low, low, 0.0], 0.015625),
        (pole, 0.03125),
        ([low; 3], 1.09375),
        (pole, 0.015625),
    ];
    let points = base.into_iter().chain([(pole, 0.015625); 7]);
    let bounds = points.clone().fold(Aabb::EMPTY, |all, (point, _)| all.with(point));
    let frame = Frame::new(bounds);
    let scaled: heapless::Vec<_, 14> =
        points.map(|(point, weight)| Weighted::new(frame.from_nets(point), weight / 4.0)).collect();
    let net = Net::new(1, 6, &scaled).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let limits = Limits::default();
    let (mut flat, mut basis) = (heapless::Vec::<_, 14>::new(), Basis::<f64, 7>::new());
    let mut basis = basis.view();
    let ray = frame.ray(pole, [-0.0625, 0.25, -0.0625]).unwrap();
    let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
    let mut roots = 0;
    for start in (0..4096).map(|start| [f64::from(start % 64) / 63.0, f64::from(start / 64) / 63.0 / 63.0]) {
        let mut work = Work::default();
        let mut solver = Solver::new(&surface, &planes, &limits, &mut flat, &mut basis);
        let Some(root) = solver.solve(start, &mut work).unwrap() else { continue };
        roots += 1;
        let point = net.position(root.u.number(), root.v.number(), &mut basis).unwrap();
        let (o, d) = (planes.origin(), planes.direction());
        let off = (0..3).fold(0.0, |off: f64, k| off.max((point[k] - o[k] - d[k] * root.depth).abs()));
        assert!(off <= 1e-9, "{root:?} from {start:?} is {off:e} off the ray");
    }
    assert!(roots > 2000, "{roots}");
}

/// A weight that falls by 2^10 toward the edge v = 1: what is near the ray by the weight before the edge is a thousand times as far
/// from it on the edge. Beyond the edge by less than the tolerance before, by far more on it, there is no root.
#[test]
fn a_weight_that_falls_toward_an_edge_hides_no_distance() {
    let weight = [1.0, 1.0 / 1024.0];
    let points: [Weighted<f64>; 4] =
        core::array::from_fn(|k| Weighted::new([[-0.25, 0.25][k / 2], [-0.25, 0.25][k % 2], 0.0], weight[k % 2]));
    let frame = Frame::new(Aabb { low: [-0.5; 3], high: [0.5; 3] });
    let net = Net::new(1, 1, &points).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let limits = Limits { tolerance: 1e-4, ..Limits::default() };
    for (beyond, met) in [(-1e-3, true), (0.0, true), (1e-5, true), (1e-3, false), (1e-2, false), (4e-2, false)] {
        let ray = frame.ray([0.0, 0.25 + beyond, 2.0], [0.0, 0.0, -1.0]).unwrap();
        let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
        for start in [0.9, 0.99, 0.999, 0.5] {
            let (mut flat, mut basis) = (heapless::Vec::<_, 4>::new(), Basis::<f64, 2>::new());
            let mut work = Work::default();
            let root = Solver::new(&surface, &planes, &limits, &mut flat, &mut basis.view())
                .solve([0.5, start], &mut work)
                .unwrap();
            assert!(root.is_none() || met, "{beyond} {start} {root:?}");
        }
    }
}
