/* paths.h: paths from the pixels of a tile, which advance together: what path tracing, gathering
 * and compensation have in common.
 *
 * Kajiya 1986. A path goes on at every surface by its own scattering. At each one the light of the
 * lights that it reflects is added (next-event estimation), and after mirrors, glass and gloss the
 * emission that the path meets, which are caustics; gloss weighs both. Emission met from a diffuse
 * surface is direct light of that surface, and counted there. Russian roulette ends paths at
 * diffuse surfaces.
 *
 * Random numbers are those of one set for each segment, four dimensions each. Rays go to the tracer
 * in packets.
 */
#ifndef PSPLAT_ESTIMATOR_PATHS_H
#define PSPLAT_ESTIMATOR_PATHS_H

#include <psplat/plugin.h>
#include <stdbool.h>

/* Sets of the random numbers that choose points on lights; directions take 1, 2, 3, ... */
#define PATHS_LIGHT_SETS 0x10000u

#define PATHS_ANY_LOBE UINT32_MAX

#define PATHS_ALL_CAUSTICS 2.0f /* any roughness is below it */

struct paths_setting {
    const ps_host *host;
    const ps_pass *pass;
    uint32_t roulette; /* bounce from which on paths may be ended */
    /* Somebody else adds the caustics on the points that paths start from: light that a surface
     * smoother than this roughness sends on, and perhaps others, none of them diffusely. 0: nobody
     * does. */
    float caustics_below;
    /* Only light that all surfaces on its way have scattered diffusely, or by gloss no smoother
     * than this roughness. 0: any. */
    float least_roughness;
};

/* The paths of one sample of a tile that are still under way; entry i belongs to pixel
 * pixels[i]. */
struct paths {
    size_t count;
    uint32_t pixels[PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb throughput
        [PS_TILE_PIXELS]; /* what radiance is multiplied by to be irradiance of the pixel */
    uint32_t bounces[PS_TILE_PIXELS]; /* diffuse surfaces met */
    uint32_t chain[PS_TILE_PIXELS];   /* others since the last one */
    float pdfs[PS_TILE_PIXELS];       /* of the last scattering, where its lobe was glossy */
    float spreads[PS_TILE_PIXELS];    /* of the cone around the ray (ps_cone_spread) */
    float lengths[PS_TILE_PIXELS];    /* of the way from the last diffuse surface to the ray */
    uint8_t shines[PS_TILE_PIXELS];   /* whether emission that is met counts */
    /* Whether all surfaces on the way have mirrored, refracted or shone by gloss, and one of them
     * is smoother than setting->caustics_below: what is found is a caustic, which somebody else
     * adds. */
    uint8_t caustic[PS_TILE_PIXELS];
};

/* What a segment needs for each path. */
struct paths_segment {
    ps_hit hits[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS]; /* of the random numbers */
    float numbers[PS_TILE_PIXELS][4];
};

static inline void paths_move(struct paths *paths, size_t from, size_t to)
{
    paths->pixels[to] = paths->pixels[from];
    paths->rays[to] = paths->rays[from];
    paths->throughput[to] = paths->throughput[from];
    paths->bounces[to] = paths->bounces[from];
    paths->chain[to] = paths->chain[from];
    paths->pdfs[to] = paths->pdfs[from];
    paths->spreads[to] = paths->spreads[from];
    paths->lengths[to] = paths->lengths[from];
    paths->shines[to] = paths->shines[from];
    paths->caustic[to] = paths->caustic[from];
}

/* `samples`: the index of each pixel's sample. */
static inline void paths_find_indices(const uint64_t *samples, const struct paths *paths,
                                      struct paths_segment *segment)
{
    for (size_t i = 0; i < paths->count; i++)
        segment->indices[i] = samples[paths->pixels[i]];
}

static inline void paths_draw_numbers(const struct paths_setting *setting, uint32_t set,
                                      const uint64_t *samples, const struct paths *paths,
                                      struct paths_segment *segment)
{
    paths_find_indices(samples, paths, segment);
    setting->host->samples(setting->host, PS_STREAM_PATH, set, segment->indices, paths->count,
                           segment->numbers);
}

/* What the paths meet with their segment of that number, from 1. */
static inline void paths_intersect(const struct paths_setting *setting, const ps_points *points,
                                   uint32_t number, const struct paths *paths,
                                   struct paths_segment *segment)
{
    setting->host->intersect_cones(setting->host, paths->rays, paths->spreads, paths->count,
                                   segment->hits);
    if (number == 1)
        ps_forget_own_surface(points, paths->pixels, paths->count, setting->pass->surface_offset,
                              segment->hits);
}

/* A path leaves a pixel's point along a ray. Russian roulette takes throughput in proportion to pi,
 * with which paths by the cosine start. */
static inline void paths_add(struct paths *paths, uint32_t pixel, ps_ray ray, float throughput)
{
    size_t i = paths->count++;
    paths->pixels[i] = pixel;
    paths->rays[i] = ray;
    paths->throughput[i] = (ps_rgb){throughput, throughput, throughput};
    paths->bounces[i] = paths->chain[i] = 0;
    paths->pdfs[i] = paths->lengths[i] = 0.0f;
    paths->spreads[i] = PS_DIFFUSE_SPREAD;
    paths->shines[i] = paths->caustic[i] = 0;
}

/* One path from each point, by cos(theta) / pi: pi times the radiance along it is an estimate of
 * irradiance. It meets nothing farther away than `reach`. */
static inline void paths_start(const struct paths_setting *setting, const ps_points *points,
                               const uint64_t *samples, float reach, struct paths *paths,
                               struct paths_segment *segment)
{
    setting->host->samples(setting->host, PS_STREAM_PATH, 1, samples, points->count,
                           segment->numbers);
    paths->count = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        ps_vec3 normal = points->normals[i];
        ps_vec3 direction =
            ps_cosine_direction(normal, segment->numbers[i][0], segment->numbers[i][1]);
        ps_ray ray = ps_leave_surface(points->positions[i], normal, direction,
                                      setting->pass->surface_offset);
        ray.tfar = reach;
        paths_add(paths, i, ray, PS_PI);
    }
}

