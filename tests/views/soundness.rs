//! No line leaves out a patch that a ray of it meets: a span too narrow by rounding is a hole that no later step mends.
//!
//! Rays through known points of patches, corners and borders among them; and each patch that the line of the whole image leads
//! to. `PATCHRAY_RAYS=N` traces N rays per case and precision.

use crate::cameras::{cameras, inside, scaled};
use crate::common::{Kind, Prepared, add, cross, dot, index, is_rational};
use crate::corpus::{Case, cases};
use crate::judging::rays_per_case;
use crate::rooms::{InView, LineRoom, Thread, ViewRoom};
use patchray::bernstein::Basis;
use patchray::limits::Limits;
use patchray::line::{Line, Window};
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::story::Event;
use patchray::subdivide::Subdivision;
use patchray::told::{Listener, Told};
use patchray::view::{Camera, View, ViewRay};
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::shapes::Random;
use rayon::prelude::*;
use std::cell::RefCell;

/// Rays per case and precision, unless the environment says otherwise.
const RAYS: usize = 3_000;

/// What became of the rays of a case.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    rays: usize,
    /// Patches that rays were led to.
    led: usize,
    /// Patches that the line of the whole image leads rays to, but their own lines do not.
    left_out: usize,
    /// Rays through a point of a patch whose line does not lead to that patch.
    refused: usize,
}

/// A part of a surface's domain: the least and the largest u, then v.
type Sides = [[f64; 2]; 2];

thread_local! {
    static MET: RefCell<Vec<Sides>> = const { RefCell::new(Vec::new()) };
}

/// Notes the patches that are met.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct Ear;

impl Listener for Ear {
    fn hear(event: Event) {
        if let Event::Patch { sides, met: true } = event {
            MET.with_borrow_mut(|all| all.push(sides));
        }
    }
}

/// The patches that a line leads a ray to and whose boxes the ray meets, each told by where it lies in its surface.
fn led<P: Kind>(
    thread: &mut Thread<P>,
    view: &View<'_, P>,
    line: &mut Line<'_, P::Scalar>,
    ray: &ViewRay<P::Scalar>,
) -> Vec<Sides> {
    let limits = Limits { spans: u32::MAX, ..Limits::default() };
    MET.take();
    // All lies before the ray's interval, so that nothing is found, and no patch is left out for being behind it.
    assert_eq!(thread.trace(InView::NewtonPredicted, view, line, 0, ray, &limits), Ok(None));
    MET.take()
}

/// The place of a point in a camera's image, which may be wider than ±1, if the point lies before the eye.
fn place(camera: &Camera<f64>, point: [f64; 3]) -> Option<[f64; 2]> {
    let Camera { eye, forward, right, up } = *camera;
    let from_eye = add(point, -1.0, eye);
    let volume = dot(forward, cross(right, up));
    let depth = dot(from_eye, cross(right, up)) / volume;
    let [x, y] = [cross(up, forward), cross(forward, right)].map(|row| dot(from_eye, row) / volume / depth);
    (depth > 0.0).then_some([x, y])
}

/// The rows in which a surface's control points lie, if all do before the eye. Boxes of patches reach farther, and may be met
/// where no surface is: what a line leaves out there is no loss.
fn rows_of(camera: &Camera<f64>, surface: &ModelSurface) -> [f64; 2] {
    surface.points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &[x, y, z, _]| {
        match place(camera, [x, y, z]) {
            Some([_, y]) => [low.min(y), high.max(y)],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        }
    })
}

