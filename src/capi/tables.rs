//! Tables in lent memory or flash, as the kernel's views of them.

use super::lend::Lending;
use super::status::{Code, PATCHRAY_LAYOUT_DIFFERS, PATCHRAY_OPTION, PATCHRAY_TABLES};
use super::types::*;
use crate::frame::Frame;
use crate::grid::{GridSlot, Grids};
use crate::layout::Table;
use crate::method::Remembered;
use crate::patch::Patches;
use crate::point::Point;
use crate::scalar::Scalar;
use crate::scene::{Scene, SceneHeader};
use crate::tree::Tree;
use crate::view::{View, ViewHeader};

/// What stands in a table's `layout`.
pub(super) const fn layout_of<S: Scalar>(table: Table, weighted: bool) -> u32 {
    table.tag(size_of::<S>() == 8, weighted)
}

/// Refuses tables that were made otherwise.
#[inline(always)]
fn expect<S: Scalar>(layout: u32, table: Table, weighted: bool) -> Result<(), Code> {
    if layout == layout_of::<S>(table, weighted) { Ok(()) } else { Err(PATCHRAY_LAYOUT_DIFFERS) }
}

/// A scene's header in the kernel's words.
#[inline(always)]
fn header_of<S: Scalar>(frame: &patchray_frame<S>, grid: &patchray_grid<S>) -> SceneHeader<S> {
    checked_layouts::<S>();
    // SAFETY: both are laid out alike, and any bits are valid.
    let frame = unsafe { core::mem::transmute_copy::<patchray_frame<S>, Frame<S>>(frame) };
    // SAFETY: likewise.
    let grid = unsafe { core::mem::transmute_copy::<patchray_grid<S>, GridSlot<S>>(grid) };
    SceneHeader::new(frame, grid)
}

/// The same in those of the C interface.
pub(super) fn header_in_c<S: Scalar>(header: &SceneHeader<S>) -> (patchray_frame<S>, patchray_grid<S>) {
    checked_layouts::<S>();
    let mut frame = patchray_frame { numbers: [S::ZERO; 13], exponent: 0 };
    let mut grid = patchray_grid { numbers: [S::ZERO; 12], counts: [0; 5] };
    // SAFETY: both are laid out alike; a write of the kernel's struct leaves no field unset.
    unsafe { (&raw mut frame).cast::<Frame<S>>().write(*header.frame()) };
    // SAFETY: likewise.
    unsafe { (&raw mut grid).cast::<GridSlot<S>>().write(*header.grid()) };
    (frame, grid)
}

/// # Safety
/// See [`Lending::read`] and [`Lending::slots`]: of the struct and of the tables that it names.
#[inline(always)]
pub(super) unsafe fn scene<'c, P: Point>(
    lending: &mut Lending,
    scene: *const patchray_scene<P::Scalar>,
) -> Result<Scene<'c, P>, Code> {
    // SAFETY: the caller's.
    let scene = unsafe { lending.read(scene) }?;
    // SAFETY: the caller's.
    unsafe { scene_in(lending, &scene) }
}

/// The same of a copy.
///
/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn scene_in<'c, P: Point>(
    lending: &mut Lending,
    scene: &patchray_scene<P::Scalar>,
) -> Result<Scene<'c, P>, Code> {
    expect::<P::Scalar>(scene.layout, Table::Scene, P::RATIONAL)?;
    let header = header_of(&scene.frame, &scene.grid);
    // SAFETY: the caller's.
    let points = unsafe { lending.slots(scene.points, scene.points_len) }?;
    // SAFETY: likewise.
    let surfaces = unsafe { lending.slots(scene.surfaces, scene.surfaces_len) }?;
    // SAFETY: likewise.
    let offsets = unsafe { lending.slots(scene.offsets, scene.offsets_len) }?;
    // SAFETY: likewise.
    let references = unsafe { lending.slots(scene.references, scene.references_len) }?;
    Ok(Scene::new(header, points, surfaces, offsets, references))
}

/// The patches, and of how many surfaces they say to be.
///
/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn patches<'c, S: Scalar>(
    lending: &mut Lending,
    patches: *const patchray_patches<S>,
) -> Result<(Patches<'c, S>, usize), Code> {
    // SAFETY: the caller's.
    let patches = unsafe { lending.read(patches) }?;
    // SAFETY: the caller's.
    unsafe { patches_in(lending, &patches) }
}

/// The same of a copy.
///
/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn patches_in<'c, S: Scalar>(
    lending: &mut Lending,
    patches: &patchray_patches<S>,
) -> Result<(Patches<'c, S>, usize), Code> {
    expect::<S>(patches.layout, Table::Patches, false)?;
    // SAFETY: the caller's.
    let slots = unsafe { lending.slots(patches.patches, patches.patches_len) }?;
    // SAFETY: likewise.
    let first = unsafe { lending.slots(patches.first, patches.first_len) }?;
    Ok((Patches::new(slots, first), patches.first_len.saturating_sub(1)))
}

/// Patches of so many surfaces.
///
/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn patches_of<'c, S: Scalar>(
    lending: &mut Lending,
    patches: *const patchray_patches<S>,
    surfaces: usize,
) -> Result<Patches<'c, S>, Code> {
    // SAFETY: the caller's.
    let (patches, of) = unsafe { self::patches(lending, patches) }?;
    if of == surfaces { Ok(patches) } else { Err(PATCHRAY_TABLES) }
}

