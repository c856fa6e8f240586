//! The tables of a study's page.

use super::Point;
use super::data::Price;
use crate::judge::allowance;
use crate::report::plot::escaped;
use crate::report::table::grouped;
use crate::study::plan::Knob;
use crate::study::record::{Record, Worst};

/// A table as HTML. The heads say for each column whether its cells are text.
fn table(heads: &[(&str, bool)], rows: &[Vec<String>]) -> String {
    let class = |place: usize| if heads.get(place).is_some_and(|(_, text)| *text) { " class=\"text\"" } else { "" };
    let mut html = String::from("<div class=\"wide\"><table>\n<thead><tr>");
    for (place, (head, _)) in heads.iter().enumerate() {
        html += &format!("<th{}>{}</th>", class(place), escaped(head));
    }
    html += "</tr></thead>\n<tbody>\n";
    for row in rows {
        html += "<tr>";
        for (place, cell) in row.iter().enumerate() {
            html += &format!("<td{}>{cell}</td>", class(place));
        }
        html += "</tr>\n";
    }
    html + "</tbody></table></div>\n"
}

/// An error, in two digits.
fn error(number: f64) -> String {
    if number > 0.0 { format!("{number:.1e}") } else { "0".to_owned() }
}

/// The columns that both tables of cells have.
const HEADS: [(&str, bool); 12] = [
    ("ns per ray", false),
    ("spread %", false),
    ("error 99.9 %", false),
    ("rms", false),
    ("max", false),
    ("residual max", false),
    ("off", false),
    ("other sheet", false),
    ("missed", false),
    ("phantom", false),
    ("doubled", false),
    ("gave up", false),
];

fn cells(point: &Point) -> Vec<String> {
    let (time, counts, errors) = (&point.measured.time, &point.measured.counts, &point.measured.errors);
    let limits: Vec<String> =
        counts.gave_up.iter().map(|(limit, count)| format!("{count} {}", escaped(limit))).collect();
    vec![
        format!("{:.0}", point.ns),
        format!("{:.0}", 100.0 * time.spread),
        error(errors.t.most),
        error(errors.t.rms),
        error(errors.t.max),
        error(errors.residual.max),
        grouped(counts.off),
        grouped(counts.other_sheet),
        grouped(counts.missed),
        grouped(counts.phantom),
        grouped(counts.doubled),
        if limits.is_empty() { "0".to_owned() } else { limits.join(", ") },
    ]
}

/// The cells with default settings, and those under the paper's acceptance.
pub(super) fn defaults(points: &[Point]) -> String {
    let mut heads = vec![("method", true), ("", true)];
    heads.extend(HEADS);
    heads.extend([("scene bytes", false), ("bytes per thread", false), ("prepared in ms", false)]);
    let mut shown: Vec<&Point> =
        points.iter().filter(|point| matches!(point.record.head.knob, Knob::Default | Knob::Paper)).collect();
    shown.sort_by_key(|point| std::cmp::Reverse(point.record.head.precision.name()));
    let rows: Vec<Vec<String>> = shown
        .into_iter()
        .map(|point| {
            let (head, counts) = (&point.record.head, &point.measured.counts);
            let paper = if head.knob == Knob::Paper { ", paper" } else { "" };
            let mut row = vec![format!("{}{paper}", head.method.name()), head.precision.name().to_owned()];
            row.extend(cells(point));
            row.extend([counts.bytes, counts.bytes_per_thread].map(grouped));
            row.push(format!("{:.1}", 1e3 * point.measured.time.prepare));
            row
        })
        .collect();
    table(&heads, &rows)
}

