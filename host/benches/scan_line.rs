//! What does a scan line cost, per method, precision and degree?

mod common;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use patchray::limits::Limits;
use patchray::point::{Plain, Weighted};
use patchray_host::lower::{FromFile, Lowered, Preparation, Stages};
use patchray_host::method::{Clipping, ClippingCoherent, Newton, NewtonCoherent, Views};
use patchray_host::scanline::{MethodTracer, Tally, Tracer};
use patchray_host::scene::model::Model;
use patchray_host::scene::rays::RayLine;

/// Rays of one scan line.
const RAYS: usize = 512;

/// A line across the middle of the model, from a fixed view.
fn line(model: &Model) -> Vec<RayLine> {
    let bounds = model.control_box().expect("the model has points");
    let middle: [f64; 3] = std::array::from_fn(|k| (bounds.min[k] + bounds.max[k]) / 2.0);
    let size = bounds.diagonal();
    let eye = [middle[0] + 0.6 * size, middle[1] - 0.8 * size, middle[2] + 0.7 * size];
    let across = [0.8 * size, 0.6 * size, 0.0];
    let ray = |k: usize| {
        let s = k as f64 / (RAYS - 1) as f64 - 0.5;
        let direction = std::array::from_fn(|k| middle[k] + across[k] * s - eye[k]);
        RayLine { origin: eye, direction, t_min: 0.0, t_max: f64::INFINITY, scan_line: 0, valid: true }
    };
    (0..RAYS).map(ray).collect()
}

fn trace(criterion: &mut Criterion, name: &str, tracer: &dyn Tracer, rays: &[RayLine]) {
    let mut group = criterion.benchmark_group("scan_line");
    group.throughput(Throughput::Elements(rays.len() as u64));
    let mut lane = tracer.lane();
    let mut outcomes = Vec::new();
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            outcomes.clear();
            lane.trace(rays, false, &mut outcomes, &mut Tally::default());
        });
    });
    group.finish();
}

fn all_methods<P: FromFile>(criterion: &mut Criterion, name: &str, model: &Model) {
    let lowered = Lowered::<P>::build(model, Stages::ALL, &Preparation::default()).expect("the model is valid");
    let (views, limits) = (Views::of(&lowered), Limits::default());
    let newton = MethodTracer::<Newton, _>::new(views, limits, None);
    let newton_coherent = MethodTracer::<NewtonCoherent, _>::new(views, limits, None);
    let clipping = MethodTracer::<Clipping, _>::new(views, limits, None);
    let clipping_coherent = MethodTracer::<ClippingCoherent, _>::new(views, limits, None);
    let tracers: [(&str, &dyn Tracer); 4] = [
        ("newton", &newton),
        ("newton-coherent", &newton_coherent),
        ("clipping", &clipping),
        ("clipping-coherent", &clipping_coherent),
    ];
    let rays = line(model);
    for (method, tracer) in tracers {
        trace(criterion, &format!("{name}/{method}"), tracer, &rays);
    }
}

fn benches(criterion: &mut Criterion) {
    all_methods::<Plain<f32>>(criterion, "teapot/f32", &common::teapot());
    all_methods::<Plain<f64>>(criterion, "teapot/f64", &common::teapot());
    all_methods::<Weighted<f32>>(criterion, "rational-2x2/f32", &common::sphere());
    all_methods::<Weighted<f64>>(criterion, "rational-2x2/f64", &common::sphere());
    all_methods::<Plain<f64>>(criterion, "5x5/f64", &common::bumpy5());
    all_methods::<Plain<f64>>(criterion, "15x15/f64", &common::bumpy15());
}

criterion_group!(group, benches);
criterion_main!(group);
