// patchray: rays against Bezier surfaces themselves, in memory that the caller lends.
//
// No global state, no allocator, nothing to be freed, a bounded amount of work per ray, the same bits on every target.
//
// Names end in the precision, _f32 or _f64; functions on surfaces with weights in _f32_weighted or _f64_weighted. In this
// order:
//
//   patchray_scene_build    surfaces to a scene                  all methods
//   patchray_patches_build  scene to patches (and trees)         all but clipping (trees: newton)
//   patchray_grids_build    patches to grids                     newton_coherent, clipping_coherent
//   patchray_..._closest    a ray to a hit, a miss, or neither   clipping, clipping_coherent, newton, newton_coherent
//
// And for pictures, whose rays start at one eye, by the methods that are the fastest: no trees and no grids are needed.
//
//   patchray_view_build     a scene, its patches and a camera    clipping_predicted, newton_predicted
//   patchray_..._line       the rays of a scan line, each to     the same
//                           a hit, a miss, or neither
//
// Memory. Who calls lends all of it, as addresses and counts. Preparations say how much they need if they are asked with
// counts of 0: they answer PATCHRAY_MEMORY, and the counts are set. Prepared tables hold the addresses of what was lent, are
// read only from then on, and may be used by any number of threads; so may tables in flash. Scratch, coherence memory and
// memory of lines are of one thread at a time. What lent memory holds at first does not matter, but that memory of coherence
// and of lines is set.
//
// Answers. Not negative: PATCHRAY_OK, PATCHRAY_MISS, PATCHRAY_HIT. Negative: why there is none. Then nothing was written, but
// where it is said; and a preparation that answers PATCHRAY_MEMORY has set the counts, and may have written to all that it was
// lent, so that tables which were made there before are lost. An address that is NULL or misaligned, memory that is too short
// by its count or overlaps other memory of the same call, a number that is NaN: each has its code. That memory of the stated
// length is there at an address is believed. Ranges of memory that are only read may overlap.
//
// A program that calls one method and is linked with --gc-sections holds no code of another.
//
// Example. The teapot in 64 x 64 rays, by clipping. teapot.h holds its 32 surfaces: static const float teapot[32][48]
// (tests/capi/teapot.awk makes it of fixtures/patches/teapot.bpt).
//
//     #include "patchray.h"
//     #include "teapot.h"
//     #include <math.h>
//     #include <stdio.h>
//
//     static patchray_net_f32 nets[32];
//     static float points[32 * 48];
//     static patchray_surface_f32 surfaces[32];
//     static uint32_t offsets[100], references[200];
//     static uint64_t scratch[PATCHRAY_CLIP_CUBIC_WORDS_F32];
//
//     int main(void)
//     {
//         patchray_scene_memory_f32 memory = {points, 32 * 48, surfaces, 32, offsets, 100, references, 200, 0};
//         patchray_scene_f32 scene;
//         patchray_ray_f32 ray = {{7.6171875f, -9.3203125f, 7.59375f}, {0, 0, 0}, 0, INFINITY};
//         unsigned hits = 0;
//         for (int k = 0; k < 32; k++) {
//             nets[k].points = teapot[k];
//             nets[k].points_len = 48;
//             nets[k].degree_u = nets[k].degree_v = 3;
//         }
//         int32_t code = patchray_scene_build_f32(nets, 32, NULL, &memory, &scene);
//         if (code < 0) {
//             printf("%s: %zu offsets, %zu references\n", patchray_name(code), memory.offsets_len, memory.references_len);
//             return 1;
//         }
//         for (int row = 0; row < 64; row++) {
//             for (int column = 0; column < 64; column++) {
//                 float x = (float)(16 * column - 504) / 512, y = (float)(504 - 16 * row) / 512;
//                 ray.direction[0] = -222.75f + 68 * x - 24 * y;
//                 ray.direction[1] = 297 + 51 * x + 32 * y;
//                 ray.direction[2] = -198 + 75 * y;
//                 patchray_hit_f32 hit;
//                 code = patchray_clipping_closest_f32(&scene, &ray, NULL, scratch, PATCHRAY_CLIP_CUBIC_WORDS_F32, &hit, NULL);
//                 if (code < 0) {
//                     printf("%s\n", patchray_name(code));
//                     return 1;
//                 }
//                 hits += code == PATCHRAY_HIT;
//             }
//         }
//         printf("%u of 4096 rays hit the teapot\n", hits);
//         return 0;
//     }
//
// Made by tests/capi/header: change src/capi/*.rs or patchray.head, not this file.

#ifndef PATCHRAY_H
#define PATCHRAY_H

#include <stddef.h>
#include <stdint.h>

// Scratch in words of 8 bytes, for Newton's methods on surfaces up to degrees 3 x 3; as all here for both kinds of control
// points.
#define PATCHRAY_NEWTON_CUBIC_WORDS_F32 39

// The same, for any degrees.
#define PATCHRAY_NEWTON_WORDS_F32 435

// Scratch for the clipping methods, up to degrees 3 x 3.
#define PATCHRAY_CLIP_CUBIC_WORDS_F32 408

// The same, for any degrees.
#define PATCHRAY_CLIP_WORDS_F32 1164

// Scratch for patches, up to degrees 3 x 3.
#define PATCHRAY_SUBDIVIDE_CUBIC_WORDS_F32 205

// The same, for any degrees.
#define PATCHRAY_SUBDIVIDE_WORDS_F32 685

// Newton's methods in double precision, up to degrees 3 x 3.
#define PATCHRAY_NEWTON_CUBIC_WORDS_F64 75

// The same, for any degrees.
#define PATCHRAY_NEWTON_WORDS_F64 867

// The clipping methods in double precision, up to degrees 3 x 3.
#define PATCHRAY_CLIP_CUBIC_WORDS_F64 810

// The same, for any degrees.
#define PATCHRAY_CLIP_WORDS_F64 2322

// Patches in double precision, up to degrees 3 x 3.
#define PATCHRAY_SUBDIVIDE_CUBIC_WORDS_F64 237

// The same, for any degrees.
#define PATCHRAY_SUBDIVIDE_WORDS_F64 1197

// A preparation is complete.
#define PATCHRAY_OK 0

// The ray meets nothing within its t_min to t_max.
#define PATCHRAY_MISS 0

// The ray meets a surface; where is said in the hit.
#define PATCHRAY_HIT 1

// An address that has to be given is NULL, or one that comes with a count other than 0.
#define PATCHRAY_NULL -1

// An address is not a multiple of what its type asks for.
#define PATCHRAY_MISALIGNED -2

// Memory that the call writes has bytes in common with other memory of the same call.
#define PATCHRAY_OVERLAP -3

// A count is so large that the memory would not fit into the address space.
#define PATCHRAY_COUNT -4

// A table was not made by this version of the library, for this precision and this kind of control points, or is not
// filled at all.
#define PATCHRAY_LAYOUT_DIFFERS -5

// Lent memory has too few slots. After a preparation its counts say how many are needed; what it was lent is then not as it was
// before, and no table that was made in it can be used any more.
#define PATCHRAY_MEMORY -6

// Scratch has too few words for the degrees of the surfaces.
#define PATCHRAY_SCRATCH -7

// More surfaces, control points, patches or voxels than can be numbered.
#define PATCHRAY_TOO_LARGE -8

// An option, a limit, or a number of a line or hit is NaN, or not one of the values that it may have.
#define PATCHRAY_OPTION -9

// Tables that do not belong together, such as patches of other surfaces than the scene has.
#define PATCHRAY_TABLES -10

// A surface's degree is not within 1 to 15.
#define PATCHRAY_DEGREE -11

// A surface's count of numbers is not that of its control points.
#define PATCHRAY_POINTS -12

// A control point has a coordinate or weight that is NaN or infinite.
#define PATCHRAY_POINT_NOT_FINITE -13

// A control point has a weight that is not positive.
#define PATCHRAY_WEIGHT -14

// A surface makes more patches than the options allow.
#define PATCHRAY_PATCHES -15

// A camera's three vectors lie in a plane, or all but.
#define PATCHRAY_CAMERA_FLAT -16

// A camera is farther away than eight times the scene's size: trace its rays one by one.
#define PATCHRAY_CAMERA_FAR -17

