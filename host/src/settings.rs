//! How to trace: the flags of the command line, merged over a scene file's `[trace]`, over the kernel's defaults.

use std::path::PathBuf;

use clap::Args;
use patchray::limits::{Acceptance as KernelAcceptance, Limits, MAX_NEWTON_STARTS};
use patchray::scalar::Scalar;
use serde::Serialize;

use self::bounds::{Bounds, Name, all_names, bound, in_range, named_limit};
use self::switches::{On, Switch};
use crate::lower::Preparation;
use crate::scene::appearance::MAX_SIDE;
use crate::scene::error::{InputError, OnInvalid};
use crate::scene::source::SourceText;
use crate::scene::trace::{Acceptance, MAX_THREADS, Method, Precision, TraceSettings};

pub mod bounds;
pub mod switches;

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
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_NEWTON_STARTS)),
        help_heading = "Tracing")]
    pub newton_starts: Option<u32>,
    /// The share of an interval that a clip has to remove, else the interval is bisected [default: 0.2]
    #[arg(long, value_name = "SHARE", value_parser = share, allow_hyphen_values = true, help_heading = "Tracing")]
    pub clip_threshold: Option<f64>,
    /// The factor of eq. (1): smaller takes more rays for nearly tangential [default: 1]
    #[arg(long, value_name = "NUMBER", value_parser = positive, allow_hyphen_values = true, help_heading = "Tracing")]
    pub critical_factor: Option<f64>,
    /// Follow the paper's text to the letter: without any departure from it
    #[arg(long, help_heading = "Tracing")]
    pub by_the_letter: bool,
    /// A part of the paper's methods to do without
    #[arg(long, value_enum, value_name = "PART", help_heading = "Tracing")]
    pub without: Vec<Switch>,
    /// How far from the ray a root may lie, as a share of its surface's size [default: 2e-15 in f64, 1e-6 in f32]
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
    /// The factor of eq. (1).
    pub critical_factor: f64,
    /// The parts of the methods that are there; serialised, `without` those that are not.
    #[serde(rename = "without")]
    pub parts: On,
    /// How far from the ray a root may lie, as a share of its surface's size; `None` for the precision's default.
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
            critical_factor: limits.critical_factor,
            parts: On::ALL,
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
        set(&mut self.critical_factor, flags.critical_factor);
        self.parts = if flags.by_the_letter { On::LETTER } else { On::ALL }.without(&flags.without);
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
            critical_factor: S::from_f64(self.critical_factor),
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
        preparation.switches = self.parts.0;
        preparation.grid.density = S::from_f64(self.grid_density);
        preparation.own_origins = !self.method.needs_view();
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
    fn slips_are_told_what_to_write() {
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
        assert_eq!((of_scene.tolerance, Settings::default().limits::<f32>().tolerance), (Some(0.125), 1e-6));

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
