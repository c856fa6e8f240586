//! `patchray study`: error against run time, a file per cell.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use super::outputs::{Outputs, StatsOutputs};
use super::{Failure, hear_parts, load, pool, progress, say};
use crate::oracle::Oracle;
use crate::output;
use crate::scene::nearest::did_you_mean;
use crate::scene::teapot::common_scene;
use crate::settings::{Flags, Settings, SizeFlag};
use crate::stats::{Asked, SCHEMA, to_json};
use crate::study::folder::{Folder, FolderError, Manifest};
use crate::study::plan::{Cell, Shard, plan};
use crate::study::replay::replay;
use crate::study::run::{Study, groups, passes};
use crate::study::subject::{Subject, camera_of, words_of};
use crate::study::truth::of_picture;

/// The command line of `study`.
#[derive(Args, Clone, Debug)]
#[command(mut_arg("output", |arg| arg.value_name("FOLDER").help("The folder of the results [default: target/study]")))]
pub struct StudyArgs {
    /// A scene file (.toml) or the surfaces (.bpt, .json) [default: the teapot in the common view]
    pub scene: Option<PathBuf>,
    /// The size of the picture.
    #[command(flatten)]
    pub size: SizeFlag,
    /// How often each cell is timed, at least 1; cells of one setting take turns
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000),
        help_heading = "Cells")]
    pub repetitions: u32,
    /// Print the names of the cells, and measure nothing
    #[arg(long, help_heading = "Cells")]
    pub list: bool,
    /// The cell of this name alone; may be given several times
    #[arg(long, value_name = "ID", help_heading = "Cells")]
    pub only: Vec<String>,
    /// A part of the cells, I from 1 to N, such as 1/4: for one of several machines
    #[arg(long, value_name = "I/N", help_heading = "Cells")]
    pub shard: Option<Shard>,
    /// Trace the scan line of this pixel by the one cell that --only names, and print what the cell and the oracle say of it
    #[arg(long, value_name = "X,Y", value_parser = pixel, conflicts_with_all = ["list", "shard"], help_heading = "Cells")]
    pub pixel: Option<[u32; 2]>,
    /// The common flags. `-o` names the folder of the results, by default `target/study`.
    #[command(flatten)]
    pub flags: Flags,
}

/// Where results go if `-o` does not say.
const FOLDER: &str = "target/study";

/// The size of the picture if `--size` does not say: the whole study then ends within minutes, and the rays of the common
/// view are exact in `f32`.
const SIZE: [u32; 2] = [256, 256];

fn pixel(text: &str) -> Result<[u32; 2], String> {
    let pixel = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    pixel.ok_or("write the column and the row of a pixel, such as 40,12".to_owned())
}

/// What was done, as `--stats` and `--json` give it.
#[derive(Clone, Debug, Serialize)]
struct Done {
    schema: u32,
    folder: String,
    /// Cells that were asked for.
    cells: usize,
    /// Those that were finished before.
    finished_before: usize,
    /// Those that could not be traced, which is a result too.
    failed: Vec<String>,
}

/// Measures what is not yet measured.
///
/// # Errors
/// Flags that do not go together, bad input, or results that cannot be written; those that were finished before stay.
pub fn run(args: &StudyArgs) -> Result<(), Failure> {
    let StudyArgs { repetitions, flags, .. } = args;
    let stdout = Path::new("-");
    // Results go to a folder, which replaces no input.
    let outputs = Outputs::new(None, &[], flags)?;
    let cells = cells(args)?;
    if args.list {
        let ids: Vec<String> = cells.iter().map(Cell::id).collect();
        let text = if flags.json { to_json(&ids) } else { ids.join("\n") + "\n" };
        return Ok(output::write(stdout, |out| out.write_all(text.as_bytes()))?);
    }
    let subject = subject(args, &outputs)?;
    if let Some(pixel) = args.pixel {
        let [cell] = cells[..] else {
            return Err(usage("--pixel is of one cell", "name it with --only ID; --list prints all names"));
        };
        let replay = replay(&subject, &cell, pixel);
        let replay =
            replay.map_err(|message| usage(&message, "name a pixel of the picture, and a cell that can be traced"))?;
        let text = if flags.json { to_json(&replay) } else { replay.to_text() };
        return Ok(output::write(stdout, |out| out.write_all(text.as_bytes()))?);
    }

    let path = flags.output.clone().unwrap_or(PathBuf::from(FOLDER));
    let stats_outputs = StatsOutputs::create(flags)?;
    let folder = Folder::create(&path, manifest(&subject, flags)).map_err(refused)?;
    let pending: Vec<Cell> = cells.iter().filter(|cell| !folder.has(&cell.id())).copied().collect();
    let mut failed = Vec::new();
    if !pending.is_empty() {
        let bar = progress(u64::from(subject.picture.scan_lines()), "asking the oracle", flags.quiet);
        let oracle = Oracle::new(&subject.model);
        let truths = pool(subject.settings.threads)?.install(|| of_picture(&oracle, &subject.picture, || bar.inc(1)));
        bar.finish_and_clear();
        let bar = progress(passes(*repetitions) * pending.len() as u64, "measuring", flags.quiet);
        let study = Study { subject: &subject, truths: &truths, repetitions: *repetitions, step: &|| bar.inc(1) };
        for group in groups(&pending) {
            let records = study.measure(group).map_err(|reason| Failure::Refused {
                file: subject.name.clone(),
                reason,
                help: "look at the scene with `info` and `render`".to_owned(),
            })?;
            for record in records {
                if record.result.is_err() {
                    failed.push(record.head.id.clone());
                }
                folder.write(&record)?;
            }
        }
        bar.finish_and_clear();
    }
    let finished_before = cells.len() - pending.len();
    if !flags.quiet {
        let shown = path.display();
        say(format_args!(
            "{} cells in {shown}: {finished_before} finished before, {} measured, of which {} could not be traced\n\
             patchray report {shown} draws them",
            cells.len(),
            pending.len(),
            failed.len()
        ));
    }
    let done = Done { schema: SCHEMA, folder: path.display().to_string(), cells: cells.len(), finished_before, failed };
    Ok(stats_outputs.finish(&done)?)
}

