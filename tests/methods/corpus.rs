//! The models and rays that every method has to answer.

use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::shapes::{self, Random};
use patchray_host::scene::teapot;

/// A model with a name.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// What tables call it.
    pub(crate) name: &'static str,
    /// The surfaces.
    pub(crate) model: Model,
}

/// In which order rays come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rays {
    /// From anywhere to anywhere: no two neighbours have anything in common.
    Random,
    /// Scan lines of views from several sides.
    ScanLines,
}

/// The cases: bicubics, the rational quadrics and the torus, and the general degrees.
pub(crate) fn cases() -> Vec<Case> {
    let case = |name, model: Model| Case { name, model };
    let bumpy = |seed, degrees| shapes::single(shapes::bumpy(seed, degrees, [0.1, -0.2, 0.3], 2.0, 0.4));
    vec![
        case("teapot", teapot::model().expect("the built-in teapot is valid")),
        case("sphere", shapes::sphere([0.1, 0.2, -0.3], 1.0)),
        case("cylinder", shapes::cylinder([0.3, -0.1, 0.2], 0.7, 1.1)),
        case("torus", shapes::torus([-0.2, 0.1, 0.05], 1.0, 0.4, 4, 4)),
        case("flat disc", flat_disc()),
        case("flat bicubic", flat_bicubic()),
        case("bumpy 2 x 12", bumpy(1, [2, 12])),
        case("bumpy 5 x 5", bumpy(2, [5, 5])),
        case("bumpy 15 x 15", bumpy(3, [15, 15])),
    ]
}

/// A quarter of a disc in a plane across an axis: its box is as thin as its padding, and Newton's iteration, whose
/// tolerance is wider, still takes several steps in it.
fn flat_disc() -> Model {
    let w = 0.5_f64.sqrt();
    let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, w], [1.0, 1.0, w], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    let points = points.map(|[x, y, w]| [x, y, 0.7, w]).to_vec();
    shapes::single(ModelSurface { number: 0, degree_u: 2, degree_v: 1, rational: true, points, knots: None })
}

/// A square in a plane across an axis, with its inner points moved within the plane.
fn flat_bicubic() -> Model {
    let mut random = Random(9);
    let mut moved = |k: usize| k as f64 / 3.0 + if k.is_multiple_of(3) { 0.0 } else { random.within(-0.1, 0.1) };
    let points = (0..16).map(|k| [moved(k / 4), moved(k % 4), 0.3, 1.0]).collect();
    shapes::single(ModelSurface { number: 0, degree_u: 3, degree_v: 3, rational: false, points, knots: None })
}

impl Case {
    /// At least `count` rays; exact in `f32`, so that both precisions trace what the oracle judges.
    pub(crate) fn rays(&self, order: Rays, count: usize) -> Vec<RayLine> {
        let bounds = self.model.control_box().expect("the case has points");
        let size = bounds.diagonal();
        let centre: [f64; 3] = std::array::from_fn(|k| (bounds.min[k] + bounds.max[k]) / 2.0);
        let mut random = Random(0x1ce_b00d);
        match order {
            Rays::Random => (0..count)
                .map(|_| {
                    let from = outside(&mut random, centre, size);
                    let to: [f64; 3] = std::array::from_fn(|k| random.within(bounds.min[k], bounds.max[k]));
                    // Directions of any length, since t is in units of them.
                    let length = 2.0_f64.powf(random.within(-8.0, 8.0));
                    ray(from, std::array::from_fn(|k| (to[k] - from[k]) * length), 0)
                })
                .collect(),
            Rays::ScanLines => {
                const WIDTH: usize = 128;
                let mut rays = Vec::new();
                let mut line = 0;
                while rays.len() < count {
                    let eye = outside(&mut random, centre, size);
                    let forward: [f64; 3] = std::array::from_fn(|k| centre[k] - eye[k]);
                    let (right, up) = across(forward);
                    for y in 0..WIDTH / 4 {
                        line += 1;
                        for x in 0..WIDTH {
                            let at = |k: usize, n: usize| (k as f64 / n as f64 - 0.5) * 0.8 * size;
                            let (sx, sy) = (at(x, WIDTH), at(y, WIDTH / 4));
                            let direction = std::array::from_fn(|k| forward[k] + sx * right[k] + sy * up[k]);
                            rays.push(ray(eye, direction, line));
                        }
                    }
                }
                rays
            }
        }
    }
}

/// A point a diagonal and a half away from the centre.
fn outside(random: &mut Random, centre: [f64; 3], size: f64) -> [f64; 3] {
    loop {
        // Ends: a point of the cube lies in this shell of the ball with probability above 0.4.
        let p = random.point(1.0);
        let length = p.iter().map(|c| c * c).sum::<f64>().sqrt();
        if (0.3..=1.0).contains(&length) {
            return std::array::from_fn(|k| centre[k] + p[k] / length * 1.5 * size);
        }
    }
}

/// Two unit vectors across `forward` and each other.
fn across(forward: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let unit = |a: [f64; 3]| {
        let length = a.iter().map(|c| c * c).sum::<f64>().sqrt();
        a.map(|c| c / length)
    };
    let axis = if forward[2].abs() < forward[0].abs() { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let right = unit(cross(forward, axis));
    (right, unit(cross(right, forward)))
}

fn ray(origin: [f64; 3], direction: [f64; 3], scan_line: u64) -> RayLine {
    let exact = |v: [f64; 3]| v.map(|c| f64::from(c as f32));
    let (origin, direction) = (exact(origin), exact(direction));
    RayLine { origin, direction, t_min: 0.0, t_max: f64::INFINITY, scan_line, valid: true }
}
