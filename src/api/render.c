/* render.c: psplat_render: from a loaded scene to a picture. */
#include "api/environment.h"
#include "api/rendering.h"
#include "api/report.h"
#include "pipeline/planes.h"
#include "session/layers.h"
#include "session/output.h"
#include "session/remark.h"
#include "session/tiled_render.h"
#include "settings/quality.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void tell(psplat_rendering *rendering, bool is_warning, const char *message)
{
    const psplat_scene *scene = rendering->scene;
    if (!scene->listener)
        return;
    pthread_mutex_lock(&rendering->listening);
    scene->listener(scene->user, is_warning, message);
    pthread_mutex_unlock(&rendering->listening);
}

static void log_message(void *user, ps_log_level level, const char *message)
{
    if (level != PS_LOG_DEBUG)
        tell(user, level == PS_LOG_WARNING, message);
}

static void show_progress(void *user, const char *stage, double fraction)
{
    const psplat_rendering *rendering = user;
    if (rendering->callbacks.progress)
        rendering->callbacks.progress(rendering->callbacks.user, stage, fraction);
}

static bool was_cancelled(void *user)
{
    const psplat_rendering *rendering = user;
    return rendering->callbacks.cancelled &&
           rendering->callbacks.cancelled(rendering->callbacks.user) != 0;
}

static bool next_pass(void *user, struct render *render, uint32_t *number)
{
    psplat_rendering *rendering = user;
    const struct film_sum *film = render_film(render);
    uint32_t passes = film ? pass_set_size(&film->passes) : 0;
    bool another = render_missing_pass(render, number);
    if (another && passes > 0 && rendering->callbacks.pass) {
        rendering->render = render;
        rendering->callbacks.pass(rendering->callbacks.user, rendering, passes);
        rendering->render = NULL;
    }
    return another;
}

/* What a display shows stays, so that it can be written. */
static bool stays(const void *layers, const char *channel)
{
    return layers_keep(layers, channel) || strncmp(channel, "display.", 8) == 0;
}

/* Wraps an image, which it takes over in any case. */
static ps_result wrap(const psplat_rendering *rendering, struct image *image, uint32_t passes,
                      psplat_picture **picture, struct error *error)
{
    const psplat_scene *scene = rendering->scene;
    const struct output_options *output = &scene->options.output;
    psplat_picture *made = calloc(1, sizeof *made);
    if (!made) {
        image_release(image);
        return error_memory(error, sizeof *made, "a picture");
    }
    image_keep_channels(image, stays, output_options_layers(output));
    made->image = *image;
    made->threads = workers_count(rendering->settings.workers);
    made->output.compression = output->compression;
    /* A text in memory is nothing that a command could render. */
    ps_result result =
        output_describe(&made->image, scene->input.description.path, &scene->options.scene,
                        &rendering->settings, passes, passes > 0 && !scene->is_text, error);
    if (result == PS_OK && output->layers)
        result = output_options_set(&made->output, "layers", output->layers, error);
    if (result == PS_OK)
        *picture = made;
    else
        psplat_picture_destroy(made);
    return result;
}

ps_result psplat_rendering_picture(psplat_rendering *rendering, psplat_picture **picture,
                                   psplat_error *error)
{
    struct image image;
    struct error reason;
    *picture = NULL;
    if (!rendering->render) {
        error_set(&reason, PS_ERROR_INVALID,
                  "psplat_rendering_picture: only the callback 'pass' may call it");
        return report_error(error, PS_ERROR_INVALID, &reason);
    }
    uint32_t passes = pass_set_size(&render_film(rendering->render)->passes);
    ps_result result = render_picture(rendering->render, true, &image, &reason);
    if (image.width > 0) {
        struct error other;
        ps_result wrapped = wrap(rendering, &image, passes, picture, &other);
        if (result == PS_OK && wrapped != PS_OK) {
            result = wrapped;
            reason = other;
        }
    }
    return result == PS_OK ? PS_OK : report_error(error, result, &reason);
}

