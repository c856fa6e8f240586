use std::fs;

use patchray::limits::MAX_NEWTON_STARTS;
use proptest::prelude::*;

use super::super::contents::What;
use super::super::error::tests::{assert_refused, rendered};
use super::*;

mod contents;

const LEAST: &str = "surfaces = [{ file = \"a.bpt\" }]\n[camera]\neye = [0, -5, 0]\nlook_at = [0, 0, 0]\n";

fn refused(text: &str, place: &str, message: &str) {
    assert_refused(parse("s.toml", text), place, message);
}

/// Refuses `LEAST` with `lines` behind it, from line 5.
fn refused_after(lines: &str, place: &str, message: &str) {
    refused(&format!("{LEAST}{lines}"), place, message);
}

/// Refuses a scene whose table `[camera]` holds `lines`, from line 3.
fn camera_refused(lines: &str, place: &str, message: &str) {
    refused(&format!("surfaces = [{{ file = \"a.bpt\" }}]\n[camera]\n{lines}"), place, message);
}

#[test]
fn everything_else_has_a_default() {
    let scene = parse("s.toml", LEAST).expect("valid");
    assert_eq!((scene.image, &scene.lights[..]), (Image::default(), &[Light::default()][..]));
    assert_eq!((scene.material, scene.background), (Material::default(), [1.0; 3]));
    assert_eq!(scene.trace, TraceSettings::default());
    let up = [0.0, 0.0, 1.0];
    assert_eq!(scene.camera, Camera::LookAt { eye: [0.0, -5.0, 0.0], look_at: [0.0; 3], up, fov: 40.0 });
    assert_eq!(scene.contents.surfaces[0].what, What::File("a.bpt".into()));
}

#[test]
fn surfaces_and_camera_are_needed() {
    refused("", "s.toml:1:1", "the scene has no surfaces");
    refused("surfaces = []\n[camera]\n", "s.toml:1:1", "the scene has no surfaces");
    refused("surfaces = [{ file = \"a.bpt\" }]\n", "s.toml:1:1", "the scene has no camera");
    let camera = "[camera]\neye = [0, -5, 0]\nlook_at = [0, 0, 0]\n";
    refused(&format!("surfaces = [{{}}]\n{camera}"), "s.toml:1:13", "this entry of `surfaces` names none");
}

#[test]
fn syntax() {
    refused("surfaces = [\n", "s.toml:1:13", "unclosed array");
    refused("image = \n", "s.toml:1:9", "string values must be quoted");
    refused("[image]\nsize = [1, 2\n[light]\n", "s.toml:3:1", "missing comma");
    refused("[image]\n[image]\n", "s.toml:2:2", "duplicate key");
}

#[test]
fn unknown_names_with_the_nearest() {
    refused_after("[lihgt]\n", "s.toml:5:2", "there is no `lihgt` here (did you mean `light`?)");
    refused_after("fow = 3\n", "s.toml:5:1", "there is no `fow` here (did you mean `fov`?)");
    refused_after("[material]\ncolor = [1, 1, 1]\n", "s.toml:6:1", "(did you mean `colour`?)");
    refused_after("[trace]\nweather = 1\n", "s.toml:6:1", "there is no `weather` here");
    refused_after("[trace]\nmethod = \"newton_coherent\"\n", "s.toml:6:10", "(did you mean `newton-coherent`?)");
    refused_after("[trace]\nprecision = \"f16\"\n", "s.toml:6:13", "there is no `f16` here");
    refused_after("[light]\nshadow = \"ray\"\n", "s.toml:6:10", "there is no `ray` here (did you mean `rays`?)");
    refused_after("[light]\nshadows = \"map\"\n", "s.toml:6:1", "there is no `shadows` here (did you mean `shadow`?)");
    let report = rendered(&parse("s.toml", "[image]\nsice = 1\n").expect_err("refused"));
    assert!(report.contains("help: write one of size"), "{report}");
}

#[test]
fn wrong_types() {
    refused_after("fov = \"wide\"\n", "s.toml:5:7", "invalid type: string \"wide\", expected a number");
    refused_after("[image]\nsize = \"big\"\n", "s.toml:6:8", "expected a list in brackets");
    refused_after("[materials]\nred = 5\n", "s.toml:6:7", "expected a table, such as");
    refused_after(
        "[trace.limits]\nvoxels = 1.5\n",
        "s.toml:6:10",
        "invalid type: floating point `1.5`, expected a whole number",
    );
}

