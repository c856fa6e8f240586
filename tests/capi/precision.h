// The teapot's rays by one method, in one precision, REAL, whose names NAME() makes. Included once for each.

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
        fold(hit->incidence);
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
