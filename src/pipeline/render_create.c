/* render_create.c: what a render needs before its first pass, and how it ends. */
#include "base/clock.h"
#include "host/splats.h"
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

/* The caller's film has all planes, so that any denoiser may resolve it. */
static bool keeps_film(const struct render *render)
{
    return render->sum && render->sum != &render->own_sum;
}

/* Those planes of the film are half of its memory, and of the time that adding to it takes. */
static bool wants_surfaces(const struct render *render)
{
    const struct render_settings *settings = render->settings;
    return keeps_film(render) || !settings->picture_alone ||
           settings->strategies[PS_DENOISER].type->table.denoiser.filter != NULL;
}

/* Of the picture, or of the part that is rendered. */
static ps_result create_gbuffer_and_film(struct render *render, struct error *error)
{
    size_t width = render->scene->width, height = render->scene->height;
    struct rectangle crop = render->settings->crop;
    bool all = crop.width == 0;
    struct gbuffer layout =
        all ? gbuffer_layout(width, height)
            : gbuffer_layout_around(crop, render->settings->aa_samples > 1, width, height);
    ps_result result = gbuffer_create(layout, &render->gbuffer, error);
    if (result == PS_OK)
        result = film_create(all ? width : crop.width, all ? height : crop.height,
                             wants_surfaces(render), &render->film, error);
    if (result == PS_OK)
        render->film.window = (struct picture_window){crop.x, crop.y, width, height};
    return result;
}

static ps_result create_gloss(struct render *render, struct error *error)
{
    ps_result result = gbuffer_prepare_glossy(&render->gbuffer, error);
    return result == PS_OK ? film_add_gloss(&render->film, error) : result;
}

/* Halves of the direct light tell its noise from an edge, of which hard shadows have some. */
static ps_result create_edges(struct render *render, struct error *error)
{
    const struct scene *scene = render->scene;
    size_t count = (size_t)render->gbuffer.tile_count * PS_TILE_PIXELS;
    render->edges = calloc(count, sizeof *render->edges);
    if (!render->edges)
        return error_memory(error, count * sizeof *render->edges, "edges");
    if (!scene_samples_lights(scene) || scene->light_samples < 2)
        return PS_OK;
    ps_result result = gbuffer_prepare_direct_half(&render->gbuffer, error);
    return result == PS_OK && scene_has_hard_shadows_apart(scene)
               ? gbuffer_prepare_hard(&render->gbuffer, error)
               : result;
}

/* Where a denoiser may smooth the direct light: it has noise, which halves of it tell, and nothing else smooths it.
 * Halves of each pass are best, since its samples look at the same places; but one shadow ray, or one sample of
 * gloss, has no halves, and then passes are. */
static ps_result create_reflected(struct render *render, struct error *error)
{
    const struct scene *scene = render->scene;
    const struct render_settings *settings = render->settings;
    bool shadows = scene_samples_lights(scene) && !settings->discontinuity_buffer;
    bool gloss = render->gbuffer.glossy != NULL;
    bool halved_shadows = shadows && scene->light_samples > 1;
    bool halved_gloss = gloss && settings->aa_samples > 1;
    bool halves = (halved_shadows || halved_gloss) &&
                  (!render->sum || (shadows == halved_shadows && gloss == halved_gloss));
    ps_result result = PS_OK;
    if ((!shadows && !gloss) || (!halves && !render->sum))
        return PS_OK;
    if (halves && halved_shadows)
        result = gbuffer_prepare_direct_half(&render->gbuffer, error);
    bool hard_apart = shadows && scene_has_hard_shadows_apart(scene);
    if (result == PS_OK && hard_apart)
        result = gbuffer_prepare_hard(&render->gbuffer, error);
    return result == PS_OK ? film_add_reflected(&render->film, halves, hard_apart, error) : result;
}

/* Pixels that ask different lights have nothing to compare. */
static ps_result create_join(struct render *render, struct error *error)
{
    const struct scene *scene = render->scene;
    if (scene_chooses_lights(scene))
        return error_set(
            error, PS_ERROR_INVALID,
            "discontinuity_buffer needs pixels that ask every light; the scene has %zu "
            "lights and light_choices is %u, less than half of that",
            light_bvh_count(scene->light_bvh), (unsigned)scene->light_choices);
    return scene->has_area_lights ? gbuffer_prepare_join(&render->gbuffer, error) : PS_OK;
}

/* What the tables of some strategies ask for. */
static ps_result create_for_strategies(struct render *render, struct error *error)
{
    uint32_t estimator = strategy_in(render, PS_ESTIMATOR)->type->table.estimator.flags;
    uint32_t denoiser = keeps_film(render)
                            ? UINT32_MAX
                            : strategy_in(render, PS_DENOISER)->type->table.denoiser.flags;
    ps_result result = PS_OK;
    if (estimator & PS_ESTIMATOR_RADIANCE)
        result = gbuffer_prepare_radiance(&render->gbuffer, error);
    if (result == PS_OK && denoiser & PS_DENOISER_IDS)
        result = film_add_ids(&render->film, error);
    if (result == PS_OK && denoiser & PS_DENOISER_HALVES && render->sum)
        result = film_add_halves(&render->film, error);
    if (result == PS_OK && denoiser & PS_DENOISER_DIRECT)
        result = create_reflected(render, error);
    return result;
}

ps_result render_create(struct render *render, struct error *error)
{
    const struct scene *scene = render->scene;
    double start = clock_seconds();
    ps_result result = render_check_crop(render->settings, scene->width, scene->height, error);
    if (result == PS_OK)
        result = settings_choose_kernel(render->settings, &render->kernel, error);
    if (result == PS_OK)
        result = trace_create(scene, render->settings->isa, &render->trace, error);
    statistics_add_seconds(render->statistics, "build", clock_seconds() - start);
    if (result == PS_OK)
        result = create_shadow_maps(render, error);
    if (result == PS_OK)
        result = create_gbuffer_and_film(render, error);
    if (result == PS_OK && scene->microfacets && wants_surfaces(render))
        result = create_gloss(render, error);
    if (result == PS_OK && render->settings->discontinuity_buffer)
        result = create_join(render, error);
    if (result == PS_OK && render->settings->aa_samples > 1)
        result = create_edges(render, error);
    if (result == PS_OK)
        result = create_for_strategies(render, error);
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
    if (render->has_splatter)
        splatter_release(&render->splatter);
    splats_drop_points(render);
    free(render->placed);
    gathered_light_release(&render->gathered_light);
    photon_stream_release(&render->photons);
    importance_release(&render->importance);
    for (int kind = 0; kind < PS_KINDS; kind++)
        strategy_stop(&render->settings->strategies[kind]);
    render_report_kept(render);
    free(render->edges);
    film_sum_release(&render->own_sum);
    film_release(&render->film);
    gbuffer_release(&render->gbuffer);
    shadow_maps_destroy(render->shadow_maps);
    trace_destroy(render->trace);
}
