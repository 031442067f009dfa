#include "scene/noise.h"

#include "scene/fraction.h"
#include <psplat/math.h>

/* A coordinate's place between two lattice points, the lower one first. */
struct place {
    uint32_t keys[2];   /* of the lattice points */
    float distances[2]; /* from them, with sign */
    float weight;       /* of the upper one */
};

/* A point's key is a mix of its coordinates', scrambled. */
static struct place find_place(float x, uint32_t factor)
{
    float t = fraction_of(x);
    uint32_t cell = (uint32_t)whole_of(x);
    return (struct place){
        .keys = {cell * factor, (cell + 1) * factor},
        .distances = {t, t - 1.0f},
        .weight = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f),
    };
}

/* Wellons 2018, "Prospecting for hash functions": every bit depends on every other. */
static uint32_t scramble(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352d;
    x ^= x >> 15;
    x *= 0x846ca68b;
    return x ^ x >> 16;
}

/* To the middles of a cube's edges. Four of the twelve come twice, which saves a division by 12
 * (Perlin 2002). */
static const float directions[16][3] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {-1, 1, 0}, {0, -1, 1}, {0, -1, -1},
};

static float slope(uint32_t key, float x, float y, float z)
{
    const float *direction = directions[scramble(key) & 15];
    return direction[0] * x + direction[1] * y + direction[2] * z;
}

static float mix(float a, float b, float weight)
{
    return a + weight * (b - a);
}

/* Between the two lattice points at the ends of an edge along x. */
static float edge_value(const struct place *x, uint32_t key, float y, float z)
{
    return mix(slope(key ^ x->keys[0], x->distances[0], y, z),
               slope(key ^ x->keys[1], x->distances[1], y, z), x->weight);
}

/* Between the four in a plane of the lattice, at distance z from it. */
static float plane_value(const struct place *x, const struct place *y, uint32_t key, float z)
{
    return mix(edge_value(x, key ^ y->keys[0], y->distances[0], z),
               edge_value(x, key ^ y->keys[1], y->distances[1], z), y->weight);
}

float noise_value(ps_vec3 point, uint32_t seed)
{
    struct place x = find_place(point.x, 0x8da6b343);
    struct place y = find_place(point.y, 0xd8163841);
    struct place z = find_place(point.z, 0xcb1ab31f);
    uint32_t key = scramble(seed);
    return mix(plane_value(&x, &y, key ^ z.keys[0], z.distances[0]),
               plane_value(&x, &y, key ^ z.keys[1], z.distances[1]), z.weight);
}

/* A rotation about an axis that is none of the lattice's, with short numbers, and a shift by parts
 * that no octave's size divides. */
static ps_vec3 turn(ps_vec3 p)
{
    return (ps_vec3){
        0.80f * p.y + 0.60f * p.z + 0.3719f,
        -0.80f * p.x + 0.36f * p.y - 0.48f * p.z + 0.7243f,
        -0.60f * p.x - 0.48f * p.y + 0.64f * p.z + 0.5867f,
    };
}

float noise_fractal(ps_vec3 point, int32_t octaves, uint32_t seed)
{
    float sum = 0.0f, amplitude = 1.0f, variance = 0.0f;
    point = turn(point);
    for (uint32_t octave = 0; octave < (uint32_t)octaves; octave++) {
        sum += amplitude * noise_value(point, seed + octave);
        variance += amplitude * amplitude;
        amplitude *= 0.5f;
        point = turn(ps_scale(point, 2.0f));
    }
    return sum / sqrtf(variance);
}

ps_vec3 noise_vector(ps_vec3 point, int32_t octaves, uint32_t seed)
{
    /* Seeds far enough apart that their octaves never meet. */
    return (ps_vec3){noise_fractal(point, octaves, seed + 0x100),
                     noise_fractal(point, octaves, seed + 0x200),
                     noise_fractal(point, octaves, seed + 0x300)};
}
