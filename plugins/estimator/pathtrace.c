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
#include "shared/contact.h"
#include "shared/paths.h"

struct state {
    int64_t samples;
    int64_t roulette;
};

struct work {
    const struct state *state;
    struct paths_setting setting;
};

/* What the samples of a tile's points tell of their variance. */
struct spread {
    int samples; /* so far */
    float squares[PS_TILE_PIXELS], nearest[PS_TILE_PIXELS];
};

struct tile_work {
    const struct paths_setting *setting;
    struct spread *spread;
};

static void look_for_contact(const struct paths *paths, const struct paths_segment *segment,
                             struct spread *spread)
{
    for (size_t i = 0; i < paths->count && spread->samples < CONTACT_RAYS; i++) {
        float *nearest = &spread->nearest[paths->pixels[i]];
        *nearest = ps_min(*nearest, segment->hits[i].distance);
    }
    spread->samples++;
}

static void trace_sample(const void *user, const ps_points *points, const uint64_t *samples,
                         ps_rgb *sums)
{
    const struct tile_work *work = user;
    struct paths paths;
    struct paths_segment segment;
    ps_rgb found[PS_TILE_PIXELS] = {{0, 0, 0}};
    paths_start(work->setting, points, samples, INFINITY, &paths, &segment);
    paths_intersect(work->setting, points, 1, &paths, &segment);
    look_for_contact(&paths, &segment, work->spread);
    paths_go_on(work->setting, points, samples, 1, &paths, &segment, found);
    for (size_t i = 0; i < points->count; i++) {
        float light = contact_mean_of_channels(found[i]);
        work->spread->squares[i] += light * light;
        sums[i] = ps_rgb_add(sums[i], found[i]);
    }
}

/* By the means of all samples. */
static void tell_variance(const struct work *work, const ps_points *points,
                          const ps_rgb *irradiance, const struct spread *spread, ps_tile *tile)
{
    float variance[PS_TILE_PIXELS], n = (float)work->state->samples;
    for (size_t i = 0; i < points->count; i++) {
        float mean = contact_mean_of_channels(irradiance[i]);
        variance[i] = ps_max(spread->squares[i] / n - mean * mean, 0.0f) / (n - 1.0f);
    }
    contact_tell_variance(work->setting.host, points, spread->nearest, variance, tile);
}

static void trace_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_host *host = work->setting.host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    ps_points points;
    ps_rgb irradiance[PS_TILE_PIXELS];
    struct spread spread = {.samples = 0};
    struct tile_work tile_work = {&work->setting, &spread};
    for (size_t i = 0; i < PS_TILE_PIXELS; i++)
        spread.nearest[i] = INFINITY;
    ps_collect_points(tile, &points);
    paths_average(&work->setting, index, &points, (uint64_t)work->state->samples, trace_sample,
                  &tile_work, irradiance);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], irradiance[i]);
    if (work->state->samples > CONTACT_RAYS)
        tell_variance(work, &points, irradiance, &spread, tile);
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
    .flags = PS_ESTIMATOR_CROPS | PS_ESTIMATOR_VARIANCE,
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
