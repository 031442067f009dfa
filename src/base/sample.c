#include "base/sample.h"

/* The four dimensions of a point: a vector register of nearly all processors. */
typedef uint32_t lanes __attribute__((vector_size(16)));
typedef int32_t signed_lanes __attribute__((vector_size(16)));

/* Direction numbers of the first four Sobol dimensions, from the initial numbers of Joe and Kuo
 * 2008, "Constructing Sobol sequences with better two-dimensional projections": column i of
 * dimensions 0 to 3, which lie together so that one operation serves all four. */
static const lanes sobol_columns[32] = {
    {0x80000000, 0x80000000, 0x80000000, 0x80000000},
    {0x40000000, 0xc0000000, 0xc0000000, 0xc0000000},
    {0x20000000, 0xa0000000, 0x60000000, 0x20000000},
    {0x10000000, 0xf0000000, 0x90000000, 0x50000000},
    {0x08000000, 0x88000000, 0xe8000000, 0xf8000000},
    {0x04000000, 0xcc000000, 0x5c000000, 0x74000000},
    {0x02000000, 0xaa000000, 0x8e000000, 0xa2000000},
    {0x01000000, 0xff000000, 0xc5000000, 0x93000000},
    {0x00800000, 0x80800000, 0x68800000, 0xd8800000},
    {0x00400000, 0xc0c00000, 0x9cc00000, 0x25400000},
    {0x00200000, 0xa0a00000, 0xee600000, 0x59e00000},
    {0x00100000, 0xf0f00000, 0x55900000, 0xe6d00000},
    {0x00080000, 0x88880000, 0x80680000, 0x78080000},
    {0x00040000, 0xcccc0000, 0xc09c0000, 0xb40c0000},
    {0x00020000, 0xaaaa0000, 0x60ee0000, 0x82020000},
    {0x00010000, 0xffff0000, 0x90550000, 0xc3050000},
    {0x00008000, 0x80008000, 0xe8808000, 0x208f8000},
    {0x00004000, 0xc000c000, 0x5cc0c000, 0x51474000},
    {0x00002000, 0xa000a000, 0x8e606000, 0xfbea2000},
    {0x00001000, 0xf000f000, 0xc5909000, 0x75d93000},
    {0x00000800, 0x88008800, 0x6868e800, 0xa0858800},
    {0x00000400, 0xcc00cc00, 0x9c9c5c00, 0x914e5400},
    {0x00000200, 0xaa00aa00, 0xeeee8e00, 0xdbe79e00},
    {0x00000100, 0xff00ff00, 0x5555c500, 0x25db6d00},
    {0x00000080, 0x80808080, 0x8000e880, 0x58800080},
    {0x00000040, 0xc0c0c0c0, 0xc0005cc0, 0xe54000c0},
    {0x00000020, 0xa0a0a0a0, 0x60008e60, 0x79e00020},
    {0x00000010, 0xf0f0f0f0, 0x9000c590, 0xb6d00050},
    {0x00000008, 0x88888888, 0xe8006868, 0x800800f8},
    {0x00000004, 0xcccccccc, 0x5c009c9c, 0xc00c0074},
    {0x00000002, 0xaaaaaaaa, 0x8e00eeee, 0x200200a2},
    {0x00000001, 0xffffffff, 0xc5005555, 0x50050093},
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

static uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

/* An approximate Owen scramble of bits in reversed order (Vegdahl 2021, "Building a better LK
 * hash"). */
static uint32_t scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adea;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56;
    x ^= x * 0x53a22864;
    return x;
}

static uint32_t owen_scramble(uint32_t x, uint32_t seed)
{
    return reverse_bits(scramble_reversed(reverse_bits(x), seed));
}

/* The point of the four Sobol sequences, as 32-bit fractions, whose index has these bits in reversed
 * order: so the sign tells whether the next one is set. */
static lanes sobol(uint32_t reversed_index)
{
    lanes fractions = {0, 0, 0, 0};
    lanes bits = {reversed_index, reversed_index, reversed_index, reversed_index};
    for (int bit = 0; bit < 32; bit++) {
        fractions ^= sobol_columns[bit] & (lanes)((signed_lanes)bits >> 31);
        bits += bits;
    }
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

static void scrambled_point(const struct scramble *scramble, uint32_t low, float point[4])
{
    lanes fractions = sobol(scramble_reversed(reverse_bits(low), scramble->seed));
    /* 24 bits: the float lies in [0, 1) and never rounds up to 1. */
    for (int d = 0; d < 4; d++) {
        uint32_t bits = owen_scramble(fractions[d], scramble->seeds[d]);
        point[d] = (float)(int32_t)(bits >> 8) * 0x1p-24f;
    }
}

void sample_point(uint32_t key, uint64_t index, float point[4])
{
    struct scramble scramble = scramble_of(key, (uint32_t)(index >> 32));
    scrambled_point(&scramble, (uint32_t)index, point);
}

void sample_points(uint32_t key, const uint64_t *indices, size_t n, float (*points)[4])
{
    struct scramble scramble = scramble_of(key, n > 0 ? (uint32_t)(indices[0] >> 32) : 0);
    for (size_t i = 0; i < n; i++) {
        uint32_t high = (uint32_t)(indices[i] >> 32);
        if (high != scramble.high)
            scramble = scramble_of(key, high);
        scrambled_point(&scramble, (uint32_t)indices[i], points[i]);
    }
}
