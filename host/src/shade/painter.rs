//! From what rays meet to colours: surfaces and polygons under the scene's lights, their background, and mirrors.
//!
//! A mirror is followed once, so that rays have a depth of two, as in the paper's pictures. Mirrored rays are no part of a
//! scan line and of no method's statistics. Where no ray is followed any more, a metal mirrors the background: it has no other
//! light of its own, and in a world of even light that is what the ray would see.

use super::Shader;
use super::finish::{Finish, Mirror};
use super::shadows::{Count, Shadows, Visibility};
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
    shadows: &'s Shadows,
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
    /// The rays that mirrors sent on.
    pub mirrored: Count,
    /// The rays to lights.
    pub shadow: Count,
}

/// What traces the rays that painting asks for.
pub struct Lanes<'l> {
    /// Those that mirrors send on.
    pub mirrored: &'l mut dyn Lane,
    /// Those to lights, of any hits; may be left out where no light's shadows are found by rays.
    pub shadow: Option<&'l mut dyn Lane>,
}

/// A point that a ray met.
#[derive(Clone, Copy, Debug)]
struct Met {
    point: [f64; 3],
    /// The distance along the ray, in units of its direction.
    t: f64,
    /// `None` where none can be shown.
    normal: Option<[f64; 3]>,
    material: usize,
}

/// What a ray sees.
enum Seen {
    Nothing,
    Point(Met),
    GaveUp,
}

/// A ray and what it sees.
struct Sight<const N: usize> {
    ray: RayLine,
    seen: Seen,
    /// What a mirror there makes of the picture that another ray brings, and the place of that ray's sight.
    next: Option<(Mirror<N>, usize)>,
}

impl<'s, B: Basis<N>, const N: usize> Painter<'s, B, N> {
    /// The painter of rays from `eye`, whose light `basis` counts; `shadows` are those of the same lights.
    pub fn new(basis: B, eye: [f64; 3], appearance: &'s Appearance, shadows: &'s Shadows) -> Self {
        Painter {
            basis,
            appearance,
            shadows,
            shader: Shader::new(eye, &appearance.lights, &basis),
            finishes: appearance.materials.iter().map(|material| Finish::new(material, &basis)).collect(),
            fallback: Finish::new(&Material::default(), &basis),
            background: basis.parts(appearance.background),
        }
    }

    /// The colours of rays, one each, `outcomes` being what became of them on surfaces.
    pub fn paint(&self, lanes: Lanes, rays: &[RayLine], outcomes: &[Outcome]) -> Painted {
        let mut sights: Vec<_> = rays.iter().zip(outcomes).map(|(ray, outcome)| self.sight(ray, outcome)).collect();
        let count = sights.len();
        let mut mirrored = Vec::new();
        for Sight { ray, seen, next } in &mut sights {
            if let Seen::Point(met) = seen
                && let Some((mirror, ray)) = self.mirror(ray, met).zip(reflected(ray, met))
            {
                *next = Some((mirror, count + mirrored.len()));
                mirrored.push(ray);
            }
        }
        let mut outcomes = Vec::with_capacity(mirrored.len());
        if !mirrored.is_empty() {
            lanes.mirrored.trace(&mirrored, false, &mut outcomes, &mut Tally::default());
            sights.extend(mirrored.iter().zip(&outcomes).map(|(ray, outcome)| self.sight(ray, outcome)));
        }
        let mirrored = Count::of(mirrored.len(), &outcomes);
        let (visibility, shadow) = self.lit(lanes.shadow, &sights);
        let own = |k: usize| self.own(sights.get(k)?, visibility.of_point(k));
        // After the last ray that is followed, a metal mirrors the background.
        let last = |k: usize| {
            let Sight { ray, seen, .. } = sights.get(k)?;
            let metal = match seen {
                Seen::Point(met) if self.finish(met).metal.is_some() => self.mirror(ray, met),
                _ => None,
            };
            own(k).map(|own| metal.map_or(own, |mirror| mirror.with(own, self.background)))
        };
        let light = |k: usize| match sights.get(k)?.next {
            None => last(k),
            Some((mirror, next)) => Some(mirror.with(own(k)?, last(next)?)),
        };
        let colours = (0..count).map(|k| light(k).map(|light| self.basis.display(light))).collect();
        Painted { colours, mirrored, shadow }
    }

    /// Which lights reach what rays see, and how many rays that took.
    fn lit(&self, lane: Option<&mut dyn Lane>, sights: &[Sight<N>]) -> (Visibility<'s>, Count) {
        let lights = self.shader.lights();
        let mut visibility = Visibility::new(self.shadows, &self.appearance.polygons, sights.len(), lights);
        for (index, Sight { ray, seen, .. }) in sights.iter().enumerate().filter(|_| self.shadows.any()) {
            let Seen::Point(met) = seen else { continue };
            for light in (0..lights).filter(|&light| self.shadows.casts(light)) {
                let facing = self.shader.facing(light, ray.origin, met.point, met.normal, self.finish(met));
                if let Some(facing) = facing {
                    visibility.ask([index, light], &facing, ray.origin);
                }
            }
        }
        let rays = visibility.trace(lane);
        (visibility, rays)
    }

