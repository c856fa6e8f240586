//! Tables as a header in C.

use std::fmt::Write as _;
use std::io::{self, Write};

use patchray::layout::Table as Holds;

use super::{Baked, Row, Slot, Table};
use crate::memory::Kind;
use crate::scene::trace::Precision;

/// How many numbers stand in a line of source.
const PER_LINE: usize = 12;

impl Baked {
    /// Writes the tables as a header that needs nothing but `patchray.h`. `of` says what they are made from, on one line, and
    /// the names of all that it defines begin with `name`.
    ///
    /// It does not compile with a `patchray.h` of another [`LAYOUT`](patchray::LAYOUT), nor where the tables would not take the
    /// bytes that `patchray info` says; and a library of another layout refuses what it defines. Numbers are written with the
    /// fewest digits that read back as the same bits.
    ///
    /// # Errors
    /// Whatever `out` returns.
    pub fn write_c(&self, of: &str, name: &str, out: &mut impl Write) -> io::Result<()> {
        // Not that of the library's own header, whatever the name.
        let guard = format!("PATCHRAY_TABLES_{}_H", name.to_uppercase());
        let suffix = self.suffix();
        writeln!(
            out,
            "// What `{}` borrows of {of}, in {suffix}: {} bytes of tables.",
            self.method.name(),
            self.bytes()
        )?;
        writeln!(out, "// Written by `patchray bake` {}. Not to be edited: bake again.", env!("CARGO_PKG_VERSION"))?;
        writeln!(out, "// To be included by one source file: it would have the tables once for each.")?;
        writeln!(out, "\n#ifndef {guard}\n#define {guard}\n\n#include \"patchray.h\"\n#include <math.h>")?;
        writeln!(out, "\n#if PATCHRAY_LAYOUT != {}", patchray::LAYOUT)?;
        writeln!(out, "#error \"these tables were baked for another version of patchray: bake them again\"\n#endif")?;
        writeln!(
            out,
            "\n// The number of surfaces: slots of coherence memory.\n#define {name}_SURFACES {}",
            self.surfaces
        )?;
        writeln!(out, "\n// The bytes of all tables, as `patchray info` says.\n#define {name}_BYTES {}", self.bytes())?;
        for table in &self.tables {
            self.write_c_table(table, name, out)?;
        }
        self.write_c_sizes(name, out)?;
        self.write_c_views(name, out)?;
        writeln!(out, "\n#endif")
    }

