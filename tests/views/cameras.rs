//! Cameras around and in a model: what a view has to stand.

use crate::common::{add, cross, norm};
use patchray::scalar::Scalar;
use patchray::view::Camera;
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::shapes::Random;

/// A camera with a name. Its numbers are exact in `f32`, so that both precisions trace what the oracle judges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Named {
    pub(crate) name: &'static str,
    pub(crate) camera: Camera<f64>,
}

/// The same camera in a number type, its eye and vectors times `scale`.
pub(crate) fn scaled<S: Scalar>(camera: &Camera<f64>, scale: f64) -> Camera<S> {
    let by = |v: [f64; 3]| v.map(|c| S::from_f64(c * scale));
    Camera { eye: by(camera.eye), forward: by(camera.forward), right: by(camera.right), up: by(camera.up) }
}

/// The direction of the ray at (x, y).
pub(crate) fn direction(camera: &Camera<f64>, [x, y]: [f64; 2]) -> [f64; 3] {
    add(add(camera.forward, x, camera.right), y, camera.up)
}

/// The number that `f32` holds.
pub(crate) fn exact(c: f64) -> f64 {
    f64::from(c as f32)
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    v.map(|c| c / norm(v))
}

/// From `eye` to `to`: the image's edges lie at slopes of ±`half`.
pub(crate) fn looking(eye: [f64; 3], to: [f64; 3], half: f64) -> Camera<f64> {
    let forward = add(to, -1.0, eye);
    let away = if forward[2].abs() < 0.9 * norm(forward) { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let (right, length) = (unit(cross(forward, away)), norm(forward));
    let up = unit(cross(right, forward));
    let along = |v: [f64; 3]| v.map(|c| exact(c * half * length));
    Camera { eye: eye.map(exact), forward: forward.map(exact), right: along(right), up: along(up) }
}

/// The least and the largest coordinates of a model, its middle, and its diagonal.
fn extent(surfaces: &[ModelSurface]) -> ([[f64; 3]; 2], [f64; 3], f64) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in surfaces.iter().flat_map(|surface| &surface.points) {
        for k in 0..3 {
            (low[k], high[k]) = (low[k].min(point[k]), high[k].max(point[k]));
        }
    }
    ([low, high], core::array::from_fn(|k| (low[k] + high[k]) / 2.0), norm(add(high, -1.0, low)))
}

/// Cameras in a model: part of it lies behind the eye, part beside it.
pub(crate) fn inside(surfaces: &[ModelSurface]) -> Vec<Named> {
    let (_, centre, size) = extent(surfaces);
    let mut random = Random(0x1_de);
    let mut camera = |name, half| {
        let eye = add(centre, 0.1 * size, random.point(1.0));
        Named { name, camera: looking(eye, add(eye, 1.0, random.point(size)), half) }
    };
    vec![camera("inside", 0.9), camera("inside, a narrow view", 0.1), camera("inside once more", 0.7)]
}

/// Cameras around a model of these surfaces.
pub(crate) fn cameras(surfaces: &[ModelSurface]) -> Vec<Named> {
    let ([low, high], centre, size) = extent(surfaces);
    let at = |from: [f64; 3], distance: f64| add(centre, distance * size, unit(from));
    let mut random = Random(0xca3e);
    // The frame's unit: the least power of two above all coordinates. An eye up to eight of them away is near enough.
    let frame = low.iter().chain(&high).fold(0.0, |most: f64, c| most.max(c.abs())).log2().floor().exp2() * 2.0;
    let front = looking(at([1.0, -2.0, 1.2], 1.5), centre, 0.3);
    let below = looking(at([-1.0, -0.4, -1.1], 1.4), centre, 0.35);
    let skewed = Camera {
        right: add(below.right, 0.25, below.forward).map(exact),
        up: add(add(below.up, 0.4, below.right), -0.2, below.forward).map(exact),
        ..below
    };
    // Left-handed, and the three vectors of unlike lengths: all t and all x and y with them.
    let mirrored = Camera {
        forward: front.forward.map(|c| c * 1024.0),
        right: front.right.map(|c| -c * 1024.0),
        up: front.up.map(|c| c * 900.0).map(exact),
        ..front
    };
    let mut far_eye = [0.3, -7.99, 2.0].map(|c| c * frame);
    far_eye[0] += centre[0];
    let named = |name, camera| Named { name, camera };
    vec![
        named("from the front", front),
        named("skewed", skewed),
        named("mirrored", mirrored),
        named("near", looking(at([0.5, 1.0, 0.7], 0.6), centre, 0.8)),
        named("grazing", looking(add(at([1.0, 0.3, 0.0], 0.9), 0.01 * size, [0.0, 0.0, 1.0]), centre, 0.4)),
        named("far", looking(far_eye, centre, 0.5 * size / norm(add(far_eye, -1.0, centre)))),
        named("through a telescope", looking(at([-0.7, 1.0, 0.9], 2.0), add(centre, 0.1, random.point(size)), 0.01)),
    ]
}
