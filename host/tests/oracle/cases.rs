//! Rays and surfaces chosen to be hard: near tangents, poles, seams, corners, many roots, duplicates, odd input.

use crate::truth::*;
use patchray_host::oracle::{OracleIn, Real};
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::shapes::{Random, bumpy, elevate, paraboloid, parallelogram, single, sphere};

in_either!(
    a_paraboloid_just_above_and_below_its_apex
    many_roots_on_one_ray
    poles_seams_and_corners_of_a_sphere_are_met_once
    borders_and_corners_of_a_square_belong_to_it
    the_range_of_t_selects
    a_root_at_a_shallow_angle_soon_leaves_the_range_of_t
    doubled_surfaces_count_once
    odd_input_ends_and_is_said_to_be_undecided
    an_answer_outlasts_a_displacement_within_its_margin
);

fn a_paraboloid_just_above_and_below_its_apex<R: Real>(_: usize) {
    let apex = [0.25, -0.5, 1.0];
    let oracle = OracleIn::<R>::new(&single(paraboloid(apex, 1.0)));
    for exponent in 4..=11 {
        for (direction, offset) in [([1.0, 0.0, 0.0], 0.0), ([0.6, 0.8, 0.0], 0.0), ([0.0, -1.0, 0.0], 0.125)] {
            let height = offset * offset + 10f64.powi(-exponent);
            let origin = add(add(apex, -4.0, direction), offset, [1.0, 0.0, 0.0]);
            let raised = [origin[0], origin[1], origin[2] + height];
            let verdict = oracle.trace(raised, direction, 0.0, f64::INFINITY);
            assert_eq!(verdict.roots.len(), 2, "{exponent}: {verdict:?}");
            let half = 10f64.powf(-0.5 * exponent as f64);
            for (root, t) in verdict.roots.iter().zip([4.0 - half, 4.0 + half]) {
                assert!((root.t - t).abs() < 1e-15 / half + 1e-14, "{exponent}: {verdict:?}");
            }
            assert!(verdict.margin >= 1e-3 * 10f64.powi(-exponent), "{exponent}: {verdict:?}");
            let height = offset * offset - 10f64.powi(-exponent);
            let lowered = [origin[0], origin[1], origin[2] + height];
            let verdict = oracle.trace(lowered, direction, 0.0, f64::INFINITY);
            assert!(verdict.roots.is_empty() && verdict.unresolved == 0, "{exponent}: {verdict:?}");
            assert!(verdict.margin >= 1e-3 * 10f64.powi(-exponent), "{exponent}: {verdict:?}");
        }
    }
    // The tangent itself is nothing that f64 can decide, and must be said to be.
    let verdict = oracle.trace([-4.0, -0.5, 1.0], [1.0, 0.0, 0.0], 0.0, f64::INFINITY);
    assert!(verdict.margin < JUDGED, "{verdict:?}");
    assert!(verdict.unresolved > 0 || !verdict.roots.is_empty(), "{verdict:?}");
}

/// The graph z = Π (x - r_k) over the unit square, of one degree per root in u and `n` in v.
fn graph(roots: &[f64], n: usize) -> ModelSurface {
    let m = roots.len();
    // Bernstein coefficients of a product with x - r, one factor after the other.
    let mut c = vec![64.0];
    for &r in roots {
        let degree = c.len();
        let product = |i: usize| {
            let low = if i < degree { (degree - i) as f64 * -r * c[i] } else { 0.0 };
            let high = if i > 0 { i as f64 * (1.0 - r) * c[i - 1] } else { 0.0 };
            (low + high) / degree as f64
        };
        c = (0..=degree).map(product).collect();
    }
    let mut points = Vec::new();
    for i in 0..=m {
        for j in 0..=n {
            points.push([i as f64 / m as f64, j as f64 / n as f64, c[i], 1.0]);
        }
    }
    ModelSurface { number: 0, degree_u: m, degree_v: n, rational: false, points, knots: None }
}

fn many_roots_on_one_ray<R: Real>(_: usize) {
    for (count, n) in [(2, 1), (5, 3), (9, 2), (15, 15)] {
        let roots: Vec<f64> = (0..count).map(|k| (k as f64 + 0.5) / count as f64).collect();
        let oracle = OracleIn::<R>::new(&single(graph(&roots, n)));
        for scale in [1e-120, 1.0, 1e90] {
            let verdict = oracle.trace([-1.0, 0.3, 0.0], [scale, 0.0, 0.0], 0.0, f64::INFINITY);
            assert_eq!(verdict.roots.len(), count, "{verdict:?}");
            for (root, r) in verdict.roots.iter().zip(&roots) {
                // The high degrees have coefficients that cancel, rounded to f64: the graph is as steep as its blur says.
                let blur = rounding::<R>() * root.blur;
                assert!((root.t * scale - 1.0 - r).abs() < 1e-14 + 2.0 * blur, "{verdict:?}");
                assert!((root.u - r).abs() < 1e-9 && (root.v - 0.3).abs() < 1e-14);
            }
        }
    }
}

