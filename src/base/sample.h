/* sample.h: random numbers as pure functions of (seed, stream, set, index).
 *
 * Owen-scrambled Sobol points after Burley 2020, "Practical hash-based Owen scrambling" (JCGT 9-4),
 * with the hash of Vegdahl 2021 in place of Laine and Karras's. Four Sobol dimensions make a set;
 * sets are decorrelated by shuffling the index (Burley's padding). No state, so no thread can
 * disturb another and any path can be repeated alone; a stateful generator a thread could give
 * neither.
 */
#ifndef BASE_SAMPLE_H
#define BASE_SAMPLE_H

#include <stddef.h>
#include <stdint.h>

/* One key for a (seed, stream, set). */
uint32_t sample_key(uint64_t seed, uint32_t stream, uint32_t set);

/* Four numbers in [0, 1). */
void sample_point(uint32_t key, uint64_t index, float point[4]);

/* The points of `n` indices; faster than one by one where their upper halves are the same. */
void sample_points(uint32_t key, const uint64_t *indices, size_t n, float (*points)[4]);

/* A well-mixed 32-bit hash. */
uint32_t sample_hash(uint64_t value);

#endif
