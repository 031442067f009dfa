/* host.c: the services that have to do with the plugin itself: memory, messages, loops, random
 * numbers. */
#include "host/host.h"

#include "base/parallel.h"
#include "base/sample.h"
#include "host/alias.h"
#include "stratify/cells.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* In front of what allocate gives; 64 bytes, so that the memory behind it stays aligned. */
struct allocation {
    _Alignas(64) size_t bytes;
    const char *what;
};

static struct strategy_host *own_of(const ps_host *host)
{
    return host->core;
}

static void *host_allocate(const ps_host *host, size_t bytes, const char *what)
{
    size_t header = sizeof(struct allocation);
    if (bytes > SIZE_MAX / 2)
        return NULL;
    size_t whole = (header + bytes + 63) / 64 * 64;
    struct allocation *allocation = aligned_alloc(64, whole);
    if (!allocation)
        return NULL;
    *allocation = (struct allocation){whole, what};
    atomic_fetch_add(&own_of(host)->blocks, 1);
    statistics_add_bytes(render_of(host)->statistics, what, (double)whole);
    return allocation + 1;
}

static void host_release(const ps_host *host, void *memory)
{
    if (!memory)
        return;
    struct allocation *allocation = (struct allocation *)memory - 1;
    atomic_fetch_sub(&own_of(host)->blocks, 1);
    statistics_add_bytes(render_of(host)->statistics, allocation->what, -(double)allocation->bytes);
    free(allocation);
}

static const void *host_extension(const ps_host *host, const char *name)
{
    (void)host;
    static const struct {
        const char *name;
        const void *table;
    } extensions[] = {{PS_CELLS_EXTENSION, &cells_service}, {PS_ALIAS_EXTENSION, &alias_service}};
    for (size_t i = 0; i < sizeof extensions / sizeof extensions[0]; i++)
        if (strcmp(extensions[i].name, name) == 0)
            return extensions[i].table;
    return NULL;
}

static ps_result host_fail(const ps_host *host, ps_result result, const char *why)
{
    return render_fail(render_of(host), result, why);
}

bool host_in_place(const ps_host *host, bool there, const char *service)
{
    char why[120];
    if (there)
        return true;
    snprintf(why, sizeof why, "it called %s where that is not there", service);
    host_fail(host, PS_ERROR_INVALID, why);
    return false;
}

void host_refuse_index(const ps_host *host, const char *service, uint64_t index, uint64_t count)
{
    char why[160];
    snprintf(why, sizeof why, "it called %s with index %llu of %llu", service,
             (unsigned long long)index, (unsigned long long)count);
    host_fail(host, PS_ERROR_INVALID, why);
}

bool host_loop(const ps_host *host, const char *service, uint64_t count, ps_body body, void *user)
{
    struct render *render = render_of(host);
    bool other = atomic_exchange(&render->looping, true);
    if (!host_in_place(host, !other, service))
        return false;
    parallel_for(render->settings->workers, count, body, user);
    atomic_store(&render->looping, false);
    return true;
}

static void host_parallel_for(const ps_host *host, uint64_t count, ps_body body, void *user)
{
    host_loop(host, "parallel_for", count, body, user);
}

bool host_is_cancelled(const struct render *render)
{
    const struct render_callbacks *callbacks = render->callbacks;
    return callbacks->cancelled && callbacks->cancelled(callbacks->user);
}

static int32_t host_cancelled(const ps_host *host)
{
    return host_is_cancelled(render_of(host));
}

void host_tell_progress(const ps_host *host, double fraction)
{
    const struct render *render = render_of(host);
    const struct render_callbacks *callbacks = render->callbacks;
    double of_pass =
        render->progress_from + (render->progress_to - render->progress_from) * fraction;
    if (callbacks->progress)
        callbacks->progress(callbacks->user, "indirect light", render_fraction(render, of_pass));
}

static void host_progress_part(const ps_host *host, double from, double to)
{
    struct render *render = render_of(host);
    render->progress_from = from;
    render->progress_to = to;
}

void host_hand_over(const ps_host *host, const char *service, void *theirs, const void *ours,
                    uint32_t size)
{
    uint32_t known;
    memcpy(&known, theirs, sizeof known);
    if (known <= sizeof known) {
        char why[120];
        snprintf(why, sizeof why, "it called %s with a struct whose size is not set", service);
        host->fail(host, PS_ERROR_INVALID, why);
        return;
    }
    memcpy((char *)theirs + sizeof known, (const char *)ours + sizeof known,
           (known < size ? known : size) - sizeof known);
}

/* Streams from PS_STREAM_PLUGIN on are apart for each kind. */
static void host_samples(const ps_host *host, uint32_t stream, uint32_t set,
                         const uint64_t *indices, size_t n, float (*samples)[4])
{
    if (stream >= PS_STREAM_PLUGIN)
        stream += (uint32_t)(kind_of(host) + 1) << 24;
    sample_points(sample_key(render_of(host)->settings->seed, stream, set), indices, n, samples);
}

static void host_log(const ps_host *host, ps_log_level level, const char *message)
{
    const struct render_callbacks *callbacks = render_of(host)->callbacks;
    if (callbacks->log)
        callbacks->log(callbacks->user, level, message);
}

static void host_count(const ps_host *host, const char *counter, double amount)
{
    statistics_count(render_of(host)->statistics, counter, amount);
}

static void empty_nowhere(struct render *render)
{
    ps_tile *tile = &render->nowhere;
    memset(tile, 0, sizeof *tile);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        tile->object[lane] = PS_NO_OBJECT;
        tile->depth[lane] = INFINITY;
    }
    tile->radiance_r = render->nowhere_radiance[0];
    tile->radiance_g = render->nowhere_radiance[1];
    tile->radiance_b = render->nowhere_radiance[2];
}

void host_create(struct render *render)
{
    empty_nowhere(render);
    for (int kind = 0; kind <= PS_KINDS; kind++) {
        struct strategy_host *own = &render->hosts[kind];
        *own = (struct strategy_host){.render = render, .kind = (ps_kind)kind, .blocks = 0};
        own->host = (ps_host){
            .size = sizeof(ps_host),
            .abi_minor = PS_ABI_MINOR,
            .core = own,
            .extension = host_extension,
            .fail = host_fail,
            .allocate = host_allocate,
            .release = host_release,
            .log = host_log,
            .count = host_count,
            .progress = host_tell_progress,
            .cancelled = host_cancelled,
            .parallel_for = host_parallel_for,
            .samples = host_samples,
            .progress_part = host_progress_part,
        };
        host_add_scene(&own->host);
        host_add_lights(&own->host);
        host_add_tiles(&own->host);
        host_add_photons(&own->host);
    }
}
