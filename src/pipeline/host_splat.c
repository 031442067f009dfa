#include "pipeline/host_splat.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "pipeline/near_gather.h"
#include "pipeline/render_state.h"
#include "splat/box.h"
#include "splat/reach.h"
#include "splat/wall.h"
#include <math.h>
#include <psplat/math.h>
#include <string.h>

/* Splats that can light nothing in view are dropped before more is done for them: of a large scene little is in
 * view. Where few are dropped, asking takes longer than what it saves; then one batch in so many is asked. */
#define ASK_EVERY 16
#define ENOUGH_UNSEEN 0.125

/* What lies past the first hit counts, since part of a beam may pass beside it. */
static void drop_unseen(struct render *render, ps_splat *splats, size_t n)
{
    uint64_t unseen = 0;
    for (size_t i = 0; i < n; i++) {
        ps_splat open = splats[i];
        open.far_depth = INFINITY;
        if (splatter_touches(&render->splatter, &open))
            continue;
        splats[i].half_width = 0.0f;
        unseen++;
    }
    atomic_fetch_add(&render->unseen.in_batch, unseen);
}

static void begin_batch(struct render *render)
{
    struct unseen *unseen = &render->unseen;
    unseen->asked = render->splatting && (unseen->many || unseen->batches % ASK_EVERY == 0);
    unseen->batches++;
    atomic_store(&unseen->in_batch, 0);
}

static void end_batch(struct render *render, size_t n)
{
    struct unseen *unseen = &render->unseen;
    if (unseen->asked)
        unseen->many = (double)atomic_load(&unseen->in_batch) > ENOUGH_UNSEEN * (double)n;
}

static struct box_scene box_scene_of(const struct render *render)
{
    float radius = render->scene->radius, spread = render->sources.spread;
    uint64_t paths = render->sources.path_count;
    return (struct box_scene){
        .radius = radius,
        .surface_offset = render->scene->surface_offset,
        .automatic_size = box_automatic_size(radius, spread, paths, render->pass.number),
        .automatic_near = box_automatic_near(radius, spread, paths),
        .seed = render->settings->seed,
        .camera = &render->scene->camera,
        .interleave = render->has_splatter ? render->splatter.settings.interleave : 1,
        .near_distance = render->near_light.distance,
    };
}

/* What places up to PS_PATH_CHUNK boxes. */
struct placing {
    struct render *render;
    struct box_scene scene;
    const ps_box_settings *settings;
    const ps_source *sources;
    size_t n;
    ps_hit *hits;
    float *half_widths; /* 0: no box */
};

static void place(const struct placing *placing, ps_splat *splats)
{
    box_place(&placing->scene, placing->settings, placing->sources, placing->hits,
              placing->half_widths, placing->n, splats);
}

/* The widest that beams may be shows whether they are seen at all. */
static void drop_unseen_full(const struct placing *placing, ps_splat *splats)
{
    ps_hit stand_ins[PS_PATH_CHUNK];
    memcpy(stand_ins, placing->hits, placing->n * sizeof *stand_ins);
    for (size_t i = 0; i < placing->n; i++)
        if (!(placing->hits[i].distance < INFINITY))
            box_stand_in(&placing->sources[i], placing->half_widths[i], &stand_ins[i]);
    box_place(&placing->scene, placing->settings, placing->sources, stand_ins, placing->half_widths,
              placing->n, splats);
    drop_unseen(placing->render, splats, placing->n);
    for (size_t i = 0; i < placing->n; i++)
        placing->half_widths[i] = splats[i].half_width;
}

/* Beams that start at their sources. */
static void place_full(const struct placing *placing, ps_splat *splats)
{
    const ps_host *host = &placing->render->host;
    for (size_t i = 0; i < placing->n; i++)
        placing->half_widths[i] =
            box_widest(&placing->scene, placing->settings, &placing->sources[i]);
    if (placing->render->unseen.asked)
        drop_unseen_full(placing, splats);
    reach_find(host, &placing->scene, placing->settings, placing->sources, placing->n,
               placing->hits, placing->half_widths);
    place(placing, splats);
    if (placing->settings->walls)
        wall_find(host, placing->scene.surface_offset, placing->sources, placing->n, splats);
}

static void place_others(const struct placing *placing, ps_splat *splats)
{
    for (size_t i = 0; i < placing->n; i++)
        placing->half_widths[i] = box_half_width(&placing->scene, placing->settings,
                                                 &placing->sources[i], placing->hits[i].distance);
    place(placing, splats);
    if (placing->render->unseen.asked)
        drop_unseen(placing->render, splats, placing->n);
}

/* At most PS_PATH_CHUNK. */
static void place_some(struct render *render, const ps_box_settings *settings,
                       const ps_source *sources, const ps_hit *hits, size_t n, ps_splat *splats)
{
    ps_hit met[PS_PATH_CHUNK];
    float half_widths[PS_PATH_CHUNK];
    const struct placing placing = {
        render, box_scene_of(render), settings, sources, n, met, half_widths,
    };
    memcpy(met, hits, n * sizeof *hits);
    if (settings->step_back_rule == 1)
        place_full(&placing, splats);
    else
        place_others(&placing, splats);
}

