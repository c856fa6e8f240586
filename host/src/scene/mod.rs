//! From files to data: patch files, ray files and scene files.
pub mod model;
