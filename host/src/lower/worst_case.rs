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
        let original = matches!(method, Method::Newton | Method::Clipping);
        let newtons = matches!(method, Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted);
        Extent {
            surfaces: count(self.surfaces.len()),
            nodes: if method == Method::Newton { count(self.nodes.len()) } else { 0 },
            patches: count(self.patches.len()),
            scene_voxels: self.scene().longest_walk(),
            surface_voxels: if original { 0 } else { self.grids().longest_walks() },
            spans: 0,
            walks: if original { 0 } else { 2 },
            clipped: !newtons || acceptance == Acceptance::Proved,
        }
    }

    /// The most work that a ray of no view can take by the method, and under the limits, of `settings`, whose stages have to
    /// have been built; see [`Limits::worst_case`](patchray::limits::Limits::worst_case).
    pub fn worst_case(&self, settings: &Settings) -> Work {
        settings.limits::<P::Scalar>().worst_case(&self.extent(settings))
    }

    /// The same for a ray of a view.
    pub fn worst_case_in_view(&self, settings: &Settings) -> Work {
        let extent = self.extent(settings);
        // A line may show everything, and a view has neither trees nor grids.
        let spans = extent.surfaces.max(extent.patches);
        let extent = Extent { spans, nodes: 0, surface_voxels: 0, scene_voxels: 0, ..extent };
        settings.limits::<P::Scalar>().worst_case(&extent)
    }
}
