//! The patches whose parallelepipeds a line meets, in the order of its way through a surface.
//!
//! A full search goes along the ray, a testing ray back toward its origin; both meet each patch once. What leads them to the
//! patches is the surface's grid.

use crate::grid::Grid;
use crate::limits::{Limit, Limits, Work, spend};
use crate::patch::{Crossing, Patch};
use crate::planes::{DepthRange, Planes};
use crate::scalar::Scalar;
use crate::story::Event;
use crate::walk::Walk;

/// A surface's patches in its grid.
#[derive(Clone, Copy, Debug)]
pub struct InGrid<'m, S> {
    /// The grid.
    pub grid: Grid<'m, S>,
    /// The patches of its surface.
    pub patches: &'m [Patch<S>],
}

impl<S: Scalar> InGrid<'_, S> {
    /// Calls `visit` with each patch whose parallelepiped the ray, as a whole line, meets, front to back as far as is known.
    ///
    /// `visit` returns the depth up to which to go on.
    #[inline(always)]
    pub fn ahead(
        &self,
        planes: &Planes<S>,
        range: &DepthRange<S>,
        limits: &Limits<S>,
        work: &mut Work,
        mut visit: impl FnMut(&Patch<S>, &Crossing<S>, &mut Work) -> Result<S, Limit>,
    ) -> Result<(), Limit> {
        let Some((walk, begin)) = self.grid.enter(planes, range) else {
            return Ok(());
        };
        sweep(walk, self.patches, planes, limits, work, |patch, crossing, work| {
            Ok(visit(patch, crossing, work)? - begin)
        })
    }

    /// Calls `visit` with each patch whose parallelepiped the ray, as a whole line, meets, and which may reach into `range`:
    /// from its far end on, as far as is known.
    ///
    /// `visit` returns whether to go on.
    #[inline(always)]
    pub fn back(
        &self,
        planes: &Planes<S>,
        range: &DepthRange<S>,
        limits: &Limits<S>,
        work: &mut Work,
        mut visit: impl FnMut(&Patch<S>, &Crossing<S>, &mut Work) -> Result<bool, Limit>,
    ) -> Result<(), Limit> {
        let inverse = planes.inverse().map(|c| -c);
        let walk = self.grid.walk(&planes.at(range.max), &inverse, range.max - range.min);
        let mut go_on = true;
        sweep(walk, self.patches, planes, limits, work, |patch, crossing, work| {
            go_on = go_on && visit(patch, crossing, work)?;
            Ok(if go_on { S::INFINITY } else { S::LEAST })
        })
    }
}

/// Calls `visit` with each patch along `walk` whose parallelepiped the ray of `planes` meets, as a whole line.
///
/// `visit` returns how far along the walk to go on: the sweep ends after the voxel that reaches it, or with the walk.
#[inline(always)]
pub fn sweep<S: Scalar>(
    mut walk: Walk<'_, S>,
    patches: &[Patch<S>],
    planes: &Planes<S>,
    limits: &Limits<S>,
    work: &mut Work,
    mut visit: impl FnMut(&Patch<S>, &Crossing<S>, &mut Work) -> Result<S, Limit>,
) -> Result<(), Limit> {
    let mut enough = S::INFINITY;
    // Ends with the walk.
    while let Some(voxel) = walk.advance() {
        let mut voxel = voxel.map_err(|()| Limit::Slot)?;
        spend(&mut work.voxels_visited, limits.voxels, Limit::Voxels)?;
        S::tell(|| Event::Voxel);
        while let Some(item) = voxel.next_fresh() {
            let patch = patches.get(item).ok_or(Limit::Slot)?;
            spend(&mut work.patches_tested, limits.patches, Limit::Patches)?;
            let crossing = patch.bounds().crossing(planes);
            S::tell(|| patch.told(crossing.is_some()));
            if let Some(crossing) = crossing {
                enough = visit(patch, &crossing, work)?;
            }
        }
        if voxel.exit >= enough {
            break;
        }
    }
    Ok(())
}
