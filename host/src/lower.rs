//! From a model's numbers to kernel surfaces in memory that is owned here.
//!
//! The kernel only borrows. [`Lowered`] asks each stage how many slots it needs, allocates that many, has them filled, and
//! gives views of them again. Only the stages that a method needs are built: see [`Stages::of`].

use patchray::bernstein::MAX_DEGREE;
use patchray::grid::{GridError, GridMemory, GridOptions, GridSlot, Grids};
use patchray::patch::{Parallelepiped, Patch, Patches};
use patchray::point::Point;
use patchray::reading::Switches;
use patchray::scalar::Scalar;
use patchray::scene::{Scene, SceneError, SceneHeader, SceneMemory, SceneOptions, SurfaceSlot};
use patchray::subdivide::{PatchMemory, SubdivideError, SubdivideScratch, Subdivision, TreeMemory, subdivide_by};
use patchray::surface::Net;
use patchray::tree::Tree;

use crate::memory::{Bytes, Kind, Slots};
use crate::scene::model::Model;
use crate::scene::trace::Method;

mod error;
mod fit;
mod place;
mod view;
mod worst_case;

pub use error::LowerError;
pub use fit::{FromFile, unfit};
use fit::{nets_of, nothing, points_of};
use place::Origins;
pub use place::{Place, at_hand};

/// One more than the highest degree: the capacity of the scratch, so that it serves every valid surface.
pub const ORDER: usize = MAX_DEGREE + 1;

/// The control points of the largest net.
pub const NET: usize = ORDER * ORDER;

/// Which stages to build beside the scene itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stages {
    /// The patches.
    pub patches: bool,
    /// The binary trees over the patches.
    pub tree: bool,
    /// The grids over the patches.
    pub grids: bool,
}

impl Stages {
    /// None: the scene alone.
    pub const NONE: Self = Stages { patches: false, tree: false, grids: false };

    /// Patches alone.
    pub const PATCHES: Self = Stages { patches: true, tree: false, grids: false };

    /// All there are.
    pub const ALL: Self = Stages { patches: true, tree: true, grids: true };

    /// Those that a method needs: for any rays, or if it [needs a view](Method::needs_view) for the rays of one.
    pub fn of(method: Method) -> Self {
        match method {
            Method::Newton => Stages { tree: true, ..Stages::PATCHES },
            Method::NewtonCoherent | Method::ClippingCoherent => Stages { grids: true, ..Stages::PATCHES },
            Method::Clipping => Stages::NONE,
            Method::NewtonPredicted | Method::ClippingPredicted => Stages::PATCHES,
        }
    }

    /// All that is in either.
    pub fn and(self, other: Self) -> Self {
        Stages {
            patches: self.patches || other.patches,
            tree: self.tree || other.tree,
            grids: self.grids || other.grids,
        }
    }

    /// Whether there are patches: trees and grids are made of them.
    pub fn has_patches(self) -> bool {
        self.patches || self.tree || self.grids
    }
}

/// How to build the stages, in the kernel's terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preparation<S> {
    /// How finely surfaces are subdivided.
    pub subdivision: Subdivision<S>,
    /// By which reading of the paper.
    pub switches: Switches,
    /// How fine the grids over patches are.
    pub grid: GridOptions<S>,
    /// How fine the grid over surfaces is.
    pub scene: SceneOptions<S>,
    /// Whether surfaces much smaller than the scene are given relative to origins of their own, by which they are met more exactly.
    /// There is no view of them.
    pub own_origins: bool,
    /// The most bytes that all slots together may take; `u64::MAX` for no bound.
    pub arena_bytes: u64,
}

impl<S: Scalar> Default for Preparation<S> {
    /// The kernel's defaults, origins for small surfaces, and no bound on bytes.
    fn default() -> Self {
        Preparation {
            subdivision: Subdivision::default(),
            switches: Switches::ours(),
            grid: GridOptions::default(),
            scene: SceneOptions::default(),
            own_origins: true,
            arena_bytes: u64::MAX,
        }
    }
}

