//! A channel as a picture, of fixed ranges, so that pictures of different runs can be held beside each other; with a legend.
//!
//! Pixels without a number, since their ray met nothing, and those whose ray was given up have colours that no range has.

use std::convert::Infallible;

use colorous::Color;
use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::text::{Baseline, Text};

use super::seen::{GIVEN_UP, NONE, PATHS, STATUS};
use super::{Channels, Values};
use crate::picture::{GAVE_UP, Picture, Rgb};
use crate::scene::camera::View;
use crate::scene::model::ControlBox;

/// Where a ray met nothing.
const NOTHING: Rgb = [24, 24, 24];
/// What stands on the legend, and its ground.
const TEXT: Rgb = [235, 235, 235];
const GROUND: Rgb = [0, 0, 0];

/// Most that a count's range says; what is more looks the same.
pub const MOST: f64 = 255.0;

/// How numbers become colours.
#[derive(Clone, Debug, PartialEq)]
pub enum Scale {
    /// Evenly from the one to the other.
    Even([f64; 2]),
    /// The same, with a middle that is told from both sides.
    Signed([f64; 2]),
    /// By powers of ten, from the one to the other; the channel's numbers are divided by the third.
    Powers([f64; 3]),
    /// Counts from 0 to [`MOST`], by the logarithm of one more.
    Counts,
    /// A colour for each code.
    Codes(&'static [&'static str]),
    /// A colour of its own for each number.
    Numbers,
}

impl Scale {
    /// That of a channel of [`seen`](super::seen), in a scene with this box.
    pub fn of(name: &str, bounds: &ControlBox, view: &View) -> Self {
        let axis = |k: usize| Scale::Even([bounds.min[k], bounds.max[k]]);
        match name {
            "Z" => Scale::Even(distances(bounds, view.eye)),
            "P.X" => axis(0),
            "P.Y" => axis(1),
            "P.Z" => axis(2),
            "N.X" | "N.Y" | "N.Z" => Scale::Signed([-1.0, 1.0]),
            "u" | "v" => Scale::Even([0.0, 1.0]),
            "residual" => Scale::Powers([1e-17, 1e-4, bounds.diagonal()]),
            "status" => Scale::Codes(&STATUS),
            "path" => Scale::Codes(&PATHS),
            "surface" | "patch" => Scale::Numbers,
            _ => Scale::Counts,
        }
    }

    /// The colour of a number.
    fn colour(&self, value: f64) -> Rgb {
        let share = |[low, high]: [f64; 2]| (value - low) / (high - low);
        let ramp = |ramp: colorous::Gradient, share: f64| {
            let Color { r, g, b } = ramp.eval_continuous(share.clamp(0.0, 1.0));
            [r, g, b]
        };
        match self {
            _ if !value.is_finite() => NOTHING,
            Scale::Even(range) => ramp(colorous::VIRIDIS, share(*range)),
            Scale::Signed(range) => ramp(colorous::RED_BLUE, share(*range)),
            Scale::Powers([low, high, unit]) => {
                let value = (value / unit).max(*low);
                ramp(colorous::VIRIDIS, (value / low).log10() / (high / low).log10())
            }
            Scale::Counts => ramp(colorous::PLASMA, (1.0 + value).ln() / (1.0 + MOST).ln()),
            Scale::Codes(names) => {
                let Color { r, g, b } = colorous::SET2[value as usize % colorous::SET2.len()];
                match names.get(value as usize) {
                    _ if value == 0.0 => NOTHING,
                    Some(&GIVEN_UP) => GAVE_UP,
                    _ => [r, g, b],
                }
            }
            Scale::Numbers if value == f64::from(NONE) => NOTHING,
            // Neighbours in number are far apart in hue: the golden ratio never comes round.
            Scale::Numbers => ramp(colorous::SINEBOW, (value * 0.618_033_988_749_894_9).fract()),
        }
    }
}

/// The least and the largest distance from the eye to a corner of the box; from the eye itself, if it is inside.
fn distances(bounds: &ControlBox, eye: [f64; 3]) -> [f64; 2] {
    let apart = |of: fn(f64, f64) -> f64, far: bool| {
        let square = (0..3).map(|k| {
            let [a, b] = [bounds.min[k] - eye[k], bounds.max[k] - eye[k]];
            let inside = !far && a <= 0.0 && b >= 0.0;
            if inside { 0.0 } else { of(a.abs(), b.abs()).powi(2) }
        });
        square.sum::<f64>().sqrt()
    };
    [apart(f64::min, false), apart(f64::max, true)]
}

