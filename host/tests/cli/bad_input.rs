//! Bad flags, bad files, too little room, outputs that cannot be written: one message with the place, an exit code, and no
//! file left behind.

use patchray_host::scene::teapot;

use super::{Folder, SCENE, TEAPOT, printed, said};

#[test]
fn usage_errors_end_with_2() {
    let folder = Folder::new();
    for (words, parts) in [
        ("fly", &["fly"][..]),
        ("render", &["SCENE"]),
        ("render scene.toml", &["-o OUT.png"]),
        ("render scene.toml -o a.png --method ray", &["newton-coherent"]),
        ("render scene.toml -o a.png --size 0x5", &["640x480"]),
        ("render scene.toml -o a.png --newton-starts 4", &["newton-starts", "1..=3"]),
        ("render scene.toml -o a.png --newton-starts 0", &["newton-starts"]),
        ("render scene.toml -o a.png --newton-iterations 0", &["newton-iterations"]),
        ("render scene.toml -o a.png --flatness NaN", &["flatness", "above 0"]),
        ("render scene.toml -o a.png --flatness -1", &["flatness", "above 0"]),
        ("render scene.toml -o a.png --grid-density inf", &["grid-density", "finite"]),
        ("render scene.toml -o a.png --clip-threshold 0", &["clip-threshold", "above 0 and below 1"]),
        ("render scene.toml -o a.png --clip-threshold -0.2", &["clip-threshold", "above 0 and below 1"]),
        ("query teapot.bpt rays.csv --clip-threshold 20%", &["clip-threshold", "above 0 and below 1"]),
        ("render scene.toml -o a.png --limit clip-step=5", &["did you mean `clip-steps`?"]),
        ("render scene.toml -o a.png --limit bisections=-1", &["whole number"]),
        ("query teapot.bpt rays.csv -o a.csv --limit pending-domains=65", &["the most is 64"]),
        ("query teapot.bpt rays.csv -o a.csv --all --any", &["--all", "--any"]),
        ("query teapot.bpt rays.csv -o a.csv --all --method clipping-coherent", &["the closest hit alone"]),
        ("query teapot.bpt rays.csv -o a.csv --all --method newton-coherent --stats s.json", &["--method clipping"]),
        ("query no.bpt rays.csv -o a.csv --any --method newton-coherent", &["the closest hit alone"]),
        ("render scene.toml -o a.png --all", &["--all"]),
        ("render scene.toml -o a.png --threads 0", &["threads"]),
        ("render scene.toml -o a.png --limit voxel=5", &["did you mean `voxels`?"]),
        ("render scene.toml -o a.png --limit voxels=x", &["whole number"]),
        ("render scene.toml -o - --json", &["standard output"]),
        ("render scene.toml -o a.png --stats a.png", &["same file"]),
        ("query teapot.bpt rays.csv --json", &["standard output"]),
        ("query - -", &["standard input"]),
        ("query teapot.bpt rays.csv --size 3x3", &["--size"]),
        ("info teapot.bpt --stats s.json", &["--json"]),
    ] {
        folder.fails(words, 2, parts);
    }
}

#[test]
fn bad_scene_files_end_with_3() {
    let folder = Folder::new();
    folder.fails("render no.toml -o a.png", 3, &["cannot read `no.toml`"]);
    for (text, parts) in [
        ("".to_owned(), &["bad.toml:1:1", "no surfaces"][..]),
        (SCENE[..SCENE.len() / 2].to_owned(), &["bad.toml:"]),
        (SCENE.replace("fov = 35", "fov = wide"), &["bad.toml:7:7"]),
        (SCENE.replace("teapot.bpt", "kettle.bpt"), &["bad.toml:1:", "kettle.bpt", "folder of the scene file"]),
        (SCENE.replace("flatness = 0.002", "newton_starts = 4"), &["bad.toml:9:17", "1 to 3"]),
        (SCENE.replace("flatness = 0.002", "flatness = nan"), &["bad.toml:9:12"]),
        (SCENE.replace("flatness = 0.002", "clip_threshold = 1.5"), &["bad.toml:9:18", "below 1"]),
        (SCENE.replace("flatness = 0.002", "clip_threshold = nan"), &["bad.toml:9:18", "below 1"]),
        (format!("{SCENE}[trace.limits]\npending-domains = 65\n"), &["bad.toml:11:1", "the most is 64"]),
        (format!("{SCENE}[trace.limits]\nvoxel = 5\n"), &["bad.toml:11:1", "did you mean `voxels`?"]),
        (format!("{SCENE}[trace.limits]\nvoxels = 5000000000\n"), &["bad.toml:11:1", "4294967295"]),
        (SCENE.replace("9.3203125", "9e300"), &["bad.toml", "pixel (0, 0)"]),
    ] {
        folder.put("bad.toml", &text);
        folder.fails("render bad.toml -o a.png --stats s.json --precision f32", 3, parts);
    }
}

