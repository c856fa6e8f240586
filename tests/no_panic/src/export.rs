//! How entry points are exported.

/// An exported function's address. The compiler has to expect callers that it does not see.
#[derive(Debug)]
#[repr(transparent)]
pub struct Entry(*const ());

impl Entry {
    /// From the address.
    pub const fn of(address: *const ()) -> Self {
        Entry(address)
    }
}

// SAFETY: the address of code, which nothing writes to.
unsafe impl Sync for Entry {}

/// Exports generic functions for each number type and kind of control points.
macro_rules! export {
    ($($function:ident)*) => {
        $(export!($function: "f32_plain" patchray::point::Plain<f32>, "f32_weighted" patchray::point::Weighted<f32>, "f64_plain" patchray::point::Plain<f64>, "f64_weighted" patchray::point::Weighted<f64>);)*
    };
    ($function:ident: $($kind:literal $point:ty),*) => {
        $(const _: () = {
            #[unsafe(export_name = concat!("reach_", stringify!($function), "_", $kind))]
            static ENTRY: crate::export::Entry = crate::export::Entry::of($function::<$point> as *const ());
        };)*
    };
}
