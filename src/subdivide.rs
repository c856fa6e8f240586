//! Subdivision of surfaces into patches, and the binary tree over them.
//!
//! Source: Barth and Stürzlinger (1993); the paper's preprocessing step. A piece is halved in the direction of larger
//! curvature until it is flat. What the paper leaves open: "curvature" is the bound of the distance between chord and surface,
//! and "flat" is that bend in u, bend in v and twist together, bounds of the distance between the piece and its parallelogram, are
//! at most the flatness times the scene's diagonal, and a share of the surface's size.

use crate::arena::{Arena, Need};
use crate::bernstein::Full;
use crate::domain::{Domain, MAX_LEVEL};
use crate::frame::{Frame, PADDING};
use crate::measure::Measure;
use crate::patch::{Parallelepiped, Patch, Patches};
use crate::point::Point;
use crate::reading::{Ours, Reading};
use crate::scalar::Scalar;
use crate::surface::{Net, Surface};
use crate::tree::Tree;
use heapless::vec::{Vec, VecView};

/// How finely surfaces are subdivided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subdivision<S> {
    /// How far a patch may be from its parallelogram, as a share of the diagonal of the control points' box. Smaller makes
    /// more patches (about as 1/flatness), better starts and fewer lost roots; 1e-3 to 2e-3 is the knee.
    pub flatness: S,
    /// How often a surface may be halved in each direction, at most [`MAX_LEVEL`]. A patch that is still not flat is kept,
    /// and every ray counts as critical there.
    pub depth: u32,
    /// The most patches a surface may make; more is refused.
    pub patches_per_surface: u32,
    /// By how many roundings boxes are larger than what they enclose; see [`PADDING`]. Less than
    /// that makes tests that rounding can turn into misses.
    pub padding: u32,
}

impl<S: Scalar> Default for Subdivision<S> {
    /// The flatness at which the teapot makes about the paper's 7,594 patches.
    fn default() -> Self {
        Subdivision { flatness: S::from_f64(6.6e-4), depth: MAX_LEVEL, patches_per_surface: 1 << 20, padding: PADDING }
    }
}

/// Lent memory for patches.
#[derive(Debug)]
pub struct PatchMemory<'m, S> {
    /// The patches of all surfaces, surface by surface.
    pub patches: &'m mut [Patch<S>],
    /// Where each surface's patches begin, and at last where they end: surfaces + 1 slots.
    pub first: &'m mut [u32],
}

/// Lent memory for binary trees; only the original method needs it.
#[derive(Debug)]
pub struct TreeMemory<'m, S> {
    /// The inner nodes' parallelepipeds: patches − surfaces of them.
    pub nodes: &'m mut [Parallelepiped<S>],
    /// One slot per inner node or leaf: 2 · patches − surfaces of them.
    pub links: &'m mut [u32],
}

/// Slots that subdivision needs, and what it was lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SubdivideNeeds {
    /// Of [`PatchMemory::patches`].
    pub patches: Need,
    /// Of [`PatchMemory::first`].
    pub first: Need,
    /// Of [`TreeMemory::nodes`].
    pub nodes: Need,
    /// Of [`TreeMemory::links`].
    pub links: Need,
}

/// Why subdivision ended without patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubdivideError {
    /// Lent memory is too small; all needs are listed. Lending nothing is how to ask.
    Memory(SubdivideNeeds),
    /// The scratch is too small for the degrees of this surface.
    Scratch {
        /// The surface's number.
        surface: u32,
    },
    /// This surface would make more patches than [`Subdivision::patches_per_surface`].
    Patches {
        /// The surface's number.
        surface: u32,
    },
}

impl core::fmt::Display for SubdivideError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            SubdivideError::Memory(needs) => write!(f, "lent memory is too small: {needs:?}"),
            SubdivideError::Scratch { surface } => write!(f, "the scratch is too small for surface {surface}"),
            SubdivideError::Patches { surface } => write!(f, "surface {surface} makes more patches than allowed"),
        }
    }
}