// A surface is so much smaller than its scene that the number type cannot hold both: by 2^103 in single precision, by 2^970 in
// double.
#define PATCHRAY_SMALL -18

// A coordinate of the ray is NaN.
#define PATCHRAY_RAY_NAN -21

// A coordinate of the ray is infinite.
#define PATCHRAY_RAY_INFINITE -22

// The ray's direction is (0, 0, 0).
#define PATCHRAY_RAY_DIRECTION -23

// The ray's t in the scene, or small steps of it, cannot be held by the number type.
#define PATCHRAY_RAY_RANGE -24

// t_min or t_max is NaN, or t_min is the larger.
#define PATCHRAY_RAY_INTERVAL -25

// A ray of a view is more than 45 degrees off its camera's forward: to be traced by itself.
#define PATCHRAY_RAY_OUT_OF_VIEW -26

// A ray of a scan line is not within the line's x and y.
#define PATCHRAY_RAY_OUT_OF_LINE -27

// The budget of tested surfaces ran out. Of this and all below: neither a hit nor a miss.
#define PATCHRAY_GAVE_UP_SURFACES -41

// The budget of tree nodes ran out.
#define PATCHRAY_GAVE_UP_NODES -42

// The budget of tested patches ran out.
#define PATCHRAY_GAVE_UP_PATCHES -43

// The budget of voxels ran out.
#define PATCHRAY_GAVE_UP_VOXELS -44

// The budget of Newton iterations ran out.
#define PATCHRAY_GAVE_UP_NEWTON_STEPS -45

// The budget of clips ran out.
#define PATCHRAY_GAVE_UP_CLIP_STEPS -46

// The budget of bisections ran out.
#define PATCHRAY_GAVE_UP_BISECTIONS -47

// The room for domains that wait to be clipped ran out.
#define PATCHRAY_GAVE_UP_PENDING_DOMAINS -48

// The list of hits is full; it holds the closest ones.
#define PATCHRAY_GAVE_UP_HITS -49

// The budget of spans of a scan line ran out.
#define PATCHRAY_GAVE_UP_SPANS -50

// The version of all that tables hold: a library refuses tables of another one with PATCHRAY_LAYOUT_DIFFERS.
#define PATCHRAY_LAYOUT 5

// What a hit's `surface` is where there is none.
#define PATCHRAY_NO_SURFACE 4294967295

// The most hits that a call lists.
#define PATCHRAY_MAX_HITS 32

// The highest degree of a surface in u and in v.
#define PATCHRAY_MAX_DEGREE 15

// `patchray_limits.acceptance`: the paper's rule, likely right.
#define PATCHRAY_ACCEPTANCE_PAPER 0

// `patchray_limits.acceptance`: only what is proved, slower. newton_closest and newton_any take either for the same: they
// prove nothing.
#define PATCHRAY_ACCEPTANCE_PROVED 1

// `patchray_hit.incidence`: the ray passes through the surface.
#define PATCHRAY_CROSSING 0

// `patchray_hit.incidence`: the ray is tangent to working precision, and t, u, v are known to half the digits.
#define PATCHRAY_GRAZING 1

// `patchray_hit.incidence`: the ray lies in the surface for a stretch, to working precision, and t is where it begins.
#define PATCHRAY_CONTACT 2

// A surface to build a scene of: of degrees degree_u x degree_v, (degree_u + 1)(degree_v + 1) control points, the index in u
// the outer one.
typedef struct {
  // x, y, z of each control point; for weighted functions w x, w y, w z, w.
  const float *points;
  // How many numbers that is.
  size_t points_len;
  // 1 to 15.
  uint32_t degree_u;
  // 1 to 15.
  uint32_t degree_v;
} patchray_net_f32;

// How a scene is prepared. Functions take NULL for the defaults.
typedef struct {
  // Voxels per surface in the scene's grid. More cost memory and steps, fewer cost box tests.
  float scene_density;
  // Where the nets' coordinates are 0, in the coordinates of rays and hits: 0, 0, 0 unless the scene is far from there.
  float origin[3];
  // How far a patch may be from its parallelogram, over the diagonal of the scene's box. Smaller makes more patches, about
  // as 1/flatness, and better starts; of larger ones roots are lost.
  float flatness;
  // Voxels per patch in the surfaces' grids; 1 to 8 are near each other in speed.
  float grid_density;
  // The most voxels of the scene's grid.
  uint32_t scene_voxels;
  // The most voxels of one surface's grid.
  uint32_t grid_voxels;
  // How often a surface may be halved in each direction; more than 14 are as 14.
  uint32_t depth;
  // The most patches that a surface may make.
  uint32_t patches_per_surface;
  // By how many roundings boxes are larger than what they enclose. Fewer than the default make misses of roundings.
  uint32_t padding;
} patchray_options_f32;

// A surface of a scene: a slot of its table.
typedef struct {
  // Its box, the bounds on its second derivatives, its size, its largest coordinate, its least weight, its own origin.
  float numbers[15];
  // Its first control point, and its degrees.
  uint32_t counts[3];
} patchray_surface_f32;

// Memory that is lent for a scene. Counts say how many slots are lent, and after the call how many are needed; with counts
// of 0 addresses may be NULL.
typedef struct {
  // Numbers of control points.
  float *points;
  // How many numbers.
  size_t points_len;
  // Surfaces.
  patchray_surface_f32 *surfaces;
  // How many.
  size_t surfaces_len;
  // Of the scene's grid.
  uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Of the scene's grid.
  uint32_t *references;
  // How many.
  size_t references_len;
  // Of an error that is about one surface: its number. Else PATCHRAY_NO_SURFACE.
  uint32_t wrong_surface;
} patchray_scene_memory_f32;

// The scale of a scene's coordinates.
typedef struct {
  // The scale and its inverse, the origin, the box, the largest coordinate, the box's diagonal.
  float numbers[13];
  // The power of two that the scale is.
  int32_t exponent;
} patchray_frame_f32;

// The grid over a surface's patches, or over the scene's surfaces: a slot of its table.
typedef struct {
  // Its box, a voxel's sides, and their inverses.
  float numbers[12];
  // Voxels along each axis, its first offset and first reference.
  uint32_t counts[5];
} patchray_grid_f32;

// A scene: tables in memory that was lent, or in flash. What `clipping` needs.
typedef struct {
  // By which version, precision and kind of control points it was made.
  uint32_t layout;
  // The scale of its coordinates.
  patchray_frame_f32 frame;
  // The grid over its surfaces.
  patchray_grid_f32 grid;
  // Numbers of control points.
  const float *points;
  // How many numbers.
  size_t points_len;
  // Surfaces.
  const patchray_surface_f32 *surfaces;
  // How many.
  size_t surfaces_len;
  // Of its grid.
  const uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Of its grid.
  const uint32_t *references;
  // How many.
  size_t references_len;
} patchray_scene_f32;

// A patch: a slot of its table.
typedef struct {
  // Its parallelepiped, and how far its derivatives stray.
  float numbers[13];
  // The sides of its parallelogram, and its domain.
  uint16_t parts[4];
} patchray_patch_f32;

// An inner node of a surface's tree: a slot of its table.
typedef struct {
  // Its parallelepiped.
  float numbers[12];
} patchray_node_f32;

// Memory that is lent for patches, and for trees over them.
typedef struct {
  // Patches.
  patchray_patch_f32 *patches;
  // How many.
  size_t patches_len;
  // Where each surface's patches begin, and where the last one's end.
  uint32_t *first;
  // How many.
  size_t first_len;
  // The trees' inner nodes; only if a tree is asked for, as the next.
  patchray_node_f32 *nodes;
  // How many.
  size_t nodes_len;
  // The trees' links.
  uint32_t *links;
  // How many.
  size_t links_len;
  // Of an error that is about one surface: its number. Else PATCHRAY_NO_SURFACE.
  uint32_t wrong_surface;
} patchray_patches_memory_f32;

// The patches of a scene's surfaces. What all methods but `clipping` need.
typedef struct {
  // By which version and precision they were made.
  uint32_t layout;
  // Patches.
  const patchray_patch_f32 *patches;
  // How many.
  size_t patches_len;
  // Where each surface's patches begin, and where the last one's end.
  const uint32_t *first;
  // How many.
  size_t first_len;
} patchray_patches_f32;

