//! Light neither gained nor lost: pictures of one sphere in a world that is lit evenly, by colours and by nine samples of the
//! spectrum.

use patchray_host::drawing::{Drawing, Drawn, Watch, draw};
use patchray_host::picture::encode;
use patchray_host::picture::rows::Rows;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::file;
use patchray_host::settings::Settings;
use patchray_host::shade::shadows::NO_SHADOWS;
use patchray_host::viewed::{Viewed, Wishes};

const SIZE: u32 = 48;

/// The picture of a sphere of this material under no lights, and all its pixels; `more` is added to the scene file.
fn sphere(background: [f64; 3], material: &str, more: &str) -> (Drawn, Vec<[u8; 3]>) {
    let text = format!(
        "background = {background:?}\nlights = []\nsurfaces = [{{ sphere = {{ radius = 1, exact = true }} }}{more}]\n\
         camera = {{ eye = [4, -2, 1], look_at = [0, 0, 0], fov = 35 }}\n[material]\n{material}\n\
         [materials.metal]\nmetal = \"silver\"\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("written");
    let scene = file::read(&path, OnInvalid::Refuse).expect("a scene");
    let view = scene.description.camera.view([SIZE, SIZE]);
    let wishes = Wishes::of(&scene.appearance);
    let mut viewed = Viewed::build(&scene.model, &Settings::default(), &view, wishes).expect("a sphere is valid");
    let (tracers, _) = viewed.tracers().expect("it was just made ready");
    let (appearance, shadows) = (&scene.appearance, &NO_SHADOWS);
    let drawing =
        Drawing { tracers: &tracers, view: &view, appearance, shadows, rows: Rows::all(view.size[1]), outcomes: false };
    let drawn = draw(&drawing, &Watch::default());
    assert!(drawn.tally.hits > u64::from(SIZE * SIZE) / 3, "{} hits", drawn.tally.hits);
    let mut png = Vec::new();
    drawn.picture.write_png(&mut png).expect("memory does not fail");
    let pixels = image::load_from_memory(&png).expect("a picture").to_rgb8().pixels().map(|pixel| pixel.0).collect();
    (drawn, pixels)
}

/// A ball of silver behind the camera, for which the scene's light is counted in nine samples.
const SILVER: &str =
    ", { sphere = { radius = 0.1 }, transform = [{ translate = [40, -20, 10] }], material = \"metal\" }";

#[test]
fn what_returns_all_light_cannot_be_told_from_the_background() {
    let (grey, orange, white) = ([0.5; 3], [0.8, 0.4, 0.1], [1.0; 3]);
    let matt = "colour = [1, 1, 1]\nambient = 1\ndiffuse = 0";
    for (background, material) in [(grey, "reflect = 1"), (orange, "reflect = 1"), (white, matt)] {
        for (more, samples) in [("", 3), (SILVER, 9)] {
            let (drawn, pixels) = sphere(background, material, more);
            assert_eq!(drawn.light_samples, samples);
            let expected = encode(background);
            let other = pixels.iter().find(|pixel| **pixel != expected);
            assert_eq!(other, None, "{material} in {samples} samples before {background:?}, which is {expected:?}");
        }
    }
}

/// The luminance of a pixel, 0 to 1.
fn luminance(pixel: [u8; 3]) -> f64 {
    let linear = pixel.map(|byte| {
        let part = f64::from(byte) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    });
    0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
}

#[test]
fn no_metal_returns_more_than_it_gets() {
    let background = [0.5; 3];
    let around = luminance(encode(background));
    // At normal incidence, from the tables: (n, k) at 555 nm about (0.4, 2.55), (1.0, 2.6), (0.06, 3.6) and (1.0, 6.7).
    for (metal, darkest) in [("gold", 0.7), ("copper", 0.6), ("silver", 0.95), ("aluminium", 0.8)] {
        let (drawn, pixels) = sphere(background, &format!("metal = \"{metal}\""), SILVER);
        assert_eq!((drawn.light_samples, drawn.rays.camera), (9, u64::from(SIZE * SIZE)));
        assert_eq!(drawn.rays.mirrored, drawn.tally.hits);
        let shares: Vec<f64> = pixels.iter().map(|&pixel| luminance(pixel) / around).collect();
        // A channel in 8 bits is within half of 1/255, here 0.7 % of its light.
        assert!(shares.iter().all(|share| (darkest - 0.01..=1.007).contains(share)), "{metal}");
        let middle = shares[(SIZE * SIZE / 2 + SIZE / 2) as usize];
        assert!(middle < 0.99 && shares[0] > 0.999, "{metal} returns {middle}");
    }
}
