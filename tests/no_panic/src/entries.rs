//! The entry points that compute: written once, exported for both number types and both kinds of control points.

use crate::Lent;
use core::hint::black_box;
use heapless::Vec;
use patchray::arena::Arena;
use patchray::bernstein::{Basis, Jet, MAX_DEGREE};
use patchray::bspline::{BSpline, BSplineError};
use patchray::clipper::Clipper;
use patchray::domain::Domain;
use patchray::frame::{Aabb, Frame, exact_origin};
use patchray::grid::{Grid, GridError, GridMemory, GridOptions, GridSlot, Grids};
use patchray::limits::{Extent, GaveUp, Limit, Limits, Work};
use patchray::measure::Measure;
use patchray::method::Remembered;
use patchray::method::{ClipScratch, Scratch, clipping, clipping_coherent, newton, newton_coherent};
use patchray::newton::Solver;
use patchray::parameter::Parameter;
use patchray::patch::Patches;
use patchray::patch::{Crossing, Parallelepiped, Patch, Pierce};
use patchray::pieces::{InKnots, Part, Piece, PieceError, PieceMemory, Pieces};
use patchray::planes::{DepthRange, Planes, Projected, project_net};
use patchray::point::Point;
use patchray::ray::{Hit, Interval, Ray, RayError};
use patchray::reading::Ours;
use patchray::region::{Order, Region};
use patchray::root::Root;
use patchray::scalar::{Scalar, Vector3};
use patchray::scene::{Scene, SceneError, SceneHeader, SceneMemory, SceneOptions, SurfaceSlot};
use patchray::subdivide::{
    PatchMemory, SubdivideError, SubdivideScratch, Subdivided, Subdivision, TreeMemory, subdivide,
};
use patchray::surface::{Direction, Net, NetError, Surface};
use patchray::sweep::InGrid;
use patchray::tree::{Descent, Tree};
use patchray::verify::{Verdict, testing_ray, verdict};
use patchray::walk::{Voxel, Walk};

/// Capacities for the highest degree: the owner's choice, and the largest that makes sense.
pub(crate) const ORDER: usize = MAX_DEGREE + 1;
pub(crate) const POINTS: usize = ORDER * ORDER;
pub(crate) const PENDING: usize = 64;
const HITS: usize = 32;

pub(crate) type Found<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// A scene's memory, filled by the kernel or by anything else.
#[derive(Debug)]
#[repr(C)]
pub struct LentScene<P: Point> {
    header: SceneHeader<P::Scalar>,
    points: Lent<P>,
    surfaces: Lent<SurfaceSlot<P::Scalar>>,
    offsets: Lent<u32>,
    references: Lent<u32>,
}

impl<P: Point> LentScene<P> {
    /// # Safety
    /// See [`Lent::slots`].
    pub(crate) unsafe fn view<'m>(&self) -> Scene<'m, P> {
        // SAFETY: the caller keeps the contract of `slots`.
        let (points, surfaces) = unsafe { (self.points.slots(), self.surfaces.slots()) };
        // SAFETY: likewise.
        let (offsets, references) = unsafe { (self.offsets.slots(), self.references.slots()) };
        Scene::new(self.header, points, surfaces, offsets, references)
    }

    /// # Safety
    /// See [`Lent::slots`].
    unsafe fn memory<'m>(&self) -> SceneMemory<'m, P> {
        // SAFETY: the caller keeps the contract of `slots`.
        let (points, surfaces) = unsafe { (self.points.slots(), self.surfaces.slots()) };
        // SAFETY: likewise.
        let (offsets, references) = unsafe { (self.offsets.slots(), self.references.slots()) };
        SceneMemory { points, surfaces, offsets, references }
    }
}

/// Memory of patches and trees.
#[derive(Debug)]
#[repr(C)]
pub struct LentPatches<S> {
    patches: Lent<Patch<S>>,
    first: Lent<u32>,
    nodes: Lent<Parallelepiped<S>>,
    links: Lent<u32>,
}

impl<S: Scalar> LentPatches<S> {
    /// # Safety
    /// See [`Lent::slots`].
    pub(crate) unsafe fn patches<'m>(&self) -> Patches<'m, S> {
        // SAFETY: the caller keeps the contract of `slots`.
        unsafe { Patches::new(self.patches.slots(), self.first.slots()) }
    }

