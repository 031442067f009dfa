/* estimator.c: an example: light of one bounce, gathered by rays from the pixels. */
#include <psplat/plugin.h>

struct state {
    int64_t rays;
};

struct work {
    const struct state *state;
    const ps_host *host;
    const ps_pass *pass;
};

/* With directions drawn by the cosine, a ray's irradiance is pi times the radiance that it
 * finds. */
static void gather_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const ps_host *host = work->host;
    ps_tile *tile = host->tile(host, (uint32_t)index);
    ps_points points;
    ps_collect_points(tile, &points);
    for (size_t i = 0; i < points.count; i++) {
        ps_rgb sum = {0, 0, 0};
        for (int64_t k = 0; k < work->state->rays; k++) {
            uint64_t sample = ps_sample_block(index, points.lanes[i]) +
                              work->pass->number * (uint64_t)work->state->rays + (uint64_t)k;
            float numbers[1][4];
            ps_hit hit;
            ps_rgb radiance = {0, 0, 0};
            host->samples(host, PS_STREAM_PLUGIN, 0, &sample, 1, numbers);
            ps_vec3 direction =
                ps_cosine_direction(points.normals[i], numbers[0][0], numbers[0][1]);
            ps_ray ray = ps_leave_surface(points.positions[i], points.normals[i], direction,
                                          work->pass->surface_offset);
            host->intersect(host, &ray, 1, &hit);
            if (hit.distance < INFINITY)
                host->direct_radiance(host, &ray, &hit, PS_STREAM_PLUGIN, 1, &sample, 1, &radiance);
            sum = ps_rgb_add(sum, radiance);
        }
        ps_add_irradiance(tile, points.lanes[i],
                          ps_rgb_scale(sum, PS_PI / (float)work->state->rays));
    }
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct work work = {opaque, host, pass};
    return host->for_each_tile(host, gather_tile, &work);
}

static const ps_param params[] = {
    PS_INT(struct state, rays, "16", 1, 65536, "rays", "rays for each pixel and pass"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
#if PS_ABI_MINOR >= 7
    .flags = PS_ESTIMATOR_CROPS,
#endif
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "bounce",
    .version = "1.0",
    .summary = "light of one bounce, gathered by rays",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, bounce, &descriptor)
