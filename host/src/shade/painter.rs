//! From what rays meet to colours: surfaces and polygons under the scene's lights, their background, and mirrors.
//!
//! A mirror is followed once, so that rays have a depth of two, as in the paper's pictures. Mirrored rays are no part of a
//! scan line and of no method's statistics.

use super::Shader;
use crate::scanline::{Lane, Outcome, Tally};
use crate::scene::appearance::Appearance;
use crate::scene::rays::RayLine;

/// How far from the point that it leaves a mirrored ray begins, as a share of the point's distance from the eye: more than
/// rounding in 32 bits, less than can be seen.
const CLEAR: f64 = 1e-4;

/// A linear colour, red, green and blue; `None` where a ray was given up, which is neither a hit nor a miss.
pub type Colour = Option<[f64; 3]>;

/// What paints the rays from one eye.
#[derive(Clone, Debug)]
pub struct Painter<'s> {
    appearance: &'s Appearance,
    shader: Shader,
}

/// A point that a ray met.
#[derive(Clone, Copy, Debug)]
struct Met {
    point: [f64; 3],
    /// The distance along the ray, in units of its direction.
    t: f64,
    normal: Option<[f64; 3]>,
    material: usize,
}

/// What a ray sees.
enum Seen {
    Nothing,
    Point(Met),
    GaveUp,
}

impl<'s> Painter<'s> {
    /// The painter of rays from `eye`.
    pub fn new(eye: [f64; 3], appearance: &'s Appearance) -> Self {
        Painter { appearance, shader: Shader::new(eye, &appearance.lights) }
    }

    /// The colours of rays, one each, `outcomes` being what became of them on surfaces. Mirrored rays are traced by `lane`.
    pub fn paint(&self, lane: &mut dyn Lane, rays: &[RayLine], outcomes: &[Outcome]) -> Vec<Colour> {
        let mut mirrors = Vec::new();
        let mut mirrored = Vec::new();
        let mut colours = Vec::with_capacity(rays.len());
        for (ray, outcome) in rays.iter().zip(outcomes) {
            let seen = self.seen(ray, outcome);
            if let Seen::Point(met) = &seen {
                let share = self.appearance.materials.get(met.material).map_or(0.0, |material| material.reflect);
                if let Some(next) = (share > 0.0).then(|| reflected(ray, met)).flatten() {
                    mirrors.push((colours.len(), share));
                    mirrored.push(next);
                }
            }
            colours.push(self.colour(ray, &seen));
        }
        if mirrored.is_empty() {
            return colours;
        }
        let mut outcomes = Vec::with_capacity(mirrored.len());
        lane.trace(&mirrored, false, &mut outcomes, &mut Tally::default());
        for ((ray, outcome), (index, share)) in mirrored.iter().zip(&outcomes).zip(mirrors) {
            let picture = self.colour(ray, &self.seen(ray, outcome));
            colours[index] = colours[index]
                .zip(picture)
                .map(|(own, picture)| [0, 1, 2].map(|k| (1.0 - share) * own[k] + share * picture[k]));
        }
        colours
    }

    /// What a ray sees: the nearer of what it met on surfaces and on polygons.
    fn seen(&self, ray: &RayLine, outcome: &Outcome) -> Seen {
        let mut met = match outcome {
            Outcome::Hit(found) => {
                let material = self.appearance.surfaces.get(found.surface).copied().unwrap_or(0);
                Some(Met { point: [0.0; 3], t: found.t, normal: found.normal, material })
            }
            Outcome::Miss => None,
            Outcome::GaveUp { .. } | Outcome::Refused(_) | Outcome::Invalid => return Seen::GaveUp,
        };
        for (polygon, material) in &self.appearance.polygons {
            let before = met.map_or(ray.t_max, |met| met.t);
            if let Some(t) = polygon.intersect(ray.origin, ray.direction, ray.t_min, before) {
                met = Some(Met { point: [0.0; 3], t, normal: Some(polygon.normal()), material: *material });
            }
        }
        met.map_or(Seen::Nothing, |met| {
            let point = [0, 1, 2].map(|k| ray.origin[k] + met.t * ray.direction[k]);
            Seen::Point(Met { point, ..met })
        })
    }

    fn colour(&self, ray: &RayLine, seen: &Seen) -> Colour {
        match seen {
            Seen::Nothing => Some(self.appearance.background),
            Seen::GaveUp => None,
            Seen::Point(met) => {
                let material = self.appearance.materials.get(met.material).copied().unwrap_or_default();
                Some(self.shader.colour(ray.origin, met.point, met.normal, &material))
            }
        }
    }
}

