//! Views and their scan lines through the C interface: the bits of Rust, and a code for whatever is wrong.

use crate::common::{self, hard_surfaces};
use crate::errors::{model, name, off, off_mut};
use crate::lent::{Prepared, WORDS};
use crate::lent_lines::{Arguments, Views};
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use crate::same_bits::{START, fold, hit_in_c, words};
use core::ptr::{null, null_mut};
use patchray::capi::*;
use patchray::limits::{GaveUp, Limits, Work};
use patchray::line::Window;
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::view::Camera;
use patchray_host::scene::model::Model;

/// A picture of as many rows as columns: the ray of a row and a column.
#[derive(Clone, Copy)]
struct Picture {
    side: u32,
    /// Every which row is traced.
    every: usize,
    /// Eye, forward, right and up.
    camera: [[f64; 3]; 4],
}

const HARD: Picture =
    Picture { side: 24, every: 4, camera: [[0.4, -3.0, 2.5], [0.0, 3.0, -2.2], [1.5, 0.1, 0.0], [0.0, 1.0, 1.3]] };

/// That of `methods.c`: all its numbers are exact.
const TEAPOT: Picture = Picture {
    side: 64,
    every: 1,
    camera: [[7.6171875, -9.3203125, 7.59375], [-222.75, 297.0, -198.0], [68.0, 51.0, 0.0], [-24.0, 32.0, 75.0]],
};

impl Picture {
    fn camera<S: Scalar>(&self) -> patchray_camera<S> {
        let [eye, forward, right, up] = self.camera.map(|vector| vector.map(S::from_f64));
        patchray_camera { eye, forward, right, up }
    }

    /// A column's x; a row's y is that of the column with its number, from the other end.
    fn x<S: Scalar>(&self, column: u32) -> S {
        S::from_f64((f64::from(2 * column + 1) - f64::from(self.side)) / f64::from(self.side))
    }

    fn rows(self) -> impl Iterator<Item = u32> {
        (0..self.side).step_by(self.every)
    }

    fn y<S: Scalar>(&self, row: u32) -> S {
        -self.x::<S>(row)
    }
}

/// A view, and all that tracing a line of it takes.
struct Seen<S> {
    picture: Picture,
    prepared: Prepared<S>,
    view: patchray_view<S>,
    line: patchray_line<S>,
    places: Vec<S>,
    line_memory: patchray_line_memory<S>,
    /// Words of 8 bytes, so that all is aligned.
    memory: Vec<u64>,
    hits: Vec<patchray_hit<S>>,
    codes: Vec<i32>,
    works: Vec<patchray_work>,
    _lent: Vec<Vec<u64>>,
}

fn take<T>(lent: &mut Vec<Vec<u64>>, count: usize, fill: u64) -> *mut T {
    lent.push(vec![fill; (count * size_of::<T>()).div_ceil(8)]);
    lent.last_mut().map_or(null_mut(), |words| words.as_mut_ptr().cast())
}

fn lend<S>(memory: &mut patchray_view_memory<S>, lent: &mut Vec<Vec<u64>>) {
    memory.points = take(lent, memory.points_len, u64::MAX);
    memory.surfaces = take(lent, memory.surfaces_len, u64::MAX);
    memory.patches = take(lent, memory.patches_len, u64::MAX);
    memory.sights = take(lent, memory.sights_len, u64::MAX);
    memory.runs = take(lent, memory.runs_len, u64::MAX);
    memory.first_runs = take(lent, memory.first_runs_len, u64::MAX);
}

fn no_memory<S>() -> patchray_view_memory<S> {
    // SAFETY: null addresses and counts of 0.
    unsafe { core::mem::zeroed() }
}

