#include "gather_rays.h"

#include <string.h>

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

/* --- samples --- */

/* Of the samples of a call. */
struct round {
    uint64_t samples, all; /* of the round, and of all rounds */
    bool is_first, learns; /* more rays will be drawn by what these find */
};

static void add(struct gather *gather, size_t i, ps_rgb found, float weight, bool half)
{
    ps_rgb weighed = ps_rgb_scale(found, weight);
    gather->irradiance[i] = ps_rgb_add(gather->irradiance[i], weighed);
    if (half)
        gather->half[i] = ps_rgb_add(gather->half[i], weighed);
}

static float learnt_of(ps_rgb found)
{
    return found.r + found.g + found.b;
}

/* 1 / (c p_c + g p_g), over 1 / p_c, where p_g is `ratio` of p_c. */
static float balanced(uint64_t all, float ratio)
{
    return 1.0f / ((float)GATHER_FIRST + (float)(all - GATHER_FIRST) * ratio);
}

static float smooth_ratio(const struct gather *gather, size_t i, ps_vec3 direction, float learnt)
{
    return guide_smooth_ratio(&gather->guides[gather->guide_of[i]], gather->points.normals[i],
                              direction, learnt);
}

static void end_sample(struct gather *gather, const struct round *round, uint64_t number)
{
    bool half = number < round->samples / 2;
    for (size_t i = 0; i < gather->points.count; i++) {
        ps_rgb found = gather->found[i];
        if (round->is_first) {
            gather->first.found[number][i] = found;
            gather->first.directions[number][i] = gather->directions[i];
            add(gather, i, found, 1.0f / (float)round->samples, half);
        } else {
            float smooth = smooth_ratio(gather, i, gather->directions[i], 0.0f);
            add(gather, i, found, smooth * balanced(round->all, smooth), half);
        }
        gather->samples[i]++;
        if (round->learns)
            guide_learn(&gather->guides[gather->guide_of[i]], gather->directions[i],
                        learnt_of(found), gather->ratios[i]);
    }
}

/* Weighs the rays of the first round by the guides of the round that begins, for its share of the guided rays. */
static void add_first(struct gather *gather, const struct round *round)
{
    float share = (float)round->samples / (float)(round->all - GATHER_FIRST);
    for (size_t number = 0; number < GATHER_FIRST; number++)
        for (size_t i = 0; i < gather->points.count; i++) {
            ps_rgb found = gather->first.found[number][i];
            float learnt = learnt_of(found);
            if (!(learnt > 0.0f))
                continue;
            float ratio = smooth_ratio(gather, i, gather->first.directions[number][i], learnt);
            add(gather, i, found, share * balanced(round->all, ratio), number < GATHER_FIRST / 2);
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
        const struct guide *guide = &gather->guides[gather->guide_of[i]];
        ps_vec3 direction =
            guide_sample(guide, normal, segment->numbers[i][0], segment->numbers[i][1]);
        gather->directions[i] = direction;
        gather->ratios[i] = guide_ratio(guide, normal, direction);
        gather->places[i][0] = segment->numbers[i][2];
        gather->places[i][1] = segment->numbers[i][3];
        gather->found[i] = (ps_rgb){0, 0, 0};
        if (!(ps_dot(direction, normal) > 0.0f))
            continue;
        paths_add(paths, i,
                  ps_leave_surface(points->positions[i], normal, direction,
                                   setting->pass->surface_offset),
                  PS_PI / gather->ratios[i]);
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

static void take_sample(struct gather *gather, const struct round *round, uint64_t number_of_sample)
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
    end_sample(gather, round, number_of_sample);
}

static void update_guides(struct gather *gather)
{
    for (uint32_t i = 0; i < gather->guide_count; i++)
        guide_update(&gather->guides[i]);
}

void gather_resume(struct gather *gather, const struct gather_first *first)
{
    gather->first = *first;
    gather->done = GATHER_FIRST;
    for (size_t number = 0; number < GATHER_FIRST; number++)
        for (size_t i = 0; i < gather->points.count; i++)
            guide_learn(&gather->guides[gather->guide_of[i]], first->directions[number][i],
                        learnt_of(first->found[number][i]), 1.0f);
    update_guides(gather);
}

static void take_round(struct gather *gather, const struct round *round)
{
    const struct gather_setting *setting = gather->setting;
    uint64_t first =
        (gather->index << 32) +
        ((uint64_t)setting->paths.pass->number * setting->most + gather->done) * PS_TILE_PIXELS;
    if (gather->done == GATHER_FIRST) { /* what was added without guides is weighed anew */
        memset(gather->irradiance, 0, sizeof gather->irradiance);
        memset(gather->half, 0, sizeof gather->half);
    }
    if (!round->is_first)
        add_first(gather, round);
    for (size_t i = 0; i < gather->points.count; i++)
        gather->samples[i] = first + ps_lane_along_curve(gather->points.lanes[i]) * round->samples;
    const ps_host *host = setting->paths.host;
    for (uint64_t number = 0; number < round->samples && !host->cancelled(host); number++)
        take_sample(gather, round, number);
    gather->done += round->samples;
}

/* Rounds of 4, 12, 48, ... samples, each drawn by what those before it found. Shorter ones would learn sooner, but the
 * samples of a round are stratified together, which is worth more. */
void gather_samples(struct gather *gather, uint64_t samples)
{
    while (gather->done < samples) {
        uint64_t most = gather->done == 0 ? GATHER_FIRST : 3 * gather->done;
        uint64_t left = samples - gather->done;
        bool last = most >= left;
        struct round round = {
            .samples = last ? left : most,
            .all = samples,
            .is_first = gather->done == 0,
            .learns = !last,
        };
        take_round(gather, &round);
        if (!last)
            update_guides(gather);
    }
}
