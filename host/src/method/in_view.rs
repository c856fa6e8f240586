//! The kernel's methods for the rays of one view, behind one face.

use patchray::limits::{GaveUp, Limits, Work};
use patchray::line::Line;
use patchray::method::{ClipScratch, Following, clipping_predicted, newton_predicted};
use patchray::point::Point;
use patchray::ray::Hit;
use patchray::view::{View, ViewRay};

use super::{NewtonScratch, PENDING, newton_room};
use crate::lower::{NET, ORDER};

/// A method for the rays of a view, over points of type `P`: it looks for the closest hit.
pub trait ViewMethod<P: Point>: Send + Sync {
    /// What one thread needs per ray, for any degrees.
    type Scratch: Default + Send;

    /// The closest hit of a ray; `work` grows by what the call did. `scan_line` is a number that no earlier line with
    /// this memory had, at most 2³² − 2.
    fn closest(
        view: &View<'_, P>,
        line: &mut Line<'_, P::Scalar>,
        memory: &mut Following<'_, P::Scalar>,
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

macro_rules! view_method {
    ($method:ty, $kernel:ident, $scratch:ty, $room:expr) => {
        impl<P: Point> ViewMethod<P> for $method {
            type Scratch = $scratch;

            #[inline]
            fn closest(
                view: &View<'_, P>,
                line: &mut Line<'_, P::Scalar>,
                memory: &mut Following<'_, P::Scalar>,
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

view_method!(NewtonPredicted, newton_predicted, NewtonScratch<P>, newton_room);
view_method!(ClippingPredicted, clipping_predicted, ClipScratch<P, ORDER, NET, PENDING>, ClipScratch::view);
