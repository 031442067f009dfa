/* render_job.c: renders, tells how far it is, and writes what there is, also where a signal ends it. */
#include "cli/render_job.h"

#include "base/clock.h"
#include "base/path.h"
#include "session/layers.h"
#include "session/remark.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

/* A signal handler can reach nothing else: the only variables of the program that are not constant. The first is the
 * number of the signal. */
static volatile sig_atomic_t interrupted, write_now;

static void handle_signals(void (*handler)(int signal_number))
{
    struct sigaction action = {.sa_handler = handler};
    sigemptyset(&action.sa_mask);
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* The next signal, whichever of the two it is, ends the process. Only what is safe in a handler: write() is,
 * and there is nobody to tell if it fails. */
static void interrupt(int signal_number)
{
    static const char message[] = "\npsplat: interrupted: finishing this batch, then writing the "
                                  "picture without what is left; a second signal ends at once\n";
    handle_signals(SIG_DFL);
    interrupted = signal_number;
    ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
    (void)written;
}

static void ask_for_picture(int signal_number)
{
    (void)signal_number;
    write_now = 1;
}

static bool was_interrupted(void *user)
{
    const struct render_job *job = user;
    return (interrupted != 0 && !job->has_stopped) || long_job_was_stopped(&job->passes);
}

/* What is made for others to see: layers of EXR files, what PNG files show, and the error for whoever asks. */
void render_job_set_wishes(const struct render_job *job, struct render_settings *settings)
{
    bool error = job->passes.schedule.error > 0.0;
    bool shows_all = job->display && layers_are_some(output_options_layers(&job->outputs.options));
    settings->picture_alone = !output_list_wants_layers(&job->outputs) && !error && !shows_all;
    settings->no_error_layer = !output_list_wants_error(&job->outputs) && !error;
    settings->display = output_list_wants_display(&job->outputs);
    settings->exposure = job->description->image.exposure;
}

static void tell_of_dark_pixels(const struct render_job *job, const struct statistics *statistics)
{
    char remark[REMARK_TEXT];
    if (remark_dark_pixels(statistics, remark) && !job->taken.quiet)
        fprintf(stderr, "psplat: %s\n", remark);
}

/* Writes all files that can be written. */
static ps_result write_picture(struct render_job *job, struct image *image, uint32_t passes,
                               bool quiet, struct error *error)
{
    const struct scene_description *description = job->description;
    const struct render_settings *settings = job->settings;
    /* What was interrupted in its first pass, or has gaps, no command repeats. */
    bool is_run = passes > 0 && long_job_has_run(&job->passes, settings->first_pass, passes);
    ps_result result = output_describe(image, description->path, &job->taken.options.scene,
                                       settings, passes, is_run, error);
    return result == PS_OK
               ? output_list_write(&job->outputs, image, settings->workers, quiet, error)
               : result;
}

static ps_result write_picture_on_the_way(void *user, struct image *image, uint32_t passes,
                                          struct error *error)
{
    return write_picture(user, image, passes, true, error);
}

void render_job_show(const struct render_job *job, const struct image *image, bool is_last)
{
    viewer_show(job->viewer, image, output_options_layers(&job->outputs.options), is_last);
}

static void show_picture_on_the_way(void *user, const struct image *image)
{
    render_job_show(user, image, false);
}

static void show_progress(void *user, const char *stage, double fraction)
{
    struct render_job *job = user;
    job->progress.passes = long_job_passes_done(&job->passes);
    if (job->passes.team)
        fraction = (double)job->progress.passes / settings_pass_count(job->settings);
    if (long_job_has_budget(&job->passes))
        fraction = fmax(fraction, schedule_fraction(&job->passes.schedule, clock_seconds()));
    progress_update(&job->progress, stage, fraction);
}

static void show_message(void *user, ps_log_level level, const char *message)
{
    const struct render_job *job = user;
    progress_message(&job->progress, level, message);
}

static bool next_pass(void *user, struct render *render, uint32_t *number)
{
    struct render_job *job = user;
    bool another = long_job_next_pass(&job->passes, render, number);
    job->progress.error = job->passes.schedule.estimate;
    return another;
}

static ps_result end_passes(void *user, ps_result result, struct error *error)
{
    struct render_job *job = user;
    job->has_stopped = interrupted != 0;
    return long_job_end_passes(&job->passes, result, error);
}

static ps_result write_statistics(const struct render_job *job, struct statistics *statistics,
                                  struct error *error)
{
    statistics_add_seconds(statistics, "total", clock_seconds() - job->progress.start);
    return job->stats_path ? statistics_write(statistics, job->stats_path, error) : PS_OK;
}

/* What can be written is; the error is the first one's. */
static ps_result write_files(struct render_job *job, struct image *image,
                             struct statistics *statistics, struct error *error)
{
    struct error reason;
    double start = clock_seconds();
    ps_result first = PS_OK;
    if (image->width > 0)
        first = write_picture(job, image, (uint32_t)statistics_counter(statistics, "passes"),
                              job->taken.quiet, error);
    ps_result kept = long_job_write_film(&job->passes, &reason);
    if (kept != PS_OK && first == PS_OK) {
        first = kept;
        *error = reason;
    }
    if (first != PS_OK)
        return first;
    statistics_add_seconds(statistics, "write", clock_seconds() - start);
    return write_statistics(job, statistics, error);
}

static ps_result render_tiles(struct render_job *job, const struct scene *scene,
                              const struct render_callbacks *callbacks,
                              struct statistics *statistics, struct error *error)
{
    struct error reason;
    handle_signals(interrupt);
    ps_result result = render_job_tiled(job, scene, callbacks, statistics, error);
    progress_clear(&job->progress);
    if (result != PS_OK && result != PS_CANCELLED)
        return result;
    tell_of_dark_pixels(job, statistics);
    if (result == PS_CANCELLED)
        error_set(error, PS_CANCELLED, "interrupted: the picture holds the tiles done by then");
    else
        output_list_tell(&job->outputs, job->taken.quiet);
    ps_result written = write_statistics(job, statistics, &reason);
    if (result == PS_OK && written != PS_OK)
        *error = reason;
    return result == PS_OK ? written : result;
}

static ps_result render_and_write(struct render_job *job, const struct scene *scene,
                                  struct statistics *statistics, struct error *error)
{
    const struct render_callbacks callbacks = {
        .user = job,
        .progress = show_progress,
        .log = show_message,
        .cancelled = was_interrupted,
        .next_pass = job->settings->tile > 0 ? NULL : next_pass,
        .end_passes = end_passes,
    };
    if (job->settings->tile > 0)
        return render_tiles(job, scene, &callbacks, statistics, error);
    struct image image;
    handle_signals(interrupt);
    signal(SIGUSR1, ask_for_picture);
    ps_result result = render_job_progressively(job, scene, &callbacks, statistics, &image, error);
    job->progress.passes = (uint32_t)statistics_counter(statistics, "passes");
    progress_clear(&job->progress);
    if (image.width == 0 && job->passes.film.passes.count == 0)
        return result;
    tell_of_dark_pixels(job, statistics);
    struct error reason;
    ps_result written = write_files(job, &image, statistics, &reason);
    if (job->viewer && image.width > 0)
        render_job_show(job, &image, true);
    image_release(&image);
    if (result == PS_CANCELLED)
        error_set(error, PS_CANCELLED, "interrupted: the picture holds what was done by then");
    if (written == PS_OK)
        return result;
    if (result != PS_OK && result != PS_CANCELLED)
        print_error(error->text);
    *error = reason;
    return written;
}

/* With the viewer beside it. */
static ps_result render_and_show(struct render_job *job, const struct scene *scene,
                                 struct statistics *statistics, struct error *error)
{
    if (!job->display)
        return render_and_write(job, scene, statistics, error);
    job->viewer = viewer_create(&job->display_address, path_name(job->taken.scene_path));
    if (!job->viewer)
        return PS_ERROR_MEMORY;
    ps_result result = render_and_write(job, scene, statistics, error);
    viewer_destroy(job->viewer);
    job->viewer = NULL;
    return result;
}

int render_job_run(struct render_job *job, struct scene_input *input)
{
    struct long_job *passes = &job->passes;
    passes->workers = job->settings->workers;
    passes->write_now = &write_now;
    passes->write_picture = write_picture_on_the_way;
    passes->show_picture = show_picture_on_the_way;
    passes->user = job;
    struct scene scene;
    struct statistics statistics;
    struct error error = {.text = ""};
    statistics_init(&statistics);
    double start = clock_seconds();
    statistics_add_seconds(&statistics, "load", start - job->progress.start);
    ps_result result = render_options_check_size(&input->description.image, job->settings,
                                                 long_job_keeps_film(passes), &error);
    if (result == PS_OK)
        result = scene_input_build(input, &scene);
    print_problems(input);
    statistics_add_seconds(&statistics, "scene", clock_seconds() - start);
    if (result == PS_OK) {
        render_options_suit_scene(&job->taken.options, &scene, job->settings);
        result = long_job_begin(&job->passes, &input->description, &scene, job->settings, &error);
        if (result == PS_OK)
            result = render_and_show(job, &scene, &statistics, &error);
        scene_release(&scene);
    }
    statistics_destroy(&statistics);
    if (result != PS_OK && error.text[0])
        print_error(error.text);
    progress_end(&job->progress);
    if (result == PS_CANCELLED && !long_job_is_first(&job->passes))
        return STATUS_OK; /* the first process tells what became of the job */
    return result == PS_CANCELLED && interrupted ? STATUS_SIGNAL + interrupted : status_of(result);
}