// The trees over the patches of each surface. What `newton` needs.
typedef struct {
  // By which version and precision they were made.
  uint32_t layout;
  // Inner nodes.
  const patchray_node_f32 *nodes;
  // How many.
  size_t nodes_len;
  // Links.
  const uint32_t *links;
  // How many.
  size_t links_len;
} patchray_tree_f32;

// A ray `origin + t direction`, of which t_min to t_max counts. The direction need not be of unit length.
typedef struct {
  // Where t = 0.
  float origin[3];
  // What one unit of t adds.
  float direction[3];
  // The least t that counts, such as 0; -INFINITY if all that lies behind the origin counts too.
  float t_min;
  // The largest t that counts, such as INFINITY.
  float t_max;
} patchray_ray_f32;

// Bounds on the work of one call. Functions take NULL for the defaults; one that sets some begins with
// patchray_limits_default_f32 or _f64, since a budget of 0 allows nothing.
typedef struct {
  // How far from the ray a root may lie, relative to a scene of size 1; not below 0.
  float tolerance;
  // The factor in the paper's eq. (1). Smaller flags more rays as critical, which costs time and loses fewer double roots.
  float critical_factor;
  // The share of an interval that a clip has to remove, else it is bisected.
  float clip_threshold;
  // Evaluations that one Newton start may take, at least 1.
  uint32_t newton_iterations;
  // Starts per patch, 1 to 3.
  uint32_t newton_starts;
  // How often one Newton step may be halved.
  uint32_t newton_halvings;
  // PATCHRAY_ACCEPTANCE_PAPER or PATCHRAY_ACCEPTANCE_PROVED.
  uint32_t acceptance;
  // Budget: surfaces whose box is tested.
  uint32_t surfaces;
  // Budget: nodes of trees tested.
  uint32_t nodes;
  // Budget: patches tested.
  uint32_t patches;
  // Budget: voxels visited.
  uint32_t voxels;
  // Budget: spans of a scan line visited.
  uint32_t spans;
  // Budget: Newton iterations.
  uint32_t newton_steps;
  // Budget: clips.
  uint32_t clip_steps;
  // Budget: bisections.
  uint32_t bisections;
  // Budget: domains of one surface that wait to be clipped. There is room for 64, and more are as 64.
  uint32_t pending_domains;
} patchray_limits_f32;

// Where a ray meets a surface.
typedef struct {
  // Along the ray, in units of its direction.
  float t;
  // On the surface, 0 to 1.
  float u;
  // On the surface, 0 to 1.
  float v;
  // The surface's number, in the order of the nets; PATCHRAY_NO_SURFACE if there is no hit.
  uint32_t surface;
  // PATCHRAY_CROSSING, PATCHRAY_GRAZING or PATCHRAY_CONTACT; without a hit PATCHRAY_CROSSING.
  uint32_t incidence;
} patchray_hit_f32;

// What one call did.
typedef struct {
  // Surfaces whose box was tested.
  uint32_t surfaces_tested;
  // Nodes of trees tested.
  uint32_t nodes_visited;
  // Patches tested.
  uint32_t patches_tested;
  // Voxels visited.
  uint32_t voxels_visited;
  // Spans of a scan line visited.
  uint32_t spans_visited;
  // Newton starts.
  uint32_t newton_starts;
  // Newton iterations.
  uint32_t newton_steps;
  // Patches met in the critical case of eq. (1).
  uint32_t critical;
  // Patches met of which no start led to a root, taken for no hit.
  uint32_t unresolved;
  // Of fallbacks; 0 here.
  uint32_t excluded;
  // Of fallbacks; 0 here.
  uint32_t handed_over;
  // Roots found, each time that they were found.
  uint32_t intersection_points;
  // Coherent: points confirmed at once.
  uint32_t verified;
  // Coherent: points decided over the testing ray's list.
  uint32_t decided_by_list;
  // Coherent: remembered starts that led to nothing.
  uint32_t start_failed;
  // Coherent: searches of a surface's whole grid.
  uint32_t full_searches;
  // Clips.
  uint32_t clip_steps;
  // Bisections.
  uint32_t bisections;
  // Surfaces of which a domain was bisected.
  uint32_t bisection_cases;
  // Coherent clipping: points not verified because the ray is critical.
  uint32_t refused_as_critical;
  // Coherent clipping: points not verified because of another patch.
  uint32_t refused_by_list;
  // Of those: the other patch only adjoins.
  uint32_t refused_by_neighbour;
} patchray_work;

// The grids over the patches of each surface. What the coherent methods need.
typedef struct {
  // By which version and precision they were made.
  uint32_t layout;
  // Grids, one per surface.
  const patchray_grid_f32 *grids;
  // How many.
  size_t grids_len;
  // Their offsets.
  const uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Their references.
  const uint32_t *references;
  // How many.
  size_t references_len;
} patchray_grids_f32;

// What the last ray of a scan line left on one surface: coherence memory of one thread has a slot per surface. Begin with
// zeros; from then on it is the library's.
typedef struct {
  // u and v.
  float at[2];
  // The scan line, plus one.
  uint32_t stamp;
} patchray_remembered_f32;

// A surface to build a scene of: of degrees degree_u x degree_v, (degree_u + 1)(degree_v + 1) control points, the index in u
// the outer one.
typedef struct {
  // x, y, z of each control point; for weighted functions w x, w y, w z, w.
  const double *points;
  // How many numbers that is.
  size_t points_len;
  // 1 to 15.
  uint32_t degree_u;
  // 1 to 15.
  uint32_t degree_v;
} patchray_net_f64;

// How a scene is prepared. Functions take NULL for the defaults.
typedef struct {
  // Voxels per surface in the scene's grid. More cost memory and steps, fewer cost box tests.
  double scene_density;
  // Where the nets' coordinates are 0, in the coordinates of rays and hits: 0, 0, 0 unless the scene is far from there.
  double origin[3];
  // How far a patch may be from its parallelogram, over the diagonal of the scene's box. Smaller makes more patches, about
  // as 1/flatness, and better starts; of larger ones roots are lost.
  double flatness;
  // Voxels per patch in the surfaces' grids; 1 to 8 are near each other in speed.
  double grid_density;
  // The most voxels of the scene's grid.
  uint32_t scene_voxels;
  // The most voxels of one surface's grid.
  uint32_t grid_voxels;
  // How often a surface may be halved in each direction; more than 14 are as 14.
  uint32_t depth;
  // The most patches that a surface may make.
  uint32_t patches_per_surface;
  // By how many roundings boxes are larger than what they enclose. Fewer than the default make misses of roundings.
  uint32_t padding;
} patchray_options_f64;

// A surface of a scene: a slot of its table.
typedef struct {
  // Its box, the bounds on its second derivatives, its size, its largest coordinate, its least weight, its own origin.
  double numbers[15];
  // Its first control point, and its degrees.
  uint32_t counts[3];
} patchray_surface_f64;

// Memory that is lent for a scene. Counts say how many slots are lent, and after the call how many are needed; with counts
// of 0 addresses may be NULL.
typedef struct {
  // Numbers of control points.
  double *points;
  // How many numbers.
  size_t points_len;
  // Surfaces.
  patchray_surface_f64 *surfaces;
  // How many.
  size_t surfaces_len;
  // Of the scene's grid.
  uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Of the scene's grid.
  uint32_t *references;
  // How many.
  size_t references_len;
  // Of an error that is about one surface: its number. Else PATCHRAY_NO_SURFACE.
  uint32_t wrong_surface;
} patchray_scene_memory_f64;

// The scale of a scene's coordinates.
typedef struct {
  // The scale and its inverse, the origin, the box, the largest coordinate, the box's diagonal.
  double numbers[13];
  // The power of two that the scale is.
  int32_t exponent;
} patchray_frame_f64;

// The grid over a surface's patches, or over the scene's surfaces: a slot of its table.
typedef struct {
  // Its box, a voxel's sides, and their inverses.
  double numbers[12];
  // Voxels along each axis, its first offset and first reference.
  uint32_t counts[5];
} patchray_grid_f64;

