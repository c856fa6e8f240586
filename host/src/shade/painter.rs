//! From what rays meet to colours: surfaces and polygons under the scene's lights, their background, and mirrors.
//!
//! A mirror is followed once, so that rays have a depth of two, as in the paper's pictures. Mirrored rays are no part of a
//! scan line and of no method's statistics. Where no ray is followed any more, a metal mirrors the background: it has no other
//! light of its own, and in a world of even light that is what the ray would see.

use super::Shader;
use super::finish::{Finish, Mirror};
use super::spectrum::Basis;
use crate::scanline::{Lane, Outcome, Tally};
use crate::scene::appearance::{Appearance, Material};
use crate::scene::rays::RayLine;

/// How far from the point that it leaves a mirrored ray begins, as a share of the point's distance from the eye: more than
/// rounding in 32 bits, less than can be seen.
const CLEAR: f64 = 1e-4;

/// A linear colour, red, green and blue; `None` where a ray was given up, which is neither a hit nor a miss.
pub type Colour = Option<[f64; 3]>;

/// What paints the rays from one eye, by light in N parts.
#[derive(Clone, Debug)]
pub struct Painter<'s, B, const N: usize> {
    basis: B,
    appearance: &'s Appearance,
    shader: Shader<N>,
    /// The materials.
    finishes: Vec<Finish<N>>,
    /// That of what names no material that there is.
    fallback: Finish<N>,
    background: [f64; N],
}

/// The colours of rays, and what they took.
#[derive(Clone, Debug, PartialEq)]
pub struct Painted {
    /// A colour for each ray.
    pub colours: Vec<Colour>,
    /// The number of mirrored rays that were traced.
    pub mirrored: u64,
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

impl<'s, B: Basis<N>, const N: usize> Painter<'s, B, N> {
    /// The painter of rays from `eye`, whose light `basis` counts.
    pub fn new(basis: B, eye: [f64; 3], appearance: &'s Appearance) -> Self {
        Painter {
            basis,
            appearance,
            shader: Shader::new(eye, &appearance.lights, &basis),
            finishes: appearance.materials.iter().map(|material| Finish::new(material, &basis)).collect(),
            fallback: Finish::new(&Material::default(), &basis),
            background: basis.parts(appearance.background),
        }
    }