impl core::error::Error for SubdivideError {}

/// However small a surface is in its scene, its patches are as near to their parallelograms as this share of its longest side.
/// (What is small shows few pixels, so that a share of the scene is what most pictures want; but starts and boxes of a patch
/// that is nowhere near flat are worth nothing.) Smaller makes more patches of small surfaces.
const COARSEST: f64 = 1.0 / 32.0;

/// What is still to be done on the way through a tree.
#[derive(Clone, Copy, Debug)]
enum Pending {
    /// Measure this piece, and halve it if it is not flat.
    Piece(Domain),
    /// The node with this link is complete; its patches began with this number.
    Close { link: usize, patches: usize },
}

/// A path through the tree leaves a sibling and a node to close on each of its levels.
const PENDING: usize = 2 * (2 * MAX_LEVEL as usize) + 1;

/// Working memory of subdivision: one net of up to `POINTS` control points, that is (n + 1)(m + 1) for the largest degrees.
#[derive(Debug)]
pub struct SubdivideScratch<P, const POINTS: usize> {
    net: Vec<P, POINTS>,
    pending: Vec<Pending, PENDING>,
}

/// A view of [`SubdivideScratch`] without its capacity.
#[derive(Debug)]
pub struct SubdivideScratchView<'s, P> {
    net: &'s mut VecView<P>,
    pending: &'s mut VecView<Pending>,
}

impl<P: Point, const POINTS: usize> SubdivideScratch<P, POINTS> {
    /// Empty scratch, usable in a static.
    pub const fn new() -> Self {
        SubdivideScratch { net: Vec::new(), pending: Vec::new() }
    }

    /// The view that [`subdivide`] takes.
    pub fn view(&mut self) -> SubdivideScratchView<'_, P> {
        SubdivideScratchView { net: &mut self.net, pending: &mut self.pending }
    }
}

impl<P: Point, const POINTS: usize> Default for SubdivideScratch<P, POINTS> {
    fn default() -> Self {
        Self::new()
    }
}

/// Patches, and the tree over them if it was asked for.
pub type Subdivided<'m, S> = (Patches<'m, S>, Option<Tree<'m, S>>);

/// Subdivides surfaces, given in the frame, into patches, and builds the binary trees if memory for them is offered.
///
/// The tree is part of the result only if `tree` is `Some`. Too little memory is an error that lists all needs, so empty
/// slices ask for them.
pub fn subdivide<'m, 'n, P: Point>(
    surfaces: impl Iterator<Item = Surface<'n, P>>,
    frame: &Frame<P::Scalar>,
    options: &Subdivision<P::Scalar>,
    scratch: &mut SubdivideScratchView<'_, P>,
    memory: PatchMemory<'m, P::Scalar>,
    tree: Option<TreeMemory<'m, P::Scalar>>,
) -> Result<Subdivided<'m, P::Scalar>, SubdivideError> {
    subdivide_by(Ours, surfaces, frame, options, scratch, memory, tree)
}

