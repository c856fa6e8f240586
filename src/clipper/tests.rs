//! One surface, one ray, and what clipping is known to get wrong.

extern crate std;

use super::*;
use crate::bernstein::Basis;
use crate::frame::{Aabb, Frame};
use crate::parameter::{BothEnds, Number};
use crate::point::{Plain, Weighted};
use crate::ray::{Incidence, Interval};
use crate::surface::{Net, Shape};
use heapless::Vec as Fixed;
use patchray_host::scene::shapes::Random;
use std::vec::Vec;

type Found<A> = Result<(Vec<Root<A>>, Work), Limit>;

/// All roots of a ray on a surface within [−1/2, 1/2]³ and what they cost, in an order.
fn all<P: Point>(
    [n, m]: [usize; 2],
    points: &[P],
    ray: [[P::Scalar; 3]; 2],
    limits: &Limits<P::Scalar>,
    order: Order<P::Parameter>,
) -> Found<P::Parameter> {
    let half = P::Scalar::HALF;
    let frame = Frame::new(Aabb { low: [-half; 3], high: [half; 3] });
    let ray = frame.ray(ray[0], ray[1]).unwrap();
    let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
    let net = Net::checked(n, m, points).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let (mut whole, mut part) = (Fixed::<_, 256>::new(), Fixed::<_, 256>::new());
    let (mut pending, mut seen, mut basis) = (Fixed::<_, 64>::new(), Fixed::<_, 18>::new(), Basis::<_, 16>::new());
    let mut room =
        ClipRoom { whole: &mut whole, part: &mut part, pending: &mut pending, roots: &mut seen, basis: basis.view() };
    let (mut work, mut roots) = (Work::default(), Vec::new());
    let mut clipper = Clipper { surface: &surface, planes: &planes, limits, room: &mut room };
    let mut search = clipper.roots(order)?;
    while let Some(root) = search.next(&mut work)? {
        // Not to be told from one that was found before, but nearer: it stands for that one.
        if let Some(replaced) = search.replaced() {
            let old = roots.iter().position(|old: &Root<_>| *old == replaced);
            roots.remove(old.expect("it was found"));
        }
        roots.push(root);
    }
    Ok((roots, work))
}

/// What no number parts and nothing proves to be passed is not dropped.
#[test]
fn what_is_left_where_halving_ends_is_a_graze() {
    let frame = Frame::new(Aabb { low: [-0.5; 3], high: [0.5; 3] });
    let ray = frame.ray([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]).unwrap();
    let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
    // It passes the middle by 2^-20.
    let points = graph([2, 2], |_, _| 0.0).into_iter().map(|Plain([x, y, z])| Plain([x + 2_f64.powi(-20), y, z]));
    let points: Vec<_> = points.collect();
    let net = Net::checked(2, 2, &points).unwrap();
    let surface = Surface { number: 0, net, shape: Shape::of(&net) };
    let mut whole = Fixed::<_, 9>::new();
    project_net(&net, &planes, &mut whole).unwrap();
    let exact = Exactness::of(&surface, &planes, &Limits::default());
    let mut basis = Basis::<_, 3>::new();
    let side = [0.5, 0.5 + f64::EPSILON].map(Number::new);
    let region = Region { sides: [side; 2], ..Region::WHOLE };
    let mut within = |held| nearest(&surface, &planes, &whole, &region, &exact, held, &mut basis.view()).unwrap();
    assert!(within(1e-12).is_none());
    assert_eq!(within(f64::INFINITY).unwrap().incidence, Incidence::Grazing);
}

fn roots(degrees: [usize; 2], points: &[Plain<f64>], ray: [[f64; 3]; 2]) -> (Vec<Root<Number<f64>>>, Work) {
    all(degrees, points, ray, &Limits::default(), Order::Any).unwrap()
}

/// The graph z = `height`(i, j) over [−1/4, 1/4]², with control points (i, j) of degrees n × m.
fn graph([n, m]: [usize; 2], height: impl Fn(usize, usize) -> f64) -> Vec<Plain<f64>> {
    let place = |k: usize, degree: usize| k as f64 / degree as f64 * 0.5 - 0.25;
    let index = (0..=n).flat_map(|i| (0..=m).map(move |j| (i, j)));
    index.map(|(i, j)| Plain([place(i, n), place(j, m), height(i, j)])).collect()
}

