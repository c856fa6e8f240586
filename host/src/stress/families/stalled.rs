//! Surfaces that stand still somewhere: rows of control points in one point, cusps and repeated points seen end on; and strips
//! with a twist.

use glam::DVec3;

use crate::scene::model::{Model, ModelSurface};
use crate::scene::shapes::{bumpy, net, single};
use crate::stress::case::{COARSE, Case, Draw, Family, MANY, away, point, ray};

pub(super) const FAMILIES: [Family; 3] = [
    Family {
        name: "tips",
        what: "two to four rows of control points in one point, seen from all sides, 1e-1 to 1e-14 (f32: 1e-5) from it",
        unjudged: COARSE,
        cases: tips,
    },
    Family {
        name: "end-on",
        what: "ruled surfaces seen along their rulings, at cusps and where control points are repeated",
        unjudged: MANY,
        cases: end_on,
    },
    Family {
        name: "moebius",
        what: "Möbius strips of rational pieces 2 × 1, seen from all sides and near their edge",
        unjudged: COARSE,
        cases: moebius,
    },
];

fn tips(draw: &mut Draw) -> Vec<Case> {
    let mut cases = Vec::new();
    let rays = draw.rays.div_ceil(12);
    for (seed, degrees) in (131..).zip([[3, 2], [4, 3], [5, 1], [8, 3]]) {
        for rows in 2..=4_usize.min(degrees[0]) {
            let mut surface = bumpy(seed, degrees, [0.0; 3], 1.5, 0.3);
            let [m, n] = degrees;
            let tip = [0.2, -0.1, 0.9, 1.0];
            let at_start = rows % 2 == 0;
            for i in 0..rows {
                let row = if at_start { i } else { m - i };
                for j in 0..=n {
                    surface.points[row * (n + 1) + j] = tip;
                }
            }
            if seed % 2 == 0 {
                surface.rational = true;
                for point in &mut surface.points {
                    point[3] = draw.random.within(0.25, 1.0);
                }
            }
            let lines = (0..rays).map(|_| {
                // Where rows fall together, distance from the tip is a power of the parameter.
                let near = draw.ladder().abs().powf(1.0 / rows as f64);
                let [part, v] = [0; 2].map(|_| draw.random.within(0.0, 1.0));
                let u = *draw.pick(&[near, near, 1.0]) * part;
                let target = point(&surface, if at_start { u } else { 1.0 - u }, v);
                let beside = DVec3::from_array(draw.random.point(1.0)) * draw.ladder();
                let beside = *draw.pick(&[DVec3::ZERO, DVec3::ZERO, beside]);
                draw.ray_to(target + beside, 3.0)
            });
            let lines = lines.collect();
            cases.push(Case::of_rays(single(surface), lines));
        }
    }
    cases
}

/// Plane curves, by the control points of each, with a parameter at which they stand still.
fn standing() -> Vec<(Vec<[f64; 2]>, f64)> {
    vec![
        // A cusp within, and those of repeated points at either end and in the middle.
        (vec![[1.0, -1.0], [-0.333_333_343_267_440_8, 1.0], [-0.333_333_343_267_440_8, -1.0], [1.0, 1.0]], 0.5),
        (vec![[0.0, 0.0], [0.0, 0.0], [0.5, 1.0], [1.0, 0.25]], 0.0),
        (vec![[-1.0, 0.5], [-0.25, 1.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]], 1.0),
        (vec![[-1.0, 0.0], [0.0, 0.5], [0.0, 0.5], [0.0, 0.5], [0.0, 0.5], [1.0, 0.0]], 0.5),
        (vec![[-1.0, 0.0], [1.0, 1.0], [-1.0, 1.0], [1.0, 0.0]], 0.5),
    ]
}

