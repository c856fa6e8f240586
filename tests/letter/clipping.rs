//! Bézier clipping and its improvement, from the paper's text.

use crate::scenes::{Case, cases, limits};
use crate::text::{List, Met, P, S, Testing, alike, closer, heard, lists, same, starts, surfaces};
use patchray::limits::Work;
use patchray::method::{ClipScratch, Remembered, clipping, clipping_coherent};
use patchray::planes::{Planes, Projected};
use patchray::ray::{Hit, Incidence, Interval};
use patchray::reading::Switches;
use patchray::scalar::Scalar;
use patchray::surface::Surface;

/// Where a surface's control points lie as a ray sees them: two distances across it, and the depth along it.
type Net = Vec<[f64; 3]>;

/// A part of a surface's domain, and which parameter is clipped next: u is 0.
#[derive(Clone, Copy, Debug)]
struct Region {
    sides: [[f64; 2]; 2],
    next: usize,
}

/// The paper's share of an interval that a clip has to remove.
const THRESHOLD: f64 = 0.2;

/// The width of an interval that is one point: ours to choose.
const END: f64 = 9.3e-10;

/// By how much wider a clip is left than the hull says, since the hull's points are rounded.
const ROUNDING: f64 = 1e-12;

/// A point where a ray meets a surface.
#[derive(Clone, Copy, Debug)]
struct Point {
    at: [f64; 2],
    depth: f64,
}

/// What clipping a region comes to.
enum Outcome {
    Nothing,
    Point([f64; 2]),
    Halves([Region; 2]),
}

/// One ray and one surface.
struct One<'a> {
    degrees: [usize; 2],
    net: Net,
    met: Met<'a>,
}

/// What a ray came to.
#[derive(Debug, Default, PartialEq)]
struct Tally {
    clips: u32,
    points: u32,
    closest: u32,
    critical: u32,
    hidden: u32,
    lists: Vec<List>,
}

/// A row of control points cut to a part [from, to] of its interval, by blossoms.
fn cut(row: &[[f64; 3]], [from, to]: [f64; 2]) -> Net {
    let last = row.len() - 1;
    let blossom = |k: usize| {
        let mut points = row.to_vec();
        for step in 0..last {
            let t = if step < k { to } else { from };
            for i in 0..last - step {
                points[i] = [0, 1, 2].map(|c| (1.0 - t) * points[i][c] + t * points[i + 1][c]);
            }
        }
        points[0]
    };
    (0..=last).map(blossom).collect()
}