/// z = x²: over [−1/4, 1/4], as a quadratic in u; straight in v.
fn trough() -> Vec<Plain<f64>> {
    graph([2, 1], |i, _| [0.0625, -0.0625, 0.0625][i])
}

#[test]
fn roots_of_a_trough_are_where_they_are() {
    for x in [-0.2, -0.1, 0.0, 0.05, 0.25] {
        // Straight down: one root; along the trough's width: two.
        let (down, _) = roots([2, 1], &trough(), [[x, 0.1, 0.4], [0.0, 0.0, -1.0]]);
        assert_eq!(down.len(), 1);
        assert!(
            (down[0].u.number() - (x + 0.25) * 2.0).abs() < 1e-12 && (down[0].v.number() - 0.7).abs() < 1e-12,
            "{down:?}"
        );
    }
    for height in [0.0625, 0.01, 1e-4, 1e-8] {
        let (across, work) = roots([2, 1], &trough(), [[-0.4, 0.1, height], [1.0, 0.0, 0.0]]);
        assert_eq!(across.len(), 2, "{height} {work:?}");
        for root in &across {
            let x = root.u.number() * 0.5 - 0.25;
            // Twice the tolerance over the slope; where that vanishes, the root of it.
            assert!((x * x - height).abs() < 1e-12, "{height} {root:?}");
        }
        assert!(work.bisections >= 1 && work.bisection_cases == 1);
    }
}

/// Campagna, Slusallek and Seidel's phantom: a region that shrinks to a point need not hold one of the surface. The ray passes
/// below the trough, or beside its edge.
#[test]
fn a_ray_that_passes_by_is_no_hit_however_near() {
    for gap in [1e-3, 1e-6, 1e-9, 3e-12] {
        assert_eq!(roots([2, 1], &trough(), [[-0.4, 0.1, -gap], [1.0, 0.0, 0.0]]).0, [], "below by {gap}");
        assert_eq!(roots([2, 1], &trough(), [[0.25 + gap, 0.1, 0.4], [0.0, 0.0, -1.0]]).0, [], "beside by {gap}");
        assert_eq!(roots([2, 1], &trough(), [[0.1, -0.25 - gap, 0.4], [0.0, 0.0, -1.0]]).0, [], "beside by {gap}");
    }
    // Beside an edge that bulges to x = 0.3 between control points that go on to 0.35: their hull holds the ray.
    let bulge: Vec<_> = [[-0.25; 3], [0.25, 0.35, 0.25]]
        .iter()
        .flat_map(|x| [0, 1, 2].map(|j| Plain([x[j], j as f64 * 0.25 - 0.25, 0.0])))
        .collect();
    for gap in [1e-3, 1e-6, 1e-9, 1e-11] {
        assert_eq!(roots([1, 2], &bulge, [[0.3 + gap, 0.0, 0.4], [0.0, 0.0, -1.0]]).0, [], "bulge by {gap}");
        assert_eq!(roots([1, 2], &bulge, [[0.3 - gap, 0.0, 0.4], [0.0, 0.0, -1.0]]).0.len(), 1, "bulge by {gap}");
    }
    // Within the tolerance it is one.
    for gap in [0.0, 1e-15, -1e-15] {
        assert_eq!(roots([2, 1], &trough(), [[0.25 + gap, 0.1, 0.4], [0.0, 0.0, -1.0]]).0.len(), 1, "{gap}");
        let (touched, _) = roots([2, 1], &trough(), [[-0.4, 0.1, gap], [1.0, 0.0, 0.0]]);
        assert_eq!(touched.len(), 1, "{gap} {touched:?}");
        assert_eq!(touched[0].incidence, Incidence::Grazing);
    }
}

/// A double root halves at each clip, and two roots that cannot be told apart must not be bisected for ever.
#[test]
fn tangency_takes_bounded_work() {
    for gap in [1e-4, 1e-8, 1e-12, 1e-14, 0.0, -1e-14, -1e-12, -1e-8, -1e-4] {
        let (_, work) = roots([2, 1], &trough(), [[-0.4, 0.1, gap], [1.0, 0.0, 0.0]]);
        assert!(work.clip_steps < 150 && work.bisections < 40, "{gap}: {work:?}");
    }
}

