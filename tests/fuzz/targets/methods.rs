//! See `src/methods.rs`.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| patchray_fuzz::check("methods", bytes));
