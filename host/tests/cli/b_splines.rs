//! B-splines by the command: what is traced are pieces, what is told are surfaces in their own knots.

use std::fs::File;

use patchray_host::scene::shapes::Random;
use serde_json::{Value, json};

use super::{Folder, fields, printed, said};

/// What geomdl wrote: four surfaces, the second of them with a trimming curve.
const NURBS: &str = include_str!("../../../fixtures/patches/nurbs.json");

/// Where geomdl finds points of them.
const POSITIONS: &str = include_str!("../../../fixtures/recorded/nurbs-positions.csv");

/// Rays that pass through recorded points, one a line, in directions of their own.
fn rays_and_targets() -> (String, Vec<Vec<f64>>) {
    let mut random = Random(1);
    let (mut rays, mut targets) = ("ox,oy,oz,dx,dy,dz\n".to_owned(), Vec::new());
    for line in POSITIONS.lines().filter(|line| !line.starts_with(['#', 's'])) {
        let numbers: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let [x, y, z] = [numbers[3], numbers[4], numbers[5]];
        let [dx, dy] = [0; 2].map(|_| random.within(-0.2, 0.2));
        // From below: t = 1 at the point.
        rays += &format!("{},{},{},{dx},{dy},4\n", x - dx, y - dy, z - 4.0);
        targets.push(numbers);
    }
    (rays, targets)
}

#[test]
fn answers_are_in_the_surfaces_own_knots() {
    let folder = Folder::new();
    folder.put("nurbs.json", NURBS);
    let (rays, targets) = rays_and_targets();
    folder.put("rays.csv", rays);
    // The surfaces lie one over another: each is asked for alone.
    let file: Value = serde_json::from_str(NURBS).expect("JSON");
    for (precision, allowance) in [("f64", 1e-9), ("f32", 2e-3)] {
        let mut met = 0;
        for number in 0..4 {
            let alone = json!({ "shape": { "type": "surface", "data": [file["shape"]["data"][number]] } });
            folder.put("one.json", alone.to_string());
            let output = folder.done(&format!("query one.json rays.csv --precision {precision}"));
            for (line, target) in printed(&output).lines().skip(1).zip(&targets) {
                let answer = fields(line);
                if target[0] != number as f64 || answer[1] == "0" {
                    continue;
                }
                let value = |field: usize| answer[field].parse::<f64>().expect("a number");
                assert_eq!(answer[5], "0");
                // Another point of the surface may lie before this one.
                if (value(2) - 1.0).abs() < allowance {
                    let off = (value(3) - target[1]).abs().max((value(4) - target[2]).abs());
                    assert!(off < allowance, "{line}: {target:?}");
                    met += 1;
                }
            }
        }
        assert!(met > 150, "{precision}: {met} of {}", targets.len());
    }
}

#[test]
fn hits_name_the_surface_and_not_its_piece() {
    let folder = Folder::new();
    folder.put("nurbs.json", NURBS);
    folder.put("rays.csv", rays_and_targets().0);
    let output = folder.done("query nurbs.json rays.csv --stats s.json");
    assert!(said(&output).contains("surface 1 is taken whole (nurbs.json): trimming curves ignored: 1"));
    let info: Value = serde_json::from_str(&printed(&folder.done("info nurbs.json --json"))).expect("JSON");
    let answers = printed(&output);
    let mut seen = [false; 4];
    for answer in answers.lines().skip(1).map(fields).filter(|answer| answer[1] == "1") {
        let number: usize = answer[5].parse().expect("a number");
        seen[number] = true;
        for (axis, field) in [3, 4].into_iter().enumerate() {
            let bound = |k: usize| info["b_splines"][number]["domain"][axis][k].as_f64().expect("a number");
            let value: f64 = answer[field].parse().expect("a number");
            assert!((bound(0)..=bound(1)).contains(&value), "{answer:?}");
        }
    }
    // One lies behind the others.
    assert!(seen.into_iter().filter(|&seen| seen).count() >= 3, "{seen:?}");
    assert_eq!(folder.json("s.json")["surfaces"], 18);
}

