//! `patchray info`: what a file holds, and the memory that each method needs for it.
//!
//! With `--json` it prints an object with these fields: `schema` (1), `version` (the kernel's), `file`, `surfaces`,
//! `rational_surfaces`, `control_points`, `degrees` (a list of `u`, `v`, `surfaces`), in all of which a B-spline counts with
//! the Bézier surfaces that it was cut into; `b_splines`, a list of them with `file` and the fields of [`SplineSummary`];
//! `polygons`, the number of a scene's; `control_box` (`min`, `max`; `null` without surfaces), `diagonal`, `flatness` and
//! `grid_density` (the ones in effect), and `memory`: for each precision `patches` and `preparation_scratch_bytes` (while the
//! scene is built), and under `methods` for each method `arena_bytes` (lent for the scene), `arena_bytes_by_kind`,
//! `coherence_bytes_per_thread`, `scratch_bytes_per_thread`. A precision that cannot hold the model has `refused`, the
//! reason, instead. All bytes are sizes of slots times their number.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;

use super::load::{self, Loaded, LoadedFile};
use super::{Failure, check_outputs};
use crate::lower::{LowerError, Stages};
use crate::memory::Bytes;
use crate::output::Output;
use crate::prepared::Prepared;
use crate::scene::spline::SplineSummary;
use crate::scene::trace::{Method, Precision};
use crate::settings::{Flags, Settings};
use crate::stats::{SCHEMA, to_json};

/// The command line of `info`.
#[derive(Args, Clone, Debug)]
pub struct InfoArgs {
    /// A file of surfaces (.bpt, or NURBS-Python's .json), or a scene file (.toml)
    pub file: PathBuf,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// How many B-splines the text lists, each on a line. More would push what follows off a screen.
const LISTED: usize = 20;

/// What `info` found out; the module's head lists the fields.
#[derive(Clone, Debug, Serialize)]
pub struct Info {
    schema: u32,
    version: &'static str,
    file: String,
    surfaces: usize,
    rational_surfaces: usize,
    control_points: usize,
    degrees: Vec<Degrees>,
    b_splines: Vec<SplineOfFile>,
    polygons: usize,
    control_box: Option<Corners>,
    diagonal: f64,
    flatness: f64,
    grid_density: f64,
    memory: BTreeMap<&'static str, Memory>,
}

#[derive(Clone, Debug, Serialize)]
struct Degrees {
    u: usize,
    v: usize,
    surfaces: usize,
}

#[derive(Clone, Debug, Serialize)]
struct SplineOfFile {
    file: String,
    #[serde(flatten)]
    spline: SplineSummary,
}

#[derive(Clone, Debug, Serialize)]
struct Corners {
    min: [f64; 3],
    max: [f64; 3],
}

#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
enum Memory {
    Needed { patches: u64, preparation_scratch_bytes: u64, methods: BTreeMap<String, MethodMemory> },
    Refused { refused: String },
}

#[derive(Clone, Debug, Serialize)]
struct MethodMemory {
    arena_bytes: u64,
    arena_bytes_by_kind: Bytes,
    coherence_bytes_per_thread: u64,
    scratch_bytes_per_thread: u64,
}

/// Prints what the file holds.
///
/// # Errors
/// Bad input, too little memory, or an output that cannot be written.
pub fn run(args: &InfoArgs) -> Result<(), Failure> {
    let InfoArgs { file, flags } = args;
    if flags.stats.is_some() {
        return Err(Failure::Usage {
            message: "`info` traces nothing, so there are no statistics".to_owned(),
            help: "use --json -o FILE for what it finds".to_owned(),
        });
    }
    let output = flags.output.as_deref().unwrap_or(Path::new("-"));
    // What is printed is one thing, in one form or the other.
    check_outputs(Some(output), &[file], &Flags { json: false, ..flags.clone() })?;
    let loaded = load::scene_or_patches(file, flags)?;
    let mut out = Output::create(output)?;
    let info = Info::of(file, &loaded)?;
    let text = if flags.json { to_json(&info) } else { info.to_text() };
    out.write_all(text.as_bytes()).map_err(|reason| out.failed(reason))?;
    Ok(out.finish()?)
}

/// The name of a value on the command line.
fn name(value: &impl ValueEnum) -> String {
    value.to_possible_value().map_or(String::new(), |value| value.get_name().to_owned())
}

impl Info {
    fn of(file: &Path, loaded: &Loaded) -> Result<Self, LowerError> {
        let Loaded { model, settings, .. } = loaded;
        let mut degrees: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for surface in &model.surfaces {
            *degrees.entry((surface.degree_u, surface.degree_v)).or_default() += 1;
        }
        let mut memory = BTreeMap::new();
        for (name, precision) in [("f32", Precision::F32), ("f64", Precision::F64)] {
            memory.insert(name, Memory::of(loaded, &Settings { precision, ..*settings })?);
        }
        let control_box = model.control_box();
        let splines = loaded.files.iter().flat_map(|LoadedFile { name, splines, .. }| {
            splines.iter().map(|spline| SplineOfFile { file: name.clone(), spline: spline.clone() })
        });
        Ok(Info {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            file: file.display().to_string(),
            surfaces: model.surfaces.len(),
            rational_surfaces: model.surfaces.iter().filter(|surface| surface.rational).count(),
            control_points: model.surfaces.iter().map(|surface| surface.points.len()).sum(),
            degrees: degrees.into_iter().map(|((u, v), surfaces)| Degrees { u, v, surfaces }).collect(),
            b_splines: splines.collect(),
            polygons: loaded.scene.as_ref().map_or(0, |(_, appearance)| appearance.polygons.len()),
            control_box: control_box.map(|bounds| Corners { min: bounds.min, max: bounds.max }),
            diagonal: control_box.map_or(0.0, |bounds| bounds.diagonal()),
            flatness: settings.flatness,
            grid_density: settings.grid_density,
            memory,
        })
    }

