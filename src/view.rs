//! A view: what all rays from one eye share, computed once.
//!
//! The scene is turned so that the camera looks along one axis: then all rays of the view are steepest along it, and two
//! slopes are all that sets one apart from another. Of each patch it is known where in the image it can be seen, so that a scan
//! line ([`crate::line`]) knows beforehand which of them a ray can meet: no tree and no grid is walked.
//!
//! Ours: the paper knows only that rays of a scan line are coherent.

use crate::arena::{Arena, Need};
use crate::outline::Outline;
use crate::patch::{Patch, Patches};
use crate::planes::{DepthRange, Planes};
use crate::point::Point;
use crate::ray::{Interval, RayError};
use crate::scalar::Scalar;
use crate::scene::Scene;
use crate::surface::Surface;

mod lens;

pub use lens::{Camera, ViewHeader};
use lens::{Lens, Refusal};

/// What is seen of a patch: a slot of lent memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Sight<S> {
    /// Where in the image it can be seen.
    pub(crate) outline: Outline<S>,
    /// Its least depth.
    pub(crate) near: S,
}

impl<S: Scalar> Sight<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self = Sight { outline: Outline::EMPTY, near: S::ZERO };
}

/// Patches of one surface, one after another in memory, whose rows are kept together: the number of them. More make more
/// patches be looked at per scan line in vain, fewer make more runs.
pub const RUN: usize = 16;

/// Lent memory for a view.
#[derive(Debug)]
pub struct ViewMemory<'m, P: Point> {
    /// Control points of all surfaces, turned: as many as the scene has.
    pub points: &'m mut [P],
    /// The least and largest y of each surface: one slot per surface.
    pub surfaces: &'m mut [[P::Scalar; 2]],
    /// The patches, turned: as many as there are.
    pub patches: &'m mut [Patch<P::Scalar>],
    /// One slot per patch.
    pub sights: &'m mut [Sight<P::Scalar>],
    /// The least and largest y of each run of [`RUN`] patches of a surface.
    pub runs: &'m mut [[P::Scalar; 2]],
    /// The first run of each surface, and at last their number: surfaces + 1 slots.
    pub first_runs: &'m mut [u32],
}

/// Slots that a view needs, and what it was lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewNeeds {
    /// Of [`ViewMemory::points`].
    pub points: Need,
    /// Of [`ViewMemory::surfaces`].
    pub surfaces: Need,
    /// Of [`ViewMemory::patches`].
    pub patches: Need,
    /// Of [`ViewMemory::sights`].
    pub sights: Need,
    /// Of [`ViewMemory::runs`].
    pub runs: Need,
    /// Of [`ViewMemory::first_runs`].
    pub first_runs: Need,
}

/// Why a view was not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewError {
    /// Lent memory is too small; all needs are listed. Lending nothing is how to ask.
    Memory(ViewNeeds),
    /// The ray of the image's middle cannot be traced in this scene.
    Ray(RayError),
    /// The camera's three vectors lie in a plane, or all but, so that an image has no extent.
    Flat,
    /// The eye's largest |coordinate| is more than eight units of the frame, eight to sixteen times that of the scene: near to
    /// parallel, its rays would lose digits. They can be traced one by one.
    Far,
    /// Surfaces are much smaller than the scene, and have origins of their own; or they and the eye are near 0, as the scene goes:
    /// turned together with all else they would be met less exactly than rays one by one meet them.
    Near,
    /// The patches are of more or fewer surfaces than the scene has: they are another scene's.
    Patches,
    /// More patches than 32 bits can count.
    TooLarge,
}

impl core::fmt::Display for ViewError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            ViewError::Memory(needs) => write!(f, "lent memory is too small: {needs:?}"),
            ViewError::Ray(error) => write!(f, "the ray of the middle: {error}"),
            ViewError::Flat => f.write_str("the camera's vectors lie in a plane"),
            ViewError::Far => f.write_str("the eye is farther away than eight times the scene's size"),
            ViewError::Near => f.write_str(
                "surfaces that are much smaller than the scene have origins of their own, or the eye is among them",
            ),
            ViewError::Patches => f.write_str("the patches are of another scene"),
            ViewError::TooLarge => f.write_str("more patches than 32 bits can count"),
        }
    }
}

impl core::error::Error for ViewError {}

impl From<Refusal> for ViewError {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::Ray(error) => ViewError::Ray(error),
            Refusal::Flat => ViewError::Flat,
            Refusal::Far => ViewError::Far,
        }
    }
}

/// A scene as seen from one eye: a view of lent memory.
#[derive(Clone, Copy, Debug)]
pub struct View<'m, P: Point> {
    header: ViewHeader<P::Scalar>,
    scene: Scene<'m, P>,
    patches: Patches<'m, P::Scalar>,
    surfaces: &'m [[P::Scalar; 2]],
    sights: &'m [Sight<P::Scalar>],
    runs: &'m [[P::Scalar; 2]],
    first_runs: &'m [u32],
}

