#include "connections.h"

/* Sets of PS_STREAM_PATH for Russian roulette; directions and lights take smaller ones. */
#define ROULETTE_SETS 0x20000u

/* Of the tile's mean irradiance: connections that would bring less have to pass Russian
 * roulette. */
#define SMALL_SHARE 0.1f

/* Pairs of surfaces that face each other: of a pixel's path, or a pixel's point, and of a light
 * path. */
struct pair {
    const struct subpath *eye;
    const struct vertex *light;
    float distance2;
    float cos_eye, cos_light; /* to the geometric normals */
};

/* One side of the pairs. */
struct side {
    uint32_t flags; /* of all surfaces together */
    const ps_ray *rays[PS_TILE_PIXELS];
    const ps_hit *hits[PS_TILE_PIXELS];
    ps_vec3 to_other[PS_TILE_PIXELS];
    ps_bsdf_value values[PS_TILE_PIXELS];
};

struct connections {
    size_t count;
    int at_points;
    struct pair pairs[PS_TILE_PIXELS];
    struct side eyes, lights;
};

/* The diffuse part of what a light path's surface scatters: BSDF times cosine, with what smoothed
 * normals change. */
static ps_rgb diffuse_from_light(const struct bdpt *bdpt, const struct vertex *vertex,
                                 ps_vec3 direction)
{
    const ps_hit *hit = &vertex->hit;
    ps_vec3 in = ps_scale(vertex->ray.direction, -1.0f);
    float shading = ps_max(ps_dot(in, hit->normal), 0.0f) / ps_dot(in, hit->geometric_normal);
    float cosine = shading * ps_dot(direction, hit->geometric_normal);
    return ps_rgb_scale(bdpt_albedo_towards(bdpt, hit, direction), cosine / PS_PI);
}

/* What each surface scatters to the other of its pair. */
static void evaluate(const struct bdpt *bdpt, ps_direction direction, size_t n, struct side *side)
{
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    if (!(side->flags & PS_HIT_SPECULAR)) {
        for (size_t k = 0; k < n; k++)
            side->values[k] =
                bdpt_evaluate_diffuse(direction, side->rays[k], side->hits[k], side->to_other[k]);
        return;
    }
    for (size_t k = 0; k < n; k++) {
        rays[k] = *side->rays[k];
        hits[k] = *side->hits[k];
    }
    bdpt->host->evaluate_bsdf(bdpt->host, direction, rays, hits, side->to_other, n, side->values);
}

/* What the walk's surface sends on of what the light path's sends there, if nothing is in
 * between. */
static ps_rgb carried_over(const struct bdpt *bdpt, const struct connections *all, size_t k)
{
    const struct pair *pair = &all->pairs[k];
    const struct subpath *eye = pair->eye, *light = &pair->light->end;
    const ps_bsdf_value *at_eye = &all->eyes.values[k], *at_light = &all->lights.values[k];
    if (!(ps_rgb_maximum(at_eye->value) > 0.0f && ps_rgb_maximum(at_light->value) > 0.0f))
        return (ps_rgb){0, 0, 0};
    float in_units = pair->distance2 / bdpt->area;
    float others = bdpt_square(at_eye->pdf * pair->cos_light / in_units) *
                       (light->vcm + light->vc * bdpt_square(at_light->reverse_pdf)) +
                   bdpt_square(at_light->pdf * pair->cos_eye / in_units) *
                       (eye->vcm + eye->vc * bdpt_square(at_eye->reverse_pdf));
    struct scattering here = bdpt_scattering(all->eyes.hits[k], all->eyes.to_other[k], at_eye);
    uint32_t room = bdpt_room(bdpt, eye->bounces + light->bounces);
    struct scattering there = {at_light->value, at_light->value};
    if (all->at_points)
        here.diffuse = (ps_rgb){0, 0, 0};
    if (room < 2 && pair->light->hit.flags & PS_HIT_SPECULAR)
        there.diffuse = diffuse_from_light(bdpt, pair->light, all->lights.to_other[k]);
    ps_rgb scattered = bdpt_scattered(room, &here, &there);
    ps_rgb carried = ps_rgb_multiply(eye->throughput, light->throughput);
    return ps_rgb_scale(ps_rgb_multiply(carried, scattered), bdpt_weight(others) / pair->distance2);
}

float connections_small(const struct tile_sums *sums)
{
    float sum = 0.0f;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        sum += ps_rgb_maximum(sums->lanes[lane]);
    return sums->samples > 0 ? SMALL_SHARE * sum / (float)(PS_TILE_PIXELS * sums->samples) : 0.0f;
}

