//! The binary tree over a surface's patches, and a ray's descent through it.
//!
//! Source: Barth and Stürzlinger (1993). The tree records how the surface was halved; each inner node has an enclosing
//! parallelepiped, and a leaf's is its patch's. Filled by [`subdivide`](crate::subdivide::subdivide).

use crate::limits::{Limit, Limits, Work};
use crate::patch::Patches;
use crate::patch::{Met, Parallelepiped, Patch};
use crate::planes::Planes;
use crate::scalar::Scalar;
use crate::story::Event;

/// The binary trees of a scene, in pre-order: a view of lent memory.
///
/// `links` holds, for each node of a tree in pre-order, the number of patches below it, 1 for a leaf. A subtree of k
/// patches takes 2k − 1 links and k − 1 inner nodes, so a descent needs neither stack nor pointers: it goes on by one if
/// the ray meets the node's box, else by the whole subtree. Memory is read front to back.
#[derive(Clone, Copy, Debug)]
pub struct Tree<'m, S> {
    nodes: &'m [Parallelepiped<S>],
    links: &'m [u32],
}

/// A ray's way through one surface's tree.
#[derive(Clone, Copy, Debug)]
pub struct Descent<'m, S> {
    nodes: &'m [Parallelepiped<S>],
    links: &'m [u32],
    patches: &'m [Patch<S>],
    /// Inner nodes and leaves behind; their sum is the place in the pre-order.
    inner: usize,
    leaf: usize,
}

impl<'m, S: Scalar> Tree<'m, S> {
    /// The view of memory that was filled before, such as a table in flash.
    pub const fn new(nodes: &'m [Parallelepiped<S>], links: &'m [u32]) -> Self {
        Tree { nodes, links }
    }

    /// All inner nodes.
    pub fn nodes(&self) -> &'m [Parallelepiped<S>] {
        self.nodes
    }

    /// All links.
    pub fn links(&self) -> &'m [u32] {
        self.links
    }

    /// The start of a descent through one surface's tree; `None` if the memory does not hold it.
    #[inline]
    pub fn of_surface(&self, patches: &Patches<'m, S>, surface: usize) -> Option<Descent<'m, S>> {
        // A tree over k patches has k − 1 inner nodes and 2k − 1 links.
        let (first, end) = patches.range(surface)?;
        let next = surface.checked_add(1)?;
        Some(Descent {
            nodes: self.nodes.get(first.checked_sub(surface)?..end.checked_sub(next)?)?,
            links: self.links.get((first * 2).checked_sub(surface)?..(end * 2).checked_sub(next)?)?,
            patches: patches.of_surface(surface)?,
            inner: 0,
            leaf: 0,
        })
    }
}

impl<'m, S: Scalar> Descent<'m, S> {
    /// The next patch whose parallelepiped the ray meets, as a whole line, and all of whose ancestors' it meets too;
    /// `None` at the end of the tree.
    ///
    /// Kept apart from what is done with the patch, so that the loop over nodes has the registers to itself.
    #[inline(never)]
    pub fn next_patch(
        &mut self,
        planes: &Planes<S>,
        limits: &Limits<S>,
        work: &mut Work,
    ) -> Result<Option<Met<'m, S>>, Limit> {
        let (mut inner, mut leaf) = (self.inner, self.leaf);
        let mut nodes_left = limits.nodes.saturating_sub(work.nodes_visited);
        let mut patches_left = limits.patches.saturating_sub(work.patches_tested);
        // Ends: `inner + leaf` grows with each step.
        let found = loop {
            let Some(&below) = self.links.get(inner.saturating_add(leaf)) else {
                break Ok(None);
            };
            if below == 1 {
                let Some(patch) = self.patches.get(leaf) else {
                    break Err(Limit::Slot);
                };
                if patches_left == 0 {
                    break Err(Limit::Patches);
                }
                patches_left -= 1;
                leaf += 1;
                let crossing = patch.bounds().crossing(planes);
                S::tell(|| patch.told(crossing.is_some()));
                if let Some(crossing) = crossing {
                    break Ok(Some((patch, crossing)));
                }
            } else {
                let (Some(node), true) = (self.nodes.get(inner), below > 1) else {
                    break Err(Limit::Slot);
                };
                if nodes_left == 0 {
                    break Err(Limit::Nodes);
                }
                nodes_left -= 1;
                inner += 1;
                let met = node.met(planes);
                S::tell(|| Event::Node { met });
                if !met {
                    // A subtree of k patches has k − 1 inner nodes, this one among them.
                    inner = inner.saturating_add(below as usize - 2);
                    leaf = leaf.saturating_add(below as usize);
                }
            }
        };
        (self.inner, self.leaf) = (inner, leaf);
        work.nodes_visited = limits.nodes.saturating_sub(nodes_left).max(work.nodes_visited);
        work.patches_tested = limits.patches.saturating_sub(patches_left).max(work.patches_tested);
        found
    }
}

#[cfg(test)]
mod tests;
