/* ambient.c: the same irradiance everywhere: the floor of any comparison (Hoet 2014, section 2.1).
 */
#include <psplat/plugin.h>

struct state {
    ps_rgb irradiance;
};

struct work {
    const struct state *state;
    const ps_host *host;
};

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (tile->object[lane] != PS_NO_OBJECT)
            ps_add_irradiance(tile, lane, work->state->irradiance);
}

static ps_result accumulate(void *state, const ps_host *host, const ps_pass *pass)
{
    (void)pass;
    struct work work = {state, host};
    return host->for_each_tile(host, light_tile, &work);
}

static const ps_param params[] = {
    PS_COLOR(struct state, irradiance, "1", 0, INFINITY, "W/m^2",
             "indirect irradiance of every surface"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "ambient",
    .version = "1.0",
    .summary = "the same indirect light everywhere",
    .paper = "Phong 1975, Illumination for computer generated pictures; Hoet 2014, section 2.1",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, ambient, &descriptor)
