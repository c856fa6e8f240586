//! The paper's methods: each finds the closest hit of a ray, and reads like a page of the paper.
//!
//! Choices of ours that the paper leaves open are marked "ours"; where we do otherwise, "a departure".

pub mod newton;
pub mod newton_coherent;
mod starts;

use crate::bernstein::{Basis, BasisView};
use crate::newton::Root;
use crate::planes::Planes;
use crate::point::Point;
use crate::scalar::Scalar;
use heapless::vec::{Vec, VecView};

/// What one thread needs per ray, whichever of Newton's methods it traces with. `ORDER` is the highest degree + 1, `POINTS`
/// the most control points of a surface, (n + 1)(m + 1).
#[derive(Debug)]
pub struct Scratch<P: Point, const ORDER: usize, const POINTS: usize> {
    flat: Vec<P::Flat, POINTS>,
    basis: Basis<P::Scalar, ORDER>,
}

impl<P: Point, const ORDER: usize, const POINTS: usize> Scratch<P, ORDER, POINTS> {
    /// Empty scratch, usable in a static.
    pub const fn new() -> Self {
        Scratch { flat: Vec::new(), basis: Basis::new() }
    }

    /// The view that the methods take.
    pub fn view(&mut self) -> ScratchView<'_, P> {
        ScratchView { flat: &mut self.flat, basis: self.basis.view() }
    }
}

impl<P: Point, const ORDER: usize, const POINTS: usize> Default for Scratch<P, ORDER, POINTS> {
    fn default() -> Self {
        Self::new()
    }
}

/// A view of [`Scratch`] without its capacities.
#[derive(Debug)]
pub struct ScratchView<'s, P: Point> {
    /// Room for a surface's projected net.
    pub flat: &'s mut VecView<P::Flat>,
    /// Room for evaluating a surface.
    pub basis: BasisView<'s, P::Scalar>,
}

/// Counts a root as an intersection point if it lies in the ray's interval, and keeps it if it is closer.
#[inline(always)]
fn keep_closest<S: Scalar>(best: &mut Option<Root<S>>, found: Root<S>, planes: &Planes<S>, points: &mut u32) {
    if planes.t_in_interval(found.depth).is_some() {
        *points += 1;
        if best.is_none_or(|old| found.depth < old.depth) {
            *best = Some(found);
        }
    }
}
