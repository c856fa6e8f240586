//! `patchray tables`: the paper's experiment, measured, with the paper's figures beside ours.

use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use clap::Args;
use rayon::prelude::*;

use super::outputs::{Outputs, StatsOutputs};
use super::{Failure, pool, progress};
use crate::experiment::rays::{cameras, lines, shadows, shuffled};
use crate::experiment::subject::{Family, Subject, changes, ladder, letter};
use crate::experiment::{Experiment, Rays, cost};
use crate::judge::{self, OracleStats, Truth};
use crate::lower::{LowerError, Stages};
use crate::oracle::Oracle;
use crate::output::Output;
use crate::prepared::Prepared;
use crate::report::table::Style;
use crate::report::tables::{
    CameraReport, ChangeReport, FamilyReport, IncoherentReport, Preparation, Report, SamplingReport, SceneReport,
};
use crate::scene::camera::{Camera, View};
use crate::scene::file::Scene;
use crate::scene::model::Model;
use crate::scene::paper::{PaperScene, SCENES};
use crate::scene::sampling::Sampling;
use crate::scene::shapes::exchanged;
use crate::scene::trace::Acceptance;
use crate::settings::{Flags, Settings, SizeFlag};
use crate::stats::SCHEMA;

/// The command line of `tables`.
#[derive(Args, Clone, Debug)]
pub struct TablesArgs {
    /// The size of the pictures of Tables 1 and 2; those of the others are half as wide and high
    #[command(flatten)]
    pub size: SizeFlag,
    /// How often each method traces each scene for Tables 1 and 2, at least 1; for the others half as often
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000),
        help_heading = "Tracing")]
    pub repetitions: u32,
    /// Leave out the oracle, and with it what pixels are wrong; saves a part of the time
    #[arg(long, help_heading = "Tracing")]
    pub skip_oracle: bool,
    /// Print a document in Markdown that can be read by itself
    #[arg(long, help_heading = "Output")]
    pub markdown: bool,
    /// The common flags.
    #[command(flatten)]
    pub flags: Flags,
}

/// The size at which the paper measures.
const SIZE: [u32; 2] = [512, 512];

/// Measures the paper's four scenes, and prints tables.
///
/// # Errors
/// Flags that do not go together, too little memory, or an output that cannot be written.
pub fn run(args: &TablesArgs) -> Result<(), Failure> {
    let TablesArgs { size, repetitions, skip_oracle, markdown, flags } = args;
    if flags.method.is_some() || flags.by_the_letter || !flags.without.is_empty() {
        return Err(Failure::Usage {
            message: "`tables` compares all methods, with and without their parts".to_owned(),
            help: "leave --method, --by-the-letter and --without out; `render` traces a scene with one method"
                .to_owned(),
        });
    }
    let stdout = Path::new("-");
    let output = flags.output.as_deref().or((!flags.json && flags.stats.as_deref() != Some(stdout)).then_some(stdout));
    Outputs::new(output, &[], flags)?;
    let stats_outputs = StatsOutputs::create(flags)?;
    let mut out = output.map(Output::create).transpose()?;

    let begin = Instant::now();
    let size = size.size.unwrap_or(SIZE);
    let small = size.map(|side| side.div_ceil(2));
    let fewer = repetitions.div_ceil(2);
    let mut scenes = Vec::new();
    for paper in &SCENES {
        scenes.push(OnePaperScene::load(paper, [size, small], flags)?);
    }
    let common = scenes.first().map_or_else(|| Settings::of_flags(flags), |scene| scene.settings);
    let threads = common.threads.min(SCENES.len() as u32);
    if !skip_oracle {
        let rows = scenes.iter().flat_map(|scene| scene.pictures).map(|picture| u64::from(picture.scan_lines())).sum();
        let bar = progress(rows, "asking the oracle", flags.quiet);
        pool(common.threads)?.install(|| scenes.iter_mut().for_each(|scene| scene.ask(|| bar.inc(1))));
        bar.finish_and_clear();
    }
    let passes = SCENES.len() as u64 * passes(*repetitions, fewer);
    let bar = progress(passes, "measuring", flags.quiet);
    let step = || bar.inc(1);
    let measured: Result<Vec<_>, LowerError> = pool(threads)?
        .install(|| scenes.par_iter().with_max_len(1).map(|scene| scene.measure(*repetitions, fewer, &step)).collect());
    let scenes = measured?;
    bar.finish_and_clear();
    let report = Report {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        size,
        small,
        precision: common.precision,
        acceptance: common.acceptance,
        repetitions: *repetitions,
        fewer,
        threads,
        seconds: begin.elapsed().as_secs_f64(),
        scenes,
    };
    stats_outputs.finish(&report)?;
    if let Some(mut out) = out.take() {
        let text = report.to_text(if *markdown { Style::Markdown } else { Style::Text });
        out.write_all(text.as_bytes()).map_err(|reason| out.failed(reason))?;
        out.finish()?;
    }
    Ok(())
}