    fn to_text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let mut line = |args: std::fmt::Arguments| {
            let _ = writeln!(text, "{args}");
        };
        let Info { surfaces, rational_surfaces, control_points, .. } = self;
        line(format_args!("{}", self.file));
        line(format_args!(
            "surfaces        {surfaces} ({rational_surfaces} rational), {control_points} control points"
        ));
        for Degrees { u, v, surfaces } in &self.degrees {
            line(format_args!("degrees {:<7} {surfaces}", format!("{u} x {v}")));
        }
        let (splines, pieces) =
            (self.b_splines.len(), self.b_splines.iter().map(|one| one.spline.pieces).sum::<usize>());
        if splines > 0 {
            line(format_args!("b-splines       {splines}, cut into {pieces} of these surfaces"));
        }
        for SplineOfFile { file, spline } in self.b_splines.iter().take(LISTED) {
            let SplineSummary {
                surface,
                rational,
                degrees,
                control_points,
                knots,
                spans,
                pieces,
                domain,
                trims_ignored,
            } = spline;
            let by = |[u, v]: &[usize; 2]| format!("{u} x {v}");
            let [[u0, u1], [v0, v1]] = domain;
            let file = if self.file == *file { String::new() } else { format!(" of {file}") };
            let kind = if *rational { "rational, " } else { "" };
            let trims = if *trims_ignored > 0 { format!(", trims ignored {trims_ignored}") } else { String::new() };
            line(format_args!(
                "  surface {surface}{file}: {kind}degrees {}, points {}, knots {}, spans {}, pieces {pieces}, \
                 u {u0} to {u1}, v {v0} to {v1}{trims}",
                by(degrees),
                by(control_points),
                by(knots),
                by(spans),
            ));
        }
        if splines > LISTED {
            line(format_args!("  and {} more, which --json lists", splines - LISTED));
        }
        if self.polygons > 0 {
            line(format_args!("polygons        {}", self.polygons));
        }
        if let Some(Corners { min, max }) = &self.control_box {
            line(format_args!("control box     {min:?} to {max:?}, diagonal {}", self.diagonal));
        }
        line(format_args!("subdivision     flatness {}, grid density {}", self.flatness, self.grid_density));
        for (precision, memory) in &self.memory {
            let (patches, preparation, methods) = match memory {
                Memory::Refused { refused } => {
                    line(format_args!("\n{precision}: refused: {refused}"));
                    continue;
                }
                Memory::Needed { patches, preparation_scratch_bytes, methods } => {
                    (patches, preparation_scratch_bytes, methods)
                }
            };
            line(format_args!("\n{precision}: {patches} patches; scratch while building {preparation} bytes"));
            for (method, memory) in methods {
                line(format_args!("  {method}: {} bytes for the scene", memory.arena_bytes));
                for (kind, bytes) in memory.arena_bytes_by_kind.iter() {
                    line(format_args!("    {:<18}{bytes:>12}", kind.name()));
                }
                line(format_args!(
                    "    for each thread: coherence {}, scratch {}",
                    memory.coherence_bytes_per_thread, memory.scratch_bytes_per_thread
                ));
            }
        }
        text
    }
}

impl Memory {
    /// The memory of every method in the precision of `settings`.
    fn of(loaded: &Loaded, settings: &Settings) -> Result<Self, LowerError> {
        let prepared = match Prepared::build(&loaded.model, Stages::ALL, settings) {
            Ok(prepared) => prepared,
            Err(error @ (LowerError::Surface { .. } | LowerError::Vanishes { .. })) => {
                return Ok(Memory::Refused { refused: error.to_string() });
            }
            Err(error) => return Err(error),
        };
        let methods = Method::value_variants().iter().map(|method| {
            let bytes = prepared.bytes(Stages::of(*method));
            let lane = prepared.tracer(&Settings { method: *method, ..*settings }).lane_bytes();
            let memory = MethodMemory {
                arena_bytes: bytes.total(),
                arena_bytes_by_kind: bytes,
                coherence_bytes_per_thread: lane.coherence,
                scratch_bytes_per_thread: lane.scratch,
            };
            (name(method), memory)
        });
        Ok(Memory::Needed {
            patches: prepared.patches(),
            preparation_scratch_bytes: prepared.preparation_bytes(),
            methods: methods.collect(),
        })
    }
}