/* Where the roulette of some connections starts, 0..1. */
static float begin_roulette(struct connecting *work, const struct connections *all)
{
    const ps_host *host = work->bdpt->host;
    float numbers[1][4] = {{0}};
    if (all->count > 0 && work->small > 0.0f)
        host->samples(host, PS_STREAM_PATH, ROULETTE_SETS + work->roulettes++,
                      &work->samples[all->pairs[0].eye->lane], 1, numbers);
    return numbers[0][0];
}

/* Systematic sampling: probabilities are summed from a random start on, and what makes the sum pass
 * a whole number is kept. So one random number will do, and what is kept varies less. */
static int survives(float small, float *place, ps_rgb *light)
{
    float most = ps_rgb_maximum(*light);
    if (!(most > 0.0f) || most >= small)
        return most > 0.0f;
    *place += most / small;
    if (*place < 1.0f)
        return 0;
    *place -= 1.0f;
    *light = ps_rgb_scale(*light, small / most);
    return 1;
}

static void forget_pairs(struct connections *all)
{
    all->count = 0;
    all->eyes.flags = all->lights.flags = 0;
}

/* Adds what the connections carry, and forgets them. */
static void add_connections(struct connecting *work, struct connections *all)
{
    const ps_host *host = work->bdpt->host;
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb light[PS_TILE_PIXELS];
    uint32_t lanes[PS_TILE_PIXELS];
    uint8_t blocked[PS_TILE_PIXELS];
    size_t count = 0;
    evaluate(work->bdpt, PS_FROM_CAMERA, all->count, &all->eyes);
    evaluate(work->bdpt, PS_FROM_LIGHT, all->count, &all->lights);
    float place = begin_roulette(work, all);
    for (size_t k = 0; k < all->count; k++) {
        const struct pair *pair = &all->pairs[k];
        ps_rgb carried = carried_over(work->bdpt, all, k);
        if (!survives(work->small, &place, &carried))
            continue;
        ps_vec3 from = bdpt_origin(work->bdpt, all->eyes.hits[k]);
        ps_vec3 way = ps_subtract(bdpt_origin(work->bdpt, all->lights.hits[k]), from);
        float distance = ps_length(way);
        light[count] = carried;
        rays[count] = (ps_ray){from, 0.0f, ps_scale(way, 1.0f / distance), distance};
        lanes[count] = pair->eye->lane;
        count++;
    }
    host->occluded(host, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (!blocked[i])
            work->sums->lanes[lanes[i]] = ps_rgb_add(work->sums->lanes[lanes[i]], light[i]);
    forget_pairs(all);
}

static void note_end(const ps_ray *ray, const ps_hit *hit, ps_vec3 to_other, size_t k,
                     struct side *side)
{
    side->rays[k] = ray;
    side->hits[k] = hit;
    side->to_other[k] = to_other;
    side->flags |= hit->flags;
}

/* Takes note of a pair whose surfaces face each other. */
static void note_pair(const struct walk *walk, size_t i, const struct vertex *vertex,
                      struct connections *all)
{
    const ps_hit *hit = &walk->hits[i];
    ps_vec3 between = ps_subtract(vertex->hit.position, hit->position);
    float rise_eye = ps_dot(between, hit->geometric_normal);
    float rise_light = -ps_dot(between, vertex->hit.geometric_normal);
    size_t k = all->count;
    if (!(rise_eye > 0.0f && rise_light > 0.0f && ps_dot(between, hit->normal) > 0.0f))
        return;
    float distance2 = ps_dot(between, between), scale = 1.0f / sqrtf(distance2);
    all->pairs[k] =
        (struct pair){&walk->ends[i], vertex, distance2, rise_eye * scale, rise_light * scale};
    note_end(&walk->rays[i], hit, ps_scale(between, scale), k, &all->eyes);
    note_end(&vertex->ray, &vertex->hit, ps_scale(between, -scale), k, &all->lights);
    all->count++;
}

void connect_to_lights(struct connecting *work, const struct walk *walk, int at_points)
{
    const struct light_vertices *vertices = work->vertices;
    struct connections all; /* large: not to be cleared each time */
    if (!bdpt_connects(work->bdpt))
        return;
    all.at_points = at_points;
    forget_pairs(&all);
    for (size_t i = 0; i < walk->count; i++) {
        uint32_t light = vertices->first[walk->ends[i].lane];
        for (; light != NO_VERTEX; light = vertices->next[light]) {
            note_pair(walk, i, &vertices->items[light], &all);
            if (all.count == PS_TILE_PIXELS)
                add_connections(work, &all);
        }
    }
    add_connections(work, &all);
}