#[test]
fn bad_patch_files_end_with_3() {
    let folder = Folder::new();
    let square = "0 0 0\n0 1 0\n1 0 0\n1 1 0\n";
    folder.fails("query no.bpt rays.csv -o a.csv", 3, &["cannot read `no.bpt`"]);
    for (text, parts) in [
        ("".to_owned(), &["bad.bpt:1:1", "empty"][..]),
        (teapot::PATCHES[..3000].to_owned(), &["bad.bpt:195:1", "promises"]),
        (teapot::PATCHES[..2900].to_owned(), &["bad.bpt:", "cut off"]),
        (format!("1\n1 1\n{}", square.replacen("1 0 0", "1 zero 0", 1)), &["bad.bpt:5:3", "not a number"]),
        (format!("1\n0 1\n{square}"), &["bad.bpt:2:1", "degree 0"]),
        (format!("1\n1 16\n{}", "0 0 0\n".repeat(34)), &["bad.bpt:2:3", "degree 16"]),
        (format!("1\n1 2\n{square}"), &["bad.bpt:6:", "cut off"]),
        (format!("1\n1 1\n{square}2 2 2\n"), &["bad.bpt:7:1", "more points"]),
        (format!("1\n1 1\n{}", square.replacen("0 1 0", "NaN 1 0", 1)), &["bad.bpt:4:1", "NaN"]),
        (format!("1\n1 1\n{}", square.replacen("0 1 0", "0 inf 0", 1)), &["bad.bpt:4:3", "infinite"]),
        ("1\n1 1\n0 0 0 1\n0 1 0 0\n1 0 0 1\n1 1 0 1\n".to_owned(), &["bad.bpt:4:7", "not above 0"]),
        (format!("1\n1 1\n{}", square.replacen("0 1 0", "0 1e39 0", 1)), &["bad.bpt", "surface 0", "f32"]),
        (format!("1\n1 1\n{}", square.replace('1', "1e-60")), &["shrinks to a point"]),
    ] {
        folder.put("bad.bpt", &text);
        folder.fails("query bad.bpt rays.csv -o a.csv --stats s.json --precision f32", 3, parts);
        // An empty or cut file is not asked whether f32 can hold it.
        if !text.contains("1e") {
            folder.fails("info bad.bpt -o a.json --json", 3, &parts[..1]);
        }
    }
}

/// A B-spline that begins as a file of NURBS-Python does; a part of it is replaced.
fn bad_spline(from: &str, to: &str) -> String {
    let whole = "{\"shape\": {\"type\": \"surface\", \"count\": 1, \"data\": [\n\
        {\"degree_u\": 1, \"degree_v\": 2, \"size_u\": 3, \"size_v\": 4,\n\
        \"knotvector_u\": [0, 0, 1, 2, 2],\n\
        \"knotvector_v\": [0, 0, 0, 1, 3, 3, 3],\n\
        \"control_points\": {\"points\": [[0, 0, 0], [0, 1, 0], [0, 2, 0], [0, 3, 0], [1, 0, 0], [1, 1, 1],\n\
        [1, 2, 1], [1, 3, 0], [2, 0, 0], [2, 1, 0], [2, 2, 0], [2, 3, 0]],\n\
        \"weights\": [1, 1, 1, 1, 1, 2, 2, 1, 1, 1, 1, 1]}}]}}\n";
    assert_eq!(whole.matches(from).count(), 1, "{from}");
    whole.replace(from, to)
}

