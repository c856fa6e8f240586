use super::*;
use crate::scene::paper::SCENES;

fn report() -> Report {
    let times = |seconds: f64| Times::of(vec![seconds]);
    let run = |method, coherence, took: f64| Run {
        method,
        coherence,
        times: times(took),
        gain: 1.0 - took / 0.05,
        rays: 4,
        hit_rays: 3,
        gave_up: u64::from(!coherence),
        intersection_points: 123_456,
        found_twice: Some(1000),
        agreement: Some(Agreement { right: 1, wrong: 7, missed: 8, phantom: 9, ..Agreement::default() }),
    };
    let scene = SceneReport {
        name: "teapot",
        paper: SCENES[0].figures,
        surfaces: 32,
        patches: 7584,
        oracle: Some(OracleStats { rays: 4, hit_rays: 3, roots: 5, open: 0, seconds: 1.0 }),
        numerical: vec![run(Method::Newton, true, 0.05), run(Method::NewtonPredicted, false, 0.03)],
        clipping: vec![run(Method::Clipping, true, 0.05)],
        sampling: vec![SamplingRun {
            method: Method::NewtonCoherent,
            uniform: times(0.2),
            jittered: times(0.204),
            gain: -0.02,
        }],
        rays: vec![RaysRun {
            kind: RaysKind::Shadow,
            rays: 3,
            method: Method::Clipping,
            original: times(0.1),
            coherent: times(0.11),
            gain: -0.1,
            intersection_points: [2000, 1000],
            any_hit: Some(times(0.0512)),
        }],
    };
    Report {
        schema: 1,
        version: "0",
        size: [512, 512],
        precision: Precision::F64,
        acceptance: Acceptance::Paper,
        repetitions: 1,
        oracle_threads: 2,
        seconds: 9.0,
        scenes: vec![scene],
    }
}

#[test]
fn the_paper_s_rows_stand_above_ours() {
    let text = report().to_text(Style::Markdown);
    for row in [
        "| Fig. 8 | 7594/32 | paper, original | 10.7 |  |  | 110,169 |  |  |  |  |",
        "|  |  | paper, improved | 8.57 |  | 20 | 100,337 |  |  |  |  |",
        "| teapot | 7584/32 | newton | 0.0500 | 0 |  | 123,456 | 1,000 | 7 | 8 | 9 |",
        "|  |  | newton-predicted, nothing kept | 0.0300 | 0 | 40 | 123,456 | 1,000 | 7 | 8 | 9 |",
        "| Fig. 8 | 7594/32 | paper, original | 32.9 |  |  | 146,910 |  |  |  |  |",
        "| Fig. 8 | 7594/32 | paper, improved numerical | 33.9 | 34.7 |  | -1 |",
        "| teapot | 7584/32 | newton-coherent | 0.200 | 0.204 | 0 | -2 |",
        "| teapot | shadow | 3 | clipping | 0.100 | 0.110 | 0 | -10 | 2,000 | 1,000 | 0.0512 |",
    ] {
        assert!(text.contains(row), "{row}\n{text}");
    }
    let rows = text.lines().filter(|line| line.starts_with('|'));
    assert!(rows.clone().count() == 4 * 2 + 4 + 3 + 2 + 1, "{text}");
    assert!(text.contains("newton-predicted, nothing kept on teapot: 1 rays were given up"), "{text}");
}

#[test]
fn text_has_the_same_cells() {
    let report = report();
    let words = |style| {
        let text = report.to_text(style).replace(['|', '*'], " ").replace("---:", "").replace("---", "");
        text.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(words(Style::Text), words(Style::Markdown));
    let json = serde_json::to_value(&report).expect("plain data");
    assert_eq!(json["scenes"][0]["numerical"][1]["method"], "newton-predicted");
    assert_eq!(json["scenes"][0]["paper"]["numerical"]["points"][0], 110_169);
}