type PatchesSeen<'m, S> = (u32, &'m [Sight<S>], &'m [[S; 2]]);

/// A ray of a view. Made by [`View::ray`], so that it is valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewRay<S> {
    /// Its x and y.
    pub(crate) place: [S; 2],
    /// Turned.
    direction: [S; 3],
    interval: Interval<S>,
}

/// A ray of a view, with all that searching takes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facing<S> {
    pub(crate) place: [S; 2],
    pub(crate) planes: Planes<S>,
    pub(crate) range: DepthRange<S>,
    /// The distance from the eye to where depth is 0.
    pub(crate) ahead: S,
    /// How fast its slopes change with x, and with y.
    pub(crate) turning: [[S; 2]; 2],
}

impl<'m, P: Point> View<'m, P> {
    /// Turns a scene and its patches to a camera, into lent memory. Too little memory is an error that lists all needs.
    pub fn build(
        scene: &Scene<'m, P>,
        patches: &Patches<'m, P::Scalar>,
        camera: &Camera<P::Scalar>,
        memory: ViewMemory<'m, P>,
    ) -> Result<Self, ViewError> {
        let lens = lens_of(scene, patches, camera)?;
        let (infinity, least) = (P::Scalar::INFINITY, P::Scalar::LEAST);
        let along = scene
            .surfaces()
            .flat_map(|surface| surface.net.points().iter())
            .map(|point| point.turned(&lens.turn).position()[2]);
        let [low, high] = along.fold([infinity, least], |[low, high], c| [low.lesser(c), high.greater(c)]);
        let middle = if low <= high { (low + high) * P::Scalar::HALF } else { P::Scalar::ZERO };
        let mut points = Arena::new(memory.points);
        let mut surfaces = Arena::new(memory.surfaces);
        for Surface { net, .. } in scene.surfaces() {
            for point in net.points() {
                points.push(point.turned(&lens.turn));
            }
            surfaces.push(lens.outline(net.points().iter().map(|point| point.position())).rows());
        }
        let mut turned = Arena::new(memory.patches);
        let mut sights = Arena::new(memory.sights);
        let mut runs = Arena::new(memory.runs);
        let mut first_runs = Arena::new(memory.first_runs);
        for surface in 0..scene.len() {
            first_runs.push(u32::try_from(runs.len()).map_err(|_| ViewError::TooLarge)?);
            for run in patches.of_surface(surface).ok_or(ViewError::Patches)?.chunks(RUN) {
                let mut rows = [infinity, least];
                for patch in run {
                    let bounds = patch.bounds().turned(&lens.turn);
                    let corners = patch.bounds().corners();
                    let outline = lens.outline(corners.into_iter());
                    let [y0, y1] = outline.rows();
                    rows = [rows[0].lesser(y0), rows[1].greater(y1)];
                    turned.push(Patch { bounds, ..*patch });
                    sights.push(Sight { outline, near: bounds.aabb().low[2] - middle });
                }
                runs.push(rows);
            }
        }
        first_runs.push(u32::try_from(runs.len()).map_err(|_| ViewError::TooLarge)?);
        let needs = ViewNeeds {
            points: points.need(),
            surfaces: surfaces.need(),
            patches: turned.need(),
            sights: sights.need(),
            runs: runs.need(),
            first_runs: first_runs.need(),
        };
        let all = [needs.points, needs.surfaces, needs.patches, needs.sights, needs.runs, needs.first_runs];
        if !all.iter().all(Need::met) {
            return Err(ViewError::Memory(needs));
        }
        Ok(View {
            header: ViewHeader { middle, ..lens.header },
            scene: scene.with_points(points.finish()),
            patches: patches.with_patches(turned.finish()),
            surfaces: surfaces.finish(),
            sights: sights.finish(),
            runs: runs.finish(),
            first_runs: first_runs.finish(),
        })
    }

    /// A view of slots that [`View::build`] filled before, of the scene and the patches with their points and boxes turned.
    /// Slots that were filled otherwise give wrong answers, but neither panics nor work beyond the limits.
    pub const fn new(
        header: ViewHeader<P::Scalar>,
        scene: Scene<'m, P>,
        patches: Patches<'m, P::Scalar>,
        surfaces: &'m [[P::Scalar; 2]],
        sights: &'m [Sight<P::Scalar>],
        runs: &'m [[P::Scalar; 2]],
        first_runs: &'m [u32],
    ) -> Self {
        View { header, scene, patches, surfaces, sights, runs, first_runs }
    }

    /// What to keep beside the slots, for [`View::new`].
    pub fn header(&self) -> ViewHeader<P::Scalar> {
        self.header
    }

    /// Whether there can be a view of a scene from a camera, but for memory and numbers of patches.
    #[cfg(all(feature = "capi", not(test)))]
    pub(crate) fn check(
        scene: &Scene<'m, P>,
        patches: &Patches<'m, P::Scalar>,
        camera: &Camera<P::Scalar>,
    ) -> Result<(), ViewError> {
        lens_of(scene, patches, camera).map(|_| ())
    }

