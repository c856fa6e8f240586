use super::*;
use rayon::prelude::*;

/// The ray through a pixel of the common view, 512 x 512.
fn common_ray(px: usize, py: usize) -> ([f64; 3], [f64; 3]) {
    let sx = (2.0 * px as f64 - 511.0) / 512.0;
    let sy = (511.0 - 2.0 * py as f64) / 512.0;
    let axes = [[-9.0, 12.0, -8.0], [68.0, 51.0, 0.0], [-24.0, 32.0, 75.0]];
    let direction = [0, 1, 2].map(|k| 24.75 * axes[0][k] + sx * axes[1][k] + sy * axes[2][k]);
    ([7.6171875, -9.3203125, 7.59375], direction)
}

#[test]
fn the_common_view_has_its_known_counts() {
    let oracle = Oracle::new(&crate::scene::teapot::model().expect("the fixture is valid"));
    let start = std::time::Instant::now();
    let verdicts: Vec<Verdict> = (0..512 * 512usize)
        .into_par_iter()
        .map(|k| {
            let (origin, direction) = common_ray(k % 512, k / 512);
            oracle.trace(origin, direction, 0.0, f64::INFINITY)
        })
        .collect();
    let seconds = start.elapsed().as_secs_f64();
    let hits = verdicts.iter().filter(|v| !v.roots.is_empty()).count();
    let roots: usize = verdicts.iter().map(|v| v.roots.len()).sum();
    let unresolved: usize = verdicts.iter().map(|v| v.unresolved).sum();
    let mut margins: Vec<f64> = verdicts.iter().map(|v| v.margin).collect();
    margins.sort_by(f64::total_cmp);
    let quantiles: Vec<f64> = [0, 1, 10, 100, 1000, 10000, 100000, 200000].iter().map(|&k| margins[k]).collect();
    println!("{hits} hits, {roots} roots, {unresolved} unresolved, {seconds:.2} s; margins {quantiles:?}");
    assert_eq!((hits, roots, unresolved), (109_540, 237_594, 0));
}
