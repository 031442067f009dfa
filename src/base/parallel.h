/* parallel.h: loops over the render's threads.
 *
 * OpenMP's dynamic schedule, one item at a time. Every worker sets flush-to-zero and
 * denormals-are-zero at its start and restores what it found: the ray tracer wants it, and it must
 * hold on all threads alike or the same sum differs between them.
 */
#ifndef BASE_PARALLEL_H
#define BASE_PARALLEL_H

#include <stdint.h>

typedef void (*parallel_body)(void *user, uint64_t index, uint32_t worker);

/* Processors that this process may use. */
uint32_t parallel_processor_count(void);

/* body(user, index, worker) for all index < count, worker < threads; returns when all are done. */
void parallel_for(uint32_t threads, uint64_t count, parallel_body body, void *user);

#endif
