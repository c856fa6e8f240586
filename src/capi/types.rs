//! The structs of the C interface, written once for both precisions; cbindgen makes `patchray_ray_f32` of
//! `patchray_ray<f32>`.
//!
//! Slots of tables are the kernel's own, said once more so that they can be declared and listed in C; that both are laid out
//! alike is checked when compiling. All are plain numbers, of which any bits are valid.

use crate::frame::Frame;
use crate::grid::GridSlot;
use crate::method::{Followed, Remembered};
use crate::patch::{Parallelepiped, Patch};
use crate::ray::Incidence;
use crate::scalar::Scalar;
use crate::scene::SurfaceSlot;
use crate::span::Span;
use crate::view::{Sight, ViewHeader};

/// The version of all that tables hold: a library refuses tables of another one with PATCHRAY_LAYOUT_DIFFERS.
pub const PATCHRAY_LAYOUT: u32 = 5;

/// What a hit's `surface` is where there is none.
pub const PATCHRAY_NO_SURFACE: u32 = 0xffff_ffff;

/// The most hits that a call lists.
pub const PATCHRAY_MAX_HITS: u32 = 32;

/// The highest degree of a surface in u and in v.
pub const PATCHRAY_MAX_DEGREE: u32 = 15;

/// `patchray_limits.acceptance`: the paper's rule, likely right.
pub const PATCHRAY_ACCEPTANCE_PAPER: u32 = 0;
/// `patchray_limits.acceptance`: only what is proved, slower. newton_closest and newton_any take either for the same: they
/// prove nothing.
pub const PATCHRAY_ACCEPTANCE_PROVED: u32 = 1;

/// `patchray_hit.incidence`: the ray passes through the surface.
pub const PATCHRAY_CROSSING: u32 = 0;
/// `patchray_hit.incidence`: the ray is tangent to working precision, and t, u, v are known to half the digits.
pub const PATCHRAY_GRAZING: u32 = 1;
/// `patchray_hit.incidence`: the ray lies in the surface for a stretch, to working precision, and t is where it begins.
pub const PATCHRAY_CONTACT: u32 = 2;

/// A surface to build a scene of: of degrees degree_u x degree_v, (degree_u + 1)(degree_v + 1) control points, the index in u
/// the outer one.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_net<S> {
    /// x, y, z of each control point; for weighted functions w x, w y, w z, w.
    pub points: *const S,
    /// How many numbers that is.
    pub points_len: usize,
    /// 1 to 15.
    pub degree_u: u32,
    /// 1 to 15.
    pub degree_v: u32,
}

/// How a scene is prepared. Functions take NULL for the defaults.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_options<S> {
    /// Voxels per surface in the scene's grid. More cost memory and steps, fewer cost box tests.
    pub scene_density: S,
    /// Where the nets' coordinates are 0, in the coordinates of rays and hits: 0, 0, 0 unless the scene is far from there.
    pub origin: [S; 3],
    /// How far a patch may be from its parallelogram, over the diagonal of the scene's box. Smaller makes more patches, about
    /// as 1/flatness, and better starts; of larger ones roots are lost.
    pub flatness: S,
    /// Voxels per patch in the surfaces' grids; 1 to 8 are near each other in speed.
    pub grid_density: S,
    /// The most voxels of the scene's grid.
    pub scene_voxels: u32,
    /// The most voxels of one surface's grid.
    pub grid_voxels: u32,
    /// How often a surface may be halved in each direction; more than 14 are as 14.
    pub depth: u32,
    /// The most patches that a surface may make.
    pub patches_per_surface: u32,
    /// By how many roundings boxes are larger than what they enclose. Fewer than the default make misses of roundings.
    pub padding: u32,
}

/// A surface of a scene: a slot of its table.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_surface<S> {
    /// Its box, the bounds on its second derivatives, its size, its largest coordinate, its least weight, its own origin.
    pub numbers: [S; 15],
    /// Its first control point, and its degrees.
    pub counts: [u32; 3],
}

