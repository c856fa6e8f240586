//! How to trace: the flags of the command line, merged over a scene file's `[trace]`, over the kernel's defaults.

use std::path::PathBuf;

use clap::Args;
use patchray::domain::MAX_LEVEL;
use patchray::limits::{Acceptance as KernelAcceptance, Limits};
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use serde::Serialize;

use crate::lower::Preparation;
use crate::method::PENDING;
use crate::scene::appearance::MAX_SIDE;
use crate::scene::error::{InputError, OnInvalid};
use crate::scene::nearest::did_you_mean;
use crate::scene::source::SourceText;
use crate::scene::trace::{Acceptance, MAX_STARTS, MAX_THREADS, Method, Precision, TraceSettings};

/// The flags that every verb takes, with the same meaning.
#[derive(Args, Clone, Debug, Default)]
pub struct Flags {
    /// The method that finds hits [default: clipping]
    #[arg(long, value_enum, help_heading = "Tracing")]
    pub method: Option<Method>,
    /// The precision in which hits are computed [default: f64]
    #[arg(long, value_enum, help_heading = "Tracing")]
    pub precision: Option<Precision>,
    /// When Newton's methods and the coherent ones believe that a patch holds no other hit [default: proved; of `tables`:
    /// paper]
    #[arg(long, value_enum, help_heading = "Tracing")]
    pub acceptance: Option<Acceptance>,
    /// Newton iterations per start, at least 1
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Tracing")]
    pub newton_iterations: Option<u32>,
    /// Newton starts per patch, 1 to 3
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_STARTS)),
        help_heading = "Tracing")]
    pub newton_starts: Option<u32>,
    /// The share of an interval that a clip has to remove, else the interval is bisected [default: 0.2]
    #[arg(long, value_name = "SHARE", value_parser = share, allow_hyphen_values = true, help_heading = "Tracing")]
    pub clip_threshold: Option<f64>,
    /// How far from the ray a root may lie, as a share of the scene's size [default: 4e-13 in f64, 4e-6 in f32]
    #[arg(long, value_name = "SHARE", value_parser = positive, allow_hyphen_values = true, help_heading = "Tracing")]
    pub tolerance: Option<f64>,
    /// How far a patch may be from flat, as a share of the scene's diagonal
    #[arg(long, value_name = "SHARE", value_parser = positive, allow_hyphen_values = true, help_heading = "Tracing")]
    pub flatness: Option<f64>,
    /// Voxels of a grid per patch in it
    #[arg(long, value_name = "NUMBER", value_parser = positive, allow_hyphen_values = true, help_heading = "Tracing")]
    pub grid_density: Option<f64>,
    /// A bound by name; per ray: surfaces, nodes, patches, voxels, spans, newton-steps, clip-steps, bisections, pending-domains;
    /// in preparation: depth, patches-per-surface, arena-bytes
    #[arg(long = "limit", value_name = "NAME=N", value_parser = named_limit, help_heading = "Tracing")]
    pub limits: Vec<(Name, u64)>,
    /// Threads, 1 to 1024 [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_THREADS)),
        help_heading = "Tracing")]
    pub threads: Option<u32>,
    /// Leave out surfaces and rays that are not valid, and name them, instead of refusing the file
    #[arg(long, help_heading = "Tracing")]
    pub skip_invalid: bool,
    /// The file to write; `-` is standard output
    #[arg(long, short, value_name = "FILE", help_heading = "Output")]
    pub output: Option<PathBuf>,
    /// Write what was done and counted as JSON; `-` is standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub stats: Option<PathBuf>,
    /// Print JSON on standard output: what --stats writes, or, for `info`, what it found
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// No progress and no summary; warnings and errors stay
    #[arg(long, short, help_heading = "Output")]
    pub quiet: bool,
}

impl Flags {
    /// What readers do with what is not valid.
    pub fn on_invalid(&self) -> OnInvalid {
        if self.skip_invalid { OnInvalid::Skip } else { OnInvalid::Refuse }
    }
}

/// The flag of verbs that draw.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct SizeFlag {
    /// Width and height of the picture in pixels, such as 640x480
    #[arg(long, value_name = "WxH", value_parser = size, help_heading = "Output")]
    pub size: Option<[u32; 2]>,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        _ => Err("write a finite number above 0".to_owned()),
    }
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number < 1.0 => Ok(number),
        _ => Err("write a number above 0 and below 1".to_owned()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    let sides = text.split_once(['x', 'X']).and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or(format!("write width and height in pixels, each from 1 to {MAX_SIDE}, such as 640x480"))
}

