//! What the interface answers is what Rust answers.

use super::arguments::{ALL_HITS, Prepared, VOXELS};
use crate::common::Kind;
use crate::input::Case;
use crate::lane::{Answer, Lane, Lists, Way};
use crate::lent::{InC, WORDS};
use crate::ready::{Takes, prepare_within};
use crate::scribble::Slot;
use patchray::bernstein::Basis;
use patchray::capi::*;
use patchray::limits::{Acceptance, GaveUp, Limit, Limits};
use patchray::method::Remembered;
use patchray::ray::{Hit, Incidence, Interval};
use patchray::scalar::Scalar;
use std::ffi::CStr;

/// The ways of the functions that find the closest hit, then of those that find any.
const WAYS: [Way; 6] =
    [Way::Clipping, Way::ClippingCoherent, Way::Newton, Way::NewtonCoherent, Way::Clipping, Way::Newton];

impl<P: InC + Kind + Slot> Prepared<P> {
    /// Calls a function with all as it is to be, and asks the same of Rust.
    pub(super) fn as_in_rust(&mut self, case: &Case, function: usize) {
        // SAFETY: options are in their place.
        let subdivision = unsafe { self.subdivision() };
        let way = function.checked_sub(3).and_then(|number| WAYS.get(number).copied());
        let takes = match (function, way) {
            (1, _) => Takes { patches: true, tree: true, grids: false },
            (2, _) => Takes { patches: true, tree: false, grids: true },
            (_, Some(way)) => way.takes(),
            _ => Takes::default(),
        };
        let prepared = prepare_within::<P>(&case.model, &subdivision, VOXELS, takes);
        if let Some((step, code)) = self.stopped {
            let short = code == PATCHRAY_SCRATCH && self.is_short_of(case);
            assert!(short || prepared.is_none(), "preparation {step} is refused in C, by {code}, and not in Rust");
            return;
        }
        let prepared = prepared.expect("it is prepared in C");
        let surfaces = case.model.surfaces.len();
        let mut lane = Lane::<P>::new(surfaces);
        // SAFETY: all is in its place; slots are laid out alike.
        let code = unsafe {
            let memory = self.memory.cast::<Remembered<P::Scalar>>();
            lane.remembered.copy_from_slice(core::slice::from_raw_parts(memory, surfaces));
            self.call(function)
        };
        let numbers = size_of::<P>() / size_of::<P::Scalar>();
        // SAFETY: likewise.
        let (scene, cut, grids) = unsafe { (&*self.scene_memory, &*self.patches_memory, &*self.grids_memory) };
        let tables = [
            (scene.points_len, prepared.points.len() * numbers),
            (scene.surfaces_len, prepared.surfaces.len()),
            (scene.offsets_len, prepared.offsets.len()),
            (scene.references_len, prepared.references.len()),
            (cut.patches_len, prepared.patches.len()),
            (cut.first_len, prepared.first.len()),
            (grids.grids_len, prepared.grids.len()),
            (grids.offsets_len, prepared.grid_offsets.len()),
            (grids.references_len, prepared.grid_references.len()),
        ];
        for (in_c, in_rust) in tables {
            assert!(in_c == in_rust || in_rust == 0, "{tables:?}");
        }
        if function < 3 {
            assert_eq!(code, PATCHRAY_OK);
            return;
        }
        // SAFETY: all is in its place.
        let (ray, limits) = unsafe { (*self.ray, &*self.limits) };
        let scene = prepared.scene();
        if way.is_none() && function != ALL_HITS {
            // SAFETY: likewise.
            let (hit, normal) = unsafe { (&*self.hit, *self.normal) };
            let hit = Hit { t: hit.t, u: hit.u, v: hit.v, surface: hit.surface, incidence: Incidence::Crossing };
            let expected = scene.normal(&hit, &mut Basis::<P::Scalar, 16>::new().view()).map(Option::unwrap_or_default);
            assert_eq!(expected, Ok(normal));
            return;
        }
        let (Ok(in_rust), Some(interval)) = (scene.ray(ray.origin, ray.direction), Interval::new(ray.t_min, ray.t_max))
        else {
            assert!((PATCHRAY_RAY_INTERVAL..=PATCHRAY_RAY_NAN).contains(&code), "{code} for {ray:?}");
            return;
        };
        let limits = limits_in_rust(limits);
        // SAFETY: likewise.
        let (hit, work) = unsafe { (*self.hit, *self.work) };
        let (answer, counted) = match way {
            // Scratch for cubic surfaces does for no others.
            _ if code == PATCHRAY_SCRATCH => {
                assert!(self.is_short_of(case));
                return;
            }
            None => {
                return self.all_hits(lane.all_and_any(Way::Clipping, &prepared, &in_rust, &interval, &limits), code);
            }
            Some(way) if function < 3 + 4 => {
                let answer = lane.closest(way, &prepared, self.scan_line, &in_rust, &interval, &limits);
                (answer, lane.work)
            }
            Some(way) => {
                let lists = lane.all_and_any(way, &prepared, &in_rust, &interval, &limits).expect("it finds any hit");
                (lists.any, lists.work[1])
            }
        };
        assert_eq!(work, patchray_work::from(counted), "{answer:?}");
        is_answered(code, &answer);
        let found = answer.unwrap_or_else(|gave_up| gave_up.best);
        let expected = found.map(in_c);
        assert_eq!((hit.surface != PATCHRAY_NO_SURFACE).then_some(hit), expected);
    }

