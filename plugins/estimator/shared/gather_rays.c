#include "gather_rays.h"

#include "contact.h"
#include "gather_guides.h"

#include <string.h>

#define FROM_AROUND 0.5f /* of the light that the gathers around found, for that found here */

/* Two rays teach less than four, and single lucky ones leave specks where light is rare; but of few
 * samples, four would leave hardly any to be guided, and of two or three one guided ray is not
 * worth what guides cost. */
uint64_t gather_first_of(uint64_t samples)
{
    if (samples < GATHER_MOST_FIRST)
        return samples;
    return samples < 2 * GATHER_MOST_FIRST ? GATHER_MOST_FIRST / 2 : GATHER_MOST_FIRST;
}

void gather_begin(struct gather *gather)
{
    gather->expected_samples[0] = gather->expected_samples[1] = gather->setting->samples;
    for (size_t i = 0; i < gather->points.count; i++) {
        gather->first.factors[i] = 1.0f;
        gather->first.nearest[i] = INFINITY;
    }
    gather_choose_guides(gather);
}

/* --- samples --- */

/* Samples that points take one after the other, before guides learn from them. */
struct round {
    uint64_t samples;       /* of the group in all */
    uint64_t longest;       /* of the point that takes most in this round */
    bool is_first, teaches; /* more rays will be drawn by what these find */
};

/* Some of a round's, whose paths advance together. */
struct batch {
    const struct round *round;
    ps_points points;                 /* that they leave */
    uint32_t of[PS_TILE_PIXELS];      /* which of the group's that is */
    uint64_t numbers[PS_TILE_PIXELS]; /* of the samples, among their points' of the round */
    uint64_t indices[PS_TILE_PIXELS]; /* of their random numbers */
    /* What they found, where their first directions lie, and random numbers for lookups. */
    ps_rgb found[PS_TILE_PIXELS];
    struct guide_bin bins[PS_TILE_PIXELS];
    float places[PS_TILE_PIXELS][2];
};

/* Guided ones of a point, where its group has so many samples. */
static uint64_t guided_of(const struct gather *gather, size_t point, uint64_t samples)
{
    if (samples <= gather->setting->first)
        return 0;
    float wanted = (float)(samples - gather->setting->first) * gather->first.factors[point];
    return wanted > 1.0f ? (uint64_t)(wanted + 0.5f) : 1;
}

static void add(struct gather *gather, size_t i, ps_rgb found, float weight, bool half)
{
    ps_rgb weighed = ps_rgb_scale(found, weight);
    gather->irradiance[i] = ps_rgb_add(gather->irradiance[i], weighed);
    if (half)
        gather->half[i] = ps_rgb_add(gather->half[i], weighed);
}

static void add_square(struct gather *gather, size_t i, ps_rgb found, float weight)
{
    float light = weight * contact_mean_of_channels(found);
    gather->squares[i] += light * light;
}

float gather_variance(const struct gather *gather, size_t point, uint64_t samples)
{
    float n = (float)(gather->setting->first + guided_of(gather, point, samples));
    float sum = contact_mean_of_channels(gather->irradiance[point]),
          squares = gather->squares[point];
    for (uint64_t number = 0; number < gather->setting->first; number++) {
        float weight = gather->first_weights[number][point];
        float light = weight * contact_mean_of_channels(gather->first.found[number][point]);
        squares += light * light;
    }
    return ps_max(squares - sum * sum / n, 0.0f) * n / (n - 1.0f);
}

int gather_half_of(const struct gather *gather, size_t point)
{
    return ps_lane_along_curve(gather->points.lanes[point]) >= PS_TILE_PIXELS / 2;
}

static float first_ratio(const struct gather *gather, size_t i, struct guide_bin bin)
{
    return gather->first.is_guided ? guide_ratio(&gather->first_guides[gather->guide_of[i]], bin)
                                   : 1.0f;
}

/* p_c / (c p + g q), where p and q are `first` and `ratio` of the cosine's density p_c, and g the
 * guided rays that are expected. */
