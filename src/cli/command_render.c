/* command_render.c: psplat render: a scene becomes a picture. */
#include "base/clock.h"
#include "base/path.h"
#include "cli/command.h"
#include "cli/long_job.h"
#include "cli/output_list.h"
#include "cli/progress.h"
#include "cli/render_arguments.h"
#include "cli/viewer.h"
#include "session/layers.h"
#include "session/option_value.h"
#include "session/output.h"
#include "session/remark.h"
#include "session/tiled_render.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct option options[] = {
    OUTPUT_OPTIONS,
    RENDER_OPTIONS,
    {0, "crop", "X,Y,W,H", "render this part of the picture alone, in pixels"},
    {0, "tile", "SIDE", "render tiles of so many pixels a side, one by one, in little memory"},
    {0, "preview", NULL, "a quick look: small, few light paths, coarse shadows"},
    LONG_JOB_OPTIONS,
    PROGRESS_OPTION,
    VIEWER_OPTION,
    {0, "memory-limit", "SIZE", "refuse what takes more, as 500M or 8G; default: the machine's"},
    {0, "stats", "FILE.json", "write what each stage took in time and memory"},
};

struct job {
    struct render_arguments taken;
    struct output_list outputs;
    struct long_job passes;
    const char *stats_path;
    double tile;         /* --tile; 0: none */
    const char *display; /* NULL: no viewer */
    struct tev_address display_address;
    struct viewer *viewer; /* while it renders */
    enum progress_mode progress_mode;
    struct progress progress;
    bool has_stopped; /* passes ended by a signal; their picture is made all the same */
    const struct scene_description *description; /* while it renders */
    struct render_settings *settings;
};

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
    const struct job *job = user;
    return (interrupted != 0 && !job->has_stopped) || long_job_was_stopped(&job->passes);
}

static bool take_tile(struct job *job, const char *value)
{
    struct error error;
    ps_result result = option_whole_number("tile", value, TILE_STEP, 65536, &job->tile, &error);
    if (result == PS_OK && fmod(job->tile, TILE_STEP) != 0)
        result = error_set(&error, PS_ERROR_INVALID, "--tile: %s is no multiple of %d", value,
                           TILE_STEP);
    if (result != PS_OK)
        print_error(error.text);
    return result == PS_OK;
}

static bool take_option(struct job *job, const struct argument *argument)
{
    if (argument_is(argument, "tile"))
        return take_tile(job, argument->value);
    if (argument_is(argument, "stats"))
        job->stats_path = argument->value;
    else if (argument_is(argument, "display"))
        return viewer_parse(job->display = argument->value, &job->display_address);
    else if (argument_is(argument, "progress"))
        return progress_parse_mode(argument->value, &job->progress_mode);
    return true; /* another's */
}

static bool take_arguments(struct job *job, const struct argument *arguments, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option) {
            if (!take_option(job, &arguments[i]))
                return false;
        } else if (job->taken.scene_path) {
            fprintf(stderr, "psplat: error: one scene at a time: '%s' after '%s'\n",
                    arguments[i].value, job->taken.scene_path);
            return false;
        } else {
            job->taken.scene_path = arguments[i].value;
        }
    }
    if (!job->taken.scene_path)
        print_error("which scene? Try 'psplat --help'.");
    return job->taken.scene_path != NULL;
}

/* Tiles are done one after the other, so there is no picture, and no film, before the last. */
static bool suits_tiles(const struct job *job)
{
    const struct long_job *passes = &job->passes;
    const char *other = job->taken.options.crop.width > 0        ? "--crop"
                        : passes->checkpoint                     ? "--checkpoint"
                        : passes->wants_mpi                      ? "--mpi"
                        : long_job_has_budget(passes)            ? "--time and --error"
                        : isfinite(passes->schedule.write_every) ? "--write-every"
                        : job->display                           ? "--display"
                                                                 : NULL;
    if (job->tile > 0 && other)
        fprintf(stderr, "psplat: error: --tile does not go with %s\n", other);
    return job->tile == 0 || !other;
}

/* Part of the passes makes no picture that anybody waits for, unless it is named. */
static bool choose_outputs(struct job *job)
{
    if (job->outputs.count > 0)
        return true;
    if (!job->passes.range.is_shard)
        return output_list_add_defaults(&job->outputs, job->taken.scene_path);
    if (!job->passes.checkpoint)
        print_error("--passes A:B: where to? Name the film with --checkpoint, or a picture with "
                    "--output.");
    return job->passes.checkpoint != NULL;
}

