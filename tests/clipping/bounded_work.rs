//! The rays that clipping cannot part from the surface: in it, tangent to it, through its poles. Each call ends within its
//! budgets, and says hit, miss or which budget ran out, whichever is true.

use crate::ask::{Answers, Most, Query, Room, ask};
use crate::common::{Built, Kind, add, cross, is_rational, norm};
use crate::shapes::{askew, mapped};
use patchray::limits::Limits;
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::shapes::roots::product;
use patchray_host::scene::shapes::{Random, bumpy, cylinder, elevate, net, paraboloid, parallelogram, single, sphere};

/// All rays on one model; the answers, and the most work.
fn run<P: Kind>(name: &str, model: &Model, queries: &[Query], clip_steps: u32) -> Vec<Answers<P::Scalar>> {
    let built = Built::<P>::new(model, 1.0);
    let mut room = Room::<P>::new();
    let mut most = Most::default();
    let limits = Limits { clip_steps, ..Default::default() };
    let answers = queries.iter().map(|query| {
        let answers = ask(&built, query, &limits, &mut room);
        most.add(&answers);
        answers
    });
    let answers = answers.collect();
    let kind = if P::Scalar::EPSILON.to_f64() < 1e-10 { "f64" } else { "f32" };
    println!("{name} {kind}: {most:?}");
    answers
}

/// As `run`, with the points that the model needs.
fn run_any<S: Scalar>(name: &str, model: &Model, queries: &[Query], clip_steps: u32) -> Vec<Answers<S>>
where
    Plain<S>: Kind<Scalar = S>,
    Weighted<S>: Kind<Scalar = S>,
{
    if is_rational(model) {
        run::<Weighted<S>>(name, model, queries, clip_steps)
    } else {
        run::<Plain<S>>(name, model, queries, clip_steps)
    }
}

/// Whether this is a miss.
fn missed<S: Scalar>(answers: &Answers<S>) -> bool {
    answers.all.is_ok() && answers.hits.is_empty()
}

/// Flat in z = 0: over the unit square, along the axes or askew, of several degrees, with curved parameter lines too.
fn flat_surfaces() -> Vec<(&'static str, ModelSurface)> {
    let square = parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let skew = parallelogram([-0.25, -0.5, 0.0], [1.5, 0.5, 0.0], [0.25, 1.5, 0.0]);
    let curved = bumpy(41, [3, 3], [0.5, 0.5, 0.0], 1.5, 0.0);
    vec![
        ("square", square.clone()),
        ("square 3 x 3", elevate(&square, 3, 3)),
        ("square 7 x 7", elevate(&square, 7, 7)),
        ("skew", skew.clone()),
        ("skew 2 x 3", elevate(&skew, 2, 3)),
        ("curved lines", curved),
    ]
}

