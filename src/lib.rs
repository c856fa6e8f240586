#![no_std]
#![forbid(unsafe_code)]
//! Rays against Bézier and B-spline surfaces themselves: no tessellation, no allocator, a bounded amount of work per ray.
//!
//! The methods are those of S.-W. Wang, Z.-C. Shih and R.-C. Chang, "An improved rendering technique for ray tracing Bézier
//! and B-spline surfaces", The Journal of Visualization and Computer Animation 11, 2000: called "the paper" throughout.
//!
//! The modules stand in the order in which data flows; each knows only those above it.

pub mod scalar;

pub mod ray;

pub mod limits;

pub mod arena;

pub mod bernstein;
pub mod surface;

pub mod frame;

pub mod planes;

pub mod patch;

pub mod subdivide;

pub mod tree;

pub mod grid;
pub mod walk;

pub mod newton;

pub mod sweep;
pub mod verify;

pub mod scene;

pub mod method;
