//! A lowered scene as tables of numbers, to be written as source that firmware holds in flash: then nothing is prepared at
//! start.
//!
//! [`Baked`] is what a method borrows, slot by slot, in no language. Each language has a file of its own beside this one that
//! writes it.

use patchray::grid::GridSlot;
use patchray::patch::{Parallelepiped, Patch};
use patchray::point::Point;
use patchray::scalar::Scalar;
use patchray::scene::SurfaceSlot;
use patchray::surface::Surface;

use crate::lower::{Lowered, Stages};
use crate::memory::Kind;
use crate::scene::trace::{Method, Precision};

mod c;
mod rust;

/// What a slot of a table is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// [`Plain`](patchray::point::Plain): 3 reals.
    Plain,
    /// [`Weighted`](patchray::point::Weighted): 4 reals.
    Weighted,
    /// [`SurfaceSlot`]: 15 reals, 3 words.
    Surface,
    /// [`Patch`]: 13 reals, 2 words.
    Patch,
    /// [`Parallelepiped`]: 12 reals.
    Parallelepiped,
    /// [`GridSlot`]: 12 reals, 5 words.
    Grid,
    /// A number: 1 word.
    Word,
}

/// What a slot holds, in the order of its memory: reals, which `f64` holds exactly in either precision, then words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// The reals.
    pub reals: Vec<f64>,
    /// The words.
    pub words: Vec<u32>,
}

/// Slots of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What they are for.
    pub kind: Kind,
    /// What each of them is.
    pub slot: Slot,
    /// What each of them holds.
    pub rows: Vec<Row>,
    /// The bytes of all.
    pub bytes: u64,
}

/// All that a method borrows of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Baked {
    /// The method.
    pub method: Method,
    /// The type of its numbers.
    pub precision: Precision,
    /// Whether points have weights.
    pub rational: bool,
    /// The stages that there are tables of.
    pub stages: Stages,
    /// The scene's [`Frame`](patchray::frame::Frame): 13 reals, and a word that holds the bits of a signed number.
    pub frame: Row,
    /// The grid over the surfaces, as a slot of [`Slot::Grid`].
    pub grid: Row,
    /// The tables, in the order in which they are built.
    pub tables: Vec<Table>,
    /// One more than the highest degree.
    pub order: usize,
    /// The most control points of a surface.
    pub net: usize,
    /// The number of surfaces.
    pub surfaces: usize,
}

impl Baked {
    /// What `method` borrows of `lowered`, whose stages, those of the method, have to have been built.
    pub fn of<P: Point>(lowered: &Lowered<P>, method: Method, precision: Precision) -> Self {
        let stages = Stages::of(method);
        let bytes = lowered.bytes(stages);
        let table = |kind: Kind, slot: Slot, rows: Vec<Row>| Table { kind, slot, rows, bytes: bytes.of(kind) };
        let slots = lowered.slots();
        let point = if P::RATIONAL { Slot::Weighted } else { Slot::Plain };
        let mut tables = vec![
            table(Kind::Points, point, slots.points.iter().map(|&slot| point_row(slot)).collect()),
            table(Kind::Surfaces, Slot::Surface, slots.surfaces.iter().map(surface_row).collect()),
            table(Kind::SceneVoxels, Slot::Word, words(slots.offsets)),
            table(Kind::SceneReferences, Slot::Word, words(slots.references)),
        ];
        if stages.patches {
            tables.push(table(Kind::Patches, Slot::Patch, slots.patches.iter().map(patch_row).collect()));
            tables.push(table(Kind::PatchRanges, Slot::Word, words(slots.first)));
        }
        if stages.tree {
            tables.push(table(Kind::TreeNodes, Slot::Parallelepiped, slots.nodes.iter().map(box_row).collect()));
            tables.push(table(Kind::TreeLinks, Slot::Word, words(slots.links)));
        }
        if stages.grids {
            tables.push(table(Kind::Grids, Slot::Grid, slots.grids.iter().map(grid_row).collect()));
            tables.push(table(Kind::GridVoxels, Slot::Word, words(slots.grid_offsets)));
            tables.push(table(Kind::GridReferences, Slot::Word, words(slots.grid_references)));
        }
        let scene = lowered.scene();
        let header = scene.header();
        let (scales, corners, sizes, exponent) = header.frame().numbers();
        let reals = scales.into_iter().chain(corners.into_iter().flatten()).chain(sizes);
        let orders = scene.surfaces().map(|Surface { net, .. }| [net.degree_u() + 1, net.degree_v() + 1]);
        let (order, net) = orders.fold((1, 1), |(order, net), [u, v]| (order.max(u).max(v), net.max(u * v)));
        Baked {
            method,
            precision,
            rational: P::RATIONAL,
            stages,
            frame: Row { reals: reals.map(Scalar::to_f64).collect(), words: vec![exponent.cast_unsigned()] },
            grid: grid_row(header.grid()),
            tables,
            order,
            net,
            surfaces: scene.len(),
        }
    }

    /// The bytes of all tables.
    pub fn bytes(&self) -> u64 {
        self.tables.iter().map(|table| table.bytes).sum()
    }
}

fn row<S: Scalar>(reals: impl IntoIterator<Item = S>, words: &[u32]) -> Row {
    Row { reals: reals.into_iter().map(Scalar::to_f64).collect(), words: words.to_vec() }
}

fn words(slots: &[u32]) -> Vec<Row> {
    slots.iter().map(|&word| Row { reals: Vec::new(), words: vec![word] }).collect()
}

fn point_row<P: Point>(point: P) -> Row {
    row(point.weighted_position().into_iter().chain(P::RATIONAL.then(|| point.weight())), &[])
}

fn surface_row<S: Scalar>(slot: &SurfaceSlot<S>) -> Row {
    let (lengths, numbers) = slot.numbers();
    row(lengths.into_iter().flatten(), &numbers)
}

fn patch_row<S: Scalar>(slot: &Patch<S>) -> Row {
    let (bounds, stray, numbers) = slot.numbers();
    row(bounds.into_iter().flatten().chain([stray]), &numbers)
}

fn box_row<S: Scalar>(slot: &Parallelepiped<S>) -> Row {
    row(slot.numbers().into_iter().flatten(), &[])
}

fn grid_row<S: Scalar>(slot: &GridSlot<S>) -> Row {
    let (lengths, numbers) = slot.numbers();
    row(lengths.into_iter().flatten(), &numbers)
}
