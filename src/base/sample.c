#include "base/sample.h"

#include <psplat/isa.h>
#include <string.h>

/* The four dimensions of a point: a vector register of nearly all processors. */
typedef uint32_t lanes __attribute__((vector_size(16)));

/* What four columns of four dimensions sum up to (exclusive or), for each choice of them, the first
 * by the highest bit. */
#define SUM(choice, a, b, c, d)                                                                    \
    (((choice)&8 ? (a) : 0) ^ ((choice)&4 ? (b) : 0) ^ ((choice)&2 ? (c) : 0) ^                    \
     ((choice)&1 ? (d) : 0))
#define CHOICE(choice, a0, a1, a2, a3, b0, b1, b2, b3, c0, c1, c2, c3, d0, d1, d2, d3)             \
    {                                                                                              \
        SUM(choice, a0, b0, c0, d0), SUM(choice, a1, b1, c1, d1), SUM(choice, a2, b2, c2, d2),     \
            SUM(choice, a3, b3, c3, d3)                                                            \
    }
#define CHOICES(...)                                                                               \
    {                                                                                              \
        CHOICE(0, __VA_ARGS__), CHOICE(1, __VA_ARGS__), CHOICE(2, __VA_ARGS__),                    \
            CHOICE(3, __VA_ARGS__), CHOICE(4, __VA_ARGS__), CHOICE(5, __VA_ARGS__),                \
            CHOICE(6, __VA_ARGS__), CHOICE(7, __VA_ARGS__), CHOICE(8, __VA_ARGS__),                \
            CHOICE(9, __VA_ARGS__), CHOICE(10, __VA_ARGS__), CHOICE(11, __VA_ARGS__),              \
            CHOICE(12, __VA_ARGS__), CHOICE(13, __VA_ARGS__), CHOICE(14, __VA_ARGS__),             \
            CHOICE(15, __VA_ARGS__)                                                                \
    }

/* Direction numbers of the first four Sobol dimensions, from the initial numbers of Joe and Kuo
 * 2008, "Constructing Sobol sequences with better two-dimensional projections": column i of
 * dimensions 0 to 3 in line i, which lie together so that one operation serves all four. Their bits
 * run in reversed order, in which they are scrambled. Summed up by fours, a point takes 8 steps,
 * not 32. */
static const lanes sobol_sums[8][16] = {
    CHOICES(0x00000001, 0x00000001, 0x00000001, 0x00000001, 0x00000002, 0x00000003, 0x00000003,
            0x00000003, 0x00000004, 0x00000005, 0x00000006, 0x00000004, 0x00000008, 0x0000000f,
            0x00000009, 0x0000000a),
    CHOICES(0x00000010, 0x00000011, 0x00000017, 0x0000001f, 0x00000020, 0x00000033, 0x0000003a,
            0x0000002e, 0x00000040, 0x00000055, 0x00000071, 0x00000045, 0x00000080, 0x000000ff,
            0x000000a3, 0x000000c9),
    CHOICES(0x00000100, 0x00000101, 0x00000116, 0x0000011b, 0x00000200, 0x00000303, 0x00000339,
            0x000002a4, 0x00000400, 0x00000505, 0x00000677, 0x0000079a, 0x00000800, 0x00000f0f,
            0x000009aa, 0x00000b67),
    CHOICES(0x00001000, 0x00001111, 0x00001601, 0x0000101e, 0x00002000, 0x00003333, 0x00003903,
            0x0000302d, 0x00004000, 0x00005555, 0x00007706, 0x00004041, 0x00008000, 0x0000ffff,
            0x0000aa09, 0x0000a0c3),
    CHOICES(0x00010000, 0x00010001, 0x00010117, 0x0001f104, 0x00020000, 0x00030003, 0x0003033a,
            0x0002e28a, 0x00040000, 0x00050005, 0x00060671, 0x000457df, 0x00080000, 0x000f000f,
            0x000909a3, 0x000c9bae),
    CHOICES(0x00100000, 0x00110011, 0x00171616, 0x0011a105, 0x00200000, 0x00330033, 0x003a3939,
            0x002a7289, 0x00400000, 0x00550055, 0x00717777, 0x0079e7db, 0x00800000, 0x00ff00ff,
            0x00a3aaaa, 0x00b6dba4),
    CHOICES(0x01000000, 0x01010101, 0x01170001, 0x0100011a, 0x02000000, 0x03030303, 0x033a0003,
            0x030002a7, 0x04000000, 0x05050505, 0x06710006, 0x0400079e, 0x08000000, 0x0f0f0f0f,
            0x09a30009, 0x0a000b6d),
    CHOICES(0x10000000, 0x11111111, 0x16160017, 0x1f001001, 0x20000000, 0x33333333, 0x3939003a,
            0x2e003003, 0x40000000, 0x55555555, 0x77770071, 0x45004004, 0x80000000, 0xffffffff,
            0xaaaa00a3, 0xc900a00a),
};

