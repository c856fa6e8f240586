//! The kernel's methods, and what can be asked of them, behind one face, so that what drives rays need not know which one it
//! drives.

use std::marker::PhantomData;

use heapless::Vec as List;
use patchray::clipper::ClipRoom;
use patchray::grid::Grids;
use patchray::limits::{GaveUp, Limit, Limits, Work};
use patchray::method::{
    ClipScratch, Remembered, Scratch, ScratchView, clipping, clipping_coherent, newton, newton_coherent,
};
use patchray::patch::Patches;
use patchray::point::Point;
use patchray::ray::{Hit, Interval, Ray};
use patchray::reading::Switches;
use patchray::scalar::Scalar;
use patchray::scene::Scene;
use patchray::tree::Tree;

use crate::lower::{Lowered, NET, ORDER, Place};

pub mod in_view;

/// Domains that may wait to be clipped: more than 53 bits can be halved apart in.
pub const PENDING: usize = 64;

/// Hits of one ray that can be told. Two bicubics meet a line 18 times at most; a line through a model of a hundred such
/// surfaces, one behind another and each met twice, fits with room to spare.
pub const HITS: usize = 256;

/// Views of a lowered scene: all that any method works on. What was not built is empty, and a method that needs it gives up.
#[derive(Clone, Copy, Debug)]
pub struct Views<'m, P: Point> {
    /// The scene.
    pub scene: Scene<'m, P>,
    /// The same for rays in its nets' coordinates: see [`Place`].
    pub nets: Scene<'m, P>,
    /// The patches.
    pub patches: Patches<'m, P::Scalar>,
    /// The binary trees.
    pub tree: Tree<'m, P::Scalar>,
    /// The grids over patches.
    pub grids: Grids<'m, P::Scalar>,
}

impl<'m, P: Point> Views<'m, P> {
    /// The views of what was built.
    pub fn of(lowered: &'m Lowered<P>) -> Self {
        let [scene, nets] = [Place::File, Place::Nets].map(|place| lowered.scene_at(place));
        Views { scene, nets, patches: lowered.patches(), tree: lowered.tree(), grids: lowered.grids() }
    }

    /// The views for rays from there.
    pub fn at(self, place: Place) -> Self {
        match place {
            Place::File => self,
            Place::Nets => Views { scene: self.nets, ..self },
        }
    }
}

/// A ray, the stretch of it that counts, and what its answer may cost.
#[derive(Clone, Copy, Debug)]
pub struct Task<'t, S> {
    /// The ray.
    pub ray: &'t Ray<S>,
    /// The stretch of it.
    pub interval: &'t Interval<S>,
    /// The bounds on the work.
    pub limits: &'t Limits<S>,
    /// By which reading of the paper; `None` for the one that serves users best.
    pub switches: Option<Switches>,
}

/// What the rays before left to a coherent method.
#[derive(Debug)]
pub struct Coherence<'c, S> {
    /// A slot per surface, or none if the method is not coherent.
    pub memory: &'c mut [Remembered<S>],
    /// The number of the scan line: one that no earlier line with this memory had, at most 2³² − 2, begins with no coherence.
    pub line: u32,
}

/// What a ray is asked for: one hit, or a list of them.
pub trait Hits<S>: Send {
    /// The same in terms of `F`.
    type Of<F: Send>: Send;

    /// Each hit turned into an `F`, in order.
    fn each<F: Send>(self, turn: impl FnMut(&Hit<S>) -> F) -> Self::Of<F>;
}

impl<S: Scalar> Hits<S> for Hit<S> {
    type Of<F: Send> = F;

    #[inline]
    fn each<F: Send>(self, mut turn: impl FnMut(&Hit<S>) -> F) -> F {
        turn(&self)
    }
}

impl<S: Scalar> Hits<S> for Vec<Hit<S>> {
    type Of<F: Send> = Vec<F>;

    fn each<F: Send>(self, turn: impl FnMut(&Hit<S>) -> F) -> Vec<F> {
        self.iter().map(turn).collect()
    }
}

/// A call ran out of a bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped<H> {
    /// Which bound.
    pub limit: Limit,
    /// The closest hit, or the hits, found by then: not an answer.
    pub best: Option<H>,
}