/* Finds out before the render what can be told by then. */
static bool check_outputs(const struct job *job)
{
    struct error error;
    bool good = output_list_check(&job->outputs);
    if (!good)
        return false;
    if (job->stats_path)
        good = output_check(job->stats_path, &error);
    if (good && job->passes.checkpoint && long_job_is_first(&job->passes))
        good = output_check(job->passes.checkpoint, &error);
    if (!good)
        print_error(error.text);
    return good;
}

static void tell_of_dark_pixels(const struct job *job, const struct statistics *statistics)
{
    char remark[REMARK_TEXT];
    if (remark_dark_pixels(statistics, remark) && !job->taken.quiet)
        fprintf(stderr, "psplat: %s\n", remark);
}

/* Writes all files that can be written. */
static ps_result write_picture(struct job *job, struct image *image, uint32_t passes, bool quiet,
                               struct error *error)
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

static void show_picture(void *user, const struct image *image)
{
    const struct job *job = user;
    viewer_show(job->viewer, image, output_options_layers(&job->outputs.options), false);
}

static void show_progress(void *user, const char *stage, double fraction)
{
    struct job *job = user;
    job->progress.passes = long_job_passes_done(&job->passes);
    if (job->passes.team)
        fraction = (double)job->progress.passes / settings_pass_count(job->settings);
    if (long_job_has_budget(&job->passes))
        fraction = fmax(fraction, schedule_fraction(&job->passes.schedule, clock_seconds()));
    progress_update(&job->progress, stage, fraction);
}

static void show_message(void *user, ps_log_level level, const char *message)
{
    const struct job *job = user;
    progress_message(&job->progress, level, message);
}

static bool next_pass(void *user, struct render *render, uint32_t *number)
{
    struct job *job = user;
    bool another = long_job_next_pass(&job->passes, render, number);
    job->progress.error = job->passes.schedule.estimate;
    return another;
}

static ps_result end_passes(void *user, ps_result result, struct error *error)
{
    struct job *job = user;
    job->has_stopped = interrupted != 0;
    return long_job_end_passes(&job->passes, result, error);
}

static ps_result write_statistics(const struct job *job, struct statistics *statistics,
                                  struct error *error)
{
    statistics_add_seconds(statistics, "total", clock_seconds() - job->progress.start);
    return job->stats_path ? statistics_write(statistics, job->stats_path, error) : PS_OK;
}

/* What can be written is; the error is the first one's. */
static ps_result write_files(struct job *job, struct image *image, struct statistics *statistics,
                             struct error *error)
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

