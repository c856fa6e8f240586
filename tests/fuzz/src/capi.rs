//! The C interface: any addresses, counts and bits that lie within memory of one's own.
//!
//! All that a call is given lies in one [`Field`] with gaps between. Each address may be null, misaligned, or that of anything
//! else there; each count may be too small, too large for what lies there, or for the address space. What has to be refused is
//! worked out here once more, from nothing but addresses and sizes.
#![allow(unsafe_code, reason = "the interface takes addresses")]

mod arguments;
mod field;
mod lines;
mod rust;

use crate::bytes::Bytes;
use crate::common::Kind;
use crate::input::Case;
use crate::lent_lines::Views;
use crate::scribble::Slot;
use arguments::Prepared;
use field::{Call, Field};
use lines::Lines;
use patchray::capi::*;
use patchray::point::{Plain, Weighted};
use patchray_host::scene::trace::Precision;
use std::ops::Range;

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let function = bytes.byte();
    let case = Case::any(&mut bytes, 2);
    match (case.precision, case.weighted) {
        (Precision::F64, false) => of_kind::<Plain<f64>>(&case, function, bytes),
        (Precision::F32, false) => of_kind::<Plain<f32>>(&case, function, bytes),
        (Precision::F64, true) => of_kind::<Weighted<f64>>(&case, function, bytes),
        (Precision::F32, true) => of_kind::<Weighted<f32>>(&case, function, bytes),
    }
}

/// Codes that say what is wrong with addresses and counts.
const OF_ADDRESSES: [i32; 4] = [PATCHRAY_NULL, PATCHRAY_MISALIGNED, PATCHRAY_OVERLAP, PATCHRAY_COUNT];

/// Codes that say what is wrong with what stands there; any of these may be seen first.
const OF_CONTENTS: [i32; 14] = [
    PATCHRAY_LAYOUT_DIFFERS,
    PATCHRAY_OPTION,
    PATCHRAY_DEGREE,
    PATCHRAY_POINTS,
    PATCHRAY_POINT_NOT_FINITE,
    PATCHRAY_WEIGHT,
    PATCHRAY_CAMERA_FLAT,
    PATCHRAY_CAMERA_FAR,
    PATCHRAY_SMALL,
    PATCHRAY_RAY_NAN,
    PATCHRAY_RAY_INFINITE,
    PATCHRAY_RAY_DIRECTION,
    PATCHRAY_RAY_RANGE,
    PATCHRAY_RAY_INTERVAL,
];

/// The functions: three preparations, the methods, all hits, the normal; and from `LINES` on views and their lines.
const FUNCTIONS: u8 = 11;
const LINES: u8 = 110;

fn of_kind<P: Views + Kind + Slot>(case: &Case, function: u8, mut bytes: Bytes<'_>) {
    // As it is meant, or with anything in it.
    let (spoilt, function) = (function >= 128, function % 128);
    let mut field = Field::new();
    if let Some(number) = function.checked_sub(LINES) {
        let Some(mut lines) = Lines::<P>::of(case, usize::from(number % lines::FUNCTIONS), &mut field, &mut bytes)
        else {
            return;
        };
        if !spoilt {
            return lines.as_in_rust(case);
        }
        lines.scribble(&mut bytes);
        let mut call = Call::new(&field, &mut bytes);
        lines.spoil(&mut call);
        let faults = call.faults();
        // SAFETY: as below.
        let code = refused_or_within(&field, &faults, &lines.written, None, || unsafe { lines.call() });
        if code == PATCHRAY_OK {
            lines.within_limits();
        }
        return;
    }
    let function = usize::from(function % FUNCTIONS);
    let Some(mut prepared) = Prepared::<P>::of(case, function, &mut field, &mut bytes) else {
        return;
    };
    if !spoilt {
        return prepared.as_in_rust(case, function);
    }
    prepared.scribble(&mut bytes);
    let mut call = Call::new(&field, &mut bytes);
    prepared.spoil(function, &mut call);
    let faults = call.faults();
    let why = prepared.says_why(function);
    // SAFETY: each address is null, misaligned, or leads to memory of the field as large as said, and structs that hold
    // addresses hold such.
    let code = refused_or_within(&field, &faults, &prepared.written, why, || unsafe { prepared.call(function) });
    if (PATCHRAY_MISS..=PATCHRAY_HIT).contains(&code) {
        prepared.within_limits(function);
    }
}

/// The code of a call, which refuses what is wrong, and writes nothing but what it may; and of a refusal nothing but `why`.
fn refused_or_within(
    field: &Field,
    faults: &[i32],
    written: &[Range<usize>],
    why: Option<Range<usize>>,
    call: impl FnOnce() -> i32,
) -> i32 {
    let before = field.copy();
    let code = call();
    let changed = field.changed(&before);
    // SAFETY: it is a string for each code.
    let name = unsafe { std::ffi::CStr::from_ptr(patchray_name(code)) }.to_str().expect("a name");
    assert!(name != "unknown", "{code} is no code");
    if OF_ADDRESSES.contains(&code) {
        assert!(faults.contains(&code), "{name}, but all that is wrong is {faults:?}");
    }
    if !faults.is_empty() {
        // Tables of other surfaces, or fewer slots than surfaces, are seen before what comes after them.
        let known = OF_CONTENTS.contains(&code) || [PATCHRAY_TABLES, PATCHRAY_MEMORY].contains(&code);
        assert!(faults.contains(&code) || known, "{name}, though {faults:?} are to be refused");
    }
    // Control points are looked at where lent memory has been cleared.
    let of_points = [PATCHRAY_POINT_NOT_FINITE, PATCHRAY_WEIGHT, PATCHRAY_SMALL].contains(&code);
    let refused = OF_ADDRESSES.contains(&code) || (OF_CONTENTS.contains(&code) || !faults.is_empty()) && !of_points;
    let allowed = if refused { why.as_slice() } else { written };
    for at in changed {
        let known = allowed.iter().any(|range| range.contains(&at));
        assert!(known, "{name}: byte {at:#x} was written, beyond {allowed:x?}");
    }
    code
}
