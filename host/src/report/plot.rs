//! Diagrams as SVG: lines and points over two axes, each linear or logarithmic.

use std::fmt::Write as _;

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly in the logarithm; numbers that are not above 0 lie at its low end.
    Log,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What stands beside it.
    pub label: String,
    /// How it is divided.
    pub scale: Scale,
    /// The least range that it shows; `None` for as much as the points take.
    pub range: Option<[f64; 2]>,
}

/// A point of a diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Where it is.
    pub at: [f64; 2],
    /// What it is, shown to who points at it.
    pub tip: String,
    /// Whether it failed: it is then drawn on the upper border, with a cross, and counted.
    pub failed: bool,
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; an empty one has none.
    pub name: String,
    /// Its colour, as CSS writes it.
    pub colour: &'static str,
    /// Whether points are hollow and the line is dashed.
    pub hollow: bool,
    /// Whether a line joins the points that did not fail, in their order.
    pub joined: bool,
    /// The points.
    pub marks: Vec<Mark>,
}

/// A diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What stands above it.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, the first at the bottom.
    pub series: Vec<Series>,
    /// How wide it is, in units of which a line of text takes some 13: a diagram that is shown small has fewer.
    pub width: f64,
}

/// Height without the legend, as a share of the width.
const HEIGHT: f64 = 0.72;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 22.0;
const TOP: f64 = 54.0;
const BOTTOM: f64 = 56.0;
/// The least room between two numbers of an axis.
const GAP: f64 = 6.0;
/// The height of a line of the legend, and the width of a name in it.
const LEGEND: [f64; 2] = [20.0, 180.0];

/// Text that HTML and SVG take for nothing but text.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A whole power of ten, such as 10⁻¹².
pub fn power(exponent: i32) -> String {
    let digits = exponent.to_string();
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        // The others follow one another.
        digit => digit.to_digit(10).and_then(|digit| char::from_u32('⁰' as u32 + digit)).unwrap_or(digit),
    });
    format!("10{}", raised.collect::<String>())
}

/// How wide a number is, at most: raised digits, which are not ASCII, are narrower.
fn width_of(number: &str) -> f64 {
    number.chars().map(|c| if c.is_ascii() { 8.0 } else { 5.5 }).sum()
}

/// A number in few characters.
fn short(number: f64) -> String {
    let size = number.abs();
    if (1e-3..1e5).contains(&size) || size == 0.0 {
        format!("{}", (number * 1e6).round() / 1e6)
    } else {
        format!("{number:e}")
    }
}

/// An axis with its range, and where its numbers lie between 0 and 1.
struct Fitted {
    scale: Scale,
    low: f64,
    high: f64,
    ticks: Vec<(f64, String)>,
}

impl Fitted {
    fn new(axis: &Axis, numbers: impl Iterator<Item = f64>) -> Self {
        let valid = |x: &f64| x.is_finite() && (axis.scale == Scale::Linear || *x > 0.0);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for number in numbers.chain(axis.range.into_iter().flatten()).filter(valid) {
            (low, high) = (low.min(number), high.max(number));
        }
        if !(low <= high) {
            (low, high) = (0.1, 1.0);
        }
        match axis.scale {
            Scale::Log => Self::log(low, high),
            Scale::Linear => Self::linear(low, high),
        }
    }

    fn log(low: f64, high: f64) -> Self {
        let (low, high) = (low.log10(), high.log10());
        let span = high - low;
        let steps: &[f64] = match span {
            _ if span > 2.0 => &[1.0],
            _ if span > 1.0 => &[1.0, 2.0, 5.0],
            _ => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
        };
        let decades = low.floor() as i32 - 1..=high.ceil() as i32 + 1;
        let all = decades.flat_map(|decade| steps.iter().map(move |step| f64::from(decade) + step.log10()));
        if span > 2.0 {
            // Whole decades.
            let (low, high) = (low.floor(), high.ceil());
            let every = ((high - low) / 8.0).ceil();
            let shown = all.filter(|tick| (low..=high).contains(tick) && ((high - tick) / every).fract() == 0.0);
            let ticks = shown.map(|tick| (10_f64.powf(tick), power(tick.round() as i32))).collect();
            return Fitted { scale: Scale::Log, low, high, ticks };
        }
        let room = (0.04 * span).max(0.03);
        let (low, high) = (low - room, high + room);
        let shown = all.filter(|tick| (low..=high).contains(tick));
        let ticks = shown.map(|tick| 10_f64.powf(tick)).map(|tick| (tick, short((tick * 1e9).round() / 1e9))).collect();
        Fitted { scale: Scale::Log, low, high, ticks }
    }

