//! The walk against brute force over all items, with the grid's insides in view: voxels, walls, references.

extern crate std;

use super::*;
use crate::arena::Arena;
use crate::frame::{Aabb, PADDING};
use crate::grid::{GridSlot, ITEM_BITS};
use patchray_host::scene::shapes::Random;
use std::collections::BTreeSet;
use std::vec::Vec;

/// A grid over boxes, with the memory that it lies in.
struct Built<S> {
    slot: GridSlot<S>,
    offsets: Vec<u32>,
    references: Vec<u32>,
    boxes: Vec<Aabb<S>>,
}

impl<S: Scalar> Built<S> {
    /// A grid over `boxes`, padded as patches' boxes are.
    fn new(boxes: Vec<Aabb<S>>, density: f64) -> Self {
        let padding = S::EPSILON * S::from_u32(PADDING);
        let of = |k: usize| boxes[k].padded(padding);
        let build = |offsets: &mut [u32], references: &mut [u32]| {
            let (mut offsets, mut references) = (Arena::new(offsets), Arena::new(references));
            let slot =
                GridSlot::build(boxes.len(), of, S::from_f64(density), 1 << 16, &mut offsets, &mut references).unwrap();
            (slot, offsets.len(), references.len())
        };
        let (_, offsets, references) = build(&mut [], &mut []);
        let (mut offsets, mut references) = (std::vec![0; offsets], std::vec![0; references]);
        let (slot, ..) = build(&mut offsets, &mut references);
        Built { slot, offsets, references, boxes }
    }

    fn grid(&self) -> Grid<'_, S> {
        Grid::new(&self.slot, &self.offsets, &self.references).unwrap()
    }

    /// Walks a line and checks all that a walk promises.
    fn check(&self, start: [S; 3], direction: [S; 3], length: S) {
        let inverse = direction.map(|c| S::ONE / c);
        let mut walk = self.grid().walk(&start, &inverse, length);
        let (mut fresh, mut touched, mut voxels) = (Vec::new(), BTreeSet::new(), Vec::new());
        let mut last_exit = -S::INFINITY;
        loop {
            let number = walk.voxel as u32;
            let [x, y, _] = self.slot.counts;
            let at = [number % x, number / x % y, number / (x * y)];
            let Some(voxel) = walk.advance() else { break };
            let mut voxel = voxel.unwrap();
            touched.extend(voxel.references.iter().map(|&r| (r & ((1 << ITEM_BITS) - 1)) as usize));
            assert!(last_exit <= voxel.exit && voxel.exit <= length, "{last_exit:?} {:?}", voxel.exit);
            last_exit = voxel.exit;
            fresh.extend(core::iter::from_fn(|| voxel.next_fresh()));
            voxels.push(at);
        }
        assert!(voxels.len() <= self.slot.longest_walk() as usize);
        for pair in voxels.windows(2) {
            let steps: u32 = (0..3).map(|k| pair[0][k].abs_diff(pair[1][k])).sum();
            assert_eq!(steps, 1, "{voxels:?}");
        }
        // Each item of each voxel on the way, once.
        let set: BTreeSet<_> = fresh.iter().copied().collect();
        assert_eq!(set.len(), fresh.len(), "an item came up twice on {start:?} {direction:?}");
        assert_eq!(set, touched);
        // And each item that the line meets; its own box, so that padding covers the rounding of walk and brute force.
        for (k, item) in self.boxes.iter().enumerate() {
            if let Some((near, far)) = item.depths(&start, &inverse) {
                if near <= length && far >= S::ZERO {
                    assert!(set.contains(&k), "item {k} is left out on {start:?} {direction:?} {length:?}: {item:?}");
                }
            }
        }
    }
}

fn boxes<S: Scalar>(random: &mut Random, count: usize, half: [f64; 3]) -> Vec<Aabb<S>> {
    let one = |random: &mut Random| {
        let size = 10.0_f64.powf(random.within(-3.0, -0.3));
        let (mut low, mut high) = ([S::ZERO; 3], [S::ZERO; 3]);
        for k in 0..3 {
            let centre = random.within(-half[k], half[k]);
            let reach = random.within(0.0, size * half[k]);
            (low[k], high[k]) = (S::from_f64(centre - reach), S::from_f64(centre + reach));
        }
        Aabb { low, high }
    };
    (0..count).map(|_| one(random)).collect()
}

