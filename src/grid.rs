//! The regular grid over a set of boxes: a surface's patches, or a scene's surfaces.
//!
//! Source: J. G. Cleary and G. Wyvill, "Analysis of an algorithm for fast ray tracing using uniform space subdivision",
//! The Visual Computer 4(2), 1988. The items of each voxel lie in one array of references with offsets.
//!
//! Ours, since the paper says no more than "the corresponding voxels": an item stands in every voxel that its box along the axes
//! touches, so the voxels of an item form a block. A line passes a block in one stretch, and so an item needs testing only in the
//! first voxel of that stretch: where the voxel that the line came from does not hold it. Each reference carries six bits that say
//! which of the six neighbours hold the item too; no marks are kept per ray. Each voxel's offset carries eight bits that say in
//! which octants of directions nothing lies from there on, so that a line is not followed into empty space: an eighth of all steps
//! on the common teapot.

use crate::arena::{Arena, Need};
use crate::frame::Aabb;
use crate::patch::Patches;
use crate::scalar::Scalar;

/// The grid's header as a slot of lent memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct GridSlot<S> {
    /// The box that the voxels fill.
    pub(crate) bounds: Aabb<S>,
    /// Side lengths of a voxel.
    pub(crate) cell: [S; 3],
    /// Their inverses.
    inverse_cell: [S; 3],
    /// Voxels along each axis.
    pub(crate) counts: [u32; 3],
    /// The first of its offsets: one per voxel, and one more.
    first: u32,
    /// The first of its references.
    first_reference: u32,
}

/// Bits of a reference that hold the item's number; the other six are neighbour bits.
pub(crate) const ITEM_BITS: u32 = 26;
pub(crate) const ITEM_MASK: u32 = (1 << ITEM_BITS) - 1;

/// The most items a grid can hold.
pub const MAX_ITEMS: usize = ITEM_MASK as usize;

/// The most voxels along one axis: far more than any density in use asks for, so that three counts never overflow.
const MAX_ALONG_AXIS: u32 = 1 << 9;

/// Bits of an offset that count references from the grid's first one. The other eight say, for each octant of directions,
/// that from this voxel on, itself included, it holds nothing: a line that goes there need not be followed.
pub(crate) const OFFSET_BITS: u32 = 24;
pub(crate) const OFFSET_MASK: u32 = (1 << OFFSET_BITS) - 1;

/// The most references a grid can hold.
pub const MAX_REFERENCES: usize = OFFSET_MASK as usize;

