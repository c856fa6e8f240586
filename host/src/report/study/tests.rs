use super::*;
use crate::stats::SCHEMA;
use crate::study::plan::{Cell, plan};
use crate::study::record::tests::record;

fn report(cells: &[Cell], missing: &[&str]) -> StudyReport {
    let ids = cells.iter().map(Cell::id).chain(missing.iter().map(|&id| id.to_owned()));
    StudyReport {
        manifest: Manifest {
            schema: SCHEMA,
            scene: "a <scene>".to_owned(),
            size: [2, 1],
            fingerprint: "0".to_owned(),
            surfaces: 1,
            diagonal: 1.0,
            settings: serde_json::Value::Null,
            cells: ids.collect(),
        },
        // The later, the slower and the more exact; every seventh loses one of a hundred rays.
        records: cells
            .iter()
            .enumerate()
            .map(|(place, cell)| {
                let lost = if place % 7 == 3 { 10 } else { 0 };
                record(cell, 1e-6 * (1.0 + place as f64), 1e-5 / (1.0 + place as f64).powi(4), lost)
            })
            .collect(),
        missing: missing.iter().map(|&id| (id.to_owned(), None)).collect(),
    }
}

#[test]
fn the_page_is_whole_and_asks_for_nothing_from_elsewhere() {
    let cells = plan(None, None);
    let Rendered { html, drawings } = report(&cells, &["clipping.f64.gone"]).render("study");
    for text in drawings.iter().map(|drawing| &drawing.svg).chain([&html]) {
        for outside in ["<script", "<link", "src=", "@import", "url(", "href=\"http", "NaN", "<iframe"] {
            assert!(!text.contains(outside), "{outside}");
        }
        // The name of SVG's own language is the one address there is, and is not fetched.
        assert_eq!(text.matches("http").count(), text.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());
    }
    assert!(html.contains("1 of 337 cells are missing") && html.contains("clipping.f64.gone"));
    assert!(html.contains("a &lt;scene&gt;") && !html.contains("a <scene>"));
    for part in [
        "work-precision-f64",
        "work-precision-f32",
        "distribution-f64",
        "clip-threshold-lost-rays",
        "map-error-newton-f32",
        "map-error-legend",
        "map-work-clipping-predicted-f64",
        "map-work-legend",
    ] {
        assert!(drawings.iter().any(|drawing| drawing.name == part), "{part}");
    }
    let names: std::collections::BTreeSet<&str> = drawings.iter().map(|drawing| drawing.name.as_str()).collect();
    assert_eq!(names.len(), drawings.len());
    for cell in &cells {
        assert!(html.contains(&format!(">{}</td>", cell.id())), "{} is not in the table", cell.id());
    }
    assert_eq!(html.matches("<code>patchray study --only").count(), 10);
}

#[test]
fn failed_cells_stand_on_the_border_and_are_counted() {
    let cells = plan(None, Some(Precision::F64));
    let report = report(&cells, &[]);
    let failed = report.points().iter().filter(|point| point.failed()).count();
    let drawings = report.render("study").drawings;
    let work = drawings.iter().find(|drawing| drawing.name == "work-precision-f64").expect("it is drawn");
    assert!(failed > 10 && work.svg.contains(&format!("{failed} failed")), "{failed}");
}

#[test]
fn the_answer_names_the_fastest_that_loses_nothing() {
    let cells = plan(None, None);
    let first = &cells[0];
    let Rendered { html, .. } = report(&cells, &[]).render("study");
    let coarse = format!("<code>{}</code> in {} with default settings", first.method.name(), first.precision.name());
    assert!(html.contains(&format!("where 1e-5 will do, {coarse}")), "{}", &html[..4000]);
    let mut nothing = report(&cells[..4], &[]);
    nothing.records.drain(..3);
    let nothing = nothing.render("study").html;
    assert!(nothing.contains("Nothing that was measured"));
    assert!(report(&[], &["a"]).render("study").html.contains("1 of 1 cells are missing"));
}

