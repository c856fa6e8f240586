//! A ray of a view and the same ray traced by itself meet the same point; and units change nothing.

use crate::cameras::{Named, cameras, inside, scaled};
use crate::common::{Kind, Prepared, is_rational};
use crate::compare::Judge;
use crate::corpus::{Case, cases};
use crate::image::{Seen, ray_lines, rows, trace};
use crate::judging::rays_per_case;
use crate::rooms::InView;
use patchray::limits::{Limits, Work};
use patchray::method::{ClipScratch, Remembered, Scratch, clipping, clipping_coherent, newton, newton_coherent};
use patchray::point::{Plain, Weighted};
use patchray::ray::{Hit, Interval};
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::{Method, Precision};
use rayon::prelude::*;

/// Rays per case and camera, unless the environment says otherwise.
const RAYS: usize = 250;

/// A method for the rays of a view, or one that traces each by itself.
#[derive(Clone, Copy, Debug)]
pub(crate) enum By {
    View(InView),
    Rays(Method),
}

/// Each ray by itself: by tree, by grids, or by the scene's grid alone.
pub(crate) fn one_by_one<P: Kind>(
    prepared: &Prepared<P>,
    method: Method,
    rays: &[RayLine],
    limits: &Limits<P::Scalar>,
) -> Vec<Seen<P::Scalar>> {
    let (scene, patches, tree, grids) = (prepared.scene(), prepared.patches(), prepared.tree(), prepared.grids());
    let (mut scratch, mut clips) = (Scratch::<P, 16, 256>::new(), ClipScratch::<P, 16, 256, 64>::new());
    let mut memory = vec![Remembered::EMPTY; prepared.surfaces.len()];
    let (all, mut work) = (Interval::ahead(), Work::default());
    let trace = |ray: &RayLine| {
        let line = ray.scan_line as u32;
        let ray = scene.ray(ray.origin.map(P::Scalar::from_f64), ray.direction.map(P::Scalar::from_f64))?;
        let (ray, memory, work) = (&ray, &mut memory, &mut work);
        let (view, room) = (&mut scratch.view(), &mut clips.view());
        Ok(match method {
            Method::Newton => newton::closest(&scene, &patches, &tree, ray, &all, limits, view, work),
            Method::NewtonCoherent => {
                newton_coherent::closest(&scene, &patches, &grids, memory, line, ray, &all, limits, view, work)
            }
            Method::Clipping => clipping::closest(&scene, ray, &all, limits, room, work),
            Method::NewtonPredicted | Method::ClippingPredicted => unreachable!("judged as what they improve"),
            Method::ClippingCoherent => {
                clipping_coherent::closest(&scene, &patches, &grids, memory, line, ray, &all, limits, room, work)
            }
        })
    };
    rays.iter().map(trace).collect()
}

fn agree<P: Kind>(case: &Case, precision: Precision) -> Vec<String> {
    let options = Subdivision { flatness: P::Scalar::from_f64(0.003), ..Subdivision::default() };
    let prepared = Prepared::<P>::new(&case.model, 1.0, &options);
    let judge = Judge::new(case, precision);
    let surfaces = &case.model.surfaces;
    let all: Vec<Named> = cameras(surfaces).into_iter().chain(inside(surfaces)).collect();
    let each = |named: &Named| {
        let rows = rows(rays_per_case(RAYS), false, 0);
        let rays = ray_lines(&named.camera, &rows);
        let mut failures = Vec::new();
        for method in InView::ALL {
            let alone = one_by_one(&prepared, method.judged_as(), &rays, &Limits::default());
            let in_view = trace(&prepared, &scaled(&named.camera, 1.0), &rows, method, &Limits::default());
            for ((ray, one), other) in rays.iter().zip(&alone).zip(&in_view) {
                if judge.differ(&prepared, method, ray, [one, other]) {
                    let place = format!("{} {} {method:?} {precision:?}", case.name, named.name);
                    failures.push(format!("{place} {ray:?}: {one:?} by itself, {other:?} in a view"));
                }
            }
        }
        failures
    };
    all.par_iter().flat_map_iter(each).collect()
}

#[test]
fn a_ray_of_a_view_meets_what_it_meets_by_itself() {
    let mut failures = Vec::new();
    for case in cases() {
        if is_rational(&case.model) {
            failures.extend(agree::<Weighted<f32>>(&case, Precision::F32));
            failures.extend(agree::<Weighted<f64>>(&case, Precision::F64));
        } else {
            failures.extend(agree::<Plain<f32>>(&case, Precision::F32));
            failures.extend(agree::<Plain<f64>>(&case, Precision::F64));
        }
    }
    assert!(failures.is_empty(), "{} differ:\n{}", failures.len(), failures.join("\n"));
}

/// In the frame a scene of another unit is the same scene, if the units are a power of two apart; and so are a camera's vectors.
#[test]
fn powers_of_two_change_no_bit() {
    fn check<P: Kind>(case: &Case, exponents: [i32; 2]) {
        let options = Subdivision { flatness: P::Scalar::from_f64(0.005), ..Subdivision::default() };
        let prepare = |scale| Prepared::<P>::new(&case.model, scale, &options);
        let limits = Limits::default();
        let prepared = prepare(1.0);
        for named in cameras(&case.model.surfaces).into_iter().take(4) {
            let camera = scaled::<P::Scalar>(&named.camera, 1.0);
            let rows = rows(200, true, 5);
            for method in InView::ALL {
                let here = trace(&prepared, &camera, &rows, method, &limits);
                assert!(here.iter().any(|seen| matches!(seen, Ok(Ok(Some(_))))));
                for exponent in exponents {
                    let scale = f64::from(exponent).exp2();
                    let there = trace(&prepare(scale), &scaled(&named.camera, scale), &rows, method, &limits);
                    assert_eq!(here, there, "{} {} {method:?} times {scale:e}", case.name, named.name);
                    // The three vectors alone: all t are divided.
                    let by = |v: [P::Scalar; 3]| v.map(|c| c.times_power_of_two(exponent / 2));
                    let longer = patchray::view::Camera {
                        forward: by(camera.forward),
                        right: by(camera.right),
                        up: by(camera.up),
                        ..camera
                    };
                    let mut there = trace(&prepared, &longer, &rows, method, &limits);
                    for seen in &mut there {
                        if let Ok(Ok(Some(Hit { t, .. }))) = seen {
                            *t = t.times_power_of_two(exponent / 2);
                        }
                    }
                    assert_eq!(here, there, "{} {} {method:?} times 2^{}", case.name, named.name, exponent / 2);
                }
            }
        }
    }
    for case in cases().iter().filter(|case| ["teapot", "bumpy 5 x 5"].contains(&case.name)) {
        check::<Plain<f32>>(case, [-90, 80]);
        check::<Plain<f64>>(case, [-900, 800]);
    }
    for case in cases().iter().filter(|case| case.name == "sphere") {
        check::<Weighted<f32>>(case, [-40, 40]);
        check::<Weighted<f64>>(case, [-400, 400]);
    }
}
