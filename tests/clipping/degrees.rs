//! All degrees, weights, scales and distances against the oracle: every root found, and nothing else.

use crate::ask::{Most, Query, Room, ask};
use crate::common::{Built, Kind};
use crate::judge::{Allowed, Tally};
use patchray::limits::Limits;
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray_host::oracle::Oracle;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{Random, bumpy, single};

/// Rays per case, unless the environment says otherwise.
const RAYS: u32 = 300;

fn rays_per_case() -> u32 {
    std::env::var("PATCHRAY_RAYS").ok().and_then(|text| text.parse().ok()).unwrap_or(RAYS)
}

const DEGREES: [[usize; 2]; 14] = [
    [1, 1],
    [2, 1],
    [2, 2],
    [3, 3],
    [4, 4],
    [3, 7],
    [2, 12],
    [12, 2],
    [1, 15],
    [15, 1],
    [6, 6],
    [9, 10],
    [12, 12],
    [15, 15],
];

/// A bumpy surface whose numbers `f32` holds exactly.
fn model(seed: u64, degrees: [usize; 2], height: f64) -> Model {
    let mut surface = bumpy(seed, degrees, [0.1, -0.2, 0.3], 2.0, height);
    for point in &mut surface.points {
        *point = point.map(|c| f64::from(c as f32));
    }
    single(surface)
}

/// Rays through the model's box from `distance` sizes away: across it, and along it, where roots are many.
fn rays(seed: u64, model: &Model, count: u32, distance: f64) -> Vec<Query> {
    let bounds = model.control_box().unwrap();
    let mut random = Random(seed);
    (0..count)
        .map(|k| {
            let at: [f64; 3] = core::array::from_fn(|i| random.within(bounds.min[i], bounds.max[i]));
            let mut d = random.point(1.0);
            if k % 3 == 0 {
                d[2] *= 0.1;
            }
            let off = distance * bounds.diagonal() / crate::common::norm(d);
            // The origin is rounded and the direction is not: the ray misses its mark, but it is the same for all.
            Query::new(core::array::from_fn(|i| at[i] - off * d[i]), d).exact()
        })
        .collect()
}

/// Traces at `scale` what the oracle judges at 1.
fn judge<P: Kind>(name: &str, model: &Model, queries: &[Query], scale: f64, allowed: &Allowed) -> (Tally, Most) {
    let built = Built::<P>::new(model, scale);
    let oracle = Oracle::new(model);
    let size = model.control_box().unwrap().diagonal();
    let (mut room, limits) = (Room::<P>::new(), Limits::default());
    let (mut tally, mut most) = (Tally::default(), Most::default());
    for query in queries {
        let scaled = [query.origin, query.direction].map(|v| v.map(|c| c * scale));
        let query_there = Query { origin: scaled[0], direction: scaled[1], ..*query };
        let answers = ask(&built, &query_there, &limits, &mut room);
        most.add(&answers);
        tally.add(&built, &oracle, query, &answers, size, allowed);
    }
    let kind = if P::Scalar::EPSILON.to_f64() < 1e-10 { "f64" } else { "f32" };
    println!("{name} {kind}: {tally:?} {most:?}");
    (tally, most)
}

fn expect<P: Kind>(name: &str, model: &Model, queries: &[Query], scale: f64) {
    let (tally, _) = judge::<P>(name, model, queries, scale, &Allowed::of::<P::Scalar>());
    assert_eq!((tally.missed, tally.phantom, tally.gave_up), (0, 0, 0), "{name}");
    assert!(tally.judged * 10 >= tally.rays * 8 && tally.roots * 4 > tally.judged, "{name}: {tally:?}");
}

#[test]
fn all_degrees() {
    for (seed, degrees) in (50..).zip(DEGREES) {
        // The higher the degree, the less of a control point's height reaches the surface.
        let model = model(seed, degrees, 0.3 * degrees[0].max(degrees[1]) as f64);
        let queries = rays(seed, &model, rays_per_case(), 1.5);
        let name = format!("degrees {degrees:?}");
        expect::<Plain<f64>>(&name, &model, &queries, 1.0);
        // Higher ones fold too steeply for the digits of `f32`.
        if degrees[0] * degrees[1] <= 100 {
            expect::<Plain<f32>>(&name, &model, &queries, 1.0);
        } else {
            judge::<Plain<f32>>(&name, &model, &queries, 1.0, &Allowed::of::<f32>());
        }
    }
}

#[test]
fn scales_and_far_origins() {
    let model = model(70, [3, 3], 0.8);
    // 1.3e30 and its inverse.
    for scale in [-100, -33, 7, 100].map(|k| 2.0_f64.powi(k)) {
        let queries = rays(71, &model, rays_per_case(), 1.5);
        expect::<Plain<f64>>(&format!("scale {scale:e}"), &model, &queries, scale);
        expect::<Plain<f32>>(&format!("scale {scale:e}"), &model, &queries, scale);
    }
    for distance in [0.0, 7.0, 9.0, 1e3, 1e6] {
        let queries = rays(72, &model, rays_per_case(), distance);
        expect::<Plain<f64>>(&format!("{distance} sizes away"), &model, &queries, 1.0);
        if distance < 1e3 {
            expect::<Plain<f32>>(&format!("{distance} sizes away"), &model, &queries, 1.0);
        }
    }
}

#[test]
fn weights() {
    for (seed, degrees) in [(80, [2, 2]), (81, [3, 3]), (82, [2, 5]), (83, [6, 4])] {
        for ratio in [1.0_f64, 10.0, 1e3, 1e6] {
            let mut random = Random(seed);
            let mut model = model(seed, degrees, 0.8);
            model.surfaces[0].rational = true;
            for point in &mut model.surfaces[0].points {
                point[3] = f64::from(ratio.powf(random.within(-0.5, 0.5)) as f32);
            }
            let queries = rays(seed + 10, &model, rays_per_case(), 1.5);
            let name = format!("degrees {degrees:?}, weights 1 to {ratio:e}");
            let allowed = Allowed::of::<f64>();
            let (tally, _) = judge::<Weighted<f64>>(&name, &model, &queries, 1.0, &allowed);
            // Rounding is of the heaviest points' size: where a millionth of it is all there is, nine digits are too many.
            assert!(ratio > 1e3 || (tally.missed, tally.phantom) == (0, 0), "{name}");
            assert_eq!(tally.gave_up, 0, "{name}");
            assert!(tally.judged * 2 > tally.rays, "{name}");
            let allowed = Allowed::of::<f32>();
            let (tally, _) = judge::<Weighted<f32>>(&name, &model, &queries, 1.0, &allowed);
            assert!(ratio > 1.0 || (tally.missed, tally.phantom) == (0, 0), "{name}");
            assert!(ratio > 1e3 || tally.gave_up == 0, "{name}");
        }
    }
}
