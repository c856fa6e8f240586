//! `patchray render`: a scene file in, a picture out.

use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::ProgressBar;
use rayon::prelude::*;

use super::load::{self, Loaded};
use super::{Failure, StatsOutputs, check_outputs, pool, progress, say, say_gave_up, summary};
use crate::batch::Lanes;
use crate::output::Output;
use crate::picture::{self, GAVE_UP, Picture, encode};
use crate::scanline::{Outcome, Tally, Tracer, rays_of};

pub use crate::scanline::row;
use crate::scene::appearance::Appearance;
use crate::scene::camera::View;
use crate::scene::sampling::Sampling;
use crate::settings::{Flags, SizeFlag};
use crate::shade::painter::{Colour, Painter};
use crate::shade::spectrum::{Basis, Rgb, Sampled};
use crate::stats::{RaysByKind, Stats};
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
    let (tracer, used) = viewed.tracer()?;

    let bar = progress(u64::from(size[1]), "rendering", flags.quiet);
    let drawn = pool(settings.threads)?.install(|| draw(tracer.as_ref(), &view, appearance, &bar));
    bar.finish_and_clear();
    refuse_pixels(&drawn, &view, scene, &loaded)?;

    let mut stats = Stats::new(scene.display().to_string(), settings, used, &drawn.tally);
    stats.size = Some(size);
    stats.samples = Some(view.sampling);
    stats.rays_by_kind = Some(drawn.rays);
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
    /// The picture.
    pub picture: Picture,
    /// What became of each sample's ray, scan line by scan line from the top.
    pub outcomes: Vec<Outcome>,
    /// The sums over the camera's rays.
    pub tally: Tally,
    /// All rays, by what they are for.
    pub rays: RaysByKind,
    /// In how many parts light was counted.
    pub light_samples: u32,
}

/// Draws a view, a row of pixels a job, on rayon's current threads. The result does not depend on their number. Light is
/// counted as red, green and blue, or as nine samples of its spectrum where something is of metal.
pub fn draw(tracer: &dyn Tracer, view: &View, appearance: &Appearance, bar: &ProgressBar) -> Drawn {
    if appearance.has_metal() {
        draw_in(Sampled::new(), tracer, view, appearance, bar)
    } else {
        draw_in(Rgb, tracer, view, appearance, bar)
    }
}

fn draw_in<const N: usize>(
    basis: impl Basis<N>,
    tracer: &dyn Tracer,
    view: &View,
    appearance: &Appearance,
    bar: &ProgressBar,
) -> Drawn {
    let painter = Painter::new(basis, view.eye, appearance);
    let lanes = Lanes::new(tracer);
    let side = view.sampling.side();
    let rows: Vec<(Vec<picture::Rgb>, Vec<Outcome>, Tally, u64)> = (0..view.size[1])
        .into_par_iter()
        .map(|py| {
            let (mut all, mut tally) = (Vec::new(), Tally::default());
            let (mut lines, mut mirrored) = (Vec::new(), 0);
            lanes.with(|lane| {
                for line in side * py..side * (py + 1) {
                    let samples = view.scan_line(line);
                    let rays = rays_of(view, line, &samples);
                    let mut outcomes = Vec::with_capacity(rays.len());
                    lane.trace_line(&samples, &rays, &mut outcomes, &mut tally);
                    let painted = painter.paint(lane, &rays, &outcomes);
                    lines.push(painted.colours);
                    mirrored += painted.mirrored;
                    all.extend(outcomes);
                }
            });
            bar.inc(1);
            (pixels(&lines), all, tally, mirrored)
        })
        .collect();
    let mut drawn = Drawn {
        picture: Picture::new(view.size),
        outcomes: Vec::new(),
        tally: Tally::default(),
        rays: RaysByKind::default(),
        light_samples: N as u32,
    };
    for (pixels, outcomes, tally, mirrored) in rows {
        drawn.picture.push_row(&pixels);
        drawn.outcomes.extend(outcomes);
        drawn.tally.add(&tally);
        drawn.rays.mirrored += mirrored;
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
fn refuse_pixels(drawn: &Drawn, view: &View, scene: &Path, loaded: &Loaded) -> Result<(), Failure> {
    let refused = drawn.outcomes.iter().enumerate().find_map(|(sample, outcome)| match outcome {
        Outcome::Refused(error) => Some((sample, error)),
        _ => None,
    });
    let Some((sample, error)) = refused else {
        return Ok(());
    };
    let side = view.sampling.side() as usize;
    let width = side * drawn.picture.size()[0] as usize;
    let precision = loaded.settings.precision;
    Err(Failure::Refused {
        file: scene.display().to_string(),
        reason: format!(
            "the camera's ray of pixel ({}, {}) cannot be traced in {precision:?}: {error}",
            sample % width / side,
            sample / width / side
        ),
        help: "bring the camera's vectors to the size of the surfaces, or use --precision f64".to_owned(),
    })
}
