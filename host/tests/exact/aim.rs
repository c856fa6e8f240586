//! Rays aimed exactly at edges and corners that surfaces share to the bit, and pass between them.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use glam::DVec3;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;
use patchray_host::stress::case::{Draw, away, point, ray};

use crate::tools::index;

/// A place at a border of a surface: its edges are u = 0, u = 1, v = 0, v = 1.
#[derive(Clone, Copy, Debug)]
struct Side {
    surface: usize,
    edge: usize,
}

impl Side {
    fn parameters(self, along: f64) -> [f64; 2] {
        let across = (self.edge % 2) as f64;
        if self.edge < 2 { [across, along] } else { [along, across] }
    }

    /// The control points, and those of the next row.
    fn rows(self, surface: &ModelSurface) -> [Vec<[f64; 4]>; 2] {
        let (m, n) = (surface.degree_u, surface.degree_v);
        let of = |inward: usize| match self.edge {
            0 => (0..=n).map(|j| surface.points[inward * (n + 1) + j]).collect(),
            1 => (0..=n).map(|j| surface.points[(m - inward) * (n + 1) + j]).collect(),
            2 => (0..=m).map(|i| surface.points[i * (n + 1) + inward]).collect(),
            _ => (0..=m).map(|i| surface.points[i * (n + 1) + n - inward]).collect(),
        };
        [of(0), of(1)]
    }
}

/// An edge that two surfaces share, the second of them perhaps in the other order.
#[derive(Clone, Debug)]
pub(crate) struct Shared {
    sides: [Side; 2],
    reversed: bool,
}

/// A corner that surfaces share, with the two directions in which each of them leaves it.
#[derive(Clone, Debug)]
pub(crate) struct Corner {
    place: DVec3,
    wedges: Vec<[DVec3; 2]>,
}

fn position(point: &[f64; 4]) -> DVec3 {
    DVec3::new(point[0], point[1], point[2])
}

/// What there is to aim at.
#[derive(Clone, Debug)]
pub(crate) struct Targets {
    pub(crate) shared: Vec<Shared>,
    pub(crate) corners: Vec<Corner>,
}

pub(crate) fn targets(model: &Model) -> Targets {
    let bits = |row: &[[f64; 4]]| row.iter().map(|p| p.map(|c| (c + 0.0).to_bits())).collect::<Vec<_>>();
    let mut edges: BTreeMap<Vec<[u64; 4]>, Vec<(Side, bool)>> = BTreeMap::new();
    // By its end, the ways in which a surface leaves a corner.
    let mut ends: BTreeMap<[u64; 3], BTreeMap<usize, Vec<DVec3>>> = BTreeMap::new();
    for (number, surface) in model.surfaces.iter().enumerate() {
        for edge in 0..4 {
            let side = Side { surface: number, edge };
            let [row, _] = side.rows(surface);
            if row.iter().all(|point| position(point) == position(&row[0])) {
                continue;
            }
            let (forth, mut back) = (bits(&row), bits(&row));
            back.reverse();
            let reversed = back < forth;
            edges.entry(if reversed { back } else { forth }).or_default().push((side, reversed));
            let mut other = row.clone();
            other.reverse();
            for row in [row, other] {
                let from = position(&row[0]);
                let to = row.iter().map(position).find(|&to| to != from).unwrap_or(from);
                let key = from.to_array().map(|c| (c + 0.0).to_bits());
                ends.entry(key).or_default().entry(number).or_default().push((to - from).normalize_or_zero());
            }
        }
    }
    let pairs = edges.into_values().filter_map(|sides| match sides[..] {
        [(a, forth), (b, back)] => Some(Shared { sides: [a, b], reversed: forth != back }),
        _ => None,
    });
    let corners = ends.into_iter().filter_map(|(key, ways)| {
        let wedges = ways.into_values().map(|ways| <[DVec3; 2]>::try_from(ways).ok()).collect::<Option<Vec<_>>>()?;
        (wedges.len() > 2).then_some(Corner { place: DVec3::from_array(key.map(f64::from_bits)), wedges })
    });
    Targets { shared: pairs.collect(), corners: corners.collect() }
}

/// The sine between the ray and a neighbour below which nothing is asked.
const STEEP: f64 = 0.05;