/// A channel of [`seen`](super::seen) as a picture, its legend below; `None` without that channel.
pub fn picture(channels: &Channels, name: &str, scale: &Scale) -> Option<Picture> {
    let channel = channels.named(name)?;
    let gave_up = channels.named("status").map(|status| &status.values);
    let is_given_up = |pixel| gave_up.is_some_and(|status| STATUS.get(status.get(pixel) as usize) == Some(&GIVEN_UP));
    let [width, height] = channels.size;
    let wide = width.max(LEAST_WIDTH);
    let codes = codes(scale, &channel.values, wide);
    let more_lines = codes.last().map_or(0, |last| last.line);
    let mut canvas = Canvas::new([wide, height + LEGEND + more_lines * LINE]);
    for pixel in 0..channels.pixels() {
        let colour = if is_given_up(pixel) { GAVE_UP } else { scale.colour(channel.values.get(pixel)) };
        canvas.set([pixel as u32 % width, pixel as u32 / width], colour);
    }
    legend(&mut canvas, height, name, scale, &codes);
    Some(canvas.picture())
}

/// A legend's height in pixels, of one line of codes, and that of each further one; and its least width, in which all other
/// texts find room.
const LEGEND: u32 = 36;
const LINE: u32 = 12;
const LEAST_WIDTH: u32 = 420;

/// A code in a legend.
struct Code {
    /// What it means, and how many pixels it has, if any.
    text: String,
    /// Where its line begins, and which one that is.
    x: u32,
    line: u32,
}

/// The codes of a scale, if it is of codes, in lines of this width.
fn codes(scale: &Scale, values: &Values, width: u32) -> Vec<Code> {
    let Scale::Codes(names) = scale else {
        return Vec::new();
    };
    let (mut x, mut line) = (MARGIN, 0);
    let code = |(code, name): (usize, &&str)| {
        let count = match values {
            Values::Count(all) => all.iter().filter(|&&value| value == code as u32).count(),
            Values::Real(_) => 0,
        };
        let text = if count > 0 { format!("{name} {count}") } else { (*name).to_owned() };
        let wide = SWATCH + FONT_6X10.character_size.width * text.len() as u32 + MARGIN;
        if x > MARGIN && x + wide > width {
            (x, line) = (MARGIN, line + 1);
        }
        x += wide;
        Code { text, x: x - wide, line }
    };
    names.iter().enumerate().map(code).collect()
}

fn legend(canvas: &mut Canvas, top: u32, name: &str, scale: &Scale, codes: &[Code]) {
    let bar = |canvas: &mut Canvas, value: &dyn Fn(f64) -> f64| {
        for x in 0..BAR {
            let colour = scale.colour(value(f64::from(x) / f64::from(BAR - 1)));
            (0..8).for_each(|y| canvas.set([MARGIN + x, top + 16 + y], colour));
        }
    };
    let mut ends = None;
    match scale {
        Scale::Even([low, high]) | Scale::Signed([low, high]) => {
            bar(canvas, &|share| low + share * (high - low));
            ends = Some([format!("{low:.4}"), format!("{high:.4}")]);
        }
        Scale::Powers([low, high, unit]) => {
            bar(canvas, &|share| unit * low * (high / low).powf(share));
            ends = Some([format!("{low:.0e}"), format!("{high:.0e} of the scene")]);
        }
        Scale::Counts => {
            bar(canvas, &|share| (1.0 + MOST).powf(share) - 1.0);
            ends = Some(["0".to_owned(), format!("{MOST:.0} or more")]);
        }
        Scale::Codes(_) => {
            for (code, Code { text, x, line }) in codes.iter().enumerate() {
                let top = top + 15 + LINE * line;
                (0..64).for_each(|k| canvas.set([x + k % 8, top + 1 + k / 8], scale.colour(code as f64)));
                canvas.write([x + SWATCH, top], text);
            }
        }
        Scale::Numbers => {
            canvas.write([MARGIN, top + 15], "a colour for each number");
        }
    }
    if let Some([low, high]) = ends {
        let x = canvas.write([MARGIN + BAR + 6, top + 15], &format!("{low} to {high}"));
        debug_assert!(x <= LEAST_WIDTH);
    }
    let after = canvas.write([MARGIN, top + 3], name) + 2 * MARGIN;
    // Counts are of rays that met nothing, too.
    let outside: &[_] = match scale {
        Scale::Counts => &[(GAVE_UP, "gave up", after)],
        _ => &[(NOTHING, "nothing met", after), (GAVE_UP, "gave up", after + 100)],
    };
    for &(colour, text, x) in outside {
        (0..64).for_each(|k| canvas.set([x + k % 8, top + 4 + k / 8], colour));
        canvas.write([x + SWATCH, top + 3], text);
    }
}

