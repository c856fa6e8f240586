//! Shadows against closed forms: those of spheres, by rays and by maps, and of what lies close to a surface.

use std::sync::atomic::AtomicBool;

use clap::ValueEnum;
use patchray_host::drawing::{Drawing, Watch, draw};
use patchray_host::picture::rows::Rows;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::file::{self, Scene};
use patchray_host::scene::light::{MapOptions, Shadow};
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::settings::Settings;
use patchray_host::shade::map::MapUsed;
use patchray_host::shade::shadows::{Facing, Shadows, Visibility};
use patchray_host::viewed::{Viewed, Wishes};

const RAYS: Shadow = Shadow::Rays;

/// A map of this size, and the default bias.
fn map(size: u32) -> Shadow {
    Shadow::Map(MapOptions { size, ..MapOptions::default() })
}

/// The scene of this text, its first light's shadows found so.
fn scene(text: &str, shadow: Shadow) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("leaf.bpt"), LEAF).expect("written");
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("written");
    let mut scene = file::read(&path, OnInvalid::Refuse).expect("a scene");
    scene.appearance.lights[0].shadow = shadow;
    scene
}

/// A bilinear square of 2 × 2 at z = 1.
const LEAF: &str = "1\n1 1\n-1 -1 1\n-1 1 1\n1 -1 1\n1 1 1\n";

const SIZE: u32 = 160;

/// The red of each pixel, linear, and what maps took.
fn drawn(scene: &Scene, settings: &Settings) -> (Vec<f64>, Vec<MapUsed>) {
    let view = scene.description.camera.view([SIZE, SIZE]);
    let appearance = &scene.appearance;
    let mut viewed = Viewed::build(&scene.model, settings, &view, Wishes::of(appearance)).expect("valid");
    let (tracers, _) = viewed.tracers().expect("it was just made ready");
    let (shadows, maps) = Shadows::prepare(&scene.model, appearance, settings, view.eye, &AtomicBool::new(false))
        .expect("there is memory");
    let drawing = Drawing {
        tracers: &tracers,
        view: &view,
        appearance,
        shadows: &shadows,
        rows: Rows::all(view.size[1]),
        outcomes: false,
    };
    let drawn = draw(&drawing, &Watch::default());
    let mut png = Vec::new();
    drawn.picture.write_png(&mut png).expect("memory does not fail");
    let picture = image::load_from_memory(&png).expect("a picture").to_rgb8();
    let linear = |byte: u8| {
        let part = f64::from(byte) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    };
    (picture.pixels().map(|pixel| linear(pixel.0[0])).collect(), maps)
}

/// A sphere over a floor, seen and lit from two sides. Neither shines by itself or has a highlight.
const SPHERE: &str = "background = [0, 0, 0]\n\
    surfaces = [{ sphere = { radius = 1, exact = true }, transform = [{ translate = [0.2, -0.1, 2] }] }]\n\
    polygons = [{ vertices = [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]] }]\n\
    camera = { eye = [-5, -4, 7], look_at = [-0.8, -0.5, 0.6], fov = 42 }\n\
    light = { position = [4, 2, 7] }\n\
    material = { colour = [1, 1, 1], ambient = 0, diffuse = 1, highlight = 0 }\n";

const CENTRE: [f64; 3] = [0.2, -0.1, 2.0];
const LIGHT: [f64; 3] = [4.0, 2.0, 7.0];

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// How near the way from `a` to `b` comes to `centre`.
fn distance(centre: [f64; 3], a: [f64; 3], b: [f64; 3]) -> f64 {
    let (way, to) = (less(b, a), less(centre, a));
    let t = (dot(way, to) / dot(way, way)).clamp(0.0, 1.0);
    let off = [0, 1, 2].map(|k| to[k] - t * way[k]);
    dot(off, off).sqrt()
}

/// For each pixel that sees the floor how far from the sphere's middle the light passes on its way there.
fn floor(scene: &Scene) -> Vec<Option<f64>> {
    let view = scene.description.camera.view([SIZE, SIZE]);
    let pixel = |index: u32| {
        let direction = view.direction(index % SIZE, index / SIZE);
        let t = -view.eye[2] / direction[2];
        let point = [0, 1, 2].map(|k| view.eye[k] + t * direction[k]);
        let sees = t > 0.0 && point.iter().all(|c| c.abs() < 9.0) && distance(CENTRE, view.eye, point) > 1.0;
        sees.then(|| distance(CENTRE, LIGHT, point))
    };
    (0..SIZE * SIZE).map(pixel).collect()
}