static void tell_of_dark_pixels(psplat_rendering *rendering)
{
    char remark[REMARK_TEXT];
    if (remark_dark_pixels(&rendering->statistics, remark))
        tell(rendering, false, remark);
}

/* See tiled_render.take. */
static ps_result take_tile(void *user, struct rectangle tile, struct image *part,
                           struct error *error)
{
    psplat_rendering *rendering = user;
    const struct picture_window *window = &part->window;
    psplat_picture *picture;
    image_crop(part, (struct rectangle){tile.x - window->left, tile.y - window->top, tile.width,
                                        tile.height});
    ps_result result =
        wrap(rendering, part, settings_pass_count(&rendering->settings), &picture, error);
    *part = (struct image){0};
    if (result == PS_OK)
        rendering->callbacks.tile(rendering->callbacks.user, picture, tile.x, tile.y);
    return result;
}

static ps_result run_tiles(psplat_rendering *rendering, const struct render_callbacks *callbacks,
                           struct error *error)
{
    const struct tiled_render tiled = {
        .scene = &rendering->scene->scene,
        .settings = &rendering->settings,
        .callbacks = callbacks,
        .statistics = &rendering->statistics,
        .take = take_tile,
        .user = rendering,
    };
    if (!rendering->callbacks.tile)
        return error_set(error, PS_ERROR_INVALID,
                         "the option 'tile' needs the callback 'tile', which takes the tiles");
    ps_result result = tiled_render_run(&tiled, error);
    if (result == PS_CANCELLED)
        error_set(error, result, "cancelled: the last tile holds what was done by then");
    tell_of_dark_pixels(rendering);
    return result;
}

static ps_result run(psplat_rendering *rendering, const struct render_callbacks *callbacks,
                     void *user, struct error *error)
{
    psplat_picture **picture = user;
    struct image image;
    struct render_callbacks with_passes = *callbacks;
    with_passes.next_pass = next_pass;
    if (rendering->settings.tile > 0)
        return run_tiles(rendering, callbacks, error);
    ps_result result = render_run(&rendering->scene->scene, &rendering->settings, &with_passes,
                                  &rendering->statistics, NULL, &image, error);
    if (result == PS_CANCELLED)
        error_set(error, result, "cancelled: the picture holds what was done by then");
    if (image.width == 0)
        return result;
    tell_of_dark_pixels(rendering);
    struct error reason;
    uint32_t passes = (uint32_t)statistics_counter(&rendering->statistics, "passes");
    ps_result wrapped = wrap(rendering, &image, passes, picture, &reason);
    if (result != PS_OK || wrapped == PS_OK)
        return result;
    *error = reason;
    return wrapped;
}

/* The layers that are asked for, and what a display shows. */
static void set_wishes(const psplat_scene *scene, struct render_settings *settings)
{
    const char *layers = output_options_layers(&scene->options.output);
    settings->picture_alone = !layers_are_some(layers);
    settings->no_error_layer = !layers_have_error(layers);
    settings->display = true;
    settings->exposure = scene->input.description.image.exposure;
}

static ps_result resolve(psplat_rendering *rendering, psplat_error *error)
{
    const psplat_scene *scene = rendering->scene;
    struct scene_description description = scene->input.description;
    struct diagnostics *sink = diagnostics_create();
    if (!sink) {
        struct error reason;
        error_memory(&reason, 0, "the settings");
        return report_error(error, PS_ERROR_MEMORY, &reason);
    }
    if (rendering->is_preview)
        description.render.quality = QUALITY_DRAFT;
    ps_result result =
        render_options_resolve(&scene->options, &description, sink, &rendering->settings);
    rendering->settings.trace = scene->trace;
    if (result == PS_OK)
        render_options_suit_scene(&scene->options, &scene->scene, &rendering->settings);
    else
        report_problems(error, result, sink);
    diagnostics_destroy(sink);
    return result;
}