/// A grid is too large: more items than [`MAX_ITEMS`], more references than [`MAX_REFERENCES`], or more voxels in all than
/// 32 bits can count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl<S: Scalar> GridSlot<S> {
    /// What a slot holds before it is filled: a grid without voxels.
    pub const EMPTY: Self = GridSlot {
        bounds: Aabb::ORIGIN,
        cell: [S::ZERO; 3],
        inverse_cell: [S::ZERO; 3],
        counts: [0; 3],
        first: 0,
        first_reference: 0,
    };

    /// The slot that holds these numbers. For tables; see [`LAYOUT`](crate::LAYOUT).
    ///
    /// They are, by coordinate axis, the box's least and largest corner, the voxels' sides and their inverses; then the number
    /// of voxels along each axis, and the first of the grid's offsets and of its references.
    pub const fn from_numbers(lengths: [[S; 3]; 4], numbers: [u32; 5]) -> Self {
        let [low, high, cell, inverse_cell] = lengths;
        let [x, y, z, first, first_reference] = numbers;
        GridSlot { bounds: Aabb { low, high }, cell, inverse_cell, counts: [x, y, z], first, first_reference }
    }

    /// What [`GridSlot::from_numbers`] takes.
    pub const fn numbers(&self) -> ([[S; 3]; 4], [u32; 5]) {
        let [x, y, z] = self.counts;
        let lengths = [self.bounds.low, self.bounds.high, self.cell, self.inverse_cell];
        (lengths, [x, y, z, self.first, self.first_reference])
    }

    /// The most voxels that one line can pass.
    pub fn longest_walk(&self) -> u32 {
        self.counts.iter().fold(0, |sum: u32, &n| sum.saturating_add(n))
    }

    /// Builds a grid over `count` items, whose boxes `boxes` gives, with about `density` voxels per item and at most `most`
    /// voxels; fewer if their references would be more than [`MAX_REFERENCES`]. Offsets and references go into arenas, which
    /// may be too small: then they only count.
    pub fn build(
        count: usize,
        boxes: impl Fn(usize) -> Aabb<S>,
        density: S,
        most: u32,
        offsets: &mut Arena<'_, u32>,
        references: &mut Arena<'_, u32>,
    ) -> Result<Self, TooLarge> {
        if count > MAX_ITEMS {
            return Err(TooLarge);
        }
        let bounds = (0..count).fold(Aabb::EMPTY, |all, k| all.union(boxes(k)));
        let first = u32::try_from(offsets.len()).map_err(|_| TooLarge)?;
        let from = references.len();
        let first_reference = u32::try_from(from).map_err(|_| TooLarge)?;
        let mut density = density;
        // Ends: half as many voxels are wanted each time, and of one voxel there is nothing to halve.
        let (slot, total) = loop {
            let counts = shape(&bounds.sides(), count, density, most);
            let cell = core::array::from_fn(|k| bounds.sides()[k] / S::from_u32(counts[k]));
            let inverse_cell = cell.map(|side: S| if side > S::ZERO { S::ONE / side } else { S::ZERO });
            let slot = GridSlot { bounds, cell, inverse_cell, counts, first, first_reference };
            // Counting needs no memory: the blocks' sizes.
            let total = (0..count).fold(0_usize, |total, k| {
                let [low, high] = slot.block(&boxes(k));
                total.saturating_add((0..3).fold(1, |size, a| size * (high[a] - low[a] + 1) as usize))
            });
            if total <= MAX_REFERENCES {
                break (slot, total);
            }
            // Items as large as the grid lie in most voxels, and finer ones part nothing.
            if counts == [1; 3] {
                return Err(TooLarge);
            }
            density = density * S::HALF;
        };
        let voxels = slot.counts.iter().product::<u32>() as usize;
        offsets.extend(voxels + 1, 0);
        references.extend(total, 0);
        let (Some(offsets), Some(references)) = (offsets.since(first as usize), references.since(from)) else {
            return Ok(slot);
        };
        // Counting sort. After the first pass offset c + 1 is the number in voxel c, after the second its begin, and the
        // third moves it to its end, which is the begin of the next voxel.
        for k in 0..count {
            slot.each_voxel(&boxes(k), |voxel, _| {
                if let Some(offset) = offsets.get_mut(voxel + 1) {
                    *offset += 1;
                }
            });
        }
        let mut begin = 0;
        for offset in offsets.iter_mut() {
            let number = *offset;
            *offset = begin;
            begin += number;
        }
        for k in 0..count {
            slot.each_voxel(&boxes(k), |voxel, neighbours| {
                if let Some(offset) = offsets.get_mut(voxel + 1) {
                    if let Some(reference) = references.get_mut(*offset as usize) {
                        *reference = k as u32 | neighbours << ITEM_BITS;
                    }
                    *offset += 1;
                }
            });
        }
        slot.mark_empty_octants(offsets);
        Ok(slot)
    }

    /// Sets the bits of each voxel's offset that say in which octants nothing lies.
    fn mark_empty_octants(&self, offsets: &mut [u32]) {
        let counts = self.counts;
        let strides = [1, counts[0] as usize, counts[0] as usize * counts[1] as usize];
        for octant in 0..8 {
            let bit = 1 << (OFFSET_BITS + octant);
            let forward = |axis: usize| octant >> axis & 1 == 1;
            // The far end first, so that the three voxels ahead of one are done before it.
            let far_first = |axis: usize| {
                let (count, forward) = (counts[axis], forward(axis));
                (0..count).map(move |step| if forward { count - 1 - step } else { step })
            };
            for z in far_first(2) {
                for y in far_first(1) {
                    for x in far_first(0) {
                        let at = [x, y, z];
                        let voxel = (0..3).fold(0, |voxel, axis| voxel + at[axis] as usize * strides[axis]);
                        let ends = offsets.get(voxel..).and_then(<[u32]>::first_chunk);
                        let empty = ends.is_some_and(|[begin, end]| begin & OFFSET_MASK == end & OFFSET_MASK);
                        let empty_ahead = (0..3).all(|axis| {
                            let (last, next) = if forward(axis) {
                                (at[axis] + 1 >= counts[axis], voxel + strides[axis])
                            } else {
                                (at[axis] == 0, voxel.wrapping_sub(strides[axis]))
                            };
                            last || offsets.get(next).is_some_and(|offset| offset & bit != 0)
                        });
                        if let (true, Some(offset)) = (empty && empty_ahead, offsets.get_mut(voxel)) {
                            *offset |= bit;
                        }
                    }
                }
            }
        }
    }

    /// First and last voxel, by axis, that a box touches.
    fn block(&self, bounds: &Aabb<S>) -> [[u32; 3]; 2] {
        [bounds.low, bounds.high].map(|corner| core::array::from_fn(|k| self.index(corner[k], k)))
    }

    /// The voxel's index along an axis that holds a coordinate; the nearest one outside the grid.
    #[inline(always)]
    pub(crate) fn index(&self, coordinate: S, axis: usize) -> u32 {
        ((coordinate - self.bounds.low[axis]) * self.inverse_cell[axis])
            .to_u32()
            .min(self.counts[axis].saturating_sub(1))
    }

    /// Calls `visit` with each voxel of a box's block, and the bits of those of its neighbours that belong to it too.
    fn each_voxel(&self, bounds: &Aabb<S>, mut visit: impl FnMut(usize, u32)) {
        let [low, high] = self.block(bounds);
        let bit = |inside: bool, number: u32| if inside { 1 << number } else { 0 };
        let sides =
            |at: u32, axis: usize| bit(at > low[axis], 2 * axis as u32) | bit(at < high[axis], 2 * axis as u32 + 1);
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    let voxel = (z * self.counts[1] + y) * self.counts[0] + x;
                    visit(voxel as usize, sides(x, 0) | sides(y, 1) | sides(z, 2));
                }
            }
        }
    }
}

