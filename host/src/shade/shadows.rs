//! Shadows: which lights reach which points.
//!
//! Of a light with a map the map is asked; of one with rays, a ray from the point to the light. Polygons keep the light from
//! points in either case, by plain intersection.

use std::sync::atomic::AtomicBool;

use patchray::frame::{Aabb, exact_origin};
use patchray::scalar::Scalar;

use super::map::{MapUsed, ShadowMap};
use crate::lower::LowerError;
use crate::scanline::{Lane, Outcome, Tally};
use crate::scene::appearance::Appearance;
use crate::scene::light::Shadow;
use crate::scene::model::Model;
use crate::scene::polygon::Polygon;
use crate::scene::rays::RayLine;
use crate::scene::trace::Precision;
use crate::settings::Settings;
use crate::vector::{largest, subtract};

/// How the shadows of a scene's lights are found.
#[derive(Clone, Debug, PartialEq)]
pub struct Shadows {
    /// In the order of the lights.
    casts: Vec<Cast>,
    clear: Clear,
}

/// How the shadows of a light are found.
#[derive(Clone, Debug, PartialEq)]
enum Cast {
    Nothing,
    Rays,
    Map(ShadowMap),
}

/// Rays that painting asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Their number.
    pub rays: u64,
    /// Those without an answer, which pixels show.
    pub gave_up: u64,
}

impl Count {
    /// Of so many rays with these answers, of which there may be fewer.
    pub(super) fn of(rays: usize, outcomes: &[Outcome]) -> Self {
        let answered = outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Hit(_) | Outcome::Miss)).count();
        Count { rays: rays as u64, gave_up: rays.saturating_sub(answered) as u64 }
    }
}

/// How high above their surface rays to lights begin, so that they do not meet the point that they leave: as much as what is
/// found may be off. They are raised along the normal and not begun further on along themselves, since where the light
/// grazes a surface that would have to be far, and would miss what stands near.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Clear {
    /// What roots may be off, in the scene's units.
    tolerance: f64,
    /// The least step of numbers around 1.
    epsilon: f64,
}

/// By how many times the tolerance and the rounding together a ray to a light is raised. Fewer let surfaces darken themselves
/// in specks, more miss what lies on a surface: in `f64`, thinner than 1e-11 of the scene, in `f32`, than 1e-4.
const RAISED: f64 = 16.0;

/// A point that a light would reach if nothing were in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing {
    /// The point.
    pub point: [f64; 3],
    /// The unit normal, on the side of the light.
    pub normal: [f64; 3],
    /// The light's place.
    pub light: [f64; 3],
    /// The cosine between the two, above 0.
    pub cosine: f64,
}

/// Those of lights that cast none.
pub static NO_SHADOWS: Shadows = Shadows { casts: Vec::new(), clear: Clear { tolerance: 0.0, epsilon: 0.0 } };

impl Shadows {
    /// The shadows of a scene's lights; those without a place are at the eye. Draws the maps, on rayon's current threads, and
    /// tells what they took; of rays it prepares nothing. Once `stop` is set, what is not drawn yet is left out, and the
    /// shadows are of no use.
    ///
    /// # Errors
    /// As [`ShadowMap::draw`].
    pub fn prepare(
        model: &Model,
        appearance: &Appearance,
        settings: &Settings,
        eye: [f64; 3],
        stop: &AtomicBool,
    ) -> Result<(Self, Vec<MapUsed>), LowerError> {
        let (mut casts, mut maps) = (Vec::new(), Vec::new());
        for (number, light) in appearance.lights.iter().enumerate() {
            casts.push(match light.shadow {
                Shadow::None => Cast::Nothing,
                Shadow::Rays => Cast::Rays,
                Shadow::Map(options) => {
                    let place = light.position.unwrap_or(eye);
                    let (map, used) = ShadowMap::draw(model, settings, (number, place), options, stop)?;
                    maps.push(used);
                    Cast::Map(map)
                }
            });
        }
        Ok((Shadows { casts, clear: Clear::of(model, settings) }, maps))
    }

    /// Whether a light casts any.
    pub fn any(&self) -> bool {
        self.casts.iter().any(|cast| *cast != Cast::Nothing)
    }

