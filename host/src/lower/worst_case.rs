//! The most work that a ray can take in a lowered scene.

use patchray::limits::{Extent, Work};
use patchray::point::Point;

use super::Lowered;
use crate::scene::trace::{Acceptance, Method};
use crate::settings::Settings;

impl<P: Point> Lowered<P> {
    /// How large it is for a method, in the kernel's terms.
    fn extent(&self, settings: &Settings) -> Extent {
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let Settings { method, acceptance, .. } = *settings;
        let newtons = matches!(method, Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted);
        let patches = count(self.patches.len());
        let extent = Extent {
            surfaces: count(self.surfaces.len()),
            patches,
            walks: if method.is_coherent() { 2 } else { 0 },
            clipped: !newtons || acceptance == Acceptance::Proved,
            ..Extent::default()
        };
        // A view has neither trees nor grids, and a line of it may show everything.
        if method.needs_view() {
            return Extent { spans: patches, ..extent };
        }
        Extent {
            nodes: if method == Method::Newton { count(self.nodes.len()) } else { 0 },
            scene_voxels: self.scene().longest_walk(),
            surface_voxels: if method.is_coherent() { self.grids().longest_walks() } else { 0 },
            ..extent
        }
    }

    /// The most work that a ray can take by the method, and under the limits, of `settings`, whose stages have to have been
    /// built; see [`Limits::worst_case`](patchray::limits::Limits::worst_case).
    pub fn worst_case(&self, settings: &Settings) -> Work {
        settings.limits::<P::Scalar>().worst_case(&self.extent(settings))
    }
}
