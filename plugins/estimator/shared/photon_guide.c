#include "photon_guide.h"

#define POINTS 16 /* of a group that draw lights */
#define DRAWS 4   /* of each */
#define ASKED 256 /* lights that a point draws from */

_Static_assert(PHOTON_GUIDE_DRAWS == POINTS * DRAWS, "room for what all points draw");

ps_result photon_guide_create(const struct virtual_lights *lights, struct photon_guide *guide)
{
    const ps_host *host = lights->host;
    size_t n = lights->count;
    float *block = host->allocate(host, 7 * n * sizeof *block, "virtual lights");
    *guide = (struct photon_guide){.host = host, .x = block};
    if (!block)
        return PS_ERROR_MEMORY;
    guide->count = n;
    guide->y = block + n;
    guide->z = block + 2 * n;
    guide->normal_x = block + 3 * n;
    guide->normal_y = block + 4 * n;
    guide->normal_z = block + 5 * n;
    guide->power = block + 6 * n;
    guide->nearest = virtual_lights_clamp(host, (ps_number_or_choice){.choice = 0});
    for (size_t i = 0; i < n; i++) {
        const ps_photon *light = &lights->lights[i];
        guide->x[i] = light->position.x;
        guide->y[i] = light->position.y;
        guide->z[i] = light->position.z;
        guide->normal_x[i] = light->normal.x;
        guide->normal_y[i] = light->normal.y;
        guide->normal_z[i] = light->normal.z;
        guide->power[i] = ps_luminance(light->power);
    }
    return PS_OK;
}

void photon_guide_release(struct photon_guide *guide)
{
    guide->host->release(guide->host, guide->x);
    *guide = (struct photon_guide){.host = guide->host};
}

bool photon_guide_is_there(const struct photon_guide *guide)
{
    return guide->x != NULL;
}

/* Some of the lights, and the sums of what they give up to each. */
struct asked {
    size_t first, count;
    float ends[ASKED];
};

/* Asks lights from a random one on: which come one after the other are a fair part of all. Returns
 * what they would give, but for a factor that is the same for all. */
static float ask(const struct photon_guide *photons, ps_vec3 position, ps_vec3 normal, float number,
                 struct asked *asked)
{
    float nearest2 = photons->nearest * photons->nearest, sum = 0.0f;
    float *restrict given = asked->ends;
    asked->count = photons->count < ASKED ? photons->count : ASKED;
    asked->first = (size_t)(number * (float)(photons->count - asked->count + 1));
    const float *restrict light_x = photons->x + asked->first;
    const float *restrict light_y = photons->y + asked->first;
    const float *restrict light_z = photons->z + asked->first;
    const float *restrict normal_x = photons->normal_x + asked->first;
    const float *restrict normal_y = photons->normal_y + asked->first;
    const float *restrict normal_z = photons->normal_z + asked->first;
    const float *restrict power = photons->power + asked->first;
#pragma omp simd
    for (size_t i = 0; i < asked->count; i++) {
        float x = light_x[i] - position.x, y = light_y[i] - position.y, z = light_z[i] - position.z;
        float distance2 = x * x + y * y + z * z;
        float here = x * normal.x + y * normal.y + z * normal.z;
        float there = x * normal_x[i] + y * normal_y[i] + z * normal_z[i];
        float cosines = ps_max(here, 0.0f) * ps_max(-there, 0.0f) * power[i];
        float light = cosines / (distance2 * ps_max(distance2, nearest2));
        given[i] = cosines > 0.0f ? light : 0.0f;
    }
    for (size_t i = 0; i < asked->count; i++) {
        sum += given[i];
        asked->ends[i] = sum;
    }
    return sum;
}

static ps_ray ray_to(const struct photon_guide *photons, size_t light, const ps_pass *pass,
                     ps_vec3 position, ps_vec3 normal)
{
    ps_vec3 place = {photons->x[light], photons->y[light], photons->z[light]};
    ps_vec3 facing = {photons->normal_x[light], photons->normal_y[light], photons->normal_z[light]};
    ps_vec3 between = ps_subtract(ps_add_scaled(place, pass->surface_offset, facing), position);
    float distance = ps_length(between);
    ps_ray ray = ps_leave_surface(position, normal, ps_scale(between, 1.0f / distance),
                                  pass->surface_offset);
    ray.tfar = distance;
    return ray;
}

/* Draws equally spaced ones along the sums. */
static void draw(const struct photon_guide *photons, const struct asked *asked, const ps_pass *pass,
                 const ps_points *points, size_t point, int half, float number,
                 struct photon_guide_draws *drawn)
{
    float sum = asked->ends[asked->count - 1];
    size_t light = 0;
    for (int i = 0; i < DRAWS; i++) {
        float at = ((float)i + number) / DRAWS * sum;
        while (light + 1 < asked->count && asked->ends[light] <= at)
            light++;
        size_t k = drawn->count++;
        drawn->points[k] = point;
        drawn->halves[k] = half;
        drawn->light[k] = sum;
        drawn->rays[k] = ray_to(photons, asked->first + light, pass, points->positions[point],
                                points->normals[point]);
    }
}

static void draw_lights(const struct photon_guide *photons, const ps_pass *pass,
                        const ps_points *points, uint64_t index, struct photon_guide_draws *drawn)
{
    float numbers[POINTS][4];
    uint64_t indices[POINTS];
    struct asked asked;
    for (uint32_t i = 0; i < POINTS; i++)
        indices[i] = (index << 32) + (uint64_t)pass->number * POINTS + i;
    photons->host->samples(photons->host, PS_STREAM_ESTIMATOR, VIRTUAL_LIGHTS_SETS, indices, POINTS,
                           numbers);
    for (int i = 0; i < POINTS; i++) {
        float along = ((float)i + numbers[i][0]) * (1.0f / POINTS);
        size_t point = (size_t)(along * (float)points->count);
        point = point < points->count ? point : points->count - 1;
        if (ask(photons, points->positions[point], points->normals[point], numbers[i][1], &asked) >
            0.0f)
            draw(photons, &asked, pass, points, point, i % 2, numbers[i][2], drawn);
    }
}

/* Leaves out what something is in the way of. */
static void drop_shadowed(const ps_host *host, struct photon_guide_draws *drawn)
{
    uint8_t blocked[PHOTON_GUIDE_DRAWS];
    size_t left = 0;
    if (drawn->count > 0)
        host->occluded(host, drawn->rays, drawn->count, blocked);
    for (size_t i = 0; i < drawn->count; i++) {
        drawn->points[left] = drawn->points[i];
        drawn->halves[left] = drawn->halves[i];
        drawn->rays[left] = drawn->rays[i];
        drawn->light[left] = drawn->light[i];
        left += !blocked[i];
    }
    drawn->count = left;
}

void photon_guide_draw(const struct photon_guide *photons, const ps_pass *pass,
                       const ps_points *points, uint64_t index, struct photon_guide_draws *drawn)
{
    drawn->count = 0;
    if (photons->count == 0 || points->count == 0)
        return;
    draw_lights(photons, pass, points, index, drawn);
    drop_shadowed(photons->host, drawn);
}
