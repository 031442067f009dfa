#include "pipeline/render.h"

#include "host/host.h"
#include "pipeline/stages.h"
#include <math.h>

static ps_result begin_estimates(struct render *render, struct error *error)
{
    const struct strategy *estimator = strategy_in(render, PS_ESTIMATOR);
    const ps_estimator_vtable *table = &estimator->type->table.estimator;
    if (!table->begin)
        return PS_OK;
    ps_result result = table->begin(estimator->state, estimator->host, &render->pass);
    result = render_judge(render, PS_ESTIMATOR, result, error);
    render->has_begun = result == PS_OK;
    return result;
}

static void end_estimates(struct render *render)
{
    const struct strategy *estimator = strategy_in(render, PS_ESTIMATOR);
    const ps_estimator_vtable *table = &estimator->type->table.estimator;
    render->has_tiles = true;
    if (render->has_begun && table->end)
        table->end(estimator->state, estimator->host);
    render->has_begun = render->has_tiles = false;
}

bool render_missing_pass(const struct render *render, uint32_t *number)
{
    const struct render_settings *settings = render->settings;
    *number = settings->first_pass;
    if (render->sum)
        *number = pass_set_next_missing(&render->sum->passes, *number);
    else
        *number += render->film.passes;
    return *number < settings->passes;
}

static bool next_pass(struct render *render, uint32_t *number)
{
    const struct render_callbacks *callbacks = render->callbacks;
    return callbacks->next_pass ? callbacks->next_pass(callbacks->user, render, number)
                                : render_missing_pass(render, number);
}

static ps_result run_each_pass(struct render *render, struct error *error)
{
    ps_result result = PS_OK;
    bool looked = false;
    uint32_t number;
    while (result == PS_OK && next_pass(render, &number)) {
        if (number > 0 && !looked)
            pass_look_at_first(render);
        looked = true;
        result = pass_run(render, number, error);
    }
    return result;
}

/* A film of the caller's that has passes must be one of this render's. */
static ps_result check_film(const struct render *render, struct error *error)
{
    if (!render->sum || render->sum->passes.count == 0 || film_sum_fits(render->sum, &render->film))
        return PS_OK;
    return error_set(error, PS_ERROR_INVALID,
                     "the film to go on with does not have the layers of this render");
}

static ps_result run_passes(struct render *render, struct error *error)
{
    pass_describe(render, 0);
    render->has_tiles = true;
    ps_result result =
        importance_is_for_pixels(render->scene) ? render_find_importance(render, error) : PS_OK;
    if (result == PS_OK && !render->has_begun)
        result = begin_estimates(render, error);
    if (result == PS_OK)
        result = run_each_pass(render, error);
    if (result != PS_OK || render->part + 1 == render->parts)
        end_estimates(render);
    render->has_tiles = false;
    if (render->callbacks->end_passes) {
        struct error reason;
        ps_result ended = render->callbacks->end_passes(render->callbacks->user, result, &reason);
        if (result == PS_OK && ended != PS_OK) {
            result = ended;
            *error = reason;
        }
    }
    if (result != PS_OK && result != PS_CANCELLED && render_passes_done(render) > 0)
        own_host(render)->log(own_host(render), PS_LOG_WARNING,
                              "a pass failed; the picture holds those before it");
    return result;
}

const struct film_sum *render_film(const struct render *render)
{
    return render->sum;
}

ps_result render_picture(struct render *render, bool display, struct image *image,
                         struct error *error)
{
    *image = (struct image){0};
    if (render->sum && !render->unfinished) {
        ps_result result = film_begin_pass(&render->film, 0, error);
        if (result != PS_OK)
            return result;
        film_sum_round(render->sum, &render->film, render->settings->workers);
    }
    return resolve_image(render, display && render->settings->display, image, error);
}

/* The passes of a render, or of its part, and their picture. */
static ps_result make_picture(struct render *render, struct image *image, struct error *error)
{
    *image = (struct image){0};
    ps_result result = run_passes(render, error);
    if (render_passes_done(render) == 0 && !render->unfinished)
        return result;
    struct error reason;
    ps_result resolved = render_picture(render, true, image, &reason);
    statistics_count(render->statistics, "pixels without weight", render->dark_pixels);
    if (resolved != PS_OK && (result == PS_OK || image->width == 0)) {
        result = resolved;
        *error = reason;
    }
    return result;
}

ps_result render_run(const struct scene *scene, struct render_settings *settings,
                     const struct render_callbacks *callbacks, struct statistics *statistics,
                     struct film_sum *film, struct image *image, struct error *error)
{
    struct render render = {
        .scene = scene,
        .settings = settings,
        .callbacks = callbacks,
        .statistics = statistics,
        .parts = 1,
        .sum = film,
    };
    *image = (struct image){0};
    if (!film && settings_pass_count(settings) > 1)
        render.sum = &render.own_sum;
    host_create(&render);
    ps_result result = render_create(&render, error);
    if (result == PS_OK)
        result = check_film(&render, error);
    if (result == PS_OK) {
        result = make_picture(&render, image, error);
        statistics_count(statistics, "passes", render_passes_done(&render));
    }
    render_report_refused(&render);
    render_destroy(&render);
    return result;
}

ps_result render_coarse(const struct scene *scene, struct render_settings *settings, double step,
                        const struct render_callbacks *callbacks, struct statistics *statistics,
                        struct image *image, struct error *error)
{
    struct rectangle window = planes_window(settings, scene->width, scene->height);
    struct scene coarse = *scene;
    coarse.width = (size_t)ceil((double)window.width / step);
    coarse.height = (size_t)ceil((double)window.height / step);
    coarse.camera = camera_of_part(&scene->camera, (float)window.x, (float)window.y, (float)step);
    settings->crop = (struct rectangle){0};
    settings->first_pass = 0;
    settings->passes = 1;
    return render_run(&coarse, settings, callbacks, statistics, NULL, image, error);
}

