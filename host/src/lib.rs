//! The host side of `patchray`: files in, pictures and numbers out.
pub mod batch;
pub mod cmd;
pub mod judge;
pub mod lower;
pub mod memory;
pub mod method;
pub mod number;
pub mod oracle;
pub mod output;
pub mod picture;
pub mod prepared;
pub mod report;
pub mod scanline;
pub mod scene;
pub mod settings;
pub mod shade;
pub mod stats;
