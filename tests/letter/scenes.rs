//! The paper's scenes, and rays along scan lines across each of their pictures.

use crate::common::{Kind, Prepared};
use patchray::limits::Limits;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::scanline::row;
use patchray_host::scene::file::Scene;
use patchray_host::scene::paper::SCENES;
use patchray_host::scene::rays::RayLine;

/// A scene's name, its surfaces made ready, and rays in scan lines.
pub(crate) struct Case<P: Kind> {
    pub(crate) name: &'static str,
    pub(crate) prepared: Prepared<P>,
    pub(crate) lines: Vec<Vec<RayLine>>,
}

/// Of each scan line so many rays next to each other are traced, as in a picture of [`SIDE`] pixels across; of 100 lines.
const RAYS: usize = 100;
const SIDE: u32 = 512;

/// All four scenes, with 10,000 rays each.
pub(crate) fn cases<P: Kind>() -> impl Iterator<Item = Case<P>> {
    SCENES.iter().map(|paper| {
        let Scene { model, description, .. } = paper.load().unwrap();
        let flatness = P::Scalar::from_f64(description.trace.flatness.unwrap());
        let prepared = Prepared::new(&model, 1.0, &Subdivision { flatness, ..Default::default() });
        let picture = paper.camera(&description.camera).view([SIDE; 2]);
        let lines = (0..100).map(|k| {
            // Evenly up and down; stretches that wander across.
            let line = k * SIDE / 100;
            let first = (k as usize * 37) % (SIDE as usize - RAYS);
            row(&picture, line)[first..first + RAYS].to_vec()
        });
        Case { name: paper.name(), prepared, lines: lines.collect() }
    })
}

/// The paper's limits.
pub(crate) fn limits<S: Scalar>() -> Limits<S> {
    Limits::default()
}
