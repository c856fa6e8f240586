//! Each method against the oracle: every case of the corpus, from every camera, in both precisions.

use crate::adapters::Adapter;
use crate::agree::{By, one_by_one};
use crate::allowances::Allowed;
use crate::cameras::{Named, cameras, inside, scaled};
use crate::common::{Kind, Prepared, is_rational};
use crate::corpus::{Case, cases};
use crate::image::{Row, Seen, ray_lines, rows, trace};
use crate::judging::{rays_per_case, residual, truths};
use crate::rooms::InView;
use patchray::bernstein::Basis;
use patchray::limits::{Acceptance, Limits};
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::judge::{Agreement, Allowance, Truth, allowance};
use patchray_host::scanline::{Outcome, found};
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;
use rayon::prelude::*;

/// Rays per case, over all cameras, unless the environment says otherwise.
const RAYS: usize = 2_400;

/// The default.
const FLATNESS: f64 = 6.6e-4;

/// An image of a case, and what the oracle knows of its rays.
struct Judged {
    named: Named,
    rows: Vec<Row>,
    rays: Vec<RayLine>,
    truths: Vec<Truth>,
}

fn judged(case: &Case, cameras: Vec<Named>) -> Vec<Judged> {
    let each = rays_per_case(RAYS) / cameras.len();
    let image = |(k, named): (usize, Named)| {
        let rows = rows(each, k % 2 == 1, k as u64);
        let rays = ray_lines(&named.camera, &rows);
        let truths = truths(case, &rays);
        Judged { named, rows, rays, truths }
    };
    cameras.into_iter().enumerate().map(image).collect()
}

/// What became of the rays of one case, method and precision.
#[derive(Clone, Copy, Debug, Default)]
struct Report {
    agreement: Agreement,
    residual: f64,
    rays: usize,
    unjudged: usize,
    /// Answers in which a picture is wrong: another sheet, a hole, or a point where there is none.
    wrong_pixels: u64,
}

impl Report {
    fn and(mut self, other: Self) -> Self {
        let (a, b) = (&mut self.agreement, other.agreement);
        for (sum, more) in [
            (&mut a.right, b.right),
            (&mut a.wrong, b.wrong),
            (&mut a.missed, b.missed),
            (&mut a.phantom, b.phantom),
            (&mut a.unanswered, b.unanswered),
            (&mut a.undecided, b.undecided),
        ] {
            *sum += more;
        }
        // A NaN stays.
        self.residual = if other.residual <= self.residual { self.residual } else { other.residual };
        self.rays += other.rays;
        self.unjudged += other.unjudged;
        self.wrong_pixels += other.wrong_pixels;
        self
    }
}

pub(crate) fn outcome<P: Kind>(prepared: &Prepared<P>, seen: &Seen<P::Scalar>) -> Outcome {
    let hit = match seen {
        Ok(Ok(Some(hit))) => hit,
        Ok(Ok(None)) => return Outcome::Miss,
        Ok(Err(gave_up)) => return Outcome::GaveUp { limit: gave_up.limit.name(), best: None },
        Err(error) => return Outcome::Refused(*error),
    };
    Outcome::Hit(found(&prepared.scene(), &mut Basis::new(), hit))
}

/// The answers of a method to all images; `scale` is that of model and camera, which t does not feel. Rays by themselves are those
/// of scale 1.
fn report<P: Kind>(
    case: &Case,
    prepared: &Prepared<P>,
    images: &[Judged],
    scale: f64,
    method: By,
    precision: Precision,
    acceptance: Acceptance,
) -> Report {
    let limits = Limits { acceptance, ..Limits::default() };
    let diagonal = case.model.control_box().expect("the case has points").diagonal();
    let judged_as = match method {
        By::View(method) => method.judged_as(),
        By::Rays(method) => method,
    };
    let allowed = Allowed::of(&Adapter { method: judged_as, precision }, case);
    let (near, least_margin) = (allowance(precision), allowed.least_margin);
    // A point that is off no farther than residuals are is on the right sheet.
    let on_sheet = Allowance { across: near.across.max(allowed.residual), ..near };
    let of_image = |image: &Judged| {
        let answers = match method {
            By::View(method) => trace(prepared, &scaled(&image.named.camera, scale), &image.rows, method, &limits),
            By::Rays(method) => one_by_one(prepared, method, &image.rays, &limits),
        };
        assert_eq!(answers.len(), image.rays.len());
        let mut report = Report { rays: image.rays.len(), ..Report::default() };
        for ((ray, answer), truth) in image.rays.iter().zip(&answers).zip(&image.truths) {
            let outcome = outcome(prepared, answer);
            if truth.margin >= least_margin {
                let [mut agreement, mut sheets] = [Agreement::default(); 2];
                agreement.add(&outcome, truth, ray.direction, diagonal, &near);
                sheets.add(&outcome, truth, ray.direction, diagonal, &on_sheet);
                let wrong_pixels = sheets.wrong + sheets.missed + sheets.phantom;
                report = report.and(Report { agreement, wrong_pixels, ..Report::default() });
            } else {
                report.unjudged += 1;
            }
            if let Outcome::Hit(found) = &outcome {
                let off = residual(&case.model.surfaces[found.surface], ray, found) / diagonal;
                report = report.and(Report { residual: off, ..Report::default() });
            }
        }
        report
    };
    images.par_iter().map(of_image).reduce(Report::default, Report::and)
}