#[test]
fn a_map_of_work_is_drawn_for_each_method_and_left_out_where_nothing_was_counted() {
    let cells = plan(None, None);
    let work = |report: &StudyReport| {
        let drawings = report.render("study").drawings;
        let names = drawings.into_iter().map(|drawing| drawing.name).filter(|name| name.starts_with("map-work-"));
        names.collect::<Vec<String>>()
    };
    let whole = report(&cells, &[]);
    assert_eq!(work(&whole).len(), 7);
    // In f32 only where f64 is missing.
    let mut half = whole.clone();
    half.records.retain(|record| record.head.id != "newton.f64.default");
    assert!(work(&half).contains(&"map-work-newton-f32".to_owned()) && work(&half).len() == 7);
    let mut none = whole;
    for record in &mut none.records {
        record.result.as_mut().expect("measured").map.steps.clear();
    }
    assert!(work(&none).is_empty() && none.render("study").html.contains("No cell that is there has such a map"));
}

#[test]
fn data_has_the_figures_of_the_page() {
    let cells = plan(None, None);
    let mut report = report(&cells, &["clipping.f64.gone"]);
    report.records[1].result = Err("no room".to_owned());
    let data = serde_json::to_value(report.data()).expect("plain");
    let list = |name: &str| data[name].as_array().expect("a list").clone();
    assert_eq!((data["schema"].as_u64(), list("cells").len()), (Some(u64::from(SCHEMA)), cells.len() - 1));
    assert_eq!(
        (&list("missing")[0]["id"], &list("not_traced")[0]["reason"]),
        (&"clipping.f64.gone".into(), &"no room".into())
    );
    let html = report.render("study").html;
    assert!(html.contains("1 of 337 cells could not be traced at all"));
    for cell in list("cells") {
        let ns = cell["ns_per_ray"].as_f64().expect("a number");
        let row = format!("<td class=\"text\">{}</td><td>{ns:.0}</td>", cell["id"].as_str().expect("a name"));
        assert!(html.contains(&row), "{row}");
    }
    let failed = list("cells").iter().filter(|cell| cell["failed"] == true).count();
    assert_eq!(failed, report.points().iter().filter(|point| point.failed()).count());
    let machines: u64 = list("machines").iter().map(|machine| machine["cells"].as_u64().expect("a count")).sum();
    assert_eq!(machines, cells.len() as u64);
    for worst in list("worst") {
        assert!(html.contains(worst["command"].as_str().expect("a command")));
    }
    let answer = data["answer"].as_str().expect("a sentence");
    assert!(answer.ends_with('.') && answer.contains('`') && !answer.contains('<'), "{answer}");
}

#[test]
fn the_price_of_being_sure_is_told_where_both_were_measured() {
    let cells = plan(None, None);
    let whole = report(&cells, &[]);
    let prices = data::prices(&whole.points());
    assert_eq!(prices.len(), 10);
    assert!(prices.iter().all(|price| price.method != Method::Clipping));
    let points = whole.points();
    let ns = |id: &str| points.iter().find(|point| point.record.head.id == id).expect("it is there").ns;
    let own = [ns("newton.f64.paper"), ns("newton.f64.default")];
    assert_eq!((prices[0].ns_per_ray, prices[0].time_ratio), (own, own[1] / own[0]));
    assert!(whole.render("study").html.contains("The price of being sure"));
    // Without the paper's cells, or where all cells have its acceptance, there is nothing to compare.
    let mut proved = whole.clone();
    proved.records.retain(|record| record.head.knob != Knob::Paper);
    assert!(data::prices(&proved.points()).is_empty());
    assert!(!proved.render("study").html.contains("The price of being sure"));
    let mut paper = whole.clone();
    for record in &mut paper.records {
        record.head.settings["acceptance"] = "paper".into();
    }
    assert!(data::prices(&paper.points()).is_empty());
}
