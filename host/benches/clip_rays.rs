//! What does a ray of Bézier clipping cost, in the straight-forward case and in the bisection case, and at which threshold
//! is it least?
//!
//! The rays are pixels of the common view, told apart by whether any region was bisected for them at the paper's threshold.

mod common;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use patchray::limits::{Limits, Work};
use patchray::method::{ClipScratch, clipping};
use patchray::point::Plain;
use patchray::ray::{Interval, Ray};
use patchray::scalar::Scalar;
use patchray::scene::Scene;
use patchray_host::lower::{FromFile, Lowered, NET, ORDER, Preparation, Stages};
use patchray_host::method::PENDING;
use patchray_host::scanline::row;
use patchray_host::scene::teapot::common_scene;
use patchray_host::scene::trace::Method;
use std::hint::black_box;

/// Rays of each case: few enough for their own numbers to stay in cache.
const RAYS: usize = 256;

/// Every so manieth pixel in both directions is looked at; a prime number, so that rows and columns share no pattern.
const STRIDE: usize = 5;

/// Thresholds, in per cent.
const THRESHOLDS: [u32; 9] = [5, 10, 15, 20, 25, 30, 40, 50, 60];

type Room<P> = ClipScratch<P, ORDER, NET, PENDING>;

/// Rays of the common view that clipping takes up, by case: straight-forward and bisection.
fn cases<P: FromFile>(scene: &Scene<'_, P>) -> [(&'static str, Vec<Ray<P::Scalar>>); 2] {
    let view = common_scene().expect("the built-in scene is valid").description.camera.view([512, 512]);
    let mut cases = [Vec::new(), Vec::new()];
    let mut scratch = Room::<P>::new();
    for py in (0..view.size[1]).step_by(STRIDE) {
        for pixel in row(&view, py).into_iter().step_by(STRIDE) {
            let [origin, direction] = [pixel.origin, pixel.direction].map(|v| v.map(P::Scalar::from_f64));
            let ray = scene.ray(origin, direction).expect("the view is of the scene's size");
            let mut work = Work::default();
            let (ahead, limits) = (Interval::ahead(), Limits::default());
            clipping::closest(scene, &ray, &ahead, &limits, &mut scratch.view(), &mut work)
                .expect("the limits are far");
            if work.clip_steps > 0 {
                cases[usize::from(work.bisection_cases > 0)].push(ray);
            }
        }
    }
    let [straight, bisection] = cases.map(|rays| {
        let step = (rays.len() / RAYS).max(1);
        rays.into_iter().step_by(step).take(RAYS).collect::<Vec<_>>()
    });
    assert!(straight.len() == RAYS && bisection.len() == RAYS, "the view has too few rays of a case");
    [("straight-forward", straight), ("bisection", bisection)]
}

/// The closest hits of `rays`; how many there are.
fn trace<P: FromFile>(
    scene: &Scene<'_, P>,
    rays: &[Ray<P::Scalar>],
    limits: &Limits<P::Scalar>,
    scratch: &mut Room<P>,
) -> usize {
    let (ahead, mut work) = (Interval::ahead(), Work::default());
    let mut is_hit = |ray| {
        let answer = clipping::closest(scene, black_box(ray), &ahead, limits, &mut scratch.view(), &mut work);
        matches!(answer, Ok(Some(_)))
    };
    rays.iter().filter(|&ray| is_hit(ray)).count()
}

fn precision<P: FromFile>(criterion: &mut Criterion, name: &str, thresholds: &[u32]) {
    let lowered = Lowered::<P>::build(&common::teapot(), Stages::of(Method::Clipping), &Preparation::default())
        .expect("the model is valid");
    let scene = lowered.scene();
    let mut scratch = Room::<P>::new();
    for (case, rays) in cases(&scene) {
        let mut group = criterion.benchmark_group("clip_rays");
        group.throughput(Throughput::Elements(rays.len() as u64));
        group.bench_function(format!("{case}/{name}"), |bencher| {
            bencher.iter(|| trace(&scene, &rays, &Limits::default(), &mut scratch));
        });
        group.finish();
        let mut group = criterion.benchmark_group(format!("clip_threshold/{case}/{name}"));
        group.throughput(Throughput::Elements(rays.len() as u64));
        for &percent in thresholds {
            let clip_threshold = P::Scalar::from_f64(f64::from(percent) / 100.0);
            let limits = Limits { clip_threshold, ..Limits::default() };
            group.bench_with_input(BenchmarkId::from_parameter(percent), &limits, |bencher, limits| {
                bencher.iter(|| trace(&scene, &rays, limits, &mut scratch));
            });
        }
        group.finish();
    }
}

fn benches(criterion: &mut Criterion) {
    precision::<Plain<f64>>(criterion, "f64", &THRESHOLDS);
    precision::<Plain<f32>>(criterion, "f32", &[]);
}

criterion_group!(group, benches);
criterion_main!(group);
