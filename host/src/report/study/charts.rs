//! The diagrams of a study.

use clap::ValueEnum;

use super::{Drawing, Point};
use crate::report::plot::{Axis, Mark, Plot, Scale, Series};
use crate::scene::trace::{Method, Precision};
use crate::study::errors::Spread;
use crate::study::plan::Knob;

/// The colour of each method. Source: Okabe and Ito's palette, which the colour-blind can tell apart.
pub(super) fn colour(method: Method) -> &'static str {
    match method {
        Method::Newton => "#0072b2",
        Method::NewtonCoherent => "#56b4e9",
        Method::NewtonPredicted => "#009e73",
        Method::Clipping => "#d55e00",
        Method::ClippingCoherent => "#e69f00",
        Method::ClippingPredicted => "#cc79a7",
    }
}

/// The width of a diagram of which two stand in a row, and of one of which three do.
pub(super) const WIDE: f64 = 560.0;
const SMALL: f64 = 430.0;

/// A part of the page with its diagrams.
pub(super) type Section = (Knob, Vec<Drawing>);

fn axis(label: &str, scale: Scale) -> Axis {
    Axis { label: label.to_owned(), scale, range: None }
}

/// All diagrams: under [`Knob::Default`] those of all cells, then those of each knob that has some.
pub(super) fn all(points: &[Point]) -> Vec<Section> {
    let precisions = || Precision::value_variants().iter().rev();
    let mut first: Vec<Drawing> = precisions().map(|&precision| work_precision(points, precision)).collect();
    first.extend(precisions().map(|&precision| distribution(points, precision)));
    let mut sections = vec![(Knob::Default, first)];
    for knob in [
        Knob::ClipThreshold,
        Knob::Tolerance,
        Knob::Flatness,
        Knob::NewtonIterations,
        Knob::NewtonSteps,
        Knob::ClipSteps,
        Knob::GridDensity,
    ] {
        let drawings = sweep(points, knob);
        if !drawings.is_empty() {
            sections.push((knob, drawings));
        }
    }
    sections
}

/// Error over time. The line of a method goes through its tolerances; the points beside it are its other settings.
fn work_precision(points: &[Point], precision: Precision) -> Drawing {
    let mark = |point: &&Point| Mark {
        at: [point.ns, point.measured.errors.t.most],
        tip: point.tip(),
        failed: point.failed(),
    };
    let mut series = Vec::new();
    for &method in Method::value_variants() {
        let own = || points.iter().filter(move |point| point.is(method, precision));
        let (mut line, others): (Vec<&Point>, Vec<&Point>) =
            own().partition(|point| matches!(point.record.head.knob, Knob::Default | Knob::Tolerance));
        line.sort_by(|a, b| {
            let of = |point: &Point| point.value_of(Knob::Tolerance).unwrap_or(0.0);
            of(b).total_cmp(&of(a))
        });
        let part = |name: &str, joined: bool, points: &[&Point]| Series {
            name: name.to_owned(),
            colour: colour(method),
            hollow: precision == Precision::F32,
            joined,
            marks: points.iter().map(mark).collect(),
        };
        series.push(part("", false, &others));
        series.push(part(method.name(), true, &line));
    }
    // The same ranges in both precisions, so that the two can be held side by side.
    let range = |numbers: &mut dyn Iterator<Item = f64>| {
        let all: Vec<f64> = numbers.filter(|number| *number > 0.0).collect();
        let [low, high] = [f64::min, f64::max].map(|pick| all.iter().copied().reduce(pick));
        low.zip(high).map(|(low, high)| [low, high])
    };
    let times = range(&mut points.iter().map(|point| point.ns));
    let errors = range(&mut points.iter().filter(|point| !point.failed()).map(|point| point.measured.errors.t.most));
    let plot = Plot {
        title: format!("Error over time, {}", precision.name()),
        x: Axis { range: times, ..axis("time, ns per ray", Scale::Log) },
        y: Axis { range: errors, ..axis("error of t, of the diagonal: 99.9 % of hits are below", Scale::Log) },
        series,
        width: WIDE,
    };
    Drawing {
        name: format!("work-precision-{}", precision.name()),
        caption:
            "The line of a method joins its tolerances, from loose to tight; the small points are its other settings."
                .to_owned(),
        svg: plot.to_svg(),
    }
}

