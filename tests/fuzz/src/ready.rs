//! Preparation that may be refused: asked for its needs, given just that, and then it has to succeed.

use crate::common::{Kind, Prepared, lower, subdivide_scratch};
use patchray::arena::Need;
use patchray::frame::{Aabb, exact_origin};
use patchray::grid::{GridError, GridMemory, GridOptions, GridSlot, Grids};
use patchray::patch::{Parallelepiped, Patch, Patches};
use patchray::point::Point;
use patchray::scalar::Scalar;
use patchray::scene::{Scene, SceneError, SceneHeader, SceneMemory, SceneOptions, SurfaceSlot};
use patchray::subdivide::{PatchMemory, SubdivideError, Subdivision, TreeMemory, subdivide};
use patchray::surface::Net;
use patchray_host::scene::model::{Model, ModelSurface};

/// What preparing with some memory came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Stage<const N: usize> {
    /// It is done.
    Done,
    /// There was too little memory.
    Lacks([Need; N]),
    /// The input is refused.
    Refused,
}

/// More slots of one kind than any input here may need.
const MOST: usize = 1 << 20;

/// Asks a preparation for its needs, and gives it just that. `None` if the input is refused.
pub(crate) fn ask_and_fill<const N: usize>(mut build: impl FnMut([usize; N]) -> Stage<N>) -> Option<[usize; N]> {
    let needed = match build([0; N]) {
        Stage::Done => [0; N],
        Stage::Refused => return None,
        Stage::Lacks(needs) => {
            assert!(needs.iter().all(|need| need.given == 0) && needs.iter().any(|need| need.needed > 0));
            needs.map(|need| need.needed)
        }
    };
    assert!(needed.iter().all(|&count| count <= MOST), "{needed:?} slots");
    assert_eq!(build(needed), Stage::Done, "what was asked for, {needed:?}, does not suffice");
    Some(needed)
}

/// Memory for a scene.
#[derive(Default)]
pub(crate) struct SceneRoom<P: Point> {
    pub(crate) points: Vec<P>,
    pub(crate) surfaces: Vec<SurfaceSlot<P::Scalar>>,
    pub(crate) offsets: Vec<u32>,
    pub(crate) references: Vec<u32>,
    pub(crate) header: Option<SceneHeader<P::Scalar>>,
}

impl<P: Point> SceneRoom<P> {
    /// Builds a scene in memory of these sizes.
    pub(crate) fn build(
        &mut self,
        nets: &[Net<'_, P>],
        origins: &[[P::Scalar; 3]],
        options: &SceneOptions<P::Scalar>,
        [points, surfaces, offsets, references]: [usize; 4],
    ) -> Stage<4> {
        self.points = vec![P::EMPTY; points];
        self.surfaces = vec![SurfaceSlot::EMPTY; surfaces];
        (self.offsets, self.references) = (vec![7; offsets], vec![7; references]);
        let memory = SceneMemory {
            points: &mut self.points,
            surfaces: &mut self.surfaces,
            offsets: &mut self.offsets,
            references: &mut self.references,
        };
        match Scene::build_apart(nets, origins, options, memory) {
            Ok(scene) => {
                self.header = Some(scene.header());
                Stage::Done
            }
            Err(SceneError::Memory(n)) => Stage::Lacks([n.points, n.surfaces, n.offsets, n.references]),
            Err(_) => Stage::Refused,
        }
    }

    /// The scene; `None` if it was not built.
    pub(crate) fn scene(&self) -> Option<Scene<'_, P>> {
        let SceneRoom { points, surfaces, offsets, references, header } = self;
        header.map(|header| Scene::new(header, points, surfaces, offsets, references))
    }
}

/// Memory for patches and trees.
#[derive(Default)]
pub(crate) struct PatchRoom<S> {
    pub(crate) patches: Vec<Patch<S>>,
    pub(crate) first: Vec<u32>,
    pub(crate) nodes: Vec<Parallelepiped<S>>,
    pub(crate) links: Vec<u32>,
}

impl<S: Scalar> PatchRoom<S> {
    /// Subdivides a scene in memory of these sizes.
    pub(crate) fn build<P: Point<Scalar = S>>(
        &mut self,
        scene: &Scene<'_, P>,
        options: &Subdivision<S>,
        with_tree: bool,
        [patches, first, nodes, links]: [usize; 4],
    ) -> Stage<4> {
        (self.patches, self.first) = (vec![Patch::EMPTY; patches], vec![7; first]);
        (self.nodes, self.links) = (vec![Parallelepiped::EMPTY; nodes], vec![7; links]);
        let memory = PatchMemory { patches: &mut self.patches, first: &mut self.first };
        let tree = with_tree.then_some(TreeMemory { nodes: &mut self.nodes, links: &mut self.links });
        let mut scratch = subdivide_scratch();
        match subdivide(scene.surfaces(), scene.frame(), options, &mut scratch.view(), memory, tree) {
            Ok(_) => Stage::Done,
            Err(SubdivideError::Memory(n)) => Stage::Lacks([n.patches, n.first, n.nodes, n.links]),
            Err(_) => Stage::Refused,
        }
    }

    pub(crate) fn patches(&self) -> Patches<'_, S> {
        Patches::new(&self.patches, &self.first)
    }
}

/// Memory for the grids over patches.
#[derive(Default)]
pub(crate) struct GridRoom<S> {
    pub(crate) grids: Vec<GridSlot<S>>,
    pub(crate) offsets: Vec<u32>,
    pub(crate) references: Vec<u32>,
}

