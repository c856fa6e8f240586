//! From files to data: patch files, ray files and scene files.
pub mod appearance;
pub mod bpt;
pub mod camera;
mod check;
pub mod error;
pub mod file;
mod json;
pub mod model;
pub mod nearest;
pub mod nurbs_python;
pub mod patches;
pub mod rays;
pub mod sampling;
pub mod shapes;
pub mod source;
pub mod spline;
pub mod teapot;
pub mod trace;
