//! The rays of a view: what the methods for them answer, from many cameras, against the oracle and against rays traced one by one.
//!
//! The models, the judge and the allowances are those of the suite `methods`. `PATCHRAY_RAYS=N` traces N rays per case
//! instead of the default.

mod agree;
mod answers;
mod budgets;
mod cameras;
#[path = "../common/mod.rs"]
mod common;
mod compare;
mod hostile;
mod image;
mod memory;
mod order;
mod rooms;
mod rubbish;
mod soundness;

#[path = "../methods/adapters.rs"]
#[allow(dead_code, reason = "of the table of adapters only what allowances are looked up by")]
mod adapters;
#[path = "../methods/allowances.rs"]
#[allow(dead_code, reason = "the common view is the other suite's")]
mod allowances;
#[path = "../methods/corpus.rs"]
#[allow(dead_code, reason = "rays of no view are the other suite's")]
mod corpus;
#[path = "../methods/judging.rs"]
mod judging;
