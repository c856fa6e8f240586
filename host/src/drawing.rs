//! Drawing: what rays see becomes the pixels of a picture, a row of them a job.

use std::fmt::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::ProgressBar;
use patchray::ray::RayError;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::batch::Lanes;
use crate::picture::rows::Rows;
use crate::picture::{self, GAVE_UP, Picture, encode};
use crate::prepared::Tracers;
use crate::scanline::{Lane, Outcome, Tally, rays_of};
use crate::scene::appearance::Appearance;
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::settings::Settings;
use crate::shade::painter::{self, Colour, Painted, Painter};
use crate::shade::shadows::Shadows;
use crate::shade::spectrum::{Basis, Rgb, Sampled};
use crate::stats::RaysByKind;

/// A picture and what drawing it came to.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The picture, of the rows that were drawn.
    pub picture: Picture,
    /// Which these are: all that were wanted, unless somebody stopped it.
    pub rows: Rows,
    /// What became of each sample's ray, scan line by scan line from the top; nothing unless it was to be kept.
    pub outcomes: Vec<Outcome>,
    /// The first pixel with a ray that the kernel refused, if there is one: its place from the left and the top, and why.
    pub refused: Option<([u32; 2], RayError)>,
    /// The sums over the camera's rays.
    pub tally: Tally,
    /// All rays, by what they are for.
    pub rays: RaysByKind,
    /// Those of them that have no answer.
    pub gave_up: RaysByKind,
    /// In how many parts light was counted.
    pub light_samples: u32,
}

/// A row of pixels, and what drawing it came to.
#[derive(Default)]
struct Row {
    pixels: Vec<picture::Rgb>,
    outcomes: Vec<Outcome>,
    tally: Tally,
    rays: RaysByKind,
    gave_up: RaysByKind,
    refused: Option<([u32; 2], RayError)>,
}

/// A picture to be drawn.
#[derive(Clone)]
pub struct Drawing<'d> {
    /// What traces its rays.
    pub tracers: &'d Tracers<'d>,
    /// Its rays.
    pub view: &'d View,
    /// What they see looks so.
    pub appearance: &'d Appearance,
    /// The shadows of its lights.
    pub shadows: &'d Shadows,
    /// Its rows of pixels that are wanted, all within its height.
    pub rows: Rows,
    /// Whether to keep what became of each ray, which takes some 80 bytes each: of a large picture, more than all else.
    pub outcomes: bool,
}

/// Who looks on while a picture is drawn.
#[derive(Clone, Debug)]
pub struct Watch<'w> {
    /// Goes one step on for each row.
    pub bar: ProgressBar,
    /// Once it is set, no further row is begun.
    pub stop: &'w AtomicBool,
}

/// Nobody.
impl Default for Watch<'_> {
    fn default() -> Self {
        static NEVER: AtomicBool = AtomicBool::new(false);
        Watch { bar: ProgressBar::hidden(), stop: &NEVER }
    }
}

/// Draws a view, a row of pixels a job, on rayon's current threads. The result does not depend on their number. Light is
/// counted as red, green and blue, or as nine samples of its spectrum where something is of metal.
pub fn draw(drawing: &Drawing, watch: &Watch) -> Drawn {
    let Drawing { view, appearance, shadows, .. } = drawing;
    if appearance.has_metal() {
        draw_in(Painter::new(Sampled::new(), view.eye, appearance, shadows), drawing, watch)
    } else {
        draw_in(Painter::new(Rgb, view.eye, appearance, shadows), drawing, watch)
    }
}

