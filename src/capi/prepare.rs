//! Preparation: from nets to a scene, its patches and trees, and their grids.

use super::lend::Lending;
use super::status::*;
use super::tables::{header_in_c, layout_of};
use super::types::*;
use super::{scratch, tables};
use crate::grid::{GridError, GridMemory, GridOptions, Grids};
use crate::layout::Table;
use crate::point::Point;
use crate::scalar::Scalar;
use crate::scene::{Scene, SceneError, SceneMemory, SceneOptions};
use crate::subdivide::{PatchMemory, SubdivideError, Subdivision, TreeMemory, subdivide};
use crate::surface::{Net, NetError};

impl<S: Scalar> patchray_options<S> {
    pub(super) fn defaults() -> Self {
        let (scene, patches, grids) = (SceneOptions::default(), Subdivision::default(), GridOptions::default());
        patchray_options {
            scene_density: scene.density,
            origin: scene.origin,
            flatness: patches.flatness,
            grid_density: grids.density,
            scene_voxels: scene.voxels,
            grid_voxels: grids.voxels,
            depth: patches.depth,
            patches_per_surface: patches.patches_per_surface,
            padding: patches.padding,
        }
    }

    /// Numbers that are none are refused, in whichever preparation.
    fn checked(self) -> Result<Self, Code> {
        let positive = [self.scene_density, self.flatness, self.grid_density];
        let right = positive.iter().all(|c| c.is_finite() && *c > S::ZERO) && self.origin.iter().all(|c| c.is_finite());
        if right { Ok(self) } else { Err(PATCHRAY_OPTION) }
    }
}

/// The options of a call.
///
/// # Safety
/// See [`Lending::read`].
unsafe fn options<S: Scalar>(
    lending: &mut Lending,
    options: *const patchray_options<S>,
) -> Result<patchray_options<S>, Code> {
    // SAFETY: the caller's.
    unsafe { lending.read_if_any(options) }?.map_or(Ok(patchray_options::defaults()), patchray_options::checked)
}

/// How many numbers a control point has.
const fn numbers<P: Point>() -> usize {
    size_of::<P>() / size_of::<P::Scalar>()
}

/// A net of the C interface as the kernel's.
///
/// # Safety
/// Its points can be read, and nothing writes them while the net is in use.
unsafe fn net_of<'c, P: Point>(net: &patchray_net<P::Scalar>) -> Result<Net<'c, P>, NetError> {
    let count = net.points_len / numbers::<P>();
    let points = if count == 0 {
        &[]
    } else {
        // SAFETY: the caller's; a point is so many numbers.
        unsafe { core::slice::from_raw_parts(net.points.cast::<P>(), count) }
    };
    Net::new(net.degree_u as usize, net.degree_v as usize, points)
}

/// Goes through all nets: that their points are there, and apart from what is written. An error comes with the surface.
///
/// # Safety
/// As for [`scene_build`].
unsafe fn check_nets<P: Point>(lending: &Lending, nets: &[patchray_net<P::Scalar>]) -> Result<(), (u32, Code)> {
    for (surface, net) in (0..).zip(nets) {
        // Each by itself: nets may share points, and are too many to be kept apart from one another.
        lending.apart::<_, P>(net.points, net.points_len).map_err(|code| (surface, code))?;
        // SAFETY: its points were just looked at.
        let checked = unsafe { net_of::<P>(net) }.map_err(|error| (surface, of_net(error)))?;
        if checked.points().len() * numbers::<P>() != net.points_len {
            return Err((surface, PATCHRAY_POINTS));
        }
    }
    Ok(())
}

