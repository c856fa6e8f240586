//! The box of a patch seen from inside: its own coordinates, in `f64`.

use super::*;
use crate::bernstein::{Basis, MAX_DEGREE};
use crate::domain::MAX_LEVEL;
use crate::frame::{Aabb, Frame, PADDING};
use crate::planes::{CENTRE, DepthRange};
use crate::point::{Plain, Weighted};
use crate::ray::Interval;
use patchray_host::scene::shapes::{Random, bumpy};

type V3 = <f64 as Scalar>::Vec3;

/// Solves e · x = p by Cramer's rule, in `f64`.
fn coordinates(e: [[f64; 3]; 3], p: [f64; 3]) -> [f64; 3] {
    let [a, b, c] = e.map(V3::from_array);
    let p = V3::from_array(p);
    let volume = a.dot(b.cross(c));
    [p.dot(b.cross(c)) / volume, p.dot(c.cross(a)) / volume, p.dot(a.cross(b)) / volume]
}

fn centre_and_edges<S: Scalar>(bounds: &Parallelepiped<S>) -> ([f64; 3], [[f64; 3]; 3]) {
    let column = |j: usize| core::array::from_fn(|k| bounds.axes[k][j].to_f64());
    (column(CENTRE), [column(0), column(1), column(3)])
}

/// Control points and samples of a net lie within the padded box, and without padding within a rounding of it.
fn encloses<P: Point>(lower: impl Fn([f64; 4]) -> P) {
    let padding = P::Scalar::EPSILON * P::Scalar::from_u32(PADDING);
    let mut random = Random(1);
    let mut basis = Basis::<P::Scalar, 16>::new();
    for seed in 0..200 {
        let degrees = [0, 1].map(|_| 1 + random.within(0.0, MAX_DEGREE as f64) as usize);
        // From far larger to far smaller than its height, so that the parallelogram is any.
        let size = 10.0_f64.powf(random.within(-3.0, -0.4));
        let surface = bumpy(seed, degrees, [0.1, -0.2, 0.3], size, 0.1);
        let mut points = heapless::Vec::<P, 256>::new();
        for mut point in surface.points {
            point[3] = random.within(0.25, 1.0);
            points.push(lower(point)).unwrap();
        }
        let net = Net::new(degrees[0], degrees[1], &points).unwrap();
        let measure = Measure::of(&net, padding);
        let (centre, edges) = centre_and_edges(&measure.bounds);
        let slack = P::Scalar::EPSILON.to_f64();
        for k in 0..300 {
            let p = match points.get(k) {
                Some(point) => point.position(),
                None => {
                    let [u, v] = [0, 1].map(|_| P::Scalar::from_f64(random.within(0.0, 1.0)));
                    net.position(u, v, &mut basis.view()).unwrap()
                }
            };
            let from_centre = core::array::from_fn(|k| p[k].to_f64() - centre[k]);
            for x in coordinates(edges, from_centre) {
                assert!(x.abs() <= 1.0 + slack, "{seed} {degrees:?}: {x}");
            }
        }
    }
}

#[test]
fn a_box_holds_its_piece() {
    encloses(|[x, y, z, _]| Plain([x, y, z].map(|c| c as f32)));
    encloses(|[x, y, z, _]| Plain([x, y, z]));
    encloses(|[x, y, z, w]| Weighted::new([x, y, z].map(|c| c as f32), w as f32));
    encloses(|[x, y, z, w]| Weighted::new([x, y, z], w));
}

