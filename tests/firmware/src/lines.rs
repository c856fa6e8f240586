//! The methods that trace the rays of a view, whose scan lines are led by what they show.

use patchray::clipper::ClipRoom;
use patchray::fallback::NoFallback;
use patchray::limits::{Extent, Limits, Work};
use patchray::line::{Line, LineMemory, Window};
use patchray::method::{Followed, Following, ScratchView, clipping_predicted, newton_predicted};
use patchray::patch::{Patch, Patches};
use patchray::point::Point;
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::scene::Scene;
use patchray::span::Span;
use patchray::view::{RUN, Sight, View, ViewMemory};

use crate::hash::Answer;
use crate::picture::Picture;
use crate::tracer::{Tracer, count_of};

/// Buckets of a scan line: as many as the host's harness takes.
const BUCKETS: usize = 256;

/// The most runs of so many patches of so many surfaces.
pub const fn runs(patches: usize, surfaces: usize) -> usize {
    patches / RUN + surfaces
}

/// Memory for a view of `POINTS` control points, `COUNT` surfaces, `PATCHES` patches in `RUNS` runs, and `FIRST`, one more
/// than the surfaces; and for its scan lines.
#[derive(Debug)]
pub struct ViewRoom<
    P: Point,
    const POINTS: usize,
    const COUNT: usize,
    const FIRST: usize,
    const PATCHES: usize,
    const RUNS: usize,
> {
    points: [P; POINTS],
    surfaces: [[P::Scalar; 2]; COUNT],
    patches: [Patch<P::Scalar>; PATCHES],
    sights: [Sight<P::Scalar>; PATCHES],
    runs: [[P::Scalar; 2]; RUNS],
    first_runs: [u32; FIRST],
    followed: [Followed<P::Scalar>; COUNT],
    spans: [Span<P::Scalar>; PATCHES],
    active: [u32; PATCHES],
    buckets: [u32; BUCKETS],
}

impl<P: Point, const POINTS: usize, const COUNT: usize, const FIRST: usize, const PATCHES: usize, const RUNS: usize>
    ViewRoom<P, POINTS, COUNT, FIRST, PATCHES, RUNS>
{
    /// Empty memory, for a static.
    #[expect(clippy::new_without_default, reason = "it is for statics, where defaults cannot be called")]
    pub const fn new() -> Self {
        ViewRoom {
            points: [P::EMPTY; POINTS],
            surfaces: [[P::Scalar::ZERO; 2]; COUNT],
            patches: [Patch::EMPTY; PATCHES],
            sights: [Sight::EMPTY; PATCHES],
            runs: [[P::Scalar::ZERO; 2]; RUNS],
            first_runs: [0; FIRST],
            followed: [Followed::EMPTY; COUNT],
            spans: [Span::EMPTY; PATCHES],
            active: [0; PATCHES],
            buckets: [0; BUCKETS],
        }
    }

    /// The view of a scene and its patches that the picture's camera has, and memory for its lines; `None` if there is no
    /// such view.
    pub fn seen<'m, R>(
        &'m mut self,
        scene: &Scene<'m, P>,
        patches: &Patches<'m, P::Scalar>,
        picture: &Picture,
        scratch: R,
    ) -> Option<Seen<'m, P, R>> {
        let memory = ViewMemory {
            points: &mut self.points,
            surfaces: &mut self.surfaces,
            patches: &mut self.patches,
            sights: &mut self.sights,
            runs: &mut self.runs,
            first_runs: &mut self.first_runs,
        };
        let view = View::build(scene, patches, &picture.camera(), memory).ok()?;
        Some(Seen {
            view,
            patches: count_of(patches.all()),
            scratch,
            followed: &mut self.followed,
            spans: &mut self.spans,
            active: &mut self.active,
            buckets: &mut self.buckets,
        })
    }
}

/// What rays of a view need.
#[derive(Debug)]
pub struct Seen<'m, P: Point, R> {
    view: View<'m, P>,
    patches: u32,
    scratch: R,
    followed: &'m mut [Followed<P::Scalar>],
    spans: &'m mut [Span<P::Scalar>],
    active: &'m mut [u32],
    buckets: &'m mut [u32],
}

/// A scan line of a view.
#[derive(Debug)]
pub struct SeenLine<'l, 'm, P: Point, R> {
    view: &'l View<'m, P>,
    line: Line<'l, P::Scalar>,
    following: Following<'l, P::Scalar>,
    scratch: &'l mut R,
    number: u32,
}

/// The numerical method with predicted starts.
pub type NewtonPredicted<'m, P> = Seen<'m, P, ScratchView<'m, P, NoFallback>>;

/// The subdivision method with predicted starts.
pub type ClippingPredicted<'m, P> = Seen<'m, P, ClipRoom<'m, P>>;

macro_rules! tracer {
    ($name:ident, $room:ty, $kernel:ident, $clipped:literal) => {
        impl<'m, P: Point> Tracer<P> for $name<'m, P> {
            type Line<'l>
                = SeenLine<'l, 'm, P, $room>
            where
                Self: 'l;

            fn line(&mut self, picture: &Picture, number: u32) -> Option<Self::Line<'_>> {
                let Seen { view, scratch, followed, spans, active, buckets, .. } = self;
                let y = picture.y(number);
                let window = Window { x: [picture.x(0), picture.x(picture.size[0].saturating_sub(1))], y: [y, y] };
                let line = Line::build(view, window, LineMemory { spans, active, buckets }).ok()?;
                Some(SeenLine { view, line, following: Following { slots: followed, last: u32::MAX }, scratch, number })
            }

            #[inline(always)]
            fn ray(
                line: &mut Self::Line<'_>,
                at: [P::Scalar; 2],
                limits: &Limits<P::Scalar>,
                work: &mut Work,
            ) -> Answer<P::Scalar> {
                let SeenLine { view, line, following, scratch, number } = line;
                *work = Work::default();
                // As of single rays: none of these pictures' is refused.
                match view.ray(at, &Interval::ahead()) {
                    Ok(ray) => $kernel::closest_in_view(view, line, following, *number, &ray, limits, scratch, work),
                    Err(_) => Ok(None),
                }
            }

            fn extent(&self) -> Extent {
                Extent {
                    surfaces: count_of(self.followed),
                    patches: self.patches,
                    spans: self.patches,
                    walks: 2,
                    clipped: $clipped,
                    ..Extent::default()
                }
            }
        }
    };
}

tracer!(NewtonPredicted, ScratchView<'m, P, NoFallback>, newton_predicted, false);
tracer!(ClippingPredicted, ClipRoom<'m, P>, clipping_predicted, true);