static float balanced(const struct gather *gather, size_t i, float first, float ratio)
{
    return 1.0f / ((float)gather->setting->first * first + gather->guided_expected[i] * ratio);
}

static void add_to_guide(struct gather *gather, size_t i, struct guide_bin bin, ps_rgb found)
{
    guide_add(&gather->guides[gather->guide_of[i]], gather_half_of(gather, i), bin,
              found.r + found.g + found.b);
}

static float smooth_ratio(const struct gather *gather, size_t i, struct guide_bin bin)
{
    return guide_smooth_ratio(&gather->guides[gather->guide_of[i]], gather_half_of(gather, i), bin);
}

static void end_sample(struct gather *gather, const struct batch *batch, size_t k)
{
    const struct round *round = batch->round;
    size_t i = batch->of[k];
    uint64_t number = batch->numbers[k];
    bool half = number < gather->taken[i] / 2;
    ps_rgb found = batch->found[k];
    if (round->is_first) {
        gather->first.found[number][i] = found;
        gather->first.bins[number][i] = batch->bins[k];
        add(gather, i, found, 1.0f / (float)gather->taken[i], half);
    } else {
        float ratio = smooth_ratio(gather, i, batch->bins[k]);
        float first = first_ratio(gather, i, batch->bins[k]);
        float guided = gather->guided_expected[i] * ratio * balanced(gather, i, first, ratio);
        float weight = gather->guided_share[i] * guided;
        add(gather, i, found, weight, half);
        add_square(gather, i, found, weight);
    }
    if (round->teaches)
        add_to_guide(gather, i, batch->bins[k], found);
}

/* Weighs the rays of the first round by the guides of the round that begins, for its share of the
 * guided rays. */
static void add_first(struct gather *gather)
{
    for (size_t number = 0; number < gather->setting->first; number++)
        for (size_t i = 0; i < gather->points.count; i++) {
            ps_rgb found = gather->first.found[number][i];
            if (gather->taken[i] == 0 || !(ps_luminance(found) > 0.0f))
                continue;
            float share = (float)gather->taken[i] * gather->guided_share[i];
            struct guide_bin bin = gather->first.bins[number][i];
            float first = first_ratio(gather, i, bin);
            float ratio = smooth_ratio(gather, i, bin);
            float weight = share * first * balanced(gather, i, first, ratio);
            add(gather, i, found, weight, number < gather->setting->first / 2);
            gather->first_weights[number][i] += weight;
        }
}

/* --- rays --- */

static void start_paths(const struct gather *gather, struct batch *batch, struct paths *paths,
                        struct paths_segment *segment)
{
    const struct paths_setting *setting = &gather->setting->paths;
    const ps_points *points = &batch->points;
    bool by_photons = batch->round->is_first && gather->first.is_guided;
    const struct guide *guides = by_photons ? gather->first_guides : gather->guides;
    setting->host->samples(setting->host, PS_STREAM_PATH, 1, batch->indices, points->count,
                           segment->numbers);
    paths->count = 0;
    for (uint32_t k = 0; k < points->count; k++) {
        /* Not a copy: GCC 12 puts one together on the stack, and waits for that to load it. */
        const ps_vec3 *normal = &points->normals[k];
        const struct guide *guide = &guides[gather->guide_of[batch->of[k]]];
        struct guide_sample sample =
            guide_sample(guide, *normal, segment->numbers[k][0], segment->numbers[k][1]);
        batch->bins[k] = sample.bin;
        batch->places[k][0] = segment->numbers[k][2];
        batch->places[k][1] = segment->numbers[k][3];
        batch->found[k] = (ps_rgb){0, 0, 0};
        if (!(ps_dot(sample.direction, *normal) > 0.0f))
            continue;
        paths_add(paths, k,
                  ps_leave_surface(points->positions[k], *normal, sample.direction,
                                   setting->pass->surface_offset),
                  PS_PI / sample.ratio);
    }
}

