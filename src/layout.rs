//! How tables in lent memory or flash are laid out, and how they say so.

/// The version of what slots hold: of the order and the meaning of the numbers that the slots' `from_numbers` take, and of
/// where they lie in the structs of the C interface. Tables that were written for another version are not to be read; those
/// that `patchray bake` writes then do not compile:
///
/// ```compile_fail
/// const _: () = assert!(patchray::LAYOUT == 0, "these tables were baked for another version of patchray");
/// ```
pub const LAYOUT: u32 = 5;

/// What a table of the C interface holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Table {
    /// A scene: its frame, its control points, its surfaces, and the grid over them.
    Scene = 1,
    /// Patches.
    Patches = 2,
    /// The trees over the patches.
    Tree = 3,
    /// The grids over the patches of each surface.
    Grids = 4,
    /// A scene as seen by a camera.
    View = 5,
}

impl Table {
    /// The number by which a table says what it is: the [`LAYOUT`], what it holds, whether its numbers are `double` and its
    /// control points `weighted`, each in bits of its own.
    pub const fn tag(self, double: bool, weighted: bool) -> u32 {
        LAYOUT << 8 | (self as u32) << 4 | (double as u32) << 1 | weighted as u32
    }
}
