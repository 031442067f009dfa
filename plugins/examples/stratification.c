/* stratification.c: an example: the photons of each slab of space across the x axis become one. */
#include <psplat/plugin.h>

struct state {
    const ps_cells *cells;
    double width;
};

static uint64_t slab_of(const struct state *state, ps_vec3 position)
{
    return (uint64_t)(int64_t)floor((double)position.x / state->width) ^ UINT64_C(1) << 63;
}

static ps_result stratify(const void *opaque, const ps_host *host, const ps_pass *pass,
                          ps_photon *photons, size_t n, ps_strata *strata)
{
    (void)host;
    (void)pass;
    const struct state *state = opaque;
    for (size_t i = 0; i < n; i++)
        ps_strata_add(strata, i, slab_of(state, photons[i].position));
    ps_strata_sort(state->cells, strata);
    ps_strata_from_keys(strata);
    return PS_OK;
}

static ps_result find_strata(const void *opaque, const ps_host *host, const ps_strata *strata,
                             const ps_vec3 *points, size_t count, uint64_t *numbers)
{
    (void)host;
    (void)strata;
    for (size_t i = 0; i < count; i++)
        numbers[i] = slab_of(opaque, points[i]);
    return PS_OK;
}

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    state->cells = host->extension(host, PS_CELLS_EXTENSION);
    return state->cells ? PS_OK
                        : host->fail(host, PS_ERROR_INVALID, "this psplat can't sort by cells");
}

static const ps_param params[] = {
    PS_NUMBER(struct state, width, "1", 0, INFINITY, PS_PARAM_OPEN_MIN, "scene units",
              "width of a slab"),
};

static const ps_stratification_vtable vtable = {
    .size = sizeof vtable,
    .whole_pass = 1,
    .stratify = stratify,
    .find_strata = find_strata,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_STRATIFICATION,
    .name = "slabs",
    .version = "1.0",
    .summary = "the photons of each slab across the x axis become one",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .vtable = &vtable,
};

PS_MODULE(stratification, slabs, &descriptor)
