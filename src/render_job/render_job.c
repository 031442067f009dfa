#include "render_job/render_job.h"

#include "base/clock.h"
#include "session/layers.h"
#include <math.h>
#include <stdio.h>

/* Layers of EXR files, what PNG files show, and the error for whoever asks. */
void render_job_set_wishes(const struct render_job *job, struct render_settings *settings)
{
    const struct output_list *outputs = &job->options->output;
    const char *layers = output_options_layers(&outputs->options);
    bool error = job->options->job.error > 0.0;
    bool is_seen = job->wants_picture || job->callbacks->show || job->callbacks->tile;
    bool sees_layers = is_seen && layers_any(layers);
    settings->picture_alone = !output_list_wants_layers(outputs) && !sees_layers && !error;
    settings->no_error_layer = !output_list_wants_error(outputs) && !error;
    settings->display = is_seen || output_list_wants_display(outputs);
    settings->exposure = job->description->image.exposure;
}

static void tell(const struct render_job *job, const char *message)
{
    job->callbacks->log(job->callbacks->user, PS_LOG_INFO, message);
}

/* Pixels that look black, or ambient, for want of splats. */
static void tell_of_dark_pixels(const struct render_job *job)
{
    double dark = statistics_counter(job->statistics, "pixels without weight");
    char remark[128];
    snprintf(remark, sizeof remark, "no indirect light reached %.0f pixel%s", dark,
             dark == 1.0 ? "" : "s");
    if (dark > 0.0)
        tell(job, remark);
}

static void tell_of_file(void *user, const char *path)
{
    char message[1200];
    snprintf(message, sizeof message, "wrote %.1000s", path);
    tell(user, message);
}

/* --- what the render asks
 * ----------------------------------------------------------------------------- */

static bool has_files(const struct render_job *job)
{
    return job->options->output.paths.count > 0 || job->options->job.checkpoint;
}

static bool was_cancelled(void *user)
{
    const struct render_job *job = user;
    return (!job->has_stopped && job->callbacks->cancelled(job->callbacks->user)) ||
           long_job_was_stopped(&job->passes);
}

static bool next_pass(void *user, struct render *render, uint32_t *number)
{
    struct render_job *job = user;
    bool another = long_job_next_pass(&job->passes, render, number);
    if (another && job->callbacks->pass && !job->processes && job->passes.passes_seen > 0)
        job->callbacks->pass(job->callbacks->user, render, job->passes.passes_seen);
    return another;
}

/* Who waits for files gets them whole, and not without the denoiser. */
static ps_result end_passes(void *user, ps_result result, struct error *error)
{
    struct render_job *job = user;
    job->has_stopped = has_files(job) && job->callbacks->cancelled(job->callbacks->user);
    return long_job_end_passes(&job->passes, result, error);
}

static void show_progress(void *user, const char *stage, double fraction)
{
    struct render_job *job = user;
    uint32_t passes = long_job_passes_done(&job->passes);
    if (!job->callbacks->progress)
        return;
    if (job->passes.team)
        fraction = (double)passes / settings_pass_count(job->settings);
    if (job_options_have_budget(&job->options->job))
        fraction = fmax(fraction, schedule_fraction(&job->passes.schedule, clock_seconds()));
    job->callbacks->progress(job->callbacks->user, stage, fraction, passes,
                             job->passes.schedule.estimate);
}

static void show_message(void *user, ps_log_level level, const char *message)
{
    const struct render_job *job = user;
    job->callbacks->log(job->callbacks->user, level, message);
}

/* --- what the passes' keeper asks
 * --------------------------------------------------------------------- */

static bool asks_to_write(void *user)
{
    const struct render_job *job = user;
    return job->callbacks->write_now(job->callbacks->user);
}

/* Writes all files that can be written. */
static ps_result write_picture(struct render_job *job, struct image *image, uint32_t passes,
                               output_list_tell told, struct error *error)
{
    const struct render_settings *settings = job->settings;
    /* What was interrupted in its first pass, or has gaps, no command repeats. */
    bool is_run = passes > 0 && long_job_has_run(&job->passes, settings->first_pass, passes);
    ps_result result = output_describe(image, job->description->path, &job->options->scene,
                                       settings, passes, is_run && !job->is_text, error);
    return result == PS_OK ? output_list_write(&job->options->output, image, settings->workers,
                                               told, job, error)
                           : result;
}

static ps_result write_picture_on_the_way(void *user, struct image *image, uint32_t passes,
                                          struct error *error)
{
    return write_picture(user, image, passes, NULL, error);
}

