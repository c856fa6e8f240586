//! The methods: one ray of a call, from addresses to an answer.

use super::lend::{Lending, Place, Room};
use super::status::*;
use super::types::*;
use super::{scratch, tables};
use crate::bernstein::Basis;
use crate::limits::{GaveUp, Limits, Work};
use crate::method::{clipping, clipping_coherent, newton, newton_coherent};
use crate::point::Point;
use crate::ray::{Hit, Incidence, Interval, Ray};
use crate::scalar::Scalar;
use crate::scene::Scene;
use heapless::Vec;

impl<S: Scalar> From<Option<Hit<S>>> for patchray_hit<S> {
    #[inline(always)]
    fn from(hit: Option<Hit<S>>) -> Self {
        match hit {
            Some(Hit { t, u, v, surface, incidence }) => patchray_hit { t, u, v, surface, incidence: incidence as u32 },
            None => patchray_hit {
                t: S::ZERO,
                u: S::ZERO,
                v: S::ZERO,
                surface: PATCHRAY_NO_SURFACE,
                incidence: PATCHRAY_CROSSING,
            },
        }
    }
}

/// What a call is asked, whatever the method.
struct Asked<'c, P: Point> {
    scene: Scene<'c, P>,
    ray: Ray<P::Scalar>,
    interval: Interval<P::Scalar>,
    limits: Limits<P::Scalar>,
    work: Option<Place<patchray_work>>,
}

impl<P: Point> Asked<'_, P> {
    /// # Safety
    /// As for [`clipping_closest`].
    #[inline(always)]
    unsafe fn of(
        lending: &mut Lending,
        scene: *const patchray_scene<P::Scalar>,
        ray: *const patchray_ray<P::Scalar>,
        limits: *const patchray_limits<P::Scalar>,
        work: *mut patchray_work,
    ) -> Result<Self, Code> {
        let work = lending.place_if_any(work)?;
        // SAFETY: the caller's.
        let ray = unsafe { lending.read(ray) }?;
        // SAFETY: the caller's.
        let limits = unsafe { lending.read_if_any(limits) }?;
        let limits = limits.map_or(Ok(Limits::default()), |limits| limits.checked())?;
        // SAFETY: the caller's.
        let scene = unsafe { tables::scene::<P>(lending, scene) }?;
        let interval = Interval::new(ray.t_min, ray.t_max).ok_or(PATCHRAY_RAY_INTERVAL)?;
        let ray = scene.ray(ray.origin, ray.direction).map_err(of_ray)?;
        Ok(Asked { scene, ray, interval, limits, work })
    }

    /// Writes what was found and done.
    ///
    /// # Safety
    /// As for [`clipping_closest`].
    #[inline(always)]
    unsafe fn answer(
        &self,
        found: Result<Option<Hit<P::Scalar>>, GaveUp<P::Scalar>>,
        place: &Place<patchray_hit<P::Scalar>>,
        work: Work,
    ) -> Code {
        let (hit, code) = code_of(found);
        // SAFETY: the caller's.
        unsafe { place.set(hit) };
        if let Some(place) = &self.work {
            // SAFETY: the caller's.
            unsafe { place.set(work.into()) };
        }
        code
    }
}

/// What a ray came to, in the words of the C interface.
#[inline(always)]
pub(super) fn code_of<S: Scalar>(found: Found<S>) -> (patchray_hit<S>, Code) {
    match found {
        Ok(Some(hit)) => (Some(hit).into(), PATCHRAY_HIT),
        Ok(None) => (None.into(), PATCHRAY_MISS),
        Err(GaveUp { limit, best }) => (best.into(), of_limit(limit)),
    }
}

pub(super) type Found<S> = Result<Option<Hit<S>>, GaveUp<S>>;
type WithTree<S> = (*const patchray_scene<S>, *const patchray_patches<S>, *const patchray_tree<S>);
type WithGrids<S> = (*const patchray_scene<S>, *const patchray_patches<S>, *const patchray_grids<S>);
type Out<S> = (*mut patchray_hit<S>, *mut patchray_work);

