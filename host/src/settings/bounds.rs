//! The bounds that the command line and scene files set by name.

use patchray::domain::MAX_LEVEL;
use patchray::limits::Limits;
use patchray::subdivide::Subdivision;
use serde::Serialize;

use crate::method::PENDING;
use crate::scene::nearest::did_you_mean;

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
    /// [`Preparation::arena_bytes`](crate::lower::Preparation::arena_bytes).
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
pub(super) fn bound(name: &str) -> Result<Name, String> {
    NAMES.iter().find_map(|&(known, bound)| (known == name).then_some(bound)).ok_or_else(|| {
        let known = NAMES.map(|(known, _)| known);
        format!("there is no limit `{name}`{}", did_you_mean(name, &known).unwrap_or_default())
    })
}

/// The names of all bounds, for messages.
pub(super) fn all_names() -> String {
    NAMES.map(|(name, _)| name).join(", ")
}

/// Refuses a value that is more than the bound's type can hold, than the kernel allows, or than there is room for.
pub(super) fn in_range(name: Name, value: u64) -> Result<u64, String> {
    let most = match name {
        Name::ArenaBytes => u64::MAX,
        Name::Depth => u64::from(MAX_LEVEL),
        Name::PendingDomains => PENDING as u64,
        _ => u64::from(u32::MAX),
    };
    if value <= most { Ok(value) } else { Err(format!("the most is {most}")) }
}

/// What `NAME=N` says.
pub(super) fn named_limit(text: &str) -> Result<(Name, u64), String> {
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
    /// Sets the bound of this name to a value that [`in_range`] lets pass.
    pub(super) fn set(&mut self, name: Name, value: u64) {
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
    }
}
