//! `patchray render`: a scene file in, a picture out.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use clap::Args;

use super::aov::{self, Aov};
use super::load::{self, Loaded};
use super::outputs::{Outputs, StatsOutputs};
use super::{Failure, interrupt, pixel, pool, preview, progress_in_rows, say, say_gave_up, summary};
use crate::drawing::{Drawing, Drawn, Watch, digest, draw};
use crate::output::{self, Output};
use crate::picture::part::Part;
use crate::picture::rows::Rows;
use crate::scene::camera::View;
use crate::scene::sampling::Sampling;
use crate::scene::trace::Precision;
use crate::settings::{Flags, SizeFlag};
use crate::shade::shadows::Shadows;
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
    /// Draw these rows only, from A up to B, the top one being 0, into a part for `patchray merge`; several with commas; what B
    /// has beyond the last row is left out
    #[arg(long, value_name = "A..B[,C..D]", help_heading = "Output")]
    pub rows: Option<Rows>,
    /// Draw only the rows that an interrupted run of the same picture has not finished, all if there is none
    #[arg(long, help_heading = "Output")]
    pub resume: bool,
    /// Write what one ray through the middle of each pixel met, and what that took: FILE.exr for all channels, NAME=FILE.png for
    /// one as a heat map; may be given more than once
    #[arg(long, value_name = "[NAME=]FILE", value_parser = aov::parse, conflicts_with = "rows", help_heading = "Output")]
    pub aov: Vec<Aov>,
    /// Print what this pixel's rays meet, instead of a picture; counted from 0, from the left and the top
    #[arg(long, value_name = "X,Y", value_parser = pixel::parse, conflicts_with_all = ["rows", "resume", "aov", "preview"],
        help_heading = "Output")]
    pub pixel: Option<[u32; 2]>,
    /// Tell with `--pixel` all that the method does for each ray
    #[arg(long, requires = "pixel", help_heading = "Output")]
    pub explain: bool,
    /// Show the picture in the terminal too
    #[arg(long, help_heading = "Output")]
    pub preview: bool,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// Draws the scene.
///
/// # Errors
/// Bad input, too little memory, an output that cannot be written, or an interruption; no output is left behind then but, of an
/// interrupted run, the part that is finished.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let RenderArgs { scene, rows, resume, aov, preview, pixel, explain, flags, .. } = args;
    let usage = |message: &str, help: &str| Failure::Usage { message: message.to_owned(), help: help.to_owned() };
    if let Some(pixel) = *pixel {
        if flags.output.is_some() || flags.stats.is_some() || flags.json {
            return Err(usage(
                "`--pixel` prints what a pixel's rays meet, and that alone",
                "leave out -o, --stats and --json",
            ));
        }
        let loaded = load::scene(scene, flags, &Outputs::default())?;
        return pixel::run(&loaded, &view_of(&loaded, args)?, pixel, *explain);
    }
    let Some(output) = &flags.output else {
        return Err(usage("the picture has no name", "add `-o OUT.png`, or `-o -` for standard output"));
    };
    let unfinished = unfinished(output);
    if *resume && unfinished.is_none() {
        return Err(usage("an interrupted run to standard output leaves nothing", "name a file with -o"));
    }
    let channels: Vec<_> = aov.iter().map(|aov| ("--aov", aov.path())).collect();
    let loaded = load::scene(scene, flags, &Outputs::of_picture(Some(output), &channels, flags)?)?;
    let Some((_, appearance)) = &loaded.scene else {
        return Err(Failure::Internal("a scene without a description".to_owned()));
    };
    let settings = &loaded.settings;
    let view = view_of(&loaded, args)?;
    let size = view.size;
    let all = Rows::all(size[1]);
    let wanted = rows.as_ref().map_or(all.clone(), |rows| rows.within(&all));
    if wanted.is_empty() {
        return Err(usage(
            &format!("there are no such rows: the picture has {}", size[1]),
            &format!("name rows within {all}"),
        ));
    }
    let mut part = Part::new(size, digest(&loaded.model, appearance, settings, &view));
    if let Some(path) = unfinished.as_deref().filter(|path| *resume && path.exists()) {
        take_over(&mut part, path)?;
    }
    let stop = interrupt::stop();
    let mut png = Output::create(output)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let mut viewed = Viewed::build(&loaded.model, settings, &view, Wishes::of(appearance))?;
    let (tracers, used) = viewed.tracers()?;
    let pool = pool(settings.threads)?;
    let (shadows, maps) = pool.install(|| Shadows::prepare(&loaded.model, appearance, settings, view.eye, stop))?;

    let rows_left = wanted.without(&part.rows());
    let rays = u64::from(size[0]) * u64::from(view.sampling.per_pixel());
    let watch = Watch { bar: progress_in_rows(rows_left.len() as u64, rays, "rendering", flags.quiet), stop };
    let drawing =
        Drawing { tracers: &tracers, view: &view, appearance, shadows: &shadows, rows: rows_left, outcomes: false };
    let drawn = pool.install(|| draw(&drawing, &watch));
    watch.bar.finish_and_clear();
    refuse_pixels(&drawn, scene, &loaded)?;
    part.add(&drawn.rows, &drawn.picture);
    if stop.load(Ordering::Relaxed) {
        return Err(keep(&part, unfinished.as_deref(), &wanted)?);
    }

    let mut stats = Stats::new(scene.display().to_string(), settings, used, &drawn.tally);
    stats.size = Some(size);
    stats.samples = Some(view.sampling);
    stats.rows = (drawn.rows != all).then(|| drawn.rows.to_string());
    stats.rays_by_kind = Some(RaysByKind { map: maps.iter().map(|map| map.rays).sum(), ..drawn.rays });
    stats.gave_up_by_kind = Some(RaysByKind { map: maps.iter().map(|map| map.gave_up).sum(), ..drawn.gave_up });
    let method = settings.method;
    stats.methods_by_kind = Some(MethodsByKind {
        camera: method,
        mirrored: (drawn.rays.mirrored > 0).then(|| method.of_any_rays()),
        shadow: (drawn.rays.shadow > 0).then(|| method.of_any_hits()),
    });
    stats.shadow_maps = maps;
    stats.light_samples = Some(drawn.light_samples);
    if !aov.is_empty() {
        pool.install(|| aov::write(aov, &loaded.model, settings, &view, flags.quiet))?;
    }
    let picture = part.whole();
    let written = match (&picture, rows) {
        (Some(picture), None) => picture.write_png(&mut png),
        _ => part.write_png(&mut png),
    };
    written.map_err(|reason| png.failed(reason))?;
    png.finish()?;
    stats_outputs.finish(&stats)?;
    if let Some(path) = unfinished.filter(|path| *resume && path.exists()) {
        fs::remove_file(&path).map_err(|reason| output::OutputError::failed(&path, reason))?;
    }
    if *preview {
        say(format_args!("{}", preview::of(&picture.unwrap_or(drawn.picture))));
    }
    say_gave_up(&stats);
    if !flags.quiet {
        say(format_args!("{}", summary(&stats)));
    }
    Ok(())
}

