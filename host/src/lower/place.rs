//! How points of a file, and of rays, come to be relative to a scene's origin: subtracted in `f64` and rounded afterwards.
//!
//! Rounded first, a part of a few units at coordinates of a million would lose in `f32` what `f64` holds of it.

use patchray::frame::{Aabb, exact_origin};
use patchray::point::Point;
use patchray::scalar::Scalar;
use patchray::scene::{Scene, SceneHeader};

use super::Lowered;
use crate::scene::model::{Model, ModelSurface};
use crate::scene::trace::Precision;

/// The origins to which the points of a model lose nothing in this precision.
#[derive(Clone, Debug)]
pub(super) struct Origins<S> {
    /// Of the scene.
    pub(super) scene: [S; 3],
    /// Of each surface, beside that: 0 where the scene's is near enough.
    pub(super) own: Vec<[S; 3]>,
}

/// A surface has an origin of its own if its coordinates relative to that are smaller than the scene's by this factor: by powers of
/// two, in `f32` and in `f64`. Less lets a surface be met less exactly, by up to so many times 32 roundings of its own; more makes
/// more surfaces cost what a ray's way to an origin costs. The kernel takes none of less than an eighth.
const SMALL: [i32; 2] = [6, 14];

/// The largest |coordinate| in a box.
fn reach<S: Scalar>(bounds: &Aabb<S>) -> S {
    bounds.low.iter().chain(&bounds.high).fold(S::ZERO, |most, c| most.greater(c.abs()))
}

impl<S: Scalar> Origins<S> {
    /// Of a model; without origins of their own, as views ask for, if `own` is not said.
    pub(super) fn of(model: &Model, own: bool) -> Self {
        let none = [S::ZERO; 3];
        let box_of = |surface: &ModelSurface, origin: [S; 3]| {
            let points = surface.points.iter();
            points.fold(Aabb::EMPTY, |bounds, &[x, y, z, _]| bounds.with(relative([x, y, z], origin)))
        };
        let around = |origin| model.surfaces.iter().fold(Aabb::EMPTY, |all, one| all.union(box_of(one, origin)));
        let scene = exact_origin(&around(none));
        let [single, double] = SMALL;
        let small = reach(&around(scene)).times_power_of_two(if size_of::<S>() == 4 { -single } else { -double });
        let of = |surface: &ModelSurface| {
            let bounds = box_of(surface, scene);
            let origin = exact_origin(&bounds);
            if own && reach(&bounds.relative(origin)) < small { origin } else { none }
        };
        Origins { scene, own: model.surfaces.iter().map(of).collect() }
    }

    /// A position of the file on a surface, relative to the scene's origin and to the surface's own: one after the other, which
    /// rounds nothing where their sum would.
    pub(super) fn relative(&self, index: usize, position: [f64; 3]) -> [f64; 3] {
        let own = self.own.get(index).copied().unwrap_or([S::ZERO; 3]);
        std::array::from_fn(|k| position[k] - self.scene[k].to_f64() - own[k].to_f64())
    }
}

/// The largest |coordinate| by which each surface of a model is met by the methods for any rays: relative to its origin, or the
/// scene's where it is not much smaller.
pub fn at_hand(model: &Model, precision: Precision) -> Vec<f64> {
    match precision {
        Precision::F32 => at_hand_of::<f32>(model),
        Precision::F64 => at_hand_of::<f64>(model),
    }
}

fn at_hand_of<S: Scalar>(model: &Model) -> Vec<f64> {
    let origins = [false, true].map(|own| Origins::<S>::of(model, own));
    let largest = |origins: &Origins<S>| {
        let of = |(index, surface): (usize, &ModelSurface)| {
            let positions = surface.points.iter().map(|&[x, y, z, _]| origins.relative(index, [x, y, z]));
            positions.flatten().fold(0.0, |most, c| f64::max(most, c.abs()))
        };
        model.surfaces.iter().enumerate().map(of).collect::<Vec<f64>>()
    };
    let [of_scene, own] = [&origins[0], &origins[1]].map(largest);
    let all = of_scene.into_iter().fold(0.0, f64::max);
    own.into_iter().map(|own| if own < all / 8.0 { own } else { all }).collect()
}

/// A position of a file relative to an origin.
pub(super) fn relative<S: Scalar>(position: [f64; 3], origin: [S; 3]) -> [S; 3] {
    std::array::from_fn(|k| S::from_f64(position[k] - origin[k].to_f64()))
}

/// In which coordinates a scene takes a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In those of the file.
    File,
    /// In those of its nets, relative to its origin.
    Nets,
}

impl Place {
    /// The place in which rounding takes nothing from a point, or less than in the other; and the point there. `origin` is the
    /// scene's.
    #[inline]
    pub fn of<S: Scalar>(point: [f64; 3], origin: [S; 3]) -> (Self, [S; 3]) {
        let rounded = point.map(S::from_f64);
        // The kernel subtracts without loss from what the type holds.
        if origin == [S::ZERO; 3] || rounded.map(S::to_f64) == point {
            (Place::File, rounded)
        } else {
            (Place::Nets, relative(point, origin))
        }
    }
}

impl<P: Point> Lowered<P> {
    /// The scene, which takes points of this place.
    pub fn scene_at(&self, place: Place) -> Scene<'_, P> {
        let header = self.header_at(place);
        Scene::new(header, &self.points, &self.surfaces, &self.offsets, &self.references)
    }

    pub(super) fn header_at(&self, place: Place) -> SceneHeader<P::Scalar> {
        match place {
            Place::File => self.header,
            Place::Nets => SceneHeader::new(self.header.frame().with_origin([P::Scalar::ZERO; 3]), *self.header.grid()),
        }
    }
}
