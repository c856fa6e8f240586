//! What a search tells of itself, step by step, to whoever listens.
//!
//! Numbers are what carries it through the kernel: every search computes in some [`Scalar`](crate::scalar::Scalar), and tells
//! its type what it does. `f32` and `f64` do not listen, so that a program that uses these holds none of it.
//! [`Told`](crate::told::Told) is a number that computes the same bits and passes on what it is told.

use crate::ray::Incidence;

/// Something that a search did. Numbers are in the scene's [frame](crate::frame), in which it is about of size 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// A ray begins.
    Ray,
    /// A voxel of the scene's grid is visited.
    SceneVoxel,
    /// The search turns to a surface, by its number.
    Surface(u32),
    /// A voxel of a surface's grid is visited.
    Voxel,
    /// A node of a surface's tree is tested: whether the ray meets its parallelepiped.
    Node {
        /// Whether so.
        met: bool,
    },
    /// A patch is tested: whether the ray meets its parallelepiped.
    Patch {
        /// The patch's part of the surface: least and largest u, then v.
        sides: [[f64; 2]; 2],
        /// Whether so.
        met: bool,
    },
    /// The patch is critical, by the paper's eq. (1).
    Critical,
    /// The patch is proved to hold no root.
    Excluded,
    /// Nothing is proved of the patch, and the fallback decides it.
    HandedOver,
    /// No start led to a root: the patch is taken for not hit.
    Unresolved,
    /// Newton's method starts at (u, v).
    Start([f64; 2]),
    /// Newton's method evaluates the surface.
    Step {
        /// At this (u, v).
        at: [f64; 2],
        /// And finds its point so far from the ray.
        residual: f64,
    },
    /// This start leads to no root.
    Stuck,
    /// A root is found.
    Root {
        /// At this (u, v).
        at: [f64; 2],
        /// How far along the ray, from where it enters the scene's frame.
        depth: f64,
        /// How the ray meets the surface there.
        incidence: Incidence,
    },
    /// A region of the surface is clipped.
    Clip {
        /// The region: least and largest u, then v.
        sides: [[f64; 2]; 2],
        /// In v, not in u.
        in_v: bool,
        /// The part of that side that is left, from 0 to 1; `None` if nothing is, and the region holds no root.
        left: Option<[f64; 2]>,
    },
    /// The region is bisected.
    Bisection,
    /// The search goes on with another region of those that wait.
    Region {
        /// Least and largest u, then v.
        sides: [[f64; 2]; 2],
    },
    /// A coherent method begins with what the ray before has left: the search starts at (u, v).
    Remembered([f64; 2]),
    /// The testing ray runs back from the root.
    Testing,
    /// The testing ray meets a patch that counts.
    Listed {
        /// Whether it is the one that holds the root.
        owner: bool,
    },
    /// The testing ray confirms the root at once.
    Verified,
    /// The patches that the testing ray meets are searched: the root is confirmed, or replaced by a closer one.
    DecidedByList,
    /// The testing ray does not confirm the root.
    Refused,
    /// What the ray before has left led to nothing.
    StartFailed,
    /// All is searched.
    FullSearch,
}
