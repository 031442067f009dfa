/* pathtrace.c: unbiased path tracing: the truth that other estimators are measured against.
 *
 * Kajiya 1986. The indirect irradiance at a pixel's point x is an integral over directions w:
 *
 *     E(x) = integral of L(y(x, w)) cos(theta) dw
 *
 * With directions drawn by cos(theta) / pi, a sample is pi times the radiance along a path that goes
 * on at every surface by its own scattering: at each one the light of the lights that it reflects is
 * added (next-event estimation), and after mirrors, glass and gloss the emission that the path meets,
 * which are caustics; gloss weighs both. Emission met from a diffuse surface is direct light of that
 * surface, and counted there. Russian roulette ends paths at diffuse surfaces.
 *
 * Each pixel owns an aligned block of the Owen-scrambled Sobol sequence, four dimensions a segment,
 * so its first 2^k samples are stratified. All pixels of a tile advance together: rays go to the
 * tracer in packets.
 */
#include <psplat/plugin.h>

/* Sets of the random numbers that choose points on lights; directions take 1, 2, 3, ... */
#define LIGHT_SETS 0x10000u

struct state {
    int64_t samples;
    int64_t roulette;
};

struct work {
    const struct state *state;
    const ps_host *host;
    const ps_pass *pass;
};

/* The paths of one sample of a tile that are still under way; entry i belongs to pixel pixels[i].
 */
