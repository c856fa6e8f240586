//! Channels of a picture, heat maps, and what differs between pictures.

use std::io::Cursor;

use patchray_host::channels::{Channels, Values, read, seen};

use super::{Folder, printed, said};

fn channels(folder: &Folder, name: &str) -> Channels {
    read::read(&folder.path(name)).expect("it was written")
}

fn counts<'c>(channels: &'c Channels, name: &str) -> &'c [u32] {
    match &channels.named(name).expect("it is there").values {
        Values::Count(all) => all,
        Values::Real(_) => panic!("{name} counts"),
    }
}

#[test]
fn channels_say_what_statistics_do() {
    let folder = Folder::new();
    for method in
        ["newton", "newton-coherent", "newton-predicted", "clipping", "clipping-coherent", "clipping-predicted"]
    {
        folder.done(&format!("render scene.toml --method {method} --aov a.exr --stats a.json -o a.png"));
        let (channels, stats) = (channels(&folder, "a.exr"), folder.json("a.json"));
        assert_eq!(channels.size, [64, 48]);
        let sum = |name| counts(&channels, name).iter().map(|&count| u64::from(count)).sum::<u64>();
        for name in ["newton_steps", "newton_starts", "clip_steps", "bisections", "patches_tested"] {
            assert_eq!(Some(sum(name)), stats[name].as_u64(), "{method} {name}");
        }
        let (status, surface) = (counts(&channels, "status"), counts(&channels, "surface"));
        let hits = status.iter().filter(|&&status| status == 1 || status == 2).count() as u64;
        assert_eq!(Some(hits), stats["hit_rays"].as_u64(), "{method}");
        let has_patches = stats["patches"].as_u64() > Some(0);
        assert_eq!(channels.named("patch").is_some(), has_patches, "{method}");
        for pixel in 0..channels.pixels() {
            let hit = [1, 2].contains(&status[pixel]);
            assert_eq!(surface[pixel] < 32, hit);
            assert_eq!(surface[pixel] == seen::NONE, !hit);
            let measure = |name| channels.named(name).expect("it is there").values.get(pixel);
            assert_eq!(measure("Z").is_finite(), hit);
            for name in ["P.X", "N.Z", "u", "residual"] {
                assert_eq!(measure(name).is_nan(), !hit, "{method} {name}");
            }
            if hit {
                assert!(measure("residual") < 1e-11, "{method} {}", measure("residual"));
                let eye = [7.6171875, -9.3203125, 7.59375];
                let point = ["P.X", "P.Y", "P.Z"].map(measure);
                let distance = (0..3).map(|k| (point[k] - eye[k]).powi(2)).sum::<f64>().sqrt();
                assert!((distance - measure("Z")).abs() < 1e-5);
                if has_patches {
                    assert!(u64::from(counts(&channels, "patch")[pixel]) < stats["patches"].as_u64().expect("a count"));
                }
            }
        }
    }
}

#[test]
fn a_heat_map_has_its_legend() {
    let folder = Folder::new();
    folder.done("render scene.toml --aov clip_steps=heat.png --aov path=path.png --aov all.exr -o a.png");
    assert_eq!(channels(&folder, "heat.png").size, [420, 48 + 36]);
    // Its codes take more than a line.
    let [width, height] = channels(&folder, "path.png").size;
    assert!(width == 420 && [48 + 48, 48 + 60].contains(&height), "{width} x {height}");
    folder.fails("render scene.toml --aov u=all.exr -o b.png", 2, &["u=FILE.png for `u` as a heat map"]);
    folder.fails("render scene.toml --aov steps=b.png -o b.png", 2, &["no channel `steps`", "newton_steps"]);
    folder.fails("render scene.toml --aov u=b.png -o b.png", 2, &["-o and --aov name the same file"]);
    folder.fails("render scene.toml --method clipping --aov patch=p.png -o b.png", 2, &["no channel `patch`"]);
}

#[test]
fn differences_are_told() {
    let folder = Folder::new();
    folder.done("render scene.toml -o a.png --aov a.exr");
    folder.done("render scene.toml -o b.png --aov b.exr --method newton-predicted --threads 2");
    for same in ["diff a.png a.png", "diff a.exr a.exr", "diff a.png b.png --tolerance 2"] {
        assert!(printed(&folder.done(same)).ends_with("0 of 3072 pixels differ\n"), "{same}");
    }
    assert!(printed(&folder.done("diff a.png a.png -q")).is_empty());
    let output = folder.run("diff a.exr b.exr");
    assert_eq!(output.status.code(), Some(1));
    assert!(printed(&output).contains(" of 3072 pixels differ\n") && said(&output).is_empty(), "{}", said(&output));
    let output = folder.run("diff a.exr b.exr --json");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((output.status.code(), &json["only_in_second"][0]), (Some(1), &"patch".into()));
    folder.done("render scene.toml --size 64x47 -o c.png");
    folder.fails("diff a.png c.png", 1, &["64 x 48", "64 x 47"]);
    folder.fails("diff a.png scene.toml", 3, &["scene.toml", "neither OpenEXR nor a PNG"]);
    folder.fails("diff a.png none.png", 3, &["none.png"]);
    folder.fails("diff a.png b.png --tolerance nan", 2, &["finite"]);
    folder.fails("diff a.png b.png -o a.png", 2, &["would replace an input"]);
    for quiet in ["diff a.png c.png -q", "diff a.exr b.exr -q"] {
        let output = folder.run(quiet);
        assert_eq!((output.status.code(), printed(&output) + &said(&output)), (Some(1), String::new()));
    }
    let marked = folder.run("diff a.png b.exr -o marked.png");
    assert_eq!(marked.status.code(), Some(1));
    let shown = std::fs::read(folder.path("marked.png")).expect("it was written");
    assert!(image::load(Cursor::new(shown), image::ImageFormat::Png).is_ok());
}

