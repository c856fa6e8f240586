//! The rays of the experiment: five cameras, and rays that are not coherent.

use crate::scanline::{Outcome, row};
use crate::scene::camera::{Camera, View};
use crate::scene::rays::RayLine;
use crate::scene::shapes::Random;

/// The camera that a scene was fitted by, and four by one rule for all scenes, with their names: the eye is turned about the point
/// that it looks at.
pub fn cameras(fitted: &Camera) -> [(&'static str, Camera); 5] {
    [
        ("fitted", *fitted),
        ("20° left", fitted.turned(-20.0, 0.0)),
        ("20° right", fitted.turned(20.0, 0.0)),
        ("10° up", fitted.turned(0.0, 10.0)),
        ("10° down", fitted.turned(0.0, -10.0)),
    ]
}

/// The rays of a picture, in its scan lines.
pub fn lines(picture: &View) -> Vec<Vec<RayLine>> {
    (0..picture.scan_lines()).map(|line| row(picture, line)).collect()
}

/// The rays in random order, in lines as long as before: always the same order.
pub fn shuffled(lines: &[Vec<RayLine>]) -> Vec<Vec<RayLine>> {
    let mut rays: Vec<RayLine> = lines.concat();
    let mut random = Random(1);
    for last in (1..rays.len()).rev() {
        rays.swap(last, (random.bits() % (last as u64 + 1)) as usize);
    }
    rays.chunks(lines.first().map_or(1, |line| line.len().max(1))).map(<[RayLine]>::to_vec).collect()
}

/// For each ray that hit, a ray from there to a light, in the same scan line; `outcomes` are those of the rays.
pub fn shadows(lines: &[Vec<RayLine>], outcomes: &[Outcome], light: [f64; 3]) -> Vec<Vec<RayLine>> {
    let mut outcomes = outcomes.iter();
    let shadow = |(ray, outcome): (&RayLine, &Outcome)| {
        let Outcome::Hit(found) = outcome else { return None };
        let origin = [0, 1, 2].map(|k| ray.origin[k] + found.t * ray.direction[k]);
        let direction = [0, 1, 2].map(|k| light[k] - origin[k]);
        Some(RayLine { origin, direction, t_min: CLEAR, t_max: 1.0, ..*ray })
    };
    lines.iter().map(|line| line.iter().zip(outcomes.by_ref()).filter_map(shadow).collect()).collect()
}

/// Where on its way to the light a shadow ray begins, so that it does not meet the point that it leaves.
const CLEAR: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::teapot::common_scene;

    #[test]
    fn shuffling_loses_no_ray() {
        let picture = common_scene().expect("the fixture is valid").description.camera.view([7, 5]);
        let lines = lines(&picture);
        let other = shuffled(&lines);
        assert!(other.iter().all(|line| line.len() == 7) && other != lines);
        let sorted = |lines: &[Vec<RayLine>]| {
            let mut keys: Vec<_> = lines.iter().flatten().map(|ray| ray.direction.map(f64::to_bits)).collect();
            keys.sort_unstable();
            keys
        };
        assert_eq!(sorted(&lines), sorted(&other));
    }
}
