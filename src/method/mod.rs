//! The paper's methods: each finds the closest hit of a ray, and reads like a page of the paper.
//!
//! Choices of ours that the paper leaves open are marked "ours"; where we do otherwise, "a departure".

pub mod clipping;
pub mod clipping_coherent;
pub mod clipping_predicted;
mod collect;
mod follow;
pub mod newton;
pub mod newton_coherent;
pub mod newton_predicted;
mod starts;

pub use follow::{Followed, Following};

use crate::bernstein::{Basis, BasisView};
use crate::clipper::ClipRoom;
use crate::fallback::{Fallback, NoFallback};
use crate::limits::Work;
use crate::parameter::Parameter;
use crate::planes::Planes;
use crate::point::Point;
use crate::region::Region;
use crate::root::Root;
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

    /// The view that the methods take, without a fallback.
    pub fn view(&mut self) -> ScratchView<'_, P> {
        self.view_with(NoFallback)
    }

    /// The view that the methods take, with a fallback: a [`ClipRoom`], which a [`ClipScratch`] gives, or [`NoFallback`].
    pub fn view_with<F: Fallback<P>>(&mut self, fallback: F) -> ScratchView<'_, P, F> {
        ScratchView { flat: &mut self.flat, basis: self.basis.view(), fallback }
    }
}

impl<P: Point, const ORDER: usize, const POINTS: usize> Default for Scratch<P, ORDER, POINTS> {
    fn default() -> Self {
        Self::new()
    }
}

/// A view of [`Scratch`] without its capacities.
#[derive(Debug)]
pub struct ScratchView<'s, P: Point, F = NoFallback> {
    /// Room for a surface's projected net.
    pub flat: &'s mut VecView<P::Flat>,
    /// Room for evaluating a surface.
    pub basis: BasisView<'s, P::Scalar>,
    /// What decides patches of which Newton's method proves nothing; asked under
    /// [`Acceptance::Proved`](crate::limits::Acceptance::Proved) only.
    pub fallback: F,
}

/// What one thread needs per ray, whichever of the clipping methods it traces with. `ORDER` is the highest degree + 1,
/// `POINTS` the most control points of a surface, (n + 1)(m + 1), `PENDING` the most domains that wait to be clipped, of
/// which a bisection adds one: 64 hold more than numbers of 53 bits can be halved apart.
#[derive(Debug)]
pub struct ClipScratch<P: Point, const ORDER: usize, const POINTS: usize, const PENDING: usize> {
    whole: Vec<P::Flat, POINTS>,
    part: Vec<P::Flat, POINTS>,
    pending: Vec<Region<P::Parameter>, PENDING>,
    roots: Vec<Root<P::Parameter>, ROOTS>,
    basis: Basis<P::Scalar, ORDER>,
}

/// Roots of one surface that are kept to tell whether one was found before: two bicubics meet a line 18 times at most.
const ROOTS: usize = 18;

impl<P: Point, const ORDER: usize, const POINTS: usize, const PENDING: usize> ClipScratch<P, ORDER, POINTS, PENDING> {
    /// Empty scratch, usable in a static.
    pub const fn new() -> Self {
        ClipScratch { whole: Vec::new(), part: Vec::new(), pending: Vec::new(), roots: Vec::new(), basis: Basis::new() }
    }

    /// The view that the methods take.
    pub fn view(&mut self) -> ClipRoom<'_, P> {
        ClipRoom {
            whole: &mut self.whole,
            part: &mut self.part,
            pending: &mut self.pending,
            roots: &mut self.roots,
            basis: self.basis.view(),
        }
    }
}

impl<P: Point, const ORDER: usize, const POINTS: usize, const PENDING: usize> Default
    for ClipScratch<P, ORDER, POINTS, PENDING>
{
    fn default() -> Self {
        Self::new()
    }
}

/// Coherence memory: what the previous ray of a scan line left on one surface. A slot of memory that the caller lends, one
/// per surface and thread.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Remembered<S> {
    u: S,
    v: S,
    /// The scan line that it belongs to, plus one; 0 holds nothing. So nothing need be cleared between scan lines.
    stamp: u32,
}

impl<S: Scalar> Remembered<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self = Remembered { u: S::ZERO, v: S::ZERO, stamp: 0 };

    /// What a ray leaves: the point that it found; after a miss nothing.
    #[inline(always)]
    fn of<A: Parameter<Scalar = S>>(found: Option<Root<A>>, stamp: u32) -> Self {
        found.map_or(Self::EMPTY, |root| Remembered { u: root.u.number(), v: root.v.number(), stamp })
    }

    /// (u, v) of the previous ray's point, if it was of this scan line.
    #[inline(always)]
    fn recall(&self, stamp: u32) -> Option<[S; 2]> {
        if self.stamp == stamp && stamp != 0 { Some([self.u, self.v]) } else { None }
    }
}

/// A search that memory may lead, by a stamp to recall with; and where it runs out, once more without memory, by budgets of its
/// own: what memory led into must not cost a ray its answer. `search` sets `work`, and also says whether it recalled anything.
#[inline(always)]
fn led<T, E>(
    mut stamp: u32,
    work: &mut Work,
    mut search: impl FnMut(u32, &mut bool, &mut Work) -> Result<T, E>,
) -> Result<T, E> {
    let mut spent: Option<Work> = None;
    // Ends: a second search, whose stamp recalls nothing, is the last.
    loop {
        let mut recalled = false;
        let answer = search(stamp, &mut recalled, work);
        if let Some(spent) = &spent {
            *work = spent.plus(work);
        }
        if !(recalled && answer.is_err()) {
            return answer;
        }
        (stamp, spent) = (0, Some(*work));
    }
}

/// Counts a root as an intersection point if it lies in the ray's interval, and keeps it if it is closer.
#[inline(always)]
fn keep_closest<A: Parameter>(
    best: &mut Option<Root<A>>,
    found: Root<A>,
    planes: &Planes<A::Scalar>,
    points: &mut u32,
) {
    if planes.t_in_interval(found.depth).is_some() {
        *points += 1;
        if best.is_none_or(|old| found.depth < old.depth) {
            *best = Some(found);
        }
    }
}