/// A bound that the command line can set by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Name {
    /// [`Limits::surfaces`].
    Surfaces,
    /// [`Limits::nodes`].
    Nodes,
    /// [`Limits::patches`].
    Patches,
    /// [`Limits::voxels`].
    Voxels,
    /// [`Limits::spans`].
    Spans,
    /// [`Limits::newton_steps`].
    NewtonSteps,
    /// [`Limits::clip_steps`].
    ClipSteps,
    /// [`Limits::bisections`].
    Bisections,
    /// [`Limits::pending_domains`].
    PendingDomains,
    /// [`Subdivision::depth`].
    Depth,
    /// [`Subdivision::patches_per_surface`].
    PatchesPerSurface,
    /// [`Preparation::arena_bytes`].
    ArenaBytes,
}

/// Every bound with the name that it has on the command line, in `[trace.limits]` and in STATS.
const NAMES: [(&str, Name); 12] = [
    ("surfaces", Name::Surfaces),
    ("nodes", Name::Nodes),
    ("patches", Name::Patches),
    ("voxels", Name::Voxels),
    ("spans", Name::Spans),
    ("newton-steps", Name::NewtonSteps),
    ("clip-steps", Name::ClipSteps),
    ("bisections", Name::Bisections),
    ("pending-domains", Name::PendingDomains),
    ("depth", Name::Depth),
    ("patches-per-surface", Name::PatchesPerSurface),
    ("arena-bytes", Name::ArenaBytes),
];

/// The bound of this name; else what is wrong with it, with the nearest name.
fn bound(name: &str) -> Result<Name, String> {
    NAMES.iter().find_map(|&(known, bound)| (known == name).then_some(bound)).ok_or_else(|| {
        let known = NAMES.map(|(known, _)| known);
        format!("there is no limit `{name}`{}", did_you_mean(name, &known).unwrap_or_default())
    })
}

/// The names of all bounds, for messages.
fn all_names() -> String {
    NAMES.map(|(name, _)| name).join(", ")
}

/// Refuses a value that is more than the bound's type can hold, than the kernel allows, or than there is room for.
fn in_range(name: Name, value: u64) -> Result<u64, String> {
    let most = match name {
        Name::ArenaBytes => u64::MAX,
        Name::Depth => u64::from(MAX_LEVEL),
        Name::PendingDomains => PENDING as u64,
        _ => u64::from(u32::MAX),
    };
    if value <= most { Ok(value) } else { Err(format!("the most is {most}")) }
}

fn named_limit(text: &str) -> Result<(Name, u64), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=N, such as patches=10000")?;
    let name = bound(name.trim()).map_err(|error| format!("{error}; there are {}", all_names()))?;
    let value = value.trim().parse().map_err(|_| "write a whole number behind the `=`")?;
    Ok((name, in_range(name, value)?))
}

/// The bounds that can be set by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Bounds {
    /// Surfaces whose box is tested, per ray.
    pub surfaces: u32,
    /// Inner nodes of binary trees tested, per ray.
    pub nodes: u32,
    /// Patches tested, per ray.
    pub patches: u32,
    /// Voxels visited, per ray.
    pub voxels: u32,
    /// Spans of a view's scan line looked at, per ray.
    pub spans: u32,
    /// Evaluations of a surface, per ray.
    pub newton_steps: u32,
    /// Clips of an interval, per ray.
    pub clip_steps: u32,
    /// Bisections of an interval, per ray.
    pub bisections: u32,
    /// Domains that wait to be clipped at one time; at most [`PENDING`].
    pub pending_domains: u32,
    /// How often a surface may be halved in each direction.
    pub depth: u32,
    /// The most patches of one surface.
    pub patches_per_surface: u32,
    /// The most bytes of all slots lent to the kernel; `None` for no bound.
    pub arena_bytes: Option<u64>,
}

impl Name {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        NAMES.iter().find_map(|&(name, bound)| (bound == self).then_some(name)).unwrap_or("")
    }
}

impl Default for Bounds {
    /// The kernel's.
    fn default() -> Self {
        let limits = Limits::<f64>::default();
        let subdivision = Subdivision::<f64>::default();
        Bounds {
            surfaces: limits.surfaces,
            nodes: limits.nodes,
            patches: limits.patches,
            voxels: limits.voxels,
            spans: limits.spans,
            newton_steps: limits.newton_steps,
            clip_steps: limits.clip_steps,
            bisections: limits.bisections,
            pending_domains: limits.pending_domains.min(PENDING as u32),
            depth: subdivision.depth,
            patches_per_surface: subdivision.patches_per_surface,
            arena_bytes: None,
        }
    }
}