#[test]
fn a_ray_in_a_flat_surface_is_no_miss() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
        Weighted<S>: Kind<Scalar = S>,
    {
        for (name, surface) in flat_surfaces() {
            for slanted in [false, true] {
                let model = single(surface.clone());
                let model = if slanted { mapped(&model, askew) } else { model };
                let map = |v: [f64; 3]| if slanted { askew(v) } else { v };
                let mut queries = vec![];
                for d in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, -0.375, 0.0], [0.25, 1.5, 0.0]] {
                    for distance in [-2.0, 0.0, 0.125] {
                        let query = Query::new(map(add([0.5, 0.375, 0.0], distance, d)), map(d));
                        queries.push(query);
                        queries.push(Query { range: [0.0625, 4.0], ..query });
                    }
                }
                let name = format!("in a flat surface: {name}, slanted {slanted}");
                for (query, answers) in queries.iter().zip(run_any::<S>(&name, &model, &queries, 2000)) {
                    assert!(!missed(&answers), "{name} {query:?} {answers:?}");
                }
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn a_ray_along_a_ruling() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
        Weighted<S>: Kind<Scalar = S>,
    {
        let model = cylinder([0.0; 3], 1.0, 2.0);
        let mut queries = vec![];
        for [x, y] in [[1.0, 0.0], [0.0, -1.0], [0.6, 0.8], [-0.28, 0.96], [0.5, 0.75_f64.sqrt()]] {
            for z in [-3.0, 0.0, 0.5] {
                queries.push(Query::new([x, y, z], [0.0, 0.0, 1.0]).exact());
                for off in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15] {
                    for by in [1.0 - off, 1.0 + off] {
                        queries.push(Query::new([x * by, y * by, z], [0.0, 0.0, 1.0]));
                    }
                }
            }
        }
        let tolerance = Limits::<S>::default().tolerance.to_f64();
        for (query, answers) in queries.iter().zip(run_any::<S>("along a ruling", &model, &queries, 1000)) {
            let distance = query.origin[0].hypot(query.origin[1]) - 1.0;
            if distance.abs() > 1e3 * tolerance {
                assert!(missed(&answers), "{query:?} {answers:?}");
            } else if distance == 0.0 && query.origin[0] * query.origin[1] == 0.0 {
                // On the ruling to the last bit; also from inside it, when its first part lies before the ray's interval.
                assert!(!missed(&answers), "{query:?}");
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn a_tangent_of_a_paraboloid() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
        Weighted<S>: Kind<Scalar = S>,
    {
        let tolerance = Limits::<S>::default().tolerance.to_f64();
        for (name, base) in [
            ("biquadratic", paraboloid([0.0; 3], 1.0)),
            ("bicubic", elevate(&paraboloid([0.0; 3], 1.0), 3, 3)),
            ("7 x 4", elevate(&paraboloid([0.0; 3], 1.0), 7, 4)),
        ] {
            let mut queries = vec![];
            let mut heights = vec![];
            for y in [0.0, 0.25, -0.3125, 0.109375] {
                for exponent in 3..=14 {
                    for side in [-1.0, 0.0, 1.0] {
                        let height = side * 10.0_f64.powi(-exponent);
                        heights.push(height);
                        queries.push(Query::new([-2.0, y, y * y + height], [1.0, 0.0, 0.0]));
                    }
                }
            }
            let answers = run_any::<S>(&format!("tangent of a paraboloid {name}"), &single(base), &queries, 1000);
            for ((query, height), answers) in queries.iter().zip(&heights).zip(&answers) {
                let t: Vec<_> = answers.hits.iter().map(|hit| hit.t.to_f64()).collect();
                // What rounding may have done to a net of these degrees.
                let near = 540.0 * S::EPSILON.to_f64();
                let ok = answers.all.is_ok()
                    && if *height > near {
                        let half = height.sqrt();
                        let off = 8.0 * tolerance / half;
                        t.len() == 2 && (t[0] - 2.0 + half).abs() <= off && (t[1] - 2.0 - half).abs() <= off
                    } else if *height < -near {
                        t.is_empty()
                    } else {
                        // Too near to tell: a pair, or one.
                        t.len() <= 2 && t.iter().all(|t| (t - 2.0).abs() < 4.0 * near.sqrt())
                    };
                assert!(ok, "{name} height {height:e}: {:?} {t:?} {query:?}", answers.all);
                assert!(*height != 0.0 || !t.is_empty(), "{name}: {query:?}");
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn a_tangent_of_a_sphere() {
    fn check<S: Scalar>()
    where
        Weighted<S>: Kind<Scalar = S>,
        Plain<S>: Kind<Scalar = S>,
    {
        let tolerance = Limits::<S>::default().tolerance.to_f64();
        let mut random = Random(43);
        let (mut queries, mut depths) = (vec![], vec![]);
        for exponent in 3..=14 {
            for side in [-1.0, 1.0] {
                for k in 0..40 {
                    // Tangent in a plane across an axis or anywhere; at random, and on the seams.
                    let n = match k % 4 {
                        0 => [1.0, 0.0, 0.0],
                        1 => [0.6, 0.0, 0.8],
                        _ => {
                            let p = random.point(1.0);
                            p.map(|c| c / norm(p))
                        }
                    };
                    let along = cross(n, random.point(1.0));
                    let along = along.map(|c| c / norm(along));
                    let depth = side * 10.0_f64.powi(-exponent);
                    depths.push(depth);
                    queries.push(Query::new(add(n.map(|c| c * (1.0 - depth)), -3.0, along), along));
                }
            }
        }
        let answers = run_any::<S>("tangent of a sphere", &sphere([0.0; 3], 1.0), &queries, 20_000);
        for ((query, depth), answers) in queries.iter().zip(&depths).zip(&answers) {
            let t: Vec<_> = answers.hits.iter().map(|hit| hit.t.to_f64()).collect();
            let near = 64.0 * tolerance;
            let half = (2.0 * depth - depth * depth).sqrt();
            let off = 32.0 * tolerance / half;
            let ok = answers.all.is_ok()
                && if *depth > near {
                    !t.is_empty()
                        && t.iter().all(|t| ((t - 3.0).abs() - half).abs() <= off)
                        && t.iter().any(|t| *t < 3.0)
                        && t.iter().any(|t| *t > 3.0)
                } else if *depth < -near {
                    t.is_empty()
                } else {
                    t.iter().all(|t| (t - 3.0).abs() < 4.0 * near.sqrt())
                };
            assert!(ok, "depth {depth:e}: {:?} {:?} {query:?}", answers.all, answers.hits);
        }
    }
    check::<f64>();
    check::<f32>();
}

/// z = (2u − 1)^k over a square, along x: contact of order k.
#[test]
fn contact_of_higher_order() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
        Weighted<S>: Kind<Scalar = S>,
    {
        for k in 2..=7_usize {
            let c = product(&vec![0.5; k]);
            let model = single(net(k, 2, |i, j| [i as f64 / k as f64 - 0.5, j as f64 / 2.0, c[i]]));
            let mut queries = vec![];
            for exponent in 3..=14 {
                for side in [-1.0, 0.0, 1.0] {
                    let height = side * 10.0_f64.powi(-exponent);
                    for y in [0.5, 0.3] {
                        queries.push(Query::new([-2.0, y, height], [1.0, 0.0, 0.0]));
                    }
                }
            }
            let name = format!("contact of order {k}");
            for (query, answers) in queries.iter().zip(run_any::<S>(&name, &model, &queries, 1000)) {
                let height = query.origin[2];
                let far = height.abs() > 64.0 * Limits::<S>::default().tolerance.to_f64();
                let roots = match (k % 2, height > 0.0) {
                    (1, _) => 1,
                    (_, true) => 2,
                    (_, false) => 0,
                };
                let found = answers.hits.len();
                assert_eq!(answers.all, Ok(()), "{name} {query:?}");
                assert!(!far || found == roots, "{name} {query:?} {:?}", answers.hits);
                assert!(far || k % 2 == 0 || found > 0, "{name} {query:?}");
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn doubled_surfaces() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
        Weighted<S>: Kind<Scalar = S>,
    {
        for copies in [2, 5] {
            let one = bumpy(44, [3, 3], [0.0; 3], 2.0, 0.4);
            let model = Model::numbered(vec![one; copies]);
            let mut random = Random(45);
            let queries: Vec<_> = (0..300)
                .map(|_| {
                    let (from, to) = (random.point(3.0), random.point(0.6));
                    Query::new([from[0], from[1], 4.0], add(to, -1.0, [from[0], from[1], 4.0]))
                })
                .collect();
            for (query, answers) in
                queries.iter().zip(run_any::<S>(&format!("{copies} copies"), &model, &queries, 1000))
            {
                assert_eq!(answers.all, Ok(()));
                assert_eq!(answers.hits.len() % copies, 0, "{query:?} {:?}", answers.hits);
                for same in answers.hits.chunks(copies) {
                    // Each copy once, at equal bits, the lower number first.
                    let numbers: Vec<_> = same.iter().map(|hit| hit.surface as usize).collect();
                    assert_eq!(numbers, (0..copies).collect::<Vec<_>>());
                    assert!(same.iter().all(|hit| hit.t == same[0].t && hit.u == same[0].u && hit.v == same[0].v));
                }
                assert!(answers.closest.unwrap().is_none_or(|hit| hit.surface == 0));
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn poles() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
        Weighted<S>: Kind<Scalar = S>,
    {
        // A bicubic with one edge a point; the same raised; and an octant of a sphere.
        let mut cap = bumpy(46, [3, 3], [0.0; 3], 1.5, 0.4);
        (0..4).for_each(|k| cap.points[k] = [-0.75, 0.0, 0.25, 1.0]);
        let mut collapsed_v = bumpy(47, [2, 4], [0.0; 3], 1.5, 0.4);
        (0..3).for_each(|k| collapsed_v.points[5 * k] = [-0.75, 0.0, 0.25, 1.0]);
        let pole = [-0.75, 0.0, 0.25];
        let octant = sphere([-0.75, 0.0, -0.75], 1.0).surfaces.swap_remove(2);
        let mut random = Random(48);
        for (name, surface) in [
            ("collapsed in u", cap.clone()),
            ("raised", elevate(&cap, 6, 5)),
            ("collapsed in v", collapsed_v),
            ("octant", octant),
        ] {
            let mut queries = vec![];
            let mut through = vec![];
            for exponent in 2..=16 {
                for _ in 0..30 {
                    let d = [random.within(-1.0, 1.0), random.within(-1.0, 1.0), random.within(-1.0, 1.0)];
                    let off = if exponent == 2 { 0.0 } else { 10.0_f64.powi(-exponent) };
                    let at = add(pole, off, random.point(1.0));
                    through.push(off == 0.0);
                    queries.push(Query::new(add(at, -2.0, d), d));
                }
            }
            let name = format!("pole, {name}");
            let answers = run_any::<S>(&name, &single(surface), &queries, 1000);
            for ((query, through), answers) in queries.iter().zip(&through).zip(&answers) {
                assert_eq!(answers.all, Ok(()), "{name} {query:?}");
                // All parameters of the edge name the one point. Off along a tangent, so by half the digits.
                let near = Limits::<S>::default().tolerance.sqrt().to_f64();
                let at_pole = answers.hits.iter().filter(|hit| (hit.t.to_f64() - 2.0).abs() < near).count();
                // In `f32`, where that is a thousandth of the size, a second root may be as near.
                let once = at_pole == 1 || (at_pole > 0 && S::EPSILON.to_f64() > 1e-10);
                assert!(!through || once, "{name} {query:?} {:?}", answers.hits);
            }
        }
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn cusps_points_and_lines() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
        Weighted<S>: Kind<Scalar = S>,
    {
        // (x², x³) along z, x from −1 to 1: Bernstein coefficients by hand.
        let (square, cube) = ([1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0], [-1.0, 1.0, -1.0, 1.0]);
        let cusp = single(net(3, 1, |i, j| [square[i], cube[i], j as f64]));
        let point = |n, m| single(net(n, m, |_, _| [0.5, 0.25, -1.0]));
        let straight = |n: usize, m: usize| {
            single(net(n, m, |i, j| {
                let s = (i as f64 - 0.5 * j as f64) / (n + m) as f64;
                [0.5 + s, 0.25 - 0.5 * s, -1.0 + 0.25 * s]
            }))
        };
        let mut random = Random(49);
        let mut queries = vec![];
        for exponent in 1..=16 {
            let off = if exponent == 1 { 0.0 } else { 10.0_f64.powi(-exponent) };
            for k in 0..20 {
                let d = if k < 4 {
                    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0]][k]
                } else {
                    random.point(1.0)
                };
                queries.push(Query::new(add(add([0.0, 0.0, 0.5], off, random.point(1.0)), -2.0, d), d));
            }
        }
        let answers = run_any::<S>("cusp", &cusp, &queries, 6000);
        // The first twenty go through the cusp; one lies along it.
        for (query, answers) in queries.iter().zip(&answers).take(20) {
            assert!(!missed(answers), "{query:?}");
        }
        for (name, model, line) in [
            ("point 1 x 1", point(1, 1), false),
            ("point 3 x 3", point(3, 3), false),
            ("point 15 x 15", point(15, 15), false),
            ("line 1 x 1", straight(1, 1), true),
            ("line 3 x 3", straight(3, 3), true),
            ("line 4 x 2", straight(4, 2), true),
        ] {
            let mut queries = vec![];
            let along = [1.0, -0.5, 0.25];
            for k in 0..60 {
                let d = if k % 6 == 5 { along } else { random.point(1.0) };
                let off = if k < 30 { 0.0 } else { 10.0_f64.powi(-(k / 2) + 12) };
                let at = add([0.5, 0.25, -1.0], if line { 0.0625 } else { 0.0 }, along);
                queries.push(Query::new(add(add(at, off, random.point(1.0)), -2.0, d), d));
            }
            for (k, (query, answers)) in queries.iter().zip(run_any::<S>(name, &model, &queries, 2000)).enumerate() {
                // A point is hit once; a line, of which every point is met at a whole line of parameters, may be too much.
                assert!(answers.all.is_ok() || line, "{name} {query:?}");
                assert!(k >= 30 || !missed(&answers), "{name} {query:?}");
                assert!(line || answers.hits.len() <= 1, "{name} {query:?} {:?}", answers.hits);
            }
        }
    }
    check::<f64>();
    check::<f32>();
}
