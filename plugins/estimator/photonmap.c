/* photonmap.c: photon mapping, the reference of the thesis (Hoet 2014, section 4.5).
 *
 * Jensen 1996. Every photon is traced to the surface it lights and stored there; at
 * each pixel the nearest photons estimate the irradiance (photon_map.h).
 *
 * With `gather`, photons stay where they leave a surface, with the power that leaves the surface,
 * and the estimate is looked up where cosine-distributed rays from the pixel land (final gather),
 * after mirrors, gloss and glass on their way.
 */
#include "shared/photon_map.h"

/* Sets of the random numbers that choose points on lights; directions take 0, 1, 2, ... */
#define LIGHT_SETS 0x10000u

static const char *const filter_choices[] = {"box", "cone", "gaussian", NULL};
static const char *const radius_choices[] = {"none", NULL};

struct state {
    int64_t neighbours;
    ps_number_or_choice max_radius;
    int32_t filter;
    int64_t gather;
};

struct work {
    const struct state *state;
    const ps_host *host;
    const ps_pass *pass;
    struct photon_map map;
    struct photon_estimate how;
};

/* Rays of the final gather that are still under way, and where they have come. */
struct gathering {
    size_t count;
    uint64_t samples[PS_TILE_PIXELS];
    uint32_t targets[PS_TILE_PIXELS]; /* point that each belongs to */
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    ps_rgb throughput[PS_TILE_PIXELS];
    float pdfs[PS_TILE_PIXELS];
    float numbers[PS_TILE_PIXELS][4];
};

static void start_gathering(const struct work *work, const ps_points *points,
                            const uint64_t *samples, struct gathering *g)
{
    g->count = points->count;
    for (size_t i = 0; i < points->count; i++) {
        g->samples[i] = samples[i];
        g->targets[i] = (uint32_t)i;
        g->throughput[i] = (ps_rgb){1, 1, 1};
        g->pdfs[i] = 0.0f;
    }
    work->host->samples(work->host, PS_STREAM_PATH, 0, samples, points->count, g->numbers);
    for (size_t i = 0; i < points->count; i++) {
        ps_vec3 n = points->normals[i];
        ps_vec3 direction = ps_cosine_direction(n, g->numbers[i][0], g->numbers[i][1]);
        g->rays[i] =
            ps_leave_surface(points->positions[i], n, direction, work->pass->surface_offset);
    }
}

/* Adds pi times the radiance that mirrors, glass and gloss on the way show of the lights. */
static void add_lights(const struct work *work, uint32_t chain, struct gathering *g, ps_rgb *sums)
{
    ps_rgb emitted[PS_TILE_PIXELS], gloss[PS_TILE_PIXELS];
    ps_hit glossy[PS_TILE_PIXELS];
    const ps_host *host = work->host;
    size_t met = 0;
    host->emitted_radiance(host, g->rays, g->hits, g->pdfs, g->count, emitted);
    for (size_t i = 0; i < g->count; i++) {
        ps_rgb *sum = &sums[g->targets[i]];
        if (chain > 0) /* from a point itself it is direct light */
            *sum = ps_rgb_add(*sum,
                              ps_rgb_scale(ps_rgb_multiply(g->throughput[i], emitted[i]), PS_PI));
        if (!(g->hits[i].distance < INFINITY))
            continue;
        g->samples[met] = g->samples[i];
        g->targets[met] = g->targets[i];
        g->rays[met] = g->rays[i];
        g->hits[met] = g->hits[i];
        g->throughput[met++] = g->throughput[i];
    }
    g->count = met;
    if (!work->pass->specular)
        return;
    for (size_t i = 0; i < met; i++) {
        glossy[i] = g->hits[i];
        glossy[i].albedo = (ps_rgb){0, 0, 0};
    }
    host->direct_radiance(host, g->rays, glossy, PS_STREAM_PATH, LIGHT_SETS + chain, g->samples,
                          met, gloss);
    for (size_t i = 0; i < met; i++)
        sums[g->targets[i]] = ps_rgb_add(
            sums[g->targets[i]], ps_rgb_scale(ps_rgb_multiply(g->throughput[i], gloss[i]), PS_PI));
}

/* Sends rays on over mirrors, gloss and glass; those that end at a diffuse lobe take the exitance
 * (W/m^2) there. */