impl Bounds {
    fn set(&mut self, name: Name, value: u64) {
        // In range, as `in_range` has seen; a narrower bound is the safe side should it ever not be.
        let count = u32::try_from(value).unwrap_or(u32::MAX);
        match name {
            Name::Surfaces => self.surfaces = count,
            Name::Nodes => self.nodes = count,
            Name::Patches => self.patches = count,
            Name::Voxels => self.voxels = count,
            Name::Spans => self.spans = count,
            Name::NewtonSteps => self.newton_steps = count,
            Name::ClipSteps => self.clip_steps = count,
            Name::Bisections => self.bisections = count,
            Name::PendingDomains => self.pending_domains = count,
            Name::Depth => self.depth = count,
            Name::PatchesPerSurface => self.patches_per_surface = count,
            Name::ArenaBytes => self.arena_bytes = Some(value),
        }
    }
}

/// All that decides how rays are traced. Serialised, it is the echo in STATS.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Settings {
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// The acceptance of Newton's methods and the coherent ones.
    pub acceptance: Acceptance,
    /// Newton iterations per start.
    pub newton_iterations: u32,
    /// Newton starts per patch.
    pub newton_starts: u32,
    /// The share of an interval that a clip has to remove, else the interval is bisected.
    pub clip_threshold: f64,
    /// How far from the ray a root may lie, in the kernel's frame of the scene; `None` for the precision's default.
    pub tolerance: Option<f64>,
    /// How far a patch may be from flat, as a share of the scene's diagonal.
    pub flatness: f64,
    /// Voxels of a grid per patch in it.
    pub grid_density: f64,
    /// Threads.
    pub threads: u32,
    /// The bounds by name.
    pub limits: Bounds,
}

impl Default for Settings {
    /// The kernel's defaults, and a thread per core.
    fn default() -> Self {
        let limits = Limits::<f64>::default();
        let preparation = Preparation::<f64>::default();
        let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
        Settings {
            method: Method::default(),
            precision: Precision::default(),
            acceptance: Acceptance::default(),
            newton_iterations: limits.newton_iterations,
            newton_starts: limits.newton_starts,
            clip_threshold: limits.clip_threshold,
            tolerance: None,
            flatness: preparation.subdivision.flatness,
            grid_density: preparation.grid.density,
            threads: u32::try_from(cores).unwrap_or(1).min(MAX_THREADS),
            limits: Bounds::default(),
        }
    }
}

impl Settings {
    /// The flags over the defaults.
    pub fn of_flags(flags: &Flags) -> Self {
        Settings::default().with_flags(flags)
    }

    /// The flags over a scene file's `[trace]` over the defaults; `source` is the scene file's text.
    ///
    /// # Errors
    /// The scene file names a limit that does not exist, or gives one a value that it cannot have.
    pub fn of_scene(flags: &Flags, trace: &TraceSettings, source: &SourceText) -> Result<Self, InputError> {
        let mut settings = Settings::default();
        set(&mut settings.method, trace.method);
        set(&mut settings.precision, trace.precision);
        set(&mut settings.acceptance, trace.acceptance);
        set(&mut settings.newton_iterations, trace.newton_iterations);
        set(&mut settings.newton_starts, trace.newton_starts);
        set(&mut settings.clip_threshold, trace.clip_threshold);
        settings.tolerance = trace.tolerance;
        set(&mut settings.flatness, trace.flatness);
        set(&mut settings.grid_density, trace.grid_density);
        set(&mut settings.threads, trace.threads);
        for limit in &trace.limits {
            let refuse = |message: String, help: String| source.refuse(limit.span.clone(), message, "this limit", help);
            let name = bound(&limit.name).map_err(|error| refuse(error, format!("write one of {}", all_names())))?;
            let value = in_range(name, limit.value)
                .map_err(|error| refuse(format!("`{}` is {}", limit.name, limit.value), error))?;
            settings.limits.set(name, value);
        }
        Ok(settings.with_flags(flags))
    }

    fn with_flags(mut self, flags: &Flags) -> Self {
        set(&mut self.method, flags.method);
        set(&mut self.precision, flags.precision);
        set(&mut self.acceptance, flags.acceptance);
        set(&mut self.newton_iterations, flags.newton_iterations);
        set(&mut self.newton_starts, flags.newton_starts);
        set(&mut self.clip_threshold, flags.clip_threshold);
        self.tolerance = flags.tolerance.or(self.tolerance);
        set(&mut self.flatness, flags.flatness);
        set(&mut self.grid_density, flags.grid_density);
        set(&mut self.threads, flags.threads);
        for &(name, value) in &flags.limits {
            self.limits.set(name, value);
        }
        self
    }

