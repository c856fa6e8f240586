//! The patch test is sound under rounding: a ray through a point of a patch meets the patch's box and all boxes above it.
//!
//! A box refused by rounding is a hole in the surface one ray wide, which no picture shows and no later step mends. So: a
//! million rays through known points, many of them edge on, where boxes are thinnest as the ray sees them.

mod common;

use common::{Kind, Prepared, add, cross, direction, hard_surfaces, index, is_rational, norm};
use patchray::bernstein::Basis;
use patchray::limits::{Limits, Work};
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{Random, paraboloid, parallelogram, single};

/// What became of the rays of a run.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    rays: u32,
    edge_on: u32,
    far: u32,
    /// The patch, a node above it, or the scene's box refused the ray.
    refused: u32,
    /// The number type could not hold such a ray.
    unrepresentable: u32,
}

/// Shoots `rays` rays through points of a model's patches.
fn shoot<P: Kind>(model: &Model, scale: f64, padding: Option<u32>, rays: u32, seed: u64, count: &mut Count) {
    let mut options = Subdivision::default();
    if let Some(padding) = padding {
        options.padding = padding;
    }
    let prepared = Prepared::<P>::new(model, scale, &options);
    let (scene, patches, tree) = (prepared.scene(), prepared.patches(), prepared.tree());
    let limits = Limits::default();
    let mut basis = Basis::<P::Scalar, 16>::new();
    let mut random = Random(seed);
    let unit = (-scene.frame().exponent()) as f64;
    // The largest coordinate is within a factor of two of this, in the caller's units.
    let reach = unit.exp2();
    for _ in 0..rays {
        let surface = index(&mut random, scene.len());
        let of_surface = patches.of_surface(surface).unwrap();
        let number = index(&mut random, of_surface.len());
        let patch = &of_surface[number];
        let [u, v] = parameters::<P::Scalar>(patch, &mut random);
        let net = scene.surface(surface).unwrap().net;
        let jet = net.jet(u, v, &mut basis.view()).unwrap();
        let point = jet.point.position().map(|c| c.times_power_of_two(-scene.frame().exponent()));
        let [at, su, sv] = [jet.point, jet.du, jet.dv].map(|p| (p.weighted_position().map(Scalar::to_f64), p.weight()));
        // The quotient rule without its factor 1/w.
        let tangent = |(d, w): ([f64; 3], P::Scalar)| {
            let share = if P::RATIONAL { w.to_f64() / at.1.to_f64() } else { 0.0 };
            add(d, -share, at.0)
        };
        let (su, sv) = (tangent(su), tangent(sv));
        let (d, edge_on) = ray_direction(su, sv, &mut random);
        let length = norm(d);
        if !(length > 0.0) {
            continue;
        }
        let speed = reach * 10.0_f64.powf(random.within(-3.0, 3.0));
        let axis_parallel = d.iter().filter(|c| **c == 0.0).count() == 2;
        let d = d.map(|c| P::Scalar::from_f64(c / length * speed));
        // In front of the origin or behind; inside the box, near it, or, where that is exact, far away.
        let far = axis_parallel && random.within(0.0, 1.0) < 0.5;
        let distance = match random.within(0.0, 4.0) as u32 {
            _ if far => 10.0_f64.powf(random.within(1.0, 5.0)),
            0 => 0.0,
            1 => random.within(-0.5, 0.5),
            _ => random.within(-6.5, 6.5),
        };
        let tau = P::Scalar::from_f64(distance * reach / speed);
        let origin = core::array::from_fn(|k| point[k] - tau * d[k]);
        count.far += u32::from(far);
        count.edge_on += u32::from(edge_on);
        count.rays += 1;
        let Ok(ray) = scene.ray(origin, d) else {
            count.unrepresentable += 1;
            continue;
        };
        let whole = Interval::new(-P::Scalar::INFINITY, P::Scalar::INFINITY).unwrap();
        let met = scene.frame().enter(&ray, &whole).is_some_and(|(planes, _)| {
            let mut descent = tree.of_surface(&patches, surface).unwrap();
            let mut work = Work::default();
            // Ends: the patch is in the tree, or the tree ends.
            patch.bounds().crossing(&planes).is_some()
                && loop {
                    match descent.next_patch(&planes, &limits, &mut work).unwrap() {
                        Some((found, _)) if core::ptr::eq(found, patch) => break true,
                        Some(_) => {}
                        None => break false,
                    }
                }
        });
        count.refused += u32::from(!met);
    }
}

/// A point of the patch's domain: anywhere, on its lower borders, or at a corner.
fn parameters<S: Scalar>(patch: &patchray::patch::Patch<S>, random: &mut Random) -> [S; 2] {
    let bounds = patch.domain().bounds::<S>();
    // Ends: the middle of the interval is never refused.
    loop {
        let [u, v] = bounds.map(|[low, high]| {
            let share = match random.within(0.0, 10.0) as u32 {
                0 => 0.0,
                // The last interval of each direction is closed.
                1 if high == S::ONE => 1.0,
                _ => random.within(0.0, 1.0),
            };
            low + (high - low) * S::from_f64(share)
        });
        if patch.domain().holds(u, v) {
            return [u, v];
        }
    }
}

