//! What does one Newton solve cost, from the start that a patch gives, per degree and precision?

mod common;

use criterion::{Criterion, criterion_group, criterion_main};
use patchray::limits::{Limits, Work};
use patchray::method::Scratch;
use patchray::newton::Solver;
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray_host::lower::{FromFile, Lowered, NET, ORDER, Preparation, Stages};
use patchray_host::scene::model::Model;
use std::hint::black_box;

fn solve<P: FromFile>(criterion: &mut Criterion, name: &str, model: &Model) {
    let stages = Stages { patches: true, tree: false, grids: false };
    let lowered = Lowered::<P>::build(model, stages, &Preparation::default()).expect("the model is valid");
    let scene = lowered.scene();
    let patches = lowered.patches();
    let number = |value: f64| P::Scalar::from_f64(value);
    // Through the middle of the first surface, from outside, not quite along an axis.
    let surface = scene.surface(0).expect("there is a surface");
    let mut scratch = Scratch::<P, ORDER, NET>::new();
    let mut view = scratch.view();
    let target =
        surface.net.position(number(0.55), number(0.45), &mut view.basis).expect("the scratch is large enough");
    let back = P::Scalar::ONE.times_power_of_two(-scene.frame().exponent());
    let direction = [number(0.3), number(-0.2), number(-1.0)];
    let origin = std::array::from_fn(|k| target[k] * back - direction[k] * number(4.0));
    let ray = scene.ray(origin, direction).expect("the ray is valid");
    let (planes, _) = scene.frame().enter(&ray, &Interval::ahead()).expect("the ray meets the scene");
    let owner =
        patches.of_surface(0).and_then(|all| all.iter().find(|patch| patch.domain().holds(number(0.55), number(0.45))));
    let patch = owner.expect("a patch holds the point");
    let crossing = patch.bounds().crossing(&planes).expect("the ray meets the patch");
    let start = patch.parallelogram(&crossing).expect("the patch is not edge on");
    let limits = Limits::default();
    let mut work = Work::default();
    criterion.bench_function(&format!("newton_solve/{name}"), |bencher| {
        bencher.iter(|| {
            let mut solver = Solver::new(&surface, &planes, &limits, &mut *view.flat, &mut view.basis);
            work = Work::default();
            solver.solve(black_box(start), &mut work)
        });
    });
}

fn benches(criterion: &mut Criterion) {
    solve::<Plain<f32>>(criterion, "teapot/f32", &common::teapot());
    solve::<Plain<f64>>(criterion, "teapot/f64", &common::teapot());
    solve::<Weighted<f32>>(criterion, "rational-2x2/f32", &common::sphere());
    solve::<Weighted<f64>>(criterion, "rational-2x2/f64", &common::sphere());
    solve::<Plain<f64>>(criterion, "5x5/f64", &common::bumpy5());
    solve::<Plain<f64>>(criterion, "15x15/f64", &common::bumpy15());
}

criterion_group!(group, benches);
criterion_main!(group);
