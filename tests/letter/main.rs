//! The paper's methods to the letter, held against a second implementation that is written from the text alone; and each of their
//! parts switched by itself.
//!
//! The second implementation is slow: it looks at every surface and every patch, keeps lists, and leaves nothing out. It shares
//! with the kernel what has tests of its own: subdivision, the tests of parallelepipeds, and one solve by Newton's method.

mod clipping;
#[path = "../common/mod.rs"]
mod common;
mod numerical;
mod scenes;
mod switches;
mod text;
