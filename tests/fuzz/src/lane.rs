//! The methods for rays of no view, with what one thread needs for them.

use crate::common::{Kind, Prepared};
use crate::ready::Takes;
use patchray::limits::{Acceptance, Extent, GaveUp, Limits, Work};
use patchray::method::{ClipScratch, Remembered, Scratch, clipping, clipping_coherent, newton, newton_coherent};
use patchray::point::Point;
use patchray::ray::{Hit, Interval, Ray};

pub(crate) type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// A method, and whether it falls back on clipping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    Newton,
    NewtonProving,
    NewtonCoherent,
    NewtonCoherentProving,
    Clipping,
    ClippingCoherent,
}

impl Way {
    pub(crate) const ALL: [Way; 6] = [
        Way::Newton,
        Way::NewtonProving,
        Way::NewtonCoherent,
        Way::NewtonCoherentProving,
        Way::Clipping,
        Way::ClippingCoherent,
    ];

    /// What of a model's preparation it takes.
    pub(crate) fn takes(self) -> Takes {
        match self {
            Way::Newton | Way::NewtonProving => Takes { patches: true, tree: true, grids: false },
            Way::NewtonCoherent | Way::NewtonCoherentProving | Way::ClippingCoherent => {
                Takes { patches: true, tree: false, grids: true }
            }
            Way::Clipping => Takes::default(),
        }
    }

    /// The method without memory that a coherent one is made of.
    pub(crate) fn original(self) -> Option<Way> {
        match self {
            Way::NewtonCoherent => Some(Way::Newton),
            Way::NewtonCoherentProving => Some(Way::NewtonProving),
            Way::ClippingCoherent => Some(Way::Clipping),
            _ => None,
        }
    }

    /// Whether it answers rightly whatever the ray meets, as far as numbers can tell, under this rule.
    pub(crate) fn proves(self, acceptance: Acceptance) -> bool {
        match self {
            Way::Clipping => true,
            Way::Newton | Way::NewtonCoherent => false,
            Way::NewtonProving | Way::NewtonCoherentProving | Way::ClippingCoherent => acceptance == Acceptance::Proved,
        }
    }

    /// How large a scene is to it.
    pub(crate) fn extent<P: Kind>(self, prepared: &Prepared<P>, acceptance: Acceptance) -> Extent {
        let coherent = matches!(self, Way::NewtonCoherent | Way::NewtonCoherentProving | Way::ClippingCoherent);
        let falls_back = matches!(self, Way::NewtonProving | Way::NewtonCoherentProving);
        let clips = matches!(self, Way::Clipping | Way::ClippingCoherent);
        let descends = matches!(self, Way::Newton | Way::NewtonProving);
        Extent {
            surfaces: prepared.surfaces.len() as u32,
            nodes: if descends { prepared.nodes.len() as u32 } else { 0 },
            patches: if self == Way::Clipping { 0 } else { prepared.patches.len() as u32 },
            scene_voxels: prepared.scene().longest_walk(),
            surface_voxels: if coherent { prepared.grids().longest_walks() } else { 0 },
            walks: if coherent { 2 } else { 0 },
            clipped: clips || falls_back && acceptance == Acceptance::Proved,
            ..Extent::default()
        }
    }
}

/// Scratch and coherence memory.
pub(crate) struct Lane<P: Point> {
    newton: Box<Scratch<P, 16, 256>>,
    clips: Box<ClipScratch<P, 16, 256, 64>>,
    pub(crate) remembered: Vec<Remembered<P::Scalar>>,
    /// Of the last call.
    pub(crate) work: Work,
}

impl<P: Kind> Lane<P> {
    pub(crate) fn new(surfaces: usize) -> Self {
        Lane {
            newton: Box::new(Scratch::new()),
            clips: Box::new(ClipScratch::new()),
            remembered: vec![Remembered::EMPTY; surfaces],
            work: Work::default(),
        }
    }

