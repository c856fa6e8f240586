//! Many surfaces: their min-max boxes, a uniform grid over them, and the closest hit over all.
//!
//! Source: the paper's section "Experimental Results" (uniform space subdivision and min-max boxes reduce unnecessary
//! ray-surface tests). The scene knows no method: a method is a function that searches one surface within a range of depths.

use crate::arena::{Arena, Need};
use crate::bernstein::{BasisView, Full};
use crate::frame::{Aabb, Frame};
use crate::grid::{Grid, GridSlot};
use crate::limits::{GaveUp, Limit, Limits, Work, spend};
use crate::planes::{DepthRange, Planes};
use crate::point::Point;
use crate::ray::{Hit, Interval, Ray, RayError};
use crate::reading::Reading;
use crate::root::Root;
use crate::scalar::{Scalar, Vector3};
use crate::story::Event;
use crate::surface::{APART, Net, NetError, Shape, Surface};

/// A surface as a slot of lent memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SurfaceSlot<S> {
    /// The box of its control points, in the frame, padded.
    bounds: Aabb<S>,
    shape: Shape<S>,
    /// The first of its control points.
    first: u32,
    degree_u: u32,
    degree_v: u32,
}

impl<S: Scalar> SurfaceSlot<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self =
        SurfaceSlot { bounds: Aabb::ORIGIN, shape: Shape::EMPTY, first: 0, degree_u: 0, degree_v: 0 };

    /// The slot that holds these numbers. For tables; see [`LAYOUT`](crate::LAYOUT).
    ///
    /// They are the box's least and largest corner, then [`Shape`]'s bend, its size, reach and least weight, and its origin; then
    /// the first of its control points, and the degrees in u and v.
    pub const fn from_numbers(
        [low, high, bend, shape, origin]: [[S; 3]; 5],
        [first, degree_u, degree_v]: [u32; 3],
    ) -> Self {
        let [size, reach, lightest] = shape;
        let shape = Shape { bend, size, reach, lightest, origin };
        SurfaceSlot { bounds: Aabb { low, high }, shape, first, degree_u, degree_v }
    }

    /// What [`SurfaceSlot::from_numbers`] takes.
    pub const fn numbers(&self) -> ([[S; 3]; 5], [u32; 3]) {
        let Shape { bend, size, reach, lightest, origin } = self.shape;
        let lengths = [self.bounds.low, self.bounds.high, bend, [size, reach, lightest], origin];
        (lengths, [self.first, self.degree_u, self.degree_v])
    }
}

/// Lent memory for a scene.
#[derive(Debug)]
pub struct SceneMemory<'m, P: Point> {
    /// Control points of all surfaces, in the frame, relative to the surfaces' own origins.
    pub points: &'m mut [P],
    /// One slot per surface.
    pub surfaces: &'m mut [SurfaceSlot<P::Scalar>],
    /// Of the scene's grid: one offset per voxel, and one more.
    pub offsets: &'m mut [u32],
    /// Of the scene's grid: the surfaces in each voxel.
    pub references: &'m mut [u32],
}

/// Slots that a scene needs, and what it was lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneNeeds {
    /// Of [`SceneMemory::points`].
    pub points: Need,
    /// Of [`SceneMemory::surfaces`].
    pub surfaces: Need,
    /// Of [`SceneMemory::offsets`].
    pub offsets: Need,
    /// Of [`SceneMemory::references`].
    pub references: Need,
}

/// How fine the scene's grid is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneOptions<S> {
    /// Voxels per surface. More cost memory and steps, fewer cost box tests.
    pub density: S,
    /// The most voxels.
    pub voxels: u32,
    /// Where the nets' coordinates are 0, in the coordinates of rays and hits. Of a scene far from 0 the nets lose digits on
    /// the way unless they are given relative to a point near them: [`exact_origin`](crate::frame::exact_origin) is one that
    /// can be subtracted from their control points without rounding, before weights are multiplied in.
    pub origin: [S; 3],
}

impl<S: Scalar> Default for SceneOptions<S> {
    fn default() -> Self {
        SceneOptions { density: S::from_f64(2.0), voxels: 1 << 20, origin: [S::ZERO; 3] }
    }
}

