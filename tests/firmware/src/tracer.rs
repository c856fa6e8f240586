//! The methods behind one face: a scan line is begun, and then its rays are traced.

use patchray::clipper::ClipRoom;
use patchray::fallback::NoFallback;
use patchray::grid::Grids;
use patchray::limits::{Extent, Limits, Work};
use patchray::method::{Remembered, ScratchView, clipping, clipping_coherent, newton, newton_coherent};
use patchray::patch::Patches;
use patchray::point::Point;
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::scene::Scene;
use patchray::tree::Tree;
use patchray::view::Camera;

use crate::hash::Answer;
use crate::picture::Picture;

/// A method with all that it borrows.
pub trait Tracer<P: Point> {
    /// The memory of a scan line while it is traced.
    type Line<'l>
    where
        Self: 'l;

    /// Makes ready for the rays of a scan line of the picture, in order.
    fn line(&mut self, picture: &Picture, number: u32) -> Option<Self::Line<'_>>;

    /// The closest hit of a line's ray at (x, y) of the image; `work` is set to what the call did.
    fn ray(
        line: &mut Self::Line<'_>,
        at: [P::Scalar; 2],
        limits: &Limits<P::Scalar>,
        work: &mut Work,
    ) -> Answer<P::Scalar>;

    /// How large the scene is for this method.
    fn extent(&self) -> Extent;
}

/// What rays of any kind need, of a method that leads them by `L`: a tree, grids, or nothing.
#[derive(Debug)]
pub struct Rays<'m, P: Point, L, R> {
    /// The scene.
    pub scene: Scene<'m, P>,
    /// What leads them.
    pub led: L,
    /// Scratch.
    pub room: R,
    /// Coherence memory: a slot per surface, none for a method without coherence.
    pub memory: &'m mut [Remembered<P::Scalar>],
}

/// A scan line of such rays.
#[derive(Debug)]
pub struct RayLine<'l, 'm, P: Point, L, R> {
    rays: &'l mut Rays<'m, P, L, R>,
    picture: Picture,
    number: u32,
}

/// The direction of the ray at (x, y) of the image.
#[inline(always)]
fn direction<S: Scalar>(camera: &Camera<S>, [x, y]: [S; 2]) -> [S; 3] {
    core::array::from_fn(|k| camera.forward[k] + x * camera.right[k] + y * camera.up[k])
}

/// What a call takes, from a line.
macro_rules! ask {
    ($line:ident, $at:ident, $ask:expr) => {{
        let camera = $line.picture.camera::<P::Scalar>();
        match $line.rays.scene.ray(camera.eye, direction(&camera, $at)) {
            Ok(ray) => $ask(&ray),
            // No ray of these pictures is refused; if one were, the hash would tell the hits apart from the host's.
            Err(_) => Ok(None),
        }
    }};
}

macro_rules! tracer {
    ($led:ty, $room:ty, |$line:ident, $ray:ident, $interval:ident, $limits:ident, $work:ident| $ask:expr,
        $(#[$doc:meta])* $name:ident: |$rays:ident| $extent:expr) => {
        $(#[$doc])*
        pub type $name<'m, P> = Rays<'m, P, $led, $room>;

        impl<'m, P: Point> Tracer<P> for $name<'m, P> {
            type Line<'l> = RayLine<'l, 'm, P, $led, $room> where Self: 'l;

            fn line(&mut self, picture: &Picture, number: u32) -> Option<Self::Line<'_>> {
                Some(RayLine { rays: self, picture: *picture, number })
            }

            #[inline(always)]
            fn ray(
                $line: &mut Self::Line<'_>,
                at: [P::Scalar; 2],
                $limits: &Limits<P::Scalar>,
                $work: &mut Work,
            ) -> Answer<P::Scalar> {
                let $interval = &Interval::ahead();
                ask!($line, at, |$ray| $ask)
            }

            fn extent(&self) -> Extent {
                let $rays = self;
                let count = |number: usize| number as u32;
                let scene = Extent {
                    surfaces: count($rays.scene.len()),
                    scene_voxels: $rays.scene.longest_walk(),
                    ..Extent::default()
                };
                $extent(scene)
            }
        }
    };
}

/// Patches, and the grids over them.
pub type Gridded<'m, S> = (Patches<'m, S>, Grids<'m, S>);

/// Patches, and the trees over them.
pub type Treed<'m, S> = (Patches<'m, S>, Tree<'m, S>);

/// A type of its own for a method, that it be told apart from another with the same memory.
#[derive(Debug)]
pub struct By<const METHOD: u8, T>(pub T);

tracer!(
    By<0, Treed<'m, <P as Point>::Scalar>>, ScratchView<'m, P, NoFallback>,
    |line, ray, interval, limits, work| {
        let Rays { scene, led: By((patches, tree)), room, .. } = &mut *line.rays;
        newton::closest(scene, patches, tree, ray, interval, limits, room, work)
    },
    /// The original numerical method.
    Newton: |rays| |scene: Extent| {
        let By((patches, tree)) = &rays.led;
        Extent { nodes: count_of(tree.nodes()), patches: count_of(patches.all()), ..scene }
    }
);

tracer!(
    By<1, Gridded<'m, <P as Point>::Scalar>>, ScratchView<'m, P, NoFallback>,
    |line, ray, interval, limits, work| {
        let number = line.number;
        let Rays { scene, led: By((patches, grids)), room, memory } = &mut *line.rays;
        newton_coherent::closest(scene, patches, grids, memory, number, ray, interval, limits, room, work)
    },
    /// The improved numerical method.
    NewtonCoherent: |rays| |scene: Extent| {
        let By((patches, grids)) = &rays.led;
        Extent { patches: count_of(patches.all()), surface_voxels: grids.longest_walks(), walks: 2, ..scene }
    }
);

tracer!(
    By<2, ()>, ClipRoom<'m, P>,
    |line, ray, interval, limits, work| {
        let Rays { scene, room, .. } = &mut *line.rays;
        clipping::closest(scene, ray, interval, limits, room, work)
    },
    /// The original subdivision method.
    Clipping: |_rays| |scene: Extent| Extent { clipped: true, ..scene }
);

tracer!(
    By<3, Gridded<'m, <P as Point>::Scalar>>, ClipRoom<'m, P>,
    |line, ray, interval, limits, work| {
        let number = line.number;
        let Rays { scene, led: By((patches, grids)), room, memory } = &mut *line.rays;
        clipping_coherent::closest(scene, patches, grids, memory, number, ray, interval, limits, room, work)
    },
    /// The improved subdivision method.
    ClippingCoherent: |rays| |scene: Extent| {
        let By((patches, grids)) = &rays.led;
        let (patches, surface_voxels) = (count_of(patches.all()), grids.longest_walks());
        Extent { patches, surface_voxels, walks: 2, clipped: true, ..scene }
    }
);

/// How many slots there are.
pub(crate) fn count_of<T>(slots: &[T]) -> u32 {
    slots.len() as u32
}
