#include "eye_paths.h"

/* Sets of PS_STREAM_PATH that choose points on lights; directions take 1, 2, 3, ... */
#define LIGHT_SETS 0x10000u

struct eye_work {
    const struct bdpt *bdpt;
    const ps_points *points;
    const struct sight *sights;
    const uint64_t *samples;
    const struct light_vertices *vertices;
    uint32_t targets[PS_TILE_PIXELS]; /* which point each lane is */
    ps_rgb *sums;
    int at_points; /* the walk is still at the pixels' points, which count as white and diffuse */
    struct walk walk;
};

static void add(struct eye_work *work, uint32_t lane, ps_rgb irradiance)
{
    ps_rgb *sum = &work->sums[work->targets[lane]];
    *sum = ps_rgb_add(*sum, irradiance);
}

/* What surface i of the walk scatters of light from a direction, given what the host says of it. */
static struct scattering scattering_at(const struct walk *walk, size_t i, ps_vec3 direction,
                                       const ps_bsdf_value *value)
{
    const ps_hit *hit = &walk->hits[i];
    float cosine = ps_max(ps_dot(direction, hit->normal), 0.0f);
    int is_diffuse = !(hit->flags & PS_HIT_SPECULAR);
    return (struct scattering){
        value->value, is_diffuse ? value->value : ps_rgb_scale(hit->albedo, cosine / PS_PI)};
}

/* --- emission that is met --- */

static ps_light_sample point_met(const struct bdpt *bdpt, const ps_ray *ray, const ps_hit *hit)
{
    ps_light_sample point = {
        .distance = hit->distance, .direction = ray->direction, .light = PS_NO_LIGHT};
    if (hit->distance < INFINITY) {
        point.normal = hit->geometric_normal;
        point.light = bdpt->host->light_of_object(bdpt->host, hit->object);
    }
    return point;
}

/* Weighed against next-event estimation and against light paths. */
static void add_emission(struct eye_work *work)
{
    const struct bdpt *bdpt = work->bdpt;
    const struct walk *walk = &work->walk;
    ps_rgb radiance[PS_TILE_PIXELS];
    static const float unweighed[PS_TILE_PIXELS] = {0};
    bdpt->host->emitted_radiance(bdpt->host, walk->rays, walk->hits, unweighed, walk->count,
                                 radiance);
    for (size_t i = 0; i < walk->count; i++) {
        const struct subpath *end = &walk->ends[i];
        if (!(ps_rgb_maximum(radiance[i]) > 0.0f))
            continue;
        ps_light_sample point = point_met(bdpt, &walk->rays[i], &walk->hits[i]);
        ps_light_density density;
        bdpt->host->light_densities(bdpt->host, &walk->rays[i].origin, &point, 1, &density);
        float arrival = bdpt_connects(bdpt) ? density.arrival : 0.0f;
        float others = bdpt_square(density.direct) * (end->vcm + bdpt_square(arrival) * end->vc);
        ps_rgb carried = ps_rgb_scale(end->throughput, bdpt_weight(others));
        add(work, end->lane, ps_rgb_multiply(carried, radiance[i]));
    }
}

/* --- next-event estimation --- */

/* A point of a light for each surface, as seen from off it. */
static void choose_points(const struct eye_work *work, uint32_t number, ps_vec3 *places,
                          ps_light_sample *points, ps_light_density *densities,
                          ps_bsdf_value *values)
{
    const ps_host *host = work->bdpt->host;
    const struct walk *walk = &work->walk;
    uint64_t indices[PS_TILE_PIXELS];
    float numbers[PS_TILE_PIXELS][4];
    ps_vec3 directions[PS_TILE_PIXELS];
    for (size_t i = 0; i < walk->count; i++) {
        indices[i] = work->samples[walk->ends[i].lane];
        places[i] = bdpt_origin(work->bdpt, &walk->hits[i]);
    }
    host->samples(host, PS_STREAM_PATH, LIGHT_SETS + number, indices, walk->count, numbers);
    host->sample_light(host, places, (const float(*)[4])numbers, walk->count, points);
    host->light_densities(host, places, points, walk->count, densities);
    for (size_t i = 0; i < walk->count; i++)
        directions[i] = points[i].direction;
    bdpt_evaluate(work->bdpt, PS_FROM_CAMERA, walk->rays, walk->hits, directions, walk->count,
                  values);
}

