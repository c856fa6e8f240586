//! Many roots on one ray: each found exactly once, by all three functions and by the coherent method, in any order of rays.

use crate::ask::{Query, Room, ask};
use crate::common::{Kind, Prepared, add, dot, is_rational};
use crate::judge::{Allowed, Tally};
use crate::shapes::{askew, mapped};
use crate::{coherence, common::Built};
use patchray::limits::Limits;
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray_host::oracle::Oracle;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::shapes::roots::{folded, grid_of_roots, spread};
use patchray_host::scene::shapes::{Random, single, torus};

/// All hits of one ray, against t, u and v known beforehand, in order of t; u and v within `tolerance`.
fn expect<P: Kind>(model: &Model, query: &Query, truth: &[[f64; 3]], tolerance: f64) {
    let built = Built::<P>::new(model, 1.0);
    let mut room = Room::<P>::new();
    let answers = ask(&built, query, &Limits::default(), &mut room);
    assert_eq!(answers.all, Ok(()));
    let found: Vec<_> = answers.hits.iter().map(|hit| [hit.t, hit.u, hit.v].map(Scalar::to_f64)).collect();
    assert_eq!(found.len(), truth.len(), "{found:?}\n{truth:?}");
    for (found, truth) in found.iter().zip(truth) {
        assert!((0..3).all(|k| (found[k] - truth[k]).abs() <= tolerance), "{found:?} {truth:?}");
    }
    println!("{} roots: {:?}", truth.len(), answers.work[0]);
}

/// u and v of the roots of S = (∏ (u − r), ∏ (v − s), u + v/16) on the line along z, with the depth of each.
fn pairs(r: &[f64], s: &[f64]) -> Vec<[f64; 3]> {
    let mut all: Vec<_> = r.iter().flat_map(|&u| s.iter().map(move |&v| [u + v / 16.0, u, v])).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}

