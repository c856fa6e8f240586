//! The paper's methods to the letter, held against a second implementation that is written from the text alone; and each of their
//! parts switched by itself.
//!
//! The second implementation is slow: it looks at every patch of every surface whose box the ray meets, keeps lists, and leaves
//! nothing out. It shares with the kernel what has tests of its own: subdivision, projection, the scene's grid and boxes, the tests of
//! parallelepipeds and the starts in them, and one solve by Newton's method. Where the text is open it reads it as the kernel does.

mod clipping;
#[path = "../common/mod.rs"]
mod common;
mod numerical;
mod scenes;
mod switches;
mod text;
