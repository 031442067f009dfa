/* jumping_clock.c: a library to preload, under which the time of day jumps by hours back and forth
 * each time it is asked for. Clocks that only go on are left alone.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdatomic.h>
#include <time.h>

static time_t jump(void)
{
    static atomic_uint calls;
    unsigned call = atomic_fetch_add(&calls, 1);
    return (time_t)(call % 3) * 7200 - (time_t)(call % 2) * 36000;
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    static int (*next)(clockid_t, struct timespec *);
    if (!next)
        *(void **)&next = dlsym(RTLD_NEXT, "clock_gettime");
    int status = next(clock, now);
    if (status == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
        now->tv_sec += jump();
    return status;
}

time_t time(time_t *now)
{
    static time_t (*next)(time_t *);
    if (!next)
        *(void **)&next = dlsym(RTLD_NEXT, "time");
    time_t jumped = next(NULL) + jump();
    if (now)
        *now = jumped;
    return jumped;
}
