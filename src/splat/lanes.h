/* lanes.h: sixteen conditions as the bits of a number, which compilers find no short way to: of the
 * arrays that a loop over sixteen pixels leaves they or-ed one half to the other four times over, a
 * twelfth of the kernel's time.
 */
#ifndef SPLAT_LANES_H
#define SPLAT_LANES_H

#include <stdint.h>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#define LANES 16

/* Bit i: whether condition i holds, 0 or -1 as vectors compare (1 would cost AVX2 another step).
 * Aligned to 64 bytes. */
static inline uint32_t lanes_mask(const int32_t conditions[LANES])
{
#if defined(__AVX512DQ__)
    return _mm512_movepi32_mask(_mm512_load_si512(conditions));
#elif defined(__AVX2__)
    const __m256i *halves = (const __m256i *)(const void *)conditions;
    int low = _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_load_si256(halves)));
    int high = _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_load_si256(halves + 1)));
    return (uint32_t)low | (uint32_t)high << 8;
#else
    uint32_t mask = 0;
    for (int i = 0; i < LANES; i++)
        mask |= (uint32_t)(conditions[i] & 1) << i;
    return mask;
#endif
}

/* How many bits are set. */
static inline int lanes_count(uint32_t mask)
{
#if defined(__GNUC__)
    return __builtin_popcount(mask);
#else
    int count = 0;
    for (; mask; mask &= mask - 1)
        count++;
    return count;
#endif
}

/* The lowest bit of a mask that has some. */
static inline int lanes_first(uint32_t mask)
{
#if defined(__GNUC__)
    return __builtin_ctz(mask);
#else
    int bit = 0;
    while (!(mask >> bit & 1u))
        bit++;
    return bit;
#endif
}

#endif
