//! What was found, as data for people and for programs.
pub mod answers;