fn usage(message: &str, help: &str) -> Failure {
    Failure::Usage { message: message.to_owned(), help: help.to_owned() }
}

/// The cells that the flags ask for.
fn cells(args: &StudyArgs) -> Result<Vec<Cell>, Failure> {
    let StudyArgs { only, shard, flags, .. } = args;
    let all = plan(flags.method, flags.precision);
    let ids: Vec<String> = all.iter().map(Cell::id).collect();
    let known: Vec<&str> = ids.iter().map(String::as_str).collect();
    if let Some(unknown) = only.iter().find(|id| !ids.contains(id)) {
        let suggestion = did_you_mean(unknown, &known).unwrap_or_default();
        return Err(usage(&format!("there is no cell `{unknown}`{suggestion}"), "--list prints all names"));
    }
    let wanted: Vec<Cell> = all
        .into_iter()
        .zip(&ids)
        .filter(|(_, id)| only.is_empty() || only.contains(id))
        .map(|(cell, _)| cell)
        .collect();
    Ok(shard.map_or(wanted.clone(), |shard| shard.of(wanted)))
}

/// What the study is of.
fn subject(args: &StudyArgs, outputs: &Outputs) -> Result<Subject, Failure> {
    let StudyArgs { scene, size, flags, .. } = args;
    let size = size.size.unwrap_or(SIZE);
    let words = words_of(flags);
    hear_parts(flags.method, Asked::Closest, Settings::of_flags(flags).parts)?;
    let Some(path) = scene else {
        let scene = common_scene()?;
        return Ok(Subject {
            name: "the teapot in the common view".to_owned(),
            argument: None,
            patches: "fixtures/patches/teapot.bpt".to_owned(),
            picture: scene.description.camera.view(size),
            model: scene.model,
            settings: Settings::of_flags(flags),
            words,
        });
    };
    let loaded = load::scene_or_patches(path, flags, outputs)?;
    let camera = loaded.scene.as_ref().map_or_else(|| camera_of(&loaded.model), |(description, _)| description.camera);
    let shown = path.display().to_string();
    Ok(Subject {
        name: shown.clone(),
        argument: Some(shown.clone()),
        patches: shown,
        picture: camera.view(size),
        model: loaded.model,
        settings: loaded.settings,
        words,
    })
}

/// What the folder is told that the study is of: all its cells, whichever part is measured now.
fn manifest(subject: &Subject, flags: &Flags) -> Manifest {
    let settings = Settings {
        // Each cell has its own, and how many threads there are decides nothing.
        method: Default::default(),
        precision: Default::default(),
        threads: 1,
        ..subject.settings
    };
    Manifest {
        schema: SCHEMA,
        scene: subject.name.clone(),
        size: subject.picture.size,
        fingerprint: subject.fingerprint(),
        surfaces: subject.model.surfaces.len() as u64,
        diagonal: subject.diagonal(),
        // Plain numbers and names can always be said.
        settings: serde_json::to_value(settings).unwrap_or_default(),
        cells: plan(flags.method, flags.precision).iter().map(Cell::id).collect(),
    }
}

/// The failure for a folder that cannot be used.
pub(super) fn refused(error: FolderError) -> Failure {
    match error {
        FolderError::Other(message) => usage(&message, "name another folder with -o, or remove this one"),
        FolderError::Unreadable(reason) => Failure::Refused {
            file: "the folder of the study".to_owned(),
            reason,
            help: "name a folder that `patchray study` made".to_owned(),
        },
        FolderError::Output(error) => error.into(),
    }
}