/// Refuses `LEAST` with `lines` behind it, from line 5, with this help.
fn helped_after(lines: &str, place: &str, message: &str, help: &str) {
    let text = format!("{LEAST}{lines}");
    refused(&text, place, message);
    let report = rendered(&parse("s.toml", &text).expect_err("refused"));
    assert!(report.contains(&format!("help: {help}")), "{report}");
}

#[test]
fn lists_are_no_tables() {
    let table = "invalid type: list, expected a table, such as `{ name = value }`";
    let surfaces = |entries: &str| format!("surfaces = [{entries}]\n[camera]\neye = [0, -5, 0]\nlook_at = [0, 0, 0]\n");
    for (entry, place) in [
        ("[\"a.bpt\"]", "s.toml:1:13"),
        ("{ sphere = [1.0, 6, true, \"anything\"] }", "s.toml:1:24"),
        ("{ torus = [1, 0.3, 0.3, 4, 4, 0, true] }", "s.toml:1:23"),
        ("{ cylinder = [1, 2] }", "s.toml:1:26"),
        ("{ file = \"a.bpt\", transform = [[[1, 0, 0]]] }", "s.toml:1:44"),
        ("{ file = \"a.bpt\", transform = [{ rotate = [[1, 0, 0], 30] }] }", "s.toml:1:55"),
    ] {
        refused(&surfaces(entry), place, table);
    }
    helped_after(
        "[materials]\nred = { metal = { gold = [] } }\n",
        "s.toml:6:17",
        "invalid type: table, expected one of `aluminium`",
        "write one of \"aluminium\", \"copper\", \"gold\", \"silver\"",
    );
    for (lines, place, help) in [
        ("[[image]]\nsize = [9, 9]\n", "s.toml:5:1", "write `[image]`"),
        ("[[trace]]\n", "s.toml:5:1", "write `[trace]`"),
        ("[[trace.limits]]\n", "s.toml:5:1", "write `[trace.limits]`"),
        ("[[light]]\n", "s.toml:5:1", "write `[light]` for one light, `[[lights]]` for each of several"),
        ("[[material]]\n", "s.toml:5:1", "write `[material]` for what names none, `[materials.NAME]`"),
        ("[[materials]]\n", "s.toml:5:1", "write `[materials.NAME]` for one with a name, `[material]`"),
        ("[[materials.a]]\n", "s.toml:5:1", "write `[materials.NAME]` for one with a name, `[material]`"),
        (
            "[materials]\ncolour = [1, 0, 0]\n",
            "s.toml:6:10",
            "write `[materials.NAME]` for one with a name, `[material]`",
        ),
        ("[groups]\nsurfaces = []\n", "s.toml:6:12", "write `[groups.NAME]` for each group"),
        ("[[groups.a]]\n", "s.toml:5:1", "write `[groups.NAME]` for each group"),
    ] {
        helped_after(lines, place, "invalid type: list, expected a table", help);
    }
    helped_after(
        "[lights]\n",
        "s.toml:5:1",
        "expected a list in brackets",
        "write `[[lights]]` for each light, or `[light]`",
    );
    helped_after("[polygons]\n", "s.toml:5:1", "expected a list in brackets", "write `[[polygons]]`");
    refused("surfaces = []\ncamera = [[0, -5, 1], [0, 1, 0]]\n", "s.toml:2:10", table);
    let report = rendered(&parse("s.toml", "image = [[64, 64], \"jittered\", 1]\n").expect_err("refused"));
    assert!(report.contains("help: write a table `{ name = value }` of size, samples"), "{report}");
}

#[test]
fn choices_are_told_whatever_stands_in_their_place() {
    for (lines, place, message, help) in [
        ("[image]\nsamples = 4\n", "s.toml:6:11", "integer `4`, expected one of", "\"one\", \"uniform\", \"jittered\""),
        ("[image]\nsamples = { jittered = {} }\n", "s.toml:6:11", "type: table, expected", "\"one\", \"uniform\""),
        ("[image]\nsamples = [\"one\"]\n", "s.toml:6:11", "type: list, expected one of", "\"one\", \"uniform\""),
        ("[light]\nshadow = true\n", "s.toml:6:10", "boolean `true`, expected one of", "\"none\", \"rays\", \"map\""),
        ("[trace]\nmethod = 3\n", "s.toml:6:10", "integer `3`, expected one of", "\"newton\", \"newton-coherent\""),
        ("[material]\nmetal = 1\n", "s.toml:6:9", "integer `1`, expected one of", "\"aluminium\", \"copper\""),
    ] {
        helped_after(lines, place, message, &format!("write one of {help}"));
    }
}

