#include "light_paths.h"

#include "camera.h"
#include <string.h>

/* Sets of PS_STREAM_ESTIMATOR: that of the start; scatterings take 1, 2, 3, ... */
#define START_SET 0u

/* --- lists that grow --- */

/* Moves an array to a larger place; false when out of memory, which leaves it as it is. */
static int enlarge(const ps_host *host, void **array, size_t count, size_t room, size_t size)
{
    void *larger = host->allocate(host, room * size, "bidirectional paths");
    if (!larger)
        return 0;
    if (count > 0)
        memcpy(larger, *array, count * size);
    host->release(host, *array);
    *array = larger;
    return 1;
}

static int make_room_for_splats(const ps_host *host, struct splat_list *splats, size_t more)
{
    size_t room = 2 * (splats->count + more);
    if (splats->count + more <= splats->room)
        return 1;
    void *items = splats->items;
    int grown = enlarge(host, &items, splats->count, room, sizeof *splats->items);
    splats->items = items;
    splats->room = grown ? room : splats->room;
    return grown;
}

static int make_room_for_vertices(const ps_host *host, struct light_vertices *vertices, size_t more)
{
    size_t room = 2 * (vertices->count + more);
    if (vertices->count + more <= vertices->room)
        return 1;
    void *items = vertices->items, *next = vertices->next;
    int grown = enlarge(host, &items, vertices->count, room, sizeof *vertices->items);
    vertices->items = items;
    grown = grown && enlarge(host, &next, vertices->count, room, sizeof *vertices->next);
    vertices->next = next;
    vertices->room = grown ? room : vertices->room;
    return grown;
}

void light_vertices_release(const ps_host *host, struct light_vertices *vertices)
{
    host->release(host, vertices->next);
    host->release(host, vertices->items);
    *vertices = (struct light_vertices){.count = 0};
}

void splat_list_release(const ps_host *host, struct splat_list *splats)
{
    host->release(host, splats->items);
    *splats = (struct splat_list){.count = 0};
}

/* --- the paths --- */

/* Partial weights where a light's rays are met. `points`: where each starts. */
static void arrive_from_lights(const struct bdpt *bdpt, ps_light_sample *points, struct walk *walk)
{
    ps_vec3 places[PS_TILE_PIXELS];
    ps_light_density densities[PS_TILE_PIXELS];
    for (size_t i = 0; i < walk->count; i++) {
        places[i] = bdpt_origin(bdpt, &walk->hits[i]); /* as from the other side: off the surface */
        points[i].direction = ps_scale(walk->rays[i].direction, -1.0f);
        if (points[i].distance < INFINITY)
            points[i].distance = walk->hits[i].distance;
    }
    bdpt->host->light_densities(bdpt->host, places, points, walk->count, densities);
    for (size_t i = 0; i < walk->count; i++) {
        float cosine = ps_dot(points[i].direction, walk->hits[i].geometric_normal);
        float arrival = densities[i].arrival * bdpt->area * cosine, direct = densities[i].direct;
        walk->ends[i].vcm = bdpt_square(1.0f / arrival);
        walk->ends[i].vc = direct > 0.0f ? bdpt_square(1.0f / (arrival * direct)) : 0.0f;
    }
}

/* The first segment: one ray for each of the tile's pixels, and what it meets. */
static void start(const struct bdpt *bdpt, uint32_t tile, const uint64_t *samples,
                  struct walk *walk)
{
    const ps_host *host = bdpt->host;
    float numbers[PS_TILE_PIXELS][4];
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb power[PS_TILE_PIXELS];
    ps_light_sample points[PS_TILE_PIXELS];
    host->samples(host, PS_STREAM_ESTIMATOR, START_SET, samples, PS_TILE_PIXELS, numbers);
    host->emit_points(host, (const float(*)[4])numbers, PS_TILE_PIXELS, rays, power, points);
    host->intersect(host, rays, PS_TILE_PIXELS, walk->hits);
    walk->count = 0;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        size_t i = walk->count;
        float most = ps_rgb_maximum(power[lane]);
        if (!host->pixel(host, tile, lane, &x, &y) || !(most > 0.0f) ||
            !(walk->hits[lane].distance < INFINITY))
            continue;
        walk->ends[i] = (struct subpath){.throughput = power[lane], .start = most, .lane = lane};
        walk->rays[i] = rays[lane];
        walk->hits[i] = walk->hits[lane];
        points[i] = points[lane];
        walk->count++;
    }
    arrive_from_lights(bdpt, points, walk);
}

