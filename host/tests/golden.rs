//! The common view drawn by every method and precision, against the picture in `fixtures/recorded`.
//!
//! That picture was recorded by the reference, and only by it, from the project's root:
//! `cargo run --release -- render fixtures/scenes/teapot-common.toml --method clipping --precision f64 -o
//! fixtures/recorded/teapot-common.png`. Where a test fails it leaves the picture and a map of the differences under
//! `target/golden`.

use clap::ValueEnum;
use image::RgbImage;
use patchray_host::drawing::{Drawing, Watch, draw};
use patchray_host::picture::rows::Rows;
use patchray_host::scene::teapot;
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::settings::Settings;
use patchray_host::shade::shadows::NO_SHADOWS;
use patchray_host::viewed::{Viewed, Wishes};
use std::path::Path;

/// A channel may differ by this much: the last bits of t move a shade across a step of 1/255.
const CHANNEL: u8 = 2;

/// So many pixels may differ by more: those on a silhouette of which a method loses the nearer of two roots, at most 20.
const PIXELS: usize = 20;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

#[test]
fn every_method_draws_the_recorded_picture() {
    let recorded = image::open(root().join("fixtures/recorded/teapot-common.png")).expect("it is committed").to_rgb8();
    let scene = teapot::common_scene().expect("the built-in scene is valid");
    let description = &scene.description;
    let view = description.camera.view(description.image.size);
    for &method in Method::value_variants() {
        for precision in [Precision::F64, Precision::F32] {
            let settings = Settings { method, precision, ..Settings::default() };
            let wishes = Wishes::of(&scene.appearance);
            let mut viewed = Viewed::build(&scene.model, &settings, &view, wishes).expect("the teapot is valid");
            assert!(viewed.has_view());
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
            let mut png = Vec::new();
            drawn.picture.write_png(&mut png).expect("memory does not fail");
            let drawn = image::load_from_memory(&png).expect("what was written can be read").to_rgb8();
            compare(&format!("{method:?}-{precision:?}"), &drawn, &recorded);
        }
    }
}

fn compare(name: &str, drawn: &RgbImage, recorded: &RgbImage) {
    assert_eq!(drawn.dimensions(), recorded.dimensions(), "{name}");
    let far = |a: u8, b: u8| a.abs_diff(b) > CHANNEL;
    let differs = |x, y| drawn.get_pixel(x, y).0.iter().zip(recorded.get_pixel(x, y).0).any(|(&a, b)| far(a, b));
    let (width, height) = drawn.dimensions();
    let count = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| differs(x, y)).count();
    if count <= PIXELS {
        return;
    }
    let folder = root().join("target/golden");
    std::fs::create_dir_all(&folder).expect("the target folder can be written");
    drawn.save(folder.join(format!("{name}.png"))).expect("the target folder can be written");
    let map = RgbImage::from_fn(width, height, |x, y| {
        let shade = recorded.get_pixel(x, y).0.map(|c| c / 4);
        image::Rgb(if differs(x, y) { [255, 0, 255] } else { shade })
    });
    map.save(folder.join(format!("{name}-differences.png"))).expect("the target folder can be written");
    panic!("{name}: {count} pixels differ; see {}", folder.display());
}
