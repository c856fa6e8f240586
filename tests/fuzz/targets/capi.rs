//! See `src/capi.rs`.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| patchray_fuzz::check("capi", bytes));
