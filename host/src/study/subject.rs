//! What a study is of: a model, a picture of it, and the settings that cells differ from.

use crate::number::Shortest;
use crate::scene::camera::{Camera, View};
use crate::scene::model::Model;
use crate::settings::{Flags, Settings};

/// What a study is of.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The scene, for people.
    pub name: String,
    /// What `study` was given to find it: a file, or nothing for the built-in scene.
    pub argument: Option<String>,
    /// Where `query` finds its surfaces.
    pub patches: String,
    /// The surfaces.
    pub model: Model,
    /// The picture, a sample per pixel.
    pub picture: View,
    /// The settings that cells differ from.
    pub settings: Settings,
    /// The flags that led to them, as words of the command line.
    pub words: String,
}

impl Subject {
    /// The model's diagonal; 1 for a model that has no extent to measure by.
    pub fn diagonal(&self) -> f64 {
        let diagonal = self.model.control_box().map_or(0.0, |bounds| bounds.diagonal());
        if diagonal > 0.0 { diagonal } else { 1.0 }
    }

    /// A number that two models, or two views of one, hardly have in common. Source: FNV-1a, 64 bits, of the bits of all
    /// numbers.
    pub fn fingerprint(&self) -> String {
        let View { eye, forward, right, up, .. } = self.picture;
        let camera = [eye, forward, right, up];
        let points = self.model.surfaces.iter().flat_map(|surface| surface.points.iter().flatten());
        let mut sum = 0xcbf2_9ce4_8422_2325_u64;
        for number in camera.iter().flatten().chain(points) {
            for byte in number.to_bits().to_le_bytes() {
                sum = (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
        format!("{sum:016x}")
    }
}

/// A camera that sees all of a model whose file names none: from the side from which the common view sees the teapot.
pub fn camera_of(model: &Model) -> Camera {
    const TOWARDS_EYE: [f64; 3] = [9.0 / 17.0, -12.0 / 17.0, 8.0 / 17.0];
    let bounds = model.control_box();
    let centre = bounds.map_or([0.0; 3], |bounds| [0, 1, 2].map(|k| 0.5 * (bounds.min[k] + bounds.max[k])));
    let diagonal = bounds.map_or(0.0, |bounds| bounds.diagonal());
    let distance = 1.6 * if diagonal > 0.0 { diagonal } else { 1.0 };
    let eye = [0, 1, 2].map(|k| centre[k] + distance * TOWARDS_EYE[k]);
    Camera::LookAt { eye, look_at: centre, up: [0.0, 0.0, 1.0], fov: 36.0 }
}

/// The flags that decide how rays are traced, but for method, precision and threads, as words of the command line.
pub fn words_of(flags: &Flags) -> String {
    let number = |name: &str, value: Option<f64>| value.map(|value| format!("--{name} {}", Shortest(value)));
    let count = |name: &str, value: Option<u32>| value.map(|value| format!("--{name} {value}"));
    let acceptance = flags.acceptance.and_then(|acceptance| {
        let name = clap::ValueEnum::to_possible_value(&acceptance)?;
        Some(format!("--acceptance {}", name.get_name()))
    });
    let words = [
        acceptance,
        count("newton-iterations", flags.newton_iterations),
        count("newton-starts", flags.newton_starts),
        number("clip-threshold", flags.clip_threshold),
        number("tolerance", flags.tolerance),
        number("flatness", flags.flatness),
        number("grid-density", flags.grid_density),
        flags.skip_invalid.then(|| "--skip-invalid".to_owned()),
    ];
    let limits = flags.limits.iter().map(|(name, value)| format!("--limit {}={value}", name.name()));
    words.into_iter().flatten().chain(limits).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::teapot;
    use crate::scene::trace::Acceptance;
    use crate::settings::bounds::Name;

    #[test]
    fn the_camera_sees_the_whole_model() {
        let model = teapot::model().expect("the fixture is valid");
        let bounds = model.control_box().expect("it has points");
        let view = camera_of(&model).view([64, 64]);
        for corner in 0..8 {
            let point = [0, 1, 2].map(|k| if corner >> k & 1 == 0 { bounds.min[k] } else { bounds.max[k] });
            let off = [0, 1, 2].map(|k| point[k] - view.eye[k]);
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let depth = dot(off, view.forward) / dot(view.forward, view.forward);
            for axis in [view.right, view.up] {
                let across = dot(off, axis) / dot(axis, axis) / depth;
                assert!(depth > 0.0 && across.abs() < 1.0, "corner {corner}: {across}");
            }
        }
    }

    #[test]
    fn flags_are_said_as_they_are_written() {
        let flags = Flags {
            acceptance: Some(Acceptance::Proved),
            newton_starts: Some(2),
            tolerance: Some(1e-9),
            limits: vec![(Name::ClipSteps, 40)],
            ..Flags::default()
        };
        assert_eq!(words_of(&flags), "--acceptance proved --newton-starts 2 --tolerance 1e-9 --limit clip-steps=40");
        assert_eq!(words_of(&Flags::default()), "");
    }
}
