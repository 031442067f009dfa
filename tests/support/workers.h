/* workers.h: workers for a test; a failure fails it. */
#ifndef TESTS_SUPPORT_WORKERS_H
#define TESTS_SUPPORT_WORKERS_H

#include "base/parallel.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

/* Release them with workers_destroy. */
static inline struct workers *start_workers(uint32_t count)
{
    struct workers *workers;
    struct error error;
    assert_int_equal(workers_create(count, &workers, &error), PS_OK);
    return workers;
}

#endif
