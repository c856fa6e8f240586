//! What the suites share: models lowered to kernel surfaces, with memory of the size that counting asked for.
#![allow(dead_code, unreachable_pub)] // Each suite is a program of its own and uses a part.

pub mod allowances;

use patchray::grid::{GridError, GridMemory, GridOptions, GridSlot, Grids};
use patchray::limits::{Limit, Limits, Work};
use patchray::method::Scratch;
use patchray::newton::Solver;
use patchray::patch::Patches;
use patchray::patch::{Parallelepiped, Patch};
use patchray::planes::Planes;
use patchray::point::{Plain, Point, Weighted};
use patchray::root::Root;
use patchray::scalar::Scalar;
use patchray::scene::{Scene, SceneError, SceneHeader, SceneMemory, SceneOptions, SurfaceSlot};
use patchray::subdivide::{PatchMemory, SubdivideError, SubdivideScratch, Subdivision, TreeMemory, subdivide};
use patchray::surface::{Net, Surface};
use patchray::tree::Tree;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::shapes::Random;

/// One Newton solve with scratch of its own.
pub fn solve<P: Point>(
    surface: &Surface<'_, P>,
    planes: &Planes<P::Scalar>,
    start: [P::Scalar; 2],
    limits: &Limits<P::Scalar>,
    work: &mut Work,
) -> Result<Option<Root<P::Parameter>>, Limit> {
    let mut scratch = Scratch::<P, 16, 256>::new();
    let mut view = scratch.view();
    Solver::new(surface, planes, limits, view.flat, &mut view.basis).solve(start, work)
}

/// Points that a model's can be lowered to.
pub trait Kind: Point {
    /// The point `[x, y, z, w]` of a model, its position times `scale`.
    fn lower(point: &[f64; 4], scale: f64) -> Self;
}

impl<S: Scalar> Kind for Plain<S> {
    fn lower(&[x, y, z, _]: &[f64; 4], scale: f64) -> Self {
        Plain([x, y, z].map(|c| S::from_f64(c * scale)))
    }
}

impl<S: Scalar> Kind for Weighted<S> {
    fn lower(&[x, y, z, w]: &[f64; 4], scale: f64) -> Self {
        Weighted::new([x, y, z].map(|c| S::from_f64(c * scale)), S::from_f64(w))
    }
}

/// A surface's points as the kernel takes them.
pub fn lower<P: Kind>(surface: &ModelSurface, scale: f64) -> Vec<P> {
    surface.points.iter().map(|p| P::lower(p, scale)).collect()
}

