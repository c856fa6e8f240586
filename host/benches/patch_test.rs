//! What does one test of a ray against a patch's parallelepiped cost, over all patches of the teapot?

mod common;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use patchray::point::Plain;
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray_host::lower::{FromFile, Lowered, Preparation, Stages};
use std::hint::black_box;

fn test<P: FromFile>(criterion: &mut Criterion, precision: &str) {
    let stages = Stages { patches: true, tree: false, grids: false };
    let lowered = Lowered::<P>::build(&common::teapot(), stages, &Preparation::default()).expect("the model is valid");
    let number = |value: f64| P::Scalar::from_f64(value);
    let scene = lowered.scene();
    let ray = scene.ray([number(7.6), number(-9.3), number(7.6)], [number(-9.0), number(12.0), number(-8.0)]);
    let ray = ray.expect("the ray is valid");
    let (planes, _) = scene.frame().enter(&ray, &Interval::ahead()).expect("the ray meets the scene");
    let patches = lowered.patches();
    let mut group = criterion.benchmark_group("patch_test");
    group.throughput(Throughput::Elements(patches.all().len() as u64));
    group.bench_function(precision, |bencher| {
        bencher.iter(|| {
            patches.all().iter().filter(|patch| patch.bounds().crossing(black_box(&planes)).is_some()).count()
        });
    });
    group.finish();
}

fn benches(criterion: &mut Criterion) {
    test::<Plain<f32>>(criterion, "f32");
    test::<Plain<f64>>(criterion, "f64");
}

criterion_group!(group, benches);
criterion_main!(group);
