#include "gather_rays.h"

#include <string.h>

#define SAME_FACING 0.8f /* cosine of two normals that share a guide */
#define FROM_AROUND 0.5f /* of the light that the gathers around found, for that found here */

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
    gather->expected[0] = gather->expected[1] = gather->setting->samples;
    for (size_t i = 0; i < gather->points.count; i++)
        gather->guide_of[i] = choose_guide(gather, gather->points.normals[i]);
}

/* --- samples --- */

/* Of the samples of a call. */
struct round {
    uint64_t samples;
    float share;           /* of the guided samples of all rounds */
    bool is_first, learns; /* more rays will be drawn by what these find */
};

/* Guided ones of so many samples. */
static uint64_t guided_of(uint64_t samples)
{
    return samples > GATHER_FIRST ? samples - GATHER_FIRST : 0;
}

static void add(struct gather *gather, size_t i, ps_rgb found, float weight, bool half)
{
    ps_rgb weighed = ps_rgb_scale(found, weight);
    gather->irradiance[i] = ps_rgb_add(gather->irradiance[i], weighed);
    if (half)
        gather->half[i] = ps_rgb_add(gather->half[i], weighed);
}

int gather_half_of(const struct gather *gather, size_t point)
{
    return ps_lane_along_curve(gather->points.lanes[point]) >= PS_TILE_PIXELS / 2;
}

static float expected_of(const struct gather *gather, size_t i)
{
    return (float)guided_of(gather->expected[gather_half_of(gather, i)]);
}

/* p_c / (c p_c + g q), where q is `ratio` of p_c and g the guided rays that are expected. */
static float balanced(const struct gather *gather, size_t i, float ratio)
{
    return 1.0f / ((float)GATHER_FIRST + expected_of(gather, i) * ratio);
}

static void learn(struct gather *gather, size_t i, struct guide_bin bin, ps_rgb found)
{
    guide_learn(&gather->guides[gather->guide_of[i]], gather_half_of(gather, i), bin,
                found.r + found.g + found.b);
}

static float smooth_ratio(const struct gather *gather, size_t i, struct guide_bin bin)
{
    return guide_smooth_ratio(&gather->guides[gather->guide_of[i]], gather_half_of(gather, i), bin);
}

static void end_sample(struct gather *gather, const struct round *round, uint64_t number)
{
    bool half = number < round->samples / 2;
    for (size_t i = 0; i < gather->points.count; i++) {
        ps_rgb found = gather->found[i];
        if (round->is_first) {
            gather->first.found[number][i] = found;
            gather->first.bins[number][i] = gather->bins[i];
            add(gather, i, found, 1.0f / (float)round->samples, half);
        } else {
            float ratio = smooth_ratio(gather, i, gather->bins[i]);
            float each = round->share / (float)round->samples;
            add(gather, i, found,
                each * expected_of(gather, i) * ratio * balanced(gather, i, ratio), half);
        }
        gather->samples[i]++;
        if (round->learns)
            learn(gather, i, gather->bins[i], found);
    }
}

/* Weighs the rays of the first round by the guides of the round that begins, for its share of the guided rays. */
static void add_first(struct gather *gather, const struct round *round)
{
    for (size_t number = 0; number < GATHER_FIRST; number++)
        for (size_t i = 0; i < gather->points.count; i++) {
            ps_rgb found = gather->first.found[number][i];
            if (!(ps_luminance(found) > 0.0f))
                continue;
            float ratio = smooth_ratio(gather, i, gather->first.bins[number][i]);
            add(gather, i, found, round->share * balanced(gather, i, ratio),
                number < GATHER_FIRST / 2);
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
        gather->bins[i] = guide_bin_of(guide, normal, direction);
        gather->places[i][0] = segment->numbers[i][2];
        gather->places[i][1] = segment->numbers[i][3];
        gather->found[i] = (ps_rgb){0, 0, 0};
        if (!(ps_dot(direction, normal) > 0.0f))
            continue;
        paths_add(paths, i,
                  ps_leave_surface(points->positions[i], normal, direction,
                                   setting->pass->surface_offset),
                  PS_PI / guide_ratio(guide, gather->bins[i]));
    }
}

