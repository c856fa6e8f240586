//! The command itself: what it writes, how it ends, and what it says about bad input.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use patchray_host::scene::rays::RayLine;
use patchray_host::scene::{bpt, shapes, teapot};
use serde_json::Value;
use tempfile::TempDir;

mod all_and_any;
mod b_splines;
mod bad_input;
mod bake;
mod channels;
mod normals;
mod parts;
mod scenes;
mod study;
mod tables;

/// A folder with a teapot, a scene of it, and some rays.
struct Folder(TempDir);

const SCENE: &str = "surfaces = [{ file = \"teapot.bpt\" }]\n\
    [image]\nsize = [64, 48]\n\
    [camera]\neye = [7.6171875, -9.3203125, 7.59375]\nlook_at = [0.2, 0, 1.4]\nfov = 35\n\
    [trace]\nflatness = 0.002\n";

impl Folder {
    fn new() -> Self {
        let folder = Folder(tempfile::tempdir().expect("a temporary folder"));
        folder.put("teapot.bpt", teapot::PATCHES);
        folder.put("scene.toml", SCENE);
        folder.put("rays.csv", ray_file());
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn put(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(name), text).expect("written");
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("it is there")
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).expect("JSON")
    }

    /// Runs the command in this folder; words are cut at spaces.
    fn run(&self, words: &str) -> Output {
        self.command(words).output().expect("it starts")
    }

    fn command(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_patchray"));
        command.args(words.split(' ').filter(|word| !word.is_empty())).current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    /// Runs the command, which has to do its work.
    fn done(&self, words: &str) -> Output {
        let output = self.run(words);
        assert!(output.status.success(), "{words}: {:?}\n{}", output.status, said(&output));
        output
    }

    /// Runs the command, which has to fail with this code, to say each of `parts`, and to leave nothing behind.
    fn fails(&self, words: &str, code: i32, parts: &[&str]) {
        let before = self.names();
        let output = self.run(words);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(code), "{words}:\n{said}");
        for part in parts {
            assert!(said.contains(part), "{words}: `{part}` is not in\n{said}");
        }
        assert!(!said.contains("panicked"), "{said}");
        assert_eq!(self.names(), before, "{words} left something behind");
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("it can be listed");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Rays in ten scan lines across the teapot.
fn ray_file() -> String {
    let mut text = "ox,oy,oz,dx,dy,dz,tmax,line\n".to_owned();
    for line in 0..10 {
        for k in 0..40 {
            let (x, z) = (f64::from(k) / 5.0 - 4.0, 0.1 + f64::from(line) / 3.0);
            text += &format!("1,-9,4,{},9.1,{},inf,{line}\n", x - 1.0, z - 4.0);
        }
    }
    text
}

const METHODS: [&str; 4] = ["newton", "newton-coherent", "clipping", "clipping-coherent"];

/// Those for the rays of one view alone.
const PREDICTED: [&str; 2] = ["newton-predicted", "clipping-predicted"];

const TEAPOT: &str = "teapot.bpt rays.csv --flatness 0.002";

#[test]
fn render_draws_and_counts() {
    let folder = Folder::new();
    let output = folder.done("render scene.toml -o out.png --stats stats.json");
    assert!(output.stdout.is_empty());
    assert!(said(&output).contains("3072 rays"), "{}", said(&output));
    let picture = image::open(folder.path("out.png")).expect("a picture").to_rgb8();
    assert_eq!(picture.dimensions(), (64, 48));
    assert_eq!(picture.get_pixel(0, 0).0, [255; 3]);
    assert_ne!(picture.get_pixel(32, 24).0, [255; 3]);

    let stats = folder.json("stats.json");
    assert_eq!(
        (&stats["schema"], &stats["method"], &stats["precision"]),
        (&1.into(), &"clipping".into(), &"f64".into())
    );
    for field in [
        "scene",
        "threads",
        "rays",
        "hit_rays",
        "surfaces",
        "patches",
        "intersection_points",
        "newton_steps",
        "newton_starts",
        "clip_steps",
        "bisections",
        "voxels_visited",
        "patches_tested",
        "verified",
        "gave_up",
        "prepare_seconds",
        "intersect_seconds",
        "arena_bytes",
    ] {
        assert!(!stats[field].is_null(), "{field}");
    }
    assert_eq!((&stats["rays"], &stats["surfaces"], &stats["gave_up"]), (&3072.into(), &32.into(), &0.into()));
    assert!(stats["clip_steps"].as_u64() > stats["hit_rays"].as_u64());
    assert_eq!((&stats["patches"], &stats["asked"]), (&0.into(), &"closest".into()));
    let kinds = &stats["rays_by_kind"];
    assert_eq!((&kinds["camera"], &kinds["mirrored"], &stats["light_samples"]), (&3072.into(), &0.into(), &3.into()));
    // What the scene file and the flags say is what is in effect; the flags win.
    let settings = &stats["settings"];
    assert_eq!((&settings["flatness"], &settings["clip_threshold"]), (&0.002.into(), &0.2.into()));
    let trace = "clip_threshold = 0.1\nnewton_starts = 1\n[trace.limits]\nclip-steps = 500\nbisections = 50\n";
    folder.put("own.toml", format!("{SCENE}{trace}"));
    let flags = "--flatness 0.004 --newton-starts 2 --limit voxels=9999 --limit bisections=60 --size 8x8";
    folder.done(&format!("render own.toml -o out.png --stats stats.json {flags} --limit pending-domains=9"));
    let settings = &folder.json("stats.json")["settings"];
    assert_eq!((&settings["flatness"], &settings["newton_starts"]), (&0.004.into(), &2.into()));
    assert_eq!(settings["clip_threshold"], 0.1);
    for (limit, value) in [("voxels", 9999), ("clip-steps", 500), ("bisections", 60), ("pending-domains", 9)] {
        assert_eq!(settings["limits"][limit], value, "{limit}");
    }
    folder.done("render own.toml -o out.png --stats stats.json --clip-threshold 0.35 --size 8x8");
    assert_eq!(folder.json("stats.json")["settings"]["clip_threshold"], 0.35);
    // --json prints what --stats writes, but for the times.
    let quiet = folder.done("render scene.toml -o out.png --json --quiet --size 8x8");
    assert_eq!(said(&quiet), "");
    let stats: Value = serde_json::from_str(&printed(&quiet)).expect("JSON");
    assert_eq!((&stats["rays"], &stats["size"]), (&64.into(), &vec![8, 8].into()));
}

#[test]
fn threads_change_neither_pictures_nor_answers_nor_counters() {
    let folder = Folder::new();
    let without_times = |name: &str| {
        let mut stats = folder.json(name);
        let object = stats.as_object_mut().expect("an object");
        for field in ["prepare_seconds", "intersect_seconds", "threads"] {
            object.remove(field);
        }
        object.get_mut("settings").and_then(Value::as_object_mut).expect("settings").remove("threads");
        stats
    };
    for method in METHODS {
        for precision in ["f32", "f64"] {
            let flags = format!("--method {method} --precision {precision}");
            for threads in [1, 2] {
                folder.done(&format!(
                    "render scene.toml -o {threads}.png --stats r{threads}.json --threads {threads} {flags}"
                ));
                folder.done(&format!(
                    "query {TEAPOT} -o {threads}.csv --stats q{threads}.json --threads {threads} {flags}"
                ));
            }
            assert_eq!(fs::read(folder.path("1.png")).expect("there"), fs::read(folder.path("2.png")).expect("there"));
            assert_eq!(folder.text("1.csv"), folder.text("2.csv"));
            for file in ["r", "q"] {
                assert_eq!(without_times(&format!("{file}1.json")), without_times(&format!("{file}2.json")));
            }
        }
    }
}

/// Splits a line of answers.
fn fields(line: &str) -> Vec<&str> {
    line.split(',').collect()
}

#[test]
fn answers_lie_on_their_rays_and_read_back_to_the_same_bits() {
    let folder = Folder::new();
    let batch = patchray_host::scene::rays::read(&folder.path("rays.csv"), Default::default()).expect("rays");
    for (precision, error) in [("f64", 1e-12), ("f32", 2e-5)] {
        let output = folder.done(&format!("query {TEAPOT} --precision {precision}"));
        let text = printed(&output);
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("ray,hit,t,u,v,patch,nx,ny,nz,status"));
        let mut hits = 0;
        for (number, (line, ray)) in lines.by_ref().zip(&batch.rays).enumerate() {
            let answer = fields(line);
            assert_eq!(answer[0], number.to_string());
            if answer[1] == "0" {
                assert_eq!((answer[9], &answer[2..9]), ("miss", &[""; 7][..]));
                continue;
            }
            hits += 1;
            for field in [2, 3, 4, 6, 7, 8] {
                let again = if precision == "f64" {
                    answer[field].parse::<f64>().map(|x| x.to_string())
                } else {
                    answer[field].parse::<f32>().map(|x| x.to_string())
                };
                let shown: f64 = answer[field].parse().expect("a number");
                let again: f64 = again.expect("a number").parse().expect("a number");
                assert_eq!(shown.to_bits(), again.to_bits(), "{line}");
            }
            assert!(distance(ray, &answer) < error * 8.2, "{line}");
        }
        assert!(lines.next().is_none() && (150..400).contains(&hits), "{hits} hits");
    }
}