static inline void paths_add_radiance(const struct paths *paths, const ps_rgb *radiance,
                                      ps_rgb *sums)
{
    for (size_t i = 0; i < paths->count; i++) {
        ps_rgb *sum = &sums[paths->pixels[i]];
        *sum = ps_rgb_add(*sum, ps_rgb_multiply(paths->throughput[i], radiance[i]));
    }
}

/* Adds the emission that paths met after mirrors, glass and gloss, but for caustics that somebody
 * else adds. */
static inline void paths_add_emission(const struct paths_setting *setting,
                                      const struct paths *paths,
                                      const struct paths_segment *segment, ps_rgb *sums)
{
    ps_rgb radiance[PS_TILE_PIXELS];
    uint8_t any_shines = 0;
    for (size_t i = 0; i < paths->count; i++)
        any_shines |= paths->shines[i];
    if (!any_shines)
        return;
    setting->host->emitted_radiance(setting->host, paths->rays, segment->hits, paths->pdfs,
                                    paths->count, radiance);
    for (size_t i = 0; i < paths->count; i++)
        if (!paths->shines[i])
            radiance[i] = (ps_rgb){0, 0, 0};
    paths_add_radiance(paths, radiance, sums);
}

/* Drops paths that met nothing. */
static inline void paths_drop_lost(struct paths *paths, struct paths_segment *segment)
{
    size_t met = 0;
    for (size_t i = 0; i < paths->count; i++) {
        if (!(segment->hits[i].distance < INFINITY))
            continue;
        segment->hits[met] = segment->hits[i];
        paths_move(paths, i, met++);
    }
    paths->count = met;
}

/* Past its last diffuse bounce a path can only find lights in mirrors and glass. */
static inline int paths_is_last(const struct paths_setting *setting, const struct paths *paths,
                                size_t i)
{
    return paths->bounces[i] >= setting->pass->bounces;
}

/* Adds what the surfaces that were met reflect of the lights: of those of some groups, for each
 * path (NULL: of all). */