/// What share of hits has a larger error, over the error, with default settings.
fn distribution(points: &[Point], precision: Precision) -> Drawing {
    let mut series = Vec::new();
    for &method in Method::value_variants() {
        let own = points.iter().find(|point| point.is(method, precision) && point.record.head.knob == Knob::Default);
        let mut marks = Vec::new();
        if let Some(point) = own {
            let Spread { count, bins, .. } = &point.measured.errors.t;
            let mut left = *count;
            for (bin, number) in bins.iter().enumerate() {
                left = left.saturating_sub(*number);
                // Where the bin ends.
                let error = Spread::LEAST * 10_f64.powf(bin as f64 / 2.0);
                let share = left as f64 / (*count).max(1) as f64;
                if left == 0 {
                    break;
                }
                if left == *count {
                    continue;
                }
                let tip = format!("{}: {left} of {count} hits are off by more than {error:.1e}", method.name());
                marks.push(Mark { at: [error, share], tip, failed: false });
            }
        }
        let hollow = precision == Precision::F32;
        series.push(Series { name: method.name().to_owned(), colour: colour(method), hollow, joined: true, marks });
    }
    let plot = Plot {
        title: format!("Distribution of error, {}, default settings", precision.name()),
        x: axis("error of t, of the diagonal", Scale::Log),
        y: axis("share of hits with a larger error", Scale::Log),
        series,
        width: WIDE,
    };
    Drawing {
        name: format!("distribution-{}", precision.name()),
        caption: "What share of hits is off by more. The long tail is of rays that all but graze.".to_owned(),
        svg: plot.to_svg(),
    }
}

/// Time, error and lost rays over the values of a knob; none if no cell moves it.
fn sweep(points: &[Point], knob: Knob) -> Vec<Drawing> {
    if points.iter().all(|point| point.record.head.knob != knob) {
        return Vec::new();
    }
    let scale = if knob == Knob::ClipThreshold { Scale::Linear } else { Scale::Log };
    let limit = matches!(knob, Knob::NewtonSteps | Knob::ClipSteps);
    let panel = |what: &str, label: &str, y: Scale, value: &dyn Fn(&Point) -> f64, fails: bool| {
        let mut series = Vec::new();
        for &precision in Precision::value_variants().iter().rev() {
            for &method in Method::value_variants() {
                let own = points.iter().filter(|point| point.is(method, precision));
                // The default is a value too, unless it stands for no bound.
                let own = own.filter(|point| {
                    point.record.head.knob == knob || (point.record.head.knob == Knob::Default && !limit)
                });
                let mut own: Vec<(f64, &Point)> =
                    own.filter_map(|point| Some((point.value_of(knob)?, point))).collect();
                if own.iter().all(|(_, point)| point.record.head.knob == Knob::Default) {
                    continue;
                }
                own.sort_by(|a, b| a.0.total_cmp(&b.0));
                let mark = |(x, point): &(f64, &Point)| Mark {
                    at: [*x, value(point)],
                    tip: point.tip(),
                    failed: fails && point.failed(),
                };
                series.push(Series {
                    name: format!("{} {}", method.name(), precision.name()),
                    colour: colour(method),
                    hollow: precision == Precision::F32,
                    joined: true,
                    marks: own.iter().map(mark).collect(),
                });
            }
        }
        let plot = Plot {
            title: format!("{what} over {}", title_of(knob)),
            x: axis(&label_of(knob), scale),
            y: Axis { range: (y == Scale::Linear).then_some([0.0, 1.0]), ..axis(label, y) },
            series,
            width: SMALL,
        };
        Drawing {
            name: format!("{}-{}", knob.name(), what.to_lowercase().replace(' ', "-")),
            caption: String::new(),
            svg: plot.to_svg(),
        }
    };
    let lost = |point: &Point| 1e3 * point.measured.counts.lost_share();
    let mut panels = vec![panel("Time", "time, ns per ray", Scale::Log, &|point| point.ns, false)];
    // A limit changes no answer that it lets pass.
    if !limit {
        let error = |point: &Point| point.measured.errors.t.most;
        panels.push(panel("Error", "error of t: 99.9 % of hits are below", Scale::Log, &error, true));
    }
    panels.push(panel("Lost rays", "rays lost, of 1000", Scale::Linear, &lost, false));
    panels
}

/// What a knob is, for a title.
pub(super) fn title_of(knob: Knob) -> &'static str {
    match knob {
        Knob::Default => "all settings",
        Knob::Tolerance => "the tolerance",
        Knob::Flatness => "the flatness",
        Knob::ClipThreshold => "the clipping threshold",
        Knob::NewtonIterations => "Newton iterations",
        Knob::NewtonStarts => "Newton starts",
        Knob::Paper => "the paper's acceptance",
        Knob::NewtonSteps => "the limit on Newton steps",
        Knob::ClipSteps => "the limit on clips",
        Knob::GridDensity => "the grid's density",
    }
}

fn label_of(knob: Knob) -> String {
    match knob {
        Knob::Tolerance => "--tolerance, of the scene's size".to_owned(),
        Knob::Flatness => "--flatness, of the diagonal: less makes more patches".to_owned(),
        Knob::ClipThreshold => "--clip-threshold: the share that a clip has to remove".to_owned(),
        Knob::GridDensity => "--grid-density, voxels per patch".to_owned(),
        Knob::NewtonSteps | Knob::ClipSteps => format!("--limit {}=N, per ray", knob.name()),
        _ => format!("--{}", knob.name()),
    }
}
