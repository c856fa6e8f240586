//! The command `patchray`.
fn main() {}