static struct rectangle largest_of(const struct render_parts *parts)
{
    struct rectangle largest = parts->places[0];
    for (uint32_t i = 1; i < parts->count; i++)
        if (parts->places[i].width * parts->places[i].height > largest.width * largest.height)
            largest = parts->places[i];
    return largest;
}

/* Whatever there is of the part is handed over. */
static ps_result make_part(struct render *render, const struct render_parts *parts,
                           struct error *error)
{
    struct image image;
    struct error reason;
    render->settings->crop = parts->places[render->part];
    ps_result result = render_turn_to_part(render, error), taken = PS_OK;
    if (result != PS_OK)
        return result;
    result = make_picture(render, &image, error);
    if (image.width > 0)
        taken = parts->take(parts->user, render->part, &image, &reason);
    image_release(&image);
    if (taken == PS_OK)
        return result;
    *error = reason;
    return taken;
}

ps_result render_run_parts(const struct scene *scene, struct render_settings *settings,
                           const struct render_callbacks *callbacks, struct statistics *statistics,
                           const struct render_parts *parts, struct error *error)
{
    struct render render = {
        .scene = scene,
        .settings = settings,
        .callbacks = callbacks,
        .statistics = statistics,
        .parts = parts->count,
    };
    if (settings_pass_count(settings) > 1)
        render.sum = &render.own_sum;
    settings->crop = largest_of(parts);
    host_create(&render);
    ps_result result = render_create(&render, error);
    for (; result == PS_OK && render.part < parts->count; render.part++)
        result = make_part(&render, parts, error);
    end_estimates(&render); /* where a last stage failed before the last part */
    if (result == PS_OK)
        statistics_count(statistics, "passes", settings_pass_count(settings));
    render_report_refused(&render);
    render_destroy(&render);
    return result;
}

static ps_result start_resolving(struct render *render, struct error *error)
{
    ps_result result = trace_create(render->scene, render->settings->isa, &render->trace, error);
    if (result == PS_OK)
        result = film_sum_create_film(render->sum, &render->film, error);
    if (result == PS_OK)
        result = render_start_strategies(render, PS_NORMALIZATION, error);
    if (result == PS_OK)
        crop_warn(render);
    return result;
}

ps_result render_resolve(struct film_sum *film, const struct scene *seen,
                         struct render_settings *settings, const struct render_callbacks *callbacks,
                         struct statistics *statistics, struct image *image, struct error *error)
{
    bool whole = film->window.picture_width == 0;
    const struct scene scene = {
        .camera = seen->camera,
        .center = seen->center,
        .radius = seen->radius,
        .width = whole ? film->width : film->window.picture_width,
        .height = whole ? film->height : film->window.picture_height,
    };
    struct render render = {
        .scene = &scene,
        .settings = settings,
        .callbacks = callbacks,
        .statistics = statistics,
        .parts = 1,
        .sum = film,
    };
    *image = (struct image){0};
    host_create(&render);
    ps_result result = start_resolving(&render, error);
    if (result == PS_OK)
        result = render_picture(&render, true, image, error);
    render_report_refused(&render);
    render_destroy(&render);
    return result;
}

ps_result render_display(float *const planes[3], size_t width, size_t height,
                         struct render_settings *settings, const struct render_callbacks *callbacks,
                         struct error *error)
{
    const struct scene scene = {.width = width, .height = height};
    struct statistics statistics;
    settings->display = true;
    struct render render = {
        .scene = &scene,
        .settings = settings,
        .callbacks = callbacks,
        .statistics = &statistics,
        .parts = 1,
    };
    statistics_init(&statistics);
    host_create(&render);
    ps_result result = trace_create(&scene, settings->isa, &render.trace, error);
    if (result == PS_OK)
        result = render_start_strategies(&render, PS_BLOOM, error);
    if (result == PS_OK)
        result = display_show(&render, planes, width, height, error);
    render_report_refused(&render);
    render_destroy(&render);
    statistics_destroy(&statistics);
    return result;
}

ps_result render_inspect(const struct scene *scene, struct render_settings *settings,
                         const struct render_callbacks *callbacks, struct statistics *statistics,
                         render_inspector inspect, void *user, struct error *error)
{
    struct render render = {
        .scene = scene,
        .settings = settings,
        .callbacks = callbacks,
        .statistics = statistics,
        .parts = 1,
    };
    settings->first_pass = 0;
    settings->passes = settings->aa_samples = 1;
    host_create(&render);
    ps_result result = render_create(&render, error);
    if (result == PS_OK) {
        pass_light_first(&render);
        render.has_tiles = render.estimating = true;
        result = inspect(user, &render, error);
    }
    render_destroy(&render);
    return result;
}

ps_result render_try(const struct scene *scene, struct render_settings *settings,
                     const struct render_callbacks *callbacks, struct error *error)
{
    struct statistics statistics;
    struct render render = {
        .scene = scene,
        .settings = settings,
        .callbacks = callbacks,
        .statistics = &statistics,
        .parts = 1,
    };
    statistics_init(&statistics);
    host_create(&render);
    ps_result result = trace_create(scene, settings->isa, &render.trace, error);
    if (result == PS_OK)
        result = render_start_strategies(&render, (ps_kind)0, error);
    render_destroy(&render);
    statistics_destroy(&statistics);
    return result;
}
