//! Barth and Stürzlinger's method and its improvement, from the paper's text.

use crate::scenes::{Case, cases, limits};
use crate::text::{At, Heard, List, Met, P, S, Testing, alike, closer, heard, lists, same, starts, surfaces};
use patchray::limits::{Limits, Work};
use patchray::measure::Measure;
use patchray::method::{Remembered, Scratch, newton, newton_coherent};
use patchray::newton::Solver;
use patchray::parameter::Parameter as _;
use patchray::patch::{Parallelepiped, Patch};
use patchray::planes::Planes;
use patchray::ray::{Hit, Interval};
use patchray::reading::Switches;
use patchray::scalar::Scalar;
use patchray::surface::{Net, Surface};

/// A node of a surface's binary tree.
enum Node {
    Inner(Parallelepiped<S>, Box<[Node; 2]>),
    /// A leaf: the number of its patch.
    Leaf(usize),
}

/// The tree over a part of a surface: what is a patch is a leaf, all else was halved where it strays farther from its chord.
fn tree(net: &Net<'_, P>, patches: &[Patch<S>], sides: [[f64; 2]; 2]) -> Node {
    let is_it = |patch: &Patch<S>| patch.domain().bounds::<f64>() == sides;
    if let Some(leaf) = patches.iter().position(is_it) {
        return Node::Leaf(leaf);
    }
    let mut points = heapless::Vec::<P, 256>::new();
    let [u, v] = sides.map(|side| side.map(S::from_f64));
    net.restrict(u, v, &mut points).unwrap();
    let measure = Measure::of(&Net::new(net.degree_u(), net.degree_v(), &points).unwrap(), S::ZERO);
    let along_u = if measure.bend_u == measure.bend_v {
        measure.sides[0] >= measure.sides[1]
    } else {
        measure.bend_u > measure.bend_v
    };
    let k = usize::from(!along_u);
    let middle = (sides[k][0] + sides[k][1]) / 2.0;
    let half = |ends: [f64; 2]| {
        let mut half = sides;
        half[k] = ends;
        tree(net, patches, half)
    };
    Node::Inner(measure.bounds, Box::new([half([sides[k][0], middle]), half([middle, sides[k][1]])]))
}

/// All patches whose parallelepiped the ray meets, and all of whose ancestors' it meets.
fn leaves(node: &Node, patches: &[Patch<S>], planes: &Planes<S>, found: &mut Vec<usize>) {
    match node {
        Node::Leaf(patch) if patches[*patch].bounds().met(planes) => found.push(*patch),
        Node::Leaf(_) => {}
        Node::Inner(bounds, halves) if bounds.met(planes) => {
            halves.iter().for_each(|half| leaves(half, patches, planes, found));
        }
        Node::Inner(..) => {}
    }
}

/// One ray and one surface.
struct One<'a> {
    surface: Surface<'a, P>,
    met: Met<'a>,
    tree: &'a Node,
    limits: &'a Limits<S>,
}

/// What a ray came to.
#[derive(Debug, Default, PartialEq)]
struct Tally {
    points: u32,
    solves: u32,
    verified: u32,
    by_list: u32,
    full: u32,
    /// Of each testing ray.
    lists: Vec<List>,
}