    fn linear(low: f64, high: f64) -> Self {
        let span = if high > low { high - low } else { low.abs().max(1e-9) };
        let decade = 10_f64.powf((span / 5.0).log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|part| part * decade);
        let step = step.into_iter().find(|step| span / step <= 6.0).unwrap_or(span);
        let (first, last) = ((low / step + 1e-9).floor(), (high / step - 1e-9).ceil().max((low / step).floor() + 1.0));
        let ticks = (0..=(last - first).round() as i32).map(|k| {
            let tick = (first + f64::from(k)) * step;
            (tick, short(tick))
        });
        Fitted { scale: Scale::Linear, low: first * step, high: last * step, ticks: ticks.collect() }
    }

    fn share(&self, number: f64) -> f64 {
        let place = match self.scale {
            Scale::Linear => number,
            Scale::Log if number > 0.0 => number.log10(),
            Scale::Log => self.low,
        };
        ((place - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

impl Plot {
    /// The diagram as an SVG document, which also stands in HTML as it is.
    pub fn to_svg(&self) -> String {
        let marks = || self.series.iter().flat_map(|series| &series.marks);
        let x = Fitted::new(&self.x, marks().map(|mark| mark.at[0]));
        let y = Fitted::new(&self.y, marks().filter(|mark| !mark.failed).map(|mark| mark.at[1]));
        let names = self.series.iter().filter(|series| !series.name.is_empty()).count();
        let width = self.width;
        let columns = ((width / LEGEND[1]) as usize).max(1);
        let base = (HEIGHT * width).round();
        let height = base + LEGEND[0] * names.div_ceil(columns) as f64;
        let (right, bottom) = (width - RIGHT, base - BOTTOM);
        let across = |number: f64| LEFT + x.share(number) * (right - LEFT);
        let down = |number: f64| bottom - y.share(number) * (bottom - TOP);
        let mut svg = String::new();
        let mut add = |args: std::fmt::Arguments| {
            // Writing to a string cannot fail.
            let _ = writeln!(svg, "{args}");
        };
        add(format_args!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" aria-label="{}" font-family="system-ui, sans-serif" font-size="13" fill="currentColor">"#,
            escaped(&self.title)
        ));
        add(format_args!(r#"<text x="4" y="17" font-size="15" font-weight="600">{}</text>"#, escaped(&self.title)));
        let mut end = f64::NEG_INFINITY;
        for (tick, text) in &x.ticks {
            let place = across(*tick);
            add(format_args!(r#"<path d="M{place:.1} {TOP}V{bottom}" stroke="currentColor" stroke-opacity=".12"/>"#));
            // A number that would touch the one before it is left out; its line stays.
            let half = 0.5 * width_of(text);
            if place - half < end + GAP {
                continue;
            }
            end = place + half;
            add(format_args!(r#"<text x="{place:.1}" y="{:.1}" text-anchor="middle">{text}</text>"#, bottom + 17.0));
        }
        for (tick, text) in &y.ticks {
            let place = down(*tick);
            add(format_args!(r#"<path d="M{LEFT} {place:.1}H{right}" stroke="currentColor" stroke-opacity=".12"/>"#));
            add(format_args!(r#"<text x="{:.1}" y="{:.1}" text-anchor="end">{text}</text>"#, LEFT - 6.0, place + 4.5));
        }
        add(format_args!(
            r#"<text x="{:.1}" y="{:.1}" text-anchor="middle">{}</text>"#,
            (LEFT + right) / 2.0,
            bottom + 38.0,
            escaped(&self.x.label)
        ));
        add(format_args!(r#"<text x="4" y="36">↑ {}</text>"#, escaped(&self.y.label)));
        for series in &self.series {
            let Series { colour, hollow, joined, marks, .. } = series;
            if *joined {
                let whole: Vec<String> = marks
                    .iter()
                    .filter(|mark| !mark.failed)
                    .map(|mark| format!("{:.1},{:.1}", across(mark.at[0]), down(mark.at[1])))
                    .collect();
                let dashes = if *hollow { r#" stroke-dasharray="5 4""# } else { "" };
                add(format_args!(
                    r#"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="1.8"{dashes}/>"#,
                    whole.join(" ")
                ));
            }
            for Mark { at, tip, failed } in marks {
                let place = across(at[0]);
                let tip = format!("<title>{}</title>", escaped(tip));
                if *failed {
                    let (left, up) = (place - 4.0, TOP - 4.0);
                    add(format_args!(
                        r#"<path d="M{left:.1} {up:.1}l8 8m0 -8l-8 8" stroke="{colour}" stroke-width="2" fill="none">{tip}</path>"#
                    ));
                    continue;
                }
                let radius = if *joined { 3.6 } else { 2.6 };
                let fill = if *hollow { "var(--page, #fff)" } else { colour };
                add(format_args!(
                    r#"<circle cx="{place:.1}" cy="{:.1}" r="{radius}" fill="{fill}" stroke="{colour}" stroke-width="1.4">{tip}</circle>"#,
                    down(at[1])
                ));
            }
        }
        let failed = marks().filter(|mark| mark.failed).count();
        if failed > 0 {
            add(format_args!(r#"<text x="{right}" y="17" text-anchor="end">{failed} failed (×)</text>"#));
        }
        for (place, series) in self.series.iter().filter(|series| !series.name.is_empty()).enumerate() {
            let left = 8.0 + (place % columns) as f64 * (width - 8.0) / columns as f64;
            let middle = base + 2.0 + (place / columns) as f64 * LEGEND[0];
            let (colour, dashes) = (series.colour, if series.hollow { r#" stroke-dasharray="5 4""# } else { "" });
            let fill = if series.hollow { "var(--page, #fff)" } else { colour };
            add(format_args!(
                r#"<path d="M{left} {middle}h22" stroke="{colour}" stroke-width="2"{dashes}/><circle cx="{:.1}" cy="{middle}" r="3.6" fill="{fill}" stroke="{colour}" stroke-width="1.4"/><text x="{:.1}" y="{:.1}">{}</text>"#,
                left + 11.0,
                left + 28.0,
                middle + 4.5,
                escaped(&series.name)
            ));
        }
        svg + "</svg>\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(marks: Vec<Mark>) -> Plot {
        let axis = |label: &str| Axis { label: label.to_owned(), scale: Scale::Log, range: None };
        let series = Series { name: "a <b>".to_owned(), colour: "#000", hollow: false, joined: true, marks };
        Plot { title: "t & u".to_owned(), x: axis("x"), y: axis("y"), series: vec![series], width: 400.0 }
    }

    fn mark(x: f64, y: f64, failed: bool) -> Mark {
        Mark { at: [x, y], tip: format!("{x}"), failed }
    }

    #[test]
    fn failed_points_are_on_the_border_and_counted() {
        let svg = plot(vec![mark(1.0, 1e-9, false), mark(100.0, 1e-3, false), mark(10.0, f64::NAN, true)]).to_svg();
        assert!(
            svg.contains("1 failed")
                && svg.contains("10⁻⁹")
                && svg.contains("a &lt;b&gt;")
                && svg.contains("t &amp; u")
        );
        assert_eq!((svg.matches("<title>").count(), svg.matches("<polyline").count()), (3, 1));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }

    #[test]
    fn nothing_to_show_is_drawn_too() {
        for marks in [vec![], vec![mark(0.0, 0.0, false)], vec![mark(5.0, 5.0, false)]] {
            let svg = plot(marks).to_svg();
            assert!(!svg.contains("NaN") && svg.ends_with("</svg>\n"));
        }
    }

    #[test]
    fn numbers_of_an_axis_do_not_touch() {
        let svg = plot(vec![mark(13_000.0, 1.0, false), mark(98_000.0, 2.0, false)]).to_svg();
        let places = svg.lines().filter(|line| line.contains("text-anchor=\"middle\">") && !line.contains(">x<"));
        let places: Vec<f64> =
            places.filter_map(|line| line.split_once("x=\"")?.1.split_once('"')?.0.parse().ok()).collect();
        assert!(places.len() > 2 && places.windows(2).all(|pair| pair[1] - pair[0] > width_of("50000")), "{places:?}");
        // Their lines are all there.
        assert!(svg.matches("stroke-opacity").count() > places.len() + 3);
    }

    #[test]
    fn ticks_are_round() {
        let texts = |fitted: Fitted| fitted.ticks.into_iter().map(|(_, text)| text).collect::<Vec<_>>();
        assert_eq!(texts(Fitted::log(170.0, 940.0)), ["200", "300", "400", "500", "700", "1000"]);
        assert_eq!(texts(Fitted::log(2.0, 100.0)), ["2", "5", "10", "20", "50", "100"]);
        assert_eq!(texts(Fitted::log(2e-15, 3e-12)), ["10⁻¹⁵", "10⁻¹⁴", "10⁻¹³", "10⁻¹²", "10⁻¹¹"]);
        assert_eq!(texts(Fitted::linear(0.05, 0.6)), ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6"]);
        assert_eq!(texts(Fitted::linear(0.0, 0.0)).len(), 2);
        assert_eq!(power(-307), "10⁻³⁰⁷");
    }
}
