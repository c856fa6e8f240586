//! Shadow maps: how far a light's rays come before surfaces stop them, drawn as pictures are, along scan lines.
//!
//! Source: L. Williams, "Casting curved shadows on curved surfaces", SIGGRAPH 1978. That the methods for pictures serve to draw
//! them is the paper's remark. Surfaces alone are in a map: polygons, which may reach far beyond it, are few and flat, and
//! a ray is asked whether it meets one.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use serde::Serialize;

use super::face::{Face, TEXEL_BYTES};
use crate::batch::Lanes;
use crate::lower::LowerError;
use crate::scanline::{Tally, row};
use crate::scene::light::MapOptions;
use crate::scene::model::Model;
use crate::scene::trace::Method;
use crate::settings::Settings;
use crate::viewed::{Viewed, Wishes};

/// A light's shadow map.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowMap {
    /// One, or the six of a cube.
    faces: Vec<Face>,
    bias: f64,
}

/// What a shadow map took.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MapUsed {
    /// The light's place in the scene file, from 0.
    pub light: usize,
    /// The width and height of a face in texels.
    pub size: u32,
    /// Its faces: one, or six where the light is among the surfaces or near them.
    pub faces: u32,
    /// The method that drew it.
    pub method: Method,
    /// The rays that it took: one for each texel.
    pub rays: u64,
    /// Those of them that were given up: where they are needed, pixels show it.
    pub gave_up: u64,
    /// The bytes that it takes, once for all threads.
    pub bytes: u64,
    /// Wall-clock seconds to draw it, preparation included.
    pub seconds: f64,
}

impl ShadowMap {
    /// The map of a light at `place`, whose number is `light`, drawn on rayon's current threads by the method of `settings`, or
    /// where that needs a view and there is none, by [`Method::of_any_rays`]. It does not depend on the number of threads. Once
    /// `stop` is set, no further row is drawn.
    ///
    /// # Errors
    /// As [`Viewed::build`].
    pub fn draw(
        model: &Model,
        settings: &Settings,
        (light, place): (usize, [f64; 3]),
        options: MapOptions,
        stop: &AtomicBool,
    ) -> Result<(Self, MapUsed), LowerError> {
        let begin = Instant::now();
        let MapOptions { size, bias } = options;
        let mut faces =
            Face::around(model, place, size).map_or_else(|| Face::cube(model, place, size), |face| vec![face]);
        let mut used = MapUsed {
            light,
            size,
            faces: faces.len() as u32,
            method: settings.method,
            rays: 0,
            gave_up: 0,
            bytes: 0,
            seconds: 0.0,
        };
        for face in faces.iter_mut().take_while(|_| !stop.load(Ordering::Relaxed)) {
            let picture = face.picture();
            let mut viewed = match Viewed::build(model, settings, &picture, Wishes::PRIMARY) {
                Err(LowerError::NoView { .. }) => {
                    used.method = settings.method.of_any_rays();
                    Viewed::build(model, &Settings { method: used.method, ..*settings }, &picture, Wishes::PRIMARY)
                }
                built => built,
            }?;
            let (tracer, _) = viewed.tracer()?;
            let lanes = Lanes::new(tracer.as_ref());
            let tallies = face.draw(|line| {
                let (mut outcomes, mut tally) = (Vec::new(), Tally::default());
                if stop.load(Ordering::Relaxed) {
                    return (Vec::new(), outcomes, tally);
                }
                let (samples, rays) = (picture.scan_line(line), row(&picture, line));
                lanes.with(|lane| lane.trace_line(&samples, &rays, &mut outcomes, &mut tally));
                (rays, outcomes, tally)
            });
            for tally in tallies {
                used.rays += tally.rays;
                used.gave_up += tally.gave_up_in_all();
            }
            used.bytes += TEXEL_BYTES * u64::from(size) * u64::from(size);
        }
        used.seconds = begin.elapsed().as_secs_f64();
        Ok((ShadowMap { faces, bias }, used))
    }

    /// The share of the light, 0 to 1, that no surface keeps from a point, whose surface has this cosine to the light; `None` if
    /// it is not known, since rays of the map were given up. Where a map of one face does not look, nothing is in the way.
    pub fn share(&self, point: [f64; 3], cosine: f64) -> Option<f64> {
        let share = self.faces.iter().find_map(|face| face.share(point, cosine, self.bias)).unwrap_or(1.0);
        (!share.is_nan()).then_some(share)
    }
}