/// A root on the border of a bisection lies in both halves; found twice, it would count twice.
#[test]
fn a_root_on_the_border_of_a_bisection_counts_once() {
    // A wave with three roots along z = 0, the middle one at u = 1/2, where the first bisection is.
    let wave = graph([3, 1], |i, _| [-0.05, 0.25, -0.25, 0.05][i]);
    for order in
        [Order::Any, Order::around(Some([0.5, 0.5].map(Number::new))), Order::around(Some([0.1, 0.5].map(Number::new)))]
    {
        let ray = [[-0.4, 0.1, 0.0], [1.0, 0.0, 0.0]];
        let (mut found, work) = all([3, 1], &wave, ray, &Limits::default(), order).unwrap();
        found.sort_by(|a, b| a.u.number().total_cmp(&b.u.number()));
        assert!(work.bisections > 0);
        assert_eq!(found.len(), 3, "{found:?}");
        assert!((found[1].u.number() - 0.5).abs() < 1e-12, "{found:?}");
    }
}

/// An edge of parameter speed 0 and one of great speed: tolerances in (u, v) would be a thousand times too wide at one end
/// and too narrow at the other.
#[test]
fn tolerances_are_distances_not_parameters() {
    // x runs as u⁷ from 0 on: at u = 0.02 by 1e-11 per unit of u.
    let squeezed: Vec<_> =
        (0..8).flat_map(|i| [0.0, 0.25].map(|y| Plain([if i == 7 { 0.4 } else { 0.0 }, y, 0.0]))).collect();
    for u in [0.02_f64, 0.2, 0.5, 0.99] {
        let x = 0.4 * u.powi(7);
        let (found, work) = roots([7, 1], &squeezed, [[x, 0.1, 0.4], [0.0, 0.0, -1.0]]);
        assert_eq!(found.len(), 1, "{u} {work:?}");
        assert!(
            (0.4 * found[0].u.number().powi(7) - x).abs() < 1e-12 && (found[0].v.number() - 0.4).abs() < 1e-11,
            "{u} {found:?}"
        );
    }
}

/// Where an edge is collapsed the chord along it is null, and no clip along it changes anything.
#[test]
fn a_collapsed_edge_is_met_once() {
    let cone: Vec<_> = [[0.0; 3], [0.0; 3], [-0.2, 0.3, -0.1], [0.2, 0.3, -0.1]].map(Plain).into_iter().collect();
    let (tip, work) = roots([1, 1], &cone, [[0.0, 0.0, 0.4], [0.0, 0.0, -1.0]]);
    assert_eq!(tip.len(), 1, "{tip:?}");
    assert!(tip[0].u.number() < 1e-11 && work.clip_steps < 100, "{tip:?} {work:?}");
    let (near, _) = roots([1, 1], &cone, [[0.0, 1e-9, 0.4], [0.0, 0.0, -1.0]]);
    assert!(near.len() == 1 && (near[0].v.number() - 0.5).abs() < 1e-3, "{near:?}");
    assert_eq!(roots([1, 1], &cone, [[0.0, -1e-9, 0.4], [0.0, 0.0, -1.0]]).0, []);
}

/// In a flat surface the ray has no first-order way to tell where it is: nearest point, or out of budget, never a miss.
#[test]
fn a_ray_in_the_surface_is_a_hit_or_out_of_budget() {
    let sheet = graph([1, 1], |_, _| 0.0);
    let (found, work) = roots([1, 1], &sheet, [[-0.4, 0.1, 0.0], [1.0, 0.0, 0.0]]);
    assert_eq!(found.len(), 1, "{work:?}");
    // Where the ray enters the sheet.
    assert!(found[0].u.number() == 0.0 && (found[0].v.number() - 0.7).abs() < 1e-12, "{found:?}");
    let skew = all([1, 1], &sheet, [[-0.4, -0.3, 0.0], [1.0, 0.7, 0.0]], &Limits::default(), Order::Any);
    match skew {
        Ok((found, _)) => assert!(!found.is_empty()),
        Err(limit) => {
            assert!(matches!(limit, Limit::ClipSteps | Limit::Bisections | Limit::PendingDomains), "{limit:?}")
        }
    }
}