#[test]
fn bad_b_splines_end_with_3() {
    let folder = Folder::new();
    folder.put("bad.json", bad_spline("\"degree_u\": 1", "\"degree_u\": 1"));
    folder.done("query bad.json rays.csv -o a.csv");
    std::fs::remove_file(folder.path("a.csv")).expect("it was written");
    folder.put("scene.toml", SCENE.replace("teapot.bpt", "bad.json"));
    let whole = bad_spline("\"degree_u\": 1", "\"degree_u\": 1");
    for (text, parts) in [
        (String::new(), &["bad.json:1:1", "empty"][..]),
        ("{}".to_owned(), &["bad.json:1:1", "no `shape`"]),
        (whole[..whole.len() - 20].to_owned(), &["bad.json:7:", "cut off"]),
        (whole[..whole.len() / 2].to_owned(), &["bad.json:5:", "cut off"]),
        (bad_spline("\"surface\"", "\"curve\""), &["bad.json:1:20", "`curve`"]),
        (bad_spline("\"count\": 1", "\"count\": 3"), &["bad.json:1:40", "1 of the 3 surfaces"]),
        (bad_spline("[1, 1, 1]", "[1, one, 1]"), &["bad.json:5:", "not JSON"]),
        (bad_spline("[1, 1, 1]", "[1, \"one\", 1]"), &["bad.json:5:90", "y of point 5", "not a number"]),
        (bad_spline("[1, 1, 1]", "[1, NaN, 1]"), &["bad.json:5:90", "NaN"]),
        (bad_spline("[1, 1, 1]", "[1, 1, -Infinity]"), &["bad.json:5:93", "infinite"]),
        (bad_spline("[1, 1, 1]", "[1, 1]"), &["bad.json:5:86", "point 5", "2 numbers"]),
        (bad_spline(", [2, 3, 0]]", "]"), &["bad.json:5:30", "11 control points", "3 x 4"]),
        (bad_spline("\"size_u\": 3", "\"size_u\": 4"), &["bad.json:5:30", "4 x 4"]),
        (bad_spline("\"size_v\": 4", "\"size_v\": 2"), &["bad.json:2:55", "too few"]),
        (bad_spline("\"degree_u\": 1", "\"degree_u\": 0"), &["bad.json:2:14", "degree 0"]),
        (bad_spline("\"degree_v\": 2", "\"degree_v\": 16"), &["bad.json:2:29", "degree 16"]),
        (bad_spline("1, 2, 2]", "1, 2]"), &["bad.json:3:17", "4 knots in u, not 5"]),
        (bad_spline("[0, 0, 0, 1, 3", "[0, 0, 0, 4, 3"), &["bad.json:4:30", "knot 4", "less than the 4"]),
        (bad_spline("[0, 0, 0, 1, 3", "[0, 0, 0, 0, 3"), &["bad.json:4:27", "knot 3", "equal to the 3"]),
        (bad_spline("[0, 0, 1, 2, 2]", "[0, 1, 1, 1, 2]"), &["bad.json:3:27", "empty in u"]),
        (bad_spline("[0, 0, 1, 2, 2]", "[0, 0, Infinity, 2, 2]"), &["bad.json:3:24", "knot 2", "infinite"]),
        (bad_spline("1, 2, 2, 1, 1", "1, 0, 2, 1, 1"), &["bad.json:7:28", "weight of point 5", "not above 0"]),
        (bad_spline("1, 2, 2, 1, 1", "1, 2, 2, 1"), &["bad.json:7:12", "11 weights"]),
        (bad_spline("[2, 3, 0]", "[2, 3e39, 0]"), &["bad.json", "surface 0", "f32"]),
    ] {
        folder.put("bad.json", &text);
        folder.fails("query bad.json rays.csv -o a.csv --stats s.json --precision f32", 3, parts);
        folder.fails("render scene.toml -o a.png --precision f32", 3, parts);
        if !text.contains("3e39") {
            folder.fails("info bad.json -o a.json --json", 3, parts);
        }
    }
}