/// Why a scene was not built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneError {
    /// Lent memory is too small; all needs are listed. Lending nothing is how to ask.
    Memory(SceneNeeds),
    /// A surface is not valid.
    Surface {
        /// Its number.
        surface: u32,
        /// What is wrong with it.
        error: NetError,
    },
    /// More surfaces, points or voxels than their numbers can count.
    TooLarge,
}

impl core::fmt::Display for SceneError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            SceneError::Memory(needs) => write!(f, "lent memory is too small: {needs:?}"),
            SceneError::Surface { surface, error } => write!(f, "surface {surface}: {error}"),
            SceneError::TooLarge => f.write_str("more surfaces or points than 32 bits can count"),
        }
    }
}

impl core::error::Error for SceneError {}

/// What a scene holds beside its slots: plain numbers, to be kept with them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SceneHeader<S> {
    frame: Frame<S>,
    grid: GridSlot<S>,
}

impl<S: Scalar> SceneHeader<S> {
    /// The header of a scene with this frame, and this grid over its surfaces. For tables; see [`LAYOUT`](crate::LAYOUT).
    pub const fn new(frame: Frame<S>, grid: GridSlot<S>) -> Self {
        SceneHeader { frame, grid }
    }

    /// The scene's frame.
    pub const fn frame(&self) -> &Frame<S> {
        &self.frame
    }

    /// The grid over the surfaces.
    pub const fn grid(&self) -> &GridSlot<S> {
        &self.grid
    }
}

/// Surfaces with a grid over them: a view of lent memory.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'m, P: Point> {
    header: SceneHeader<P::Scalar>,
    points: &'m [P],
    surfaces: &'m [SurfaceSlot<P::Scalar>],
    offsets: &'m [u32],
    references: &'m [u32],
}