fn shoot<P: Kind>(case: &Case) -> Count {
    let options = Subdivision { flatness: P::Scalar::from_f64(0.004), ..Subdivision::default() };
    let prepared = Prepared::<P>::new(&case.model, 1.0, &options);
    let surfaces = &case.model.surfaces;
    let all: Vec<_> = cameras(surfaces).into_iter().chain(inside(surfaces)).enumerate().collect();
    let each = rays_per_case(RAYS) / all.len();
    let of_camera = |&(seed, named): &(usize, crate::cameras::Named)| {
        let camera = scaled::<P::Scalar>(&named.camera, 1.0);
        let mut room = ViewRoom::for_view(&prepared, &camera).unwrap();
        let view = room.build(&prepared, &camera).unwrap();
        let mut random = Random(seed as u64);
        let (mut basis, mut line_room) = (Basis::<P::Scalar, 16>::new(), LineRoom::for_any(&prepared, 1 + seed * 30));
        let unscale = -prepared.scene().frame().exponent();
        let rows: Vec<_> = surfaces.iter().map(|surface| rows_of(&named.camera, surface)).collect();
        let all = [P::Scalar::LEAST, P::Scalar::INFINITY];
        let mut image_room = LineRoom::for_any(&prepared, 1);
        let mut image = image_room.line(&view, Window { x: all, y: all }).unwrap();
        let behind_all = Interval::new(P::Scalar::from_f64(1e6), P::Scalar::INFINITY).unwrap();
        let mut thread = Thread::new(surfaces.len());
        let mut count = Count::default();
        for _ in 0..each {
            let surface = index(&mut random, surfaces.len());
            let patches = prepared.patches();
            let of_surface = patches.of_surface(surface).unwrap();
            let patch = &of_surface[index(&mut random, of_surface.len())];
            let [u, v] = patch.domain().bounds::<P::Scalar>().map(|[low, high]| {
                let share = [0.0, 1.0, random.within(0.0, 1.0), random.within(0.0, 1.0)][index(&mut random, 4)];
                low + (high - low) * P::Scalar::from_f64(share)
            });
            let net = prepared.scene().surface(surface).unwrap().net;
            let point = net.position(u, v, &mut basis.view()).unwrap();
            let point = point.map(|c| c.times_power_of_two(unscale).to_f64());
            let Some(place) = place(&named.camera, point).filter(|p| p.iter().all(|c| c.abs() <= 1.0)) else {
                continue;
            };
            let place = place.map(P::Scalar::from_f64);
            let Ok(ray) = view.ray(place, &behind_all) else { continue };
            let wide = P::Scalar::from_f64(random.within(0.0, 0.01));
            let x = if index(&mut random, 2) == 0 { [place[0]; 2] } else { [-P::Scalar::ONE, P::Scalar::ONE] };
            let window = Window { x, y: [place[1] - wide, place[1] + wide] };
            let mut line = line_room.line(&view, window).unwrap();
            let found = led(&mut thread, &view, &mut line, &ray);
            count.rays += 1;
            count.led += found.len();
            count.refused += usize::from(!found.contains(&patch.domain().bounds()));
            // No loss if it is of a surface that is not seen here.
            let unseen = |sides: &Sides| {
                let mut of = rows
                    .iter()
                    .enumerate()
                    .filter(|(_, [low, high])| !(*low <= window.y[1].to_f64() && window.y[0].to_f64() <= *high));
                of.any(|(k, _)| {
                    patches.of_surface(k).unwrap().iter().any(|patch| patch.domain().bounds::<f64>() == *sides)
                })
            };
            let in_image = led(&mut thread, &view, &mut image, &ray);
            count.left_out += in_image.iter().filter(|sides| !found.contains(sides) && !unseen(sides)).count();
        }
        count
    };
    all.par_iter().map(of_camera).reduce(Count::default, |a, b| Count {
        rays: a.rays + b.rays,
        led: a.led + b.led,
        left_out: a.left_out + b.left_out,
        refused: a.refused + b.refused,
    })
}

#[test]
fn no_line_leaves_out_what_a_ray_meets() {
    for case in cases() {
        let [of_f32, of_f64] = if is_rational(&case.model) {
            [shoot::<Weighted<Told<f32, Ear>>>(&case), shoot::<Weighted<Told<f64, Ear>>>(&case)]
        } else {
            [shoot::<Plain<Told<f32, Ear>>>(&case), shoot::<Plain<Told<f64, Ear>>>(&case)]
        };
        println!("{}: f32 {of_f32:?}, f64 {of_f64:?}", case.name);
        for count in [of_f32, of_f64] {
            assert!(count.rays * 4 > rays_per_case(RAYS), "{}: {count:?}", case.name);
            assert_eq!((count.refused, count.left_out), (0, 0), "{}: {count:?}", case.name);
        }
    }
}
