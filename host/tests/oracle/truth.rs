//! What the tests share: vectors, the sphere's equation, and the comparison of a verdict with the true roots.

use patchray_host::oracle::{Real, Verdict};
use patchray_host::scene::shapes::Random;

pub(crate) type Vector = [f64; 3];

/// The margin below which an answer cannot be judged by what is solved in f64.
pub(crate) const JUDGED: f64 = <f64 as Real>::LEAST_MARGIN;

pub(crate) fn add(a: Vector, s: f64, b: Vector) -> Vector {
    [0, 1, 2].map(|k| a[k] + s * b[k])
}

pub(crate) fn sub(a: Vector, b: Vector) -> Vector {
    add(a, -1.0, b)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn unit(a: Vector) -> Vector {
    a.map(|x| x / norm(a))
}

/// A random unit vector orthogonal to `n`.
pub(crate) fn tangent(random: &mut Random, n: Vector) -> Vector {
    unit(cross(n, random.point(1.0)))
}

/// The real roots of a x² + 2 b x + c, sorted, without cancellation.
pub(crate) fn quadratic(a: f64, b: f64, c: f64) -> Vec<f64> {
    // The discriminant by fused products, so that it is wrong by a rounding of its terms' difference only.
    let product = a * c;
    let discriminant = b.mul_add(b, -product) - a.mul_add(c, -product);
    if discriminant < 0.0 {
        return Vec::new();
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let mut roots = if q == 0.0 { vec![0.0, 0.0] } else { vec![q / a, c / q] };
    roots.retain(|r| r.is_finite());
    roots.sort_by(f64::total_cmp);
    roots
}

/// How many times a blur in `R` is one in f64: control points and what is solved here are rounded to f64.
pub(crate) fn rounding<R: Real>() -> f64 {
    f64::EPSILON / R::EPS
}

/// What a set of answers came to.
#[derive(Debug)]
pub(crate) struct Tally {
    /// As [`rounding`].
    pub(crate) rounding: f64,
    pub(crate) rays: usize,
    pub(crate) judged: usize,
    pub(crate) hits: usize,
    /// Answers of which every root was compared, not only the closest.
    pub(crate) complete: usize,
    pub(crate) worst: f64,
}

impl Tally {
    /// Of no answers yet, of an oracle in `R`.
    pub(crate) fn of<R: Real>() -> Tally {
        Tally { rounding: rounding::<R>(), rays: 0, judged: 0, hits: 0, complete: 0, worst: 0.0 }
    }

    /// Compares a verdict on a ray with a direction of length 1 with the true roots, sorted. `complete` says that the
    /// number of true roots is beyond doubt.
    pub(crate) fn add(&mut self, what: &str, verdict: &Verdict, truth: &[f64], size: f64, complete: bool) {
        self.rays += 1;
        for pair in verdict.roots.windows(2) {
            assert!(pair[0].t < pair[1].t, "{what}: not sorted, or one root twice: {verdict:?}");
        }
        let mut compare = |t: f64, root: &patchray_host::oracle::Root| {
            let error = (t - root.t).abs() / size;
            let blur = self.rounding * root.blur;
            assert!(error <= 1e-14 + blur, "{what}: off by {error}: {verdict:?} {truth:?}");
            // The blur is rounding over the cosine: large only near a silhouette.
            assert!(blur < 1e-10 || root.margin < 1e-7, "{what}: {verdict:?}");
            self.worst = self.worst.max(error / blur);
        };
        if verdict.margin >= JUDGED {
            self.judged += 1;
            self.hits += usize::from(!truth.is_empty());
            assert_eq!(truth.is_empty(), verdict.roots.is_empty(), "{what}: {verdict:?} {truth:?}");
            if let (Some(&t), Some(root)) = (truth.first(), verdict.roots.first()) {
                compare(t, root);
            }
        }
        if complete && verdict.unresolved == 0 && verdict.roots.iter().all(|r| r.margin >= JUDGED) {
            self.complete += 1;
            assert_eq!(truth.len(), verdict.roots.len(), "{what}: {verdict:?} {truth:?}");
            for (&t, root) in truth.iter().zip(&verdict.roots) {
                compare(t, root);
            }
        }
    }

    /// Checks that the answers were of the kinds that the test is about: parts of all rays.
    pub(crate) fn expect(&self, judged: f64, complete: f64, hits: [f64; 2]) {
        let part = |n: usize| n as f64 / self.rays as f64;
        println!("{self:?}");
        assert!(part(self.judged) >= judged, "{self:?}");
        assert!(part(self.complete) >= complete, "{self:?}");
        assert!(part(self.hits) > hits[0] && part(self.hits) < hits[1], "{self:?}");
    }
}

/// A ray from within a cube about `centre` toward a point near it; `size` is the shape's.
pub(crate) fn toward(random: &mut Random, centre: Vector, size: f64) -> (Vector, Vector) {
    let origin = add(centre, 3.0 * size, random.point(1.0));
    let target = add(centre, 1.5 * size, random.point(1.0));
    (origin, unit(sub(target, origin)))
}

/// The parameters where a ray with a direction of length 1 meets a sphere, and the distance from its silhouette.
pub(crate) fn meet_sphere(origin: Vector, d: Vector, centre: Vector, radius: f64) -> (Vec<f64>, f64) {
    let from = sub(origin, centre);
    let nearest = -dot(from, d);
    let foot = add(from, nearest, d);
    let distance = norm(foot);
    let half = (radius - distance) * (radius + distance);
    let roots = if half < 0.0 { Vec::new() } else { vec![nearest - half.sqrt(), nearest + half.sqrt()] };
    (roots, radius - distance)
}