impl One<'_> {
    fn new<'a>(surface: &Surface<'_, P>, met: Met<'a>) -> One<'a> {
        let planes: &Planes<S> = met.planes;
        let seen = |point: &P| {
            let Projected { f, g, depth, .. } = planes.point(&point.0);
            [f, g, depth].map(S::to_f64)
        };
        let (u, v) = (surface.net.degree_u(), surface.net.degree_v());
        One { degrees: [u, v], net: surface.net.points().iter().map(seen).collect(), met }
    }

    /// The net of a part of the surface.
    fn part(&self, [u, v]: [[f64; 2]; 2]) -> Net {
        let [rows, columns] = self.degrees.map(|degree| degree + 1);
        let along_v: Vec<Net> = self.net.chunks(columns).map(|row| cut(row, v)).collect();
        let along_u = (0..columns).map(|j| cut(&(0..rows).map(|i| along_v[i][j]).collect::<Vec<_>>(), u));
        let along_u: Vec<Net> = along_u.collect();
        (0..rows).flat_map(|i| along_u.iter().map(move |column| column[i])).collect()
    }

    /// What of a net's parameter `k` can hold points: where the convex hull of the distances to a line meets zero.
    fn clip(&self, net: &Net, k: usize) -> Option<[f64; 2]> {
        let [rows, columns] = self.degrees.map(|degree| degree + 1);
        let at = |i: usize, j: usize| net[i * columns + j];
        let corner = [at(0, 0), at(rows - 1, 0), at(0, columns - 1), at(rows - 1, columns - 1)];
        let sum = |a: usize, b: usize, c: usize, d: usize| {
            [0, 1].map(|x| corner[b][x] - corner[a][x] + corner[d][x] - corner[c][x])
        };
        // Along the mean chord in the other parameter.
        let chords = [sum(0, 1, 2, 3), sum(0, 2, 1, 3)];
        let [x, y] = chords[1 - k];
        let degree = self.degrees[k];
        let mut points = Vec::new();
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            let [f, g, _] = at(i, j);
            points.push([[i, j][k] as f64 / degree as f64, x * g - y * f]);
        }
        let mut span: Option<[f64; 2]> = None;
        let mut hold = |t: f64| span = Some(span.map_or([t, t], |[low, high]| [low.min(t), high.max(t)]));
        for a in &points {
            if a[1] == 0.0 {
                hold(a[0]);
            }
            for b in &points {
                if a[1] < 0.0 && b[1] > 0.0 {
                    hold(a[0] + (b[0] - a[0]) * (a[1] / (a[1] - b[1])));
                }
            }
        }
        span
    }

    /// Clips a region's parameters alternately.
    fn clip_down(&self, mut region: Region, tally: &mut Tally) -> Outcome {
        loop {
            let widths = region.sides.map(|[low, high]| high - low);
            if widths.iter().all(|&width| width <= END) {
                return Outcome::Point(region.sides.map(|[low, high]| (low + high) / 2.0));
            }
            let k = region.next;
            region.next = 1 - k;
            let [low, high] = region.sides[k];
            tally.clips += 1;
            match self.clip(&self.part(region.sides), k) {
                None => return Outcome::Nothing,
                Some([from, to]) if to - from <= 1.0 - THRESHOLD => {
                    let [from, to] = [from, to].map(|share| low + (high - low) * share);
                    region.sides[k] = [low.max(from - ROUNDING), high.min(to + ROUNDING)];
                }
                Some(_) if widths[k] <= END => {}
                Some(_) => {
                    let (mut first, mut second) = (region, region);
                    let middle = (low + high) / 2.0;
                    first.sides[k] = [low, middle];
                    second.sides[k] = [middle, high];
                    return Outcome::Halves([first, second]);
                }
            }
        }
    }

    /// A point's depth, and whether it lies in the interval.
    fn point(&self, at: [f64; 2], tally: &mut Tally) -> Option<Point> {
        let depth = self.part(at.map(|c| [c, c]))[0][2];
        let inside = self.met.planes.t_in_interval(S::from_f64(depth)).is_some();
        tally.points += u32::from(inside);
        inside.then_some(Point { at, depth })
    }

    /// All points, around what the previous ray has left; those after the first only if it is not verified.
    fn search(&self, previous: Option<[f64; 2]>, tally: &mut Tally) -> Option<Point> {
        let mut pending = vec![Region { sides: [[0.0, 1.0]; 2], next: 0 }];
        let mut prior = pending[0];
        let mut best: Option<Point> = None;
        let mut verify = previous.is_some();
        while !pending.is_empty() {
            let region = pending.remove(next(&pending, previous, &prior));
            if previous.is_some_and(|at| holds(&region, at)) {
                prior = region;
            }
            match self.clip_down(region, tally) {
                Outcome::Nothing => {}
                Outcome::Halves([first, second]) => pending.extend([second, first]),
                Outcome::Point(at) => {
                    let Some(point) = self.point(at, tally) else { continue };
                    if best.is_none_or(|best| point.depth < best.depth) {
                        best = Some(point);
                    }
                    if std::mem::take(&mut verify) && !pending.is_empty() && self.verify(&point, tally) {
                        break;
                    }
                }
            }
        }
        best
    }

    /// Whether the testing ray says yes.
    fn verify(&self, point: &Point, tally: &mut Tally) -> bool {
        let Testing { list, owner, tangential } = self.met.testing(point.at.map(S::from_f64), S::from_f64(point.depth));
        tally.lists.push(self.met.domains(&list));
        match owner {
            Some(_) if !tangential && list.len() == 1 => tally.closest += 1,
            Some(_) if !tangential => tally.hidden += 1,
            _ => tally.critical += 1,
        }
        owner.is_some() && !tangential && list.len() == 1
    }
}

fn holds(region: &Region, at: [f64; 2]) -> bool {
    region.sides.iter().zip(at).all(|(&[low, high], c)| (low..=high).contains(&c))
}

/// Which of the regions that wait is the next: the last, or the prior one, or one that adjoins it, or the one nearest to the point.
fn next(pending: &[Region], previous: Option<[f64; 2]>, prior: &Region) -> usize {
    let Some(at) = previous else { return pending.len() - 1 };
    let adjoins = |one: &Region| one.sides.iter().zip(prior.sides).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1]);
    let off = |one: &Region| -> f64 {
        one.sides.iter().zip(at).map(|(&[low, high], c)| (c.clamp(low, high) - c).abs()).sum()
    };
    let rank = |one: &Region| {
        if holds(one, at) {
            0
        } else if adjoins(one) {
            1
        } else {
            2
        }
    };
    let order = |a: &Region, b: &Region| rank(a).cmp(&rank(b)).then(off(a).total_cmp(&off(b)));
    (0..pending.len()).min_by(|&a, &b| order(&pending[a], &pending[b])).unwrap()
}

