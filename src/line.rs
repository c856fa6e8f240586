//! A scan line of a view: which patches a ray can meet, from where it is in the line.
//!
//! Each patch that can be seen in the line's rows has a span of x there. Spans hang in buckets by where they begin, so that
//! nothing is sorted. While rays go along the line, the spans around them are kept in a short list, the nearest patch first; a
//! ray that goes back builds the list anew, so that any order of rays gives the same answers.
//!
//! Ours: an active list over a scan line, as scan conversion of polygons has had since C. Wylie, G. Romney, D. Evans and
//! A. Erdahl, "Half-tone perspective drawings by computer", AFIPS 1967.

use crate::arena::{Arena, Need};
use crate::limits::{Limit, Limits, Work, spend};
use crate::patch::Patch;
use crate::point::Point;
use crate::scalar::Scalar;
use crate::span::{InLine, Span};
use crate::story::Event;
use crate::view::{RUN, Sight, View, ViewRay};

const NONE: u32 = u32::MAX;

/// Lent memory for a scan line.
#[derive(Debug)]
pub struct LineMemory<'m, S> {
    /// The patches that can be seen in the line: at most as many as there are.
    pub spans: &'m mut [Span<S>],
    /// As many slots as `spans` holds.
    pub active: &'m mut [u32],
    /// Buckets, at least one. About as many as there are spans is best; fewer make the list be rebuilt from longer chains, which
    /// counts against [`Limits::spans`], more are cleared and passed for nothing.
    pub buckets: &'m mut [u32],
}

/// Slots that a scan line needs, and what it was lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineNeeds {
    /// Of [`LineMemory::spans`].
    pub spans: Need,
    /// Of [`LineMemory::active`].
    pub active: Need,
    /// Of [`LineMemory::buckets`].
    pub buckets: Need,
}

/// The part of a view's image that a scan line's rays are of: least and largest x, least and largest y. For rays in one row
/// both y are the same; where rays are jittered, they are the row's edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window<S> {
    /// Least and largest x.
    pub x: [S; 2],
    /// Least and largest y.
    pub y: [S; 2],
}

/// A scan line of a view, ready for its rays.
#[derive(Debug)]
pub struct Line<'m, S> {
    window: Window<S>,
    spans: &'m [Span<S>],
    buckets: &'m [u32],
    /// Numbers of spans that may hold the ray, in order.
    active: &'m mut [u32],
    /// How many of them there are.
    count: usize,
    /// Buckets per unit of x.
    per_unit: S,
    /// The bucket that the list is of; none before the first ray.
    bucket: Option<u32>,
}

impl<'m, S: Scalar> Line<'m, S> {
    /// The spans of a view's patches. Too little memory is an error that lists all needs.
    pub fn build<P: Point<Scalar = S>>(
        view: &View<'_, P>,
        window: Window<S>,
        memory: LineMemory<'m, S>,
    ) -> Result<Self, LineNeeds> {
        let Window { x: [begin, end], y: [low, high] } = window;
        let LineMemory { spans, active, buckets } = memory;
        buckets.fill(NONE);
        let per_unit = if begin < end { S::from_u32(buckets.len() as u32) / (end - begin) } else { S::ZERO };
        let buckets_given = buckets.len();
        let mut filling = Filling { window, spans: Arena::new(spans), buckets, per_unit };
        for (surface, &[from, to]) in (0_u32..).zip(view.surfaces()) {
            if !(from <= high && low <= to) {
                continue;
            }
            let Some((first, sights, runs)) = view.patches_of(surface as usize) else {
                continue;
            };
            for ((number, run), &[from, to]) in (first..).step_by(RUN).zip(sights.chunks(RUN)).zip(runs) {
                if from <= high && low <= to {
                    for (patch, of_patch) in (number..).zip(run) {
                        filling.add(of_patch, surface, patch);
                    }
                }
            }
        }
        let Filling { spans, buckets, .. } = filling;
        let needs = LineNeeds {
            spans: spans.need(),
            active: Need { needed: spans.len(), given: active.len() },
            buckets: Need { needed: 1, given: buckets_given },
        };
        if !(needs.spans.met() && needs.active.met() && needs.buckets.met()) {
            return Err(needs);
        }
        Ok(Line { window, spans: spans.finish(), buckets, active, count: 0, per_unit, bucket: None })
    }

