//! The host side of `patchray`: files in, pictures and numbers out.
pub mod number;
pub mod scene;
