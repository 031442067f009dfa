#include "record.h"

#include "hemisphere_mesh.h"

#define THICKNESS 0.25f /* of the smaller radius */
#define LONGEST 0.45f   /* radius, of sqrt(E / c): an error of c r^2 / 2 = 0.1 E */
#define WALL_SLOPE 0.5f /* height over distance, below which what is seen stands on the surface */
#define FAR 10.0f       /* units, where rays that meet nothing are taken to end */
#define TO_WALL 0.7f    /* radius, of the distance of a wall */

/* --- rays --- */

static uint32_t ray_count(const struct record_setting *setting)
{
    return setting->rings * setting->sectors;
}

struct record_room *record_rooms_create(const struct record_setting *setting)
{
    const ps_host *host = setting->paths.host;
    uint32_t workers = setting->paths.pass->thread_count, rays = ray_count(setting);
    size_t of_ray = sizeof(ps_rgb) + 2 * sizeof(ps_vec3);
    struct record_room *rooms =
        host->allocate(host, workers * (sizeof *rooms + rays * of_ray), "irradiance cache");
    if (!rooms)
        return NULL;
    ps_vec3 *vectors = (ps_vec3 *)(rooms + workers);
    ps_rgb *colours = (ps_rgb *)(vectors + 2 * (size_t)workers * rays);
    for (size_t i = 0; i < workers; i++)
        rooms[i] = (struct record_room){colours + i * rays, vectors + 2 * i * rays,
                                        vectors + (2 * i + 1) * rays};
    return rooms;
}

void record_rooms_release(const ps_host *host, struct record_room *rooms)
{
    host->release(host, rooms);
}

/* A direction of a stratum around z, by two numbers of [0, 1). */
static ps_vec3 stratum_direction(const struct record_setting *setting, uint32_t ray, float a,
                                 float b)
{
    uint32_t ring = ray / setting->sectors, sector = ray % setting->sectors;
    float square = ((float)ring + a) / (float)setting->rings;
    float angle = 2.0f * PS_PI * ((float)sector + b) / (float)setting->sectors;
    float sine = sqrtf(square);
    return (ps_vec3){sine * cosf(angle), sine * sinf(angle), sqrtf(ps_max(1.0f - square, 0.0f))};
}

/* A group of rays, as if they were one from each point of a tile. */
struct ray_group {
    ps_points points;
    uint64_t samples[PS_TILE_PIXELS];
    ps_rgb found[PS_TILE_PIXELS];
    struct paths paths;
    struct paths_segment segment;
};

/* The frame of a record is ps_frame of its normal. */
static void start_group(const struct record_setting *setting, const struct record *record,
                        const struct record_room *room, uint64_t first_sample, uint32_t first,
                        struct ray_group *group)
{
    const ps_host *host = setting->paths.host;
    uint32_t left = ray_count(setting) - first;
    ps_vec3 u, v;
    ps_frame(record->normal, &u, &v);
    group->points.count = left < PS_TILE_PIXELS ? left : PS_TILE_PIXELS;
    for (uint32_t i = 0; i < group->points.count; i++) {
        group->samples[i] = first_sample + first + i;
        group->points.positions[i] = record->position;
        group->found[i] = (ps_rgb){0, 0, 0};
    }
    host->samples(host, PS_STREAM_PATH, 1, group->samples, group->points.count,
                  group->segment.numbers);
    group->paths.count = 0;
    for (uint32_t i = 0; i < group->points.count; i++) {
        ps_vec3 local = stratum_direction(setting, first + i, group->segment.numbers[i][0],
                                          group->segment.numbers[i][1]);
        ps_vec3 direction = ps_normalize(ps_add_scaled(
            ps_add_scaled(ps_scale(u, local.x), local.y, v), local.z, record->normal));
        room->directions[first + i] = direction;
        room->hits[first + i] = ps_scale(local, FAR);
        paths_add(&group->paths, i,
                  ps_leave_surface(record->position, record->normal, direction,
                                   setting->paths.pass->surface_offset),
                  PS_PI);
    }
}

