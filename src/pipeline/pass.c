/* pass.c: one pass: G-buffer, direct light, the estimator's indirect light, and what becomes of
 * them in the film. */
#include "base/clock.h"
#include "base/parallel.h"
#include "base/sample.h"
#include "direct/direct.h"
#include "direct/discontinuity_buffer.h"
#include "host/host.h"
#include "host/splats.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"
#include "view/edges.h"
#include "view/fireflies.h"
#include "view/pixel_filter.h"
#include "view/view.h"
#include <math.h>
#include <psplat/tile.h>
#include <stdatomic.h>

static void report_progress(const struct render *render, const char *stage, double fraction)
{
    const struct render_callbacks *callbacks = render->callbacks;
    if (callbacks->progress)
        callbacks->progress(callbacks->user, stage, fraction);
}

/* Where in its pixels a pass looks: the first at their centres, later ones at points spread over
 * them, the same in all pixels so that a pass stays coherent. Not a matter of how many passes there
 * will be: a pass depends on its own number alone. */
static void set_jitter(struct render *render)
{
    float *jitter = render->jitter;
    jitter[0] = jitter[1] = 0.5f;
    if (render->pass.number == 0)
        return;
    float numbers[4];
    sample_point(sample_key(render->settings->seed, PS_STREAM_PIXEL, 0), render->pass.number,
                 numbers);
    pixel_filter_point(render->scene->pixel_filter, numbers, jitter);
}

struct tile_work {
    struct render *render;
    struct view_pass view;
    atomic_bool skipped; /* a tile was left out, as the render was cancelled */
};

/* The discontinuity buffer compares what rays to all lights met. */
static struct lighting lighting_of(const struct render *render)
{
    bool asks_all = render->settings->discontinuity_buffer;
    return (struct lighting){
        .scene = render->scene,
        .trace = render->trace,
        .maps = render->shadow_maps,
        .portals = render->importance.portals,
        .choices = render->scene->light_choices,
        .light_threshold = asks_all ? 0.0f : render->importance.light_threshold,
    };
}

static void trace_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct tile_work *work = user;
    struct view_points points;
    const struct gbuffer *gbuffer = &work->render->gbuffer;
    view_pixels(gbuffer, gbuffer_number(gbuffer, (uint32_t)index), work->render->pass.number,
                work->render->jitter[0], work->render->jitter[1], &points);
    view_trace(&work->view, &points, (uint32_t)index);
}

/* A run for each pixel; the tile by its number in the picture. */
static void runs_of_tile(uint32_t tile, uint32_t pass, uint32_t samples, struct light_runs *runs)
{
    runs->count = PS_TILE_PIXELS;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        runs->first[lane] = ps_sample_block(tile, lane) + (uint64_t)pass * samples;
        runs->of_lane[lane] = (uint8_t)lane;
    }
}

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct tile_work *work = user;
    struct render *render = work->render;
    uint32_t tile = (uint32_t)index, pass = render->pass.number;
    uint32_t samples = render->scene->light_samples;
    struct light_runs runs;
    if (render->gbuffer.occlusion)
        discontinuity_buffer_runs(&render->gbuffer, tile, pass, samples, &runs);
    else
        runs_of_tile(gbuffer_number(&render->gbuffer, tile), pass, samples, &runs);
    direct_light_tile(&work->view.lighting, &render->gbuffer, tile, render->settings->seed, &runs,
                      samples);
}

static void find_edges_of_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct tile_work *work = user;
    struct render *render = work->render;
    if (render->edges)
        edges_find(&render->gbuffer, (uint32_t)index, render->edges + index * PS_TILE_PIXELS);
    film_keep_ids(&render->film, &render->gbuffer, (uint32_t)index);
}

static void add_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct tile_work *work = user;
    film_add_tile(&work->render->film, &work->render->gbuffer, (uint32_t)index, NULL);
}

/* Adds a tile's pixels off the edges as they are; those at edges share what is left when fireflies
 * are spread. */
static void add_off_edges(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct tile_work *work = user;
    struct render *render = work->render;
    const uint8_t *edges = render->edges + index * PS_TILE_PIXELS;
    if (film_has_tile(&render->film, &render->gbuffer, (uint32_t)index))
        film_add_tile(&render->film, &render->gbuffer, (uint32_t)index, edges);
    fireflies_spread(&render->gbuffer, (uint32_t)index);
}