impl One<'_> {
    fn solve(&self, start: [S; 2], tally: &mut Tally) -> Option<At> {
        let (mut scratch, mut work) = (Scratch::<P, 16, 256>::new(), Work::default());
        let mut view = scratch.view();
        tally.solves += 1;
        Solver::new(&self.surface, self.met.planes, self.limits, view.flat, &mut view.basis)
            .solve(start, &mut work)
            .unwrap()
    }

    /// The point that a patch's starts lead to: from the parallelogram, or if the ray is nearly tangential, or it is so asked, from
    /// the entrance; then from the others in turn.
    fn point(&self, patch: usize, entrance_first: bool, tally: &mut Tally) -> Option<At> {
        let (patch, crossing) = (&self.met.patches[patch], self.met.crossing(patch));
        let first = patch.is_critical(&crossing, S::ONE) || entrance_first;
        let [entrance, exit] = match crossing.pierces() {
            Some(both) => both.map(|pierce| Some(patch.at(&pierce))),
            None => [None; 2],
        };
        let flat = patch.parallelogram(&crossing);
        let starts = if first { [entrance, flat, exit] } else { [flat, entrance, exit] };
        starts.into_iter().flatten().find_map(|start| self.solve(start, tally))
    }

    /// Counts a point if it lies in the interval; then it is one to select from.
    fn count(&self, point: Option<At>, tally: &mut Tally) -> Option<At> {
        let point = point.filter(|root| self.met.planes.t_in_interval(root.depth).is_some());
        tally.points += u32::from(point.is_some());
        point
    }

    fn original(&self, tally: &mut Tally) -> Option<At> {
        let mut met = Vec::new();
        leaves(self.tree, self.met.patches, self.met.planes, &mut met);
        met.retain(|&patch| self.met.crossing(patch).overlaps(&self.met.range));
        closest(met.into_iter().map(|patch| self.point(patch, false, tally)).collect::<Vec<_>>(), |point| {
            self.count(point, tally)
        })
    }

    /// The improved method, and what the next ray may begin at.
    fn improved(&self, previous: Option<[S; 2]>, heard: &[Heard], tally: &mut Tally) -> [Option<At>; 2] {
        let begun = previous.and_then(|at| self.solve(at, tally));
        let begun = begun.filter(|root| !self.met.planes.is_before_interval(root.depth));
        let found = begun.and_then(|point| self.verify(point, tally)).or_else(|| {
            tally.full += 1;
            // The ray, as a line, hits others beside the stretch within the surface's box. The voxels may lead to those, too.
            let by_voxels = |k: usize| {
                let sides = self.met.patches[k].domain().bounds::<f64>();
                heard.iter().any(|one| matches!(one, Heard::Patch(tested, _) if *tested == sides))
            };
            let beside = |k: usize| {
                self.met.patches[k]
                    .bounds()
                    .crossing(self.met.planes)
                    .is_some_and(|crossing| crossing.overlaps(&self.met.range))
            };
            let met = (0..self.met.patches.len())
                .filter(|&k| self.met.pierced(k, &self.met.range) || beside(k) && by_voxels(k));
            let met = met.collect::<Vec<_>>();
            closest(met.into_iter().map(|patch| self.point(patch, false, tally)).collect::<Vec<_>>(), |point| {
                self.count(point, tally)
            })
        });
        [found.filter(|root| self.met.planes.t_in_interval(root.depth).is_some()), found]
    }

    /// The closest point, if a testing ray from `point` to the origin can tell.
    fn verify(&self, point: At, tally: &mut Tally) -> Option<At> {
        self.count(Some(point), tally);
        let Testing { list, owner, tangential } = self.met.testing([point.u.number(), point.v.number()], point.depth);
        tally.lists.push(self.met.domains(&list));
        let owner = owner?;
        let others = list.into_iter().filter(|&k| k != owner || tangential).collect::<Vec<_>>();
        if others.is_empty() {
            tally.verified += 1;
            return Some(point);
        }
        tally.by_list += 1;
        let points = others.into_iter().map(|patch| self.point(patch, true, tally)).collect::<Vec<_>>();
        let best = closest(points, |point| self.count(point, tally));
        closest([Some(point), best].to_vec(), |point| point)
    }
}

/// The closest of some points, of those that `counts` lets pass.
fn closest(points: Vec<Option<At>>, counts: impl FnMut(Option<At>) -> Option<At>) -> Option<At> {
    let points = points.into_iter().filter_map(counts);
    points.reduce(|best, point| if point.depth < best.depth { point } else { best })
}

