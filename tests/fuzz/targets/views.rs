//! See `src/views.rs`.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| patchray_fuzz::check("views", bytes));
