//! Evaluation, derivatives, restriction and normals, against de Casteljau's algorithm in `f64` and shapes with known equations.

mod common;

use common::allowances::{EVALUATION, RATIONAL_EVALUATION, REMAINDER, RESTRICTION};
use common::{Kind, Prepared, add, cross, dot, index, lower, norm};
use patchray::bernstein::{Basis, Full, MAX_DEGREE};
use patchray::domain::MAX_LEVEL;
use patchray::limits::{Limits, Work};
use patchray::point::{Plain, Point, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::surface::{Direction, Net, Surface};
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::shapes::{Random, bumpy, elevate, parallelogram, single, sphere};
use patchray_host::scene::teapot;

type P4 = [f64; 4];

/// An edge of a bicubic: its control points, and the (u, v) at `t` along it, `inset` from it.
type Edge = ([usize; 4], fn(f64, f64) -> [f64; 2]);

fn mix(a: P4, b: P4, t: f64) -> P4 {
    core::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

/// The point of a curve and its derivative; homogeneous.
fn de_casteljau(points: &[P4], t: f64) -> [P4; 2] {
    let mut row = points.to_vec();
    let degree = row.len() - 1;
    while row.len() > 2 {
        row = row.windows(2).map(|pair| mix(pair[0], pair[1], t)).collect();
    }
    [mix(row[0], row[1], t), core::array::from_fn(|k| (row[1][k] - row[0][k]) * degree as f64)]
}

/// Point and derivatives in u and in v of a net of homogeneous points, u outer.
fn reference<P: Point>(net: &Net<'_, P>, u: f64, v: f64) -> [P4; 3] {
    let rows: Vec<[P4; 2]> =
        net.rows().map(|row| de_casteljau(&row.iter().map(exact).collect::<Vec<_>>(), v)).collect();
    let along_u = |k: usize| de_casteljau(&rows.iter().map(|r| r[k]).collect::<Vec<_>>(), u);
    let [point, du] = along_u(0);
    [point, du, along_u(1)[0]]
}

/// The homogeneous point that the kernel holds, in `f64`.
fn exact<P: Point>(point: &P) -> P4 {
    let [x, y, z] = point.weighted_position().map(Scalar::to_f64);
    [x, y, z, point.weight().to_f64()]
}

fn close(a: P4, b: P4, allowance: f64) -> bool {
    (0..4).all(|k| (a[k] - b[k]).abs() <= allowance)
}

/// A surface of these degrees with coordinates below 1, and weights if asked for.
fn some_surface(degrees: [usize; 2], weighted: bool, seed: u64) -> ModelSurface {
    let mut surface = bumpy(seed, degrees, [0.1, -0.2, 0.3], 1.2, 0.5);
    let mut random = Random(seed);
    surface.rational = weighted;
    for point in surface.points.iter_mut().filter(|_| weighted) {
        point[3] = random.within(0.25, 1.0);
    }
    surface
}

/// Parameters within [0, 1], both ends among them.
fn parameters<S: Scalar>(random: &mut Random) -> [S; 2] {
    [0, 1].map(|_| match index(random, 6) {
        0 => S::ZERO,
        1 => S::ONE,
        _ => S::from_f64(random.within(0.0, 1.0)),
    })
}

fn every_degree_pair<P: Kind>(weighted: bool) {
    let mut basis = Basis::<P::Scalar, 16>::new();
    let mut random = Random(1);
    let eps = P::Scalar::EPSILON.to_f64();
    let mut worst: f64 = 0.0;
    for n in 1..=MAX_DEGREE {
        for m in 1..=MAX_DEGREE {
            let surface = some_surface([n, m], weighted, (16 * n + m) as u64);
            let points: Vec<P> = lower(&surface, 1.0);
            let net = Net::checked(n, m, &points).unwrap();
            for _ in 0..20 {
                let [u, v] = parameters::<P::Scalar>(&mut random);
                let jet = net.jet(u, v, &mut basis.view()).unwrap();
                let expected = reference(&net, u.to_f64(), v.to_f64());
                let allowance = f64::from(EVALUATION) * eps;
                // Plain points have weight 1, and so have their derivatives, which name none.
                let found = [jet.point, jet.du, jet.dv].map(|p| exact(&p));
                for (k, factor) in [1.0, n as f64, m as f64].into_iter().enumerate() {
                    let mut expected = expected[k];
                    if !P::RATIONAL {
                        expected[3] = 1.0;
                    }
                    let off = (0..4).fold(0.0, |o: f64, c| o.max((found[k][c] - expected[c]).abs() / factor));
                    worst = worst.max(off / eps);
                    assert!(off <= allowance, "{n} x {m}, {k}: {found:?} {expected:?}");
                }
                let [x, y, z] = net.position(u, v, &mut basis.view()).unwrap().map(Scalar::to_f64);
                let [wx, wy, wz, w] = expected[0];
                let w = if P::RATIONAL { w } else { 1.0 };
                let allowance = f64::from(if P::RATIONAL { RATIONAL_EVALUATION } else { EVALUATION }) * eps;
                assert!(close([x, y, z, 1.0], [wx / w, wy / w, wz / w, 1.0], allowance));
            }
        }
    }
    println!("worst: {worst} roundings");
}

#[test]
fn every_degree_pair_agrees_with_de_casteljau() {
    every_degree_pair::<Plain<f32>>(false);
    every_degree_pair::<Plain<f64>>(false);
    every_degree_pair::<Weighted<f32>>(true);
    every_degree_pair::<Weighted<f64>>(true);
}

#[test]
fn raising_the_degree_leaves_the_surface_where_it_is() {
    fn check<P: Kind>(weighted: bool) {
        let mut basis = Basis::<P::Scalar, 16>::new();
        let mut random = Random(2);
        let allowance = f64::from(RATIONAL_EVALUATION) * P::Scalar::EPSILON.to_f64();
        for (degrees, raised) in
            [([1, 1], [3, 3]), ([2, 2], [3, 3]), ([3, 3], [15, 15]), ([3, 3], [4, 3]), ([2, 2], [2, 9])]
        {
            let low = some_surface(degrees, weighted, 5);
            let high = elevate(&low, raised[0], raised[1]);
            let (low_points, high_points): (Vec<P>, Vec<P>) = (lower(&low, 1.0), lower(&high, 1.0));
            let a = Net::new(degrees[0], degrees[1], &low_points).unwrap();
            let b = Net::new(raised[0], raised[1], &high_points).unwrap();
            for _ in 0..100 {
                let [u, v] = parameters(&mut random);
                let [p, q] = [a, b].map(|net| net.position(u, v, &mut basis.view()).unwrap().map(Scalar::to_f64));
                assert!((0..3).all(|k| (p[k] - q[k]).abs() <= allowance), "{degrees:?} {raised:?} {p:?} {q:?}");
            }
        }
    }
    check::<Plain<f32>>(false);
    check::<Plain<f64>>(false);
    check::<Weighted<f32>>(true);
    check::<Weighted<f64>>(true);
}

/// A power of two as net and dyadic parameters: every sum is exact, so the result is known to the bit.
#[test]
fn short_dyadic_nets_are_evaluated_exactly() {
    fn check<S: Scalar>() {
        let mut random = Random(3);
        let mut basis = Basis::<S, 16>::new();
        for degrees in [[1, 1], [2, 2], [3, 3], [2, 1], [1, 3], [3, 2]] {
            let count = (degrees[0] + 1) * (degrees[1] + 1);
            let points: Vec<Plain<S>> = (0..count)
                .map(|_| Plain([0; 3].map(|_| S::from_f64(index(&mut random, 17) as f64 / 8.0 - 1.0))))
                .collect();
            let net = Net::new(degrees[0], degrees[1], &points).unwrap();
            for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.5), (0.25, 0.5), (0.75, 0.25)] {
                let jet = net.jet(S::from_f64(u), S::from_f64(v), &mut basis.view()).unwrap();
                let expected = reference(&net, u, v);
                for (found, expected) in [jet.point, jet.du, jet.dv].iter().zip(expected) {
                    assert_eq!(exact(found)[..3], expected[..3], "{degrees:?} at {u}, {v}");
                }
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn a_basis_too_small_says_so_and_unrolled_degrees_need_none() {
    let mut small = Basis::<f64, 3>::new();
    for degrees in [[1, 3], [3, 1], [4, 4], [15, 1]] {
        let points: Vec<Plain<f64>> = lower(&some_surface(degrees, false, 1), 1.0);
        let net = Net::new(degrees[0], degrees[1], &points).unwrap();
        assert_eq!(net.jet(0.5, 0.5, &mut small.view()), Err(Full));
        assert_eq!(net.position(0.5, 0.5, &mut small.view()), Err(Full));
        assert_eq!(net.normal(0.5, 0.5, &mut small.view()), Err(Full));
    }
    for degree in [2, 3] {
        let points: Vec<Plain<f64>> = lower(&some_surface([degree; 2], false, 1), 1.0);
        let net = Net::new(degree, degree, &points).unwrap();
        assert!(net.jet(0.5, 0.5, &mut Basis::<f64, 0>::new().view()).is_ok());
        assert!(net.normal(0.5, 0.5, &mut Basis::<f64, 0>::new().view()).is_ok());
    }
    let mut part = heapless::Vec::<Plain<f64>, 15>::new();
    let points: Vec<Plain<f64>> = lower(&some_surface([3, 3], false, 1), 1.0);
    assert_eq!(Net::new(3, 3, &points).unwrap().restrict([0.0, 1.0], [0.0, 1.0], &mut part), Err(Full));
}

fn restriction<P: Kind>(weighted: bool) {
    let mut basis = Basis::<P::Scalar, 16>::new();
    let mut random = Random(4);
    let allowance = f64::from(RESTRICTION) * P::Scalar::EPSILON.to_f64() * if weighted { 4.0 } else { 1.0 };
    let (zero, one) = (P::Scalar::ZERO, P::Scalar::ONE);
    let mut part = heapless::Vec::<P, 256>::new();
    for degrees in [[1, 1], [2, 2], [3, 3], [5, 4], [2, 12], [15, 15]] {
        let points: Vec<P> = lower(&some_surface(degrees, weighted, 9), 1.0);
        let net = Net::new(degrees[0], degrees[1], &points).unwrap();
        for round in 0..100 {
            let mut interval = || {
                // Of subdivision: dyadic, down to the finest level; and any other.
                if round % 2 == 0 {
                    let level = index(&mut random, MAX_LEVEL as usize + 1);
                    let cell = index(&mut random, 1 << level) as f64;
                    [cell, cell + 1.0].map(|c| P::Scalar::from_f64(c / (1 << level) as f64))
                } else {
                    let [a, b] = parameters::<P::Scalar>(&mut random);
                    if a < b { [a, b] } else { [b, a] }
                }
            };
            let (u, v) = (interval(), interval());
            net.restrict(u, v, &mut part).unwrap();
            let piece = Net::new(degrees[0], degrees[1], &part).unwrap();
            for _ in 0..5 {
                let [a, b] = parameters::<P::Scalar>(&mut random);
                let at = |[low, high]: [P::Scalar; 2], t: P::Scalar| {
                    low.to_f64() + (high.to_f64() - low.to_f64()) * t.to_f64()
                };
                let found = piece.position(a, b, &mut basis.view()).unwrap().map(Scalar::to_f64);
                let [x, y, z, w] = reference(&net, at(u, a), at(v, b))[0];
                let w = if P::RATIONAL { w } else { 1.0 };
                let expected = [x / w, y / w, z / w];
                assert!((0..3).all(|k| (found[k] - expected[k]).abs() <= allowance), "{degrees:?} {u:?} {v:?}");
            }
        }
        // A border that stays keeps its control points to the bit; neighbours rely on it.
        let columns = degrees[1] + 1;
        let first = |row: &[P]| row.iter().step_by(columns).copied().collect::<Vec<_>>();
        let half = P::Scalar::HALF;
        net.restrict([zero, half], [zero, one], &mut part).unwrap();
        assert_eq!(part[..columns], points[..columns]);
        net.restrict([half, one], [zero, one], &mut part).unwrap();
        assert_eq!(part[degrees[0] * columns..], points[degrees[0] * columns..]);
        net.restrict([zero, one], [zero, half], &mut part).unwrap();
        assert_eq!(first(&part), first(&points));
        net.restrict([zero, one], [half, one], &mut part).unwrap();
        assert_eq!(first(&part[degrees[1]..]), first(&points[degrees[1]..]));
        net.restrict([zero, one], [zero, one], &mut part).unwrap();
        assert_eq!(part[..], points[..]);
        // The two halves share their border, and are what restriction makes of it.
        let (mut low, mut high) = (heapless::Vec::<P, 256>::new(), heapless::Vec::<P, 256>::new());
        for direction in [Direction::U, Direction::V] {
            net.halve(direction, &mut low, &mut high).unwrap();
            let (domain_u, domain_v) = match direction {
                Direction::U => ([half, one], [zero, one]),
                Direction::V => ([zero, one], [half, one]),
            };
            net.restrict(domain_u, domain_v, &mut part).unwrap();
            assert_eq!(high, part);
            let (a, b): (Vec<P>, Vec<P>) = match direction {
                Direction::U => (low[degrees[0] * columns..].to_vec(), high[..columns].to_vec()),
                Direction::V => (first(&low[degrees[1]..]), first(&high)),
            };
            let tolerance = allowance;
            assert!(a.iter().zip(&b).all(|(a, b)| close(exact(a), exact(b), tolerance)), "{direction:?}");
        }
    }
}

#[test]
fn a_part_of_a_surface_is_that_part() {
    restriction::<Plain<f32>>(false);
    restriction::<Plain<f64>>(false);
    restriction::<Weighted<f32>>(true);
    restriction::<Weighted<f64>>(true);
}

/// The angle between a normal and a unit vector, whatever their signs.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    norm(cross(a, b))
}

#[test]
fn normals_of_a_sphere_are_radial_at_its_poles_too() {
    fn check<S: Scalar>(allowance: f64) {
        let centre = [0.5, -0.25, 1.0];
        let model = sphere(centre, 1.5);
        let prepared = Prepared::<Weighted<S>>::coarse(&model);
        let mut basis = Basis::<S, 16>::new();
        for k in 0..8 {
            let net = prepared.scene().surface(k).unwrap().net;
            for i in 0..=16 {
                for j in 0..=16 {
                    let [u, v] = [i, j].map(|n| S::from_f64(f64::from(n) / 16.0));
                    let point = net.position(u, v, &mut basis.view()).unwrap();
                    let scale = (prepared.header_exponent() as f64).exp2();
                    let radial: [f64; 3] = core::array::from_fn(|k| (point[k].to_f64() / scale - centre[k]) / 1.5);
                    let normal = net.normal(u, v, &mut basis.view()).unwrap().unwrap().map(Scalar::to_f64);
                    assert!((norm(normal) - 1.0).abs() < allowance, "{k} {i} {j}: {normal:?}");
                    assert!(angle(normal, radial) < allowance, "{k} {i} {j}: {normal:?} {radial:?}");
                }
            }
        }
    }
    check::<f32>(2e-4);
    check::<f64>(1e-11);
}

impl<P: Kind> Prepared<P> {
    fn header_exponent(&self) -> i32 {
        self.scene().frame().exponent()
    }
}

#[test]
fn normals_at_the_teapots_collapsed_edges_are_the_limit_from_inside() {
    fn check<S: Scalar>(inset: f64, allowance: f64) {
        let model = teapot::model().unwrap();
        let prepared = Prepared::<Plain<S>>::coarse(&model);
        let mut basis = Basis::<S, 16>::new();
        let mut collapsed = 0;
        for k in 0..model.surfaces.len() {
            let net = prepared.scene().surface(k).unwrap().net;
            let points = net.points();
            // Each edge: its control points, and a point (u, v) at `t` along it, `inset` from it.
            let edges: [Edge; 4] = [
                ([0, 1, 2, 3], |t, inset| [inset, t]),
                ([12, 13, 14, 15], |t, inset| [1.0 - inset, t]),
                ([0, 4, 8, 12], |t, inset| [t, inset]),
                ([3, 7, 11, 15], |t, inset| [t, 1.0 - inset]),
            ];
            for (edge, place) in edges {
                if edge.iter().any(|&p| points[p] != points[edge[0]]) {
                    continue;
                }
                collapsed += 1;
                for t in [0.125, 0.25, 0.5, 0.625, 0.9] {
                    let mut normal = |inset: f64| {
                        let [u, v] = place(t, inset).map(S::from_f64);
                        net.normal(u, v, &mut basis.view()).unwrap().unwrap().map(Scalar::to_f64)
                    };
                    let (at, near) = (normal(0.0), normal(inset));
                    assert!((norm(at) - 1.0).abs() < 1e-6, "{k} {edge:?} {t}: {at:?}");
                    assert!(norm(add(at, -1.0, near)) < allowance, "{k} {edge:?} {t}: {at:?} {near:?}");
                }
            }
        }
        assert_eq!(collapsed, 8);
    }
    check::<f32>(1e-3, 2e-2);
    check::<f64>(1e-6, 2e-5);
}

#[test]
fn a_normal_where_both_derivatives_vanish_and_of_a_plane() {
    let mut basis = Basis::<f64, 16>::new();
    // The four points about a corner in one place: S_u and S_v vanish there, and S_uv too.
    let mut corner = elevate(&parallelogram([0.0; 3], [0.5, 0.25, 0.0], [-0.25, 0.5, 0.0]), 3, 3);
    for k in [1, 4] {
        corner.points[k] = corner.points[0];
    }
    let points: Vec<Plain<f64>> = lower(&corner, 1.0);
    let net = Net::new(3, 3, &points).unwrap();
    let normal = net.normal(0.0, 0.0, &mut basis.view()).unwrap().unwrap();
    let near = net.normal(1e-3, 1e-3, &mut basis.view()).unwrap().unwrap();
    assert!((normal[2].abs() - 1.0).abs() < 1e-12 && normal[2] * near[2] > 0.0, "{normal:?} {near:?}");
    let points: Vec<Plain<f64>> = lower(&parallelogram([0.1; 3], [0.5, 0.25, 0.1], [-0.25, 0.5, 0.7]), 1.0);
    let net = Net::new(1, 1, &points).unwrap();
    let expected = cross([0.5, 0.25, 0.1], [-0.25, 0.5, 0.7]);
    for (u, v) in [(0.0, 0.0), (0.3, 0.8), (1.0, 1.0)] {
        let normal = net.normal(u, v, &mut basis.view()).unwrap().unwrap();
        assert!(norm(add(normal, -1.0 / norm(expected), expected)) < 1e-14);
        assert!(dot(normal, expected) > 0.0);
    }
    // A surface that is a point has no normal.
    let point = [Plain([0.25; 3]); 16];
    assert_eq!(Net::new(3, 3, &point).unwrap().normal(0.5, 0.5, &mut basis.view()), Ok(None));
}

/// `Net::bend` bounds what one Newton step leaves: the remainder of the step's linear model, in the two planes' system, and
/// what the true step of `solve` ends with.
fn bend<P: Kind>(weighted: bool) {
    let mut random = Random(6);
    let mut basis = Basis::<P::Scalar, 16>::new();
    let eps = P::Scalar::EPSILON.to_f64();
    let (mut nearest, mut steps): (f64, u32) = (0.0, 0);
    for seed in 0..60 {
        let degrees = [[1, 1], [2, 2], [3, 3], [2, 5], [9, 4], [15, 15]][seed as usize % 6];
        let mut surface = some_surface(degrees, weighted, seed);
        for point in surface.points.iter_mut().filter(|_| weighted) {
            point[3] = 10.0_f64.powf(random.within(-1.5, 0.0));
        }
        let prepared = Prepared::<P>::coarse(&single(surface));
        let scene = prepared.scene();
        let Surface { net, shape, .. } = scene.surface(0).unwrap();
        let bend = shape.bend.map(|b| b.to_f64());
        for _ in 0..200 {
            let origin = random.point(2.0).map(P::Scalar::from_f64);
            let target = random.point(0.4).map(P::Scalar::from_f64);
            let d = core::array::from_fn(|k| target[k] - origin[k]);
            let Ok(ray) = scene.ray(origin, d) else { continue };
            let whole = Interval::new(-P::Scalar::INFINITY, P::Scalar::INFINITY).unwrap();
            let Some((planes, _)) = scene.frame().enter(&ray, &whole) else { continue };
            let [u, v] = parameters::<P::Scalar>(&mut random);
            let size = 10.0_f64.powf(random.within(-3.0, 0.0));
            let [u1, v1] = [u, v].map(|t| {
                let by = P::Scalar::from_f64(random.within(-size, size));
                (t + by).clamped(P::Scalar::ZERO, P::Scalar::ONE)
            });
            let (du, dv) = (u1 - u, v1 - v);
            let jet = net.jet(u, v, &mut basis.view()).unwrap();
            let along = |d: P| if weighted { planes.weighted(d) } else { planes.vector(&d.weighted_position()) };
            let (p, a, b) = (planes.weighted(jet.point), along(jet.du), along(jet.dv));
            let end = net.jet(u1, v1, &mut basis.view()).unwrap();
            let q = planes.weighted(end.point);
            // What is left of the distance from the ray at the end of the step, times the weight there.
            let left = [(q.f - p.f - a.f * du - b.f * dv).to_f64(), (q.g - p.g - a.g * du - b.g * dv).to_f64()];
            let left = left[0].hypot(left[1]);
            let (du, dv) = (du.to_f64(), dv.to_f64());
            let bound = bend[0] * du * du + bend[1] * (du * dv).abs() + bend[2] * dv * dv;
            let slack = f64::from(REMAINDER) * eps;
            assert!(left <= bound + slack, "{degrees:?}: {left} {bound}");
            if bound > 100.0 * slack {
                nearest = nearest.max(left / bound);
                steps += 1;
            }
        }
    }
    println!("{steps} steps, nearest to the bound: {nearest}");
    assert!(steps > 500 && nearest > 0.05, "the bound says nothing: {steps} {nearest}");
}

#[test]
fn no_newton_step_leaves_more_than_the_bend_bounds() {
    bend::<Plain<f32>>(false);
    bend::<Plain<f64>>(false);
    bend::<Weighted<f32>>(true);
    bend::<Weighted<f64>>(true);
}

/// A paraboloid's second derivatives are constant: the bound is reached but for the √3 of sheared planes.
#[test]
fn the_bend_of_a_paraboloid_is_its_curvature() {
    let prepared = Prepared::<Plain<f64>>::of(&single(patchray_host::scene::shapes::paraboloid([0.0; 3], 0.5)));
    let surface = prepared.scene().surface(0).unwrap();
    // z = x² + y² with x = u − 1/2: S_uu = (0, 0, 2) · scale, halved by Taylor.
    let scale = f64::from(prepared.header_exponent()).exp2();
    let [along_u, mixed, along_v] = surface.shape.bend.map(|b| b / (3.0_f64.sqrt() * scale));
    assert!((along_u - 1.0).abs() < 1e-4 && (along_v - 1.0).abs() < 1e-4 && mixed < 1e-12, "{:?}", surface.shape.bend);
    // A flat surface is solved in one step, by a tolerance above what rounding makes of a step across all of it.
    let flat = Prepared::<Plain<f64>>::of(&single(parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])));
    let scene = flat.scene();
    let ray = scene.ray([0.25, 0.75, 1.0], [0.0, 0.0, -1.0]).unwrap();
    let (planes, _) = scene.frame().enter(&ray, &Interval::ahead()).unwrap();
    let mut work = Work::default();
    let limits = Limits { tolerance: 1e-13, ..Limits::default() };
    let root = common::solve(&scene.surface(0).unwrap(), &planes, [0.0; 2], &limits, &mut work);
    let root = root.unwrap().unwrap();
    assert_eq!((root.at(), work.newton_steps), ([0.25, 0.75], 1));
}
