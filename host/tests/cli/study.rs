//! `patchray study`.

use serde_json::Value;

use super::{Folder, printed, said};

/// Few pixels and few patches: what is measured so means nothing, but all of it is there.
const SMALL: &str = "study --size 24x16 --repetitions 2 --flatness 0.01";

fn lines(folder: &Folder, name: &str) -> Vec<Value> {
    folder.text(name).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn line<'l>(lines: &'l [Value], name: &str) -> &'l Value {
    lines.iter().find(|line| line["line"] == name).unwrap_or_else(|| panic!("no line {name}"))
}

#[test]
fn cells_are_listed_and_shards_part_them() {
    let folder = Folder::new();
    let list = printed(&folder.done("study --list"));
    let all: Vec<&str> = list.lines().collect();
    assert!(all.contains(&"clipping.f64.default") && all.contains(&"newton-predicted.f32.tolerance.0.001"));
    let mut parts: Vec<String> = Vec::new();
    for part in 1..=3 {
        parts.extend(printed(&folder.done(&format!("study --list --shard {part}/3"))).lines().map(str::to_owned));
    }
    let sorted = |mut ids: Vec<String>| {
        ids.sort();
        ids
    };
    assert_eq!(sorted(parts), sorted(all.iter().map(|&id| id.to_owned()).collect()));
    let json: Vec<String> =
        serde_json::from_str(&printed(&folder.done("study --list --json --method newton"))).expect("JSON");
    assert!(json.len() > 10 && json.iter().all(|id| id.starts_with("newton.")));
    folder.fails("study --list --shard 4/3", 2, &["1/4"]);
    folder.fails("study --only clipping.f64.defaul", 2, &["did you mean `clipping.f64.default`?", "--list"]);
}

#[test]
fn a_cell_is_measured_once_and_says_all() {
    let folder = Folder::new();
    let only = "--only newton-coherent.f64.default --only newton-coherent.f64.newton-steps.4";
    folder.done(&format!("{SMALL} {only} -o results"));
    let name = "results/newton-coherent.f64.default.jsonl";
    let all = lines(&folder, name);
    assert_eq!(line(&all, "cell")["method"], "newton-coherent");
    assert_eq!(line(&all, "cell")["settings"]["flatness"], 0.01);
    assert!(line(&all, "machine")["version"].is_string());
    let time = line(&all, "time");
    assert_eq!(time["repetitions"].as_array().map(Vec::len), Some(2));
    let counts = line(&all, "counts");
    assert_eq!((&counts["rays"], &counts["gave_up"]), (&384.into(), &serde_json::json!({})));
    assert!(counts["work"]["newton_steps"].as_u64() > Some(100) && counts["bytes"].as_u64() > Some(1000));
    let errors = line(&all, "errors");
    for part in ["t", "residual"] {
        let max = errors[part]["max"].as_f64().expect("a number");
        assert!(max > 0.0 && max < 1e-10, "{part}: {max}");
    }
    for map in ["pixels", "steps"] {
        assert_eq!(line(&all, "map")[map].as_str().map(str::len), Some(384));
    }
    assert_eq!(all.iter().filter(|line| line["line"] == "worst").count(), 10);
    let limited = lines(&folder, "results/newton-coherent.f64.newton-steps.4.jsonl");
    assert!(line(&limited, "counts")["gave_up"]["newton-steps"].as_u64() > Some(0));

    // Only what is not finished is measured; half a file is not finished.
    let finished = folder.text(name);
    let half = "results/newton-coherent.f64.newton-steps.4.jsonl";
    let text = folder.text(half);
    folder.put(half, &text[..text.len() / 2]);
    let output = folder.done(&format!("{SMALL} {only} -o results --json"));
    let done: Value = serde_json::from_str(&printed(&output)).expect("JSON");
    assert_eq!((&done["cells"], &done["finished_before"]), (&2.into(), &1.into()));
    assert_eq!(folder.text(name), finished, "it was measured again");
    assert_eq!(line(&lines(&folder, half), "end")["line"], "end");
    assert!(said(&output).contains("1 finished before, 1 measured"), "{}", said(&output));

    // Another picture, or other settings, do not go into the same folder.
    folder.fails(&format!("study --size 8x8 {only} -o results"), 2, &["another folder"]);
}