/// The hexagon test, entrance, exit and the parallelogram's start against the box's own coordinates: slabs, in `f64`.
#[test]
fn crossings_agree_with_slabs() {
    let mut random = Random(2);
    let frame = Frame::new(Aabb { low: [-0.75; 3], high: [0.75; 3] });
    let (mut met, mut passed) = (0, 0);
    for _ in 0..20_000 {
        let edges = [0.2, 0.2, 0.05].map(|half| random.point(half));
        let [e1, e2, e3] = edges.map(V3::from_array);
        if e1.cross(e2).dot(e3).abs() < 1e-6 {
            continue;
        }
        let centre = random.point(0.3);
        let bounds = Parallelepiped::new(V3::from_array(centre), [e1, e2, e3]);
        let (origin, target) = (random.point(0.7), random.point(0.5));
        let ray = frame.ray(origin, core::array::from_fn(|k| target[k] - origin[k])).unwrap();
        let whole = Interval::new(-f64::INFINITY, f64::INFINITY).unwrap();
        let (planes, _) = frame.enter(&ray, &whole).unwrap();
        let scaled = planes.origin();
        let base = coordinates(edges, core::array::from_fn(|k| scaled[k] - centre[k]));
        let step = coordinates(edges, planes.direction());
        let (mut near, mut far) = (-f64::INFINITY, f64::INFINITY);
        for k in 0..3 {
            let (a, b) = ((-1.0 - base[k]) / step[k], (1.0 - base[k]) / step[k]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        let crossing = bounds.crossing(&planes);
        assert_eq!(bounds.met(&planes), crossing.is_some());
        // Lines within rounding of an edge may go either way.
        if (far - near).abs() > 1e-9 {
            assert_eq!(crossing.is_some(), near < far, "{near} {far}");
        }
        let Some(crossing) = crossing else {
            passed += 1;
            continue;
        };
        met += 1;
        if far - near < 1e-9 {
            continue;
        }
        let [entrance, exit] = crossing.pierces().unwrap();
        assert!((entrance.depth - near).abs() < 1e-9 && (exit.depth - far).abs() < 1e-9);
        for (end, depth) in [(entrance, near), (exit, far)] {
            for k in 0..2 {
                assert!((end.local[k] - (base[k] + step[k] * depth)).abs() < 1e-8 && end.local[k].abs() < 1.0 + 1e-8);
            }
        }
        let range = |min: f64, max: f64| DepthRange { min, max };
        assert!(crossing.overlaps(&range(near, near)) && crossing.overlaps(&range(far, far + 1.0)));
        assert!(!crossing.overlaps(&range(100.0, 101.0)) && !crossing.overlaps(&range(-101.0, -100.0)));
        // The parallelogram is met where the third coordinate is 0, held within the box.
        let patch = Patch { bounds, stray: 0.0, sides: [SIDE_STEPS as u16; 2], domain: Domain::WHOLE };
        let depth = -base[2] / step[2];
        let start = patch.parallelogram(&crossing).unwrap();
        for k in 0..2 {
            let local = (base[k] + step[k] * depth).clamp(-1.0, 1.0);
            assert!((start[k] - 0.5 * (local + 1.0)).abs() < 1e-6, "{start:?} {local}");
        }
    }
    assert!(met > 1000 && passed > 1000, "{met} {passed}");
}

#[test]
fn domains_name_their_place_exactly() {
    let mut random = Random(3);
    for _ in 0..200 {
        let mut domain = Domain::WHOLE;
        let mut expected = [[0.0, 1.0]; 2];
        for _ in 0..2 * MAX_LEVEL {
            let along_u = random.within(0.0, 1.0) < 0.5;
            let axis = usize::from(!along_u);
            if domain.levels()[axis] == MAX_LEVEL {
                continue;
            }
            let side = usize::from(random.within(0.0, 1.0) < 0.5);
            domain = domain.halves(along_u)[side];
            let [low, high] = expected[axis];
            let middle = 0.5 * (low + high);
            expected[axis] = if side == 0 { [low, middle] } else { [middle, high] };
            assert_eq!(domain.bounds::<f64>(), expected);
            assert_eq!(domain.bounds::<f32>(), expected.map(|e| e.map(|t| t as f32)));
            let rough = domain.rough();
            assert!(rough.is_rough() && !domain.is_rough());
            assert_eq!((rough.levels(), rough.bounds::<f64>()), (domain.levels(), expected));
            // The corners of local coordinates are the corners of the domain.
            for corner in [0, 1] {
                let at = domain.parameters([-1.0, 1.0][corner], [-1.0, 1.0][1 - corner]);
                assert_eq!(at, [expected[0][corner], expected[1][1 - corner]]);
            }
            assert!(rough.holds(expected[0][0], expected[1][0]));
        }
    }
    assert!(Domain::WHOLE.holds(0.0, 1.0) && Domain::WHOLE.holds(1.0, 0.0));
}

#[test]
fn a_slot_stays_small() {
    assert!(size_of::<Patch<f32>>() <= 64 && size_of::<Patch<f64>>() <= 112 + 8);
}

/// Control points that are one point, or on one line, or a sliver: a box all the same, and no NaN.
#[test]
fn degenerate_pieces_have_a_box() {
    let padding = f64::EPSILON * f64::from(PADDING);
    for shape in 0..5 {
        let points: [Plain<f64>; 16] = core::array::from_fn(|k| {
            let (i, j) = ((k / 4) as f64 / 3.0, (k % 4) as f64 / 3.0);
            Plain(match shape {
                0 => [0.25, 0.5, -0.125],
                1 => [0.25 + 0.5 * i, 0.5 - 0.25 * i, 0.125 * i],
                2 => [0.25 * j, 0.25 * j, 0.25 * j],
                3 => [0.5 * i, 0.5 * i + 1e-12 * j, 0.25],
                // Along one line in both directions.
                _ => [0.25 * (i + j), 0.5 * (i + j), 0.0],
            })
        });
        let measure = Measure::of(&Net::new(3, 3, &points).unwrap(), padding);
        let (centre, edges) = centre_and_edges(&measure.bounds);
        assert!(centre.iter().chain(edges.iter().flatten()).all(|c| c.is_finite()), "{shape}");
        let [e1, e2, e3] = edges.map(V3::from_array);
        let volume = e1.cross(e2).dot(e3);
        assert!(volume != 0.0, "{shape}: the padding gives it a volume");
        for point in &points {
            let from_centre = core::array::from_fn(|k| point.0[k] - centre[k]);
            assert!(coordinates(edges, from_centre).iter().all(|x| x.abs() <= 1.0 + 1e-9), "{shape}");
        }
        let patch = measure.patch(Domain::WHOLE);
        let frame = Frame::new(Aabb { low: [-0.9; 3], high: [0.9; 3] });
        let ray = frame.ray([0.25, 0.5, 0.8], [0.0, 0.0, -1.0]).unwrap();
        let (planes, _) = frame.enter(&ray, &Interval::ahead()).unwrap();
        if let Some(crossing) = patch.bounds().crossing(&planes) {
            for start in patch.parallelogram(&crossing).into_iter().chain(crossing.pierces().map(|p| patch.at(&p[0]))) {
                assert!(start.iter().all(|t| t.is_finite()), "{shape}");
            }
        }
    }
}
