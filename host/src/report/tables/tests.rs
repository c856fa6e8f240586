use super::*;
use crate::experiment::Counts;
use crate::experiment::cost::Work;
use crate::experiment::subject::{Subject, changes, ladder, letter};
use crate::report::times::Times;
use crate::scene::paper::SCENES;

fn report() -> Report {
    let run = |subject: &Subject, took: f64| Run {
        subject: subject.clone(),
        times: Times::of(vec![took]),
        rays: 4,
        hit_rays: 3,
        gave_up: u64::from(subject.name == "improved"),
        counts: Counts::of_named(&[("intersection_points", 123_456), ("clip_steps", 77), ("newton_starts", 55)]),
        found_twice: Some(1000),
        agreement: Some(Agreement { right: 1, wrong: 7, missed: 8, phantom: 9, ..Agreement::default() }),
    };
    let family = |family: Family| {
        let [original, improved, nothing_kept] = &letter(family);
        let pair = |[a, b]: [f64; 2]| vec![run(original, a), run(improved, b)];
        FamilyReport {
            letter: [pair([0.05, 0.04]), vec![run(nothing_kept, 0.06)]].concat(),
            cameras: vec![CameraReport { name: "20° left", runs: pair([0.05, 0.06]) }],
            samplings: vec![SamplingReport { uniform: run(improved, 0.2), jittered: run(improved, 0.204) }],
            incoherent: vec![IncoherentReport { rays: "shadow", runs: pair([0.1, 0.11]) }],
            ladder: ladder(family).iter().map(|subject| run(subject, 0.03)).collect(),
            changes: changes(family)
                .iter()
                .map(|change| ChangeReport {
                    name: change.name,
                    before: pair([0.05, 0.04]),
                    after: change.subjects.iter().map(|subject| run(subject, 0.025)).collect(),
                })
                .collect(),
            cost: Model {
                work: [Work { steps: 100, tests: 100 }, Work { steps: 50, tests: 200 }],
                ratio: None,
                most: 0.5,
            },
        }
    };
    let scene = SceneReport {
        name: "teapot",
        paper: SCENES[0].figures,
        surfaces: 32,
        patches: 7584,
        preparation: Preparation { surfaces: 0.001, trees: 0.01, grids: 0.02 },
        oracle: Some(OracleStats { rays: 4, hit_rays: 3, roots: 5, open: 0, seconds: 1.0 }),
        numerical: family(Family::Numerical),
        clipping: family(Family::Clipping),
    };
    Report {
        schema: 1,
        version: "0",
        size: [512, 512],
        small: [256, 256],
        precision: Precision::F64,
        acceptance: Acceptance::Paper,
        repetitions: 1,
        fewer: 1,
        threads: 2,
        seconds: 9.0,
        scenes: vec![scene],
    }
}

#[test]
fn the_paper_s_rows_stand_above_ours() {
    let text = report().to_text(Style::Markdown);
    for row in [
        "| Fig. 8 | 7594/32 | paper, original | 10.7 |  |  |  | 110,169 |  |  |  |  |",
        "|  |  | paper, improved | 8.57 |  | 20 |  | 100,337 |  |  |  |  |",
        "| teapot | 7584/32 | newton, original | 0.0500 | 0 |  |  | 123,456 | 1,000 | 7 | 8 | 9 |",
        "|  |  | newton-coherent, improved | 0.0400 | 0 | 20 | -20 to 20 | 123,456 | 1,000 | 7 | 8 | 9 |",
        "|  |  | newton-coherent, improved, nothing kept | 0.0600 | 0 | -20 |  | 123,456 | 1,000 | 7 | 8 | 9 |",
        "| Fig. 8 | 7594/32 | paper, original | 32.9 |  |  |  | 146,910 |  |  |  |  |",
        "| Fig. 8 | paper, improved numerical | 33.9 |  | 34.7 |  | -1 |",
        "| teapot | newton-coherent, improved | 0.200 | 0 | 0.204 | 0 | -2 |",
        "| teapot | shadow | 4 | newton-coherent | 0.100 | 0.110 | 0 | -10 |",
        "| teapot | newton-coherent | pruning | 50 | 38 | 20 | 0 | 123,456 | 123,456 | 123,456 | 123,456 |",
        "| teapot | Newton step | 100 | 50 | 100 | 200 | 20 | none | 13 | 36 | 45 | 50 |",
    ] {
        assert!(text.contains(row), "{row}\n{text}");
    }
    assert!(text.contains("newton-coherent, improved, on teapot: 1 rays were given up"), "{text}");
}

#[test]
fn text_has_the_same_cells() {
    let report = report();
    for table in 0..report.tables().len() {
        let words = |style| {
            let text =
                report.tables()[table].to_text(style).replace(['|', '*'], " ").replace("---:", "").replace("---", "");
            text.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(words(Style::Text), words(Style::Markdown));
    }
    let json = serde_json::to_value(&report).expect("plain data");
    assert_eq!(json["scenes"][0]["numerical"]["letter"][1]["subject"]["method"], "newton-coherent");
    assert_eq!(json["scenes"][0]["numerical"]["letter"][1]["counts"]["intersection_points"], 123_456);
    assert_eq!(json["scenes"][0]["paper"]["numerical"]["points"][0], 110_169);
}