    /// Whether its scratch is for cubic surfaces, and a surface is not.
    pub(super) fn is_short_of(&self, case: &Case) -> bool {
        case.model.surfaces.iter().any(|surface| surface.degree_u.max(surface.degree_v) > 3)
            && self.scratch_words != WORDS
    }

    fn all_hits(&self, lists: Option<Lists<P::Scalar>>, code: i32) {
        let lists = lists.expect("clipping finds all hits");
        // SAFETY: all is in its place.
        let (hits, found, work) =
            unsafe { (core::slice::from_raw_parts(self.hits, self.hits_len), *self.found, *self.work) };
        let Ok(all) = &lists.all else {
            assert!(code <= PATCHRAY_GAVE_UP_SURFACES, "{code}, {lists:?}");
            return;
        };
        if all.len() > PATCHRAY_MAX_HITS as usize {
            assert_eq!(code, PATCHRAY_GAVE_UP_HITS);
            return;
        }
        assert_eq!(work, patchray_work::from(lists.work[0]));
        let expected = match all.len() {
            count if count > hits.len() => PATCHRAY_GAVE_UP_HITS,
            0 => PATCHRAY_MISS,
            _ => PATCHRAY_HIT,
        };
        assert_eq!((code, found), (expected, all.len().min(hits.len())));
        assert!(hits.iter().zip(all).all(|(hit, other)| *hit == in_c(*other)), "{hits:?}, {all:?}");
    }
}

pub(super) fn in_c<S>(Hit { t, u, v, surface, incidence }: Hit<S>) -> patchray_hit<S> {
    patchray_hit { t, u, v, surface, incidence: incidence as u32 }
}

/// The code says what the answer is.
pub(super) fn is_answered<S: Scalar>(code: i32, answer: &Answer<S>) {
    // SAFETY: it is a string for each code.
    let name = unsafe { CStr::from_ptr(patchray_name(code)) }.to_str().expect("a name");
    match answer {
        Ok(Some(_)) => assert_eq!(code, PATCHRAY_HIT),
        Ok(None) => assert_eq!(code, PATCHRAY_MISS),
        // No budget: the call was wrong.
        Err(GaveUp { limit: Limit::Line, .. }) => assert_eq!(code, PATCHRAY_RAY_OUT_OF_LINE),
        Err(gave_up) => {
            let limit = gave_up.limit.name().replace('-', "_").to_uppercase();
            assert_eq!(name, format!("PATCHRAY_GAVE_UP_{limit}"));
        }
    }
}

pub(super) fn limits_in_rust<S: Scalar>(limits: &patchray_limits<S>) -> Limits<S> {
    Limits {
        newton_iterations: limits.newton_iterations,
        newton_starts: limits.newton_starts,
        newton_halvings: limits.newton_halvings,
        tolerance: limits.tolerance,
        critical_factor: limits.critical_factor,
        acceptance: if limits.acceptance == PATCHRAY_ACCEPTANCE_PROVED {
            Acceptance::Proved
        } else {
            Acceptance::Paper
        },
        clip_threshold: limits.clip_threshold,
        surfaces: limits.surfaces,
        nodes: limits.nodes,
        patches: limits.patches,
        voxels: limits.voxels,
        spans: limits.spans,
        newton_steps: limits.newton_steps,
        clip_steps: limits.clip_steps,
        bisections: limits.bisections,
        pending_domains: limits.pending_domains,
    }
}