impl<S: Scalar> Seen<S> {
    /// `None` if the scene cannot be traced as this view.
    fn of<P: Views<Scalar = S>>(model: &Model, picture: Picture) -> Option<Self> {
        let (camera, rays) = (picture.camera(), picture.side as usize);
        let prepared = Prepared::of::<P>(model);
        let (mut memory, mut lent) = (no_memory(), Vec::new());
        // SAFETY: all zeros is a table of no library.
        let mut view = unsafe { core::mem::zeroed() };
        // SAFETY: addresses of memory as large as said, here and below.
        let code = unsafe { P::VIEW(&prepared.scene, &prepared.patches, &camera, &mut memory, &mut view) };
        if code == PATCHRAY_CAMERA_FAR {
            return None;
        }
        assert_eq!(name(code), name(PATCHRAY_MEMORY));
        lend(&mut memory, &mut lent);
        assert_eq!(
            unsafe { P::VIEW(&prepared.scene, &prepared.patches, &camera, &mut memory, &mut view) },
            PATCHRAY_OK
        );
        let seen = view.patches.patches_len;
        let slots = model.surfaces.len() * size_of::<patchray_followed<S>>();
        let line_memory = patchray_line_memory {
            spans: take(&mut lent, seen, 0),
            spans_len: seen,
            active: take(&mut lent, seen, 0),
            active_len: seen,
            buckets: take(&mut lent, 64, 0),
            buckets_len: 64,
        };
        Some(Seen {
            picture,
            view,
            line: patchray_line {
                places: null(),
                places_len: 2 * rays,
                x: [S::ZERO; 2],
                y: [S::ZERO; 2],
                t_min: S::ZERO,
                t_max: S::from_f64(1e30),
                number: 0,
            },
            places: Vec::new(),
            line_memory,
            memory: vec![0; slots.div_ceil(8)],
            hits: vec![prepared.hit; rays],
            codes: vec![77; rays],
            works: vec![prepared.work; rays],
            prepared,
            _lent: lent,
        })
    }

    /// What a right call for a row takes.
    fn row(&mut self, row: u32) -> Arguments<S> {
        let (picture, y) = (self.picture, self.picture.y(row));
        self.places = (0..picture.side).flat_map(|column| [picture.x(column), y]).collect();
        self.line.places = self.places.as_ptr();
        (self.line.x, self.line.y) = ([picture.x(0), picture.x(picture.side - 1)], [y; 2]);
        self.line.number = row;
        Arguments {
            view: &raw const self.view,
            line: &raw const self.line,
            line_memory: &raw mut self.line_memory,
            memory: self.memory.as_mut_ptr().cast(),
            memory_len: self.prepared.surfaces(),
            limits: null(),
            scratch: self.prepared.scratch.as_mut_ptr(),
            words: WORDS,
            hits: self.hits.as_mut_ptr(),
            codes: self.codes.as_mut_ptr(),
            works: self.works.as_mut_ptr(),
        }
    }
}

/// What one ray came to.
type Answer<S> = (i32, Option<patchray_hit<S>>, [u32; Work::COUNT]);

/// The methods, in the order of [`Views::LINES`].
const METHODS: [InView; 2] = [InView::ClippingPredicted, InView::NewtonPredicted];

/// The same rays in Rust.
fn in_rust<P: Views>(
    prepared: &common::Prepared<P>,
    picture: Picture,
    method: usize,
    mut each: impl FnMut(Answer<P::Scalar>),
) {
    let patchray_camera { eye, forward, right, up } = picture.camera();
    let camera = Camera { eye, forward, right, up };
    let mut room = ViewRoom::for_view(prepared, &camera).expect("there is one in C");
    let view = room.build(prepared, &camera).expect("as was asked for");
    let (mut lines, mut thread) = (LineRoom::for_any(prepared, 64), Thread::<P>::new(prepared.surfaces.len()));
    let interval = Interval::new(P::Scalar::ZERO, P::Scalar::from_f64(1e30)).expect("it is one");
    for row in picture.rows() {
        let y = picture.y(row);
        let window = Window { x: [picture.x(0), picture.x(picture.side - 1)], y: [y; 2] };
        let mut line = lines.line(&view, window).expect("there is memory for any");
        thread.last = u32::MAX;
        for column in 0..picture.side {
            let Ok(ray) = view.ray([picture.x(column), y], &interval) else {
                each((PATCHRAY_RAY_OUT_OF_VIEW, None, [0; Work::COUNT]));
                continue;
            };
            let (code, hit) = match thread.trace(METHODS[method], &view, &mut line, row, &ray, &Limits::default()) {
                Ok(hit) => (i32::from(hit.is_some()), hit),
                Err(GaveUp { best, .. }) => (-1, best),
            };
            each((code, hit.map(hit_in_c), thread.work.counts()));
        }
    }
}

