//! One Newton solve: what it accepts, what it refuses, and that it ends.

mod common;

use common::allowances::{RESIDUAL, roundings};
use common::{Kind, Prepared, cross, index, norm, solve};
use patchray::bernstein::Basis;
use patchray::limits::{Limit, Limits, Work};
use patchray::method::Scratch;
use patchray::newton::Solver;
use patchray::planes::Planes;
use patchray::point::{Plain, Point, Weighted};
use patchray::ray::{Incidence, Interval};
use patchray::root::Root;
use patchray::scalar::Scalar;
use patchray::surface::Surface;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::shapes::{Random, bumpy, elevate, paraboloid, parallelogram, single, sphere};

fn planes<P: Kind>(prepared: &Prepared<P>, origin: [f64; 3], d: [f64; 3]) -> Option<Planes<P::Scalar>> {
    let scene = prepared.scene();
    let ray = scene.ray(origin.map(P::Scalar::from_f64), d.map(P::Scalar::from_f64)).unwrap();
    let whole = Interval::new(-P::Scalar::INFINITY, P::Scalar::INFINITY).unwrap();
    scene.frame().enter(&ray, &whole).map(|(planes, _)| planes)
}

type Solved<P> = Result<Option<Root<<P as Point>::Parameter>>, Limit>;

fn newton<P: Kind>(
    prepared: &Prepared<P>,
    planes: &Planes<P::Scalar>,
    start: [f64; 2],
    limits: &Limits<P::Scalar>,
) -> (Solved<P>, Work) {
    let surface = prepared.scene().surface(0).unwrap();
    let mut work = Work::default();
    let root = solve(&surface, planes, start.map(P::Scalar::from_f64), limits, &mut work);
    assert_eq!(work.newton_starts, 1);
    assert!(work.newton_steps <= limits.newton_iterations.min(limits.newton_steps));
    (root, work)
}

/// Every accepted root lies within the tolerance of the ray, in true distance; and its depth is where it lies.
fn accepted_roots_are_roots<P: Kind>(weighted: bool) {
    let mut random = Random(71);
    let (mut roots, mut none) = (0, 0);
    let limits = Limits::<P::Scalar>::default();
    let allowed = limits.tolerance + roundings::<P::Scalar>(RESIDUAL);
    let mut worst: f64 = 0.0;
    for seed in 0..30 {
        let degrees = [[1, 1], [2, 2], [3, 3], [2, 6], [15, 15]][seed as usize % 5];
        let mut surface = bumpy(seed, degrees, [0.2, 0.1, -0.3], 2.0, 0.7);
        surface.rational = weighted;
        for point in surface.points.iter_mut().filter(|_| weighted) {
            point[3] = random.within(0.2, 1.0);
        }
        let prepared = Prepared::<P>::coarse(&single(surface));
        let net = prepared.scene().surface(0).unwrap().net;
        let mut basis = Basis::<P::Scalar, 16>::new();
        for _ in 0..300 {
            let (origin, target) = (random.point(3.0), random.point(1.0));
            let Some(planes) = planes(&prepared, origin, [0, 1, 2].map(|k| target[k] - origin[k])) else { continue };
            let start = [0, 1].map(|_| random.within(-0.2, 1.2));
            let (Ok(Some(root)), _) = newton(&prepared, &planes, start, &limits) else {
                none += 1;
                continue;
            };
            let inside = |t: P::Scalar| P::Scalar::ZERO <= t && t <= P::Scalar::ONE;
            let [u, v] = root.at();
            assert!(inside(u) && inside(v) && root.depth.is_finite());
            let point = net.position(u, v, &mut basis.view()).unwrap();
            let (o, d) = (planes.origin(), planes.direction());
            let on_ray: [f64; 3] = core::array::from_fn(|k| (point[k] - o[k] - d[k] * root.depth).to_f64());
            // At a held edge (u, v) was rounded onto the surface by up to 64 roundings; then its point moved with it.
            let edge = [u, v].iter().any(|t| *t == P::Scalar::ZERO || *t == P::Scalar::ONE);
            let allowed = if edge { allowed.to_f64() * 8.0 } else { allowed.to_f64() };
            assert!(norm(on_ray) <= allowed, "{degrees:?} {root:?} {on_ray:?} {allowed}");
            worst = worst.max(norm(on_ray) / allowed);
            roots += 1;
        }
    }
    println!("{roots} roots, {none} starts without; worst residual {worst} of what is allowed");
    assert!(roots > 1500 && none > 500);
}

#[test]
fn accepted_roots_lie_on_ray_and_surface() {
    accepted_roots_are_roots::<Plain<f32>>(false);
    accepted_roots_are_roots::<Plain<f64>>(false);
    accepted_roots_are_roots::<Weighted<f32>>(true);
    accepted_roots_are_roots::<Weighted<f64>>(true);
}

