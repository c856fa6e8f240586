//! What a run did, as JSON: the file that `--stats` writes and `--json` prints.

use std::collections::BTreeMap;
use std::ops::AddAssign;

use patchray::limits::Work;
use serde::Serialize;

use crate::lower::Stages;
use crate::memory::Bytes;
use crate::prepared::Prepared;
use crate::scanline::{LaneBytes, Tally};
use crate::scene::sampling::Sampling;
use crate::scene::trace::{Method, Precision};
use crate::settings::Settings;
use crate::shade::map::MapUsed;

/// The number of this format; it changes when a field changes its meaning or goes away, not when one is added.
pub const SCHEMA: u32 = 1;

/// What rays are asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Asked {
    /// The closest hit.
    #[default]
    Closest,
    /// All hits.
    All,
    /// The first hit that is found.
    Any,
}

/// The rays of a picture, by what they are for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RaysByKind {
    /// The camera's, to which all other counters of a run belong.
    pub camera: u64,
    /// Those that mirrors sent on.
    pub mirrored: u64,
    /// Those that asked whether a light reaches a point.
    pub shadow: u64,
    /// Those that drew shadow maps.
    pub map: u64,
}

impl AddAssign for RaysByKind {
    fn add_assign(&mut self, other: Self) {
        self.camera += other.camera;
        self.mirrored += other.mirrored;
        self.shadow += other.shadow;
        self.map += other.map;
    }
}

/// The methods of a picture's rays, by what the rays are for; of none that there are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct MethodsByKind {
    /// Of the camera's rays.
    pub camera: Method,
    /// Of those that mirrors send on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mirrored: Option<Method>,
    /// Of those to lights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shadow: Option<Method>,
}

/// What a run did. Counters are sums over all rays and do not depend on the number of threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stats {
    /// [`SCHEMA`].
    pub schema: u32,
    /// The kernel's version.
    pub version: &'static str,
    /// The scene file or patch file as given.
    pub scene: String,
    /// The ray file as given, for a batch of rays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ray_file: Option<String>,
    /// Width and height, for a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<[u32; 2]>,
    /// The samples of a pixel, for a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples: Option<Sampling>,
    /// The rows that this run drew, as `A..B,C..D`, for a picture of which it did not draw all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rows: Option<String>,
    /// Rays by what they are for, for a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rays_by_kind: Option<RaysByKind>,
    /// Those of them that have no answer. Pixels that need them show it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gave_up_by_kind: Option<RaysByKind>,
    /// In how many parts light was counted, for a picture: 3 (red, green and blue), or 9 samples of its spectrum where
    /// something is of metal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_samples: Option<u32>,
    /// Methods by what rays are for, for a picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub methods_by_kind: Option<MethodsByKind>,
    /// The shadow maps, for a picture.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shadow_maps: Vec<MapUsed>,
    /// The method.
    pub method: Method,
    /// The precision.
    pub precision: Precision,
    /// What rays were asked for.
    pub asked: Asked,
    /// The number of threads.
    pub threads: u32,
    /// All that was in effect: method and parameters, and `limits` by name.
    pub settings: Settings,
    /// Surfaces in the scene.
    pub surfaces: u64,
    /// Patches of all surfaces; 0 for a method that needs none.
    pub patches: u64,
    /// Rays, those that are not valid included.
    pub rays: u64,
    /// Rays that hit.
    pub hit_rays: u64,
    /// Rays given up because a limit ran out.
    pub gave_up: u64,
    /// The same by the limit's name.
    pub gave_up_by_limit: BTreeMap<&'static str, u64>,
    /// Rays that are not valid.
    pub invalid_rays: u64,
    /// The kernel's counters by name (see [`Work`]); 0 for those of methods that are not in use.
    #[serde(flatten)]
    pub work: BTreeMap<&'static str, u64>,
    /// Wall-clock seconds from the model to the scene ready to trace.
    pub prepare_seconds: f64,
    /// Seconds for making rays and answering them, summed over threads.
    pub intersect_seconds: f64,
    /// Bytes lent to the kernel for the scene, and for a view of it, all threads sharing them.
    pub arena_bytes: u64,
    /// The same by kind of slot.
    pub arena_bytes_by_kind: Bytes,
    /// Bytes of coherence memory, for each thread.
    pub coherence_bytes_per_thread: u64,
    /// Bytes of what can be seen along a scan line of a view, for each thread; 0 for rays of no view.
    pub line_bytes_per_thread: u64,
    /// Bytes of scratch, for each thread.
    pub scratch_bytes_per_thread: u64,
}

/// What was made ready for a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Used {
    /// Surfaces in the scene.
    pub surfaces: u64,
    /// Patches of all surfaces.
    pub patches: u64,
    /// Bytes lent to the kernel for the scene, and for a view of it, by kind.
    pub bytes: Bytes,
    /// Seconds that making it took.
    pub prepare_seconds: f64,
    /// What each thread takes.
    pub lane: LaneBytes,
}

impl Used {
    /// That of rays of no view.
    pub fn of_rays(prepared: &Prepared, settings: &Settings, prepare_seconds: f64) -> Self {
        Used {
            surfaces: prepared.surfaces(),
            patches: prepared.patches(),
            bytes: prepared.bytes(Stages::of(settings.method)),
            prepare_seconds,
            lane: prepared.tracer(settings).lane_bytes(),
        }
    }
}

impl Stats {
    /// The statistics of tracing what `used` says under `settings`, with `tally` the sums over rays, which were asked for
    /// their closest hits.
    pub fn new(scene: String, settings: &Settings, used: Used, tally: &Tally) -> Self {
        let Used { surfaces, patches, bytes, prepare_seconds, lane } = used;
        Stats {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            scene,
            ray_file: None,
            size: None,
            samples: None,
            rows: None,
            rays_by_kind: None,
            gave_up_by_kind: None,
            light_samples: None,
            methods_by_kind: None,
            shadow_maps: Vec::new(),
            method: settings.method,
            precision: settings.precision,
            asked: Asked::Closest,
            threads: settings.threads,
            settings: *settings,
            surfaces,
            patches,
            rays: tally.rays,
            hit_rays: tally.hits,
            gave_up: tally.gave_up_in_all(),
            gave_up_by_limit: tally.gave_up.clone(),
            invalid_rays: tally.invalid,
            work: Work::NAMES.into_iter().zip(tally.work).collect(),
            prepare_seconds,
            intersect_seconds: tally.seconds,
            arena_bytes: bytes.total(),
            arena_bytes_by_kind: bytes,
            coherence_bytes_per_thread: lane.coherence,
            line_bytes_per_thread: lane.line,
            scratch_bytes_per_thread: lane.scratch,
        }
    }
}

/// Indented JSON with an end of line. Numbers that are not finite become `null`.
pub fn to_json(value: &impl Serialize) -> String {
    // Only maps with keys that are no text can fail, and there are none.
    let mut text = serde_json::to_string_pretty(value).unwrap_or_default();
    text.push('\n');
    text
}
