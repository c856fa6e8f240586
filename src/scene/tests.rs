//! The scene with a search that knows where its surfaces are.

extern crate std;

use super::*;
use crate::parameter::{Number, Parameter};
use crate::point::Plain;
use crate::ray::Incidence;
use crate::reading::Ours;
use std::vec;
use std::vec::Vec;

/// Sheets across z at these heights, over the square of side 1 about 0.
fn with_sheets<R>(heights: &[f64], with: impl FnOnce(&Scene<'_, Plain<f64>>) -> R) -> R {
    let points: Vec<[Plain<f64>; 4]> =
        heights.iter().map(|&z| [[-0.5, -0.5, z], [-0.5, 0.5, z], [0.5, -0.5, z], [0.5, 0.5, z]].map(Plain)).collect();
    let nets: Vec<_> = points.iter().map(|p| Net::new(1, 1, p).unwrap()).collect();
    let (mut points, mut surfaces) = (vec![Plain::EMPTY; 4 * nets.len()], vec![SurfaceSlot::EMPTY; nets.len()]);
    let (mut offsets, mut references) = (vec![0; 1000], vec![0; 1000]);
    let memory = SceneMemory {
        points: &mut points,
        surfaces: &mut surfaces,
        offsets: &mut offsets,
        references: &mut references,
    };
    with(&Scene::build(&nets, &SceneOptions::default(), memory).unwrap())
}

/// A search that knows the sheets' depths, and notes which surfaces it was asked about.
fn search(
    scene: &Scene<'_, Plain<f64>>,
    interval: &Interval<f64>,
    limits: &Limits<f64>,
    asked: &mut Vec<u32>,
) -> Result<Option<Hit<f64>>, GaveUp<f64>> {
    let ray = scene.ray([0.1, 0.2, -4.0], [0.0, 0.0, 2.0]).unwrap();
    scene.closest(Ours, &ray, interval, limits, &mut Work::default(), |surface, planes, range, _| {
        asked.push(surface.number);
        let depth = planes.point(&surface.net.points()[0].0).depth;
        let inside = range.min <= depth && depth <= range.max;
        Ok(inside.then_some(Root {
            u: Number::new(0.5),
            v: Number::new(0.5),
            depth,
            incidence: Incidence::Crossing,
            turned: false,
        }))
    })
}

#[test]
fn the_closest_of_many_wins_and_what_is_behind_it_is_left_alone() {
    let heights = [0.9, -0.3, 0.5, -0.8, 0.2];
    with_sheets(&heights, |scene| {
        let (limits, mut asked) = (Limits::default(), vec![]);
        let hit = search(scene, &Interval::ahead(), &limits, &mut asked).unwrap().unwrap();
        assert_eq!((hit.surface, hit.t), (3, 1.6));
        assert!(asked.len() < heights.len() && asked.contains(&3), "{asked:?}");
        // Each surface is asked at most once, and within an interval only those that it reaches.
        let number = asked.len();
        asked.sort();
        asked.dedup();
        assert_eq!(asked.len(), number);
        asked.clear();
        let hit = search(scene, &Interval::new(1.9, 2.05).unwrap(), &limits, &mut asked).unwrap();
        assert_eq!((hit, asked.as_slice()), (None, &[][..]));
        let hit = search(scene, &Interval::new(1.7, 100.0).unwrap(), &limits, &mut asked).unwrap().unwrap();
        assert_eq!(hit.surface, 1);
        // Behind the origin.
        let hit = search(scene, &Interval::new(-9.0, -1.0).unwrap(), &limits, &mut asked).unwrap();
        assert_eq!(hit, None);
    });
}

#[test]
fn of_equal_depths_the_lower_number_wins() {
    for heights in [[0.0, 0.0, 0.5, 0.0], [0.25, 0.0, 0.0, 0.0]] {
        with_sheets(&heights, |scene| {
            let hit = search(scene, &Interval::ahead(), &Limits::default(), &mut vec![]).unwrap().unwrap();
            assert_eq!(hit.surface, heights.iter().position(|&z| z == 0.0).unwrap() as u32);
        });
    }
}

#[test]
fn budgets_of_the_scene_are_named_and_carry_the_best_so_far() {
    with_sheets(&[0.9, -0.3, 0.5, -0.8, 0.2], |scene| {
        let none = Limits { surfaces: 0, ..Limits::default() };
        let gave_up = search(scene, &Interval::ahead(), &none, &mut vec![]).unwrap_err();
        assert_eq!(gave_up, GaveUp { limit: Limit::Surfaces, best: None });
        let none = Limits { voxels: 0, ..Limits::default() };
        let gave_up = search(scene, &Interval::ahead(), &none, &mut vec![]).unwrap_err();
        assert_eq!(gave_up, GaveUp { limit: Limit::Voxels, best: None });
    });
    // Two sheets in one voxel: the first found is no answer yet.
    with_sheets(&[0.0, -1e-9], |scene| {
        let one = Limits { surfaces: 1, ..Limits::default() };
        let gave_up = search(scene, &Interval::ahead(), &one, &mut vec![]).unwrap_err();
        assert_eq!((gave_up.limit, gave_up.best.map(|hit| hit.surface)), (Limit::Surfaces, Some(0)));
    });
}

#[test]
fn bad_surfaces_are_named_and_an_empty_scene_is_missed() {
    let nan = [Plain([0.0, f64::NAN, 0.0]); 4];
    let good = [Plain([0.0; 3]); 4];
    let nets = [Net::new(1, 1, &good).unwrap(), Net::new(1, 1, &nan).unwrap()];
    let memory = SceneMemory { points: &mut [], surfaces: &mut [], offsets: &mut [], references: &mut [] };
    let refused = Scene::build(&nets, &SceneOptions::default(), memory).err();
    assert_eq!(refused, Some(SceneError::Surface { surface: 1, error: NetError::NotFinite(0) }));
    with_sheets(&[], |scene| {
        assert!(scene.is_empty() && scene.surface(0).is_none());
        let ray = scene.ray([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]).unwrap();
        let found =
            scene.closest(Ours, &ray, &Interval::ahead(), &Limits::default(), &mut Work::default(), |_, _, _, _| {
                panic!("there is nothing to search")
            });
        assert_eq!(found, Ok(None));
    });
}

/// A sheet of side 1 about `own`, before one of side 1000: given relative to that, or not.
fn with_small<R>(own: [f32; 3], with: impl FnOnce(Result<Scene<'_, Plain<f32>>, SceneError>) -> R) -> R {
    let sheet = |half: f32| [[-half, -half, 0.0], [-half, half, 0.0], [half, -half, 0.0], [half, half, 0.0]].map(Plain);
    let (small, large) = (sheet(0.5), sheet(500.0));
    let nets = [&small, &large].map(|points| Net::new(1, 1, points).unwrap());
    let (mut points, mut surfaces) = ([Plain::EMPTY; 8], [SurfaceSlot::EMPTY; 2]);
    let (mut offsets, mut references) = ([0; 1000], [0; 1000]);
    let memory = SceneMemory {
        points: &mut points,
        surfaces: &mut surfaces,
        offsets: &mut offsets,
        references: &mut references,
    };
    with(Scene::build_apart(&nets, &[own], &SceneOptions::default(), memory))
}

#[test]
fn a_surface_with_an_origin_of_its_own_is_met_to_its_own_rounding() {
    let own = [300.5_f32, -200.25, 130.0];
    with_small(own, |scene| {
        let scene = scene.unwrap();
        for direction in [[0.0, 0.0, -1.0_f32], [0.3, -0.2, -1.0], [-0.7, 0.9, -1.0], [1.0, 0.4, -0.1]] {
            // From above a point of the sheet, to about the origin's rounding.
            let height = -2.0 * direction[2];
            let from = [0.25 - 2.0 * direction[0], 0.125 - 2.0 * direction[1], height];
            let origin: [f32; 3] = core::array::from_fn(|k| own[k] + from[k]);
            let ray = scene.ray(origin, direction).unwrap();
            // Where it meets the sheet's plane, in the sheet's coordinates.
            let from: [f64; 3] = core::array::from_fn(|k| f64::from(origin[k]) - f64::from(own[k]));
            let t = from[2] / -f64::from(direction[2]);
            let on: [f64; 3] = core::array::from_fn(|k| from[k] + t * f64::from(direction[k]));
            let mut met = false;
            let (work, scale) = (&mut Work::default(), scene.frame().scale());
            let visited = scene.visit(&ray, &Interval::ahead(), &Limits::default(), work, |surface, planes, _, _| {
                if surface.number == 0 {
                    met = true;
                    let point = planes.point(&on.map(|c| c as f32 * scale));
                    let off = (point.f.abs() + point.g.abs()) / scale;
                    assert!(off <= 4.0 * f32::EPSILON, "{direction:?}: {off:e}");
                    assert!((f64::from(planes.t(point.depth)) - t).abs() <= 2.0 * f64::from(f32::EPSILON) * t);
                }
                Ok(f32::INFINITY)
            });
            visited.unwrap();
            assert!(met, "{direction:?}");
        }
    });
}

#[test]
fn a_surface_that_would_vanish_beside_another_is_refused() {
    let sheet = |half: f32| [[-half, -half, 0.0], [-half, half, 0.0], [half, -half, 0.0], [half, half, 0.0]].map(Plain);
    let build = |small: [Plain<f32>; 4], large: [Plain<f32>; 4]| {
        let nets = [&small, &large].map(|points| Net::new(1, 1, points).unwrap());
        let memory = SceneMemory { points: &mut [], surfaces: &mut [], offsets: &mut [], references: &mut [] };
        Scene::build(&nets, &SceneOptions::default(), memory).err()
    };
    let expected = Some(SceneError::Surface { surface: 0, error: NetError::Small });
    for (half, large) in [(1e-30, 1e17), (1e-38, 1e-3), (1e-2, 3e38)] {
        assert_eq!(build(sheet(half), sheet(large)), expected, "{half:e} {large:e}");
    }
    // As small as the number type holds in full; and one that is a point, or alone.
    for (half, large) in [(1e-30, 1e-2), (1.0, 1e30), (0.0, 1e30), (1e-44, 1e-44)] {
        assert!(matches!(build(sheet(half), sheet(large)), Some(SceneError::Memory(_))), "{half:e} {large:e}");
    }
}

#[test]
fn an_origin_far_from_its_net_is_refused() {
    let expected = SceneError::Surface { surface: 0, error: NetError::Origin };
    for own in [[f32::NAN, 0.0, 0.0], [0.0, f32::NEG_INFINITY, 0.0]] {
        with_small(own, |scene| assert_eq!(scene.err(), Some(expected), "{own:?}"));
    }
    with_small([1e30, 0.0, 0.0], |scene| assert!(scene.is_ok()));
    // Points that are not finite beside it, and those of a surface as large as the scene.
    for (size, own) in [(f32::MAX, f32::MAX), (1.0, 0.5)] {
        let sheet = [[-size, -size, 0.0], [-size, size, 0.0], [size, -size, 0.0], [size, size, 0.0]].map(Plain);
        let memory = SceneMemory { points: &mut [], surfaces: &mut [], offsets: &mut [], references: &mut [] };
        let nets = [Net::new(1, 1, &sheet).unwrap()];
        let built = Scene::build_apart(&nets, &[[own, 0.0, 0.0]], &SceneOptions::default(), memory);
        assert_eq!(built.err(), Some(expected));
    }
}
