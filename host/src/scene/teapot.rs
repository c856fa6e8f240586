//! The common teapot: Newell's, with bottom, built in so that it can be drawn without any file.
use std::path::PathBuf;

use super::bpt;
use super::error::{InputError, OnInvalid};
use super::file::{self, Scene};
use super::model::Model;
use super::patches::PatchFile;
use super::source::SourceText;

/// The patch file `fixtures/patches/teapot.bpt`.
pub const PATCHES: &str = include_str!("../../../fixtures/patches/teapot.bpt");

/// The scene file `fixtures/scenes/teapot-common.toml`.
pub const COMMON_SCENE: &str = include_str!("../../../fixtures/scenes/teapot-common.toml");

/// The 32 bicubic surfaces: rim, body, handle, spout, lid, bottom; z up, its own box [-3, 3.434075] × [-2, 2] × [0, 3.15].
///
/// # Errors
/// None, as long as the fixture is whole.
pub fn model() -> Result<Model, InputError> {
    Ok(patches()?.model)
}

/// The teapot in the common view, as the scene file would be read.
///
/// # Errors
/// None, as long as the fixtures are whole.
pub fn common_scene() -> Result<Scene, InputError> {
    let source = SourceText::new("teapot-common.toml", COMMON_SCENE);
    file::load(source, |_| Ok((PathBuf::from("teapot.bpt"), patches()?)))
}

fn patches() -> Result<PatchFile, InputError> {
    bpt::parse("teapot.bpt", PATCHES, OnInvalid::Refuse)
}

#[cfg(test)]
mod tests {
    use super::super::model::{ControlBox, ModelSurface};
    use super::*;

    fn teapot() -> Model {
        model().expect("the fixture is valid")
    }

    /// The Bernstein polynomials of degree 3.
    fn bernstein(t: f64) -> [f64; 4] {
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    }

    fn evaluate(surface: &ModelSurface, u: f64, v: f64, axis: usize) -> f64 {
        let (bu, bv) = (bernstein(u), bernstein(v));
        (0..16).map(|k| bu[k / 4] * bv[k % 4] * surface.points[k][axis]).sum()
    }

    /// The largest of `sign` × coordinate on the surface: the best of a grid, refined by ever smaller grids around it.
    fn extreme(surface: &ModelSurface, axis: usize, sign: f64) -> f64 {
        const STEPS: i32 = 8;
        let (mut best, mut at, mut half) = (f64::NEG_INFINITY, (0.5, 0.5), 0.5);
        for _ in 0..30 {
            let centre = at;
            for i in -STEPS..=STEPS {
                for j in -STEPS..=STEPS {
                    let u = (centre.0 + half * f64::from(i) / f64::from(STEPS)).clamp(0.0, 1.0);
                    let v = (centre.1 + half * f64::from(j) / f64::from(STEPS)).clamp(0.0, 1.0);
                    let value = sign * evaluate(surface, u, v, axis);
                    if value > best {
                        (best, at) = (value, (u, v));
                    }
                }
            }
            half *= 0.5;
        }
        best
    }

    #[test]
    fn thirty_two_bicubic_surfaces() {
        let model = teapot();
        assert_eq!(model.surfaces.len(), 32);
        for (number, surface) in model.surfaces.iter().enumerate() {
            assert_eq!((surface.number, surface.degree_u, surface.degree_v), (number, 3, 3));
            assert!(!surface.rational);
        }
    }

    #[test]
    fn box_of_the_control_points() {
        let control_box = teapot().control_box().expect("it has points");
        assert_eq!(control_box.min, [-3.0, -2.0, 0.0]);
        assert_eq!(control_box.max, [3.525, 2.0, 3.15]);
        assert!((control_box.diagonal() - 8.276359).abs() < 5e-7);
    }

    #[test]
    fn box_of_the_surface() {
        let model = teapot();
        let most = |axis: usize, sign: f64| {
            let extremes = model.surfaces.iter().map(|surface| extreme(surface, axis, sign));
            sign * extremes.fold(f64::NEG_INFINITY, f64::max)
        };
        let own =
            ControlBox { min: [0, 1, 2].map(|axis| most(axis, -1.0)), max: [0, 1, 2].map(|axis| most(axis, 1.0)) };
        for (found, stated) in own.min.iter().zip([-3.0, -2.0, 0.0]) {
            assert!((found - stated).abs() < 1e-12, "{own:?}");
        }
        for (found, (stated, digits)) in own.max.iter().zip([(3.434075, 5e-7), (2.0, 1e-12), (3.15, 1e-12)]) {
            assert!((found - stated).abs() < digits, "{own:?}");
        }
        // The spout's tip is the cubic with x = 3.3, 3.525, 3.45, 3.2, highest where 0.225 - 0.6 t + 0.125 t² = 0.
        let t = (0.6 - (0.36_f64 - 0.1125).sqrt()) / 0.25;
        let tip: f64 = bernstein(t).iter().zip([3.3, 3.525, 3.45, 3.2]).map(|(b, x)| b * x).sum();
        assert!((own.max[0] - tip).abs() < 1e-12, "{own:?}");
        assert!((own.diagonal() - 8.2048657954).abs() < 5e-11, "{}", own.diagonal());
    }

    #[test]
    fn common_view_is_exact_in_f32() {
        let scene = common_scene().expect("the fixtures are valid");
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/scenes/teapot-common.toml");
        let from_disk = file::read(path.as_ref(), OnInvalid::Refuse).expect("the fixtures are valid");
        assert_eq!((&scene.description, &scene.model), (&from_disk.description, &from_disk.model));

        let view = scene.description.camera.view(scene.description.image.size);
        let exact = |vector: [f64; 3]| vector.iter().all(|&x| f64::from(x as f32) == x);
        assert_eq!(view.eye, [7.6171875, -9.3203125, 7.59375]);
        assert!(exact(view.eye));
        for (px, py) in (0..512).flat_map(|py| (0..512).map(move |px| (px, py))) {
            let direction = view.direction(px, py);
            let sx = (2.0 * f64::from(px) - 511.0) / 512.0;
            let sy = (511.0 - 2.0 * f64::from(py)) / 512.0;
            let stated =
                [24.75 * -9.0 + sx * 68.0 + sy * -24.0, 24.75 * 12.0 + sx * 51.0 + sy * 32.0, 24.75 * -8.0 + sy * 75.0];
            assert_eq!(direction, stated);
            assert!(exact(direction), "{px} {py}");
        }
    }

    #[test]
    fn eight_collapsed_edges() {
        let collapsed = |surface: &ModelSurface| {
            let corner = |i: usize, j: usize| surface.points[4 * i + j];
            let edges = [
                [corner(0, 0), corner(0, 1), corner(0, 2), corner(0, 3)],
                [corner(3, 0), corner(3, 1), corner(3, 2), corner(3, 3)],
                [corner(0, 0), corner(1, 0), corner(2, 0), corner(3, 0)],
                [corner(0, 3), corner(1, 3), corner(2, 3), corner(3, 3)],
            ];
            edges.iter().any(|edge| edge.iter().all(|point| point == &edge[0]))
        };
        let numbers: Vec<_> = teapot().surfaces.iter().filter(|&s| collapsed(s)).map(|s| s.number).collect();
        assert_eq!(numbers, [20, 21, 22, 23, 28, 29, 30, 31]);
    }
}
