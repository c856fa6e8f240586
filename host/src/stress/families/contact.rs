//! Rays that lie in a surface for a stretch, exactly so in the numbers of either precision: right is where the stretch begins.

use glam::DVec3;

use crate::judge::Truth;
use crate::scene::model::{Model, ModelSurface};
use crate::scene::rays::RayLine;
use crate::scene::revolution::{Arcs, Curve, revolve};
use crate::scene::shapes::{cylinder, elevate, net, parallelogram, single};
use crate::scene::trace::Precision;
use crate::stress::case::{Case, Draw, FEW, Family, ray};

pub(super) const FAMILIES: [Family; 1] = [Family {
    name: "contact",
    what: "rays in a plane, a disc, or along rulings of cylinders, cones and tangent developables",
    unjudged: FEW,
    cases: contact,
}];

/// What is true of a ray that lies in a surface from `begin` on; or lies in its plane and passes it.
fn along(begin: Option<f64>) -> Truth {
    Truth { closest: begin, roots: usize::from(begin.is_some()), margin: 1.0, contact: true, ..Truth::default() }
}

/// A ray that the form cannot judge: its way into the outline is too flat.
fn open() -> Truth {
    Truth { open: true, ..Truth::default() }
}

/// Where a line in the plane of a convex polygon, whose corners are in order around it, enters it.
fn into_polygon(corners: &[[f64; 2]], origin: [f64; 2], d: [f64; 2]) -> Truth {
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let less = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let speed = d[0].hypot(d[1]);
    let sides: Vec<f64> = corners.iter().map(|&corner| cross(d, less(corner, origin)) / speed).collect();
    // A line that passes a corner closely is in doubt.
    if sides.iter().any(|side| side.abs() < 0.05) {
        return open();
    }
    let mut crossings = Vec::new();
    for k in 0..corners.len() {
        let next = (k + 1) % corners.len();
        if (sides[k] > 0.0) == (sides[next] > 0.0) {
            continue;
        }
        let side = less(corners[next], corners[k]);
        let sine = cross(d, side) / (speed * side[0].hypot(side[1]));
        if sine.abs() < 0.1 {
            return open();
        }
        crossings.push(cross(less(corners[k], origin), side) / cross(d, side));
    }
    crossings.sort_by(f64::total_cmp);
    match crossings[..] {
        [] => along(None),
        [begin, _] if begin > 0.0 => along(Some(begin)),
        _ => open(),
    }
}

/// Where a line in the plane of the circle of radius 1 about 0 enters it.
fn into_disc(o: [f64; 2], d: [f64; 2]) -> Truth {
    let speed = d[0].hypot(d[1]);
    let [x, y] = d.map(|c| c / speed);
    let aside = o[0] * y - o[1] * x;
    if aside.abs() > 1.1 {
        return along(None);
    }
    let begin = (-(o[0] * x + o[1] * y) - (1.0 - aside * aside).max(0.0).sqrt()) / speed;
    // The angle at the outline has a cosine of |aside|.
    if aside.abs() < 0.9 && begin > 0.0 { along(Some(begin)) } else { open() }
}

/// A number of few digits, so that sums and products of a few are exact in either precision.
fn short(x: f64) -> f64 {
    (x * 64.0).round() / 64.0
}

/// A ray in the plane z = height, from outside of the circle of radius 3.
fn in_plane(draw: &mut Draw, height: f64) -> RayLine {
    let turn = draw.random.within(0.0, std::f64::consts::TAU);
    let [x, y, toward_x, toward_y] =
        [4.0 * turn.cos(), 4.0 * turn.sin(), draw.random.within(-1.5, 1.5), draw.random.within(-1.5, 1.5)];
    let (from, to) = (DVec3::new(short(x), short(y), height), DVec3::new(short(toward_x), short(toward_y), height));
    ray(from, (to - from) * *draw.pick(&[1.0, 0.25, 8.0]))
}

