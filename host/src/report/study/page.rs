//! The page itself.

use std::fmt::Write as _;

use super::charts::{Section, title_of};
use super::{Drawing, FAILED, Point, StudyReport, data, tables};
use crate::report::plot::escaped;
use crate::report::table::grouped;
use crate::study::machine::Machine;
use crate::study::plan::Knob;

const STYLE: &str = include_str!("page.css");

/// The page, as HTML. It asks for nothing from elsewhere.
pub(super) fn html(
    report: &StudyReport,
    points: &[Point],
    sections: &[Section],
    heat: &[(Drawing, Vec<Drawing>); 2],
    stem: &str,
) -> String {
    let manifest = &report.manifest;
    let [width, height] = manifest.size;
    let title = format!("Error against run time: {}", manifest.scene);
    let mut page = String::new();
    let mut add = |args: std::fmt::Arguments| {
        // Writing to a string cannot fail.
        let _ = writeln!(page, "{args}");
    };
    add(format_args!("<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">"));
    add(format_args!("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"));
    add(format_args!("<title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>", escaped(&title)));
    add(format_args!("<h1>{}</h1>", escaped(&title)));
    add(format_args!("<p class=\"answer\">{}</p>", answer(points)));
    add(format_args!("{}", missing(report)));
    add(format_args!(
        "<p>{width} × {height} rays of one view against {} surfaces, each answer held against the oracle's. An error is how \
         far t is off along the ray, as a share of the model's diagonal ({:.4}); it is of hits on the closest sheet. A ray is \
         lost if the answer is another sheet, missed, phantom or given up. A cell fails if more than {} of 1000 rays are \
         lost. In f32, rays and surfaces are rounded before they are traced, and what that does to the answer is part of the \
         error.</p>",
        grouped(manifest.surfaces),
        manifest.diagonal,
        FAILED * 1e3
    ));
    add(format_args!("{}", machines(report)));

    add(format_args!("<h2>Methods with default settings</h2>\n{}", tables::defaults(points)));
    add(format_args!(
        "<p class=\"note\">Off: on the right sheet, but by more than the allowance (1e-9 of the diagonal in f64, 5e-6 in \
         f32, more where a ray all but grazes). Doubled: roots found more than once. Paper: under <code>--acceptance \
         paper</code>.</p>"
    ));
    if let Some(prices) = tables::prices(&data::prices(points)) {
        add(format_args!("<h2>The price of being sure</h2>\n{prices}"));
        add(format_args!(
            "<p class=\"note\">Under <code>--acceptance paper</code> a patch holds at most one hit by eq. (1) of the paper, and \
             none where Newton's method finds none; under <code>proved</code>, the default, that has to be proved, or the patch \
             is clipped. <code>clipping</code> proves all its answers in any case. Not right: off, another sheet, missed, \
             phantom, or given up.</p>"
        ));
    }
    for (knob, drawings) in sections {
        let head =
            if *knob == Knob::Default { "Error over time".to_owned() } else { format!("Over {}", title_of(*knob)) };
        add(format_args!("<h2>{head}</h2>"));
        if let Some(note) = note_of(*knob) {
            add(format_args!("<p>{note}</p>"));
        }
        let pairs = if *knob == Knob::Default { " pairs" } else { "" };
        add(format_args!("<div class=\"plots{pairs}\">"));
        for drawing in drawings {
            add(format_args!("{}", figure(drawing)));
        }
        add(format_args!("</div>"));
    }
    add(format_args!("<h2>The ten worst rays</h2>"));
    add(format_args!(
        "<p>Of all methods with default settings: lost rays first, then those that use up most of their precision's \
         allowance. The margin says how far the ray may move, in diagonals, before the true answer changes: below some 2e-5 \
         in f32, and 1e-12 in f64, the ray grazes and cannot be judged. The command traces the ray's scan line again, and \
         says how to ask <code>query</code> the same.</p>\n{}",
        tables::worst(points)
    ));
    for (head, (legend, maps)) in ["Where the errors are", "Where the work is"].into_iter().zip(heat) {
        add(format_args!("<h2>{head}</h2>"));
        if maps.is_empty() {
            add(format_args!("<p class=\"note\">No cell that is there has such a map.</p>"));
            continue;
        }
        add(format_args!("<div class=\"legend\">{}</div>\n<div class=\"maps\">", figure(legend)));
        for drawing in maps {
            add(format_args!("{}", figure(drawing)));
        }
        add(format_args!("</div>"));
    }
    add(format_args!(
        "<h2>All cells</h2>\n<details><summary>{} cells, with what each did per ray</summary>\n{}</details>",
        report.records.len(),
        tables::all(points, &report.records)
    ));
    add(format_args!(
        "<p class=\"note\">The diagrams lie beside this page as <code>{}-*.svg</code>, the numbers in the study's folder as a \
         file of JSON lines per cell.</p>\n</body>\n</html>",
        escaped(stem)
    ));
    page
}

fn figure(drawing: &Drawing) -> String {
    let caption = if drawing.caption.is_empty() {
        String::new()
    } else {
        format!("<figcaption>{}</figcaption>", escaped(&drawing.caption))
    };
    format!("<figure>{}{caption}</figure>", drawing.svg)
}

/// What there is to know before reading a knob's diagrams.
fn note_of(knob: Knob) -> Option<&'static str> {
    match knob {
        Knob::Default => Some("Down and to the left is better. What lies on the upper border failed."),
        Knob::ClipThreshold => Some(
            "The paper bisects an interval if a clip removes less than 20 % of it. Solid lines are f64, dashed ones f32.",
        ),
        Knob::NewtonSteps | Knob::ClipSteps => Some("A ray that runs out of a limit is given up, and counts as lost."),
        _ => None,
    }
}

/// How much faster than default settings others have to be for the answer to name them: less than that is noise.
const FASTER: f64 = 0.9;

/// Which method and setting to take, in a sentence of HTML.
pub(super) fn answer(points: &[Point]) -> String {
    let fit = |error: f64| {
        let fit = || {
            points.iter().filter(move |point| {
                let counts = &point.measured.counts;
                let sound = counts.lost() == 0 && counts.undecided == 0;
                sound && point.measured.errors.t.most <= error
            })
        };
        let fastest = fit().min_by(|a, b| a.ns.total_cmp(&b.ns))?;
        let defaults = fit().filter(|point| point.record.head.knob == Knob::Default);
        let plain = defaults.min_by(|a, b| a.ns.total_cmp(&b.ns)).filter(|plain| fastest.ns >= FASTER * plain.ns);
        Some(plain.unwrap_or(fastest))
    };
    let say = |point: &Point| format!("{} ({:.0} ns per ray)", setting_of(point), point.ns);
    let rays = points.first().map_or(0, |point| point.measured.counts.rays);
    let loses = format!("of {} rays it loses none", grouped(rays));
    match (fit(1e-12), fit(1e-5)) {
        (Some(exact), Some(coarse)) if FASTER * exact.ns <= coarse.ns => format!(
            "Take {}: {loses}, 99.9 % of its errors are below 1e-12 of the diagonal, and nothing coarser is faster.",
            say(exact)
        ),
        (Some(exact), Some(coarse)) => format!(
            "For errors below 1e-12 of the diagonal take {}; where 1e-5 will do, {}: {loses}, and neither does the other.",
            say(exact),
            say(coarse)
        ),
        (None, Some(coarse)) => format!(
            "For errors below 1e-5 of the diagonal take {}: {loses}. Nothing that was measured stays below 1e-12.",
            say(coarse)
        ),
        _ => "Nothing that was measured stays below 1e-5 of the diagonal and loses no ray.".to_owned(),
    }
}

/// The flags of a cell, as a reader would write them, in HTML.
fn setting_of(point: &Point) -> String {
    let head = &point.record.head;
    let value = head.value.map_or(String::new(), |value| format!(" {}", crate::number::Shortest(value)));
    let own = match head.knob {
        Knob::Default => " with default settings".to_owned(),
        Knob::Paper => " with <code>--acceptance paper</code>".to_owned(),
        Knob::NewtonSteps | Knob::ClipSteps => {
            format!(" with <code>--limit {}={}</code>", head.knob.name(), value.trim())
        }
        knob => format!(" with <code>--{}{value}</code>", knob.name()),
    };
    format!("<code>{}</code> in {}{own}", head.method.name(), head.precision.name())
}

/// What is not there yet.
fn missing(report: &StudyReport) -> String {
    let all = report.records.len() + report.missing.len();
    let not_traced = report.not_traced().count();
    let not_traced = if not_traced > 0 {
        format!(
            "<p class=\"missing\">{not_traced} of {all} cells could not be traced at all, and are in no diagram.</p>"
        )
    } else {
        String::new()
    };
    if report.missing.is_empty() {
        return format!("<p class=\"note\">All {all} cells are there.</p>{not_traced}");
    }
    let names: Vec<String> = report
        .missing
        .iter()
        .map(|(id, reason)| match reason {
            Some(reason) => format!("<code>{}</code> (not whole: {})", escaped(id), escaped(reason)),
            None => format!("<code>{}</code>", escaped(id)),
        })
        .collect();
    format!(
        "<div class=\"missing\"><details><summary>{} of {all} cells are missing: run the study again to measure \
         them</summary><p>{}</p></details></div>{not_traced}",
        names.len(),
        names.join(", ")
    )
}

/// On what it was measured.
fn machines(report: &StudyReport) -> String {
    let all = report.machines();
    let mut html = String::new();
    for (machine, cells) in &all {
        let Machine { processor, cores, system, architecture, version, compiler, release } = machine;
        let of = if all.len() > 1 { format!(" ({cells} cells)") } else { String::new() };
        let build = if *release { "" } else { ", not built for release" };
        let words = [format!("patchray {version}{build}"), compiler.clone(), processor.clone()];
        let words: Vec<String> = words.into_iter().filter(|word| !word.is_empty()).collect();
        let _ = writeln!(
            html,
            "<p class=\"note\">{}, {cores} threads, {system} {architecture}{of}.</p>",
            escaped(&words.join(", "))
        );
    }
    let repetitions =
        report.records.iter().filter_map(|record| Some(record.result.as_ref().ok()?.time.repetitions.len()));
    let repetitions = repetitions.min().unwrap_or(0);
    let _ = writeln!(
        html,
        "<p class=\"note\">Times are of intersecting alone, on one thread: medians of {repetitions} repetitions or more, cells \
         of a setting in turn. Each repetition is divided by that of <code>clipping</code> in f64 just before it, and \
         multiplied by the median of all of those, so that what else the machine did counts less; the spread, from the first \
         to the third quartile, is that of the bare times.</p>"
    );
    html
}