static inline void paths_add_direct(const struct paths_setting *setting, uint32_t number,
                                    const struct paths *paths, const uint8_t *groups,
                                    struct paths_segment *segment, ps_rgb *sums)
{
    ps_rgb radiance[PS_TILE_PIXELS], albedos[PS_TILE_PIXELS];
    for (size_t i = 0; i < paths->count; i++) {
        albedos[i] = segment->hits[i].albedo;
        if (paths_is_last(setting, paths, i))
            segment->hits[i].albedo = (ps_rgb){0, 0, 0};
    }
    setting->host->direct_radiance_of(setting->host, paths->rays, segment->hits, groups,
                                      PS_STREAM_PATH, PATHS_LIGHT_SETS + number, segment->indices,
                                      paths->count, radiance);
    paths_add_radiance(paths, radiance, sums);
    for (size_t i = 0; i < paths->count; i++)
        segment->hits[i].albedo = albedos[i];
}

/* Whether a path is on the way of such a caustic where this surface sends it on, but not
 * diffusely. */
static inline int paths_is_caustic_after(const struct paths_setting *setting,
                                         const struct paths *paths, size_t i, float roughness)
{
    return paths->bounces[i] == 0 && (paths->caustic[i] || roughness < setting->caustics_below);
}

/* Adds what surfaces that were met reflect of the lights; diffusely alone on the way of caustics
 * that somebody else adds, and where they are smoother than setting->least_roughness. */
static inline void paths_add_direct_without_caustics(const struct paths_setting *setting,
                                                     uint32_t number, const struct paths *paths,
                                                     const uint8_t *groups,
                                                     struct paths_segment *segment, ps_rgb *sums)
{
    uint32_t flags[PS_TILE_PIXELS] = {0};
    for (size_t i = 0; i < paths->count; i++) {
        flags[i] = segment->hits[i].flags;
        float roughness = segment->hits[i].roughness;
        if (roughness < setting->least_roughness ||
            paths_is_caustic_after(setting, paths, i, roughness))
            segment->hits[i].flags &= ~PS_HIT_SPECULAR;
    }
    paths_add_direct(setting, number, paths, groups, segment, sums);
    for (size_t i = 0; i < paths->count; i++)
        segment->hits[i].flags = flags[i];
}

/* Adds what is emitted where paths land; drops paths that met nothing. */
static inline void paths_add_emitted(const struct paths_setting *setting, struct paths *paths,
                                     struct paths_segment *segment, ps_rgb *sums)
{
    paths_add_emission(setting, paths, segment, sums);
    paths_drop_lost(paths, segment);
}

/* Adds what is reflected there, but for what the setting leaves out; `groups` as in
 * paths_add_direct(). */
static inline void paths_add_reflected(const struct paths_setting *setting, uint32_t number,
                                       const uint64_t *samples, const struct paths *paths,
                                       const uint8_t *groups, struct paths_segment *segment,
                                       ps_rgb *sums)
{
    paths_find_indices(samples, paths, segment);
    if (setting->caustics_below > 0.0f || setting->least_roughness > 0.0f)
        paths_add_direct_without_caustics(setting, number, paths, groups, segment, sums);
    else
        paths_add_direct(setting, number, paths, groups, segment, sums);
}

/* Whether a path goes on after a surface of that roughness that scatters like this. */
static inline int paths_goes_on(const struct paths_setting *setting,
                                const ps_bsdf_sample *scattered, float roughness, float number,
                                struct paths *paths, size_t i)
{
    ps_rgb *throughput = &paths->throughput[i];
    *throughput = ps_rgb_multiply(*throughput, scattered->weight);
    float likelihood = ps_rgb_maximum(*throughput) / PS_PI;
    if (!(likelihood > 0.0f))
        return 0;
    if (scattered->lobe != PS_DIFFUSE)
        return roughness >= setting->least_roughness && ++paths->chain[i] <= PS_LONGEST_CHAIN;
    if (paths_is_last(setting, paths, i))
        return 0;
    paths->chain[i] = 0;
    paths->bounces[i]++;
    if (paths_is_last(setting, paths, i) && !setting->pass->specular)
        return 0;
    return paths->bounces[i] < setting->roulette ||
           ps_russian_roulette(likelihood, number, throughput);
}

