/* bdpt.c: bidirectional path tracing: paths from the pixels and from the lights, connected with
 * each other.
 *
 * Lafortune and Willems 1993; Veach 1997, chapter 10. Each sample of a pixel has a path from the
 * pixel's point and one from a light. The same light can be found by the first alone, by the second
 * alone, which then is connected to the camera (light tracing), and by each way to connect one's
 * surfaces with the other's. Multiple importance sampling weighs them all (bdpt/subpath.h), so that
 * each part of the light comes from what finds it best: caustics by light tracing, light around
 * corners by connections, what mirrors show by paths from the pixels.
 *
 * Weighed sums without bias are noisier than a cached gather where light is smooth, but hold where
 * its way is hard to find from one end. Light tracing arrives all over the picture: tiles go in
 * batches, whose splats are added in the order of the tiles, so that sums do not depend on threads.
 */
#include "bdpt/camera.h"
#include "bdpt/eye_paths.h"
#include "bdpt/light_paths.h"

/* Tiles, and samples of them, between two times that splats are added. */
#define TILE_BATCH 64u
#define SAMPLE_BATCH 4u

struct state {
    int64_t samples;
    int64_t roulette;
    int32_t strategies;
};

/* A batch of tiles under way. */
struct work {
    struct bdpt bdpt;
    uint64_t samples;                /* for each pixel */
    uint64_t first_sample, end;      /* of the batch */
    uint32_t first_tile;             /* of the batch */
    struct light_vertices *vertices; /* of each worker, owned */
    struct splat_list splats[TILE_BATCH];
    uint8_t failed[TILE_BATCH]; /* out of memory */
};

static void find_sights(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    camera_find_sights(&work->bdpt, (uint32_t)index);
}

static void find_shares(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    camera_find_shares(&work->bdpt, (uint32_t)index);
}

/* One sample of each of the tile's pixels; false when out of memory. */
static int trace_sample(struct work *work, uint32_t tile, const ps_points *points,
                        const uint64_t *samples, struct light_vertices *vertices,
                        struct splat_list *splats, struct tile_sums *sums)
{
    const struct bdpt *bdpt = &work->bdpt;
    const struct sight *sights = &bdpt->sights[(size_t)tile * PS_TILE_PIXELS];
    float scale = 1.0f / (float)work->samples;
    if (bdpt->strategies != STRATEGIES_CAMERA &&
        !light_paths_trace(bdpt, tile, samples, scale, vertices, splats))
        return 0;
    if (bdpt->strategies != STRATEGIES_LIGHT)
        eye_paths_trace(bdpt, points, sights, samples, vertices, sums);
    return 1;
}

static void trace_tile(void *user, uint64_t index, uint32_t worker)
{
    struct work *work = user;
    uint32_t tile_index = work->first_tile + (uint32_t)index;
    ps_tile *tile = work->bdpt.host->tile(work->bdpt.host, tile_index);
    uint64_t samples[PS_TILE_PIXELS];
    struct tile_sums sums = {.samples = 0};
    ps_points points;
    ps_collect_points(tile, &points);
    for (uint64_t i = work->first_sample; i < work->end; i++) {
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
            samples[lane] =
                ps_tile_sample(tile_index, lane, work->bdpt.pass->number, work->samples) + i;
        if (!trace_sample(work, tile_index, &points, samples, &work->vertices[worker],
                          &work->splats[index], &sums))
            work->failed[index] = 1;
        sums.samples++;
    }
    for (size_t i = 0; i < points.count; i++) {
        uint32_t lane = points.lanes[i];
        ps_add_irradiance(tile, lane, ps_rgb_scale(sums.lanes[lane], 1.0f / (float)work->samples));
        tile->weight[lane] = 1.0f;
    }
}

/* Adds the splats of a list to the pixels that see their points directly. Where a pixel's own point
 * is behind a mirror or glass, by chance or at an edge, nothing is added: the pixel's throughput,
 * by which its light is multiplied, makes up for what chance leaves out. */
static void add_splats(const struct work *work, struct splat_list *splats)
{
    const struct bdpt *bdpt = &work->bdpt;
    for (size_t i = 0; i < splats->count; i++) {
        const struct splat *splat = &splats->items[i];
        ps_tile *tile = bdpt->host->tile(bdpt->host, splat->tile);
        uint32_t lane = splat->lane;
        float share = bdpt->sights[(size_t)splat->tile * PS_TILE_PIXELS + lane].share;
        if (!(share > 0.0f))
            continue;
        tile->radiance_r[lane] += splat->radiance.r / share;
        tile->radiance_g[lane] += splat->radiance.g / share;
        tile->radiance_b[lane] += splat->radiance.b / share;
    }
    splats->count = 0;
}

