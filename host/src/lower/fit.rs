//! Which surfaces of a file a kernel point can hold, and its points.

use patchray::point::{Plain, Point, Weighted};
use patchray::scalar::Scalar;
use patchray::scene::{Scene, SceneError, SceneMemory, SceneOptions};
use patchray::surface::{Net, NetError};

use super::place::Origins;
use crate::scene::model::{Model, ModelSurface};

/// A kernel point that can be made from a file's numbers.
pub trait FromFile: Point {
    /// The point `[x, y, z, w]`, rounded to this precision; the weight is not multiplied in.
    fn from_file(point: [f64; 4]) -> Self;
}

impl<S: Scalar> FromFile for Plain<S> {
    fn from_file([x, y, z, _]: [f64; 4]) -> Self {
        Plain([x, y, z].map(S::from_f64))
    }
}

impl<S: Scalar> FromFile for Weighted<S> {
    fn from_file([x, y, z, w]: [f64; 4]) -> Self {
        Weighted::new([x, y, z].map(S::from_f64), S::from_f64(w))
    }
}

/// The control points of a surface in the kernel's type, relative to its origins, checked.
pub(super) fn points_of<P: FromFile>(
    surface: &ModelSurface,
    index: usize,
    origins: &Origins<P::Scalar>,
) -> Result<Vec<P>, String> {
    let relative = |&[x, y, z, w]: &[f64; 4]| {
        let [x, y, z] = origins.relative(index, [x, y, z]);
        P::from_file([x, y, z, w])
    };
    let points: Vec<P> = surface.points.iter().map(relative).collect();
    Net::checked(surface.degree_u, surface.degree_v, &points).map_err(|error| error.to_string())?;
    Ok(points)
}

/// The nets of a model, of its surfaces' points.
pub(super) fn nets_of<'p, P: Point>(model: &Model, points: &'p [Vec<P>]) -> Result<Vec<Net<'p, P>>, NetError> {
    let of = |(surface, points): (&ModelSurface, &'p Vec<P>)| Net::new(surface.degree_u, surface.degree_v, points);
    model.surfaces.iter().zip(points).map(of).collect()
}

/// The index in `model`, and the reason, of each surface that this point type cannot hold: one that is not valid in the
/// file, or whose numbers overflow, or whose weights vanish, in `f32`.
///
/// If there are none, of the first that is too small beside the others: what is left without it is to be asked of again, since
/// a small surface that lies far away is itself what others are small beside.
pub fn unfit<P: FromFile>(model: &Model) -> Vec<(usize, String)> {
    let origins = Origins::of(model, true);
    let (mut points, mut unfit) = (Vec::new(), Vec::new());
    for (index, surface) in model.surfaces.iter().enumerate() {
        match points_of::<P>(surface, index, &origins) {
            Ok(of_surface) => points.push(of_surface),
            Err(reason) => unfit.push((index, reason)),
        }
    }
    if let (true, Ok(nets)) = (unfit.is_empty(), nets_of(model, &points)) {
        let options = SceneOptions { origin: origins.scene, ..Default::default() };
        let built = Scene::build_apart(&nets, &origins.own, &options, nothing());
        if let Err(SceneError::Surface { surface, error }) = built {
            unfit.push((surface as usize, error.to_string()));
        }
    }
    unfit
}

/// No memory, to be told how much is needed.
pub(super) fn nothing<'m, P: Point>() -> SceneMemory<'m, P> {
    SceneMemory { points: &mut [], surfaces: &mut [], offsets: &mut [], references: &mut [] }
}
