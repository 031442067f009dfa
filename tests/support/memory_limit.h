/* memory_limit.h: lets a test run out of memory. */
#ifndef TESTS_SUPPORT_MEMORY_LIMIT_H
#define TESTS_SUPPORT_MEMORY_LIMIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/resource.h>

#include <cmocka.h>

/* Limits mean nothing there. */
#if defined(__SANITIZE_ADDRESS__)
#define ADDRESS_SPACE_IS_SHADOWED true
#elif defined(__has_feature)
#define ADDRESS_SPACE_IS_SHADOWED __has_feature(address_sanitizer)
#else
#define ADDRESS_SPACE_IS_SHADOWED false
#endif

/* So many bytes more than now. Returns the limit before: give it back with setrlimit(RLIMIT_AS). */
static inline struct rlimit limit_memory(double bytes)
{
    struct rlimit before, limit;
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%ld", &pages), 1);
    fclose(file);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    limit = (struct rlimit){(rlim_t)pages * 4096 + (rlim_t)bytes, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
    return before;
}

#endif