/// What it costs to be sure, and what it saves; nothing where no method was measured under both acceptances.
pub(super) fn prices(prices: &[Price]) -> Option<String> {
    let heads = [
        ("method", true),
        ("", true),
        ("paper ns per ray", false),
        ("proved ns per ray", false),
        ("time ratio", false),
        ("paper not right", false),
        ("proved not right", false),
    ];
    let row = |price: &Price| {
        let [paper, proved] = price.ns_per_ray.map(|ns| format!("{ns:.0}"));
        let [wrong, right] = price.not_right.map(grouped);
        let names = [price.method.name(), price.precision.name()].map(str::to_owned);
        let numbers = [paper, proved, format!("{:.2}", price.time_ratio), wrong, right];
        names.into_iter().chain(numbers).collect()
    };
    (!prices.is_empty()).then(|| table(&heads, &prices.iter().map(row).collect::<Vec<Vec<String>>>()))
}

/// All cells, with what they did.
pub(super) fn all(points: &[Point], records: &[Record]) -> String {
    let mut heads = vec![("cell", true)];
    heads.extend(HEADS);
    let work = [
        ("intersection_points", "points per ray"),
        ("newton_steps", "Newton steps"),
        ("clip_steps", "clips"),
        ("bisections", "bisections"),
        ("patches_tested", "patches tested"),
    ];
    heads.push(("patches", false));
    heads.push(("scene bytes", false));
    heads.extend(work.map(|(_, head)| (head, false)));
    let columns = heads.len();
    let mut rows: Vec<Vec<String>> = points
        .iter()
        .map(|point| {
            let counts = &point.measured.counts;
            let mut row = vec![point.record.head.id.clone()];
            row.extend(cells(point));
            row.extend([counts.patches, counts.bytes].map(grouped));
            let per_ray = |name: &str| counts.work.get(name).map_or(0.0, |&sum| sum as f64 / counts.rays.max(1) as f64);
            row.extend(work.map(|(name, _)| format!("{:.2}", per_ray(name))));
            row
        })
        .collect();
    for record in records {
        if let Err(reason) = &record.result {
            let mut row = vec![String::new(); columns];
            row[0] = format!("{}: could not be traced: {}", record.head.id, escaped(reason));
            rows.push(row);
        }
    }
    table(&heads, &rows)
}

/// How many bad answers are shown.
const WORST: usize = 10;

/// The worst answers of the cells with default settings, with the cell of each: those that are lost first, the farthest from
/// a graze before the others; then those that use up most of the allowance of their precision.
pub(super) fn worst_of<'p, 'r>(points: &'p [Point<'r>]) -> Vec<(&'p Point<'r>, &'r Worst)> {
    let defaults = points.iter().filter(|point| point.record.head.knob == Knob::Default);
    let mut all: Vec<(&Point, &Worst)> =
        defaults.flat_map(|point| point.measured.worst.iter().map(move |worst| (point, worst))).collect();
    let used =
        |(point, worst): &(&Point, &Worst)| worst.error.unwrap_or(0.0) / allowance(point.record.head.precision).across;
    all.sort_by(|one, other| {
        let lost = other.1.kind.is_lost().cmp(&one.1.kind.is_lost());
        let safe =
            if one.1.kind.is_lost() { other.1.margin.total_cmp(&one.1.margin) } else { std::cmp::Ordering::Equal };
        lost.then(safe).then(used(other).total_cmp(&used(one)))
    });
    all.truncate(WORST);
    all
}

/// The worst answers, as a table.
pub(super) fn worst(points: &[Point]) -> String {
    let rows: Vec<Vec<String>> = worst_of(points)
        .into_iter()
        .map(|(point, worst)| {
            let [x, y] = worst.pixel;
            let limit = worst.limit.as_ref().map_or(String::new(), |limit| format!(": {}", escaped(limit)));
            vec![
                format!("{} {}", point.record.head.method.name(), point.record.head.precision.name()),
                format!("{x},{y}"),
                format!("{}{limit}", worst.kind.name()),
                worst.error.map_or("–".to_owned(), error),
                error(worst.margin),
                format!("<code>{}</code>", escaped(&worst.command)),
            ]
        })
        .collect();
    let heads = [
        ("method", true),
        ("pixel", false),
        ("answer", true),
        ("error", false),
        ("margin", false),
        ("to see it again", true),
    ];
    table(&heads, &rows)
}
