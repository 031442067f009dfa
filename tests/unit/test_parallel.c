/* Loops over workers: every index once, numbers of workers in their range, the floating-point mode,
 * and that whoever waits sleeps. */
#include "base/parallel.h"

#include "support/memory_limit.h"
#include "support/workers.h"
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>
#include <time.h>

#define INDICES 1000

struct counted {
    atomic_uint times[INDICES];
    atomic_uint wrong_workers;
    uint32_t workers;
};

static void count(void *user, uint64_t index, uint32_t worker)
{
    struct counted *counted = user;
    counted->times[index]++;
    counted->wrong_workers += worker >= counted->workers;
}

static void expect_each_once(struct workers *workers, uint64_t indices)
{
    struct counted counted = {.workers = workers_count(workers)};
    parallel_for(workers, indices, count, &counted);
    for (uint64_t i = 0; i < INDICES; i++)
        assert_int_equal(counted.times[i], i < indices);
    assert_int_equal(counted.wrong_workers, 0);
}

static void test_each_index_once(void **state)
{
    static const uint32_t numbers[] = {1, 2, 3, 16};
    (void)state;
    expect_each_once(NULL, INDICES);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct workers *workers = start_workers(numbers[i]);
        assert_int_equal(workers_count(workers), numbers[i]);
        for (uint64_t indices = 0; indices <= INDICES; indices += 1 + indices / 10)
            expect_each_once(workers, indices);
        workers_destroy(workers);
    }
}

/* Loops at once after each other and after pauses in which helpers fall asleep. */
static void test_many_loops(void **state)
{
    const struct timespec pause = {.tv_nsec = 300000};
    struct workers *workers = start_workers(4);
    (void)state;
    for (int i = 0; i < 20000; i++) {
        if (i % 200 == 0)
            nanosleep(&pause, NULL);
        struct counted counted = {.workers = 4};
        parallel_for(workers, 5, count, &counted);
        for (int j = 0; j < 5; j++)
            assert_int_equal(counted.times[j], 1);
    }
    workers_destroy(workers);
}

/* Half of the least normal number; `volatile` lets no compiler halve it. */
static void halve(void *user, uint64_t index, uint32_t worker)
{
    float *halves = user;
    volatile float least = 1.17549435e-38f;
    (void)worker;
    halves[index] = 0.5f * least;
}

static void test_denormals_are_flushed_within_loops_alone(void **state)
{
    float before, halves[64], alone;
    struct workers *workers = start_workers(3);
    (void)state;
    halve(&before, 0, 0);
    assert_true(before > 0.0f);
    parallel_for(workers, 64, halve, halves);
    parallel_for(NULL, 1, halve, &alone);
    halve(&before, 0, 0);
    assert_true(before > 0.0f);
    workers_destroy(workers);
#if defined(__SSE2__) || defined(__aarch64__)
    for (int i = 0; i < 64; i++)
        assert_true(halves[i] == 0.0f);
    assert_true(alone == 0.0f);
#endif
}

static double seconds_of(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void sleep_at_index_0(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    if (index == 0)
        nanosleep(user, NULL);
}

/* One index sleeps while the other workers have nothing to do, and then nobody has. */
static void test_who_waits_sleeps(void **state)
{
    struct timespec pause = {.tv_nsec = 300000000};
    struct workers *workers = start_workers(4);
    (void)state;
    double wall = -seconds_of(CLOCK_MONOTONIC), processor = -seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    parallel_for(workers, 8, sleep_at_index_0, &pause);
    nanosleep(&pause, NULL);
    wall += seconds_of(CLOCK_MONOTONIC);
    processor += seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    if (processor > 0.1 * wall)
        fail_msg("%.2f processor seconds while %.2f seconds went by", processor, wall);
    workers_destroy(workers);
}

/* A thousand stacks, of at least 64 kB each. */
static void test_too_many_threads(void **state)
{
    (void)state;
    if (ADDRESS_SPACE_IS_SHADOWED)
        skip();
    struct workers *workers;
    struct error error;
    struct rlimit before = limit_memory(50e6);
    ps_result result = workers_create(1000, &workers, &error);
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    assert_int_equal(result, PS_ERROR_MEMORY);
    assert_null(workers);
    assert_non_null(strstr(error.text, "cannot start 1000 threads: the system gives "));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_index_once),
        cmocka_unit_test(test_many_loops),
        cmocka_unit_test(test_denormals_are_flushed_within_loops_alone),
        cmocka_unit_test(test_who_waits_sleeps),
        cmocka_unit_test(test_too_many_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