/// Voxels along each axis: about `density · count` in all, in the proportions of the box.
fn shape<S: Scalar>(sides: &[S; 3], count: usize, density: S, most: u32) -> [u32; 3] {
    let wanted = (density * S::from_u32(count as u32)).greater(S::ONE).lesser(S::from_u32(most));
    let longest = S::ZERO.greater(sides[0]).greater(sides[1]).greater(sides[2]);
    if !(longest > S::ZERO && wanted.is_finite()) {
        return [1; 3];
    }
    // Cubic cells of side s: find s by bisection on the count, which no cube root need be called for.
    let counts = |side: S| sides.map(|length| (length / side + S::HALF).to_u32().clamp(1, MAX_ALONG_AXIS));
    let number = |side: S| counts(side).iter().map(|&n| S::from_u32(n)).fold(S::ONE, |a, b| a * b);
    let (mut fine, mut coarse) = (longest / S::from_u32(MAX_ALONG_AXIS), longest * S::TWO);
    // Ends: 24 halvings settle the side to one part in 10^4.
    for _ in 0..24 {
        let middle = (fine + coarse) * S::HALF;
        if number(middle) > wanted { fine = middle } else { coarse = middle }
    }
    counts(coarse)
}

/// A grid: a view of lent memory.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'m, S> {
    pub(crate) slot: &'m GridSlot<S>,
    pub(crate) offsets: &'m [u32],
    pub(crate) references: &'m [u32],
}

impl<'m, S: Scalar> Grid<'m, S> {
    /// The view of a grid whose offsets and references lie in `offsets` and `references`, among others; `None` if they do
    /// not hold it, or if the slot was never filled: a grid that was built has a voxel at least.
    #[inline]
    pub fn new(slot: &'m GridSlot<S>, offsets: &'m [u32], references: &'m [u32]) -> Option<Self> {
        let [x, y, z] = slot.counts.map(|n| n as usize);
        let voxels = x.checked_mul(y)?.checked_mul(z)?;
        if voxels == 0 {
            return None;
        }
        let first = slot.first as usize;
        let offsets = offsets.get(first..first.checked_add(voxels)?.checked_add(1)?)?;
        let references = references.get(slot.first_reference as usize..)?;
        Some(Grid { slot, offsets, references })
    }
}

