//! The patches whose parallelepipeds a line meets, in the order of its way through a surface's grid.
//!
//! A full search sweeps along the ray, a testing ray back toward its origin; both meet each patch once.

use crate::limits::{Limit, Limits, Work};
use crate::patch::{Met, Patch};
use crate::planes::Planes;
use crate::scalar::Scalar;
use crate::walk::{Voxel, Walk};

/// A line's way past the patches of one surface.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'m, S> {
    walk: Walk<'m, S>,
    voxel: Voxel<'m, S>,
    patches: &'m [Patch<S>],
}

impl<'m, S: Scalar> Sweep<'m, S> {
    /// Along a walk through the grid over `patches`.
    #[inline(always)]
    pub fn new(walk: Walk<'m, S>, patches: &'m [Patch<S>]) -> Self {
        Sweep { walk, voxel: Voxel::NONE, patches }
    }

    /// The next patch whose parallelepiped the ray of `planes` meets, as a whole line; `None` at the end of the walk, or
    /// once all voxels up to the distance `enough` along it are done.
    ///
    /// Kept apart from what is done with the patch, so that the loop over voxels and patches has the registers to itself.
    #[inline(never)]
    pub fn next_patch(
        &mut self,
        planes: &Planes<S>,
        enough: S,
        limits: &Limits<S>,
        work: &mut Work,
    ) -> Result<Option<Met<'m, S>>, Limit> {
        let mut patches_left = limits.patches.saturating_sub(work.patches_tested);
        let mut voxels_left = limits.voxels.saturating_sub(work.voxels_visited);
        // Ends: each turn takes a reference of the voxel or goes on to the next voxel.
        let found = loop {
            if let Some(item) = self.voxel.next_fresh() {
                let Some(patch) = self.patches.get(item) else {
                    break Err(Limit::Slot);
                };
                if patches_left == 0 {
                    break Err(Limit::Patches);
                }
                patches_left -= 1;
                if let Some(crossing) = patch.bounds().crossing(planes) {
                    break Ok(Some((patch, crossing)));
                }
                continue;
            }
            if self.voxel.exit >= enough {
                break Ok(None);
            }
            match self.walk.advance() {
                None => break Ok(None),
                Some(Err(())) => break Err(Limit::Slot),
                Some(Ok(_)) if voxels_left == 0 => break Err(Limit::Voxels),
                Some(Ok(voxel)) => self.voxel = voxel,
            }
            voxels_left -= 1;
        };
        work.patches_tested = limits.patches.saturating_sub(patches_left).max(work.patches_tested);
        work.voxels_visited = limits.voxels.saturating_sub(voxels_left).max(work.voxels_visited);
        found
    }
}
