//! Where in a scan line a patch can be seen, and what of that lies around one ray.

use crate::limits::{Limit, Limits, Work, spend};
use crate::patch::{Crossing, Patch};
use crate::planes::Planes;
use crate::scalar::Scalar;

/// Where in a scan line a patch can be seen: a slot of lent memory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Span<S> {
    /// The least and the largest x.
    pub(crate) x: [S; 2],
    /// The least depth.
    pub(crate) near: S,
    /// The surface's number in the scene.
    pub(crate) surface: u32,
    /// The patch's number in the scene.
    pub(crate) patch: u32,
    /// The next one of those that begin in the same bucket, or `u32::MAX`.
    pub(crate) next: u32,
    /// The bucket in which it ends.
    pub(crate) last: u32,
}

impl<S: Scalar> Span<S> {
    /// What a slot holds before it is filled: zeros, of which static memory takes no flash.
    pub const EMPTY: Self = Span { x: [S::ZERO; 2], near: S::ZERO, surface: 0, patch: 0, next: 0, last: 0 };

    #[inline(always)]
    fn holds(&self, x: S) -> bool {
        self.x[0] <= x && x <= self.x[1]
    }

    /// Whether it comes before another one: nearer, of whatever surface. No two are equal, so that the list is the same in whatever
    /// order it was built.
    #[inline(always)]
    pub(crate) fn is_before(&self, other: &Self) -> bool {
        self.near < other.near || (self.near == other.near && self.patch < other.patch)
    }
}

/// The spans around a ray, and others that end in the same bucket.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InLine<'l, S> {
    pub(crate) spans: &'l [Span<S>],
    pub(crate) list: &'l [u32],
    pub(crate) x: S,
    /// The patches of the view.
    pub(crate) patches: &'l [Patch<S>],
}

impl<S: Scalar> InLine<'_, S> {
    /// Skips the first ones that do not hold the ray.
    #[inline(always)]
    pub(crate) fn skip(&mut self) {
        // Ends with the list.
        while let Some((&first, after)) = self.list.split_first() {
            if self.spans.get(first as usize).is_none_or(|span| span.holds(self.x)) {
                break;
            }
            self.list = after;
        }
    }

    /// Calls `visit` with each patch whose parallelepiped the ray meets, and its surface's number: in the order of the list, up to
    /// the depth that `visit` returned last. Patches for which `skip` says so are left out untested.
    #[inline(always)]
    pub(crate) fn visit(
        &self,
        planes: &Planes<S>,
        mut farthest: S,
        limits: &Limits<S>,
        work: &mut Work,
        skip: impl Fn(u32, &Patch<S>) -> bool,
        mut visit: impl FnMut(u32, &Patch<S>, &Crossing<S>, &mut Work) -> Result<S, Limit>,
    ) -> Result<(), Limit> {
        for &number in self.list {
            spend(&mut work.spans_visited, limits.spans, Limit::Spans)?;
            let span = self.spans.get(number as usize).ok_or(Limit::Slot)?;
            if !span.holds(self.x) {
                continue;
            }
            if !(span.near <= farthest) {
                break;
            }
            let patch = self.patches.get(span.patch as usize).ok_or(Limit::Slot)?;
            if skip(span.surface, patch) {
                continue;
            }
            spend(&mut work.patches_tested, limits.patches, Limit::Patches)?;
            let crossing = patch.bounds().crossing(planes);
            S::tell(|| patch.told(crossing.is_some()));
            if let Some(crossing) = crossing {
                farthest = visit(span.surface, patch, &crossing, work)?;
            }
        }
        Ok(())
    }

    /// Whether the list holds a span of the surface around the ray.
    #[inline(always)]
    pub(crate) fn holds_surface(&self, surface: u32) -> bool {
        let spans = self.list.iter().filter_map(|&number| self.spans.get(number as usize));
        spans.into_iter().any(|span| span.surface == surface && span.holds(self.x))
    }

    /// The surface of the first span.
    #[inline(always)]
    pub(crate) fn first_surface(&self) -> Option<u32> {
        Some(self.spans.get(*self.list.first()? as usize)?.surface)
    }
}