#[test]
fn cameras() {
    camera_refused("look_at = [0, 0, 0]\n", "s.toml:2:1", "the camera lacks `eye`");
    camera_refused("eye = [0, 0, 0]\n", "s.toml:2:1", "the camera lacks `look_at`");
    camera_refused("eye = [0, 0, 0]\nfov = 3\n", "s.toml:2:1", "the camera lacks `look_at`");
    camera_refused("eye = [0, 0, 0]\nforward = [0, 1, 0]\n", "s.toml:2:1", "the camera lacks `right`");
    camera_refused(
        "eye = [0, 0, 0]\nforward = [0, 1, 0]\nright = [1, 0, 0]\nup = [0, 0, 1]\nfov = 30\n",
        "s.toml:7:7",
        "the camera is given in two ways",
    );
    camera_refused("eye = [0, 0]\nlook_at = [1, 0, 0]\n", "s.toml:3:7", "`eye` has 2 numbers");
    camera_refused("eye = [0, 0, 0, 0]\nlook_at = [1, 0, 0]\n", "s.toml:3:7", "`eye` has 4 numbers");
    camera_refused("eye = [0, nan, 0]\nlook_at = [1, 0, 0]\n", "s.toml:3:7", "`eye` holds NaN");
    camera_refused("eye = [1, 0, 0]\nlook_at = [1, 0, 0]\n", "s.toml:4:11", "looks at the point where it is");
    for far in ["[0, -1e308, 0]", "[-1e308, -1e308, -1e308]"] {
        let text = format!("eye = {far}\nlook_at = [1e308, 1e308, 1e308]\n");
        camera_refused(&text, "s.toml:4:11", "the camera looks too far away");
    }
    let long = "[1.5e308, 1.5e308, 0]";
    camera_refused(&format!("eye = [1, 0, 0]\nlook_at = [0, 0, 0]\nup = {long}\n"), "s.toml:5:6", "`up` is too long");
    let forward = format!("eye = [0, 0, 0]\nforward = {long}\nright = [1, 0, 0]\nup = [0, 0, 1]\n");
    camera_refused(&forward, "s.toml:4:11", "`forward` is too long");
    camera_refused("eye = [0, 0, 9]\nlook_at = [0, 0, 0]\n", "s.toml:4:11", "looks straight along `up`");
    let up = "eye = [0, 0, 9]\nlook_at = [0, 9, 0]\nup = [0, 0, 0]\n";
    camera_refused(up, "s.toml:5:6", "looks straight along `up`, or `up` is zero");
    for fov in ["0", "180", "-1", "nan", "inf"] {
        refused_after(&format!("fov = {fov}\n"), "s.toml:5:7", "the field of view is");
    }
    camera_refused(
        "eye = [0, 0, 0]\nforward = [0, 1, 0]\nright = [1, 1, 0]\nup = [1, 2, 0]\n",
        "s.toml:2:1",
        "`forward`, `right` and `up` lie in one plane",
    );
    camera_refused(
        "eye = [0, 0, 0]\nforward = [0, 1, 0]\nright = [0, 0, 0]\nup = [0, 0, 1]\n",
        "s.toml:2:1",
        "or one of them is zero",
    );
}