#[test]
fn a_replay_answers_as_the_study_did() {
    let folder = Folder::new();
    for (scene, id) in [
        ("", "clipping-predicted.f64.default"),
        ("scene.toml", "newton-coherent.f32.tolerance.0.001"),
        ("teapot.bpt", "clipping.f64.clip-steps.10"),
        ("teapot.bpt", "clipping-coherent.f64.grid-density.0.25"),
    ] {
        let results = format!("results-{id}");
        folder.done(&format!("{SMALL} {scene} --only {id} -o {results}"));
        let all = lines(&folder, &format!("{results}/{id}.jsonl"));
        let worst: Vec<&Value> = all.iter().filter(|line| line["line"] == "worst").collect();
        assert!(worst.len() > 5, "{id}: {}", worst.len());
        for worst in worst.iter().take(2) {
            let command = worst["command"].as_str().expect("a command");
            let words = command.strip_prefix("patchray ").expect("a command of patchray");
            let replay: Value = serde_json::from_str(&printed(&folder.done(&format!("{words} --json")))).expect("JSON");
            assert_eq!(
                (&replay["t"], &replay["kind"], &replay["error"], &replay["margin"]),
                (&worst["t"], &worst["kind"], &worst["error"], &worst["margin"]),
                "{command}"
            );
            assert!(printed(&folder.done(words)).contains("verdict"));
            // The ray alone, for `query`.
            let query = replay["query"].as_str().expect("a command");
            let (rays, words) = query.split_once(" | patchray ").expect("two commands");
            let rays = rays.strip_prefix("printf '").and_then(|rays| rays.strip_suffix('\'')).expect("quoted");
            folder.put("ray.csv", rays.replace("\\n", "\n"));
            let words = words.replace(" - ", " ray.csv ").replace("fixtures/patches/", "");
            let answers = printed(&folder.done(&words));
            assert_eq!(answers.lines().count(), 2, "{query}");
        }
    }
    folder.fails("study --pixel 1,1", 2, &["--only ID"]);
    folder.fails("study --only clipping.f64.default --size 8x8 --pixel 8,1", 2, &["no pixel 8,1"]);
}

#[test]
fn a_report_names_what_is_missing_and_asks_for_nothing_from_elsewhere() {
    let folder = Folder::new();
    folder.fails("report results", 3, &["study.json"]);
    folder.done(&format!("{SMALL} --only clipping.f64.default --only newton.f64.flatness.0.03 -o results"));
    folder.put("results/clipping.f32.default.jsonl", "{\"line\":\"end\"}\n");
    let output = folder.done("report results -o page.html");
    let told = said(&output);
    for part in
        ["2 cells drawn, 334 missing", "missing: newton.f32.default", "clipping.f32.default (its file is not whole"]
    {
        assert!(told.contains(part), "{part}: {told}");
    }
    let page = folder.text("page.html");
    assert!(page.contains("334 of 336 cells are missing") && page.contains("newton.f32.default"));
    assert!(page.contains("24 × 16 rays") && page.contains("newton.f64.flatness.0.03"));
    for outside in ["<script", "<link", "@import", "url(", " src=", "href=\"http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    let drawing = folder.text("page-work-precision-f64.svg");
    assert!(drawing.starts_with("<svg") && page.contains(&drawing));
    assert!(folder.names().contains(&"page-map-error-clipping-f64.svg".to_owned()));
    // Without a name the page lies with the results, and does not pass for one of them.
    folder.done("report results --quiet");
    assert!(folder.text("results/report.html").contains("334 of 336"));
}

#[test]
fn the_figures_of_a_report_come_as_json() {
    let folder = Folder::new();
    let only = "--only newton.f64.default --only newton.f64.paper";
    folder.done(&format!("{SMALL} {only} -o results"));
    let data: Value = serde_json::from_str(&printed(&folder.done("report results --json -o page.html"))).expect("JSON");
    assert_eq!((&data["schema"], &data["size"]), (&1.into(), &serde_json::json!([24, 16])));
    let ids: Vec<&str> =
        data["cells"].as_array().expect("a list").iter().filter_map(|cell| cell["id"].as_str()).collect();
    assert_eq!(ids, ["newton.f64.default", "newton.f64.paper"]);
    assert_eq!(data["missing"].as_array().map(Vec::len), Some(334));
    assert!(data["acceptance"][0]["time_ratio"].as_f64() > Some(0.0), "{data}");
    assert!(folder.text("page.html").contains("The price of being sure"));
    folder.done("report results --quiet --stats figures.json");
    assert_eq!(folder.json("figures.json"), data);
    // The page alone may go to standard output, and so may the figures; neither replaces what it is made of.
    folder.fails("report results -o - --json", 2, &["standard output"]);
    folder.fails("report results -o results/study.json", 2, &["replace an input"]);
    folder.fails("report results --stats results/newton.f64.paper.jsonl", 2, &["replace an input"]);
}

#[test]
fn help_says_that_results_go_into_a_folder() {
    let help = printed(&Folder::new().done("study --help"));
    assert!(help.contains("--output <FOLDER>") && help.contains("[default: target/study]"), "{help}");
    assert!(!help.contains("--output <FILE>"), "{help}");
}
