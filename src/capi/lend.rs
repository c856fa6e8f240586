//! Making sure of the addresses and counts of one call.
//!
//! A call names all its memory to one [`Lending`], which refuses what Rust's references may not be made of. So at any time
//! the references that exist are valid by what can be known of an address, and nothing that one of them writes is seen
//! through another.

use super::status::{Code, PATCHRAY_COUNT, PATCHRAY_MEMORY, PATCHRAY_MISALIGNED, PATCHRAY_NULL, PATCHRAY_OVERLAP};
use heapless::Vec;

/// The most pieces of memory that one call names: a scan line has 23.
const MOST: usize = 24;

#[derive(Clone, Copy)]
struct Range {
    begin: usize,
    end: usize,
    written: bool,
}

/// The memory of one call.
pub(super) struct Lending {
    ranges: Vec<Range, MOST>,
}

impl Lending {
    pub(super) const fn new() -> Self {
        Lending { ranges: Vec::new() }
    }

    /// Takes note of memory; refuses it if it cannot be, or has bytes in common with other memory and either is written.
    #[inline(never)]
    fn note(&mut self, begin: usize, align: usize, size: usize, count: usize, written: bool) -> Result<(), Code> {
        if count == 0 {
            return Ok(());
        }
        let range = self.checked(begin, align, size, count, written)?;
        self.ranges.push(range).map_err(|_| PATCHRAY_COUNT)
    }

    /// Memory that may be used.
    #[inline(always)]
    fn checked(&self, begin: usize, align: usize, size: usize, count: usize, written: bool) -> Result<Range, Code> {
        if begin == 0 {
            return Err(PATCHRAY_NULL);
        }
        if begin & (align - 1) != 0 {
            return Err(PATCHRAY_MISALIGNED);
        }
        let bytes = size.checked_mul(count).filter(|&bytes| bytes <= isize::MAX as usize).ok_or(PATCHRAY_COUNT)?;
        let end = begin.checked_add(bytes).ok_or(PATCHRAY_COUNT)?;
        for other in &self.ranges {
            if (written | other.written) & (begin < other.end) & (other.begin < end) {
                return Err(PATCHRAY_OVERLAP);
            }
        }
        Ok(Range { begin, end, written })
    }

    /// Whether slots can be read and nothing noted so far is written among them, without taking note: for more of them than a
    /// call could name.
    pub(super) fn apart<A, T>(&self, first: *const A, count: usize) -> Result<(), Code> {
        match count / per_slot::<A, T>() {
            0 => Ok(()),
            count => self.checked(first.addr(), align_of::<T>(), size_of::<T>(), count, false).map(|_| ()),
        }
    }

    /// A copy of what the caller gives.
    ///
    /// # Safety
    /// If `given` is neither null nor misaligned, a `T` can be read there.
    #[inline(always)]
    pub(super) unsafe fn read<T: Copy>(&mut self, given: *const T) -> Result<T, Code> {
        self.note(given.addr(), align_of::<T>(), size_of::<T>(), 1, false)?;
        // SAFETY: the caller's, and the address was noted.
        Ok(unsafe { given.read() })
    }

    /// The same, `None` for null.
    ///
    /// # Safety
    /// As for [`Lending::read`].
    #[inline(always)]
    pub(super) unsafe fn read_if_any<T: Copy>(&mut self, given: *const T) -> Result<Option<T>, Code> {
        if given.is_null() {
            return Ok(None);
        }
        // SAFETY: the caller's.
        unsafe { self.read(given) }.map(Some)
    }

    /// Where an answer is to be written when the call has come to its end.
    #[inline(always)]
    pub(super) fn place<T>(&mut self, place: *mut T) -> Result<Place<T>, Code> {
        self.note(place.addr(), align_of::<T>(), size_of::<T>(), 1, true)?;
        Ok(Place(place))
    }

    /// The same where null says that the answer is not wanted.
    #[inline(always)]
    pub(super) fn place_if_any<T>(&mut self, place: *mut T) -> Result<Option<Place<T>>, Code> {
        if place.is_null() { Ok(None) } else { self.place(place).map(Some) }
    }

