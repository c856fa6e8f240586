//! The method `clipping-predicted` in f32.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[allow(dead_code)]
mod tables {
    include!(concat!(env!("BAKED"), "/clipping-predicted-f32.rs"));
}

firmware::program!(f32: clipping_predicted over tables);
