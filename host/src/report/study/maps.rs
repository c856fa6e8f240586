//! Heat maps: what became of each pixel, and what it took.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use clap::ValueEnum;

use super::charts::WIDE;
use super::{Drawing, Point};
use crate::picture::{Picture, Rgb};
use crate::report::plot::{escaped, power};
use crate::report::table::grouped;
use crate::scene::trace::{Method, Precision};
use crate::study::plan::Knob;

/// The colour of a ray that misses, rightly, or takes no step.
const NOTHING: Rgb = [238, 238, 238];

/// Answers that are not the closest hit: the character, its colour, and its name. None of the colours is in the ramp.
const FAILURES: [(char, Rgb, &str); 5] = [
    ('M', [255, 0, 255], "missed"),
    ('O', [230, 0, 0], "other sheet"),
    ('P', [255, 140, 0], "phantom"),
    ('G', [0, 0, 0], "gave up"),
    ('U', [150, 110, 80], "undecided"),
];

/// The letters that the ramp goes over, in every map: errors from 1e-18 to 1e-2 of the diagonal, or steps from 1 to 256. All
/// maps have the same, so that they can be held side by side.
const LETTERS: u8 = 16;

/// What a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// How far t is off.
    Error,
    /// Newton steps and clips.
    Work,
}

impl Shown {
    /// Its name in names of files.
    fn name(self) -> &'static str {
        match self {
            Shown::Error => "error",
            Shown::Work => "work",
        }
    }

    /// What the ramp measures.
    fn measure(self) -> &'static str {
        match self {
            Shown::Error => "error of t, of the diagonal",
            Shown::Work => "Newton steps and clips of a ray",
        }
    }

    /// What has the colour of nothing.
    fn nothing(self) -> &'static str {
        match self {
            Shown::Error => "no hit, rightly",
            Shown::Work => "no step",
        }
    }

    /// The number at which a letter begins, in few characters.
    fn begin(self, letter: u8) -> String {
        match self {
            Shown::Error => power(i32::from(letter) - 18),
            Shown::Work => format!("{:.0}", 2_f64.powf(f64::from(letter) / 2.0)),
        }
    }
}

/// The colour in the ramp of a letter counted from `a`.
fn ramp(letter: u32) -> Rgb {
    let letter = letter.min(u32::from(LETTERS)) as usize;
    let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_rational(letter, usize::from(LETTERS) + 1);
    [r, g, b]
}

/// The colour of a pixel: that of a failure, or of its letter.
fn colour(kind: char, letter: char) -> Rgb {
    if let Some((_, colour, _)) = FAILURES.iter().find(|(failure, ..)| *failure == kind) {
        return *colour;
    }
    if letter == '.' { NOTHING } else { ramp((letter as u32).saturating_sub('a' as u32)) }
}

/// The maps of a page: of error those of all cells with default settings; of work one for each method, in f64 if it is there.
pub(super) fn all(points: &[Point], shown: Shown) -> Vec<Drawing> {
    let mut own: Vec<&Point> = Vec::new();
    for &precision in Precision::value_variants().iter().rev() {
        for &method in Method::value_variants() {
            let of = |point: &&Point| point.is(method, precision) && point.record.head.knob == Knob::Default;
            own.extend(points.iter().find(of));
        }
    }
    let mut methods = Vec::new();
    own.retain(|point| {
        let first = !methods.contains(&point.record.head.method);
        methods.push(point.record.head.method);
        shown == Shown::Error || first
    });
    own.into_iter().filter_map(|point| drawing(point, shown)).collect()
}

/// The map of a cell; `None` if its record has none, or not as many pixels as its size says.
fn drawing(point: &Point, shown: Shown) -> Option<Drawing> {
    let (head, counts, map) = (&point.record.head, &point.measured.counts, &point.measured.map);
    let letters = match shown {
        Shown::Error => &map.pixels,
        Shown::Work => &map.steps,
    };
    let [width, height] = map.size;
    let mut picture = Picture::new(map.size);
    let pixels: Vec<Rgb> = map.pixels.chars().zip(letters.chars()).map(|(kind, letter)| colour(kind, letter)).collect();
    picture.push_row(&pixels);
    let mut png = Vec::new();
    picture.write_png(&mut png).ok()?;
    let png = STANDARD.encode(png);
    let name = format!("{} {}", head.method.name(), head.precision.name());
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" aria-label="{}"><image width="{width}" height="{height}" style="image-rendering: pixelated" href="data:image/png;base64,{png}"/></svg>
"#,
        escaped(&format!("{name}, pixel by pixel: {}", shown.measure()))
    );
    let per_ray = |name: &str| counts.work.get(name).map_or(0.0, |&sum| sum as f64 / counts.rays.max(1) as f64);
    let caption = match shown {
        Shown::Error => format!("{name}: {} of {} lost", grouped(counts.lost()), grouped(counts.rays)),
        Shown::Work => {
            format!(
                "{name}: {:.2} Newton steps and {:.2} clips per ray",
                per_ray("newton_steps"),
                per_ray("clip_steps")
            )
        }
    };
    Some(Drawing { name: format!("map-{}-{}", shown.name(), name.replace(' ', "-")), caption, svg })
}

