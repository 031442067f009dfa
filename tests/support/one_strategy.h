/* one_strategy.h: a strategy alone, without a render: for tests that call its functions on input
 * made by hand. */
#ifndef TESTS_SUPPORT_ONE_STRATEGY_H
#define TESTS_SUPPORT_ONE_STRATEGY_H

#include "base/parallel.h"
#include "plugin/strategy.h"
#include <stdatomic.h>

#define BARE_HOST_RADIUS 100.0f
#define BARE_HOST_PIXEL 0.1f

/* A host that has memory, loops on `threads` threads, the bounds of a scene with its centre in the
 * origin and radius BARE_HOST_RADIUS, an orthographic camera with pixels of side BARE_HOST_PIXEL,
 * says whether it is cancelled, and keeps failures; nothing else. */
struct bare_host {
    ps_host host;
    struct workers *workers;
    atomic_int live_allocations;
    bool cancelled;
    char why[200]; /* the last failure */
};

/* `bare` must stay where it is while it is used. */
void bare_host_create(struct bare_host *bare, uint32_t threads);
void bare_host_release(struct bare_host *bare);

/* The strategy that a text such as "filter=cone:k=2" asks for, not started. A failure fails the
 * test. Release it with strategy_release. */
struct strategy strategy_of(const char *text);

#endif
