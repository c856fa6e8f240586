//! The patches whose parallelepipeds a line meets, in the order of its way through a surface's grid.
//!
//! A full search sweeps along the ray, a testing ray back toward its origin; both meet each patch once.

use crate::limits::{Limit, Limits, Work, spend};
use crate::patch::{Crossing, Patch};
use crate::planes::Planes;
use crate::scalar::Scalar;
use crate::walk::Walk;

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
        while let Some(item) = voxel.next_fresh() {
            let patch = patches.get(item).ok_or(Limit::Slot)?;
            spend(&mut work.patches_tested, limits.patches, Limit::Patches)?;
            if let Some(crossing) = patch.bounds().crossing(planes) {
                enough = visit(patch, &crossing, work)?;
            }
        }
        if voxel.exit >= enough {
            break;
        }
    }
    Ok(())
}