impl Shared {
    /// The place at `along`, and the least sine by which the ray passes between both surfaces, which then lie on either side of
    /// the edge as the ray sees them; `None` where it might slip by.
    fn at(&self, model: &Model, along: f64, d: DVec3) -> Option<(DVec3, f64)> {
        let [a, b] = self.sides;
        let other = if self.reversed { 1.0 - along } else { along };
        let place = |side: Side, along: f64| {
            let surface = &model.surfaces[side.surface];
            let [u, v] = side.parameters(along);
            point(surface, u, v)
        };
        let on = place(a, along);
        let step = 1e-4;
        let (low, high) = ((along - step).max(0.0), (along + step).min(1.0));
        let edge = (place(a, high) - place(a, low)).normalize_or_zero();
        // Inward, of either surface, as the ray sees it.
        let into = |side: Side, along: f64| {
            let surface = &model.surfaces[side.surface];
            let [u, v] = side.parameters(along);
            let inward = |c: f64| if c == 0.0 { step } else { 1.0 - step };
            let [u, v] = if side.edge < 2 { [inward(u), v] } else { [u, inward(v)] };
            let way = point(surface, u, v) - on;
            (way - edge * way.dot(edge)).normalize_or_zero()
        };
        let sine = |way: DVec3| edge.cross(way).dot(d);
        let [one, two] = [sine(into(a, along)), sine(into(b, other))];
        let least = one.abs().min(two.abs());
        (one * two < 0.0 && least > STEEP).then_some((on, least))
    }
}

impl Corner {
    /// The same of a corner: as the ray sees them, its surfaces surround it once.
    fn at(&self, d: DVec3) -> Option<(DVec3, f64)> {
        let right = d.any_orthonormal_vector();
        let up = d.cross(right);
        let (mut sum, mut least) = (0.0, 1.0);
        for wedge in &self.wedges {
            let [a, b] = wedge.map(|way| [way.dot(right), way.dot(up)]);
            let (sine, cosine) = (a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
            sum += sine.atan2(cosine).abs();
            least = f64::min(least, wedge[0].cross(wedge[1]).normalize_or_zero().dot(d).abs());
        }
        ((sum - TAU).abs() < 1e-6 && sum > PI && least > STEEP).then_some((self.place, least))
    }
}

/// A ray at an edge or a corner, where it has to be met, and by how much t may be off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aimed {
    pub(crate) ray: RayLine,
    pub(crate) t: f64,
    pub(crate) off: f64,
}

/// Rays from outside of the model, or from near by, in numbers of the precision.
pub(crate) fn aim(draw: &mut Draw, model: &Model, targets: &Targets, count: usize) -> Vec<Aimed> {
    let size = away(model) / 1.5;
    let (unit, share) = match draw.precision {
        Precision::F64 => (f64::EPSILON, 1e-14),
        Precision::F32 => (f64::from(f32::EPSILON), 2e-6),
    };
    let precision = draw.precision;
    let round = |v: DVec3| match precision {
        Precision::F64 => v,
        Precision::F32 => v.as_vec3().as_dvec3(),
    };
    let mut aimed = Vec::new();
    // Ends: of directions drawn at random most pass between neighbours.
    while aimed.len() < count {
        let d = draw.direction();
        let at = if targets.shared.is_empty() || index(&mut draw.random, 5) == 0 {
            draw.pick(&targets.corners).at(d)
        } else {
            let along = if index(&mut draw.random, 4) == 0 { 0.5 } else { draw.random.within(0.01, 0.99) };
            draw.pick(&targets.shared).at(model, along, d)
        };
        let Some((on, sine)) = at else { continue };
        let distance = size * *draw.pick(&[1.5, 0.5, 0.01]);
        let (origin, direction) = (round(on - d * distance), round(d));
        let t = (on - origin).dot(direction) / direction.length_squared();
        let mut ray = ray(origin, direction);
        let largest = [on, origin].iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let off = (share * size + 16.0 * unit * largest) / sine;
        // Half of them alone with the edge, half with all else that the ray meets.
        if index(&mut draw.random, 2) == 0 {
            let [low, high] = [t - 4.0 * off, t + 4.0 * off];
            ray.t_min = round(DVec3::splat(low)).x.max(0.0);
            ray.t_max = round(DVec3::splat(high)).x;
        }
        aimed.push(Aimed { ray, t, off });
    }
    aimed
}