#[test]
fn twenty_five_roots_on_one_ray() {
    let five = spread(5);
    let uneven = [0.03, 0.25, 0.5, 0.53125, 0.98];
    for (r, s) in [(&five[..], &five[..]), (&uneven, &five), (&five, &uneven), (&uneven, &uneven)] {
        for [m, n] in [[5, 5], [5, 9], [8, 6], [15, 15]] {
            let model = single(grid_of_roots(r, s, m, n));
            let query = Query::new([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
            let truth: Vec<_> = pairs(r, s).iter().map(|&[z, u, v]| [z + 1.0, u, v]).collect();
            expect::<Plain<f64>>(&model, &query, &truth, 1e-9);
            // The same, and neither plane along an axis.
            let slanted = mapped(&model, askew);
            let query = Query { origin: askew(query.origin), direction: askew(query.direction), ..query };
            expect::<Plain<f64>>(&slanted, &query, &truth, 1e-9);
            if [m, n] == [5, 5] && r == s && r == five {
                let query = Query::new([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
                expect::<Plain<f32>>(&model, &query, &truth, 2e-3);
            }
        }
    }
}

/// A sheet between two curves in parallel planes, cut by rays in a plane between them: after one clip the net is all but a line,
/// and the ray meets it as often as its section. The curves are graphs of known roots, one beside the other by a step that has a
/// part along the ray.
#[test]
fn a_sheet_is_met_as_often_as_its_section() {
    fn check<P: Kind>(least: f64) {
        let (mut random, mut room) = (Random(29), Room::<P>::new());
        for _ in 0..4000 {
            let count = 1 + random.bits() as usize % 4;
            let mut roots: Vec<f64> = (0..count).map(|_| random.within(0.05, 0.95)).collect();
            roots.sort_by(f64::total_cmp);
            if roots.windows(2).any(|pair| pair[1] - pair[0] < least) {
                continue;
            }
            let step = random.point(1.0);
            let twisted = |[x, y, z]: [f64; 3]| [x + step[0] * y, (step[1] + 1.5) * y, z + step[2] * y];
            let at = random.within(0.05, 0.95);
            let model = mapped(&single(folded(&roots, 1)), twisted);
            let origin = twisted([-1.0 - random.within(0.0, 1.0), at, 0.0]);
            let query = Query::new(origin, [1.0, 0.0, 0.0]);
            for (model, query) in [
                (model.clone(), query),
                (mapped(&model, askew), Query { origin: askew(origin), direction: askew([1.0, 0.0, 0.0]), ..query }),
            ] {
                let built = Built::<P>::new(&model, 1.0);
                let all = ask(&built, &query, &Limits::default(), &mut room);
                assert_eq!((all.all, all.hits.len()), (Ok(()), count), "{roots:?} {step:?} {at} {:?}", all.hits);
                for (hit, root) in all.hits.iter().zip(&roots) {
                    let off = hit.t.to_f64() - (root + step[0] * at - origin[0]);
                    assert!(off.abs() < least * 0.1, "{roots:?} {step:?} {at} {hit:?} {off}");
                }
            }
        }
    }
    check::<Plain<f64>>(1e-3);
    check::<Weighted<f64>>(1e-3);
    check::<Plain<f32>>(0.1);
}

#[test]
fn as_many_roots_as_the_degree() {
    for (count, n) in [(2, 1), (3, 3), (6, 2), (6, 3), (9, 1), (12, 2), (15, 15)] {
        let roots = spread(count);
        let truth: Vec<_> = roots.iter().map(|&r| [1.0 + r, r, 0.25]).collect();
        let query = Query::new([-1.0, 0.25, 0.0], [1.0, 0.0, 0.0]);
        expect::<Plain<f64>>(&single(folded(&roots, n)), &query, &truth, 1e-7);
        let backward: Vec<_> = truth.iter().rev().map(|&[t, u, v]| [3.0 - t, u, v]).collect();
        let query = Query::new([2.0, 0.25, 0.0], [-1.0, 0.0, 0.0]);
        expect::<Plain<f64>>(&single(folded(&roots, n)), &query, &backward, 1e-7);
        if count <= 6 {
            expect::<Plain<f32>>(&single(folded(&roots, n)), &query, &backward, 4e-3);
        }
    }
}

/// The torus of radii 1 and 0.4 by bicubics: circles are off by 3e-4, so only the oracle knows the truth.
fn polynomial_torus() -> Model {
    let k = 4.0 / 3.0 * (2.0_f64.sqrt() - 1.0);
    let quarter = |number: usize| {
        let turn = |[x, y]: [f64; 2]| [[x, y], [-y, x], [-x, -y], [y, -x]][number];
        [[1.0, 0.0], [1.0, k], [k, 1.0], [0.0, 1.0]].map(turn)
    };
    let mut surfaces = Vec::new();
    for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
        let (small, great) = (quarter(a), quarter(b));
        let points = small
            .iter()
            .flat_map(|[r, z]| great.map(|[x, y]| [x * (1.0 + 0.4 * r), y * (1.0 + 0.4 * r), 0.4 * z, 1.0]));
        let points = points.collect();
        surfaces.push(ModelSurface { number: 0, degree_u: 3, degree_v: 3, rational: false, points, knots: None });
    }
    Model::numbered(surfaces)
}

/// Depths at which a ray along z, or one at height `h` along x, meets the torus of radii 1 and 0.4.
fn torus_by_formula(query: &Query) -> Vec<f64> {
    let [x, y, z] = query.origin;
    let mut t = vec![];
    if query.direction[2] != 0.0 {
        let off = 0.16 - (x.hypot(y) - 1.0).powi(2);
        if off > 0.0 {
            t.extend([-1.0, 1.0].map(|side| (side * off.sqrt() - z) / query.direction[2]));
        }
    } else if z.abs() < 0.4 {
        let half = (0.16 - z * z).sqrt();
        for radius in [1.0 - half, 1.0 + half] {
            if y.abs() < radius {
                let reach = (radius * radius - y * y).sqrt();
                t.extend([-1.0, 1.0].map(|side| (side * reach - x) / query.direction[0]));
            }
        }
    }
    t.sort_by(f64::total_cmp);
    t
}

#[test]
fn a_torus_along_its_axis_and_across() {
    fn check<P: Kind>(tolerance: f64) {
        let model = torus([0.0; 3], 1.0, 0.4, 4, 4);
        let built = Built::<P>::new(&model, 1.0);
        let mut room = Room::<P>::new();
        let mut random = Random(31);
        let mut roots = [0; 5];
        for k in 0..2000 {
            let at = random.point(1.45);
            let query = if k % 2 == 0 {
                Query::new([at[0], at[1], 3.0], [0.0, 0.0, -2.0])
            } else {
                Query::new([-3.0, at[1], at[2] * 0.3], [0.5, 0.0, 0.0])
            };
            let query = query.exact();
            let truth = torus_by_formula(&query);
            if truth.windows(2).any(|pair| pair[1] - pair[0] < 0.1) {
                continue;
            }
            let answers = ask(&built, &query, &Limits::default(), &mut room);
            assert_eq!((answers.all, answers.hits.len()), (Ok(()), truth.len()), "{query:?} {truth:?}");
            for (hit, truth) in answers.hits.iter().zip(&truth) {
                // |x|, |y| and |z| over the radii are the normal's; along the ray the error is that over its cosine.
                let [x, y, z] = add(query.origin, *truth, query.direction);
                let from = x.hypot(y);
                let normal = [x * (1.0 - 1.0 / from), y * (1.0 - 1.0 / from), z].map(|c| c / 0.4);
                let cosine = dot(normal, query.direction).abs();
                assert!((hit.t.to_f64() - truth).abs() < tolerance / cosine, "{hit:?} {truth} {query:?}");
            }
            roots[truth.len()] += 1;
        }
        println!("rays by roots: {roots:?}");
        assert!(roots[0] > 100 && roots[2] > 500 && roots[4] > 300);
    }
    check::<Weighted<f64>>(1e-11);
    check::<Weighted<f32>>(1e-4);
}

/// Rays that sweep across the place where one of them meets a surface many times, onto it and off again: by the coherent
/// method in both rules, against the oracle's closest.
fn sweep<P: Kind>(model: &Model, name: &str, along: [f64; 3], across: [[f64; 3]; 2], lines: u32) {
    let prepared = Prepared::<P>::new(
        model,
        1.0,
        &patchray::subdivide::Subdivision { flatness: P::Scalar::from_f64(5e-3), ..Default::default() },
    );
    let built = Built::<P>::new(model, 1.0);
    let oracle = Oracle::new(model);
    let size = model.control_box().unwrap().diagonal();
    let mut room = Room::<P>::new();
    let (mut all, mut tally) = (vec![], Tally::default());
    for line in 0..lines {
        for k in 0..200 {
            let (a, b) = (f64::from(k) / 100.0 - 1.0, f64::from(line) / f64::from(lines.max(2) - 1) - 0.5);
            let origin = [0, 1, 2].map(|i| a * across[0][i] + b * across[1][i] - 2.0 * along[i]);
            let query = Query::new(origin, along).exact();
            let answers = ask(&built, &query, &Limits::default(), &mut room);
            tally.add(&built, &oracle, &query, &answers, size, &Allowed::of::<P::Scalar>());
            all.push((query, line, answers));
        }
    }
    println!("{name}: {tally:?}");
    assert_eq!((tally.missed, tally.phantom, tally.gave_up), (0, 0, 0), "{name}");
    let most = if P::Scalar::EPSILON.to_f64() < 1e-10 { 100 } else { 10 };
    assert!(tally.judged > tally.rays / 2 && tally.roots * 100 > tally.judged * most, "{name}: {tally:?}");
    coherence::agree(&prepared, name, &all);
}

#[test]
fn scan_lines_across_many_roots() {
    let five = spread(5);
    let z = [0.0, 0.0, 1.0];
    let product = single(grid_of_roots(&five, &five, 5, 5));
    sweep::<Plain<f64>>(&product, "25 roots", z, [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0]], 20);
    sweep::<Plain<f32>>(&product, "25 roots", z, [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0]], 20);
    let wave = single(folded(&spread(6), 3));
    sweep::<Plain<f64>>(&wave, "6 roots", [1.0, 0.0, 0.0], [[0.0, 0.3, 0.1], [0.0, 0.0, 0.2]], 20);
    sweep::<Plain<f32>>(&wave, "6 roots", [1.0, 0.0, 0.0], [[0.0, 0.3, 0.1], [0.0, 0.0, 0.2]], 20);
    let ring = torus([0.0; 3], 1.0, 0.4, 4, 4);
    assert!(is_rational(&ring));
    sweep::<Weighted<f64>>(&ring, "torus", z, [[1.6, 0.01, 0.0], [0.02, 1.6, 0.0]], 20);
    sweep::<Weighted<f32>>(&ring, "torus", [0.03, 1.0, 0.01], [[1.6, 0.01, 0.0], [0.0, 0.02, 1.0]], 20);
    sweep::<Plain<f64>>(&polynomial_torus(), "bicubic torus", [0.01, 1.0, 0.2], [[1.6, 0.0, 0.0], [0.0, 0.0, 1.0]], 20);
}
