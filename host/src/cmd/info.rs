//! `patchray info`: what a file holds, and the memory that each method needs for it.
//!
//! With `--json` it prints an object with these fields: `schema` (1), `version` (the kernel's), `file`, `surfaces`,
//! `rational_surfaces`, `control_points`, `degrees` (a list of `u`, `v`, `surfaces`), in all of which a B-spline counts with
//! the Bézier surfaces that it was cut into; `b_splines`, a list of them with `file` and the fields of [`SplineSummary`];
//! `polygons`, the number of a scene's; `control_box` (`min`, `max`; `null` without surfaces), `diagonal`, `flatness` and
//! `grid_density` (the ones in effect), and `memory`: for each precision `patches` and `preparation_scratch_bytes` (while the
//! scene is built), and under `methods` for each method `baked_bytes` (of the tables that `patchray bake` writes),
//! `arena_bytes` (lent for the scene), `arena_bytes_by_kind`, `coherence_bytes_per_thread`, `scratch_bytes_per_thread`, all for
//! rays of any kind and not there for a method that needs those of a view; which has instead, in `view`, the same fields and
//! `line_bytes_per_thread_at_most`: of a picture, `--stats` says how many bytes its scan lines take.
//! A precision that cannot hold the model has `refused`, the reason, instead. All bytes are sizes of slots times their number.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;

use super::Failure;
use super::load::{self, Loaded, LoadedFile};
use super::outputs::Outputs;
use crate::lower::{LowerError, Stages};
use crate::memory::Bytes;
use crate::output::Output;
use crate::prepared::Prepared;
use crate::scanline::LaneBytes;
use crate::scene::camera::{Camera, View};
use crate::scene::model::Model;
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
    baked_bytes: u64,
    #[serde(flatten)]
    rays: Option<RaysMemory>,
    view: Option<ViewMemory>,
}

/// For rays of any kind.
#[derive(Clone, Debug, Serialize)]
struct RaysMemory {
    arena_bytes: u64,
    arena_bytes_by_kind: Bytes,
    coherence_bytes_per_thread: u64,
    scratch_bytes_per_thread: u64,
}

/// For the rays of one view.
#[derive(Clone, Debug, Serialize)]
struct ViewMemory {
    #[serde(flatten)]
    rays: RaysMemory,
    line_bytes_per_thread_at_most: u64,
}

impl RaysMemory {
    fn of(bytes: Bytes, lane: &LaneBytes) -> Self {
        RaysMemory {
            arena_bytes: bytes.total(),
            arena_bytes_by_kind: bytes,
            coherence_bytes_per_thread: lane.coherence,
            scratch_bytes_per_thread: lane.scratch,
        }
    }
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
    let one = Flags { json: false, ..flags.clone() };
    let loaded = load::scene_or_patches(file, flags, &Outputs::new(Some(output), &[], &one)?)?;
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
            for (method, MethodMemory { baked_bytes, rays, view }) in methods {
                line(format_args!("  {method}, baked: {baked_bytes} bytes of tables"));
                let mut part = |what: &str, rays: &RaysMemory, most: Option<u64>| {
                    line(format_args!("  {method}{what}: {} bytes for the scene", rays.arena_bytes));
                    for (kind, bytes) in rays.arena_bytes_by_kind.iter() {
                        line(format_args!("    {:<18}{bytes:>12}", kind.name()));
                    }
                    let most = most.map_or(String::new(), |most| format!(", a scan line at most {most}"));
                    line(format_args!(
                        "    for each thread: coherence {}, scratch {}{most}",
                        rays.coherence_bytes_per_thread, rays.scratch_bytes_per_thread
                    ));
                };
                if let Some(rays) = rays {
                    part("", rays, None);
                }
                if let Some(ViewMemory { rays, line_bytes_per_thread_at_most }) = view {
                    part(", rays of a view", rays, Some(*line_bytes_per_thread_at_most));
                }
            }
        }
        text
    }
}

impl Memory {
    /// The memory of every method in the precision of `settings`.
    fn of(loaded: &Loaded, settings: &Settings) -> Result<Self, LowerError> {
        let mut prepared = match Prepared::build(&loaded.model, Stages::ALL, settings) {
            Ok(prepared) => prepared,
            Err(error @ (LowerError::Surface { .. } | LowerError::Vanishes { .. })) => {
                return Ok(Memory::Refused { refused: error.to_string() });
            }
            Err(error) => return Err(error),
        };
        // What a view takes does not depend on where it looks from.
        let picture = loaded.scene.as_ref().map(|(description, _)| description.camera.view(description.image.size));
        let picture = picture.unwrap_or_else(|| from_within(&loaded.model));
        let has_view = prepared.no_view(&picture).is_none();
        if has_view {
            prepared.take_view(&picture, settings)?;
        }
        let methods = Method::value_variants().iter().map(|&method| {
            let settings = Settings { method, ..*settings };
            let rays = (!method.needs_view())
                .then(|| RaysMemory::of(prepared.bytes(Stages::of(method)), &prepared.tracer(&settings).lane_bytes()));
            let stages = Stages::of(method);
            let view = prepared.most_view_lane_bytes(method).filter(|_| has_view).map(|lane| {
                let mut bytes = prepared.bytes(stages);
                bytes.add_all(&prepared.view_bytes());
                ViewMemory { rays: RaysMemory::of(bytes, &lane), line_bytes_per_thread_at_most: lane.line }
            });
            let baked_bytes = prepared.bytes(stages).total();
            (name(&method), MethodMemory { baked_bytes, rays, view })
        });
        let methods = methods.collect();
        Ok(Memory::Needed {
            patches: prepared.patches(),
            preparation_scratch_bytes: prepared.preparation_bytes(),
            methods,
        })
    }
}

/// A picture from the middle of the model.
fn from_within(model: &Model) -> View {
    let (eye, size) = model.control_box().map_or(([0.0; 3], 1.0), |bounds| {
        ([0, 1, 2].map(|k| 0.5 * (bounds.min[k] + bounds.max[k])), bounds.diagonal())
    });
    let axis = |k: usize| [0, 1, 2].map(|other| if other == k { size } else { 0.0 });
    Camera::Vectors { eye, forward: axis(0), right: axis(1), up: axis(2) }.view([1, 1])
}