/* What the cache knows of the light where a path's ray landed. */
static bool look_up(const struct gather *gather, const struct paths *paths,
                    const struct paths_segment *segment, size_t i, struct gather_known *known)
{
    const struct gather_setting *setting = gather->setting;
    const ps_hit *hit = &segment->hits[i];
    /* Where bounces are counted, the cache knows those that are left after one surface. */
    bool counted = setting->paths.pass->bounces != PS_ALL_BOUNCES;
    return setting->lookup && !(counted && paths->bounces[i] > 0) &&
           setting->lookup(setting->cache, hit->position, hit->normal, hit->distance,
                           gather->places[paths->pixels[i]], known);
}

/* Adds what a diffuse surface of that reflectance sends back along a path's ray of irradiance. */
static void add_known(struct gather *gather, const struct paths *paths, size_t i,
                      ps_rgb reflectance, ps_rgb irradiance)
{
    ps_rgb *found = &gather->found[paths->pixels[i]];
    ps_rgb light = ps_rgb_scale(ps_rgb_multiply(reflectance, irradiance), 1.0f / PS_PI);
    *found = ps_rgb_add(*found, ps_rgb_multiply(paths->throughput[i], light));
}

/* Adds the light of the lights, and what the cache knows of surfaces that are only diffuse; paths end where that is all. */
static void light_paths(struct gather *gather, uint32_t number, struct paths *paths,
                        struct paths_segment *segment)
{
    const struct gather_setting *setting = gather->setting;
    struct gather_known known[PS_TILE_PIXELS];
    bool is_known[PS_TILE_PIXELS];
    uint8_t groups[PS_TILE_PIXELS];
    size_t left = 0;
    for (size_t i = 0; i < paths->count; i++) {
        is_known[i] = !(segment->hits[i].flags & PS_HIT_SPECULAR) &&
                      look_up(gather, paths, segment, i, &known[i]);
        groups[i] = is_known[i] && setting->knows_sky ? PS_LIGHTS_OTHERS : PS_LIGHTS_ALL;
    }
    paths_add_reflected(&setting->paths, number, gather->samples, paths, groups, segment,
                        gather->found);
    for (size_t i = 0; i < paths->count; i++) {
        if (is_known[i])
            add_known(gather, paths, i, segment->hits[i].albedo,
                      ps_rgb_add(known[i].indirect, known[i].sky));
        if (is_known[i] && setting->knows_indirect)
            continue;
        segment->hits[left] = segment->hits[i];
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
        struct gather_known known;
        if (gather->setting->knows_indirect && segment->hits[i].flags & PS_HIT_SPECULAR &&
            scattered[i].lobe == PS_DIFFUSE && look_up(gather, paths, segment, i, &known)) {
            add_known(gather, paths, i, scattered[i].weight, known.indirect);
            continue;
        }
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
        paths_add_emitted(setting, &paths, &segment, gather->found);
        light_paths(gather, number, &paths, &segment);
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

void gather_teach(struct gather *gather)
{
    struct gather_first *first = &gather->first;
    for (size_t number = 0; number < GATHER_FIRST; number++)
        for (size_t i = 0; i < gather->points.count; i++)
            learn(gather, i, first->bins[number][i], first->found[number][i]);
    first->guide_count = gather->guide_count;
    for (uint32_t i = 0; i < gather->guide_count; i++) {
        const struct guide *guide = &gather->guides[i];
        first->lessons[i].normal = guide->normal;
        first->lessons[i].u = guide->u;
        memcpy(first->lessons[i].found, guide->found, sizeof guide->found);
    }
}

/* Neighbours know of light that the few rays here have missed, and where these were lucky, do not point there because of it. */
static void learn_from_around(struct gather *gather, const struct gather_first *const around[],
                              size_t count)
{
    for (size_t k = 0; k < count; k++)
        for (uint32_t i = 0; i < gather->guide_count; i++)
            for (uint32_t j = 0; j < around[k]->guide_count; j++)
                guide_learn_from(&gather->guides[i], &around[k]->lessons[j], FROM_AROUND);
}

void gather_resume(struct gather *gather, const struct gather_first *first,
                   const struct gather_first *const around[], size_t count)
{
    gather->first = *first;
    gather->done = GATHER_FIRST;
    for (uint32_t i = 0; i < gather->guide_count; i++)
        memcpy(gather->guides[i].found, first->lessons[i].found, sizeof first->lessons[i].found);
    learn_from_around(gather, around, count);
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
        uint64_t taken = last ? left : most;
        struct round round = {
            .samples = taken,
            .share = gather->done > 0 ? (float)taken / (float)guided_of(samples) : 0.0f,
            .is_first = gather->done == 0,
            .learns = !last,
        };
        take_round(gather, &round);
        if (!last)
            update_guides(gather);
    }
}
