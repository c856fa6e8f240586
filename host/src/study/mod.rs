//! Error against run time: every method in each precision, with one setting at a time moved from its default.
//!
//! A [`plan`] names the cells. Each is traced on one picture, held against the [`truth`], and written as a file of its own,
//! a [`record`], into a [`folder`].

pub mod errors;
pub mod folder;
pub mod machine;
pub mod plan;
pub mod record;
pub mod replay;
pub mod run;
pub mod subject;
pub mod truth;
