#include "surfel_correction.h"

#include <stdbool.h>

#define GROUPS_AROUND 16 /* to each side, in the order of surfels */

static float *channel(ps_rgb *colour, int c)
{
    return c == 0 ? &colour->r : c == 1 ? &colour->g : &colour->b;
}

static double value(ps_rgb colour, int c)
{
    return (double)*channel(&colour, c);
}

/* Surfels near each other, and what their splats and paths say of one channel. */
struct group {
    ps_rgb *splatted;
    const ps_rgb *traced, *half;
    size_t n;
    /* Variance of the paths' noise, and mean square of what splats and paths differ by, over the
     * square of the mean. */
    double noise, difference;
};

static struct group group_at(const struct surfels *surfels, const ps_rgb *traced,
                             const ps_rgb *half, size_t index)
{
    struct surfel_group group = surfels_group(surfels, SURFELS_OF_RATIO, index);
    return (struct group){
        .splatted = surfels->irradiance + group.first,
        .traced = traced + group.first,
        .half = half + group.first,
        .n = group.n,
    };
}

/* Multiplies a group's splats by the ratio of what its paths and splats find. What no splat has
 * reached takes the mean of its paths. */
static void scale_splats(const struct group *group, int c)
{
    double by_splats = 0.0, by_paths = 0.0;
    for (size_t i = 0; i < group->n; i++) {
        by_splats += value(group->splatted[i], c);
        by_paths += value(group->traced[i], c);
    }
    bool reached = by_splats > 0.0;
    float scale = (float)(by_paths / (reached ? by_splats : (double)group->n));
    for (size_t i = 0; i < group->n; i++) {
        float *splatted = channel(&group->splatted[i], c);
        *splatted = reached ? scale * *splatted : scale;
    }
}

static void compare(struct group *group, int c)
{
    double sum = 0.0, noise = 0.0, difference = 0.0;
    for (size_t i = 0; i < group->n; i++) {
        double by_paths = value(group->traced[i], c);
        double off = value(group->half[i], c) - by_paths;
        double rest = value(group->splatted[i], c) - by_paths;
        noise += off * off;
        difference += rest * rest;
        sum += by_paths;
    }
    group->noise = sum > 0.0 ? noise / (sum * sum) : 0.0;
    group->difference = sum > 0.0 ? difference / (sum * sum) : 0.0;
}

/* The weight of splats in the mean of both, each weighted by the other's variance: what they differ
 * by, of which the paths' noise is known. From the groups around, too: a group's own estimate of
 * the noise depends on whether its paths happened to hit a light, and weights by it alone would
 * lose that light. */
static float weight_of_splats(const struct group *groups, size_t count, size_t index)
{
    size_t from = index > GROUPS_AROUND ? index - GROUPS_AROUND : 0;
    double noise = 0.0, difference = 0.0;
    for (size_t i = from; i < count && i <= index + GROUPS_AROUND; i++) {
        noise += groups[i].noise;
        difference += groups[i].difference;
    }
    return difference > noise ? (float)(noise / difference) : 1.0f;
}

static void mix(const struct group *group, float weight, int c)
{
    for (size_t i = 0; i < group->n; i++) {
        float *irradiance = channel(&group->splatted[i], c);
        float by_paths = (float)value(group->traced[i], c);
        *irradiance = weight * *irradiance + (1.0f - weight) * by_paths;
    }
}

ps_result surfels_correct(struct surfels *surfels, const ps_rgb *traced, const ps_rgb *half)
{
    const ps_host *host = surfels->host;
    size_t count = surfels_group_count(surfels, SURFELS_OF_RATIO);
    struct group *groups = host->allocate(host, count * sizeof *groups, "surfels");
    if (!groups)
        return PS_ERROR_MEMORY;
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < count; i++) {
            groups[i] = group_at(surfels, traced, half, i);
            scale_splats(&groups[i], c);
            compare(&groups[i], c);
        }
        for (size_t i = 0; i < count; i++)
            mix(&groups[i], weight_of_splats(groups, count, i), c);
    }
    host->release(host, groups);
    return PS_OK;
}