/* All samples of a batch of `count` tiles. */
static ps_result trace_batch(struct work *work, uint32_t count)
{
    const ps_host *host = work->bdpt.host;
    for (work->first_sample = 0; work->first_sample < work->samples;
         work->first_sample = work->end) {
        uint64_t left = work->samples - work->first_sample;
        work->end = work->first_sample + (left < SAMPLE_BATCH ? left : SAMPLE_BATCH);
        if (host->cancelled(host))
            return PS_CANCELLED;
        host->parallel_for(host, count, trace_tile, work);
        for (uint32_t i = 0; i < count; i++) {
            if (work->failed[i])
                return PS_ERROR_MEMORY;
            add_splats(work, &work->splats[i]);
        }
    }
    return PS_OK;
}

static ps_result trace_all(struct work *work)
{
    const ps_host *host = work->bdpt.host;
    uint32_t tiles = work->bdpt.pass->tile_count;
    ps_result result = PS_OK;
    host->parallel_for(host, tiles, find_sights, work);
    camera_find_jitter(&work->bdpt);
    host->parallel_for(host, tiles, find_shares, work);
    for (uint32_t first = 0; first < tiles && result == PS_OK; first += TILE_BATCH) {
        uint32_t count = tiles - first < TILE_BATCH ? tiles - first : TILE_BATCH;
        work->first_tile = first;
        result = trace_batch(work, count);
        host->progress(host, (double)(first + count) / (double)tiles);
    }
    return result;
}

static int allocate(struct work *work)
{
    struct bdpt *bdpt = &work->bdpt;
    const ps_pass *pass = bdpt->pass;
    size_t pixels = (size_t)pass->tile_count * PS_TILE_PIXELS;
    bdpt->sights =
        bdpt->host->allocate(bdpt->host, pixels * sizeof *bdpt->sights, "bidirectional paths");
    work->vertices = bdpt->host->allocate(bdpt->host, pass->thread_count * sizeof *work->vertices,
                                          "bidirectional paths");
    for (uint32_t i = 0; work->vertices && i < pass->thread_count; i++)
        work->vertices[i] = (struct light_vertices){.count = 0};
    return bdpt->sights && work->vertices;
}

static void release(struct work *work)
{
    const ps_host *host = work->bdpt.host;
    for (uint32_t i = 0; i < TILE_BATCH; i++)
        splat_list_release(host, &work->splats[i]);
    for (uint32_t i = 0; work->vertices && i < work->bdpt.pass->thread_count; i++)
        light_vertices_release(host, &work->vertices[i]);
    host->release(host, work->vertices);
    host->release(host, work->bdpt.sights);
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {
        .bdpt = {.host = host,
                 .pass = pass,
                 .roulette = (uint32_t)state->roulette,
                 .strategies = state->strategies,
                 .light_paths = (float)pass->width * (float)pass->height,
                 .camera = {.size = sizeof(ps_camera)}},
        .samples = (uint64_t)state->samples,
    };
    ps_vec3 center;
    float radius;
    host->camera(host, &work.bdpt.camera);
    host->scene_bounds(host, &center, &radius);
    work.bdpt.area = radius * radius;
    ps_result result = allocate(&work) ? trace_all(&work) : PS_ERROR_MEMORY;
    release(&work);
    return result;
}

static const char *const strategies_choices[] = {"all", "camera", "light", NULL};

static const ps_param params[] = {
    PS_ROW(struct state, samples, PS_PARAM_INT, "16", 1, 1 << 20, PS_PARAM_QUALITY, NULL, "paths",
           "paths from each pixel, and from the lights for each pixel, a pass; powers of two are "
           "best"),
    PS_ROW(struct state, roulette, PS_PARAM_INT, "3", 1, 1000, PS_PARAM_EXPERT, NULL, "bounces",
           "bounce from which on Russian roulette may end a path"),
    PS_ROW(struct state, strategies, PS_PARAM_CHOICE, "all", 0, 0, PS_PARAM_EXPERT,
           strategies_choices, "",
           "all: paths from both ends, connected; camera: from the camera alone; light: light "
           "tracing alone, which misses what mirrors, glass and a lens show"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_RADIANCE,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "bdpt",
    .version = "1.0",
    .summary = "bidirectional path tracing: paths from pixels and lights, weighed together",
    .paper = "Lafortune and Willems 1993, Bi-directional path tracing; Veach 1997, Robust Monte "
             "Carlo methods for light transport simulation",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, bdpt, &descriptor)