static int keep(const struct bdpt *bdpt, const struct walk *walk, struct light_vertices *vertices)
{
    if (!bdpt_connects(bdpt))
        return 1;
    if (!make_room_for_vertices(bdpt->host, vertices, walk->count))
        return 0;
    for (size_t i = 0; i < walk->count; i++) {
        uint32_t place = (uint32_t)vertices->count++, lane = walk->ends[i].lane;
        vertices->items[place] = (struct vertex){walk->ends[i], walk->rays[i], walk->hits[i]};
        vertices->next[place] = vertices->first[lane];
        vertices->first[lane] = place;
    }
    return 1;
}

/* --- light tracing --- */

/* What an end brings to the camera, if nothing is in between. A point of a pixel reflects diffusely
 * here; what it mirrors is the host's. */
static int connect(const struct bdpt *bdpt, const struct walk *walk, size_t i, const float place[2],
                   struct splat *splat, ps_ray *ray)
{
    const struct subpath *end = &walk->ends[i];
    const ps_hit *hit = &walk->hits[i];
    ps_vec3 in = ps_scale(walk->rays[i].direction, -1.0f);
    float density = camera_ray_to(bdpt, hit->position, hit->geometric_normal, ray);
    float cosine = ps_max(ps_dot(in, hit->normal), 0.0f);
    if (!(density > 0.0f && cosine > 0.0f) || !bdpt->host->is_shown(bdpt->host, hit->object) ||
        !camera_pixel_at(bdpt, place, &splat->tile, &splat->lane))
        return 0;
    density /= bdpt->light_paths;
    float others =
        bdpt_square(density * bdpt->area) * (end->vcm + end->vc * bdpt_square(cosine / PS_PI));
    float weight = bdpt_connects(bdpt) ? bdpt_weight(others) : 1.0f;
    float shading = cosine / ps_dot(in, hit->geometric_normal); /* Veach 1997, section 5.3 */
    ps_rgb albedo = bdpt_albedo_towards(bdpt, hit, ray->direction);
    splat->radiance =
        ps_rgb_scale(ps_rgb_multiply(end->throughput, albedo), shading * density * weight / PS_PI);
    return ps_rgb_maximum(splat->radiance) > 0.0f;
}

static int connect_to_camera(const struct bdpt *bdpt, const struct walk *walk, float scale,
                             struct splat_list *splats)
{
    const ps_host *host = bdpt->host;
    ps_vec3 positions[PS_TILE_PIXELS];
    float places[PS_TILE_PIXELS][2];
    struct splat seen[PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS];
    uint8_t blocked[PS_TILE_PIXELS];
    size_t count = 0;
    if (!make_room_for_splats(host, splats, walk->count))
        return 0;
    for (size_t i = 0; i < walk->count; i++)
        positions[i] = walk->hits[i].position;
    host->project(host, positions, walk->count, places);
    for (size_t i = 0; i < walk->count; i++)
        count += (size_t)connect(bdpt, walk, i, places[i], &seen[count], &rays[count]);
    host->occluded(host, rays, count, blocked);
    for (size_t i = 0; i < count; i++) {
        if (blocked[i])
            continue;
        seen[i].radiance = ps_rgb_scale(seen[i].radiance, scale);
        splats->items[splats->count++] = seen[i];
    }
    return 1;
}

int light_paths_trace(const struct bdpt *bdpt, uint32_t tile, const uint64_t *samples, float scale,
                      struct light_vertices *vertices, struct splat_list *splats)
{
    struct walk walk;
    vertices->count = 0;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        vertices->first[lane] = NO_VERTEX;
    start(bdpt, tile, samples, &walk);
    for (uint32_t number = 1; walk.count > 0; number++) {
        if (!keep(bdpt, &walk, vertices))
            return 0;
        if (number > 1 && !connect_to_camera(bdpt, &walk, scale, splats))
            return 0;
        walk_scatter(bdpt, PS_FROM_LIGHT, PS_STREAM_ESTIMATOR, number, samples, &walk);
        bdpt->host->intersect(bdpt->host, walk.rays, walk.count, walk.hits);
        walk_drop_lost(&walk);
        walk_arrive(bdpt, &walk);
    }
    return 1;
}