/// The grid over a surface's patches, or over the scene's surfaces: a slot of its table.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_grid<S> {
    /// Its box, a voxel's sides, and their inverses.
    pub numbers: [S; 12],
    /// Voxels along each axis, its first offset and first reference.
    pub counts: [u32; 5],
}

/// The scale of a scene's coordinates.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_frame<S> {
    /// The scale and its inverse, the origin, the box, the largest coordinate, the box's diagonal.
    pub numbers: [S; 13],
    /// The power of two that the scale is.
    pub exponent: i32,
}

/// A patch: a slot of its table.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_patch<S> {
    /// Its parallelepiped, and how far its derivatives stray.
    pub numbers: [S; 13],
    /// The sides of its parallelogram, and its domain.
    pub parts: [u16; 4],
}

/// An inner node of a surface's tree: a slot of its table.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_node<S> {
    /// Its parallelepiped.
    pub numbers: [S; 12],
}

/// What the last ray of a scan line left on one surface: coherence memory of one thread has a slot per surface. Begin with
/// zeros; from then on it is the library's.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_remembered<S> {
    /// u and v.
    pub at: [S; 2],
    /// The scan line, plus one.
    pub stamp: u32,
}

/// Memory that is lent for a scene. Counts say how many slots are lent, and after the call how many are needed; with counts
/// of 0 addresses may be NULL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_scene_memory<S> {
    /// Numbers of control points.
    pub points: *mut S,
    /// How many numbers.
    pub points_len: usize,
    /// Surfaces.
    pub surfaces: *mut patchray_surface<S>,
    /// How many.
    pub surfaces_len: usize,
    /// Of the scene's grid.
    pub offsets: *mut u32,
    /// How many.
    pub offsets_len: usize,
    /// Of the scene's grid.
    pub references: *mut u32,
    /// How many.
    pub references_len: usize,
    /// Of an error that is about one surface: its number. Else PATCHRAY_NO_SURFACE.
    pub wrong_surface: u32,
}

/// A scene: tables in memory that was lent, or in flash. What `clipping` needs.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_scene<S> {
    /// By which version, precision and kind of control points it was made.
    pub layout: u32,
    /// The scale of its coordinates.
    pub frame: patchray_frame<S>,
    /// The grid over its surfaces.
    pub grid: patchray_grid<S>,
    /// Numbers of control points.
    pub points: *const S,
    /// How many numbers.
    pub points_len: usize,
    /// Surfaces.
    pub surfaces: *const patchray_surface<S>,
    /// How many.
    pub surfaces_len: usize,
    /// Of its grid.
    pub offsets: *const u32,
    /// How many.
    pub offsets_len: usize,
    /// Of its grid.
    pub references: *const u32,
    /// How many.
    pub references_len: usize,
}

/// Memory that is lent for patches, and for trees over them.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_patches_memory<S> {
    /// Patches.
    pub patches: *mut patchray_patch<S>,
    /// How many.
    pub patches_len: usize,
    /// Where each surface's patches begin, and where the last one's end.
    pub first: *mut u32,
    /// How many.
    pub first_len: usize,
    /// The trees' inner nodes; only if a tree is asked for, as the next.
    pub nodes: *mut patchray_node<S>,
    /// How many.
    pub nodes_len: usize,
    /// The trees' links.
    pub links: *mut u32,
    /// How many.
    pub links_len: usize,
    /// Of an error that is about one surface: its number. Else PATCHRAY_NO_SURFACE.
    pub wrong_surface: u32,
}

/// The patches of a scene's surfaces. What all methods but `clipping` need.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_patches<S> {
    /// By which version and precision they were made.
    pub layout: u32,
    /// Patches.
    pub patches: *const patchray_patch<S>,
    /// How many.
    pub patches_len: usize,
    /// Where each surface's patches begin, and where the last one's end.
    pub first: *const u32,
    /// How many.
    pub first_len: usize,
}