/* Looks up what the cache knows where the rays of some paths landed: of those that are marked. */
static void look_up(const struct gather_setting *setting, const struct batch *batch,
                    const struct paths *paths, const struct paths_segment *segment,
                    const bool *marked, struct cached_irradiance *known, bool *is_known)
{
    /* Where bounces are counted, the cache knows those that are left after one surface. */
    bool counted = setting->paths.pass->bounces != PS_ALL_BOUNCES;
    struct gather_landing landings[PS_TILE_PIXELS];
    size_t n = 0;
    for (uint32_t i = 0; i < paths->count; i++) {
        const ps_hit *hit = &segment->hits[i];
        const float *numbers = batch->places[paths->pixels[i]];
        is_known[i] = false;
        if (!marked[i] || (counted && paths->bounces[i] > 0))
            continue;
        landings[n++] = (struct gather_landing){
            .position = hit->position,
            .normal = hit->normal,
            .material = hit->material,
            .length = paths->lengths[i] + hit->distance,
            .is_focused = paths->lengths[i] > 0.0f,
            .numbers = {numbers[0], numbers[1]},
            .path = i,
        };
    }
    if (setting->lookup && n > 0)
        setting->lookup(setting->cache, landings, n, known, is_known);
}

/* Adds what a diffuse surface of that reflectance sends back along a path's ray of irradiance. */
static void add_known(struct batch *batch, const struct paths *paths, size_t i, ps_rgb reflectance,
                      ps_rgb irradiance)
{
    ps_rgb *found = &batch->found[paths->pixels[i]];
    ps_rgb light = ps_rgb_scale(ps_rgb_multiply(reflectance, irradiance), 1.0f / PS_PI);
    *found = ps_rgb_add(*found, ps_rgb_multiply(paths->throughput[i], light));
}

/* Adds the light of the lights, and what the cache knows of surfaces that are only diffuse; paths
 * end where that is all. */
static void light_paths(const struct gather_setting *setting, struct batch *batch, uint32_t number,
                        struct paths *paths, struct paths_segment *segment)
{
    struct cached_irradiance known[PS_TILE_PIXELS];
    bool marked[PS_TILE_PIXELS], is_known[PS_TILE_PIXELS];
    uint8_t groups[PS_TILE_PIXELS];
    size_t left = 0;
    for (size_t i = 0; i < paths->count; i++)
        marked[i] = !(segment->hits[i].flags & PS_HIT_SPECULAR);
    look_up(setting, batch, paths, segment, marked, known, is_known);
    for (size_t i = 0; i < paths->count; i++)
        groups[i] = is_known[i] && setting->cache_has_sky ? PS_LIGHTS_OTHERS : PS_LIGHTS_ALL;
    paths_add_reflected(&setting->paths, number, batch->indices, paths, groups, segment,
                        batch->found);
    for (size_t i = 0; i < paths->count; i++) {
        if (is_known[i])
            add_known(batch, paths, i, segment->hits[i].albedo,
                      ps_rgb_add(known[i].indirect, known[i].sky));
        if (is_known[i] && setting->cache_has_indirect)
            continue;
        segment->hits[left] = segment->hits[i];
        paths_move(paths, i, left++);
    }
    paths->count = left;
}

/* Sends the others on, or ends them where their lobe is diffuse. */
static void scatter_paths(const struct gather_setting *setting, struct batch *batch,
                          struct paths *paths, struct paths_segment *segment)
{
    const ps_host *host = setting->paths.host;
    ps_bsdf_sample scattered[PS_TILE_PIXELS];
    struct cached_irradiance known[PS_TILE_PIXELS];
    bool marked[PS_TILE_PIXELS], is_known[PS_TILE_PIXELS];
    size_t alive = 0;
    host->sample_bsdf(host, PS_FROM_CAMERA, paths->rays, segment->hits,
                      (const float(*)[4])segment->numbers, paths->count, scattered);
    for (size_t i = 0; i < paths->count; i++)
        marked[i] = setting->cache_has_indirect && segment->hits[i].flags & PS_HIT_SPECULAR &&
                    scattered[i].lobe == PS_DIFFUSE;
    look_up(setting, batch, paths, segment, marked, known, is_known);
    for (size_t i = 0; i < paths->count; i++) {
        if (is_known[i]) {
            add_known(batch, paths, i, scattered[i].weight, known[i].indirect);
            continue;
        }
        if (paths_scatter(&setting->paths, &scattered[i], segment, paths, i))
            paths_move(paths, i, alive++);
    }
    paths->count = alive;
}