static void look_up_or_go_on(const struct work *work, uint32_t worker, uint32_t chain,
                             struct gathering *g, ps_rgb *sums)
{
    ps_bsdf_sample scattered[PS_TILE_PIXELS];
    ps_vec3 positions[PS_TILE_PIXELS], normals[PS_TILE_PIXELS];
    ps_rgb exitance[PS_TILE_PIXELS], share[PS_TILE_PIXELS];
    size_t targets[PS_TILE_PIXELS], ended = 0, left = 0;
    const ps_host *host = work->host;
    host->samples(host, PS_STREAM_PATH, chain + 1, g->samples, g->count, g->numbers);
    host->sample_bsdf(host, PS_FROM_CAMERA, g->rays, g->hits, (const float(*)[4])g->numbers,
                      g->count, scattered);
    for (size_t i = 0; i < g->count; i++) {
        const ps_bsdf_sample *on = &scattered[i];
        if (!(ps_rgb_maximum(on->weight) > 0.0f))
            continue;
        if (on->lobe == PS_DIFFUSE) {
            positions[ended] = g->hits[i].position;
            normals[ended] = g->hits[i].normal;
            share[ended] = ps_rgb_scale(g->throughput[i], 1.0f / on->probability);
            targets[ended++] = g->targets[i];
            continue;
        }
        g->rays[left] = ps_leave_surface(g->hits[i].position, on->normal, on->direction,
                                         work->pass->surface_offset);
        g->samples[left] = g->samples[i];
        g->targets[left] = g->targets[i];
        g->throughput[left] = ps_rgb_multiply(g->throughput[i], on->weight);
        g->pdfs[left++] = on->pdf;
    }
    g->count = left;
    photon_map_estimate(&work->map, &work->how, worker, positions, normals, ended, exitance, NULL);
    for (size_t i = 0; i < ended; i++)
        sums[targets[i]] = ps_rgb_add(sums[targets[i]], ps_rgb_multiply(share[i], exitance[i]));
}

/* One ray of the final gather from each point. */
static void gather_once(const struct work *work, uint32_t worker, const ps_points *points,
                        const uint64_t *samples, ps_rgb *sums)
{
    struct gathering g;
    start_gathering(work, points, samples, &g);
    for (uint32_t chain = 0; g.count > 0 && chain <= PS_LONGEST_CHAIN; chain++) {
        work->host->intersect(work->host, g.rays, g.count, g.hits);
        if (chain == 0)
            ps_forget_own_surface(points, g.targets, g.count, work->pass->surface_offset, g.hits);
        add_lights(work, chain, &g, sums);
        look_up_or_go_on(work, worker, chain, &g, sums);
    }
}

static void gather_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct work *work = user;
    int64_t rays = work->state->gather;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    uint64_t samples[PS_TILE_PIXELS] = {0};
    ps_rgb sums[PS_TILE_PIXELS] = {{0, 0, 0}};
    ps_collect_points(tile, &points);
    for (int64_t ray = 0; ray < rays; ray++) {
        uint64_t sample = (uint64_t)work->pass->number * (uint64_t)rays + (uint64_t)ray;
        for (size_t i = 0; i < points.count; i++)
            samples[i] = ps_sample_block(index, points.lanes[i]) + sample;
        gather_once(work, worker, &points, samples, sums);
    }
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], ps_rgb_scale(sums[i], 1.0f / (float)rays));
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {
        .state = state,
        .host = host,
        .pass = pass,
        .how = {.filter = state->filter,
                .max_radius =
                    state->max_radius.choice < 0 ? (float)state->max_radius.number : INFINITY,
                .shrink = 1.0f},
    };
    enum photon_end end = state->gather ? PHOTONS_LEAVE : PHOTONS_ARRIVE;
    ps_result result = photon_map_create(host, pass, end, state->neighbours, &work.map);
    if (result == PS_OK && work.map.index)
        result = state->gather ? host->for_each_tile(host, gather_tile, &work)
                               : photon_map_light_pixels(&work.map, &work.how);
    photon_map_release(&work.map);
    return result;
}

static const ps_param params[] = {
    PS_INT(struct state, neighbours, "100", 1, 100000, "photons",
           "photons that an estimate is made of"),
    PS_NUMBER_OR(struct state, max_radius, "none", 0, INFINITY, PS_PARAM_OPEN_MIN, radius_choices,
                 "scene units", "photons farther away than this do not count"),
    PS_CHOICE(struct state, filter, "cone", filter_choices, "radial weight of the photons"),
    PS_INT(struct state, gather, "0", 0, 1 << 20, "rays",
           "rays of the final gather for each pixel and pass; 0: look up at the pixel itself"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "photonmap",
    .version = "1.0",
    .summary = "photon mapping with exact nearest neighbours: the reference of the thesis",
    .paper = "Jensen 1996, Global illumination using photon maps; Muja and Lowe 2009 (FLANN)",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, photonmap, &descriptor)
