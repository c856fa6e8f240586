use super::*;
use crate::limits::{Limits, Work};
use crate::method::Scratch;
use crate::newton::Solver;
use crate::point::Plain;
use crate::scene::{SceneMemory, SceneOptions, SurfaceSlot};
use crate::surface::Net;

type Points<S> = [Plain<S>; 4];

/// A saddle over the unit square about the origin, as z = x y.
fn saddle<S: Scalar>(scale: f64) -> Points<S> {
    [[-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]
        .map(|p: [f64; 3]| Plain(p.map(|c| S::from_f64(c * scale))))
}

fn with_scene<S: Scalar, R>(points: &Points<S>, with: impl FnOnce(&Scene<'_, Plain<S>>) -> R) -> R {
    let nets = [Net::new(1, 1, points).unwrap()];
    let (mut points, mut surfaces) = ([Plain::EMPTY; 4], [SurfaceSlot::EMPTY; 1]);
    let (mut offsets, mut references) = ([0; 16], [0; 16]);
    let memory = SceneMemory {
        points: &mut points,
        surfaces: &mut surfaces,
        offsets: &mut offsets,
        references: &mut references,
    };
    with(&Scene::build(&nets, &SceneOptions::default(), memory).unwrap())
}

/// Room for a view of one bilinear surface of no patches.
struct Room<S: Scalar>([Plain<S>; 4], [[S; 2]; 1], [u32; 2]);

impl<S: Scalar> Room<S> {
    fn new() -> Self {
        Room([Plain::EMPTY; 4], [[S::ZERO; 2]; 1], [0; 2])
    }

    fn build<'m>(
        &'m mut self,
        scene: &Scene<'m, Plain<S>>,
        camera: &Camera<S>,
    ) -> Result<View<'m, Plain<S>>, ViewError> {
        let Room(points, surfaces, first_runs) = self;
        let (patches, sights, runs) = (&mut [], &mut [], &mut []);
        let memory = ViewMemory { points, surfaces, patches, sights, runs, first_runs };
        View::build(scene, &Patches::new(&[], &[0, 0]), camera, memory)
    }
}

fn camera<S: Scalar>(scale: f64) -> Camera<S> {
    let at = |v: [f64; 3]| v.map(|c| S::from_f64(c * scale));
    // Neither of unit length nor at right angles.
    Camera {
        eye: at([3.0, -4.0, 5.0]),
        forward: at([-3.0, 4.1, -5.0]),
        right: at([1.5, 1.0, 0.3]),
        up: at([-0.2, 1.0, 1.4]),
    }
}

/// Where a ray of the view meets the saddle, and where the ray's point lies by its t.
fn found_and_expected<S: Scalar>(scale: f64, place: [f64; 2]) -> Option<([f64; 3], [f64; 3])> {
    let points = saddle::<S>(scale);
    with_scene(&points, |scene| {
        let (camera, mut room) = (camera::<S>(scale), Room::new());
        let view = room.build(scene, &camera).unwrap();
        let ray = view.ray(place.map(S::from_f64), &Interval::ahead()).unwrap();
        let facing = view.facing(&ray);
        let (limits, mut scratch) = (Limits::default(), Scratch::<Plain<S>, 2, 4>::new());
        let mut scratch = scratch.view();
        let surface = view.surface(0).unwrap();
        let mut solver = Solver::new(&surface, &facing.planes, &limits, scratch.flat, &mut scratch.basis);
        let root = solver.solve([S::HALF; 2], &mut Work::default()).unwrap()?;
        let (t, [x, y]) = (facing.planes.t(root.depth).to_f64(), place);
        let along = |k: usize| {
            let [e, f, r, u] = [camera.eye, camera.forward, camera.right, camera.up].map(|v| v[k].to_f64());
            (e + t * (f + x * r + y * u)) / scale
        };
        let [p, q] = root.at().map(|c| c.to_f64() * 2.0 - 1.0);
        Some(([p, q, p * q], core::array::from_fn(along)))
    })
}

