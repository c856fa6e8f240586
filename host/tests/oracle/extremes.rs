//! What only double-double decides: tangents within 1e-24, models far from the origin of coordinates, rays from afar.

use crate::truth::*;
use patchray_host::oracle::{DoubleDouble, Oracle, OracleIn, Real, Verdict};
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{Random, paraboloid, single};

type Fine = OracleIn<DoubleDouble>;

/// z = x² + y² over [-1, 1]², times `scale`, a power of two.
fn bowl(scale: f64) -> Model {
    let mut surface = paraboloid([0.0; 3], 1.0);
    for p in &mut surface.points {
        for x in &mut p[..3] {
            *x *= scale;
        }
    }
    single(surface)
}

/// Checks that a ray at `height` over the bowl's apex has two roots or none, and that its margin says so.
fn check(verdict: &Verdict, height: f64) {
    assert_eq!(verdict.roots.len(), if height > 0.0 { 2 } else { 0 }, "{height}: {verdict:?}");
    assert_eq!(verdict.unresolved, 0, "{height}: {verdict:?}");
    assert!(verdict.margin >= 1e-3 * height.abs() && verdict.margin <= height.abs(), "{height}: {verdict:?}");
}

#[test]
fn tangents_far_below_the_rounding_of_f64() {
    let model = bowl(1.0);
    let (fine, coarse) = (Fine::new(&model), Oracle::new(&model));
    for exponent in 4..=24 {
        for height in [1.0, -1.0].map(|side| side * 10f64.powi(-exponent)) {
            for direction in [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [0.0, -1.0, 0.0]] {
                let origin = add([0.0, 0.0, height], -4.0, direction);
                let verdict = fine.trace(origin, direction, 0.0, f64::INFINITY);
                check(&verdict, height);
                let half = 10f64.powf(-0.5 * exponent as f64);
                for (root, t) in verdict.roots.iter().zip([4.0 - half, 4.0 + half]) {
                    assert!((root.t - t).abs() < 2e-15, "{height}: {verdict:?}");
                }
                let verdict = coarse.trace(origin, direction, 0.0, f64::INFINITY);
                assert!(exponent < 13 || verdict.margin < JUDGED, "{height}: {verdict:?}");
            }
        }
    }
}

#[test]
fn a_tangent_is_undecided() {
    let fine = Fine::new(&bowl(1.0));
    for height in [0.0, 1e-31, -1e-31] {
        let verdict = fine.trace([-4.0, 0.0, height], [1.0, 0.0, 0.0], 0.0, f64::INFINITY);
        assert!(verdict.margin < DoubleDouble::LEAST_MARGIN, "{verdict:?}");
        assert!(verdict.unresolved > 0 || !verdict.roots.is_empty(), "{verdict:?}");
    }
}

#[test]
fn any_unit_of_length_and_any_length_of_direction() {
    for exponent in [-100, -50, 50, 100] {
        let unit = 2f64.powi(exponent);
        let fine = Fine::new(&bowl(unit));
        for length in [-498, -250, 0, 250, 498].map(|e| 2f64.powi(e)) {
            for height in [1e-3, 1e-20, -1e-20] {
                let origin = [-2.4 * unit, -3.2 * unit, height * unit];
                let direction = [0.6, 0.8, 0.0].map(|x| x * length);
                let verdict = fine.trace(origin, direction, 0.0, f64::INFINITY);
                check(&verdict, height);
                for root in &verdict.roots {
                    let t = root.t * length / unit;
                    assert!(((t - 4.0).abs() - height.sqrt()).abs() < 2e-15, "{unit} {length}: {verdict:?}");
                }
            }
        }
    }
}