    /// Slots that are read while the call goes on, given as a number of `A`, one or several to a slot. `T` is any bits.
    ///
    /// # Safety
    /// If `first` is neither null nor misaligned, `count` of `A` can be read there, and nothing else writes them before the
    /// call ends.
    #[inline(always)]
    pub(super) unsafe fn slots<'c, A, T>(&mut self, first: *const A, count: usize) -> Result<&'c [T], Code> {
        let count = count / per_slot::<A, T>();
        self.note(first.addr(), align_of::<T>(), size_of::<T>(), count, false)?;
        if count == 0 {
            return Ok(&[]);
        }
        // SAFETY: the caller's; address and size were noted, so that no memory that this call writes is among them.
        Ok(unsafe { core::slice::from_raw_parts(first.cast(), count) })
    }

    /// Slots that are read and written while the call goes on.
    ///
    /// # Safety
    /// If `first` is neither null nor misaligned, `count` of `A` can be read and written there, and nothing else reads or
    /// writes them before the call ends.
    #[inline(always)]
    pub(super) unsafe fn memory<'c, A, T>(&mut self, first: *mut A, count: usize) -> Result<&'c mut [T], Code> {
        let count = count / per_slot::<A, T>();
        self.note(first.addr(), align_of::<T>(), size_of::<T>(), count, true)?;
        if count == 0 {
            return Ok(&mut []);
        }
        // SAFETY: the caller's; address and size were noted, so that no other memory of this call is among them.
        Ok(unsafe { core::slice::from_raw_parts_mut(first.cast(), count) })
    }

    /// The same of at least one slot for each of so many surfaces.
    ///
    /// # Safety
    /// As for [`Lending::memory`].
    #[inline(always)]
    pub(super) unsafe fn slot_each<'c, A, T>(
        &mut self,
        first: *mut A,
        count: usize,
        surfaces: usize,
    ) -> Result<&'c mut [T], Code> {
        // SAFETY: the caller's.
        let slots = unsafe { self.memory(first, count) }?;
        // Now, and not when a ray comes to a surface without one.
        if slots.len() < surfaces { Err(PATCHRAY_MEMORY) } else { Ok(slots) }
    }

    /// Slots that the call fills, once it has seen all that it reads.
    #[inline(always)]
    pub(super) fn room<A, T>(&mut self, first: *mut A, count: usize) -> Result<Room<T>, Code> {
        let count = count / per_slot::<A, T>();
        self.note(first.addr(), align_of::<T>(), size_of::<T>(), count, true)?;
        Ok(Room { first: first.cast(), count })
    }

    /// A copy of what the caller gives, and the place to write it back to.
    ///
    /// # Safety
    /// As for [`Lending::read`], to be written too.
    pub(super) unsafe fn exchange<T: Copy>(&mut self, place: *mut T) -> Result<(T, Place<T>), Code> {
        let place = self.place(place)?;
        // SAFETY: the caller's, and the address was noted.
        Ok((unsafe { place.0.read() }, place))
    }
}

/// Slots to be filled.
pub(super) struct Room<T> {
    first: *mut T,
    count: usize,
}

impl<T> Room<T> {
    /// Where it begins, and its bytes; what is there need not have been set.
    pub(super) fn raw(self) -> (*mut T, usize) {
        // Bounded when it was noted.
        (self.first, self.count * size_of::<T>())
    }

    /// The slots, all zero, so that what they held need not have been set. `T` is any bits.
    ///
    /// # Safety
    /// If there are any, they can be written, and nothing else reads or writes them before the call ends.
    pub(super) unsafe fn open<'c>(self) -> &'c mut [T] {
        let Room { first, count } = self;
        if count == 0 {
            return &mut [];
        }
        // SAFETY: the caller's, and address and size were noted.
        unsafe { first.write_bytes(0, count) };
        // SAFETY: likewise; no other memory of this call is among them.
        unsafe { core::slice::from_raw_parts_mut(first, count) }
    }
}

/// How many of `A` make a slot; that a slot is made of them is checked when compiling.
const fn per_slot<A, T>() -> usize {
    const { assert!(size_of::<T>().is_multiple_of(size_of::<A>()) && align_of::<A>() == align_of::<T>()) }
    size_of::<T>() / size_of::<A>()
}

/// Where an answer is to be written.
pub(super) struct Place<T>(*mut T);

impl<T> Place<T> {
    /// Writes the answer.
    ///
    /// # Safety
    /// A `T` can be written there.
    #[inline(always)]
    pub(super) unsafe fn set(&self, value: T) {
        // SAFETY: the caller's; that the place is neither null nor misaligned was seen when it was noted.
        unsafe { self.0.write(value) }
    }
}