fn draw_in<const N: usize>(
    painter: Painter<'_, impl Basis<N>, N>,
    Drawing { tracers, view, rows, outcomes: keep, .. }: &Drawing,
    watch: &Watch,
) -> Drawn {
    let lanes = Lanes::new(tracers.picture.as_ref());
    let of_any = tracers.any.as_deref().map(Lanes::new);
    let side = view.sampling.side();
    let row = |py: u32, lane: &mut dyn Lane, mut any: Option<&mut dyn Lane>| {
        let mut row = Row::default();
        let mut lines = Vec::new();
        for line in side * py..side * (py + 1) {
            let samples = view.scan_line(line);
            let rays = rays_of(view, line, &samples);
            let mut outcomes = Vec::with_capacity(rays.len());
            lane.trace_line(&samples, &rays, &mut outcomes, &mut row.tally);
            let shadow = any.as_mut().map(|lane| &mut **lane as &mut dyn Lane);
            let painted = painter.paint(painter::Lanes { mirrored: lane, shadow }, &rays, &outcomes);
            lines.push(painted.colours);
            let Painted { mirrored, shadow, .. } = painted;
            row.rays += RaysByKind { mirrored: mirrored.rays, shadow: shadow.rays, ..RaysByKind::default() };
            row.gave_up += RaysByKind { mirrored: mirrored.gave_up, shadow: shadow.gave_up, ..RaysByKind::default() };
            let refused = outcomes.iter().enumerate().find_map(|(sample, outcome)| match outcome {
                Outcome::Refused(error) => Some(([sample as u32 / side, py], *error)),
                _ => None,
            });
            row.refused = row.refused.or(refused);
            if *keep {
                row.outcomes.extend(outcomes);
            }
        }
        watch.bar.inc(1);
        Row { pixels: pixels(&lines), ..row }
    };
    let wanted: Vec<u32> = rows.iter().collect();
    let drawn_rows: Vec<(u32, Row)> = wanted
        .into_par_iter()
        .filter(|_| !watch.stop.load(Ordering::Relaxed))
        .map(|py| {
            let row = lanes.with(|lane| match &of_any {
                Some(of_any) => of_any.with(|any| row(py, lane, Some(any))),
                None => row(py, lane, None),
            });
            (py, row)
        })
        .collect();
    let mut drawn = Drawn {
        picture: Picture::new([view.size[0], drawn_rows.len() as u32]),
        rows: drawn_rows.iter().map(|(py, _)| *py).collect(),
        outcomes: Vec::new(),
        tally: Tally::default(),
        rays: RaysByKind::default(),
        gave_up: RaysByKind::default(),
        refused: None,
        light_samples: N as u32,
    };
    for (_, Row { pixels, outcomes, tally, rays, gave_up, refused }) in drawn_rows {
        drawn.picture.push_row(&pixels);
        drawn.outcomes.extend(outcomes);
        drawn.tally.add(&tally);
        drawn.rays += rays;
        drawn.gave_up += gave_up;
        drawn.refused = drawn.refused.or(refused);
    }
    drawn.rays.camera = drawn.tally.rays;
    drawn.gave_up.camera = drawn.tally.gave_up_in_all();
    drawn
}

/// The pixels of a row, from the colours of its samples in one or two scan lines: the mean, in linear colour, of what the
/// display can show of each. Of a light many times brighter than white a quarter would still be white, and its edge a
/// staircase, however many samples a pixel has. A pixel with a ray that was given up shows that.
fn pixels(lines: &[Vec<Colour>]) -> Vec<picture::Rgb> {
    let side = lines.len();
    let samples = (side * side) as f64;
    let width = lines.first().map_or(0, Vec::len) / side.max(1);
    let pixel = |px: usize| {
        let samples_of = lines.iter().flat_map(|line| &line[side * px..side * (px + 1)]);
        let sum = samples_of.copied().try_fold([0.0; 3], |sum, colour| {
            colour.map(|colour: [f64; 3]| [0, 1, 2].map(|k| sum[k] + colour[k].clamp(0.0, 1.0)))
        });
        sum.map_or(GAVE_UP, |sum| encode(sum.map(|part| part / samples)))
    };
    (0..width).map(pixel).collect()
}

/// The hash of text, as it is written.
struct Hashed(Sha256);

impl Write for Hashed {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text);
        Ok(())
    }
}

/// What a picture depends on, in 64 hexadecimal digits: equal ones mean that all rows of two runs fit together, whichever
/// files the scene was read from and whatever the threads. SHA-256, since parts are put together in trust of it.
pub fn digest(model: &Model, appearance: &Appearance, settings: &Settings, view: &View) -> String {
    let settings = Settings { threads: 0, ..*settings };
    let mut hashed = Hashed(Sha256::new());
    // Numbers are written so that they read back to the same bits; into the hash, for the text of a large model is larger still.
    let version = env!("CARGO_PKG_VERSION");
    write!(hashed, "{version} {view:?} {settings:?} {appearance:?} {model:?}").expect("a hash takes any text");
    hashed.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the mean of the light itself, all but the first of these were white, and the edges of highlights were jagged.
    #[test]
    fn a_pixel_at_the_edge_of_a_bright_light_is_between_it_and_what_lies_beside() {
        let (light, dark) = (Some([40.0; 3]), Some([0.0; 3]));
        let lines = [vec![dark, dark, dark, light, light, light], vec![dark, dark, dark, dark, dark, light]];
        let expected = [0.0, 0.25, 0.75].map(|part| encode([part; 3]));
        assert_eq!(pixels(&lines), expected);
    }

    #[test]
    fn a_pixel_of_which_one_ray_was_given_up_shows_that() {
        assert_eq!(pixels(&[vec![Some([0.5; 3]), None], vec![Some([0.5; 3]); 2]]), [GAVE_UP]);
    }
}
