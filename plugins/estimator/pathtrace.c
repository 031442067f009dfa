/* pathtrace.c: unbiased path tracing: the truth that other estimators are measured against.
 *
 * Kajiya 1986. The indirect irradiance at a pixel's point x is an integral over directions w:
 *
 *     E(x) = integral of L(y(x, w)) cos(theta) dw,   L(y) = albedo(y) / pi * (E_direct(y) + E(y))
 *
 * With directions drawn by cos(theta) / pi the pi's cancel, and a sample is the sum over the path's
 * surfaces of albedo_1 ... albedo_k * E_direct(y_k): next-event estimation at every surface,
 * Russian roulette on albedo. Emission that a ray happens to meet is direct light and is not
 * counted.
 *
 * Each pixel owns an aligned block of the Owen-scrambled Sobol sequence, four dimensions a bounce,
 * so its first 2^k samples are stratified. All pixels of a tile advance together: rays go to the
 * tracer in packets.
 */
#include <psplat/plugin.h>

struct state {
    int64_t samples;
    int64_t bounces;
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
    ps_vec3 positions[PS_TILE_PIXELS], normals[PS_TILE_PIXELS];
    ps_rgb throughput[PS_TILE_PIXELS];
};

static void start_paths(const ps_points *points, struct paths *paths)
{
    paths->count = points->count;
    for (uint32_t i = 0; i < points->count; i++) {
        paths->pixels[i] = i;
        paths->positions[i] = points->positions[i];
        paths->normals[i] = points->normals[i];
        paths->throughput[i] = (ps_rgb){1, 1, 1};
    }
}

/* Whether a path goes on after a surface. */
static int goes_on(const struct state *state, int64_t bounce, float number, ps_rgb *throughput)
{
    float likelihood = ps_rgb_maximum(*throughput);
    if (state->roulette && bounce >= state->roulette)
        return ps_survives(likelihood, number, throughput);
    return likelihood > 0.0f;
}

/* Follows all paths by one segment: adds the direct light of the surfaces they meet to the sums. */
static void extend_paths(const struct work *work, int64_t bounce, const uint64_t *blocks,
                         uint64_t sample, struct paths *paths, ps_rgb *sums)
{
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    float numbers[PS_TILE_PIXELS][4];
    uint64_t indices[PS_TILE_PIXELS] = {0};
    const ps_host *host = work->host;
    for (size_t i = 0; i < paths->count; i++)
        indices[i] = blocks[paths->pixels[i]] + sample;
    host->samples(host, PS_STREAM_PATH, (uint32_t)bounce, indices, paths->count, numbers);
    for (size_t i = 0; i < paths->count; i++) {
        ps_vec3 n = paths->normals[i];
        ps_vec3 direction = ps_cosine_direction(n, numbers[i][0], numbers[i][1]);
        rays[i] = ps_leave_surface(paths->positions[i], n, direction, work->pass->surface_offset);
    }
    host->intersect(host, rays, paths->count, hits);
    size_t met = 0;
    float roulette[PS_TILE_PIXELS];
    for (size_t i = 0; i < paths->count; i++) {
        if (!(hits[i].distance < INFINITY))
            continue;
        roulette[met] = numbers[i][2];
        paths->pixels[met] = paths->pixels[i];
        paths->positions[met] = hits[i].position;
        paths->normals[met] = hits[i].normal;
        paths->throughput[met++] = ps_rgb_multiply(paths->throughput[i], hits[i].albedo);
    }
    ps_rgb direct[PS_TILE_PIXELS];
    host->direct_irradiance(host, paths->positions, paths->normals, met, direct);
    paths->count = 0;
    for (size_t i = 0; i < met; i++) {
        ps_rgb *sum = &sums[paths->pixels[i]];
        *sum = ps_rgb_add(*sum, ps_rgb_multiply(paths->throughput[i], direct[i]));
        if (!goes_on(work->state, bounce, roulette[i], &paths->throughput[i]))
            continue;
        size_t to = paths->count++;
        paths->pixels[to] = paths->pixels[i];
        paths->positions[to] = paths->positions[i];
        paths->normals[to] = paths->normals[i];
        paths->throughput[to] = paths->throughput[i];
    }
}

static void trace_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const struct state *state = work->state;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    struct paths paths;
    uint64_t blocks[PS_TILE_PIXELS];
    ps_rgb sums[PS_TILE_PIXELS] = {{0, 0, 0}};
    ps_collect_points(tile, &points);
    for (size_t i = 0; i < points.count; i++)
        blocks[i] = ps_sample_block(index, points.lanes[i]);
    for (int64_t i = 0; i < state->samples; i++) {
        uint64_t sample = (uint64_t)work->pass->number * (uint64_t)state->samples + (uint64_t)i;
        start_paths(&points, &paths);
        for (int64_t bounce = 1; paths.count > 0; bounce++) {
            if (state->bounces && bounce > state->bounces)
                break;
            extend_paths(work, bounce, blocks, sample, &paths, sums);
        }
    }
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i],
                          ps_rgb_scale(sums[i], 1.0f / (float)state->samples));
}

static ps_result accumulate(const void *state, const ps_host *host, const ps_pass *pass)
{
    struct work work = {state, host, pass};
    return host->for_each_tile(host, trace_tile, &work);
}

static int32_t init(void *opaque, const ps_host *host, char *message, size_t size)
{
    (void)host;
    const struct state *state = opaque;
    return ps_check_bounces(state->bounces, state->roulette, message, size);
}

static const ps_param params[] = {
    PS_INT(struct state, samples, "64", 1, 1 << 20, "paths",
           "paths for each pixel and pass; powers of two are best"),
    PS_INT(struct state, bounces, "1", 0, 1000, "bounces",
           "diffuse surfaces between light and the visible one; 0: unlimited"),
    PS_INT(struct state, roulette, "3", 0, 1000, "bounces",
           "bounce from which on Russian roulette may end a path; 0: never"),
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
    .init = init,
    .vtable = &vtable,
};

PS_MODULE(estimator, pathtrace, &descriptor)