/// What the OpenEXR project's own package for Python says of a file; nothing where it is not installed.
fn as_open_exr(folder: &Folder) -> Option<serde_json::Value> {
    const SCRIPT: &str = "\
import json, numpy, OpenEXR
with OpenEXR.File('a.exr', separate_channels=True) as file:
    channels = {name: channel.pixels for name, channel in file.channels().items()}
print(json.dumps({
    'shape': list(channels['Z'].shape),
    'types': {name: str(pixels.dtype) for name, pixels in channels.items()},
    'steps': int(channels['newton_steps'].sum()),
    'hits': int(numpy.isfinite(channels['Z']).sum()),
    'highest': float(numpy.nanmax(channels['P.Z'])),
    'surface': int(channels['surface'][30, 32]),
}))";
    let python = std::env::var_os("PYTHON").unwrap_or("python3".into());
    let run = |script: &str| {
        std::process::Command::new(&python).args(["-c", script]).current_dir(folder.path("")).output().ok()
    };
    if !run("import numpy, OpenEXR")?.status.success() {
        return None;
    }
    let output = run(SCRIPT)?;
    assert!(output.status.success(), "{}", super::said(&output));
    serde_json::from_slice(&output.stdout).ok()
}

#[test]
fn open_exr_reads_the_channels() {
    let folder = Folder::new();
    folder.done("render scene.toml --method newton --aov a.exr --stats a.json -o a.png");
    let (Some(python), stats) = (as_open_exr(&folder), folder.json("a.json")) else {
        println!("not asked: python3 has no package OpenEXR");
        return;
    };
    let own = channels(&folder, "a.exr");
    assert_eq!(python["shape"], serde_json::json!([48, 64]));
    assert_eq!((&python["steps"], &python["hits"]), (&stats["newton_steps"], &stats["hit_rays"]));
    assert_eq!(python["surface"].as_u64(), Some(u64::from(counts(&own, "surface")[30 * 64 + 32])));
    let types = python["types"].as_object().expect("by name");
    let mut names: Vec<&str> = own.all.iter().map(|channel| channel.name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(types.keys().map(String::as_str).collect::<Vec<_>>(), names);
    for channel in &own.all {
        let dtype = if matches!(channel.values, Values::Real(_)) { "float32" } else { "uint32" };
        assert_eq!(types[&channel.name], dtype, "{}", channel.name);
    }
    // The teapot's lid is 3.15 high.
    let highest = python["highest"].as_f64().expect("a number");
    assert!((3.0..3.16).contains(&highest), "{highest}");
}

#[test]
fn a_pixel_tells_its_story() {
    let folder = Folder::new();
    let short = printed(&folder.done("render scene.toml --method newton --pixel 32,30"));
    assert!(
        short.starts_with("pixel 32,30, by newton in f64:\nit meets surface ") && short.lines().count() == 3,
        "{short}"
    );
    let long = printed(&folder.done("render scene.toml --method newton --pixel 32,30 --explain"));
    for part in ["the ray starts at", "(teapot.bpt):", "Newton's method from", "step 1:", "a root at", "counted: "] {
        assert!(long.contains(part), "{part} is not in\n{long}");
    }
    assert!(printed(&folder.done("render scene.toml --pixel 0,0 --explain")).contains("it meets nothing"));
    for flag in ["-o a.png", "--stats a.json", "--json"] {
        folder.fails(&format!("render scene.toml --pixel 0,0 {flag}"), 2, &["leave out -o, --stats and --json"]);
    }
    let samples = printed(&folder.done("render scene.toml --pixel 32,30 --samples jittered"));
    assert!(samples.contains("sample 4 of 4"));
    folder.fails("render scene.toml --pixel 64,0", 2, &["no pixel 64,0", "64 x 48"]);
    folder.fails("render scene.toml --explain -o a.png", 2, &["--pixel"]);
    folder.fails("render scene.toml --pixel 1 -o a.png", 2, &["X,Y"]);
}