#[test]
fn a_ray_of_a_view_meets_what_the_camera_says_whatever_the_unit() {
    let mut met = 0;
    for place in [[0.0, 0.0], [0.1, -0.05], [-0.13, 0.11], [0.2, 0.2], [-0.9, 0.9]] {
        for scale in [1.0, 1e-20, 1e20] {
            if let Some((found, expected)) = found_and_expected::<f64>(scale, place) {
                assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-11), "{found:?} {expected:?}");
                met += 1;
            }
            if let Some((found, expected)) = found_and_expected::<f32>(scale, place) {
                assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4), "{found:?} {expected:?}");
                met += 1;
            }
        }
    }
    assert!(met >= 18, "{met}");
}

#[test]
fn all_needs_are_told_at_once_and_lending_them_is_enough() {
    with_scene(&saddle::<f64>(1.0), |scene| {
        let nothing = || ViewMemory::<Plain<f64>> {
            points: &mut [],
            surfaces: &mut [],
            patches: &mut [],
            sights: &mut [],
            runs: &mut [],
            first_runs: &mut [],
        };
        let points = [Plain([0.1, 0.2, 0.3]); 4];
        let patch =
            crate::measure::Measure::of(&Net::new(1, 1, &points).unwrap(), 0.0).patch(crate::domain::Domain::WHOLE);
        let (all, first) = ([patch; 17], [0, 17]);
        // Of surfaces without patches a view would see nothing, and say so as a miss.
        for others in [&[0, 17, 17][..], &[0], &[]] {
            let built = View::build(scene, &Patches::new(&all, others), &camera(1.0), nothing());
            assert_eq!(built.err(), Some(ViewError::Patches), "{others:?}");
        }
        let patches = Patches::new(&all, &first);
        match View::build(scene, &patches, &camera(1.0), nothing()) {
            Err(ViewError::Memory(needs)) => {
                let ViewNeeds { points, surfaces, patches, sights, runs, first_runs } = needs;
                let all = [points, surfaces, patches, sights, runs, first_runs].map(|need| need.needed);
                assert_eq!(all, [4, 1, 17, 17, 2, 2]);
            }
            other => panic!("{other:?}"),
        }
    });
}

#[test]
fn cameras_and_rays_that_cannot_be_traced_are_refused_by_name() {
    with_scene(&saddle::<f64>(1.0), |scene| {
        let good = camera::<f64>(1.0);
        let refused = |camera: &Camera<f64>| Room::new().build(scene, camera).err();
        assert_eq!(refused(&good), None);
        assert_eq!(refused(&Camera { eye: [f64::NAN; 3], ..good }), Some(ViewError::Ray(RayError::NotANumber)));
        assert_eq!(refused(&Camera { right: [0.0; 3], ..good }), Some(ViewError::Ray(RayError::ZeroDirection)));
        assert_eq!(refused(&Camera { up: good.right, ..good }), Some(ViewError::Flat));
        assert_eq!(refused(&Camera { up: good.forward.map(|c| c * (1.0 + 1e-15)), ..good }), Some(ViewError::Flat));
        assert_eq!(refused(&Camera { eye: [0.0, 0.0, 30.0], ..good }), Some(ViewError::Far));
        let mut room = Room::new();
        let view = room.build(scene, &good).unwrap();
        for place in [[f64::NAN, 0.0], [0.0, f64::INFINITY], [1e9, 0.0], [0.0, -8.0]] {
            assert_eq!(view.ray(place, &Interval::ahead()).err(), Some(RayError::OutOfView), "{place:?}");
        }
        assert!(view.ray([0.9, 0.9], &Interval::ahead()).is_ok());
    });
}

/// What reaches from before the eye to behind it may be seen anywhere, and must not be given the outline of its corners.
#[test]
fn a_surface_around_the_eye_is_seen_everywhere() {
    with_scene(&saddle::<f64>(1.0), |scene| {
        let camera =
            Camera { eye: [0.0, 0.0, 0.5], forward: [1.0, 0.0, 0.0], right: [0.0, -1.0, 0.0], up: [0.0, 0.0, 1.0] };
        let mut room = Room::new();
        let view = room.build(scene, &camera).unwrap();
        assert_eq!(view.surfaces()[0], Outline::<f64>::EVERYWHERE.rows());
    });
}
