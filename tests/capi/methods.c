// The teapot in 64 x 64 rays by every method and in both precisions: prepared in lent memory, traced ray by ray or by scan
// lines, and of each a line with a hash of all hits and counters, to be compared with the one that Rust finds. For the host and for bare metal.

#include "patchray.h"
#include "teapot.h"
#include "report.h"

// What all that is prepared lies in: taken from the front, and given back as a whole.
static uint64_t pool[330000];
static size_t taken;

static void *take(size_t bytes)
{
    size_t words = (bytes + 7) / 8;
    if (words > sizeof pool / sizeof *pool - taken) {
        put("the pool is too small\n");
        return NULL;
    }
    taken += words;
    return pool + (taken - words);
}

#define REAL float
#define NAME(name) name##_f32
#define PRECISION "f32"
#define WORDS(kind) PATCHRAY_##kind##_CUBIC_WORDS_F32
#include "precision.h"
#include "prepare.h"
#include "lines.h"
#undef REAL
#undef NAME
#undef PRECISION
#undef WORDS

#define REAL double
#define NAME(name) name##_f64
#define PRECISION "f64"
#define WORDS(kind) PATCHRAY_##kind##_CUBIC_WORDS_F64
#include "precision.h"
#include "prepare.h"
#include "lines.h"

int main(void)
{
    if (patchray_layout() != PATCHRAY_LAYOUT) {
        put("library and header differ\n");
        return 1;
    }
    return run_f32() && run_lines_f32() && run_f64() && run_lines_f64() ? 0 : 1;
}
