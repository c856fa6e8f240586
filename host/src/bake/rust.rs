//! Tables as a Rust module.

use std::fmt::{self, Write as _};
use std::io::{self, Write};

use super::{Baked, Row, Slot, Table};
use crate::memory::Kind;
use crate::scene::trace::Precision;

/// How many reals stand in a line of source.
const PER_LINE: usize = 12;

impl Baked {
    /// Writes the tables as a module that needs nothing but the kernel. `of` says what they are made from, on one line.
    ///
    /// The module does not compile with a kernel of another [`LAYOUT`](patchray::LAYOUT), nor where the tables would not take
    /// the bytes that `patchray info` says. Reals are written with the fewest digits that read back as the same bits.
    ///
    /// # Errors
    /// Whatever `out` returns.
    pub fn write_rust(&self, of: &str, out: &mut impl Write) -> io::Result<()> {
        let (method, precision) = (self.method.name(), self.scalar());
        writeln!(out, "// What `{method}` borrows of {of}, in {precision}: {} bytes of tables.", self.bytes())?;
        writeln!(out, "// Written by `patchray bake` {}. Not to be edited: bake again.", env!("CARGO_PKG_VERSION"))?;
        writeln!(out)?;
        self.write_uses(out)?;
        writeln!(out, "\nconst _: () = assert!(patchray::LAYOUT == {}, \"{REFUSED}\");", patchray::LAYOUT)?;
        let names = self.tables.iter().map(|table| constant(table.kind));
        let sizes: Vec<_> = names.map(|name| format!("size_of_val(&{name})")).collect();
        writeln!(out, "\n/// The bytes of all tables, as `patchray info` says.")?;
        writeln!(out, "pub const BYTES: usize = {};", self.bytes())?;
        writeln!(out, "const _: () = assert!(BYTES == {}, \"slots of another size\");", sizes.join(" + "))?;
        writeln!(
            out,
            "\n/// One more than the highest degree: the `ORDER` of scratch.\npub const ORDER: usize = {};",
            self.order
        )?;
        writeln!(
            out,
            "\n/// The most control points of a surface: the `POINTS` of scratch.\npub const NET: usize = {};",
            self.net
        )?;
        writeln!(
            out,
            "\n/// The number of surfaces: slots of coherence memory, if the method has any.\n#[allow(dead_code)]\npub const COUNT: usize = {};",
            self.surfaces
        )?;
        self.write_functions(out)?;
        let scalar = self.scalar();
        writeln!(out, "\n/// What the scene holds beside its tables.\n{ALLOW}")?;
        writeln!(out, "const HEADER: SceneHeader<{scalar}> = SceneHeader::new(")?;
        writeln!(out, "    {},\n    {},\n);", self.frame(), self.slot(Slot::Grid, &self.grid))?;
        for table in &self.tables {
            self.write_table(table, out)?;
        }
        Ok(())
    }