#[test]
fn the_clipping_methods_are_the_text_s() {
    for Case { name, prepared, lines } in cases::<P>() {
        let (scene, limits) = (prepared.scene(), limits::<S>());
        let (all, grids) = (prepared.patches(), prepared.grids());
        let patches = |number: u32| all.of_surface(number as usize).unwrap();
        let mut memory = vec![Remembered::EMPTY; scene.len()];
        let mut scratch = ClipScratch::<P, 16, 256, 64>::new();
        let (mut rays, mut points, mut clips) = (0, [0; 2], [[0; 2]; 2]);
        let mut count = |k: usize, work: &Work, tally: &Tally| {
            points[k] += tally.points;
            clips[k][0] += work.clip_steps;
            clips[k][1] += tally.clips;
        };
        for (number, line) in lines.iter().enumerate() {
            let mut previous = vec![None; scene.len()];
            for one in line {
                let ray = scene.ray(one.origin.map(S::from_f64), one.direction.map(S::from_f64)).unwrap();
                let (interval, letter) = (Interval::ahead(), Switches::letter());
                let hit = |planes: &Planes<S>, surface: u32, Point { at, depth }: Point| {
                    let [u, v] = at.map(S::from_f64);
                    Hit { t: planes.t(S::from_f64(depth)), u, v, surface, incidence: Incidence::Crossing }
                };

                let (mut tally, mut best, mut work) = (Tally::default(), None, Work::default());
                surfaces(&scene, &ray, |surface, planes, range| {
                    let of_text = One::new(&surface, Met { patches: patches(surface.number), planes, range });
                    if let Some(point) = of_text.search(None, &mut tally) {
                        best = closer(best, hit(planes, surface.number, point));
                    }
                });
                let mut room = scratch.view();
                let kernel = clipping::closest_by(letter, &scene, &ray, &interval, &limits, &mut room, &mut work);
                assert!(same(kernel.unwrap(), best), "{name}: {one:?}: {kernel:?} {best:?}");
                assert_eq!(work.intersection_points, tally.points, "{name}: {one:?}");
                count(0, &work, &tally);

                let (mut tally, mut best, mut work) = (Tally::default(), None, Work::default());
                heard();
                let kernel = clipping_coherent::closest_by(
                    letter,
                    &scene,
                    &all,
                    &grids,
                    &mut memory,
                    number as u32,
                    &ray,
                    &interval,
                    &limits,
                    &mut room,
                    &mut work,
                );
                let heard = heard();
                let mut remembered = starts(&heard);
                surfaces(&scene, &ray, |surface, planes, range| {
                    let of_text = One::new(&surface, Met { patches: patches(surface.number), planes, range });
                    let slot = &mut previous[surface.number as usize];
                    let start = slot.take().map(|[u, v]: [S; 2]| {
                        let start = remembered.next().unwrap();
                        assert!(alike(u, start[0]) && alike(v, start[1]), "{name}: {one:?}");
                        start.map(S::to_f64)
                    });
                    let root = of_text.search(start, &mut tally);
                    *slot = root.map(|root| root.at.map(S::from_f64));
                    if let Some(point) = root {
                        best = closer(best, hit(planes, surface.number, point));
                    }
                });
                assert!(same(kernel.unwrap(), best), "{name}: {one:?}: {kernel:?} {best:?}");
                let counted = [work.intersection_points, work.verified, work.refused_as_critical, work.refused_by_list];
                let of_text = [tally.points, tally.closest, tally.critical, tally.hidden];
                assert_eq!(counted, of_text, "{name}: {one:?}");
                assert_eq!(lists(&heard), tally.lists, "{name}: {one:?}");
                count(1, &work, &tally);
                rays += 1;
            }
        }
        println!("{name}: {rays} rays, {points:?} points, {clips:?} clips");
        // Where a clip ends on the last digits it may take one more.
        for [kernel, of_text] in clips {
            assert!(kernel.abs_diff(of_text) <= kernel / 200, "{name}: {clips:?}");
        }
        assert_eq!(rays, 10_000);
    }
}
