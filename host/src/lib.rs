//! The host side of `patchray`: files in, pictures and numbers out.
pub mod number;
pub mod oracle;
pub mod output;
pub mod report;
pub mod scene;
