/* random.h: independent random numbers for tests, of another make than those under test. */
#ifndef TESTS_SUPPORT_RANDOM_H
#define TESTS_SUPPORT_RANDOM_H

#include <math.h>
#include <psplat/types.h>

/* Seed it with any number but 0. */
struct random {
    uint64_t state;
};

/* xorshift64* (Vigna 2016). */
static inline uint64_t random_bits(struct random *random)
{
    uint64_t x = random->state;
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    random->state = x;
    return x * UINT64_C(0x2545f4914f6cdd1d);
}

/* In [0, 1), 24 bits: the float is exact. */
static inline float random_unit(struct random *random)
{
    return (float)(random_bits(random) >> 40) * 0x1p-24f;
}

static inline float random_between(struct random *random, float low, float high)
{
    return low + (high - low) * random_unit(random);
}

/* Uniform over the sphere (Archimedes). */
static inline ps_vec3 random_direction(struct random *random)
{
    double z = 2.0 * random_unit(random) - 1.0, phi = 6.283185307179586 * random_unit(random);
    double radius = sqrt(fmax(0.0, 1.0 - z * z));
    return (ps_vec3){(float)(radius * cos(phi)), (float)(radius * sin(phi)), (float)z};
}

#endif
