extern crate std;

use super::*;
use crate::arena::Arena;
use crate::domain::Domain;
use crate::frame::{Aabb, Frame};
use crate::grid::{Grid, GridSlot};
use crate::measure::Measure;
use crate::parameter::Number;
use crate::point::Plain;
use crate::ray::{Incidence, Interval};
use crate::reading::Ours;
use crate::surface::Net;
use crate::sweep::InGrid;
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
        let root =
            Root { u: Number::new(u), v: Number::new(0.5), depth, incidence: Incidence::Crossing, turned: false };
        let (mut listed, mut work) = (Vec::new(), Work::default());
        let end =
            testing_ray(&InGrid { grid, patches: &patches }, &planes, &root, nearest, limits, &mut work, |item, _| {
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
    let root = Root {
        u: Number::new(0.75),
        v: Number::new(0.5),
        depth: 0.1 - planes.origin()[2],
        incidence: Incidence::Crossing,
        turned: false,
    };
    let mut visits = 0;
    let end =
        testing_ray(&InGrid { grid, patches: &patches }, &planes, &root, 0.0, &limits, &mut Work::default(), |_, _| {
            visits += 1;
            Err(Limit::NewtonSteps)
        });
    assert_eq!((end, visits), (Err(Limit::NewtonSteps), 1));
}

/// A point on a sheet whose domain is [1/2, 1] in u, with another sheet before it, of a domain that adjoins it or does not;
/// asked for yes or no.
#[test]
fn a_point_is_the_closest_or_critical_or_hidden_by_a_neighbour_or_by_another() {
    let [low, high] = Domain::WHOLE.halves(true);
    let frame = Frame::new(Aabb { low: [-0.5; 3], high: [0.5; 3] });
    let sheet = |z: f64, domain: Domain| {
        let points = [[-0.5, -0.5, z], [-0.5, 0.5, z], [0.5, -0.5, z], [0.5, 0.5, z]].map(Plain);
        Measure::of(&Net::new(1, 1, &points).unwrap(), 1e-12).patch(domain)
    };
    let ask = |patches: &[Patch<f64>], u: f64, factor: f64| {
        let boxes = |k: usize| patches[k].bounds().aabb();
        let (mut offsets, mut references) = ([0; 200], [0; 200]);
        let (mut a, mut b) = (Arena::new(&mut offsets[..]), Arena::new(&mut references[..]));
        let slot = GridSlot::build(patches.len(), boxes, 8.0, 100, &mut a, &mut b).unwrap();
        let grid = Grid::new(&slot, &offsets, &references).unwrap();
        let ray = frame.ray([0.1, 0.2, -3.0], [0.0, 0.01, 1.0]).unwrap();
        let (planes, range) = frame.enter(&ray, &Interval::ahead()).unwrap();
        let root = Root {
            u: Number::new(u),
            v: Number::new(0.5),
            depth: 0.1 - planes.origin()[2],
            incidence: Incidence::Crossing,
            turned: false,
        };
        let limits = Limits { critical_factor: factor, ..Limits::default() };
        verdict(Ours, &InGrid { grid, patches }, &planes, &root, range.min, &limits, &mut Work::default()).unwrap()
    };
    let owner = sheet(0.1, high);
    assert_eq!(ask(&[owner], 0.75, 1.0), Verdict::Closest);
    // Behind the point nothing hides it.
    assert_eq!(ask(&[owner, sheet(0.3, low)], 0.75, 1.0), Verdict::Closest);
    assert_eq!(ask(&[owner, sheet(-0.2, low)], 0.75, 1.0), Verdict::Hidden { by_neighbour: true });
    let far = low.halves(true)[0];
    assert_eq!(ask(&[sheet(-0.2, far), owner], 0.75, 1.0), Verdict::Hidden { by_neighbour: false });
    // Eq. (1) comes before the list; a patch that is not flat is always critical; and so is a point that nobody holds.
    assert_eq!(ask(&[owner, sheet(-0.2, low)], 0.75, 0.0), Verdict::Critical);
    assert_eq!(ask(&[sheet(0.1, high.rough())], 0.75, 1.0), Verdict::Critical);
    assert_eq!(ask(&[owner], 0.25, 1.0), Verdict::Critical);
}