// A scene: tables in memory that was lent, or in flash. What `clipping` needs.
typedef struct {
  // By which version, precision and kind of control points it was made.
  uint32_t layout;
  // The scale of its coordinates.
  patchray_frame_f64 frame;
  // The grid over its surfaces.
  patchray_grid_f64 grid;
  // Numbers of control points.
  const double *points;
  // How many numbers.
  size_t points_len;
  // Surfaces.
  const patchray_surface_f64 *surfaces;
  // How many.
  size_t surfaces_len;
  // Of its grid.
  const uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Of its grid.
  const uint32_t *references;
  // How many.
  size_t references_len;
} patchray_scene_f64;

// A patch: a slot of its table.
typedef struct {
  // Its parallelepiped, and how far its derivatives stray.
  double numbers[13];
  // The sides of its parallelogram, and its domain.
  uint16_t parts[4];
} patchray_patch_f64;

// An inner node of a surface's tree: a slot of its table.
typedef struct {
  // Its parallelepiped.
  double numbers[12];
} patchray_node_f64;

// Memory that is lent for patches, and for trees over them.
typedef struct {
  // Patches.
  patchray_patch_f64 *patches;
  // How many.
  size_t patches_len;
  // Where each surface's patches begin, and where the last one's end.
  uint32_t *first;
  // How many.
  size_t first_len;
  // The trees' inner nodes; only if a tree is asked for, as the next.
  patchray_node_f64 *nodes;
  // How many.
  size_t nodes_len;
  // The trees' links.
  uint32_t *links;
  // How many.
  size_t links_len;
  // Of an error that is about one surface: its number. Else PATCHRAY_NO_SURFACE.
  uint32_t wrong_surface;
} patchray_patches_memory_f64;

// The patches of a scene's surfaces. What all methods but `clipping` need.
typedef struct {
  // By which version and precision they were made.
  uint32_t layout;
  // Patches.
  const patchray_patch_f64 *patches;
  // How many.
  size_t patches_len;
  // Where each surface's patches begin, and where the last one's end.
  const uint32_t *first;
  // How many.
  size_t first_len;
} patchray_patches_f64;

// The trees over the patches of each surface. What `newton` needs.
typedef struct {
  // By which version and precision they were made.
  uint32_t layout;
  // Inner nodes.
  const patchray_node_f64 *nodes;
  // How many.
  size_t nodes_len;
  // Links.
  const uint32_t *links;
  // How many.
  size_t links_len;
} patchray_tree_f64;

// A ray `origin + t direction`, of which t_min to t_max counts. The direction need not be of unit length.
typedef struct {
  // Where t = 0.
  double origin[3];
  // What one unit of t adds.
  double direction[3];
  // The least t that counts, such as 0; -INFINITY if all that lies behind the origin counts too.
  double t_min;
  // The largest t that counts, such as INFINITY.
  double t_max;
} patchray_ray_f64;

// Bounds on the work of one call. Functions take NULL for the defaults; one that sets some begins with
// patchray_limits_default_f32 or _f64, since a budget of 0 allows nothing.
typedef struct {
  // How far from the ray a root may lie, relative to a scene of size 1; not below 0.
  double tolerance;
  // The factor in the paper's eq. (1). Smaller flags more rays as critical, which costs time and loses fewer double roots.
  double critical_factor;
  // The share of an interval that a clip has to remove, else it is bisected.
  double clip_threshold;
  // Evaluations that one Newton start may take, at least 1.
  uint32_t newton_iterations;
  // Starts per patch, 1 to 3.
  uint32_t newton_starts;
  // How often one Newton step may be halved.
  uint32_t newton_halvings;
  // PATCHRAY_ACCEPTANCE_PAPER or PATCHRAY_ACCEPTANCE_PROVED.
  uint32_t acceptance;
  // Budget: surfaces whose box is tested.
  uint32_t surfaces;
  // Budget: nodes of trees tested.
  uint32_t nodes;
  // Budget: patches tested.
  uint32_t patches;
  // Budget: voxels visited.
  uint32_t voxels;
  // Budget: spans of a scan line visited.
  uint32_t spans;
  // Budget: Newton iterations.
  uint32_t newton_steps;
  // Budget: clips.
  uint32_t clip_steps;
  // Budget: bisections.
  uint32_t bisections;
  // Budget: domains of one surface that wait to be clipped. There is room for 64, and more are as 64.
  uint32_t pending_domains;
} patchray_limits_f64;

// Where a ray meets a surface.
typedef struct {
  // Along the ray, in units of its direction.
  double t;
  // On the surface, 0 to 1.
  double u;
  // On the surface, 0 to 1.
  double v;
  // The surface's number, in the order of the nets; PATCHRAY_NO_SURFACE if there is no hit.
  uint32_t surface;
  // PATCHRAY_CROSSING, PATCHRAY_GRAZING or PATCHRAY_CONTACT; without a hit PATCHRAY_CROSSING.
  uint32_t incidence;
} patchray_hit_f64;

// The grids over the patches of each surface. What the coherent methods need.
typedef struct {
  // By which version and precision they were made.
  uint32_t layout;
  // Grids, one per surface.
  const patchray_grid_f64 *grids;
  // How many.
  size_t grids_len;
  // Their offsets.
  const uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Their references.
  const uint32_t *references;
  // How many.
  size_t references_len;
} patchray_grids_f64;

// What the last ray of a scan line left on one surface: coherence memory of one thread has a slot per surface. Begin with
// zeros; from then on it is the library's.
typedef struct {
  // u and v.
  double at[2];
  // The scan line, plus one.
  uint32_t stamp;
} patchray_remembered_f64;

// Memory that is lent for grids over patches.
typedef struct {
  // Grids, one per surface.
  patchray_grid_f32 *grids;
  // How many.
  size_t grids_len;
  // Their offsets.
  uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Their references.
  uint32_t *references;
  // How many.
  size_t references_len;
} patchray_grids_memory_f32;

// Memory that is lent for grids over patches.
typedef struct {
  // Grids, one per surface.
  patchray_grid_f64 *grids;
  // How many.
  size_t grids_len;
  // Their offsets.
  uint32_t *offsets;
  // How many.
  size_t offsets_len;
  // Their references.
  uint32_t *references;
  // How many.
  size_t references_len;
} patchray_grids_memory_f64;

// A pinhole camera: the ray of the image's point (x, y) starts at the eye and has the direction forward + x right + y up.
typedef struct {
  // Where all rays start.
  float eye[3];
  // The direction of the image's middle, (0, 0).
  float forward[3];
  // What one unit of x adds.
  float right[3];
  // What one unit of y adds.
  float up[3];
} patchray_camera_f32;

// Where a patch can be seen: a slot of a view's tables.
typedef struct {
  // The octagon around it in the image, and its least depth.
  float numbers[9];
} patchray_sight_f32;

// Memory that is lent for a view. Counts say how many slots are lent, and after the call how many are needed; with counts of 0
// addresses may be NULL.
typedef struct {
  // Numbers of control points.
  float *points;
  // How many numbers.
  size_t points_len;
  // Rows in which the surfaces are seen.
  float *surfaces;
  // How many numbers.
  size_t surfaces_len;
  // Patches.
  patchray_patch_f32 *patches;
  // How many.
  size_t patches_len;
  // What is seen of the patches.
  patchray_sight_f32 *sights;
  // How many.
  size_t sights_len;
  // Rows in which runs of 16 patches are seen.
  float *runs;
  // How many numbers.
  size_t runs_len;
  // Where each surface's runs begin, and where the last one's end.
  uint32_t *first_runs;
  // How many.
  size_t first_runs_len;
} patchray_view_memory_f32;

// How a view turns its scene.
typedef struct {
  // The turned eye, the scene's middle depth, the turned vectors forward, right and up, and the scale.
  float numbers[16];
} patchray_lens_f32;

// A scene as seen by a camera. What tracing by scan lines needs.
typedef struct {
  // By which version, precision and kind of control points it was made.
  uint32_t layout;
  // How it is turned.
  patchray_lens_f32 header;
  // The scene, its control points turned.
  patchray_scene_f32 scene;
  // The patches, turned.
  patchray_patches_f32 patches;
  // Rows in which the surfaces are seen.
  const float *surfaces;
  // How many numbers.
  size_t surfaces_len;
  // What is seen of the patches.
  const patchray_sight_f32 *sights;
  // How many.
  size_t sights_len;
  // Rows in which runs of 16 patches are seen.
  const float *runs;
  // How many numbers.
  size_t runs_len;
  // Where each surface's runs begin, and where the last one's end.
  const uint32_t *first_runs;
  // How many.
  size_t first_runs_len;
} patchray_view_f32;