/// One case in one precision through all methods: what lies beyond the allowances.
fn beyond<P: Kind>(case: &Case, images: &[Judged], scale: f64, flatness: f64, precision: Precision) -> Vec<String> {
    let options = Subdivision { flatness: P::Scalar::from_f64(flatness), ..Subdivision::default() };
    let prepared = Prepared::<P>::new(&case.model, scale, &options);
    let mut failures = Vec::new();
    for acceptance in [Acceptance::Paper, Acceptance::Proved] {
        let mut wrong_pixels = [0; InView::ALL.len()];
        for method in InView::ALL {
            if acceptance == Acceptance::Proved && scale != 1.0 {
                continue;
            }
            let allowed = Allowed::of(&Adapter { method: method.judged_as(), precision }, case);
            let report = report(case, &prepared, images, scale, By::View(method), precision, acceptance);
            wrong_pixels[method as usize] = report.wrong_pixels;
            let Agreement { wrong, missed, phantom, unanswered, undecided, .. } = report.agreement;
            let line = format!(
                "{:<14} {precision:?} {acceptance:?} {:<18} at {scale:e}: rays {} wrong {wrong} missed {missed} phantom \
                 {phantom} unanswered {unanswered} undecided {undecided} unjudged {} residual {:.1e}",
                case.name,
                format!("{method:?}"),
                report.rays,
                report.unjudged,
                report.residual
            );
            println!("{line}");
            if !allowed.lost.allows(wrong + missed, report.rays)
                || phantom > 0
                || !allowed.unanswered.allows(unanswered, report.rays)
                || report.unjudged as f64 > allowed.unjudged * report.rays as f64
                || !(report.residual <= allowed.residual)
            {
                failures.push(line);
            }
        }
        if acceptance == Acceptance::Paper || scale != 1.0 {
            continue;
        }
        let of = |method| wrong_pixels[method as usize];
        // Where all is proved, nothing is wrong. In `f32` what is proved is known to the allowance only.
        if precision == Precision::F64 && of(InView::NewtonPredictedProving) > 0 {
            failures.push(format!("{}: {wrong_pixels:?} wrong pixels", case.name));
        }
        for predicted in [InView::NewtonPredicted, InView::ClippingPredicted] {
            let original = By::Rays(predicted.original());
            let wrong = report(case, &prepared, images, scale, original, precision, acceptance).wrong_pixels;
            if of(predicted) > wrong {
                let line = format!("{}: {precision:?}, {predicted:?}: {wrong_pixels:?} wrong pixels", case.name);
                failures.push(format!("{line}, {wrong} by {original:?}"));
            }
        }
    }
    failures
}

/// All cases; the models, and the cameras with them, at each of the scales.
fn suite(of: impl Fn(&[ModelSurface]) -> Vec<Named>, flatness: f64, scales: &[f64]) {
    let mut failures = Vec::new();
    for case in cases() {
        let images = judged(&case, of(&case.model.surfaces));
        let hits: usize = images.iter().flat_map(|image| &image.truths).filter(|truth| truth.closest.is_some()).count();
        let rays: usize = images.iter().map(|image| image.rays.len()).sum();
        println!("{}: {hits} of {rays} rays hit", case.name);
        assert!(hits * 10 > rays, "{}: only {hits} of {rays} rays hit anything", case.name);
        for &scale in scales {
            failures.extend(if is_rational(&case.model) {
                let of_f32 = beyond::<Weighted<f32>>(&case, &images, scale, flatness, Precision::F32);
                of_f32
                    .into_iter()
                    .chain(beyond::<Weighted<f64>>(&case, &images, scale, flatness, Precision::F64))
                    .collect::<Vec<_>>()
            } else {
                let of_f32 = beyond::<Plain<f32>>(&case, &images, scale, flatness, Precision::F32);
                of_f32
                    .into_iter()
                    .chain(beyond::<Plain<f64>>(&case, &images, scale, flatness, Precision::F64))
                    .collect()
            });
        }
    }
    assert!(failures.is_empty(), "beyond the allowances:\n{}", failures.join("\n"));
}

#[test]
fn every_method_from_every_camera() {
    suite(cameras, FLATNESS, &[1.0]);
}

#[test]
fn every_method_from_inside() {
    suite(inside, 0.005, &[1.0]);
}

/// Scenes in other units, by powers of ten: coordinates round, answers stay.
#[test]
fn every_method_in_any_unit() {
    let few = |surfaces: &[ModelSurface]| cameras(surfaces).into_iter().step_by(3).collect();
    suite(few, 0.005, &[1e-20, 1e20]);
}
