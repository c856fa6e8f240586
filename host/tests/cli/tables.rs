//! `patchray tables`.

use serde_json::Value;

use super::{Folder, printed};

/// Few pixels and few patches: what is measured so means nothing, but all of it is there.
const SMALL: &str = "tables --size 16x12 --repetitions 1 --flatness 0.01";

#[test]
fn tables_hold_the_paper_s_figures_beside_ours() {
    let folder = Folder::new();
    let text = printed(&folder.done(&format!("{SMALL} --stats s.json")));
    for part in ["Table 1", "Table 2", "Table 3", "Table 4", "110,169", "1,170,938", "newton-predicted, nothing kept"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let report = folder.json("s.json");
    assert_eq!((&report["schema"], &report["size"]), (&1.into(), &serde_json::json!([16, 12])));
    let scenes = report["scenes"].as_array().expect("a list");
    assert_eq!(scenes.len(), 4);
    for scene in scenes {
        assert_eq!(scene["surfaces"], scene["paper"]["surfaces"]);
        let hits = &scene["oracle"]["hit_rays"];
        for run in ["numerical", "clipping"].into_iter().flat_map(|table| scene[table].as_array().expect("a list")) {
            assert_eq!(run["rays"], 192);
            let off = run["hit_rays"].as_i64().expect("a count") - hits.as_i64().expect("a count");
            assert!(off.abs() <= 1, "{run}");
        }
    }
}

#[test]
fn tables_come_as_markdown_and_as_json_without_the_oracle() {
    let folder = Folder::new();
    let flags = "--skip-oracle --precision f32 --markdown --json -o tables.md";
    let report: Value = serde_json::from_str(&printed(&folder.done(&format!("{SMALL} {flags}")))).expect("JSON");
    assert_eq!(report["precision"], "f32");
    assert!(report["scenes"][0]["oracle"].is_null() && report["scenes"][0]["numerical"][0]["agreement"].is_null());
    let markdown = folder.text("tables.md");
    assert!(markdown.contains("| Fig. 11 | 39358/340 | paper, original | 145 |"), "{markdown}");
    folder.fails("tables --method newton", 2, &["compares all methods"]);
}