// The rays of a scan line of a view.
typedef struct {
  // x and y of each ray's point of the image: best from one end of the line to the other.
  const float *places;
  // How many numbers: two for each ray, so an even count.
  size_t places_len;
  // The least and the largest x of them all.
  float x[2];
  // The least and the largest y; both the same where all rays are in one row.
  float y[2];
  // The least t that counts, such as 0. What lies behind the eye does not count, whatever it is.
  float t_min;
  // The largest t that counts, such as INFINITY.
  float t_max;
  // Numbers the line, from 0 to 0xfffffffe: a number that no earlier line with this coherence memory had.
  uint32_t number;
} patchray_line_f32;

// Where in a scan line a patch can be seen: a slot of memory that is lent for a line.
typedef struct {
  // The least and the largest x, and its least depth.
  float numbers[3];
  // Its surface and patch, the next one, and the bucket in which it ends.
  uint32_t counts[4];
} patchray_span_f32;

// Memory that is lent for tracing a scan line, of one thread. Begin with zeros; from then on it is the library's, and may be lent
// for any other line. On PATCHRAY_MEMORY the counts say how many slots are needed: of no line more than the view has patches.
typedef struct {
  // What can be seen in the line.
  patchray_span_f32 *spans;
  // How many.
  size_t spans_len;
  // What can be seen around a ray: as many as spans are needed.
  uint32_t *active;
  // How many.
  size_t active_len;
  // At least one; best is about one for each span.
  uint32_t *buckets;
  // How many.
  size_t buckets_len;
} patchray_line_memory_f32;

// What the last ray of a scan line left on one surface, for the predicted methods: coherence memory of one thread has a slot per
// surface. Begin with zeros; from then on it is the library's.
typedef struct {
  // Where it was, its point, how that moves, and how that changes.
  float numbers[18];
  // The scan line, plus one.
  uint32_t stamp;
} patchray_followed_f32;

// A pinhole camera: the ray of the image's point (x, y) starts at the eye and has the direction forward + x right + y up.
typedef struct {
  // Where all rays start.
  double eye[3];
  // The direction of the image's middle, (0, 0).
  double forward[3];
  // What one unit of x adds.
  double right[3];
  // What one unit of y adds.
  double up[3];
} patchray_camera_f64;

// Where a patch can be seen: a slot of a view's tables.
typedef struct {
  // The octagon around it in the image, and its least depth.
  double numbers[9];
} patchray_sight_f64;

// Memory that is lent for a view. Counts say how many slots are lent, and after the call how many are needed; with counts of 0
// addresses may be NULL.
typedef struct {
  // Numbers of control points.
  double *points;
  // How many numbers.
  size_t points_len;
  // Rows in which the surfaces are seen.
  double *surfaces;
  // How many numbers.
  size_t surfaces_len;
  // Patches.
  patchray_patch_f64 *patches;
  // How many.
  size_t patches_len;
  // What is seen of the patches.
  patchray_sight_f64 *sights;
  // How many.
  size_t sights_len;
  // Rows in which runs of 16 patches are seen.
  double *runs;
  // How many numbers.
  size_t runs_len;
  // Where each surface's runs begin, and where the last one's end.
  uint32_t *first_runs;
  // How many.
  size_t first_runs_len;
} patchray_view_memory_f64;

// How a view turns its scene.
typedef struct {
  // The turned eye, the scene's middle depth, the turned vectors forward, right and up, and the scale.
  double numbers[16];
} patchray_lens_f64;

// A scene as seen by a camera. What tracing by scan lines needs.
typedef struct {
  // By which version, precision and kind of control points it was made.
  uint32_t layout;
  // How it is turned.
  patchray_lens_f64 header;
  // The scene, its control points turned.
  patchray_scene_f64 scene;
  // The patches, turned.
  patchray_patches_f64 patches;
  // Rows in which the surfaces are seen.
  const double *surfaces;
  // How many numbers.
  size_t surfaces_len;
  // What is seen of the patches.
  const patchray_sight_f64 *sights;
  // How many.
  size_t sights_len;
  // Rows in which runs of 16 patches are seen.
  const double *runs;
  // How many numbers.
  size_t runs_len;
  // Where each surface's runs begin, and where the last one's end.
  const uint32_t *first_runs;
  // How many.
  size_t first_runs_len;
} patchray_view_f64;

// The rays of a scan line of a view.
typedef struct {
  // x and y of each ray's point of the image: best from one end of the line to the other.
  const double *places;
  // How many numbers: two for each ray, so an even count.
  size_t places_len;
  // The least and the largest x of them all.
  double x[2];
  // The least and the largest y; both the same where all rays are in one row.
  double y[2];
  // The least t that counts, such as 0. What lies behind the eye does not count, whatever it is.
  double t_min;
  // The largest t that counts, such as INFINITY.
  double t_max;
  // Numbers the line, from 0 to 0xfffffffe: a number that no earlier line with this coherence memory had.
  uint32_t number;
} patchray_line_f64;

// Where in a scan line a patch can be seen: a slot of memory that is lent for a line.
typedef struct {
  // The least and the largest x, and its least depth.
  double numbers[3];
  // Its surface and patch, the next one, and the bucket in which it ends.
  uint32_t counts[4];
} patchray_span_f64;

// Memory that is lent for tracing a scan line, of one thread. Begin with zeros; from then on it is the library's, and may be lent
// for any other line. On PATCHRAY_MEMORY the counts say how many slots are needed: of no line more than the view has patches.
typedef struct {
  // What can be seen in the line.
  patchray_span_f64 *spans;
  // How many.
  size_t spans_len;
  // What can be seen around a ray: as many as spans are needed.
  uint32_t *active;
  // How many.
  size_t active_len;
  // At least one; best is about one for each span.
  uint32_t *buckets;
  // How many.
  size_t buckets_len;
} patchray_line_memory_f64;

// What the last ray of a scan line left on one surface, for the predicted methods: coherence memory of one thread has a slot per
// surface. Begin with zeros; from then on it is the library's.
typedef struct {
  // Where it was, its point, how that moves, and how that changes.
  double numbers[18];
  // The scan line, plus one.
  uint32_t stamp;
} patchray_followed_f64;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the tables that this library knows: to be compared with PATCHRAY_LAYOUT, which the header knows.
uint32_t patchray_layout(void);

// Builds a scene of nets: checks them, copies their control points into lent memory, and builds the grid over them.
//
// Asked with counts of 0 it answers PATCHRAY_MEMORY, and the counts say what is needed. On PATCHRAY_OK the counts say
// what is used, and the scene holds the addresses: the memory has to stay where it is for as long as the scene is used.
// nets are needed no more. On errors about one surface memory->wrong_surface is its number.
int32_t patchray_scene_build_f32(const patchray_net_f32 *nets,
                                 size_t nets_len,
                                 const patchray_options_f32 *options,
                                 patchray_scene_memory_f32 *memory,
                                 patchray_scene_f32 *scene);

// Subdivides a scene's surfaces into patches, in lent memory; and builds the trees over them, which only newton needs, if
// tree is not NULL. Counts as for scene_build; of nodes and links only with a tree. scratch: SUBDIVIDE words.
int32_t patchray_patches_build_f32(const patchray_scene_f32 *scene,
                                   const patchray_options_f32 *options,
                                   uint64_t *scratch,
                                   size_t scratch_words,
                                   patchray_patches_memory_f32 *memory,
                                   patchray_patches_f32 *patches,
                                   patchray_tree_f32 *tree);

// The closest hit by Bezier clipping: all roots are found, and no table but the scene is needed. Returns PATCHRAY_HIT,
// PATCHRAY_MISS or a negative code. scratch: CLIP words. limits and work may be NULL. After PATCHRAY_GAVE_UP_... hit is the
// closest one so far, which is no answer.
int32_t patchray_clipping_closest_f32(const patchray_scene_f32 *scene,
                                      const patchray_ray_f32 *ray,
                                      const patchray_limits_f32 *limits,
                                      uint64_t *scratch,
                                      size_t scratch_words,
                                      patchray_hit_f32 *hit,
                                      patchray_work *work);