    fn sight(&self, ray: &RayLine, outcome: &Outcome) -> Sight<N> {
        Sight { ray: *ray, seen: self.seen(ray, outcome), next: None }
    }

    /// What a ray sees: the nearer of what it met on surfaces and on polygons.
    fn seen(&self, ray: &RayLine, outcome: &Outcome) -> Seen {
        let mut met = match outcome {
            Outcome::Hit(found) => {
                let material = self.appearance.surfaces.get(found.surface).copied().unwrap_or(0);
                Some(Met { point: [0.0; 3], t: found.t, normal: found.normal.shown(), material })
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
        let finish = self.finish(met);
        if !(finish.reflect > 0.0) {
            return None;
        }
        // What has no normal is taken to face the ray.
        finish.mirror(met.normal.map_or(1.0, |normal| {
            let [along, square] = [normal, ray.direction].map(|v| (0..3).map(|k| v[k] * ray.direction[k]).sum::<f64>());
            along.abs() / square.sqrt()
        }))
    }

    /// The light that a ray brings without what is mirrored, so much of each light arriving there as `shares` says.
    fn own(&self, Sight { ray, seen, .. }: &Sight<N>, shares: &[Option<f64>]) -> Option<[f64; N]> {
        match seen {
            Seen::Nothing => Some(self.background),
            Seen::GaveUp => None,
            Seen::Point(met) => self.shader.colour(ray.origin, met.point, met.normal, self.finish(met), shares),
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
    use patchray::ray::Incidence;

    use super::super::shadows::NO_SHADOWS;
    use super::super::spectrum::{Rgb, Sampled};
    use super::*;
    use crate::scanline::{Found, Normal};
    use crate::scene::appearance::Metal;
    use crate::scene::light::{Light, Shadow};
    use crate::scene::model::Model;
    use crate::scene::polygon::Polygon;
    use crate::settings::Settings;
    use std::sync::atomic::AtomicBool;

    /// A lane that answers every ray alike.
    struct Answers(Outcome);

    impl Lane for Answers {
        fn trace(&mut self, rays: &[RayLine], _: bool, outcomes: &mut Vec<Outcome>, _: &mut Tally) {
            outcomes.extend(rays.iter().map(|_| self.0));
        }
    }

    fn lanes(mirrored: &mut Answers) -> Lanes<'_> {
        Lanes { mirrored, shadow: None }
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
        let mut lane = Answers(mirrored);
        Painter::new(Rgb, DOWN.origin, appearance, &NO_SHADOWS).paint(lanes(&mut lane), &[DOWN], &[met]).colours[0]
    }

    fn surface(t: f64) -> Outcome {
        Outcome::Hit(Found {
            t,
            u: 0.5,
            v: 0.5,
            surface: 0,
            normal: Normal::There([0.0, 0.0, 1.0]),
            incidence: Incidence::Crossing,
        })
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

    /// A floor that scatters all of one light and shines itself: in the shadow its own light is left.
    #[test]
    fn a_shadow_takes_the_light_and_not_what_shines_by_itself() {
        let mut scene = floor(0.0);
        scene.materials[1].diffuse = 0.5;
        scene.lights = vec![Light { position: Some([0.0, 0.0, 3.0]), shadow: Shadow::Rays, ..Light::default() }];
        let shadows =
            Shadows::prepare(&Model::default(), &scene, &Settings::default(), DOWN.origin, &AtomicBool::new(false));
        let (shadows, _) = shadows.expect("there is no map");
        let painter = Painter::new(Rgb, DOWN.origin, &scene, &shadows);
        let gave_up = Outcome::GaveUp { limit: "nodes", best: None };
        let mut nothing = Answers(Outcome::Miss);
        for (answer, colour) in
            [(Outcome::Miss, Some([1.5, 0.0, 0.0])), (surface(0.5), Some([1.0, 0.0, 0.0])), (gave_up, None)]
        {
            let mut to_light = Answers(answer);
            let lanes = Lanes { mirrored: &mut nothing, shadow: Some(&mut to_light) };
            let painted = painter.paint(lanes, &[DOWN], &[Outcome::Miss]);
            assert_eq!((painted.colours, painted.shadow.rays), (vec![colour], 1));
        }
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
            let painter = Painter::new(Rgb, DOWN.origin, &scene, &NO_SHADOWS);
            let outcomes = [Outcome::Miss, surface(1.0), Outcome::Miss];
            painter.paint(lanes(&mut Answers(Outcome::Miss)), &[DOWN; 3], &outcomes).mirrored
        };
        assert_eq!((count(0.0).rays, count(0.5).rays), (0, 2));
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
        let painter = Painter::new(Sampled::new(), ray.origin, &scene, &NO_SHADOWS);
        painter.paint(lanes(&mut Answers(mirrored)), &[ray], &[Outcome::Miss]).colours[0].expect("no ray is given up")
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
                normal: Normal::There([1.0, 0.0, 0.0]),
                incidence: Incidence::Crossing,
            });
            let again = basis.indices(kind).expect("samples have wavelengths").map(|index| index.reflectance(0.8));
            near(metal(kind, 1.0, upright), std::array::from_fn(|k| shares[k] * again[k]));
        }
    }
}
