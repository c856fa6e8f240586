//! Traces scan lines of a baked scene, on small machines and on the host alike, and says what came out and what it took.
//!
//! The modules but [`machine`] and [`lent`] are safe and the same everywhere; [`machine`] is what differs: start, clock and
//! console.
#![cfg_attr(target_os = "none", no_std)]
#![deny(unsafe_code)]

pub mod hash;
pub mod lent;
pub mod lines;
pub mod machine;
pub mod measure;
#[cfg(target_os = "none")]
mod paint;
pub mod picture;
mod program;
pub mod tracer;

/// Domains that may wait to be clipped: more than numbers of 53 bits can be halved apart.
pub const PENDING: usize = 64;

// What the macros of this crate name, for programs that know no other crate.
#[doc(hidden)]
pub use patchray;

/// Reached by a panic. A program whose optimised build holds this function can panic.
#[cfg(target_os = "none")]
#[inline(never)]
fn panic_is_reachable() -> ! {
    machine::end_of_panic()
}

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    panic_is_reachable()
}