/// A direction, and whether it lies nearly in the tangent plane.
fn ray_direction(su: [f64; 3], sv: [f64; 3], random: &mut Random) -> ([f64; 3], bool) {
    let across = cross(su, sv);
    let along = add(su.map(|c| c * random.within(-1.0, 1.0)), random.within(-1.0, 1.0), sv);
    match random.within(0.0, 8.0) as u32 {
        0 | 1 => (direction(random, 0.0), false),
        2 => {
            let axis = index(random, 3);
            let sign = if random.within(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
            // The two zeros with either sign: their inverses are infinities of either sign.
            (core::array::from_fn(|k| if k == axis { sign } else { -0.0 * sign }), false)
        }
        // In the tangent plane, also along an isoparametric line.
        3 => (along, true),
        4 => (if random.within(0.0, 1.0) < 0.5 { su } else { sv }, true),
        _ => {
            let angle = 10.0_f64.powf(random.within(-12.0, -1.0));
            let size = norm(across);
            let tilt = if size > 0.0 { angle * norm(along) / size } else { 0.0 };
            (add(along, tilt, across), true)
        }
    }
}

/// All hard surfaces at all scales; `each` rays per surface and scale.
fn run<S: Scalar>(padding: Option<u32>, each: u32) -> Count {
    let mut count = Count::default();
    for (number, (name, model)) in (0..).zip(hard_surfaces()) {
        for (k, scale) in [1e-30, 3e-8, 1.0, 7e6, 1e30].into_iter().enumerate() {
            let before = count.refused;
            let seed = 100 * number + k as u64;
            if is_rational(&model) {
                shoot::<Weighted<S>>(&model, scale, padding, each, seed, &mut count);
            } else {
                shoot::<Plain<S>>(&model, scale, padding, each, seed, &mut count);
            }
            assert!(padding.is_some() || count.refused == before, "{name} {number} at {scale}: {count:?}");
        }
    }
    count
}

fn none_is_refused<S: Scalar>() {
    let each = 1_000_000 / (5 * hard_surfaces().len() as u32) + 1;
    let count = run::<S>(None, each);
    println!("{count:?}");
    assert_eq!(count.refused, 0);
    assert_eq!(count.unrepresentable, 0);
    assert!(count.rays > 990_000 && count.edge_on > count.rays / 2 && count.far > 20_000, "{count:?}");
    // The same rays against boxes that are not padded: the padding is what makes them sound.
    let bare = run::<S>(Some(0), each / 20);
    println!("without padding: {bare:?}");
    assert!(bare.refused > 0);
}

#[test]
fn no_ray_through_a_point_of_a_patch_is_refused_f32() {
    none_is_refused::<f32>();
}

#[test]
fn no_ray_through_a_point_of_a_patch_is_refused_f64() {
    none_is_refused::<f64>();
}

/// From a thousand scenes away in `f32`, or 10¹¹ in `f64`, a point's rounding alone would move the ray out of a box. Here
/// nothing rounds but the kernel: surface points, directions and distances are dyadic and short.
fn far_rays_through_dyadic_points<S: Scalar>(farthest: i32) {
    let surfaces = [
        single(parallelogram([-0.5, -0.25, 0.125], [1.0, 0.25, 0.5], [-0.25, 0.75, 0.5])),
        single(paraboloid([0.0, 0.0, -0.5], 0.75)),
    ];
    let mut random = Random(77);
    let mut far = 0;
    for model in &surfaces {
        let prepared = Prepared::<Plain<S>>::of(model);
        let (scene, patches) = (prepared.scene(), prepared.patches());
        let mut basis = Basis::<S, 16>::new();
        for _ in 0..20_000 {
            let [u, v] = [0, 1].map(|_| S::from_u32(index(&mut random, 17) as u32) * S::from_f64(1.0 / 16.0));
            let net = scene.surface(0).unwrap().net;
            let point = net.position(u, v, &mut basis.view()).unwrap();
            let point = point.map(|c| c.times_power_of_two(-scene.frame().exponent()));
            let d: [S; 3] = core::array::from_fn(|_| S::from_f64(index(&mut random, 9) as f64 / 4.0 - 1.0));
            if d == [S::ZERO; 3] {
                continue;
            }
            let tau = S::ONE.times_power_of_two(4 + index(&mut random, farthest as usize - 3) as i32);
            let origin: [S; 3] = core::array::from_fn(|k| point[k] - tau * d[k]);
            assert!((0..3).all(|k| (origin[k] + tau * d[k]) == point[k] && point[k] - origin[k] == tau * d[k]));
            let patch = patches.all().iter().find(|patch| patch.domain().holds(u, v)).unwrap();
            let ray = scene.ray(origin, d).unwrap();
            let whole = Interval::new(-S::INFINITY, S::INFINITY).unwrap();
            let (planes, _) = scene.frame().enter(&ray, &whole).expect("the ray passes through the scene");
            assert!(patch.bounds().crossing(&planes).is_some(), "{origin:?} {d:?} {u:?} {v:?}");
            far += 1;
        }
    }
    assert!(far > 39_000);
}

#[test]
fn far_rays_are_not_refused() {
    far_rays_through_dyadic_points::<f32>(10);
    far_rays_through_dyadic_points::<f64>(38);
}
