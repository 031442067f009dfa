#include "direct/direct.h"

#include "base/sample.h"
#include "scene/heuristic.h"
#include <psplat/host.h>
#include <psplat/tile.h>
#include <string.h>

#define CHUNK 256

/* Points that receive light: of a surface hit, or of the G-buffer, of which only position and normal
 * are known. */
struct receivers {
    const struct lighting *lighting;
    size_t n; /* at most CHUNK */
    const ps_vec3 *positions, *normals;
    const ps_ray *rays; /* NULL: irradiance is asked for */
    const ps_hit *hits;
    float (*numbers)[4]; /* NULL: no light has a size */
    uint64_t *occlusion; /* what rays to the lights met, see gbuffer_occlusion; NULL: nobody asks */
};

/* Two of a point's four numbers, or these moved by Roberts's sequence for many lights. */
static void numbers_for_light(const float numbers[4], size_t light, float pair[2])
{
    size_t first = light % 2 * 2, turn = light / 2;
    if (turn == 0) { /* as below, without two calls; few scenes have more lights */
        memcpy(pair, numbers + first, 2 * sizeof *pair);
        return;
    }
    float turns = (float)turn;
    float a = numbers[first] + 0.7548777f * turns, b = numbers[first + 1] + 0.5698403f * turns;
    pair[0] = ps_min(a - floorf(a), 0x1.fffffep-1f);
    pair[1] = ps_min(b - floorf(b), 0x1.fffffep-1f);
}

/* What the receiver makes of irradiance 1 across a beam from `direction`. */
static ps_rgb response(const struct receivers *to, size_t i, ps_vec3 direction, float light_pdf)
{
    float cosine = ps_max(ps_dot(direction, to->normals[i]), 0.0f);
    if (!to->hits)
        return (ps_rgb){cosine, cosine, cosine};
    const ps_hit *hit = &to->hits[i];
    if (!(ps_dot(direction, hit->geometric_normal) > 0.0f))
        return (ps_rgb){0, 0, 0};
    ps_rgb reflected = ps_rgb_scale(hit->albedo, cosine / PS_PI);
    if (!(hit->flags & PS_HIT_SPECULAR))
        return reflected;
    return ps_rgb_add(reflected, material_gloss(&to->lighting->scene->materials[hit->material],
                                                to->lighting->scene->microfacets, &to->rays[i], hit,
                                                direction, light_pdf));
}

/* The normals of receivers to which light counts by the cosine alone. */
static const ps_vec3 *normals_of_diffuse(const struct receivers *to, ps_vec3 *room)
{
    static const ps_vec3 none = {0, 0, 0};
    if (!to->hits)
        return to->normals;
    for (size_t i = 0; i < to->n; i++)
        room[i] = to->hits[i].flags & PS_HIT_SPECULAR ? none : to->normals[i];
    return room;
}

/* A point of the light for each receiver, as seen from where its shadow ray begins. */
static void choose_points(const struct receivers *to, size_t light, ps_vec3 *origins,
                          struct light_sample *samples)
{
    const struct scene *scene = to->lighting->scene;
    ps_vec3 normals[CHUNK];
    float pairs[CHUNK][2];
    for (size_t i = 0; i < to->n; i++) {
        ps_vec3 away = to->hits ? to->hits[i].geometric_normal : to->normals[i];
        origins[i] = ps_add_scaled(to->positions[i], scene->surface_offset, away);
        pairs[i][0] = pairs[i][1] = 0.0f;
        if (to->numbers)
            numbers_for_light(to->numbers[i], light, pairs[i]);
    }
    light_sample(&scene->lights[light], origins, normals_of_diffuse(to, normals),
                 (const float(*)[2])pairs, to->n, samples);
}

/* The shadow ray from a receiver to a point of a light, and what arrives where nothing is in the way. */
static ps_rgb connect(const struct receivers *to, size_t i, ps_vec3 origin,
                      const struct light_sample *sample, ps_ray *ray)
{
    if (!(ps_rgb_maximum(sample->weight) > 0.0f &&
          ps_dot(sample->direction, to->normals[i]) > 0.0f))
        return (ps_rgb){0, 0, 0};
    /* A light may lie on a surface, which must not shadow it. */
    float radius = ps_max(sample->distance - to->lighting->scene->surface_offset, 0.0f);
    *ray = (ps_ray){origin, 0.0f, sample->direction, radius};
    return ps_rgb_multiply(sample->weight, response(to, i, sample->direction, sample->pdf));
}