    fn scalar(&self) -> &'static str {
        match self.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        }
    }

    fn write_uses(&self, out: &mut impl Write) -> io::Result<()> {
        let point = if self.rational { "Weighted" } else { "Plain" };
        let grids = if self.stages.grids { "{GridSlot, Grids}" } else { "GridSlot" };
        writeln!(out, "use patchray::frame::Frame;\nuse patchray::grid::{grids};")?;
        match (self.stages.patches, self.stages.tree) {
            (_, true) => writeln!(out, "use patchray::patch::{{Parallelepiped, Patch, Patches}};")?,
            (true, false) => writeln!(out, "use patchray::patch::{{Patch, Patches}};")?,
            (false, false) => {}
        }
        writeln!(out, "use patchray::point::{point};\nuse patchray::scene::{{Scene, SceneHeader, SurfaceSlot}};")?;
        if self.stages.tree {
            writeln!(out, "use patchray::tree::Tree;")?;
        }
        Ok(())
    }

    /// The functions that give the kernel's views of the tables.
    fn write_functions(&self, out: &mut impl Write) -> io::Result<()> {
        let scalar = self.scalar();
        let point = self.type_of(if self.rational { Slot::Weighted } else { Slot::Plain });
        writeln!(out, "\n/// The scene.\npub fn scene() -> Scene<'static, {point}> {{")?;
        writeln!(out, "    Scene::new(HEADER, &POINTS, &SURFACES, &SCENE_VOXELS, &SCENE_REFERENCES)\n}}")?;
        if self.stages.patches {
            writeln!(out, "\n/// The patches.\npub fn patches() -> Patches<'static, {scalar}> {{")?;
            writeln!(out, "    Patches::new(&PATCHES, &PATCH_RANGES)\n}}")?;
        }
        if self.stages.tree {
            writeln!(out, "\n/// The binary trees.\npub fn tree() -> Tree<'static, {scalar}> {{")?;
            writeln!(out, "    Tree::new(&TREE_NODES, &TREE_LINKS)\n}}")?;
        }
        if self.stages.grids {
            writeln!(out, "\n/// The grids over patches.\npub fn grids() -> Grids<'static, {scalar}> {{")?;
            writeln!(out, "    Grids::new(&GRIDS, &GRID_VOXELS, &GRID_REFERENCES)\n}}")?;
        }
        Ok(())
    }

    fn write_table(&self, table: &Table, out: &mut impl Write) -> io::Result<()> {
        let Table { kind, slot, rows, .. } = table;
        let (name, count, of) = (constant(*kind), rows.len(), self.type_of(*slot));
        writeln!(out, "\n/// {}: {}.", capital(kind.name()), table.bytes)?;
        if *slot != Slot::Word {
            writeln!(out, "{ALLOW}")?;
        }
        writeln!(out, "pub static {name}: [{of}; {count}] = [")?;
        let per_line = if *slot == Slot::Word { PER_LINE } else { 1 };
        for line in rows.chunks(per_line) {
            let line: Vec<_> = line.iter().map(|row| self.slot(*slot, row)).collect();
            writeln!(out, "    {},", line.join(", "))?;
        }
        writeln!(out, "];")
    }

    fn type_of(&self, slot: Slot) -> String {
        let name = match slot {
            Slot::Plain => "Plain",
            Slot::Weighted => "Weighted",
            Slot::Surface => "SurfaceSlot",
            Slot::Patch => "Patch",
            Slot::Parallelepiped => "Parallelepiped",
            Slot::Grid => "GridSlot",
            Slot::Word => return "u32".to_owned(),
        };
        format!("{name}<{}>", self.scalar())
    }

    /// A slot as an expression.
    fn slot(&self, slot: Slot, row: &Row) -> String {
        let Row { reals, words } = row;
        match slot {
            Slot::Plain => format!("Plain({})", self.list(reals)),
            Slot::Weighted => format!("Weighted::from_numbers({})", self.list(reals)),
            Slot::Surface => format!("SurfaceSlot::from_numbers({}, {words:?})", self.lists(reals, 3)),
            Slot::Parallelepiped => format!("Parallelepiped::from_numbers({})", self.lists(reals, 4)),
            Slot::Grid => format!("GridSlot::from_numbers({}, {words:?})", self.lists(reals, 3)),
            Slot::Patch => {
                let (bounds, stray) = reals.split_at(reals.len().saturating_sub(1));
                let stray: String = stray.iter().map(|&stray| self.real(stray)).collect();
                format!("Patch::from_numbers({}, {stray}, {words:?})", self.lists(bounds, 4))
            }
            Slot::Word => words.iter().map(u32::to_string).collect(),
        }
    }

    /// The frame as an expression.
    fn frame(&self) -> String {
        let (scales, rest) = self.frame.reals.split_at(2);
        let (corners, sizes) = rest.split_at(9);
        let exponent: String = self.frame.words.iter().map(|bits| bits.cast_signed().to_string()).collect();
        format!(
            "Frame::from_numbers({}, {}, {}, {exponent})",
            self.list(scales),
            self.lists(corners, 3),
            self.list(sizes)
        )
    }

    fn list(&self, reals: &[f64]) -> String {
        let reals: Vec<_> = reals.iter().map(|&real| self.real(real)).collect();
        format!("[{}]", reals.join(", "))
    }

    fn lists(&self, reals: &[f64], of: usize) -> String {
        let lists: Vec<_> = reals.chunks(of).map(|list| self.list(list)).collect();
        format!("[{}]", lists.join(", "))
    }

    /// A real with the fewest digits that read back as the same bits; what digits cannot say, by its bits.
    fn real(&self, real: f64) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = match self.precision {
            Precision::F32 => {
                literal(&mut text, real as f32, real.is_finite(), "f32", u64::from((real as f32).to_bits()))
            }
            Precision::F64 => literal(&mut text, real, real.is_finite(), "f64", real.to_bits()),
        };
        text
    }
}

fn literal(text: &mut String, real: impl fmt::Debug, finite: bool, scalar: &str, bits: u64) -> fmt::Result {
    if finite { write!(text, "{real:?}") } else { write!(text, "{scalar}::from_bits({bits:#x})") }
}

/// Why a module is refused.
const REFUSED: &str = "these tables were baked for another version of patchray: bake them again";

/// A table may hold a number near a named constant.
const ALLOW: &str = "#[allow(clippy::approx_constant)]";

/// The name of a table.
fn constant(kind: Kind) -> &'static str {
    match kind {
        Kind::Points => "POINTS",
        Kind::Surfaces => "SURFACES",
        Kind::SceneVoxels => "SCENE_VOXELS",
        Kind::SceneReferences => "SCENE_REFERENCES",
        Kind::Patches => "PATCHES",
        Kind::PatchRanges => "PATCH_RANGES",
        Kind::TreeNodes => "TREE_NODES",
        Kind::TreeLinks => "TREE_LINKS",
        Kind::Grids => "GRIDS",
        Kind::GridVoxels => "GRID_VOXELS",
        Kind::GridReferences => "GRID_REFERENCES",
        Kind::ViewPoints => "VIEW_POINTS",
        Kind::ViewSurfaces => "VIEW_SURFACES",
        Kind::ViewPatches => "VIEW_PATCHES",
        Kind::ViewSights => "VIEW_SIGHTS",
        Kind::ViewRuns => "VIEW_RUNS",
        Kind::ViewRunRanges => "VIEW_RUN_RANGES",
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
