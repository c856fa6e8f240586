//! Lent memory: slots that the caller owns, filled from the front.
//!
//! The same code fills and counts: an [`Arena`] over too few slots, or over none, goes on counting what it was asked to
//! hold. So "how much is needed" is the result of filling nothing.

/// How much of one kind of slot was needed, and how much was lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Need {
    /// Slots needed.
    pub needed: usize,
    /// Slots lent.
    pub given: usize,
}

impl Need {
    /// Whether the lent slots suffice.
    pub fn met(&self) -> bool {
        self.needed <= self.given
    }
}

/// Lent slots, filled from the front. Pushing past the end stores nothing but still counts.
#[derive(Debug)]
pub struct Arena<'m, T> {
    slots: &'m mut [T],
    pushed: usize,
}

impl<'m, T: Copy> Arena<'m, T> {
    /// An empty arena over lent slots; what they hold does not matter.
    pub fn new(slots: &'m mut [T]) -> Self {
        Arena { slots, pushed: 0 }
    }

    /// How many slots were asked for so far; also the index of the next one.
    pub fn len(&self) -> usize {
        self.pushed
    }

    /// Whether nothing was asked for yet.
    pub fn is_empty(&self) -> bool {
        self.pushed == 0
    }

    /// Puts a value into the next slot, if there is one, and counts it in any case.
    pub fn push(&mut self, value: T) {
        self.set(self.pushed, value);
        self.pushed = self.pushed.saturating_add(1);
    }

    /// Puts the same value into the next `count` slots.
    pub fn extend(&mut self, count: usize, value: T) {
        let end = self.pushed.saturating_add(count);
        let stop = end.min(self.slots.len());
        if let Some(fresh) = self.slots.get_mut(self.pushed..stop) {
            fresh.fill(value);
        }
        self.pushed = end;
    }

    /// Replaces the value of a slot, if that slot was lent.
    pub fn set(&mut self, index: usize, value: T) {
        if let Some(slot) = self.slots.get_mut(index) {
            *slot = value;
        }
    }

    /// The slots from `first` on that were asked for so far, if all of them were lent.
    pub fn since(&mut self, first: usize) -> Option<&mut [T]> {
        self.slots.get_mut(first..self.pushed)
    }

    /// Needed against given.
    pub fn need(&self) -> Need {
        Need { needed: self.pushed, given: self.slots.len() }
    }

    /// The filled slots; all that were lent if they were too few (ask [`Arena::need`] first).
    pub fn finish(self) -> &'m [T] {
        let filled = self.pushed.min(self.slots.len());
        let (front, _) = self.slots.split_at_mut_checked(filled).unwrap_or((&mut [], &mut []));
        front
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counting_and_filling_are_the_same_code() {
        let fill = |slots: &mut [u32]| {
            let mut arena = Arena::new(slots);
            arena.extend(2, 7);
            for k in 0..3 {
                arena.push(k);
            }
            arena.set(1, 9);
            arena.need()
        };
        assert_eq!(fill(&mut []), Need { needed: 5, given: 0 });
        let mut four = [100; 4];
        assert!(!fill(&mut four).met());
        let mut five = [100; 5];
        assert!(fill(&mut five).met());
        assert_eq!(five, [7, 9, 0, 1, 2]);
    }
}
