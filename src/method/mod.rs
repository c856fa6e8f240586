//! The paper's methods: each finds the closest hit of a ray, and reads like a page of the paper.
//!
//! Choices of ours that the paper leaves open are marked "ours"; where we do otherwise, "a departure".

pub mod newton;
pub mod newton_coherent;
mod starts;

use crate::newton::Root;
use crate::planes::Planes;
use crate::scalar::Scalar;
use crate::surface::{Basis, BasisView};

/// What one thread needs per ray, whichever of Newton's methods it traces with. `ORDER` is the highest degree + 1; a scene
/// with only 2 × 2 and 3 × 3 surfaces does with 4.
#[derive(Debug)]
pub struct Scratch<S, const ORDER: usize> {
    basis: Basis<S, ORDER>,
}

impl<S: Scalar, const ORDER: usize> Scratch<S, ORDER> {
    /// Empty scratch, usable in a static.
    pub const fn new() -> Self {
        Scratch { basis: Basis::new() }
    }

    /// The view that the methods take.
    pub fn view(&mut self) -> ScratchView<'_, S> {
        ScratchView { basis: self.basis.view() }
    }
}

impl<S: Scalar, const ORDER: usize> Default for Scratch<S, ORDER> {
    fn default() -> Self {
        Self::new()
    }
}

/// A view of [`Scratch`] without its capacity.
#[derive(Debug)]
pub struct ScratchView<'s, S> {
    /// Room for evaluating a surface.
    pub basis: BasisView<'s, S>,
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
