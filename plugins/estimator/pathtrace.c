/* pathtrace.c: unbiased path tracing: the truth that other estimators are measured against.
 *
 * The indirect irradiance at a pixel's point x is an integral over directions w:
 *
 *     E(x) = integral of L(y(x, w)) cos(theta) dw
 *
 * With directions drawn by cos(theta) / pi, a sample is pi times the radiance along a path
 * (paths.h).
 *
 * The samples of a tile's pixels are parts of one aligned block of the Owen-scrambled Sobol
 * sequence, in the order of a Z curve (ps_tile_sample). So not only those of a pixel are
 * stratified, but those of squares of pixels as well, and what one pixel has too much of its
 * neighbours have too little: a denoiser finds less noise.
 */
#include "shared/paths.h"

struct state {
    int64_t samples;
    int64_t roulette;
};

struct work {
    const struct state *state;
    struct paths_setting setting;
};

static void trace_sample(const void *user, const ps_points *points, const uint64_t *samples,
                         ps_rgb *sums)
{
    const struct work *work = user;
    struct paths paths;
    struct paths_segment segment;
    paths_start(&work->setting, points, samples, INFINITY, &paths, &segment);
    paths_follow(&work->setting, points, samples, 1, &paths, &segment, sums);
}

static void trace_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_host *host = work->setting.host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    ps_points points;
    ps_rgb irradiance[PS_TILE_PIXELS];
    ps_collect_points(tile, &points);
    paths_average(&work->setting, index, &points, (uint64_t)work->state->samples, trace_sample,
                  work, irradiance);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], irradiance[i]);
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {state, {host, pass, (uint32_t)state->roulette, false, false}};
    return host->for_each_tile(host, trace_tile, &work);
}

static const ps_param params[] = {
    PS_ROW(struct state, samples, PS_PARAM_INT, "64", 1, 1 << 20, PS_PARAM_QUALITY, NULL, "paths",
           "paths for each pixel and pass; powers of two are best"),
    PS_ROW(struct state, roulette, PS_PARAM_INT, "3", 1, 1000, PS_PARAM_EXPERT, NULL, "bounces",
           "bounce from which on Russian roulette may end a path"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "pathtrace",
    .version = "1.0",
    .summary = "unbiased path tracing with next-event estimation: the reference",
    .paper = "Kajiya 1986, The rendering equation",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, pathtrace, &descriptor)