    /// How many slots of each kind it takes, in the order of [`ViewMemory`].
    #[cfg(all(feature = "capi", not(test)))]
    pub(crate) fn lens(&self) -> [usize; 6] {
        let View { scene, patches, surfaces, sights, runs, first_runs, .. } = self;
        let [points, ..] = scene.lens();
        [points, surfaces.len(), patches.all().len(), sights.len(), runs.len(), first_runs.len()]
    }

    /// The patches, turned.
    #[inline]
    pub(crate) fn patches(&self) -> &'m [Patch<P::Scalar>] {
        self.patches.all()
    }

    /// The least and largest y of each surface.
    pub(crate) fn surfaces(&self) -> &'m [[P::Scalar; 2]] {
        self.surfaces
    }

    /// The number of a surface's first patch, what is seen of its patches, and the rows of its runs.
    pub(crate) fn patches_of(&self, surface: usize) -> Option<PatchesSeen<'m, P::Scalar>> {
        let (first, end) = self.patches.range(surface)?;
        let (run, last) =
            (*self.first_runs.get(surface)? as usize, *self.first_runs.get(surface.checked_add(1)?)? as usize);
        Some((first as u32, self.sights.get(first..end)?, self.runs.get(run..last)?))
    }

    /// A surface by its number, turned.
    #[inline]
    pub(crate) fn surface(&self, number: usize) -> Option<Surface<'m, P>> {
        self.scene.surface(number)
    }

    /// The ray of the image's point (x, y) in `interval`, as far as that lies ahead of the eye. Refuses NaN, and directions
    /// more than 45° off `forward`, in either of the directions across it.
    #[inline(always)]
    pub fn ray(&self, [x, y]: [P::Scalar; 2], interval: &Interval<P::Scalar>) -> Result<ViewRay<P::Scalar>, RayError> {
        let ViewHeader { directions: [forward, right, up], unscale, farthest, .. } = &self.header;
        let direction: [P::Scalar; 3] = core::array::from_fn(|k| forward[k] + x * right[k] + y * up[k]);
        let [across, upward, speed] = direction;
        if !(across.abs() <= speed && upward.abs() <= speed) {
            return Err(RayError::OutOfView);
        }
        // See `Frame::ray`.
        let small = *unscale * P::Scalar::EPSILON;
        if !(*farthest < P::Scalar::MAX * speed && small >= P::Scalar::MIN_POSITIVE * speed) {
            return Err(RayError::Unrepresentable);
        }
        Ok(ViewRay { place: [x, y], direction, interval: *interval })
    }

    /// The ray with all that searching takes: most rays that meet nothing are done with before.
    #[inline(always)]
    pub(crate) fn facing(&self, ray: &ViewRay<P::Scalar>) -> Facing<P::Scalar> {
        let ViewHeader { eye, middle, directions: [_, right, up], scale, unscale, .. } = &self.header;
        let ViewRay { place, direction: [across, upward, speed], interval } = *ray;
        let (zero, one) = (P::Scalar::ZERO, P::Scalar::ONE);
        let inverse = one / speed;
        let slopes = [across * inverse, upward * inverse];
        let ahead = *middle - eye[2];
        let origin = [eye[0] + slopes[0] * ahead, eye[1] + slopes[1] * ahead, *middle];
        let interval = Interval { min: interval.min.greater(zero), max: interval.max };
        let depth = |t: P::Scalar| t * speed * *scale - ahead;
        let range = DepthRange { min: depth(interval.min), max: depth(interval.max) };
        let t_per_depth = *unscale * inverse;
        let direction = [slopes[0], slopes[1], one];
        let planes = Planes::turned(origin, direction, ahead * t_per_depth, t_per_depth, interval);
        let turns = |[x, y, z]: [P::Scalar; 3]| [(x - slopes[0] * z) * inverse, (y - slopes[1] * z) * inverse];
        // One by one, for `map` of a nested array may stay a call, whose results come through memory.
        let turning = [turns(*right), turns(*up)];
        Facing { place, planes, range, ahead, turning }
    }
}

/// The lens of a camera that looks at a scene and its patches, if they are its own.
fn lens_of<P: Point>(
    scene: &Scene<'_, P>,
    patches: &Patches<'_, P::Scalar>,
    camera: &Camera<P::Scalar>,
) -> Result<Lens<P::Scalar>, ViewError> {
    if patches.surfaces() != scene.len() {
        return Err(ViewError::Patches);
    }
    let lens = Lens::of(scene.frame(), camera)?;
    // The ray's own coordinates are then much smaller than the scene's, too.
    if scene.shapes().any(|shape| shape.is_moved() || shape.is_apart() && lens.eye_is_apart()) {
        return Err(ViewError::Near);
    }
    Ok(lens)
}

#[cfg(test)]
mod tests;
