//! The interface for programs in C, called from Rust: the same answers as Rust's own, and a code for every wrong input.
//!
//! Its programs in C are built and run by `tests/capi/run`.
#![allow(unsafe_code)] // What is tested takes addresses.
#![allow(unreachable_pub)] // A program of its own.
#![allow(clippy::type_complexity)] // Signatures stand as they do in C.

#[path = "../common/mod.rs"]
mod common;
mod errors;
mod lent;
mod lent_lines;
#[path = "../views/rooms.rs"]
#[allow(dead_code)] // What other suites take of it.
mod rooms;
mod same_bits;
mod views;
