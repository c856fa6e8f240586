//! The common view drawn by every method and precision, against the picture in `fixtures/recorded`.
//!
//! That picture was recorded by the reference, and only by it, from the project's root:
//! `cargo run --release -- render fixtures/scenes/teapot-common.toml --method clipping --precision f64 -o
//! fixtures/recorded/teapot-common.png`. The test leaves its pictures under `target/golden`, and where one fails
//! a map of the differences beside it.

use clap::ValueEnum;
use patchray_host::channels::Channels;
use patchray_host::channels::difference::Difference;
use patchray_host::channels::read::read;
use patchray_host::drawing::{Drawing, Watch, draw};
use patchray_host::picture::Picture;
use patchray_host::picture::rows::Rows;
use patchray_host::scene::teapot;
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::settings::Settings;
use patchray_host::shade::shadows::NO_SHADOWS;
use patchray_host::viewed::{Viewed, Wishes};
use std::fs::File;
use std::path::Path;

/// A channel may differ by this much: the last bits of t move a shade across a step of 1/255.
const CHANNEL: f64 = 2.0;

/// So many pixels may differ by more: those on a silhouette of which a method loses the nearer of two roots, at most 20.
const PIXELS: u64 = 20;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

#[test]
fn every_method_draws_the_recorded_picture() {
    let recorded = read(&root().join("fixtures/recorded/teapot-common.png")).expect("it is committed");
    let scene = teapot::common_scene().expect("the built-in scene is valid");
    let description = &scene.description;
    let view = description.camera.view(description.image.size);
    for &method in Method::value_variants() {
        for precision in [Precision::F64, Precision::F32] {
            let settings = Settings { method, precision, ..Settings::default() };
            let wishes = Wishes::of(&scene.appearance);
            let mut viewed = Viewed::build(&scene.model, &settings, &view, wishes).expect("the teapot is valid");
            let (tracers, _) = viewed.tracers().expect("it was just made ready");
            let (appearance, shadows) = (&scene.appearance, &NO_SHADOWS);
            let drawing = Drawing {
                tracers: &tracers,
                view: &view,
                appearance,
                shadows,
                rows: Rows::all(view.size[1]),
                outcomes: false,
            };
            let drawn = draw(&drawing, &Watch::default());
            compare(&format!("{method:?}-{precision:?}"), &drawn.picture, &recorded);
        }
    }
}

fn compare(name: &str, drawn: &Picture, recorded: &Channels) {
    let folder = root().join("target/golden");
    std::fs::create_dir_all(&folder).expect("the target folder can be written");
    let path = folder.join(format!("{name}.png"));
    drawn.write_png(&mut File::create(&path).expect("the target folder can be written")).expect("so can its files");
    let drawn = read(&path).expect("what was written can be read");
    let difference = Difference::of(&drawn, recorded, CHANNEL).expect("they are of one size");
    if difference.differing > PIXELS {
        let map = folder.join(format!("{name}-differences.png"));
        let mut file = File::create(&map).expect("the target folder can be written");
        difference.picture(recorded).write_png(&mut file).expect("so can its files");
        panic!("{name}: {} pixels differ; see {}", difference.differing, folder.display());
    }
}
