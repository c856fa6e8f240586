//! A lowered scene of whichever point type it needs: plain or weighted, `f32` or `f64`.

use patchray::limits::Work;
use patchray::patch::Patches;
use patchray::point::{Plain, Point, Weighted};
use patchray::scalar::Scalar;
use patchray::scene::Scene;
use patchray::view::View;

use crate::bake::Baked;
use crate::lower::{LowerError, Lowered, Stages, unfit};
use crate::memory::Bytes;
use crate::method::in_view::{ClippingPredicted, NewtonPredicted, ViewMethod};
use crate::method::{AllHits, AnyHit, Clipping, ClippingCoherent, Method, Newton, NewtonCoherent, Views};
use crate::scanline::view::{ViewTracer, most_lane_bytes};
use crate::scanline::{Found, LaneBytes, MethodTracer, Told, Tracer};
use crate::scene::camera;
use crate::scene::model::Model;
use crate::scene::trace::{Method as Which, Precision};
use crate::settings::Settings;

/// A lowered scene. A model without a rational surface has plain points; one rational surface makes all of them weighted.
#[derive(Clone, Debug)]
pub enum Prepared {
    /// Polynomial, 32 bits.
    PlainF32(Lowered<Plain<f32>>),
    /// Polynomial, 64 bits.
    PlainF64(Lowered<Plain<f64>>),
    /// Rational, 32 bits.
    WeightedF32(Lowered<Weighted<f32>>),
    /// Rational, 64 bits.
    WeightedF64(Lowered<Weighted<f64>>),
}

/// Runs the same code whatever the point type.
macro_rules! any {
    ($prepared:expr, $lowered:ident => $body:expr) => {
        match $prepared {
            Prepared::PlainF32($lowered) => $body,
            Prepared::PlainF64($lowered) => $body,
            Prepared::WeightedF32($lowered) => $body,
            Prepared::WeightedF64($lowered) => $body,
        }
    };
}

/// Whether the model needs weighted points.
pub(crate) fn is_rational(model: &Model) -> bool {
    model.surfaces.iter().any(|surface| surface.rational)
}

/// The index in `model`, and the reason, of each surface that cannot be lowered in this precision.
pub fn unfit_for(model: &Model, precision: Precision) -> Vec<(usize, String)> {
    match (precision, is_rational(model)) {
        (Precision::F32, false) => unfit::<Plain<f32>>(model),
        (Precision::F64, false) => unfit::<Plain<f64>>(model),
        (Precision::F32, true) => unfit::<Weighted<f32>>(model),
        (Precision::F64, true) => unfit::<Weighted<f64>>(model),
    }
}

/// The tracer of the method `M` under the limits of `settings`.
fn tracer<'m, M, P>(views: Views<'m, P>, settings: &Settings) -> Box<dyn Tracer<Told<M, P>> + 'm>
where
    M: Method<P> + 'm,
    P: Point,
{
    Box::new(MethodTracer::<M, P>::new(views, settings.limits(), settings.parts.reading()))
}

/// Which rays are traced beside those of a picture's scan lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Others {
    /// Any that ask for the closest hit, such as those that mirrors send on.
    pub closest: bool,
    /// Any that ask whether something lies on them, such as those to lights.
    pub any: bool,
}

/// What traces the rays of a picture.
pub struct Tracers<'m> {
    /// Those of its scan lines, and others if wanted: of the closest hits.
    pub picture: Box<dyn Tracer + 'm>,
    /// Those that ask whether something lies on them, if wanted: of the first hits that are found.
    pub any: Option<Box<dyn Tracer + 'm>>,
}

/// The tracer of a picture's scan lines by a method for the rays of a view, which the kernel's view of the scene is; `others`
/// traces all other rays.
fn lines_tracer<'m, M, P>(
    seen: (Scene<'m, P>, View<'m, P>),
    picture: &camera::View,
    settings: &Settings,
    others: Option<Box<dyn Tracer + 'm>>,
) -> Box<dyn Tracer + 'm>
where
    M: ViewMethod<P> + 'm,
    P: Point,
{
    Box::new(ViewTracer::<M, P>::new(seen, picture, settings.limits(), settings.parts.0.coherence, others))
}