/// # Safety
/// All addresses that are neither null nor misaligned lead to memory as the counts beside them say, which nothing else uses
/// during the call.
pub(super) unsafe fn scene_build<P: Point>(
    nets: *const patchray_net<P::Scalar>,
    nets_len: usize,
    given: *const patchray_options<P::Scalar>,
    memory: *mut patchray_scene_memory<P::Scalar>,
    scene: *mut patchray_scene<P::Scalar>,
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    // SAFETY: the caller's.
    let (lent, memory) = unsafe { lending.exchange(memory) }?;
    let out = lending.place(scene)?;
    let points = lending.room::<_, P>(lent.points, lent.points_len)?;
    let surfaces = lending.room(lent.surfaces, lent.surfaces_len)?;
    let offsets = lending.room(lent.offsets, lent.offsets_len)?;
    let references = lending.room(lent.references, lent.references_len)?;
    // SAFETY: the caller's.
    let options = unsafe { options(&mut lending, given) }?;
    // SAFETY: the caller's.
    let nets = unsafe { lending.slots::<_, patchray_net<P::Scalar>>(nets, nets_len) }?;
    let wrong = |(wrong_surface, code)| {
        // SAFETY: the caller's.
        unsafe { memory.set(patchray_scene_memory { wrong_surface, ..lent }) };
        code
    };
    // SAFETY: the caller's.
    unsafe { check_nets::<P>(&lending, nets) }.map_err(wrong)?;
    // SAFETY: all nets were gone through.
    let net = |k: usize| Some((unsafe { net_of::<P>(nets.get(k)?) }.ok()?, [P::Scalar::ZERO; 3]));
    // SAFETY: the caller's.
    let room = unsafe {
        SceneMemory {
            points: points.open(),
            surfaces: surfaces.open(),
            offsets: offsets.open(),
            references: references.open(),
        }
    };
    let options = SceneOptions { density: options.scene_density, voxels: options.scene_voxels, origin: options.origin };
    let (needs, built) = match Scene::build_from(nets.len(), net, &options, room) {
        Ok(scene) => (scene.lens(), Some(scene.header())),
        Err(SceneError::Memory(needs)) => {
            ([needs.points, needs.surfaces, needs.offsets, needs.references].map(|need| need.needed), None)
        }
        Err(SceneError::Surface { surface, error }) => return Err(wrong((surface, of_net(error)))),
        Err(SceneError::TooLarge) => return Err(PATCHRAY_TOO_LARGE),
    };
    let [points, surfaces_len, offsets_len, references_len] = needs;
    let points_len = points.saturating_mul(numbers::<P>());
    let wrong_surface = PATCHRAY_NO_SURFACE;
    // SAFETY: the caller's.
    unsafe {
        memory.set(patchray_scene_memory {
            points_len,
            surfaces_len,
            offsets_len,
            references_len,
            wrong_surface,
            ..lent
        });
    }
    let (frame, grid) = header_in_c(&built.ok_or(PATCHRAY_MEMORY)?);
    // SAFETY: the caller's.
    unsafe {
        out.set(patchray_scene {
            layout: layout_of::<P::Scalar>(Table::Scene, P::RATIONAL),
            frame,
            grid,
            points: lent.points,
            points_len,
            surfaces: lent.surfaces,
            surfaces_len,
            offsets: lent.offsets,
            offsets_len,
            references: lent.references,
            references_len,
        });
    }
    Ok(PATCHRAY_OK)
}