#[test]
fn info_lists_b_splines() {
    let folder = Folder::new();
    folder.put("nurbs.json", NURBS);
    let info: Value = serde_json::from_str(&printed(&folder.done("info nurbs.json --json"))).expect("JSON");
    assert_eq!((&info["surfaces"], &info["rational_surfaces"]), (&18.into(), &8.into()));
    let second = &info["b_splines"][1];
    for (field, value) in [
        ("file", json!("nurbs.json")),
        ("surface", json!(1)),
        ("rational", json!(true)),
        ("degrees", json!([2, 3])),
        ("control_points", json!([4, 6])),
        ("knots", json!([7, 10])),
        ("spans", json!([2, 3])),
        ("pieces", json!(6)),
        ("trims_ignored", json!(1)),
    ] {
        assert_eq!(second[field], value, "{field}");
    }
    let text = printed(&folder.done("info nurbs.json"));
    for part in ["b-splines       4, cut into 18", "surface 1: rational, degrees 2 x 3", "pieces 6", "trims ignored 1"]
    {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
    // A file of Bézier surfaces has none.
    let text = printed(&folder.done("info teapot.bpt"));
    assert!(!text.contains("b-splines"), "{text}");
}

#[test]
fn a_scene_mixes_formats() {
    let folder = Folder::new();
    folder.put("nurbs.json", NURBS);
    let scene = folder.text("scene.toml");
    folder.put(
        "scene.toml",
        scene.replace("{ file = \"teapot.bpt\" }", "{ file = \"teapot.bpt\" }, { file = \"nurbs.json\" }"),
    );
    let output = folder.done("render scene.toml -o a.png --stats s.json");
    assert!(said(&output).contains("surface 1 is taken whole (nurbs.json)"));
    assert_eq!(folder.json("s.json")["surfaces"], 50);
    let text = printed(&folder.done("info scene.toml"));
    assert!(text.contains("surface 3 of nurbs.json: degrees 1 x 5"), "{text}");
}

/// By name, or, where the name says nothing, by how the text begins; a `.bpt` is what it says it is.
#[test]
fn formats_are_told_apart() {
    let folder = Folder::new();
    for name in ["a.json", "a.JSON", "a.txt", "a"] {
        folder.put(name, NURBS);
        assert!(printed(&folder.done(&format!("info {name}"))).contains("b-splines       4"));
    }
    let input = File::open(folder.path("a.json")).expect("it is there");
    let output = folder.command("info -").stdin(input).output().expect("it starts");
    assert!(printed(&output).contains("b-splines       4"), "{}", said(&output));
    folder.put("b.bpt", NURBS);
    folder.fails("info b.bpt", 3, &["b.bpt:1:1", "not the number of surfaces"]);
    folder.put("c.json", folder.text("teapot.bpt"));
    folder.fails("info c.json", 3, &["c.json:1:1", "not JSON"]);
    folder.put("d.txt", folder.text("teapot.bpt"));
    assert!(printed(&folder.done("info d.txt")).contains("surfaces        32"));
}

#[test]
fn a_surface_is_left_out_whole() {
    let folder = Folder::new();
    let mut file: Value = serde_json::from_str(NURBS).expect("JSON");
    let surfaces = file["shape"]["data"].as_array_mut().expect("a list");
    // Not valid in either precision; and a point that f32 cannot hold, on one of several pieces.
    surfaces[0]["knotvector_u"][5] = json!(-5);
    surfaces[3]["control_points"]["points"][0][0] = json!(-1e39);
    folder.put("bad.json", file.to_string());
    let output = folder.done("query bad.json rays.csv --precision f32 --skip-invalid --stats s.json -o a.csv");
    let told = said(&output);
    assert!(told.contains("surface 0 left out (bad.json:1:"), "{told}");
    assert_eq!(told.matches("surface 3 left out (bad.json): in f32").count(), 1, "{told}");
    assert_eq!(folder.json("s.json")["surfaces"], 8);
    let text = printed(&folder.done("info bad.json --precision f32 --skip-invalid"));
    assert!(text.contains("b-splines       2, cut into 8"), "{text}");
    let text = printed(&folder.done("info bad.json --skip-invalid"));
    assert!(text.contains("b-splines       3, cut into 12"), "{text}");
}
