/* splats.c: the filter's profile, the interleaving and the splatter, made when splats are first
 * wanted. */
#include "host/splats.h"

#include "placement/placement.h"
#include "splat/point_tiles.h"

#include <math.h>
#include <stdlib.h>

static ps_result tabulate_filter(struct render *render, struct kernel_profile *profile,
                                 struct error *error)
{
    const struct strategy *filter = strategy_in(render, PS_FILTER);
    float radius2[KERNEL_PROFILE_SIZE];
    for (size_t i = 0; i < KERNEL_PROFILE_SIZE; i++)
        radius2[i] = kernel_profile_radius2(i);
    filter->type->table.filter.weigh(filter->state, radius2, profile->weights, KERNEL_PROFILE_SIZE);
    if (kernel_profile_normalize(profile))
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "filter %s: weights must not be negative, nor zero everywhere",
                     filter->type->name);
}

/* Room for the splats of a batch. */
static ps_result reserve_placed(struct render *render, struct error *error)
{
    size_t bytes = SPLATS_PLACED * sizeof *render->placed;
    if (!render->placed)
        render->placed = malloc(bytes);
    if (!render->placed)
        return error_memory(error, bytes, "splats placed");
    statistics_set_bytes(render->statistics, "splats placed", (double)bytes);
    return PS_OK;
}

/* What a splatter lights takes memory from here on, or, with a sign of -1, no more. */
static void count_lit(struct render *render, const struct splatter *splatter, double sign)
{
    statistics_add_bytes(render->statistics, "splatted pixels",
                         sign * (double)interleaved_bytes(&splatter->lit));
}

static ps_result create_splatter(struct render *render, struct interleaved layout,
                                 struct splatter *splatter, struct error *error)
{
    const struct strategy *visibility = strategy_in(render, PS_VISIBILITY);
    const struct footprint_params *footprint = strategy_shared(visibility);
    const ps_visibility_vtable *table = &visibility->type->table.visibility;
    struct splatter_settings settings = {
        .host = visibility->host,
        .visibility = table,
        .visibility_state = visibility->state,
        .resolution = table->depth_maps ? (uint32_t)footprint->resolution : 0,
        .surface_offset = render->scene->surface_offset,
        .kernel = render->kernel,
        .workers = render->settings->workers,
        .batch = render->settings->batch,
    };
    ps_result result = reserve_placed(render, error);
    if (result != PS_OK)
        return result;
    if (render->counts_splats)
        kernel_profile_count(&settings.profile);
    else
        result = tabulate_filter(render, &settings.profile, error);
    if (result == PS_OK)
        result = splatter_create(splatter, layout, &settings, error);
    if (result == PS_OK)
        count_lit(render, splatter, 1.0);
    return result;
}

/* Interleaving pays where n pixels are little beside a splat. In small pictures it blurs edges and
 * adds noise, and splats shrink as the number of paths grows. Subsets by powers of two share out
 * paths most evenly. */
#define SIDE_PER_STEP 150.0 /* pixels of the picture's side for each step of n */
#define MANY_PATHS 3000000
#define MOST_FOR_MANY 4

static uint32_t automatic_interleave(const struct render *render, uint32_t most)
{
    double side = PS_TILE_SIZE * sqrt((double)gbuffer_picture_tiles(&render->gbuffer));
    uint32_t n = 1;
    while (2 * n <= most && 2 * n * SIDE_PER_STEP <= side)
        n *= 2;
    return n;
}

static uint32_t interleave_of(const struct render *render, uint32_t n, uint32_t most)
{
    if (n == 0)
        return automatic_interleave(render, most);
    return n < PS_MOST_INTERLEAVE ? n : PS_MOST_INTERLEAVE;
}

void splats_drop_pixels(struct render *render)
{
    if (!render->has_splatter)
        return;
    render_report_splatter(render->statistics, &render->splatter);
    count_lit(render, &render->splatter, -1.0);
    splatter_release(&render->splatter);
    render->has_splatter = false;
}

/* Makes the splatter, or keeps that of the pass before. Short-range light stays as noisy when
 * splats become small, and is averaged as widely. */
static ps_result begin_interleaved(struct render *render, uint32_t n, struct error *error)
{
    bool many = render->photons.path_count > MANY_PATHS;
    uint32_t most = many ? MOST_FOR_MANY : PS_MOST_INTERLEAVE;
    render->gather_interleave = interleave_of(render, n, PS_MOST_INTERLEAVE);
    n = render->counts_splats ? 1 : interleave_of(render, n, most);
    if (render->has_splatter && render->splatter.lit.interleave == n)
        return PS_OK;
    splats_drop_pixels(render);
    ps_result result =
        create_splatter(render, interleaved_layout(&render->gbuffer, n), &render->splatter, error);
    render->has_splatter = result == PS_OK;
    return result;
}

ps_result splats_begin(struct render *render, uint32_t n, struct error *error)
{
    ps_result result = photon_stream_prepare(&render->photons, error);
    if (result == PS_OK)
        result = begin_interleaved(render, n, error);
    if (result != PS_OK)
        return result;
    struct splatter_pass pass = {render->pass.number, render->photons.path_count};
    interleaved_fill(&render->splatter.lit, &render->gbuffer, render->settings->workers);
    splatter_begin_pass(&render->splatter, pass);
    render->gathered_light.distance = 0.0f;
    render->splatting = true;
    return PS_OK;
}

ps_result splats_begin_points(struct render *render, const ps_vec3 *positions,
                              const ps_vec3 *normals, size_t n, struct error *error)
{
    ps_result result = photon_stream_prepare(&render->photons, error);
    if (result == PS_OK)
        result = create_splatter(render, point_tiles_layout(n), &render->points, error);
    if (result != PS_OK)
        return result;
    render->has_points = true;
    point_tiles_fill(&render->points.lit, positions, normals, render->settings->workers);
    struct splatter_pass pass = {render->pass.number, render->photons.path_count};
    splatter_begin_pass(&render->points, pass);
    return PS_OK;
}

void splats_read_points(const struct render *render, ps_rgb *irradiance)
{
    point_tiles_read(&render->points.lit, irradiance);
}

void splats_end_points(struct render *render, ps_rgb *irradiance)
{
    splats_read_points(render, irradiance);
    render_report_splatter(render->statistics, &render->points);
    splats_drop_points(render);
}

void splats_drop_points(struct render *render)
{
    if (!render->has_points)
        return;
    count_lit(render, &render->points, -1.0);
    splatter_release(&render->points);
    render->has_points = false;
}
