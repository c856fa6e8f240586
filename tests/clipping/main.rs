//! Bézier clipping at the kernel's public face: all roots and each once, bounded work on the hardest rays, lists, borders,
//! and answers that no coherence memory can change.
//!
//! `PATCHRAY_RAYS=N` traces N rays per case instead of the default.

#[path = "../common/mod.rs"]
mod common;

mod ask;
mod borders;
mod bounded_work;
mod coherence;
mod degrees;
mod judge;
mod lists;
mod many_roots;
mod shapes;