/// What a picture's rays come to through the C interface, by a method.
fn in_c<P: Views>(seen: &mut Seen<P::Scalar>, method: usize) -> Vec<Answer<P::Scalar>> {
    let mut answers = Vec::new();
    // The next method's memory is of other slots.
    seen.memory.fill(0);
    for row in seen.picture.rows() {
        // SAFETY: a right call.
        assert_eq!(unsafe { (P::LINES[method])(&seen.row(row)) }, PATCHRAY_OK);
        for ((hit, &code), work) in seen.hits.iter().zip(&seen.codes).zip(&seen.works) {
            let found = hit.surface != PATCHRAY_NO_SURFACE;
            // SAFETY: as many numbers of 32 bits.
            let counts = unsafe { core::mem::transmute::<patchray_work, [u32; Work::COUNT]>(*work) };
            let code = if code <= PATCHRAY_GAVE_UP_SURFACES { -1 } else { code };
            answers.push((code, found.then_some(*hit), counts));
        }
    }
    answers
}

/// Compares both methods; how many hits there were. None if the scene cannot be traced as one view.
fn agree<P: Views>(name: &str, model: &Model, picture: Picture) -> usize {
    let prepared = common::Prepared::<P>::of(model);
    let mut hits = 0;
    let Some(mut seen) = Seen::of::<P>(model, picture) else {
        return 0;
    };
    for method in 0..METHODS.len() {
        let mut answers = in_c::<P>(&mut seen, method).into_iter();
        in_rust::<P>(&prepared, picture, method, |answer| {
            hits += usize::from(answer.1.is_some());
            assert_eq!(Some(answer), answers.next(), "{name}, method {method}");
        });
        assert_eq!(answers.next(), None);
    }
    hits
}

#[test]
fn scan_lines_have_the_answers_of_rust() {
    let mut hits = 0;
    for (name, model) in hard_surfaces() {
        if !common::is_rational(&model) {
            hits += agree::<Plain<f32>>(name, &model, HARD) + agree::<Plain<f64>>(name, &model, HARD);
        }
        hits += agree::<Weighted<f32>>(name, &model, HARD) + agree::<Weighted<f64>>(name, &model, HARD);
    }
    assert!(hits > 1000, "{hits}");
}

/// The lines of `methods.c` that tell of scan lines.
pub(crate) fn lines<P: Views>(model: &Model, precision: &str, out: &mut String) {
    const NAMES: [&str; 2] = ["clipping-predicted", "newton-predicted"];
    agree::<P>("the teapot", model, TEAPOT);
    let mut seen = Seen::of::<P>(model, TEAPOT).expect("the teapot is near");
    for (method, name) in NAMES.into_iter().enumerate() {
        let answers = in_c::<P>(&mut seen, method);
        let (mut hash, hits) = (START, answers.iter().filter(|answer| answer.1.is_some()).count());
        for (code, hit, counts) in answers {
            fold(&mut hash, [code as u32].into_iter().chain(words(hit)).chain(counts));
        }
        *out += &format!("{name}-line {precision} {hits} {hash:x}\n");
    }
}

