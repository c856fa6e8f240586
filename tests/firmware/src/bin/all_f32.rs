//! All six methods in f32.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[allow(dead_code)]
mod tree {
    include!(concat!(env!("BAKED"), "/newton-f32.rs"));
}

#[allow(dead_code)]
mod grids {
    include!(concat!(env!("BAKED"), "/newton-coherent-f32.rs"));
}

firmware::program!(f32:
    newton over tree,
    newton_coherent over grids,
    newton_predicted over grids,
    clipping over tree,
    clipping_coherent over grids,
    clipping_predicted over grids
);