// A hit by clipping, the first that is found, not the closest: for shadows. A miss is sure.
int32_t patchray_clipping_any_f32(const patchray_scene_f32 *scene,
                                  const patchray_ray_f32 *ray,
                                  const patchray_limits_f32 *limits,
                                  uint64_t *scratch,
                                  size_t scratch_words,
                                  patchray_hit_f32 *hit,
                                  patchray_work *work);

// All hits by clipping, in order of t, PATCHRAY_MAX_HITS at most; found is set to how many stand in hits. More than
// hits_len are PATCHRAY_GAVE_UP_HITS, and the closest stand there.
int32_t patchray_clipping_all_f32(const patchray_scene_f32 *scene,
                                  const patchray_ray_f32 *ray,
                                  const patchray_limits_f32 *limits,
                                  uint64_t *scratch,
                                  size_t scratch_words,
                                  patchray_hit_f32 *hits,
                                  size_t hits_len,
                                  size_t *found,
                                  patchray_work *work);

// The closest hit by clipping with scan-line coherence; coherence memory and scan lines as for newton_coherent_closest, all
// else as for clipping_closest.
int32_t patchray_clipping_coherent_closest_f32(const patchray_scene_f32 *scene,
                                               const patchray_patches_f32 *patches,
                                               const patchray_grids_f32 *grids,
                                               patchray_remembered_f32 *memory,
                                               size_t memory_len,
                                               uint32_t scan_line,
                                               const patchray_ray_f32 *ray,
                                               const patchray_limits_f32 *limits,
                                               uint64_t *scratch,
                                               size_t scratch_words,
                                               patchray_hit_f32 *hit,
                                               patchray_work *work);

// The closest hit by the original numerical method: Newton's method from each patch that the ray meets. Returns
// PATCHRAY_HIT, PATCHRAY_MISS (not proved: a patch of which no start led to a root counts as missed), or a negative code.
// scratch: NEWTON words. limits and work may be NULL. After PATCHRAY_GAVE_UP_... hit is the closest one so far, which is
// no answer.
int32_t patchray_newton_closest_f32(const patchray_scene_f32 *scene,
                                    const patchray_patches_f32 *patches,
                                    const patchray_tree_f32 *tree,
                                    const patchray_ray_f32 *ray,
                                    const patchray_limits_f32 *limits,
                                    uint64_t *scratch,
                                    size_t scratch_words,
                                    patchray_hit_f32 *hit,
                                    patchray_work *work);

// A hit by newton, the first that is found, not the closest: for shadows. A miss is not proved, as of newton_closest.
int32_t patchray_newton_any_f32(const patchray_scene_f32 *scene,
                                const patchray_patches_f32 *patches,
                                const patchray_tree_f32 *tree,
                                const patchray_ray_f32 *ray,
                                const patchray_limits_f32 *limits,
                                uint64_t *scratch,
                                size_t scratch_words,
                                patchray_hit_f32 *hit,
                                patchray_work *work);

// The closest hit by the improved numerical method, with scan-line coherence: rays of one scan line follow one another
// closely, and each begins where the last one ended. memory has a slot per surface and is left alone between rays; zeros at
// first. scan_line numbers the line, from 0 to 0xfffffffe: a number that no earlier line with this memory had begins anew.
// All else as for newton_closest.
int32_t patchray_newton_coherent_closest_f32(const patchray_scene_f32 *scene,
                                             const patchray_patches_f32 *patches,
                                             const patchray_grids_f32 *grids,
                                             patchray_remembered_f32 *memory,
                                             size_t memory_len,
                                             uint32_t scan_line,
                                             const patchray_ray_f32 *ray,
                                             const patchray_limits_f32 *limits,
                                             uint64_t *scratch,
                                             size_t scratch_words,
                                             patchray_hit_f32 *hit,
                                             patchray_work *work);

// The unit normal at a hit, along dS/du x dS/dv; 0, 0, 0 where the surface has none, as at the apex of a cone.
int32_t patchray_normal_f32(const patchray_scene_f32 *scene,
                            const patchray_hit_f32 *hit,
                            float (*normal)[3]);

// As patchray_scene_build_f32, of control points with weights.
int32_t patchray_scene_build_f32_weighted(const patchray_net_f32 *nets,
                                          size_t nets_len,
                                          const patchray_options_f32 *options,
                                          patchray_scene_memory_f32 *memory,
                                          patchray_scene_f32 *scene);

// As patchray_patches_build_f32, of control points with weights.
int32_t patchray_patches_build_f32_weighted(const patchray_scene_f32 *scene,
                                            const patchray_options_f32 *options,
                                            uint64_t *scratch,
                                            size_t scratch_words,
                                            patchray_patches_memory_f32 *memory,
                                            patchray_patches_f32 *patches,
                                            patchray_tree_f32 *tree);

// As patchray_clipping_closest_f32, of control points with weights.
int32_t patchray_clipping_closest_f32_weighted(const patchray_scene_f32 *scene,
                                               const patchray_ray_f32 *ray,
                                               const patchray_limits_f32 *limits,
                                               uint64_t *scratch,
                                               size_t scratch_words,
                                               patchray_hit_f32 *hit,
                                               patchray_work *work);

// As patchray_clipping_any_f32, of control points with weights.
int32_t patchray_clipping_any_f32_weighted(const patchray_scene_f32 *scene,
                                           const patchray_ray_f32 *ray,
                                           const patchray_limits_f32 *limits,
                                           uint64_t *scratch,
                                           size_t scratch_words,
                                           patchray_hit_f32 *hit,
                                           patchray_work *work);

// As patchray_clipping_all_f32, of control points with weights.
int32_t patchray_clipping_all_f32_weighted(const patchray_scene_f32 *scene,
                                           const patchray_ray_f32 *ray,
                                           const patchray_limits_f32 *limits,
                                           uint64_t *scratch,
                                           size_t scratch_words,
                                           patchray_hit_f32 *hits,
                                           size_t hits_len,
                                           size_t *found,
                                           patchray_work *work);

// As patchray_clipping_coherent_closest_f32, of control points with weights.
int32_t patchray_clipping_coherent_closest_f32_weighted(const patchray_scene_f32 *scene,
                                                        const patchray_patches_f32 *patches,
                                                        const patchray_grids_f32 *grids,
                                                        patchray_remembered_f32 *memory,
                                                        size_t memory_len,
                                                        uint32_t scan_line,
                                                        const patchray_ray_f32 *ray,
                                                        const patchray_limits_f32 *limits,
                                                        uint64_t *scratch,
                                                        size_t scratch_words,
                                                        patchray_hit_f32 *hit,
                                                        patchray_work *work);

// As patchray_newton_closest_f32, of control points with weights.
int32_t patchray_newton_closest_f32_weighted(const patchray_scene_f32 *scene,
                                             const patchray_patches_f32 *patches,
                                             const patchray_tree_f32 *tree,
                                             const patchray_ray_f32 *ray,
                                             const patchray_limits_f32 *limits,
                                             uint64_t *scratch,
                                             size_t scratch_words,
                                             patchray_hit_f32 *hit,
                                             patchray_work *work);

// As patchray_newton_any_f32, of control points with weights.
int32_t patchray_newton_any_f32_weighted(const patchray_scene_f32 *scene,
                                         const patchray_patches_f32 *patches,
                                         const patchray_tree_f32 *tree,
                                         const patchray_ray_f32 *ray,
                                         const patchray_limits_f32 *limits,
                                         uint64_t *scratch,
                                         size_t scratch_words,
                                         patchray_hit_f32 *hit,
                                         patchray_work *work);

// As patchray_newton_coherent_closest_f32, of control points with weights.
int32_t patchray_newton_coherent_closest_f32_weighted(const patchray_scene_f32 *scene,
                                                      const patchray_patches_f32 *patches,
                                                      const patchray_grids_f32 *grids,
                                                      patchray_remembered_f32 *memory,
                                                      size_t memory_len,
                                                      uint32_t scan_line,
                                                      const patchray_ray_f32 *ray,
                                                      const patchray_limits_f32 *limits,
                                                      uint64_t *scratch,
                                                      size_t scratch_words,
                                                      patchray_hit_f32 *hit,
                                                      patchray_work *work);

