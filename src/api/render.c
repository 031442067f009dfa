/* render.c: psplat_render: from a loaded scene to a picture, and to files. */
#include "api/rendering.h"
#include "api/report.h"
#include "base/clock.h"
#include "render_job/render_job.h"

static void show_progress(void *user, const char *stage, double fraction, uint32_t passes,
                          double error)
{
    const psplat_rendering *rendering = user;
    const psplat_progress progress = {stage, fraction, error, passes};
    rendering->callbacks.progress(rendering->callbacks.user, &progress);
}

static bool asks_to_write(void *user)
{
    const psplat_rendering *rendering = user;
    return rendering->callbacks.write_now &&
           rendering->callbacks.write_now(rendering->callbacks.user) != 0;
}

static void end_pass(void *user, struct render *render, uint32_t passes)
{
    psplat_rendering *rendering = user;
    rendering->render = render;
    rendering->callbacks.pass(rendering->callbacks.user, rendering, passes);
    rendering->render = NULL;
}

static void show(void *user, struct image *image, uint32_t passes)
{
    psplat_rendering *rendering = user;
    psplat_picture *picture;
    struct error error;
    if (rendering_wrap(rendering, image, passes, &picture, &error) == PS_OK)
        rendering->callbacks.show(rendering->callbacks.user, picture);
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
        rendering_wrap(rendering, part, settings_pass_count(&rendering->settings), &picture, error);
    *part = (struct image){0};
    if (result == PS_OK)
        rendering->callbacks.tile(rendering->callbacks.user, picture, tile.x, tile.y);
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
        ps_result wrapped = rendering_wrap(rendering, &image, passes, picture, &other);
        if (result == PS_OK && wrapped != PS_OK) {
            result = wrapped;
            reason = other;
        }
    }
    return result == PS_OK ? PS_OK : report_error(error, result, &reason);
}

static struct render_job_callbacks callbacks_of(psplat_rendering *rendering)
{
    const struct psplat_callbacks *given = &rendering->callbacks;
    const struct render_callbacks base = rendering_callbacks(rendering);
    struct render_job_callbacks callbacks = {
        .user = rendering,
        .log = base.log,
        .cancelled = base.cancelled,
        .write_now = asks_to_write,
    };
    if (!processes_is_first(rendering->scene->processes))
        return callbacks;
    callbacks.progress = given->progress ? show_progress : NULL;
    callbacks.pass = given->pass ? end_pass : NULL;
    callbacks.show = given->show ? show : NULL;
    callbacks.tile = given->tile ? take_tile : NULL;
    return callbacks;
}

/* `user`: where the picture goes; NULL: nobody waits for it. */
static ps_result run(psplat_rendering *rendering, void *user, struct error *error)
{
    const psplat_scene *scene = rendering->scene;
    const struct load_times *times = &scene->times;
    const struct render_job_callbacks callbacks = callbacks_of(rendering);
    psplat_picture **picture = user;
    struct render_options options = scene->options; /* which lends what it owns */
    bool is_first = processes_is_first(scene->processes);
    if (!is_first) {
        options.output.paths.count = 0;
        options.stats = NULL;
    }
    struct render_job job = {
        .options = &options,
        .description = &scene->input.description,
        .scene = &scene->scene,
        .processes = scene->processes,
        .callbacks = &callbacks,
        .settings = &rendering->settings,
        .statistics = &rendering->statistics,
        .start = clock_seconds() - times->load - times->scene - times->build,
        .is_text = scene->is_text,
        .wants_picture = picture && is_first,
    };
    struct image image;
    struct error reason;
    uint32_t passes;
    statistics_add_seconds(job.statistics, "load", times->load);
    statistics_add_seconds(job.statistics, "scene", times->scene);
    statistics_add_seconds(job.statistics, "build", times->build);
    render_job_set_wishes(&job, job.settings);
    ps_result result = render_job_run(&job, &image, &passes, error);
    if (image.width == 0 || !job.wants_picture) {
        image_release(&image);
        return result;
    }
    ps_result wrapped = rendering_wrap(rendering, &image, passes, picture, &reason);
    if (result != PS_OK || wrapped == PS_OK)
        return result;
    *error = reason;
    return wrapped;
}

ps_result psplat_render(const psplat_scene *scene, const psplat_callbacks *callbacks,
                        psplat_picture **picture, psplat_error *error)
{
    psplat_rendering rendering = {.scene = scene};
    if (picture)
        *picture = NULL;
    return rendering_do(&rendering, callbacks, run, picture, error);
}
