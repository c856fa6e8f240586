//! What does one clip step cost, a clip and the restriction to what it leaves, by degree?

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use patchray::bernstein::{Degrees, Direction, Tuple};
use patchray::casteljau::restrict;
use patchray::clip::{Clip, Noise, clip};
use patchray::parameter::{Number, Parameter};
use std::hint::black_box;

/// A gently bent sheet over the unit square, seen from where (0.4, 0.6) lies on the ray.
fn sheet(degree: usize) -> Vec<Tuple<f64, 2>> {
    let share = |k: usize| k as f64 / degree as f64;
    let point = |i: usize, j: usize| {
        let (u, v) = (share(i), share(j));
        Tuple([u - 0.4 + 0.05 * (u - v) * v, v - 0.6 + 0.05 * u * (1.0 - u)])
    };
    (0..=degree).flat_map(|i| (0..=degree).map(move |j| point(i, j))).collect()
}

fn benches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("clip_step");
    let noise = Noise { error: 1e-15, tolerance: 1e-12 };
    for degree in 1..=15 {
        let degrees = Degrees::new(degree, degree).expect("within the bounds");
        let net = sheet(degree);
        group.bench_function(BenchmarkId::from_parameter(format!("{degree} x {degree}")), |bencher| {
            let mut part = net.clone();
            bencher.iter(|| {
                part.copy_from_slice(black_box(&net));
                let Clip::Part(kept) = clip(degrees, &part, Direction::U, &noise) else {
                    panic!("the sheet meets the ray");
                };
                restrict(degrees, &mut part, Direction::U, kept.map(Number::new));
                part[0]
            });
        });
    }
    group.finish();
}

criterion_group!(group, benches);
criterion_main!(group);
