//! How many bytes the kernel's lent memory takes, by kind of slot, and the bound on it.

use std::collections::BTreeMap;
use std::fmt;

use patchray::arena::Need;
use serde::Serialize;

use crate::lower::LowerError;

/// A kind of slot that the kernel is lent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Control points of all surfaces.
    Points,
    /// One header per surface.
    Surfaces,
    /// Offsets of the grid over surfaces.
    SceneVoxels,
    /// References to surfaces in that grid.
    SceneReferences,
    /// Patches of all surfaces.
    Patches,
    /// Where each surface's patches begin.
    PatchRanges,
    /// Parallelepipeds of the trees' inner nodes.
    TreeNodes,
    /// Links of the trees.
    TreeLinks,
    /// One header per grid over patches.
    Grids,
    /// Offsets of the grids over patches.
    GridVoxels,
    /// References to patches in those grids.
    GridReferences,
    /// Control points turned to a view.
    ViewPoints,
    /// The rows of surfaces in a view.
    ViewSurfaces,
    /// Patches turned to a view.
    ViewPatches,
    /// What a view sees of each patch.
    ViewSights,
    /// The rows of runs of patches in a view.
    ViewRuns,
    /// Where each surface's runs begin.
    ViewRunRanges,
}

impl Kind {
    /// What it is, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Points => "control points",
            Kind::Surfaces => "surface headers",
            Kind::SceneVoxels => "scene voxels",
            Kind::SceneReferences => "scene references",
            Kind::Patches => "patches",
            Kind::PatchRanges => "patch ranges",
            Kind::TreeNodes => "tree nodes",
            Kind::TreeLinks => "tree links",
            Kind::Grids => "grid headers",
            Kind::GridVoxels => "grid voxels",
            Kind::GridReferences => "grid references",
            Kind::ViewPoints => "view points",
            Kind::ViewSurfaces => "view surfaces",
            Kind::ViewPatches => "view patches",
            Kind::ViewSights => "view sights",
            Kind::ViewRuns => "view runs",
            Kind::ViewRunRanges => "view run ranges",
        }
    }
}

/// Bytes by kind of slot: `size_of` times slots, exactly. A kind that is not needed is not there.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Bytes(BTreeMap<Kind, u64>);

impl Bytes {
    /// Adds `count` slots of type `T`.
    pub fn add<T>(&mut self, kind: Kind, count: usize) {
        *self.0.entry(kind).or_default() += (size_of::<T>() as u64).saturating_mul(count as u64);
    }

    /// Adds those of another part.
    pub fn add_all(&mut self, other: &Bytes) {
        for (kind, bytes) in other.iter() {
            let sum = self.0.entry(kind).or_default();
            *sum = sum.saturating_add(bytes);
        }
    }

    /// Bytes of one kind.
    pub fn of(&self, kind: Kind) -> u64 {
        self.0.get(&kind).copied().unwrap_or(0)
    }

    /// Kinds and their bytes, in the order in which they are built.
    pub fn iter(&self) -> impl Iterator<Item = (Kind, u64)> {
        self.0.iter().map(|(&kind, &bytes)| (kind, bytes))
    }

    /// Bytes of all kinds.
    pub fn total(&self) -> u64 {
        self.0.values().fold(0, |sum: u64, bytes| sum.saturating_add(*bytes))
    }
}

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, (kind, bytes)) in self.iter().enumerate() {
            let comma = if place == 0 { "" } else { ", " };
            write!(f, "{comma}{} {bytes}", kind.name())?;
        }
        Ok(())
    }
}

/// Allocates slots under a bound on the bytes of all of them.
#[derive(Debug)]
pub(crate) struct Slots {
    asked: Bytes,
    given: u64,
}

impl Slots {
    pub(crate) fn new(given: u64) -> Self {
        Slots { asked: Bytes::default(), given }
    }

    /// More slots beside some that were given before, under a bound on both together.
    pub(crate) fn beside(before: Bytes, given: u64) -> Self {
        Slots { asked: before, given }
    }

    /// Notes that slots of type `T` are needed.
    pub(crate) fn ask<T>(&mut self, kind: Kind, need: Need) {
        self.asked.add::<T>(kind, need.needed);
    }

    /// Refuses if what was asked for so far is more than is given.
    pub(crate) fn check(&self) -> Result<(), LowerError> {
        let needed = self.asked.total();
        if needed <= self.given {
            return Ok(());
        }
        Err(LowerError::Arena { needed, given: self.given, detail: self.asked.to_string() })
    }

    /// The slots themselves, each holding `empty`.
    pub(crate) fn take<T: Copy>(&self, kind: Kind, empty: T, need: Need) -> Result<Vec<T>, LowerError> {
        let mut slots = Vec::new();
        slots.try_reserve_exact(need.needed).map_err(|_| LowerError::System {
            needed: (size_of::<T>() as u64).saturating_mul(need.needed as u64),
            kind: kind.name(),
        })?;
        slots.resize(need.needed, empty);
        Ok(slots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_add_up() {
        let mut bytes = Bytes::default();
        bytes.add::<u32>(Kind::GridVoxels, 3);
        bytes.add::<[f64; 3]>(Kind::Points, 2);
        bytes.add::<u32>(Kind::GridVoxels, 1);
        assert_eq!((bytes.of(Kind::GridVoxels), bytes.of(Kind::Patches), bytes.total()), (16, 0, 64));
        assert_eq!(bytes.to_string(), "control points 48, grid voxels 16");
        assert_eq!(serde_json::to_string(&bytes).expect("plain"), r#"{"points":48,"grid_voxels":16}"#);
    }

    #[test]
    fn a_bound_names_needed_and_given() {
        let need = Need { needed: 3, given: 0 };
        let mut slots = Slots::new(11);
        slots.ask::<u32>(Kind::Patches, need);
        let message = slots.check().expect_err("12 bytes are more than 11").to_string();
        assert!(message.contains("12") && message.contains("11") && message.contains("patches"), "{message}");
        assert_eq!(slots.take(Kind::Patches, 7_u32, need).expect("it is small"), [7; 3]);
        let most = Need { needed: usize::MAX / 8, given: 0 };
        assert!(matches!(slots.take(Kind::Patches, 0_u32, most), Err(LowerError::System { .. })));
    }
}