/* Where the first segments ended. */
static void keep_hits(const struct record_setting *setting, const struct record *record,
                      const struct record_room *room, uint32_t first, const struct ray_group *group)
{
    ps_vec3 u, v;
    ps_frame(record->normal, &u, &v);
    for (size_t i = 0; i < group->paths.count; i++) {
        const ps_hit *hit = &group->segment.hits[i];
        if (!(hit->distance < INFINITY))
            continue;
        ps_vec3 way = ps_scale(ps_subtract(hit->position, record->position), 1.0f / setting->unit);
        room->hits[first + group->paths.pixels[i]] =
            (ps_vec3){ps_dot(way, u), ps_dot(way, v), ps_max(ps_dot(way, record->normal), 0.0f)};
    }
}

static void trace_rays(const struct record_setting *setting, const struct record *record,
                       const struct record_room *room, uint64_t first_sample)
{
    struct ray_group group;
    for (uint32_t first = 0; first < ray_count(setting); first += PS_TILE_PIXELS) {
        start_group(setting, record, room, first_sample, first, &group);
        paths_intersect(&setting->paths, &group.points, 1, &group.paths, &group.segment);
        keep_hits(setting, record, room, first, &group);
        paths_go_on(&setting->paths, &group.points, group.samples, 1, &group.paths, &group.segment,
                    group.found);
        for (size_t i = 0; i < group.points.count; i++)
            room->radiance[first + i] = ps_rgb_scale(group.found[i], 1.0f / PS_PI);
    }
}

/* --- what they tell --- */

/* E = pi / n * sum of L, and by the rotational gradient of Ward and Heckbert 1992 a change d of the
 * normal adds pi / n * sum of L d.w / cos(theta). Of each stratum the cosine in its middle divides,
 * which is never 0. */
static void sum_irradiance(const struct record_setting *setting, const struct record_room *room,
                           struct record *record)
{
    uint32_t rays = ray_count(setting);
    record->irradiance = (ps_rgb){0, 0, 0};
    for (int channel = 0; channel < 3; channel++)
        record->rotations[channel] = (ps_vec3){0, 0, 0};
    for (uint32_t i = 0; i < rays; i++) {
        uint32_t ring = i / setting->sectors;
        float square = ((float)ring + 0.5f) / (float)setting->rings;
        ps_rgb found = ps_rgb_scale(room->radiance[i], PS_PI / (float)rays);
        ps_vec3 way = ps_scale(room->directions[i], 1.0f / sqrtf(1.0f - square));
        way = ps_add_scaled(way, -ps_dot(way, record->normal), record->normal);
        record->rotations[0] = ps_add_scaled(record->rotations[0], found.r, way);
        record->rotations[1] = ps_add_scaled(record->rotations[1], found.g, way);
        record->rotations[2] = ps_add_scaled(record->rotations[2], found.b, way);
        record->irradiance = ps_rgb_add(record->irradiance, found);
    }
}

static float radius_of(const struct record_setting *setting, float footprint, float irradiance,
                       float curvature)
{
    float least = setting->least * footprint, most = setting->most * footprint;
    if (!(curvature > 0.0f))
        return most;
    float length = sqrtf(irradiance / curvature);
    float radius = ps_min(sqrtf(setting->scale * footprint * length), LONGEST * length);
    return ps_min(ps_max(radius, least), most);
}

static ps_rgb limit(ps_rgb gradient, float most)
{
    float length = ps_max(fabsf(gradient.r), ps_max(fabsf(gradient.g), fabsf(gradient.b)));
    return length > most ? ps_rgb_scale(gradient, most / length) : gradient;
}

/* Axes are those of the matrix of second derivatives, and radii by its eigenvalues c: of an error c
 * r^2 / 2 at distance r the sum over the picture is least, for a given number of records, where r^4
 * is in proportion to E / c and to the square of a pixel's footprint. */
