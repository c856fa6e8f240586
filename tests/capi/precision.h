// What methods.c does in one precision, REAL, whose names NAME() makes. Included once for each.

static bool NAME(fold_real)(REAL number)
{
    uint32_t words[sizeof number / sizeof(uint32_t)];
    memcpy(words, &number, sizeof number);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        fold(words[k]);
    return number == number;
}

static bool NAME(fold_hit)(int32_t code, const NAME(patchray_hit) * hit, const patchray_work *work)
{
    bool sound = true;
    fold((uint32_t)code);
    if (code == PATCHRAY_HIT) {
        sound = NAME(fold_real)(hit->t) && NAME(fold_real)(hit->u) && NAME(fold_real)(hit->v);
        fold(hit->surface);
        fold(hit->grazing);
    }
    fold_work(work);
    return sound;
}

// What is prepared for all methods.
typedef struct {
    NAME(patchray_scene) scene;
    NAME(patchray_patches) patches;
    NAME(patchray_tree) tree;
    NAME(patchray_grids) grids;
    NAME(patchray_remembered) * memory;
} NAME(prepared);

static bool NAME(prepare)(NAME(prepared) * all)
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
                                                &all->tree);
    if (code != PATCHRAY_MEMORY)
        return is_ok("asking for patches", code) && false;
    of_patches.patches = (NAME(patchray_patch) *)take(of_patches.patches_len * sizeof *of_patches.patches);
    of_patches.first = (uint32_t *)take(of_patches.first_len * sizeof *of_patches.first);
    of_patches.nodes = (NAME(patchray_node) *)take(of_patches.nodes_len * sizeof *of_patches.nodes);
    of_patches.links = (uint32_t *)take(of_patches.links_len * sizeof *of_patches.links);
    code = NAME(patchray_patches_build)(&all->scene, NULL, scratch, WORDS(SUBDIVIDE), &of_patches, &all->patches, &all->tree);
    if (!is_ok("patches", code))
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

enum NAME(method) { NAME(CLIPPING), NAME(CLIPPING_COHERENT), NAME(NEWTON), NAME(NEWTON_COHERENT) };

static int32_t NAME(closest)(enum NAME(method) method, const NAME(prepared) * all, uint32_t line, const NAME(patchray_ray) * ray,
                             NAME(patchray_hit) * hit, patchray_work *work)
{
    static uint64_t scratch[WORDS(CLIP)];
    switch (method) {
    case NAME(CLIPPING):
        return NAME(patchray_clipping_closest)(&all->scene, ray, NULL, scratch, WORDS(CLIP), hit, work);
    case NAME(CLIPPING_COHERENT):
        return NAME(patchray_clipping_coherent_closest)(&all->scene, &all->patches, &all->grids, all->memory, SURFACES, line,
                                                        ray, NULL, scratch, WORDS(CLIP), hit, work);
    case NAME(NEWTON):
        return NAME(patchray_newton_closest)(&all->scene, &all->patches, &all->tree, ray, NULL, scratch, WORDS(NEWTON), hit,
                                             work);
    case NAME(NEWTON_COHERENT):
        return NAME(patchray_newton_coherent_closest)(&all->scene, &all->patches, &all->grids, all->memory, SURFACES, line,
                                                      ray, NULL, scratch, WORDS(NEWTON), hit, work);
    }
    return PATCHRAY_OPTION;
}

static bool NAME(trace)(enum NAME(method) method, const char *name, const NAME(prepared) * all)
{
    NAME(patchray_ray) ray = {{(REAL)7.6171875, (REAL)-9.3203125, (REAL)7.59375}, {0, 0, 0}, 0, (REAL)1e30};
    uint32_t hits = 0;
    hash = 0xcbf29ce484222325u;
    memset(all->memory, 0, SURFACES * sizeof *all->memory);
    for (int row = 0; row < SIDE; row++) {
        for (int column = 0; column < SIDE; column++) {
            // All exact.
            REAL x = (REAL)(16 * column - 504) / 512, y = (REAL)(504 - 16 * row) / 512;
            NAME(patchray_hit) hit;
            patchray_work work;
            int32_t code;
            ray.direction[0] = (REAL)-222.75 + 68 * x - 24 * y;
            ray.direction[1] = 297 + 51 * x + 32 * y;
            ray.direction[2] = -198 + 75 * y;
            code = NAME(closest)(method, all, (uint32_t)row, &ray, &hit, &work);
            if (!is_ok(name, code) || !NAME(fold_hit)(code, &hit, &work))
                return false;
            hits += code == PATCHRAY_HIT;
        }
    }
    put_line(name, PRECISION, hits);
    return true;
}

static bool NAME(run)(void)
{
    static NAME(prepared) all;
    taken = 0;
    return NAME(prepare)(&all) && NAME(trace)(NAME(CLIPPING), "clipping", &all)
        && NAME(trace)(NAME(CLIPPING_COHERENT), "clipping-coherent", &all) && NAME(trace)(NAME(NEWTON), "newton", &all)
        && NAME(trace)(NAME(NEWTON_COHERENT), "newton-coherent", &all);
}
