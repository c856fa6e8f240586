//! Memory that calls are given parts of, and what is wrong with the parts.

use crate::bytes::Bytes;
use patchray::capi::*;
use std::ops::Range;

/// One piece of memory with room for all that a call takes. What is not given to it must not change.
pub(super) struct Field {
    words: Box<[u64]>,
    taken: usize,
}

/// Of 8 bytes each.
const WORDS: usize = 1 << 14;

/// Between pieces, and past the last one, so that one too long is seen.
const GAP: usize = 64;

impl Field {
    pub(super) fn new() -> Self {
        Field { words: vec![0xa5a5_a5a5_a5a5_a5a5; WORDS].into(), taken: GAP }
    }

    pub(super) fn base(&self) -> *mut u8 {
        self.words.as_ptr().cast_mut().cast()
    }

    /// The addresses of all of it.
    fn range(&self) -> Range<usize> {
        self.base().addr()..self.base().addr() + size_of_val(&*self.words)
    }

    /// A place for so many; `None` when all is taken.
    pub(super) fn take<T>(&mut self, count: usize) -> Option<*mut T> {
        let at = self.taken.next_multiple_of(align_of::<T>().max(8));
        let end = count.checked_mul(size_of::<T>()).and_then(|size| at.checked_add(size + GAP))?;
        (end <= size_of_val(&*self.words)).then(|| {
            self.taken = end;
            self.base().wrapping_add(at).cast()
        })
    }

    /// A place for one, with this in it.
    pub(super) fn put<T>(&mut self, value: T) -> Option<*mut T> {
        let place = self.take::<T>(1)?;
        // SAFETY: it is within the field, and aligned.
        unsafe { place.write(value) };
        Some(place)
    }

    /// What stands in it.
    pub(super) fn copy(&self) -> Vec<u64> {
        // SAFETY: its own words; calls have written them by the addresses that were given.
        (0..WORDS).map(|k| unsafe { self.words.as_ptr().add(k).read_volatile() }).collect()
    }

    /// The addresses of bytes that are not as they were.
    pub(super) fn changed(&self, before: &[u64]) -> Vec<usize> {
        let after = self.copy();
        let words = before.iter().zip(&after).enumerate().filter(|(_, (before, after))| before != after);
        let bytes = words.flat_map(|(k, (before, after))| {
            let differ = (before ^ after).to_le_bytes();
            (0..8).filter(move |&byte| differ[byte] != 0).map(move |byte| 8 * k + byte)
        });
        bytes.map(|at| self.base().addr() + at).collect()
    }
}

/// What a call is told of a piece of memory.
struct Named {
    begin: usize,
    align: usize,
    /// `None` if no address space holds it.
    size: Option<usize>,
    written: bool,
}

/// A call whose arguments are spoilt, as bytes say.
pub(super) struct Call<'f, 'c, 'b> {
    field: &'f Field,
    bytes: &'c mut Bytes<'b>,
    named: Vec<Named>,
}

impl<'f, 'c, 'b> Call<'f, 'c, 'b> {
    pub(super) fn new(field: &'f Field, bytes: &'c mut Bytes<'b>) -> Self {
        Call { field, bytes, named: vec![] }
    }

    fn note<T>(&mut self, begin: usize, count: usize, written: bool) {
        if count > 0 {
            let size = count.checked_mul(size_of::<T>()).filter(|&size| size <= isize::MAX as usize);
            let size = size.filter(|&size| begin.checked_add(size).is_some());
            self.named.push(Named { begin, align: align_of::<T>(), size, written });
        }
    }

    /// Another address for so many bytes, of which each is in the field if the address is aligned; or the same.
    fn address<T>(&mut self, address: *mut T, size: usize) -> *mut T {
        let moved = match self.bytes.below(16) {
            0..11 => return address,
            11 => return core::ptr::null_mut(),
            12 => address.wrapping_byte_add(1 + self.bytes.below(7)),
            13 => address.wrapping_byte_add(4 * self.bytes.below(60)),
            14 => address.wrapping_byte_sub(4 * self.bytes.below(60)),
            _ => {
                // Among what is taken.
                let at = usize::from(self.bytes.u16()) * 4 % self.field.taken;
                self.field.base().wrapping_add(at).cast()
            }
        };
        let Range { start, end } = self.field.range();
        if start <= moved.addr() && moved.addr().checked_add(size).is_some_and(|to| to <= end) {
            moved
        } else {
            address
        }
    }

    /// One struct without addresses in it.
    pub(super) fn one<T>(&mut self, place: *mut T, written: bool) -> *mut T {
        let place = self.address(place, size_of::<T>());
        self.note::<T>(place.addr(), 1, written);
        place
    }

    /// The same, where null says that there is none.
    pub(super) fn one_if_any<T>(&mut self, place: *mut T, written: bool) -> *mut T {
        let place = self.address(place, size_of::<T>());
        self.note::<T>(place.addr(), usize::from(!place.is_null()), written);
        place
    }