// As patchray_normal_f32, of control points with weights.
int32_t patchray_normal_f32_weighted(const patchray_scene_f32 *scene,
                                     const patchray_hit_f32 *hit,
                                     float (*normal)[3]);

// As patchray_scene_build_f32, in double precision.
int32_t patchray_scene_build_f64(const patchray_net_f64 *nets,
                                 size_t nets_len,
                                 const patchray_options_f64 *options,
                                 patchray_scene_memory_f64 *memory,
                                 patchray_scene_f64 *scene);

// As patchray_patches_build_f32, in double precision.
int32_t patchray_patches_build_f64(const patchray_scene_f64 *scene,
                                   const patchray_options_f64 *options,
                                   uint64_t *scratch,
                                   size_t scratch_words,
                                   patchray_patches_memory_f64 *memory,
                                   patchray_patches_f64 *patches,
                                   patchray_tree_f64 *tree);

// As patchray_clipping_closest_f32, in double precision.
int32_t patchray_clipping_closest_f64(const patchray_scene_f64 *scene,
                                      const patchray_ray_f64 *ray,
                                      const patchray_limits_f64 *limits,
                                      uint64_t *scratch,
                                      size_t scratch_words,
                                      patchray_hit_f64 *hit,
                                      patchray_work *work);

// As patchray_clipping_any_f32, in double precision.
int32_t patchray_clipping_any_f64(const patchray_scene_f64 *scene,
                                  const patchray_ray_f64 *ray,
                                  const patchray_limits_f64 *limits,
                                  uint64_t *scratch,
                                  size_t scratch_words,
                                  patchray_hit_f64 *hit,
                                  patchray_work *work);

// As patchray_clipping_all_f32, in double precision.
int32_t patchray_clipping_all_f64(const patchray_scene_f64 *scene,
                                  const patchray_ray_f64 *ray,
                                  const patchray_limits_f64 *limits,
                                  uint64_t *scratch,
                                  size_t scratch_words,
                                  patchray_hit_f64 *hits,
                                  size_t hits_len,
                                  size_t *found,
                                  patchray_work *work);

// As patchray_clipping_coherent_closest_f32, in double precision.
int32_t patchray_clipping_coherent_closest_f64(const patchray_scene_f64 *scene,
                                               const patchray_patches_f64 *patches,
                                               const patchray_grids_f64 *grids,
                                               patchray_remembered_f64 *memory,
                                               size_t memory_len,
                                               uint32_t scan_line,
                                               const patchray_ray_f64 *ray,
                                               const patchray_limits_f64 *limits,
                                               uint64_t *scratch,
                                               size_t scratch_words,
                                               patchray_hit_f64 *hit,
                                               patchray_work *work);

// As patchray_newton_closest_f32, in double precision.
int32_t patchray_newton_closest_f64(const patchray_scene_f64 *scene,
                                    const patchray_patches_f64 *patches,
                                    const patchray_tree_f64 *tree,
                                    const patchray_ray_f64 *ray,
                                    const patchray_limits_f64 *limits,
                                    uint64_t *scratch,
                                    size_t scratch_words,
                                    patchray_hit_f64 *hit,
                                    patchray_work *work);

// As patchray_newton_any_f32, in double precision.
int32_t patchray_newton_any_f64(const patchray_scene_f64 *scene,
                                const patchray_patches_f64 *patches,
                                const patchray_tree_f64 *tree,
                                const patchray_ray_f64 *ray,
                                const patchray_limits_f64 *limits,
                                uint64_t *scratch,
                                size_t scratch_words,
                                patchray_hit_f64 *hit,
                                patchray_work *work);

// As patchray_newton_coherent_closest_f32, in double precision.
int32_t patchray_newton_coherent_closest_f64(const patchray_scene_f64 *scene,
                                             const patchray_patches_f64 *patches,
                                             const patchray_grids_f64 *grids,
                                             patchray_remembered_f64 *memory,
                                             size_t memory_len,
                                             uint32_t scan_line,
                                             const patchray_ray_f64 *ray,
                                             const patchray_limits_f64 *limits,
                                             uint64_t *scratch,
                                             size_t scratch_words,
                                             patchray_hit_f64 *hit,
                                             patchray_work *work);

// As patchray_normal_f32, in double precision.
int32_t patchray_normal_f64(const patchray_scene_f64 *scene,
                            const patchray_hit_f64 *hit,
                            double (*normal)[3]);

// As patchray_scene_build_f32, in double precision, of control points with weights.
int32_t patchray_scene_build_f64_weighted(const patchray_net_f64 *nets,
                                          size_t nets_len,
                                          const patchray_options_f64 *options,
                                          patchray_scene_memory_f64 *memory,
                                          patchray_scene_f64 *scene);

// As patchray_patches_build_f32, in double precision, of control points with weights.
int32_t patchray_patches_build_f64_weighted(const patchray_scene_f64 *scene,
                                            const patchray_options_f64 *options,
                                            uint64_t *scratch,
                                            size_t scratch_words,
                                            patchray_patches_memory_f64 *memory,
                                            patchray_patches_f64 *patches,
                                            patchray_tree_f64 *tree);

// As patchray_clipping_closest_f32, in double precision, of control points with weights.
int32_t patchray_clipping_closest_f64_weighted(const patchray_scene_f64 *scene,
                                               const patchray_ray_f64 *ray,
                                               const patchray_limits_f64 *limits,
                                               uint64_t *scratch,
                                               size_t scratch_words,
                                               patchray_hit_f64 *hit,
                                               patchray_work *work);

// As patchray_clipping_any_f32, in double precision, of control points with weights.
int32_t patchray_clipping_any_f64_weighted(const patchray_scene_f64 *scene,
                                           const patchray_ray_f64 *ray,
                                           const patchray_limits_f64 *limits,
                                           uint64_t *scratch,
                                           size_t scratch_words,
                                           patchray_hit_f64 *hit,
                                           patchray_work *work);

// As patchray_clipping_all_f32, in double precision, of control points with weights.
int32_t patchray_clipping_all_f64_weighted(const patchray_scene_f64 *scene,
                                           const patchray_ray_f64 *ray,
                                           const patchray_limits_f64 *limits,
                                           uint64_t *scratch,
                                           size_t scratch_words,
                                           patchray_hit_f64 *hits,
                                           size_t hits_len,
                                           size_t *found,
                                           patchray_work *work);

// As patchray_clipping_coherent_closest_f32, in double precision, of control points with weights.
int32_t patchray_clipping_coherent_closest_f64_weighted(const patchray_scene_f64 *scene,
                                                        const patchray_patches_f64 *patches,
                                                        const patchray_grids_f64 *grids,
                                                        patchray_remembered_f64 *memory,
                                                        size_t memory_len,
                                                        uint32_t scan_line,
                                                        const patchray_ray_f64 *ray,
                                                        const patchray_limits_f64 *limits,
                                                        uint64_t *scratch,
                                                        size_t scratch_words,
                                                        patchray_hit_f64 *hit,
                                                        patchray_work *work);

// As patchray_newton_closest_f32, in double precision, of control points with weights.
int32_t patchray_newton_closest_f64_weighted(const patchray_scene_f64 *scene,
                                             const patchray_patches_f64 *patches,
                                             const patchray_tree_f64 *tree,
                                             const patchray_ray_f64 *ray,
                                             const patchray_limits_f64 *limits,
                                             uint64_t *scratch,
                                             size_t scratch_words,
                                             patchray_hit_f64 *hit,
                                             patchray_work *work);

// As patchray_newton_any_f32, in double precision, of control points with weights.
int32_t patchray_newton_any_f64_weighted(const patchray_scene_f64 *scene,
                                         const patchray_patches_f64 *patches,
                                         const patchray_tree_f64 *tree,
                                         const patchray_ray_f64 *ray,
                                         const patchray_limits_f64 *limits,
                                         uint64_t *scratch,
                                         size_t scratch_words,
                                         patchray_hit_f64 *hit,
                                         patchray_work *work);