impl<S: Scalar> From<GaveUp<S>> for Stopped<Hit<S>> {
    #[inline]
    fn from(GaveUp { limit, best }: GaveUp<S>) -> Self {
        Stopped { limit, best }
    }
}

/// What a method answers: what was asked for, none of it, or out of a budget.
pub type Answer<H> = Result<Option<H>, Stopped<H>>;

/// A method over points of type `P`, and what it is asked for.
pub trait Method<P: Point>: Send + Sync {
    /// Whether the order of rays matters to its work, so that a scan line has to stay with one thread.
    const COHERENT: bool;

    /// What one thread needs per ray, for any degrees.
    type Scratch: Default + Send;

    /// What it is asked for.
    type Hits: Hits<P::Scalar>;

    /// Its answer to one ray; `work` is set to what the call did.
    fn answer(
        views: &Views<'_, P>,
        coherence: Coherence<'_, P::Scalar>,
        task: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Answer<Self::Hits>;
}

/// A method that can be asked for more than the closest hit: one that knows nothing of the rays before.
pub trait Complete<P: Point>: Method<P> {
    /// All hits in order of t, into `hits`; if there are more, it holds the closest.
    fn all_hits(
        views: &Views<'_, P>,
        task: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        hits: &mut List<Hit<P::Scalar>, HITS>,
        work: &mut Work,
    ) -> Result<(), GaveUp<P::Scalar>>;

    /// The first hit that is found, whether or not it is the closest.
    fn any_hit(
        views: &Views<'_, P>,
        task: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>>;
}

/// The closest hit by [`patchray::method::newton`].
#[derive(Clone, Copy, Debug)]
pub struct Newton;

/// What Newton's methods need per ray: their own scratch, and that of Bézier clipping, on which they fall back under
/// [`Acceptance::Proved`](patchray::limits::Acceptance::Proved).
pub type NewtonScratch<P> = (Scratch<P, ORDER, NET>, ClipScratch<P, ORDER, NET, PENDING>);

/// The view of it that the methods take.
#[inline]
pub(crate) fn newton_room<P: Point>((newton, clips): &mut NewtonScratch<P>) -> ScratchView<'_, P, ClipRoom<'_, P>> {
    newton.view_with(clips.view())
}

/// The closest hit by [`patchray::method::newton_coherent`].
#[derive(Clone, Copy, Debug)]
pub struct NewtonCoherent;

/// The closest hit by [`patchray::method::clipping`].
#[derive(Clone, Copy, Debug)]
pub struct Clipping;

/// The closest hit by [`patchray::method::clipping_coherent`].
#[derive(Clone, Copy, Debug)]
pub struct ClippingCoherent;

/// All hits by the method `M`, at most [`HITS`].
#[derive(Clone, Copy, Debug)]
pub struct AllHits<M>(PhantomData<M>);

/// The first hit that the method `M` finds.
#[derive(Clone, Copy, Debug)]
pub struct AnyHit<M>(PhantomData<M>);

impl<P: Point> Method<P> for Newton {
    const COHERENT: bool = false;
    type Scratch = NewtonScratch<P>;
    type Hits = Hit<P::Scalar>;

    #[inline]
    fn answer(
        Views { scene, patches, tree, .. }: &Views<'_, P>,
        _: Coherence<'_, P::Scalar>,
        Task { ray, interval, limits, switches }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Answer<Self::Hits> {
        let room = &mut newton_room(scratch);
        Ok(match *switches {
            None => newton::closest(scene, patches, tree, ray, interval, limits, room, work)?,
            Some(some) => newton::closest_by(some, scene, patches, tree, ray, interval, limits, room, work)?,
        })
    }
}

impl<P: Point> Complete<P> for Newton {
    #[inline]
    fn all_hits(
        Views { scene, patches, tree, .. }: &Views<'_, P>,
        Task { ray, interval, limits, .. }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        hits: &mut List<Hit<P::Scalar>, HITS>,
        work: &mut Work,
    ) -> Result<(), GaveUp<P::Scalar>> {
        newton::all_hits(scene, patches, tree, ray, interval, limits, &mut newton_room(scratch), hits, work)
    }

    #[inline]
    fn any_hit(
        Views { scene, patches, tree, .. }: &Views<'_, P>,
        Task { ray, interval, limits, .. }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
        newton::any_hit(scene, patches, tree, ray, interval, limits, &mut newton_room(scratch), work)
    }
}

impl<P: Point> Method<P> for NewtonCoherent {
    const COHERENT: bool = true;
    type Scratch = NewtonScratch<P>;
    type Hits = Hit<P::Scalar>;

