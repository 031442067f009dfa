/* lpv.c: cascaded light propagation volumes: light that goes from cell to cell of grids.
 *
 * Kaplanyan and Dachsbacher 2010, "Cascaded light propagation volumes for real-time indirect
 * illumination". Photons shine into the cells that they lie in; light goes on from cell to cell, in
 * spherical harmonics of order 1, past what surfaces cover (lpv/light_grid.h); nested grids are
 * finer around what the camera sees (lpv/cascades.h). Then a pixel asks the cells around for its
 * irradiance.
 *
 * Photons have the light of as many bounces as are asked for, so that there is no second
 * propagation for each, as in the paper: one bounce takes as long as all. Caustics, which cells
 * would blur, are splatted. The paper takes its lights from the pixels of reflective shadow maps;
 * with injection=rsm or voxel, light is of one bounce as there.
 *
 * Each pass shifts the grids by a part of a cell, so that what depends on where cells lie is
 * averaged.
 */
#include "lpv/cascades.h"
#include "shared/caustics.h"
#include "shared/photons.h"

#define STREAM_GRID PS_STREAM_PLUGIN /* shift of the grids */
#define LINES_PER_CELL 3
#define LEAST_LEFT 0.01 /* of the light, by which automatic steps end */

static const char *const steps_choices[] = {"auto", NULL};

struct state {
    int64_t cells;
    int64_t cascades;
    ps_number_or_choice steps;
};

struct work {
    const ps_host *host;
    const ps_pass *pass;
    struct cascades cascades; /* owned */
    uint64_t lost;            /* photons that no grid holds */
};

/* --- grids
 * ---------------------------------------------------------------------------------------------- */

/* The mean of what pixels show, as far as it lies in the scene's sphere. */
static ps_vec3 find_focus(const ps_host *host, const ps_pass *pass)
{
    ps_vec3 center;
    float radius;
    double sum[3] = {0, 0, 0}, count = 0;
    host->scene_bounds(host, &center, &radius);
    for (uint32_t index = 0; index < pass->tile_count; index++) {
        const ps_tile *tile = host->tile(host, index);
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            ps_vec3 away = ps_subtract(ps_tile_position(tile, lane), center);
            if (tile->object[lane] == PS_NO_OBJECT || !(ps_length(away) <= radius))
                continue;
            sum[0] += (double)away.x;
            sum[1] += (double)away.y;
            sum[2] += (double)away.z;
            count++;
        }
    }
    if (count == 0)
        return center;
    return ps_add(center, (ps_vec3){(float)(sum[0] / count), (float)(sum[1] / count),
                                    (float)(sum[2] / count)});
}

/* A photons_take. */
static ps_result inject(void *opaque, const ps_photon *photons, size_t n)
{
    struct work *work = opaque;
    for (size_t i = 0; i < n; i++) {
        const ps_photon *photon = &photons[i];
        if (photon->bounce > 0 && photon->bounce <= work->pass->bounces &&
            !cascades_inject(&work->cascades, photon))
            work->lost++;
    }
    return work->pass->specular ? caustics_splat_photons(work->host, photons, n) : PS_OK;
}

static ps_result fill(const struct state *state, struct work *work)
{
    const ps_host *host = work->host;
    struct cascades_setting setting = {
        .host = host,
        .pass = work->pass,
        .focus = find_focus(host, work->pass),
        .count = (uint32_t)state->cascades,
        .across = (uint32_t)state->cells,
        .lines_per_cell = LINES_PER_CELL,
    };
    float numbers[1][4];
    uint64_t index = work->pass->number;
    host->samples(host, STREAM_GRID, 0, &index, 1, numbers);
    for (int k = 0; k < 3; k++)
        setting.shift[k] = numbers[0][k];
    bool automatic = state->steps.choice >= 0;
    uint64_t steps =
        automatic ? (uint64_t)(state->cells * state->cells) : (uint64_t)state->steps.number;
    ps_result result = cascades_create(&setting, &work->cascades);
    if (result == PS_OK && work->pass->specular)
        result = host->begin_splats(host, 0);
    if (result == PS_OK)
        result = photons_for_each_batch(host, inject, work);
    host->count(host, "photons left out", (double)work->lost);
    return result == PS_OK
               ? cascades_propagate(&work->cascades, steps, automatic ? LEAST_LEFT : 0.0)
               : result;
}

/* --- the picture
 * ---------------------------------------------------------------------------------------------- */

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    ps_collect_points(tile, &points);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(
            tile, points.lanes[i],
            cascades_irradiance(&work->cascades, points.positions[i], points.normals[i]));
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {.host = host, .pass = pass, .cascades = {.host = host}};
    ps_result result = fill(state, &work);
    if (result == PS_OK)
        result = host->for_each_tile(host, light_tile, &work);
    cascades_release(&work.cascades);
    return result;
}

static const ps_param params[] = {
    PS_INT(struct state, cells, "16", 4, 128, "cells", "cells of each grid along each axis"),
    PS_INT(struct state, cascades, "2", 1, CASCADES_MOST, "grids",
           "grids, each half as wide as the next; the widest holds the scene"),
    PS_NUMBER_OR(struct state, steps, "auto", 0, 10000, PS_PARAM_WHOLE, steps_choices, "steps",
                 "steps of propagation; auto: until a hundredth of the light is left, at most "
                 "cells squared"),
};

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "lpv",
    .version = "1.0",
    .summary = "light propagation volumes: photons' light goes from cell to cell of nested grids",
    .paper = "Kaplanyan and Dachsbacher 2010, Cascaded light propagation volumes for real-time "
             "indirect illumination",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, lpv, &descriptor)
