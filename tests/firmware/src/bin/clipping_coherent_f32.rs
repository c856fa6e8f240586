//! The method `clipping-coherent` in f32.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[allow(dead_code)]
mod tables {
    include!(concat!(env!("BAKED"), "/clipping-coherent-f32.rs"));
}

firmware::program!(f32: clipping_coherent over tables);
