//! `patchray tables`.

use serde_json::Value;

use super::{Folder, printed};

/// Few pixels and few patches: what is measured so means nothing, but all of it is there.
const SMALL: &str = "tables --size 16x12 --repetitions 1 --flatness 0.01";

#[test]
fn tables_hold_the_paper_s_figures_beside_ours() {
    let folder = Folder::new();
    let text = printed(&folder.done(&format!("{SMALL} --stats s.json")));
    for number in 1..=8 {
        assert!(text.contains(&format!("Table {number}. ")), "{number}: {text}");
    }
    for part in ["110,169", "1,170,938", "improved, nothing kept", "ours: predicted, in a view", "pruning"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let report = folder.json("s.json");
    assert_eq!((&report["schema"], &report["size"]), (&1.into(), &serde_json::json!([16, 12])));
    let scenes = report["scenes"].as_array().expect("a list");
    assert_eq!(scenes.len(), 4);
    for scene in scenes {
        assert_eq!(scene["surfaces"], scene["paper"]["surfaces"]);
        let hits = scene["oracle"]["hit_rays"].as_i64().expect("a count");
        for family in ["numerical", "clipping"] {
            let letter = scene[family]["letter"].as_array().expect("a list");
            assert_eq!(letter.len(), 3);
            for run in letter {
                assert_eq!(run["rays"], 192);
                assert!((run["hit_rays"].as_i64().expect("a count") - hits).abs() <= 1, "{run}");
            }
            assert_eq!(scene[family]["cameras"].as_array().map(Vec::len), Some(4));
        }
    }
}

#[test]
fn tables_come_as_a_document_and_as_json_without_the_oracle() {
    let folder = Folder::new();
    let flags = "--skip-oracle --precision f32 --markdown --json -o tables.md";
    let report: Value = serde_json::from_str(&printed(&folder.done(&format!("{SMALL} {flags}")))).expect("JSON");
    assert_eq!(report["precision"], "f32");
    assert!(report["scenes"][0]["oracle"].is_null());
    assert!(report["scenes"][0]["numerical"]["letter"][0]["agreement"].is_null());
    let markdown = folder.text("tables.md");
    assert!(markdown.contains("| Fig. 11 | 39358/340 | paper, original | 145 |"), "{markdown}");
    for part in ["# ", "## Question", "## Why the figures differ", "## How to repeat it"] {
        assert!(markdown.contains(part), "{part}: {markdown}");
    }
    folder.fails("tables --method newton", 2, &["compares all methods"]);
    folder.fails("tables --by-the-letter", 2, &["compares all methods"]);
}
