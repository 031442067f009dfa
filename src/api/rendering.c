#include "api/rendering.h"

#include "api/environment.h"
#include "api/report.h"
#include "session/layers.h"
#include "settings/quality.h"
#include <stdlib.h>
#include <string.h>

/* --- callbacks
 * ---------------------------------------------------------------------------------------- */

/* A process beside the first says only what that one can't: what it was warned of while it
 * rendered. */
static bool may_tell(const psplat_scene *scene, bool is_warning)
{
    return scene->listener &&
           (processes_is_first(scene->processes) || (is_warning && scene->processes->has_agreed));
}

static void log_message(void *user, ps_log_level level, const char *message)
{
    psplat_rendering *rendering = user;
    const psplat_scene *scene = rendering->scene;
    bool is_warning = level == PS_LOG_WARNING;
    if (level == PS_LOG_DEBUG || !may_tell(scene, is_warning))
        return;
    pthread_mutex_lock(&rendering->listening);
    scene->listener(scene->user, is_warning ? PSPLAT_WARNING : PSPLAT_REMARK, message);
    pthread_mutex_unlock(&rendering->listening);
}

static void show_progress(void *user, const char *stage, double fraction)
{
    const psplat_rendering *rendering = user;
    const psplat_progress progress = {.stage = stage, .fraction = fraction, .error = -1.0};
    if (rendering->callbacks.progress)
        rendering->callbacks.progress(rendering->callbacks.user, &progress);
}

static bool was_cancelled(void *user)
{
    const psplat_rendering *rendering = user;
    return rendering->callbacks.cancelled &&
           rendering->callbacks.cancelled(rendering->callbacks.user) != 0;
}

struct render_callbacks rendering_callbacks(psplat_rendering *rendering)
{
    return (struct render_callbacks){
        .user = rendering,
        .progress = show_progress,
        .log = log_message,
        .cancelled = was_cancelled,
    };
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

/* --- pictures
 * ----------------------------------------------------------------------------------------- */

/* What a display shows stays, so that it can be written. */
static bool stays(const void *layers, const char *channel)
{
    return layers_keep(layers, channel) || strncmp(channel, "display.", 8) == 0;
}

ps_result rendering_wrap(const psplat_rendering *rendering, struct image *image, uint32_t passes,
                         psplat_picture **picture, struct error *error)
{
    const psplat_scene *scene = rendering->scene;
    const struct output_options *output = &scene->options.output.options;
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

/* --- the call
 * ----------------------------------------------------------------------------------------- */

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
        render_options_adapt_preview(&scene->options, &scene->scene, &rendering->settings);
    else
        report_problems(error, result, sink);
    diagnostics_destroy(sink);
    return result;
}

/* With settings of its own: strategies serve one render. */
static ps_result start(psplat_rendering *rendering, rendering_work work, void *user,
                       psplat_error *error)
{
    struct error reason;
    ps_result result = resolve(rendering, error);
    if (result != PS_OK)
        return result;
    statistics_init(&rendering->statistics);
    pthread_mutex_init(&rendering->listening, NULL);
    result = work(rendering, user, &reason);
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
    return report_of_process(error, result, scene->processes);
}