#[test]
fn a_model_far_from_the_origin_of_coordinates() {
    let place = [2f64.powi(30), -(2f64.powi(30)), 2f64.powi(30)];
    let model = single(paraboloid(place, 1.0));
    let (fine, coarse) = (Fine::new(&model), Oracle::new(&model));
    // The least height that f64 can state there.
    for height in [1.0, -1.0].map(|side| side * 2f64.powi(-22)) {
        let origin = [place[0] - 4.0, place[1], place[2] + height];
        let verdict = fine.trace(origin, [1.0, 0.0, 0.0], 0.0, f64::INFINITY);
        check(&verdict, height);
        for (root, t) in verdict.roots.iter().zip([4.0 - 2f64.powi(-11), 4.0 + 2f64.powi(-11)]) {
            assert!((root.t - t).abs() < 1e-14, "{verdict:?}");
        }
        let verdict = coarse.trace(origin, [1.0, 0.0, 0.0], 0.0, f64::INFINITY);
        assert!(verdict.margin < JUDGED, "{verdict:?}");
    }
    // The same rays there and about 0, with exact coordinates in both places.
    let near = Fine::new(&bowl(1.0));
    let mut random = Random(21);
    let coarsened = |p: Vector| p.map(|x| (x * 2f64.powi(20)).round() / 2f64.powi(20));
    let mut roots = 0;
    for _ in 0..500 {
        let (origin, _) = toward(&mut random, [0.0; 3], 1.0);
        let origin = coarsened(origin);
        let direction = sub(coarsened(random.point(1.0)), origin);
        let a = near.trace(origin, direction, 0.0, f64::INFINITY);
        let b = fine.trace(add(origin, 1.0, place), direction, 0.0, f64::INFINITY);
        assert_eq!(a.roots.len(), b.roots.len(), "{a:?} {b:?}");
        assert!((a.margin - b.margin).abs() < 1e-14, "{a:?} {b:?}");
        for (a, b) in a.roots.iter().zip(&b.roots) {
            roots += 1;
            assert!((a.t - b.t).abs() < 1e-15 && (a.u - b.u).abs() < 1e-15 && b.blur < 1e-18, "{a:?} {b:?}");
        }
    }
    assert!(roots > 100, "{roots}");
}

#[test]
fn a_ray_that_comes_from_afar() {
    let fine = Fine::new(&bowl(1.0));
    // Through the axis exactly, from 5.6e15 away.
    let far = 2f64.powi(50);
    for height in [1e-6, -1e-6, 1e-20, -1e-20] {
        let verdict = fine.trace([-3.0 * far, -4.0 * far, height], [3.0, 4.0, 0.0], 0.0, f64::INFINITY);
        check(&verdict, height);
        assert!(verdict.roots.iter().all(|r| (r.t - far).abs() <= 0.25));
    }
    // Where a root lies on the surface is known better than t, which has no more digits than an f64.
    let mut random = Random(22);
    let mut roots = 0;
    for _ in 0..400 {
        let d = unit(random.point(1.0));
        let distance = 10f64.powf(random.within(12.0, 15.0));
        let origin = add(random.point(0.5), -distance, d);
        for root in fine.trace(origin, d, 0.0, f64::INFINITY).roots {
            roots += 1;
            let [x, y] = [2.0 * root.u - 1.0, 2.0 * root.v - 1.0].map(DoubleDouble::new);
            let from = [x, y, x * x + y * y];
            let from = [0, 1, 2].map(|k| from[k] - origin[k]);
            let off = [(1, 2), (2, 0), (0, 1)].map(|(a, b)| (from[a] * d[b] - from[b] * d[a]).to_f64());
            assert!(norm(off) < 1e-15, "{root:?} {off:?}");
        }
    }
    assert!(roots > 100, "{roots}");
}

#[test]
fn both_numbers_agree_on_the_teapot() {
    let model = patchray_host::scene::teapot::model().expect("the fixture is valid");
    let (fine, coarse) = (Fine::new(&model), Oracle::new(&model));
    let mut random = Random(23);
    let (mut both, mut roots) = (0, 0);
    for _ in 0..2000 {
        let (origin, direction) = toward(&mut random, [0.2, 0.0, 1.5], 1.5);
        let a = coarse.trace(origin, direction, 0.0, f64::INFINITY);
        let b = fine.trace(origin, direction, 0.0, f64::INFINITY);
        if a.margin <= 1e-10 || b.margin <= 1e-10 {
            continue;
        }
        both += 1;
        assert_eq!(a.roots.len(), b.roots.len(), "{a:?} {b:?}");
        for (a, b) in a.roots.iter().zip(&b.roots) {
            roots += 1;
            assert!((a.t - b.t).abs() < 1e-12, "{a:?} {b:?}");
        }
    }
    println!("{both} rays compared, {roots} roots");
    assert!(both > 1900 && roots > 1500, "{both} {roots}");
}