impl<'m, P: Point> Scene<'m, P> {
    /// Builds a scene from nets in the caller's coordinates, relative to [`SceneOptions::origin`]: checks them, copies their
    /// points into the frame, and builds the grid. Too little memory is an error that lists all needs.
    pub fn build(
        nets: &[Net<'_, P>],
        options: &SceneOptions<P::Scalar>,
        memory: SceneMemory<'m, P>,
    ) -> Result<Self, SceneError> {
        Scene::build_apart(nets, &[], options, memory)
    }

    /// The same from nets each of which is given relative to an origin of its own beside that, by its number; 0 where there is
    /// none. From that its coordinates must be less than an eighth of the scene's.
    ///
    /// A small surface in a large scene is met to the rounding of its own coordinates. With a net that is given relative to a
    /// point near it, such as [`exact_origin`](crate::frame::exact_origin) of its own box, that is the rounding of its size.
    /// A ray is brought near such a surface with care, which costs time, and there is no view of them: [`ViewError::Near`].
    ///
    /// [`ViewError::Near`]: crate::view::ViewError::Near
    pub fn build_apart(
        nets: &[Net<'_, P>],
        origins: &[[P::Scalar; 3]],
        options: &SceneOptions<P::Scalar>,
        memory: SceneMemory<'m, P>,
    ) -> Result<Self, SceneError> {
        let own = |k: usize| origins.get(k).copied().unwrap_or([P::Scalar::ZERO; 3]);
        Scene::build_from(nets.len(), |k| Some((*nets.get(k)?, own(k))), options, memory)
    }

    /// The same from `count` nets and their origins that `net` gives by their numbers, each as often as it is asked for.
    pub(crate) fn build_from<'n>(
        count: usize,
        net: impl Fn(usize) -> Option<(Net<'n, P>, [P::Scalar; 3])>,
        options: &SceneOptions<P::Scalar>,
        memory: SceneMemory<'m, P>,
    ) -> Result<Self, SceneError> {
        let nets = || (0..count).map_while(&net);
        let mut bounds = Aabb::EMPTY;
        for (surface, (net, origin)) in (0_u32..).zip(nets()) {
            let refused = |error| SceneError::Surface { surface, error };
            Net::checked(net.degree_u(), net.degree_v(), net.points()).map_err(refused)?;
            let own = control_box(&net, origin);
            if !origin.iter().chain(&own.low).chain(&own.high).all(|c| c.is_finite()) {
                return Err(refused(NetError::Origin));
            }
            bounds = bounds.union(own);
        }
        let frame = Frame::new(bounds).with_origin(options.origin);
        let mut points = Arena::new(memory.points);
        let mut surfaces = Arena::new(memory.surfaces);
        let boxes = |k: usize| {
            let scaled = net(k).map_or(Aabb::EMPTY, |(net, origin)| control_box(&net, origin));
            let [low, high] = [scaled.low, scaled.high].map(|corner| frame.from_nets(corner));
            Aabb { low, high }.padded(Frame::padding())
        };
        for (k, (net, origin)) in nets().enumerate() {
            let first = u32::try_from(points.len()).map_err(|_| SceneError::TooLarge)?;
            let refused = |error| SceneError::Surface { surface: k as u32, error };
            let own = control_box(&net, [P::Scalar::ZERO; 3]);
            if origin != [P::Scalar::ZERO; 3] && !is_near(&frame, own) {
                return Err(refused(NetError::Origin));
            }
            if is_lost(&frame, own) {
                return Err(refused(NetError::Small));
            }
            // Weights matter up to a common factor: the largest is brought near 1, exactly.
            let heaviest = net.points().iter().fold(P::Scalar::ZERO, |w, p| w.greater(p.weight()));
            let weight = if P::RATIONAL { -heaviest.binary_exponent() } else { 0 };
            for point in net.points() {
                points.push(point.rescaled(frame.exponent(), weight));
            }
            let shape = points.since(first as usize).map_or(Shape::EMPTY, |scaled| {
                let scaled = Net::new(net.degree_u(), net.degree_v(), &*scaled);
                scaled.map_or(Shape::EMPTY, |scaled| Shape { origin: frame.from_nets(origin), ..Shape::of(&scaled) })
            });
            let (degree_u, degree_v) = (net.degree_u() as u32, net.degree_v() as u32);
            surfaces.push(SurfaceSlot { bounds: boxes(k), shape, first, degree_u, degree_v });
        }
        let mut offsets = Arena::new(memory.offsets);
        let mut references = Arena::new(memory.references);
        let grid = GridSlot::build(count, boxes, options.density, options.voxels, &mut offsets, &mut references)
            .map_err(|_| SceneError::TooLarge)?;
        let needs = SceneNeeds {
            points: points.need(),
            surfaces: surfaces.need(),
            offsets: offsets.need(),
            references: references.need(),
        };
        if ![needs.points, needs.surfaces, needs.offsets, needs.references].iter().all(Need::met) {
            return Err(SceneError::Memory(needs));
        }
        let (points, surfaces) = (points.finish(), surfaces.finish());
        let header = SceneHeader { frame, grid };
        Ok(Scene { header, points, surfaces, offsets: offsets.finish(), references: references.finish() })
    }

    /// The view of memory that was filled before, such as a table in flash, with the header of the scene that filled it.
    pub const fn new(
        header: SceneHeader<P::Scalar>,
        points: &'m [P],
        surfaces: &'m [SurfaceSlot<P::Scalar>],
        offsets: &'m [u32],
        references: &'m [u32],
    ) -> Self {
        Scene { header, points, surfaces, offsets, references }
    }

    /// The same surfaces over other points: of which then neither boxes nor grid hold true.
    pub(crate) fn with_points(&self, points: &'m [P]) -> Self {
        Scene { points, ..*self }
    }

    /// What to keep beside the slots, for [`Scene::new`].
    pub fn header(&self) -> SceneHeader<P::Scalar> {
        self.header
    }

    /// How many slots of each kind it takes, in the order of [`SceneMemory`].
    #[cfg(all(feature = "capi", not(test)))]
    pub(crate) fn lens(&self) -> [usize; 4] {
        [self.points.len(), self.surfaces.len(), self.offsets.len(), self.references.len()]
    }

    /// The scene's frame.
    pub fn frame(&self) -> &Frame<P::Scalar> {
        &self.header.frame
    }

    /// The number of surfaces.
    pub fn len(&self) -> usize {
        self.surfaces.len()
    }

    /// Whether there are no surfaces.
    pub fn is_empty(&self) -> bool {
        self.surfaces.is_empty()
    }

    /// The most voxels of the scene's grid that one ray can pass.
    pub fn longest_walk(&self) -> u32 {
        self.header.grid.longest_walk()
    }

    /// Makes a ray of this scene; see [`Frame::ray`].
    pub fn ray(&self, origin: [P::Scalar; 3], direction: [P::Scalar; 3]) -> Result<Ray<P::Scalar>, RayError> {
        self.header.frame.ray(origin, direction)
    }

    /// A surface by its number; `None` if there is none, or the memory does not hold it.
    #[inline]
    pub fn surface(&self, number: usize) -> Option<Surface<'m, P>> {
        let slot = self.surfaces.get(number)?;
        let (n, m, first) = (slot.degree_u as usize, slot.degree_v as usize, slot.first as usize);
        let count = n.checked_add(1)?.checked_mul(m.checked_add(1)?)?;
        let points = self.points.get(first..first.checked_add(count)?)?;
        Some(Surface { number: number as u32, net: Net::new(n, m, points).ok()?, shape: slot.shape })
    }

    /// All surfaces.
    pub fn surfaces(&self) -> impl Iterator<Item = Surface<'m, P>> {
        (0..self.len()).map_while(|k| self.surface(k))
    }