fn poles_seams_and_corners_of_a_sphere_are_met_once<R: Real>(fewer: usize) {
    let mut random = Random(17);
    let (centre, radius) = ([0.5, -1.0, 2.0], 1.5);
    let oracle = OracleIn::<R>::new(&sphere(centre, radius));
    let mut judged = 0;
    for n in 0..3000 / fewer {
        let a = random.within(-3.0, 3.0);
        let (sin, cos) = a.sin_cos();
        let normal = match n % 4 {
            0 => [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]][n % 8 / 4],
            1 => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]][n / 4 % 4],
            2 => [cos, sin, 0.0],
            _ => [cos, 0.0, sin],
        };
        let on = add(centre, radius, normal);
        let d = random.point(1.0);
        let origin = add(on, -8.0, d);
        let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
        if (dot(normal, d) / norm(d)).abs() < 1e-3 {
            continue;
        }
        assert_eq!(verdict.unresolved, 0, "{normal:?} {verdict:?}");
        let near = verdict
            .roots
            .iter()
            .filter(|r| (r.t - 8.0).abs() * norm(d) < 1e-13 + 6.0 * rounding::<R>() * r.blur)
            .count();
        assert_eq!(near, 1, "{normal:?}: {verdict:?}");
        let expected = meet_sphere(origin, unit(d), centre, radius).0;
        let ahead = expected.iter().filter(|&&t| t > 1e-9).count();
        assert_eq!(verdict.roots.len(), ahead, "{normal:?} {verdict:?}");
        // A seam is no border, so a root on it is a safe one; a pole has no normal.
        judged += usize::from(n % 4 != 0 && verdict.margin > 1e-9);
    }
    assert!(judged > 2000 / fewer, "{judged}");
}

fn borders_and_corners_of_a_square_belong_to_it<R: Real>(_: usize) {
    let square = parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    for surface in [square.clone(), elevate(&square, 3, 3)] {
        let oracle = OracleIn::<R>::new(&single(surface));
        for (x, y) in [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.5, 1.0), (0.0, 0.3), (0.25, 0.5)] {
            let verdict = oracle.trace([x, y, 2.0], [0.0, 0.0, -0.5], 0.0, f64::INFINITY);
            let [root] = verdict.roots[..] else {
                panic!("{x} {y}: {verdict:?}");
            };
            assert!((root.t - 4.0).abs() < 1e-14);
            assert!((root.u - x).abs() < 1e-14 && (root.v - y).abs() < 1e-14);
            let border = x.min(y).min(1.0 - x).min(1.0 - y) / 2f64.sqrt();
            assert!(verdict.margin <= border + 1e-14, "{x} {y}: {verdict:?}");
        }
    }
}

fn the_range_of_t_selects<R: Real>(_: usize) {
    let oracle = OracleIn::<R>::new(&sphere([0.0; 3], 1.0));
    let (origin, d) = ([0.1, 0.2, 8.0], [0.0, 0.0, -2.0]);
    let count = |low, high| oracle.trace(origin, d, low, high).roots.len();
    assert_eq!(count(f64::NEG_INFINITY, f64::INFINITY), 2);
    assert_eq!(count(0.0, 4.0), 1);
    assert_eq!(count(4.0, 5.0), 1);
    assert_eq!(count(3.9, 4.1), 0);
    assert_eq!(count(5.0, f64::INFINITY), 0);
    assert_eq!(count(f64::INFINITY, 0.0), 0);
}

/// Moved aside by far less than its distance to the range's end, such a root passes it: an answer of `f32` was called lost that
/// lay a twentieth of its tolerance off.
fn a_root_at_a_shallow_angle_soon_leaves_the_range_of_t<R: Real>(_: usize) {
    let slope = 2f64.powi(-12);
    let oracle = OracleIn::<R>::new(&single(parallelogram([0.0; 3], [1.0, 0.0, slope], [0.0, 1.0, 0.0])));
    let (origin, d) = ([0.5, 0.5, slope * 0.5625], [1.0, 0.0, 0.0]);
    for (range, roots, distance) in [
        ([0.0, 0.03125], 0, 0.03125),
        ([0.125, 1.0], 0, 0.0625),
        ([0.0, 1.0], 1, 0.0625),
        ([-1.0, 0.078125], 1, 0.015625),
    ] {
        let verdict = oracle.trace(origin, d, range[0], range[1]);
        assert_eq!(verdict.roots.len(), roots, "{range:?}: {verdict:?}");
        let sideways = distance * slope / 2f64.sqrt();
        assert!((0.5 * sideways..1.0001 * sideways).contains(&verdict.margin), "{range:?}: {verdict:?}");
    }
}