/// The view that a scene and flags ask for.
fn view_of(loaded: &Loaded, RenderArgs { size, samples, .. }: &RenderArgs) -> Result<View, Failure> {
    let Some((description, _)) = &loaded.scene else {
        return Err(Failure::Internal("a scene without a description".to_owned()));
    };
    let size = size.size.unwrap_or(description.image.size);
    Ok(description.camera.view(size).sampled(samples.unwrap_or(description.image.samples)))
}

/// The file beside a picture in which an interrupted run leaves its rows; none beside standard output.
fn unfinished(output: &Path) -> Option<PathBuf> {
    (output != Path::new("-")).then(|| output.with_extension("unfinished.png"))
}

/// Keeps the rows that an interrupted run has finished, and says so.
fn keep(part: &Part, unfinished: Option<&Path>, wanted: &Rows) -> Result<Failure, Failure> {
    let finished = part.rows().len();
    let kept = match unfinished {
        Some(path) if finished > 0 => {
            output::write(path, |png| part.write_png(png))?;
            let (path, wanted) = (path.display(), wanted.len());
            format!("{finished} of {wanted} rows are kept in `{path}`; --resume goes on with the others")
        }
        _ => "no rows are kept".to_owned(),
    };
    Ok(Failure::Interrupted { kept })
}

/// Takes over what an interrupted run has left.
fn take_over(part: &mut Part, path: &Path) -> Result<(), Failure> {
    let left = Part::read(path).and_then(|left| part.join(left));
    left.map_err(|reason| Failure::Refused {
        file: path.display().to_string(),
        reason: reason.to_string(),
        help: "draw the same picture as the interrupted run, or remove that file, or leave --resume out".to_owned(),
    })
}

/// Refuses a view with a pixel whose ray the kernel refuses.
fn refuse_pixels(drawn: &Drawn, scene: &Path, loaded: &Loaded) -> Result<(), Failure> {
    let Some(([px, py], error)) = drawn.refused else {
        return Ok(());
    };
    let precision = loaded.settings.precision;
    let help = match precision {
        Precision::F32 => "bring the camera's vectors to the size of the surfaces, or use --precision f64",
        Precision::F64 => "bring the camera, and the scene, to a size whose inverse a number can hold",
    };
    Err(Failure::Refused {
        file: scene.display().to_string(),
        reason: format!("the camera's ray of pixel ({px}, {py}) cannot be traced in {precision:?}: {error}"),
        help: help.to_owned(),
    })
}
