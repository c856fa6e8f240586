//! The walk of a line through a regular grid, voxel by voxel, front to back.
//!
//! Source: Cleary and Wyvill (1988). The distance to each wall is computed afresh from the wall's number rather than by
//! adding up steps, so that its rounding does not grow along the way.

use crate::grid::{Grid, ITEM_BITS, ITEM_MASK};
use crate::planes::{DepthRange, Planes};
use crate::scalar::Scalar;

/// One voxel on the way of a line.
#[derive(Clone, Copy, Debug)]
pub struct Voxel<'m, S> {
    references: &'m [u32],
    /// The neighbour bit of the voxel that the line came from; 0 in the first voxel.
    came_from: u32,
    /// Where the line leaves the voxel, counted from the walk's start; at most the walk's length.
    pub exit: S,
}

impl<'m, S: Scalar> Voxel<'m, S> {
    /// The items that the line meets here for the first time.
    #[inline(always)]
    pub fn fresh(&self) -> impl Iterator<Item = usize> + use<'m, S> {
        let came_from = self.came_from;
        self.references.iter().filter(move |&&r| r & came_from == 0).map(|&r| (r & ITEM_MASK) as usize)
    }
}

/// The way of a line through a grid, voxel by voxel.
#[derive(Clone, Copy, Debug)]
pub struct Walk<'m, S> {
    grid: Grid<'m, S>,
    /// The voxel's index along each axis.
    at: [u32; 3],
    /// Where the line crosses the next wall across each axis.
    next: [S; 3],
    /// The number of walls of each axis crossed or about to be, and where the line crosses wall k: `base + k · step`.
    walls: [S; 3],
    base: [S; 3],
    step: [S; 3],
    forward: [bool; 3],
    length: S,
    came_from: u32,
    done: bool,
}

impl<'m, S: Scalar> Grid<'m, S> {
    /// The walk of a ray through what of a range of depths lies in the grid's box, and the depth where it begins; `None` if
    /// the ray passes the grid by.
    #[inline(always)]
    pub fn enter(&self, planes: &Planes<S>, range: &DepthRange<S>) -> Option<(Walk<'m, S>, S)> {
        let (origin, direction, inverse) = (planes.origin(), planes.direction(), planes.inverse());
        let (near, far) = self.slot.bounds.depths(&origin, &inverse)?;
        let (begin, end) = (near.greater(range.min), far.lesser(range.max));
        if !(begin <= end) {
            return None;
        }
        let start = core::array::from_fn(|k| origin[k] + direction[k] * begin);
        Some((self.walk(&start, &direction, &inverse, end - begin), begin))
    }

    /// The walk along `start + s · direction` for s in [0, `length`]; `inverse` is 1 / `direction` by component. `start`
    /// should be inside the grid, or so near that rounding explains it.
    #[inline(always)]
    pub fn walk(&self, start: &[S; 3], direction: &[S; 3], inverse: &[S; 3], length: S) -> Walk<'m, S> {
        let slot = self.slot;
        let mut walk = Walk {
            grid: *self,
            at: [0; 3],
            next: [S::INFINITY; 3],
            walls: [S::ZERO; 3],
            base: [S::ZERO; 3],
            step: [S::ZERO; 3],
            forward: [false; 3],
            length,
            came_from: 0,
            done: slot.counts.contains(&0),
        };
        for k in 0..3 {
            walk.at[k] = slot.index(start[k], k);
            if direction[k] == S::ZERO || !inverse[k].is_finite() {
                continue;
            }
            // Walls are counted in the line's direction, from the one behind the first voxel.
            walk.forward[k] = direction[k] > S::ZERO;
            let wall = if walk.forward[k] { walk.at[k] } else { walk.at[k] + 1 };
            walk.base[k] = (slot.bounds.low[k] + S::from_u32(wall) * slot.cell[k] - start[k]) * inverse[k];
            walk.step[k] = slot.cell[k] * inverse[k].abs();
            walk.walls[k] = S::ONE;
            walk.next[k] = walk.base[k] + walk.step[k];
        }
        walk
    }
}

impl<'m, S: Scalar> Walk<'m, S> {
    /// The next voxel; `Err` if the lent memory leads nowhere. Ends: each step crosses a wall, of which there are at most
    /// [`GridSlot::longest_walk`].
    #[inline(always)]
    pub fn advance(&mut self) -> Option<Result<Voxel<'m, S>, ()>> {
        if self.done {
            return None;
        }
        let counts = &self.grid.slot.counts;
        let voxel = ((self.at[2] * counts[1] + self.at[1]) * counts[0] + self.at[0]) as usize;
        let offsets = self.grid.offsets;
        let references = match (offsets.get(voxel), offsets.get(voxel + 1)) {
            (Some(&begin), Some(&end)) => self.grid.references.get(begin as usize..end as usize),
            _ => None,
        };
        let Some(references) = references else {
            self.done = true;
            return Some(Err(()));
        };
        let [x, y, z] = self.next;
        let axis = if x <= y {
            if x <= z { 0 } else { 2 }
        } else if y <= z {
            1
        } else {
            2
        };
        let exit = self.next[axis];
        let found = Voxel { references, came_from: self.came_from, exit: exit.lesser(self.length) };
        // A NaN ends the walk here.
        if !(exit < self.length) || !self.cross_wall(axis) {
            self.done = true;
        }
        Some(Ok(found))
    }

    /// Moves to the next voxel along an axis; false at the grid's border.
    #[inline(always)]
    fn cross_wall(&mut self, axis: usize) -> bool {
        self.walls[axis] += S::ONE;
        self.next[axis] = self.base[axis] + self.walls[axis] * self.step[axis];
        if self.forward[axis] {
            self.came_from = 1 << (ITEM_BITS + 2 * axis as u32);
            self.at[axis] += 1;
            self.at[axis] < self.grid.slot.counts[axis]
        } else {
            self.came_from = 1 << (ITEM_BITS + 2 * axis as u32 + 1);
            self.at[axis] = self.at[axis].wrapping_sub(1);
            self.at[axis] < self.grid.slot.counts[axis]
        }
    }
}
