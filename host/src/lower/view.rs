//! A lowered scene as seen from one eye: the memory of the kernel's view.

use patchray::patch::{Patch, Patches};
use patchray::point::Point;
use patchray::ray::{Interval, RayError};
use patchray::scalar::Scalar;
use patchray::view::{Camera, Sight, View, ViewError, ViewMemory, ViewNeeds};

use super::{FromFile, LowerError, Lowered, Place, Stages};
use crate::memory::{Bytes, Kind, Slots};
use crate::method::Views;
use crate::scene::camera;
use crate::scene::model::Model;
use crate::scene::sampling::ScanLine;
use crate::settings::Settings;

/// The memory of a view, lent to the kernel.
#[derive(Clone, Debug)]
pub(super) struct ViewSlots<P: Point> {
    points: Vec<P>,
    surfaces: Vec<[P::Scalar; 2]>,
    patches: Vec<Patch<P::Scalar>>,
    sights: Vec<Sight<P::Scalar>>,
    runs: Vec<[P::Scalar; 2]>,
    first_runs: Vec<u32>,
}

impl<P: Point> ViewSlots<P> {
    pub(super) fn none() -> Self {
        ViewSlots {
            points: Vec::new(),
            surfaces: Vec::new(),
            patches: Vec::new(),
            sights: Vec::new(),
            runs: Vec::new(),
            first_runs: Vec::new(),
        }
    }

    /// The needs, each as slots of its type.
    fn take(slots: &mut Slots, needs: &ViewNeeds) -> Result<Self, LowerError> {
        slots.ask::<P>(Kind::ViewPoints, needs.points);
        slots.ask::<[P::Scalar; 2]>(Kind::ViewSurfaces, needs.surfaces);
        slots.ask::<Patch<P::Scalar>>(Kind::ViewPatches, needs.patches);
        slots.ask::<Sight<P::Scalar>>(Kind::ViewSights, needs.sights);
        slots.ask::<[P::Scalar; 2]>(Kind::ViewRuns, needs.runs);
        slots.ask::<u32>(Kind::ViewRunRanges, needs.first_runs);
        slots.check()?;
        Ok(ViewSlots {
            points: slots.take(Kind::ViewPoints, P::EMPTY, needs.points)?,
            surfaces: slots.take(Kind::ViewSurfaces, [P::Scalar::ZERO; 2], needs.surfaces)?,
            patches: slots.take(Kind::ViewPatches, Patch::EMPTY, needs.patches)?,
            sights: slots.take(Kind::ViewSights, Sight::EMPTY, needs.sights)?,
            runs: slots.take(Kind::ViewRuns, [P::Scalar::ZERO; 2], needs.runs)?,
            first_runs: slots.take(Kind::ViewRunRanges, 0, needs.first_runs)?,
        })
    }

    fn lend(&mut self) -> ViewMemory<'_, P> {
        ViewMemory {
            points: &mut self.points,
            surfaces: &mut self.surfaces,
            patches: &mut self.patches,
            sights: &mut self.sights,
            runs: &mut self.runs,
            first_runs: &mut self.first_runs,
        }
    }
}

/// The kernel's camera of a view, its numbers rounded to this precision, for a scene with this origin; and the place that its
/// eye is in.
fn camera_of<S: Scalar>(view: &camera::View, origin: [S; 3]) -> (Place, Camera<S>) {
    let (place, eye) = Place::of(view.eye, origin);
    let [forward, right, up] = [view.forward, view.right, view.up].map(|vector| vector.map(S::from_f64));
    (place, Camera { eye, forward, right, up })
}

/// The corners of the part of the image in which samples lie.
fn corners(view: &camera::View) -> Vec<[f64; 2]> {
    let lines = [0, view.scan_lines().saturating_sub(1)].map(|line| view.scan_line(line));
    let ends = |ScanLine { samples, sy }: &ScanLine| {
        let xs = samples.iter().map(|sample| sample[0]);
        let [left, right] = [xs.clone().fold(f64::INFINITY, f64::min), xs.fold(f64::NEG_INFINITY, f64::max)];
        sy.map(|y| [[left, y], [right, y]])
    };
    lines.iter().flat_map(ends).flatten().collect()
}

/// Why the rays of a picture are not those of a view.
fn reason(error: ViewError) -> String {
    match error {
        ViewError::Ray(error) => format!("of the ray of its middle {error}"),
        other => other.to_string(),
    }
}

