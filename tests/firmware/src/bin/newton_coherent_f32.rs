//! The method `newton-coherent` in f32.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[allow(dead_code)]
mod tables {
    include!(concat!(env!("BAKED"), "/newton-coherent-f32.rs"));
}

firmware::program!(f32: newton_coherent over tables);