/* The share of a light that gets along each of n shadow rays, to points of these normals. */
static void find_lit(const struct lighting *lighting, size_t light, const ps_ray *rays,
                     const ps_vec3 *normals, size_t n, float *lit)
{
    uint8_t blocked[CHUNK];
    if (lighting->maps && shadow_maps_hold(lighting->maps, light)) {
        for (size_t i = 0; i < n; i++)
            lit[i] = shadow_maps_lit(lighting->maps, light, rays[i].origin, normals[i]);
        return;
    }
    trace_occluded(lighting->trace, rays, n, blocked);
    for (size_t i = 0; i < n; i++)
        lit[i] = blocked[i] ? 0.0f : 1.0f;
}

static void add_light(const struct receivers *to, size_t light, ps_rgb *sums)
{
    ps_ray rays[CHUNK];
    ps_rgb unshadowed[CHUNK];
    ps_vec3 origins[CHUNK], normals[CHUNK];
    struct light_sample samples[CHUNK];
    size_t targets[CHUNK];
    float lit[CHUNK];
    size_t count = 0;
    choose_points(to, light, origins, samples);
    for (size_t i = 0; i < to->n; i++) {
        unshadowed[count] = connect(to, i, origins[i], &samples[i], &rays[count]);
        normals[count] = to->normals[i];
        targets[count] = i;
        count += ps_rgb_maximum(unshadowed[count]) > 0.0f;
    }
    if (count == 0)
        return;
    find_lit(to->lighting, light, rays, normals, count, lit);
    for (size_t i = 0; i < count; i++) {
        sums[targets[i]] = ps_rgb_add(sums[targets[i]], ps_rgb_scale(unshadowed[i], lit[i]));
        if (to->occlusion)
            to->occlusion[targets[i]] |= gbuffer_occlusion(light, lit[i]);
    }
}

static void add_lights(const struct receivers *to, ps_rgb *sums)
{
    for (size_t light = 0; light < to->lighting->scene->light_count; light++)
        add_light(to, light, sums);
}

/* Draws `n` points' numbers, where some light needs them; else NULL. */
static float (*draw(const struct scene *scene, const struct light_numbers *from, size_t first,
                    size_t n, float (*room)[4]))[4]
{
    if (!scene->has_area_lights)
        return NULL;
    uint32_t key = sample_key(from->seed, from->stream, from->set);
    sample_points(key, from->indices + first, n, room);
    return room;
}

void direct_radiance(const struct lighting *lighting, const ps_ray *rays, const ps_hit *hits,
                     size_t n, const struct light_numbers *numbers, ps_rgb *radiance)
{
    ps_vec3 positions[CHUNK], normals[CHUNK];
    float room[CHUNK][4];
    for (size_t first = 0; first < n; first += CHUNK) {
        size_t count = n - first < CHUNK ? n - first : CHUNK;
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
            .numbers = draw(lighting->scene, numbers, first, count, room),
        };
        add_lights(&to, radiance + first);
    }
}

static ps_rgb sky_radiance(const struct scene *scene, const ps_ray *ray, float pdf)
{
    ps_rgb sum = {0, 0, 0};
    for (size_t i = 0; i < scene->light_count && scene->has_sky; i++) {
        const struct light *light = &scene->lights[i];
        ps_rgb radiance = light_radiance_from(light, ray->direction);
        if (!(ps_rgb_maximum(radiance) > 0.0f))
            continue;
        float light_density =
            pdf > 0.0f ? light_pdf(light, ray->origin, ray->direction, INFINITY, (ps_vec3){0, 0, 0})
                       : 0.0f;
        sum = ps_rgb_add(sum, ps_rgb_scale(radiance, power_heuristic(pdf, light_density)));
    }
    return sum;
}

