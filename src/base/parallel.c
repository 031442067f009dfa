#include "base/parallel.h"

#include <assert.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

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

#if defined(__SSE2__)
#define PAUSE() _mm_pause()
#else
#define PAUSE() ((void)0)
#endif

/* Longer than most pauses between the loops of a pass, shorter than what a scheduler gives to
 * others. */
#define SPIN_NANOSECONDS 50000

/* `lock` guards all but the atomics. Helpers enter a loop under the lock while it is open; the
 * caller closes it when no index is left and waits for those inside alone, so that a helper that a
 * busy machine has not woken yet holds nobody up. */
struct workers {
    uint32_t helper_count;
    pthread_t *helpers;
    pthread_mutex_t lock;
    pthread_cond_t opened, emptied;
    parallel_body body;
    void *user;
    uint64_t count;
    atomic_uint_fast64_t next;   /* index */
    atomic_uint_fast64_t inside; /* helpers */
    atomic_uint_fast64_t loops;  /* opened so far */
    bool open, ended;
    uint32_t started; /* helpers that have taken their number */
};

uint32_t parallel_processor_count(void)
{
#ifdef __linux__
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) == 0 && CPU_COUNT(&allowed) > 0)
        return (uint32_t)CPU_COUNT(&allowed);
#endif
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 0 ? (uint32_t)count : 1;
}

static int64_t nanoseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* Returns when the number has become another, or the time is over. */
static void spin_on(atomic_uint_fast64_t *number, uint64_t value)
{
    int64_t end = nanoseconds() + SPIN_NANOSECONDS;
    while (atomic_load(number) == value && nanoseconds() < end)
        for (int i = 0; i < 16; i++)
            PAUSE();
}

static void run_indices(struct workers *workers, uint32_t worker)
{
    parallel_body body = workers->body;
    void *user = workers->user;
    uint64_t count = workers->count;
    floating_point_mode before = flush_denormals();
    for (uint64_t i; (i = atomic_fetch_add(&workers->next, 1)) < count;)
        body(user, i, worker);
    restore_denormals(before);
}

static void *help(void *argument)
{
    struct workers *workers = argument;
    pthread_mutex_lock(&workers->lock);
    uint32_t worker = ++workers->started;
    for (uint64_t seen = 0;;) {
        pthread_mutex_unlock(&workers->lock);
        spin_on(&workers->loops, seen);
        pthread_mutex_lock(&workers->lock);
        while (!workers->ended && !(workers->open && workers->loops != seen))
            pthread_cond_wait(&workers->opened, &workers->lock);
        if (workers->ended)
            break;
        seen = workers->loops;
        workers->inside++;
        pthread_mutex_unlock(&workers->lock);
        run_indices(workers, worker);
        pthread_mutex_lock(&workers->lock);
        if (--workers->inside == 0)
            pthread_cond_signal(&workers->emptied);
    }
    pthread_mutex_unlock(&workers->lock);
    return NULL;
}

/* Signals are for the threads that were there before. */
static bool start_helpers(struct workers *workers, uint32_t wanted)
{
    sigset_t all, before;
    int failed = 0;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    while (workers->helper_count < wanted && failed == 0) {
        failed = pthread_create(&workers->helpers[workers->helper_count], NULL, help, workers);
        workers->helper_count += failed == 0;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return failed == 0;
}

ps_result workers_create(uint32_t count, struct workers **created, struct error *error)
{
    assert(count > 0);
    *created = NULL;
    struct workers *workers = calloc(1, sizeof *workers);
    pthread_t *helpers = calloc(count, sizeof *helpers);
    if (!workers || !helpers) {
        free(workers);
        free(helpers);
        return error_memory(error, count * sizeof *helpers, "threads");
    }
    workers->helpers = helpers;
    pthread_mutex_init(&workers->lock, NULL);
    pthread_cond_init(&workers->opened, NULL);
    pthread_cond_init(&workers->emptied, NULL);
    if (!start_helpers(workers, count - 1)) {
        ps_result result =
            error_set(error, PS_ERROR_MEMORY, "cannot start %u threads: the system gives %u", count,
                      workers->helper_count + 1);
        workers_destroy(workers);
        return result;
    }
    *created = workers;
    return PS_OK;
}

void workers_destroy(struct workers *workers)
{
    if (!workers)
        return;
    pthread_mutex_lock(&workers->lock);
    workers->ended = true;
    atomic_fetch_add(&workers->loops, 1); /* who spins shall look */
    pthread_cond_broadcast(&workers->opened);
    pthread_mutex_unlock(&workers->lock);
    for (uint32_t i = 0; i < workers->helper_count; i++)
        pthread_join(workers->helpers[i], NULL);
    pthread_cond_destroy(&workers->emptied);
    pthread_cond_destroy(&workers->opened);
    pthread_mutex_destroy(&workers->lock);
    free(workers->helpers);
    free(workers);
}

uint32_t workers_count(const struct workers *workers)
{
    return workers ? workers->helper_count + 1 : 1;
}

static void open_loop(struct workers *workers, uint64_t count, parallel_body body, void *user)
{
    pthread_mutex_lock(&workers->lock);
    assert(!workers->open); /* no loop within a loop */
    workers->body = body;
    workers->user = user;
    workers->count = count;
    atomic_store(&workers->next, 0);
    atomic_fetch_add(&workers->loops, 1);
    workers->open = true;
    pthread_cond_broadcast(&workers->opened);
    pthread_mutex_unlock(&workers->lock);
}

static void close_loop(struct workers *workers)
{
    pthread_mutex_lock(&workers->lock);
    workers->open = false;
    for (uint64_t inside; (inside = atomic_load(&workers->inside)) > 0;) {
        pthread_mutex_unlock(&workers->lock);
        spin_on(&workers->inside, inside);
        pthread_mutex_lock(&workers->lock);
        if (atomic_load(&workers->inside) == inside)
            pthread_cond_wait(&workers->emptied, &workers->lock);
    }
    pthread_mutex_unlock(&workers->lock);
}

void parallel_for(struct workers *workers, uint64_t count, parallel_body body, void *user)
{
    if (workers_count(workers) > 1 && count > 1) {
        open_loop(workers, count, body, user);
        run_indices(workers, 0);
        close_loop(workers);
        return;
    }
    floating_point_mode before = flush_denormals();
    for (uint64_t i = 0; i < count; i++)
        body(user, i, 0);
    restore_denormals(before);
}
