//! Surfaces that are hard by how they are made, and rays at them: what numbers drawn one by one never come to.
//!
//! Weights fall toward an edge or a corner by up to 2³⁰, rows of points fall together, curves stop or turn back, sheets lie close
//! together, and what stands beside a surface is far away or of another size. All numbers are short ones times powers of two, so
//! that coordinates times weights are exact in either precision.

use crate::bytes::Bytes;
use crate::input::{Case, Numbers, in_precision};
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;

/// How far weights are apart at most, as a power of two: a little more than 1e9.
const MOST: i32 = 30;

/// A surface with a point for each place, all weights 1.
fn net([n, m]: [usize; 2], mut point: impl FnMut(usize, usize) -> [f64; 3]) -> ModelSurface {
    let places = (0..=n).flat_map(|i| (0..=m).map(move |j| (i, j)));
    let points = places.map(|(i, j)| {
        let [x, y, z] = point(i, j);
        [x, y, z, 1.0]
    });
    ModelSurface { number: 0, degree_u: n, degree_v: m, rational: false, points: points.collect(), knots: None }
}

/// The same surface with its parameters exchanged, or run through backwards.
fn turned(surface: ModelSurface, how: u8) -> ModelSurface {
    let (n, m) = (surface.degree_u, surface.degree_v);
    let [degree_u, degree_v] = if how & 1 == 0 { [n, m] } else { [m, n] };
    let places = (0..=degree_u).flat_map(|i| (0..=degree_v).map(move |j| if how & 1 == 0 { (i, j) } else { (j, i) }));
    let from = |(i, j): (usize, usize)| {
        let (i, j) = (if how & 2 == 0 { i } else { n - i }, if how & 4 == 0 { j } else { m - j });
        surface.points[i * (m + 1) + j]
    };
    ModelSurface { degree_u, degree_v, points: places.map(from).collect(), ..surface }
}

/// A case of one such surface, or of one with a mate.
pub(crate) fn case(bytes: &mut Bytes<'_>, precision: Precision, weighted: bool, degree: u8) -> Case {
    let size = if bytes.rarely(4) { i32::from(bytes.byte() as i8) / 4 } else { 0 };
    let mut surface = form(bytes, degree.min(3));
    if weighted {
        weigh(bytes, &mut surface);
    } else {
        surface.points.iter_mut().for_each(|point| point[3] = 1.0);
    }
    let mut surface = turned(surface, bytes.byte());
    let unit = f64::from(size).exp2();
    let offset = if bytes.rarely(8) { [0; 3].map(|_| f64::from(bytes.u16() as i16) * 8.0) } else { [0.0; 3] };
    for point in &mut surface.points {
        for k in 0..3 {
            point[k] = in_precision((point[k] + offset[k]) * unit, precision);
        }
    }
    let mut surfaces = vec![surface];
    surfaces.extend(mate(bytes, &surfaces[0], unit, precision));
    for surface in &mut surfaces {
        surface.rational = weighted;
    }
    let numbers = if size == 0 { Numbers::Fine } else { Numbers::Scaled(size) };
    Case { model: Model::numbered(surfaces), precision, weighted, numbers, shaped: true }
}

/// A number of few digits, below 8.
fn height(bytes: &mut Bytes<'_>) -> f64 {
    f64::from(bytes.byte() as i8) / 16.0
}

