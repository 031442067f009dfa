/* tiled.c: a picture too large for the memory, rendered tile by tile straight into its files. */
#include "base/clock.h"
#include "render_job/render_job.h"
#include "session/tiled_output.h"
#include "session/tiled_render.h"

struct tiled_files {
    const struct render_job *job;
    struct tiled_output *output; /* NULL: no tile is done */
    bool cannot_write;
};

/* The picture's attributes are those of all of it. */
static ps_result begin_files(struct tiled_files *files, struct image *first, struct error *error)
{
    const struct render_job *job = files->job;
    const struct render_settings *settings = job->settings;
    const struct output_list *outputs = &job->options->output;
    ps_result result =
        output_describe(first, job->description->path, &job->options->scene, settings,
                        settings_pass_count(settings), !job->is_text, error);
    if (result != PS_OK)
        return result;
    return tiled_output_create((const char *const *)outputs->paths.words, outputs->paths.count,
                               &outputs->options, first, job->scene->width, job->scene->height,
                               settings->tile, settings->workers, &files->output, error);
}

static ps_result write_tile(struct tiled_files *files, struct rectangle tile, struct image *part,
                            struct error *error)
{
    double start = clock_seconds();
    ps_result result = files->output ? PS_OK : begin_files(files, part, error);
    if (result == PS_OK)
        result = tiled_output_add(files->output, part, tile, error);
    files->cannot_write = result != PS_OK;
    statistics_add_seconds(files->job->statistics, "write", clock_seconds() - start);
    return result;
}

/* See tiled_render.take. */
static ps_result take_tile(void *user, struct rectangle tile, struct image *part,
                           struct error *error)
{
    struct tiled_files *files = user;
    const struct render_job_callbacks *callbacks = files->job->callbacks;
    ps_result result = PS_OK;
    if (files->job->options->output.paths.count > 0)
        result = write_tile(files, tile, part, error);
    if (result == PS_OK && callbacks->tile)
        result = callbacks->tile(callbacks->user, tile, part, error);
    return result;
}

static ps_result finish(struct tiled_files *files, ps_result result, struct error *error)
{
    struct error reason;
    if (!files->output || files->cannot_write) {
        tiled_output_discard(files->output);
        return result;
    }
    ps_result finished = tiled_output_finish(files->output, &reason);
    if (finished == PS_OK || (result != PS_OK && result != PS_CANCELLED))
        return result;
    *error = reason;
    return finished;
}

ps_result render_job_tiled(struct render_job *job, const struct render_callbacks *callbacks,
                           struct error *error)
{
    struct tiled_files files = {.job = job};
    const struct tiled_render tiled = {
        .scene = job->scene,
        .settings = job->settings,
        .callbacks = callbacks,
        .statistics = job->statistics,
        .take = take_tile,
        .user = &files,
    };
    ps_result result = tiled_render_run(&tiled, error);
    return finish(&files, result, error);
}
