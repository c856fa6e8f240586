//! `patchray render`: a scene file in, a picture out.

use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::ProgressBar;
use rayon::prelude::*;

use super::load::{self, Loaded};
use super::{Failure, StatsOutputs, check_outputs, pool, progress, say, say_gave_up, summary};
use crate::output::Output;
use crate::picture::{GAVE_UP, Picture, Rgb, encode};
use crate::scanline::{Lanes, Outcome, Tally, Tracer};
use crate::scene::camera::View;
use crate::scene::file::Description;
use crate::scene::rays::RayLine;
use crate::settings::{Flags, SizeFlag};
use crate::shade::Shader;
use crate::stats::Stats;

/// The command line of `render`.
#[derive(Args, Clone, Debug)]
pub struct RenderArgs {
    /// The scene file (TOML)
    pub scene: PathBuf,
    /// The size of the picture.
    #[command(flatten)]
    pub size: SizeFlag,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// Draws the scene.
///
/// # Errors
/// Bad input, too little memory, or an output that cannot be written; no output is left behind then.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let RenderArgs { scene, size, flags } = args;
    let Some(output) = &flags.output else {
        return Err(Failure::Usage {
            message: "the picture has no name".to_owned(),
            help: "add `-o OUT.png`, or `-o -` for standard output".to_owned(),
        });
    };
    check_outputs(Some(output), &[scene], flags)?;
    let loaded = load::scene(scene, flags)?;
    let Some(description) = &loaded.description else {
        return Err(Failure::Internal("a scene without a description".to_owned()));
    };
    let mut png = Output::create(output)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let (prepared, prepare_seconds) = loaded.prepare()?;
    let settings = &loaded.settings;
    let tracer = prepared.tracer(settings);

    let size = size.size.unwrap_or(description.image.size);
    let view = description.camera.view(size);
    let bar = progress(u64::from(size[1]), "rendering", flags.quiet);
    let drawn = pool(settings.threads)?.install(|| draw(tracer.as_ref(), &view, description, &bar));
    bar.finish_and_clear();
    refuse_pixels(&drawn, scene, &loaded)?;

    let (scene, lane) = (scene.display().to_string(), tracer.lane_bytes());
    let mut stats = Stats::new(scene, settings, &prepared, prepare_seconds, lane, &drawn.tally);
    stats.size = Some(size);
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
    /// What became of each pixel's ray, row by row from the top.
    pub outcomes: Vec<Outcome>,
    /// The sums.
    pub tally: Tally,
}

/// The rays of a row of pixels, a scan line.
pub fn row(view: &View, py: u32) -> Vec<RayLine> {
    let ray = |px| RayLine {
        origin: view.eye,
        direction: view.direction(px, py),
        t_min: 0.0,
        t_max: f64::INFINITY,
        scan_line: u64::from(py),
        valid: true,
    };
    (0..view.size[0]).map(ray).collect()
}

/// Draws a view, a scan line a job, on rayon's current threads. The result does not depend on their number.
pub fn draw(tracer: &dyn Tracer, view: &View, description: &Description, bar: &ProgressBar) -> Drawn {
    let Description { light, material, background, .. } = description;
    let shader = Shader::new(view.eye, light, material);
    let background = encode(*background);
    let lanes = Lanes::new(tracer);
    let rows: Vec<(Vec<Rgb>, Vec<Outcome>, Tally)> = (0..view.size[1])
        .into_par_iter()
        .map(|py| {
            let rays = row(view, py);
            let (mut outcomes, mut tally) = (Vec::with_capacity(rays.len()), Tally::default());
            lanes.with(|lane| lane.trace(&rays, false, &mut outcomes, &mut tally));
            let pixels = rays.iter().zip(&outcomes).map(|(ray, outcome)| match outcome {
                Outcome::Hit(found) => {
                    let point = [0, 1, 2].map(|k| ray.origin[k] + found.t * ray.direction[k]);
                    encode(shader.colour(point, found.normal))
                }
                Outcome::Miss => background,
                Outcome::GaveUp { .. } | Outcome::Refused(_) | Outcome::Invalid => GAVE_UP,
            });
            let pixels = pixels.collect();
            bar.inc(1);
            (pixels, outcomes, tally)
        })
        .collect();
    let mut drawn = Drawn { picture: Picture::new(view.size), outcomes: Vec::new(), tally: Tally::default() };
    for (pixels, outcomes, tally) in rows {
        drawn.picture.push_row(&pixels);
        drawn.outcomes.extend(outcomes);
        drawn.tally.add(&tally);
    }
    drawn
}

/// Refuses a view with a pixel whose ray the kernel refuses.
fn refuse_pixels(drawn: &Drawn, scene: &Path, loaded: &Loaded) -> Result<(), Failure> {
    let refused = drawn.outcomes.iter().enumerate().find_map(|(pixel, outcome)| match outcome {
        Outcome::Refused(error) => Some((pixel, error)),
        _ => None,
    });
    let Some((pixel, error)) = refused else {
        return Ok(());
    };
    let width = drawn.picture.size()[0] as usize;
    let precision = loaded.settings.precision;
    Err(Failure::Refused {
        file: scene.display().to_string(),
        reason: format!(
            "the camera's ray of pixel ({}, {}) cannot be traced in {precision:?}: {error}",
            pixel % width,
            pixel / width
        ),
        help: "bring the camera's vectors to the size of the surfaces, or use --precision f64".to_owned(),
    })
}
