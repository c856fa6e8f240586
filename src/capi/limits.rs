//! Bounds in the words of the C interface.

use super::status::*;
use super::types::*;
use crate::limits::{Acceptance, Limits};
use crate::scalar::Scalar;

impl<S: Scalar> patchray_limits<S> {
    pub(super) fn defaults() -> Self {
        let limits = Limits::default();
        patchray_limits {
            tolerance: limits.tolerance,
            critical_factor: limits.critical_factor,
            clip_threshold: limits.clip_threshold,
            newton_iterations: limits.newton_iterations,
            newton_starts: limits.newton_starts,
            newton_halvings: limits.newton_halvings,
            acceptance: PATCHRAY_ACCEPTANCE_PAPER,
            surfaces: limits.surfaces,
            nodes: limits.nodes,
            patches: limits.patches,
            voxels: limits.voxels,
            spans: limits.spans,
            newton_steps: limits.newton_steps,
            clip_steps: limits.clip_steps,
            bisections: limits.bisections,
            pending_domains: limits.pending_domains,
        }
    }

    /// In the kernel's words.
    #[inline(always)]
    pub(super) fn checked(&self) -> Result<Limits<S>, Code> {
        let limits = Limits {
            newton_iterations: self.newton_iterations,
            newton_starts: self.newton_starts,
            newton_halvings: self.newton_halvings,
            tolerance: self.tolerance,
            critical_factor: self.critical_factor,
            acceptance: match self.acceptance {
                PATCHRAY_ACCEPTANCE_PAPER => Acceptance::Paper,
                PATCHRAY_ACCEPTANCE_PROVED => Acceptance::Proved,
                _ => return Err(PATCHRAY_OPTION),
            },
            clip_threshold: self.clip_threshold,
            surfaces: self.surfaces,
            nodes: self.nodes,
            patches: self.patches,
            voxels: self.voxels,
            spans: self.spans,
            newton_steps: self.newton_steps,
            clip_steps: self.clip_steps,
            bisections: self.bisections,
            pending_domains: self.pending_domains,
        };
        if limits.in_range() { Ok(limits) } else { Err(PATCHRAY_OPTION) }
    }
}