    /// What is known of each surface.
    pub(crate) fn shapes(&self) -> impl Iterator<Item = &'m Shape<P::Scalar>> {
        self.surfaces.iter().map(|slot| &slot.shape)
    }

    /// The unit normal at a hit, along ∂S/∂u × ∂S/∂v; `None` where there is none, as at the apex of a cone. See
    /// [`Net::normal`].
    pub fn normal(
        &self,
        hit: &Hit<P::Scalar>,
        basis: &mut BasisView<'_, P::Scalar>,
    ) -> Result<Option<[P::Scalar; 3]>, GaveUp<P::Scalar>> {
        let give_up = |limit| GaveUp { limit, best: Some(*hit) };
        let surface = self.surface(hit.surface as usize).ok_or(give_up(Limit::Slot))?;
        surface.net.normal(hit.u, hit.v, basis).map_err(|Full| give_up(Limit::Scratch))
    }

    /// The closest hit of a ray over all surfaces, those in front first. By the paper's letter all are searched that the ray meets.
    ///
    /// `search` is given a surface, the ray's planes and the range of depths in which a root matters, and returns the
    /// closest root it finds. `work` is set to what this call did.
    #[inline]
    pub fn closest(
        &self,
        reading: impl Reading,
        ray: &Ray<P::Scalar>,
        interval: &Interval<P::Scalar>,
        limits: &Limits<P::Scalar>,
        work: &mut Work,
        mut search: impl FnMut(
            &Surface<'m, P>,
            &Planes<P::Scalar>,
            DepthRange<P::Scalar>,
            &mut Work,
        ) -> Result<Option<Root<P::Parameter>>, Limit>,
    ) -> Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>> {
        let mut best: Option<(Root<P::Parameter>, u32, P::Scalar)> = None;
        let ended = self.visit(ray, interval, limits, work, |surface, planes, within, work| {
            let Some(root) = search(surface, planes, within, work)? else {
                return Ok(P::Scalar::INFINITY);
            };
            let t = planes.t(root.depth);
            // Of equal depths the lower number wins, so that the answer does not depend on the order of search; t decides, since
            // depths of surfaces apart are counted from elsewhere.
            let closer = |(old, other, old_t): (Root<P::Parameter>, u32, P::Scalar)| {
                t < old_t || (t == old_t && (root.depth, surface.number) < (old.depth, other))
            };
            if best.is_none_or(closer) {
                best = Some((root, surface.number, t));
            }
            Ok(if reading.pruning() { root.depth } else { P::Scalar::INFINITY })
        });
        let best = best.map(|(root, surface, t)| root.hit(surface, t));
        match ended {
            Ok(()) => Ok(best),
            Err(limit) => Err(GaveUp { limit, best }),
        }
    }

    /// Every surface whose box a ray meets in its interval, once each, about front to back.
    ///
    /// `search` is given a surface, the ray's planes and the range of depths in which a root matters, and returns the
    /// farthest depth that matters from then on: infinity to go on as before, [`Scalar::LEAST`] to end. `work` is set to
    /// what this call did.
    #[inline(always)]
    pub fn visit(
        &self,
        ray: &Ray<P::Scalar>,
        interval: &Interval<P::Scalar>,
        limits: &Limits<P::Scalar>,
        work: &mut Work,
        mut search: impl FnMut(
            &Surface<'m, P>,
            &Planes<P::Scalar>,
            DepthRange<P::Scalar>,
            &mut Work,
        ) -> Result<P::Scalar, Limit>,
    ) -> Result<(), Limit> {
        *work = Work::default();
        P::Scalar::tell(|| Event::Ray);
        let Some((planes, range)) = self.header.frame.enter(ray, interval) else {
            return Ok(());
        };
        let (origin, inverse) = (planes.origin(), planes.inverse());
        let mut farthest = range.max;
        let grid = Grid::new(&self.header.grid, self.offsets, self.references).ok_or(Limit::Slot)?;
        let mut walk = grid.walk(&origin, &inverse, range.max);
        // Ends with the walk, or where no later voxel can hold a root that matters.
        while let Some(voxel) = walk.advance() {
            let mut voxel = voxel.map_err(|()| Limit::Slot)?;
            spend(&mut work.voxels_visited, limits.voxels, Limit::Voxels)?;
            P::Scalar::tell(|| Event::SceneVoxel);
            while let Some(number) = voxel.next_fresh() {
                let slot = self.surfaces.get(number).ok_or(Limit::Slot)?;
                spend(&mut work.surfaces_tested, limits.surfaces, Limit::Surfaces)?;
                let Some((near, far)) = slot.bounds.depths(&origin, &inverse) else {
                    continue;
                };
                let within = DepthRange { min: near.greater(range.min), max: far.lesser(farthest) };
                if !(within.min <= within.max) {
                    continue;
                }
                let surface = self.surface(number).ok_or(Limit::Slot)?;
                P::Scalar::tell(|| Event::Surface(surface.number));
                farthest = farthest.lesser(if slot.shape.is_apart() {
                    let shape = &slot.shape;
                    let Some((near, range)) =
                        self.header.frame.enter_near(ray, interval, &slot.bounds, shape.origin, shape.unit())
                    else {
                        continue;
                    };
                    let within =
                        DepthRange { min: range.min, max: range.max.lesser(near.depth_from(&planes, farthest)) };
                    if !(within.min <= within.max) {
                        continue;
                    }
                    planes.depth_from(&near, search(&surface, &near, within, work)?)
                } else {
                    search(&surface, &planes, within, work)?
                });
            }
            if voxel.exit >= farthest {
                break;
            }
        }
        Ok(())
    }
}

/// Whether coordinates in this box are as small as those of a net with an origin of its own have to be.
fn is_near<S: Scalar>(frame: &Frame<S>, bounds: Aabb<S>) -> bool {
    let largest = |corner: [S; 3]| S::Vec3::from_array(frame.from_nets(corner)).largest();
    largest(bounds.low).greater(largest(bounds.high)) < S::from_f32(APART)
}

/// Whether all sides of a net's box, in the nets' coordinates, would lose digits in the frame, and are not 0.
fn is_lost<S: Scalar>(frame: &Frame<S>, bounds: Aabb<S>) -> bool {
    let longest = S::Vec3::from_array(bounds.sides()).largest();
    longest > S::ZERO && longest.times_power_of_two(frame.exponent()) < S::MIN_POSITIVE / S::EPSILON
}

/// The box of a net's control points, in the nets' coordinates; `origin` is the net's own.
fn control_box<P: Point>(net: &Net<'_, P>, origin: [P::Scalar; 3]) -> Aabb<P::Scalar> {
    let of_net = net.points().iter().fold(Aabb::EMPTY, |all, p| all.with(p.position()));
    of_net.relative(origin.map(|c| -c))
}

#[cfg(test)]
mod tests;