static void smooth_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    struct tile_work *work = user;
    struct render *render = work->render;
    if (host_is_cancelled(render)) {
        atomic_store(&work->skipped, true);
        return;
    }
    struct edge_pass pass = {
        .lighting = &work->view.lighting,
        .gbuffer = &render->gbuffer,
        .seed = render->settings->seed,
        .number = render->pass.number,
        .edges = render->edges,
        .samples = render->settings->aa_samples,
    };
    edges_add_tile(&pass, (uint32_t)index, &render->film);
}

static void over_tiles(struct tile_work *work, const char *stage, parallel_body body)
{
    struct render *render = work->render;
    double start = clock_seconds();
    parallel_for(render->settings->workers, render->gbuffer.tile_count, body, work);
    statistics_add_seconds(render->statistics, stage, clock_seconds() - start);
}

static void end_splats(struct render *render)
{
    struct splatter *splatter = &render->splatter;
    splatter_end_pass(splatter, &render->gbuffer);
    gathered_light_end(&render->gathered_light, &render->gbuffer, render->settings->workers);
}

uint64_t mend_plane(float *plane, size_t n)
{
    uint64_t bad = 0;
    for (size_t i = 0; i < n; i++)
        bad += !(plane[i] >= 0.0f && plane[i] < INFINITY);
    for (size_t i = 0; bad > 0 && i < n; i++)
        plane[i] = plane[i] >= 0.0f && plane[i] < INFINITY ? plane[i] : 0.0f;
    return bad;
}

static uint64_t mend_tile(struct gbuffer *gbuffer, uint32_t index)
{
    ps_tile *tile = &gbuffer->tiles[index];
    uint64_t bad = mend_plane(tile->irradiance_r, PS_TILE_PIXELS) +
                   mend_plane(tile->irradiance_g, PS_TILE_PIXELS) +
                   mend_plane(tile->irradiance_b, PS_TILE_PIXELS) +
                   mend_plane(tile->weight, PS_TILE_PIXELS) +
                   mend_plane(tile->variance, PS_TILE_PIXELS);
    if (tile->radiance_r)
        bad += mend_plane(tile->radiance_r, PS_TILE_PIXELS) +
               mend_plane(tile->radiance_g, PS_TILE_PIXELS) +
               mend_plane(tile->radiance_b, PS_TILE_PIXELS);
    if (gbuffer->splatted)
        bad += mend_plane(gbuffer_splatted(gbuffer, index, 0), 3 * PS_TILE_PIXELS);
    return bad;
}

ps_result render_estimate(struct render *render, struct error *error)
{
    const struct strategy *estimator = strategy_in(render, PS_ESTIMATOR);
    photon_stream_rewind(&render->photons);
    double start = clock_seconds();
    render->estimating = true;
    ps_result result = estimator->type->table.estimator.accumulate(estimator->state,
                                                                   estimator->host, &render->pass);
    render->estimating = false;
    if (result == PS_OK && render->splatting)
        end_splats(render);
    splats_drop_points(render);
    result = render_judge(render, PS_ESTIMATOR, result, error);
    for (uint32_t i = 0; i < render->gbuffer.tile_count; i++)
        render->refused.pixels[0] += mend_tile(&render->gbuffer, i);
    statistics_add_seconds(render->statistics, "estimate", clock_seconds() - start);
    return result == PS_OK && host_is_cancelled(render) ? PS_CANCELLED : result;
}

/* The estimator looks at the pass that it accumulated. */
static ps_result end_estimate(struct render *render, struct error *error)
{
    const struct strategy *estimator = strategy_in(render, PS_ESTIMATOR);
    const ps_estimator_vtable *table = &estimator->type->table.estimator;
    if (!table->end_pass)
        return PS_OK;
    ps_result result = table->end_pass(estimator->state, estimator->host, &render->pass);
    return render_judge(render, PS_ESTIMATOR, result, error);
}

static void light_pixels(struct tile_work *work)
{
    struct render *render = work->render;
    over_tiles(work, "direct", light_tile);
    if (!render->gbuffer.occlusion)
        return;
    double start = clock_seconds();
    discontinuity_buffer(&render->gbuffer, render->settings->workers);
    statistics_add_seconds(render->statistics, "direct", clock_seconds() - start);
}

/* What merges photons would take those in one place for one. */
static uint32_t shares_places(const struct render_settings *settings)
{
    const struct strategy *estimator = &settings->strategies[PS_ESTIMATOR];
    const struct strategy *stratification = &settings->strategies[PS_STRATIFICATION];
    return (estimator->type->table.estimator.flags & PS_ESTIMATOR_SHARES_PLACES) &&
           !stratification->type->table.stratification.stratify;
}

