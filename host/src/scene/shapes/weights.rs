//! Surfaces with weights far apart: which points are heavy, and by how much, decides where on the parameters the surface lies.
//!
//! Of degree 1, weights 1 and 1/r leave all of the segment but a share 1/r of it in the last 1/r of its parameter: where weights
//! fall toward 1, numbers near 1 are too coarse to say where.

use super::{Random, bilinear, bumpy, parallelogram};
use crate::scene::model::ModelSurface;

/// How weights are arranged over a net. Of a ratio r they lie between 1/r and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weights {
    /// Those of an edge are light: u = 0, u = 1, v = 0, v = 1.
    Edge(usize),
    /// That of a corner is light: (0, 0), (0, 1), (1, 0), (1, 1).
    Corner(usize),
    /// They fall by equal factors along u and v, by the sign of each: toward 1, not at all, or toward 0.
    Graded([i32; 2]),
    /// At random, their logarithms evenly spread.
    Any,
}

impl Weights {
    /// Those that fall toward an edge or a corner.
    pub const FALLING: [Weights; 8] = [
        Weights::Edge(0),
        Weights::Edge(1),
        Weights::Edge(2),
        Weights::Edge(3),
        Weights::Corner(0),
        Weights::Corner(1),
        Weights::Corner(2),
        Weights::Corner(3),
    ];

    /// Those that are graded.
    pub const GRADED: [Weights; 8] = [
        Weights::Graded([1, 0]),
        Weights::Graded([-1, 0]),
        Weights::Graded([0, 1]),
        Weights::Graded([0, -1]),
        Weights::Graded([1, 1]),
        Weights::Graded([1, -1]),
        Weights::Graded([-1, 1]),
        Weights::Graded([-1, -1]),
    ];

    /// The surface with weights so arranged.
    pub fn of(self, mut surface: ModelSurface, ratio: f64, random: &mut Random) -> ModelSurface {
        let (m, n) = (surface.degree_u, surface.degree_v);
        surface.rational = true;
        for (k, point) in surface.points.iter_mut().enumerate() {
            let [i, j] = [k / (n + 1), k % (n + 1)];
            let light = |is: bool| if is { 1.0 } else { 0.0 };
            // How far it has fallen along one parameter, as a share of all that it falls along it.
            let fallen = |sign: i32, k: usize, degree: usize| {
                let along = k as f64 / degree as f64;
                match sign {
                    0 => 0.0,
                    1.. => along,
                    _ => 1.0 - along,
                }
            };
            let share = match self {
                Weights::Edge(0) => light(i == 0),
                Weights::Edge(1) => light(i == m),
                Weights::Edge(2) => light(j == 0),
                Weights::Edge(_) => light(j == n),
                Weights::Corner(corner) => light([i, j] == [corner / 2 * m, corner % 2 * n]),
                Weights::Graded([along_u, along_v]) => {
                    let all = along_u.abs() + along_v.abs();
                    (fallen(along_u, i, m) + fallen(along_v, j, n)) / f64::from(all.max(1))
                }
                Weights::Any => random.within(0.0, 1.0),
            };
            point[3] = ratio.powf(-share);
        }
        surface
    }
}

/// A surface of size about 2 about a place, to give weights to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sheet {
    /// A square, turned in space, of degrees 1 × 1.
    Square,
    /// A twisted bilinear surface.
    Twisted,
    /// Of degrees 3 × 3.
    Bicubic,
    /// Of degrees 15 × 1.
    Long,
    /// Of degrees 1 × 15.
    Wide,
}

impl Sheet {
    /// All of them.
    pub const ALL: [Sheet; 5] = [Sheet::Square, Sheet::Twisted, Sheet::Bicubic, Sheet::Long, Sheet::Wide];