/// A view that holds less than its rays need says so ray by ray; and what a call is not given, it does not write.
#[test]
fn lines_refuse_what_is_wrong() {
    fn check<P: Views>() {
        let mut seen = Seen::of::<P>(&model(), HARD).expect("it is near");
        let nan = P::Scalar::from_f64(f64::NAN);
        for (number, call) in P::LINES.iter().enumerate() {
            let newton = number == 1;
            let (view, line, line_memory) = (seen.view, seen.line, seen.line_memory);
            let mut refused =
                |code: i32, what: &str, spoil: &dyn Fn(&mut Seen<P::Scalar>, &mut Arguments<P::Scalar>)| {
                    seen.codes.fill(77);
                    let mut arguments = seen.row(12);
                    spoil(&mut seen, &mut arguments);
                    // SAFETY: spoilt as little as the interface says that it sees.
                    let got = unsafe { call(&arguments) };
                    assert_eq!(name(got), name(code), "line {number} with {what}");
                    assert!(code >= 0 || seen.codes.iter().all(|&code| code == 77), "line {number} with {what} wrote");
                    (seen.view, seen.line, seen.line_memory) = (view, line, line_memory);
                };
            refused(PATCHRAY_OK, "nothing wrong", &|_, _| {});
            refused(PATCHRAY_OK, "no room for work", &|_, a| a.works = null_mut());
            refused(PATCHRAY_OK, "no rays", &|s, a| {
                (s.line.places_len, s.line.places) = (0, null());
                (a.hits, a.codes) = (null_mut(), null_mut());
            });
            refused(PATCHRAY_NULL, "no view", &|_, a| a.view = null());
            refused(PATCHRAY_NULL, "no line", &|_, a| a.line = null());
            refused(PATCHRAY_NULL, "no memory for a line", &|_, a| a.line_memory = null_mut());
            refused(PATCHRAY_NULL, "no scratch", &|_, a| a.scratch = null_mut());
            refused(PATCHRAY_NULL, "no hits", &|_, a| a.hits = null_mut());
            refused(PATCHRAY_NULL, "no codes", &|_, a| a.codes = null_mut());
            refused(PATCHRAY_NULL, "no places", &|s, _| s.line.places = null());
            refused(PATCHRAY_NULL, "no spans", &|s, _| s.line_memory.spans = null_mut());
            refused(PATCHRAY_MISALIGNED, "a misaligned view", &|_, a| a.view = off(a.view));
            refused(PATCHRAY_MISALIGNED, "a misaligned line", &|_, a| a.line = off(a.line));
            refused(PATCHRAY_MISALIGNED, "misaligned codes", &|_, a| a.codes = off_mut(a.codes));
            refused(PATCHRAY_MISALIGNED, "misaligned works", &|_, a| a.works = off_mut(a.works));
            refused(PATCHRAY_MISALIGNED, "misaligned places", &|s, _| s.line.places = off(s.line.places));
            refused(PATCHRAY_MISALIGNED, "misaligned buckets", &|s, _| {
                s.line_memory.buckets = off_mut(s.line_memory.buckets);
            });
            refused(PATCHRAY_COUNT, "endless places", &|s, _| s.line.places_len = usize::MAX);
            refused(PATCHRAY_COUNT, "endless spans", &|s, _| s.line_memory.spans_len = usize::MAX);
            refused(PATCHRAY_OVERLAP, "codes over the hits", &|_, a| a.codes = a.hits.cast());
            refused(PATCHRAY_OVERLAP, "works in the scratch", &|_, a| a.works = a.scratch.cast());
            refused(PATCHRAY_OVERLAP, "hits over the places", &|s, a| a.hits = s.line.places.cast_mut().cast());
            refused(PATCHRAY_OVERLAP, "spans over the patches", &|s, _| {
                s.line_memory.spans = s.view.patches.patches.cast_mut().cast();
            });
            refused(PATCHRAY_OVERLAP, "active over buckets", &|s, _| s.line_memory.active = s.line_memory.buckets);
            refused(PATCHRAY_OVERLAP, "scratch over the points", &|s, a| {
                a.scratch = s.view.scene.points.cast_mut().cast()
            });
            refused(PATCHRAY_OVERLAP, "scratch over the runs", &|s, a| a.scratch = s.view.runs.cast_mut().cast());
            for bit in 0..32 {
                refused(PATCHRAY_LAYOUT_DIFFERS, "a view made otherwise", &|s, _| s.view.layout ^= 1 << bit);
            }
            refused(PATCHRAY_LAYOUT_DIFFERS, "a scene made otherwise", &|s, _| s.view.scene.layout = s.view.layout);
            refused(PATCHRAY_NULL, "no sights", &|s, _| s.view.sights = null());
            refused(PATCHRAY_MISALIGNED, "misaligned surfaces", &|s, _| s.view.surfaces = off(s.view.surfaces));
            refused(PATCHRAY_MEMORY, "too few spans", &|s, _| s.line_memory.spans_len = 0);
            refused(PATCHRAY_MEMORY, "too few of the active", &|s, _| s.line_memory.active_len = 0);
            refused(PATCHRAY_MEMORY, "no bucket", &|s, _| s.line_memory.buckets_len = 0);
            refused(PATCHRAY_SCRATCH, "no word", &|_, a| a.words = 0);
            let few = if newton { PATCHRAY_NEWTON_CUBIC_WORDS_F32 } else { PATCHRAY_CLIP_CUBIC_WORDS_F32 };
            refused(PATCHRAY_SCRATCH, "few words", &|_, a| a.words = few / 2);
            refused(PATCHRAY_RAY_INTERVAL, "t_min of NaN", &|s, _| s.line.t_min = nan);
            refused(PATCHRAY_OPTION, "an x of NaN", &|s, _| s.line.x[0] = nan);
            refused(PATCHRAY_OPTION, "an x without y", &|s, _| s.line.places_len -= 1);
            refused(PATCHRAY_OPTION, "the number of no line", &|s, _| s.line.number = u32::MAX);
            refused(PATCHRAY_OPTION, "rows upside down", &|s, _| {
                s.line.y = [P::Scalar::ONE, -P::Scalar::ONE];
            });
            refused(PATCHRAY_NULL, "no coherence memory", &|_, a| a.memory = null_mut());
            refused(PATCHRAY_MISALIGNED, "misaligned memory", &|_, a| a.memory = off_mut(a.memory));
            refused(PATCHRAY_OVERLAP, "memory over the scratch", &|_, a| a.memory = a.scratch.cast());
            refused(PATCHRAY_MEMORY, "a slot less than surfaces", &|_, a| a.memory_len -= 1);
            // What is wrong with a ray is its own.
            let mut of_rays = |code: i32, spoil: &dyn Fn(&mut Seen<P::Scalar>)| {
                let arguments = seen.row(12);
                spoil(&mut seen);
                // SAFETY: a right call.
                assert_eq!(unsafe { call(&arguments) }, PATCHRAY_OK);
                assert_eq!(name(seen.codes[5]), name(code), "line {number}");
                assert_eq!(seen.hits[5].surface, PATCHRAY_NO_SURFACE);
                (seen.view, seen.line, seen.line_memory) = (view, line, line_memory);
            };
            of_rays(PATCHRAY_RAY_OUT_OF_VIEW, &|s| s.places[10] = P::Scalar::from_f64(1e3));
            of_rays(PATCHRAY_RAY_NAN, &|s| s.places[11] = nan);
            of_rays(PATCHRAY_RAY_INFINITE, &|s| s.places[10] = -P::Scalar::INFINITY);
            of_rays(PATCHRAY_RAY_OUT_OF_LINE, &|s| s.line.x[0] = P::Scalar::ZERO);
        }
    }
    check::<Plain<f32>>();
    check::<Weighted<f32>>();
    check::<Plain<f64>>();
    check::<Weighted<f64>>();
}

