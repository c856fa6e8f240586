// How methods.c prepares the teapot in one precision, and traces it ray by ray by the methods for that. Included after precision.h.

// A scene and its patches, with trees if they are wanted.
static bool NAME(prepare_patches)(NAME(prepared) * all, NAME(patchray_tree) * tree)
{
    static NAME(patchray_net) nets[SURFACES];
    static REAL points[SURFACES][48];
    static uint64_t scratch[WORDS(SUBDIVIDE)];
    for (int surface = 0; surface < SURFACES; surface++) {
        for (int k = 0; k < 48; k++)
            points[surface][k] = (REAL)teapot[surface][k];
        nets[surface].points = points[surface];
        nets[surface].points_len = 48;
        nets[surface].degree_u = nets[surface].degree_v = 3;
    }

    // Each first asked for its size.
    NAME(patchray_scene_memory) of_scene = {NULL, 0, NULL, 0, NULL, 0, NULL, 0, 0};
    if (NAME(patchray_scene_build)(nets, SURFACES, NULL, &of_scene, &all->scene) != PATCHRAY_MEMORY)
        return false;
    of_scene.points = (REAL *)take(of_scene.points_len * sizeof *of_scene.points);
    of_scene.surfaces = (NAME(patchray_surface) *)take(of_scene.surfaces_len * sizeof *of_scene.surfaces);
    of_scene.offsets = (uint32_t *)take(of_scene.offsets_len * sizeof *of_scene.offsets);
    of_scene.references = (uint32_t *)take(of_scene.references_len * sizeof *of_scene.references);
    if (!is_ok("scene", NAME(patchray_scene_build)(nets, SURFACES, NULL, &of_scene, &all->scene)))
        return false;

    NAME(patchray_patches_memory) of_patches = {NULL, 0, NULL, 0, NULL, 0, NULL, 0, 0};
    int32_t code = NAME(patchray_patches_build)(&all->scene, NULL, scratch, WORDS(SUBDIVIDE), &of_patches, &all->patches,
                                                tree);
    if (code != PATCHRAY_MEMORY)
        return is_ok("asking for patches", code) && false;
    of_patches.patches = (NAME(patchray_patch) *)take(of_patches.patches_len * sizeof *of_patches.patches);
    of_patches.first = (uint32_t *)take(of_patches.first_len * sizeof *of_patches.first);
    of_patches.nodes = (NAME(patchray_node) *)take(of_patches.nodes_len * sizeof *of_patches.nodes);
    of_patches.links = (uint32_t *)take(of_patches.links_len * sizeof *of_patches.links);
    code = NAME(patchray_patches_build)(&all->scene, NULL, scratch, WORDS(SUBDIVIDE), &of_patches, &all->patches, tree);
    return is_ok("patches", code);
}

static bool NAME(prepare)(NAME(prepared) * all)
{
    if (!NAME(prepare_patches)(all, &all->tree))
        return false;
    NAME(patchray_grids_memory) of_grids = {NULL, 0, NULL, 0, NULL, 0};
    if (NAME(patchray_grids_build)(&all->patches, NULL, &of_grids, &all->grids) != PATCHRAY_MEMORY)
        return false;
    of_grids.grids = (NAME(patchray_grid) *)take(of_grids.grids_len * sizeof *of_grids.grids);
    of_grids.offsets = (uint32_t *)take(of_grids.offsets_len * sizeof *of_grids.offsets);
    of_grids.references = (uint32_t *)take(of_grids.references_len * sizeof *of_grids.references);
    all->memory = (NAME(patchray_remembered) *)take(SURFACES * sizeof *all->memory);
    return is_ok("grids", NAME(patchray_grids_build)(&all->patches, NULL, &of_grids, &all->grids));
}

static bool NAME(run)(void)
{
    static NAME(prepared) all;
    taken = 0;
    return NAME(prepare)(&all) && NAME(trace)(NAME(CLIPPING), "clipping", &all)
        && NAME(trace)(NAME(CLIPPING_COHERENT), "clipping-coherent", &all) && NAME(trace)(NAME(NEWTON), "newton", &all)
        && NAME(trace)(NAME(NEWTON_COHERENT), "newton-coherent", &all);
}