fn flat(v: [f64; 3]) -> [f64; 2] {
    [v[0], v[1]]
}

/// Exchanges the axes of all, so that the plane lies across another axis; the form sees them in their old order.
fn turned(by: usize, model: Model, rays: Vec<RayLine>, form: fn([f64; 2], [f64; 2]) -> Truth) -> Case {
    let turn = |v: [f64; 3]| [0, 1, 2].map(|k| v[(k + by) % 3]);
    let back = move |v: [f64; 3]| [0, 1, 2].map(|k| v[(k + 3 - by) % 3]);
    let mut model = model;
    for point in model.surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
        let [x, y, z, w] = *point;
        let [x, y, z] = turn([x, y, z]);
        *point = [x, y, z, w];
    }
    let rays = rays.into_iter().map(|ray| RayLine { origin: turn(ray.origin), direction: turn(ray.direction), ..ray });
    Case::of_form(model, rays.collect(), move |_, ray| form(flat(back(ray.origin)), flat(back(ray.direction))))
}

/// The corners of the quadrilateral that is used flat.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -0.75], [1.25, 1.0], [-0.75, 1.25]];

fn into_quadrilateral(o: [f64; 2], d: [f64; 2]) -> Truth {
    into_polygon(&CORNERS, o, d)
}

fn planes(draw: &mut Draw, rays: usize) -> Vec<Case> {
    let height = 0.375;
    let [a, b, c, d] = CORNERS;
    let corners = [a, d, b, c].map(|[x, y]| [x, y, height]);
    let plain = crate::scene::shapes::bilinear(corners);
    let mut weighted = elevate(&plain, 2, 3);
    weighted.rational = true;
    for (k, point) in weighted.points.iter_mut().enumerate() {
        point[3] = [1.0, 0.5, 0.25][k / 4] * [1.0, 2.0, 0.5, 1.0][k % 4];
    }
    // The control points of a raised one are not within its plane's numbers but for the height.
    let cases = [plain.clone(), elevate(&plain, 3, 3), weighted].into_iter().zip(0..).map(|(surface, by)| {
        let lines = (0..rays / 3).map(|_| in_plane(draw, height)).collect();
        turned(by, single(surface), lines, into_quadrilateral)
    });
    cases.collect()
}

fn discs(draw: &mut Draw, rays: usize) -> Vec<Case> {
    let height = -0.25;
    let disc = |degree| {
        let profile = Curve::segment(degree, [0.0, height], [1.0, height]);
        Model::numbered(revolve(&profile, &Curve::circle(Arcs::Rational, 0.0, 360.0, 4)))
    };
    let cases = [1, 2].map(|degree| {
        let lines = (0..rays / 2).map(|_| in_plane(draw, height)).collect();
        turned(degree, disc(degree), lines, into_disc)
    });
    cases.to_vec()
}

/// A case of rays along rulings, from t = 1 at the first of two points to t = 2 at the second.
fn rulings(draw: &mut Draw, surface: Model, rays: usize, ruling: impl Fn(&mut Draw) -> [DVec3; 2]) -> Case {
    let lines = (0..rays).map(|_| {
        let [a, b] = ruling(draw);
        ray(a - (b - a), b - a)
    });
    let lines: Vec<RayLine> = lines.collect();
    Case::of_form(surface, lines, |_, _| along(Some(1.0)))
}

/// Two points in either order.
fn either(draw: &mut Draw, [a, b]: [DVec3; 2]) -> [DVec3; 2] {
    *draw.pick(&[[a, b], [b, a]])
}

/// A ruled surface between two curves of control points.
fn ruled(first: &[DVec3], second: &[DVec3]) -> ModelSurface {
    net(first.len() - 1, 1, |i, j| if j == 0 { first[i].to_array() } else { second[i].to_array() })
}