    /// Brings the list to a ray's place in the line.
    #[inline(always)]
    fn go_to(&mut self, ray: &ViewRay<S>, most: u32, work: &mut Work) -> Result<(), Limit> {
        S::tell(|| Event::Ray);
        let Window { x: [left, right], y: [low, high] } = self.window;
        let [x, y] = ray.place;
        if !(left <= x && x <= right && low <= y && y <= high) {
            return Err(Limit::Line);
        }
        let bucket = bucket_of(x - left, self.per_unit, self.buckets.len());
        if self.bucket == Some(bucket) { Ok(()) } else { self.rebuild(bucket, most, work) }
    }

    /// The list of a bucket: what an earlier one's holds and goes on to this one, and what begins in between.
    #[inline(never)]
    fn rebuild(&mut self, bucket: u32, most: u32, work: &mut Work) -> Result<(), Limit> {
        // Nothing, until it is complete: the budget may run out.
        let before = self.bucket.take().filter(|&before| before < bucket);
        let kept = if before.is_some() { self.count } else { 0 };
        self.count = 0;
        for k in 0..kept {
            let number = self.active.get(k).copied().ok_or(Limit::Slot)?;
            if self.span(number)?.last >= bucket {
                *self.active.get_mut(self.count).ok_or(Limit::Slot)? = number;
                self.count += 1;
            }
        }
        for begins in before.map_or(0, |before| before + 1)..=bucket {
            let mut next = self.buckets.get(begins as usize).copied().ok_or(Limit::Slot)?;
            // Ends: each span names one that was filled before it.
            while next != NONE {
                spend(&mut work.spans_visited, most, Limit::Spans)?;
                let span = self.span(next)?;
                if span.last >= bucket {
                    self.insert(next, most, work)?;
                }
                next = span.next;
            }
        }
        self.bucket = Some(bucket);
        Ok(())
    }

    #[inline(always)]
    fn span(&self, number: u32) -> Result<&'m Span<S>, Limit> {
        self.spans.get(number as usize).ok_or(Limit::Slot)
    }

    /// Puts a span into the list, in order.
    #[inline(always)]
    fn insert(&mut self, number: u32, most: u32, work: &mut Work) -> Result<(), Limit> {
        let span = self.span(number)?;
        let mut at = self.count;
        // Ends: `at` falls.
        while let Some(before) = at.checked_sub(1) {
            spend(&mut work.spans_visited, most, Limit::Spans)?;
            let other = self.active.get(before).copied().ok_or(Limit::Slot)?;
            if !span.is_before(self.span(other)?) {
                break;
            }
            *self.active.get_mut(at).ok_or(Limit::Slot)? = other;
            at = before;
        }
        *self.active.get_mut(at).ok_or(Limit::Slot)? = number;
        self.count += 1;
        Ok(())
    }

    /// The spans that may hold a ray; `None` if none does.
    #[inline(always)]
    pub(crate) fn nearby<'l>(
        &'l mut self,
        patches: &'l [Patch<S>],
        ray: &ViewRay<S>,
        limits: &Limits<S>,
        work: &mut Work,
    ) -> Result<Option<InLine<'l, S>>, Limit> {
        self.go_to(ray, limits.spans.saturating_add(work.spans_visited), work)?;
        let mut nearby =
            InLine { spans: self.spans, list: self.active.get(..self.count).unwrap_or(&[]), x: ray.place[0], patches };
        nearby.skip();
        Ok(if nearby.list.is_empty() { None } else { Some(nearby) })
    }
}

/// A line being filled.
struct Filling<'m, S> {
    window: Window<S>,
    spans: Arena<'m, Span<S>>,
    buckets: &'m mut [u32],
    per_unit: S,
}

impl<S: Scalar> Filling<'_, S> {
    /// Adds what can be seen of a patch in the window, if anything.
    #[inline(always)]
    fn add(&mut self, sight: &Sight<S>, surface: u32, patch: u32) {
        let [left, right] = self.window.x;
        let Some(x) = sight.outline.across(self.window.y).filter(|x| x[0] <= right && left <= x[1]) else {
            return;
        };
        let buckets = self.buckets.len();
        let [first, last] = x.map(|x| bucket_of(x - left, self.per_unit, buckets));
        let number = self.spans.len() as u32;
        let next = self.buckets.get_mut(first as usize).map_or(NONE, |head| core::mem::replace(head, number));
        self.spans.push(Span { x, near: sight.near, surface, patch, next, last });
    }
}

/// The bucket of a place this far from the window's left edge: the first one for all before it, the last one for all behind.
#[inline(always)]
fn bucket_of<S: Scalar>(from_left: S, per_unit: S, buckets: usize) -> u32 {
    (from_left * per_unit).to_u32().min((buckets as u32).saturating_sub(1))
}

#[cfg(test)]
mod tests;
