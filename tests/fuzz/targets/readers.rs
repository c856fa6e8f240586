//! See `src/readers.rs`.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| patchray_fuzz::check("readers", bytes));