    #[inline]
    fn answer(
        Views { scene, patches, grids, .. }: &Views<'_, P>,
        Coherence { memory, line }: Coherence<'_, P::Scalar>,
        Task { ray, interval, limits, switches }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Answer<Self::Hits> {
        let room = &mut newton_room(scratch);
        Ok(match *switches {
            None => newton_coherent::closest(scene, patches, grids, memory, line, ray, interval, limits, room, work)?,
            Some(some) => newton_coherent::closest_by(
                some, scene, patches, grids, memory, line, ray, interval, limits, room, work,
            )?,
        })
    }
}

impl<P: Point> Method<P> for Clipping {
    const COHERENT: bool = false;
    type Scratch = ClipScratch<P, ORDER, NET, PENDING>;
    type Hits = Hit<P::Scalar>;

    #[inline]
    fn answer(
        Views { scene, .. }: &Views<'_, P>,
        _: Coherence<'_, P::Scalar>,
        Task { ray, interval, limits, switches }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Answer<Self::Hits> {
        let room = &mut scratch.view();
        Ok(match *switches {
            None => clipping::closest(scene, ray, interval, limits, room, work)?,
            Some(some) => clipping::closest_by(some, scene, ray, interval, limits, room, work)?,
        })
    }
}

impl<P: Point> Complete<P> for Clipping {
    #[inline]
    fn all_hits(
        Views { scene, .. }: &Views<'_, P>,
        Task { ray, interval, limits, .. }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        hits: &mut List<Hit<P::Scalar>, HITS>,
        work: &mut Work,
    ) -> Result<(), GaveUp<P::Scalar>> {
        clipping::all_hits(scene, ray, interval, limits, &mut scratch.view(), hits, work)
    }

    #[inline]
    fn any_hit(
        Views { scene, .. }: &Views<'_, P>,
        Task { ray, interval, limits, .. }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
        clipping::any_hit(scene, ray, interval, limits, &mut scratch.view(), work)
    }
}

impl<P: Point> Method<P> for ClippingCoherent {
    const COHERENT: bool = true;
    type Scratch = ClipScratch<P, ORDER, NET, PENDING>;
    type Hits = Hit<P::Scalar>;

    #[inline]
    fn answer(
        Views { scene, patches, grids, .. }: &Views<'_, P>,
        Coherence { memory, line }: Coherence<'_, P::Scalar>,
        Task { ray, interval, limits, switches }: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Answer<Self::Hits> {
        let room = &mut scratch.view();
        Ok(match *switches {
            None => clipping_coherent::closest(scene, patches, grids, memory, line, ray, interval, limits, room, work)?,
            Some(some) => clipping_coherent::closest_by(
                some, scene, patches, grids, memory, line, ray, interval, limits, room, work,
            )?,
        })
    }
}

impl<P: Point, M: Complete<P>> Method<P> for AllHits<M> {
    const COHERENT: bool = false;
    type Scratch = (M::Scratch, List<Hit<P::Scalar>, HITS>);
    type Hits = Vec<Hit<P::Scalar>>;

    #[inline]
    fn answer(
        views: &Views<'_, P>,
        _: Coherence<'_, P::Scalar>,
        task: &Task<'_, P::Scalar>,
        (scratch, hits): &mut Self::Scratch,
        work: &mut Work,
    ) -> Answer<Self::Hits> {
        let ended = M::all_hits(views, task, scratch, hits, work);
        let found = (!hits.is_empty()).then(|| hits.to_vec());
        match ended {
            Ok(()) => Ok(found),
            Err(GaveUp { limit, .. }) => Err(Stopped { limit, best: found }),
        }
    }
}

impl<P: Point, M: Complete<P>> Method<P> for AnyHit<M> {
    const COHERENT: bool = false;
    type Scratch = M::Scratch;
    type Hits = Hit<P::Scalar>;

    #[inline]
    fn answer(
        views: &Views<'_, P>,
        _: Coherence<'_, P::Scalar>,
        task: &Task<'_, P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Answer<Self::Hits> {
        Ok(M::any_hit(views, task, scratch, work)?)
    }
}
