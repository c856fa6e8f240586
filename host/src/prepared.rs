//! A lowered scene of whichever point type it needs: plain or weighted, `f32` or `f64`.

use patchray::point::{Plain, Point, Weighted};

use crate::lower::{LowerError, Lowered, Stages, unfit};
use crate::memory::Bytes;
use crate::method::{AllHits, AnyHit, Clipping, ClippingCoherent, Method, Newton, NewtonCoherent, Views};
use crate::scanline::{Found, MethodTracer, Told, Tracer};
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
fn is_rational(model: &Model) -> bool {
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
    Box::new(MethodTracer::<M, P>::new(views, settings.limits()))
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

    /// The tracer of the method, and under the limits, of `settings`: of the closest hits. The method's stages have to have
    /// been built.
    pub fn tracer(&self, settings: &Settings) -> Box<dyn Tracer + '_> {
        any!(self, lowered => {
            let views = Views::of(lowered);
            match settings.method {
                Which::Newton => tracer::<Newton, _>(views, settings),
                Which::NewtonCoherent => tracer::<NewtonCoherent, _>(views, settings),
                Which::Clipping => tracer::<Clipping, _>(views, settings),
                Which::ClippingCoherent => tracer::<ClippingCoherent, _>(views, settings),
            }
        })
    }

    /// The same of all hits; `None` if the method looks for no more than the closest.
    pub fn tracer_of_all(&self, settings: &Settings) -> Option<Box<dyn Tracer<Vec<Found>> + '_>> {
        any!(self, lowered => {
            let views = Views::of(lowered);
            match settings.method {
                Which::Newton => Some(tracer::<AllHits<Newton>, _>(views, settings)),
                Which::Clipping => Some(tracer::<AllHits<Clipping>, _>(views, settings)),
                Which::NewtonCoherent | Which::ClippingCoherent => None,
            }
        })
    }

    /// The same of any hits, the first that are found; `None` if the method looks for no other than the closest.
    pub fn tracer_of_any(&self, settings: &Settings) -> Option<Box<dyn Tracer + '_>> {
        any!(self, lowered => {
            let views = Views::of(lowered);
            match settings.method {
                Which::Newton => Some(tracer::<AnyHit<Newton>, _>(views, settings)),
                Which::Clipping => Some(tracer::<AnyHit<Clipping>, _>(views, settings)),
                Which::NewtonCoherent | Which::ClippingCoherent => None,
            }
        })
    }

    /// The number of surfaces.
    pub fn surfaces(&self) -> u64 {
        any!(self, lowered => lowered.scene().len() as u64)
    }

    /// The number of patches.
    pub fn patches(&self) -> u64 {
        any!(self, lowered => lowered.patches().all().len() as u64)
    }

    /// The bytes that `stages` take of what was built, by kind.
    pub fn bytes(&self, stages: Stages) -> Bytes {
        any!(self, lowered => lowered.bytes(stages))
    }

    /// Bytes of scratch that building the scene needs.
    pub fn preparation_bytes(&self) -> u64 {
        any!(self, lowered => lowered.preparation_bytes())
    }
}
