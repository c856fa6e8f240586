// How methods.c traces the same rays as scan lines of a view, by the methods for these, in one precision. Included after prepare.h.

// A view of the teapot, and memory for its lines and for coherence.
typedef struct {
    NAME(patchray_view) view;
    NAME(patchray_line_memory) of_lines;
    NAME(patchray_followed) * followed;
} NAME(seen);

enum NAME(line_method) { NAME(CLIPPING_PREDICTED_LINE), NAME(NEWTON_PREDICTED_LINE) };

static bool NAME(look)(const NAME(prepared) * all, NAME(seen) * seen)
{
    const NAME(patchray_camera) camera = {
        {(REAL)7.6171875, (REAL)-9.3203125, (REAL)7.59375}, {(REAL)-222.75, 297, -198}, {68, 51, 0}, {-24, 32, 75}};
    NAME(patchray_view_memory) memory = {NULL, 0, NULL, 0, NULL, 0, NULL, 0, NULL, 0, NULL, 0};
    size_t spans;
    if (NAME(patchray_view_build)(&all->scene, &all->patches, &camera, &memory, &seen->view) != PATCHRAY_MEMORY)
        return false;
    memory.points = (REAL *)take(memory.points_len * sizeof *memory.points);
    memory.surfaces = (REAL *)take(memory.surfaces_len * sizeof *memory.surfaces);
    memory.patches = (NAME(patchray_patch) *)take(memory.patches_len * sizeof *memory.patches);
    memory.sights = (NAME(patchray_sight) *)take(memory.sights_len * sizeof *memory.sights);
    memory.runs = (REAL *)take(memory.runs_len * sizeof *memory.runs);
    memory.first_runs = (uint32_t *)take(memory.first_runs_len * sizeof *memory.first_runs);
    if (!is_ok("view", NAME(patchray_view_build)(&all->scene, &all->patches, &camera, &memory, &seen->view)))
        return false;

    // More than any line of it needs; as many as there are patches would be enough for each view.
    spans = memory.patches_len / 4;
    seen->of_lines.spans = (NAME(patchray_span) *)take(spans * sizeof *seen->of_lines.spans);
    seen->of_lines.active = (uint32_t *)take(spans * sizeof *seen->of_lines.active);
    seen->of_lines.buckets = (uint32_t *)take(SIDE * sizeof *seen->of_lines.buckets);
    seen->of_lines.spans_len = seen->of_lines.active_len = spans;
    seen->of_lines.buckets_len = SIDE;
    seen->followed = (NAME(patchray_followed) *)take(SURFACES * sizeof *seen->followed);
    return seen->followed != NULL;
}

static int32_t NAME(trace_line)(enum NAME(line_method) method, NAME(seen) * seen, const NAME(patchray_line) * line,
                                NAME(patchray_hit) * hits, int32_t *codes, patchray_work *works)
{
    static uint64_t scratch[WORDS(CLIP)];
    const NAME(patchray_view) *view = &seen->view;
    NAME(patchray_line_memory) *memory = &seen->of_lines;
    switch (method) {
    case NAME(CLIPPING_PREDICTED_LINE):
        return NAME(patchray_clipping_predicted_line)(view, line, memory, seen->followed, SURFACES, NULL, scratch,
                                                      WORDS(CLIP), hits, codes, works);
    case NAME(NEWTON_PREDICTED_LINE):
        return NAME(patchray_newton_predicted_line)(view, line, memory, seen->followed, SURFACES, NULL, scratch,
                                                    WORDS(NEWTON), hits, codes, works);
    }
    return PATCHRAY_OPTION;
}

static bool NAME(trace_lines)(enum NAME(line_method) method, const char *name, NAME(seen) * seen)
{
    static REAL places[SIDE][2];
    static NAME(patchray_hit) hits[SIDE];
    static int32_t codes[SIDE];
    static patchray_work works[SIDE];
    uint32_t count = 0;
    hash = 0xcbf29ce484222325u;
    memset(seen->followed, 0, SURFACES * sizeof *seen->followed);
    for (int row = 0; row < SIDE; row++) {
        // All exact.
        REAL y = (REAL)(504 - 16 * row) / 512;
        NAME(patchray_line) line = {&places[0][0], 2 * SIDE, {0, 0}, {y, y}, 0, (REAL)1e30, (uint32_t)row};
        for (int column = 0; column < SIDE; column++) {
            places[column][0] = (REAL)(16 * column - 504) / 512;
            places[column][1] = y;
        }
        line.x[0] = places[0][0];
        line.x[1] = places[SIDE - 1][0];
        if (!is_ok(name, NAME(trace_line)(method, seen, &line, hits, codes, works)))
            return false;
        for (int column = 0; column < SIDE; column++) {
            if (!is_ok(name, codes[column]) || !NAME(fold_hit)(codes[column], &hits[column], &works[column]))
                return false;
            count += codes[column] == PATCHRAY_HIT;
        }
    }
    put_line(name, PRECISION, count);
    return true;
}

// All that the methods above were given is given back: a view needs no more than scene and patches.
static bool NAME(run_lines)(void)
{
    static NAME(prepared) all;
    static NAME(seen) seen;
    taken = 0;
    return NAME(prepare_patches)(&all, NULL) && NAME(look)(&all, &seen)
        && NAME(trace_lines)(NAME(CLIPPING_PREDICTED_LINE), "clipping-predicted-line", &seen)
        && NAME(trace_lines)(NAME(NEWTON_PREDICTED_LINE), "newton-predicted-line", &seen);
}