void pass_describe(struct render *render, uint32_t number)
{
    render->pass = (ps_pass){
        .size = sizeof(ps_pass),
        .number = number,
        .seed = render->settings->seed,
        .passes = render->settings->passes,
        .tile_count = gbuffer_picture_tiles(&render->gbuffer),
        .width = (uint32_t)render->gbuffer.width,
        .height = (uint32_t)render->gbuffer.height,
        .thread_count = workers_count(render->settings->workers),
        .surface_offset = render->scene->surface_offset,
        .specular = render->scene->microfacets != NULL,
        .shares_places = shares_places(render->settings),
        .bounces = render->settings->bounces,
        .part = render->part,
        .parts = render->parts,
    };
}

/* Fills the G-buffer and its direct light. */
static struct tile_work begin_pass(struct render *render, uint32_t number)
{
    pass_describe(render, number);
    render->splatting = false;
    render->progress_from = 0.0;
    render->progress_to = 1.0;
    report_progress(render, "direct light", render_fraction(render, 0.0));
    struct tile_work work = {
        .render = render,
        .view = {.lighting = lighting_of(render),
                 .gbuffer = &render->gbuffer,
                 .seed = render->settings->seed},
    };
    set_jitter(render);
    over_tiles(&work, "gbuffer", trace_tile);
    light_pixels(&work);
    return work;
}

/* Pass 0 tells which pixels are edges, and what they see, whoever renders it. */
static void find_edges(struct tile_work *work)
{
    over_tiles(work, "edges", find_edges_of_tile);
}

static void add_tiles(struct tile_work *work)
{
    over_tiles(work, "film", add_tile);
    film_end_pass(&work->render->film);
}

/* PS_CANCELLED, and an empty film, where it was cancelled before all edges were smooth. */
static ps_result end_pass(struct tile_work *work, struct error *error)
{
    struct render *render = work->render;
    if (!render->edges) {
        add_tiles(work);
        return PS_OK;
    }
    over_tiles(work, "edges", add_off_edges);
    over_tiles(work, "edges", smooth_tile);
    film_end_pass(&render->film);
    if (!work->skipped)
        return PS_OK;
    ps_result result = film_begin_pass(&render->film, render->pass.number, error);
    return result == PS_OK ? PS_CANCELLED : result;
}

/* Cancelled where nothing else is there: what there is of the pass makes a picture, its direct
 * light alone or all but smooth edges. */
static void keep_unfinished(struct render *render, struct tile_work *work, bool estimated)
{
    if (!estimated)
        gbuffer_clear_indirect(&render->gbuffer);
    add_tiles(work);
    render->unfinished = true;
}

static ps_result add_to_sum(struct render *render, struct error *error)
{
    struct film_sum *sum = render->sum;
    ps_result result = PS_OK;
    double start = clock_seconds();
    if (!sum->planes[FILM_COLOR_R].high)
        result = film_sum_create(&render->film, sum, error);
    if (result == PS_OK)
        result = film_sum_add(sum, &render->film, render->settings->workers, error);
    statistics_add_seconds(render->statistics, "film", clock_seconds() - start);
    statistics_set_bytes(render->statistics, "sums", (double)film_sum_bytes(sum));
    return result;
}

ps_result pass_run(struct render *render, uint32_t number, struct error *error)
{
    struct tile_work work = begin_pass(render, number);
    if (number == 0)
        find_edges(&work);
    ps_result result = film_begin_pass(&render->film, number, error);
    if (result == PS_OK)
        result = render_estimate(render, error);
    if (result == PS_OK)
        result = end_estimate(render, error);
    bool estimated = result == PS_OK;
    if (estimated)
        result = end_pass(&work, error);
    if (result == PS_OK && render->sum)
        result = add_to_sum(render, error);
    else if (result == PS_CANCELLED && render_passes_done(render) == 0)
        keep_unfinished(render, &work, estimated);
    return result;
}

void pass_look_at_first(struct render *render)
{
    if (!render->edges && !render->film.object)
        return;
    struct tile_work work = begin_pass(render, 0);
    find_edges(&work);
}

void pass_light_first(struct render *render)
{
    struct tile_work work = begin_pass(render, 0);
    find_edges(&work);
    add_tiles(&work);
    film_average(&render->film);
}
