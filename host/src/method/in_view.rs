//! The kernel's methods for the rays of one view, behind one face.

use patchray::limits::{GaveUp, Limits, Work};
use patchray::line::Line;
use patchray::method::{
    ClipScratch, Followed, Following, Remembered, clipping, clipping_coherent, clipping_predicted, newton,
    newton_coherent, newton_predicted,
};
use patchray::point::Point;
use patchray::ray::Hit;
use patchray::span::Order;
use patchray::view::{View, ViewRay};

use super::{Clipping, ClippingCoherent, Newton, NewtonCoherent, NewtonScratch, PENDING, newton_room};
use crate::lower::{NET, ORDER};

/// A method for the rays of a view, over points of type `P`: it looks for the closest hit.
pub trait ViewMethod<P: Point>: Send + Sync {
    /// The order in which it searches the patches of a scan line.
    const ORDER: Order;

    /// What one thread needs per ray, for any degrees.
    type Scratch: Default + Send;

    /// What a ray leaves to the next on one surface; `()` for a method without coherence.
    type Slot: Copy + Send;

    /// What a slot holds before it is filled.
    const EMPTY: Self::Slot;

    /// Coherence memory.
    type Memory<'c>;

    /// The memory of these slots, one per surface, as a scan line finds it.
    fn memory(slots: &mut [Self::Slot]) -> Self::Memory<'_>;

    /// The closest hit of a ray; `work` grows by what the call did. `scan_line` is a number that no earlier line with
    /// this memory had, at most 2³² − 2.
    fn closest(
        view: &View<'_, P>,
        line: &mut Line<'_, P::Scalar>,
        memory: &mut Self::Memory<'_>,
        scan_line: u32,
        ray: &ViewRay<P::Scalar>,
        limits: &Limits<P::Scalar>,
        scratch: &mut Self::Scratch,
        work: &mut Work,
    ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>>;
}

/// The closest hit by [`patchray::method::newton_predicted`].
#[derive(Clone, Copy, Debug)]
pub struct NewtonPredicted;

/// The closest hit by [`patchray::method::clipping_predicted`].
#[derive(Clone, Copy, Debug)]
pub struct ClippingPredicted;

/// What the clipping methods need per ray.
type ClippingScratch<P> = ClipScratch<P, ORDER, NET, PENDING>;

macro_rules! without_coherence {
    ($method:ty, $kernel:ident, $scratch:ty, $room:expr) => {
        impl<P: Point> ViewMethod<P> for $method {
            const ORDER: Order = Order::Surfaces;
            type Scratch = $scratch;
            type Slot = ();
            const EMPTY: Self::Slot = ();
            type Memory<'c> = ();

            fn memory(_: &mut [Self::Slot]) -> Self::Memory<'_> {}

            #[inline]
            fn closest(
                view: &View<'_, P>,
                line: &mut Line<'_, P::Scalar>,
                _: &mut Self::Memory<'_>,
                _: u32,
                ray: &ViewRay<P::Scalar>,
                limits: &Limits<P::Scalar>,
                scratch: &mut Self::Scratch,
                work: &mut Work,
            ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
                $kernel::closest_in_view(view, line, ray, limits, &mut $room(scratch), work)
            }
        }
    };
}

macro_rules! with_coherence {
    ($method:ty, $kernel:ident, $scratch:ty, $room:expr, $order:expr, $slot:ident, $memory:ty, $lend:expr) => {
        impl<P: Point> ViewMethod<P> for $method {
            const ORDER: Order = $order;
            type Scratch = $scratch;
            type Slot = $slot<P::Scalar>;
            const EMPTY: Self::Slot = $slot::EMPTY;
            type Memory<'c> = $memory;

            fn memory(slots: &mut [Self::Slot]) -> Self::Memory<'_> {
                $lend(slots)
            }

            #[inline]
            fn closest(
                view: &View<'_, P>,
                line: &mut Line<'_, P::Scalar>,
                memory: &mut Self::Memory<'_>,
                scan_line: u32,
                ray: &ViewRay<P::Scalar>,
                limits: &Limits<P::Scalar>,
                scratch: &mut Self::Scratch,
                work: &mut Work,
            ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
                $kernel::closest_in_view(view, line, memory, scan_line, ray, limits, &mut $room(scratch), work)
            }
        }
    };
}

/// The slots as [`Following`]: at the beginning of a scan line no surface was the last one.
fn following<S>(slots: &mut [Followed<S>]) -> Following<'_, S> {
    Following { slots, last: u32::MAX }
}

without_coherence!(Newton, newton, NewtonScratch<P>, newton_room);
without_coherence!(Clipping, clipping, ClippingScratch<P>, ClipScratch::view);

with_coherence!(
    NewtonCoherent,
    newton_coherent,
    NewtonScratch<P>,
    newton_room,
    Order::Surfaces,
    Remembered,
    &'c mut [Remembered<P::Scalar>],
    std::convert::identity
);
with_coherence!(
    ClippingCoherent,
    clipping_coherent,
    ClippingScratch<P>,
    ClipScratch::view,
    Order::Surfaces,
    Remembered,
    &'c mut [Remembered<P::Scalar>],
    std::convert::identity
);
with_coherence!(
    NewtonPredicted,
    newton_predicted,
    NewtonScratch<P>,
    newton_room,
    Order::Depth,
    Followed,
    Following<'c, P::Scalar>,
    following
);
with_coherence!(
    ClippingPredicted,
    clipping_predicted,
    ClippingScratch<P>,
    ClipScratch::view,
    Order::Depth,
    Followed,
    Following<'c, P::Scalar>,
    following
);