/// Lent memory for the grids over all surfaces' patches; only the coherent methods need it.
#[derive(Debug)]
pub struct GridMemory<'m, S> {
    /// One header per surface.
    pub grids: &'m mut [GridSlot<S>],
    /// Of all grids: one offset per voxel, and one more per grid.
    pub offsets: &'m mut [u32],
    /// Of all grids: the patches in each voxel.
    pub references: &'m mut [u32],
}

/// Slots that the grids need, and what they were lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GridNeeds {
    /// Of [`GridMemory::grids`].
    pub grids: Need,
    /// Of [`GridMemory::offsets`].
    pub offsets: Need,
    /// Of [`GridMemory::references`].
    pub references: Need,
}

/// How fine the grids are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridOptions<S> {
    /// Voxels per patch. More cost memory and steps, fewer cost patch tests; 1 to 8 are near each other in speed.
    pub density: S,
    /// The most voxels of one grid.
    pub voxels: u32,
}

impl<S: Scalar> Default for GridOptions<S> {
    fn default() -> Self {
        GridOptions { density: S::from_f64(3.0), voxels: 1 << 22 }
    }
}

/// Why grids were not built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridError {
    /// Lent memory is too small; all needs are listed. Lending nothing is how to ask.
    Memory(GridNeeds),
    /// More patches, voxels or references than their numbers can count.
    TooLarge,
    /// The patches do not cover this many surfaces.
    Patches,
}

impl core::fmt::Display for GridError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            GridError::Memory(needs) => write!(f, "lent memory is too small: {needs:?}"),
            GridError::TooLarge => f.write_str("more patches or voxels than 32 bits can count"),
            GridError::Patches => f.write_str("patches of fewer surfaces than asked for"),
        }
    }
}

impl core::error::Error for GridError {}

/// The grids over the patches of each surface: a view of lent memory.
#[derive(Clone, Copy, Debug)]
pub struct Grids<'m, S> {
    grids: &'m [GridSlot<S>],
    offsets: &'m [u32],
    references: &'m [u32],
}

impl<'m, S: Scalar> Grids<'m, S> {
    /// The view of memory that was filled before, such as a table in flash.
    pub const fn new(grids: &'m [GridSlot<S>], offsets: &'m [u32], references: &'m [u32]) -> Self {
        Grids { grids, offsets, references }
    }

    /// Builds a grid over the patches of each of `surfaces` surfaces. Too little memory is an error that lists all needs.
    pub fn build(
        surfaces: usize,
        patches: &Patches<'_, S>,
        options: &GridOptions<S>,
        memory: GridMemory<'m, S>,
    ) -> Result<Self, GridError> {
        let mut grids = Arena::new(memory.grids);
        let mut offsets = Arena::new(memory.offsets);
        let mut references = Arena::new(memory.references);
        for surface in 0..surfaces {
            let patches = patches.of_surface(surface).ok_or(GridError::Patches)?;
            let boxes = |k: usize| patches.get(k).map_or(Aabb::EMPTY, |patch| patch.bounds().aabb());
            let (density, most) = (options.density, options.voxels);
            let slot = GridSlot::build(patches.len(), boxes, density, most, &mut offsets, &mut references);
            grids.push(slot.map_err(|TooLarge| GridError::TooLarge)?);
        }
        let needs = GridNeeds { grids: grids.need(), offsets: offsets.need(), references: references.need() };
        if !(needs.grids.met() && needs.offsets.met() && needs.references.met()) {
            return Err(GridError::Memory(needs));
        }
        Ok(Grids { grids: grids.finish(), offsets: offsets.finish(), references: references.finish() })
    }

    /// How many slots of each kind they take, in the order of [`GridMemory`].
    #[cfg(all(feature = "capi", not(test)))]
    pub(crate) fn lens(&self) -> [usize; 3] {
        [self.grids.len(), self.offsets.len(), self.references.len()]
    }

    /// The grid of one surface; `None` if the memory does not hold it.
    #[inline]
    pub fn of_surface(&self, surface: usize) -> Option<Grid<'m, S>> {
        Grid::new(self.grids.get(surface)?, self.offsets, self.references)
    }

    /// The most voxels that one line can pass, summed over the grids.
    pub fn longest_walks(&self) -> u32 {
        self.grids.iter().fold(0, |sum: u32, grid| sum.saturating_add(grid.longest_walk()))
    }
}

#[cfg(test)]
mod tests;