    /// The closest hit of a ray, of this scan line if the way is a coherent one.
    pub(crate) fn closest(
        &mut self,
        way: Way,
        prepared: &Prepared<P>,
        scan_line: u32,
        ray: &Ray<P::Scalar>,
        interval: &Interval<P::Scalar>,
        limits: &Limits<P::Scalar>,
    ) -> Answer<P::Scalar> {
        let (scene, patches, tree, grids) = (prepared.scene(), prepared.patches(), prepared.tree(), prepared.grids());
        let Lane { newton, clips, remembered, work } = self;
        let room = &mut clips.view();
        match way {
            Way::Newton => newton::closest(&scene, &patches, &tree, ray, interval, limits, &mut newton.view(), work),
            Way::NewtonProving => {
                let scratch = &mut newton.view_with(clips.view());
                newton::closest(&scene, &patches, &tree, ray, interval, limits, scratch, work)
            }
            Way::NewtonCoherent => {
                let scratch = &mut newton.view();
                newton_coherent::closest(
                    &scene, &patches, &grids, remembered, scan_line, ray, interval, limits, scratch, work,
                )
            }
            Way::NewtonCoherentProving => {
                let scratch = &mut newton.view_with(clips.view());
                newton_coherent::closest(
                    &scene, &patches, &grids, remembered, scan_line, ray, interval, limits, scratch, work,
                )
            }
            Way::Clipping => clipping::closest(&scene, ray, interval, limits, room, work),
            Way::ClippingCoherent => clipping_coherent::closest(
                &scene, &patches, &grids, remembered, scan_line, ray, interval, limits, room, work,
            ),
        }
    }

    /// All hits, or some hit, of a ray by the methods that find these; `None` of the others.
    pub(crate) fn all_and_any(
        &mut self,
        way: Way,
        prepared: &Prepared<P>,
        ray: &Ray<P::Scalar>,
        interval: &Interval<P::Scalar>,
        limits: &Limits<P::Scalar>,
    ) -> Option<Lists<P::Scalar>> {
        let (scene, patches, tree) = (prepared.scene(), prepared.patches(), prepared.tree());
        let (mut hits, mut work) = (heapless::Vec::<_, 40>::new(), [Work::default(); 2]);
        let Lane { newton, clips, .. } = self;
        let (all, any) = match way {
            Way::Newton => {
                let scratch = &mut newton.view();
                (
                    newton::all_hits(&scene, &patches, &tree, ray, interval, limits, scratch, &mut hits, &mut work[0]),
                    newton::any_hit(&scene, &patches, &tree, ray, interval, limits, scratch, &mut work[1]),
                )
            }
            Way::NewtonProving => {
                let scratch = &mut newton.view_with(clips.view());
                (
                    newton::all_hits(&scene, &patches, &tree, ray, interval, limits, scratch, &mut hits, &mut work[0]),
                    newton::any_hit(&scene, &patches, &tree, ray, interval, limits, scratch, &mut work[1]),
                )
            }
            Way::Clipping => {
                let room = &mut clips.view();
                (
                    clipping::all_hits(&scene, ray, interval, limits, room, &mut hits, &mut work[0]),
                    clipping::any_hit(&scene, ray, interval, limits, room, &mut work[1]),
                )
            }
            _ => return None,
        };
        Some(Lists { all: all.map(|()| hits.to_vec()), found: hits.to_vec(), any, work })
    }
}

/// What asking for all hits, and for any, came to.
#[derive(Debug)]
pub(crate) struct Lists<S> {
    /// All of them, unless a bound ran out.
    pub(crate) all: Result<Vec<Hit<S>>, GaveUp<S>>,
    /// Those found by then.
    pub(crate) found: Vec<Hit<S>>,
    pub(crate) any: Answer<S>,
    /// Of the one call and of the other.
    pub(crate) work: [Work; 2],
}