/// [`subdivide`] by another reading of the paper.
pub fn subdivide_by<'m, 'n, P: Point>(
    reading: impl Reading,
    surfaces: impl Iterator<Item = Surface<'n, P>>,
    frame: &Frame<P::Scalar>,
    options: &Subdivision<P::Scalar>,
    scratch: &mut SubdivideScratchView<'_, P>,
    memory: PatchMemory<'m, P::Scalar>,
    tree: Option<TreeMemory<'m, P::Scalar>>,
) -> Result<Subdivided<'m, P::Scalar>, SubdivideError> {
    let mut patches = Arena::new(memory.patches);
    let mut first = Arena::new(memory.first);
    let wants_tree = tree.is_some();
    let (nodes, links): (&mut [_], &mut [_]) = match tree {
        Some(memory) => (memory.nodes, memory.links),
        None => (&mut [], &mut []),
    };
    let mut nodes = Arena::new(nodes);
    let mut links = Arena::new(links);
    let depth = options.depth.min(MAX_LEVEL);

    for (number, Surface { net, shape, .. }) in (0_u32..).zip(surfaces) {
        let padding = P::Scalar::EPSILON * P::Scalar::from_u32(options.padding) * shape.unit();
        let coarsest = shape.size * P::Scalar::from_f64(COARSEST);
        let tolerance = (options.flatness * frame.diagonal()).lesser(coarsest);
        let begin = patches.len();
        first.push(begin as u32);
        scratch.pending.clear();
        let push = |pending: &mut VecView<Pending>, piece| {
            pending.push(piece).map_err(|_| SubdivideError::Scratch { surface: number })
        };
        push(scratch.pending, Pending::Piece(Domain::WHOLE))?;
        // Ends: each piece is halved at most `depth` times in each direction, and the number of patches is bounded.
        while let Some(next) = scratch.pending.pop() {
            let domain = match next {
                Pending::Close { link, patches: before } => {
                    links.set(link, (patches.len() - before) as u32);
                    continue;
                }
                Pending::Piece(domain) => domain,
            };
            let [u, v] = domain.bounds();
            net.restrict(u, v, scratch.net).map_err(|Full| SubdivideError::Scratch { surface: number })?;
            let Ok(piece) = Net::new(net.degree_u(), net.degree_v(), scratch.net.as_slice()) else {
                return Err(SubdivideError::Scratch { surface: number });
            };
            let measure = Measure::of(&piece, padding);
            let flat = measure.bend_u + measure.bend_v + measure.twist <= tolerance;
            let direction = if flat { None } else { direction_to_halve(reading, &measure, domain.levels(), depth) };
            let Some(along_u) = direction else {
                if patches.len() - begin >= options.patches_per_surface as usize {
                    return Err(SubdivideError::Patches { surface: number });
                }
                patches.push(measure.patch(if flat { domain } else { domain.rough() }));
                links.push(1);
                continue;
            };
            let [low, high] = domain.halves(along_u);
            push(scratch.pending, Pending::Close { link: links.len(), patches: patches.len() })?;
            push(scratch.pending, Pending::Piece(high))?;
            push(scratch.pending, Pending::Piece(low))?;
            links.push(0);
            nodes.push(measure.bounds);
        }
    }
    first.push(patches.len() as u32);
    let mut needs = SubdivideNeeds { patches: patches.need(), first: first.need(), ..Default::default() };
    if wants_tree {
        (needs.nodes, needs.links) = (nodes.need(), links.need());
    }
    if ![needs.patches, needs.first, needs.nodes, needs.links].iter().all(Need::met) {
        return Err(SubdivideError::Memory(needs));
    }
    let tree = wants_tree.then(|| Tree::new(nodes.finish(), links.finish()));
    Ok((Patches::new(patches.finish(), first.finish()), tree))
}

/// Whether to halve in u (true) or in v, `None` if both directions are at their depth.
///
/// The direction of larger bend, or of more turning; where both are straight (a twisted bilinear piece), across the longer side.
fn direction_to_halve<S: Scalar>(
    reading: impl Reading,
    measure: &Measure<S>,
    levels: [u32; 2],
    depth: u32,
) -> Option<bool> {
    let [bend_u, bend_v] = [measure.bend_u, measure.bend_v];
    let prefer_u = if bend_u == bend_v {
        measure.sides[0] >= measure.sides[1]
    } else if reading.bend_halving() {
        bend_u > bend_v
    } else {
        // The bend is an eighth of the second derivative's bound over the piece; the turning is that over the side.
        bend_u * measure.sides[1] > bend_v * measure.sides[0]
    };
    match (levels[0] < depth, levels[1] < depth) {
        (true, true) => Some(prefer_u),
        (true, false) => Some(true),
        (false, true) => Some(false),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests;
