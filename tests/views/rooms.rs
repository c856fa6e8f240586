//! Views, lines and methods with the memory that they are lent.

use crate::common::{Kind, Prepared};
use patchray::limits::{GaveUp, Limits, Work};
use patchray::line::{Line, LineMemory, LineNeeds, Window};
use patchray::method::{
    ClipScratch, Followed, Following, Remembered, Scratch, clipping, clipping_coherent, clipping_predicted, newton,
    newton_coherent, newton_predicted,
};
use patchray::patch::Patch;
use patchray::point::Point;
use patchray::ray::Hit;
use patchray::scalar::Scalar;
use patchray::span::{Order, Span};
use patchray::view::{Camera, Sight, View, ViewError, ViewMemory, ViewNeeds, ViewRay};
use patchray_host::scene::trace::Method;

pub(crate) type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// The methods for the rays of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InView {
    Newton,
    NewtonCoherent,
    NewtonPredicted,
    /// In a view without patches.
    ClippingBare,
    Clipping,
    ClippingCoherent,
    ClippingPredicted,
    /// Newton's methods that fall back on clipping, which they do under `Acceptance::Proved`.
    NewtonProving,
    NewtonCoherentProving,
    NewtonPredictedProving,
}

impl InView {
    pub(crate) const ALL: [InView; 10] = [
        InView::Newton,
        InView::NewtonCoherent,
        InView::NewtonPredicted,
        InView::ClippingBare,
        InView::Clipping,
        InView::ClippingCoherent,
        InView::ClippingPredicted,
        InView::NewtonProving,
        InView::NewtonCoherentProving,
        InView::NewtonPredictedProving,
    ];

    /// The method whose error allowances it is held to. A predicted method verifies as the coherent one does.
    pub(crate) fn judged_as(self) -> Method {
        match self {
            InView::Newton | InView::NewtonProving => Method::Newton,
            InView::NewtonCoherent
            | InView::NewtonPredicted
            | InView::NewtonCoherentProving
            | InView::NewtonPredictedProving => Method::NewtonCoherent,
            InView::ClippingBare | InView::Clipping => Method::Clipping,
            InView::ClippingCoherent | InView::ClippingPredicted => Method::ClippingCoherent,
        }
    }

    pub(crate) fn has_patches(self) -> bool {
        self != InView::ClippingBare
    }

    pub(crate) fn remembers(self) -> bool {
        !matches!(self, InView::Newton | InView::NewtonProving | InView::ClippingBare | InView::Clipping)
    }

    /// In which order it searches a line.
    pub(crate) fn order(self) -> Order {
        let by_depth =
            matches!(self, InView::NewtonPredicted | InView::NewtonPredictedProving | InView::ClippingPredicted);
        if by_depth { Order::Depth } else { Order::Surfaces }
    }

    /// Whether it proves what it answers, as far as it is asked to.
    pub(crate) fn falls_back(self) -> bool {
        matches!(self, InView::NewtonProving | InView::NewtonCoherentProving | InView::NewtonPredictedProving)
    }
}

/// Memory for a view.
#[derive(Clone, Debug)]
pub(crate) struct ViewRoom<P: Point> {
    pub(crate) points: Vec<P>,
    pub(crate) surfaces: Vec<Sight<P::Scalar>>,
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
            surfaces: vec![Sight::EMPTY; surfaces],
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
    pub(crate) fn for_view(
        prepared: &Prepared<P>,
        with_patches: bool,
        camera: &Camera<P::Scalar>,
    ) -> Result<Self, ViewError> {
        let mut nothing = Self::sized([0; 6]);
        let patches = with_patches.then(|| prepared.patches());
        match View::build(&prepared.scene(), patches.as_ref(), camera, nothing.lend()) {
            Err(ViewError::Memory(needs)) => Ok(Self::sized(slots(&needs))),
            Err(error) => Err(error),
            // Of a scene whose first slot is rubbish.
            Ok(_) => Ok(nothing),
        }
    }

    pub(crate) fn build<'m>(
        &'m mut self,
        prepared: &'m Prepared<P>,
        with_patches: bool,
        camera: &Camera<P::Scalar>,
    ) -> Result<View<'m, P>, ViewError> {
        let patches = with_patches.then(|| prepared.patches());
        View::build(&prepared.scene(), patches.as_ref(), camera, self.lend())
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
        Self::sized(prepared.patches.len().max(prepared.surfaces.len()), buckets)
    }

    pub(crate) fn lend(&mut self) -> LineMemory<'_, S> {
        LineMemory { spans: &mut self.spans, active: &mut self.active, buckets: &mut self.buckets }
    }

    /// The line that a method takes.
    pub(crate) fn line<P: Point<Scalar = S>>(
        &mut self,
        view: &View<'_, P>,
        method: InView,
        window: Window<S>,
    ) -> Result<Line<'_, S>, LineNeeds> {
        if method.has_patches() {
            Line::of_patches(view, window, method.order(), self.lend())
        } else {
            Line::of_surfaces(view, window, self.lend())
        }
    }
}

/// What one thread traces with, whatever the method.
pub(crate) struct Thread<P: Point> {
    newton: Box<Scratch<P, 16, 256>>,
    clips: Box<ClipScratch<P, 16, 256, 64>>,
    pub(crate) remembered: Vec<Remembered<P::Scalar>>,
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
            remembered: vec![Remembered::EMPTY; surfaces],
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
        let Thread { newton, clips, remembered, followed, last, work } = self;
        // The kernel goes on counting from ray to ray; the suites ask of each.
        *work = Work::default();
        let mut memory = Following { slots: followed, last: *last };
        if method.falls_back() {
            let scratch = &mut newton.view_with(clips.view());
            let answer = match method {
                InView::NewtonProving => newton::closest_in_view(view, line, ray, limits, scratch, work),
                InView::NewtonCoherentProving => {
                    newton_coherent::closest_in_view(view, line, remembered, scan_line, ray, limits, scratch, work)
                }
                _ => newton_predicted::closest_in_view(view, line, &mut memory, scan_line, ray, limits, scratch, work),
            };
            *last = memory.last;
            return answer;
        }
        let (scratch, room) = (&mut newton.view(), &mut clips.view());
        let answer = match method {
            InView::Newton => newton::closest_in_view(view, line, ray, limits, scratch, work),
            InView::NewtonCoherent => {
                newton_coherent::closest_in_view(view, line, remembered, scan_line, ray, limits, scratch, work)
            }
            InView::NewtonPredicted
            | InView::NewtonProving
            | InView::NewtonCoherentProving
            | InView::NewtonPredictedProving => {
                newton_predicted::closest_in_view(view, line, &mut memory, scan_line, ray, limits, scratch, work)
            }
            InView::ClippingBare | InView::Clipping => clipping::closest_in_view(view, line, ray, limits, room, work),
            InView::ClippingCoherent => {
                clipping_coherent::closest_in_view(view, line, remembered, scan_line, ray, limits, room, work)
            }
            InView::ClippingPredicted => {
                clipping_predicted::closest_in_view(view, line, &mut memory, scan_line, ray, limits, room, work)
            }
        };
        *last = memory.last;
        answer
    }
}