#[test]
fn the_numerical_methods_are_the_text_s() {
    for Case { name, prepared, lines } in cases::<P>() {
        let (scene, limits) = (prepared.scene(), limits::<S>());
        let (all, tree_memory, grids) = (prepared.patches(), prepared.tree(), prepared.grids());
        let patches = |number: u32| all.of_surface(number as usize).unwrap();
        let trees: Vec<_> = scene.surfaces().map(|one| tree(&one.net, patches(one.number), [[0.0, 1.0]; 2])).collect();
        let mut memory = vec![Remembered::EMPTY; scene.len()];
        let mut scratch = Scratch::<P, 16, 256>::new();
        let (mut rays, mut points) = (0, [0; 2]);
        for (number, line) in lines.iter().enumerate() {
            let mut previous = vec![None; scene.len()];
            for one in line {
                let ray = scene.ray(one.origin.map(S::from_f64), one.direction.map(S::from_f64)).unwrap();
                let (mut tally, mut best, mut work) = (Tally::default(), None, Work::default());
                surfaces(&scene, &ray, |surface, planes, range| {
                    let (patches, tree) = (patches(surface.number), &trees[surface.number as usize]);
                    let one = One { surface, met: Met { patches, planes, range }, tree, limits: &limits };
                    if let Some(root) = one.original(&mut tally) {
                        let [u, v] = root.at();
                        let (t, surface) = (planes.t(root.depth), surface.number);
                        best = closer(best, Hit { t, u, v, surface, incidence: root.incidence });
                    }
                });
                let letter = Switches::letter();
                let (interval, view) = (Interval::ahead(), &mut scratch.view());
                let kernel =
                    newton::closest_by(letter, &scene, &all, &tree_memory, &ray, &interval, &limits, view, &mut work);
                assert!(same(kernel.unwrap(), best), "{name}: {one:?}: {kernel:?} {best:?}");
                assert_eq!(
                    [work.intersection_points, work.newton_starts],
                    [tally.points, tally.solves],
                    "{name}: {one:?}"
                );
                points[0] += tally.points;

                let (mut tally, mut best, mut work) = (Tally::default(), None, Work::default());
                crate::text::heard();
                let kernel = newton_coherent::closest_by(
                    letter,
                    &scene,
                    &all,
                    &grids,
                    &mut memory,
                    number as u32,
                    &ray,
                    &interval,
                    &limits,
                    view,
                    &mut work,
                );
                let heard = heard();
                let mut remembered = starts(&heard);
                surfaces(&scene, &ray, |surface, planes, range| {
                    let (patches, tree) = (patches(surface.number), &trees[surface.number as usize]);
                    let one = One { surface, met: Met { patches, planes, range }, tree, limits: &limits };
                    let slot = &mut previous[surface.number as usize];
                    // Of points that differ by rounding the kernel's own.
                    let start = slot.take().map(|[u, v]: [S; 2]| {
                        let start = remembered.next().unwrap();
                        assert!(alike(u, start[0]) && alike(v, start[1]), "{name}: {line:?}");
                        start
                    });
                    let [root, next] = one.improved(start, &heard, &mut tally);
                    *slot = next.map(|root| [root.u.number(), root.v.number()]);
                    if let Some(root) = root {
                        let [u, v] = root.at();
                        let (t, surface) = (planes.t(root.depth), surface.number);
                        best = closer(best, Hit { t, u, v, surface, incidence: root.incidence });
                    }
                });
                assert!(same(kernel.unwrap(), best), "{name}: {one:?}: {kernel:?} {best:?}");
                let counted = [
                    work.intersection_points,
                    work.newton_starts,
                    work.verified,
                    work.decided_by_list,
                    work.full_searches,
                ];
                let of_text = [tally.points, tally.solves, tally.verified, tally.by_list, tally.full];
                assert_eq!(counted, of_text, "{name}: {one:?}");
                assert_eq!(remembered.next(), None, "{name}: {one:?}");
                assert_eq!(lists(&heard), tally.lists, "{name}: {one:?}");
                points[1] += tally.points;
                rays += 1;
            }
        }
        println!("{name}: {rays} rays, {points:?} points");
        assert_eq!(rays, 10_000);
    }
}