/// Lowers a model and hands its nets to `with`.
pub fn with_nets<P: Kind, R>(model: &Model, scale: f64, with: impl FnOnce(&[Net<'_, P>]) -> R) -> R {
    let points: Vec<Vec<P>> = model.surfaces.iter().map(|s| lower(s, scale)).collect();
    let nets = model.surfaces.iter().zip(&points).map(|(s, p)| Net::new(s.degree_u, s.degree_v, p).unwrap());
    with(&nets.collect::<Vec<_>>())
}

/// A scene and the memory that it lies in: all that clipping alone needs.
pub struct Built<P: Point> {
    pub header: SceneHeader<P::Scalar>,
    pub points: Vec<P>,
    pub surfaces: Vec<SurfaceSlot<P::Scalar>>,
    pub offsets: Vec<u32>,
    pub references: Vec<u32>,
}

impl<P: Kind> Built<P> {
    pub fn new(model: &Model, scale: f64) -> Self {
        let (mut points, mut surfaces, mut offsets, mut references) = (vec![], vec![], vec![], vec![]);
        let header = with_nets(model, scale, |nets: &[Net<'_, P>]| {
            let scene_options = SceneOptions::default();
            let nothing = SceneMemory { points: &mut [], surfaces: &mut [], offsets: &mut [], references: &mut [] };
            let Err(SceneError::Memory(needs)) = Scene::build(nets, &scene_options, nothing) else {
                panic!("a scene needs memory")
            };
            points = vec![P::EMPTY; needs.points.needed];
            surfaces = vec![SurfaceSlot::EMPTY; needs.surfaces.needed];
            offsets = vec![0; needs.offsets.needed];
            references = vec![0; needs.references.needed];
            let memory = SceneMemory {
                points: &mut points,
                surfaces: &mut surfaces,
                offsets: &mut offsets,
                references: &mut references,
            };
            Scene::build(nets, &scene_options, memory).unwrap().header()
        });
        Built { header, points, surfaces, offsets, references }
    }

    pub fn scene(&self) -> Scene<'_, P> {
        Scene::new(self.header, &self.points, &self.surfaces, &self.offsets, &self.references)
    }
}

/// A scene with its patches, trees and grids, and the memory that they lie in.
pub struct Prepared<P: Point> {
    pub header: SceneHeader<P::Scalar>,
    pub points: Vec<P>,
    pub surfaces: Vec<SurfaceSlot<P::Scalar>>,
    pub offsets: Vec<u32>,
    pub references: Vec<u32>,
    pub patches: Vec<Patch<P::Scalar>>,
    pub first: Vec<u32>,
    pub nodes: Vec<Parallelepiped<P::Scalar>>,
    pub links: Vec<u32>,
    pub grids: Vec<GridSlot<P::Scalar>>,
    pub grid_offsets: Vec<u32>,
    pub grid_references: Vec<u32>,
}

/// Room to subdivide any surface.
pub fn subdivide_scratch<P: Point>() -> Box<SubdivideScratch<P, 256>> {
    Box::new(SubdivideScratch::new())
}

impl<P: Kind> Prepared<P> {
    /// The model at its own scale, with all defaults.
    pub fn of(model: &Model) -> Self {
        Self::new(model, 1.0, &Subdivision::default())
    }

    /// The model at its own scale in few patches, for suites that look at its surfaces.
    pub fn coarse(model: &Model) -> Self {
        Self::new(model, 1.0, &Subdivision { flatness: P::Scalar::from_f64(0.1), ..Default::default() })
    }

    pub fn new(model: &Model, scale: f64, options: &Subdivision<P::Scalar>) -> Self {
        Self::with_grid(model, scale, options, &GridOptions::default())
    }

    pub fn with_grid(
        model: &Model,
        scale: f64,
        options: &Subdivision<P::Scalar>,
        grid_options: &GridOptions<P::Scalar>,
    ) -> Self {
        let Built { header, points, surfaces, offsets, references } = Built::new(model, scale);
        let scene = Scene::new(header, &points, &surfaces, &offsets, &references);
        let mut scratch = subdivide_scratch();
        let mut view = scratch.view();
        let ask = subdivide(
            scene.surfaces(),
            scene.frame(),
            options,
            &mut view,
            PatchMemory { patches: &mut [], first: &mut [] },
            Some(TreeMemory { nodes: &mut [], links: &mut [] }),
        );
        let Err(SubdivideError::Memory(needs)) = ask else { panic!("{ask:?}") };
        let mut patches = vec![Patch::EMPTY; needs.patches.needed];
        let mut first = vec![0; needs.first.needed];
        let mut nodes = vec![Parallelepiped::EMPTY; needs.nodes.needed];
        let mut links = vec![0; needs.links.needed];
        let memory = PatchMemory { patches: &mut patches, first: &mut first };
        let tree = TreeMemory { nodes: &mut nodes, links: &mut links };
        subdivide(scene.surfaces(), scene.frame(), options, &mut view, memory, Some(tree)).unwrap();
        let filled = Patches::new(&patches, &first);
        let count = model.surfaces.len();
        let nothing = GridMemory { grids: &mut [], offsets: &mut [], references: &mut [] };
        let Err(GridError::Memory(needs)) = Grids::build(count, &filled, grid_options, nothing) else {
            panic!("grids need memory")
        };
        let mut grids = vec![GridSlot::EMPTY; needs.grids.needed];
        let mut grid_offsets = vec![0; needs.offsets.needed];
        let mut grid_references = vec![0; needs.references.needed];
        let memory = GridMemory { grids: &mut grids, offsets: &mut grid_offsets, references: &mut grid_references };
        Grids::build(count, &filled, grid_options, memory).unwrap();
        Prepared {
            header,
            points,
            surfaces,
            offsets,
            references,
            patches,
            first,
            nodes,
            links,
            grids,
            grid_offsets,
            grid_references,
        }
    }

    pub fn scene(&self) -> Scene<'_, P> {
        Scene::new(self.header, &self.points, &self.surfaces, &self.offsets, &self.references)
    }

    pub fn patches(&self) -> Patches<'_, P::Scalar> {
        Patches::new(&self.patches, &self.first)
    }

    pub fn tree(&self) -> Tree<'_, P::Scalar> {
        Tree::new(&self.nodes, &self.links)
    }

    pub fn grids(&self) -> Grids<'_, P::Scalar> {
        Grids::new(&self.grids, &self.grid_offsets, &self.grid_references)
    }
}