fn end_on(draw: &mut Draw) -> Vec<Case> {
    let mut cases = Vec::new();
    let curves = standing();
    let rays = draw.rays.div_ceil(2 * curves.len());
    for (curve, place) in curves {
        let m = curve.len() - 1;
        // Rulings along y, straight or drawn together a little to one end.
        for taper in [0.0, 0.25] {
            let surface = net(m, 1, |i, j| {
                let by = 1.0 - taper * j as f64;
                [by * curve[i][0], 2.0 * j as f64 - 1.0, by * curve[i][1]]
            });
            let lines = (0..rays).map(|_| {
                let near = (place + 0.5 * draw.ladder()).clamp(0.0, 1.0);
                let any = draw.random.within(0.0, 1.0);
                let u = *draw.pick(&[near, near, place, any]);
                let (from, to) = (point(&surface, u, 0.0), point(&surface, u, 1.0));
                let beside = DVec3::new(draw.ladder(), 0.0, draw.ladder());
                // By some steps beside it, and not quite along it.
                let off = *draw.pick(&[DVec3::ZERO, beside, beside]);
                let tilt = DVec3::new(draw.ladder(), 0.0, draw.ladder());
                let tilt = *draw.pick(&[DVec3::ZERO, tilt]);
                let along = to - from + tilt;
                ray(0.5 * (from + to) + off - along * 2.0, along)
            });
            let lines = lines.collect();
            cases.push(Case::of_rays(single(surface.clone()), lines));
        }
    }
    cases
}

/// A strip of half width `half` along the circle of radius 1, turned over by `turns` halves, of rational pieces 2 × 1 that share
/// their rulings to the bit.
fn strip(pieces: usize, turns: f64, half: f64) -> Model {
    let tau = std::f64::consts::TAU;
    let at = |angle: f64, side: f64| {
        let (sin, cos) = angle.sin_cos();
        let (up, out) = (0.5 * turns * angle).sin_cos();
        let radius = 1.0 + side * half * out;
        DVec3::new(radius * cos, radius * sin, side * half * up)
    };
    let angle = |k: usize| tau * k as f64 / pieces as f64;
    // After one turn around, the sides have changed places if turns are odd.
    let ruling = |k: usize| {
        let ends = [-1.0, 1.0].map(|side| at(angle(k % pieces), side));
        if k == pieces && turns % 2.0 == 1.0 { [ends[1], ends[0]] } else { ends }
    };
    let weight = (0.5 * tau / pieces as f64).cos();
    let piece = |k: usize| {
        let (first, last) = (ruling(k), ruling(k + 1));
        // The middle of the arc is on the strip: (first + 2 w middle + last) / (2 + 2 w).
        let half_way = [-1.0, 1.0].map(|side| at(angle(k) + 0.5 * tau / pieces as f64, side));
        let middle = [0, 1].map(|j| (half_way[j] * (2.0 + 2.0 * weight) - first[j] - last[j]) / (2.0 * weight));
        let mut points = Vec::new();
        for (row, w) in [first, middle, last].into_iter().zip([1.0, weight, 1.0]) {
            points.extend(row.map(|p| [p.x, p.y, p.z, w]));
        }
        ModelSurface { number: k, degree_u: 2, degree_v: 1, rational: true, points, knots: None }
    };
    Model::numbered((0..pieces).map(piece).collect())
}

fn moebius(draw: &mut Draw) -> Vec<Case> {
    let mut cases = Vec::new();
    let rays = draw.rays.div_ceil(4);
    for (pieces, turns, half) in [(8, 1.0, 0.4), (5, 1.0, 0.3), (12, 3.0, 0.35), (6, 2.0, 0.4)] {
        let model = strip(pieces, turns, half);
        let lines = (0..rays).map(|_| {
            let surface = draw.pick(&model.surfaces).clone();
            let u = draw.random.within(0.0, 1.0);
            // At the edge of the strip, by steps to either side, along its rulings, or anywhere.
            let kind = draw.random.within(0.0, 3.0) as usize;
            let v = if kind == 2 { draw.random.within(0.0, 1.0) } else { *draw.pick(&[0.0, 1.0]) };
            let (on, across) = (point(&surface, u, v), point(&surface, u, 1.0) - point(&surface, u, 0.0));
            let step = draw.ladder();
            match kind {
                0 => draw.ray_to(on + across * step, away(&model)),
                1 => {
                    let along = across + DVec3::from_array(draw.random.point(1.0)) * draw.random.within(0.01, 0.3);
                    ray(on + across * step - along * 4.0, along)
                }
                _ => draw.ray_to(on, away(&model)),
            }
        });
        let lines = lines.collect();
        cases.push(Case::of_rays(model, lines));
    }
    cases
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_of_a_strip_share_their_rulings() {
        for turns in [1.0, 2.0, 3.0] {
            let model = strip(6, turns, 0.4);
            for (k, piece) in model.surfaces.iter().enumerate() {
                let next = &model.surfaces[(k + 1) % 6];
                let (last, first) = (&piece.points[4..], &next.points[..2]);
                let turned: Vec<_> = first.iter().rev().copied().collect();
                assert!(last == first || last == turned, "{turns} {k}");
            }
        }
    }
}
