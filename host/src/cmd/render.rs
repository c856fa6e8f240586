//! `patchray render`: a scene file in, a picture out.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::ProgressBar;
use patchray::ray::RayError;
use rayon::prelude::*;

use super::load::{self, Loaded};
use super::{Failure, StatsOutputs, check_outputs, pool, progress, say, say_gave_up, summary};
use crate::batch::Lanes;
use crate::output::Output;
use crate::picture::{self, GAVE_UP, Picture, encode};
use crate::prepared::Tracers;
use crate::scanline::{Lane, Outcome, Tally, rays_of};

pub use crate::scanline::row;
use crate::scene::appearance::Appearance;
use crate::scene::camera::View;
use crate::scene::sampling::Sampling;
use crate::settings::{Flags, SizeFlag};
use crate::shade::painter::{self, Colour, Painter};
use crate::shade::shadows::Shadows;
use crate::shade::spectrum::{Basis, Rgb, Sampled};
use crate::stats::{MethodsByKind, RaysByKind, Stats};
use crate::viewed::{Viewed, Wishes};

/// The command line of `render`.
#[derive(Args, Clone, Debug)]
pub struct RenderArgs {
    /// The scene file (TOML)
    pub scene: PathBuf,
    /// The size of the picture.
    #[command(flatten)]
    pub size: SizeFlag,
    /// The samples of a pixel: one, or four, uniform or jittered [default: one]
    #[arg(long, value_enum, help_heading = "Output")]
    pub samples: Option<Sampling>,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// Draws the scene.
///
/// # Errors
/// Bad input, too little memory, or an output that cannot be written; no output is left behind then.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let RenderArgs { scene, size, samples, flags } = args;
    let Some(output) = &flags.output else {
        return Err(Failure::Usage {
            message: "the picture has no name".to_owned(),
            help: "add `-o OUT.png`, or `-o -` for standard output".to_owned(),
        });
    };
    check_outputs(Some(output), &[scene], flags)?;
    let loaded = load::scene(scene, flags)?;
    let Some((description, appearance)) = &loaded.scene else {
        return Err(Failure::Internal("a scene without a description".to_owned()));
    };
    let mut png = Output::create(output)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let settings = &loaded.settings;
    let size = size.size.unwrap_or(description.image.size);
    let view = description.camera.view(size).sampled(samples.unwrap_or(description.image.samples));
    let mut viewed = Viewed::build(&loaded.model, settings, &view, Wishes::of(appearance))?;
    let (tracers, used) = viewed.tracers()?;
    let pool = pool(settings.threads)?;
    let (shadows, maps) = pool.install(|| Shadows::prepare(&loaded.model, appearance, settings, view.eye))?;

    let bar = progress(u64::from(size[1]), "rendering", flags.quiet);
    let rows = 0..view.size[1];
    let drawing = Drawing { tracers: &tracers, view: &view, appearance, shadows: &shadows, rows, outcomes: false };
    let drawn = pool.install(|| draw(&drawing, &bar));
    bar.finish_and_clear();
    refuse_pixels(&drawn, scene, &loaded)?;

    let mut stats = Stats::new(scene.display().to_string(), settings, used, &drawn.tally);
    stats.size = Some(size);
    stats.samples = Some(view.sampling);
    stats.rays_by_kind = Some(RaysByKind { map: maps.iter().map(|map| map.rays).sum(), ..drawn.rays });
    let method = settings.method;
    stats.methods_by_kind = Some(MethodsByKind {
        camera: method,
        mirrored: (drawn.rays.mirrored > 0).then(|| method.of_any_rays()),
        shadow: (drawn.rays.shadow > 0).then(|| method.of_any_hits()),
    });
    stats.shadow_maps = maps;
    stats.light_samples = Some(drawn.light_samples);
    drawn.picture.write_png(&mut png).map_err(|reason| png.failed(reason))?;
    png.finish()?;
    stats_outputs.finish(&stats)?;
    say_gave_up(&stats);
    if !flags.quiet {
        say(format_args!("{}", summary(&stats)));
    }
    Ok(())
}

