//! Patches and the tree over them: domains tile, boxes enclose, eq. (1) and the proof of "at most once" mean what they say.

mod common;

use common::allowances::{ENCLOSURE, roundings};
use common::{Kind, Prepared, add, cross, direction, hard_surfaces, index, is_rational, norm};
use patchray::bernstein::Basis;
use patchray::domain::MAX_LEVEL;
use patchray::grid::GridOptions;
use patchray::limits::{Limits, Work};
use patchray::patch::{Parallelepiped, Patch, Patches};
use patchray::planes::Planes;
use patchray::point::{Plain, Point, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray::tree::Tree;
use patchray_host::oracle::Oracle;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{Random, bumpy, elevate, paraboloid, parallelogram, single};
use patchray_host::scene::teapot;

fn whole<S: Scalar>() -> Interval<S> {
    Interval::new(-S::INFINITY, S::INFINITY).unwrap()
}

fn planes<P: Kind>(prepared: &Prepared<P>, origin: [f64; 3], d: [f64; 3]) -> Option<Planes<P::Scalar>> {
    let scene = prepared.scene();
    let ray = scene.ray(origin.map(P::Scalar::from_f64), d.map(P::Scalar::from_f64)).unwrap();
    scene.frame().enter(&ray, &whole()).map(|(planes, _)| planes)
}

fn at_flatness<P: Kind>(model: &Model, flatness: f64) -> Prepared<P> {
    Prepared::new(model, 1.0, &Subdivision { flatness: P::Scalar::from_f64(flatness), ..Default::default() })
}

fn check_tiling_and_enclosure<P: Kind>(model: &Model, random: &mut Random) {
    let prepared = at_flatness::<P>(model, 5e-3);
    let (scene, patches) = (prepared.scene(), prepared.patches());
    let mut basis = Basis::<P::Scalar, 16>::new();
    for number in 0..scene.len() {
        let of_surface = patches.of_surface(number).unwrap();
        let area: f64 = of_surface
            .iter()
            .map(|p| {
                let [u, v] = p.domain().bounds::<f64>();
                (u[1] - u[0]) * (v[1] - v[0])
            })
            .sum();
        assert_eq!(area, 1.0, "dyadic areas add up exactly");
        let finest = f64::from(1 << MAX_LEVEL);
        for _ in 0..50 {
            let [u, v] = [0, 1].map(|_| match index(random, 5) {
                0 => 0.0,
                1 => 1.0,
                2 => index(random, 1 << MAX_LEVEL) as f64 / finest,
                3 => index(random, 9) as f64 / 8.0,
                _ => random.within(0.0, 1.0),
            });
            let [u, v] = [u, v].map(P::Scalar::from_f64);
            let holders: Vec<_> = of_surface.iter().filter(|p| p.domain().holds(u, v)).collect();
            assert_eq!(holders.len(), 1, "{u:?} {v:?}");
            for ([low, high], t) in holders[0].domain().bounds::<P::Scalar>().into_iter().zip([u, v]) {
                assert!(low <= t && (t < high || (t == high && t == P::Scalar::ONE)));
            }
        }
        for patch in of_surface {
            let aabb = patch.bounds().aabb();
            let [[u0, u1], [v0, v1]] = patch.domain().bounds::<P::Scalar>();
            for i in 0..=4 {
                for j in 0..=4 {
                    let [a, b] = [i, j].map(|n| P::Scalar::from_f64(f64::from(n) / 4.0));
                    let net = scene.surface(number).unwrap().net;
                    let p = net.position(u0 + (u1 - u0) * a, v0 + (v1 - v0) * b, &mut basis.view()).unwrap();
                    let slack = roundings::<P::Scalar>(ENCLOSURE);
                    assert!((0..3).all(|k| aabb.low[k] - slack <= p[k] && p[k] <= aabb.high[k] + slack));
                }
            }
        }
    }
}

#[test]
fn domains_tile_and_boxes_enclose() {
    let mut random = Random(21);
    for (_, model) in hard_surfaces() {
        if is_rational(&model) {
            check_tiling_and_enclosure::<Weighted<f32>>(&model, &mut random);
            check_tiling_and_enclosure::<Weighted<f64>>(&model, &mut random);
        } else {
            check_tiling_and_enclosure::<Plain<f32>>(&model, &mut random);
            check_tiling_and_enclosure::<Plain<f64>>(&model, &mut random);
        }
    }
}

/// Eq. (1) on one flat patch: α is the angle to its normal, b/h its breadth over its thickness.
#[test]
fn a_ray_is_critical_by_its_angle_to_the_patch() {
    fn check<S: Scalar>() {
        // A cap of breadth 2 and height 1/64, in one patch: control points from 0 to 1/32 above the corners.
        let mut cap = elevate(&parallelogram([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]), 2, 2);
        cap.points[4][2] = 0.03125;
        let model = single(cap);
        let prepared = at_flatness::<Plain<S>>(&model, 1.0);
        let [patch] = prepared.patches.as_slice() else { panic!("one patch") };
        let critical = |d: [f64; 3], factor: f64| {
            let planes = planes(&prepared, add([0.0, 0.0, 0.015625], -3.0, d), d).unwrap();
            let crossing = patch.bounds().crossing(&planes).unwrap();
            patch.is_critical(&crossing, S::from_f64(factor))
        };
        assert!(!critical([0.0, 0.0, 1.0], 1.0), "along the normal");
        assert!(critical([1.0, 0.0, 0.0], 1.0) && critical([0.6, 0.8, 0.0], 1.0), "in the plane");
        // b/h is 2 / 0.03125 = 64 along an axis: tan α just below and above it.
        assert!(!critical([63.2, 0.0, 1.0], 1.0) && critical([64.8, 0.0, 1.0], 1.0));
        // The factor scales the bound.
        assert!(!critical([31.2, 0.0, 1.0], 0.5) && critical([32.8, 0.0, 1.0], 0.5));
        assert!(!critical([127.2, 0.0, -1.0], 2.0) && critical([128.8, 0.0, -1.0], 2.0));
        assert!(critical([1e-3, 0.0, 1.0], 0.0), "a factor of 0 flags all but the normal");
    }
    check::<f32>();
    check::<f64>();
}

#[test]
fn patches_at_the_depth_limit_are_always_critical() {
    let model = single(bumpy(31, [3, 3], [0.0; 3], 2.0, 1.0));
    for depth in 0..3 {
        let options = Subdivision { depth, flatness: 1e-6, ..Default::default() };
        let prepared = Prepared::<Plain<f64>>::new(&model, 1.0, &options);
        assert_eq!(prepared.patches.len(), 1 << (2 * depth));
        for patch in &prepared.patches {
            assert!(patch.domain().is_rough() && patch.domain().levels() == [depth; 2]);
            let aabb = patch.bounds().aabb();
            let unit = (-f64::from(prepared.scene().frame().exponent())).exp2();
            let centre = core::array::from_fn(|k| 0.5 * (aabb.low[k] + aabb.high[k]) * unit);
            let planes = planes(&prepared, add(centre, -5.0, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]).unwrap();
            let crossing = patch.bounds().crossing(&planes).unwrap();
            assert!(patch.is_critical(&crossing, f64::INFINITY) && !patch.at_most_once(&crossing));
        }
    }
    // Flat where it may be: none is rough.
    let prepared = at_flatness::<Plain<f64>>(&model, 1e-2);
    assert!(prepared.patches.iter().all(|p| !p.domain().is_rough()));
    // At the greatest depth the walls of domains are still exact, and the domains tile.
    let deep = Subdivision { depth: 99, flatness: 1.6e-9, ..Default::default() };
    let line = single(bumpy(32, [2, 1], [0.0; 3], 2.0, 1.0));
    let flat_in_v = Model::numbered(vec![patchray_host::scene::model::ModelSurface {
        points: (0..6).map(|k| [(k / 2) as f64, (k % 2) as f64, if k / 2 == 1 { 1.0 } else { 0.0 }, 1.0]).collect(),
        ..line.surfaces[0].clone()
    }]);
    let prepared =
        Prepared::<Plain<f64>>::with_grid(&flat_in_v, 1.0, &deep, &GridOptions { density: 0.01, voxels: 64 });
    assert_eq!(prepared.patches.len(), 1 << MAX_LEVEL);
    assert!(prepared.patches.iter().all(|p| p.domain().levels() == [MAX_LEVEL, 0]));
    for k in 0..=1000_u32 {
        let u = f64::from(k) / 1000.0;
        assert_eq!(prepared.patches.iter().filter(|p| p.domain().holds(u, 0.5)).count(), 1);
    }
}

#[test]
fn the_trees_links_add_up_and_lead_to_every_leaf() {
    fn check<S: Scalar>() {
        let prepared = at_flatness::<Plain<S>>(&teapot::model().unwrap(), 5e-3);
        let patches = prepared.patches();
        // Pre-order: a node's link is the sum of its two subtrees'.
        fn walk(links: &[u32], at: usize) -> usize {
            if links[at] == 1 {
                return at + 1;
            }
            let second = walk(links, at + 1);
            let end = walk(links, second);
            assert_eq!(links[at], links[at + 1] + links[second]);
            end
        }
        let mut at = 0;
        for number in 0..32 {
            let count = patches.of_surface(number).unwrap().len();
            assert_eq!(prepared.links[at] as usize, count);
            let end = walk(&prepared.links, at);
            assert_eq!(end - at, 2 * count - 1);
            at = end;
        }
        assert_eq!(at, prepared.links.len());
        assert_eq!(prepared.nodes.len(), prepared.patches.len() - 32);

        // With one box that the ray meets in every place, the descent meets all; with one that it passes, the root alone.
        let met = prepared.patches[0];
        let box_ = met.bounds().aabb();
        let unit = (-f64::from(prepared.scene().frame().exponent())).exp2();
        let centre = core::array::from_fn(|k| (box_.low[k] + box_.high[k]).to_f64() * 0.5 * unit);
        let planes = planes(&prepared, add(centre, -1.0, [0.5, 0.25, 1.0]), [0.5, 0.25, 1.0]).unwrap();
        let passed = *prepared.patches.iter().find(|p| !p.bounds().met(&planes)).unwrap().bounds();
        let all: Vec<Patch<S>> = vec![met; prepared.patches.len()];
        let all = Patches::new(&all, &prepared.first);
        let nodes = vec![*met.bounds(); prepared.nodes.len()];
        let limits = Limits::default();
        let count = |nodes: &[Parallelepiped<S>], number: usize| {
            let tree = Tree::new(nodes, &prepared.links);
            let mut descent = tree.of_surface(&all, number).unwrap();
            let (mut work, mut found) = (Work::default(), 0);
            while descent.next_patch(&planes, &limits, &mut work).unwrap().is_some() {
                found += 1;
            }
            (found, work.patches_tested, work.nodes_visited)
        };
        for number in 0..32 {
            let (first, end) =
                (prepared.first[number] as usize - number, prepared.first[number + 1] as usize - number - 1);
            let leaves = (end - first + 1) as u32;
            assert_eq!(count(&nodes, number), (leaves, leaves, leaves - 1));
            let mut gap = nodes.clone();
            gap[first] = passed;
            assert_eq!(count(&gap, number), (0, 0, 1));
            // A gap anywhere else leaves out its subtree: the inner nodes in pre-order, with their links.
            let links = &prepared.links[2 * prepared.first[number] as usize - number..];
            let inner: Vec<u32> = links[..2 * leaves as usize - 1].iter().copied().filter(|&l| l > 1).collect();
            for (k, &below) in inner.iter().enumerate().skip(1).step_by(7) {
                let mut gap = nodes.clone();
                gap[first + k] = passed;
                assert_eq!(count(&gap, number), (leaves - below, leaves - below, leaves - 1 - (below - 2)));
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

/// Whenever a patch claims that a ray meets it at most once, the oracle knows at most one root in its domain.
#[test]
fn at_most_once_is_never_wrong() {
    let mut random = Random(41);
    let (mut proved, mut refused, mut twice) = (0_u32, 0_u32, 0_u32);
    let mut rays = 0;
    for seed in 0..14 {
        let model = match seed {
            0 => single(paraboloid([0.1, -0.2, 0.0], 1.0)),
            1 => single(elevate(&paraboloid([0.1, -0.2, 0.0], 1.0), 5, 4)),
            _ => {
                let degrees = [[3, 3], [2, 2], [5, 5], [2, 4], [3, 1], [7, 3]][seed as usize % 6];
                single(bumpy(seed, degrees, [0.0; 3], 2.0, 0.2 + 0.05 * seed as f64))
            }
        };
        let oracle = Oracle::new(&model);
        for flatness in [0.3, 0.05, 0.01, 0.002] {
            let in_f32 = at_flatness::<Plain<f32>>(&model, flatness);
            let in_f64 = at_flatness::<Plain<f64>>(&model, flatness);
            for _ in 0..600 {
                // Through a point of the surface, mostly almost along it and a little above or below.
                let net = in_f64.scene().surface(0).unwrap().net;
                let [u, v] = [0, 1].map(|_| random.within(0.0, 1.0));
                let jet = net.jet(u, v, &mut Basis::<f64, 16>::new().view()).unwrap();
                let unit = (-f64::from(in_f64.scene().frame().exponent())).exp2();
                let [at, su, sv] = [jet.point, jet.du, jet.dv].map(|p| p.weighted_position().map(|c| c * unit));
                let d = if random.within(0.0, 1.0) < 0.4 {
                    direction(&mut random, 0.0)
                } else {
                    let across = cross(su, sv);
                    let along = add(su.map(|c| c * random.within(-1.0, 1.0)), random.within(-1.0, 1.0), sv);
                    let tilt = random.within(-1.0, 1.0) * 10.0_f64.powf(random.within(-4.0, 0.0));
                    add(along, tilt * norm(along) / norm(across), across)
                };
                let lift = random.within(-1.0, 1.0) * 10.0_f64.powf(random.within(-7.0, -1.0));
                let origin = add(add(at, lift, direction(&mut random, 0.0)), -4.0 / norm(d), d);
                // Exact in `f32`, so that all judge the same ray.
                let [origin, d] = [origin, d].map(|p| p.map(|c| f64::from(c as f32)));
                let roots = oracle.trace(origin, d, f64::NEG_INFINITY, f64::INFINITY).roots;
                rays += 1;
                let mut check = |domain: [[f64; 2]; 2], once: bool| {
                    let inside = |t: f64, [low, high]: [f64; 2]| low <= t && t <= high;
                    let number = roots.iter().filter(|r| inside(r.u, domain[0]) && inside(r.v, domain[1])).count();
                    assert!(!once || number <= 1, "{seed} {flatness} {domain:?} {origin:?} {d:?} {roots:?}");
                    proved += u32::from(once);
                    refused += u32::from(!once && number == 1);
                    twice += u32::from(number > 1);
                };
                if let Some(planes) = planes(&in_f32, origin, d) {
                    for patch in &in_f32.patches {
                        if let Some(crossing) = patch.bounds().crossing(&planes) {
                            check(patch.domain().bounds(), patch.at_most_once(&crossing));
                        }
                    }
                }
                if let Some(planes) = planes(&in_f64, origin, d) {
                    for patch in &in_f64.patches {
                        if let Some(crossing) = patch.bounds().crossing(&planes) {
                            check(patch.domain().bounds(), patch.at_most_once(&crossing));
                        }
                    }
                }
            }
        }
    }
    println!("{rays} rays: {proved} proved, {refused} with one root not proved, {twice} with several");
    assert!(rays > 10_000 && proved > 10_000 && twice > 1_000, "{proved} {refused} {twice}");
}
