/* grid.c: the photons of each cell of a grid become one (Hoet 2014, sections 3.2.1 and 4.2).
 *
 * Where a cell holds fewer photons than `threshold`, it and its block of 2x2x2 cells merge as a
 * whole, and blocks of blocks do, level by level. A bucket limits what becomes one photon: without,
 * crowded cells end as few very bright photons beside dim ones, which shows as blotches (section
 * 5.3.2).
 *
 * The grid is a sorted list of photons (see cells.h), not an array of cells: 40 bytes a photon at
 * any resolution, where the array took 40 bytes a cell, 256^3 of them (section 5.1). So it has no
 * outside either: cells go on wherever photons are, and `centre` only says where borders lie.
 */
#include <psplat/plugin.h>
#include <stdio.h>

static const char *const cell_choices[] = {"auto", NULL};
static const char *const centre_choices[] = {"scene", "camera", NULL};

enum { CENTRE_SCENE = 0, CENTRE_CAMERA = 1 };

struct state {
    const ps_cells *cells;
    int64_t resolution;
    ps_number_or_choice cell;
    int32_t centre;
    int64_t threshold;
    int64_t levels;
    int64_t bucket;
    int64_t per_cell;
    double side; /* of a cell */
};

/* The grid of `resolution` cells a side is the cube around the scene's sphere, moved to the centre;
 * all others have a corner of cells at the centre. */
static ps_lattice lattice_of(const struct state *state, const ps_host *host)
{
    ps_vec3 corner;
    float radius;
    ps_camera camera = {.size = sizeof camera};
    host->scene_bounds(host, &corner, &radius);
    host->camera(host, &camera);
    if (state->centre == CENTRE_CAMERA)
        corner = camera.position;
    if (state->cell.choice >= 0)
        corner = ps_subtract(corner, (ps_vec3){radius, radius, radius});
    return state->cells->lattice(host, corner, state->side);
}

static uint64_t block_of(const ps_strata *strata, size_t stratum, unsigned level)
{
    return strata->entries[strata->starts[stratum]].key >> 3 * level;
}

/* Strata [first, last) of one block become one if any of them holds too few. */
static void join_block(const struct state *state, ps_strata *strata, size_t first, size_t last)
{
    int sparse = 0;
    for (size_t i = first; i < last; i++)
        sparse |= strata->starts[i + 1] - strata->starts[i] < (size_t)state->threshold;
    for (size_t i = first; i < last; i++)
        if (!sparse || i == last - 1)
            ps_strata_end_at(strata, strata->starts[i + 1]);
}

/* Goes over the blocks of a level. The strata that are left are written over those that were: they
 * are not more, so none is overwritten before it was read. */
static void join_level(const struct state *state, ps_strata *strata, unsigned level)
{
    size_t before = strata->count;
    strata->count = 0;
    for (size_t first = 0, last; first < before; first = last) {
        uint64_t block = block_of(strata, first, level);
        for (last = first + 1; last < before && block_of(strata, last, level) == block;)
            last++;
        join_block(state, strata, first, last);
    }
}

static ps_result stratify(const void *opaque, const ps_host *host, const ps_pass *pass,
                          ps_photon *photons, size_t n, ps_strata *strata)
{
    (void)pass;
    const struct state *state = opaque;
    ps_lattice lattice = lattice_of(state, host);
    for (size_t i = 0; i < n; i++)
        ps_strata_add(strata, i, state->cells->key(&lattice, 0, photons[i].position));
    ps_strata_sort(state->cells, strata);
    ps_strata_from_keys(strata);
    for (unsigned level = 1; level <= (unsigned)state->levels && state->threshold > 1; level++)
        join_level(state, strata, level);
    strata->per_stratum = (uint64_t)state->per_cell;
    strata->most = (uint64_t)state->bucket;
    return PS_OK;
}

/* A cell that holds nothing goes by its own key, others by that of the first one that they
 * joined. */
static uint64_t number_of(const ps_strata *strata, uint64_t key)
{
    size_t entry = ps_strata_find(strata, key);
    if (entry == strata->entry_count || strata->entries[entry].key != key)
        return key;
    return strata->entries[strata->starts[ps_stratum_of(strata, entry)]].key;
}

static ps_result find_strata(const void *opaque, const ps_host *host, const ps_strata *strata,
                             const ps_vec3 *points, size_t count, uint64_t *numbers)
{
    const struct state *state = opaque;
    ps_lattice lattice = lattice_of(state, host);
    for (size_t i = 0; i < count; i++)
        numbers[i] = number_of(strata, state->cells->key(&lattice, 0, points[i]));
    return PS_OK;
}

static ps_result init(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    char why[160];
    ps_vec3 center;
    float radius;
    state->cells = host->extension(host, PS_CELLS_EXTENSION);
    host->scene_bounds(host, &center, &radius);
    state->side = state->cell.choice >= 0 ? 2.0 * (double)radius / (double)state->resolution
                                          : state->cell.number;
    if (state->cell.choice >= 0 || !state->cells->too_small(host, state->side))
        return PS_OK;
    snprintf(why, sizeof why, "cell=%g is too small: the scene would be more than %u cells across",
             state->side, PS_CELLS_ACROSS);
    return host->fail(host, PS_ERROR_INVALID, why);
}

static const ps_param params[] = {
    PS_INT(struct state, resolution, "128", 1, 1000000, "cells",
           "cells across the sphere around the scene, where cell is auto"),
    PS_NUMBER_OR(struct state, cell, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN, cell_choices,
                 "scene units", "side of a cell; auto: by resolution"),
    PS_ROW(struct state, centre, PS_PARAM_CHOICE, "scene", 0, 0, PS_PARAM_EXPERT, centre_choices,
           "", "where the middle of the grid lies"),
    PS_ROW(struct state, threshold, PS_PARAM_INT, "2", 1, 1000000000, PS_PARAM_EXPERT, NULL,
           "photons", "a cell of fewer photons merges with its block of 2x2x2 cells; 1: none does"),
    PS_ROW(struct state, levels, PS_PARAM_INT, "1", 0, 20, PS_PARAM_EXPERT, NULL, "levels",
           "how often blocks may merge"),
    PS_ROW(struct state, bucket, PS_PARAM_INT, "0", 0, 1000000000, PS_PARAM_EXPERT, NULL, "photons",
           "largest number of photons that become one; 0: any number"),
    PS_ROW(struct state, per_cell, PS_PARAM_INT, "1", 1, 1000000000, PS_PARAM_EXPERT, NULL,
           "photons", "photons that stay in a cell that holds as many"),
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
    .name = "grid",
    .version = "1.0",
    .summary = "the photons of each cell of a grid become one",
    .paper = "Hoet 2014, sections 3.2.1 and 4.2",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .init = init,
    .vtable = &vtable,
};

PS_MODULE(stratification, grid, &descriptor)