/// A call: makes sure of all memory, that of `tables`, which are of so many surfaces, last, before any is written; `room`
/// makes its scratch of words.
///
/// # Safety
/// As for [`clipping_closest`].
#[inline(always)]
unsafe fn with<P: Point, T, R>(
    scene: *const patchray_scene<P::Scalar>,
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    (words, words_len): (*mut u64, usize),
    (hit, work): Out<P::Scalar>,
    tables: impl FnOnce(&mut Lending, usize) -> Result<T, Code>,
    room: impl FnOnce(Room<u64>) -> Result<R, Code>,
    search: impl FnOnce(&Asked<'_, P>, T, &mut R, &mut Work) -> Found<P::Scalar>,
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    let (hit, words) = (lending.place(hit)?, lending.room(words, words_len)?);
    // SAFETY: the caller's.
    let asked = unsafe { Asked::of(&mut lending, scene, ray, limits, work) }?;
    let tables = tables(&mut lending, asked.scene.len())?;
    let mut room = room(words)?;
    let mut done = Work::default();
    let found = search(&asked, tables, &mut room, &mut done);
    // SAFETY: the caller's.
    Ok(unsafe { asked.answer(found, &hit, done) })
}

/// # Safety
/// All addresses that are neither null nor misaligned lead to memory as the counts beside them say, and tables to memory as
/// the counts in them say, which nothing else uses during the call.
#[inline(always)]
pub(super) unsafe fn clipping_closest<P: Point>(
    scene: *const patchray_scene<P::Scalar>,
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    scratch: (*mut u64, usize),
    out: Out<P::Scalar>,
) -> Result<Code, Code> {
    // SAFETY: the caller's.
    unsafe {
        with::<P, _, _>(
            scene,
            ray,
            limits,
            scratch,
            out,
            |_, _| Ok(()),
            |words| scratch::clip::<P>(words),
            |asked, (), room, work| {
                clipping::closest(&asked.scene, &asked.ray, &asked.interval, &asked.limits, room, work)
            },
        )
    }
}

/// # Safety
/// As for [`clipping_closest`].
#[inline(always)]
pub(super) unsafe fn clipping_any<P: Point>(
    scene: *const patchray_scene<P::Scalar>,
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    scratch: (*mut u64, usize),
    out: Out<P::Scalar>,
) -> Result<Code, Code> {
    // SAFETY: the caller's.
    unsafe {
        with::<P, _, _>(
            scene,
            ray,
            limits,
            scratch,
            out,
            |_, _| Ok(()),
            |words| scratch::clip::<P>(words),
            |asked, (), room, work| {
                clipping::any_hit(&asked.scene, &asked.ray, &asked.interval, &asked.limits, room, work)
            },
        )
    }
}

/// # Safety
/// As for [`clipping_closest`].
#[inline(always)]
pub(super) unsafe fn clipping_all<P: Point>(
    scene: *const patchray_scene<P::Scalar>,
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    (words, words_len): (*mut u64, usize),
    (hits, hits_len): (*mut patchray_hit<P::Scalar>, usize),
    (found, work): (*mut usize, *mut patchray_work),
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    let (found, words) = (lending.place(found)?, lending.room(words, words_len)?);
    let hits = lending.room::<_, patchray_hit<P::Scalar>>(hits, hits_len)?;
    // SAFETY: the caller's.
    let asked = unsafe { Asked::<P>::of(&mut lending, scene, ray, limits, work) }?;
    // SAFETY: the caller's.
    let (mut room, hits) = unsafe { (scratch::clip::<P>(words)?, hits.open()) };
    let mut done = Work::default();
    let mut list = Vec::<Hit<P::Scalar>, { PATCHRAY_MAX_HITS as usize }>::new();
    let Asked { scene, ray, interval, limits, work } = &asked;
    let ended = clipping::all_hits(scene, ray, interval, limits, &mut room, &mut list, &mut done);
    for (place, hit) in hits.iter_mut().zip(&list) {
        *place = Some(*hit).into();
    }
    let code = match ended {
        Err(GaveUp { limit, .. }) => of_limit(limit),
        Ok(()) if list.len() > hits.len() => PATCHRAY_GAVE_UP_HITS,
        Ok(()) if list.is_empty() => PATCHRAY_MISS,
        Ok(()) => PATCHRAY_HIT,
    };
    // SAFETY: the caller's.
    unsafe { found.set(list.len().min(hits.len())) };
    if let Some(place) = work {
        // SAFETY: the caller's.
        unsafe { place.set(done.into()) };
    }
    Ok(code)
}

/// # Safety
/// As for [`clipping_closest`].
#[inline(always)]
pub(super) unsafe fn clipping_coherent_closest<P: Point>(
    (scene, patches, grids): WithGrids<P::Scalar>,
    (memory, memory_len, scan_line): (*mut patchray_remembered<P::Scalar>, usize, u32),
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    scratch: (*mut u64, usize),
    out: Out<P::Scalar>,
) -> Result<Code, Code> {
    // SAFETY: the caller's, here and within.
    unsafe {
        let tables = |lending: &mut Lending, surfaces| {
            tables::coherent(lending, (patches, grids), (memory, memory_len, scan_line), surfaces)
        };
        let room = |words| scratch::clip::<P>(words);
        with::<P, _, _>(
            scene,
            ray,
            limits,
            scratch,
            out,
            tables,
            room,
            |asked, (patches, grids, memory), room, work| {
                let Asked { scene, ray, interval, limits, .. } = asked;
                clipping_coherent::closest(
                    scene, &patches, &grids, memory, scan_line, ray, interval, limits, room, work,
                )
            },
        )
    }
}

/// # Safety
/// As for [`clipping_closest`].
#[inline(always)]
pub(super) unsafe fn newton_closest<P: Point>(
    (scene, patches, tree): WithTree<P::Scalar>,
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    scratch: (*mut u64, usize),
    out: Out<P::Scalar>,
) -> Result<Code, Code> {
    // SAFETY: the caller's, here and within.
    unsafe {
        let tables = |lending: &mut Lending, surfaces| tables::in_tree(lending, patches, tree, surfaces);
        let room = |words| scratch::newton::<P>(words);
        with::<P, _, _>(scene, ray, limits, scratch, out, tables, room, |asked, (patches, tree), scratch, work| {
            let Asked { scene, ray, interval, limits, .. } = asked;
            newton::closest(scene, &patches, &tree, ray, interval, limits, scratch, work)
        })
    }
}

/// # Safety
/// As for [`clipping_closest`].
#[inline(always)]
pub(super) unsafe fn newton_any<P: Point>(
    (scene, patches, tree): WithTree<P::Scalar>,
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    scratch: (*mut u64, usize),
    out: Out<P::Scalar>,
) -> Result<Code, Code> {
    // SAFETY: the caller's, here and within.
    unsafe {
        let tables = |lending: &mut Lending, surfaces| tables::in_tree(lending, patches, tree, surfaces);
        let room = |words| scratch::newton::<P>(words);
        with::<P, _, _>(scene, ray, limits, scratch, out, tables, room, |asked, (patches, tree), scratch, work| {
            let Asked { scene, ray, interval, limits, .. } = asked;
            newton::any_hit(scene, &patches, &tree, ray, interval, limits, scratch, work)
        })
    }
}

/// # Safety
/// As for [`clipping_closest`].
#[inline(always)]
pub(super) unsafe fn newton_coherent_closest<P: Point>(
    (scene, patches, grids): WithGrids<P::Scalar>,
    (memory, memory_len, scan_line): (*mut patchray_remembered<P::Scalar>, usize, u32),
    ray: *const patchray_ray<P::Scalar>,
    limits: *const patchray_limits<P::Scalar>,
    scratch: (*mut u64, usize),
    out: Out<P::Scalar>,
) -> Result<Code, Code> {
    // SAFETY: the caller's, here and within.
    unsafe {
        let tables = |lending: &mut Lending, surfaces| {
            tables::coherent(lending, (patches, grids), (memory, memory_len, scan_line), surfaces)
        };
        with::<P, _, _>(
            scene,
            ray,
            limits,
            scratch,
            out,
            tables,
            |words| scratch::newton::<P>(words),
            |asked, (patches, grids, memory), scratch, work| {
                let Asked { scene, ray, interval, limits, .. } = asked;
                newton_coherent::closest(
                    scene, &patches, &grids, memory, scan_line, ray, interval, limits, scratch, work,
                )
            },
        )
    }
}

/// # Safety
/// As for [`clipping_closest`].
pub(super) unsafe fn normal<P: Point>(
    scene: *const patchray_scene<P::Scalar>,
    hit: *const patchray_hit<P::Scalar>,
    normal: *mut [P::Scalar; 3],
) -> Result<Code, Code> {
    let mut lending = Lending::new();
    let place = lending.place(normal)?;
    // SAFETY: the caller's.
    let patchray_hit { t, u, v, surface, .. } = unsafe { lending.read(hit) }?;
    // SAFETY: the caller's.
    let scene = unsafe { tables::scene::<P>(&mut lending, scene) }?;
    if !(u.is_finite() && v.is_finite()) {
        return Err(PATCHRAY_OPTION);
    }
    let mut basis = Basis::<P::Scalar, 16>::new();
    let found = scene.normal(&Hit { t, u, v, surface, incidence: Incidence::Crossing }, &mut basis.view());
    let normal = found.map_err(|GaveUp { limit, .. }| of_limit(limit))?;
    // SAFETY: the caller's.
    unsafe { place.set(normal.unwrap_or([P::Scalar::ZERO; 3])) };
    Ok(PATCHRAY_OK)
}

/// Writes defaults.
///
/// # Safety
/// If `place` is neither null nor misaligned, a `T` can be written there.
pub(super) unsafe fn default_to<T>(place: *mut T, value: T) -> Result<Code, Code> {
    let place = Lending::new().place(place)?;
    // SAFETY: the caller's.
    unsafe { place.set(value) };
    Ok(PATCHRAY_OK)
}