    fn suffix(&self) -> &'static str {
        match self.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        }
    }

    fn write_c_table(&self, table: &Table, name: &str, out: &mut impl Write) -> io::Result<()> {
        let Table { kind, slot, rows, bytes } = table;
        let (field, of) = (field(*kind), self.c_type_of(*slot));
        let per_slot = match slot {
            Slot::Plain => 3,
            Slot::Weighted => 4,
            _ => 1,
        };
        // C has no arrays without elements: one that is not counted stands for none.
        let (count, empty) = (rows.len() * per_slot, rows.is_empty());
        writeln!(out, "\n// {}: {bytes}.", kind.name())?;
        writeln!(out, "#define {name}_{field}_LEN {count}\nstatic const {of} {name}_{field}[{}] = {{", count.max(1))?;
        if empty {
            writeln!(
                out,
                "    {},",
                if matches!(slot, Slot::Plain | Slot::Weighted | Slot::Word) { "0" } else { "{{0}}" }
            )?;
        }
        let per_line = if *slot == Slot::Word { PER_LINE } else { 1 };
        for line in rows.chunks(per_line) {
            let line: Vec<_> = line.iter().map(|row| self.c_slot(*slot, row)).collect();
            writeln!(out, "    {},", line.join(", "))?;
        }
        writeln!(out, "}};")
    }

    /// That the tables take as many bytes as foretold, whatever compiler reads them.
    fn write_c_sizes(&self, name: &str, out: &mut impl Write) -> io::Result<()> {
        let sizes = self.tables.iter().filter(|table| !table.rows.is_empty());
        let sizes: Vec<_> = sizes.map(|table| format!("sizeof {name}_{}", field(table.kind))).collect();
        let holds = format!("{name}_BYTES == {}", if sizes.is_empty() { "0".to_owned() } else { sizes.join(" + ") });
        writeln!(out, "\n#ifdef __cplusplus\nstatic_assert({holds}, \"slots of another size\");")?;
        writeln!(out, "#else\n_Static_assert({holds}, \"slots of another size\");\n#endif")
    }

    /// What functions are given.
    fn write_c_views(&self, name: &str, out: &mut impl Write) -> io::Result<()> {
        let suffix = self.suffix();
        let of = |kind: Kind| format!("{name}_{0}, {name}_{0}_LEN", field(kind));
        let layout = |table: Holds, weighted: bool| table.tag(self.precision == Precision::F64, weighted);
        writeln!(
            out,
            "\nstatic const patchray_scene_{suffix} {name} = {{\n    {},",
            layout(Holds::Scene, self.rational)
        )?;
        writeln!(out, "    {},\n    {},", self.c_frame(), self.c_slot(Slot::Grid, &self.grid))?;
        writeln!(out, "    {}, {},", of(Kind::Points), of(Kind::Surfaces))?;
        writeln!(out, "    {}, {},\n}};", of(Kind::SceneVoxels), of(Kind::SceneReferences))?;
        let mut view = |table: Holds, what: &str, kinds: &[Kind]| {
            let lists: Vec<_> = kinds.iter().map(|&kind| of(kind)).collect();
            let (layout, lists) = (layout(table, false), lists.join(", "));
            writeln!(out, "\nstatic const patchray_{what}_{suffix} {name}_{what} = {{{layout}, {lists}}};")
        };
        if self.stages.patches {
            view(Holds::Patches, "patches", &[Kind::Patches, Kind::PatchRanges])?;
        }
        if self.stages.tree {
            view(Holds::Tree, "tree", &[Kind::TreeNodes, Kind::TreeLinks])?;
        }
        if self.stages.grids {
            view(Holds::Grids, "grids", &[Kind::Grids, Kind::GridVoxels, Kind::GridReferences])?;
        }
        Ok(())
    }

    fn c_type_of(&self, slot: Slot) -> String {
        let name = match slot {
            Slot::Plain | Slot::Weighted => return if self.suffix() == "f32" { "float" } else { "double" }.to_owned(),
            Slot::Surface => "surface",
            Slot::Patch => "patch",
            Slot::Parallelepiped => "node",
            Slot::Grid => "grid",
            Slot::Word => return "uint32_t".to_owned(),
        };
        format!("patchray_{name}_{}", self.suffix())
    }

    /// A slot as an initialiser.
    fn c_slot(&self, slot: Slot, Row { reals, words }: &Row) -> String {
        let reals = self.c_reals(reals);
        match slot {
            Slot::Plain | Slot::Weighted => reals,
            Slot::Surface | Slot::Grid => format!("{{{{{reals}}}, {{{}}}}}", c_words(words)),
            // Two words of two numbers each, the lower half first.
            Slot::Patch => {
                let parts: Vec<_> = words.iter().flat_map(|word| [word & 0xffff, word >> 16]).collect();
                format!("{{{{{reals}}}, {{{}}}}}", c_words(&parts))
            }
            Slot::Parallelepiped => format!("{{{{{reals}}}}}"),
            Slot::Word => c_words(words),
        }
    }

    /// The frame as an initialiser.
    fn c_frame(&self) -> String {
        let exponent: String = self.frame.words.iter().map(|bits| bits.cast_signed().to_string()).collect();
        format!("{{{{{}}}, {exponent}}}", self.c_reals(&self.frame.reals))
    }

    fn c_reals(&self, reals: &[f64]) -> String {
        let mut text = String::new();
        for (place, real) in reals.iter().enumerate() {
            let comma = if place == 0 { "" } else { ", " };
            // Writing to a string cannot fail. Debug formatting has a point or an exponent always, as C wants.
            let _ = match self.precision {
                _ if real.is_infinite() => {
                    write!(text, "{comma}{}(float)INFINITY", if *real < 0.0 { "-" } else { "" })
                }
                Precision::F32 => write!(text, "{comma}{:?}f", *real as f32),
                Precision::F64 => write!(text, "{comma}{real:?}"),
            };
        }
        text
    }
}

fn c_words(words: &[u32]) -> String {
    let words: Vec<_> = words.iter().map(u32::to_string).collect();
    words.join(", ")
}

/// The name of a table, as fields of the structs are called.
fn field(kind: Kind) -> &'static str {
    match kind {
        Kind::Points => "points",
        Kind::Surfaces => "surfaces",
        Kind::SceneVoxels => "offsets",
        Kind::SceneReferences => "references",
        Kind::Patches => "patch_slots",
        Kind::PatchRanges => "first",
        Kind::TreeNodes => "nodes",
        Kind::TreeLinks => "links",
        Kind::Grids => "grid_slots",
        Kind::GridVoxels => "grid_offsets",
        Kind::GridReferences => "grid_references",
        // Of views, of which nothing is baked.
        Kind::ViewPoints => "view_points",
        Kind::ViewSurfaces => "view_surfaces",
        Kind::ViewPatches => "view_patches",
        Kind::ViewSights => "view_sights",
        Kind::ViewRuns => "view_runs",
        Kind::ViewRunRanges => "view_run_ranges",
    }
}