static void host_place_boxes(const ps_host *host, const ps_box_settings *settings,
                             const ps_source *sources, const ps_hit *hits, size_t n,
                             ps_splat *splats)
{
    for (size_t first = 0; first < n; first += PS_PATH_CHUNK) {
        size_t some = n - first < PS_PATH_CHUNK ? n - first : PS_PATH_CHUNK;
        place_some(render_of(host), settings, sources + first, hits + first, some, splats + first);
    }
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
    begin_batch(render);
    parallel_for(render->settings->threads, chunks, place_chunk, &placement);
    end_batch(render, n);
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

static ps_result create_splatter(struct render *render, uint32_t interleave)
{
    const struct strategy *visibility = &render->settings->strategies[PS_VISIBILITY];
    struct splatter_settings settings = {
        .host = &render->host,
        .visibility = visibility->descriptor->vtable,
        .visibility_state = visibility->state,
        .surface_offset = render->scene->surface_offset,
        .kernel = render->kernel,
        .interleave = render->counts_splats ? 1 : interleave,
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

/* Interleaving pays where n pixels are little beside a splat; in small pictures, or small parts of them, it
 * blurs edges and adds noise, and splats shrink as paths become more. (Under the lamp, 1600x900, 6.4 million
 * paths have 2.1 % of error with 8, and 1.7 % with 4, in the same time; 400,000 take a third less time
 * with 8.) Subsets by powers of two share out paths most evenly. */
#define SIDE_PER_STEP 150.0 /* pixels of the picture's side for each step of n */
#define MANY_PATHS 3000000
#define MOST_FOR_MANY 4

static uint32_t automatic_interleave(const struct render *render, uint32_t most)
{
    double side = PS_TILE_SIZE * sqrt((double)render->gbuffer.tile_count);
    uint32_t n = 1;
    while (2 * n <= most && 2 * n * SIDE_PER_STEP <= side)
        n *= 2;
    return n;
}

static uint32_t interleave_of(const struct render *render, uint32_t n, uint32_t most)
{
    if (n == 0)
        return automatic_interleave(render, most);
    return n < PS_MOST_INTERLEAVE ? n : PS_MOST_INTERLEAVE;
}

/* Near light stays as noisy when splats become small, and is averaged as widely. */
static ps_result begin_interleaved(struct render *render, uint32_t n)
{
    bool many = render->sources.path_count > MANY_PATHS;
    uint32_t most = many ? MOST_FOR_MANY : PS_MOST_INTERLEAVE;
    render->near_interleave = interleave_of(render, n, PS_MOST_INTERLEAVE);
    return create_splatter(render, interleave_of(render, n, most));
}

static ps_result host_begin_splats(const ps_host *host, uint32_t n)
{
    struct render *render = render_of(host);
    ps_result result = source_stream_prepare(&render->sources, &render->error);
    if (result == PS_OK && !render->has_splatter)
        result = begin_interleaved(render, n);
    if (result != PS_OK)
        return result;
    struct splatter_pass pass = {render->pass.number, render->sources.path_count};
    splatter_begin_pass(&render->splatter, &render->gbuffer, pass);
    render->near_light.distance = 0.0f;
    render->unseen.many = false;
    render->unseen.batches = 0;
    render->splatting = true;
    return PS_OK;
}

static ps_result host_splat(const ps_host *host, ps_splat *splats, size_t n)
{
    struct render *render = render_of(host);
    if (!render->splatting)
        return error_set(&render->error, PS_ERROR_INVALID, "splat was called before begin_splats");
    ps_result result = splatter_add(&render->splatter, splats, n, &render->error);
    if (result == PS_OK)
        statistics_set_bytes(render->statistics, "splats",
                             (double)splatter_bytes(&render->splatter));
    return result;
}

static float near_distance(const struct render *render)
{
    const struct strategy *visibility = &render->settings->strategies[PS_VISIBILITY];
    const ps_visibility_vtable *vtable = visibility->descriptor->vtable;
    if (!vtable->boxes)
        return 0.0f;
    ps_box_settings settings = vtable->boxes(visibility->state);
    struct box_scene scene = box_scene_of(render);
    return box_near_distance(&scene, &settings, render->sources.path_count);
}

static ps_result host_gather_near_light(const ps_host *host, double rays)
{
    struct render *render = render_of(host);
    struct near_light *near = &render->near_light;
    float distance = near_distance(render);
    if (!(distance > 0.0f))
        return PS_OK;
    double start = clock_seconds();
    statistics_set_bytes(render->statistics, "near light",
                         (double)near_light_bytes(&render->gbuffer));
    ps_result result = near_light_begin(near, &render->gbuffer, distance, render->near_interleave,
                                        render->settings->threads, &render->error);
    if (result == PS_OK)
        result = near_gather(host, &render->pass, near,
                             rays > 0.0 ? rays : near_light_rays(render->sources.path_count));
    statistics_add_seconds(render->statistics, "near", clock_seconds() - start);
    return result;
}

void host_add_splatting(ps_host *host)
{
    host->place_boxes = host_place_boxes;
    host->place_splats = host_place_splats;
    host->begin_splats = host_begin_splats;
    host->splat = host_splat;
    host->gather_near_light = host_gather_near_light;
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
