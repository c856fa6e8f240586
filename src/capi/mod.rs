//! The kernel for programs in C and C++: behind the feature `capi`, and the one place where unsafe code is allowed.
//!
//! `patchray.h` beside this file is made of it by cbindgen, and is what a C programmer reads. As everywhere in the kernel the
//! caller lends all memory; here it comes as addresses and counts, so that every call first makes sure of them
//! (`lend.rs`): nothing is read or written through a null or misaligned address, past the end of the address space, or
//! through two ways at once where one of them writes. What it cannot see is whether memory of the size stated is there.
//!
//! A function for each method, kind of control points and precision, in a section of its own, so that a program that is
//! linked with `--gc-sections` holds what it calls and no more. As a static library:
//!
//! ```text
//! cargo rustc --package patchray --features capi --profile capi --crate-type staticlib
//! ```

#![allow(unsafe_code)]
// The names are those of the C interface.
#![allow(non_camel_case_types)]

mod export;
mod export_views;
mod lend;
mod limits;
mod panic;
mod prepare;
mod scratch;
mod status;
mod tables;
mod trace;
mod types;
mod view;

pub use export::*;
pub use export_views::*;
pub use scratch::*;
pub use status::*;
pub use types::*;
