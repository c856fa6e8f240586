//! What is claimed of answers, held against judges that share nothing with the kernel: closed forms, the oracle, and the surfaces'
//! own control points in double-double.
//!
//! `PATCHRAY_RAYS=N` asks for N rays of each kind instead of few.

mod aim;
mod cases;
mod edges;
mod rational;
mod residual;
mod tools;
