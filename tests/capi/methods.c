// The teapot in 64 x 64 rays by every method and in both precisions: prepared in lent memory, traced, and of each a line
// with a hash of all hits and counters, to be compared with the one that Rust finds.
//
// The same file for the host and for bare metal: put() is the one thing that it asks of either.

#include "patchray.h"
#include "teapot.h"
#include <stdbool.h>
#include <string.h>

#ifdef __cplusplus
extern "C"
#endif
void put(const char *text);

enum { SURFACES = 32, SIDE = 64 };

// What all that is prepared lies in: taken from the front, and given back as a whole.
static uint64_t pool[300000];
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

static uint64_t hash;

// FNV-1a over the bytes of a word, the least first.
static void fold(uint32_t word)
{
    for (int byte = 0; byte < 4; byte++) {
        hash = (hash ^ (word & 0xff)) * 0x100000001b3u;
        word >>= 8;
    }
}

static void put_number(uint64_t number, unsigned base)
{
    char text[24];
    char *digit = text + sizeof text - 1;
    *digit = 0;
    do {
        *--digit = "0123456789abcdef"[number % base];
        number /= base;
    } while (number > 0);
    put(digit);
}

static void fold_work(const patchray_work *work)
{
    uint32_t counters[sizeof *work / sizeof(uint32_t)];
    memcpy(counters, work, sizeof counters);
    for (size_t k = 0; k < sizeof counters / sizeof *counters; k++)
        fold(counters[k]);
}

// Tells of a code that should not be.
static bool is_ok(const char *what, int32_t code)
{
    if (code >= 0)
        return true;
    put(what);
    put(": ");
    put(patchray_name(code));
    put("\n");
    return false;
}

static void put_line(const char *method, const char *precision, uint32_t hits)
{
    put(method);
    put(" ");
    put(precision);
    put(" ");
    put_number(hits, 10);
    put(" ");
    put_number(hash, 16);
    put("\n");
}

#define REAL float
#define NAME(name) name##_f32
#define PRECISION "f32"
#define WORDS(kind) PATCHRAY_##kind##_CUBIC_WORDS_F32
#include "precision.h"
#undef REAL
#undef NAME
#undef PRECISION
#undef WORDS

#define REAL double
#define NAME(name) name##_f64
#define PRECISION "f64"
#define WORDS(kind) PATCHRAY_##kind##_CUBIC_WORDS_F64
#include "precision.h"

int main(void)
{
    if (patchray_layout() != PATCHRAY_LAYOUT) {
        put("library and header differ\n");
        return 1;
    }
    return run_f32() && run_f64() ? 0 : 1;
}