static void note_nearest(struct gather *gather, const struct batch *batch,
                         const struct paths *paths, const struct paths_segment *segment)
{
    for (uint32_t i = 0; i < paths->count; i++) {
        uint32_t k = paths->pixels[i];
        float *nearest = &gather->first.nearest[batch->of[k]];
        if (gather->done + batch->numbers[k] < CONTACT_RAYS)
            *nearest = ps_min(*nearest, segment->hits[i].distance);
    }
}

static void take_batch(struct gather *gather, struct batch *batch)
{
    const struct gather_setting *setting = gather->setting;
    struct paths paths;
    struct paths_segment segment;
    start_paths(gather, batch, &paths, &segment);
    for (uint32_t number = 1; paths.count > 0; number++) {
        paths_intersect(&setting->paths, &batch->points, number, &paths, &segment);
        if (number == 1 && gather->done < CONTACT_RAYS)
            note_nearest(gather, batch, &paths, &segment);
        paths_add_emitted(&setting->paths, &paths, &segment, batch->found);
        light_paths(setting, batch, number, &paths, &segment);
        paths_draw_numbers(&setting->paths, number + 1, batch->indices, &paths, &segment);
        scatter_paths(setting, batch, &paths, &segment);
    }
    for (size_t k = 0; k < batch->points.count; k++)
        end_sample(gather, batch, k);
    batch->points.count = 0;
}

static void put(const struct gather *gather, uint32_t point, uint64_t number, struct batch *batch)
{
    size_t k = batch->points.count++;
    batch->points.positions[k] = gather->points.positions[point];
    batch->points.normals[k] = gather->points.normals[point];
    batch->of[k] = point;
    batch->numbers[k] = number;
    batch->indices[k] = gather->starts[point] + number;
}

/* The first samples of all points, the second ones, and so on. */
static void take_samples(struct gather *gather, const struct round *round)
{
    const ps_host *host = gather->setting->paths.host;
    struct batch batch;
    batch.round = round;
    batch.points.count = 0;
    for (uint64_t number = 0; number < round->longest && !host->cancelled(host); number++)
        for (uint32_t i = 0; i < gather->points.count; i++) {
            if (number >= gather->taken[i])
                continue;
            put(gather, i, number, &batch);
            if (batch.points.count == PS_TILE_PIXELS)
                take_batch(gather, &batch);
        }
    if (batch.points.count > 0)
        take_batch(gather, &batch);
}

static void update_guides(struct gather *gather)
{
    for (uint32_t i = 0; i < gather->guide_count; i++)
        guide_update(&gather->guides[i]);
}

void gather_keep_first_round(struct gather *gather)
{
    struct gather_first *first = &gather->first;
    for (size_t number = 0; number < gather->setting->first; number++)
        for (size_t i = 0; i < gather->points.count; i++)
            add_to_guide(gather, i, first->bins[number][i], first->found[number][i]);
    first->guide_count = gather->guide_count;
    for (uint32_t i = 0; i < gather->guide_count; i++) {
        const struct guide *guide = &gather->guides[i];
        first->histograms[i].normal = guide->normal;
        memcpy(first->histograms[i].found, guide->found, sizeof guide->found);
    }
}

/* Neighbours know of light that the few rays here have missed, and where these were lucky, do not
 * point there because of it. */
