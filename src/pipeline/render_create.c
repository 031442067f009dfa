/* render_create.c: what a render needs before its first pass, and how it ends. */
#include "base/clock.h"
#include "host/splats.h"
#include "pipeline/planes.h"
#include "pipeline/render.h"
#include "pipeline/stages.h"
#include <stdlib.h>

ps_result render_start_strategies(struct render *render, ps_kind first, struct error *error)
{
    int end = render->settings->display ? PS_KINDS : PS_BLOOM;
    for (int kind = (int)first; kind < end; kind++) {
        ps_result result =
            strategy_start(strategy_in(render, (ps_kind)kind), &render->hosts[kind].host);
        result = render_judge(render, (ps_kind)kind, result, error);
        if (result != PS_OK)
            return result;
    }
    return PS_OK;
}

static ps_result create_shadow_maps(struct render *render, struct error *error)
{
    const struct render_settings *settings = render->settings;
    if (settings->direct != DIRECT_SHADOWMAP)
        return PS_OK;
    double start = clock_seconds();
    ps_result result = shadow_maps_create(render->scene, render->trace, settings->direct_resolution,
                                          settings->workers, &render->shadow_maps, error);
    if (result != PS_OK)
        return result;
    statistics_add_seconds(render->statistics, "direct maps", clock_seconds() - start);
    statistics_set_bytes(render->statistics, "direct maps",
                         (double)shadow_maps_bytes(render->shadow_maps));
    return PS_OK;
}

/* Pixels that ask different lights have nothing to compare. */
static ps_result check_join(const struct render *render, struct error *error)
{
    const struct scene *scene = render->scene;
    if (render->settings->discontinuity_buffer && scene_chooses_lights(scene))
        return error_set(
            error, PS_ERROR_INVALID,
            "discontinuity_buffer needs pixels that ask every light; the scene has %zu "
            "lights and light_choices is %u, less than half of that",
            light_bvh_count(scene->light_bvh), (unsigned)scene->light_choices);
    return PS_OK;
}

/* Of the picture, or of the part that is rendered. */
static ps_result create_gbuffer_and_film(struct render *render, const struct planes *planes,
                                         struct error *error)
{
    const struct render_settings *settings = render->settings;
    size_t width = render->scene->width, height = render->scene->height;
    struct rectangle window = planes_window(settings, width, height);
    ps_result result =
        gbuffer_create(planes_layout(settings, width, height), &render->gbuffer, error);
    if (result == PS_OK)
        result = film_create(window.width, window.height, planes->surfaces, &render->film, error);
    if (result == PS_OK)
        render->film.window = (struct picture_window){window.x, window.y, width, height};
    return result;
}

static ps_result add_to_gbuffer(struct render *render, const struct planes *planes,
                                struct error *error)
{
    struct gbuffer *gbuffer = &render->gbuffer;
    ps_result result = PS_OK;
    if (planes->gloss)
        result = gbuffer_prepare_glossy(gbuffer, error);
    if (result == PS_OK && planes->geometric)
        result = gbuffer_prepare_geometric_normals(gbuffer, error);
    if (result == PS_OK && planes->discontinuity_buffer)
        result = gbuffer_prepare_discontinuity_buffer(gbuffer, error);
    if (result == PS_OK && planes->direct_half)
        result = gbuffer_prepare_direct_half(gbuffer, error);
    if (result == PS_OK && planes->hard)
        result = gbuffer_prepare_hard(gbuffer, error);
    if (result == PS_OK && planes->radiance)
        result = gbuffer_prepare_radiance(gbuffer, error);
    if (result == PS_OK && planes->caustics)
        result = gbuffer_prepare_splatted(gbuffer, error);
    return result;
}

static ps_result add_to_film(struct render *render, const struct planes *planes,
                             struct error *error)
{
    struct film *film = &render->film;
    ps_result result = PS_OK;
    if (planes->gloss)
        result = film_add_plane(film, FILM_GLOSS, error);
    if (result == PS_OK && planes->variance)
        result = film_add_plane(film, FILM_VARIANCE, error);
    for (int c = 0; c < 3 && result == PS_OK && planes->splatted; c++)
        result = film_add_plane(film, FILM_SPLATTED_R + c, error);
    if (result == PS_OK && planes->ids)
        result = film_add_ids(film, error);
    if (result == PS_OK && planes->odd)
        result = film_add_halves(film, error);
    if (result == PS_OK && planes->reflected)
        result = film_add_reflected(film, planes->reflected_hard, error);
    if (result == PS_OK && planes->halves_of_pass)
        result = film_add_half_of_reflected(film, true, error);
    if (result == PS_OK && planes->halves_of_passes)
        result = film_add_half_of_reflected(film, false, error);
    return result;
}