// As patchray_newton_coherent_closest_f32, in double precision, of control points with weights.
int32_t patchray_newton_coherent_closest_f64_weighted(const patchray_scene_f64 *scene,
                                                      const patchray_patches_f64 *patches,
                                                      const patchray_grids_f64 *grids,
                                                      patchray_remembered_f64 *memory,
                                                      size_t memory_len,
                                                      uint32_t scan_line,
                                                      const patchray_ray_f64 *ray,
                                                      const patchray_limits_f64 *limits,
                                                      uint64_t *scratch,
                                                      size_t scratch_words,
                                                      patchray_hit_f64 *hit,
                                                      patchray_work *work);

// As patchray_normal_f32, in double precision, of control points with weights.
int32_t patchray_normal_f64_weighted(const patchray_scene_f64 *scene,
                                     const patchray_hit_f64 *hit,
                                     double (*normal)[3]);

// Builds the grid over the patches of each surface, which the coherent methods need. Counts as for scene_build.
int32_t patchray_grids_build_f32(const patchray_patches_f32 *patches,
                                 const patchray_options_f32 *options,
                                 patchray_grids_memory_f32 *memory,
                                 patchray_grids_f32 *grids);

// Writes the default options: for the teapot about the paper's 7,594 patches.
int32_t patchray_options_default_f32(patchray_options_f32 *options);

// Writes the default limits: the paper's values where it gives one, and budgets a hundred times what the hardest ray of
// the teapot needs.
int32_t patchray_limits_default_f32(patchray_limits_f32 *limits);

// As patchray_grids_build_f32, in double precision.
int32_t patchray_grids_build_f64(const patchray_patches_f64 *patches,
                                 const patchray_options_f64 *options,
                                 patchray_grids_memory_f64 *memory,
                                 patchray_grids_f64 *grids);

// As patchray_options_default_f32, in double precision.
int32_t patchray_options_default_f64(patchray_options_f64 *options);

// As patchray_limits_default_f32, in double precision.
int32_t patchray_limits_default_f64(patchray_limits_f64 *limits);

// Turns a scene and its patches to a camera, for tracing scan lines of its image. Counts as for scene_build. The view goes on
// reading the surfaces, offsets and references of the scene and the first of the patches; their points and patches it has
// turned. Codes of rays are of the camera's three vectors.
int32_t patchray_view_build_f32(const patchray_scene_f32 *scene,
                                const patchray_patches_f32 *patches,
                                const patchray_camera_f32 *camera,
                                patchray_view_memory_f32 *memory,
                                patchray_view_f32 *view);

// Traces a scan line by clipping around where the hit is predicted: of each ray the hit, in codes what
// patchray_clipping_closest would return, and in works, unless it is NULL, what was done; each has as many slots as the line
// has rays. memory has a slot per surface. Returns PATCHRAY_OK, or a negative code, after which nothing was written but counts.
// scratch: CLIP words.
int32_t patchray_clipping_predicted_line_f32(const patchray_view_f32 *view,
                                             const patchray_line_f32 *line,
                                             patchray_line_memory_f32 *line_memory,
                                             patchray_followed_f32 *memory,
                                             size_t memory_len,
                                             const patchray_limits_f32 *limits,
                                             uint64_t *scratch,
                                             size_t scratch_words,
                                             patchray_hit_f32 *hits,
                                             int32_t *codes,
                                             patchray_work *works);

// The same by Newton's method from where the hit is predicted, the fastest of all. scratch: NEWTON words.
int32_t patchray_newton_predicted_line_f32(const patchray_view_f32 *view,
                                           const patchray_line_f32 *line,
                                           patchray_line_memory_f32 *line_memory,
                                           patchray_followed_f32 *memory,
                                           size_t memory_len,
                                           const patchray_limits_f32 *limits,
                                           uint64_t *scratch,
                                           size_t scratch_words,
                                           patchray_hit_f32 *hits,
                                           int32_t *codes,
                                           patchray_work *works);

// As patchray_view_build_f32, of control points with weights.
int32_t patchray_view_build_f32_weighted(const patchray_scene_f32 *scene,
                                         const patchray_patches_f32 *patches,
                                         const patchray_camera_f32 *camera,
                                         patchray_view_memory_f32 *memory,
                                         patchray_view_f32 *view);

// As patchray_clipping_predicted_line_f32, of control points with weights.
int32_t patchray_clipping_predicted_line_f32_weighted(const patchray_view_f32 *view,
                                                      const patchray_line_f32 *line,
                                                      patchray_line_memory_f32 *line_memory,
                                                      patchray_followed_f32 *memory,
                                                      size_t memory_len,
                                                      const patchray_limits_f32 *limits,
                                                      uint64_t *scratch,
                                                      size_t scratch_words,
                                                      patchray_hit_f32 *hits,
                                                      int32_t *codes,
                                                      patchray_work *works);

// As patchray_newton_predicted_line_f32, of control points with weights.
int32_t patchray_newton_predicted_line_f32_weighted(const patchray_view_f32 *view,
                                                    const patchray_line_f32 *line,
                                                    patchray_line_memory_f32 *line_memory,
                                                    patchray_followed_f32 *memory,
                                                    size_t memory_len,
                                                    const patchray_limits_f32 *limits,
                                                    uint64_t *scratch,
                                                    size_t scratch_words,
                                                    patchray_hit_f32 *hits,
                                                    int32_t *codes,
                                                    patchray_work *works);

// As patchray_view_build_f32, in double precision.
int32_t patchray_view_build_f64(const patchray_scene_f64 *scene,
                                const patchray_patches_f64 *patches,
                                const patchray_camera_f64 *camera,
                                patchray_view_memory_f64 *memory,
                                patchray_view_f64 *view);

// As patchray_clipping_predicted_line_f32, in double precision.
int32_t patchray_clipping_predicted_line_f64(const patchray_view_f64 *view,
                                             const patchray_line_f64 *line,
                                             patchray_line_memory_f64 *line_memory,
                                             patchray_followed_f64 *memory,
                                             size_t memory_len,
                                             const patchray_limits_f64 *limits,
                                             uint64_t *scratch,
                                             size_t scratch_words,
                                             patchray_hit_f64 *hits,
                                             int32_t *codes,
                                             patchray_work *works);

// As patchray_newton_predicted_line_f32, in double precision.
int32_t patchray_newton_predicted_line_f64(const patchray_view_f64 *view,
                                           const patchray_line_f64 *line,
                                           patchray_line_memory_f64 *line_memory,
                                           patchray_followed_f64 *memory,
                                           size_t memory_len,
                                           const patchray_limits_f64 *limits,
                                           uint64_t *scratch,
                                           size_t scratch_words,
                                           patchray_hit_f64 *hits,
                                           int32_t *codes,
                                           patchray_work *works);

// As patchray_view_build_f32, in double precision, of control points with weights.
int32_t patchray_view_build_f64_weighted(const patchray_scene_f64 *scene,
                                         const patchray_patches_f64 *patches,
                                         const patchray_camera_f64 *camera,
                                         patchray_view_memory_f64 *memory,
                                         patchray_view_f64 *view);

// As patchray_clipping_predicted_line_f32, in double precision, of control points with weights.
int32_t patchray_clipping_predicted_line_f64_weighted(const patchray_view_f64 *view,
                                                      const patchray_line_f64 *line,
                                                      patchray_line_memory_f64 *line_memory,
                                                      patchray_followed_f64 *memory,
                                                      size_t memory_len,
                                                      const patchray_limits_f64 *limits,
                                                      uint64_t *scratch,
                                                      size_t scratch_words,
                                                      patchray_hit_f64 *hits,
                                                      int32_t *codes,
                                                      patchray_work *works);

// As patchray_newton_predicted_line_f32, in double precision, of control points with weights.
int32_t patchray_newton_predicted_line_f64_weighted(const patchray_view_f64 *view,
                                                    const patchray_line_f64 *line,
                                                    patchray_line_memory_f64 *line_memory,
                                                    patchray_followed_f64 *memory,
                                                    size_t memory_len,
                                                    const patchray_limits_f64 *limits,
                                                    uint64_t *scratch,
                                                    size_t scratch_words,
                                                    patchray_hit_f64 *hits,
                                                    int32_t *codes,
                                                    patchray_work *works);

// A code's name, such as "PATCHRAY_OVERLAP": a string in constant memory, never NULL. 0 is "PATCHRAY_OK", which a miss is
// too; what no call returns is "unknown".
const char *patchray_name(int32_t code);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* PATCHRAY_H */
