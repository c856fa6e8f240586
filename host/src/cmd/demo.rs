//! `patchray` without a verb: the built-in teapot, drawn with every method and compared with the oracle.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rayon::ThreadPool;
use serde::Serialize;

use super::outputs::{Outputs, StatsOutputs};
use super::{Failure, hear_parts, pool, progress};
use crate::drawing::{Drawing, Drawn, Watch, draw};
use crate::judge::{Agreement, OracleStats, Truth, ask};
use crate::oracle::Oracle;
use crate::output::{Output, OutputError};
use crate::picture::Picture;
use crate::picture::rows::Rows;
use crate::prepared::Tracers;
use crate::scene::appearance::Appearance;
use crate::scene::camera::View;
use crate::scene::file::Scene;
use crate::scene::model::Model;
use crate::scene::teapot::common_scene;
use crate::scene::trace::{Method, Precision};
use crate::settings::{Flags, Settings, SizeFlag};
use crate::shade::shadows::NO_SHADOWS;
use crate::stats::{Asked, SCHEMA, Stats, Used};
use crate::viewed::{Viewed, Wishes};

/// The command line without a verb.
#[derive(Args, Clone, Debug)]
pub struct DemoArgs {
    /// The size of the picture.
    #[command(flatten)]
    pub size: SizeFlag,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// A method in a precision, and how it did.
#[derive(Clone, Debug, Serialize)]
struct Run {
    #[serde(flatten)]
    stats: Stats,
    ns_per_ray: f64,
    /// How many rays the method answers in the time in which the oracle answers one.
    times_oracle: f64,
    agreement: Agreement,
}

/// All runs, as `--stats` and `--json` give them.
#[derive(Clone, Debug, Serialize)]
struct Report {
    schema: u32,
    picture: String,
    oracle: OracleStats,
    runs: Vec<Run>,
}

/// Where the picture goes if `-o` does not say.
const PICTURE: &str = "target/teapot.png";

/// Draws the teapot with every method in every precision, or with those that the flags name; prints a table of times,
/// counts and agreement with the oracle, and the name of the picture: that of the last run, all being the same but for
/// pixels that the table counts. In `f32` rays are rounded; those of the common view at 512 × 512 are exact.
///
/// # Errors
/// Too little memory for the settings, or an output that cannot be written.
pub fn run(args: &DemoArgs) -> Result<(), Failure> {
    let DemoArgs { size, flags } = args;
    let output = match &flags.output {
        Some(output) => output.clone(),
        None => default_picture()?,
    };
    let table = if flags.json { None } else { Some(Path::new("-")) };
    if table.is_some() && (output == Path::new("-") || flags.stats.as_deref() == table) {
        return Err(Failure::Usage {
            message: "the table goes to standard output".to_owned(),
            help: "name files with -o and --stats, or use --json instead of the table".to_owned(),
        });
    }
    Outputs::of_picture(Some(&output), &[], flags)?;
    let Scene { model, description, appearance, .. } = common_scene()?;
    let settings = Settings::of_flags(flags);
    hear_parts(flags.method, Asked::Closest, settings.parts)?;
    let mut png = Output::create(&output)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let view = description.camera.view(size.size.unwrap_or(description.image.size));
    let pool = pool(settings.threads)?;

    let bar = progress(u64::from(view.scan_lines()), "asking the oracle", flags.quiet);
    let (truths, oracle) = pool.install(|| ask(&Oracle::new(&model), &view, || bar.inc(1)));
    bar.finish_and_clear();
    let (runs, picture) =
        compare(&model, &appearance, &view, &combinations(flags, &settings), &pool, (&truths, &oracle), flags.quiet)?;
    if let Some(picture) = picture {
        picture.write_png(&mut png).map_err(|reason| png.failed(reason))?;
    }
    png.finish()?;
    let report = Report { schema: SCHEMA, picture: output.display().to_string(), oracle, runs };
    stats_outputs.finish(&report)?;
    if let Some(table) = table {
        let mut out = Output::create(table)?;
        out.write_all(report.to_text().as_bytes()).map_err(|reason| out.failed(reason))?;
        out.finish()?;
    }
    Ok(())
}

/// How often each method draws the view, all in turn: the least time counts, which other work on the machine disturbs least.
const PASSES: usize = 5;

/// Draws the view with all `settings`, and holds their answers against the truths; also the picture of the last.
fn compare(
    model: &Model,
    appearance: &Appearance,
    view: &View,
    settings: &[Settings],
    pool: &ThreadPool,
    (truths, oracle): (&[Truth], &OracleStats),
    quiet: bool,
) -> Result<(Vec<Run>, Option<Picture>), Failure> {
    let wishes = Wishes::of(appearance);
    let viewed = settings.iter().map(|settings| Viewed::build(model, settings, view, wishes));
    let mut viewed = viewed.collect::<Result<Vec<_>, _>>()?;
    let tracers = viewed.iter_mut().map(Viewed::tracers).collect::<Result<Vec<_>, _>>()?;
    let bar = progress((PASSES * settings.len()) as u64 * u64::from(view.size[1]), "drawing", quiet);
    let watch = Watch { bar, ..Watch::default() };
    let passes = (0..PASSES).map(|_| {
        let draw = |(tracers, _): &(Tracers, Used)| {
            let drawing = Drawing {
                tracers,
                view,
                appearance,
                shadows: &NO_SHADOWS,
                rows: Rows::all(view.size[1]),
                outcomes: true,
            };
            pool.install(|| draw(&drawing, &watch))
        };
        tracers.iter().map(draw).collect::<Vec<Drawn>>()
    });
    let fastest = passes.reduce(|mut fastest, pass| {
        for (best, drawn) in fastest.iter_mut().zip(pass) {
            best.tally.seconds = best.tally.seconds.min(drawn.tally.seconds);
        }
        fastest
    });
    watch.bar.finish_and_clear();
    let diagonal = model.control_box().map_or(0.0, |bounds| bounds.diagonal());
    let mut runs = Vec::new();
    let mut picture = None;
    for ((settings, (_, used)), drawn) in settings.iter().zip(tracers).zip(fastest.unwrap_or_default()) {
        let agreement = Agreement::of(&drawn.outcomes, truths, view, diagonal, settings.precision);
        let mut stats = Stats::new("teapot".to_owned(), settings, used, &drawn.tally);
        stats.size = Some(view.size);
        stats.samples = Some(view.sampling);
        let ns_per_ray = stats.intersect_seconds / stats.rays.max(1) as f64 * 1e9;
        let times_oracle = oracle.seconds / stats.intersect_seconds.max(f64::MIN_POSITIVE);
        runs.push(Run { stats, ns_per_ray, times_oracle, agreement });
        picture = Some(drawn.picture);
    }
    Ok((runs, picture))
}

/// [`PICTURE`], its folder made if it is not there.
fn default_picture() -> Result<PathBuf, OutputError> {
    let path = PathBuf::from(PICTURE);
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)
            .map_err(|reason| OutputError::Failed { path: folder.display().to_string(), reason })?;
    }
    Ok(path)
}

