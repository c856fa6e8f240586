//! What a family is made of: cases, each a model with rays.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;

use crate::judge::Truth;
use crate::scene::camera::View;
use crate::scene::model::{Model, ModelSurface};
use crate::scene::rays::RayLine;
use crate::scene::shapes::Random;
use crate::scene::trace::Precision;

/// Cases that are hard in the same way.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// Its name, in tables and on the command line.
    pub name: &'static str,
    /// In what way it is hard.
    pub what: &'static str,
    /// The share of its rays that may be left unjudged, at most: in `f64` and in `f32`.
    pub unjudged: [f64; 2],
    /// Makes the cases.
    pub cases: fn(&mut Draw) -> Vec<Case>,
}

/// What may be left unjudged of most families.
pub const FEW: [f64; 2] = [0.3, 0.3];

/// The same of those for which `f32` has so few digits that rounding alone changes many answers.
pub const COARSE: [f64; 2] = [0.3, 0.6];

/// The same of those whose rays come near another answer on purpose, down to the last digits of the precision.
pub const MANY: [f64; 2] = [0.6, 0.6];

/// A model with rays.
#[derive(Clone, Debug)]
pub struct Case {
    /// The surfaces.
    pub model: Model,
    /// The rays.
    pub shot: Shot,
    /// The truth by a closed form, in place of the oracle's.
    pub exact: Option<Exact>,
}

/// A closed form: what is true of a ray, given the case's model in the numbers that the precision holds.
#[derive(Clone)]
pub struct Exact(pub Arc<Form>);

/// See [`Exact`].
pub type Form = dyn Fn(&Model, &RayLine) -> Truth + Send + Sync;

impl fmt::Debug for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Exact")
    }
}

/// How a case is traced.
#[derive(Clone, Debug)]
pub enum Shot {
    /// As rays of no view, along scan lines of their own: by the methods for any rays.
    Rays(Vec<RayLine>),
    /// As a picture: by all methods.
    Picture(View),
}

impl Case {
    /// Rays of no view, judged by the oracle.
    pub fn of_rays(model: Model, rays: Vec<RayLine>) -> Self {
        Case { model, shot: Shot::Rays(rays), exact: None }
    }

    /// Rays of no view, judged by a closed form.
    pub fn of_form(
        model: Model,
        rays: Vec<RayLine>,
        form: impl Fn(&Model, &RayLine) -> Truth + Send + Sync + 'static,
    ) -> Self {
        Case { exact: Some(Exact(Arc::new(form))), ..Case::of_rays(model, rays) }
    }
}

/// What cases are drawn from.
#[derive(Clone, Debug)]
pub struct Draw {
    /// The numbers.
    pub random: Random,
    /// About how many rays a case is to have.
    pub rays: usize,
    /// What model and rays will be rounded to.
    pub precision: Precision,
}

impl Draw {
    /// The exponent of the smallest step, as a power of ten, that is asked of the precision: 14 in `f64`, 5 in `f32`. A hundredth,
    /// or half, of what can be judged.
    pub fn digits(&self) -> f64 {
        match self.precision {
            Precision::F64 => 14.0,
            Precision::F32 => 5.0,
        }
    }

    /// A number of either sign, from 0.1 down to the smallest step, its logarithm evenly spread.
    pub fn ladder(&mut self) -> f64 {
        let size = 10.0_f64.powf(-self.random.within(1.0, self.digits()));
        if self.random.within(0.0, 1.0) < 0.5 { -size } else { size }
    }

    /// A unit vector.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            // Ends: a point of the cube lies in this shell with probability above 0.4.
            let p = DVec3::from_array(self.random.point(1.0));
            if (0.3..=1.0).contains(&p.length()) {
                return p.normalize();
            }
        }
    }

    /// A ray to `target` from `distance` away in any direction.
    pub fn ray_to(&mut self, target: DVec3, distance: f64) -> RayLine {
        let direction = self.direction();
        ray(target - direction * distance, direction)
    }

    /// Rays from outside to points in the box of the model's control points: half of them met somewhere, by experience.
    pub fn rays_at(&mut self, model: &Model, count: usize) -> Vec<RayLine> {
        let Some(bounds) = model.control_box() else { return Vec::new() };
        (0..count)
            .map(|_| {
                let target = DVec3::from_array([0, 1, 2].map(|k| self.random.within(bounds.min[k], bounds.max[k])));
                self.ray_to(target, away(model))
            })
            .collect()
    }

    /// Rays from outside to points of the model's surfaces.
    pub fn rays_onto(&mut self, model: &Model, count: usize) -> Vec<RayLine> {
        (0..count)
            .map(|_| {
                let surface = self.pick(&model.surfaces);
                let [u, v] = [0; 2].map(|_| self.random.within(0.0, 1.0));
                let target = point(surface, u, v);
                self.ray_to(target, away(model))
            })
            .collect()
    }

    /// One of a list, which must not be empty.
    pub fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        let place = self.random.within(0.0, list.len() as f64) as usize;
        &list[place.min(list.len() - 1)]
    }
}

/// How far from what they are aimed at rays begin: outside of the model.
pub fn away(model: &Model) -> f64 {
    1.5 * model.control_box().map_or(0.0, |bounds| bounds.diagonal())
}

/// A ray ahead of its origin.
pub fn ray(origin: DVec3, direction: DVec3) -> RayLine {
    RayLine {
        origin: origin.to_array(),
        direction: direction.to_array(),
        t_min: 0.0,
        t_max: f64::INFINITY,
        scan_line: 0,
        valid: true,
    }
}

/// The point of a surface at (u, v), to rounding: for aiming.
pub fn point(surface: &ModelSurface, u: f64, v: f64) -> DVec3 {
    DVec3::from_array(surface.point(u, v))
}

/// The model with every control point moved by `map`.
pub fn mapped(model: &Model, map: impl Fn(DVec3) -> DVec3) -> Model {
    let mut model = model.clone();
    for point in model.surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
        let [x, y, z] = map(DVec3::new(point[0], point[1], point[2])).to_array();
        *point = [x, y, z, point[3]];
    }
    model
}

/// The models, each with its part of the rays onto it.
pub fn onto(draw: &mut Draw, models: Vec<Model>) -> Vec<Case> {
    let rays = draw.rays / models.len().max(1);
    let cases = models.into_iter().map(|model| {
        let lines = draw.rays_onto(&model, rays);
        Case::of_rays(model, lines)
    });
    cases.collect()
}
