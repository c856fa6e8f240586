//! Thousands of random rays against spheres, cylinders, tori, bilinear surfaces and planes.

use crate::truth::*;
use patchray_host::oracle::{OracleIn, Real};
use patchray_host::scene::shapes::{Random, bilinear, cylinder, elevate, parallelogram, single, sphere, torus};

in_either!(
    spheres_at_any_place_and_size
    rays_that_graze_a_sphere
    a_cylinder_and_its_open_ends
    tori_of_any_number_of_arcs
    bilinear_surfaces_of_any_degree
    planes_of_any_degree_and_uneven_weights
);

fn spheres_at_any_place_and_size<R: Real>(fewer: usize) {
    let mut random = Random(11);
    for (centre, radius) in [([0.5, -1.0, 2.0], 1.5), ([0.0; 3], 1e-6), ([3e5, -1e5, 2e5], 1e5)] {
        let oracle = OracleIn::<R>::new(&sphere(centre, radius));
        let diagonal = 12f64.sqrt() * radius;
        let mut tally = Tally::of::<R>();
        for _ in 0..4000 / fewer {
            let (origin, d) = toward(&mut random, centre, radius);
            let (mut truth, clearance) = meet_sphere(origin, d, centre, radius);
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            truth.retain(|&t| t >= 0.0);
            tally.add("sphere", &verdict, &truth, diagonal, clearance.abs() > 1e-10 * radius);
            let bound = clearance.abs() / diagonal;
            let ahead = dot(sub(centre, origin), d) > radius;
            assert!(!ahead || verdict.margin <= 1.01 * bound + 1e-14, "{verdict:?} {bound}");
        }
        tally.expect(0.999, 0.99, [0.4, 0.9]);
    }
}

fn rays_that_graze_a_sphere<R: Real>(fewer: usize) {
    let mut random = Random(12);
    let (centre, radius) = ([0.5, -1.0, 2.0], 1.5);
    let oracle = OracleIn::<R>::new(&sphere(centre, radius));
    let diagonal = 12f64.sqrt() * radius;
    for exponent in 1..=15 {
        let mut tally = Tally::of::<R>();
        let mut least: f64 = 1.0;
        for _ in 0..400 / fewer {
            let n = unit(random.point(1.0));
            let d = tangent(&mut random, n);
            let depth = 10f64.powi(-exponent) * random.within(-1.0, 1.0).signum();
            let origin = add(add(centre, radius + depth, n), -random.within(2.0, 5.0), d);
            let (truth, clearance) = meet_sphere(origin, d, centre, radius);
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            tally.add("graze", &verdict, &truth, diagonal, verdict.margin > JUDGED);
            let bound = clearance.abs() / diagonal;
            assert!(verdict.margin <= 1.01 * bound + 1e-14, "{verdict:?} {bound}");
            least = least.min(verdict.margin / bound);
            if truth.is_empty() && verdict.roots.is_empty() {
                continue;
            }
            // Nothing is dropped: what is hit is a root, or cannot be decided.
            assert!(!verdict.roots.is_empty() || verdict.unresolved > 0 || verdict.margin < JUDGED);
        }
        println!("{exponent}: least margin {least} of the truth; {tally:?}");
        if exponent <= 9 {
            tally.expect(0.99, 0.99, [0.4, 0.6]);
        }
    }
}

fn a_cylinder_and_its_open_ends<R: Real>(fewer: usize) {
    let mut random = Random(13);
    let (centre, radius, height) = ([-2.0, 1.0, 0.25], 0.75, 2.0);
    let oracle = OracleIn::<R>::new(&cylinder(centre, radius, height));
    let mut tally = Tally::of::<R>();
    for _ in 0..6000 / fewer {
        let (origin, d) = toward(&mut random, centre, 1.0);
        let from = sub(origin, centre);
        let a = d[0] * d[0] + d[1] * d[1];
        // From the point nearest to the axis, where the equation has no linear term to lose digits to.
        let nearest = -(from[0] * d[0] + from[1] * d[1]) / a;
        let foot = add(from, nearest, d);
        let distance = foot[0].hypot(foot[1]);
        let c = (distance - radius) * (distance + radius);
        let linear = foot[0] * d[0] + foot[1] * d[1];
        let mut truth: Vec<f64> = quadratic(a, linear, c).iter().map(|s| nearest + s).collect();
        let mut complete = c.abs() > 1e-9;
        truth.retain(|&t| {
            let z = (from[2] + t * d[2]).abs() - 0.5 * height;
            complete &= z.abs() > 1e-9;
            t >= 0.0 && z <= 0.0
        });
        let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
        tally.add("cylinder", &verdict, &truth, 3.0, complete);
    }
    tally.expect(0.999, 0.99, [0.3, 0.9]);
}

