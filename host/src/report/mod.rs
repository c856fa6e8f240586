//! What was found, as data for people and for programs.
pub mod answers;
pub mod plot;
pub mod stress;
pub mod study;
pub mod table;
pub mod tables;
pub mod times;