struct paths {
    size_t count;
    uint32_t pixels[PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb throughput[PS_TILE_PIXELS];
    uint32_t bounces[PS_TILE_PIXELS]; /* diffuse surfaces met */
    uint32_t chain[PS_TILE_PIXELS];   /* others since the last one */
    float pdfs[PS_TILE_PIXELS];       /* of the last scattering, where its lobe was glossy */
    uint8_t shines[PS_TILE_PIXELS];   /* whether emission that is met counts */
};

/* What a segment needs for each path. */
struct segment {
    ps_hit hits[PS_TILE_PIXELS];
    uint64_t indices[PS_TILE_PIXELS];
    float numbers[PS_TILE_PIXELS][4];
};

static void move_path(struct paths *paths, size_t from, size_t to)
{
    paths->pixels[to] = paths->pixels[from];
    paths->rays[to] = paths->rays[from];
    paths->throughput[to] = paths->throughput[from];
    paths->bounces[to] = paths->bounces[from];
    paths->chain[to] = paths->chain[from];
    paths->pdfs[to] = paths->pdfs[from];
    paths->shines[to] = paths->shines[from];
}

static void draw_numbers(const struct work *work, uint32_t set, const uint64_t *blocks,
                         uint64_t sample, const struct paths *paths, struct segment *segment)
{
    for (size_t i = 0; i < paths->count; i++)
        segment->indices[i] = blocks[paths->pixels[i]] + sample;
    work->host->samples(work->host, PS_STREAM_PATH, set, segment->indices, paths->count,
                        segment->numbers);
}

static void start_paths(const struct work *work, const ps_points *points, const uint64_t *blocks,
                        uint64_t sample, struct paths *paths, struct segment *segment)
{
    paths->count = points->count;
    for (uint32_t i = 0; i < points->count; i++) {
        paths->pixels[i] = i;
        paths->throughput[i] = (ps_rgb){PS_PI, PS_PI, PS_PI};
        paths->bounces[i] = paths->chain[i] = 0;
        paths->pdfs[i] = 0.0f;
        paths->shines[i] = 0;
    }
    draw_numbers(work, 1, blocks, sample, paths, segment);
    for (size_t i = 0; i < points->count; i++) {
        ps_vec3 n = points->normals[i];
        const float *numbers = segment->numbers[i];
        paths->rays[i] = ps_leave_surface(points->positions[i], n,
                                          ps_cosine_direction(n, numbers[0], numbers[1]),
                                          work->pass->surface_offset);
    }
}

static void add_radiance(const struct paths *paths, const ps_rgb *radiance, ps_rgb *sums)
{
    for (size_t i = 0; i < paths->count; i++) {
        ps_rgb *sum = &sums[paths->pixels[i]];
        *sum = ps_rgb_add(*sum, ps_rgb_multiply(paths->throughput[i], radiance[i]));
    }
}

/* Adds the emission that paths met after mirrors, glass and gloss. */
static void add_emission(const struct work *work, const struct paths *paths,
                         const struct segment *segment, ps_rgb *sums)
{
    ps_rgb radiance[PS_TILE_PIXELS];
    work->host->emitted_radiance(work->host, paths->rays, segment->hits, paths->pdfs, paths->count,
                                 radiance);
    for (size_t i = 0; i < paths->count; i++)
        if (!paths->shines[i])
            radiance[i] = (ps_rgb){0, 0, 0};
    add_radiance(paths, radiance, sums);
}

/* Drops paths that met nothing. */
static void drop_lost(struct paths *paths, struct segment *segment)
{
    size_t met = 0;
    for (size_t i = 0; i < paths->count; i++) {
        if (!(segment->hits[i].distance < INFINITY))
            continue;
        segment->hits[met] = segment->hits[i];
        move_path(paths, i, met++);
    }
    paths->count = met;
}

/* Past its last diffuse bounce a path can only find lights in mirrors and glass. */
static int is_last(const ps_pass *pass, const struct paths *paths, size_t i)
{
    return paths->bounces[i] >= pass->bounces;
}

/* Whether a path goes on after a surface that scatters like this. */
static int goes_on(const struct work *work, const ps_bsdf_sample *scattered, float number,
                   struct paths *paths, size_t i)
{
    const struct state *state = work->state;
    ps_rgb *throughput = &paths->throughput[i];
    *throughput = ps_rgb_multiply(*throughput, scattered->weight);
    float likelihood = ps_rgb_maximum(*throughput) / PS_PI;
    if (!(likelihood > 0.0f))
        return 0;
    if (scattered->lobe != PS_DIFFUSE)
        return ++paths->chain[i] <= PS_LONGEST_CHAIN;
    if (is_last(work->pass, paths, i))
        return 0;
    paths->chain[i] = 0;
    paths->bounces[i]++;
    if (is_last(work->pass, paths, i) && !work->pass->specular)
        return 0;
    return paths->bounces[i] < (uint32_t)state->roulette ||
           ps_russian_roulette(likelihood, number, throughput);
}

/* Sends the paths on from the surfaces that they met. */
static void scatter_paths(const struct work *work, struct paths *paths, struct segment *segment)
{
    ps_bsdf_sample scattered[PS_TILE_PIXELS];
    work->host->sample_bsdf(work->host, PS_FROM_CAMERA, paths->rays, segment->hits,
                            (const float(*)[4])segment->numbers, paths->count, scattered);
    size_t alive = 0;
    for (size_t i = 0; i < paths->count; i++) {
        if (!goes_on(work, &scattered[i], segment->numbers[i][2], paths, i))
            continue;
        paths->rays[i] = ps_leave_surface(segment->hits[i].position, scattered[i].normal,
                                          scattered[i].direction, work->pass->surface_offset);
        paths->shines[i] = scattered[i].lobe != PS_DIFFUSE;
        paths->pdfs[i] = scattered[i].lobe == PS_GLOSSY ? scattered[i].pdf : 0.0f;
        move_path(paths, i, alive++);
    }
    paths->count = alive;
}

/* Adds what the surfaces that were met reflect of the lights. */
static void add_direct(const struct work *work, uint32_t number, const struct paths *paths,
                       struct segment *segment, ps_rgb *sums)
{
    ps_rgb radiance[PS_TILE_PIXELS];
    for (size_t i = 0; i < paths->count; i++)
        if (is_last(work->pass, paths, i))
            segment->hits[i].albedo = (ps_rgb){0, 0, 0};
    work->host->direct_radiance(work->host, paths->rays, segment->hits, PS_STREAM_PATH,
                                LIGHT_SETS + number, segment->indices, paths->count, radiance);
    add_radiance(paths, radiance, sums);
}

/* Follows all paths by one segment, to hits that are known: adds what the surfaces they meet emit and
 * reflect. */
static void extend_paths(const struct work *work, uint32_t number, const uint64_t *blocks,
                         uint64_t sample, struct paths *paths, struct segment *segment,
                         ps_rgb *sums)
{
    add_emission(work, paths, segment, sums);
    drop_lost(paths, segment);
    draw_numbers(work, number + 1, blocks, sample, paths, segment);
    add_direct(work, number, paths, segment, sums);
    scatter_paths(work, paths, segment);
}

static void trace_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const struct state *state = work->state;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    struct paths paths;
    struct segment segment;
    uint64_t blocks[PS_TILE_PIXELS];
    ps_rgb sums[PS_TILE_PIXELS] = {{0, 0, 0}};
    ps_collect_points(tile, &points);
    for (size_t i = 0; i < points.count; i++)
        blocks[i] = ps_sample_block(index, points.lanes[i]);
    for (int64_t i = 0; i < state->samples; i++) {
        uint64_t sample = (uint64_t)work->pass->number * (uint64_t)state->samples + (uint64_t)i;
        start_paths(work, &points, blocks, sample, &paths, &segment);
        for (uint32_t number = 1; paths.count > 0; number++) {
            work->host->intersect(work->host, paths.rays, paths.count, segment.hits);
            if (number == 1)
                ps_forget_own_surface(&points, paths.pixels, paths.count,
                                      work->pass->surface_offset, segment.hits);
            extend_paths(work, number, blocks, sample, &paths, &segment, sums);
        }
    }
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i],
                          ps_rgb_scale(sums[i], 1.0f / (float)state->samples));
}

static ps_result accumulate(void *state, const ps_host *host, const ps_pass *pass)
{
    struct work work = {state, host, pass};
    return host->for_each_tile(host, trace_tile, &work);
}

static const ps_param params[] = {
    PS_INT(struct state, samples, "64", 1, 1 << 20, "paths",
           "paths for each pixel and pass; powers of two are best"),
    PS_ROW(struct state, roulette, PS_PARAM_INT, "3", 1, 1000, PS_PARAM_EXPERT, NULL, "bounces",
           "bounce from which on Russian roulette may end a path"),
};

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

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