/// The trees over the patches of each surface. What `newton` needs.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_tree<S> {
    /// By which version and precision they were made.
    pub layout: u32,
    /// Inner nodes.
    pub nodes: *const patchray_node<S>,
    /// How many.
    pub nodes_len: usize,
    /// Links.
    pub links: *const u32,
    /// How many.
    pub links_len: usize,
}

/// Memory that is lent for grids over patches.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_grids_memory<S> {
    /// Grids, one per surface.
    pub grids: *mut patchray_grid<S>,
    /// How many.
    pub grids_len: usize,
    /// Their offsets.
    pub offsets: *mut u32,
    /// How many.
    pub offsets_len: usize,
    /// Their references.
    pub references: *mut u32,
    /// How many.
    pub references_len: usize,
}

/// The grids over the patches of each surface. What the coherent methods need.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_grids<S> {
    /// By which version and precision they were made.
    pub layout: u32,
    /// Grids, one per surface.
    pub grids: *const patchray_grid<S>,
    /// How many.
    pub grids_len: usize,
    /// Their offsets.
    pub offsets: *const u32,
    /// How many.
    pub offsets_len: usize,
    /// Their references.
    pub references: *const u32,
    /// How many.
    pub references_len: usize,
}

/// A pinhole camera: the ray of the image's point (x, y) starts at the eye and has the direction forward + x right + y up.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct patchray_camera<S> {
    /// Where all rays start.
    pub eye: [S; 3],
    /// The direction of the image's middle, (0, 0).
    pub forward: [S; 3],
    /// What one unit of x adds.
    pub right: [S; 3],
    /// What one unit of y adds.
    pub up: [S; 3],
}

/// Where a patch can be seen: a slot of a view's tables.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_sight<S> {
    /// The octagon around it in the image, and its least depth.
    pub numbers: [S; 9],
}

/// How a view turns its scene.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_lens<S> {
    /// The turned eye, the scene's middle depth, the turned vectors forward, right and up, and the scale.
    pub numbers: [S; 16],
}

/// Memory that is lent for a view. Counts say how many slots are lent, and after the call how many are needed; with counts of 0
/// addresses may be NULL.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_view_memory<S> {
    /// Numbers of control points.
    pub points: *mut S,
    /// How many numbers.
    pub points_len: usize,
    /// Rows in which the surfaces are seen.
    pub surfaces: *mut S,
    /// How many numbers.
    pub surfaces_len: usize,
    /// Patches.
    pub patches: *mut patchray_patch<S>,
    /// How many.
    pub patches_len: usize,
    /// What is seen of the patches.
    pub sights: *mut patchray_sight<S>,
    /// How many.
    pub sights_len: usize,
    /// Rows in which runs of 16 patches are seen.
    pub runs: *mut S,
    /// How many numbers.
    pub runs_len: usize,
    /// Where each surface's runs begin, and where the last one's end.
    pub first_runs: *mut u32,
    /// How many.
    pub first_runs_len: usize,
}

/// A scene as seen by a camera. What tracing by scan lines needs.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_view<S> {
    /// By which version, precision and kind of control points it was made.
    pub layout: u32,
    /// How it is turned.
    pub header: patchray_lens<S>,
    /// The scene, its control points turned.
    pub scene: patchray_scene<S>,
    /// The patches, turned.
    pub patches: patchray_patches<S>,
    /// Rows in which the surfaces are seen.
    pub surfaces: *const S,
    /// How many numbers.
    pub surfaces_len: usize,
    /// What is seen of the patches.
    pub sights: *const patchray_sight<S>,
    /// How many.
    pub sights_len: usize,
    /// Rows in which runs of 16 patches are seen.
    pub runs: *const S,
    /// How many numbers.
    pub runs_len: usize,
    /// Where each surface's runs begin, and where the last one's end.
    pub first_runs: *const u32,
    /// How many.
    pub first_runs_len: usize,
}

/// Where in a scan line a patch can be seen: a slot of memory that is lent for a line.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_span<S> {
    /// The least and the largest x, and its least depth.
    pub numbers: [S; 3],
    /// Its surface and patch, the next one, and the bucket in which it ends.
    pub counts: [u32; 4],
}

