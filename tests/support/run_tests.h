/* run_tests.h: runs a program's tests, without those that take seconds where time is short.
 *
 * A test that is listed by SLOW_TEST is left out under $PSPLAT_QUICK. CMake finds the word in the
 * source, and adds the program twice: whole, with the label `slow`, and quick, with the label
 * `quick`. Under $PSPLAT_SLOW the others are left out: for a whole run after a quick one. Include
 * it after cmocka.h.
 */
#ifndef TESTS_SUPPORT_RUN_TESTS_H
#define TESTS_SUPPORT_RUN_TESTS_H

#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>

#define MOST_TESTS 64

/* Its address is the initial state of slow tests, which they do not look at. */
static char slow_mark;

#define SLOW_TEST(function)                                                                        \
    {                                                                                              \
#function, function, NULL, NULL, &slow_mark                                                \
    }

static inline int run_tests_of(const struct CMUnitTest *tests, size_t count)
{
    struct CMUnitTest chosen[MOST_TESTS];
    size_t chosen_count = 0;
    assert(count <= MOST_TESTS);
    for (size_t i = 0; i < count; i++) {
        bool slow = tests[i].initial_state == &slow_mark;
        if (!getenv(slow ? "PSPLAT_QUICK" : "PSPLAT_SLOW"))
            chosen[chosen_count++] = tests[i];
    }
    return _cmocka_run_group_tests("tests", chosen, chosen_count, NULL, NULL);
}

#define RUN_TESTS(tests) run_tests_of(tests, sizeof(tests) / sizeof(tests)[0])

#endif