/// The settings of each method and precision.
fn all_settings() -> impl Iterator<Item = Settings> {
    Method::value_variants().iter().flat_map(|&method| {
        Precision::value_variants().iter().map(move |&precision| Settings { method, precision, ..Settings::default() })
    })
}

/// The pixels of the floor whose share of the light is wrong by more than half, `off` pixels whose light passes the sphere
/// nearer to its edge than that left out; and how many are dark.
fn wrong(scene: &Scene, settings: &Settings, unshadowed: &[f64], off: f64) -> (usize, usize) {
    let (found, _) = drawn(scene, settings);
    let (mut wrong, mut dark) = (0, 0);
    for ((passes, found), full) in floor(scene).into_iter().zip(found).zip(unshadowed) {
        let Some(passes) = passes else { continue };
        let lit = passes > 1.0;
        dark += usize::from(!lit);
        wrong += usize::from((found / full > 0.5) != lit && (passes - 1.0).abs() > off);
    }
    (wrong, dark)
}

#[test]
fn the_shadow_of_a_sphere_on_a_floor_is_the_cones() {
    let (unshadowed, _) = drawn(&scene(SPHERE, Shadow::None), &Settings::default());
    for settings in all_settings() {
        // Rays are right but for rounding.
        let off = if settings.precision == Precision::F64 { 1e-9 } else { 1e-4 };
        let (wrong_by_rays, dark) = wrong(&scene(SPHERE, RAYS), &settings, &unshadowed, off);
        assert_eq!(wrong_by_rays, 0, "{settings:?}");
        assert!(dark > 1500, "{dark}");
        // A map is right but for what is as near to the edge as a texel is wide: seen from the light, 6.5 away, the sphere
        // fills it, so that 256 texels are a bit more than 2 wide.
        for (size, near) in [(64, 100), (256, 50)] {
            let texel = 2.2 / f64::from(size);
            let of_map = scene(SPHERE, map(size));
            let (wrong_by_map, _) = wrong(&of_map, &settings, &unshadowed, texel);
            assert_eq!(wrong_by_map, 0, "{size} {settings:?}");
            let (near_the_edge, _) = wrong(&of_map, &settings, &unshadowed, 0.0);
            assert!(near_the_edge < near, "{near_the_edge} {size} {settings:?}");
        }
    }
}

/// In 32 bits the depths of a scene are all one to a light a hundred thousand times its size away: maps of it darkened what
/// is lit, in rings, and the larger the map the more. A thousand times farther still they saw no shadow at all.
#[test]
fn the_map_of_a_light_far_off_is_right_to_a_texel() {
    for far in [1e2, 1e5, 1e8, 1e11] {
        let place = format!("position = [{}, {}, {}]", 4.0 * far, 2.0 * far, 7.0 * far);
        let text = SPHERE.replace("position = [4, 2, 7]", &place);
        let (by_rays, _) = drawn(&scene(&text, RAYS), &Settings::default());
        for (size, off_edge) in [(128, 90), (1024, 20)] {
            let (by_map, maps) = drawn(&scene(&text, map(size)), &Settings::default());
            assert_eq!(maps[0].faces, 1);
            let differ = by_map.iter().zip(&by_rays).filter(|(a, b)| (**a - **b).abs() > 0.1).count();
            assert!(differ < off_edge, "{differ} pixels of {} at {far:e}, {size} texels wide", by_map.len());
        }
    }
}

/// The sphere without the floor.
fn alone() -> String {
    SPHERE.lines().filter(|line| !line.starts_with("polygons")).map(|line| format!("{line}\n")).collect()
}

