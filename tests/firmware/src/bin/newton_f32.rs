//! The method `newton` in f32.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[allow(dead_code)]
mod tables {
    include!(concat!(env!("BAKED"), "/newton-f32.rs"));
}

firmware::program!(f32: newton over tables);
