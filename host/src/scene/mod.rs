//! From files to data: patch files, ray files and scene files.
pub mod bpt;
pub mod error;
pub mod model;
pub mod nearest;
pub mod rays;
pub mod source;
pub mod teapot;