    /// # Safety
    /// See [`Lent::slots`].
    pub(crate) unsafe fn tree<'m>(&self) -> Tree<'m, S> {
        // SAFETY: the caller keeps the contract of `slots`.
        unsafe { Tree::new(self.nodes.slots(), self.links.slots()) }
    }
}

/// Memory of the grids over patches.
#[derive(Debug)]
#[repr(C)]
pub struct LentGrids<S> {
    grids: Lent<GridSlot<S>>,
    offsets: Lent<u32>,
    references: Lent<u32>,
}

impl<S: Scalar> LentGrids<S> {
    /// # Safety
    /// See [`Lent::slots`].
    pub(crate) unsafe fn view<'m>(&self) -> Grids<'m, S> {
        // SAFETY: the caller keeps the contract of `slots`.
        unsafe { Grids::new(self.grids.slots(), self.offsets.slots(), self.references.slots()) }
    }
}

/// What a ray is made of and bounded by.
#[derive(Debug)]
#[repr(C)]
pub struct Asked<S> {
    origin: [S; 3],
    direction: [S; 3],
    interval: [S; 2],
}

impl<S: Scalar> Asked<S> {
    pub(crate) fn ray<P: Point<Scalar = S>>(&self, scene: &Scene<'_, P>) -> Result<(Ray<S>, Interval<S>), RayError> {
        let [min, max] = self.interval;
        let interval = Interval::new(min, max).unwrap_or(Interval::ahead());
        Ok((scene.ray(self.origin, self.direction)?, interval))
    }
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn net<P: Point>(
    n: usize,
    m: usize,
    points: &Lent<P>,
    out: &mut [Result<Net<'static, P>, NetError>; 2],
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let points = unsafe { points.slots() };
    *out = [Net::new(n, m, points), Net::checked(n, m, points)];
}

/// What is asked of one net.
#[derive(Debug)]
pub struct OfNet<P: Point> {
    jet: Option<Jet<P>>,
    position: Option<[P::Scalar; 3]>,
    normal: Option<Option<[P::Scalar; 3]>>,
    bend: [P::Scalar; 3],
    corners: [P; 4],
    rows: usize,
    shape: (usize, usize, usize),
    measure: Measure<P::Scalar>,
    fitted: [bool; 3],
}

extern "C" fn evaluate<P: Point>(
    net: &Net<'static, P>,
    &[u, v]: &[P::Scalar; 2],
    basis: &mut Basis<P::Scalar, ORDER>,
    small: &mut Basis<P::Scalar, 2>,
    out: &mut OfNet<P>,
) {
    out.jet = net.jet(u, v, &mut basis.view()).or(net.jet(u, v, &mut small.view())).ok();
    out.position = net.position(u, v, &mut basis.view()).ok();
    out.normal = net.normal(u, v, &mut basis.view()).ok();
    out.bend = net.bend(u);
    out.corners = net.corners();
    out.rows = net.rows().map(<[P]>::len).sum();
    out.shape = (net.degree_u(), net.degree_v(), net.points().len());
}

extern "C" fn cut<P: Point>(
    net: &Net<'static, P>,
    &[u, v]: &[[P::Scalar; 2]; 2],
    low: &mut Vec<P, POINTS>,
    high: &mut Vec<P, 9>,
    padding: P::Scalar,
    out: &mut OfNet<P>,
) {
    out.fitted[0] = net.restrict(u, v, low).is_ok();
    out.fitted[1] = net.halve(Direction::U, low, high).is_ok();
    out.fitted[2] = net.halve(Direction::V, high, low).is_ok();
    out.measure = Measure::of(net, padding);
}

extern "C" fn project<P: Point>(
    net: &Net<'static, P>,
    planes: &Planes<P::Scalar>,
    out: &mut Vec<P::Flat, POINTS>,
) -> bool {
    project_net(net, planes, out).is_ok()
}

/// Memory of B-splines' pieces.
#[derive(Debug)]
#[repr(C)]
pub struct LentPieces<P: Point> {
    points: Lent<P>,
    pieces: Lent<Piece<P::Scalar>>,
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn spline<P: Point>(
    degrees: &[usize; 2],
    knots: &[Lent<P::Scalar>; 2],
    points: &Lent<P>,
    out: &mut Result<BSpline<'static, P>, BSplineError>,
) {
    let ([n, m], [u, v]) = (*degrees, knots);
    // SAFETY: the caller keeps the contract of `slots`.
    *out = unsafe { BSpline::new(n, m, u.slots(), v.slots(), points.slots()) };
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn pieces<P: Point>(
    splines: &Lent<BSpline<'static, P>>,
    memory: &LentPieces<P>,
    out: &mut Result<Pieces<'static, P>, PieceError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (splines, points, pieces) = unsafe { (splines.slots(), memory.points.slots(), memory.pieces.slots()) };
    *out = Pieces::build(splines, PieceMemory { points, pieces });
}

/// What is asked of one B-spline, and of pieces.
#[derive(Debug)]
pub struct OfPieces<P: Point> {
    numbers: [(usize, usize, usize, usize); 2],
    domains: [[P::Scalar; 2]; 2],
    counts: (usize, usize, usize, bool, u32),
    net: Option<Net<'static, P>>,
    nets: Option<[Net<'static, P>; 3]>,
    part: Option<Part<P::Scalar>>,
    at: (Option<InKnots<P::Scalar>>, [P::Scalar; 2]),
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn of_pieces<P: Point>(
    spline: &BSpline<'static, P>,
    memory: &LentPieces<P>,
    number: usize,
    hit: &Hit<P::Scalar>,
    part: &Part<P::Scalar>,
    out: &mut OfPieces<P>,
) {
    let both = [Direction::U, Direction::V];
    out.numbers = both.map(|k| (spline.degree(k), spline.size(k), spline.spans(k), spline.knots(k).len()));
    out.domains = both.map(|k| spline.domain(k));
    // SAFETY: the caller keeps the contract of `slots`.
    let pieces = unsafe { Pieces::new(memory.points.slots(), memory.pieces.slots()) };
    let of_all = pieces.all().iter().fold(0, |sum: u32, piece| sum ^ piece.spline());
    out.counts = (pieces.len(), spline.points().len(), pieces.nets().count(), pieces.is_empty(), of_all);
    (out.net, out.nets) = (pieces.net(number), pieces.nets_array());
    out.part = pieces.all().get(number).map(Piece::part);
    out.at = (pieces.in_knots(hit), part.in_knots(hit.u, hit.v));
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn build<P: Point>(
    nets: &Lent<Net<'static, P>>,
    options: &SceneOptions<P::Scalar>,
    memory: &LentScene<P>,
    out: &mut Result<Scene<'static, P>, SceneError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    *out = unsafe { Scene::build(nets.slots(), options, memory.memory()) };
}

/// What is asked of one scene.
#[derive(Debug)]
pub struct OfScene<P: Point> {
    header: SceneHeader<P::Scalar>,
    surface: Option<Surface<'static, P>>,
    normal: Result<Option<[P::Scalar; 3]>, GaveUp<P::Scalar>>,
    ray: Result<Ray<P::Scalar>, RayError>,
    points: usize,
    numbers: (usize, bool, u32),
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn look<P: Point>(
    scene: &LentScene<P>,
    number: usize,
    hit: &Hit<P::Scalar>,
    asked: &Asked<P::Scalar>,
    basis: &mut Basis<P::Scalar, ORDER>,
    out: &mut OfScene<P>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let scene = unsafe { scene.view() };
    out.header = scene.header();
    out.surface = scene.surface(number);
    out.normal = scene.normal(hit, &mut basis.view());
    out.ray = scene.ray(asked.origin, asked.direction);
    out.points = scene.surfaces().map(|surface| surface.net.points().len()).sum();
    out.numbers = (scene.len(), scene.is_empty(), scene.longest_walk());
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn patches<P: Point>(
    scene: &LentScene<P>,
    options: &Subdivision<P::Scalar>,
    scratch: &mut SubdivideScratch<P, POINTS>,
    memory: &LentPatches<P::Scalar>,
    out: &mut Result<Subdivided<'static, P::Scalar>, SubdivideError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, patches, first) = unsafe { (scene.view(), memory.patches.slots(), memory.first.slots()) };
    let memory = PatchMemory { patches, first };
    *out = subdivide(scene.surfaces(), scene.frame(), options, &mut scratch.view(), memory, None);
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn tree<P: Point>(
    surfaces: &Lent<Surface<'static, P>>,
    frame: &Frame<P::Scalar>,
    options: &Subdivision<P::Scalar>,
    scratch: &mut SubdivideScratch<P, 16>,
    memory: &LentPatches<P::Scalar>,
    out: &mut Result<Subdivided<'static, P::Scalar>, SubdivideError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (surfaces, patches, first) = unsafe { (surfaces.slots(), memory.patches.slots(), memory.first.slots()) };
    // SAFETY: likewise.
    let (nodes, links) = unsafe { (memory.nodes.slots(), memory.links.slots()) };
    let (memory, tree) = (PatchMemory { patches, first }, TreeMemory { nodes, links });
    *out = subdivide(surfaces.iter().copied(), frame, options, &mut scratch.view(), memory, Some(tree));
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn grids<P: Point>(
    surfaces: usize,
    patches: &LentPatches<P::Scalar>,
    options: &GridOptions<P::Scalar>,
    memory: &LentGrids<P::Scalar>,
    out: &mut Result<Grids<'static, P::Scalar>, GridError>,
    walks: &mut u32,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (patches, filled) = unsafe { (patches.patches(), memory.view()) };
    *walks = filled.longest_walks();
    // SAFETY: likewise.
    let (grids, offsets, references) =
        unsafe { (memory.grids.slots(), memory.offsets.slots(), memory.references.slots()) };
    *out = Grids::build(surfaces, &patches, options, GridMemory { grids, offsets, references });
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn trace_newton<P: Point>(
    scene: &LentScene<P>,
    patches: &LentPatches<P::Scalar>,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut Scratch<P, ORDER, POINTS>,
    work: &mut Work,
    out: &mut Result<Found<P::Scalar>, RayError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, tree, patches) = unsafe { (scene.view(), patches.tree(), patches.patches()) };
    *out = asked.ray(&scene).map(|(ray, interval)| {
        newton::closest(&scene, &patches, &tree, &ray, &interval, limits, &mut scratch.view(), work)
    });
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn trace_coherent<P: Point>(
    scene: &LentScene<P>,
    patches: &LentPatches<P::Scalar>,
    grids: &LentGrids<P::Scalar>,
    memory: &Lent<Remembered<P::Scalar>>,
    scan_line: u32,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut Scratch<P, ORDER, POINTS>,
    work: &mut Work,
    out: &mut Result<Found<P::Scalar>, RayError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, patches, grids, memory) = unsafe { (scene.view(), patches.patches(), grids.view(), memory.slots()) };
    *out = asked.ray(&scene).map(|(ray, interval)| {
        let (scratch, limits) = (&mut scratch.view(), limits);
        newton_coherent::closest(&scene, &patches, &grids, memory, scan_line, &ray, &interval, limits, scratch, work)
    });
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn trace_clipping<P: Point>(
    scene: &LentScene<P>,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ClipScratch<P, ORDER, POINTS, PENDING>,
    work: &mut Work,
    out: &mut Result<Found<P::Scalar>, RayError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let scene = unsafe { scene.view() };
    *out = asked
        .ray(&scene)
        .map(|(ray, interval)| clipping::closest(&scene, &ray, &interval, limits, &mut scratch.view(), work));
}

/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn trace_clipping_coherent<P: Point>(
    scene: &LentScene<P>,
    patches: &LentPatches<P::Scalar>,
    grids: &LentGrids<P::Scalar>,
    memory: &Lent<Remembered<P::Scalar>>,
    scan_line: u32,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ClipScratch<P, ORDER, POINTS, PENDING>,
    work: &mut Work,
    out: &mut Result<Found<P::Scalar>, RayError>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, patches, grids, memory) = unsafe { (scene.view(), patches.patches(), grids.view(), memory.slots()) };
    *out = asked.ray(&scene).map(|(ray, interval)| {
        let room = &mut scratch.view();
        clipping_coherent::closest(&scene, &patches, &grids, memory, scan_line, &ray, &interval, limits, room, work)
    });
}

type Listed<S> = Result<(Result<(), GaveUp<S>>, Found<S>), RayError>;

/// All hits, and any hit, by Newton's method.
///
/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn hits_newton<P: Point>(
    scene: &LentScene<P>,
    patches: &LentPatches<P::Scalar>,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut Scratch<P, ORDER, POINTS>,
    hits: &mut Vec<Hit<P::Scalar>, HITS>,
    work: &mut Work,
    out: &mut Listed<P::Scalar>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (scene, tree, patches) = unsafe { (scene.view(), patches.tree(), patches.patches()) };
    *out = asked.ray(&scene).map(|(ray, interval)| {
        let view = &mut scratch.view();
        let any = newton::any_hit(&scene, &patches, &tree, &ray, &interval, limits, view, work);
        (newton::all_hits(&scene, &patches, &tree, &ray, &interval, limits, view, hits, work), any)
    });
}

/// All hits, and any hit, by clipping.
///
/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn hits_clipping<P: Point>(
    scene: &LentScene<P>,
    asked: &Asked<P::Scalar>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ClipScratch<P, ORDER, POINTS, PENDING>,
    hits: &mut Vec<Hit<P::Scalar>, HITS>,
    work: &mut Work,
    out: &mut Listed<P::Scalar>,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let scene = unsafe { scene.view() };
    *out = asked.ray(&scene).map(|(ray, interval)| {
        let room = &mut scratch.view();
        let any = clipping::any_hit(&scene, &ray, &interval, limits, room, work);
        (clipping::all_hits(&scene, &ray, &interval, limits, room, hits, work), any)
    });
}

/// Clipping alone, on whatever calls itself a surface, in room too small for most, and in any order.
extern "C" fn clip_roots<P: Point>(
    surface: &Surface<'static, P>,
    planes: &Planes<P::Scalar>,
    order: &Order<P::Parameter>,
    limits: &Limits<P::Scalar>,
    scratch: &mut ClipScratch<P, 3, 9, 2>,
    work: &mut Work,
    roots: &mut Vec<Root<P::Parameter>, HITS>,
    out: &mut Result<(), Limit>,
) {
    let room = &mut scratch.view();
    let mut clipper = Clipper { surface, planes, limits, room };
    *out = clipper.roots(*order).and_then(|mut search| {
        while let Some(root) = search.next(work)? {
            if roots.push(root).is_err() || !search.regions_wait() {
                break;
            }
        }
        Ok(())
    });
}

/// What is asked of one region, and of those that wait.
#[derive(Debug)]
pub struct OfRegion<A: Parameter> {
    widths: [A::Scalar; 2],
    points: [[A; 2]; 2],
    halves: [Option<[Region<A>; 2]>; 2],
    narrowed: Region<A>,
    common: Option<Region<A>>,
    says: [bool; 3],
    pushed: Result<(), Limit>,
    popped: Option<Region<A>>,
    order: Order<A>,
}

extern "C" fn region<P: Point>(
    region: &Region<P::Parameter>,
    other: &Region<P::Parameter>,
    domains: &[Domain; 2],
    order: &mut Order<P::Parameter>,
    pending: &mut Vec<Region<P::Parameter>, PENDING>,
    most: u32,
    &numbers: &[P::Scalar; 2],
    out: &mut OfRegion<P::Parameter>,
) {
    let point = numbers.map(P::Parameter::new);
    out.widths = region.widths();
    out.points = [region.middle(), region.nearest(point)];
    out.halves = [region.halves(Direction::U), region.halves(Direction::V)];
    out.narrowed = *region;
    out.narrowed.narrow(region.next, numbers);
    out.common = region.meet(other.sides);
    out.says = [region.holds(point), region.adjoins(other), domains[0].adjoins(domains[1])];
    out.pushed = order.push(*region, pending, most);
    out.popped = order.pop(pending);
    out.order = Order::around(Some(point));
}

/// The solve alone, on whatever calls itself a surface.
extern "C" fn newton_solve<P: Point>(
    surface: &Surface<'static, P>,
    planes: &Planes<P::Scalar>,
    start: &[P::Scalar; 2],
    limits: &Limits<P::Scalar>,
    work: &mut Work,
    scratch: &mut Scratch<P, ORDER, POINTS>,
    out: &mut Result<Option<Root<P::Parameter>>, Limit>,
) {
    let mut scratch = scratch.view();
    *out = Solver::new(surface, planes, limits, scratch.flat, &mut scratch.basis).solve(*start, work);
}

/// What the frame, a box and a ray's planes give.
#[derive(Debug)]
pub struct OfFrame<S> {
    frame: Frame<S>,
    exponent: i32,
    point: [S; 3],
    lengths: [S; 4],
    ray: Result<Ray<S>, RayError>,
    entered: Option<(Planes<S>, DepthRange<S>)>,
    grown: [Aabb<S>; 3],
    at: [[S; 3]; 6],
    projected: [Projected<S>; 2],
    ts: (S, Option<S>),
    interval: Option<Interval<S>>,
    vector: [[S; 3]; 2],
    origin_of_nets: [S; 3],
    empty: bool,
}

extern "C" fn frame<P: Point>(
    bounds: &Aabb<P::Scalar>,
    frame: &Frame<P::Scalar>,
    ray: &Ray<P::Scalar>,
    planes: &Planes<P::Scalar>,
    interval: &Interval<P::Scalar>,
    asked: &Asked<P::Scalar>,
    out: &mut OfFrame<P::Scalar>,
) {
    let (point, t) = (&asked.origin, asked.interval[0]);
    out.frame = Frame::new(*bounds).with_origin(exact_origin(bounds));
    out.exponent = frame.exponent();
    out.origin_of_nets = frame.origin();
    out.point = frame.from_nets(*point);
    let vector = <P::Scalar as Scalar>::Vec3::from_array(*point);
    out.lengths = [frame.diagonal(), bounds.diagonal(), Frame::<P::Scalar>::padding(), vector.length()];
    out.vector = [vector.unit().to_array(), bounds.sides()];
    out.ray = frame.ray(asked.origin, asked.direction);
    out.entered = frame.enter(ray, interval);
    out.grown = [bounds.with(*point), bounds.union(*bounds), bounds.padded(t)];
    out.empty = bounds.is_empty();
    out.at = [ray.at(t), ray.origin(), ray.direction(), planes.origin(), planes.direction(), planes.inverse()];
    out.projected = [planes.vector(point), planes.point(point)];
    out.ts = (planes.t(t), planes.t_in_interval(interval.min()));
    out.interval = Interval::new(t, interval.max());
}

/// What a patch gives for a ray.
#[derive(Debug)]
pub struct OfPatch<S> {
    crossing: Option<Crossing<S>>,
    bounds: Aabb<S>,
    pierces: Option<[Pierce<S>; 2]>,
    starts: [Option<[S; 2]>; 2],
    says: [bool; 6],
    domain: ([[S; 2]; 2], [u32; 2]),
    filled: Patch<S>,
}

extern "C" fn patch<P: Point>(
    patch: &Patch<P::Scalar>,
    crossing: &Crossing<P::Scalar>,
    measure: &Measure<P::Scalar>,
    planes: &Planes<P::Scalar>,
    range: &DepthRange<P::Scalar>,
    &[u, v]: &[P::Scalar; 2],
    out: &mut OfPatch<P::Scalar>,
) {
    out.crossing = patch.bounds().crossing(planes);
    out.bounds = patch.bounds().aabb();
    out.pierces = crossing.pierces();
    out.starts = [patch.parallelogram(crossing), out.pierces.map(|[first, _]| patch.at(&first))];
    let domain = patch.domain();
    out.says = [
        crossing.overlaps(range),
        patch.is_critical(crossing, u),
        patch.at_most_once(crossing),
        patch.bounds().met(planes),
        domain.holds(u, v),
        domain.is_rough(),
    ];
    out.domain = (domain.bounds(), domain.levels());
    out.filled = measure.patch(domain);
}

/// A grid over boxes of any numbers, and a walk in any state.
///
/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn walk<P: Point>(
    boxes: &Lent<Aabb<P::Scalar>>,
    items: usize,
    density: P::Scalar,
    most: u32,
    memory: &LentGrids<P::Scalar>,
    slot: &'static GridSlot<P::Scalar>,
    planes: &Planes<P::Scalar>,
    range: &DepthRange<P::Scalar>,
    walk: &mut Walk<'static, P::Scalar>,
    sum: &mut usize,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (boxes, offsets, references) = unsafe { (boxes.slots(), memory.offsets.slots(), memory.references.slots()) };
    let fresh = |mut voxel: Voxel<'static, P::Scalar>| {
        core::iter::from_fn(move || voxel.next_fresh()).fold(0, usize::wrapping_add)
    };
    if let Some(Ok(voxel)) = walk.advance() {
        *sum ^= fresh(voxel);
    }
    {
        let (mut offsets, mut references) = (Arena::new(offsets), Arena::new(references));
        let boxes = |k: usize| boxes.get(k).copied().unwrap_or(Aabb::EMPTY);
        black_box(&GridSlot::build(items, boxes, density, most, &mut offsets, &mut references).is_ok());
    }
    // SAFETY: as above; the slices before are no longer used.
    let (offsets, references) = unsafe { (memory.offsets.slots(), memory.references.slots()) };
    let Some(grid) = Grid::new(slot, offsets, references) else {
        return;
    };
    if let Some((mut walk, _)) = grid.enter(planes, range) {
        while let Some(Ok(voxel)) = walk.advance() {
            *sum ^= fresh(voxel);
        }
    }
}

/// A descent in any state, and one from a tree in any memory.
///
/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn descend<P: Point>(
    lent: &LentPatches<P::Scalar>,
    surface: usize,
    descent: &mut Descent<'static, P::Scalar>,
    planes: &Planes<P::Scalar>,
    limits: &Limits<P::Scalar>,
    work: &mut Work,
    found: &mut usize,
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (patches, tree) = unsafe { (lent.patches(), lent.tree()) };
    *found = patches.all().len() ^ tree.nodes().len() ^ tree.links().len();
    *found ^= patches.of_surface(surface).map_or(0, <[_]>::len);
    *found ^= usize::from(matches!(descent.next_patch(planes, limits, work), Ok(Some(_))));
    if let Some(mut descent) = tree.of_surface(&patches, surface) {
        while let Ok(Some(_)) = descent.next_patch(planes, limits, work) {
            *found = found.wrapping_add(1);
        }
    }
}

/// The testing ray alone, and its verdict.
///
/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn verify<P: Point>(
    grids: &LentGrids<P::Scalar>,
    surface: usize,
    patches: &Lent<Patch<P::Scalar>>,
    planes: &Planes<P::Scalar>,
    root: &Root<P::Parameter>,
    nearest: P::Scalar,
    limits: &Limits<P::Scalar>,
    work: &mut Work,
    owners: &mut u32,
    out: &mut (Result<(), Limit>, Result<Verdict, Limit>),
) {
    // SAFETY: the caller keeps the contract of `slots`.
    let (grids, patches) = unsafe { (grids.view(), patches.slots()) };
    let Some(grid) = grids.of_surface(surface) else {
        return;
    };
    let along = InGrid { grid, patches };
    out.0 = testing_ray(&along, planes, root, nearest, limits, work, |listed, _| {
        *owners = owners.wrapping_add(u32::from(listed.owner));
        Ok(*owners < limits.patches)
    });
    out.1 = verdict(Ours, &along, planes, root, nearest, limits, work);
}

/// An arena asked for anything.
///
/// # Safety
/// See [`Lent::slots`].
unsafe extern "C" fn arena<P: Point>(slots: &Lent<P>, count: usize, at: usize, value: &P, sum: &mut usize) {
    // SAFETY: the caller keeps the contract of `slots`.
    let mut arena = Arena::new(unsafe { slots.slots() });
    arena.extend(count, *value);
    arena.push(*value);
    arena.extend(at, *value);
    arena.push(*value);
    arena.set(at, *value);
    *sum = arena.since(at).map_or(0, |since| since.len());
    let need = arena.need();
    *sum ^= arena.len() ^ need.needed ^ need.given ^ usize::from(need.met()) ^ usize::from(arena.is_empty());
    *sum ^= arena.finish().len();
}

extern "C" fn worst_case<P: Point>(limits: &Limits<P::Scalar>, extent: &Extent, out: &mut (Work, [u32; Work::COUNT])) {
    let work = limits.worst_case(extent);
    *out = (work, work.counts());
}

export! {
    net evaluate cut project build look patches tree grids trace_newton trace_coherent newton_solve frame patch walk descend
    verify arena worst_case spline pieces of_pieces trace_clipping trace_clipping_coherent hits_newton hits_clipping
    clip_roots region
}
