//! The method `newton` in f64.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[allow(dead_code)]
mod tables {
    include!(concat!(env!("BAKED"), "/newton-f64.rs"));
}

firmware::program!(f64: newton over tables);
