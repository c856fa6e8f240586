// The teapot's rays from tables that `patchray bake` wrote: nothing is prepared, and the hashes are the same.

#include "patchray.h"
#include "baked_clipping.h"
#include "baked_clipping_coherent.h"
#include "baked_newton.h"
#include "baked_newton_coherent.h"
#include "report.h"

#define REAL float
#define NAME(name) name##_f32
#define PRECISION "f32"
#define WORDS(kind) PATCHRAY_##kind##_CUBIC_WORDS_F32
#include "precision.h"

int main(void)
{
    static patchray_remembered_f32 memory[SURFACES];
    static prepared_f32 all;
    all.memory = memory;
    all.scene = baked_clipping;
    if (!trace_f32(CLIPPING_f32, "clipping", &all))
        return 1;
    all.scene = baked_clipping_coherent;
    all.patches = baked_clipping_coherent_patches;
    all.grids = baked_clipping_coherent_grids;
    if (!trace_f32(CLIPPING_COHERENT_f32, "clipping-coherent", &all))
        return 1;
    all.scene = baked_newton;
    all.patches = baked_newton_patches;
    all.tree = baked_newton_tree;
    if (!trace_f32(NEWTON_f32, "newton", &all))
        return 1;
    all.scene = baked_newton_coherent;
    all.patches = baked_newton_coherent_patches;
    all.grids = baked_newton_coherent_grids;
    return trace_f32(NEWTON_COHERENT_f32, "newton-coherent", &all) ? 0 : 1;
}