static ps_rgb surface_radiance(const struct scene *scene, const ps_ray *ray, const ps_hit *hit,
                               float pdf)
{
    if (!(hit->flags & PS_HIT_EMISSIVE))
        return (ps_rgb){0, 0, 0};
    ps_rgb radiance = material_emission(&scene->materials[hit->material], hit);
    uint32_t light = scene->object_lights[hit->object];
    if (!(pdf > 0.0f) || light == NO_LIGHT)
        return radiance;
    bool back = hit->flags & PS_HIT_BACK;
    ps_vec3 front = ps_scale(hit->geometric_normal, back ? -1.0f : 1.0f);
    float light_density =
        light_pdf(&scene->lights[light], ray->origin, ray->direction, hit->distance, front);
    return ps_rgb_scale(radiance, power_heuristic(pdf, light_density));
}

void emitted_radiance(const struct scene *scene, const ps_ray *rays, const ps_hit *hits,
                      const float *pdfs, size_t n, ps_rgb *radiance)
{
    for (size_t i = 0; i < n; i++) {
        float pdf = pdfs ? pdfs[i] : 0.0f;
        radiance[i] = hits[i].distance < INFINITY ? surface_radiance(scene, &rays[i], &hits[i], pdf)
                                                  : sky_radiance(scene, &rays[i], pdf);
    }
}

/* Number `sample` of each run, for the points that have it. */
static void draw_runs(const struct light_runs *runs, uint64_t seed, uint32_t sample,
                      const ps_points *points, float (*numbers)[4])
{
    uint64_t indices[PS_TILE_PIXELS];
    float drawn[PS_TILE_PIXELS][4];
    for (size_t run = 0; run < runs->count; run++)
        indices[run] = runs->first[run] + sample;
    sample_points(sample_key(seed, PS_STREAM_LIGHT, 0), indices, runs->count, drawn);
    for (size_t i = 0; i < points->count; i++)
        memcpy(numbers[i], drawn[runs->of_lane[points->lanes[i]]], sizeof numbers[i]);
}

/* Sums over the points of a tile, the shadow rays of number `from` to `end` each. */
static void add_samples(const struct receivers *receivers, uint64_t seed,
                        const struct light_runs *runs, const ps_points *points, uint32_t from,
                        uint32_t end, ps_rgb *irradiance)
{
    if (points->count == 0)
        return;
    float numbers[PS_TILE_PIXELS][4];
    struct receivers to = *receivers;
    to.numbers = to.lighting->scene->has_area_lights ? numbers : NULL;
    for (uint32_t sample = from; sample < end; sample++) {
        if (to.numbers)
            draw_runs(runs, seed, sample, points, numbers);
        add_lights(&to, irradiance);
    }
}

void direct_light_tile(const struct lighting *lighting, struct gbuffer *gbuffer, uint32_t index,
                       uint64_t seed, const struct light_runs *runs, uint32_t samples)
{
    ps_rgb *direct = &gbuffer->direct[(size_t)index * PS_TILE_PIXELS];
    ps_rgb irradiance[PS_TILE_PIXELS] = {{0, 0, 0}}, first_half[PS_TILE_PIXELS];
    uint64_t occlusion[PS_TILE_PIXELS] = {0};
    samples = lighting->scene->has_area_lights ? samples : 1;
    uint32_t half = (samples + 1) / 2;
    ps_points points;
    ps_collect_points(&gbuffer->tiles[index], &points);
    const struct receivers to = {.lighting = lighting,
                                 .n = points.count,
                                 .positions = points.positions,
                                 .normals = points.normals,
                                 .occlusion = gbuffer->occlusion ? occlusion : NULL};
    add_samples(&to, seed, runs, &points, 0, half, irradiance);
    memcpy(first_half, irradiance, sizeof first_half);
    add_samples(&to, seed, runs, &points, half, samples, irradiance);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        direct[lane] = (ps_rgb){0, 0, 0};
    for (size_t i = 0; i < points.count; i++)
        direct[points.lanes[i]] = ps_rgb_scale(irradiance[i], 1.0f / (float)samples);
    for (size_t i = 0; i < points.count && gbuffer->direct_half && samples > half; i++)
        gbuffer->direct_half[(size_t)index * PS_TILE_PIXELS + points.lanes[i]] =
            ps_rgb_scale(ps_rgb_add(irradiance[i], ps_rgb_scale(first_half[i], -1.0f)),
                         1.0f / (float)(samples - half));
    for (size_t i = 0; i < points.count && gbuffer->occlusion; i++)
        gbuffer->occlusion[(size_t)index * PS_TILE_PIXELS + points.lanes[i]] = occlusion[i];
}