impl<P: FromFile> Lowered<P> {
    /// Lowers `model`, builds the stages, and takes the memory of the picture's view if the method of `settings` needs one.
    ///
    /// # Errors
    /// As [`Lowered::build`] and [`Lowered::take_view`]; and a picture that the method cannot trace: [`LowerError::NoView`].
    pub fn for_picture(
        model: &Model,
        stages: Stages,
        settings: &Settings,
        picture: &camera::View,
    ) -> Result<Self, LowerError> {
        let (method, preparation) = (settings.method, settings.preparation());
        if !method.needs_view() {
            return Self::build(model, stages, &preparation);
        }
        // Before patches are made, which may take long.
        if let Some(reason) = Self::build(model, Stages::NONE, &preparation)?.no_view(picture) {
            return Err(LowerError::NoView { method: method.name(), reason });
        }
        let mut lowered = Self::build(model, stages, &preparation)?;
        lowered.take_view(picture, preparation.arena_bytes)?;
        Ok(lowered)
    }
}

impl<P: Point> Lowered<P> {
    /// Why the kernel cannot trace all of the picture's rays as those of one view, if it cannot. Needs no patches.
    pub fn no_view(&self, view: &camera::View) -> Option<String> {
        let (place, camera) = camera_of(view, self.header.frame().origin());
        let scene = self.scene_at(place);
        let first = vec![0; scene.len() + 1];
        let no_patches = Patches::new(&[], &first);
        let mut slots = ViewSlots::<P>::none();
        slots.points = vec![P::EMPTY; self.points.len()];
        slots.surfaces = vec![[P::Scalar::ZERO; 2]; scene.len()];
        slots.first_runs = vec![0; scene.len() + 1];
        let seen = match View::build(&scene, &no_patches, &camera, slots.lend()) {
            Ok(seen) => seen,
            Err(error) => return Some(reason(error)),
        };
        // Directions within 45° of the middle are a convex part of the image.
        let refused = |place: [f64; 2]| seen.ray(place.map(P::Scalar::from_f64), &Interval::ahead()).err();
        let error: RayError = corners(view).into_iter().find_map(refused)?;
        Some(format!("of a ray in its corners {error}"))
    }

    /// Takes the memory of a view of what was built, its patches among it; `given` bounds the bytes of all memory together.
    ///
    /// # Errors
    /// More memory than there is or is given. That there is no such view, as [`Lowered::no_view`] tells, is internal.
    pub fn take_view(&mut self, view: &camera::View, given: u64) -> Result<(), LowerError> {
        let mut nothing = ViewSlots::none();
        let (place, camera) = camera_of(view, self.header.frame().origin());
        let needs = match View::build(&self.scene_at(place), &self.patches(), &camera, nothing.lend()) {
            Err(ViewError::Memory(needs)) => needs,
            Ok(_) => ViewNeeds::default(),
            Err(ViewError::TooLarge) => return Err(LowerError::TooLarge(ViewError::TooLarge.to_string())),
            Err(error) => return Err(LowerError::Internal(error.to_string())),
        };
        let mut slots = Slots::beside(self.bytes(self.stages), given);
        self.view = ViewSlots::take(&mut slots, &needs)?;
        Ok(())
    }

    /// What was built, and the view that [`Lowered::take_view`] took memory for; filled anew.
    ///
    /// # Errors
    /// The memory is of another view.
    pub fn seen(&mut self, view: &camera::View) -> Result<(Views<'_, P>, View<'_, P>), LowerError> {
        let (place, camera) = camera_of(view, self.header.frame().origin());
        let headers = [Place::File, Place::Nets].map(|place| self.header_at(place));
        let Lowered { points, surfaces, offsets, references, patches, first, .. } = self;
        let [scene, nets] = headers.map(|header| super::Scene::new(header, points, surfaces, offsets, references));
        let patches = Patches::new(patches, first);
        let of = if place == Place::File { &scene } else { &nets };
        let seen = View::build(of, &patches, &camera, self.view.lend());
        let seen = seen.map_err(|error| LowerError::Internal(error.to_string()))?;
        let tree = super::Tree::new(&self.nodes, &self.links);
        let grids = super::Grids::new(&self.grids, &self.grid_offsets, &self.grid_references);
        Ok((Views { scene, nets, patches, tree, grids }, seen))
    }

    /// The slots that the view takes, by kind; none if no memory of one was taken.
    pub fn view_bytes(&self) -> Bytes {
        let ViewSlots { points, surfaces, patches, sights, runs, first_runs } = &self.view;
        let mut bytes = Bytes::default();
        if surfaces.is_empty() {
            return bytes;
        }
        bytes.add::<P>(Kind::ViewPoints, points.len());
        bytes.add::<[P::Scalar; 2]>(Kind::ViewSurfaces, surfaces.len());
        bytes.add::<Patch<P::Scalar>>(Kind::ViewPatches, patches.len());
        bytes.add::<Sight<P::Scalar>>(Kind::ViewSights, sights.len());
        bytes.add::<[P::Scalar; 2]>(Kind::ViewRuns, runs.len());
        bytes.add::<u32>(Kind::ViewRunRanges, first_runs.len());
        bytes
    }
}