static void add_from_around(struct gather *gather, const struct gather_first *const around[],
                            size_t count)
{
    for (size_t k = 0; k < count; k++)
        for (uint32_t i = 0; i < gather->guide_count; i++)
            for (uint32_t j = 0; j < around[k]->guide_count; j++)
                guide_add_histogram(&gather->guides[i], &around[k]->histograms[j], FROM_AROUND);
}

void gather_resume(struct gather *gather, const struct gather_first *first,
                   const struct gather_first *const around[], size_t count)
{
    gather->first = *first;
    if (first->is_guided) /* the same guides again: to keep them would take 11 KB a group */
        gather_guide_first(gather);
    gather->done = gather->setting->first;
    for (uint32_t i = 0; i < gather->guide_count; i++) {
        if (gather->is_bent[i])
            guide_begin(&gather->guides[i], first->histograms[i].normal);
        memcpy(gather->guides[i].found, first->histograms[i].found,
               sizeof first->histograms[i].found);
    }
    add_from_around(gather, around, count);
    update_guides(gather);
}

/* Numbers the samples of a round from `first` on, point after point along the curve. */
static void number_samples(struct gather *gather, uint64_t first)
{
    uint32_t order[PS_TILE_PIXELS];
    memset(order, 0xff, sizeof order);
    for (uint32_t i = 0; i < gather->points.count; i++)
        order[ps_lane_along_curve(gather->points.lanes[i])] = i;
    for (size_t place = 0; place < PS_TILE_PIXELS; place++) {
        if (order[place] == UINT32_MAX)
            continue;
        gather->starts[order[place]] = first;
        first += gather->taken[order[place]];
    }
}

static void take_round(struct gather *gather, const struct round *round)
{
    const struct gather_setting *setting = gather->setting;
    uint64_t most = SAMPLE_FACTOR_MOST * setting->most;
    uint64_t before = (uint64_t)setting->paths.pass->number * most + gather->done;
    if (gather->done == setting->first) { /* what was added without guides is weighed anew */
        memset(gather->irradiance, 0, sizeof gather->irradiance);
        memset(gather->half, 0, sizeof gather->half);
    }
    if (!round->is_first)
        add_first(gather);
    number_samples(gather, (gather->index << 32) + before * PS_TILE_PIXELS);
    take_samples(gather, round);
    gather->done += round->longest;
}

/* Shares out a round of at most `most` samples to the points. Returns whether all have theirs with
 * it. */
static bool begin_round(struct gather *gather, uint64_t most, struct round *round)
{
    bool last = true;
    for (size_t i = 0; i < gather->points.count; i++) {
        uint64_t guided = guided_of(gather, i, round->samples);
        uint64_t total = guided > 0 ? gather->setting->first + guided : round->samples;
        uint64_t left = total > gather->done ? total - gather->done : 0;
        uint64_t expected = gather->expected_samples[gather_half_of(gather, i)];
        last &= left <= most;
        gather->guided_share[i] = guided > 0 ? 1.0f / (float)guided : 0.0f;
        gather->guided_expected[i] = (float)guided_of(gather, i, expected);
        gather->taken[i] = left < most ? left : most;
        if (gather->taken[i] > round->longest)
            round->longest = gather->taken[i];
    }
    return last;
}

/* Rounds of 2 or 4, 12, 48, ... samples, each drawn by what those before it found. Shorter ones
 * would learn sooner, but the samples of a round are stratified together, which is worth more. */
static uint64_t longest_round(const struct gather *gather)
{
    uint64_t done = gather->done;
    if (done == 0)
        return gather->setting->first;
    return 3 * (done > GATHER_MOST_FIRST ? done : GATHER_MOST_FIRST);
}

void gather_samples(struct gather *gather, uint64_t samples)
{
    for (bool last = false; !last;) {
        struct round round = {.samples = samples, .is_first = gather->done == 0};
        last = begin_round(gather, longest_round(gather), &round);
        round.teaches = !last;
        if (round.longest > 0)
            take_round(gather, &round);
        if (!last)
            update_guides(gather);
    }
}