/// The tracers of the picture's rays, by the method of `settings`. The memory of its view, if it needs one, has to have been
/// taken.
pub(crate) fn tracers<'m, P: Point>(
    lowered: &'m mut Lowered<P>,
    picture: &camera::View,
    settings: &Settings,
    others: Others,
) -> Result<Tracers<'m>, LowerError> {
    let (views, seen) = if settings.method.needs_view() {
        let (views, seen) = lowered.seen(picture)?;
        (views, Some((views.scene, seen)))
    } else {
        (Views::of(lowered), None)
    };
    let rays = || rays_tracer(views, settings);
    let closest = || others.closest.then(rays);
    let of_picture = match (settings.method, seen) {
        (Which::NewtonPredicted, Some(seen)) => lines_tracer::<NewtonPredicted, P>(seen, picture, settings, closest()),
        (Which::ClippingPredicted, Some(seen)) => {
            lines_tracer::<ClippingPredicted, P>(seen, picture, settings, closest())
        }
        _ => rays(),
    };
    Ok(Tracers { picture: of_picture, any: others.any.then(|| any_tracer(views, settings)) })
}

fn most_lane_bytes_of<P: Point>(method: Which, lowered: &Lowered<P>) -> Option<LaneBytes> {
    let (surfaces, patches) = (lowered.scene().len(), lowered.patches().all().len());
    match method {
        Which::NewtonPredicted => Some(most_lane_bytes::<NewtonPredicted, P>(surfaces, patches)),
        Which::ClippingPredicted => Some(most_lane_bytes::<ClippingPredicted, P>(surfaces, patches)),
        Which::Newton | Which::NewtonCoherent | Which::Clipping | Which::ClippingCoherent => None,
    }
}

/// The tracer of any rays, of the closest hits.
fn rays_tracer<'m, P: Point>(views: Views<'m, P>, settings: &Settings) -> Box<dyn Tracer + 'm> {
    match settings.method.of_any_rays() {
        Which::Newton => tracer::<Newton, _>(views, settings),
        Which::NewtonCoherent | Which::NewtonPredicted => tracer::<NewtonCoherent, _>(views, settings),
        Which::Clipping => tracer::<Clipping, _>(views, settings),
        Which::ClippingCoherent | Which::ClippingPredicted => tracer::<ClippingCoherent, _>(views, settings),
    }
}

/// The tracer of any rays, of the first hits that are found, by [`Which::of_any_hits`].
fn any_tracer<'m, P: Point>(views: Views<'m, P>, settings: &Settings) -> Box<dyn Tracer + 'm> {
    match settings.method.of_any_hits() {
        Which::Newton => tracer::<AnyHit<Newton>, _>(views, settings),
        _ => tracer::<AnyHit<Clipping>, _>(views, settings),
    }
}

fn patch_at<S: Scalar>(patches: &Patches<'_, S>, surface: usize, at: [f64; 2]) -> Option<u32> {
    let [u, v] = at.map(S::from_f64);
    let (first, _) = patches.range(surface)?;
    let within = patches.of_surface(surface)?.iter().position(|patch| patch.domain().holds(u, v))?;
    u32::try_from(first + within).ok()
}

impl Prepared {
    /// Lowers `model` in the precision of `settings`, and builds `stages`.
    ///
    /// # Errors
    /// As [`Lowered::build`].
    pub fn build(model: &Model, stages: Stages, settings: &Settings) -> Result<Self, LowerError> {
        Ok(match (settings.precision, is_rational(model)) {
            (Precision::F32, false) => Self::PlainF32(Lowered::build(model, stages, &settings.preparation())?),
            (Precision::F64, false) => Self::PlainF64(Lowered::build(model, stages, &settings.preparation())?),
            (Precision::F32, true) => Self::WeightedF32(Lowered::build(model, stages, &settings.preparation())?),
            (Precision::F64, true) => Self::WeightedF64(Lowered::build(model, stages, &settings.preparation())?),
        })
    }

    /// The same for a picture: with the memory of its view, if the method needs one.
    ///
    /// # Errors
    /// As [`Lowered::for_picture`].
    pub fn for_picture(
        model: &Model,
        stages: Stages,
        settings: &Settings,
        picture: &camera::View,
    ) -> Result<Self, LowerError> {
        Ok(match (settings.precision, is_rational(model)) {
            (Precision::F32, false) => Self::PlainF32(Lowered::for_picture(model, stages, settings, picture)?),
            (Precision::F64, false) => Self::PlainF64(Lowered::for_picture(model, stages, settings, picture)?),
            (Precision::F32, true) => Self::WeightedF32(Lowered::for_picture(model, stages, settings, picture)?),
            (Precision::F64, true) => Self::WeightedF64(Lowered::for_picture(model, stages, settings, picture)?),
        })
    }