/// # Safety
/// As for [`scene_build`].
pub(super) unsafe fn patches_build<P: Point>(
    scene: *const patchray_scene<P::Scalar>,
    given: *const patchray_options<P::Scalar>,
    words: *mut u64,
    words_len: usize,
    memory: *mut patchray_patches_memory<P::Scalar>,
    patches: *mut patchray_patches<P::Scalar>,
    tree: *mut patchray_tree<P::Scalar>,
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    // SAFETY: the caller's.
    let (lent, memory) = unsafe { lending.exchange(memory) }?;
    let (out, tree) = (lending.place(patches)?, lending.place_if_any(tree)?);
    let patches = lending.room(lent.patches, lent.patches_len)?;
    let first = lending.room(lent.first, lent.first_len)?;
    let nodes = lending.room(lent.nodes, lent.nodes_len)?;
    let links = lending.room(lent.links, lent.links_len)?;
    // SAFETY: the caller's.
    let options = unsafe { options(&mut lending, given) }?;
    // SAFETY: the caller's.
    let scene = unsafe { tables::scene::<P>(&mut lending, scene) }?;
    let words = lending.room(words, words_len)?;
    // SAFETY: the caller's.
    let mut scratch = unsafe { scratch::subdivide(words) }?;
    let options = Subdivision {
        flatness: options.flatness,
        depth: options.depth,
        patches_per_surface: options.patches_per_surface,
        padding: options.padding,
    };
    // SAFETY: the caller's.
    let room = unsafe { PatchMemory { patches: patches.open(), first: first.open() } };
    // SAFETY: the caller's.
    let room_of_tree = tree.is_some().then(|| unsafe { TreeMemory { nodes: nodes.open(), links: links.open() } });
    let wrong = |wrong_surface, code| {
        // SAFETY: the caller's.
        unsafe { memory.set(patchray_patches_memory { wrong_surface, ..lent }) };
        Err(code)
    };
    let (needs, code) = match subdivide(scene.surfaces(), scene.frame(), &options, &mut scratch, room, room_of_tree) {
        Ok((patches, tree)) => {
            let (nodes, links) = tree.map_or((0, 0), |tree| (tree.nodes().len(), tree.links().len()));
            ([patches.all().len(), scene.len().saturating_add(1), nodes, links], PATCHRAY_OK)
        }
        Err(SubdivideError::Memory(needs)) => {
            ([needs.patches, needs.first, needs.nodes, needs.links].map(|need| need.needed), PATCHRAY_MEMORY)
        }
        Err(SubdivideError::Scratch { surface }) => return wrong(surface, PATCHRAY_SCRATCH),
        Err(SubdivideError::Patches { surface }) => return wrong(surface, PATCHRAY_PATCHES),
    };
    let [patches_len, first_len, nodes_len, links_len] = needs;
    let wrong_surface = PATCHRAY_NO_SURFACE;
    // SAFETY: the caller's.
    unsafe {
        memory.set(patchray_patches_memory { patches_len, first_len, nodes_len, links_len, wrong_surface, ..lent });
    }
    if code != PATCHRAY_OK {
        return Err(code);
    }
    let layout = layout_of::<P::Scalar>(Table::Patches, false);
    // SAFETY: the caller's.
    unsafe { out.set(patchray_patches { layout, patches: lent.patches, patches_len, first: lent.first, first_len }) };
    if let Some(tree) = tree {
        let layout = layout_of::<P::Scalar>(Table::Tree, false);
        // SAFETY: the caller's.
        unsafe { tree.set(patchray_tree { layout, nodes: lent.nodes, nodes_len, links: lent.links, links_len }) };
    }
    Ok(PATCHRAY_OK)
}

/// # Safety
/// As for [`scene_build`].
pub(super) unsafe fn grids_build<S: Scalar>(
    patches: *const patchray_patches<S>,
    given: *const patchray_options<S>,
    memory: *mut patchray_grids_memory<S>,
    grids: *mut patchray_grids<S>,
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    // SAFETY: the caller's.
    let (lent, memory) = unsafe { lending.exchange(memory) }?;
    let out = lending.place(grids)?;
    let grids = lending.room(lent.grids, lent.grids_len)?;
    let offsets = lending.room(lent.offsets, lent.offsets_len)?;
    let references = lending.room(lent.references, lent.references_len)?;
    // SAFETY: the caller's.
    let options = unsafe { options(&mut lending, given) }?;
    // SAFETY: the caller's.
    let (patches, surfaces) = unsafe { tables::patches(&mut lending, patches) }?;
    // SAFETY: the caller's.
    let room = unsafe { GridMemory { grids: grids.open(), offsets: offsets.open(), references: references.open() } };
    let options = GridOptions { density: options.grid_density, voxels: options.grid_voxels };
    let (needs, code) = match Grids::build(surfaces, &patches, &options, room) {
        Ok(grids) => (grids.lens(), PATCHRAY_OK),
        Err(GridError::Memory(needs)) => {
            ([needs.grids, needs.offsets, needs.references].map(|need| need.needed), PATCHRAY_MEMORY)
        }
        Err(GridError::TooLarge) => return Err(PATCHRAY_TOO_LARGE),
        Err(GridError::Patches) => return Err(PATCHRAY_TABLES),
    };
    let [grids_len, offsets_len, references_len] = needs;
    // SAFETY: the caller's.
    unsafe { memory.set(patchray_grids_memory { grids_len, offsets_len, references_len, ..lent }) };
    if code != PATCHRAY_OK {
        return Err(code);
    }
    let layout = layout_of::<S>(Table::Grids, false);
    // SAFETY: the caller's.
    unsafe {
        out.set(patchray_grids {
            layout,
            grids: lent.grids,
            grids_len,
            offsets: lent.offsets,
            offsets_len,
            references: lent.references,
            references_len,
        });
    }
    Ok(PATCHRAY_OK)
}
