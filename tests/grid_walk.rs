//! The walk through the grids of real patches: what it tests is what brute force says that it has to.

mod common;

use common::{Kind, Prepared, direction, index};
use patchray::limits::{Limits, Work};
use patchray::method::{Scratch, newton_coherent};
use patchray::point::Plain;
use patchray::ray::Interval;
use patchray::reading::Ours;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{Random, bumpy, single};
use patchray_host::scene::teapot;
use std::collections::BTreeSet;

/// A line in the caller's coordinates: any, along an axis with zeros of either sign, in a plane across one.
fn line(random: &mut Random, low: [f64; 3], high: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let target: [f64; 3] = core::array::from_fn(|k| {
        // Now and then on a face of the scene's box, where walls are.
        match index(random, 8) {
            0 => low[k],
            1 => high[k],
            2 => 0.5 * (low[k] + high[k]),
            _ => random.within(low[k], high[k]),
        }
    });
    let mut d = direction(random, 2.0);
    let axis = index(random, 3);
    let kind = index(random, 4);
    for k in 0..3 {
        if kind == 2 && k != axis || kind == 3 && k == axis {
            d[k] = if index(random, 2) == 0 { 0.0 } else { -0.0 };
        }
    }
    let back = [0.0, 0.5, 3.0, -0.5][index(random, 4)];
    let length = common::norm(d);
    (common::add(target, -back / length, d), d)
}

fn check<S: Scalar>(model: &Model, rays: u32, seed: u64)
where
    Plain<S>: Kind<Scalar = S>,
{
    let prepared = Prepared::<Plain<S>>::new(model, 1.0, &Subdivision::default());
    // The same patches in boxes padded by half as much: a line that meets one of these meets the grid's by more than rounding.
    let padding = Subdivision::<S>::default().padding / 2;
    let lean = Prepared::<Plain<S>>::new(model, 1.0, &Subdivision { padding, ..Default::default() });
    assert_eq!(prepared.patches.len(), lean.patches.len());
    let (scene, patches, grids) = (prepared.scene(), prepared.patches(), prepared.grids());
    let limits = Limits::default();
    let control_box = model.control_box().unwrap();
    let mut random = Random(seed);
    let mut memory = vec![patchray::method::Remembered::EMPTY; scene.len()];
    let mut scratch = Scratch::<Plain<S>, 16, 256>::new();
    let (mut misses, mut tested) = (0_u32, 0_u64);
    for number in 0..rays {
        let (origin, d) = line(&mut random, control_box.min, control_box.max);
        let ray = scene.ray(origin.map(S::from_f64), d.map(S::from_f64)).unwrap();
        let interval = match index(&mut random, 3) {
            0 => Interval::ahead(),
            1 => Interval::new(-S::INFINITY, S::INFINITY).unwrap(),
            _ => Interval::new(S::ZERO, S::from_f64(1.0 / common::norm(d))).unwrap(),
        };
        let mut sum = 0;
        let mut work = Work::default();
        let searched = scene.closest(Ours, &ray, &interval, &limits, &mut work, |surface, planes, range, _| {
            let k = surface.number as usize;
            let grid = grids.of_surface(k).unwrap();
            let (mut found, mut set) = (0_usize, BTreeSet::new());
            if let Some((mut walk, _)) = grid.enter(planes, &range) {
                while let Some(voxel) = walk.advance() {
                    let mut voxel = voxel.unwrap();
                    while let Some(item) = voxel.next_fresh() {
                        found += 1;
                        set.insert(item);
                    }
                }
            }
            assert_eq!(found, set.len(), "a patch came up twice");
            for (item, patch) in lean.patches().of_surface(k).unwrap().iter().enumerate() {
                let within = |[first, last]: [patchray::patch::Pierce<S>; 2]| {
                    first.depth <= range.max && last.depth >= range.min
                };
                if let Some(crossing) = patch.bounds().crossing(planes) {
                    let met = crossing.overlaps(&range) && crossing.pierces().is_some_and(within);
                    assert!(!met || set.contains(&item), "patch {item} of {k} is left out: {origin:?} {d:?}");
                }
            }
            assert_eq!(patches.of_surface(k).unwrap().len(), lean.patches().of_surface(k).unwrap().len());
            sum += found as u32;
            Ok(None)
        });
        assert_eq!(searched, Ok(None));
        // A ray that meets nothing is a full search of each surface: it tests each patch of the set, once.
        let (mut work, view) = (Work::default(), &mut scratch.view());
        let answer = newton_coherent::closest(
            &scene,
            &patches,
            &grids,
            &mut memory,
            number,
            &ray,
            &interval,
            &limits,
            view,
            &mut work,
        );
        if answer == Ok(None) && work.intersection_points == 0 {
            misses += 1;
            tested += u64::from(work.patches_tested);
            assert_eq!(work.patches_tested, sum);
        }
    }
    println!("{rays} lines, {misses} misses, which tested {tested} patches");
    assert!(misses > rays / 20 && tested > u64::from(rays / 20));
}

#[test]
fn the_teapots_grids() {
    check::<f32>(&teapot::model().unwrap(), 3000, 61);
    check::<f64>(&teapot::model().unwrap(), 3000, 62);
}

#[test]
fn grids_of_single_surfaces() {
    for seed in 0..4 {
        let degrees = [[3, 3], [2, 7], [15, 15], [4, 1]][seed as usize];
        let model = single(bumpy(seed, degrees, [0.2, -0.3, 0.1], 2.0, 0.6));
        check::<f32>(&model, 1000, seed);
        check::<f64>(&model, 1000, seed);
    }
}

/// Flat surfaces in planes across the axes: grids one voxel thick, and lines that run in that voxel.
#[test]
fn flat_grids() {
    for k in 0..3 {
        let surfaces = (0..5).map(|n| {
            // Uneven parameters in a plane: many patches, all flat.
            let mut flat = bumpy(n, [3, 4], [0.0, 0.0, [0.0, 0.25, 0.5, 0.5, 0.75][n as usize]], 1.5, 0.0);
            for point in &mut flat.points {
                point[..3].rotate_right(k);
            }
            flat
        });
        let model = Model::numbered(surfaces.collect());
        check::<f32>(&model, 1000, k as u64);
        check::<f64>(&model, 1000, k as u64);
    }
}