#[test]
fn bad_ray_files_end_with_3() {
    let folder = Folder::new();
    let header = "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n";
    folder.fails("query teapot.bpt no.csv -o a.csv", 3, &["cannot read `no.csv`"]);
    for (text, parts) in [
        ("".to_owned(), &["bad.csv:1:1", "empty"][..]),
        ("ox,oy,oz,dx,dy\n".to_owned(), &["bad.csv:1:1", "`dz` is missing"]),
        (format!("{header}1,2,3\n"), &["bad.csv:3:1", "3 fields"]),
        (format!("{header}1,2,x,0,0,1\n"), &["bad.csv:3:5", "not a number"]),
        (format!("{header}1,2,NaN,0,0,1\n"), &["bad.csv:3:5", "NaN"]),
        (format!("{header}1,2,3,0,0,inf\n"), &["bad.csv:3:11", "infinite"]),
        (format!("{header}1,2,3,0,0,0\n"), &["bad.csv:3:1", "direction is zero"]),
        (format!("{header}1,2,3,0,0,1e39\n"), &["bad.csv:3:1", "cannot be traced", "infinite"]),
        (format!("{header}1,2,3,0,0,1e-44\n"), &["bad.csv:3:1", "cannot be traced"]),
    ] {
        folder.put("bad.csv", &text);
        folder.fails("query teapot.bpt bad.csv -o a.csv --stats s.json --precision f32 --flatness 0.01", 3, parts);
    }
}

#[test]
fn what_is_invalid_can_be_left_out() {
    let folder = Folder::new();
    let square = |z: &str| format!("1 1\n0 0 {z}\n0 1 {z}\n1 0 {z}\n1 1 {z}\n");
    folder.put("three.bpt", format!("3\n{}{}{}", square("NaN"), square("1e39"), square("1")));
    folder.put(
        "rays.csv",
        "ox,oy,oz,dx,dy,dz\n0.5,0.25,9,0,0,-1\n0.5,0.25,9,0,0,0\n0.5,0.25,9,0,0,1e39\n0.5,0.25,9,0,0,-2\n",
    );
    let output = folder.done("query three.bpt rays.csv --precision f32 --skip-invalid");
    let told = said(&output);
    for part in ["surface 0 left out (three.bpt:3:5)", "surface 1 left out (three.bpt)", "2 of 4 rays", "rays.csv:3:1"]
    {
        assert!(told.contains(part), "`{part}` is not in\n{told}");
    }
    let answers = printed(&output);
    let lines: Vec<_> = answers.lines().skip(1).collect();
    assert_eq!(lines[0], "0,1,8,0.5,0.25,2,0,0,1,ok");
    assert_eq!(lines[1..3], ["1,0,,,,,,,,invalid", "2,0,,,,,,,,invalid"]);
    assert_eq!(lines[3], "3,1,4,0.5,0.25,2,0,0,1,ok");
    // In 64 bits the second surface and the third ray are valid.
    let answers = printed(&folder.done("query three.bpt rays.csv --skip-invalid"));
    assert_eq!(answers.matches("invalid").count(), 1, "{answers}");
}

#[test]
fn what_vanishes_beside_the_rest_can_be_left_out() {
    let folder = Folder::new();
    let square = |side: &str| format!("1 1\n0 0 0\n0 {side} 0\n{side} 0 0\n{side} {side} 0\n");
    folder.put("four.bpt", format!("4\n{}{}{}{}", square("1e-30"), square("1e17"), square("1e-10"), square("3e-31")));
    folder.put("rays.csv", "ox,oy,oz,dx,dy,dz\n0.5e17,0.25e17,9e17,0,0,-1\n");
    folder.fails("query four.bpt rays.csv --precision f32", 3, &["surface 0", "too small beside", "--skip-invalid"]);
    let output = folder.done("query four.bpt rays.csv --precision f32 --skip-invalid");
    let told = said(&output);
    let left_out = |surface: usize| told.contains(&format!("surface {surface} left out (four.bpt)"));
    assert_eq!([0, 1, 2, 3].map(left_out), [true, false, false, true], "{told}");
    assert!(printed(&output).lines().nth(1).is_some_and(|line| line.starts_with("0,1,") && line.ends_with(",ok")));
    // In 64 bits all of them stand.
    assert_eq!(said(&folder.done("query four.bpt rays.csv --skip-invalid")).matches("left out").count(), 0);
}

#[test]
fn too_little_room_ends_with_4() {
    let folder = Folder::new();
    for (flags, parts) in [
        ("--limit arena-bytes=10000", &["needs", "bytes", "given 10000", "control points"][..]),
        ("--limit arena-bytes=100000 --method clipping-coherent", &["given 100000", "patches"]),
        ("--limit patches-per-surface=10 --method newton", &["surface 0", "more than 10"]),
        ("--flatness 1e-9 --limit patches-per-surface=1000 --method newton", &["more than 1000", "--flatness"]),
    ] {
        folder.fails(&format!("render scene.toml -o a.png {flags}"), 4, parts);
        folder.fails(&format!("query teapot.bpt rays.csv -o a.csv {flags}"), 4, parts);
        folder.fails(&format!("info teapot.bpt {flags}"), 4, parts);
    }
}

