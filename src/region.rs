//! The regions of a surface's domain that may hold roots, and the order in which those that wait are dealt with.
//!
//! Source: the paper's section "An Improvement of Bézier Clipping".

use crate::bernstein::Direction;
use crate::limits::Limit;
use crate::parameter::Parameter;
use crate::scalar::Scalar;
use heapless::vec::VecView;

/// A rectangle of a surface's domain, and the parameter to be clipped next. Both ends belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region<A> {
    /// From and to, of u and of v; within [0, 1].
    pub sides: [[A; 2]; 2],
    /// What to clip next.
    pub next: Direction,
}

impl<A: Parameter> Region<A> {
    /// The whole surface; u is clipped first.
    pub const WHOLE: Self = Region { sides: [[A::ZERO, A::ONE]; 2], next: Direction::U };

    /// The rectangle between these numbers, from and to of u and of v.
    #[inline(always)]
    pub fn between(sides: [[A::Scalar; 2]; 2]) -> Self {
        // Not by `map`, which a compiler may leave out of line.
        let [[u0, u1], [v0, v1]] = sides;
        Region { sides: [[A::new(u0), A::new(u1)], [A::new(v0), A::new(v1)]], next: Direction::U }
    }

    /// Its width in u and in v.
    #[inline(always)]
    pub fn widths(&self) -> [A::Scalar; 2] {
        self.sides.map(|[from, to]| to.minus(from))
    }

    /// Its middle.
    #[inline(always)]
    pub fn middle(&self) -> [A; 2] {
        self.sides.map(|[from, to]| A::middle(from, to))
    }

    /// The nearest point of it.
    #[inline(always)]
    pub fn nearest(&self, [u, v]: [A; 2]) -> [A; 2] {
        let [[u0, u1], [v0, v1]] = self.sides;
        [u.held(u0, u1), v.held(v0, v1)]
    }

    /// It and what lies beside it, on each side so many times as wide, within the domain.
    #[inline(always)]
    pub(crate) fn around(&self, times: A::Scalar) -> Self {
        let sides = self.sides.map(|[low, high]| {
            let reach = high.minus(low) * times;
            [low.plus(-reach).later(A::ZERO), high.plus(reach).earlier(A::ONE)]
        });
        Region { sides, ..*self }
    }

    /// Becomes its part [from, to] in one parameter, counted across it from 0 to 1.
    #[inline(always)]
    pub fn narrow(&mut self, direction: Direction, part: [A::Scalar; 2]) {
        let [low, high] = self.sides[direction as usize];
        self.sides[direction as usize] = part.map(|share| low.toward(high, share, A::Scalar::ONE - share));
    }

    /// Its halves in one parameter; `None` if the number type holds nothing between its ends.
    pub fn halves(&self, direction: Direction) -> Option<[Self; 2]> {
        let [low, high] = self.sides[direction as usize];
        let middle = self.middle()[direction as usize];
        if !(low.is_below(middle) && middle.is_below(high)) {
            return None;
        }
        let (mut first, mut second) = (*self, *self);
        first.sides[direction as usize] = [low, middle];
        second.sides[direction as usize] = [middle, high];
        Some([first, second])
    }

    /// Whether it has halves in either parameter.
    pub fn is_divisible(&self) -> bool {
        [Direction::U, Direction::V].iter().any(|&direction| self.halves(direction).is_some())
    }

    /// What it has in common with another rectangle; `None` if that is nothing.
    #[inline(always)]
    pub fn meet(&self, sides: [[A; 2]; 2]) -> Option<Self> {
        let mut smaller = *self;
        for (side, [from, to]) in smaller.sides.iter_mut().zip(sides) {
            *side = [side[0].later(from), side[1].earlier(to)];
            if !side[0].is_at_most(side[1]) {
                return None;
            }
        }
        Some(smaller)
    }

    /// Whether it holds all of another rectangle.
    #[inline(always)]
    pub fn encloses(&self, sides: [[A; 2]; 2]) -> bool {
        self.sides
            .iter()
            .zip(sides)
            .all(|(outer, inner)| outer[0].is_at_most(inner[0]) && inner[1].is_at_most(outer[1]))
    }

    /// The smallest rectangle that holds it and another.
    #[inline(always)]
    pub fn joined(&self, other: &Self) -> Self {
        let mut larger = *self;
        for (side, [from, to]) in larger.sides.iter_mut().zip(other.sides) {
            *side = [side[0].earlier(from), side[1].later(to)];
        }
        larger
    }

    /// Whether it holds a point.
    pub fn holds(&self, point: [A; 2]) -> bool {
        self.sides.iter().zip(point).all(|(&[low, high], c)| low.is_at_most(c) && c.is_at_most(high))
    }

    /// Whether it and another have a point in common.
    pub fn adjoins(&self, other: &Self) -> bool {
        self.sides.iter().zip(&other.sides).all(|(a, b)| a[0].is_at_most(b[1]) && b[0].is_at_most(a[1]))
    }
}

/// The order in which regions that wait are dealt with.
#[derive(Clone, Copy, Debug)]
pub enum Order<A> {
    /// Any: the last one first, which keeps fewest waiting.
    Any,
    /// The prior region first, that which holds this point; then those that adjoin it; then the rest.
    Around {
        /// (u, v) of the previous ray's point.
        point: [A; 2],
        /// The smallest region so far that held it.
        prior: Region<A>,
    },
}

impl<A: Parameter> Order<A> {
    /// Around the point that the previous ray left; without one, any.
    pub fn around(point: Option<[A; 2]>) -> Self {
        point.map_or(Order::Any, |point| Order::Around { point, prior: Region::WHOLE })
    }

    /// Puts a region among those that wait.
    pub fn push(&self, region: Region<A>, pending: &mut VecView<Region<A>>, most: u32) -> Result<(), Limit> {
        if pending.len() >= most as usize {
            return Err(Limit::PendingDomains);
        }
        pending.push(region).map_err(|_| Limit::PendingDomains)
    }

    /// Takes the region to be dealt with next.
    pub fn pop(&mut self, pending: &mut VecView<Region<A>>) -> Option<Region<A>> {
        let Order::Around { point, prior } = self else {
            return pending.pop();
        };
        let mut first: Option<(usize, (u32, A::Scalar))> = None;
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
fn rank<A: Parameter>(region: &Region<A>, point: [A; 2], prior: &Region<A>) -> (u32, A::Scalar) {
    let class = if region.holds(point) {
        0
    } else if region.adjoins(prior) {
        1
    } else {
        2
    };
    let [u, v] = region.nearest(point);
    (class, u.minus(point[0]).abs() + v.minus(point[1]).abs())
}

#[cfg(test)]
mod tests;
