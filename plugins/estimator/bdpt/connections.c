#include "connections.h"

struct connecting {
    const struct bdpt *bdpt;
    const struct walk *walk;
    const struct light_vertices *vertices;
    ps_rgb *sums; /* of lanes */
    int at_points;
};

/* Ends that can be connected, from the surfaces of pixels' paths, or pixels' points, to those of light paths. */
struct connections {
    size_t count;
    uint32_t eyes[PS_TILE_PIXELS];   /* in the walk */
    uint32_t lights[PS_TILE_PIXELS]; /* among the light paths' vertices */
    ps_vec3 to_lights[PS_TILE_PIXELS], to_eyes[PS_TILE_PIXELS];
    ps_ray eye_rays[PS_TILE_PIXELS], light_rays[PS_TILE_PIXELS];
    ps_hit eye_hits[PS_TILE_PIXELS], light_hits[PS_TILE_PIXELS];
    ps_bsdf_value eye_values[PS_TILE_PIXELS], light_values[PS_TILE_PIXELS];
};

/* The diffuse part of what a light path's surface scatters: BSDF times cosine, with what smoothed normals change. */
static ps_rgb diffuse_from_light(const struct bdpt *bdpt, const struct vertex *vertex,
                                 ps_vec3 direction)
{
    const ps_hit *hit = &vertex->hit;
    ps_vec3 in = ps_scale(vertex->ray.direction, -1.0f);
    float shading = ps_max(ps_dot(in, hit->normal), 0.0f) / ps_dot(in, hit->geometric_normal);
    float cosine = shading * ps_dot(direction, hit->geometric_normal);
    return ps_rgb_scale(bdpt_albedo_towards(bdpt, hit, direction), cosine / PS_PI);
}

/* What the walk's surface sends on of what the light path's sends there, if nothing is in between. */
static ps_rgb carried_over(const struct connecting *work, const struct connections *links, size_t k)
{
    const struct bdpt *bdpt = work->bdpt;
    const struct vertex *vertex = &work->vertices->items[links->lights[k]];
    const struct subpath *eye = &work->walk->ends[links->eyes[k]], *light = &vertex->end;
    const ps_bsdf_value *at_eye = &links->eye_values[k], *at_light = &links->light_values[k];
    if (!(ps_rgb_maximum(at_eye->value) > 0.0f && ps_rgb_maximum(at_light->value) > 0.0f))
        return (ps_rgb){0, 0, 0};
    ps_vec3 between = ps_subtract(vertex->hit.position, links->eye_hits[k].position);
    float distance2 = ps_dot(between, between), in_units = distance2 / bdpt->area;
    float cos_eye = ps_dot(links->to_lights[k], links->eye_hits[k].geometric_normal);
    float cos_light = ps_dot(links->to_eyes[k], vertex->hit.geometric_normal);
    float others = bdpt_square(at_eye->pdf * cos_light / in_units) *
                       (light->vcm + light->vc * bdpt_square(at_light->reverse_pdf)) +
                   bdpt_square(at_light->pdf * cos_eye / in_units) *
                       (eye->vcm + eye->vc * bdpt_square(at_eye->reverse_pdf));
    struct scattering here = bdpt_scattering(&links->eye_hits[k], links->to_lights[k], at_eye);
    uint32_t room = bdpt_room(bdpt, eye->bounces + light->bounces);
    struct scattering there = {at_light->value, at_light->value};
    if (work->at_points)
        here.diffuse = (ps_rgb){0, 0, 0};
    if (room < 2 && vertex->hit.flags & PS_HIT_SPECULAR)
        there.diffuse = diffuse_from_light(bdpt, vertex, links->to_eyes[k]);
    ps_rgb scattered = bdpt_scattered(room, &here, &there);
    ps_rgb carried = ps_rgb_multiply(eye->throughput, light->throughput);
    return ps_rgb_scale(ps_rgb_multiply(carried, scattered), bdpt_weight(others) / distance2);
}

/* Adds what the connections carry, and forgets them. */
static void add_connections(const struct connecting *work, struct connections *links)
{
    const ps_host *host = work->bdpt->host;
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb light[PS_TILE_PIXELS];
    uint32_t lanes[PS_TILE_PIXELS];
    uint8_t blocked[PS_TILE_PIXELS];
    size_t count = 0;
    bdpt_evaluate(work->bdpt, PS_FROM_CAMERA, links->eye_rays, links->eye_hits, links->to_lights,
                  links->count, links->eye_values);
    bdpt_evaluate(work->bdpt, PS_FROM_LIGHT, links->light_rays, links->light_hits, links->to_eyes,
                  links->count, links->light_values);
    for (size_t k = 0; k < links->count; k++) {
        ps_vec3 from = bdpt_origin(work->bdpt, &links->eye_hits[k]);
        ps_vec3 way = ps_subtract(bdpt_origin(work->bdpt, &links->light_hits[k]), from);
        float distance = ps_length(way);
        light[count] = carried_over(work, links, k);
        rays[count] = (ps_ray){from, 0.0f, ps_scale(way, 1.0f / distance), distance};
        lanes[count] = work->walk->ends[links->eyes[k]].lane;
        count += ps_rgb_maximum(light[count]) > 0.0f;
    }
    host->occluded(host, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (!blocked[i])
            work->sums[lanes[i]] = ps_rgb_add(work->sums[lanes[i]], light[i]);
    links->count = 0;
}

/* Takes note of a connection whose ends face each other. */
static void note_connection(const struct connecting *work, size_t i, uint32_t light,
                            struct connections *links)
{
    const struct vertex *vertex = &work->vertices->items[light];
    const ps_hit *hit = &work->walk->hits[i];
    ps_vec3 between = ps_subtract(vertex->hit.position, hit->position);
    ps_vec3 direction = ps_normalize(between);
    size_t k = links->count;
    if (!(ps_dot(direction, hit->geometric_normal) > 0.0f &&
          ps_dot(direction, hit->normal) > 0.0f &&
          ps_dot(direction, vertex->hit.geometric_normal) < 0.0f))
        return;
    links->eyes[k] = (uint32_t)i;
    links->lights[k] = light;
    links->to_lights[k] = direction;
    links->to_eyes[k] = ps_scale(direction, -1.0f);
    links->eye_rays[k] = work->walk->rays[i];
    links->light_rays[k] = vertex->ray;
    links->eye_hits[k] = *hit;
    links->light_hits[k] = vertex->hit;
    links->count++;
}

void connect_to_lights(const struct bdpt *bdpt, const struct walk *walk, int at_points,
                       const struct light_vertices *vertices, ps_rgb *sums)
{
    const struct connecting work = {bdpt, walk, vertices, sums, at_points};
    struct connections links; /* large: not to be cleared each time */
    if (!bdpt_connects(bdpt))
        return;
    links.count = 0;
    for (size_t i = 0; i < walk->count; i++) {
        uint32_t light = vertices->first[walk->ends[i].lane];
        for (; light != NO_VERTEX; light = vertices->next[light]) {
            note_connection(&work, i, light, &links);
            if (links.count == PS_TILE_PIXELS)
                add_connections(&work, &links);
        }
    }
    add_connections(&work, &links);
}