    /// The kernel's bounds of a call.
    pub fn limits<S: Scalar>(&self) -> Limits<S> {
        Limits {
            newton_iterations: self.newton_iterations,
            newton_starts: self.newton_starts,
            tolerance: self.tolerance.map_or(S::TOLERANCE, S::from_f64),
            acceptance: match self.acceptance {
                Acceptance::Paper => KernelAcceptance::Paper,
                Acceptance::Proved => KernelAcceptance::Proved,
            },
            surfaces: self.limits.surfaces,
            nodes: self.limits.nodes,
            patches: self.limits.patches,
            voxels: self.limits.voxels,
            spans: self.limits.spans,
            newton_steps: self.limits.newton_steps,
            clip_threshold: S::from_f64(self.clip_threshold),
            clip_steps: self.limits.clip_steps,
            bisections: self.limits.bisections,
            pending_domains: self.limits.pending_domains,
            ..Limits::default()
        }
    }

    /// How to build the kernel's stages.
    pub fn preparation<S: Scalar>(&self) -> Preparation<S> {
        let mut preparation = Preparation::default();
        preparation.subdivision.flatness = S::from_f64(self.flatness);
        preparation.subdivision.depth = self.limits.depth;
        preparation.subdivision.patches_per_surface = self.limits.patches_per_surface;
        preparation.grid.density = S::from_f64(self.grid_density);
        preparation.arena_bytes = self.limits.arena_bytes.unwrap_or(u64::MAX);
        preparation
    }
}

fn set<T>(value: &mut T, given: Option<T>) {
    if let Some(given) = given {
        *value = given;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bound_is_set_by_its_name() {
        let echo = |bounds: Bounds| serde_json::to_value(bounds).expect("plain numbers");
        for (text, _) in NAMES {
            let (name, value) = named_limit(&format!("{text}=7")).expect("a limit");
            let mut bounds = Bounds::default();
            bounds.set(name, value);
            assert_eq!(echo(bounds)[text], 7, "{text}");
        }
        assert_eq!(echo(Bounds::default()).as_object().map(|object| object.len()), Some(NAMES.len()));
    }

    #[test]
    fn slips_are_told_what_to_write() {
        assert!(named_limit("patch=1").expect_err("unknown").contains("did you mean `patches`?"));
        assert!(named_limit("patches").expect_err("no value").contains("NAME=N"));
        assert!(named_limit("patches=-1").expect_err("negative").contains("whole number"));
        assert!(named_limit("patches=4294967296").expect_err("too large").contains("4294967295"));
        assert!(named_limit("depth=15").expect_err("too deep").contains("14"));
        assert!(named_limit("pending-domains=65").expect_err("no room").contains("64"));
        assert_eq!(size("640x480"), Ok([640, 480]));
        for text in ["640", "0x1", "1x40000", "x", "-1x2"] {
            assert!(size(text).is_err(), "{text}");
        }
        for text in ["0", "-1", "NaN", "inf", "flat"] {
            assert!(positive(text).is_err(), "{text}");
        }
        assert_eq!(share("0.05"), Ok(0.05));
        for text in ["0", "1", "-0.2", "NaN", "20%"] {
            assert!(share(text).is_err(), "{text}");
        }
    }

    #[test]
    fn flags_win_over_the_scene_file() {
        let text = "newton_starts = 2\nvoxls = 1\n";
        let source = SourceText::new("s.toml", text);
        let mut trace = TraceSettings { newton_starts: Some(2), method: Some(Method::Newton), ..Default::default() };
        let flags = Flags { newton_starts: Some(1), limits: vec![(Name::Voxels, 5)], ..Default::default() };
        trace.clip_threshold = Some(0.3);
        trace.tolerance = Some(0.25);
        let settings = Settings::of_scene(&flags, &trace, &source).expect("valid");
        assert_eq!((settings.newton_starts, settings.method, settings.limits.voxels), (1, Method::Newton, 5));
        let limits = settings.limits::<f32>();
        assert_eq!((limits.newton_starts, limits.clip_threshold, limits.tolerance), (1, 0.3, 0.25));
        let finer = Flags { tolerance: Some(0.125), ..flags.clone() };
        let of_scene = Settings::of_scene(&finer, &trace, &source).expect("valid");
        assert_eq!((of_scene.tolerance, Settings::default().limits::<f32>().tolerance), (Some(0.125), 4e-6));

        let limit =
            |name: &str, value| crate::scene::trace::LimitSetting { name: name.to_owned(), value, span: 18..23 };
        trace.limits = vec![limit("voxls", 1)];
        let error = Settings::of_scene(&flags, &trace, &source).expect_err("unknown limit");
        assert!(error.to_string().contains("did you mean `voxels`?"), "{error}");
        assert_eq!(error.place().expect("a place").to_string(), "s.toml:2:1");
        trace.limits = vec![limit("voxels", 1 << 40)];
        assert!(Settings::of_scene(&flags, &trace, &source).is_err());
    }
}