/// Homogeneous sums, or a weight would move the surface.
#[test]
fn a_rational_quarter_of_a_cylinder_is_round() {
    let h = 0.5_f64.sqrt();
    let circle = [([0.3, 0.0], 1.0), ([0.3, 0.3], h), ([0.0, 0.3], 1.0)];
    for scale in [1.0, 1e-3, 1e6] {
        let points: Vec<_> =
            circle.iter().flat_map(|&([x, z], w)| [-0.2, 0.2].map(|y| Weighted::new([x, y, z], w * scale))).collect();
        for x in [0.01, 0.1, 0.2, 0.29] {
            let ray = [[x, 0.05, 0.4], [0.0, 0.0, -1.0]];
            // Weights near 1, as a scene makes them.
            let exponent = -scale.binary_exponent();
            let points: Vec<_> = points.iter().map(|p| p.rescaled(0, exponent)).collect();
            let (found, _) = all([2, 1], &points, ray, &Limits::default(), Order::Any).unwrap();
            assert_eq!(found.len(), 1);
            let (u, w) = (found[0].u.number(), [1.0, h, 1.0]);
            let b = [(1.0 - u) * (1.0 - u), 2.0 * u * (1.0 - u), u * u];
            let at = |k: usize| {
                let sum: f64 = (0..3).map(|i| b[i] * w[i] * circle[i].0[k]).sum();
                sum / (0..3).map(|i| b[i] * w[i]).sum::<f64>()
            };
            assert!((at(0) - x).abs() < 1e-12 && (at(0).hypot(at(1)) - 0.3).abs() < 1e-14, "{x} {found:?}");
        }
    }
}

/// Codes differ in when they bisect: from a clip of 20 % of the interval down to one of 60 %. The roots are the same.
#[test]
fn the_threshold_changes_the_work_and_not_the_roots() {
    let wave = graph([3, 3], |i, j| [[-0.1, 0.3, -0.3, 0.1], [0.2, -0.1, 0.0, 0.1]][j % 2][i]);
    let ray = [[-0.4, 0.03, 0.02], [1.0, 0.1, -0.04]];
    let mut seen = Vec::new();
    for threshold in [0.05, 0.2, 0.4, 0.6] {
        let limits = Limits { clip_threshold: threshold, ..Limits::default() };
        let (mut found, work) = all([3, 3], &wave, ray, &limits, Order::Any).unwrap();
        found.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        seen.push((found, work.bisections));
    }
    assert!(!seen[0].0.is_empty());
    for (found, _) in &seen {
        assert_eq!(found.len(), seen[0].0.len());
        for (a, b) in found.iter().zip(&seen[0].0) {
            assert!((a.u.number() - b.u.number()).abs() < 1e-11 && (a.v.number() - b.v.number()).abs() < 1e-11);
        }
    }
    let mut bisections: Vec<_> = seen.iter().map(|(_, bisections)| *bisections).collect();
    bisections.dedup();
    assert!(bisections.len() > 2, "{bisections:?}");
}

/// A budget ends the search as such, and a full list of regions that wait is never a lost one.
#[test]
fn budgets_are_kept_and_named() {
    let wave = graph([3, 1], |i, _| [-0.05, 0.25, -0.25, 0.05][i]);
    let ray = [[-0.4, 0.1, 0.0], [1.0, 0.0, 0.0]];
    let (_, work) = all([3, 1], &wave, ray, &Limits::default(), Order::Any).unwrap();
    let run = |limits: Limits<f64>| all([3, 1], &wave, ray, &limits, Order::Any).map(|_| ());
    let base = Limits::default();
    assert_eq!(run(Limits { clip_steps: work.clip_steps, bisections: work.bisections, ..base }), Ok(()));
    assert_eq!(run(Limits { clip_steps: work.clip_steps - 1, ..base }), Err(Limit::ClipSteps));
    assert_eq!(run(Limits { bisections: work.bisections - 1, ..base }), Err(Limit::Bisections));
    assert_eq!(run(Limits { pending_domains: 1, ..base }), Err(Limit::PendingDomains));
    assert_eq!(run(Limits { newton_steps: 2, ..base }), Err(Limit::NewtonSteps));
}