static ps_result create_edges(struct render *render, struct error *error)
{
    size_t count = (size_t)render->gbuffer.tile_count * PS_TILE_PIXELS;
    render->edges = calloc(count, sizeof *render->edges);
    return render->edges ? PS_OK : error_memory(error, count * sizeof *render->edges, "edges");
}

static struct planes wanted(const struct render *render)
{
    bool sums = render->sum != NULL, keeps_film = sums && render->sum != &render->own_sum;
    return planes_wanted(render->settings, render->scene, sums, keeps_film);
}

static ps_result check_memory(const struct render *render, struct error *error)
{
    const struct planes planes = wanted(render);
    bool keeps_film = render->sum && render->sum != &render->own_sum;
    return memory_check(render->settings, &planes, render->scene, keeps_film, error);
}

/* All that is kept of pixels. */
static ps_result create_planes(struct render *render, struct error *error)
{
    const struct planes planes = wanted(render);
    ps_result result = create_gbuffer_and_film(render, &planes, error);
    if (result == PS_OK)
        result = add_to_gbuffer(render, &planes, error);
    if (result == PS_OK)
        result = add_to_film(render, &planes, error);
    return result == PS_OK && planes.edges ? create_edges(render, error) : result;
}

static void release_planes(struct render *render)
{
    splats_drop_pixels(render);
    splats_drop_points(render);
    free(render->placed);
    render->placed = NULL;
    gathered_light_release(&render->gathered_light);
    free(render->edges);
    render->edges = NULL;
    film_sum_release(&render->own_sum);
    film_release(&render->film);
    gbuffer_release(&render->gbuffer);
}

ps_result render_turn_to_part(struct render *render, struct error *error)
{
    release_planes(render);
    render->unfinished = false;
    return create_planes(render, error);
}

/* The caller's, or one of its own. */
static ps_result create_trace(struct render *render, struct error *error)
{
    const struct render_settings *settings = render->settings;
    render->trace = settings->trace;
    if (render->trace)
        return PS_OK;
    double start = clock_seconds();
    ps_result result = trace_create(render->scene, settings->isa, &render->trace, error);
    statistics_add_seconds(render->statistics, "build", clock_seconds() - start);
    return result;
}

ps_result render_create(struct render *render, struct error *error)
{
    const struct scene *scene = render->scene;
    ps_result result = render_check_crop(render->settings, scene->width, scene->height, error);
    if (result == PS_OK)
        result = settings_choose_kernel(render->settings, &render->kernel, error);
    if (result == PS_OK)
        result = create_trace(render, error);
    if (result == PS_OK)
        result = create_shadow_maps(render, error);
    if (result == PS_OK)
        result = check_join(render, error);
    if (result == PS_OK)
        result = check_memory(render, error);
    if (result == PS_OK)
        result = create_planes(render, error);
    if (result == PS_OK)
        result = render_start_strategies(render, (ps_kind)0, error);
    if (result == PS_OK)
        result = photon_stream_create(render, &render->photons, error);
    if (result != PS_OK)
        return result;
    crop_warn(render);
    statistics_set_bytes(render->statistics, "ray tracer", (double)trace_bytes(render->trace));
    statistics_set_bytes(render->statistics, "G-buffer", (double)gbuffer_bytes(&render->gbuffer));
    statistics_set_bytes(render->statistics, "film", (double)film_bytes(&render->film));
    return PS_OK;
}

void render_destroy(struct render *render)
{
    release_planes(render);
    photon_stream_release(&render->photons);
    importance_release(&render->importance);
    for (int kind = 0; kind < PS_KINDS; kind++)
        strategy_stop(&render->settings->strategies[kind]);
    render_report_kept(render);
    shadow_maps_destroy(render->shadow_maps);
    if (render->trace != render->settings->trace)
        trace_destroy(render->trace);
}