static void show_picture_on_the_way(void *user, struct image *image)
{
    const struct render_job *job = user;
    job->callbacks->show(job->callbacks->user, image, job->passes.passes_seen);
}

/* --- the render
 * --------------------------------------------------------------------------------------- */

static ps_result write_statistics(const struct render_job *job, struct error *error)
{
    const char *path = job->options->stats;
    statistics_add_seconds(job->statistics, "total", clock_seconds() - job->start);
    return path ? statistics_write(job->statistics, path, error) : PS_OK;
}

/* What can be written is; the error is the first one's. */
static ps_result write_files(struct render_job *job, struct image *image, uint32_t passes,
                             struct error *error)
{
    struct error reason;
    double start = clock_seconds();
    ps_result first = PS_OK;
    if (image->width > 0 && job->options->output.paths.count > 0)
        first = write_picture(job, image, passes, tell_of_file, error);
    ps_result kept = long_job_write_film(&job->passes, &reason);
    if (kept != PS_OK && first == PS_OK) {
        first = kept;
        *error = reason;
    }
    if (first != PS_OK)
        return first;
    statistics_add_seconds(job->statistics, "write", clock_seconds() - start);
    return write_statistics(job, error);
}

static ps_result run_tiled(struct render_job *job, const struct render_callbacks *callbacks,
                           struct error *error)
{
    const struct word_list *paths = &job->options->output.paths;
    struct error reason;
    if (paths->count == 0 && !job->callbacks->tile)
        return error_set(error, PS_ERROR_INVALID,
                         "the option 'tile' needs files, or a callback, which take the tiles");
    ps_result result = render_job_tiled(job, callbacks, error);
    if (result != PS_OK && result != PS_CANCELLED)
        return result;
    tell_of_dark_pixels(job);
    if (result == PS_CANCELLED)
        error_set(error, PS_CANCELLED, "interrupted: the picture holds the tiles done by then");
    for (size_t i = 0; i < paths->count && result == PS_OK; i++)
        tell_of_file(job, paths->words[i]);
    ps_result written = write_statistics(job, &reason);
    if (result == PS_OK && written != PS_OK)
        *error = reason;
    return result == PS_OK ? written : result;
}

static ps_result run_whole(struct render_job *job, const struct render_callbacks *callbacks,
                           struct image *image, uint32_t *passes, struct error *error)
{
    struct error reason;
    ps_result result = render_job_progressively(job, callbacks, image, error);
    *passes = (uint32_t)statistics_counter(job->statistics, "passes");
    if (image->width == 0 && job->passes.film.passes.count == 0)
        return result;
    tell_of_dark_pixels(job);
    if (job->callbacks->progress)
        job->callbacks->progress(job->callbacks->user, "writing files", 1.0, *passes,
                                 job->passes.schedule.estimate);
    ps_result written = write_files(job, image, *passes, &reason);
    if (result == PS_CANCELLED)
        error_set(error, PS_CANCELLED, "interrupted: the picture holds what was done by then");
    if (written == PS_OK)
        return result;
    if (result != PS_OK && result != PS_CANCELLED) {
        struct error both;
        error_set(&both, written, "%.2000s; and: %.2000s", error->text, reason.text);
        reason = both;
    }
    *error = reason;
    return written;
}

ps_result render_job_run(struct render_job *job, struct image *image, uint32_t *passes,
                         struct error *error)
{
    const struct render_callbacks callbacks = {
        .user = job,
        .progress = show_progress,
        .log = show_message,
        .cancelled = was_cancelled,
        .next_pass = job->settings->tile > 0 ? NULL : next_pass,
        .end_passes = end_passes,
    };
    job->passes = (struct long_job){
        .options = job->options,
        .processes = job->processes,
        .workers = job->settings->workers,
        .shows = job->callbacks->show != NULL,
        .log = show_message,
        .write_now = asks_to_write,
        .write_picture = write_picture_on_the_way,
        .show_picture = show_picture_on_the_way,
        .user = job,
    };
    *image = (struct image){0};
    *passes = 0;
    long_job_init(&job->passes, job->start);
    ps_result result = long_job_set_passes(&job->passes, job->settings, error);
    if (result == PS_OK)
        result = long_job_begin(&job->passes, job->description, job->scene, job->settings, error);
    if (result == PS_OK)
        result = job->settings->tile > 0 ? run_tiled(job, &callbacks, error)
                                         : run_whole(job, &callbacks, image, passes, error);
    long_job_release(&job->passes);
    return result;
}
