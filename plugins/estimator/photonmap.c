/* photonmap.c: photon mapping, the reference of the thesis (Hoet 2014, section 4.5).
 *
 * Jensen 1996. Every photon is traced to the surface it lights and stored there; at
 * each pixel the k nearest photons estimate the irradiance, with r the distance of the k-th:
 *
 *     E(p) = sum over photons nearer than r of Phi * w(d / r) / (pi r^2 W)
 *     W    = 2 * integral of w(s) s ds over 0..1
 *
 * No cosine: the photons' density in the surface already falls with the slope of the light, unlike
 * a splat's kernel, which lies across the bundle. The k-th photon sets r and is not counted itself,
 * or the estimate would be k / (k - 1) too large. Neighbourhoods are discs: photons off the tangent
 * plane weigh less, and those that arrive from behind the surface nothing.
 *
 * With `gather`, photons stay where they leave a surface, with the power that leaves the surface, and
 * the estimate is looked up where cosine-distributed rays from the pixel land (final gather), after
 * mirrors, gloss and glass on their way.
 *
 * FLANN's single kd-tree is exact and deterministic; its default parameters are neither. Its
 * searches only read the index, and the one global that a call touches is the log level, always
 * with the same value, so tiles are searched on all threads at once.
 */
#include <psplat/plugin.h>

#include <flann/flann.h>
#include <limits.h>
#include <string.h>

#define LEAF_SIZE 16
/* Photons higher above the tangent plane than this times r do not count; up to half of it they
 * count fully, so that curved surfaces keep their light. */
#define FLATNESS 0.25f

/* Sets of the random numbers that choose points on lights; directions take 0, 1, 2, ... */
#define LIGHT_SETS 0x10000u

enum filter { FILTER_BOX, FILTER_CONE, FILTER_GAUSSIAN };
static const char *const filter_choices[] = {"box", "cone", "gaussian", NULL};
static const char *const radius_choices[] = {"none", NULL};

struct state {
    int64_t neighbours;
    ps_number_or_choice max_radius;
    int32_t filter;
    int64_t gather;
};

struct stored_photon {
    ps_vec3 direction; /* of arrival */
    ps_vec3 normal;    /* of the surface it lies on */
    ps_rgb power;      /* W */
};

struct map {
    float *positions; /* three for each photon: what FLANN searches */
    struct stored_photon *photons;
    size_t count, capacity;
    flann_index_t index;
    struct FLANNParameters parameters;
    int neighbours; /* at most count */
};

struct work {
    const struct state *state;
    const ps_host *host;
    const ps_pass *pass;
    const struct map *map;
    int *indices;     /* neighbours of a tile's points, for each worker */
    float *distances; /* squared */
};

static void map_release(const ps_host *host, struct map *map)
{
    if (map->index)
        flann_free_index_float(map->index, &map->parameters);
    host->release(host, map->positions);
    host->release(host, map->photons);
}

static ps_result map_reserve(const ps_host *host, struct map *map, size_t more)
{
    if (map->count + more <= map->capacity)
        return PS_OK;
    size_t capacity = 2 * map->capacity + more;
    float *positions = host->allocate(host, capacity * 3 * sizeof *positions, "photon map");
    struct stored_photon *photons = host->allocate(host, capacity * sizeof *photons, "photon map");
    if (!positions || !photons) {
        host->release(host, positions);
        host->release(host, photons);
        return PS_ERROR_MEMORY;
    }
    if (map->count) {
        memcpy(positions, map->positions, map->count * 3 * sizeof *positions);
        memcpy(photons, map->photons, map->count * sizeof *photons);
    }
    host->release(host, map->positions);
    host->release(host, map->photons);
    map->positions = positions;
    map->photons = photons;
    map->capacity = capacity;
    return PS_OK;
}

static void map_add(struct map *map, ps_vec3 position, ps_vec3 normal, ps_vec3 direction,
                    ps_rgb power)
{
    float *to = map->positions + 3 * map->count;
    to[0] = position.x;
    to[1] = position.y;
    to[2] = position.z;
    map->photons[map->count++] = (struct stored_photon){direction, normal, power};
}

/* The photons' density in a surface falls with the slope to the surface itself; irradiance is meant
 * for the smoothed or bent normal. */
