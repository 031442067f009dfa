#include "base/parallel.h"

#include <assert.h>
#include <omp.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
typedef uint32_t floating_point_mode;
#define FLUSH_DENORMALS 0x8040u /* FTZ | DAZ */
static floating_point_mode flush_denormals(void)
{
    floating_point_mode before = _mm_getcsr();
    _mm_setcsr(before | FLUSH_DENORMALS);
    return before;
}
static void restore_denormals(floating_point_mode before)
{
    _mm_setcsr(before);
}
#elif defined(__aarch64__) && defined(__GNUC__)
typedef uint64_t floating_point_mode;
#define FLUSH_DENORMALS (UINT64_C(1) << 24) /* FPCR.FZ */
static floating_point_mode flush_denormals(void)
{
    floating_point_mode before;
    __asm__ volatile("mrs %0, fpcr" : "=r"(before));
    __asm__ volatile("msr fpcr, %0" : : "r"(before | FLUSH_DENORMALS));
    return before;
}
static void restore_denormals(floating_point_mode before)
{
    __asm__ volatile("msr fpcr, %0" : : "r"(before));
}
#else
typedef uint32_t floating_point_mode;
static floating_point_mode flush_denormals(void)
{
    return 0;
}
static void restore_denormals(floating_point_mode before)
{
    (void)before;
}
#endif

uint32_t parallel_processor_count(void)
{
    int count = omp_get_num_procs();
    return count > 0 ? (uint32_t)count : 1;
}

void parallel_for(uint32_t threads, uint64_t count, parallel_body body, void *user)
{
    assert(threads > 0);
    /* nowait: the end of the region is barrier enough. */
#pragma omp parallel num_threads((int)threads)
    {
        uint32_t worker = (uint32_t)omp_get_thread_num();
        floating_point_mode before = flush_denormals();
#pragma omp for schedule(dynamic, 1) nowait
        for (uint64_t index = 0; index < count; index++)
            body(user, index, worker);
        restore_denormals(before);
    }
}