/// What is convex does not darken itself, and what is not lit is dark without.
#[test]
fn no_sphere_is_specked_by_its_own_shadow() {
    let alone = alone();
    // From where the sphere's dark half is seen as well, and along the edge between the halves.
    for eye in ["-5, -4, 7", "5, -5, 0"] {
        let alone = alone.replace(
            "eye = [-5, -4, 7], look_at = [-0.8, -0.5, 0.6]",
            &format!("eye = [{eye}], look_at = [0.2, -0.1, 2]"),
        );
        for settings in all_settings() {
            let (unshadowed, _) = drawn(&scene(&alone, Shadow::None), &settings);
            let (by_rays, _) = drawn(&scene(&alone, RAYS), &settings);
            assert!(by_rays == unshadowed, "{eye} {settings:?}");
            // At the edge of what is lit a map may take away what is left of the light there.
            for (size, least) in [(100, 0.08), (400, 0.04)] {
                let (by_map, maps) = drawn(&scene(&alone, map(size)), &settings);
                assert_eq!((maps[0].faces, maps[0].rays), (1, u64::from(size * size)));
                let most = by_map.iter().zip(&unshadowed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(most < least, "{most} {size} {eye} {settings:?}");
            }
        }
    }
}

/// The control of the test above: held against a map without being raised, a sphere is specked.
#[test]
fn a_map_without_bias_specks_a_sphere() {
    let unbiased = Shadow::Map(MapOptions { size: 400, bias: 0.0 });
    let (unshadowed, _) = drawn(&scene(&alone(), Shadow::None), &Settings::default());
    let (by_map, _) = drawn(&scene(&alone(), unbiased), &Settings::default());
    let specks = by_map.iter().zip(&unshadowed).filter(|(a, b)| **b > 0.5 && *a + 0.1 < **b).count();
    assert!(specks > 100, "{specks}");
}

/// Ctrl-C once waited for maps, which of many lights may take longer than the picture.
#[test]
fn maps_heed_a_stop() {
    let scene = scene(SPHERE, Shadow::Map(MapOptions { size: 64, bias: 1.0 }));
    let rays = |stop: bool| {
        let (settings, eye) = (Settings::default(), scene.description.camera.view([8, 8]).eye);
        let prepared = Shadows::prepare(&scene.model, &scene.appearance, &settings, eye, &AtomicBool::new(stop));
        prepared.expect("there is memory").1.iter().map(|map| map.rays).sum::<u64>()
    };
    assert_eq!((rays(false), rays(true)), (64 * 64, 0));
}

/// The shares of the first light that arrive at these points, each with its normal.
fn shares(scene: &Scene, settings: &Settings, points: &[[[f64; 3]; 2]]) -> (Vec<Option<f64>>, Vec<MapUsed>) {
    let (appearance, view) = (&scene.appearance, scene.description.camera.view([8, 8]));
    let mut viewed = Viewed::build(&scene.model, settings, &view, Wishes::of(appearance)).expect("valid");
    let (tracers, _) = viewed.tracers().expect("it was just made ready");
    let (shadows, maps) = Shadows::prepare(&scene.model, appearance, settings, view.eye, &AtomicBool::new(false))
        .expect("there is memory");
    let light = appearance.lights[0].position.expect("it has a place");
    let mut visibility = Visibility::new(&shadows, &appearance.polygons, points.len(), 1);
    for (index, &[point, normal]) in points.iter().enumerate() {
        let way = less(light, point);
        let cosine = dot(way, normal) / dot(way, way).sqrt();
        visibility.ask([index, 0], &Facing { point, normal, light, cosine }, view.eye);
    }
    let mut lane = tracers.any.as_ref().map(|any| any.lane());
    visibility.trace(lane.as_mut().map(|lane| &mut **lane as &mut dyn patchray_host::scanline::Lane));
    ((0..points.len()).map(|k| visibility.of_point(k)[0]).collect(), maps)
}

/// A leaf at z = 1 under a light that stands askew, and polygons far below it.
const UNDER: &str = "surfaces = [{ file = 'leaf.bpt' }]\n\
    polygons = [{ vertices = [[3, -1, 1], [5, -1, 1], [5, 1, 1], [3, 1, 1]] }]\n\
    camera = { eye = [-5, -4, 7], look_at = [0, 0, 0] }\nlight = { position = [4, 3, 6] }\n";

#[test]
fn what_lies_close_to_a_surface_darkens_it() {
    let up = [0.0, 0.0, 1.0];
    for settings in all_settings() {
        let gap = if settings.precision == Precision::F64 { 1e-9 } else { 1e-3 };
        for x in [0.3, 4.3] {
            // Below and on the surface, or the polygon, and beside them.
            let points = [[x, 0.2, 1.0 - gap], [x, 0.2, 1.0], [x, 0.2, 1.0 + gap], [x, 1.5, 1.0 - gap]];
            let (by_rays, maps) = shares(&scene(UNDER, RAYS), &settings, &points.map(|point| [point, up]));
            assert_eq!(by_rays, [0.0, 1.0, 1.0, 1.0].map(Some), "{x} {settings:?}");
            assert!(maps.is_empty());
        }
        // A map tells apart what is twice as far as a surface is raised: of 512 texels, each a bit more than 2 / 512 wide.
        let points = [0.98, 0.995, 1.0, 1.01].map(|z| [[0.3, 0.2, z], up]);
        let (by_map, _) = shares(&scene(UNDER, map(512)), &settings, &points);
        assert_eq!(by_map, [0.0, 0.0, 1.0, 1.0].map(Some), "{settings:?}");
    }
}

/// A small sphere between the light and the large one around both.
const AROUND: &str = "surfaces = [\n\
    { sphere = { radius = 5, exact = true } },\n\
    { sphere = { radius = 0.6, exact = true }, transform = [{ translate = [1.5, 0.8, -0.4] }] },\n]\n\
    camera = { eye = [-3, 0, 0], look_at = [0, 0, 0] }\nlight = { position = [0.1, 0.2, 0.3] }\n";

#[test]
fn a_light_among_surfaces_has_a_map_of_six_faces() {
    let (small, light) = ([1.5, 0.8, -0.4], [0.1, 0.2, 0.3]);
    // Points all around, and more about the middle of the shadow; the golden angle sets them apart.
    let around = |k: u32| {
        let (z, angle) = (1.0 - (f64::from(k) + 0.5) / 1000.0, f64::from(k) * 2.399_963);
        let wide = (1.0 - z * z).sqrt();
        [wide * angle.cos(), wide * angle.sin(), z]
    };
    let points: Vec<_> = (0..2000).map(|k| (around(k).map(|c| 5.0 * c), around(k).map(|c| -c))).collect();
    let truth: Vec<_> = points.iter().map(|&(point, _)| distance(small, light, point)).collect();
    let points: Vec<_> = points.into_iter().map(|(point, normal)| [point, normal]).collect();
    for settings in all_settings() {
        let (by_rays, _) = shares(&scene(AROUND, RAYS), &settings, &points);
        let (by_map, maps) = shares(&scene(AROUND, map(256)), &settings, &points);
        assert_eq!((maps[0].faces, maps[0].rays, maps[0].gave_up), (6, 6 * 256 * 256, 0));
        let mut dark = 0;
        for ((rays, map), passes) in by_rays.iter().zip(&by_map).zip(&truth) {
            let lit = *passes > 0.6;
            dark += usize::from(!lit);
            let (rays, map) = (rays.expect("told"), map.expect("told"));
            assert!((rays > 0.5) == lit || (passes - 0.6).abs() < 1e-4, "{passes} {settings:?}");
            // A texel is 2 / 256 of the distance wide.
            assert!((map > 0.5) == lit || (passes - 0.6).abs() < 0.02, "{map} {passes} {settings:?}");
            assert!(map == f64::from(u8::from(lit)) || (passes - 0.6).abs() < 0.04, "{map} {passes} {settings:?}");
        }
        assert!(dark > 40, "{dark}");
    }
}

/// Beyond eight times the scene's size the kernel has no view.
#[test]
fn a_light_far_away_has_a_map_drawn_ray_by_ray() {
    let far = SPHERE.replace("light = { position = [4, 2, 7] }", "light = { position = [0.2, -0.1, 900] }");
    let points: Vec<_> = (1..100).map(|k| [[0.2 + 0.02 * f64::from(k), -0.1, 0.0], [0.0, 0.0, 1.0]]).collect();
    for settings in all_settings().filter(|settings| settings.precision == Precision::F64) {
        let (by_map, maps) = shares(&scene(&far, map(200)), &settings, &points);
        assert_eq!((maps[0].faces, maps[0].method), (1, settings.method.of_any_rays()));
        for (share, [[x, ..], _]) in by_map.iter().zip(&points) {
            let radius = x - 0.2;
            assert!(*share == Some(f64::from(u8::from(radius > 1.0))) || (radius - 1.0).abs() < 0.03, "{radius}");
        }
    }
}
