//! How points of a file, and of rays, come to be relative to a scene's origin: subtracted in `f64` and rounded afterwards.
//!
//! Rounded first, a part of a few units at coordinates of a million would lose in `f32` what `f64` holds of it.

use patchray::frame::{Aabb, exact_origin};
use patchray::point::Point;
use patchray::scalar::Scalar;
use patchray::scene::{Scene, SceneHeader};

use super::Lowered;
use crate::scene::model::Model;

/// The origin to which the model's points lose nothing in this precision.
pub(super) fn origin_of<S: Scalar>(model: &Model) -> [S; 3] {
    let positions = model.surfaces.iter().flat_map(|surface| &surface.points);
    let bounds = positions.fold(Aabb::EMPTY, |bounds, &[x, y, z, _]| bounds.with([x, y, z].map(S::from_f64)));
    exact_origin(&bounds)
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