/// Memory that is lent for tracing a scan line, of one thread. Begin with zeros; from then on it is the library's, and may be lent
/// for any other line. On PATCHRAY_MEMORY the counts say how many slots are needed: of no line more than the view has patches.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_line_memory<S> {
    /// What can be seen in the line.
    pub spans: *mut patchray_span<S>,
    /// How many.
    pub spans_len: usize,
    /// What can be seen around a ray: as many as spans are needed.
    pub active: *mut u32,
    /// How many.
    pub active_len: usize,
    /// At least one; best is about one for each span.
    pub buckets: *mut u32,
    /// How many.
    pub buckets_len: usize,
}

/// What the last ray of a scan line left on one surface, for the predicted methods: coherence memory of one thread has a slot per
/// surface. Begin with zeros; from then on it is the library's.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_followed<S> {
    /// Where it was, its point, how that moves, and how that changes.
    pub numbers: [S; 18],
    /// The scan line, plus one.
    pub stamp: u32,
}

/// The rays of a scan line of a view.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_line<S> {
    /// x and y of each ray's point of the image: best from one end of the line to the other.
    pub places: *const S,
    /// How many numbers: two for each ray, so an even count.
    pub places_len: usize,
    /// The least and the largest x of them all.
    pub x: [S; 2],
    /// The least and the largest y; both the same where all rays are in one row.
    pub y: [S; 2],
    /// The least t that counts, such as 0. What lies behind the eye does not count, whatever it is.
    pub t_min: S,
    /// The largest t that counts, such as INFINITY.
    pub t_max: S,
    /// Numbers the line, from 0 to 0xfffffffe: a number that no earlier line with this coherence memory had.
    pub number: u32,
}

/// A ray `origin + t direction`, of which t_min to t_max counts. The direction need not be of unit length.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct patchray_ray<S> {
    /// Where t = 0.
    pub origin: [S; 3],
    /// What one unit of t adds.
    pub direction: [S; 3],
    /// The least t that counts, such as 0; -INFINITY if all that lies behind the origin counts too.
    pub t_min: S,
    /// The largest t that counts, such as INFINITY.
    pub t_max: S,
}

/// Where a ray meets a surface.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct patchray_hit<S> {
    /// Along the ray, in units of its direction.
    pub t: S,
    /// On the surface, 0 to 1.
    pub u: S,
    /// On the surface, 0 to 1.
    pub v: S,
    /// The surface's number, in the order of the nets; PATCHRAY_NO_SURFACE if there is no hit.
    pub surface: u32,
    /// PATCHRAY_CROSSING, PATCHRAY_GRAZING or PATCHRAY_CONTACT; without a hit PATCHRAY_CROSSING.
    pub incidence: u32,
}

/// Bounds on the work of one call. Functions take NULL for the defaults; one that sets some begins with
/// patchray_limits_default_f32 or _f64, since a budget of 0 allows nothing.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct patchray_limits<S> {
    /// How far from the ray a root may lie, relative to a scene of size 1; not below 0.
    pub tolerance: S,
    /// The factor in the paper's eq. (1). Smaller flags more rays as critical, which costs time and loses fewer double roots.
    pub critical_factor: S,
    /// The share of an interval that a clip has to remove, else it is bisected.
    pub clip_threshold: S,
    /// Evaluations that one Newton start may take, at least 1.
    pub newton_iterations: u32,
    /// Starts per patch, 1 to 3.
    pub newton_starts: u32,
    /// How often one Newton step may be halved.
    pub newton_halvings: u32,
    /// PATCHRAY_ACCEPTANCE_PAPER or PATCHRAY_ACCEPTANCE_PROVED.
    pub acceptance: u32,
    /// Budget: surfaces whose box is tested.
    pub surfaces: u32,
    /// Budget: nodes of trees tested.
    pub nodes: u32,
    /// Budget: patches tested.
    pub patches: u32,
    /// Budget: voxels visited.
    pub voxels: u32,
    /// Budget: spans of a scan line visited.
    pub spans: u32,
    /// Budget: Newton iterations.
    pub newton_steps: u32,
    /// Budget: clips.
    pub clip_steps: u32,
    /// Budget: bisections.
    pub bisections: u32,
    /// Budget: domains of one surface that wait to be clipped. There is room for 64, and more are as 64.
    pub pending_domains: u32,
}