impl<S: Scalar> GridRoom<S> {
    /// Builds the grids of `surfaces` surfaces in memory of these sizes.
    pub(crate) fn build(
        &mut self,
        surfaces: usize,
        patches: &Patches<'_, S>,
        options: &GridOptions<S>,
        [grids, offsets, references]: [usize; 3],
    ) -> Stage<3> {
        self.grids = vec![GridSlot::EMPTY; grids];
        (self.offsets, self.references) = (vec![7; offsets], vec![7; references]);
        let memory =
            GridMemory { grids: &mut self.grids, offsets: &mut self.offsets, references: &mut self.references };
        match Grids::build(surfaces, patches, options, memory) {
            Ok(_) => Stage::Done,
            Err(GridError::Memory(n)) => Stage::Lacks([n.grids, n.offsets, n.references]),
            Err(_) => Stage::Refused,
        }
    }
}

/// The surfaces' points, as the kernel takes them.
pub(crate) fn points<P: Kind>(model: &Model) -> Vec<Vec<P>> {
    model.surfaces.iter().map(|surface| lower(surface, 1.0)).collect()
}

/// Their nets.
pub(crate) fn nets<'p, P: Kind>(model: &Model, points: &'p [Vec<P>]) -> Vec<Net<'p, P>> {
    let degrees = model.surfaces.iter().map(|surface| (surface.degree_u, surface.degree_v));
    degrees
        .zip(points)
        .map(|((n, m), points)| Net::new(n, m, points).expect("as many points as there must be"))
        .collect()
}

/// Scenes and grids of few voxels, so that an input is done with soon.
pub(crate) const VOXELS: u32 = 4096;

/// What is prepared beside the scene; what is not stays empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Takes {
    pub(crate) patches: bool,
    /// Over patches.
    pub(crate) tree: bool,
    /// Over patches.
    pub(crate) grids: bool,
}

impl Takes {
    /// What the methods for the rays of a view take.
    pub(crate) const IN_VIEW: Takes = Takes { patches: true, tree: false, grids: false };
}

/// A model with what a method takes; `None` if the kernel refuses it.
pub(crate) fn prepare<P: Kind>(model: &Model, options: &Subdivision<P::Scalar>, takes: Takes) -> Option<Prepared<P>> {
    prepare_within::<P>(model, options, VOXELS, takes)
}

/// The same for rays of no view, with small surfaces relative to origins of their own.
pub(crate) fn prepare_apart<P: Kind>(
    model: &Model,
    options: &Subdivision<P::Scalar>,
    takes: Takes,
) -> Option<Prepared<P>> {
    let (model, origins) = apart::<P::Scalar>(model);
    prepare_with::<P>(&model, &origins, options, VOXELS, takes)
}

/// The same with a scene and grids of so many voxels at most.
pub(crate) fn prepare_within<P: Kind>(
    model: &Model,
    options: &Subdivision<P::Scalar>,
    voxels: u32,
    takes: Takes,
) -> Option<Prepared<P>> {
    prepare_with::<P>(model, &[], options, voxels, takes)
}

/// A model whose small surfaces are relative to origins of their own, and these: to the bit what it was.
fn apart<S: Scalar>(model: &Model) -> (Model, Vec<[S; 3]>) {
    let box_of = |surface: &ModelSurface| {
        let points = surface.points.iter();
        points.fold(Aabb::EMPTY, |bounds, &[x, y, z, _]| bounds.with([x, y, z].map(S::from_f64)))
    };
    let largest =
        |bounds: &Aabb<S>| bounds.low.iter().chain(&bounds.high).fold(0.0, |most, c| f64::max(most, c.to_f64().abs()));
    let all = model.surfaces.iter().map(|surface| largest(&box_of(surface))).fold(0.0, f64::max);
    let mut moved = model.clone();
    let origins = moved.surfaces.iter_mut().map(|surface| {
        let origin = exact_origin(&box_of(surface));
        let from = origin.map(S::to_f64);
        let before = surface.points.clone();
        for point in &mut surface.points {
            *point = [point[0] - from[0], point[1] - from[1], point[2] - from[2], point[3]];
        }
        // Else it is no eighth of the scene's frame.
        if largest(&box_of(surface)) < all / 16.0 {
            return origin;
        }
        surface.points = before;
        [S::ZERO; 3]
    });
    let origins = origins.collect();
    (moved, origins)
}

fn prepare_with<P: Kind>(
    model: &Model,
    origins: &[[P::Scalar; 3]],
    options: &Subdivision<P::Scalar>,
    voxels: u32,
    takes: Takes,
) -> Option<Prepared<P>> {
    let points = points::<P>(model);
    let nets = nets(model, &points);
    let scene_options = SceneOptions { voxels, ..SceneOptions::default() };
    let mut room = SceneRoom { points: vec![], surfaces: vec![], offsets: vec![], references: vec![], header: None };
    ask_and_fill(|sizes| room.build(&nets, origins, &scene_options, sizes))?;
    let scene = room.scene()?;
    let mut cut = PatchRoom { patches: vec![], first: vec![], nodes: vec![], links: vec![] };
    if takes.patches {
        ask_and_fill(|sizes| cut.build(&scene, options, takes.tree, sizes))?;
    }
    let mut over = GridRoom { grids: vec![], offsets: vec![], references: vec![] };
    let grid_options = GridOptions { voxels, ..GridOptions::default() };
    if takes.grids {
        ask_and_fill(|sizes| over.build(model.surfaces.len(), &cut.patches(), &grid_options, sizes))?;
    }
    let header = room.header?;
    let SceneRoom { points, surfaces, offsets, references, .. } = room;
    let PatchRoom { patches, first, nodes, links } = cut;
    let GridRoom { grids, offsets: grid_offsets, references: grid_references } = over;
    Some(Prepared {
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
    })
}
