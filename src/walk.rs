//! The walk of a line through a regular grid, voxel by voxel, front to back.
//!
//! Source: Cleary and Wyvill (1988). The distance to each wall is computed afresh from the wall's number rather than by
//! adding up steps, so that its rounding does not grow along the way.

use crate::grid::{Grid, ITEM_BITS, ITEM_MASK, OFFSET_BITS, OFFSET_MASK};
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
    /// No voxel: before a walk.
    pub const NONE: Self = Voxel { references: &[], came_from: 0, exit: S::LEAST };

    /// The next of the items that the line meets here for the first time.
    #[inline(always)]
    pub fn next_fresh(&mut self) -> Option<usize> {
        // Ends with the references.
        while let Some((&reference, rest)) = self.references.split_first() {
            self.references = rest;
            if reference & self.came_from == 0 {
                return Some((reference & ITEM_MASK) as usize);
            }
        }
        None
    }
}

/// The way of a line through a grid, voxel by voxel.
#[derive(Clone, Copy, Debug)]
pub struct Walk<'m, S> {
    offsets: &'m [u32],
    references: &'m [u32],
    axes: [Across<S>; 3],
    /// The voxel's number in the grid.
    voxel: usize,
    length: S,
    came_from: u32,
    /// The bit of an offset that says that nothing lies ahead.
    nothing_ahead: u32,
    done: bool,
}

/// The walls across one axis, as the line meets them.
#[derive(Clone, Copy, Debug)]
struct Across<S> {
    /// Where the line crosses the next wall: `base + wall · step`.
    next: S,
    base: S,
    step: S,
    wall: S,
    /// What crossing it adds to the voxel's number, modulo 2⁶⁴ (or 2³²).
    stride: usize,
    /// How many more walls lie inside the grid.
    left: u32,
    /// The bit of the neighbour that lies behind the wall just crossed.
    behind: u32,
}

impl<'m, S: Scalar> Grid<'m, S> {
    /// The walk of a ray through what of a range of depths lies in the grid's box, and the depth where it begins; `None` if
    /// the ray passes the grid by.
    #[inline(always)]
    pub fn enter(&self, planes: &Planes<S>, range: &DepthRange<S>) -> Option<(Walk<'m, S>, S)> {
        let inverse = planes.inverse();
        let (near, far) = self.slot.bounds.depths(&planes.origin(), &inverse)?;
        let (begin, end) = (near.greater(range.min), far.lesser(range.max));
        if !(begin <= end) {
            return None;
        }
        Some((self.walk(&planes.at(begin), &inverse, end - begin), begin))
    }

    /// The walk along `start + s · direction` for s in [0, `length`], by the direction's `inverse`: 1 / its components,
    /// infinite for those that are 0. `start` should be inside the grid, or so near that rounding explains it.
    #[inline(always)]
    pub fn walk(&self, start: &[S; 3], inverse: &[S; 3], length: S) -> Walk<'m, S> {
        let slot = self.slot;
        let [x, y, _] = slot.counts.map(|n| n as usize);
        let (offsets, references) = (self.offsets, self.references);
        let mut walk = Walk {
            offsets,
            references,
            axes: [Across::NONE; 3],
            voxel: 0,
            length,
            came_from: 0,
            nothing_ahead: 0,
            done: false,
        };
        let mut octant = 0;
        // Written in place: the walk is large, and building its parts apart would copy them.
        let mut stride = 1_usize;
        for k in 0..3 {
            let at = slot.index(start[k], k);
            walk.voxel = walk.voxel.wrapping_add((at as usize).wrapping_mul(stride));
            let forward = inverse[k] > S::ZERO;
            // Walls are numbered in the line's direction, 0 being the one behind the first voxel.
            let wall = if forward { at } else { at + 1 };
            let across = &mut walk.axes[k];
            across.base = (slot.bounds.low[k] + S::from_u32(wall) * slot.cell[k] - start[k]) * inverse[k];
            across.step = slot.cell[k] * inverse[k].abs();
            // A line along the walls never crosses one; its base is infinite or NaN.
            across.next = if inverse[k].is_finite() { across.base + across.step } else { S::INFINITY };
            across.stride = if forward { stride } else { stride.wrapping_neg() };
            across.left = if forward { slot.counts[k].saturating_sub(at + 1) } else { at };
            across.behind = 1 << (ITEM_BITS + 2 * k as u32 + u32::from(!forward));
            stride = if k == 0 { x } else { x.wrapping_mul(y) };
            octant |= u32::from(forward) << k;
        }
        walk.nothing_ahead = 1 << (OFFSET_BITS + octant);
        walk
    }
}

impl<S: Scalar> Across<S> {
    const NONE: Self =
        Across { next: S::ZERO, base: S::ZERO, step: S::ZERO, wall: S::ONE, stride: 0, left: 0, behind: 0 };
}

impl<'m, S: Scalar> Walk<'m, S> {
    /// The next voxel, unless nothing lies in it and beyond; `Err` if the lent memory leads nowhere. Ends: each step crosses a
    /// wall, of which there are at most [`GridSlot::longest_walk`](crate::grid::GridSlot::longest_walk).
    #[inline(always)]
    pub fn advance(&mut self) -> Option<Result<Voxel<'m, S>, ()>> {
        if self.done {
            return None;
        }
        let references = match self.offsets.get(self.voxel..).and_then(<[u32]>::first_chunk) {
            Some(&[begin, _]) if begin & self.nothing_ahead != 0 => {
                self.done = true;
                return None;
            }
            Some(&[begin, end]) => self.references.get((begin & OFFSET_MASK) as usize..(end & OFFSET_MASK) as usize),
            None => None,
        };
        let Some(references) = references else {
            self.done = true;
            return Some(Err(()));
        };
        // The nearest wall, without a branch: which axis it is cannot be foreseen.
        let [x, y, z] = &self.axes;
        let (first, nearer) = if y.next < x.next { (1, y.next) } else { (0, x.next) };
        let axis = if z.next < nearer { 2 } else { first };
        let across = &mut self.axes[axis];
        let exit = across.next;
        let found = Voxel { references, came_from: self.came_from, exit: exit.lesser(self.length) };
        // A NaN ends the walk here.
        if !(exit < self.length) || across.left == 0 {
            self.done = true;
            return Some(Ok(found));
        }
        across.left -= 1;
        across.wall += S::ONE;
        across.next = across.base + across.wall * across.step;
        self.voxel = self.voxel.wrapping_add(across.stride);
        self.came_from = across.behind;
        Some(Ok(found))
    }
}

#[cfg(test)]
mod tests;
