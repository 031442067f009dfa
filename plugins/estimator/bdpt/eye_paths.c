#include "eye_paths.h"

/* Sets of PS_STREAM_PATH that choose points on lights; directions take 1, 2, 3, ... */
#define LIGHT_SETS 0x10000u

struct eye_work {
    const struct bdpt *bdpt;
    const ps_points *points;
    const struct sight *sights;
    const uint64_t *samples;
    struct tile_sums *sums;
    struct walk walk;
};

static void add(struct eye_work *work, uint32_t lane, ps_rgb irradiance)
{
    work->sums->lanes[lane] = ps_rgb_add(work->sums->lanes[lane], irradiance);
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
        float arrival = bdpt_connects(bdpt) ? density.arrival * bdpt->area : 0.0f;
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
    float arrival = bdpt_connects(bdpt) ? density->arrival * bdpt->area * cosine : 0.0f;
    float others = bdpt_square(arrival) * (end->vcm + end->vc * bdpt_square(value->reverse_pdf));
    if (density->direct > 0.0f)
        others += bdpt_square(value->pdf / density->direct);
    struct scattering here = bdpt_scattering(&work->walk.hits[i], point->direction, value);
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

/* --- the paths --- */

/* The pixels' points as first surfaces: white, so that pi times what they send on is their
 * irradiance. */
static void start_at_points(struct eye_work *work)
{
    struct walk *walk = &work->walk;
    walk->count = work->points->count;
    for (uint32_t i = 0; i < walk->count; i++) {
        uint32_t lane = work->points->lanes[i];
        float density = work->sights[lane].density * work->bdpt->area;
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
        float cosine = ps_dot(direction, hit->geometric_normal);
        subpath_leave(&walk->ends[i], cosine, pdf, 0.0f);
        if (!(cosine > 0.0f)) /* by a bent normal; no connection goes there */
            walk->ends[i].vcm = walk->ends[i].vc = 0.0f;
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
                     const uint64_t *samples, const struct light_vertices *vertices,
                     struct tile_sums *sums)
{
    struct eye_work work = {
        .bdpt = bdpt, .points = points, .sights = sights, .samples = samples, .sums = sums};
    struct connecting connecting = {bdpt, vertices, samples, sums, connections_small(sums), 0};
    struct walk *walk = &work.walk;
    start_at_points(&work);
    connect_to_lights(&connecting, walk, 1);
    leave_points(&work);
    for (uint32_t number = 1; walk->count > 0; number++) {
        bdpt->host->intersect(bdpt->host, walk->rays, walk->count, walk->hits);
        if (number == 1)
            forget_own_surfaces(&work);
        else
            add_emission(&work);
        walk_drop_lost(walk);
        walk_arrive(bdpt, walk);
        add_direct(&work, number);
        connect_to_lights(&connecting, walk, 0);
        walk_scatter(bdpt, PS_FROM_CAMERA, PS_STREAM_PATH, number + 1, samples, walk);
    }
}