/// A parameter at which polynomials of low degree are exact.
fn exact_parameter(draw: &mut Draw) -> f64 {
    let steps = match draw.precision {
        Precision::F64 => 64.0,
        Precision::F32 => 16.0,
    };
    (draw.random.within(0.0, 1.0) * steps).round() / steps
}

fn contact(draw: &mut Draw) -> Vec<Case> {
    let share = draw.rays / 6;
    let mut cases = planes(draw, share);
    cases.extend(discs(draw, share));
    // Cylinders and cones about z have rulings at their seams that are exact.
    let quarter = |draw: &mut Draw| *draw.pick(&[DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y]);
    let round = cylinder([0.0; 3], 0.75, 1.5);
    cases.push(rulings(draw, round, share / 2, |draw| {
        let side = quarter(draw) * 0.75;
        either(draw, [side - DVec3::Z * 0.75, side + DVec3::Z * 0.75])
    }));
    let cone = Curve::segment(1, [1.0, 0.0], [0.0, 1.0]);
    let cone = Model::numbered(revolve(&cone, &Curve::circle(Arcs::Rational, 0.0, 360.0, 4)));
    cases.push(rulings(draw, cone, share / 2, |draw| {
        let on = quarter(draw);
        either(draw, [on, DVec3::Z])
    }));
    // Over the parabola (u, u²), u from -1 to 1.
    let parabola = |s: f64| DVec3::new(2.0 * s - 1.0, (2.0 * s - 1.0) * (2.0 * s - 1.0), 0.0);
    let base = [DVec3::new(-1.0, 1.0, 0.0), DVec3::new(0.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)];
    let (up, apex) = (DVec3::new(0.25, 0.5, 2.0), DVec3::new(0.5, 0.0, 1.5));
    let wall = single(ruled(&base, &base.map(|p| p + up)));
    cases.push(rulings(draw, wall, share / 2, |draw| {
        let on = parabola(exact_parameter(draw));
        either(draw, [on, on + up])
    }));
    let tent = single(ruled(&base, &[apex; 3]));
    cases.push(rulings(draw, tent, share / 2, |draw| {
        let on = parabola(exact_parameter(draw));
        either(draw, [on, apex])
    }));
    // The tangents of (s, s², s³), each as long as the derivative, toward the curve: behind it a tangent is left by the other sheet
    // as slowly as a cube, so that rounding moves where a ray that comes from there meets the surface.
    let cubic = [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 0.0), DVec3::new(3.0, 3.0, 3.0)];
    // Control points of c, times 3, and of c' raised to degree 3, times 3.
    let derivative = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 2.0, 3.0)];
    let raised = [
        3.0 * derivative[0],
        derivative[0] + 2.0 * derivative[1],
        2.0 * derivative[1] + derivative[2],
        3.0 * derivative[2],
    ];
    let ends: Vec<DVec3> = cubic.iter().zip(raised).map(|(&c, d)| c + d).collect();
    let developable = single(ruled(&cubic, &ends));
    cases.push(rulings(draw, developable, share, |draw| {
        let s = exact_parameter(draw);
        let on = 3.0 * DVec3::new(s, s * s, s * s * s);
        [on + 3.0 * DVec3::new(1.0, 2.0 * s, 3.0 * s * s), on]
    }));
    // A plane with a ray in it that another surface stops before.
    let square = parallelogram([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    let stop = parallelogram([-2.0, -3.0, -1.0], [0.0, 6.0, 0.0], [0.0, 0.0, 2.0]);
    let model = Model::numbered(vec![square, stop]);
    let lines = (0..share / 2).map(|_| {
        let [from, to] = [0; 2].map(|_| short(draw.random.within(-0.75, 0.75)));
        ray(DVec3::new(-4.0, from, 0.0), DVec3::new(4.0, to - from, 0.0))
    });
    let lines: Vec<RayLine> = lines.collect();
    cases.push(Case::of_form(model, lines, |_, _| Truth { contact: false, ..along(Some(0.5)) }));
    cases
}
