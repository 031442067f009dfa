#include "photon_map.h"

#include <limits.h>
#include <string.h>

#define LEAF_SIZE 16
struct stored_photon {
    ps_vec3 direction; /* of arrival */
    ps_vec3 normal;    /* of the surface it lies on */
    ps_rgb power;      /* W */
};

void photon_map_release(struct photon_map *map)
{
    const ps_host *host = map->host;
    if (map->index)
        flann_free_index_float(map->index, &map->parameters);
    host->release(host, map->positions);
    host->release(host, map->photons);
    host->release(host, map->indices);
    host->release(host, map->distances);
}

static ps_result map_reserve(struct photon_map *map, size_t more)
{
    const ps_host *host = map->host;
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

static void map_add(struct photon_map *map, ps_vec3 position, ps_vec3 normal, ps_vec3 direction,
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
static void store_arrivals(const ps_pass *pass, const ps_photon *photons, size_t n,
                           struct photon_map *map)
{
    const ps_host *host = map->host;
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
static void store_departures(const ps_photon *photons, size_t n, struct photon_map *map)
{
    for (size_t i = 0; i < n; i++)
        if (photons[i].lobe == PS_DIFFUSE)
            map_add(map, photons[i].position, photons[i].normal, ps_scale(photons[i].normal, -1.0f),
                    photons[i].power);
}

void photon_map_begin(const ps_host *host, struct photon_map *map)
{
    *map = (struct photon_map){.host = host};
}

ps_result photon_map_add(struct photon_map *map, const ps_pass *pass, enum photon_end end,
                         const ps_photon *photons, size_t n)
{
    ps_result result = map_reserve(map, n);
    for (size_t first = 0; result == PS_OK && first < n; first += PS_PATH_CHUNK) {
        size_t count = n - first < PS_PATH_CHUNK ? n - first : PS_PATH_CHUNK;
        if (end == PHOTONS_LEAVE)
            store_departures(photons + first, count, map);
        else
            store_arrivals(pass, photons + first, count, map);
    }
    return result;
}

/* Builds the tree. */
static ps_result build_tree(int64_t neighbours, struct photon_map *map)
{
    if (map->count > INT_MAX)
        return PS_ERROR_INVALID;
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
    size_t wanted = (size_t)neighbours + 1;
    map->neighbours = (int)(wanted < map->count ? wanted : map->count);
    return map->index ? PS_OK : PS_ERROR_MEMORY;
}

static ps_result make_room(uint32_t workers, struct photon_map *map)
{
    const ps_host *host = map->host;
    size_t room = (size_t)workers * PS_TILE_PIXELS * (size_t)map->neighbours;
    map->indices = host->allocate(host, room * sizeof *map->indices, "photon queries");
    map->distances = host->allocate(host, room * sizeof *map->distances, "photon queries");
    return map->indices && map->distances ? PS_OK : PS_ERROR_MEMORY;
}

ps_result photon_map_build(struct photon_map *map, const ps_pass *pass, int64_t neighbours)
{
    map->host->count(map->host, "photons stored", (double)map->count);
    if (map->count < 2)
        return PS_OK;
    ps_result result = build_tree(neighbours, map);
    if (map->index)
        map->host->count(map->host, "photon tree bytes",
                         (double)flann_used_memory_float(map->index));
    return result == PS_OK ? make_room(pass->thread_count, map) : result;
}

ps_result photon_map_create(const ps_host *host, const ps_pass *pass, enum photon_end end,
                            int64_t neighbours, struct photon_map *map)
{
    const ps_photon *photons;
    size_t n = 1;
    double progress;
    ps_result result = PS_OK;
    photon_map_begin(host, map);
    while (result == PS_OK && n > 0) {
        result = host->next_photons(host, &photons, &n, &progress);
        if (result == PS_OK)
            result = photon_map_add(map, pass, end, photons, n);
    }
    if (result == PS_OK && map->count < 2)
        host->log(host, PS_LOG_WARNING, "fewer than two photons: no indirect light");
    return result == PS_OK ? photon_map_build(map, pass, neighbours) : result;
}

ps_vec3 photon_map_position(const struct photon_map *map, size_t i)
{
    const float *at = map->positions + 3 * i;
    return (ps_vec3){at[0], at[1], at[2]};
}

ps_vec3 photon_map_normal(const struct photon_map *map, size_t i)
{
    return map->photons[i].normal;
}

void photon_map_nearest(const struct photon_map *map, ps_vec3 position, int n, int *indices)
{
    struct FLANNParameters parameters = map->parameters;
    float query[3] = {position.x, position.y, position.z}, distances[PS_TILE_PIXELS];
    flann_find_nearest_neighbors_index_float(map->index, query, 1, indices, distances, n,
                                             &parameters);
}

/* Weight at squared relative radius s, and its mean over the disc. */
static float filter_weight(int32_t filter, float s)
{
    switch (filter) {
    case PHOTON_FILTER_CONE:
        return 1.0f - sqrtf(s);
    case PHOTON_FILTER_GAUSSIAN:
        return expf(-2.0f * s);
    default:
        return 1.0f;
    }
}

static float filter_mean(int32_t filter)
{
    switch (filter) {
    case PHOTON_FILTER_CONE:
        return 1.0f / 3.0f;
    case PHOTON_FILTER_GAUSSIAN:
        return 0.5f * (1.0f - expf(-2.0f));
    default:
        return 1.0f;
    }
}

static float radius2_of(const struct photon_map *map, const struct photon_estimate *how,
                        const float *distances)
{
    return ps_min(how->shrink * how->shrink * distances[map->neighbours - 1],
                  how->max_radius * how->max_radius);
}

/* Irradiance at a point from its neighbours in order of distance. */
static ps_rgb estimate(const struct photon_map *map, const struct photon_estimate *how,
                       ps_vec3 position, ps_vec3 normal, const int *indices, const float *distances)
{
    int count = map->neighbours - 1;
    float radius2 = radius2_of(map, how, distances);
    ps_rgb sum = {0, 0, 0};
    float highest = PHOTON_MAP_FLATNESS * sqrtf(radius2);
    for (int i = 0; i < count && distances[i] < radius2; i++) {
        const struct stored_photon *photon = &map->photons[indices[i]];
        const float *at = map->positions + 3 * (size_t)indices[i];
        ps_vec3 offset = {at[0] - position.x, at[1] - position.y, at[2] - position.z};
        float height = fabsf(ps_dot(offset, normal)) / highest;
        int behind = ps_dot(photon->direction, normal) >= 0 || ps_dot(photon->normal, normal) <= 0;
        if (behind || !(height < 1.0f))
            continue;
        /* Up to half of the height they count fully, so that curved surfaces keep their light. */
        float flat = fminf(1.0f, 2.0f * (1.0f - height));
        float weight = flat * filter_weight(how->filter, distances[i] / radius2);
        sum = ps_rgb_add(sum, ps_rgb_scale(photon->power, weight));
    }
    float area = PS_PI * radius2 * filter_mean(how->filter);
    return radius2 > 0.0f ? ps_rgb_scale(sum, 1.0f / area) : (ps_rgb){0, 0, 0};
}

void photon_map_estimate(const struct photon_map *map, const struct photon_estimate *how,
                         uint32_t worker, const ps_vec3 *positions, const ps_vec3 *normals,
                         size_t n, ps_rgb *irradiance, float *radii)
{
    size_t room = (size_t)PS_TILE_PIXELS * (size_t)map->neighbours * worker;
    int *indices = map->indices + room;
    float *distances = map->distances + room;
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
            estimate(map, how, positions[i], normals[i], indices + i * (size_t)map->neighbours,
                     distances + i * (size_t)map->neighbours);
    for (size_t i = 0; i < n && radii; i++)
        radii[i] = sqrtf(radius2_of(map, how, distances + i * (size_t)map->neighbours));
}

struct lighting {
    const struct photon_map *map;
    const struct photon_estimate *how;
};

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    const struct lighting *lighting = user;
    const ps_host *host = lighting->map->host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    ps_points points;
    ps_rgb irradiance[PS_TILE_PIXELS];
    ps_collect_points(tile, &points);
    photon_map_estimate(lighting->map, lighting->how, worker, points.positions, points.normals,
                        points.count, irradiance, NULL);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], irradiance[i]);
}

ps_result photon_map_light_pixels(const struct photon_map *map, const struct photon_estimate *how)
{
    struct lighting lighting = {map, how};
    return map->host->for_each_tile(map->host, light_tile, &lighting);
}