/// What the colours of such maps mean: the ramp with its numbers, and what is outside it.
pub(super) fn legend(shown: Shown) -> Drawing {
    const LEFT: f64 = 8.0;
    const BAR: [f64; 2] = [28.0, 14.0];
    let step = (WIDE - 2.0 * LEFT) / f64::from(LETTERS + 1);
    let rgb = |[r, g, b]: Rgb| format!("rgb({r},{g},{b})");
    let mut svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} 112" role="img" aria-label="Colours: {0}" font-family="system-ui, sans-serif" font-size="13" fill="currentColor"><text x="{LEFT}" y="17" font-weight="600">{0}</text>"#,
        escaped(shown.measure())
    );
    for letter in 0..=LETTERS {
        let ([top, height], left) = (BAR, LEFT + step * f64::from(letter));
        let fill = rgb(ramp(letter.into()));
        // Writing to a string cannot fail.
        let _ = write!(svg, r#"<rect x="{left:.1}" y="{top}" width="{step:.1}" height="{height}" fill="{fill}"/>"#);
        if letter.is_multiple_of(2) {
            let more = if letter == LETTERS { "+" } else { "" };
            let _ =
                write!(svg, r#"<text x="{left:.1}" y="{}">{}{more}</text>"#, top + height + 15.0, shown.begin(letter));
        }
    }
    let nothing = [(NOTHING, shown.nothing())];
    let outside = nothing.into_iter().chain(FAILURES.map(|(_, colour, name)| (colour, name)));
    for (place, (colour, name)) in outside.enumerate() {
        let (left, top) = (LEFT + 182.0 * (place % 3) as f64, 67.0 + 22.0 * (place / 3) as f64);
        let _ = write!(
            svg,
            r#"<rect x="{left}" y="{top}" width="13" height="13" fill="{}"/><text x="{}" y="{}">{name}</text>"#,
            rgb(colour),
            left + 19.0,
            top + 11.5
        );
    }
    let name = format!("map-{}-legend", shown.name());
    Drawing { name, caption: String::new(), svg: svg + "</svg>\n" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn nothing_outside_the_ramp_looks_like_it() {
        let ramp: Vec<Rgb> = (0..=u32::from(LETTERS)).map(ramp).collect();
        let outside: Vec<Rgb> = FAILURES.iter().map(|(_, colour, _)| *colour).chain([NOTHING]).collect();
        let apart = |a: &Rgb, b: &Rgb| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        for (place, colour) in outside.iter().enumerate() {
            let others = ramp.iter().chain(&outside[..place]);
            assert!(others.map(|other| apart(colour, other)).min() >= Some(40), "{colour:?}");
        }
        assert_eq!(ramp.iter().collect::<BTreeSet<_>>().len(), ramp.len());
    }

    #[test]
    fn failures_hide_what_they_took_and_long_rays_stay_in_the_ramp() {
        assert_eq!((colour('.', '.'), colour('.', 'c'), colour('G', 'c')), (NOTHING, ramp(2), [0, 0, 0]));
        assert_eq!((colour('f', 'z'), colour('z', 'z')), (ramp(16), ramp(16)));
    }

    #[test]
    fn legends_name_all_colours() {
        for (shown, ends) in [(Shown::Error, ["10⁻¹⁸", "10⁻²+"]), (Shown::Work, [">1<", ">256+<"])] {
            let svg = legend(shown).svg;
            assert!(ends.iter().all(|end| svg.contains(end)), "{svg}");
            assert!(FAILURES.iter().all(|(_, _, name)| svg.contains(name)) && svg.contains(shown.nothing()));
        }
    }
}