/// A scene in memory of its own: filled slots and the header that goes with them.
#[derive(Clone, Debug)]
pub struct Lowered<P: Point> {
    stages: Stages,
    header: SceneHeader<P::Scalar>,
    points: Vec<P>,
    surfaces: Vec<SurfaceSlot<P::Scalar>>,
    offsets: Vec<u32>,
    references: Vec<u32>,
    patches: Vec<Patch<P::Scalar>>,
    first: Vec<u32>,
    nodes: Vec<Parallelepiped<P::Scalar>>,
    links: Vec<u32>,
    grids: Vec<GridSlot<P::Scalar>>,
    grid_offsets: Vec<u32>,
    grid_references: Vec<u32>,
    /// Of a view of these; empty until one is taken.
    view: view::ViewSlots<P>,
}

impl<P: FromFile> Lowered<P> {
    /// Lowers `model`, and builds the stages.
    ///
    /// # Errors
    /// A surface that the number type cannot hold, or more memory than there is or may be used.
    pub fn build(model: &Model, stages: Stages, preparation: &Preparation<P::Scalar>) -> Result<Self, LowerError> {
        let numbers = |index: u32| model.surfaces.get(index as usize).map_or(0, |surface| surface.number);
        let origins = Origins::of(model, preparation.own_origins);
        let mut points = Vec::new();
        for (index, surface) in model.surfaces.iter().enumerate() {
            let refused = |reason| LowerError::Surface { index, number: surface.number, reason };
            points.push(points_of::<P>(surface, index, &origins).map_err(refused)?);
        }
        let nets = nets_of(model, &points).map_err(|error| LowerError::Internal(error.to_string()))?;
        let mut slots = Slots::new(preparation.arena_bytes);
        let mut lowered = Self::scene_of(&nets, &origins, &preparation.scene, stages, numbers, &mut slots)?;
        let diagonal = model.control_box().map_or(0.0, |bounds| bounds.diagonal());
        if diagonal > 0.0 && !(lowered.scene().frame().diagonal() > P::Scalar::ZERO) {
            return Err(LowerError::Vanishes { diagonal });
        }
        if stages.has_patches() {
            lowered.subdivide(preparation, numbers, &mut slots)?;
        }
        if stages.grids {
            lowered.grids_of(&preparation.grid, &mut slots)?;
        }
        Ok(lowered)
    }

