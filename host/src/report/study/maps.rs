//! Heat maps: what became of each pixel.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::{Drawing, Point};
use crate::picture::{Picture, Rgb};
use crate::report::plot::escaped;
use crate::study::plan::Knob;
use crate::study::record::Map;

/// What is not an error by degree: the character, its colour, and its name. None of the colours is in the ramp.
pub(super) const KINDS: [(char, Rgb, &str); 6] = [
    ('.', [238, 238, 238], "no hit, rightly"),
    ('M', [255, 0, 255], "missed"),
    ('O', [230, 0, 0], "other sheet"),
    ('P', [255, 140, 0], "phantom"),
    ('G', [0, 0, 0], "gave up"),
    ('U', [150, 110, 80], "undecided"),
];

/// The letters that the ramp goes over: errors from 1e-18 to 1e-2 of the diagonal.
const LETTERS: u8 = 16;

/// The colour of a character of a [`Map`].
fn colour(pixel: char) -> Rgb {
    if let Some((_, colour, _)) = KINDS.iter().find(|(kind, ..)| *kind == pixel) {
        return *colour;
    }
    let letter = (pixel as u32).saturating_sub('a' as u32).min(u32::from(LETTERS) - 1);
    let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_rational(letter as usize, usize::from(LETTERS));
    [r, g, b]
}

/// The map as a picture; `None` if it has not as many pixels as its size says.
fn picture(map: &Map) -> Option<Vec<u8>> {
    let mut picture = Picture::new(map.size);
    let pixels: Vec<Rgb> = map.pixels.chars().map(colour).collect();
    picture.push_row(&pixels);
    let mut png = Vec::new();
    picture.write_png(&mut png).ok()?;
    Some(png)
}

/// The maps of the cells with default settings.
pub(super) fn all(points: &[Point]) -> Vec<Drawing> {
    let mut defaults: Vec<&Point> = points.iter().filter(|point| point.record.head.knob == Knob::Default).collect();
    defaults.sort_by_key(|point| std::cmp::Reverse(point.record.head.precision.name()));
    defaults.into_iter().filter_map(drawing).collect()
}

fn drawing(point: &Point) -> Option<Drawing> {
    let map = &point.measured.map;
    let (head, counts) = (&point.record.head, &point.measured.counts);
    let [width, height] = map.size;
    let png = STANDARD.encode(picture(map)?);
    let name = format!("{} {}", head.method.name(), head.precision.name());
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" aria-label="{}"><image width="{width}" height="{height}" style="image-rendering: pixelated" href="data:image/png;base64,{png}"/></svg>
"#,
        escaped(&format!("Error of {name}, pixel by pixel"))
    );
    let caption = format!("{name}: {} lost of {}", counts.lost(), counts.rays);
    Some(Drawing { name: format!("map-{}", name.replace(' ', "-")), caption, svg })
}

/// What the colours mean, as HTML.
pub(super) fn legend() -> String {
    let mut html = String::from("<p class=\"legend\"><span>error of t:</span> ");
    for letter in (0..LETTERS).step_by(3) {
        let [r, g, b] = colour(char::from(b'a' + letter));
        html += &format!(
            "<span><i style=\"background:rgb({r},{g},{b})\"></i>10<sup>{}</sup></span> ",
            i32::from(letter) - 18
        );
    }
    for (_, [r, g, b], name) in KINDS {
        html += &format!("<span><i style=\"background:rgb({r},{g},{b})\"></i>{name}</span> ");
    }
    html + "</p>\n"
}