/// The length of the legend's bar, and what is left free around it.
const BAR: u32 = 128;
const MARGIN: u32 = 6;
/// From where a colour stands to the text beside it.
const SWATCH: u32 = 10;

/// What is drawn on.
struct Canvas {
    size: [u32; 2],
    pixels: Vec<Rgb>,
}

impl Canvas {
    fn new(size: [u32; 2]) -> Self {
        Canvas { size, pixels: vec![GROUND; size.iter().map(|&side| side as usize).product()] }
    }

    /// Colours a pixel; outside there is none.
    fn set(&mut self, [x, y]: [u32; 2], colour: Rgb) {
        if x < self.size[0]
            && let Some(pixel) = self.pixels.get_mut(y as usize * self.size[0] as usize + x as usize)
        {
            *pixel = colour;
        }
    }

    /// Writes a line, its upper left corner there; where it ends.
    fn write(&mut self, [x, y]: [u32; 2], text: &str) -> u32 {
        let style = MonoTextStyle::new(&FONT_6X10, Rgb888::new(TEXT[0], TEXT[1], TEXT[2]));
        let text = Text::with_baseline(text, Point::new(x as i32, y as i32), style, Baseline::Top);
        text.draw(self).map_or(x, |next| next.x.max(0) as u32)
    }

    fn picture(self) -> Picture {
        let mut picture = Picture::new(self.size);
        self.pixels.chunks(self.size[0] as usize).for_each(|row| picture.push_row(row));
        picture
    }
}

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        Size::new(self.size[0], self.size[1])
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = embedded_graphics::Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        for embedded_graphics::Pixel(Point { x, y }, colour) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) {
                self.set([x, y], [colour.r(), colour.g(), colour.b()]);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channels::Channel;

    #[test]
    fn nothing_and_failures_are_outside_every_ramp() {
        let scales = [
            Scale::Even([0.0, 1.0]),
            Scale::Signed([-1.0, 1.0]),
            Scale::Powers([1e-17, 1e-4, 1.0]),
            Scale::Counts,
            Scale::Numbers,
        ];
        for scale in scales {
            for step in -1000..=3000 {
                let colour = scale.colour(f64::from(step) / 1000.0);
                assert!(![NOTHING, GAVE_UP].contains(&colour), "{scale:?} {step}");
            }
            assert_eq!(scale.colour(f64::NAN), NOTHING);
        }
        assert_eq!(Scale::Numbers.colour(f64::from(NONE)), NOTHING);
    }

    #[test]
    fn each_code_has_a_colour() {
        for (names, scale) in [(&STATUS[..], Scale::Codes(&STATUS)), (&PATHS[..], Scale::Codes(&PATHS))] {
            let colours: std::collections::BTreeSet<Rgb> =
                (0..names.len()).map(|code| scale.colour(code as f64)).collect();
            assert_eq!(colours.len(), names.len());
        }
    }

    /// Codes that did not fit were cut off at the picture's edge.
    #[test]
    fn codes_stand_in_as_many_lines_as_they_need() {
        let values = Values::Count((0..PATHS.len() as u32).flat_map(|code| vec![code; 12345]).collect());
        for width in [LEAST_WIDTH, 512, 1024, 4096] {
            let codes = codes(&Scale::Codes(&PATHS), &values, width);
            assert_eq!(codes.len(), PATHS.len());
            for (name, Code { text, x, .. }) in PATHS.iter().zip(&codes) {
                assert_eq!(*text, format!("{name} 12345"));
                assert!(x + SWATCH + 6 * text.len() as u32 <= width, "{text} at {width}");
            }
            for pair in codes.windows(2) {
                let follows = pair[1].line == pair[0].line && pair[1].x > pair[0].x;
                assert!(follows || (pair[1].line == pair[0].line + 1 && pair[1].x == MARGIN));
            }
        }
    }

    #[test]
    fn a_picture_has_its_pixels_and_a_legend_below() {
        let channels = Channels {
            size: [2, 1],
            all: vec![
                Channel { name: "u".to_owned(), values: Values::Real(vec![0.0, f32::NAN]) },
                Channel { name: "status".to_owned(), values: Values::Count(vec![1, 3]) },
            ],
        };
        let shown = picture(&channels, "u", &Scale::Even([0.0, 1.0])).expect("it is there");
        assert_eq!(shown.size(), [LEAST_WIDTH, 1 + LEGEND]);
        let first: Vec<Rgb> = shown.rows().next().expect("a row").to_vec();
        assert_eq!(first[..2], [[68, 1, 84], GAVE_UP]);
        assert!(shown.rows().skip(1).flatten().any(|&pixel| pixel == TEXT));
        assert_eq!(picture(&channels, "v", &Scale::Counts), None);
    }
}