/* Those that the caller knows, others being zero. */
static ps_result take_callbacks(const psplat_callbacks *given, psplat_callbacks *taken,
                                struct error *error)
{
    *taken = (psplat_callbacks){.size = sizeof *taken};
    if (!given)
        return PS_OK;
    if (given->size < sizeof given->size || given->size > sizeof *taken ||
        given->size % sizeof(void *) != 0)
        return error_set(error, PS_ERROR_INVALID,
                         "psplat_callbacks.size is %zu, which no version up to this one has: it "
                         "has %zu",
                         given->size, sizeof *taken);
    memcpy(taken, given, given->size);
    return PS_OK;
}

/* With settings of its own: strategies serve one render. */
static ps_result start(psplat_rendering *rendering, rendering_work work, void *user,
                       psplat_error *error)
{
    const struct render_callbacks callbacks = {
        .user = rendering,
        .progress = show_progress,
        .log = log_message,
        .cancelled = was_cancelled,
    };
    struct error reason;
    ps_result result = resolve(rendering, error);
    if (result != PS_OK)
        return result;
    set_wishes(rendering->scene, &rendering->settings);
    statistics_init(&rendering->statistics);
    pthread_mutex_init(&rendering->listening, NULL);
    result = work(rendering, &callbacks, user, &reason);
    pthread_mutex_destroy(&rendering->listening);
    statistics_destroy(&rendering->statistics);
    settings_release(&rendering->settings);
    return result == PS_OK ? PS_OK : report_error(error, result, &reason);
}

ps_result rendering_do(psplat_rendering *rendering, const psplat_callbacks *callbacks,
                       rendering_work work, void *user, psplat_error *error)
{
    const psplat_scene *scene = rendering->scene;
    struct error reason;
    fenv_t caller;
    ps_result result = take_callbacks(callbacks, &rendering->callbacks, &reason);
    if (result == PS_OK && !scene->is_loaded)
        result = error_set(&reason, PS_ERROR_INVALID,
                           "no scene is loaded; options are to be set before psplat_scene_load");
    if (result != PS_OK)
        return report_error(error, result, &reason);
    environment_enter(&caller);
    result = start(rendering, work, user, error);
    environment_leave(&caller);
    return result;
}

ps_result psplat_render(const psplat_scene *scene, const psplat_callbacks *callbacks,
                        psplat_picture **picture, psplat_error *error)
{
    psplat_rendering rendering = {.scene = scene};
    *picture = NULL;
    return rendering_do(&rendering, callbacks, run, picture, error);
}

/* --- previews ---------------------------------------------------------------------------------------- */

struct preview {
    double pixels;
    psplat_picture **picture;
};

static ps_result run_preview(psplat_rendering *rendering, const struct render_callbacks *callbacks,
                             void *user, struct error *error)
{
    const struct preview *preview = user;
    const struct scene *scene = &rendering->scene->scene;
    struct render_settings *settings = &rendering->settings;
    struct image image;
    struct rectangle crop = settings->crop;
    struct rectangle window = planes_window(settings, scene->width, scene->height);
    double all = (double)window.width * (double)window.height;
    double step = fmax(sqrt(all / fmax(preview->pixels, 1.0)), 1.0);
    settings->tile = 0;
    ps_result result =
        render_coarse(scene, settings, step, callbacks, &rendering->statistics, &image, error);
    settings->crop = crop;
    if (result == PS_OK)
        return wrap(rendering, &image, 0, preview->picture, error);
    image_release(&image);
    return result;
}

ps_result psplat_preview(const psplat_scene *scene, size_t pixels,
                         const psplat_callbacks *callbacks, psplat_picture **picture,
                         psplat_error *error)
{
    psplat_rendering rendering = {.scene = scene, .is_preview = true};
    struct preview preview = {(double)pixels, picture};
    *picture = NULL;
    return rendering_do(&rendering, callbacks, run_preview, &preview, error);
}