uint32_t sample_hash(uint64_t value)
{
    /* The finalizer of SplitMix64 (Steele et al. 2014). */
    value += UINT64_C(0x9e3779b97f4a7c15);
    value = (value ^ (value >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    value = (value ^ (value >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)((value ^ (value >> 31)) >> 32);
}

uint32_t sample_key(uint64_t seed, uint32_t stream, uint32_t set)
{
    uint32_t purpose = sample_hash((uint64_t)stream << 32 | set);
    return sample_hash(seed ^ (uint64_t)purpose << 17 ^ purpose);
}

static PS_INLINED uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/* An approximate Owen scramble of bits in reversed order (Vegdahl 2021, "Building a better LK
 * hash"). */
static PS_INLINED uint32_t scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

/* The point of the four Sobol sequences, as 32-bit fractions. Their bits run in reversed order, and
 * so do those of the index. */
static PS_INLINED lanes sobol(uint32_t index)
{
    lanes fractions = sobol_sums[0][index >> 28];
    for (int i = 1; i < 8; i++)
        fractions ^= sobol_sums[i][index >> (28 - 4 * i) & 15u];
    return fractions;
}

/* What scrambles the points of 2^32 indices: past these a fresh one begins. */
struct scramble {
    uint32_t high; /* half of the indices */
    uint32_t seed, seeds[4];
};

static struct scramble scramble_of(uint32_t key, uint32_t high)
{
    struct scramble scramble = {.high = high, .seed = key};
    if (high)
        scramble.seed = sample_hash((uint64_t)key << 32 | high);
    for (uint32_t d = 0; d < 4; d++)
        scramble.seeds[d] = sample_hash((uint64_t)scramble.seed << 8 | (d + 1));
    return scramble;
}

/* 24 of the bits: the float lies in [0, 1) and never rounds up to 1. */
static PS_INLINED float unit_of(uint32_t reversed)
{
    return (float)(int32_t)(reverse_bits(reversed) >> 8) * 0x1p-24f;
}

void sample_point(uint32_t key, uint64_t index, float point[4])
{
    struct scramble scramble = scramble_of(key, (uint32_t)(index >> 32));
    lanes fractions = sobol(scramble_reversed(reverse_bits((uint32_t)index), scramble.seed));
    for (int d = 0; d < 4; d++)
        point[d] = unit_of(scramble_reversed(fractions[d], scramble.seeds[d]));
}

enum { BLOCK = 16 }; /* points that are made together */

PS_EVERY_ISA static void make_block(const struct scramble *scramble, const uint32_t low[BLOCK],
                                    float points[4 * BLOCK])
{
    _Alignas(64) uint32_t indices[BLOCK], fractions[4 * BLOCK], seeds[4 * BLOCK];
#pragma omp simd
    for (int i = 0; i < BLOCK; i++)
        indices[i] = scramble_reversed(reverse_bits(low[i]), scramble->seed);
    for (int i = 0; i < BLOCK; i++) {
        lanes all = sobol(indices[i]);
        memcpy(&fractions[4 * i], &all, sizeof all);
        memcpy(&seeds[4 * i], scramble->seeds, sizeof scramble->seeds);
    }
#pragma omp simd
    for (int i = 0; i < 4 * BLOCK; i++)
        points[i] = unit_of(scramble_reversed(fractions[i], seeds[i]));
}

/* How many of n indices, at most a block, have the upper half of the first one. */
static size_t same_half(const uint64_t *indices, size_t n)
{
    size_t count = 1;
    while (count < n && count < BLOCK && indices[count] >> 32 == indices[0] >> 32)
        count++;
    return count;
}

void sample_points(uint32_t key, const uint64_t *indices, size_t n, float (*points)[4])
{
    struct scramble scramble = scramble_of(key, n > 0 ? (uint32_t)(indices[0] >> 32) : 0);
    for (size_t first = 0, count; first < n; first += count) {
        uint32_t high = (uint32_t)(indices[first] >> 32), low[BLOCK] = {0};
        float made[4 * BLOCK];
        count = same_half(indices + first, n - first);
        if (high != scramble.high)
            scramble = scramble_of(key, high);
        for (size_t i = 0; i < count; i++)
            low[i] = (uint32_t)indices[first + i];
        make_block(&scramble, low, made);
        memcpy(points[first], made, count * sizeof *points);
    }
}