#[test]
fn outputs_that_cannot_be_written_end_with_5() {
    let folder = Folder::new();
    folder.fails("render scene.toml -o no/a.png", 5, &["cannot write `no/a.png`", "no folder `no`"]);
    folder.fails("render scene.toml -o a.png --stats no/s.json", 5, &["no folder `no`"]);
    folder.fails("render scene.toml -o .", 5, &["it is a folder"]);
    folder.fails(&format!("query {TEAPOT} -o no/a.csv"), 5, &["no folder `no`"]);
    folder.fails("info teapot.bpt -o no/a.csv", 5, &["no folder `no`"]);
    folder.fails("--size 4x4 -o no/a.png", 5, &["no folder `no`"]);
    // What was there before stays.
    folder.put("old.csv", "old");
    folder.put("bad.csv", "ox,oy,oz,dx,dy,dz\n1,2,3,0,0,0\n");
    folder.fails("query teapot.bpt bad.csv -o old.csv", 3, &["direction is zero"]);
    assert_eq!(folder.text("old.csv"), "old");
}

/// However a path is spelled: an output in the place of an input, or of another output, would destroy it.
#[test]
fn no_output_replaces_an_input_or_another_output() {
    let folder = Folder::new();
    let rays = folder.text("rays.csv");
    let input = &["an output would replace an input"];
    for words in [
        "query teapot.bpt rays.csv -o rays.csv",
        "query teapot.bpt rays.csv -o ./rays.csv",
        "query ./teapot.bpt rays.csv -o teapot.bpt",
        "query teapot.bpt rays.csv -o a.csv --stats rays.csv",
        "render scene.toml -o scene.toml",
        "info teapot.bpt -o teapot.bpt",
    ] {
        folder.fails(words, 2, input);
    }
    // What a scene names, the command line does not.
    folder.put(
        "names.toml",
        "surfaces = [{ file = \"teapot.bpt\" }]\ncamera = { eye = [8, -9, 8], look_at = [0, 0, 1] }\n",
    );
    let teapot = folder.text("teapot.bpt");
    for words in [
        "render names.toml -o teapot.bpt",
        "render names.toml -o a.png --stats teapot.bpt",
        "query names.toml rays.csv -o teapot.bpt",
        "info names.toml -o ./teapot.bpt",
        "bake names.toml --rust teapot.bpt",
        "study names.toml -o results --stats teapot.bpt",
        "study teapot.bpt -o results --stats ./teapot.bpt",
    ] {
        folder.fails(words, 2, input);
    }
    assert_eq!(folder.text("teapot.bpt"), teapot);
    folder.fails("query teapot.bpt rays.csv -o a.csv --stats ./a.csv", 2, &["name the same file"]);
    assert_eq!(folder.text("rays.csv"), rays);
    folder.done("query teapot.bpt rays.csv -o /dev/null --stats /dev/null");
}

/// A picture named `a.jpg` once was a PNG, which some viewers refuse.
#[test]
fn a_picture_is_not_named_after_another_format() {
    let folder = Folder::new();
    let format = &["pictures are written as PNG", "--aov"];
    for words in ["render scene.toml -o a.jpg", "render scene.toml -o a.EXR", "--size 4x4 -o a.tiff"] {
        folder.fails(words, 2, format);
    }
    folder.done("render scene.toml --size 4x4 -o a.PNG");
    folder.fails("diff a.PNG a.PNG -o b.webp", 2, format);
    folder.fails("merge a.PNG -o b.gif", 2, format);
    folder.done("render scene.toml --size 4x4 -o a");
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_even_where_nothing_is_yet() {
    let folder = Folder::new();
    std::os::unix::fs::symlink("target.csv", folder.path("link.csv")).expect("links can be made");
    folder.done("query teapot.bpt rays.csv -o link.csv");
    assert!(folder.path("link.csv").is_symlink());
    assert!(folder.text("target.csv").starts_with("ray,"));
}