/// A line's start, direction and length: any, from inside, along axes, along walls, through edges and corners of voxels.
fn line<S: Scalar>(built: &Built<S>, random: &mut Random) -> ([S; 3], [S; 3], S) {
    let slot = &built.slot;
    let pick = |random: &mut Random, below: u32| (random.within(0.0, f64::from(below)) as u32).min(below - 1);
    let wall = |random: &mut Random, k: usize| {
        let wall = pick(random, slot.counts[k] + 1);
        slot.bounds.low[k] + S::from_u32(wall) * slot.cell[k]
    };
    let inside = |random: &mut Random, k: usize| {
        slot.bounds.low[k] + slot.bounds.sides()[k] * S::from_f64(random.within(0.0, 1.0))
    };
    let mut target: [S; 3] = core::array::from_fn(|k| inside(random, k));
    let mut direction = random.point(1.0).map(S::from_f64);
    let kind = pick(random, 6);
    if kind >= 3 {
        // Along one axis, or in a plane across one: zeros of both signs.
        let axis = pick(random, 3) as usize;
        for k in 0..3 {
            if (kind == 3) == (k != axis) {
                direction[k] = if random.within(0.0, 1.0) < 0.5 { S::ZERO } else { -S::ZERO };
            }
        }
        if random.within(0.0, 1.0) < 0.7 {
            target = core::array::from_fn(|k| if direction[k] == S::ZERO { wall(random, k) } else { target[k] });
        }
    }
    if kind == 2 {
        // Through a corner of voxels, at 45 degrees where voxels are cubes.
        target = core::array::from_fn(|k| wall(random, k));
        direction = core::array::from_fn(|k| if random.within(0.0, 1.0) < 0.5 { slot.cell[k] } else { -slot.cell[k] });
    }
    // As the planes have it: 1 along the steepest axis.
    let speed = S::ZERO.greater(direction[0].abs()).greater(direction[1].abs()).greater(direction[2].abs());
    if !(speed > S::ZERO) {
        direction = [S::ONE, S::ZERO, S::ZERO];
    } else {
        direction = direction.map(|c| c / speed);
    }
    // From the target itself, or from where the line enters the grid's box.
    let inverse = direction.map(|c| S::ONE / c);
    match slot.bounds.depths(&target, &inverse) {
        Some((near, far)) if kind != 1 => {
            (core::array::from_fn(|k| target[k] + direction[k] * near), direction, far - near)
        }
        Some((_, far)) => (target, direction, far.greater(S::ZERO)),
        None => (target, direction, S::ONE),
    }
}

fn against_brute_force<S: Scalar>() {
    let mut random = Random(51);
    for (count, half) in [
        (1, [0.5; 3]),
        (40, [0.5; 3]),
        (300, [0.75; 3]),
        // Flat, as the grid of a flat surface is, and thin as a needle.
        (100, [0.75, 0.5, 0.0]),
        (100, [0.0, 0.75, 0.75]),
        (60, [0.75, 1e-4, 0.5]),
        (60, [1e-5, 0.0, 0.75]),
        (10, [0.0; 3]),
    ] {
        for density in [0.5, 4.0, 30.0] {
            let built = Built::new(boxes::<S>(&mut random, count, half), density);
            for _ in 0..1500 {
                let (start, direction, length) = line(&built, &mut random);
                built.check(start, direction, length);
            }
        }
    }
}

#[test]
fn a_walk_meets_what_brute_force_meets_f32() {
    against_brute_force::<f32>();
}

#[test]
fn a_walk_meets_what_brute_force_meets_f64() {
    against_brute_force::<f64>();
}

#[test]
fn lines_that_pass_the_grid_by_and_grids_without_voxels() {
    let mut random = Random(52);
    let built = Built::new(boxes::<f64>(&mut random, 20, [0.5; 3]), 4.0);
    let frame = crate::frame::Frame::new(Aabb { low: [-0.9; 3], high: [0.9; 3] });
    let ahead = crate::ray::Interval::ahead();
    let ray = frame.ray([0.8, 0.8, -0.9], [0.0, 0.0, 1.0]).unwrap();
    let (planes, range) = frame.enter(&ray, &ahead).unwrap();
    assert!(built.grid().enter(&planes, &range).is_none());
    let ray = frame.ray([0.1, 0.2, -0.9], [0.0, 0.0, 1.0]).unwrap();
    let (planes, range) = frame.enter(&ray, &ahead).unwrap();
    let (mut walk, begin) = built.grid().enter(&planes, &range).unwrap();
    assert!(walk.advance().unwrap().is_ok() && begin > 0.0);
    // Behind what the range holds.
    let short = DepthRange { min: 0.0, max: begin * 0.5 };
    assert!(built.grid().enter(&planes, &short).is_none());
}

#[test]
fn offsets_that_lead_nowhere_end_the_walk() {
    let mut random = Random(53);
    let mut built = Built::new(boxes::<f32>(&mut random, 20, [0.5; 3]), 4.0);
    built.offsets.fill(OFFSET_MASK);
    let mut walk = built.grid().walk(&[0.0; 3], &[1.0, f32::INFINITY, f32::INFINITY], 1.0);
    assert!(walk.advance().unwrap().is_err());
    assert!(walk.advance().is_none());
    // NaN in a line ends it too.
    let built = Built::new(boxes::<f32>(&mut random, 20, [0.5; 3]), 4.0);
    let mut walk = built.grid().walk(&[f32::NAN; 3], &[f32::NAN; 3], f32::NAN);
    assert!(walk.advance().unwrap().is_ok());
    assert!(walk.advance().is_none());
}