#[test]
fn values_out_of_range() {
    refused(&format!("background = [0, 0, 2]\n{LEAST}"), "s.toml:1:14", "`background` is not a colour");
    refused_after("[image]\nsize = [0, 5]\n", "s.toml:6:8", "not the size of an image");
    refused_after("[image]\nsize = [5]\n", "s.toml:6:8", "not the size of an image");
    for size in ["[5, 40000]", "[-1, 5]", "[1000000000000, 5]"] {
        refused_after(&format!("[image]\nsize = {size}\n"), "s.toml:6:8", "not the size of an image");
    }
    refused_after("[light]\nposition = [1, 2]\n", "s.toml:6:12", "`position` of the light has 2 numbers");
    refused_after("[light]\ncolour = [1, 2, -3]\n", "s.toml:6:10", "`colour` of the light is not a colour");
    let map = "[light]\nshadow = \"map\"\n";
    for (line, place, message) in [
        ("map_size = 0", "s.toml:7:12", "`map_size` is 0"),
        ("map_size = 8193", "s.toml:7:12", "`map_size` is 8193"),
        ("map_size = -1", "s.toml:7:12", "`map_size` is -1"),
        ("map_size = 0.5", "s.toml:7:12", "invalid type: floating point `0.5`, expected a whole number"),
        ("map_bias = -1", "s.toml:7:12", "`map_bias` is -1"),
        ("map_bias = inf", "s.toml:7:12", "`map_bias` is inf"),
        ("map_sice = 8", "s.toml:7:1", "there is no `map_sice` here (did you mean `map_size`?)"),
    ] {
        refused_after(&format!("{map}{line}\n"), place, message);
    }
    refused_after("[material]\nambient = -0.5\n", "s.toml:6:11", "`ambient` is -0.5");
    refused_after("[material]\nshininess = 0\n", "s.toml:6:13", "`shininess` is 0");
    for (field, range) in [
        ("newton_iterations", "1 to 4294967295"),
        ("newton_starts", &format!("1 to {MAX_NEWTON_STARTS}")),
        ("threads", "1 to 1024"),
    ] {
        for count in ["0", "-4", "1000000000000", "10000000000000000000"] {
            let place = format!("s.toml:6:{}", field.len() + 4);
            let help = format!("write a whole number from {range}");
            helped_after(&format!("[trace]\n{field} = {count}\n"), &place, &format!("`{field}` is {count}"), &help);
        }
    }
    let digits = "9".repeat(50);
    helped_after(&format!("[trace]\nthreads = {digits}\n"), "s.toml:6:11", "overflowed", "write a smaller number");
    refused_after("[trace]\nclip_threshold = 1.0\n", "s.toml:6:18", "`clip_threshold` is 1");
    refused_after("[trace]\nflatness = inf\n", "s.toml:6:12", "`flatness` is inf");
    refused_after("[trace]\ngrid_density = 0.0\n", "s.toml:6:16", "`grid_density` is 0");
}

#[test]
fn limits_keep_their_place() {
    let text = format!("{LEAST}[trace.limits]\nvoxels = 7\n'a b' = 0\n");
    let limits = parse("s.toml", &text).expect("valid").trace.limits;
    let found: Vec<_> = limits.iter().map(|limit| (&*limit.name, limit.value, &text[limit.span.clone()])).collect();
    assert_eq!(found, [("a b", 0, "'a b'"), ("voxels", 7, "voxels")]);
}

#[test]
fn files_are_joined_and_refused_by_place() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let square = "1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n";
    fs::create_dir(folder.path().join("sub")).expect("made");
    fs::write(folder.path().join("sub/one.bpt"), format!("1\n{square}")).expect("written");
    fs::write(folder.path().join("two.bpt"), format!("2\n{}{square}", square.replace("1 1 0", "1 1 nan")))
        .expect("written");
    let path = folder.path().join("scene.toml");
    let camera = "[camera]\neye = [0, -5, 0]\nlook_at = [0, 0, 0]\n";
    fs::write(&path, format!("surfaces = [{{ file = \"sub/one.bpt\" }}, {{ file = \"two.bpt\" }}]\n{camera}"))
        .expect("written");

    let scene = read(&path, OnInvalid::Skip).expect("valid");
    let numbers: Vec<_> = scene.model.surfaces.iter().map(|surface| surface.number).collect();
    assert_eq!(numbers, [0, 1]);
    let file = scene.file_of(1).expect("of the second file");
    assert_eq!((&file.path, file.surfaces.clone()), (&folder.path().join("two.bpt"), 1..2));
    assert_eq!(file.skipped[0].number, 0);
    assert!(scene.file_of(2).is_none());
    let place = format!("{}:6:5", file.path.display());
    assert_refused(read(&path, OnInvalid::Refuse), &place, "z of point 3 of surface 0 is not a number");

    fs::write(&path, format!("surfaces = [{{ file = \"gone.bpt\" }}]\n{camera}")).expect("written");
    assert_refused(read(&path, OnInvalid::Refuse), &format!("{}:1:22", path.display()), "cannot read `");

    let unused = "[groups.unused]\nsurfaces = [{ file = \"sub/one.bpt\" }, { file = \"gone.bpt\" }]\n";
    fs::write(&path, format!("surfaces = [{{ sphere = {{ radius = 1 }} }}]\n{camera}{unused}")).expect("written");
    assert_refused(read(&path, OnInvalid::Refuse), &format!("{}:6:48", path.display()), "cannot read `");
}

proptest! {
    #[test]
    fn damage_never_panics(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6)) {
        let mut bytes = super::super::teapot::COMMON_SCENE.as_bytes().to_vec();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Err(error) = parse("s.toml", &String::from_utf8_lossy(&bytes)) {
            prop_assert!(rendered(&error).contains("[s.toml:"));
        }
    }
}