/* Sends a path on from its hit; false where it ends. */
static inline int paths_scatter(const struct paths_setting *setting,
                                const ps_bsdf_sample *scattered,
                                const struct paths_segment *segment, struct paths *paths, size_t i)
{
    float roughness = segment->hits[i].roughness;
    int is_caustic = paths_is_caustic_after(setting, paths, i, roughness);
    if (!paths_goes_on(setting, scattered, roughness, segment->numbers[i][2], paths, i))
        return 0;
    paths->caustic[i] = (uint8_t)(scattered->lobe != PS_DIFFUSE && is_caustic);
    paths->rays[i] = ps_leave_surface(segment->hits[i].position, scattered->normal,
                                      scattered->direction, setting->pass->surface_offset);
    paths->shines[i] = scattered->lobe != PS_DIFFUSE && !paths->caustic[i];
    paths->pdfs[i] = scattered->lobe == PS_GLOSSY ? scattered->pdf : 0.0f;
    paths->lengths[i] =
        scattered->lobe == PS_DIFFUSE ? 0.0f : paths->lengths[i] + segment->hits[i].distance;
    if (scattered->lobe != PS_SPECULAR) /* a mirror keeps the cone */
        paths->spreads[i] = ps_cone_spread(scattered->pdf);
    return 1;
}

/* Sends the paths on from their hits. `lobes`: what they may go on by, 1 << PS_DIFFUSE and so on;
 * the others end. */
static inline void paths_scatter_all(const struct paths_setting *setting, uint32_t lobes,
                                     struct paths *paths, struct paths_segment *segment)
{
    ps_bsdf_sample scattered[PS_TILE_PIXELS];
    setting->host->sample_bsdf(setting->host, PS_FROM_CAMERA, paths->rays, segment->hits,
                               (const float(*)[4])segment->numbers, paths->count, scattered);
    size_t alive = 0;
    for (size_t i = 0; i < paths->count; i++)
        if (lobes >> scattered[i].lobe & 1u &&
            paths_scatter(setting, &scattered[i], segment, paths, i))
            paths_move(paths, i, alive++);
    paths->count = alive;
}

/* Follows paths, whose segment of that number has been intersected, to their ends: adds what the
 * surfaces that they meet emit and reflect. */
static inline void paths_go_on(const struct paths_setting *setting, const ps_points *points,
                               const uint64_t *samples, uint32_t number, struct paths *paths,
                               struct paths_segment *segment, ps_rgb *sums)
{
    while (paths->count > 0) {
        paths_add_emitted(setting, paths, segment, sums);
        paths_add_reflected(setting, number, samples, paths, NULL, segment, sums);
        paths_draw_numbers(setting, ++number, samples, paths, segment);
        paths_scatter_all(setting, PATHS_ANY_LOBE, paths, segment);
        paths_intersect(setting, points, number, paths, segment);
    }
}

/* The same, from their segment of that number on. */
static inline void paths_follow(const struct paths_setting *setting, const ps_points *points,
                                const uint64_t *samples, uint32_t number, struct paths *paths,
                                struct paths_segment *segment, ps_rgb *sums)
{
    paths_intersect(setting, points, number, paths, segment);
    paths_go_on(setting, points, samples, number, paths, segment, sums);
}

/* One sample of each point of a tile: adds to their sums. */
typedef void (*paths_trace)(const void *user, const ps_points *points, const uint64_t *samples,
                            ps_rgb *sums);

/* The mean of `count` samples for each point, those of a pass that ps_tile_sample() chooses. Means
 * nothing after the host was cancelled. */
static inline void paths_average(const struct paths_setting *setting, uint64_t tile,
                                 const ps_points *points, uint64_t count, paths_trace trace,
                                 const void *user, ps_rgb *irradiance)
{
    const ps_host *host = setting->host;
    uint64_t samples[PS_TILE_PIXELS];
    ps_rgb sums[PS_TILE_PIXELS] = {{0, 0, 0}};
    for (size_t i = 0; i < points->count; i++)
        samples[i] = ps_tile_sample(tile, points->lanes[i], setting->pass->number, count);
    for (uint64_t sample = 0; sample < count && !host->cancelled(host); sample++) {
        trace(user, points, samples, sums);
        for (size_t i = 0; i < points->count; i++)
            samples[i]++;
    }
    for (size_t i = 0; i < points->count; i++)
        irradiance[i] = ps_rgb_scale(sums[i], 1.0f / (float)count);
}

#endif