    /// The colours of rays, one each, `outcomes` being what became of them on surfaces. Mirrored rays are traced by `lane`.
    pub fn paint(&self, lane: &mut dyn Lane, rays: &[RayLine], outcomes: &[Outcome]) -> Painted {
        let mut mirrors = Vec::new();
        let mut mirrored = Vec::new();
        let mut lights = Vec::with_capacity(rays.len());
        for (ray, outcome) in rays.iter().zip(outcomes) {
            let seen = self.seen(ray, outcome);
            let next = match &seen {
                Seen::Point(met) => self.mirror(ray, met).zip(reflected(ray, met)),
                Seen::Nothing | Seen::GaveUp => None,
            };
            let Some((mirror, next)) = next else {
                lights.push(self.last(ray, &seen));
                continue;
            };
            mirrors.push((lights.len(), mirror));
            mirrored.push(next);
            lights.push(self.own(ray, &seen));
        }
        if !mirrored.is_empty() {
            let mut outcomes = Vec::with_capacity(mirrored.len());
            lane.trace(&mirrored, false, &mut outcomes, &mut Tally::default());
            for ((ray, outcome), (index, mirror)) in mirrored.iter().zip(&outcomes).zip(mirrors) {
                let picture = self.last(ray, &self.seen(ray, outcome));
                lights[index] = lights[index].zip(picture).map(|(own, picture)| mirror.with(own, picture));
            }
        }
        let colours = lights.into_iter().map(|light| light.map(|light| self.basis.display(light))).collect();
        Painted { colours, mirrored: mirrored.len() as u64 }
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

    fn finish(&self, met: &Met) -> &Finish<N> {
        self.finishes.get(met.material).unwrap_or(&self.fallback)
    }

    /// What the point mirrors of the ray; `None` if it is no mirror.
    fn mirror(&self, ray: &RayLine, met: &Met) -> Option<Mirror<N>> {
        // What has no normal is taken to face the ray.
        self.finish(met).mirror(met.normal.map_or(1.0, |normal| {
            let [along, square] = [normal, ray.direction].map(|v| (0..3).map(|k| v[k] * ray.direction[k]).sum::<f64>());
            along.abs() / square.sqrt()
        }))
    }

    /// The light that a ray brings without what is mirrored.
    fn own(&self, ray: &RayLine, seen: &Seen) -> Option<[f64; N]> {
        match seen {
            Seen::Nothing => Some(self.background),
            Seen::GaveUp => None,
            Seen::Point(met) => Some(self.shader.colour(ray.origin, met.point, met.normal, self.finish(met))),
        }
    }

    /// The light that a ray brings after which no other is followed.
    fn last(&self, ray: &RayLine, seen: &Seen) -> Option<[f64; N]> {
        let own = self.own(ray, seen)?;
        let metal = match seen {
            Seen::Point(met) if self.finish(met).metal.is_some() => self.mirror(ray, met),
            _ => None,
        };
        Some(metal.map_or(own, |mirror| mirror.with(own, self.background)))
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
    use super::super::spectrum::{Rgb, Sampled};
    use super::*;
    use crate::scanline::Found;
    use crate::scene::appearance::{Light, Metal};
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
        Painter::new(Rgb, DOWN.origin, appearance).paint(&mut Answers(mirrored), &[DOWN], &[met]).colours[0]
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

    #[test]
    fn mirrored_rays_are_counted() {
        let count = |reflect| {
            let scene = floor(reflect);
            let painter = Painter::new(Rgb, DOWN.origin, &scene);
            painter
                .paint(&mut Answers(Outcome::Miss), &[DOWN; 3], &[Outcome::Miss, surface(1.0), Outcome::Miss])
                .mirrored
        };
        assert_eq!((count(0.0), count(0.5)), (0, 2));
    }

    /// A floor of metal under an even sky, seen at an angle; and what a ray that it mirrors meets.
    fn metal(metal: Metal, reflect: f64, mirrored: Outcome) -> [f64; 3] {
        let mut scene = floor(reflect);
        scene.background = [1.0; 3];
        scene.lights.clear();
        for material in &mut scene.materials {
            *material = Material { metal: Some(metal), reflect, ..*material };
        }
        let ray = RayLine { origin: [-0.4, 0.0, 0.3], direction: [4.0, 0.0, -3.0], ..DOWN };
        let painter = Painter::new(Sampled::new(), ray.origin, &scene);
        painter.paint(&mut Answers(mirrored), &[ray], &[Outcome::Miss]).colours[0].expect("no ray is given up")
    }

    #[test]
    fn a_metal_mirrors_the_sky_at_the_rays_angle_and_what_is_lost_of_it() {
        for kind in Metal::ALL {
            let basis = Sampled::new();
            let shares = basis.indices(kind).expect("samples have wavelengths").map(|index| index.reflectance(0.6));
            let near = |found: [f64; 3], light: [f64; 9]| {
                let expected = basis.display(light);
                assert!((0..3).all(|k| (found[k] - expected[k]).abs() < 1e-8), "{kind:?} {found:?} {expected:?}");
            };
            near(metal(kind, 1.0, Outcome::Miss), shares);
            near(metal(kind, 0.5, Outcome::Miss), shares.map(|share| 0.5 * share));
            // What a ray that is not followed any more meets, of metal too, mirrors the sky in its turn.
            let upright = Outcome::Hit(Found {
                t: 1.0,
                u: 0.5,
                v: 0.5,
                surface: 0,
                normal: Some([1.0, 0.0, 0.0]),
                grazing: false,
            });
            let again = basis.indices(kind).expect("samples have wavelengths").map(|index| index.reflectance(0.8));
            near(metal(kind, 1.0, upright), std::array::from_fn(|k| shares[k] * again[k]));
        }
    }
}