/// The ray that a mirror at the point sends on; `None` where there is no normal.
fn reflected(ray: &RayLine, met: &Met) -> Option<RayLine> {
    let normal = met.normal?;
    let along: f64 = (0..3).map(|k| normal[k] * ray.direction[k]).sum();
    let direction = [0, 1, 2].map(|k| ray.direction[k] - 2.0 * along * normal[k]);
    // As long as the ray's direction, so that t is in the same units.
    Some(RayLine { origin: met.point, direction, t_min: CLEAR * met.t, t_max: f64::INFINITY, ..*ray })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scanline::Found;
    use crate::scene::appearance::{Light, Material};
    use crate::scene::polygon::Polygon;

    /// A lane that answers every ray alike.
    struct Answers(Outcome);

    impl Lane for Answers {
        fn trace(&mut self, rays: &[RayLine], _: bool, outcomes: &mut Vec<Outcome>, _: &mut Tally) {
            outcomes.extend(rays.iter().map(|_| self.0));
        }
    }

    const DOWN: RayLine = RayLine {
        origin: [0.0, 0.0, 4.0],
        direction: [0.0, 0.0, -2.0],
        t_min: 0.0,
        t_max: f64::INFINITY,
        scan_line: 0,
        valid: true,
    };

    const SKY: [f64; 3] = [0.0, 0.0, 1.0];

    /// A red floor at z = 0, which mirrors this share, under a blue sky.
    fn floor(reflect: f64) -> Appearance {
        let square = [[-1., -1., 0.], [1., -1., 0.], [1., 1., 0.], [-1., 1., 0.]];
        let flat = |colour| Material { colour, ambient: 1.0, diffuse: 0.0, highlight: 0.0, ..Material::default() };
        Appearance {
            lights: vec![Light::default()],
            materials: vec![flat([0.0, 1.0, 0.0]), Material { reflect, ..flat([1.0, 0.0, 0.0]) }],
            surfaces: vec![0],
            polygons: vec![(Polygon::new(square.to_vec()).expect("a polygon"), 1)],
            background: SKY,
        }
    }

    fn painted(appearance: &Appearance, met: Outcome, mirrored: Outcome) -> Colour {
        Painter::new(DOWN.origin, appearance).paint(&mut Answers(mirrored), &[DOWN], &[met])[0]
    }

    fn surface(t: f64) -> Outcome {
        Outcome::Hit(Found { t, u: 0.5, v: 0.5, surface: 0, normal: Some([0.0, 0.0, 1.0]), grazing: false })
    }

    #[test]
    fn the_nearer_of_surface_and_polygon_is_seen() {
        let scene = floor(0.0);
        assert_eq!(painted(&scene, Outcome::Miss, Outcome::Miss), Some([1.0, 0.0, 0.0]));
        assert_eq!(painted(&scene, surface(1.0), Outcome::Miss), Some([0.0, 1.0, 0.0]));
        assert_eq!(painted(&scene, surface(3.0), Outcome::Miss), Some([1.0, 0.0, 0.0]));
        let nothing = Appearance { polygons: Vec::new(), ..scene };
        assert_eq!(painted(&nothing, Outcome::Miss, Outcome::Miss), Some(SKY));
    }

    #[test]
    fn a_mirror_mixes_in_what_its_ray_sees_and_not_itself() {
        assert_eq!(painted(&floor(0.25), Outcome::Miss, Outcome::Miss), Some([0.75, 0.0, 0.25]));
        assert_eq!(painted(&floor(1.0), Outcome::Miss, surface(7.0)), Some([0.0, 1.0, 0.0]));
    }

    #[test]
    fn giving_up_is_no_colour_in_a_mirror_either() {
        let gave_up = Outcome::GaveUp { limit: "voxels", best: None };
        assert_eq!(painted(&floor(0.0), gave_up, Outcome::Miss), None);
        assert_eq!(painted(&floor(0.5), Outcome::Miss, gave_up), None);
    }

    #[test]
    fn mirrored_rays_leave_as_they_came() {
        let ray = RayLine { direction: [3.0, 0.0, -1.0], ..DOWN };
        let met = Met { point: [12.0, 0.0, 0.0], t: 4.0, normal: Some([0.0, 0.0, -1.0]), material: 0 };
        let next = reflected(&ray, &met).expect("there is a normal");
        assert_eq!((next.origin, next.direction), ([12.0, 0.0, 0.0], [3.0, 0.0, 1.0]));
        assert!(next.t_min > 0.0);
        assert!(reflected(&ray, &Met { normal: None, ..met }).is_none());
    }
}
