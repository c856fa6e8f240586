//! The kernel's methods behind one face, so that what drives rays need not know which one it drives.

use patchray::grid::Grids;
use patchray::limits::{GaveUp, Limits, Work};
use patchray::method::{Remembered, newton_coherent};
use patchray::method::{ScratchView, newton};
use patchray::patch::Patches;
use patchray::point::Point;
use patchray::ray::{Hit, Interval, Ray};
use patchray::scene::Scene;
use patchray::tree::Tree;

use crate::lower::Lowered;

/// What a method answers: a hit, a miss, or out of a budget.
pub type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// A method over views of a lowered scene.
pub trait Method: Send + Sync {
    /// The type of control points; its scalar is the precision.
    type Point: Point;

    /// Whether the order of rays matters to its work, so that a scan line has to stay with one thread.
    const COHERENT: bool;

    /// The scene.
    fn scene(&self) -> Scene<'_, Self::Point>;

    /// The closest hit of `ray` in `interval`; `work` is set to what the call did.
    ///
    /// `memory` is a slot per surface, or empty if the method is not coherent; a `line` that no earlier line with this
    /// memory had, at most 2³² − 2, begins with no coherence.
    fn closest(
        &self,
        memory: &mut [Remembered<Scalar<Self>>],
        line: u32,
        ray: &Ray<Scalar<Self>>,
        interval: &Interval<Scalar<Self>>,
        limits: &Limits<Scalar<Self>>,
        scratch: &mut ScratchView<'_, Self::Point>,
        work: &mut Work,
    ) -> Answer<Scalar<Self>>;
}

/// The precision of a method.
pub type Scalar<M> = <<M as Method>::Point as Point>::Scalar;

/// [`patchray::method::newton`].
#[derive(Clone, Copy, Debug)]
pub struct Newton<'m, P: Point> {
    scene: Scene<'m, P>,
    patches: Patches<'m, P::Scalar>,
    tree: Tree<'m, P::Scalar>,
}

/// [`patchray::method::newton_coherent`].
#[derive(Clone, Copy, Debug)]
pub struct NewtonCoherent<'m, P: Point> {
    scene: Scene<'m, P>,
    patches: Patches<'m, P::Scalar>,
    grids: Grids<'m, P::Scalar>,
}

impl<'m, P: Point> Newton<'m, P> {
    /// The method over what was built. If a stage that it needs was not built, every call gives up.
    pub fn over(lowered: &'m Lowered<P>) -> Self {
        Newton { scene: lowered.scene(), patches: lowered.patches(), tree: lowered.tree() }
    }
}

impl<P: Point> Method for Newton<'_, P> {
    type Point = P;
    const COHERENT: bool = false;

    fn scene(&self) -> Scene<'_, P> {
        self.scene
    }

    #[inline]
    fn closest(
        &self,
        _memory: &mut [Remembered<P::Scalar>],
        _line: u32,
        ray: &Ray<P::Scalar>,
        interval: &Interval<P::Scalar>,
        limits: &Limits<P::Scalar>,
        scratch: &mut ScratchView<'_, P>,
        work: &mut Work,
    ) -> Answer<P::Scalar> {
        newton::closest(&self.scene, &self.patches, &self.tree, ray, interval, limits, scratch, work)
    }
}

impl<'m, P: Point> NewtonCoherent<'m, P> {
    /// The method over what was built. If a stage that it needs was not built, every call gives up.
    pub fn over(lowered: &'m Lowered<P>) -> Self {
        NewtonCoherent { scene: lowered.scene(), patches: lowered.patches(), grids: lowered.grids() }
    }
}

impl<P: Point> Method for NewtonCoherent<'_, P> {
    type Point = P;
    const COHERENT: bool = true;

    fn scene(&self) -> Scene<'_, P> {
        self.scene
    }

    #[inline]
    fn closest(
        &self,
        memory: &mut [Remembered<P::Scalar>],
        line: u32,
        ray: &Ray<P::Scalar>,
        interval: &Interval<P::Scalar>,
        limits: &Limits<P::Scalar>,
        scratch: &mut ScratchView<'_, P>,
        work: &mut Work,
    ) -> Answer<P::Scalar> {
        let Self { scene, patches, grids } = self;
        newton_coherent::closest(scene, patches, grids, memory, line, ray, interval, limits, scratch, work)
    }
}