/// A whole number from 0 to `below` − 1.
pub fn index(random: &mut Random, below: usize) -> usize {
    (random.within(0.0, below as f64) as usize).min(below - 1)
}

/// A direction of random length within 10^±`decades`.
pub fn direction(random: &mut Random, decades: f64) -> [f64; 3] {
    loop {
        let d = random.point(1.0);
        let length = dot(d, d).sqrt();
        if (0.1..=1.0).contains(&length) {
            let by = 10.0_f64.powf(random.within(-decades, decades)) / length;
            return d.map(|c| c * by);
        }
    }
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn add(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}

pub fn norm(a: [f64; 3]) -> f64 {
    let largest = a.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    if largest == 0.0 { 0.0 } else { largest * dot(a.map(|c| c / largest), a.map(|c| c / largest)).sqrt() }
}

/// Surfaces that are hard in a known way, by name.
pub fn hard_surfaces() -> Vec<(&'static str, Model)> {
    use patchray_host::scene::shapes::{bumpy, elevate, parallelogram, single, sphere, torus};
    use patchray_host::scene::teapot;
    let mut all = vec![("teapot", teapot::model().unwrap())];
    for (seed, degrees) in
        [(1, [1, 1]), (2, [2, 2]), (3, [3, 3]), (4, [5, 5]), (5, [2, 12]), (6, [15, 15]), (7, [15, 1])]
    {
        all.push(("bumpy", single(bumpy(seed, degrees, [0.3, -0.2, 0.1], 2.0, 0.3))));
    }
    // Eight extents away from 0: what is left of the digits is the surface's own.
    all.push(("far from 0", single(bumpy(8, [3, 3], [8.0, -6.0, 5.0], 1.0, 0.2))));
    all.push(("flat", single(elevate(&parallelogram([0.1, 0.2, 0.3], [1.0, 0.5, 0.0], [-0.25, 1.0, 0.5]), 3, 3))));
    all.push(("flat along the axes", single(parallelogram([-1.0, -1.0, 0.5], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]))));
    let tilted = |p: [f64; 3]| [0.6 * p[0] - 0.8 * p[1], 0.8 * p[0] + 0.6 * p[1], p[2] + 0.3 * p[0]];
    let squeezed = |surface: ModelSurface, by: f64| {
        let points = surface.points.iter().map(|&[x, y, z, w]| {
            let [x, y, z] = tilted([x, y * by, z]);
            [x, y, z, w]
        });
        ModelSurface { points: points.collect(), ..surface.clone() }
    };
    all.push(("sliver of aspect 1e9", single(squeezed(bumpy(9, [3, 3], [0.0; 3], 1.0, 0.2), 1e-9))));
    all.push(("sliver of aspect 1e4", single(squeezed(bumpy(10, [2, 2], [0.0; 3], 1.0, 0.2), 1e-4))));
    let flat = parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    all.push(("flat sliver of aspect 1e9", single(squeezed(flat, 1e-9))));
    for (seed, row) in [(11, true), (12, false)] {
        let mut collapsed = bumpy(seed, [3, 3], [0.0; 3], 1.5, 0.4);
        for k in 0..4 {
            let at = if row { k } else { 4 * k + 3 };
            collapsed.points[at] = [0.7, -0.4, 0.2, 1.0];
        }
        all.push(("collapsed edge", single(collapsed)));
    }
    all.push(("sphere", sphere([0.5, -0.25, 1.0], 1.5)));
    all.push(("torus", torus([0.0; 3], 1.0, 0.25, 4, 4)));
    let mut random = Random(13);
    for degrees in [[3, 3], [2, 5]] {
        let mut weighted = bumpy(14, degrees, [0.0; 3], 2.0, 0.5);
        weighted.rational = true;
        for point in &mut weighted.points {
            point[3] = 10.0_f64.powf(random.within(-2.0, 2.0));
        }
        all.push(("weights", single(weighted)));
    }
    all
}

/// Whether a model needs weighted points.
pub fn is_rational(model: &Model) -> bool {
    model.surfaces.iter().any(|s| s.rational)
}
