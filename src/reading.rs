//! What a method consists of, each part by itself: the paper's idea, and where its methods are done otherwise than its text says.
//!
//! A reading is a type. [`Ours`] is known when compiling, and costs no instruction; [`Switches`] are set at run time, to measure what
//! each part is worth.

macro_rules! switches {
    ($($(#[$doc:meta])* $name:ident: $letter:literal,)*) => {
        /// Which parts a method has.
        pub trait Reading: Copy {
            $($(#[$doc])* fn $name(self) -> bool;)*
        }

        /// All of them: what is best for users.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Ours;

        impl Reading for Ours {
            $(#[inline(always)]
            fn $name(self) -> bool {
                true
            })*
        }

        /// Parts that are there, or not, as is said at run time.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct Switches {
            $($(#[$doc])* pub $name: bool,)*
        }

        impl Reading for Switches {
            $(#[inline(always)]
            fn $name(self) -> bool {
                self.$name
            })*
        }

        impl Switches {
            /// As [`Ours`].
            pub const fn ours() -> Self {
                Switches { $($name: true),* }
            }

            /// The paper's own parts and no others: its text, to the letter.
            pub const fn letter() -> Self {
                Switches { $($name: $letter),* }
            }
        }
    };
}

switches! {
    /// The paper's: a coherent method begins at the point that the ray before found.
    coherence: true,
    /// The paper's: a testing ray verifies the point that coherence leads to. Without, it is believed, which is wrong at times.
    verification: true,
    /// A departure: what lies behind the closest hit so far, on whatever surface, is left out. The paper's methods find the points on
    /// each surface that the ray meets, and select afterwards.
    pruning: false,
    /// A departure: the improved numerical method's search of a whole surface ends at the closest point. The paper's finds all points.
    early_end: false,
    /// A departure: the yes or no of clipping's testing ray is said as soon as it is known. The paper's list of patches is completed
    /// first.
    quick_verdict: false,
    /// A departure: a surface all of whose control points lie to one side of a plane of the ray is left out before it is clipped.
    box_first: false,
    /// A departure: Newton's method, where it is proved to lead to the only root of a region, stands for the last clips.
    newton_end: false,
    /// A departure: a region that a clip does not shorten enough is looked at across the ray before it is bisected.
    look_across: false,
    /// A departure: of a region one side of which is much longer in space than that which a clip did not shorten enough, the longer
    /// one is halved.
    long_side: false,
    /// A departure: lines along chords that are all but parallel are spread before distances to them are taken.
    spread_lines: false,
    /// A departure: a root that clipping finds again, from another region, is known again. It counts for another point all the same.
    known_roots: false,
    /// A choice where the text is open: a surface is halved where it strays farther from its chord, by the bound of the second
    /// derivative over the piece. Without, it is where its tangent turns more: by that over the length of the chord.
    bend_halving: true,
}
