#include "direct/direct.h"

#include "base/sample.h"
#include "direct/receivers.h"
#include "scene/heuristic.h"
#include <psplat/host.h>
#include <psplat/tile.h>
#include <string.h>

/* The numbers of receivers; see struct receivers. */
struct draws {
    float numbers[RECEIVERS_MOST][4];
    double choices[RECEIVERS_MOST];
};

/* Set of the numbers that choose lights beside a set of those that choose points on them. */
#define CHOICE_SETS 0x40000000u

/* One number of 48 bits: a light may have a share of the others that 24 do not tell. */
static double choice_of(const float numbers[4])
{
    return (double)numbers[0] + (double)numbers[1] * 0x1p-24;
}

/* Draws the numbers of `n` points, those that the lights need. */
static void draw(const struct lighting *lighting, const struct light_numbers *from, size_t first,
                 size_t n, struct draws *draws, struct receivers *to)
{
    const struct scene *scene = lighting->scene;
    const uint64_t *indices = from->indices + first;
    if (receivers_need_choices(lighting)) {
        uint32_t key = sample_key(from->seed, from->stream, from->set | CHOICE_SETS);
        sample_points(key, indices, n, draws->numbers);
        for (size_t i = 0; i < n; i++)
            draws->choices[i] = choice_of(draws->numbers[i]);
        to->choices = draws->choices;
    }
    if (scene->has_area_lights) {
        uint32_t key = sample_key(from->seed, from->stream, from->set);
        sample_points(key, indices, n, draws->numbers);
        to->numbers = draws->numbers;
    }
}

void direct_radiance(const struct lighting *lighting, const ps_ray *rays, const ps_hit *hits,
                     const uint8_t *groups, size_t n, const struct light_numbers *numbers,
                     ps_rgb *radiance)
{
    ps_vec3 positions[RECEIVERS_MOST], normals[RECEIVERS_MOST];
    struct draws draws;
    for (size_t first = 0; first < n; first += RECEIVERS_MOST) {
        size_t count = n - first < RECEIVERS_MOST ? n - first : RECEIVERS_MOST;
        for (size_t i = 0; i < count; i++) {
            positions[i] = hits[first + i].position;
            normals[i] = hits[first + i].normal;
            radiance[first + i] = (ps_rgb){0, 0, 0};
        }
        struct receivers to = {
            .lighting = lighting,
            .n = count,
            .positions = positions,
            .normals = normals,
            .rays = rays + first,
            .hits = hits + first,
            .groups = groups ? groups + first : NULL,
        };
        draw(lighting, numbers, first, count, &draws, &to);
        receivers_add_lights(&to, radiance + first);
    }
}

/* The density by which receivers at the ray's origin draw its direction. */
static float density_from_afar(const struct lighting *lighting, const struct light *light,
                               const ps_ray *ray)
{
    return lighting->portals && light->emitter == EMITTER_SKY
               ? portals_pdf(lighting->portals, light, ray->origin, ray->direction)
               : light_pdf(light, ray->origin, ray->direction, INFINITY, (ps_vec3){0, 0, 0});
}

static ps_rgb sky_radiance(const struct lighting *lighting, const ps_ray *ray, float pdf)
{
    const struct scene *scene = lighting->scene;
    ps_rgb sum = {0, 0, 0};
    for (size_t i = 0; i < scene->afar_count; i++) {
        const struct light *light = &scene->lights[scene->afar[i]];
        ps_rgb radiance = light_radiance_from(light, ray->direction);
        if (!(ps_rgb_maximum(radiance) > 0.0f))
            continue;
        float light_density = pdf > 0.0f ? density_from_afar(lighting, light, ray) : 0.0f;
        sum = ps_rgb_add(sum, ps_rgb_scale(radiance, power_heuristic(pdf, light_density)));
    }
    return sum;
}

static ps_rgb surface_radiance(const struct lighting *lighting, const ps_ray *ray,
                               const ps_hit *hit, float pdf)
{
    if (!(hit->flags & PS_HIT_EMISSIVE))
        return (ps_rgb){0, 0, 0};
    const struct scene *scene = lighting->scene;
    ps_rgb radiance = material_emission(&scene->materials[hit->material], hit);
    uint32_t light = scene->object_lights[hit->object];
    if (!(pdf > 0.0f) || light == NO_LIGHT)
        return radiance;
    bool back = hit->flags & PS_HIT_BACK;
    ps_vec3 front = ps_scale(hit->geometric_normal, back ? -1.0f : 1.0f);
    float light_density =
        receivers_light_pdf(lighting, light, ray->origin, ray->direction, hit->distance, front);
    return ps_rgb_scale(radiance, power_heuristic(pdf, light_density));
}

