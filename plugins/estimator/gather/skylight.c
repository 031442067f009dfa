#include "skylight.h"

#define LIGHT_SET 1 /* of PS_STREAM_PLUGIN; surfels are found by set 0 */

bool skylight_is_there(const ps_host *host)
{
    uint32_t count = host->light_count(host);
    for (uint32_t i = 0; i < count; i++) {
        ps_light light = {.size = sizeof light};
        host->light(host, i, &light);
        if (light.kind == PS_LIGHT_SKY)
            return true;
    }
    return false;
}

struct work {
    const ps_pass *pass;
    uint64_t rays;
    struct surfels *surfels;
};

/* A surface at a surfel that sends back what it gets as radiance, so that this is its
 * irradiance. */
static void look_at(const struct surfels *surfels, size_t i, ps_ray *ray, ps_hit *hit)
{
    ps_vec3 position = surfels->positions[i], normal = surfels->normals[i];
    *ray = (ps_ray){ps_add(position, normal), 0.0f, ps_scale(normal, -1.0f), INFINITY};
    *hit = (ps_hit){
        .position = position,
        .distance = 1.0f,
        .normal = normal,
        .geometric_normal = normal,
        .albedo = {PS_PI, PS_PI, PS_PI},
    };
}

static void light_group(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    struct surfels *surfels = work->surfels;
    const ps_host *host = surfels->host;
    struct surfel_group group = surfels_group(surfels, SURFELS_GROUP, index);
    ps_ray rays[SURFELS_GROUP];
    ps_hit hits[SURFELS_GROUP];
    ps_rgb radiance[SURFELS_GROUP];
    uint8_t groups[SURFELS_GROUP];
    uint64_t indices[SURFELS_GROUP];
    if (host->cancelled(host))
        return;
    for (size_t i = 0; i < group.n; i++) {
        look_at(surfels, group.first + i, &rays[i], &hits[i]);
        groups[i] = PS_LIGHTS_SOFT;
        indices[i] =
            (work->pass->number * UINT64_C(2) * MOST_SURFELS + group.first + i) * work->rays;
        surfels->sky[group.first + i] = (ps_rgb){0, 0, 0};
    }
    for (uint64_t ray = 0; ray < work->rays; ray++) {
        host->direct_radiance_of(host, rays, hits, groups, PS_STREAM_PLUGIN, LIGHT_SET, indices,
                                 group.n, radiance);
        for (size_t i = 0; i < group.n; i++) {
            ps_rgb *sky = &surfels->sky[group.first + i];
            *sky = ps_rgb_add(*sky, ps_rgb_scale(radiance[i], 1.0f / (float)work->rays));
            indices[i]++;
        }
    }
}

ps_result skylight_find(const ps_pass *pass, uint64_t rays, struct surfels *surfels)
{
    const ps_host *host = surfels->host;
    struct work work = {pass, rays, surfels};
    if (surfels->count == 0)
        return PS_OK;
    surfels->sky = host->allocate(host, surfels->count * sizeof *surfels->sky, "surfels");
    if (!surfels->sky)
        return PS_ERROR_MEMORY;
    host->parallel_for(host, surfels_group_count(surfels, SURFELS_GROUP), light_group, &work);
    return host->cancelled(host) ? PS_CANCELLED : PS_OK;
}
