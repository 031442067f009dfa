#include "pipeline/direct.h"

#include <psplat/math.h>
#include <psplat/tile.h>

#define CHUNK 256

/* The shadow ray from a point to a light, and the irradiance it stands for where nothing is in the
 * way: E = I cos / r^2. */
static ps_rgb connect(const struct scene *scene, const struct light *light, ps_vec3 position,
                      ps_vec3 normal, ps_ray *ray)
{
    static const ps_rgb nothing = {0, 0, 0};
    ps_vec3 origin = ps_add_scaled(position, scene->surface_offset, normal);
    struct light_sample sample;
    if (!light_sample(light, origin, 0.5f, 0.5f, &sample))
        return nothing;
    float cosine = ps_dot(sample.direction, normal);
    if (!(cosine > 0.0f))
        return nothing;
    /* A lamp may lie on a surface, which must not shadow it. */
    float reach = fmaxf(sample.distance - scene->surface_offset, 0.0f);
    *ray = (ps_ray){origin, 0.0f, sample.direction, reach};
    return ps_rgb_scale(sample.weight, cosine);
}

/* Adds one light to at most CHUNK points. */
static void add_light(const struct scene *scene, const struct trace *trace,
                      enum coherence coherence, const struct light *light, const ps_vec3 *positions,
                      const ps_vec3 *normals, size_t n, ps_rgb *irradiance)
{
    ps_ray rays[CHUNK];
    ps_rgb unshadowed[CHUNK];
    size_t points[CHUNK];
    uint8_t blocked[CHUNK];
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        unshadowed[count] = connect(scene, light, positions[i], normals[i], &rays[count]);
        points[count] = i;
        count += ps_rgb_maximum(unshadowed[count]) > 0.0f;
    }
    trace_occluded(trace, coherence, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (!blocked[i])
            irradiance[points[i]] = ps_rgb_add(irradiance[points[i]], unshadowed[i]);
}

void direct_irradiance(const struct scene *scene, const struct trace *trace,
                       enum coherence coherence, const ps_vec3 *positions, const ps_vec3 *normals,
                       size_t n, ps_rgb *irradiance)
{
    for (size_t i = 0; i < n; i++)
        irradiance[i] = (ps_rgb){0, 0, 0};
    for (size_t first = 0; first < n; first += CHUNK) {
        size_t count = n - first < CHUNK ? n - first : CHUNK;
        for (size_t light = 0; light < scene->light_count; light++)
            add_light(scene, trace, coherence, &scene->lights[light], positions + first,
                      normals + first, count, irradiance + first);
    }
}

void direct_light_tile(const struct scene *scene, const struct trace *trace,
                       struct gbuffer *gbuffer, uint32_t index)
{
    ps_rgb *direct = &gbuffer->direct[(size_t)index * PS_TILE_PIXELS];
    ps_rgb irradiance[PS_TILE_PIXELS];
    ps_points points;
    ps_collect_points(&gbuffer->tiles[index], &points);
    direct_irradiance(scene, trace, RAYS_COHERENT, points.positions, points.normals, points.count,
                      irradiance);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        direct[lane] = (ps_rgb){0, 0, 0};
    for (size_t i = 0; i < points.count; i++)
        direct[points.lanes[i]] = irradiance[i];
}