void emitted_radiance(const struct lighting *lighting, const ps_ray *rays, const ps_hit *hits,
                      const float *pdfs, size_t n, ps_rgb *radiance)
{
    for (size_t i = 0; i < n; i++) {
        float pdf = pdfs ? pdfs[i] : 0.0f;
        radiance[i] = hits[i].distance < INFINITY
                          ? surface_radiance(lighting, &rays[i], &hits[i], pdf)
                          : sky_radiance(lighting, &rays[i], pdf);
    }
}

/* Number `sample` of each run, for the points that have it. */
static void draw_runs(const struct lighting *lighting, const struct light_runs *runs, uint64_t seed,
                      uint32_t sample, const ps_points *points, struct draws *draws,
                      struct receivers *to)
{
    uint64_t indices[PS_TILE_PIXELS];
    struct draws drawn;
    struct receivers all = {.numbers = NULL};
    const struct light_numbers from = {seed, PS_STREAM_LIGHT, 0, indices};
    for (size_t run = 0; run < runs->count; run++)
        indices[run] = runs->first[run] + sample;
    draw(lighting, &from, 0, runs->count, &drawn, &all);
    for (size_t i = 0; i < points->count; i++) {
        uint32_t run = runs->of_lane[points->lanes[i]];
        if (all.numbers)
            memcpy(draws->numbers[i], drawn.numbers[run], sizeof drawn.numbers[run]);
        if (all.choices)
            draws->choices[i] = drawn.choices[run];
    }
    to->numbers = all.numbers ? draws->numbers : NULL;
    to->choices = all.choices ? draws->choices : NULL;
}

/* Irradiance of the points of a tile, summed over shadow rays: of all lights, and of those that
 * cast hard shadows. */
struct sums {
    ps_rgb all[PS_TILE_PIXELS], hard[PS_TILE_PIXELS];
};

/* Adds the shadow rays of number `from` to `end` of each point. */
static void add_samples(const struct receivers *receivers, uint64_t seed,
                        const struct light_runs *runs, const ps_points *points, uint32_t from,
                        uint32_t end, struct sums *sums)
{
    if (points->count == 0)
        return;
    struct draws draws;
    struct receivers to = *receivers;
    to.hard = receivers->hard ? sums->hard : NULL;
    for (uint32_t sample = from; sample < end; sample++) {
        draw_runs(to.lighting, runs, seed, sample, points, &draws, &to);
        receivers_add_lights(&to, sums->all);
    }
}

/* Puts means over `count` shadow rays in their lanes: of what `sums` has more than `before` (NULL:
 * nothing). */
static void put_means(const ps_points *points, const ps_rgb *sums, const ps_rgb *before,
                      uint32_t count, ps_rgb lanes[PS_TILE_PIXELS])
{
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS && !before; lane++)
        lanes[lane] = (ps_rgb){0, 0, 0};
    for (size_t i = 0; i < points->count; i++) {
        ps_rgb sum = before ? ps_rgb_add(sums[i], ps_rgb_scale(before[i], -1.0f)) : sums[i];
        lanes[points->lanes[i]] = ps_rgb_scale(sum, 1.0f / (float)count);
    }
}

void direct_light_tile(const struct lighting *lighting, struct gbuffer *gbuffer, uint32_t index,
                       uint64_t seed, const struct light_runs *runs, uint32_t samples)
{
    size_t first = (size_t)index * PS_TILE_PIXELS;
    struct sums sums = {.all = {{0, 0, 0}}}, half_sums;
    uint64_t occlusion[PS_TILE_PIXELS] = {0};
    samples = scene_samples_lights(lighting->scene) ? samples : 1;
    uint32_t half = (samples + 1) / 2;
    ps_points points;
    ps_collect_points(&gbuffer->tiles[index], &points);
    const struct receivers to = {.lighting = lighting,
                                 .n = points.count,
                                 .positions = points.positions,
                                 .normals = points.normals,
                                 .hard = gbuffer->hard ? sums.hard : NULL,
                                 .occlusion = gbuffer->occlusion ? occlusion : NULL};
    add_samples(&to, seed, runs, &points, 0, half, &sums);
    memcpy(&half_sums, &sums, sizeof half_sums);
    add_samples(&to, seed, runs, &points, half, samples, &sums);
    put_means(&points, sums.all, NULL, samples, gbuffer->direct + first);
    if (gbuffer->hard)
        put_means(&points, sums.hard, NULL, samples, gbuffer->hard + first);
    if (gbuffer->direct_half && samples > half)
        put_means(&points, sums.all, half_sums.all, samples - half, gbuffer->direct_half + first);
    if (gbuffer->hard_half && samples > half)
        put_means(&points, sums.hard, half_sums.hard, samples - half, gbuffer->hard_half + first);
    for (size_t i = 0; i < points.count && gbuffer->occlusion; i++)
        gbuffer->occlusion[first + points.lanes[i]] = occlusion[i];
}