    /// Whether the light with this number casts any.
    pub fn casts(&self, light: usize) -> bool {
        self.casts.get(light).is_some_and(|cast| *cast != Cast::Nothing)
    }
}

impl Clear {
    fn of(model: &Model, settings: &Settings) -> Self {
        let (tolerance, epsilon) = match settings.precision {
            Precision::F32 => (f32::TOLERANCE.to_f64(), f64::from(f32::EPSILON)),
            Precision::F64 => (f64::TOLERANCE, f64::EPSILON),
        };
        // The tolerance is one of the kernel's frame, a unit of which is at most twice as long as the largest coordinate.
        let unit = model.control_box().map_or(0.0, |bounds| {
            let origin = exact_origin(&Aabb { low: bounds.min, high: bounds.max });
            2.0 * largest([bounds.min, bounds.max].map(|corner| subtract(corner, origin)))
        });
        Clear { tolerance: settings.tolerance.unwrap_or(tolerance) * unit, epsilon }
    }

    /// The ray from a point to the light, `from` being where the ray came from that found the point.
    fn ray(&self, facing: &Facing, from: [f64; 3]) -> RayLine {
        let Facing { point, normal, light, .. } = *facing;
        let height = RAISED * (self.tolerance + self.epsilon * largest([point, from]));
        let origin = [0, 1, 2].map(|k| point[k] + height * normal[k]);
        RayLine { origin, direction: subtract(light, origin), t_min: 0.0, t_max: 1.0, scan_line: 0, valid: true }
    }
}

/// Which lights reach which points, and what is still to be asked for that.
#[derive(Debug)]
pub struct Visibility<'s> {
    shadows: &'s Shadows,
    polygons: &'s [(Polygon, usize)],
    /// The number of lights.
    lights: usize,
    /// For each point and light the share of its light that arrives; `None` if that could not be told. Empty if no light
    /// casts a shadow.
    shares: Vec<Option<f64>>,
    /// The rays to be traced, and which share each decides.
    rays: Vec<RayLine>,
    decides: Vec<usize>,
}

impl<'s> Visibility<'s> {
    /// Of so many points and lights, all of which see each other.
    pub fn new(shadows: &'s Shadows, polygons: &'s [(Polygon, usize)], points: usize, lights: usize) -> Self {
        let shares = if shadows.any() { vec![Some(1.0); points * lights] } else { Vec::new() };
        Visibility { shadows, polygons, lights, shares, rays: Vec::new(), decides: Vec::new() }
    }

    /// Asks whether the light with this number reaches the point with this number; `from` is where the ray came from that found
    /// the point.
    pub fn ask(&mut self, [point, light]: [usize; 2], facing: &Facing, from: [f64; 3]) {
        let place = point * self.lights + light;
        let (Some(cast), Some(share)) = (self.shadows.casts.get(light), self.shares.get_mut(place)) else {
            return;
        };
        if *cast == Cast::Nothing {
            return;
        }
        let ray = self.shadows.clear.ray(facing, from);
        let meets = |polygon: &Polygon| polygon.intersect(ray.origin, ray.direction, ray.t_min, ray.t_max).is_some();
        if self.polygons.iter().any(|(polygon, _)| meets(polygon)) {
            *share = Some(0.0);
            return;
        }
        match cast {
            Cast::Nothing => {}
            Cast::Rays => {
                self.rays.push(ray);
                self.decides.push(place);
            }
            Cast::Map(map) => *share = map.share(facing.point, facing.cosine),
        }
    }

    /// Traces the rays that are to be traced, by a lane of a tracer of any hits; without one they are given up. Their number.
    pub fn trace(&mut self, lane: Option<&mut dyn Lane>) -> Count {
        let mut outcomes = Vec::with_capacity(self.rays.len());
        if let Some(lane) = lane.filter(|_| !self.rays.is_empty()) {
            lane.trace(&self.rays, false, &mut outcomes, &mut Tally::default());
        }
        for (k, &place) in self.decides.iter().enumerate() {
            if let Some(share) = self.shares.get_mut(place) {
                *share = match outcomes.get(k) {
                    Some(Outcome::Hit(_)) => Some(0.0),
                    Some(Outcome::Miss) => Some(1.0),
                    Some(Outcome::GaveUp { .. } | Outcome::Refused(_) | Outcome::Invalid) | None => None,
                };
            }
        }
        Count::of(self.rays.len(), &outcomes)
    }

