/* host.c: the services of psplat/host.h, on top of a render. */
#include "base/parallel.h"
#include "base/sample.h"
#include "pipeline/host_light.h"
#include "pipeline/host_place.h"
#include "pipeline/host_splat.h"
#include "pipeline/render_state.h"
#include <psplat/math.h>
#include <stdlib.h>
#include <string.h>

/* In front of what allocate gives; 64 bytes, so that the memory behind it stays aligned. */
struct allocation {
    _Alignas(64) size_t bytes;
    const char *what;
};

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
    statistics_add_bytes(render_of(host)->statistics, what, (double)whole);
    return allocation + 1;
}

static void host_release(const ps_host *host, void *memory)
{
    if (!memory)
        return;
    struct allocation *allocation = (struct allocation *)memory - 1;
    statistics_add_bytes(render_of(host)->statistics, allocation->what, -(double)allocation->bytes);
    free(allocation);
}

static void host_parallel_for(const ps_host *host, uint64_t count, ps_body body, void *user)
{
    parallel_for(render_of(host)->settings->threads, count, body, user);
}

static int32_t host_cancelled(const ps_host *host)
{
    const struct render_callbacks *callbacks = render_of(host)->callbacks;
    return callbacks->cancelled && callbacks->cancelled(callbacks->user);
}

static void host_progress(const ps_host *host, double fraction)
{
    const struct render *render = render_of(host);
    const struct render_callbacks *callbacks = render->callbacks;
    if (callbacks->progress)
        callbacks->progress(callbacks->user, "indirect light",
                            (render->pass.number + fraction) / render->settings->passes);
}

/* A part of the tiles; their number is shifted by the first of the part. */
struct tile_part {
    const ps_host *host;
    uint64_t first;
    ps_body body;
    void *user;
};

static void visit_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct tile_part *part = user;
    if (!host_cancelled(part->host))
        part->body(part->user, part->first + index, worker);
}

static ps_result host_for_each_tile(const ps_host *host, ps_body body, void *user)
{
    const struct render *render = render_of(host);
    uint64_t count = render->gbuffer.tile_count;
    /* Parts of some tiles a thread: often enough to report, rarely enough to keep threads busy. */
    uint64_t step = 16 * (uint64_t)render->settings->threads;
    for (uint64_t first = 0; first < count; first += step) {
        struct tile_part part = {host, first, body, user};
        parallel_for(render->settings->threads, count - first < step ? count - first : step,
                     visit_tile, &part);
        if (host_cancelled(host))
            return PS_CANCELLED;
        uint64_t done = first + step < count ? first + step : count;
        host_progress(host, (double)done / (double)count);
    }
    return PS_OK;
}

static void host_samples(const ps_host *host, uint32_t stream, uint32_t set,
                         const uint64_t *indices, size_t n, float (*samples)[4])
{
    sample_points(sample_key(render_of(host)->settings->seed, stream, set), indices, n, samples);
}

static void host_scene_bounds(const ps_host *host, ps_vec3 *center, float *radius)
{
    *center = render_of(host)->scene->center;
    *radius = render_of(host)->scene->radius;
}

static void host_camera(const ps_host *host, ps_vec3 *position, ps_vec3 *direction)
{
    *position = render_of(host)->scene->camera.location;
    *direction = render_of(host)->scene->camera.forward;
}

static ps_result host_next_photons(const ps_host *host, const ps_photon **photons, size_t *n,
                                   double *progress)
{
    struct render *render = render_of(host);
    if (host_cancelled(host))
        return PS_CANCELLED;
    ps_result result = photon_stream_next(&render->photons, photons, n, &render->error);
    *progress = photon_stream_progress(&render->photons);
    return result;
}

static ps_tile *host_tile(const ps_host *host, uint32_t index)
{
    return &render_of(host)->gbuffer.tiles[index];
}

static int32_t host_pixel(const ps_host *host, uint32_t tile, uint32_t lane, uint32_t *x,
                          uint32_t *y)
{
    return gbuffer_pixel(&render_of(host)->gbuffer, tile, lane, x, y);
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

void host_create(struct render *render)
{
    render->host = (ps_host){
        .size = sizeof(ps_host),
        .abi_minor = PS_ABI_MINOR,
        .core = render,
        .allocate = host_allocate,
        .release = host_release,
        .parallel_for = host_parallel_for,
        .for_each_tile = host_for_each_tile,
        .samples = host_samples,
        .scene_bounds = host_scene_bounds,
        .next_photons = host_next_photons,
        .tile = host_tile,
        .pixel = host_pixel,
        .log = host_log,
        .count = host_count,
        .progress = host_progress,
        .cancelled = host_cancelled,
        .camera = host_camera,
    };
    host_add_light_transport(&render->host);
    host_add_placing(&render->host);
    host_add_splatting(&render->host);
}
