//! What both families have: what the kernel tells of a ray, the surfaces that a ray meets, the testing ray's list, and when two
//! answers are one.

use crate::scenes::limits;
use patchray::limits::Work;
use patchray::parameter::Number;
use patchray::patch::{Crossing, Patch, Pierce};
use patchray::planes::{DepthRange, Planes};
use patchray::point::Plain;
use patchray::ray::{Hit, Interval};
use patchray::root::Root;
use patchray::scalar::Scalar;
use patchray::scene::Scene;
use patchray::story::Event;
use patchray::surface::Surface;
use patchray::told::{Listener, Told};
use std::cell::RefCell;

thread_local! {
    static HEARD: RefCell<Vec<Heard>> = const { RefCell::new(Vec::new()) };
}

/// What the kernel tells of a ray.
#[derive(Clone, Copy)]
pub(crate) enum Heard {
    /// The (u, v) that the ray before has left.
    Remembered([f64; 2]),
    /// A new testing ray.
    Testing,
    /// A patch's domain, and whether it was listed.
    Patch([[f64; 2]; 2], bool),
}

/// The domains of the patches in a testing ray's list, in order.
pub(crate) type List = Vec<[[f64; 2]; 2]>;

#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub(crate) struct Ear;

impl Listener for Ear {
    fn hear(event: Event) {
        HEARD.with_borrow_mut(|heard| match event {
            Event::Remembered(start) => heard.push(Heard::Remembered(start)),
            Event::Testing => heard.push(Heard::Testing),
            // What is listed is the patch that was tested last.
            Event::Patch { sides, met: true } => heard.push(Heard::Patch(sides, false)),
            Event::Listed { .. } => {
                if let Some(Heard::Patch(_, listed)) = heard.last_mut() {
                    *listed = true;
                }
            }
            _ => {}
        });
    }
}

pub(crate) type S = Told<f64, Ear>;
pub(crate) type P = Plain<S>;
pub(crate) type At = Root<Number<S>>;

/// Of two hits on different surfaces the closer, and of equal ones that of the lower number.
pub(crate) fn closer(best: Option<Hit<S>>, hit: Hit<S>) -> Option<Hit<S>> {
    Some(best.filter(|best| (best.t, best.surface) <= (hit.t, hit.surface)).unwrap_or(hit))
}

/// Every surface whose min-max box the ray meets.
pub(crate) fn surfaces<'s>(
    scene: &Scene<'s, P>,
    ray: &patchray::ray::Ray<S>,
    mut visit: impl FnMut(Surface<'s, P>, &Planes<S>, DepthRange<S>),
) {
    let (mut work, interval) = (Work::default(), Interval::ahead());
    scene
        .visit(ray, &interval, &limits(), &mut work, |surface, planes, range, _| {
            visit(*surface, planes, range);
            Ok(S::INFINITY)
        })
        .unwrap();
}

pub(crate) fn sorted(mut list: List) -> List {
    list.sort_by(|a, b| a.as_flattened().partial_cmp(b.as_flattened()).unwrap());
    list
}

/// The lists of testing rays.
pub(crate) fn lists(heard: &[Heard]) -> Vec<List> {
    let rays = heard.split(|one| matches!(one, Heard::Testing)).skip(1);
    let listed = |one: &Heard| match *one {
        Heard::Patch(sides, true) => Some(sides),
        _ => None,
    };
    rays.map(|ray| sorted(ray.iter().filter_map(listed).collect())).collect()
}

/// Whether two numbers differ by no more than the end of Newton's method leaves open.
pub(crate) fn alike(a: S, b: S) -> bool {
    (a.to_f64() - b.to_f64()).abs() <= 1e-6 * (1.0 + a.to_f64().abs())
}

/// Whether two answers are one. Where neighbours meet, two patches lead to one point, which they find to within rounding, and the
/// text does not say which of them is kept.
pub(crate) fn same(a: Option<Hit<S>>, b: Option<Hit<S>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => a.surface == b.surface && alike(a.t, b.t) && alike(a.u, b.u) && alike(a.v, b.v),
        (a, b) => a == b,
    }
}

/// One ray, and one surface's patches.
pub(crate) struct Met<'a> {
    pub(crate) patches: &'a [Patch<S>],
    pub(crate) planes: &'a Planes<S>,
    /// Within the surface's box.
    pub(crate) range: DepthRange<S>,
}

/// What a testing ray comes to.
pub(crate) struct Testing {
    /// All patches that it hits.
    pub(crate) list: Vec<usize>,
    /// The one that holds the point.
    pub(crate) owner: Option<usize>,
    /// Whether eq. (1) holds for the ray and that one.
    pub(crate) tangential: bool,
}

impl Met<'_> {
    pub(crate) fn crossing(&self, patch: usize) -> Crossing<S> {
        self.patches[patch].bounds().crossing(self.planes).unwrap()
    }

    /// Whether the ray is inside a patch's parallelepiped anywhere in a range.
    pub(crate) fn pierced(&self, patch: usize, range: &DepthRange<S>) -> bool {
        let Some(crossing) = self.patches[patch].bounds().crossing(self.planes) else { return false };
        let within = |[first, last]: [Pierce<S>; 2]| first.depth <= range.max && last.depth >= range.min;
        crossing.overlaps(range) && crossing.pierces().is_none_or(within)
    }

    /// The testing ray from a point of the surface to the origin.
    pub(crate) fn testing(&self, [u, v]: [S; 2], depth: S) -> Testing {
        let range = DepthRange { min: self.range.min, max: depth };
        let holds = |k: usize| self.patches[k].domain().holds(u, v);
        let hit = |&k: &usize| self.pierced(k, &range) || (holds(k) && self.patches[k].bounds().met(self.planes));
        let list: Vec<_> = (0..self.patches.len()).filter(hit).collect();
        let owner = list.iter().copied().find(|&k| holds(k));
        let tangential = owner.is_some_and(|owner| self.patches[owner].is_critical(&self.crossing(owner), S::ONE));
        Testing { list, owner, tangential }
    }

    /// The domains of listed patches, in the order of [`lists`].
    pub(crate) fn domains(&self, list: &[usize]) -> List {
        sorted(list.iter().map(|&k| self.patches[k].domain().bounds()).collect())
    }
}

/// The points that the kernel began at, in the order of its surfaces.
pub(crate) fn starts(heard: &[Heard]) -> impl Iterator<Item = [S; 2]> {
    heard.iter().filter_map(|one| match *one {
        Heard::Remembered(start) => Some(start.map(S::from_f64)),
        _ => None,
    })
}

/// What the kernel has told since this was last asked.
pub(crate) fn heard() -> Vec<Heard> {
    HEARD.take()
}