/// How often a method's pass ends on one scene.
fn passes(repetitions: u32, fewer: u32) -> u64 {
    let of = |family: Family| {
        let few = 4 * 2 + 2 * 2 + 2 * 2 + ladder(family).len() + 2 + 2 * changes(family).len() + 2;
        letter(family).len() as u64 * u64::from(1 + repetitions) + few as u64 * u64::from(1 + fewer)
    };
    Family::ALL.into_iter().map(of).sum()
}

/// These subjects, each on these rays.
fn on<'r>(subjects: &[Subject], rays: Rays<'r>) -> Vec<(Subject, Rays<'r>)> {
    subjects.iter().map(|subject| (subject.clone(), rays)).collect()
}

/// A scene of the paper, ready to be measured.
struct OnePaperScene<'p> {
    paper: &'p PaperScene,
    scene: Scene,
    settings: Settings,
    camera: Camera,
    /// Of Tables 1 and 2, and of the others.
    pictures: [View; 2],
    /// What the oracle says of them, if it was asked.
    truths: Option<[(Vec<Truth>, OracleStats); 2]>,
}

impl<'p> OnePaperScene<'p> {
    fn load(paper: &'p PaperScene, sizes: [[u32; 2]; 2], flags: &Flags) -> Result<Self, Failure> {
        let scene = paper.load()?;
        let settings = Settings {
            // What the paper measured; proofs and their fallback would be measured too.
            acceptance: flags.acceptance.unwrap_or(Acceptance::Paper),
            ..Settings::of_scene(flags, &scene.description.trace, &scene.source)?
        };
        let camera = paper.camera(&scene.description.camera);
        let pictures = sizes.map(|size| camera.view(size));
        Ok(OnePaperScene { paper, scene, settings, camera, pictures, truths: None })
    }

    fn ask(&mut self, step: impl Fn() + Sync) {
        let oracle = Oracle::new(&self.scene.model);
        self.truths = Some(self.pictures.map(|picture| judge::ask(&oracle, &picture, &step)));
    }

    /// Everything that is measured on the scene.
    fn measure(&self, repetitions: u32, fewer: u32, step: &(dyn Fn() + Sync)) -> Result<SceneReport, LowerError> {
        let OnePaperScene { paper, scene, settings, truths, .. } = self;
        let experiment = Experiment { model: &scene.model, settings: *settings, step };
        let prepared = Prepared::build(&scene.model, Stages::PATCHES, settings)?;
        let (surfaces, patches) = (prepared.surfaces(), prepared.patches());
        drop(prepared);
        let seconds = |stages: Stages| {
            let begin = Instant::now();
            Prepared::build(&scene.model, stages, settings).map(|_| begin.elapsed().as_secs_f64())
        };
        let preparation = Preparation {
            surfaces: seconds(Stages::NONE)?,
            trees: seconds(Stages { tree: true, ..Stages::PATCHES })?,
            grids: seconds(Stages { grids: true, ..Stages::PATCHES })?,
        };
        Ok(SceneReport {
            name: paper.name(),
            paper: paper.figures,
            surfaces,
            patches,
            preparation,
            oracle: truths.as_ref().map(|[(_, stats), _]| stats.clone()),
            numerical: self.family(&experiment, Family::Numerical, repetitions, fewer)?,
            clipping: self.family(&experiment, Family::Clipping, repetitions, fewer)?,
        })
    }