/// How far the answer's point on its surface is from its point on the ray.
fn distance(ray: &RayLine, answer: &[&str]) -> f64 {
    let number = |field: usize| answer[field].parse::<f64>().expect("a number");
    let model = teapot::model().expect("the fixture is valid");
    let surface = &model.surfaces[answer[5].parse::<usize>().expect("a number")];
    let bernstein = |t: f64| {
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let (bu, bv) = (bernstein(number(3)), bernstein(number(4)));
    let off = [0, 1, 2].map(|axis| {
        let on: f64 = (0..16).map(|k| bu[k / 4] * bv[k % 4] * surface.points[k][axis]).sum();
        on - ray.origin[axis] - number(2) * ray.direction[axis]
    });
    off.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[test]
fn small_budgets_give_up_by_name() {
    let folder = Folder::new();
    let often_bisected = "--clip-threshold 0.9";
    for (limit, flags) in [
        ("surfaces", ""),
        ("voxels", ""),
        ("newton-steps", ""),
        ("clip-steps", ""),
        ("clip-steps", "--method clipping-coherent"),
        ("clip-steps", "--any"),
        ("bisections", often_bisected),
        ("pending-domains", often_bisected),
        ("patches", "--method newton-coherent"),
        ("newton-steps", "--method newton-coherent"),
        ("nodes", "--method newton"),
    ] {
        let output = folder.done(&format!("query {TEAPOT} -o out.csv --stats s.json --limit {limit}=1 {flags}"));
        let told = said(&output);
        assert!(told.contains(&format!("gave up: the limit on {limit} ran out")), "{told}");
        let answers = folder.text("out.csv");
        let gave_up = answers.lines().filter(|line| line.ends_with(&format!(",gave-up:{limit}"))).count();
        assert!(gave_up > 50, "{limit}: {gave_up}");
        assert!(answers.lines().skip(1).all(|line| !line.contains("gave-up") || fields(line)[1] == "0"));
        let stats = folder.json("s.json");
        assert_eq!((&stats["gave_up"], &stats["gave_up_by_limit"][limit]), (&gave_up.into(), &gave_up.into()));
    }
}

#[test]
fn info_says_what_stats_report() {
    let folder = Folder::new();
    let output = folder.done("info teapot.bpt --json --flatness 0.002");
    let info: Value = serde_json::from_str(&printed(&output)).expect("JSON");
    assert_eq!((&info["schema"], &info["surfaces"], &info["rational_surfaces"]), (&1.into(), &32.into(), &0.into()));
    assert_eq!(info["degrees"], serde_json::json!([{ "u": 3, "v": 3, "surfaces": 32 }]));
    assert_eq!(info["control_box"]["max"], serde_json::json!([3.525, 2.0, 3.15]));
    for precision in ["f32", "f64"] {
        let memory = &info["memory"][precision];
        let fields = ["arena_bytes", "arena_bytes_by_kind", "coherence_bytes_per_thread", "scratch_bytes_per_thread"];
        for method in METHODS.into_iter().chain(PREDICTED) {
            let flags = format!("--stats s.json --method {method} --precision {precision}");
            folder.done(&format!("render scene.toml -o o.png --size 4x4 {flags}"));
            let stats = folder.json("s.json");
            assert_eq!(stats["patches"], if method == "clipping" { 0.into() } else { memory["patches"].clone() });
            let of_method = &memory["methods"][method];
            let line = stats["line_bytes_per_thread"].as_u64().expect("bytes");
            if PREDICTED.contains(&method) {
                let view = &of_method["view"];
                for field in fields {
                    assert_eq!(view[field], stats[field], "{precision} {method} {field}");
                }
                let most = view["line_bytes_per_thread_at_most"].as_u64().expect("bytes");
                assert!((1..=most).contains(&line), "{method}");
                assert!(of_method.get("arena_bytes").is_none());
                continue;
            }
            assert_eq!((line, &of_method["view"]), (0, &Value::Null), "{method}");
            for field in fields {
                assert_eq!(of_method[field], stats[field], "{precision} {method} {field}");
            }
            folder.done(&format!("query {TEAPOT} -o out.csv {flags}"));
            let stats = folder.json("s.json");
            for field in fields {
                assert_eq!(of_method[field], stats[field], "{precision} {method} {field}");
            }
        }
    }
    // The scene file's settings count, and the text says the same.
    let text = printed(&folder.done("info scene.toml"));
    let bytes = &info["memory"]["f64"]["methods"]["newton"]["arena_bytes"];
    assert!(text.contains(&format!("newton: {bytes} bytes")), "{text}");
}

#[test]
fn predicted_methods_ask_for_a_view() {
    let folder = Folder::new();
    folder.put(
        "far.toml",
        "surfaces = [{ file = \"teapot.bpt\" }]\ncamera = { eye = [0, -500, 1.5], look_at = [0, 0, 1.5], fov = 1 }\n",
    );
    folder.put(
        "mirror.toml",
        "surfaces = [{ file = \"teapot.bpt\", material = \"mirror\" }]\nmaterials.mirror = { reflect = 0.5 }\n\
         camera = { eye = [0, -9, 3], look_at = [0, 0, 1.5] }\n",
    );
    for method in PREDICTED {
        folder.fails(&format!("query {TEAPOT} -o out.csv --method {method}"), 2, &["one view", "--method"]);
        folder.fails(
            &format!("render far.toml -o o.png --size 8x8 --method {method}"),
            3,
            &["eight times", "--method"],
        );
        // What mirrors send on is traced by the method that can.
        folder.done(&format!("render mirror.toml -o o.png --size 24x24 --stats s.json --method {method}"));
        assert!(folder.json("s.json")["arena_bytes_by_kind"].get("grid_voxels").is_some());
    }
    folder.done("render far.toml -o o.png --size 8x8 --stats s.json --method newton");
    assert_eq!(folder.json("s.json")["line_bytes_per_thread"], 0);
}

#[test]
fn without_a_verb_the_teapot_is_compared_with_the_oracle() {
    let folder = Folder::new();
    let output = folder.done("--size 48x48 --quiet");
    let table = printed(&output);
    assert!(table.contains("Picture: target/teapot.png"), "{table}");
    assert!(folder.path("target/teapot.png").is_file());
    for row in table.lines().skip(1).take(12) {
        let words: Vec<_> = row.split_whitespace().collect();
        let judged: u64 = words[6..10].iter().map(|word| word.parse::<u64>().expect("a count")).sum();
        assert!(judged <= 2, "{table}");
    }
    let output = folder.done("--size 16x16 --method newton --precision f32 --json -o t.png");
    let report: Value = serde_json::from_str(&printed(&output)).expect("JSON");
    assert_eq!(report["runs"].as_array().map(Vec::len), Some(1));
    assert_eq!(report["runs"][0]["hit_rays"], report["oracle"]["hit_rays"]);
    assert!(folder.path("t.png").is_file());
}

#[test]
fn rational_surfaces_and_every_degree_are_traced() {
    let folder = Folder::new();
    let torus = shapes::torus([0.0; 3], 2.0, 0.5, 4, 4);
    folder.put("torus.bpt", bpt::write(&torus));
    folder.put("axis.csv", "ox,oy,oz,dx,dy,dz\n2,0,9,0,0,-1\n0,0,9,0,0,-1\n");
    let answers = printed(&folder.done("query torus.bpt axis.csv"));
    let lines: Vec<_> = answers.lines().map(fields).collect();
    assert!((lines[1][2].parse::<f64>().expect("t") - 8.5).abs() < 1e-12, "{answers}");
    assert_eq!(lines[2][9], "miss");
    // Weights of 1 and degrees raised to the limit change nothing but the last bits.
    let mut raised = shapes::single(shapes::elevate(&teapot::model().expect("valid").surfaces[0], 15, 15));
    raised.surfaces[0].rational = true;
    folder.put("raised.bpt", bpt::write(&raised));
    assert!(printed(&folder.done("query raised.bpt rays.csv --flatness 0.01")).contains(",ok"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_a_reader_gone_is_not() {
    let folder = Folder::new();
    folder.fails(&format!("query {TEAPOT} -o /dev/full"), 5, &["cannot write `/dev/full`"]);
    let mut child = folder
        .command(&format!("query {TEAPOT} --quiet"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((output.status.code(), said(&output)), (Some(0), String::new()));
}

#[test]
fn inputs_come_by_standard_input_too() {
    let folder = Folder::new();
    let expected = printed(&folder.done(&format!("query {TEAPOT}")));
    for words in ["query - rays.csv --flatness 0.002", "query teapot.bpt - --flatness 0.002"] {
        let file = if words.starts_with("query -") { "teapot.bpt" } else { "rays.csv" };
        let input = fs::File::open(folder.path(file)).expect("it is there");
        let output = folder.command(words).stdin(input).output().expect("it starts");
        assert_eq!(printed(&output), expected, "{}", said(&output));
    }
}

/// What a coherent method believes, and what clipping takes for a clip worth its while, show in the counters.
#[test]
fn parameters_of_clipping_have_their_effect() {
    let folder = Folder::new();
    let mut hits = None;
    let mut count = |flags: &str, counter: &str| {
        folder.done(&format!("render scene.toml -o o.png --stats s.json {flags}"));
        let stats = folder.json("s.json");
        assert_eq!(*hits.get_or_insert(stats["hit_rays"].clone()), stats["hit_rays"], "{flags}");
        stats[counter].as_u64().expect("a count")
    };
    let coherent = "--method clipping-coherent --acceptance";
    assert!(count(&format!("{coherent} paper"), "verified") > count(&format!("{coherent} proved"), "verified"));
    let cases = [0.05, 0.2, 0.6].map(|share| count(&format!("--clip-threshold {share}"), "bisections"));
    assert!(cases.is_sorted_by(|less, more| less < more), "{cases:?}");
}
