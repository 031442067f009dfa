/* parallel.h: loops over the threads of a render.
 *
 * Workers are the thread that calls and helpers, which last as long as the workers do. Each takes
 * the next index as it gets free. One that has nothing to do spins for 50 microseconds, as long as
 * a loop is likely to follow, and sleeps then: OpenMP's threads spin for milliseconds, which costs
 * a machine with other work twice the processor time; and there all threads meet at the end of a
 * loop, where here a helper that has not begun is not waited for.
 *
 * Every worker sets flush-to-zero and denormals-are-zero at its start and restores what it found:
 * the ray tracer wants it, and it must hold on all threads alike or the same sum differs between
 * them.
 */
#ifndef BASE_PARALLEL_H
#define BASE_PARALLEL_H

#include "base/error.h"

#include <stdint.h>

struct workers;

typedef void (*parallel_body)(void *user, uint64_t index, uint32_t worker);

/* Processors that this process may use. */
uint32_t parallel_processor_count(void);

/* `count` workers, the caller among them. PS_ERROR_MEMORY where the system has not so many
 * threads. */
ps_result workers_create(uint32_t count, struct workers **created, struct error *error);

/* While no loop runs. NULL is nobody. */
void workers_destroy(struct workers *workers);

/* Numbers of workers are below it. */
uint32_t workers_count(const struct workers *workers);

/* body(user, index, worker) for all index < count; returns when all are done. NULL stands for the
 * caller alone. One loop at a time: neither from within a body nor from two threads. */
void parallel_for(struct workers *workers, uint64_t count, parallel_body body, void *user);

#endif