static void set_axes(const struct record_setting *setting, const struct hemisphere_derivatives *of,
                     struct record *record)
{
    ps_vec3 u, v;
    ps_frame(record->normal, &u, &v);
    float mean = 0.5f * (of->xx + of->yy), half = 0.5f * (of->xx - of->yy);
    float spread = sqrtf(half * half + of->xy * of->xy);
    float angle = 0.5f * atan2f(of->xy, half);
    float irradiance = ps_luminance(record->irradiance);
    float area = setting->unit * setting->unit;
    const float curvatures[2] = {fabsf(mean + spread) / area, fabsf(mean - spread) / area};
    for (int i = 0; i < 2; i++) {
        float x = i == 0 ? cosf(angle) : -sinf(angle), y = i == 0 ? sinf(angle) : cosf(angle);
        record->axes[i] = ps_add_scaled(ps_scale(u, x), y, v);
        record->radii[i] = radius_of(setting, record->footprint, irradiance, curvatures[i]);
        record->gradients[i] = limit(ps_rgb_add(ps_rgb_scale(of->gradient_x, x / setting->unit),
                                                ps_rgb_scale(of->gradient_y, y / setting->unit)),
                                     irradiance / record->radii[i]);
    }
}

/* Towards a crease irradiance changes ever faster, which no second derivative tells: records end
 * near what stands on their own surface. */
static void end_before_walls(const struct record_setting *setting, const struct record_room *room,
                             struct record *record)
{
    float least = setting->least * record->footprint, scale = TO_WALL * setting->unit;
    ps_vec3 u, v;
    ps_frame(record->normal, &u, &v);
    for (uint32_t i = 0; i < ray_count(setting); i++) {
        ps_vec3 hit = room->hits[i];
        if (hit.z > WALL_SLOPE * sqrtf(hit.x * hit.x + hit.y * hit.y))
            continue;
        ps_vec3 wall = ps_add_scaled(ps_scale(u, scale * hit.x), scale * hit.y, v);
        float along[2] = {fabsf(ps_dot(wall, record->axes[0])),
                          fabsf(ps_dot(wall, record->axes[1]))};
        float x = along[0] / record->radii[0], y = along[1] / record->radii[1];
        int axis = x >= y ? 0 : 1;
        if (x * x + y * y < 1.0f)
            record->radii[axis] = ps_max(along[axis], least);
    }
}

void record_make(const struct record_setting *setting, const struct record_room *room,
                 uint64_t first_sample, struct record *record)
{
    const struct hemisphere hemisphere = {setting->rings, setting->sectors, room->hits,
                                          room->radiance};
    trace_rays(setting, record, room, first_sample);
    sum_irradiance(setting, room, record);
    struct hemisphere_derivatives derivatives = hemisphere_derivatives(&hemisphere);
    set_axes(setting, &derivatives, record);
    end_before_walls(setting, room, record);
}

/* --- use --- */

float record_thickness(const struct record *record)
{
    return THICKNESS * ps_min(record->radii[0], record->radii[1]);
}

float record_distance(const struct record *record, ps_vec3 position, ps_vec3 normal)
{
    float cosine = ps_dot(record->normal, normal);
    ps_vec3 way = ps_subtract(position, record->position);
    float u = ps_dot(way, record->axes[0]) / record->radii[0];
    float v = ps_dot(way, record->axes[1]) / record->radii[1];
    float w = ps_dot(way, record->normal) / record_thickness(record);
    return u * u + v * v + w * w + (1.0f - cosine) / (1.0f - RECORD_FACING);
}

ps_rgb record_extrapolate(const struct record *record, ps_vec3 position, ps_vec3 normal)
{
    ps_vec3 way = ps_subtract(position, record->position);
    ps_rgb turned = {ps_dot(record->rotations[0], normal), ps_dot(record->rotations[1], normal),
                     ps_dot(record->rotations[2], normal)};
    ps_rgb sum = ps_rgb_add(record->irradiance, turned);
    for (int i = 0; i < 2; i++)
        sum = ps_rgb_add(sum, ps_rgb_scale(record->gradients[i], ps_dot(way, record->axes[i])));
    return (ps_rgb){ps_max(sum.r, 0.0f), ps_max(sum.g, 0.0f), ps_max(sum.b, 0.0f)};
}