fn form(bytes: &mut Bytes<'_>, degree: u8) -> ModelSurface {
    let form = bytes.below(12);
    let mut degrees = [0; 2].map(|_| 1 + bytes.below(degree));
    if bytes.rarely(8) {
        degrees = [1, 1 + bytes.below(15)];
    }
    let [n, m] = degrees;
    let over_square = |i: usize, j: usize, z: f64| [i as f64 - 1.0, j as f64 - 1.0, z];
    match form {
        // Flat: t and the point are plain whatever the weights.
        0..3 => net(degrees, |i, j| over_square(i, j, 0.0)),
        3 => net([1, 1], |i, j| over_square(i, j, height(bytes))),
        4 | 5 => net(degrees, |i, j| over_square(i, j, height(bytes))),
        // Rows that fall together in a tip.
        6 | 7 => {
            let rows = 1 + bytes.below(n as u8);
            let tip = [0.0, 0.0, height(bytes)];
            net(degrees, |i, j| if i < rows { tip } else { over_square(i, j, height(bytes)) })
        }
        // A curve with a cusp, or that stops, drawn along a line.
        8 => {
            let curves = [
                [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]],
                [[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
                [[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [1.0, 1.0]],
                [[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 1.0]],
            ];
            let curve = bytes.one_of(&curves);
            let [x, y] = [0; 2].map(|_| height(bytes));
            net([1, 3], |i, j| [curve[j][0] + x * i as f64, curve[j][1] + y * i as f64, i as f64])
        }
        // A thin arch: two sheets that come together.
        9 => {
            let thin = (-f64::from(bytes.byte() % 24)).exp2();
            let mut arch =
                net([1, 2], |i, j| [i as f64, (j as f64 - 1.0) * thin, if j == 1 { 2.0 * thin } else { 0.0 }]);
            let heavy = f64::from(1 << bytes.below(4));
            arch.points[1][3] = heavy;
            arch.points[4][3] = heavy;
            arch
        }
        // A sliver.
        10 => {
            let thin = (-f64::from(bytes.byte() % 24)).exp2();
            net(degrees, |i, j| [i as f64, j as f64 * thin, height(bytes) * thin])
        }
        // A strip about a quarter of a circle, twisted.
        _ => {
            let from = f64::from(bytes.byte()) / 32.0;
            let by = f64::from(bytes.byte() as i8) / 64.0;
            let circle = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let round = |c: f64| (c * 4096.0).round() / 4096.0;
            let mut strip = net([2, m], |i, j| {
                let (sine, cosine) = (from + by * i as f64).sin_cos();
                let out = j as f64 / m as f64 - 0.5;
                let [x, y] = circle[i].map(|c| round(c * (1.0 + out * cosine)));
                [x, y, round(out * sine)]
            });
            for point in &mut strip.points[2 * (m + 1)..] {
                point[3] = 2.0;
            }
            strip
        }
    }
}

/// Exponents along one direction.
fn grades(bytes: &mut Bytes<'_>, degree: usize, most: i32) -> Vec<i32> {
    let kind = bytes.below(10);
    // Where an input ends, weights are as far apart as they may be.
    let apart = most - i32::from(bytes.byte()) % (most + 1);
    let n = degree as i32;
    let grade = |i: i32| match kind {
        // Evenly toward 1, and toward 0.
        0..3 => -apart * i / n,
        3 => apart * i / n,
        // The last one, or the first one.
        4 => -apart * i32::from(i == n),
        5 => -apart * i32::from(i == 0),
        // The middle, the ends, every other.
        6 => -apart * i32::from(i > 0 && i < n),
        7 => -apart * i32::from(i == 0 || i == n),
        8 => -apart * (i % 2),
        _ => 0,
    };
    (0..=n).map(grade).collect()
}

/// Multiplies weights.
fn weigh(bytes: &mut Bytes<'_>, surface: &mut ModelSurface) {
    let (n, m) = (surface.degree_u, surface.degree_v);
    match bytes.below(8) {
        0..6 => {
            let along_u = grades(bytes, n, MOST);
            let apart = |grades: &[i32]| grades.iter().fold(0, |most: i32, grade| most.max(grade.abs()));
            let along_v = grades(bytes, m, MOST - apart(&along_u));
            for (k, point) in surface.points.iter_mut().enumerate() {
                point[3] *= f64::from(along_u[k / (m + 1)] + along_v[k % (m + 1)]).exp2();
            }
        }
        // A corner, or any one point.
        6 => {
            let corners = [surface.points.len() - 1, 0, m, n * (m + 1)];
            let any = bytes.byte();
            let place = corners.get(usize::from(any)).copied().unwrap_or(usize::from(any) % surface.points.len());
            surface.points[place][3] *= (f64::from(bytes.byte() % 61) - f64::from(MOST)).exp2();
        }
        _ => {
            for point in &mut surface.points {
                point[3] *= f64::from(-i32::from(bytes.byte()) % (MOST + 1)).exp2();
            }
        }
    }
    if bytes.rarely(4) {
        for point in &mut surface.points {
            point[3] *= 1.0 + f64::from(bytes.byte() % 128) / 128.0;
        }
    }
}

/// What stands beside a surface of the size of `unit`, if anything does.
fn mate(bytes: &mut Bytes<'_>, surface: &ModelSurface, unit: f64, precision: Precision) -> Option<ModelSurface> {
    let square = |at: [f64; 3], side: f64| {
        Some(net([1, 1], |i, j| {
            [at[0] + (i as f64 - 0.5) * side, at[1] + (j as f64 - 0.5) * side, at[2]]
                .map(|c| in_precision(c, precision))
        }))
    };
    let [x, y, z, _] = surface.points[0];
    let (far, large) = (30_f64.exp2() * unit, 20_f64.exp2() * unit);
    match bytes.below(8) {
        4 => {
            let mut at = [x, y, z];
            let side = bytes.byte();
            at[usize::from(side) % 3] += if side & 128 == 0 { far } else { -far };
            square(at, unit)
        }
        5 => square([x, y, z - 4.0 * unit], large),
        6 => square([x, y, z + 4.0 * unit], unit * unit / large),
        // The same again, as close as may be.
        7 => {
            let most = if precision == Precision::F64 { 40 } else { 16 };
            let step = (-f64::from(bytes.byte() % most)).exp2() * unit;
            let axis = bytes.one_of(&[2, 2, 0, 1]);
            let mut other = surface.clone();
            for point in &mut other.points {
                point[axis] = in_precision(point[axis] + step, precision);
            }
            Some(other)
        }
        _ => None,
    }
}

/// Places by which a parameter is spread evenly in space, as far as the weights at its ends tell.
fn spread(place: f64, ratio: f64) -> f64 {
    place / (place + ratio * (1.0 - place))
}

/// A point to look at: of a surface, evenly in space or toward any of its edges, or in its box.
pub(crate) fn target(case: &Case, bytes: &mut Bytes<'_>) -> [f64; 3] {
    let surfaces = &case.model.surfaces;
    let surface = &surfaces[usize::from(bytes.rarely(4)) % surfaces.len()];
    let (n, m) = (surface.degree_u, surface.degree_v);
    // Where an input ends, in the middle.
    let place = |bytes: &mut Bytes<'_>| f64::from(bytes.byte() ^ 128) / 255.0;
    let corner = |k: usize| surface.points[k][3];
    let ratios = [(corner(n * (m + 1)) / corner(0)).powf(1.0 / n as f64), (corner(m) / corner(0)).powf(1.0 / m as f64)];
    let point = match bytes.below(8) {
        0..3 => {
            let bounds = |k: usize| {
                let all = surface.points.iter().map(move |point| point[k]);
                (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max))
            };
            [0, 1, 2].map(|k| {
                let (low, high) = bounds(k);
                low + (high - low) * place(bytes)
            })
        }
        3 | 4 => {
            let [u, v] = ratios.map(|ratio| spread(place(bytes), ratio));
            surface.point(u, v)
        }
        5 | 6 => {
            let [u, v] = [0; 2].map(|_| {
                let ratio = (f64::from(bytes.byte() as i8) / 4.0).exp2();
                spread(place(bytes), ratio)
            });
            surface.point(u, v)
        }
        _ => {
            let [x, y, z, _] = surface.points[usize::from(bytes.byte()) % surface.points.len()];
            [x, y, z]
        }
    };
    point.map(|c| in_precision(c, case.precision))
}

/// A ray at such a point: along an axis, in a plane across one, from anywhere, at a shallow angle, or along the net.
pub(crate) fn ray(case: &Case, bytes: &mut Bytes<'_>) -> RayLine {
    let unit = case.numbers.size();
    let kind = bytes.below(16);
    let mut target = target(case, bytes);
    if bytes.rarely(4) {
        let step = (-f64::from(bytes.byte() % 50)).exp2() * unit;
        let side = bytes.byte();
        target[usize::from(side) % 3] += if side & 128 == 0 { step } else { -step };
    }
    let round = |v: [f64; 3]| v.map(|c| in_precision(c, case.precision));
    let from_afar = |direction: [f64; 3]| {
        let direction = round(direction);
        (round([0, 1, 2].map(|k| target[k] - 4.0 * direction[k])), direction)
    };
    let along = |axis: usize, side: f64| {
        let mut direction = [0.0; 3];
        direction[axis] = side * 2.0 * unit;
        direction
    };
    let (origin, direction) = match kind {
        // Of a net whose rows or columns lie in planes across an axis all but one curve is out of the way.
        12 => {
            let mut direction = [0; 3].map(|_| height(bytes) * unit);
            direction[bytes.below(3)] = 0.0;
            from_afar(direction)
        }
        0..3 | 8..11 => {
            let side = if bytes.byte() & 1 == 0 { -1.0 } else { 1.0 };
            from_afar(along(bytes.one_of(&[2, 2, 2, 0, 1]), side))
        }
        3 | 4 | 11 => {
            let origin = round([0, 1, 2].map(|k| target[k] + case.number(bytes) - if k == 2 { 0.0 } else { unit }));
            (origin, round([0, 1, 2].map(|k| target[k] - origin[k])))
        }
        5 | 13 => {
            let slope = (-f64::from(bytes.byte() % 20)).exp2() * unit;
            let [x, y] = [0; 2].map(|_| height(bytes) * unit);
            from_afar([x + unit, y, -slope])
        }
        6 | 14 => {
            let points = &case.model.surfaces[0].points;
            let [a, b] = [0; 2].map(|_| points[usize::from(bytes.byte()) % points.len()]);
            from_afar([0, 1, 2].map(|k| b[k] - a[k]))
        }
        _ => from_afar(along(2, -1.0).map(|c| c + case.number(bytes))),
    };
    let (t_min, t_max) = if bytes.rarely(8) {
        let [a, b] = [0; 2].map(|_| height(bytes));
        (a.min(b), a.max(b))
    } else {
        (0.0, f64::INFINITY)
    };
    RayLine { origin, direction, t_min, t_max, scan_line: 0, valid: true }
}