/* What surface i sends on of a light's point, if nothing is in between. */
static ps_rgb light_from(const struct eye_work *work, size_t i, const ps_light_sample *point,
                         const ps_light_density *density, const ps_bsdf_value *value)
{
    const struct bdpt *bdpt = work->bdpt;
    const struct subpath *end = &work->walk.ends[i];
    static const struct scattering light = {{1, 1, 1}, {0, 0, 0}};
    if (!(ps_rgb_maximum(point->irradiance) > 0.0f && ps_rgb_maximum(value->value) > 0.0f))
        return (ps_rgb){0, 0, 0};
    float cosine = ps_dot(point->direction, work->walk.hits[i].geometric_normal);
    float arrival = bdpt_connects(bdpt) ? density->arrival * cosine : 0.0f;
    float others = bdpt_square(arrival) * (end->vcm + end->vc * bdpt_square(value->reverse_pdf));
    if (density->direct > 0.0f)
        others += bdpt_square(value->pdf / density->direct);
    struct scattering here = scattering_at(&work->walk, i, point->direction, value);
    ps_rgb scattered = bdpt_scattered(bdpt_room(bdpt, end->bounces), &here, &light);
    ps_rgb carried = ps_rgb_scale(end->throughput, bdpt_weight(others));
    return ps_rgb_multiply(ps_rgb_multiply(carried, scattered), point->irradiance);
}