/// The parameters where a ray with a direction of length 1 meets a torus about the vertical axis through 0, and whether
/// their number is beyond doubt: the equation's extrema are found one derivative after the other and its roots by
/// bisection between them.
fn meet_torus(origin: Vector, d: Vector, major: f64, minor: f64) -> (Vec<f64>, bool) {
    let nearest = -dot(origin, d);
    let o = add(origin, nearest, d);
    // (s² + k)² = 4 R² ((o_x + s d_x)² + (o_y + s d_y)²), halved derivatives.
    let k = dot(o, o) + major * major - minor * minor;
    let p = 2.0 * k - 4.0 * major * major * (d[0] * d[0] + d[1] * d[1]);
    let q = -8.0 * major * major * (o[0] * d[0] + o[1] * d[1]);
    let reach = 2.0 * (major + minor);
    let slope = |s: f64| 4.0 * s * s * s + 2.0 * p * s + q;
    let turns: Vec<f64> = if p < 0.0 { vec![-(-p / 6.0).sqrt(), (-p / 6.0).sqrt()] } else { Vec::new() };
    let extrema = bisect(&turns, reach, slope);
    let distance = |s: f64| {
        let [x, y, z] = add(o, s, d);
        (x.hypot(y) - major).hypot(z) - minor
    };
    let clear = extrema.iter().all(|&s| distance(s).abs() > 1e-10);
    let roots = bisect(&extrema, reach, distance);
    (roots.iter().map(|s| nearest + s).collect(), clear)
}

/// The roots of `f` on [-reach, reach], at most one between neighbours of `turns`, which are sorted.
fn bisect(turns: &[f64], reach: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut ends = vec![-reach];
    ends.extend(turns.iter().filter(|t| t.abs() < reach));
    ends.push(reach);
    let mut roots = Vec::new();
    for pair in ends.windows(2) {
        let [mut low, mut high] = [pair[0], pair[1]];
        let sign = f(low) < 0.0;
        if sign == (f(high) < 0.0) {
            continue;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if (f(middle) < 0.0) == sign {
                low = middle;
            } else {
                high = middle;
            }
        }
        roots.push(0.5 * (low + high));
    }
    roots
}

fn tori_of_any_number_of_arcs<R: Real>(fewer: usize) {
    let mut random = Random(14);
    let (major, minor) = (2.0, 0.75);
    for (around, across) in [(4, 4), (3, 5), (6, 3)] {
        let oracle = OracleIn::<R>::new(&torus([0.0; 3], major, minor, around, across));
        let mut tally = Tally::of::<R>();
        let mut four = 0;
        for n in 0..4000 / fewer {
            let (origin, d) = if n % 2 == 0 {
                toward(&mut random, [0.0; 3], 2.5)
            } else {
                // A tangent at a random point, moved off it by 1e-1 to 1e-12.
                let (a, b) = (random.within(0.0, 6.3), random.within(0.0, 6.3));
                let normal = [a.cos() * b.cos(), a.sin() * b.cos(), b.sin()];
                let on = add([major * a.cos(), major * a.sin(), 0.0], minor, normal);
                let d = tangent(&mut random, normal);
                let off = 10f64.powf(-random.within(1.0, 12.0)) * random.within(-1.0, 1.0).signum();
                (add(add(on, off, normal), -8.0, d), d)
            };
            let (mut truth, clear) = meet_torus(origin, d, major, minor);
            truth.retain(|&t| t >= 0.0);
            four += usize::from(truth.len() == 4);
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            tally.add("torus", &verdict, &truth, 8.0, clear);
        }
        assert!(four > 100 / fewer, "{four}");
        tally.expect(0.9, 0.85, [0.4, 0.95]);
    }
}

