//! The regions of a surface's domain that may hold roots, and the order in which those that wait are dealt with.
//!
//! Source: the paper's section "An Improvement of Bézier Clipping".

use crate::bernstein::Direction;
use crate::limits::Limit;
use crate::scalar::Scalar;
use heapless::vec::VecView;

/// A rectangle of a surface's domain, and the parameter to be clipped next. Both ends belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region<S> {
    /// From and to, of u and of v; within [0, 1].
    pub sides: [[S; 2]; 2],
    /// What to clip next.
    pub next: Direction,
}

impl<S: Scalar> Region<S> {
    /// The whole surface; u is clipped first.
    pub const WHOLE: Self = Region { sides: [[S::ZERO, S::ONE]; 2], next: Direction::U };

    /// Its width in u and in v.
    #[inline(always)]
    pub fn widths(&self) -> [S; 2] {
        self.sides.map(|[from, to]| to - from)
    }

    /// Its middle.
    #[inline(always)]
    pub fn middle(&self) -> [S; 2] {
        self.sides.map(|[from, to]| (from + to) * S::HALF)
    }

    /// The nearest point of it.
    #[inline(always)]
    pub fn nearest(&self, [u, v]: [S; 2]) -> [S; 2] {
        let [[u0, u1], [v0, v1]] = self.sides;
        [u.clamped(u0, u1), v.clamped(v0, v1)]
    }

    /// Becomes its part [from, to] in one parameter, counted across it from 0 to 1.
    #[inline(always)]
    pub fn narrow(&mut self, direction: Direction, [from, to]: [S; 2]) {
        let [low, high] = self.sides[direction as usize];
        let width = high - low;
        let at = |share: S| if share == S::ONE { high } else { low + width * share };
        self.sides[direction as usize] = [at(from), at(to)];
    }

    /// Its halves in one parameter; `None` if the number type holds nothing between its ends.
    pub fn halves(&self, direction: Direction) -> Option<[Self; 2]> {
        let [low, high] = self.sides[direction as usize];
        let middle = self.middle()[direction as usize];
        if !(low < middle && middle < high) {
            return None;
        }
        let (mut first, mut second) = (*self, *self);
        first.sides[direction as usize] = [low, middle];
        second.sides[direction as usize] = [middle, high];
        Some([first, second])
    }

    /// What it has in common with another rectangle; `None` if that is nothing.
    #[inline(always)]
    pub fn meet(&self, sides: [[S; 2]; 2]) -> Option<Self> {
        let mut smaller = *self;
        for (side, [from, to]) in smaller.sides.iter_mut().zip(sides) {
            *side = [side[0].greater(from), side[1].lesser(to)];
            if !(side[0] <= side[1]) {
                return None;
            }
        }
        Some(smaller)
    }

    /// Whether it holds all of another rectangle.
    #[inline(always)]
    pub fn encloses(&self, sides: [[S; 2]; 2]) -> bool {
        self.sides.iter().zip(sides).all(|(outer, inner)| outer[0] <= inner[0] && inner[1] <= outer[1])
    }

    /// The smallest rectangle that holds it and another.
    #[inline(always)]
    pub fn joined(&self, other: &Self) -> Self {
        let mut larger = *self;
        for (side, [from, to]) in larger.sides.iter_mut().zip(other.sides) {
            *side = [side[0].lesser(from), side[1].greater(to)];
        }
        larger
    }

    /// Whether it holds a point.
    pub fn holds(&self, point: [S; 2]) -> bool {
        self.sides.iter().zip(point).all(|(&[low, high], c)| low <= c && c <= high)
    }

    /// Whether it and another have a point in common.
    pub fn adjoins(&self, other: &Self) -> bool {
        self.sides.iter().zip(&other.sides).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1])
    }
}

/// The order in which regions that wait are dealt with.
#[derive(Clone, Copy, Debug)]
pub enum Order<S> {
    /// Any: the last one first, which keeps fewest waiting.
    Any,
    /// The prior region first, that which holds this point; then those that adjoin it; then the rest.
    Around {
        /// (u, v) of the previous ray's point.
        point: [S; 2],
        /// The smallest region so far that held it.
        prior: Region<S>,
    },
}

impl<S: Scalar> Order<S> {
    /// Around the point that the previous ray left; without one, any.
    pub fn around(point: Option<[S; 2]>) -> Self {
        point.map_or(Order::Any, |point| Order::Around { point, prior: Region::WHOLE })
    }

    /// Puts a region among those that wait.
    pub fn push(&self, region: Region<S>, pending: &mut VecView<Region<S>>, most: u32) -> Result<(), Limit> {
        if pending.len() >= most as usize {
            return Err(Limit::PendingDomains);
        }
        pending.push(region).map_err(|_| Limit::PendingDomains)
    }

    /// Takes the region to be dealt with next.
    pub fn pop(&mut self, pending: &mut VecView<Region<S>>) -> Option<Region<S>> {
        let Order::Around { point, prior } = self else {
            return pending.pop();
        };
        let mut first: Option<(usize, (u32, S))> = None;
        for (index, region) in pending.iter().enumerate() {
            let rank = rank(region, *point, prior);
            if first.is_none_or(|(_, least)| rank < least) {
                first = Some((index, rank));
            }
        }
        let (index, _) = first?;
        // The others keep their order, which only matters where two ranks are equal.
        let region = if index < pending.len() { pending.remove(index) } else { return None };
        if region.holds(*point) {
            *prior = region;
        }
        Some(region)
    }
}

/// 0 for the prior region, 1 for those that adjoin it, 2 for the rest; ours: among equals the distance from the point.
fn rank<S: Scalar>(region: &Region<S>, point: [S; 2], prior: &Region<S>) -> (u32, S) {
    let class = if region.holds(point) {
        0
    } else if region.adjoins(prior) {
        1
    } else {
        2
    };
    let [u, v] = region.nearest(point);
    (class, (u - point[0]).abs() + (v - point[1]).abs())
}

#[cfg(test)]
mod tests;