static ps_result render_tiles(struct job *job, const struct scene *scene,
                              const struct render_callbacks *callbacks,
                              struct statistics *statistics, struct error *error)
{
    const struct tiled_render tiled = {
        .scene = scene,
        .scene_path = job->description->path,
        .scene_options = &job->taken.options.scene,
        .settings = job->settings,
        .callbacks = callbacks,
        .statistics = statistics,
        .paths = job->outputs.paths,
        .path_count = job->outputs.count,
        .output = &job->outputs.options,
    };
    struct error reason;
    handle_signals(interrupt);
    ps_result result = tiled_render_run(&tiled, error);
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

static ps_result render_and_write(struct job *job, const struct scene *scene,
                                  struct statistics *statistics, struct error *error)
{
    const struct render_callbacks callbacks = {
        .user = job,
        .progress = show_progress,
        .log = show_message,
        .cancelled = was_interrupted,
        .next_pass = job->tile > 0 ? NULL : next_pass,
        .end_passes = end_passes,
    };
    if (job->tile > 0)
        return render_tiles(job, scene, &callbacks, statistics, error);
    struct image image = {0};
    struct film_sum *film = long_job_keeps_film(&job->passes) ? &job->passes.film : NULL;
    handle_signals(interrupt);
    signal(SIGUSR1, ask_for_picture);
    ps_result result =
        render_run(scene, job->settings, &callbacks, statistics, film, &image, error);
    job->progress.passes = (uint32_t)statistics_counter(statistics, "passes");
    progress_clear(&job->progress);
    if (image.width == 0 && job->passes.film.passes.count == 0)
        return result;
    tell_of_dark_pixels(job, statistics);
    struct error reason;
    ps_result written = write_files(job, &image, statistics, &reason);
    if (job->viewer && image.width > 0)
        viewer_show(job->viewer, &image, output_options_layers(&job->outputs.options), true);
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
static ps_result render_and_show(struct job *job, const struct scene *scene,
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

static ps_result check_size(const struct job *job, const struct scene_input *input,
                            struct error *error)
{
    const struct image_description *image = &input->description.image;
    ps_result result = job->tile > 0 ? tiled_render_prepare(job->settings, (size_t)image->width,
                                                            (size_t)image->height, error)
                                     : PS_OK;
    if (result != PS_OK)
        return result;
    return render_options_check_size(image, job->settings, long_job_keeps_film(&job->passes),
                                     error);
}

static int render_job(struct job *job, struct scene_input *input)
{
    struct scene scene;
    struct statistics statistics;
    struct error error = {.text = ""};
    statistics_init(&statistics);
    double start = clock_seconds();
    statistics_add_seconds(&statistics, "load", start - job->progress.start);
    ps_result result = check_size(job, input, &error);
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

/* What is made for others to see: layers of EXR files, what PNG files show, and the error for whoever asks. */
static void set_wishes(const struct job *job, struct render_settings *settings)
{
    bool error = job->passes.schedule.error > 0.0;
    bool shows_all = job->display && layers_are_some(output_options_layers(&job->outputs.options));
    settings->picture_alone = !output_list_wants_layers(&job->outputs) && !error && !shows_all;
    settings->no_error_layer = !output_list_wants_error(&job->outputs) && !error;
    settings->display = output_list_wants_display(&job->outputs);
    settings->exposure = job->description->image.exposure;
    settings->tile = (uint32_t)job->tile;
}

/* A checkpoint that is there already is not replaced, or is a film. */
static bool spares_scene(const struct job *job)
{
    struct error error;
    if (!output_list_spares(&job->outputs, job->description))
        return false;
    if (!job->stats_path || output_spares(job->stats_path, "--stats", job->description, &error))
        return true;
    print_error(error.text);
    return false;
}

static int load_and_render(struct job *job)
{
    struct scene_input input;
    struct render_settings settings;
    /* Where it has no scene, or fails to load what that names, the first process tells. */
    int status = long_job_is_first(&job->passes) ? STATUS_USAGE : STATUS_OK;
    if (render_arguments_load(&job->taken, &input, &settings)) {
        job->settings = &settings;
        job->description = &input.description;
        job->passes.workers = settings.workers;
        set_wishes(job, &settings);
        if (spares_scene(job) && output_list_suits(&job->outputs, &settings) &&
            long_job_set_passes(&job->passes, &settings))
            status = render_job(job, &input);
        else
            print_problems(&input); /* warnings of what was loaded */
        job->settings = NULL;
        settings_release(&settings);
    }
    job->description = NULL;
    scene_input_release(&input);
    return status;
}

/* Processes beside the first only render. */
static void write_nothing(struct job *job)
{
    job->outputs.count = 0;
    job->stats_path = job->display = NULL;
    job->taken.quiet = true;
    job->progress_mode = PROGRESS_NONE;
}

static int run_job(struct job *job)
{
    if (!long_job_is_first(&job->passes))
        write_nothing(job);
    progress_start(&job->progress, job->progress_mode, job->taken.quiet);
    job->passes.schedule.start = job->progress.start;
    job->passes.compression = job->outputs.options.compression;
    job->passes.quiet = job->taken.quiet;
    job->passes.write_now = &write_now;
    job->passes.write_picture = write_picture_on_the_way;
    job->passes.show_picture = show_picture;
    job->passes.schedule.shows = job->display != NULL;
    job->passes.user = job;
    if (job->passes.transport.size > 1)
        job->taken.transport = &job->passes.transport;
    if (check_outputs(job))
        return load_and_render(job);
    if (job->taken.transport)
        scene_input_share_none(job->taken.transport);
    return STATUS_FAILED;
}

static int run(const struct argument *arguments, size_t count)
{
    struct job job = {.stats_path = NULL};
    int status = STATUS_USAGE;
    if (render_arguments_take(&job.taken, arguments, count) &&
        output_list_take(&job.outputs, arguments, count) &&
        long_job_take(&job.passes, arguments, count, &job.taken.options.passes) &&
        take_arguments(&job, arguments, count) && suits_tiles(&job) && choose_outputs(&job)) {
        status = STATUS_FAILED;
        if (long_job_join(&job.passes))
            status = run_job(&job);
        long_job_leave(&job.passes);
    }
    long_job_release(&job.passes);
    output_list_release(&job.outputs);
    render_arguments_release(&job.taken);
    return status;
}

const struct command command_render = {
    .name = "render",
    .operands = "SCENE.psd|MODEL",
    .summary = "renders a scene, or a lone model; the command when none is named",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