/// At a pole a derivative vanishes and the Jacobian is singular, but the root is there and the start may be too.
#[test]
fn a_start_at_a_collapsed_pole_with_the_root_there() {
    fn check<S: Scalar>() {
        // The octant whose pole is at u = 1, up; its four dyadic coordinates are exact in both types.
        let model = single(sphere([0.0; 3], 0.5).surfaces[0].clone());
        let prepared = Prepared::<Weighted<S>>::coarse(&model);
        // Straight down, at a slant from inside the octant's side, and at a slant from outside.
        for d in [[0.0, 0.0, -1.0], [-0.5, -0.25, -1.0], [0.25, 0.5, -1.0]] {
            let origin: [f64; 3] = core::array::from_fn(|k| [0.0, 0.0, 0.5][k] - d[k]);
            let planes = planes(&prepared, origin, d).unwrap();
            for v in [0.0, 0.3, 1.0] {
                let (root, work) = newton(&prepared, &planes, [1.0, v], &Limits::default());
                let root = root.unwrap().expect("the start is the root");
                assert_eq!((root.at(), work.newton_steps), ([S::ONE, S::from_f64(v)], 1));
                assert!((planes.t(root.depth) - S::ONE).abs() < roundings(8));
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

/// A start where the Jacobian vanishes away from any root ends with none, without a division by it.
#[test]
fn a_singular_jacobian_ends_the_solve() {
    fn check<S: Scalar>() {
        let prepared = Prepared::<Plain<S>>::coarse(&single(paraboloid([0.0; 3], 0.5)));
        // Along x, above the apex: at u = v = 1/2 the surface is parallel to the ray.
        let level = planes(&prepared, [-2.0, 0.0, 0.125], [1.0, 0.0, 0.0]).unwrap();
        let (root, work) = newton(&prepared, &level, [0.5, 0.5], &Limits::default());
        assert_eq!((root, work.newton_steps), (Ok(None), 1));
        // The roots at x = ±√(1/8) are found from either side of it.
        for (start, x) in [([0.9, 0.5], 0.125_f64.sqrt()), ([0.1, 0.5], -0.125_f64.sqrt())] {
            let root = newton(&prepared, &level, start, &Limits::default()).0.unwrap().unwrap();
            assert!((root.at()[0].to_f64() - 0.5 - x).abs() < 1e-5 && root.incidence == Incidence::Crossing);
        }
        // A surface that is a line, and one that is a point.
        let line = single(elevate(&parallelogram([0.0; 3], [1.0, 0.5, 0.25], [1.0, 0.5, 0.25]), 3, 2));
        let point = single(parallelogram([0.5; 3], [0.0; 3], [0.0; 3]));
        for (model, passing) in [(line, [0.5, 0.25, 2.0]), (point, [0.5, 0.5, 2.0])] {
            let prepared = Prepared::<Plain<S>>::coarse(&model);
            if let Some(planes) = planes(&prepared, passing, [0.0, 0.0, -1.0]) {
                for start in [[0.5, 0.5], [0.25, 0.25], [0.0, 1.0]] {
                    let root = newton(&prepared, &planes, start, &Limits::default()).0.unwrap();
                    if let Some(root) = root {
                        assert!(root.depth.is_finite());
                    }
                }
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn starts_outside_and_starts_that_are_not_numbers() {
    fn check<S: Scalar>() {
        let prepared = Prepared::<Plain<S>>::coarse(&single(bumpy(5, [3, 3], [0.0; 3], 2.0, 0.1)));
        let planes = planes(&prepared, [0.25, -0.5, 3.0], [0.0, 0.0, -1.0]).unwrap();
        let limits = Limits::default();
        let inside = newton(&prepared, &planes, [0.5, 0.5], &limits).0.unwrap().unwrap();
        // A start beyond the edge begins at the edge.
        for start in [[-3.0, 0.5], [0.5, 7.0], [1e30, -1e30], [f64::INFINITY, f64::NEG_INFINITY]] {
            let root = newton(&prepared, &planes, start, &limits).0.unwrap();
            if let Some(root) = root {
                let close = |k: usize| (root.at()[k] - inside.at()[k]).abs() < S::from_f64(1e-4);
                assert!(close(0) && close(1));
            }
        }
        for start in [[f64::NAN, 0.5], [0.5, f64::NAN], [f64::NAN, f64::NAN]] {
            assert_eq!(newton(&prepared, &planes, start, &limits).0, Ok(None));
            let endless = Limits { newton_halvings: u32::MAX, ..limits };
            assert_eq!(newton(&prepared, &planes, start, &endless).0, Ok(None));
        }
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn iterations_are_a_parameter_and_steps_a_budget() {
    let flat = Prepared::<Plain<f64>>::coarse(&single(parallelogram([-0.5; 3], [1.0, 0.0, 0.5], [0.0, 1.0, 0.0])));
    let straight = planes(&flat, [0.1, 0.2, 3.0], [0.0, 0.0, -1.0]).unwrap();
    let limits = Limits::default();
    // None: no evaluation, no root, no giving up. One is enough for a flat surface, by a tolerance above what rounding makes of a
    // step across all of it.
    let none = Limits { newton_iterations: 0, ..limits };
    let (root, work) = newton(&flat, &straight, [0.5, 0.5], &none);
    assert_eq!((root, work.newton_steps), (Ok(None), 0));
    let one = Limits { newton_iterations: 1, tolerance: 1e-13, ..limits };
    let (root, work) = newton(&flat, &straight, [0.0, 1.0], &one);
    assert!(root.unwrap().is_some() && work.newton_steps == 1);
    let round = Prepared::<Plain<f64>>::coarse(&single(paraboloid([0.0; 3], 0.5)));
    let slant = planes(&round, [0.3, 0.2, 3.0], [-0.1, 0.05, -1.0]).unwrap();
    let (root, full) = newton(&round, &slant, [0.0, 0.0], &limits);
    let root = root.unwrap().unwrap();
    assert!(full.newton_steps > 1);
    for n in 0..full.newton_steps {
        let few = Limits { newton_iterations: n, ..limits };
        assert_eq!(newton(&round, &slant, [0.0, 0.0], &few).0, Ok(None));
        let budget = Limits { newton_steps: n, ..limits };
        let (outcome, work) = newton(&round, &slant, [0.0, 0.0], &budget);
        assert_eq!((outcome, work.newton_steps), (Err(Limit::NewtonSteps), n));
    }
    let enough = Limits { newton_steps: full.newton_steps, newton_iterations: full.newton_steps, ..limits };
    assert_eq!(newton(&round, &slant, [0.0, 0.0], &enough).0, Ok(Some(root)));
    // A basis too small for the degree, or too little room for the projected net.
    let high = Prepared::<Plain<f64>>::coarse(&single(bumpy(5, [4, 4], [0.0; 3], 2.0, 0.1)));
    let planes = planes(&high, [0.25, -0.5, 3.0], [0.0, 0.0, -1.0]).unwrap();
    let scene = high.scene();
    let surface = scene.surface(0).unwrap();
    fn within<const ORDER: usize, const POINTS: usize>(
        surface: &Surface<'_, Plain<f64>>,
        planes: &Planes<f64>,
        limits: &Limits<f64>,
    ) -> Solved<Plain<f64>> {
        let mut scratch = Scratch::<Plain<f64>, ORDER, POINTS>::new();
        let mut view = scratch.view();
        let mut solver = Solver::new(surface, planes, limits, view.flat, &mut view.basis);
        solver.solve([0.5; 2], &mut Work::default())
    }
    assert_eq!(within::<4, 25>(&surface, &planes, &limits), Err(Limit::Scratch));
    assert_eq!(within::<5, 24>(&surface, &planes, &limits), Err(Limit::Scratch));
    assert!(matches!(within::<5, 25>(&surface, &planes, &limits), Ok(Some(_))));
}

/// The graph of x ↦ (x − 1/8) (x² − 5 x / 4 + 1/2) over the unit square: one root, at 1/8, and a hump beside it over which
/// the undamped step leaps.
fn humped() -> Model {
    // Bernstein coefficients of x³ − 11/8 x² + 21/32 x − 1/16.
    let [a, b, c, d] = [1.0, -11.0 / 8.0, 21.0 / 32.0, -1.0 / 16.0];
    let heights = [d, d + c / 3.0, d + 2.0 * c / 3.0 + b / 3.0, d + c + b + a];
    let mut points = Vec::new();
    for i in 0..4 {
        for j in 0..2 {
            points.push([i as f64 / 3.0, j as f64, heights[i], 1.0]);
        }
    }
    single(ModelSurface { number: 0, degree_u: 3, degree_v: 1, rational: false, points, knots: None })
}

/// Damping mends starts that the plain iteration loses, and loses none that it finds.
#[test]
fn damping_finds_roots_that_the_bare_step_leaps_over() {
    fn check<S: Scalar>() {
        let prepared = Prepared::<Plain<S>>::coarse(&humped());
        let planes = planes(&prepared, [-1.0, 0.5, 0.0], [1.0, 0.0, 0.0]).unwrap();
        let damped = Limits::<S> { newton_iterations: 30, ..Default::default() };
        let bare = Limits { newton_halvings: 0, ..damped };
        let (mut both, mut only_damped) = (0, 0);
        for k in 0..=200 {
            let start = [f64::from(k) / 200.0, 0.5];
            let with = newton(&prepared, &planes, start, &damped).0.unwrap();
            let without = newton(&prepared, &planes, start, &bare).0.unwrap();
            for root in [with, without].into_iter().flatten() {
                assert!((root.at()[0] - S::from_f64(0.125)).abs() < S::from_f64(1e-5), "{root:?}");
            }
            both += u32::from(with.is_some() && without.is_some());
            only_damped += u32::from(with.is_some() && without.is_none());
        }
        println!("{both} starts found by both, {only_damped} with damping only");
        assert!(both > 50 && only_damped > 5);
    }
    check::<f32>();
    check::<f64>();
}

/// A root on the common edge of two surfaces: both take it, and never neither.
///
/// It gets lost in two ways. Newton's iterates close in on it from beyond the edge, each far nearer than the last: that is
/// not leaving the surface. And where they end beyond it by what the last step leaves, a bound on parameters cannot tell.
#[test]
fn a_root_on_a_common_edge_is_found_from_both_sides() {
    fn check<S: Scalar>() {
        let (mut random, limits) = (Random(81), Limits::<S>::default());
        let (mut both, mut neither, mut rays) = (0, 0, 0);
        for seed in 0..20 {
            // Two bicubic surfaces with the edge's control points in common, to the bit, in each of the four orientations.
            let left = bumpy(seed, [3, 3], [-0.5, 0.0, 0.0], 1.0, 0.2);
            let mut right = bumpy(seed + 100, [3, 3], [0.5, 0.0, 0.0], 1.0, 0.2);
            for j in 0..4 {
                right.points[j] = left.points[12 + j];
            }
            let turned = |surface: &ModelSurface| {
                let points = (0..16).map(|k| surface.points[4 * (k % 4) + k / 4]).collect();
                ModelSurface { points, ..surface.clone() }
            };
            // (surface, whether its parameter across the edge is v)
            let sides = if seed % 2 == 0 { [left.clone(), right.clone()] } else { [turned(&left), turned(&right)] };
            let prepared = Prepared::<Plain<S>>::coarse(&Model::numbered(sides.to_vec()));
            let scene = prepared.scene();
            let unit = S::ONE.times_power_of_two(-scene.frame().exponent());
            let mut basis = Basis::<S, 16>::new();
            for _ in 0..1000 {
                let along = S::from_f64(if index(&mut random, 8) == 0 { 0.0 } else { random.within(0.0, 1.0) });
                let [u, v] = if seed % 2 == 0 { [S::ONE, along] } else { [along, S::ONE] };
                let surface = scene.surface(0).unwrap();
                let jet = surface.net.jet(u, v, &mut basis.view()).unwrap();
                let [point, su, sv] = [jet.point, jet.du, jet.dv].map(|p| p.weighted_position().map(|c| c * unit));
                let normal = cross(su.map(S::to_f64), sv.map(S::to_f64));
                let tilt = random.point(0.5);
                let size = norm(normal);
                let d: [S; 3] = core::array::from_fn(|k| S::from_f64(normal[k] / size + tilt[k]));
                let origin = core::array::from_fn(|k| point[k] - d[k]);
                let ray = scene.ray(origin, d).unwrap();
                let (planes, _) = scene.frame().enter(&ray, &Interval::ahead()).unwrap();
                let found = [0, 1].map(|number| {
                    let surface = scene.surface(number).unwrap();
                    let (low, high) = if number == 0 { (0.9, 1.0) } else { (0.0, 0.1) };
                    let across = S::from_f64(random.within(low, high));
                    let along = along + S::from_f64(random.within(-0.05, 0.05));
                    let start = if seed % 2 == 0 { [across, along] } else { [along, across] };
                    solve(&surface, &planes, start, &limits, &mut Work::default()).unwrap()
                });
                rays += 1;
                both += u32::from(found.iter().all(Option::is_some));
                neither += u32::from(found.iter().all(Option::is_none));
                // The ray is steep to the left surface; to the right one it may be nearly tangent.
                if let Some(root) = found[0] {
                    assert!((planes.t(root.depth) - S::ONE).abs() < limits.tolerance * S::from_u32(8));
                }
            }
        }
        println!("{rays} roots on a common edge, {both} found from both sides, {neither} from neither");
        assert_eq!(neither, 0);
        // What one side loses alone are roots that are nearly tangent there.
        assert!(both * 1000 > rays * 995, "{both} of {rays}");
    }
    check::<f32>();
    check::<f64>();
}
