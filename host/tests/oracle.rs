//! The oracle against closed forms: planes, bilinear surfaces, spheres, cylinders, tori and a paraboloid.
//!
//! The equations are solved here without any Bézier surface. An answer counts where the oracle's margin says that it can
//! be judged; each test also says how many answers must be of that kind.

use patchray_host::oracle::{Oracle, Verdict};
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::shapes::{
    Random, bilinear, bumpy, cylinder, elevate, paraboloid, parallelogram, single, sphere, torus,
};

type Vector = [f64; 3];

/// The margin below which an answer cannot be judged.
const JUDGED: f64 = 1e-12;

fn add(a: Vector, s: f64, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + s * b[k])
}

fn sub(a: Vector, b: Vector) -> Vector {
    add(a, -1.0, b)
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

fn unit(a: Vector) -> Vector {
    a.map(|x| x / norm(a))
}

/// A random unit vector orthogonal to `n`.
fn tangent(random: &mut Random, n: Vector) -> Vector {
    unit(cross(n, random.point(1.0)))
}

/// The real roots of a x² + 2 b x + c, sorted, without cancellation.
fn quadratic(a: f64, b: f64, c: f64) -> Vec<f64> {
    // The discriminant by fused products, so that it is wrong by a rounding of its terms' difference only.
    let product = a * c;
    let discriminant = b.mul_add(b, -product) - a.mul_add(c, -product);
    if discriminant < 0.0 {
        return Vec::new();
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let mut roots = if q == 0.0 {
        vec![0.0, 0.0]
    } else {
        vec![q / a, c / q]
    };
    roots.retain(|r| r.is_finite());
    roots.sort_by(f64::total_cmp);
    roots
}

/// What a set of answers came to.
#[derive(Debug, Default)]
struct Tally {
    rays: usize,
    judged: usize,
    hits: usize,
    /// Answers of which every root was compared, not only the closest.
    complete: usize,
    worst: f64,
}

impl Tally {
    /// Compares a verdict on a ray with a direction of length 1 with the true roots, sorted. `complete` says that the
    /// number of true roots is beyond doubt.
    fn add(&mut self, what: &str, verdict: &Verdict, truth: &[f64], size: f64, complete: bool) {
        self.rays += 1;
        for pair in verdict.roots.windows(2) {
            assert!(
                pair[0].t < pair[1].t,
                "{what}: not sorted, or one root twice: {verdict:?}"
            );
        }
        let mut compare = |t: f64, root: &patchray_host::oracle::Root| {
            let error = (t - root.t).abs() / size;
            assert!(
                error <= 1e-14 + root.blur,
                "{what}: off by {error}: {verdict:?} {truth:?}"
            );
            // The blur is rounding over the cosine: large only near a silhouette.
            assert!(
                root.blur < 1e-10 || root.margin < 1e-7,
                "{what}: {verdict:?}"
            );
            self.worst = self.worst.max(error / root.blur);
        };
        if verdict.margin >= JUDGED {
            self.judged += 1;
            self.hits += usize::from(!truth.is_empty());
            assert_eq!(
                truth.is_empty(),
                verdict.roots.is_empty(),
                "{what}: {verdict:?} {truth:?}"
            );
            if let (Some(&t), Some(root)) = (truth.first(), verdict.roots.first()) {
                compare(t, root);
            }
        }
        if complete && verdict.unresolved == 0 && verdict.roots.iter().all(|r| r.margin >= JUDGED) {
            self.complete += 1;
            assert_eq!(
                truth.len(),
                verdict.roots.len(),
                "{what}: {verdict:?} {truth:?}"
            );
            for (&t, root) in truth.iter().zip(&verdict.roots) {
                compare(t, root);
            }
        }
    }

    /// Checks that the answers were of the kinds that the test is about: parts of all rays.
    fn expect(&self, judged: f64, complete: f64, hits: [f64; 2]) {
        let part = |n: usize| n as f64 / self.rays as f64;
        println!("{self:?}");
        assert!(part(self.judged) >= judged, "{self:?}");
        assert!(part(self.complete) >= complete, "{self:?}");
        assert!(
            part(self.hits) > hits[0] && part(self.hits) < hits[1],
            "{self:?}"
        );
    }
}

/// A ray from within a cube about `centre` toward a point near it; `size` is the shape's.
fn toward(random: &mut Random, centre: Vector, size: f64) -> (Vector, Vector) {
    let origin = add(centre, 3.0 * size, random.point(1.0));
    let target = add(centre, 1.5 * size, random.point(1.0));
    (origin, unit(sub(target, origin)))
}

/// The parameters where a ray with a direction of length 1 meets a sphere, and the distance from its silhouette.
fn meet_sphere(origin: Vector, d: Vector, centre: Vector, radius: f64) -> (Vec<f64>, f64) {
    let from = sub(origin, centre);
    let nearest = -dot(from, d);
    let foot = add(from, nearest, d);
    let distance = norm(foot);
    let half = (radius - distance) * (radius + distance);
    let roots = if half < 0.0 {
        Vec::new()
    } else {
        vec![nearest - half.sqrt(), nearest + half.sqrt()]
    };
    (roots, radius - distance)
}

#[test]
fn spheres_at_any_place_and_size() {
    let mut random = Random(11);
    for (centre, radius) in [
        ([0.5, -1.0, 2.0], 1.5),
        ([0.0; 3], 1e-6),
        ([3e5, -1e5, 2e5], 1e5),
    ] {
        let oracle = Oracle::new(&sphere(centre, radius));
        let diagonal = 12f64.sqrt() * radius;
        let mut tally = Tally::default();
        for _ in 0..4000 {
            let (origin, d) = toward(&mut random, centre, radius);
            let (mut truth, clearance) = meet_sphere(origin, d, centre, radius);
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            truth.retain(|&t| t >= 0.0);
            tally.add(
                "sphere",
                &verdict,
                &truth,
                diagonal,
                clearance.abs() > 1e-10 * radius,
            );
            let bound = clearance.abs() / diagonal;
            let ahead = dot(sub(centre, origin), d) > radius;
            assert!(
                !ahead || verdict.margin <= 1.01 * bound + 1e-14,
                "{verdict:?} {bound}"
            );
        }
        tally.expect(0.999, 0.99, [0.4, 0.9]);
    }
}

#[test]
fn rays_that_graze_a_sphere() {
    let mut random = Random(12);
    let (centre, radius) = ([0.5, -1.0, 2.0], 1.5);
    let oracle = Oracle::new(&sphere(centre, radius));
    let diagonal = 12f64.sqrt() * radius;
    for exponent in 1..=15 {
        let mut tally = Tally::default();
        let mut least: f64 = 1.0;
        for _ in 0..400 {
            let n = unit(random.point(1.0));
            let d = tangent(&mut random, n);
            let depth = 10f64.powi(-exponent) * random.within(-1.0, 1.0).signum();
            let origin = add(add(centre, radius + depth, n), -random.within(2.0, 5.0), d);
            let (truth, clearance) = meet_sphere(origin, d, centre, radius);
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            tally.add("graze", &verdict, &truth, diagonal, verdict.margin > JUDGED);
            let bound = clearance.abs() / diagonal;
            assert!(
                verdict.margin <= 1.01 * bound + 1e-14,
                "{verdict:?} {bound}"
            );
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

#[test]
fn a_cylinder_and_its_open_ends() {
    let mut random = Random(13);
    let (centre, radius, height) = ([-2.0, 1.0, 0.25], 0.75, 2.0);
    let oracle = Oracle::new(&cylinder(centre, radius, height));
    let mut tally = Tally::default();
    for _ in 0..6000 {
        let (origin, d) = toward(&mut random, centre, 1.0);
        let from = sub(origin, centre);
        let a = d[0] * d[0] + d[1] * d[1];
        // From the point nearest to the axis, where the equation has no linear term to lose digits to.
        let nearest = -(from[0] * d[0] + from[1] * d[1]) / a;
        let foot = add(from, nearest, d);
        let distance = foot[0].hypot(foot[1]);
        let c = (distance - radius) * (distance + radius);
        let linear = foot[0] * d[0] + foot[1] * d[1];
        let mut truth: Vec<f64> = quadratic(a, linear, c)
            .iter()
            .map(|s| nearest + s)
            .collect();
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
    let turns: Vec<f64> = if p < 0.0 {
        vec![-(-p / 6.0).sqrt(), (-p / 6.0).sqrt()]
    } else {
        Vec::new()
    };
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

#[test]
fn tori_of_any_number_of_arcs() {
    let mut random = Random(14);
    let (major, minor) = (2.0, 0.75);
    for (around, across) in [(4, 4), (3, 5), (6, 3)] {
        let oracle = Oracle::new(&torus([0.0; 3], major, minor, around, across));
        let mut tally = Tally::default();
        let mut four = 0;
        for n in 0..4000 {
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
        assert!(four > 100, "{four}");
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
        let plane = if (x[1] + x[3] * v).abs() > (y[1] + y[3] * v).abs() {
            x
        } else {
            y
        };
        let u = -(plane[0] + plane[2] * v) / (plane[1] + plane[3] * v);
        let outside = (u - 0.5).abs().max((v - 0.5).abs()) - 0.5;
        clear &= outside.abs() > 1e-9;
        if outside <= 0.0 {
            let point = [0, 1, 2].map(|k| {
                (1.0 - u) * ((1.0 - v) * p[k] + v * q[k]) + u * ((1.0 - v) * r[k] + v * s[k])
            });
            roots.push(dot(point, d));
        }
    }
    roots.retain(|&t| t >= 0.0);
    roots.sort_by(f64::total_cmp);
    (roots, clear)
}

#[test]
fn bilinear_surfaces_of_any_degree() {
    let mut random = Random(15);
    let mut two = 0;
    let mut tally = Tally::default();
    for n in 0..300 {
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
            .map(|(x, y)| add([x, y, 0.0], 1.4, random.point(1.0)));
        let surface = bilinear(corners);
        let degrees = [[1, 1], [3, 3], [2, 5], [1, 7]][n % 4];
        let oracle = Oracle::new(&single(elevate(&surface, degrees[0], degrees[1])));
        for _ in 0..20 {
            let (origin, d) = toward(&mut random, [0.0; 3], 1.0);
            let (truth, clear) = meet_bilinear(origin, d, corners);
            two += usize::from(truth.len() == 2);
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            tally.add("bilinear", &verdict, &truth, 3.0, clear);
        }
    }
    assert!(two > 20, "{two}");
    tally.expect(0.999, 0.99, [0.2, 0.8]);
}

#[test]
fn planes_of_any_degree_and_uneven_weights() {
    let mut random = Random(16);
    let (corner, along_u, along_v) = ([-1.0, -0.5, 0.25], [2.0, 0.5, 0.125], [-0.25, 1.5, 0.5]);
    let plane = parallelogram(corner, along_u, along_v);
    let mut heavy = elevate(&plane, 2, 3);
    heavy.rational = true;
    for (k, point) in heavy.points.iter_mut().enumerate() {
        point[3] = [1.0, 31.0, 0.04][k / 4] * [1.0, 25.0, 2.0, 0.5][k % 4];
    }
    let normal = cross(along_u, along_v);
    for surface in [
        plane.clone(),
        elevate(&plane, 1, 4),
        elevate(&plane, 15, 15),
        heavy,
    ] {
        let oracle = Oracle::new(&single(surface));
        let mut tally = Tally::default();
        for _ in 0..1000 {
            let (origin, d) = toward(&mut random, [0.0; 3], 1.0);
            let from = sub(corner, origin);
            let t = dot(from, normal) / dot(d, normal);
            let at = sub(add(origin, t, d), corner);
            // Parameters of the parallelogram, by Cramer's rule.
            let area = dot(normal, normal);
            let u = dot(cross(at, along_v), normal) / area;
            let v = dot(cross(along_u, at), normal) / area;
            let outside = (u - 0.5).abs().max((v - 0.5).abs()) - 0.5;
            let truth: Vec<f64> = if outside <= 0.0 && t >= 0.0 {
                vec![t]
            } else {
                vec![]
            };
            let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
            tally.add("plane", &verdict, &truth, 3.0, outside.abs() > 1e-9);
        }
        tally.expect(0.999, 0.99, [0.15, 0.8]);
    }
}

#[test]
fn a_paraboloid_just_above_and_below_its_apex() {
    let apex = [0.25, -0.5, 1.0];
    let oracle = Oracle::new(&single(paraboloid(apex, 1.0)));
    for exponent in 4..=11 {
        for (direction, offset) in [
            ([1.0, 0.0, 0.0], 0.0),
            ([0.6, 0.8, 0.0], 0.0),
            ([0.0, -1.0, 0.0], 0.125),
        ] {
            let height = offset * offset + 10f64.powi(-exponent);
            let origin = add(add(apex, -4.0, direction), offset, [1.0, 0.0, 0.0]);
            let raised = [origin[0], origin[1], origin[2] + height];
            let verdict = oracle.trace(raised, direction, 0.0, f64::INFINITY);
            assert_eq!(verdict.roots.len(), 2, "{exponent}: {verdict:?}");
            let half = 10f64.powf(-0.5 * exponent as f64);
            for (root, t) in verdict.roots.iter().zip([4.0 - half, 4.0 + half]) {
                assert!(
                    (root.t - t).abs() < 1e-15 / half + 1e-14,
                    "{exponent}: {verdict:?}"
                );
            }
            assert!(
                verdict.margin >= 1e-3 * 10f64.powi(-exponent),
                "{exponent}: {verdict:?}"
            );
            let height = offset * offset - 10f64.powi(-exponent);
            let lowered = [origin[0], origin[1], origin[2] + height];
            let verdict = oracle.trace(lowered, direction, 0.0, f64::INFINITY);
            assert!(
                verdict.roots.is_empty() && verdict.unresolved == 0,
                "{exponent}: {verdict:?}"
            );
            assert!(
                verdict.margin >= 1e-3 * 10f64.powi(-exponent),
                "{exponent}: {verdict:?}"
            );
        }
    }
    // The tangent itself is nothing that f64 can decide, and must be said to be.
    let verdict = oracle.trace([-4.0, -0.5, 1.0], [1.0, 0.0, 0.0], 0.0, f64::INFINITY);
    assert!(verdict.margin < JUDGED, "{verdict:?}");
    assert!(
        verdict.unresolved > 0 || !verdict.roots.is_empty(),
        "{verdict:?}"
    );
}

/// The graph z = Π (x - r_k) over the unit square, of one degree per root in u and `n` in v.
fn graph(roots: &[f64], n: usize) -> ModelSurface {
    let m = roots.len();
    // Bernstein coefficients of a product with x - r, one factor after the other.
    let mut c = vec![64.0];
    for &r in roots {
        let degree = c.len();
        let product = |i: usize| {
            let low = if i < degree {
                (degree - i) as f64 * -r * c[i]
            } else {
                0.0
            };
            let high = if i > 0 {
                i as f64 * (1.0 - r) * c[i - 1]
            } else {
                0.0
            };
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
    ModelSurface {
        degree_u: m,
        degree_v: n,
        rational: false,
        points,
    }
}

#[test]
fn many_roots_on_one_ray() {
    for (count, n) in [(2, 1), (5, 3), (9, 2), (15, 15)] {
        let roots: Vec<f64> = (0..count)
            .map(|k| (k as f64 + 0.5) / count as f64)
            .collect();
        let oracle = Oracle::new(&single(graph(&roots, n)));
        for scale in [1e-120, 1.0, 1e90] {
            let verdict = oracle.trace([-1.0, 0.3, 0.0], [scale, 0.0, 0.0], 0.0, f64::INFINITY);
            assert_eq!(verdict.roots.len(), count, "{verdict:?}");
            for (root, r) in verdict.roots.iter().zip(&roots) {
                // The high degrees have coefficients that cancel: the graph is as steep as its blur says.
                assert!(
                    (root.t * scale - 1.0 - r).abs() < 1e-14 + 2.0 * root.blur,
                    "{verdict:?}"
                );
                assert!((root.u - r).abs() < 1e-9 && (root.v - 0.3).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn poles_seams_and_corners_of_a_sphere_are_met_once() {
    let mut random = Random(17);
    let (centre, radius) = ([0.5, -1.0, 2.0], 1.5);
    let oracle = Oracle::new(&sphere(centre, radius));
    let mut judged = 0;
    for n in 0..3000 {
        let a = random.within(-3.0, 3.0);
        let (sin, cos) = a.sin_cos();
        let normal = match n % 4 {
            0 => [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]][n % 8 / 4],
            1 => [
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [-1.0, 0.0, 0.0],
                [0.0, -1.0, 0.0],
            ][n / 4 % 4],
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
            .filter(|r| (r.t - 8.0).abs() * norm(d) < 1e-13 + 6.0 * r.blur)
            .count();
        assert_eq!(near, 1, "{normal:?}: {verdict:?}");
        let expected = meet_sphere(origin, unit(d), centre, radius).0;
        let ahead = expected.iter().filter(|&&t| t > 1e-9).count();
        assert_eq!(verdict.roots.len(), ahead, "{normal:?} {verdict:?}");
        // A seam is no border, so a root on it is a safe one; a pole has no normal.
        judged += usize::from(n % 4 != 0 && verdict.margin > 1e-9);
    }
    assert!(judged > 2000, "{judged}");
}

#[test]
fn borders_and_corners_of_a_square_belong_to_it() {
    let square = parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    for surface in [square.clone(), elevate(&square, 3, 3)] {
        let oracle = Oracle::new(&single(surface));
        for (x, y) in [
            (0.0, 0.0),
            (1.0, 1.0),
            (1.0, 0.0),
            (0.5, 1.0),
            (0.0, 0.3),
            (0.25, 0.5),
        ] {
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

#[test]
fn the_range_of_t_selects() {
    let oracle = Oracle::new(&sphere([0.0; 3], 1.0));
    let (origin, d) = ([0.1, 0.2, 8.0], [0.0, 0.0, -2.0]);
    let count = |low, high| oracle.trace(origin, d, low, high).roots.len();
    assert_eq!(count(f64::NEG_INFINITY, f64::INFINITY), 2);
    assert_eq!(count(0.0, 4.0), 1);
    assert_eq!(count(4.0, 5.0), 1);
    assert_eq!(count(3.9, 4.1), 0);
    assert_eq!(count(5.0, f64::INFINITY), 0);
    assert_eq!(count(f64::INFINITY, 0.0), 0);
}

#[test]
fn doubled_surfaces_count_once() {
    let mut model = sphere([0.0; 3], 1.0);
    let copy = model.surfaces.clone();
    model.surfaces.extend(copy);
    let oracle = Oracle::new(&model);
    let mut random = Random(18);
    let mut tally = Tally::default();
    for _ in 0..1000 {
        let (origin, d) = toward(&mut random, [0.0; 3], 1.0);
        let (mut truth, clearance) = meet_sphere(origin, d, [0.0; 3], 1.0);
        truth.retain(|&t| t >= 0.0);
        let verdict = oracle.trace(origin, d, 0.0, f64::INFINITY);
        tally.add("doubled", &verdict, &truth, 4.0, clearance.abs() > 1e-9);
    }
    tally.expect(0.99, 0.99, [0.4, 0.9]);
}

#[test]
fn odd_input_ends_and_is_said_to_be_undecided() {
    // All points one point: met or missed.
    let point = Oracle::new(&single(parallelogram([1.0, 2.0, 3.0], [0.0; 3], [0.0; 3])));
    assert_eq!(
        point
            .trace([1.0, 2.0, 0.0], [0.0, 0.0, 1.0], 0.0, 9.0)
            .roots
            .len(),
        1
    );
    assert!(
        point
            .trace([1.0, 2.5, 0.0], [0.0, 0.0, 1.0], 0.0, 9.0)
            .roots
            .is_empty()
    );
    // Rays within the plane of a flat surface, with straight and with curved parameter lines.
    let flat = bumpy(3, [4, 4], [0.0; 3], 2.0, 0.0);
    for surface in [
        parallelogram([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]),
        flat,
    ] {
        let oracle = Oracle::new(&single(surface));
        let verdict = oracle.trace([-3.0, 0.1, 0.0], [1.0, 0.05, 0.0], 0.0, f64::INFINITY);
        assert!(
            verdict.unresolved > 0 && verdict.margin == 0.0,
            "{:?}",
            verdict.margin
        );
        let above = oracle.trace([-3.0, 0.1, 1e-9], [1.0, 0.05, 0.0], 0.0, f64::INFINITY);
        assert!(above.unresolved == 0 && above.roots.is_empty() && above.margin > 1e-10);
    }
    // What is no ray, and what is no surface.
    let mut model = sphere([0.0; 3], 1.0);
    for d in [[0.0; 3], [f64::NAN; 3]] {
        let verdict = Oracle::new(&model).trace([5.0; 3], d, 0.0, 1.0);
        assert_eq!((verdict.unresolved, verdict.margin), (1, 0.0));
    }
    model.surfaces[0].points[4][0] = f64::NAN;
    model.surfaces[1].points[4][3] = -1.0;
    model.surfaces[2].points.pop();
    let verdict = Oracle::new(&model).trace([5.0; 3], [-1.0; 3], 0.0, 9.0);
    assert_eq!((verdict.unresolved, verdict.margin), (3, 0.0));
    let nothing = Oracle::new(&Model::default()).trace([5.0; 3], [-1.0; 3], 0.0, 9.0);
    assert!(nothing.roots.is_empty() && nothing.unresolved == 0);
}