/// A picture and what drawing it came to.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The picture, of the rows that were wanted.
    pub picture: Picture,
    /// What became of each sample's ray, scan line by scan line from the top; nothing unless it was to be kept.
    pub outcomes: Vec<Outcome>,
    /// The first pixel with a ray that the kernel refused, if there is one: its place from the left and the top, and why.
    pub refused: Option<([u32; 2], RayError)>,
    /// The sums over the camera's rays.
    pub tally: Tally,
    /// All rays, by what they are for.
    pub rays: RaysByKind,
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
    /// Its rows of pixels that are wanted, from the top, 0 being the first; within its height.
    pub rows: Range<u32>,
    /// Whether to keep what became of each ray, which takes some 80 bytes each: of a large picture, more than all else.
    pub outcomes: bool,
}

/// Draws a view, a row of pixels a job, on rayon's current threads. The result does not depend on their number. Light is
/// counted as red, green and blue, or as nine samples of its spectrum where something is of metal.
pub fn draw(drawing: &Drawing, bar: &ProgressBar) -> Drawn {
    let Drawing { view, appearance, shadows, .. } = drawing;
    if appearance.has_metal() {
        draw_in(Painter::new(Sampled::new(), view.eye, appearance, shadows), drawing, bar)
    } else {
        draw_in(Painter::new(Rgb, view.eye, appearance, shadows), drawing, bar)
    }
}

fn draw_in<const N: usize>(
    painter: Painter<'_, impl Basis<N>, N>,
    Drawing { tracers, view, rows, outcomes: keep, .. }: &Drawing,
    bar: &ProgressBar,
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
            row.rays.mirrored += painted.mirrored;
            row.rays.shadow += painted.shadow;
            let refused = outcomes.iter().enumerate().find_map(|(sample, outcome)| match outcome {
                Outcome::Refused(error) => Some(([sample as u32 / side, py], *error)),
                _ => None,
            });
            row.refused = row.refused.or(refused);
            if *keep {
                row.outcomes.extend(outcomes);
            }
        }
        bar.inc(1);
        Row { pixels: pixels(&lines), ..row }
    };
    let drawn_rows: Vec<Row> = rows
        .clone()
        .into_par_iter()
        .map(|py| {
            lanes.with(|lane| match &of_any {
                Some(of_any) => of_any.with(|any| row(py, lane, Some(any))),
                None => row(py, lane, None),
            })
        })
        .collect();
    let mut drawn = Drawn {
        picture: Picture::new([view.size[0], rows.len() as u32]),
        outcomes: Vec::new(),
        tally: Tally::default(),
        rays: RaysByKind::default(),
        refused: None,
        light_samples: N as u32,
    };
    for Row { pixels, outcomes, tally, rays, refused } in drawn_rows {
        drawn.picture.push_row(&pixels);
        drawn.outcomes.extend(outcomes);
        drawn.tally.add(&tally);
        drawn.rays.mirrored += rays.mirrored;
        drawn.rays.shadow += rays.shadow;
        drawn.refused = drawn.refused.or(refused);
    }
    drawn.rays.camera = drawn.tally.rays;
    drawn
}

/// The pixels of a row, from the colours of its samples in one or two scan lines: their mean, in linear colour. A pixel with
/// a ray that was given up shows that.
fn pixels(lines: &[Vec<Colour>]) -> Vec<picture::Rgb> {
    let side = lines.len();
    let samples = (side * side) as f64;
    let width = lines.first().map_or(0, Vec::len) / side.max(1);
    let pixel = |px: usize| {
        let samples_of = lines.iter().flat_map(|line| &line[side * px..side * (px + 1)]);
        let sum = samples_of
            .copied()
            .try_fold([0.0; 3], |sum, colour| colour.map(|colour: [f64; 3]| [0, 1, 2].map(|k| sum[k] + colour[k])));
        sum.map_or(GAVE_UP, |sum| encode(sum.map(|part| part / samples)))
    };
    (0..width).map(pixel).collect()
}

/// Refuses a view with a pixel whose ray the kernel refuses.
fn refuse_pixels(drawn: &Drawn, scene: &Path, loaded: &Loaded) -> Result<(), Failure> {
    let Some(([px, py], error)) = drawn.refused else {
        return Ok(());
    };
    let precision = loaded.settings.precision;
    Err(Failure::Refused {
        file: scene.display().to_string(),
        reason: format!("the camera's ray of pixel ({px}, {py}) cannot be traced in {precision:?}: {error}"),
        help: "bring the camera's vectors to the size of the surfaces, or use --precision f64".to_owned(),
    })
}