    /// A struct that holds addresses: elsewhere would be any others.
    pub(super) fn holder<T>(&mut self, place: *mut T, written: bool) -> *mut T {
        let place = match self.bytes.below(16) {
            14 => core::ptr::null_mut(),
            15 => place.wrapping_byte_add(1 + self.bytes.below(align_of::<T>() as u8 - 1)),
            _ => place,
        };
        self.note::<T>(place.addr(), 1, written);
        place
    }

    /// Bounds on what the call does: elsewhere would be any others. Null says that there are none.
    pub(super) fn bounds_if_any<T>(&mut self, place: *mut T) -> *mut T {
        let place = self.holder(place, false);
        if place.is_null() {
            self.named.pop();
        }
        place
    }

    /// Structs that hold addresses.
    pub(super) fn holder_of<T>(&mut self, first: *mut T, count: usize) -> *mut T {
        let first = self.holder(first, false);
        self.named.pop();
        self.note::<T>(first.addr(), count, false);
        first
    }

    /// Slots.
    pub(super) fn many<T>(&mut self, first: *mut T, count: usize, written: bool) -> (*mut T, usize) {
        self.slots::<T, T>(first, count, written)
    }

    /// Slots, given as a number of `A` each of which is one, or several of which make one.
    pub(super) fn slots<A, T>(&mut self, first: *mut A, count: usize, written: bool) -> (*mut A, usize) {
        let end = self.field.range().end;
        let per_slot = size_of::<T>() / size_of::<A>();
        let first = self.address(first, count * size_of::<A>());
        let fits = if first.is_null() { 1000 } else { (end - first.addr()) / size_of::<A>() };
        let count = match self.bytes.below(16) {
            0..12 => count,
            12 => count.saturating_sub(1 + self.bytes.below(4)),
            13 => (count + 1 + self.bytes.below(9)).min(fits),
            14 => usize::from(self.bytes.u16()) % (fits + 1),
            // More bytes than an address space has, or than lie ahead in it.
            _ if self.bytes.rarely(2) => usize::MAX - self.bytes.below(64),
            _ => isize::MAX as usize / size_of::<T>() * per_slot + per_slot * (1 + self.bytes.below(8)),
        };
        self.note::<T>(first.addr(), count / per_slot, written);
        (first, count)
    }

    /// As many, or fewer, or more than any memory holds.
    pub(super) fn fewer_or_endless(&mut self, count: usize) -> usize {
        match self.bytes.below(16) {
            13 => count.saturating_sub(1 + self.bytes.below(4)),
            14 => 0,
            15 => isize::MAX as usize - self.bytes.below(64),
            _ => count,
        }
    }

    /// Slots of a count that is said elsewhere, and no more than there are.
    pub(super) fn fixed<T>(&mut self, first: *mut T, count: usize, written: bool) -> *mut T {
        let first = self.address(first, count.saturating_mul(size_of::<T>()));
        self.note::<T>(first.addr(), count, written);
        first
    }

    /// The same, to be written, where null says that there are none.
    pub(super) fn fixed_if_any<T>(&mut self, first: *mut T, count: usize) -> *mut T {
        let first = self.fixed(first, count, true);
        if first.is_null() && count > 0 {
            self.named.pop();
        }
        first
    }

    /// What is wrong with all that was named, as codes; of each kind once.
    pub(super) fn faults(&self) -> Vec<i32> {
        let mut faults = vec![];
        for (k, piece) in self.named.iter().enumerate() {
            let Some(size) = piece.size else {
                faults.push(PATCHRAY_COUNT);
                // Whatever else is wrong with it is as good a reason.
                faults.extend((piece.begin == 0).then_some(PATCHRAY_NULL));
                faults.extend((!piece.begin.is_multiple_of(piece.align)).then_some(PATCHRAY_MISALIGNED));
                continue;
            };
            if piece.begin == 0 {
                faults.push(PATCHRAY_NULL);
            } else if !piece.begin.is_multiple_of(piece.align) {
                faults.push(PATCHRAY_MISALIGNED);
            }
            for other in &self.named[..k] {
                let both = [piece, other];
                let apart = other.size.is_none_or(|other_size| {
                    piece.begin + size <= other.begin || other.begin + other_size <= piece.begin
                });
                if !apart && both.iter().any(|piece| piece.written) && both.iter().all(|piece| piece.begin != 0) {
                    faults.push(PATCHRAY_OVERLAP);
                }
            }
        }
        faults
    }

    /// What may be written.
    pub(super) fn written(&self) -> Vec<Range<usize>> {
        let pieces = self.named.iter().filter(|piece| piece.written);
        pieces.filter_map(|piece| piece.size.map(|size| piece.begin..piece.begin + size)).collect()
    }
}