fn doubled_surfaces_count_once<R: Real>(fewer: usize) {
    let mut model = sphere([0.0; 3], 1.0);
    let copy = model.surfaces.clone();
    model.surfaces.extend(copy);
    let oracle = OracleIn::<R>::new(&model);
    let mut random = Random(18);
    let mut tally = Tally::of::<R>();
    for _ in 0..1000 / fewer {
        let (origin, d) = toward(&mut random, [0.0; 3], 1.0);
        let (mut truth, clearance) = meet_sphere(origin, d, [0.0; 3], 1.0);
        truth.retain(|&t| t >= 0.0);
        let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
        tally.add("doubled", &verdict, &truth, 4.0, clearance.abs() > 1e-9);
    }
    tally.expect(0.99, 0.99, [0.4, 0.9]);
}

fn odd_input_ends_and_is_said_to_be_undecided<R: Real>(_: usize) {
    // All points one point: met or missed.
    let point = OracleIn::<R>::new(&single(parallelogram([1.0, 2.0, 3.0], [0.0; 3], [0.0; 3])));
    assert_eq!(point.trace([1.0, 2.0, 0.0], [0.0, 0.0, 1.0], 0.0, 9.0).roots.len(), 1);
    assert!(point.trace([1.0, 2.5, 0.0], [0.0, 0.0, 1.0], 0.0, 9.0).roots.is_empty());
    // Rays within the plane of a flat surface, with straight and with curved parameter lines.
    let flat = bumpy(3, [4, 4], [0.0; 3], 2.0, 0.0);
    for surface in [parallelogram([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]), flat] {
        let oracle = OracleIn::<R>::new(&single(surface));
        let verdict = oracle.trace([-3.0, 0.1, 0.0], [1.0, 0.05, 0.0], 0.0, f64::INFINITY);
        assert!(verdict.unresolved > 0 && verdict.margin == 0.0, "{:?}", verdict.margin);
        let above = oracle.trace([-3.0, 0.1, 1e-9], [1.0, 0.05, 0.0], 0.0, f64::INFINITY);
        assert!(above.unresolved == 0 && above.roots.is_empty() && above.margin > 1e-10);
    }
    // What is no ray, and what is no surface.
    let mut model = sphere([0.0; 3], 1.0);
    for d in [[0.0; 3], [f64::NAN; 3]] {
        let verdict = OracleIn::<R>::new(&model).trace([5.0; 3], d, 0.0, 1.0);
        assert_eq!((verdict.unresolved, verdict.margin), (1, 0.0));
    }
    model.surfaces[0].points[4][0] = f64::NAN;
    model.surfaces[1].points[4][3] = -1.0;
    model.surfaces[2].points.pop();
    let verdict = OracleIn::<R>::new(&model).trace([5.0; 3], [-1.0; 3], 0.0, 9.0);
    assert_eq!((verdict.unresolved, verdict.margin), (3, 0.0));
    let nothing = OracleIn::<R>::new(&Model::default()).trace([5.0; 3], [-1.0; 3], 0.0, 9.0);
    assert!(nothing.roots.is_empty() && nothing.unresolved == 0);
}

fn an_answer_outlasts_a_displacement_within_its_margin<R: Real>(fewer: usize) {
    let mut random = Random(19);
    let mut surfaces = sphere([0.0; 3], 1.0).surfaces;
    surfaces.extend((0..4).map(|k| bumpy(k, [3, 4], [0.4 * k as f64 - 0.6, 0.2, 0.0], 1.5, 1.5)));
    let model = Model { surfaces };
    let oracle = OracleIn::<R>::new(&model);
    let corner = |pick: fn(f64, f64) -> f64, k: usize| {
        let points = model.surfaces.iter().flat_map(|s| &s.points);
        points.map(|p| p[k]).reduce(pick).unwrap()
    };
    let diagonal = norm([0, 1, 2].map(|k| corner(f64::max, k) - corner(f64::min, k)));
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..4000 / fewer {
        let (origin, d) = toward(&mut random, [0.0; 3], 1.2);
        let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
        let moved = add(origin, 0.95 * verdict.margin * diagonal, tangent(&mut random, d));
        let other = oracle.trace(moved, d, 0.0, f64::INFINITY);
        assert_eq!(verdict.roots.is_empty(), other.roots.is_empty(), "{verdict:?} {other:?}");
        let (Some(a), Some(b)) = (verdict.roots.first(), other.roots.first()) else {
            misses += 1;
            continue;
        };
        hits += 1;
        // The closest root moved along its own sheet: its place on its surface, or its neighbour's, is near.
        let far = (a.u - b.u).abs().max((a.v - b.v).abs());
        assert!(a.surface != b.surface || far < 0.3, "{verdict:?} {other:?}");
        assert!(a.surface == b.surface || (a.surface < 8 && b.surface < 8), "{verdict:?} {other:?}");
    }
    assert!(hits > 1000 / fewer && misses > 500 / fewer, "{hits} {misses}");
}