macro_rules! counters {
    ($($(#[$doc:meta])* $name:ident,)*) => {
        /// What one call did.
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct patchray_work {
            $($(#[$doc])* pub $name: u32,)*
        }

        impl From<crate::limits::Work> for patchray_work {
            #[inline]
            fn from(work: crate::limits::Work) -> Self {
                patchray_work { $($name: work.$name),* }
            }
        }

        const _: () = assert!([$(stringify!($name)),*].len() == crate::limits::Work::COUNT);
    };
}

counters! {
    /// Surfaces whose box was tested.
    surfaces_tested,
    /// Nodes of trees tested.
    nodes_visited,
    /// Patches tested.
    patches_tested,
    /// Voxels visited.
    voxels_visited,
    /// Spans of a scan line visited.
    spans_visited,
    /// Newton starts.
    newton_starts,
    /// Newton iterations.
    newton_steps,
    /// Patches met in the critical case of eq. (1).
    critical,
    /// Patches met of which no start led to a root, taken for no hit.
    unresolved,
    /// Of fallbacks; 0 here.
    excluded,
    /// Of fallbacks; 0 here.
    handed_over,
    /// Roots found, each time that they were found.
    intersection_points,
    /// Coherent: points confirmed at once.
    verified,
    /// Coherent: points decided over the testing ray's list.
    decided_by_list,
    /// Coherent: remembered starts that led to nothing.
    start_failed,
    /// Coherent: searches of a surface's whole grid.
    full_searches,
    /// Clips.
    clip_steps,
    /// Bisections.
    bisections,
    /// Surfaces of which a domain was bisected.
    bisection_cases,
    /// Coherent clipping: points not verified because the ray is critical.
    refused_as_critical,
    /// Coherent clipping: points not verified because of another patch.
    refused_by_list,
    /// Of those: the other patch only adjoins.
    refused_by_neighbour,
}

/// Compiles only if the structs of the C interface are laid out as the kernel's slots. Both are of the same numbers in the
/// same order under `repr(C)`, so that sizes and alignments decide.
pub(super) const fn checked_layouts<S: Scalar>() {
    const fn alike<A, B>() -> bool {
        size_of::<A>() == size_of::<B>() && align_of::<A>() == align_of::<B>()
    }
    const {
        assert!(alike::<patchray_surface<S>, SurfaceSlot<S>>());
        assert!(alike::<patchray_grid<S>, GridSlot<S>>());
        assert!(alike::<patchray_frame<S>, Frame<S>>());
        assert!(alike::<patchray_patch<S>, Patch<S>>());
        assert!(alike::<patchray_node<S>, Parallelepiped<S>>());
        assert!(alike::<patchray_remembered<S>, Remembered<S>>());
        assert!(alike::<patchray_sight<S>, Sight<S>>());
        assert!(alike::<patchray_lens<S>, ViewHeader<S>>());
        assert!(alike::<patchray_span<S>, Span<S>>());
        assert!(alike::<patchray_followed<S>, Followed<S>>());
    }
}

// A macro in the header cannot name what it stands for.
const _: () = assert!(PATCHRAY_LAYOUT == crate::LAYOUT);

const _: () = {
    assert!(PATCHRAY_CROSSING == Incidence::Crossing as u32);
    assert!(PATCHRAY_GRAZING == Incidence::Grazing as u32);
    assert!(PATCHRAY_CONTACT == Incidence::Contact as u32);
};

const _: () = (checked_layouts::<f32>(), checked_layouts::<f64>()).0;
