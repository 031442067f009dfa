#include "scene/noise.h"

#include "scene/fraction.h"
#include <assert.h>
#include <psplat/math.h>

/* A coordinate's place between two lattice points, the lower one first. */
struct place {
    uint32_t keys[2];    /* of the lattice points */
    float distances[2];  /* from them, with sign */
    float weight, slope; /* of the upper one, and how it changes with the coordinate */
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
        .slope = 30.0f * t * t * (t * (t - 2.0f) + 1.0f),
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

/* A value and its gradient. */
struct sloped {
    float value;
    ps_vec3 gradient;
};

/* Of a lattice point: linear along its direction, from the point on. */
static inline struct sloped corner(uint32_t key, float x, float y, float z)
{
    const float *direction = directions[scramble(key) & 15];
    return (struct sloped){
        .value = direction[0] * x + direction[1] * y + direction[2] * z,
        .gradient = {direction[0], direction[1], direction[2]},
    };
}

static inline float mix(float a, float b, float weight)
{
    return a + weight * (b - a);
}

/* Between both sides of a cell, as if the weight were the same everywhere. */
static inline struct sloped mix_sides(struct sloped a, struct sloped b, float weight)
{
    return (struct sloped){
        .value = mix(a.value, b.value, weight),
        .gradient = {mix(a.gradient.x, b.gradient.x, weight),
                     mix(a.gradient.y, b.gradient.y, weight),
                     mix(a.gradient.z, b.gradient.z, weight)},
    };
}

/* Between the two lattice points at the ends of an edge along x. */
static inline struct sloped edge(const struct place *x, uint32_t key, float y, float z)
{
    struct sloped a = corner(key ^ x->keys[0], x->distances[0], y, z);
    struct sloped b = corner(key ^ x->keys[1], x->distances[1], y, z);
    struct sloped sum = mix_sides(a, b, x->weight);
    sum.gradient.x += x->slope * (b.value - a.value);
    return sum;
}

/* Between the four in a plane of the lattice, at distance z from it. */
static inline struct sloped plane(const struct place *x, const struct place *y, uint32_t key,
                                  float z)
{
    struct sloped a = edge(x, key ^ y->keys[0], y->distances[0], z);
    struct sloped b = edge(x, key ^ y->keys[1], y->distances[1], z);
    struct sloped sum = mix_sides(a, b, y->weight);
    sum.gradient.y += y->slope * (b.value - a.value);
    return sum;
}

static inline struct sloped noise(ps_vec3 point, uint32_t seed)
{
    struct place x = find_place(point.x, 0x8da6b343);
    struct place y = find_place(point.y, 0xd8163841);
    struct place z = find_place(point.z, 0xcb1ab31f);
    uint32_t key = scramble(seed);
    struct sloped a = plane(&x, &y, key ^ z.keys[0], z.distances[0]);
    struct sloped b = plane(&x, &y, key ^ z.keys[1], z.distances[1]);
    struct sloped sum = mix_sides(a, b, z.weight);
    sum.gradient.z += z.slope * (b.value - a.value);
    return sum;
}

float noise_value(ps_vec3 point, uint32_t seed)
{
    return noise(point, seed).value;
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

/* A gradient after the turn, as it is before: by the transpose. */
static ps_vec3 turn_back(ps_vec3 g)
{
    return (ps_vec3){
        -0.80f * g.y - 0.60f * g.z,
        0.80f * g.x + 0.36f * g.y - 0.48f * g.z,
        0.60f * g.x - 0.48f * g.y + 0.64f * g.z,
    };
}

/* What is left of noise with features 1 wide in its mean over a square of that width, by regression
 * on the value in the middle. */
static float left_over(float width)
{
    float rest = 1.0f - 0.25f * width * width;
    return rest > 0.0f ? rest * rest : 0.0f;
}

/* Their sum, to be divided by the deviation. `gradients`: of each octave, before it is turned back,
 * or NULL. */
static inline float add_octaves(ps_vec3 point, int32_t octaves, float width, uint32_t seed,
                                ps_vec3 *gradients, float *deviation)
{
    float sum = 0.0f, amplitude = 1.0f, variance = 0.0f;
    point = turn(point);
    for (int32_t octave = 0; octave < octaves; octave++) {
        float left = left_over(width);
        struct sloped of = {0.0f, {0, 0, 0}};
        if (left > 0.0f)
            of = noise(point, seed + (uint32_t)octave);
        if (gradients)
            gradients[octave] = of.gradient;
        sum += amplitude * left * of.value;
        variance += amplitude * amplitude;
        amplitude *= 0.5f;
        width *= 2.0f;
        point = turn(ps_scale(point, 2.0f));
    }
    *deviation = sqrtf(variance);
    return sum;
}

float noise_fractal(ps_vec3 point, int32_t octaves, float width, uint32_t seed)
{
    float deviation, sum = add_octaves(point, octaves, width, seed, NULL, &deviation);
    return sum / deviation;
}

/* Octaves are half as high as the one before and twice as fine: all are as steep, each turned back
 * as often as its lattice was turned. */
float noise_fractal_gradient(ps_vec3 point, int32_t octaves, uint32_t seed, ps_vec3 *gradient)
{
    ps_vec3 gradients[NOISE_OCTAVES_LIMIT], total = {0, 0, 0};
    float deviation;
    assert(octaves >= 1 && octaves <= NOISE_OCTAVES_LIMIT);
    float sum = add_octaves(point, octaves, 0.0f, seed, gradients, &deviation);
    for (int32_t octave = octaves; octave-- > 0;)
        total = turn_back(ps_add(gradients[octave], total));
    *gradient = ps_scale(total, 1.0f / deviation);
    return sum / deviation;
}

/* Seeds far enough apart that their octaves never meet. */
static const uint32_t vector_seeds[3] = {0x100, 0x200, 0x300};

ps_vec3 noise_vector(ps_vec3 point, int32_t octaves, float width, uint32_t seed)
{
    return (ps_vec3){noise_fractal(point, octaves, width, seed + vector_seeds[0]),
                     noise_fractal(point, octaves, width, seed + vector_seeds[1]),
                     noise_fractal(point, octaves, width, seed + vector_seeds[2])};
}

ps_vec3 noise_vector_gradients(ps_vec3 point, int32_t octaves, uint32_t seed, ps_vec3 gradients[3])
{
    float values[3];
    for (int i = 0; i < 3; i++)
        values[i] = noise_fractal_gradient(point, octaves, seed + vector_seeds[i], &gradients[i]);
    return (ps_vec3){values[0], values[1], values[2]};
}
