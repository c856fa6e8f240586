//! The paper's four pictures in `fixtures/recorded`: some of their rows are drawn anew.
//!
//! They were recorded from the project's root by the commands that `COMMANDS` are, which the README names. Where a picture is
//! to change, they record it again.

use image::RgbImage;
use patchray_host::drawing::{Drawing, Watch, draw};
use patchray_host::picture::GAVE_UP;
use patchray_host::picture::rows::Rows;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::file;
use patchray_host::scene::trace::Method;
use patchray_host::settings::{Flags, Settings};
use patchray_host::shade::shadows::Shadows;
use patchray_host::viewed::{Viewed, Wishes};
use std::path::Path;
use std::sync::atomic::AtomicBool;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

const NAMES: [&str; 4] = ["teapot", "toruses", "rings", "mirrors"];

/// What records the picture of a scene.
fn command(name: &str) -> String {
    format!(
        "cargo run --release -- render fixtures/scenes/{name}.toml --method newton-predicted -o fixtures/recorded/{name}.png"
    )
}

fn recorded(name: &str) -> RgbImage {
    image::open(format!("{ROOT}/fixtures/recorded/{name}.png")).expect("it is committed").to_rgb8()
}

#[test]
fn the_readme_shows_each_picture_and_its_command() {
    let readme = std::fs::read_to_string(format!("{ROOT}/README.md")).expect("there is a README");
    for name in NAMES {
        assert!(readme.contains(&format!("](fixtures/recorded/{name}.png)")), "README.md does not show {name}");
        assert!(readme.contains(&command(name)), "README.md does not say how {name} is drawn");
        assert_eq!(recorded(name).dimensions(), (1024, 1024));
    }
}

/// Every 64th row, of four rays a pixel and two deep, with shadows: no channel is more than 2 of 255 off, which the last bits of
/// a number may come to, but for so few pixels on silhouettes as a last bit may move.
#[test]
fn rows_drawn_anew_are_the_recorded_ones() {
    for name in NAMES {
        let path = format!("{ROOT}/fixtures/scenes/{name}.toml");
        let scene = file::read(Path::new(&path), OnInvalid::Refuse).expect("it is valid");
        let (description, appearance) = (&scene.description, &scene.appearance);
        let flags = Flags { method: Some(Method::NewtonPredicted), ..Flags::default() };
        let settings = Settings::of_scene(&flags, &description.trace, &scene.source).expect("it is valid");
        let view = description.camera.view(description.image.size).sampled(description.image.samples);
        assert_eq!((view.size, view.sampling.per_pixel()), ([1024; 2], 4), "{name}");
        let mut viewed = Viewed::build(&scene.model, &settings, &view, Wishes::of(appearance)).expect("valid");
        let (tracers, _) = viewed.tracers().expect("it was just made ready");
        let (shadows, _) = Shadows::prepare(&scene.model, appearance, &settings, view.eye, &AtomicBool::new(false))
            .expect("there is memory");
        assert!((0..appearance.lights.len()).all(|light| shadows.casts(light)), "{name}");
        let recorded = recorded(name);
        let mut differ = 0;
        for row in (32..1024).step_by(64) {
            let (tracers, shadows) = (&tracers, &shadows);
            let drawing =
                Drawing { tracers, view: &view, appearance, shadows, rows: Rows::from(row..row + 1), outcomes: false };
            let mut png = Vec::new();
            draw(&drawing, &Watch::default()).picture.write_png(&mut png).expect("memory does not fail");
            let drawn = image::load_from_memory(&png).expect("what was written can be read").to_rgb8();
            assert_eq!(drawn.dimensions(), (1024, 1));
            for (drawn, recorded) in drawn.pixels().zip(recorded.rows().nth(row as usize).expect("a row")) {
                differ += usize::from(drawn.0.iter().zip(recorded.0).any(|(&a, b)| a.abs_diff(b) > 2));
                assert_ne!(drawn.0, GAVE_UP);
            }
        }
        assert!(differ <= 4, "{name}: {differ} pixels");
    }
}
