/* host.c: the services of psplat/host.h, on top of a render. */
#include "base/clock.h"
#include "base/parallel.h"
#include "base/sample.h"
#include "pipeline/host_light.h"
#include "pipeline/render_state.h"
#include "splat/box.h"
#include "splat/wall.h"
#include <psplat/math.h>
#include <stdlib.h>
#include <string.h>

static struct render *render_of(const ps_host *host)
{
    return host->core;
}

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

static void host_place_boxes(const ps_host *host, const ps_box_settings *settings,
                             const ps_source *sources, const ps_hit *hits, size_t n,
                             ps_splat *splats)
{
    const struct render *render = render_of(host);
    struct box_scene scene = {
        .radius = render->scene->radius,
        .surface_offset = render->scene->surface_offset,
        .automatic_size = box_automatic_size(render->scene->radius, render->sources.path_count,
                                             render->pass.number),
        .seed = render->settings->seed,
    };
    box_place(&scene, settings, sources, hits, n, splats);
    if (settings->walls && settings->step_back_rule == 1)
        wall_find(host, render->scene->surface_offset, sources, n, splats);
}

static ps_result host_next_sources(const ps_host *host, const ps_source **sources, size_t *n,
                                   double *progress)
{
    struct render *render = render_of(host);
    if (host_cancelled(host))
        return PS_CANCELLED;
    ps_result result = source_stream_next(&render->sources, sources, n, &render->error);
    *progress = source_stream_progress(&render->sources);
    return result;
}

struct placement {
    struct render *render;
    const ps_source *sources;
    size_t n;
    ps_splat *splats;
};

static void place_chunk(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct placement *placement = user;
    struct render *render = placement->render;
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    size_t first = index * PS_PATH_CHUNK, left = placement->n - first;
    size_t n = left < PS_PATH_CHUNK ? left : PS_PATH_CHUNK;
    const ps_source *sources = placement->sources + first;
    for (size_t i = 0; i < n; i++)
        rays[i] = ps_leave_surface(sources[i].position, sources[i].normal, sources[i].direction,
                                   render->scene->surface_offset);
    trace_intersect(render->trace, RAYS_INCOHERENT, rays, n, hits);
    const struct strategy *visibility = &render->settings->strategies[PS_VISIBILITY];
    const ps_visibility_vtable *vtable = visibility->descriptor->vtable;
    vtable->place(visibility->state, &render->host, sources, hits, n, placement->splats + first);
}

static ps_result host_place_splats(const ps_host *host, const ps_source *sources, size_t n,
                                   ps_splat *splats)
{
    struct render *render = render_of(host);
    struct placement placement = {render, sources, n, splats};
    double start = clock_seconds();
    uint64_t chunks = (n + PS_PATH_CHUNK - 1) / PS_PATH_CHUNK;
    parallel_for(render->settings->threads, chunks, place_chunk, &placement);
    statistics_add_seconds(render->statistics, "place", clock_seconds() - start);
    return PS_OK;
}

static ps_result tabulate_filter(struct render *render, struct kernel_profile *profile)
{
    const struct strategy *filter = &render->settings->strategies[PS_FILTER];
    const ps_filter_vtable *vtable = filter->descriptor->vtable;
    float radius2[KERNEL_PROFILE_SIZE];
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        radius2[i] = kernel_profile_radius2(i);
    vtable->weigh(filter->state, radius2, profile->weights, KERNEL_PROFILE_SIZE);
    if (kernel_profile_normalize(profile))
        return PS_OK;
    return error_set(&render->error, PS_ERROR_INVALID,
                     "filter %s: weights must not be negative, nor zero everywhere",
                     filter->descriptor->name);
}

static void host_interleave(const ps_host *host, uint32_t n)
{
    render_of(host)->interleave = n < 1 ? 1 : n < PS_MOST_INTERLEAVE ? n : PS_MOST_INTERLEAVE;
}

static ps_result create_splatter(struct render *render)
{
    const struct strategy *visibility = &render->settings->strategies[PS_VISIBILITY];
    struct splatter_settings settings = {
        .host = &render->host,
        .visibility = visibility->descriptor->vtable,
        .visibility_state = visibility->state,
        .surface_offset = render->scene->surface_offset,
        .kernel = render->kernel,
        .interleave = render->counts_splats ? 1 : render->interleave,
        .threads = render->settings->threads,
        .batch = render->settings->batch,
    };
    ps_result result = PS_OK;
    if (render->counts_splats)
        kernel_profile_count(&settings.profile);
    else
        result = tabulate_filter(render, &settings.profile);
    if (result == PS_OK)
        result = splatter_create(&render->splatter, &render->gbuffer, &settings, &render->error);
    render->has_splatter = result == PS_OK;
    return result;
}

static ps_result begin_splatting(struct render *render)
{
    ps_result result = render->has_splatter ? PS_OK : create_splatter(render);
    if (result != PS_OK)
        return result;
    uint64_t paths = render->sources.path_count;
    struct splatter_pass pass = {render->pass.number, paths * render->pass.number, paths};
    splatter_begin_pass(&render->splatter, &render->gbuffer, pass);
    render->splatting = true;
    return PS_OK;
}

static ps_result host_splat(const ps_host *host, ps_splat *splats, size_t n)
{
    struct render *render = render_of(host);
    ps_result result = render->splatting ? PS_OK : begin_splatting(render);
    if (result == PS_OK)
        result = splatter_add(&render->splatter, splats, n, &render->error);
    if (result == PS_OK)
        statistics_set_bytes(render->statistics, "splats",
                             (double)splatter_bytes(&render->splatter));
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
        .place_boxes = host_place_boxes,
        .next_sources = host_next_sources,
        .place_splats = host_place_splats,
        .interleave = host_interleave,
        .splat = host_splat,
        .tile = host_tile,
        .pixel = host_pixel,
        .log = host_log,
        .count = host_count,
        .progress = host_progress,
        .cancelled = host_cancelled,
        .camera = host_camera,
    };
    host_add_light_transport(&render->host);
}

void host_report_splatter(struct render *render)
{
    if (!render->has_splatter)
        return;
    struct statistics *statistics = render->statistics;
    const struct splatter *splatter = &render->splatter;
    statistics_add_seconds(statistics, "maps", splatter->map_seconds);
    statistics_add_seconds(statistics, "bin", splatter->bin_seconds);
    statistics_add_seconds(statistics, "splat", splatter->kernel_seconds);
    statistics_add_seconds(statistics, "join", splatter->join_seconds);
    statistics_set_bytes(statistics, "splatted pixels", (double)field_bytes(&splatter->field));
    statistics_count(statistics, "splats", (double)splatter->splats);
    statistics_count(statistics, "map rays", (double)splatter->map_rays);
    statistics_count(statistics, "visibility rays", (double)splatter->exact_tests);
    statistics_count(statistics, "pixel-splat tests", (double)splatter->tests);
    statistics_count(statistics, "pixel-splat tests with weight", (double)splatter->useful_tests);
}
