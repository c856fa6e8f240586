//! Stiff and extreme cases: families of surfaces and rays that are hard in a known way, and what every method makes of them.
//!
//! A family makes its cases from a seed; a case is traced by every method in the family's precision, and each answer is held
//! against an oracle in double-double numbers, or against a closed form where the oracle knows no margin.

pub mod bounds;
pub mod case;
pub mod families;
pub mod forms;
pub mod judge;
pub mod run;
pub mod truth;