static void add_direct(struct eye_work *work, uint32_t number)
{
    const struct walk *walk = &work->walk;
    ps_vec3 places[PS_TILE_PIXELS];
    ps_light_sample points[PS_TILE_PIXELS];
    ps_light_density densities[PS_TILE_PIXELS];
    ps_bsdf_value values[PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb light[PS_TILE_PIXELS];
    uint32_t lanes[PS_TILE_PIXELS];
    uint8_t blocked[PS_TILE_PIXELS];
    size_t count = 0;
    choose_points(work, number, places, points, densities, values);
    for (size_t i = 0; i < walk->count; i++) {
        /* A light may lie on a surface, which must not shadow it. */
        float far = ps_max(points[i].distance - work->bdpt->pass->surface_offset, 0.0f);
        light[count] = light_from(work, i, &points[i], &densities[i], &values[i]);
        rays[count] = (ps_ray){places[i], 0.0f, points[i].direction, far};
        lanes[count] = walk->ends[i].lane;
        count += ps_rgb_maximum(light[count]) > 0.0f;
    }
    work->bdpt->host->occluded(work->bdpt->host, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (!blocked[i])
            add(work, lanes[i], light[i]);
}

/* --- connections to light paths --- */

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
static ps_rgb carried_over(const struct eye_work *work, const struct connections *links, size_t k)
{
    const struct bdpt *bdpt = work->bdpt;
    const struct vertex *vertex = &work->vertices->items[links->lights[k]];
    const struct subpath *eye = &work->walk.ends[links->eyes[k]], *light = &vertex->end;
    const ps_bsdf_value *at_eye = &links->eye_values[k], *at_light = &links->light_values[k];
    if (!(ps_rgb_maximum(at_eye->value) > 0.0f && ps_rgb_maximum(at_light->value) > 0.0f))
        return (ps_rgb){0, 0, 0};
    ps_vec3 between = ps_subtract(vertex->hit.position, links->eye_hits[k].position);
    float distance2 = ps_dot(between, between);
    float cos_eye = ps_dot(links->to_lights[k], links->eye_hits[k].geometric_normal);
    float cos_light = ps_dot(links->to_eyes[k], vertex->hit.geometric_normal);
    float others = bdpt_square(at_eye->pdf * cos_light / distance2) *
                       (light->vcm + light->vc * bdpt_square(at_light->reverse_pdf)) +
                   bdpt_square(at_light->pdf * cos_eye / distance2) *
                       (eye->vcm + eye->vc * bdpt_square(at_eye->reverse_pdf));
    struct scattering here =
        scattering_at(&work->walk, links->eyes[k], links->to_lights[k], at_eye);
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
static void add_connections(struct eye_work *work, struct connections *links)
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
        lanes[count] = work->walk.ends[links->eyes[k]].lane;
        count += ps_rgb_maximum(light[count]) > 0.0f;
    }
    host->occluded(host, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (!blocked[i])
            add(work, lanes[i], light[i]);
    links->count = 0;
}

/* Takes note of a connection whose ends face each other. */
static void note_connection(const struct eye_work *work, size_t i, uint32_t light,
                            struct connections *links)
{
    const struct vertex *vertex = &work->vertices->items[light];
    const ps_hit *hit = &work->walk.hits[i];
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
    links->eye_rays[k] = work->walk.rays[i];
    links->light_rays[k] = vertex->ray;
    links->eye_hits[k] = *hit;
    links->light_hits[k] = vertex->hit;
    links->count++;
}

static void connect_to_lights(struct eye_work *work)
{
    struct connections links; /* large: not to be cleared each time */
    if (!bdpt_connects(work->bdpt))
        return;
    links.count = 0;
    for (size_t i = 0; i < work->walk.count; i++) {
        uint32_t light = work->vertices->first[work->walk.ends[i].lane];
        for (; light != NO_VERTEX; light = work->vertices->next[light]) {
            note_connection(work, i, light, &links);
            if (links.count == PS_TILE_PIXELS)
                add_connections(work, &links);
        }
    }
    add_connections(work, &links);
}

/* --- the paths --- */

/* The pixels' points as first surfaces: white, so that pi times what they send on is their irradiance. */
static void start_at_points(struct eye_work *work)
{
    struct walk *walk = &work->walk;
    walk->count = work->points->count;
    for (uint32_t i = 0; i < walk->count; i++) {
        uint32_t lane = work->points->lanes[i];
        float density = work->sights[lane].density;
        walk->ends[i] =
            (struct subpath){.throughput = {PS_PI, PS_PI, PS_PI}, .start = PS_PI, .lane = lane};
        walk->ends[i].vcm = density > 0.0f ? bdpt_square(1.0f / density) : 0.0f;
        walk->hits[i] = (ps_hit){
            .position = work->points->positions[i],
            .normal = work->points->normals[i],
            .geometric_normal = work->sights[lane].normal,
            .albedo = {1, 1, 1},
        };
        walk->rays[i] = (ps_ray){walk->hits[i].position, 0.0f, {0, 0, 1}, INFINITY};
        work->targets[lane] = i;
    }
}

/* By the cosine, as all paths of pixels start. */
static void leave_points(struct eye_work *work)
{
    const struct bdpt *bdpt = work->bdpt;
    struct walk *walk = &work->walk;
    uint64_t indices[PS_TILE_PIXELS];
    float numbers[PS_TILE_PIXELS][4];
    for (size_t i = 0; i < walk->count; i++)
        indices[i] = work->samples[walk->ends[i].lane];
    bdpt->host->samples(bdpt->host, PS_STREAM_PATH, 1, indices, walk->count, numbers);
    for (size_t i = 0; i < walk->count; i++) {
        const ps_hit *hit = &walk->hits[i];
        ps_vec3 direction = ps_cosine_direction(hit->normal, numbers[i][0], numbers[i][1]);
        float pdf = ps_dot(direction, hit->normal) / PS_PI;
        subpath_leave(&walk->ends[i], ps_dot(direction, hit->geometric_normal), pdf, 0.0f);
        walk->rays[i] =
            ps_leave_surface(hit->position, hit->normal, direction, bdpt->pass->surface_offset);
    }
}

/* The walk's order is still that of the points. */
static void forget_own_surfaces(struct eye_work *work)
{
    uint32_t targets[PS_TILE_PIXELS];
    for (uint32_t i = 0; i < work->walk.count; i++)
        targets[i] = i;
    ps_forget_own_surface(work->points, targets, work->walk.count, work->bdpt->pass->surface_offset,
                          work->walk.hits);
}

void eye_paths_trace(const struct bdpt *bdpt, const ps_points *points, const struct sight *sights,
                     const uint64_t *samples, const struct light_vertices *vertices, ps_rgb *sums)
{
    struct eye_work work = {.bdpt = bdpt,
                            .points = points,
                            .sights = sights,
                            .samples = samples,
                            .vertices = vertices,
                            .sums = sums,
                            .at_points = 1};
    struct walk *walk = &work.walk;
    start_at_points(&work);
    connect_to_lights(&work);
    leave_points(&work);
    work.at_points = 0;
    for (uint32_t number = 1; walk->count > 0; number++) {
        bdpt->host->intersect(bdpt->host, walk->rays, walk->count, walk->hits);
        if (number == 1)
            forget_own_surfaces(&work);
        else
            add_emission(&work);
        walk_drop_lost(walk);
        walk_arrive(walk);
        add_direct(&work, number);
        connect_to_lights(&work);
        walk_scatter(bdpt, PS_FROM_CAMERA, PS_STREAM_PATH, number + 1, samples, walk);
    }
}
