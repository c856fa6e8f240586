//! Views, lines and methods with the memory that they are lent.

use crate::common::{Kind, Prepared};
use patchray::limits::{GaveUp, Limits, Work};
use patchray::line::{Line, LineMemory, LineNeeds, Window};
use patchray::method::{ClipScratch, Followed, Following, Scratch, clipping_predicted, newton_predicted};
use patchray::patch::Patch;
use patchray::point::Point;
use patchray::ray::Hit;
use patchray::scalar::Scalar;
use patchray::span::Span;
use patchray::view::{Camera, Sight, View, ViewError, ViewMemory, ViewNeeds, ViewRay};
use patchray_host::scene::trace::Method;

pub(crate) type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// The methods for the rays of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InView {
    NewtonPredicted,
    ClippingPredicted,
    /// Newton's, falling back on clipping, which it does under `Acceptance::Proved`.
    NewtonPredictedProving,
}

impl InView {
    pub(crate) const ALL: [InView; 3] =
        [InView::NewtonPredicted, InView::ClippingPredicted, InView::NewtonPredictedProving];

    /// The method whose error allowances it is held to: a predicted method verifies as the coherent one does.
    pub(crate) fn judged_as(self) -> Method {
        match self {
            InView::NewtonPredicted | InView::NewtonPredictedProving => Method::NewtonCoherent,
            InView::ClippingPredicted => Method::ClippingCoherent,
        }
    }

    /// The method without memory that it is made of.
    pub(crate) fn original(self) -> Method {
        match self {
            InView::NewtonPredicted | InView::NewtonPredictedProving => Method::Newton,
            InView::ClippingPredicted => Method::Clipping,
        }
    }
}

/// Memory for a view.
#[derive(Clone, Debug)]
pub(crate) struct ViewRoom<P: Point> {
    pub(crate) points: Vec<P>,
    pub(crate) surfaces: Vec<[P::Scalar; 2]>,
    pub(crate) patches: Vec<Patch<P::Scalar>>,
    pub(crate) sights: Vec<Sight<P::Scalar>>,
    pub(crate) runs: Vec<[P::Scalar; 2]>,
    pub(crate) first_runs: Vec<u32>,
}

impl<P: Kind> ViewRoom<P> {
    /// Of as many slots of each kind.
    pub(crate) fn sized([points, surfaces, patches, sights, runs, first_runs]: [usize; 6]) -> Self {
        ViewRoom {
            points: vec![P::EMPTY; points],
            surfaces: vec![[P::Scalar::ZERO; 2]; surfaces],
            patches: vec![Patch::EMPTY; patches],
            sights: vec![Sight::EMPTY; sights],
            runs: vec![[P::Scalar::ZERO; 2]; runs],
            first_runs: vec![0; first_runs],
        }
    }

    pub(crate) fn lend(&mut self) -> ViewMemory<'_, P> {
        let ViewRoom { points, surfaces, patches, sights, runs, first_runs } = self;
        ViewMemory { points, surfaces, patches, sights, runs, first_runs }
    }

    /// As much as asking says; or why there is no such view.
    pub(crate) fn for_view(prepared: &Prepared<P>, camera: &Camera<P::Scalar>) -> Result<Self, ViewError> {
        let mut nothing = Self::sized([0; 6]);
        match nothing.build(prepared, camera) {
            Err(ViewError::Memory(needs)) => Ok(Self::sized(slots(&needs))),
            Err(error) => Err(error),
            // Of a scene whose first slot is rubbish.
            Ok(_) => Ok(Self::sized([0; 6])),
        }
    }

    pub(crate) fn build<'m>(
        &'m mut self,
        prepared: &'m Prepared<P>,
        camera: &Camera<P::Scalar>,
    ) -> Result<View<'m, P>, ViewError> {
        View::build(&prepared.scene(), &prepared.patches(), camera, self.lend())
    }
}

/// How many slots of each kind are needed.
pub(crate) fn slots(needs: &ViewNeeds) -> [usize; 6] {
    [needs.points, needs.surfaces, needs.patches, needs.sights, needs.runs, needs.first_runs].map(|need| need.needed)
}

/// Memory for a line.
#[derive(Clone, Debug)]
pub(crate) struct LineRoom<S> {
    pub(crate) spans: Vec<Span<S>>,
    pub(crate) active: Vec<u32>,
    pub(crate) buckets: Vec<u32>,
}

impl<S: Scalar> LineRoom<S> {
    pub(crate) fn sized(spans: usize, buckets: usize) -> Self {
        LineRoom { spans: vec![Span::EMPTY; spans], active: vec![0; spans], buckets: vec![0; buckets] }
    }

    /// Enough for any line of a model.
    pub(crate) fn for_any<P: Kind<Scalar = S>>(prepared: &Prepared<P>, buckets: usize) -> Self {
        Self::sized(prepared.patches.len(), buckets)
    }

    pub(crate) fn lend(&mut self) -> LineMemory<'_, S> {
        LineMemory { spans: &mut self.spans, active: &mut self.active, buckets: &mut self.buckets }
    }

    /// A line of a view.
    pub(crate) fn line<P: Point<Scalar = S>>(
        &mut self,
        view: &View<'_, P>,
        window: Window<S>,
    ) -> Result<Line<'_, S>, LineNeeds> {
        Line::build(view, window, self.lend())
    }
}

/// What one thread traces with, whatever the method.
pub(crate) struct Thread<P: Point> {
    newton: Box<Scratch<P, 16, 256>>,
    clips: Box<ClipScratch<P, 16, 256, 64>>,
    pub(crate) followed: Vec<Followed<P::Scalar>>,
    pub(crate) last: u32,
    /// Of the last call.
    pub(crate) work: Work,
}

impl<P: Kind> Thread<P> {
    pub(crate) fn new(surfaces: usize) -> Self {
        Thread {
            newton: Box::new(Scratch::new()),
            clips: Box::new(ClipScratch::new()),
            followed: vec![Followed::EMPTY; surfaces],
            last: 0,
            work: Work::default(),
        }
    }

    pub(crate) fn trace(
        &mut self,
        method: InView,
        view: &View<'_, P>,
        line: &mut Line<'_, P::Scalar>,
        scan_line: u32,
        ray: &ViewRay<P::Scalar>,
        limits: &Limits<P::Scalar>,
    ) -> Answer<P::Scalar> {
        let Thread { newton, clips, followed, last, work } = self;
        // The kernel goes on counting from ray to ray; the suites ask of each.
        *work = Work::default();
        let memory = &mut Following { slots: followed, last: *last };
        let answer = match method {
            InView::NewtonPredicted => {
                let scratch = &mut newton.view();
                newton_predicted::closest_in_view(view, line, memory, scan_line, ray, limits, scratch, work)
            }
            InView::NewtonPredictedProving => {
                let scratch = &mut newton.view_with(clips.view());
                newton_predicted::closest_in_view(view, line, memory, scan_line, ray, limits, scratch, work)
            }
            InView::ClippingPredicted => {
                let room = &mut clips.view();
                clipping_predicted::closest_in_view(view, line, memory, scan_line, ray, limits, room, work)
            }
        };
        *last = memory.last;
        answer
    }
}
