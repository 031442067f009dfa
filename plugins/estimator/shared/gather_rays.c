#include "gather_rays.h"

#define SAME_FACING 0.8f /* cosine of two normals that share a guide */

/* --- guides --- */

static uint8_t choose_guide(struct gather *gather, ps_vec3 normal)
{
    uint32_t best = 0;
    float most = -2.0f;
    for (uint32_t i = 0; i < gather->guide_count; i++) {
        float cosine = ps_dot(gather->guides[i].normal, normal);
        if (cosine > most) {
            most = cosine;
            best = i;
        }
    }
    if (most >= SAME_FACING || gather->guide_count == GATHER_GUIDES)
        return (uint8_t)best;
    guide_begin(&gather->guides[gather->guide_count], normal);
    return (uint8_t)gather->guide_count++;
}

void gather_begin(struct gather *gather)
{
    gather->guide_count = 0;
    for (size_t i = 0; i < gather->points.count; i++)
        gather->guide_of[i] = choose_guide(gather, gather->points.normals[i]);
}

/* `learns`: whether more rays will be drawn by what this sample found; `half`: whether it is of the first half. */
static void end_sample(struct gather *gather, bool learns, bool half)
{
    for (size_t i = 0; i < gather->points.count; i++) {
        ps_rgb found = gather->found[i];
        gather->irradiance[i] = ps_rgb_add(gather->irradiance[i], found);
        if (half)
            gather->half[i] = ps_rgb_add(gather->half[i], found);
        gather->samples[i]++;
        if (!learns)
            continue;
        guide_learn(&gather->guides[gather->guide_of[i]], gather->directions[i],
                    found.r + found.g + found.b);
    }
}

/* --- rays --- */

static void start_paths(struct gather *gather, struct paths *paths, struct paths_segment *segment)
{
    const struct paths_setting *setting = &gather->setting->paths;
    const ps_points *points = &gather->points;
    setting->host->samples(setting->host, PS_STREAM_PATH, 1, gather->samples, points->count,
                           segment->numbers);
    paths->count = 0;
    for (uint32_t i = 0; i < points->count; i++) {
        ps_vec3 normal = points->normals[i];
        float pdf;
        ps_vec3 direction = guide_sample(&gather->guides[gather->guide_of[i]], normal,
                                         segment->numbers[i][0], segment->numbers[i][1], &pdf);
        float cosine = ps_dot(direction, normal);
        gather->directions[i] = direction;
        gather->places[i][0] = segment->numbers[i][2];
        gather->places[i][1] = segment->numbers[i][3];
        gather->found[i] = (ps_rgb){0, 0, 0};
        if (!(cosine > 0.0f))
            continue;
        paths_add(paths, i,
                  ps_leave_surface(points->positions[i], normal, direction,
                                   setting->pass->surface_offset),
                  cosine / pdf);
    }
}

/* What the cache knows of the light that a diffuse surface sends back along a path's ray: it takes the place of the rest
 * of the path, whose throughput has the surface's reflectance in it. */
static bool add_cached(struct gather *gather, const struct paths *paths, ps_rgb weight,
                       const struct paths_segment *segment, size_t i)
{
    const struct gather_setting *setting = gather->setting;
    const ps_hit *hit = &segment->hits[i];
    ps_rgb irradiance;
    /* Where bounces are counted, the cache knows those that are left after one surface. */
    bool counted = setting->paths.pass->bounces != PS_ALL_BOUNCES;
    if (!setting->lookup || (counted && paths->bounces[i] > 0) ||
        !setting->lookup(setting->cache, hit->position, hit->normal, hit->distance,
                         gather->places[paths->pixels[i]], &irradiance))
        return false;
    ps_rgb *found = &gather->found[paths->pixels[i]];
    ps_rgb light = ps_rgb_scale(ps_rgb_multiply(weight, irradiance), 1.0f / PS_PI);
    *found = ps_rgb_add(*found, ps_rgb_multiply(paths->throughput[i], light));
    return true;
}

/* Ends paths on surfaces that are only diffuse by the cache. */
static void end_diffuse(struct gather *gather, struct paths *paths, struct paths_segment *segment)
{
    size_t left = 0;
    for (size_t i = 0; i < paths->count; i++) {
        const ps_hit *hit = &segment->hits[i];
        if (!(hit->flags & PS_HIT_SPECULAR) && add_cached(gather, paths, hit->albedo, segment, i))
            continue;
        segment->hits[left] = *hit;
        paths_move(paths, i, left++);
    }
    paths->count = left;
}

/* Sends the others on, or ends them where their lobe is diffuse. */
static void scatter_paths(struct gather *gather, struct paths *paths, struct paths_segment *segment)
{
    const struct paths_setting *setting = &gather->setting->paths;
    ps_bsdf_sample scattered[PS_TILE_PIXELS];
    setting->host->sample_bsdf(setting->host, PS_FROM_CAMERA, paths->rays, segment->hits,
                               (const float(*)[4])segment->numbers, paths->count, scattered);
    size_t alive = 0;
    for (size_t i = 0; i < paths->count; i++) {
        if (segment->hits[i].flags & PS_HIT_SPECULAR && scattered[i].lobe == PS_DIFFUSE &&
            add_cached(gather, paths, scattered[i].weight, segment, i))
            continue;
        if (paths_scatter(setting, &scattered[i], segment, paths, i))
            paths_move(paths, i, alive++);
    }
    paths->count = alive;
}

static void take_sample(struct gather *gather, bool learns, bool half)
{
    const struct paths_setting *setting = &gather->setting->paths;
    struct paths paths;
    struct paths_segment segment;
    start_paths(gather, &paths, &segment);
    for (uint32_t number = 1; paths.count > 0; number++) {
        paths_intersect(setting, &gather->points, number, &paths, &segment);
        paths_add_light(setting, number, gather->samples, &paths, &segment, gather->found);
        end_diffuse(gather, &paths, &segment);
        paths_draw_numbers(setting, number + 1, gather->samples, &paths, &segment);
        scatter_paths(gather, &paths, &segment);
    }
    end_sample(gather, learns, half);
}

void gather_update_guides(struct gather *gather)
{
    for (uint32_t i = 0; i < gather->guide_count; i++)
        guide_update(&gather->guides[i]);
}

static void take_round(struct gather *gather, uint64_t round, bool last)
{
    const struct gather_setting *setting = gather->setting;
    uint64_t first =
        (gather->index << 32) +
        ((uint64_t)setting->paths.pass->number * setting->most + gather->done) * PS_TILE_PIXELS;
    for (size_t i = 0; i < gather->points.count; i++)
        gather->samples[i] = first + ps_lane_along_curve(gather->points.lanes[i]) * round;
    for (uint64_t sample = 0; sample < round; sample++)
        take_sample(gather, !last || gather->goes_on, sample < round / 2);
    gather->done += round;
}

/* Rounds of 4, 12, 48, ... samples, each drawn by what those before it found. Shorter ones would learn sooner, but the
 * samples of a round are stratified together, which is worth more. */
void gather_samples(struct gather *gather, uint64_t samples)
{
    while (gather->done < samples) {
        uint64_t round = gather->done == 0 ? GATHER_FIRST : 3 * gather->done;
        uint64_t left = samples - gather->done;
        bool last = round >= left;
        take_round(gather, last ? left : round, last);
        if (!last)
            gather_update_guides(gather);
    }
}
