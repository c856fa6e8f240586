// What methods.c and baked.c have in common: the hash of what was found, and the line that says it. put() is the one thing
// that either asks of the machine that it runs on.

#include <stdbool.h>
#include <string.h>

#ifdef __cplusplus
extern "C"
#endif
void put(const char *text);

enum { SURFACES = 32, SIDE = 64 };

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