/// The parameters where a ray meets a bilinear surface within its borders, and how near any (u, v) is to a border.
fn meet_bilinear(origin: Vector, d: Vector, corners: [Vector; 4]) -> (Vec<f64>, bool) {
    let [p, q, r, s] = corners.map(|c| sub(c, origin));
    let first = unit(cross(d, [0.3, -0.4, 0.86]));
    let normals = [first, cross(d, first)];
    // a + b u + c v + e u v = 0 in either plane.
    let [x, y] = normals.map(|n| {
        let [p, q, r, s] = [p, q, r, s].map(|c| dot(n, c));
        [p, r - p, q - p, (s - r) - (q - p)]
    });
    let a = x[2] * y[3] - y[2] * x[3];
    let b = x[0] * y[3] + x[2] * y[1] - y[0] * x[3] - y[2] * x[1];
    let c = x[0] * y[1] - y[0] * x[1];
    let mut clear = (b * b - 4.0 * a * c).abs() > 1e-9;
    let mut roots = Vec::new();
    for v in quadratic(a, 0.5 * b, c) {
        let plane = if (x[1] + x[3] * v).abs() > (y[1] + y[3] * v).abs() { x } else { y };
        let u = -(plane[0] + plane[2] * v) / (plane[1] + plane[3] * v);
        let outside = (u - 0.5).abs().max((v - 0.5).abs()) - 0.5;
        clear &= outside.abs() > 1e-9;
        if outside <= 0.0 {
            let point =
                [0, 1, 2].map(|k| (1.0 - u) * ((1.0 - v) * p[k] + v * q[k]) + u * ((1.0 - v) * r[k] + v * s[k]));
            roots.push(dot(point, d));
        }
    }
    roots.retain(|&t| t >= 0.0);
    roots.sort_by(f64::total_cmp);
    (roots, clear)
}

fn bilinear_surfaces_of_any_degree<R: Real>(fewer: usize) {
    let mut random = Random(15);
    let mut two = 0;
    let mut tally = Tally::of::<R>();
    for n in 0..300 / fewer {
        let corners =
            [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| add([x, y, 0.0], 1.4, random.point(1.0)));
        let surface = bilinear(corners);
        let degrees = [[1, 1], [3, 3], [2, 5], [1, 7]][n % 4];
        let oracle = OracleIn::<R>::new(&single(elevate(&surface, degrees[0], degrees[1])));
        for _ in 0..20 {
            let (origin, d) = toward(&mut random, [0.0; 3], 1.0);
            let (truth, clear) = meet_bilinear(origin, d, corners);
            two += usize::from(truth.len() == 2);
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            tally.add("bilinear", &verdict, &truth, 3.0, clear);
        }
    }
    assert!(two > 20 / fewer, "{two}");
    tally.expect(0.999, 0.99, [0.2, 0.8]);
}

fn planes_of_any_degree_and_uneven_weights<R: Real>(fewer: usize) {
    let mut random = Random(16);
    let (corner, along_u, along_v) = ([-1.0, -0.5, 0.25], [2.0, 0.5, 0.125], [-0.25, 1.5, 0.5]);
    let plane = parallelogram(corner, along_u, along_v);
    let mut heavy = elevate(&plane, 2, 3);
    heavy.rational = true;
    for (k, point) in heavy.points.iter_mut().enumerate() {
        point[3] = [1.0, 31.0, 0.04][k / 4] * [1.0, 25.0, 2.0, 0.5][k % 4];
    }
    let normal = cross(along_u, along_v);
    for surface in [plane.clone(), elevate(&plane, 1, 4), elevate(&plane, 15, 15), heavy] {
        let oracle = OracleIn::<R>::new(&single(surface));
        let mut tally = Tally::of::<R>();
        for _ in 0..1000 / fewer {
            let (origin, d) = toward(&mut random, [0.0; 3], 1.0);
            let from = sub(corner, origin);
            let t = dot(from, normal) / dot(d, normal);
            let at = sub(add(origin, t, d), corner);
            // Parameters of the parallelogram, by Cramer's rule.
            let area = dot(normal, normal);
            let u = dot(cross(at, along_v), normal) / area;
            let v = dot(cross(along_u, at), normal) / area;
            let outside = (u - 0.5).abs().max((v - 0.5).abs()) - 0.5;
            let truth: Vec<f64> = if outside <= 0.0 && t >= 0.0 { vec![t] } else { vec![] };
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            tally.add("plane", &verdict, &truth, 3.0, outside.abs() > 1e-9);
        }
        tally.expect(0.999, 0.99, [0.15, 0.8]);
    }
}
