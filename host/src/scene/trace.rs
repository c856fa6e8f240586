//! How to trace, as far as a scene file says so; the command line has the last word.
use std::collections::BTreeMap;
use std::ops::Range;

use clap::ValueEnum;
use patchray::limits::MAX_NEWTON_STARTS;
use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::check::Check;
use super::error::InputError;

/// The algorithm that finds hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Patches in a binary tree, and Newton's iteration from each patch that the ray hits.
    Newton,
    /// Patches in a grid, and Newton's iteration from the previous ray's hit, verified by a testing ray.
    NewtonCoherent,
    /// Bézier clipping of each surface that the ray may meet: without patches, and all roots.
    #[default]
    Clipping,
    /// Bézier clipping around the previous ray's hit first, verified by a testing ray through patches in a grid.
    ClippingCoherent,
    /// Newton's iteration from where the hit is predicted, verified by one testing ray; for the rays of one view alone.
    NewtonPredicted,
    /// Bézier clipping around where the hit is predicted, verified by one testing ray; for the rays of one view alone.
    ClippingPredicted,
}

impl Method {
    /// Whether it goes from one ray to the next, and therefore after the closest hit alone.
    pub fn is_coherent(self) -> bool {
        match self {
            Method::Newton | Method::Clipping => false,
            Method::NewtonCoherent | Method::ClippingCoherent | Method::NewtonPredicted | Method::ClippingPredicted => {
                true
            }
        }
    }

    /// Whether it traces nothing but the rays of one view.
    pub fn needs_view(self) -> bool {
        matches!(self, Method::NewtonPredicted | Method::ClippingPredicted)
    }

    /// The method that traces rays of no view in its place, such as those that mirrors send on: itself if it can.
    pub fn of_any_rays(self) -> Self {
        match self {
            Method::NewtonPredicted => Method::NewtonCoherent,
            Method::ClippingPredicted => Method::ClippingCoherent,
            other => other,
        }
    }

    /// The method that tells in its place whether anything lies on a ray: the original, since rays that ask that have
    /// nothing in common with the ray before.
    pub fn of_any_hits(self) -> Self {
        match self {
            Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted => Method::Newton,
            Method::Clipping | Method::ClippingCoherent | Method::ClippingPredicted => Method::Clipping,
        }
    }

    /// Its name, as files and the command line have it.
    pub fn name(self) -> &'static str {
        match self {
            Method::Newton => "newton",
            Method::NewtonCoherent => "newton-coherent",
            Method::Clipping => "clipping",
            Method::ClippingCoherent => "clipping-coherent",
            Method::NewtonPredicted => "newton-predicted",
            Method::ClippingPredicted => "clipping-predicted",
        }
    }
}

/// The precision in which hits are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 32 bits.
    F32,
    /// 64 bits.
    #[default]
    F64,
}

impl Precision {
    /// Its name, as files and the command line have it.
    pub fn name(self) -> &'static str {
        match self {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        }
    }
}

/// When a coherent method takes a point for the only one of its patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Acceptance {
    /// As the paper does: eq. (1), factor 1; and a patch whose starts lead to no root is taken for missed.
    Paper,
    /// Only where it is proved that there is no other hit; what Newton's method does not prove is clipped.
    #[default]
    Proved,
}

impl Acceptance {
    /// Its name, as files and the command line write it.
    pub fn name(self) -> &'static str {
        match self {
            Acceptance::Paper => "paper",
            Acceptance::Proved => "proved",
        }
    }
}

/// The most threads. More would let a slip of the pen ask for millions.
pub const MAX_THREADS: u32 = 1024;

/// The table `[trace]`. What it does not give is `None`, and left to the command line and the kernel's defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TraceSettings {
    /// The algorithm.
    pub method: Option<Method>,
    /// The precision.
    pub precision: Option<Precision>,
    /// The acceptance of Newton's methods and the coherent ones.
    pub acceptance: Option<Acceptance>,
    /// Newton iterations per start, at least 1.
    pub newton_iterations: Option<u32>,
    /// Newton starts per patch, 1 to [`MAX_NEWTON_STARTS`].
    pub newton_starts: Option<u32>,
    /// The share of an interval, between 0 and 1, that a clip has to remove, else the interval is bisected.
    pub clip_threshold: Option<f64>,
    /// How far from the ray a root may lie, above 0, as a share of the scene's size.
    pub tolerance: Option<f64>,
    /// The bound, above 0, to which surfaces are subdivided: less makes more and flatter patches.
    pub flatness: Option<f64>,
    /// Voxels of a grid per patch in it, above 0: more makes smaller voxels.
    pub grid_density: Option<f64>,
    /// Threads, 1 to [`MAX_THREADS`].
    pub threads: Option<u32>,
    /// The table `[trace.limits]`, sorted by name; the names are not checked here.
    pub limits: Vec<LimitSetting>,
}

/// A limit by name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LimitSetting {
    /// The name as written.
    pub name: String,
    /// Its bound.
    pub value: u64,
    /// The bytes of the scene file that hold the name, for an error that refuses it.
    pub span: Range<usize>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TraceTable {
    method: Option<Method>,
    precision: Option<Precision>,
    acceptance: Option<Acceptance>,
    newton_iterations: Option<Spanned<i128>>,
    newton_starts: Option<Spanned<i128>>,
    clip_threshold: Option<Spanned<f64>>,
    tolerance: Option<Spanned<f64>>,
    flatness: Option<Spanned<f64>>,
    grid_density: Option<Spanned<f64>>,
    threads: Option<Spanned<i128>>,
    #[serde(default)]
    limits: BTreeMap<Spanned<String>, u64>,
}

impl TraceTable {
    pub(super) fn check(self, check: &Check) -> Result<TraceSettings, InputError> {
        let at_most = |name: &str, number: &Option<Spanned<i128>>, most: u32| {
            number.as_ref().map(|number| check.whole(name, number, 1..=most)).transpose()
        };
        let positive = |name: &str, number: &Option<Spanned<f64>>| {
            number.as_ref().map(|number| check.positive(name, number)).transpose()
        };
        Ok(TraceSettings {
            method: self.method,
            precision: self.precision,
            acceptance: self.acceptance,
            newton_iterations: at_most("`newton_iterations`", &self.newton_iterations, u32::MAX)?,
            newton_starts: at_most("`newton_starts`", &self.newton_starts, MAX_NEWTON_STARTS)?,
            clip_threshold: self
                .clip_threshold
                .as_ref()
                .map(|share| check.share("`clip_threshold`", share))
                .transpose()?,
            tolerance: positive("`tolerance`", &self.tolerance)?,
            flatness: positive("`flatness`", &self.flatness)?,
            grid_density: positive("`grid_density`", &self.grid_density)?,
            threads: at_most("`threads`", &self.threads, MAX_THREADS)?,
            limits: self
                .limits
                .into_iter()
                .map(|(name, value)| LimitSetting { span: name.span(), name: name.into_inner(), value })
                .collect(),
        })
    }
}