/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn view<'c, P: Point>(
    lending: &mut Lending,
    view: *const patchray_view<P::Scalar>,
) -> Result<View<'c, P>, Code> {
    // SAFETY: the caller's.
    let view = unsafe { lending.read(view) }?;
    expect::<P::Scalar>(view.layout, Table::View, P::RATIONAL)?;
    checked_layouts::<P::Scalar>();
    // SAFETY: both are laid out alike, and any bits are valid.
    let header = unsafe { core::mem::transmute_copy::<patchray_lens<P::Scalar>, ViewHeader<P::Scalar>>(&view.header) };
    // SAFETY: the caller's.
    let scene = unsafe { scene_in::<P>(lending, &view.scene) }?;
    // SAFETY: likewise.
    let (patches, _) = unsafe { patches_in(lending, &view.patches) }?;
    // SAFETY: likewise.
    let surfaces = unsafe { lending.slots(view.surfaces, view.surfaces_len) }?;
    // SAFETY: likewise.
    let sights = unsafe { lending.slots(view.sights, view.sights_len) }?;
    // SAFETY: likewise.
    let runs = unsafe { lending.slots(view.runs, view.runs_len) }?;
    // SAFETY: likewise.
    let first_runs = unsafe { lending.slots(view.first_runs, view.first_runs_len) }?;
    Ok(View::new(header, scene, patches, surfaces, sights, runs, first_runs))
}

/// A view's header in the words of the C interface.
pub(super) fn view_header_in_c<S: Scalar>(header: &ViewHeader<S>) -> patchray_lens<S> {
    checked_layouts::<S>();
    let mut lens = patchray_lens { numbers: [S::ZERO; 16] };
    // SAFETY: both are laid out alike; a write of the kernel's struct leaves no field unset.
    unsafe { (&raw mut lens).cast::<ViewHeader<S>>().write(*header) };
    lens
}

/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn tree<'c, S: Scalar>(
    lending: &mut Lending,
    tree: *const patchray_tree<S>,
) -> Result<Tree<'c, S>, Code> {
    // SAFETY: the caller's.
    let tree = unsafe { lending.read(tree) }?;
    expect::<S>(tree.layout, Table::Tree, false)?;
    // SAFETY: the caller's.
    let nodes = unsafe { lending.slots(tree.nodes, tree.nodes_len) }?;
    // SAFETY: likewise.
    let links = unsafe { lending.slots(tree.links, tree.links_len) }?;
    Ok(Tree::new(nodes, links))
}

/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn grids<'c, S: Scalar>(
    lending: &mut Lending,
    grids: *const patchray_grids<S>,
) -> Result<Grids<'c, S>, Code> {
    // SAFETY: the caller's.
    let grids = unsafe { lending.read(grids) }?;
    expect::<S>(grids.layout, Table::Grids, false)?;
    // SAFETY: the caller's.
    let slots = unsafe { lending.slots(grids.grids, grids.grids_len) }?;
    // SAFETY: likewise.
    let offsets = unsafe { lending.slots(grids.offsets, grids.offsets_len) }?;
    // SAFETY: likewise.
    let references = unsafe { lending.slots(grids.references, grids.references_len) }?;
    Ok(Grids::new(slots, offsets, references))
}

/// What `newton` takes: patches of so many surfaces, and their trees.
///
/// # Safety
/// As for [`scene`].
#[inline(always)]
pub(super) unsafe fn in_tree<'c, S: Scalar>(
    lending: &mut Lending,
    patches: *const patchray_patches<S>,
    tree: *const patchray_tree<S>,
    surfaces: usize,
) -> Result<(Patches<'c, S>, Tree<'c, S>), Code> {
    // SAFETY: the caller's.
    let patches = unsafe { patches_of(lending, patches, surfaces) }?;
    // SAFETY: likewise.
    let tree = unsafe { self::tree(lending, tree) }?;
    Ok((patches, tree))
}

/// What the coherent methods take: patches of so many surfaces, their grids, and memory for a scan line.
///
/// # Safety
/// As for [`scene`] and [`Lending::slot_each`].
#[inline(always)]
pub(super) unsafe fn coherent<'c, S: Scalar>(
    lending: &mut Lending,
    (patches, grids): (*const patchray_patches<S>, *const patchray_grids<S>),
    (memory, memory_len, scan_line): (*mut patchray_remembered<S>, usize, u32),
    surfaces: usize,
) -> Result<Coherent<'c, S>, Code> {
    // SAFETY: the caller's.
    let patches = unsafe { patches_of(lending, patches, surfaces) }?;
    // SAFETY: likewise.
    let grids = unsafe { self::grids(lending, grids) }?;
    // SAFETY: likewise.
    let memory = unsafe { lending.slot_each(memory, memory_len, surfaces) }?;
    if is_number_of_line(scan_line) { Ok((patches, grids, memory)) } else { Err(PATCHRAY_OPTION) }
}

pub(super) type Coherent<'c, S> = (Patches<'c, S>, Grids<'c, S>, &'c mut [Remembered<S>]);

/// Whether a scan line can have this number. The last one is none's: plus one it is what empty slots of memory hold.
#[inline(always)]
pub(super) fn is_number_of_line(number: u32) -> bool {
    number < u32::MAX
}
