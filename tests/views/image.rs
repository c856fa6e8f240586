//! The rays of an image, row by row, and what a method makes of them.

use crate::cameras::{direction, exact};
use crate::common::{Kind, Prepared};
use crate::rooms::{Answer, InView, LineRoom, Thread, ViewRoom};
use patchray::limits::Limits;
use patchray::line::Window;
use patchray::ray::{Interval, RayError};
use patchray::scalar::Scalar;
use patchray::view::Camera;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::shapes::Random;

/// One scan line: the part of the image that its rays are of, and the rays' places.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    /// The least and the largest y.
    pub(crate) y: [f64; 2],
    pub(crate) places: Vec<[f64; 2]>,
}

/// Rows of `width` rays, at least `count` rays in all: in the pixels' middles, or jittered in both directions.
pub(crate) fn rows(count: usize, jitter: bool, seed: u64) -> Vec<Row> {
    let width = ((count as f64 * 2.0).sqrt() as usize).max(4);
    let height = count.div_ceil(width);
    let mut random = Random(seed);
    let mut shift = || if jitter { random.within(-0.5, 0.5) } else { 0.0 };
    let at =
        |k: usize, n: usize, shift: f64| exact(((2.0 * (k as f64 + shift) + 1.0) / n as f64 - 1.0).clamp(-1.0, 1.0));
    let mut row = |j: usize| {
        let places: Vec<_> = (0..width).map(|i| [at(i, width, shift()), at(j, height, shift())]).collect();
        let [low, high] = [-0.5, 0.5].map(|shift| at(j, height, if jitter { shift } else { 0.0 }));
        Row { y: [low, high], places }
    };
    (0..height).map(&mut row).collect()
}

/// The rays of rows as the oracle takes them.
pub(crate) fn ray_lines(camera: &Camera<f64>, rows: &[Row]) -> Vec<RayLine> {
    let ray = |line: usize, place: [f64; 2]| RayLine {
        origin: camera.eye,
        direction: direction(camera, place),
        t_min: 0.0,
        t_max: f64::INFINITY,
        scan_line: line as u64,
        valid: true,
    };
    rows.iter().enumerate().flat_map(|(line, row)| row.places.iter().map(move |&place| ray(line, place))).collect()
}

/// What a ray came to: an answer, or a refusal.
pub(crate) type Seen<S> = Result<Answer<S>, RayError>;

/// All rays of an image, in the order of the rows, traced line by line from left to right.
pub(crate) fn trace<P: Kind>(
    prepared: &Prepared<P>,
    camera: &Camera<P::Scalar>,
    rows: &[Row],
    method: InView,
    limits: &Limits<P::Scalar>,
) -> Vec<Seen<P::Scalar>> {
    let whole = Interval::ahead();
    let mut room = ViewRoom::for_view(prepared, camera).expect("the camera is a good one");
    let view = room.build(prepared, camera).expect("what was asked for is enough");
    let mut thread = Thread::new(prepared.surfaces.len());
    let mut lines = [20, 64, 300, 700].map(|buckets| LineRoom::for_any(prepared, buckets));
    let mut answers = Vec::new();
    for (number, row) in rows.iter().enumerate() {
        let window = Window { x: [-1.0, 1.0], y: row.y };
        let window = Window { x: window.x.map(P::Scalar::from_f64), y: window.y.map(P::Scalar::from_f64) };
        let mut line = lines[number % 4].line(&view, window).expect("there is room for all");
        answers.extend(row.places.iter().map(|place| {
            let ray = view.ray(place.map(P::Scalar::from_f64), &whole)?;
            Ok(thread.trace(method, &view, &mut line, number as u32, &ray, limits))
        }));
    }
    answers
}