    /// One of its kind.
    pub fn surface(self, random: &mut Random) -> ModelSurface {
        let place = random.point(0.5);
        let around = |[x, y, z]: [f64; 3]| [place[0] + x, place[1] + y, place[2] + z];
        let mut bent = |degrees| bumpy(random.bits(), degrees, place, 2.0, 0.3);
        match self {
            Sheet::Square => {
                // Rotations of a right angle's two sides about two axes.
                let [(s, c), (sin, cos)] = [0; 2].map(|_| random.within(0.0, std::f64::consts::TAU).sin_cos());
                let along_u = [2.0 * c, 2.0 * s * cos, 2.0 * s * sin];
                let along_v = [-2.0 * s, 2.0 * c * cos, 2.0 * c * sin];
                let corner = [0, 1, 2].map(|k| -0.5 * (along_u[k] + along_v[k]));
                parallelogram(around(corner), along_u, along_v)
            }
            Sheet::Twisted => {
                let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
                bilinear(corners.map(|[x, y]| {
                    let [a, b, c] = random.point(0.5);
                    around([x + 0.5 * a, y + 0.5 * b, c])
                }))
            }
            Sheet::Bicubic => bent([3, 3]),
            Sheet::Long => bent([15, 1]),
            Sheet::Wide => bent([1, 15]),
        }
    }
}

/// The point of the surface at parameters (u, 1 - u) and (v, 1 - v), each pair exact at both ends.
pub fn point_from_both_ends(surface: &ModelSurface, u: [f64; 2], v: [f64; 2]) -> [f64; 3] {
    let blend = |mut points: Vec<[f64; 4]>, [t, s]: [f64; 2]| {
        // Ends: each round leaves one point less.
        while points.len() > 1 {
            points = points.windows(2).map(|p| [0, 1, 2, 3].map(|k| s * p[0][k] + t * p[1][k])).collect();
        }
        points.first().copied().unwrap_or_default()
    };
    let weighted = |&[x, y, z, w]: &[f64; 4]| [x * w, y * w, z * w, w];
    let rows = surface.points.chunks(surface.degree_v + 1);
    let column = rows.map(|row| blend(row.iter().map(weighted).collect(), v)).collect();
    let [x, y, z, w] = blend(column, u);
    [x / w, y / w, z / w]
}

/// A point of the surface, whose weights differ by up to `ratio`, anywhere in space: of parameters that are evenly spread nearly
/// all name points at the heavy ends.
pub fn point_anywhere(surface: &ModelSurface, ratio: f64, random: &mut Random) -> [f64; 3] {
    // What evens out weights that fall at once, or by equal factors, and others.
    let both = |random: &mut Random, degree: usize| {
        let [s, any, choice] = [random.within(0.0, 1.0), random.within(-1.0, 1.0), random.within(0.0, 6.0)];
        let graded = 1.0 / degree as f64;
        let lean = ratio.powf([1.0, -1.0, 0.0, graded, -graded, any][choice as usize % 6]);
        let all = s + (1.0 - s) * lean;
        [s / all, (1.0 - s) * lean / all]
    };
    let (u, v) = (both(random, surface.degree_u), both(random, surface.degree_v));
    point_from_both_ends(surface, u, v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_lie_where_their_arrangement_says() {
        let of = |arrangement: Weights| {
            let surface = Weights::of(arrangement, bumpy(1, [3, 1], [0.0; 3], 1.0, 0.1), 1e6, &mut Random(1));
            surface.points.iter().map(|point| (-point[3].log10() * 10.0).round() / 10.0).collect::<Vec<_>>()
        };
        assert_eq!(of(Weights::Edge(1)), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 6.0, 6.0]);
        assert_eq!(of(Weights::Corner(2)), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 6.0, 0.0]);
        assert_eq!(of(Weights::Graded([1, 0])), [0.0, 0.0, 2.0, 2.0, 4.0, 4.0, 6.0, 6.0]);
        assert_eq!(of(Weights::Graded([-1, 1])), [3.0, 6.0, 2.0, 5.0, 1.0, 4.0, 0.0, 3.0]);
        assert!(of(Weights::Any).iter().all(|share| (0.0..=6.0).contains(share)));
    }

    #[test]
    fn points_are_spread_over_a_steep_segment() {
        let mut random = Random(2);
        let square = Weights::Edge(1).of(parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), 1e9, &mut random);
        let beyond = |random: &mut Random| point_anywhere(&square, 1e9, random)[0] > 0.5;
        let count = (0..1000).filter(|_| beyond(&mut random)).count();
        assert!((50..950).contains(&count), "{count}");
    }
}