/// Where a weight falls to nothing all of the numerators are small, and so says nothing of how far a point is from the ray: of
/// a flat square with one light corner each root is on the ray by its own weight.
#[test]
fn a_root_beside_a_light_corner_is_on_the_ray() {
    let mut random = Random(81);
    let below = |random: &mut Random, count: u64| (random.bits() % count) as usize;
    let mut off = Vec::new();
    for _ in 0..100_000 {
        let light = below(&mut random, 4);
        let weight = random.within(-32.0, -8.0).exp2();
        let slope = random.within(-1.0, 1.0);
        // The square (x, y) over [−1/4, 1/4]², in a plane that rises along x.
        let corner = |k: usize| {
            let [x, y] = [k / 2, k % 2].map(|c| 0.5 * c as f32 - 0.25);
            Weighted::new([x, y, slope as f32 * x], if k == light { weight as f32 } else { 1.0 })
        };
        let points = [0, 1, 2, 3].map(corner);
        // To a place near an edge that leads to the corner opposite, or beside it.
        let mut to = [0, 1].map(|_| 0.5 * below(&mut random, 2) as f64 - 0.25);
        let edge = below(&mut random, 2);
        to[edge] += random.within(-1.0, 1.0) * random.within(-20.0, -2.0).exp2();
        to[1 - edge] += random.within(-1.0, 1.0) * random.within(-20.0, -10.0).exp2();
        let direction = [0, 1, 2].map(|_| random.within(-1.0, 1.0) as f32);
        let target = [to[0], to[1], slope * to[0]];
        let from = [0, 1, 2].map(|k| target[k] as f32 - 2.0 * direction[k]);
        let Ok((roots, _)) = all([1, 1], &points, [from, direction], &Limits::default(), Order::Any) else { continue };
        for root in roots {
            // By its distances from both ends.
            let [u, v] = [root.u, root.v].map(|t| [BothEnds::ONE.minus(t), t.minus(BothEnds::ZERO)].map(f64::from));
            let mut sum = [0.0; 4];
            for (k, point) in points.iter().enumerate() {
                let share = u[k / 2] * v[k % 2];
                (0..4).for_each(|c| sum[c] += share * f64::from(point.numbers()[c]));
            }
            let way = [0, 1, 2].map(|c| sum[c] / sum[3] - f64::from(from[c]));
            let [d, square] = [way, direction.map(f64::from)]
                .map(|of| of.iter().zip(direction).map(|(a, b)| a * f64::from(b)).sum::<f64>());
            let across = [0, 1, 2].map(|c| way[c] - d / square * f64::from(direction[c]));
            let distance = across.iter().map(|c| c * c).sum::<f64>().sqrt();
            if !(distance <= 1e-4) {
                off.push((distance, root, points, from, direction));
            }
        }
    }
    assert!(off.is_empty(), "{} off, the first: {:?}", off.len(), off[0]);
}

/// However much of a flat surface is within rounding of a ray that crosses it at a small angle, the ray crosses it, and does not
/// lie in it.
#[test]
fn a_shallow_crossing_is_no_contact() {
    let mut random = Random(82);
    let mut wrong = Vec::new();
    for _ in 0..20_000 {
        let weight = random.within(-30.0, 0.0).exp2() as f32;
        let points = [[-0.25, -0.25], [-0.25, 0.25], [0.25, -0.25], [0.25, 0.25]];
        let points = points.map(|[x, y]: [f32; 2]| Weighted::new([x, y, 0.0], if x < 0.0 { 1.0 } else { weight }));
        let [turn, slope] = [random.within(0.0, 6.3), random.within(-11.0, -7.0).exp2()];
        let [x, y] = [0, 1].map(|_| random.within(-0.2, 0.2));
        let direction = [turn.cos() as f32, turn.sin() as f32, -slope as f32];
        let from = [x as f32 - direction[0], y as f32 - direction[1], slope as f32];
        let Ok((roots, _)) = all([1, 1], &points, [from, direction], &Limits::default(), Order::Any) else { continue };
        if roots.len() != 1 || roots[0].incidence == Incidence::Contact {
            wrong.push((roots, weight, from, direction));
        }
    }
    assert!(wrong.is_empty(), "{} wrong, the first: {:?}", wrong.len(), wrong[0]);
}