static float shading_factor(const ps_ray *ray, const ps_hit *hit)
{
    if (ps_same(hit->normal, hit->geometric_normal))
        return 1.0f;
    float cosine = -ps_dot(ray->direction, hit->geometric_normal);
    return fmaxf(0.0f, -ps_dot(ray->direction, hit->normal)) / fmaxf(cosine, 1e-4f);
}

/* Where the light of photons arrives. */
static void store_arrivals(const ps_host *host, const ps_pass *pass, const ps_photon *photons,
                           size_t n, struct map *map)
{
    ps_ray rays[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    for (size_t i = 0; i < n; i++)
        rays[i] = ps_leave_surface(photons[i].position, photons[i].normal, photons[i].direction,
                                   pass->surface_offset);
    host->intersect(host, rays, n, hits);
    for (size_t i = 0; i < n; i++)
        if (hits[i].distance < INFINITY)
            map_add(map, hits[i].position, hits[i].geometric_normal, photons[i].direction,
                    ps_rgb_scale(photons[i].power, shading_factor(&rays[i], &hits[i])));
}

/* Where it leaves diffuse surfaces: the direction does not matter then. */
static void store_departures(const ps_photon *photons, size_t n, struct map *map)
{
    for (size_t i = 0; i < n; i++)
        if (photons[i].lobe == PS_DIFFUSE)
            map_add(map, photons[i].position, photons[i].normal, ps_scale(photons[i].normal, -1.0f),
                    photons[i].power);
}

static ps_result store_photons(const struct state *state, const ps_host *host, const ps_pass *pass,
                               struct map *map)
{
    const ps_photon *photons;
    size_t n;
    double progress;
    ps_result result;
    do {
        result = host->next_photons(host, &photons, &n, &progress);
        if (result == PS_OK)
            result = map_reserve(host, map, n);
        for (size_t first = 0; result == PS_OK && first < n; first += PS_PATH_CHUNK) {
            size_t count = n - first < PS_PATH_CHUNK ? n - first : PS_PATH_CHUNK;
            if (state->gather)
                store_departures(photons + first, count, map);
            else
                store_arrivals(host, pass, photons + first, count, map);
        }
    } while (result == PS_OK && n > 0);
    return result;
}

/* Builds the tree; a map of no photons has none. */
static ps_result map_build(const struct state *state, struct map *map)
{
    if (map->count == 0 || map->count > INT_MAX)
        return map->count ? PS_ERROR_INVALID : PS_OK;
    map->parameters = DEFAULT_FLANN_PARAMETERS;
    map->parameters.algorithm = FLANN_INDEX_KDTREE_SINGLE;
    map->parameters.leaf_max_size = LEAF_SIZE;
    map->parameters.checks = -1; /* exact */
    map->parameters.sorted = 1;
    map->parameters.cores = 1;
    map->parameters.random_seed = 0;
    float speedup;
    map->index =
        flann_build_index_float(map->positions, (int)map->count, 3, &speedup, &map->parameters);
    /* One more than counts: the farthest sets the radius. Asking for more than there are leaves
     * rubbish. */
    size_t wanted = (size_t)state->neighbours + 1;
    map->neighbours = (int)(wanted < map->count ? wanted : map->count);
    return map->index ? PS_OK : PS_ERROR_MEMORY;
}

/* Weight at squared relative radius s, and its mean over the disc. */
static float filter_weight(int32_t filter, float s)
{
    switch (filter) {
    case FILTER_CONE:
        return 1.0f - sqrtf(s);
    case FILTER_GAUSSIAN:
        return expf(-2.0f * s);
    default:
        return 1.0f;
    }
}

static float filter_mean(int32_t filter)
{
    switch (filter) {
    case FILTER_CONE:
        return 1.0f / 3.0f;
    case FILTER_GAUSSIAN:
        return 0.5f * (1.0f - expf(-2.0f));
    default:
        return 1.0f;
    }
}

/* Irradiance at a point from its neighbours in order of distance. */
static ps_rgb estimate(const struct work *work, ps_vec3 position, ps_vec3 normal,
                       const int *indices, const float *distances)
{
    const struct state *state = work->state;
    const struct map *map = work->map;
    int count = map->neighbours - 1;
    float radius2 = distances[count];
    if (state->max_radius.choice < 0) {
        float limit2 = (float)(state->max_radius.number * state->max_radius.number);
        if (radius2 > limit2)
            radius2 = limit2;
    }
    ps_rgb sum = {0, 0, 0};
    float highest = FLATNESS * sqrtf(radius2);
    for (int i = 0; i < count && distances[i] < radius2; i++) {
        const struct stored_photon *photon = &map->photons[indices[i]];
        const float *at = map->positions + 3 * (size_t)indices[i];
        ps_vec3 offset = {at[0] - position.x, at[1] - position.y, at[2] - position.z};
        float height = fabsf(ps_dot(offset, normal)) / highest;
        int behind = ps_dot(photon->direction, normal) >= 0 || ps_dot(photon->normal, normal) <= 0;
        if (behind || !(height < 1.0f))
            continue;
        float flat = fminf(1.0f, 2.0f * (1.0f - height));
        float weight = flat * filter_weight(state->filter, distances[i] / radius2);
        sum = ps_rgb_add(sum, ps_rgb_scale(photon->power, weight));
    }
    float area = PS_PI * radius2 * filter_mean(state->filter);
    return radius2 > 0.0f ? ps_rgb_scale(sum, 1.0f / area) : (ps_rgb){0, 0, 0};
}

/* Irradiance at up to PS_TILE_PIXELS points. */
static void estimate_points(const struct work *work, uint32_t worker, const ps_vec3 *positions,
                            const ps_vec3 *normals, size_t n, ps_rgb *irradiance)
{
    const struct map *map = work->map;
    size_t room = (size_t)PS_TILE_PIXELS * (size_t)map->neighbours * worker;
    int *indices = work->indices + room;
    float *distances = work->distances + room;
    float queries[3 * PS_TILE_PIXELS];
    for (size_t i = 0; i < n; i++) {
        queries[3 * i] = positions[i].x;
        queries[3 * i + 1] = positions[i].y;
        queries[3 * i + 2] = positions[i].z;
    }
    struct FLANNParameters parameters = map->parameters;
    if (n > 0)
        flann_find_nearest_neighbors_index_float(map->index, queries, (int)n, indices, distances,
                                                 map->neighbours, &parameters);
    for (size_t i = 0; i < n; i++)
        irradiance[i] =
            estimate(work, positions[i], normals[i], indices + i * (size_t)map->neighbours,
                     distances + i * (size_t)map->neighbours);
}

static void estimate_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct work *work = user;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    ps_rgb irradiance[PS_TILE_PIXELS];
    ps_collect_points(tile, &points);
    estimate_points(work, worker, points.positions, points.normals, points.count, irradiance);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], irradiance[i]);
}

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
    for (size_t i = 0; i < met; i++)
        g->hits[i].albedo = (ps_rgb){0, 0, 0};
    host->direct_radiance(host, g->rays, g->hits, PS_STREAM_PATH, LIGHT_SETS + chain, g->samples,
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
    estimate_points(work, worker, positions, normals, ended, exitance);
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

static ps_result search(const struct state *state, const ps_host *host, const ps_pass *pass,
                        const struct map *map)
{
    size_t room = (size_t)pass->thread_count * PS_TILE_PIXELS * (size_t)map->neighbours;
    struct work work = {state,
                        host,
                        pass,
                        map,
                        host->allocate(host, room * sizeof(int), "photon queries"),
                        host->allocate(host, room * sizeof(float), "photon queries")};
    ps_result result = PS_ERROR_MEMORY;
    if (work.indices && work.distances)
        result = host->for_each_tile(host, state->gather ? gather_tile : estimate_tile, &work);
    host->release(host, work.indices);
    host->release(host, work.distances);
    return result;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct map map = {.count = 0};
    ps_result result = store_photons(state, host, pass, &map);
    if (result == PS_OK)
        result = map_build(state, &map);
    if (map.index)
        host->count(host, "photon tree bytes", (double)flann_used_memory_float(map.index));
    host->count(host, "photons stored", (double)map.count);
    /* One photon can't tell a density. */
    if (result == PS_OK && map.count < 2)
        host->log(host, PS_LOG_WARNING, "fewer than two photons: no indirect light");
    if (result == PS_OK && map.count > 1)
        result = search(state, host, pass, &map);
    map_release(host, &map);
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

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

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
