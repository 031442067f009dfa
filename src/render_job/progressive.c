/* progressive.c: a render that shows something within a second, and keeps to its time.
 *
 * Pictures of large pixels come before the first pass (first_pictures.h). Where they tell that
 * there is no time for passes as they were asked for, passes are of less quality, and where not
 * even one of these would be done, the last of those pictures is the result.
 */
#include "base/clock.h"
#include "render_job/first_pictures.h"
#include "render_job/render_job.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool make_settings(void *user, const struct scene *scene, enum quality quality,
                          struct render_settings *settings)
{
    const struct render_job *job = user;
    struct scene_description other = *job->description;
    struct diagnostics *sink = diagnostics_create();
    other.render.quality = (int32_t)quality;
    bool good = sink && render_options_resolve(job->options, &other, sink, settings) == PS_OK;
    diagnostics_destroy(sink);
    if (!good)
        return false;
    render_job_set_wishes(job, settings);
    render_options_adapt_preview(job->options, scene, settings);
    return true;
}

/* In a file, what nobody looks at would take time to write. */
static bool is_looked_at(const char *channel)
{
    bool is_picture = strlen(channel) == 1 && strchr("RGB", channel[0]);
    return is_picture || strncmp(channel, "display.", 8) == 0;
}

/* What the denoiser takes for its error is not that of a picture that was scaled up. */
static bool holds_scaled(const char *channel)
{
    return strcmp(channel, "error") != 0;
}

static void show_first_picture(void *user, const struct first_pictures *first)
{
    const struct render_job *job = user;
    struct image image;
    struct error error;
    ps_result result = PS_OK;
    if (job->callbacks->show) {
        result = first_pictures_enlarge(first, holds_scaled, &image, &error);
        if (result == PS_OK)
            job->callbacks->show(job->callbacks->user, &image, 0);
        else
            image_release(&image);
    }
    if (result == PS_OK && isfinite(job->passes.schedule.write_every)) {
        result = first_pictures_enlarge(first, is_looked_at, &image, &error);
        if (result == PS_OK)
            result = output_list_write(&job->options->output, &image, job->settings->workers, NULL,
                                       NULL, &error);
        image_release(&image);
    }
    if (result != PS_OK)
        job->callbacks->log(job->callbacks->user, PS_LOG_WARNING, error.text);
}

static bool wants_first_pictures(const struct render_job *job)
{
    const struct schedule *schedule = &job->passes.schedule;
    return (isfinite(schedule->write_every) || job->callbacks->show) && !job->processes &&
           job->passes.film.passes.count == 0;
}

/* A film holds passes as they were asked for, and who asks for a quality, or a number of passes,
 * gets that. */
static bool chooses_quality(const struct render_job *job)
{
    const struct render_options *options = job->options;
    return isfinite(options->job.seconds) && !options->passes.is_given && !options->quality &&
           !render_options_keep_film(options);
}

static bool turn_to(struct render_job *job, const struct scene *scene, enum quality quality)
{
    struct render_settings other;
    if (!make_settings(job, scene, quality, &other))
        return false;
    other.trace = job->settings->trace;
    other.first_pass = job->settings->first_pass;
    other.passes = job->settings->passes;
    settings_release(job->settings);
    *job->settings = other;
    return true;
}

/* The last of them as the result, with its number of pixels, warned of. */
static ps_result take_as_picture(struct render_job *job, const struct first_pictures *first,
                                 struct image *image, struct error *error)
{
    char pixels[64], text[256];
    snprintf(pixels, sizeof pixels, "%zux%zu", first->image.width, first->image.height);
    snprintf(
        text, sizeof text,
        "--time: a draft pass would take about %.2g s; the picture is one of %s pixels, scaled up",
        first_pictures_draft_seconds(first), pixels);
    job->callbacks->log(job->callbacks->user, PS_LOG_WARNING, text);
    ps_result result = first_pictures_enlarge(first, holds_scaled, image, error);
    if (result == PS_OK)
        result = image_set_attribute(image, "psplat.scaled_from", pixels, error);
    bool cancelled = first->callbacks->cancelled(first->callbacks->user);
    return result == PS_OK && cancelled ? PS_CANCELLED : result;
}

/* So that what was asked for is done in time: by the settings, or by the picture, where that is no
 * pass. */
static ps_result keep_to_time(struct render_job *job, struct first_pictures *first,
                              struct image *image, struct error *error)
{
    struct schedule *schedule = &job->passes.schedule;
    double writing = output_list_guess_seconds(&job->options->output, &first->image,
                                               first_pictures_pixels(first),
                                               workers_count(job->settings->workers));
    schedule->picture_seconds = first_pictures_resolve_seconds(first) + writing;
    first->end = schedule->start + schedule->seconds - writing;
    enum quality quality;
    bool passes = first_pictures_choose(first, &quality);
    if ((quality != first->quality && !turn_to(job, first->scene, quality)) || passes)
        return PS_OK;
    return take_as_picture(job, first, image, error);
}

/* Where there is no time for a pass, `image` is the picture; else it stays empty. */
static ps_result make_first_pictures(struct render_job *job, const struct scene *scene,
                                     const struct render_callbacks *callbacks, struct image *image,
                                     struct error *error)
{
    const struct schedule *schedule = &job->passes.schedule;
    struct first_pictures first = {
        .scene = scene,
        .settings = job->settings,
        .callbacks = callbacks,
        .are_wanted = wants_first_pictures(job),
        .quality = (enum quality)job->description->render.quality,
        .end = schedule->start + schedule->seconds,
        .make_settings = make_settings,
        .show = show_first_picture,
        .user = job,
    };
    ps_result result = PS_OK;
    first_pictures_make(&first);
    if (first.step > 0.0 && chooses_quality(job) && !callbacks->cancelled(callbacks->user))
        result = keep_to_time(job, &first, image, error);
    image_release(&first.image);
    return result;
}

ps_result render_job_progressively(struct render_job *job, const struct render_callbacks *callbacks,
                                   struct image *image, struct error *error)
{
    const struct scene *scene = job->scene;
    struct film_sum *film = render_options_keep_film(job->options) ? &job->passes.film : NULL;
    *image = (struct image){0};
    if (chooses_quality(job) || wants_first_pictures(job)) {
        double start = clock_seconds();
        ps_result result = make_first_pictures(job, scene, callbacks, image, error);
        statistics_add_seconds(job->statistics, "first pictures", clock_seconds() - start);
        if (result != PS_OK || image->width > 0)
            return result;
    }
    return render_run(scene, job->settings, callbacks, job->statistics, film, image, error);
}