    fn scene_of(
        nets: &[Net<'_, P>],
        origins: &Origins<P::Scalar>,
        options: &SceneOptions<P::Scalar>,
        stages: Stages,
        numbers: impl Fn(u32) -> usize,
        slots: &mut Slots,
    ) -> Result<Self, LowerError> {
        let refused = |error: SceneError| match error {
            SceneError::TooLarge => LowerError::TooLarge(error.to_string()),
            SceneError::Surface { surface, error } => {
                LowerError::Surface { index: surface as usize, number: numbers(surface), reason: error.to_string() }
            }
            _ => LowerError::Internal(error.to_string()),
        };
        let options = &SceneOptions { origin: origins.scene, ..*options };
        let needs = match Scene::build_apart(nets, &origins.own, options, nothing()) {
            Ok(_) => Default::default(),
            Err(SceneError::Memory(needs)) => needs,
            Err(error) => return Err(refused(error)),
        };
        slots.ask::<P>(Kind::Points, needs.points);
        slots.ask::<SurfaceSlot<P::Scalar>>(Kind::Surfaces, needs.surfaces);
        slots.ask::<u32>(Kind::SceneVoxels, needs.offsets);
        slots.ask::<u32>(Kind::SceneReferences, needs.references);
        slots.check()?;
        let mut points = slots.take(Kind::Points, P::EMPTY, needs.points)?;
        let mut surfaces = slots.take(Kind::Surfaces, SurfaceSlot::EMPTY, needs.surfaces)?;
        let mut offsets = slots.take(Kind::SceneVoxels, 0, needs.offsets)?;
        let mut references = slots.take(Kind::SceneReferences, 0, needs.references)?;
        let memory = SceneMemory {
            points: &mut points,
            surfaces: &mut surfaces,
            offsets: &mut offsets,
            references: &mut references,
        };
        let header = Scene::build_apart(nets, &origins.own, options, memory).map_err(refused)?.header();
        Ok(Lowered {
            stages,
            header,
            points,
            surfaces,
            offsets,
            references,
            patches: Vec::new(),
            first: Vec::new(),
            nodes: Vec::new(),
            links: Vec::new(),
            grids: Vec::new(),
            grid_offsets: Vec::new(),
            grid_references: Vec::new(),
            view: view::ViewSlots::none(),
        })
    }

    fn subdivide(
        &mut self,
        preparation: &Preparation<P::Scalar>,
        number: impl Fn(u32) -> usize,
        slots: &mut Slots,
    ) -> Result<(), LowerError> {
        let Preparation { subdivision: options, switches, .. } = preparation;
        let given = options.patches_per_surface;
        let refused = |error: SubdivideError| match error {
            SubdivideError::Patches { surface } => LowerError::Patches { number: number(surface), given },
            _ => LowerError::Internal(error.to_string()),
        };
        let wants_tree = self.stages.tree;
        let mut scratch = Box::new(SubdivideScratch::<P, NET>::new());
        let scene = Scene::new(self.header, &self.points, &self.surfaces, &self.offsets, &self.references);
        let tree = wants_tree.then_some(TreeMemory { nodes: &mut [], links: &mut [] });
        let nothing = PatchMemory { patches: &mut [], first: &mut [] };
        let needs =
            match subdivide_by(*switches, scene.surfaces(), scene.frame(), options, &mut scratch.view(), nothing, tree)
            {
                Ok(_) => Default::default(),
                Err(SubdivideError::Memory(needs)) => needs,
                Err(error) => return Err(refused(error)),
            };
        slots.ask::<Patch<P::Scalar>>(Kind::Patches, needs.patches);
        slots.ask::<u32>(Kind::PatchRanges, needs.first);
        slots.ask::<Parallelepiped<P::Scalar>>(Kind::TreeNodes, needs.nodes);
        slots.ask::<u32>(Kind::TreeLinks, needs.links);
        slots.check()?;
        self.patches = slots.take(Kind::Patches, Patch::EMPTY, needs.patches)?;
        self.first = slots.take(Kind::PatchRanges, 0, needs.first)?;
        self.nodes = slots.take(Kind::TreeNodes, Parallelepiped::EMPTY, needs.nodes)?;
        self.links = slots.take(Kind::TreeLinks, 0, needs.links)?;
        let memory = PatchMemory { patches: &mut self.patches, first: &mut self.first };
        let tree = wants_tree.then_some(TreeMemory { nodes: &mut self.nodes, links: &mut self.links });
        subdivide_by(*switches, scene.surfaces(), scene.frame(), options, &mut scratch.view(), memory, tree)
            .map_err(refused)?;
        Ok(())
    }

    fn grids_of(&mut self, options: &GridOptions<P::Scalar>, slots: &mut Slots) -> Result<(), LowerError> {
        let refused = |error: GridError| match error {
            GridError::TooLarge => LowerError::TooLarge(error.to_string()),
            _ => LowerError::Internal(error.to_string()),
        };
        let surfaces = self.surfaces.len();
        let patches = Patches::new(&self.patches, &self.first);
        let nothing = GridMemory { grids: &mut [], offsets: &mut [], references: &mut [] };
        let needs = match Grids::build(surfaces, &patches, options, nothing) {
            Ok(_) => Default::default(),
            Err(GridError::Memory(needs)) => needs,
            Err(error) => return Err(refused(error)),
        };
        slots.ask::<GridSlot<P::Scalar>>(Kind::Grids, needs.grids);
        slots.ask::<u32>(Kind::GridVoxels, needs.offsets);
        slots.ask::<u32>(Kind::GridReferences, needs.references);
        slots.check()?;
        self.grids = slots.take(Kind::Grids, GridSlot::EMPTY, needs.grids)?;
        self.grid_offsets = slots.take(Kind::GridVoxels, 0, needs.offsets)?;
        self.grid_references = slots.take(Kind::GridReferences, 0, needs.references)?;
        let memory = GridMemory {
            grids: &mut self.grids,
            offsets: &mut self.grid_offsets,
            references: &mut self.grid_references,
        };
        Grids::build(surfaces, &patches, options, memory).map_err(refused)?;
        Ok(())
    }
}

/// The filled slots of a lowered scene, by kind: see [`SceneMemory`], [`PatchMemory`], [`TreeMemory`] and [`GridMemory`].
#[derive(Clone, Copy, Debug)]
pub struct FilledSlots<'l, P: Point> {
    /// Control points.
    pub points: &'l [P],
    /// Surfaces.
    pub surfaces: &'l [SurfaceSlot<P::Scalar>],
    /// Offsets of the grid over surfaces.
    pub offsets: &'l [u32],
    /// References of that grid.
    pub references: &'l [u32],
    /// Patches.
    pub patches: &'l [Patch<P::Scalar>],
    /// Where each surface's patches begin.
    pub first: &'l [u32],
    /// Inner nodes of the trees.
    pub nodes: &'l [Parallelepiped<P::Scalar>],
    /// Links of the trees.
    pub links: &'l [u32],
    /// Grids over patches.
    pub grids: &'l [GridSlot<P::Scalar>],
    /// Offsets of those grids.
    pub grid_offsets: &'l [u32],
    /// References of those grids.
    pub grid_references: &'l [u32],
}

