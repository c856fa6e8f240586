#![no_std]
#![cfg_attr(not(feature = "capi"), forbid(unsafe_code))]
//! Rays against Bézier surfaces themselves: no tessellation, no allocator, a bounded amount of work per ray.
//!
//! The methods are those of S.-W. Wang, Z.-C. Shih and R.-C. Chang, "An improved rendering technique for ray tracing Bézier
//! and B-spline surfaces", The Journal of Visualization and Computer Animation 11, 2000: called "the paper" throughout.
//!
//! The caller lends all memory, and asks first how much: lending nothing returns all needs. Then a ray is a hit, a miss, or
//! out of a budget, never anything else:
//!
//! ```
//! use patchray::limits::{Limits, Work};
//! use patchray::method::{Scratch, newton};
//! use patchray::patch::{Parallelepiped, Patch};
//! use patchray::ray::Interval;
//! use patchray::scene::{Scene, SceneMemory, SceneOptions, SurfaceSlot};
//! use patchray::subdivide::{PatchMemory, SubdivideScratch, Subdivision, TreeMemory, subdivide};
//! use patchray::surface::Net;
//! use patchray::point::Plain;
//!
//! // A saddle: degrees 1 × 1, over the unit square. In firmware these arrays are statics.
//! let points = [[0.0, 0.0, 0.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]].map(Plain::<f32>);
//! let nets = [Net::new(1, 1, &points)?];
//! let (mut points, mut surfaces) = ([Plain([0.0; 3]); 4], [SurfaceSlot::EMPTY; 1]);
//! let (mut offsets, mut references) = ([0; 16], [0; 16]);
//! let memory = SceneMemory {
//!     points: &mut points,
//!     surfaces: &mut surfaces,
//!     offsets: &mut offsets,
//!     references: &mut references,
//! };
//! let scene = Scene::build(&nets, &SceneOptions::default(), memory)?;
//!
//! let (mut patches, mut first) = ([Patch::EMPTY; 64], [0; 2]);
//! let (mut nodes, mut links) = ([Parallelepiped::EMPTY; 63], [0; 127]);
//! let memory = PatchMemory { patches: &mut patches, first: &mut first };
//! let tree = TreeMemory { nodes: &mut nodes, links: &mut links };
//! let options = Subdivision { flatness: 0.01, ..Subdivision::default() };
//! let mut scratch = SubdivideScratch::<_, 4>::new();
//! let (patches, tree) = subdivide(scene.surfaces(), scene.frame(), &options, &mut scratch.view(), memory, Some(tree))?;
//! let tree = tree.expect("asked for");
//!
//! let ray = scene.ray([0.25, 0.5, 3.0], [0.0, 0.0, -1.0])?;
//! let mut scratch = Scratch::<Plain<f32>, 2, 4>::new();
//! let mut work = Work::default();
//! let (interval, limits) = (Interval::ahead(), Limits::default());
//! let hit = newton::closest(&scene, &patches, &tree, &ray, &interval, &limits, &mut scratch.view(), &mut work)?;
//! let hit = hit.expect("the ray meets the saddle");
//! // z = u + v − 2 u v there, at u = 1/4 and v = 1/2.
//! assert!((hit.t - 2.5).abs() < 1e-5 && (hit.u - 0.25).abs() < 1e-5 && (hit.v - 0.5).abs() < 1e-5);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! A B-spline surface is cut into Bézier surfaces first, likewise in lent memory: see [`pieces`].
//!
//! What was prepared elsewhere can be lent as tables: each kind of slot is made from its numbers by a `const fn`
//! `from_numbers`, and tells them by `numbers`; `patchray bake` of the harness writes such tables as source. [`LAYOUT`] says
//! what the numbers mean.
//!
//! The modules stand in the order in which data flows; each knows only those above it.

pub mod layout;
pub use layout::LAYOUT;

pub mod story;

pub mod scalar;
pub mod told;

pub mod ray;
pub mod reading;

pub mod limits;

pub mod arena;

pub mod parameter;

pub mod bernstein;
pub mod casteljau;
pub mod point;
pub mod surface;

pub mod bspline;
pub mod pieces;

pub mod frame;

pub mod planes;

pub mod domain;
pub mod patch;

pub mod measure;

pub mod tree;

pub mod subdivide;

pub mod grid;
pub mod walk;

mod local;

pub mod root;

mod alone;

pub mod newton;

mod contract;
pub mod region;

pub mod clip;
mod graze;
mod part;
mod passed;
mod roots;

pub mod clipper;

pub mod fallback;

pub mod sweep;
pub mod verify;

pub mod scene;

pub mod outline;

pub mod view;

pub mod span;

pub mod line;

pub mod method;

// Not in the program of unit tests, which links the library as well: a name of C can be there once.
#[cfg(all(feature = "capi", not(test)))]
pub mod capi;