    /// For each light the share that arrives at the point with this number; nothing if no light casts a shadow.
    pub fn of_point(&self, point: usize) -> &[Option<f64>] {
        self.shares.get(point * self.lights..(point + 1) * self.lights).unwrap_or(&[])
    }
}

#[cfg(test)]
mod tests {
    use patchray::ray::Incidence;

    use super::*;

    /// A lane that answers every ray alike.
    struct Answers(Outcome);

    impl Lane for Answers {
        fn trace(&mut self, rays: &[RayLine], _: bool, outcomes: &mut Vec<Outcome>, _: &mut Tally) {
            outcomes.extend(rays.iter().map(|_| self.0));
        }
    }

    const FACING: Facing =
        Facing { point: [2.0, 0.0, 0.0], normal: [0.0, 0.0, 1.0], light: [2.0, 0.0, 4.0], cosine: 1.0 };

    /// Two lights, of which the second casts shadows, by rays.
    fn shadows() -> Shadows {
        Shadows { casts: vec![Cast::Nothing, Cast::Rays], clear: Clear { tolerance: 1e-9, epsilon: 1e-12 } }
    }

    /// What arrives of both lights at the second of two points, which is asked of both.
    fn asked(polygons: &[(Polygon, usize)], lane: Option<&mut dyn Lane>) -> (Vec<Option<f64>>, Count) {
        let shadows = shadows();
        let mut visibility = Visibility::new(&shadows, polygons, 2, 2);
        visibility.ask([1, 0], &FACING, [5.0; 3]);
        visibility.ask([1, 1], &FACING, [5.0; 3]);
        let rays = visibility.trace(lane);
        assert_eq!(visibility.of_point(0), [Some(1.0); 2]);
        (visibility.of_point(1).to_vec(), rays)
    }

    #[test]
    fn what_a_ray_meets_is_in_the_way_and_giving_up_is_neither() {
        let gave_up = Outcome::GaveUp { limit: "nodes", best: None };
        for (answer, share) in [(Outcome::Miss, Some(1.0)), (gave_up, None), (Outcome::Invalid, None)] {
            let count = Count { rays: 1, gave_up: u64::from(share.is_none()) };
            assert_eq!(asked(&[], Some(&mut Answers(answer))), (vec![Some(1.0), share], count));
        }
        let found = crate::scanline::Found {
            t: 0.5,
            u: 0.5,
            v: 0.5,
            surface: 0,
            normal: crate::scanline::Normal::Nowhere,
            incidence: Incidence::Crossing,
        };
        assert_eq!(
            asked(&[], Some(&mut Answers(Outcome::Hit(found)))),
            (vec![Some(1.0), Some(0.0)], Count { rays: 1, gave_up: 0 })
        );
        assert_eq!(asked(&[], None), (vec![Some(1.0), None], Count { rays: 1, gave_up: 1 }));
    }

    #[test]
    fn a_polygon_in_the_way_saves_the_ray() {
        let square = |z: f64| vec![[1., -1., z], [3., -1., z], [3., 1., z], [1., 1., z]];
        for (z, rays) in [(2.0, 0), (0.0, 1), (-1.0, 1), (4.5, 1)] {
            let polygons = [(Polygon::new(square(z)).expect("a polygon"), 0)];
            let (shares, traced) = asked(&polygons, Some(&mut Answers(Outcome::Miss)));
            assert_eq!((shares[1], traced.rays), (Some(rays as f64), rays), "{z}");
        }
    }

    #[test]
    fn rays_to_lights_begin_above_the_surface_and_end_at_the_light() {
        let ray = shadows().clear.ray(&FACING, [5.0; 3]);
        let height = RAISED * (1e-9 + 5e-12);
        assert_eq!((ray.origin, ray.direction), ([2.0, 0.0, height], [0.0, 0.0, 4.0 - height]));
        assert_eq!((ray.t_min, ray.t_max), (0.0, 1.0));
    }

    #[test]
    fn where_no_light_casts_a_shadow_nothing_is_kept() {
        let visibility = Visibility::new(&NO_SHADOWS, &[], 1000, 3);
        assert!(visibility.shares.is_empty() && visibility.of_point(7).is_empty());
    }
}
