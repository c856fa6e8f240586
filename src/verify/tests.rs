extern crate std;

use super::*;
use crate::arena::Arena;
use crate::domain::Domain;
use crate::frame::{Aabb, Frame};
use crate::grid::GridSlot;
use crate::measure::Measure;
use crate::point::Plain;
use crate::ray::Interval;
use crate::surface::Net;
use std::vec::Vec;

/// Sheets across z at these heights, each a patch of its own; of the last one the domain is the half beyond u = 1/2.
fn sheets(heights: &[f64]) -> Vec<Patch<f64>> {
    let sheet = |(k, &z): (usize, &f64)| {
        let points = [[-0.5, -0.5, z], [-0.5, 0.5, z], [0.5, -0.5, z], [0.5, 0.5, z]].map(Plain);
        let domain = Domain::WHOLE.halves(true)[usize::from(k + 1 == heights.len())];
        Measure::of(&Net::new(1, 1, &points).unwrap(), 1e-12).patch(domain)
    };
    heights.iter().enumerate().map(sheet).collect()
}

#[test]
fn the_list_holds_what_lies_between_point_and_origin_from_the_point_on() {
    let patches = sheets(&[-0.4, 0.3, 0.0, 0.2, -0.1, 0.1]);
    let boxes = |k: usize| patches[k].bounds().aabb();
    let (mut offsets, mut references) = ([0; 200], [0; 200]);
    let (mut a, mut b) = (Arena::new(&mut offsets[..]), Arena::new(&mut references[..]));
    let slot = GridSlot::build(patches.len(), boxes, 8.0, 100, &mut a, &mut b).unwrap();
    let grid = Grid::new(&slot, &offsets, &references).unwrap();
    let frame = Frame::new(Aabb { low: [-0.5; 3], high: [0.5; 3] });
    let ray = frame.ray([0.1, 0.2, -3.0], [0.0, 0.0, 1.0]).unwrap();
    let (planes, range) = frame.enter(&ray, &Interval::ahead()).unwrap();
    let list = |height: f64, u: f64, nearest: f64, limits: &Limits<f64>| {
        let depth = height - planes.origin()[2];
        let root = Root { u, v: 0.5, depth, grazing: false };
        let (mut listed, mut work) = (Vec::new(), Work::default());
        let end = testing_ray(&grid, &patches, &planes, &root, nearest, limits, &mut work, |item, _| {
            listed.push((patches.iter().position(|p| core::ptr::eq(p, item.patch)).unwrap(), item.owner));
            Ok(true)
        });
        (end, listed, work)
    };
    let limits = Limits::default();
    // The point on sheet 5 (height 0.1): it is the owner, the three sheets below it are in the way, those above are not.
    let (end, mut listed, work) = list(0.1, 0.75, range.min, &limits);
    assert_eq!((end, listed[0].1), (Ok(()), listed[0].0 == 5));
    listed.sort();
    assert_eq!(listed, [(0, false), (2, false), (4, false), (5, true)]);
    assert!(work.patches_tested >= 4 && work.voxels_visited > 0);
    // No farther back than asked.
    let (_, mut listed, _) = list(0.1, 0.75, 0.05 - planes.origin()[2], &limits);
    listed.sort();
    assert_eq!(listed, [(5, true)]);
    // A point of the other half has no owner there: all others hold it, but none of them is near.
    let (_, listed, _) = list(0.1, 0.25, range.min, &limits);
    assert!(listed.contains(&(5, false)));
    for (budget, limit) in [
        (Limits { voxels: 1, ..limits }, Limit::Voxels),
        (Limits { voxels: 0, ..limits }, Limit::Voxels),
        (Limits { patches: 2, ..limits }, Limit::Patches),
    ] {
        let (end, _, work) = list(0.1, 0.75, range.min, &budget);
        assert_eq!(end, Err(limit));
        assert!(work.voxels_visited <= budget.voxels && work.patches_tested <= budget.patches);
    }
    // An error of the visitor ends it.
    let root = Root { u: 0.75, v: 0.5, depth: 0.1 - planes.origin()[2], grazing: false };
    let mut visits = 0;
    let end = testing_ray(&grid, &patches, &planes, &root, 0.0, &limits, &mut Work::default(), |_, _| {
        visits += 1;
        Err(Limit::NewtonSteps)
    });
    assert_eq!((end, visits), (Err(Limit::NewtonSteps), 1));
}
