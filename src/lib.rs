#![no_std]
#![forbid(unsafe_code)]
//! Rays against Bézier and B-spline surfaces.