impl<P: Point> Lowered<P> {
    /// All filled slots; those of stages that were not built are none.
    pub fn slots(&self) -> FilledSlots<'_, P> {
        FilledSlots {
            points: &self.points,
            surfaces: &self.surfaces,
            offsets: &self.offsets,
            references: &self.references,
            patches: &self.patches,
            first: &self.first,
            nodes: &self.nodes,
            links: &self.links,
            grids: &self.grids,
            grid_offsets: &self.grid_offsets,
            grid_references: &self.grid_references,
        }
    }

    /// The scene.
    pub fn scene(&self) -> Scene<'_, P> {
        self.scene_at(Place::File)
    }

    /// The patches; of no surface if they were not built.
    pub fn patches(&self) -> Patches<'_, P::Scalar> {
        Patches::new(&self.patches, &self.first)
    }

    /// The binary trees; empty if they were not built.
    pub fn tree(&self) -> Tree<'_, P::Scalar> {
        Tree::new(&self.nodes, &self.links)
    }

    /// The grids; empty if they were not built.
    pub fn grids(&self) -> Grids<'_, P::Scalar> {
        Grids::new(&self.grids, &self.grid_offsets, &self.grid_references)
    }

    /// What was built.
    pub fn stages(&self) -> Stages {
        self.stages
    }

    /// The slots that `stages` take of what was built, by kind: exact, `size_of` times slots.
    pub fn bytes(&self, stages: Stages) -> Bytes {
        let mut bytes = Bytes::default();
        bytes.add::<P>(Kind::Points, self.points.len());
        bytes.add::<SurfaceSlot<P::Scalar>>(Kind::Surfaces, self.surfaces.len());
        bytes.add::<u32>(Kind::SceneVoxels, self.offsets.len());
        bytes.add::<u32>(Kind::SceneReferences, self.references.len());
        if stages.has_patches() {
            bytes.add::<Patch<P::Scalar>>(Kind::Patches, self.patches.len());
            bytes.add::<u32>(Kind::PatchRanges, self.first.len());
        }
        if stages.tree {
            bytes.add::<Parallelepiped<P::Scalar>>(Kind::TreeNodes, self.nodes.len());
            bytes.add::<u32>(Kind::TreeLinks, self.links.len());
        }
        if stages.grids {
            bytes.add::<GridSlot<P::Scalar>>(Kind::Grids, self.grids.len());
            bytes.add::<u32>(Kind::GridVoxels, self.grid_offsets.len());
            bytes.add::<u32>(Kind::GridReferences, self.grid_references.len());
        }
        bytes
    }

    /// Bytes of scratch that subdivision takes while the scene is built.
    pub fn preparation_bytes(&self) -> u64 {
        size_of::<SubdivideScratch<P, NET>>() as u64
    }
}

#[cfg(test)]
mod tests;
