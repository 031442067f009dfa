/* cascade.c: the photons of each cell become one; cells are coarser farther from the camera.
 *
 * Grids of `resolution` cells a side lie in one another, all around the camera; each has cells
 * `growth` times as large as the one inside of it, and a photon belongs to the smallest that it
 * lies in. So what is close to the viewer keeps its detail, and far light costs little (Kaplanyan
 * and Dachsbacher 2010, "Cascaded light propagation volumes for real-time indirect illumination";
 * for splatting Hoet 2014, sections 3.2.1 and 5.3.2). What lies outside of all of them is for
 * `beyond` to decide.
 *
 * `drop` loses the light of photons beyond, here alone of all stratifications, and the statistics
 * count them.
 */
#include <psplat/plugin.h>
#include <stdio.h>

#define MOST_LEVELS (PS_CELL_LAYERS - 1) /* one layer is for what lies beyond */

static const char *const cell_choices[] = {"auto", NULL};
static const char *const beyond_choices[] = {"keep", "merge", "drop", NULL};

enum { BEYOND_KEEP = 0, BEYOND_MERGE = 1, BEYOND_DROP = 2 };

struct state {
    const ps_cells *cells;
    int64_t levels;
    int64_t resolution;
    ps_number_or_choice cell;
    double growth;
    int32_t beyond;
};

struct cascades {
    ps_lattice lattices[MOST_LEVELS + 1]; /* the last is for what lies beyond */
    double half_side[MOST_LEVELS];        /* half the side of each cascade */
    ps_vec3 middle;
    uint32_t count;
};

/* Side of the cells of the outermost cascade, over that of the innermost. */
static double outermost_growth(const struct state *state)
{
    return pow(state->growth, (double)(state->levels - 1));
}

/* Side of the innermost cells; auto: so that the outermost cascade holds all of the scene. */
static double innermost_side(const struct state *state, const ps_host *host, ps_vec3 middle)
{
    ps_vec3 center;
    float radius;
    if (state->cell.choice < 0)
        return state->cell.number;
    host->scene_bounds(host, &center, &radius);
    double half_side = (double)ps_length(ps_subtract(center, middle)) + (double)radius;
    /* Rounding must leave nothing outside. */
    return 1.001 * 2.0 * half_side / ((double)state->resolution * outermost_growth(state));
}

static struct cascades cascades_of(const struct state *state, const ps_host *host)
{
    struct cascades cascades = {.count = (uint32_t)state->levels};
    ps_camera camera = {.size = sizeof camera};
    host->camera(host, &camera);
    cascades.middle = camera.position;
    double side = innermost_side(state, host, cascades.middle);
    for (uint32_t i = 0; i < cascades.count; i++, side *= state->growth) {
        double half_side = 0.5 * side * (double)state->resolution;
        ps_vec3 half = {(float)half_side, (float)half_side, (float)half_side};
        cascades.half_side[i] = half_side;
        cascades.lattices[i] = (ps_lattice){ps_subtract(cascades.middle, half), side};
    }
    const ps_lattice *outermost = &cascades.lattices[cascades.count - 1];
    cascades.lattices[cascades.count] =
        state->cells->lattice(host, outermost->origin, outermost->side);
    return cascades;
}

/* The smallest cascade that holds the position; their number where none does. */
static uint32_t cascade_around(const struct cascades *cascades, ps_vec3 position)
{
    ps_vec3 away = ps_subtract(position, cascades->middle);
    float farthest = fmaxf(fabsf(away.x), fmaxf(fabsf(away.y), fabsf(away.z)));
    uint32_t layer = 0;
    while (layer < cascades->count && !((double)farthest < cascades->half_side[layer]))
        layer++;
    return layer;
}

/* PS_NO_STRATUM beyond, unless what is there merges too. */
static uint64_t key_in(const struct state *state, const struct cascades *cascades, uint32_t layer,
                       ps_vec3 position)
{
    if (layer == cascades->count && state->beyond != BEYOND_MERGE)
        return PS_NO_STRATUM;
    return state->cells->key(&cascades->lattices[layer], layer, position);
}

static ps_result stratify(const void *opaque, const ps_host *host, const ps_pass *pass,
                          ps_photon *photons, size_t n, ps_strata *strata)
{
    (void)pass;
    const struct state *state = opaque;
    struct cascades cascades = cascades_of(state, host);
    size_t beyond = 0;
    for (size_t i = 0; i < n; i++) {
        uint32_t layer = cascade_around(&cascades, photons[i].position);
        uint64_t key = key_in(state, &cascades, layer, photons[i].position);
        beyond += layer == cascades.count;
        if (key != PS_NO_STRATUM)
            ps_strata_add(strata, i, key);
        else if (state->beyond == BEYOND_DROP)
            photons[i].merged = 0.0f;
    }
    host->count(host, "photons beyond", (double)beyond);
    ps_strata_sort(state->cells, strata);
    ps_strata_from_keys(strata);
    return PS_OK;
}

static ps_result find_strata(const void *opaque, const ps_host *host, const ps_strata *strata,
                             const ps_vec3 *points, size_t count, uint64_t *numbers)
{
    (void)strata;
    struct cascades cascades = cascades_of(opaque, host);
    for (size_t i = 0; i < count; i++)
        numbers[i] = key_in(opaque, &cascades, cascade_around(&cascades, points[i]), points[i]);
    return PS_OK;
}

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    char why[160];
    state->cells = host->extension(host, PS_CELLS_EXTENSION);
    double outermost = state->cell.number * outermost_growth(state);
    if (state->cell.choice >= 0 || state->beyond != BEYOND_MERGE ||
        !state->cells->too_small(host, outermost))
        return PS_OK;
    snprintf(why, sizeof why,
             "cell=%g is too small: the scene would be more than %u of the outermost cells across",
             state->cell.number, PS_CELLS_ACROSS);
    return host->fail(host, PS_ERROR_INVALID, why);
}

static const ps_param params[] = {
    PS_ROW(struct state, levels, PS_PARAM_INT, "4", 1, MOST_LEVELS, PS_PARAM_EXPERT, NULL,
           "cascades", "number of grids"),
    PS_INT(struct state, resolution, "256", 2, 1000000, "cells",
           "cells along the side of each grid"),
    PS_NUMBER_OR(struct state, cell, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN, cell_choices,
                 "scene units",
                 "side of the innermost cells; auto: so that the outermost grid holds the scene"),
    PS_NUMBER(struct state, growth, "2", 1, 16, PS_PARAM_OPEN_MIN | PS_PARAM_EXPERT, "",
              "side of the cells of a grid over that of the next one inside"),
    PS_ROW(struct state, beyond, PS_PARAM_CHOICE, "merge", 0, 0, PS_PARAM_EXPERT, beyond_choices,
           "",
           "what becomes of photons outside of all grids; merge: by cells of the outermost size"),
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
    .name = "cascade",
    .version = "1.0",
    .summary = "the photons of each cell become one; cells are coarser farther from the camera",
    .paper = "Hoet 2014, sections 3.2.1 and 5.3.2; Kaplanyan and Dachsbacher 2010",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .vtable = &vtable,
};

PS_MODULE(stratification, cascade, &descriptor)