    fn family(
        &self,
        experiment: &Experiment<'_>,
        family: Family,
        repetitions: u32,
        fewer: u32,
    ) -> Result<FamilyReport, LowerError> {
        let [large, small] = &self.pictures;
        let truths = |k: usize| self.truths.as_ref().and_then(|both| both.get(k)).map(|(truths, _)| truths.as_slice());
        let of_letter = letter(family);
        let pair = &of_letter[..2];

        let of_letter = experiment.measure(&on(&of_letter, Rays::Picture(large)), repetitions, truths(0))?;

        let mut of_cameras = Vec::new();
        for (name, camera) in cameras(&self.camera).into_iter().skip(1) {
            let picture = camera.view(small.size);
            of_cameras.push(CameraReport {
                name,
                runs: experiment.measure(&on(pair, Rays::Picture(&picture)), fewer, None)?,
            });
        }

        let sampled = [Sampling::Uniform, Sampling::Jittered].map(|sampling| small.sampled(sampling));
        let tasks: Vec<_> = pair
            .iter()
            .flat_map(|subject| sampled.iter().map(|picture| (subject.clone(), Rays::Picture(picture))))
            .collect();
        let mut samplings = Vec::new();
        let mut runs = experiment.measure(&tasks, fewer, None)?.into_iter();
        while let (Some(uniform), Some(jittered)) = (runs.next(), runs.next()) {
            samplings.push(SamplingReport { uniform, jittered });
        }

        let of_picture = lines(small);
        let hits = experiment.outcomes(&pair[0], small)?;
        let light = self.scene.appearance.lights.first().and_then(|light| light.position).unwrap_or(small.eye);
        let mut incoherent = Vec::new();
        for (rays, lines) in
            [("primary, shuffled", shuffled(&of_picture)), ("shadow", shadows(&of_picture, &hits, light))]
        {
            incoherent.push(IncoherentReport {
                rays,
                runs: experiment.measure(&on(pair, Rays::Lines(&lines)), fewer, None)?,
            });
        }

        let of_ladder = experiment.measure(&on(&ladder(family), Rays::Picture(small)), fewer, truths(1))?;

        let mut all = on(pair, Rays::Picture(small));
        let changed = changes(family);
        all.extend(changed.iter().flat_map(|change| on(&change.subjects, Rays::Picture(small))));
        let runs = experiment.measure(&all, fewer, truths(1))?;
        let (before, after) = runs.split_at(pair.len());
        let of_changes =
            changed.iter().zip(after.chunks(pair.len())).map(|(change, after)| (change.name, after.to_vec()));
        // Which of a surface's parameters is u is the model's choice, and clipping begins with u.
        let exchanged = Model::numbered(self.scene.model.surfaces.iter().map(exchanged).collect());
        let exchanged = Experiment { model: &exchanged, ..*experiment };
        let exchanged = exchanged.measure(&on(pair, Rays::Picture(small)), fewer, truths(1))?;
        let of_changes = of_changes.chain([("u and v exchanged", exchanged)]);
        let of_changes = of_changes.map(|(name, after)| ChangeReport { name, before: before.to_vec(), after });

        let paper = match family {
            Family::Numerical => &self.paper.figures.numerical,
            Family::Clipping => &self.paper.figures.clipping,
        };
        let cost = match of_letter.as_slice() {
            [original, improved, ..] => cost::Model::of(original, improved, paper.gain),
            _ => return Err(LowerError::Internal("the original and the improved method are measured".to_owned())),
        };
        Ok(FamilyReport {
            letter: of_letter,
            cameras: of_cameras,
            samplings,
            incoherent,
            ladder: of_ladder,
            changes: of_changes.collect(),
            cost,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// The bar ends with the last pass.
    #[test]
    fn as_many_passes_as_are_said() {
        let flags = Flags { flatness: Some(0.02), ..Flags::default() };
        let scene = OnePaperScene::load(&SCENES[0], [[8, 6], [6, 4]], &flags).unwrap_or_else(|_| panic!("it is valid"));
        let steps = AtomicU64::new(0);
        let step = || {
            steps.fetch_add(1, Ordering::Relaxed);
        };
        assert_eq!(scene.measure(3, 2, &step).expect("there is memory").numerical.letter.len(), 3);
        assert_eq!(steps.load(Ordering::Relaxed), passes(3, 2));
    }
}
