//! What does a walk through a surface's grid cost, at several densities, with and without the tests of the patches met?

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use patchray::grid::GridOptions;
use patchray::limits::{Limits, Work};
use patchray::planes::DepthRange;
use patchray::point::Plain;
use patchray::ray::Interval;
use patchray::sweep::sweep;
use patchray_host::lower::{Lowered, Preparation, Stages};
use std::hint::black_box;

fn benches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("grid_walk");
    for density in [1.0, 2.0, 3.0, 4.0, 8.0] {
        let preparation =
            Preparation { grid: GridOptions { density, ..GridOptions::default() }, ..Preparation::default() };
        let stages = Stages { patches: true, tree: false, grids: true };
        let lowered =
            Lowered::<Plain<f64>>::build(&common::teapot(), stages, &preparation).expect("the model is valid");
        let scene = lowered.scene();
        // Along the teapot, so that several surfaces are passed from end to end.
        let ray = scene.ray([-5.0, -0.3, 1.0], [1.0, 0.05, 0.1]).expect("the ray is valid");
        let (planes, range) = scene.frame().enter(&ray, &Interval::ahead()).expect("the ray meets the scene");
        let (patches, grids) = (lowered.patches(), lowered.grids());
        let limits = Limits::default();
        let each_grid = |visit: &mut dyn FnMut(usize, patchray::walk::Walk<'_, f64>)| {
            for surface in 0..scene.len() {
                let grid = grids.of_surface(surface).expect("the grid was built");
                if let Some((walk, _)) = grid.enter(black_box(&planes), &DepthRange { ..range }) {
                    visit(surface, walk);
                }
            }
        };
        group.bench_with_input(BenchmarkId::new("voxels", density), &density, |bencher, _| {
            bencher.iter(|| {
                let mut voxels = 0;
                each_grid(&mut |_, mut walk| {
                    while walk.advance().is_some() {
                        voxels += 1;
                    }
                });
                voxels
            });
        });
        group.bench_with_input(BenchmarkId::new("patches", density), &density, |bencher, _| {
            bencher.iter(|| {
                let mut met = 0;
                let mut work = Work::default();
                for surface in 0..scene.len() {
                    let grid = grids.of_surface(surface).expect("the grid was built");
                    let Some((walk, _)) = grid.enter(black_box(&planes), &range) else {
                        continue;
                    };
                    let patches = patches.of_surface(surface).expect("the patches were built");
                    let swept = sweep(walk, patches, &planes, &limits, &mut work, |_, _, _| {
                        met += 1;
                        Ok(f64::INFINITY)
                    });
                    swept.expect("the limits are far");
                }
                met
            });
        });
    }
    group.finish();
}

criterion_group!(group, benches);
criterion_main!(group);