    /// The tracer of the method, and under the limits, of `settings`: of the closest hits. The method's stages have to have
    /// been built. In place of a method that needs a view it is that of [`Which::of_any_rays`].
    pub fn tracer(&self, settings: &Settings) -> Box<dyn Tracer + '_> {
        any!(self, lowered => rays_tracer(Views::of(lowered), settings))
    }

    /// Why the kernel cannot trace all of the picture's rays as those of one view, if it cannot. Needs no stages.
    pub fn no_view(&self, picture: &camera::View) -> Option<String> {
        any!(self, lowered => lowered.no_view(picture))
    }

    /// Takes the memory of a view of what was built.
    ///
    /// # Errors
    /// As [`Lowered::take_view`].
    pub fn take_view(&mut self, picture: &camera::View, settings: &Settings) -> Result<(), LowerError> {
        let given = settings.limits.arena_bytes.unwrap_or(u64::MAX);
        any!(self, lowered => lowered.take_view(picture, given))
    }

    /// The tracers of the picture's rays, under the limits and by the method of `settings`, and of what `others` wants. The
    /// method's stages have to have been built, and the memory of its view taken, if it needs one.
    ///
    /// # Errors
    /// As [`Lowered::seen`].
    pub fn tracers(
        &mut self,
        picture: &camera::View,
        settings: &Settings,
        others: Others,
    ) -> Result<Tracers<'_>, LowerError> {
        any!(self, lowered => tracers(lowered, picture, settings, others))
    }

    /// The tracer of all hits; `None` if the method looks for no more than the closest.
    pub fn tracer_of_all(&self, settings: &Settings) -> Option<Box<dyn Tracer<Vec<Found>> + '_>> {
        any!(self, lowered => {
            let views = Views::of(lowered);
            match settings.method {
                Which::Newton => Some(tracer::<AllHits<Newton>, _>(views, settings)),
                Which::Clipping => Some(tracer::<AllHits<Clipping>, _>(views, settings)),
                _ => None,
            }
        })
    }

    /// The same of any hits, the first that are found; `None` if the method looks for no other than the closest.
    pub fn tracer_of_any(&self, settings: &Settings) -> Option<Box<dyn Tracer + '_>> {
        let wanted = settings.method.of_any_hits() == settings.method;
        wanted.then(|| any!(self, lowered => any_tracer(Views::of(lowered), settings)))
    }

    /// The most work that a ray can take: see [`Lowered::worst_case`].
    pub fn worst_case(&self, settings: &Settings) -> Work {
        any!(self, lowered => lowered.worst_case(settings))
    }

    /// What a method borrows of it as tables: its stages have to have been built.
    pub fn baked(&self, method: Which) -> Baked {
        let precision = match self {
            Prepared::PlainF32(_) | Prepared::WeightedF32(_) => Precision::F32,
            Prepared::PlainF64(_) | Prepared::WeightedF64(_) => Precision::F64,
        };
        any!(self, lowered => Baked::of(lowered, method, precision))
    }

    /// The number of surfaces.
    pub fn surfaces(&self) -> u64 {
        any!(self, lowered => lowered.scene().len() as u64)
    }

    /// The number of patches.
    pub fn patches(&self) -> u64 {
        any!(self, lowered => lowered.patches().all().len() as u64)
    }

    /// The number, among all, of the patch that holds the point (u, v) of a surface; `None` without patches.
    pub fn patch_at(&self, surface: usize, [u, v]: [f64; 2]) -> Option<u32> {
        any!(self, lowered => patch_at(&lowered.patches(), surface, [u, v]))
    }

    /// The bytes that `stages` take of what was built, by kind.
    pub fn bytes(&self, stages: Stages) -> Bytes {
        any!(self, lowered => lowered.bytes(stages))
    }

    /// The bytes that the view takes, by kind; none if no memory of one was taken.
    pub fn view_bytes(&self) -> Bytes {
        any!(self, lowered => lowered.view_bytes())
    }

    /// The most bytes that a thread can need for the scan lines of a view with a method; `None` for one that needs no view.
    pub fn most_view_lane_bytes(&self, method: Which) -> Option<LaneBytes> {
        any!(self, lowered => most_lane_bytes_of(method, lowered))
    }

    /// Bytes of scratch that building the scene needs.
    pub fn preparation_bytes(&self) -> u64 {
        any!(self, lowered => lowered.preparation_bytes())
    }
}