/// The settings of every run: those of the default method and precision come last.
fn combinations(flags: &Flags, settings: &Settings) -> Vec<Settings> {
    let mut methods = Method::value_variants().to_vec();
    // A stable sort, so that the others keep their order.
    methods.sort_by_key(|&method| method == Method::default());
    let mut all = Vec::new();
    for &precision in Precision::value_variants() {
        for &method in &methods {
            let wanted =
                flags.method.is_none_or(|only| only == method) && flags.precision.is_none_or(|only| only == precision);
            if wanted {
                all.push(Settings { method, precision, ..*settings });
            }
        }
    }
    all
}

impl Report {
    fn to_text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let mut line = |args: std::fmt::Arguments| {
            let _ = writeln!(text, "{args}");
        };
        line(format_args!(
            "{:<20}{:<10}{:>8}{:>9}{:>13}{:>8}{:>7}{:>8}{:>9}{:>10}{:>10}",
            "method",
            "precision",
            "time s",
            "ns/ray",
            "intersected",
            "hits",
            "wrong",
            "missed",
            "phantom",
            "undecided",
            "x oracle"
        ));
        for Run { stats, ns_per_ray, times_oracle, agreement } in &self.runs {
            let name = |value: Option<clap::builder::PossibleValue>| {
                value.map_or(String::new(), |value| value.get_name().to_owned())
            };
            let points = stats.work.get("intersection_points").copied().unwrap_or(0);
            let Agreement { wrong, missed, phantom, undecided, .. } = agreement;
            line(format_args!(
                "{:<20}{:<10}{:>8.3}{ns_per_ray:>9.0}{points:>13}{:>8}{wrong:>7}{missed:>8}{phantom:>9}{undecided:>10}\
                 {times_oracle:>10.0}",
                name(stats.method.to_possible_value()),
                name(stats.precision.to_possible_value()),
                stats.intersect_seconds,
                stats.hit_rays,
            ));
        }
        let OracleStats { rays, hit_rays, roots, open, seconds } = self.oracle;
        line(format_args!(
            "{:<20}{:<10}{seconds:>8.3}{:>9.0}{roots:>13}{hit_rays:>8}{:>7}{:>8}{:>9}{open:>10}{:>10}",
            "oracle",
            "f64",
            seconds / rays.max(1) as f64 * 1e9,
            "-",
            "-",
            "-",
            1
        ));
        line(format_args!(
            "\n{rays} rays; times are summed over {} threads, the least of {PASSES} passes taken in turn. Picture: {}",
            self.runs.first().map_or(0, |run| run.stats.threads),
            self.picture
        ));
        for run in &self.runs {
            for (limit, count) in &run.stats.gave_up_by_limit {
                line(format_args!("{count} rays gave up: the limit on {limit} ran out"));
            }
        }
        text
    }
}