#[test]
fn views_refuse_wrong_memory_and_cameras() {
    fn check<P: Views>() {
        let prepared = Prepared::<P::Scalar>::of::<P>(&model());
        let (scene, patches) = (&raw const prepared.scene, &raw const prepared.patches);
        let build = |memory: &mut patchray_view_memory<P::Scalar>, scene, patches, camera: *const _| {
            // SAFETY: all zeros is a table of no library.
            let mut view = unsafe { core::mem::zeroed() };
            // SAFETY: memory as large as said, or refused.
            unsafe { P::VIEW(scene, patches, camera, memory, &mut view) }
        };
        let (mut needs, mut lent) = (no_memory::<P::Scalar>(), Vec::new());
        assert_eq!(build(&mut needs, scene, patches, &HARD.camera()), PATCHRAY_MEMORY);
        lend(&mut needs, &mut lent);
        let spoilt = |code: i32, spoil: &dyn Fn(&mut patchray_view_memory<P::Scalar>)| {
            let mut memory = needs;
            spoil(&mut memory);
            assert_eq!(name(build(&mut memory, scene, patches, &HARD.camera())), name(code));
            if code == PATCHRAY_MEMORY {
                assert_eq!([memory.points_len, memory.sights_len], [needs.points_len, needs.sights_len]);
            }
        };
        spoilt(PATCHRAY_OK, &|_| {});
        spoilt(PATCHRAY_MEMORY, &|memory| memory.points_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.surfaces_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.patches_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.sights_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.runs_len -= 1);
        spoilt(PATCHRAY_MEMORY, &|memory| memory.first_runs_len -= 1);
        spoilt(PATCHRAY_NULL, &|memory| memory.sights = null_mut());
        spoilt(PATCHRAY_MISALIGNED, &|memory| memory.runs = off_mut(memory.runs));
        spoilt(PATCHRAY_COUNT, &|memory| memory.first_runs_len = usize::MAX);
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.sights = memory.patches.cast());
        // SAFETY: the scene is there.
        spoilt(PATCHRAY_OVERLAP, &|memory| memory.points = unsafe { (*scene).points }.cast_mut());
        let right = HARD.camera::<P::Scalar>();
        let of_camera = |code: i32, spoil: &dyn Fn(&mut patchray_camera<P::Scalar>)| {
            let (mut memory, mut camera) = (needs, right);
            spoil(&mut camera);
            assert_eq!(name(build(&mut memory, scene, patches, &camera)), name(code));
        };
        let [nan, far] = [f64::NAN, 1e4].map(P::Scalar::from_f64);
        of_camera(PATCHRAY_RAY_NAN, &|camera| camera.eye[1] = nan);
        of_camera(PATCHRAY_RAY_NAN, &|camera| camera.up[2] = nan);
        of_camera(PATCHRAY_RAY_DIRECTION, &|camera| camera.forward = [P::Scalar::ZERO; 3]);
        of_camera(PATCHRAY_CAMERA_FLAT, &|camera| camera.up = camera.right);
        of_camera(PATCHRAY_CAMERA_FAR, &|camera| camera.eye[0] = far);
        let mut memory = needs;
        assert_eq!(build(&mut memory, null(), patches, &right), PATCHRAY_NULL);
        assert_eq!(build(&mut memory, scene, off(patches), &right), PATCHRAY_MISALIGNED);
        assert_eq!(build(&mut memory, scene, patches, null()), PATCHRAY_NULL);
        // Surfaces without patches would be seen by no ray.
        let fewer = patchray_patches { first_len: prepared.patches.first_len - 1, ..prepared.patches };
        assert_eq!(name(build(&mut memory, scene, &raw const fewer, &right)), "PATCHRAY_TABLES");
        assert_eq!(build(&mut memory, scene, null(), &right), PATCHRAY_NULL);
    }
    check::<Plain<f32>>();
    check::<Weighted<f32>>();
    check::<Plain<f64>>();
    check::<Weighted<f64>>();
}
