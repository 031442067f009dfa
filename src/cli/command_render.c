/* command_render.c: psplat render: a scene becomes a picture. */
#include "base/clock.h"
#include "cli/command.h"
#include "cli/layers.h"
#include "cli/output.h"
#include "cli/preview.h"
#include "cli/progress.h"
#include "cli/render_options.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MOST_OUTPUTS 16

static const struct option options[] = {
    {'o', "output", "FILE", "write FILE (.exr or .png); may be given several times"},
    {0, "layers", "NAME,...", "layers of EXR files beside the picture; or all (default), none"},
    {0, "compression", "NAME",
     "compression of EXR files, all lossless: " IMAGE_COMPRESSIONS "; default: zip"},
    RENDER_OPTIONS,
    {0, "preview", NULL, "a quick look: small, few light paths, coarse shadows"},
    {0, "passes", "N", "number of passes; more smooth edges and lessen noise"},
    {0, "stats", "FILE.json", "write what each stage took in time and memory"},
};

struct job {
    struct render_options options;
    const char *outputs[MOST_OUTPUTS];
    size_t output_count;
    char *default_outputs[2];    /* owned */
    const char *layers;          /* a list of layers.h */
    struct output_format format; /* its exposure is the scene's */
    const char *stats_path;
    double passes; /* negative: not given */
    struct progress progress;
};

/* A signal handler can reach nothing else: the one variable of the program that is not constant. */
static volatile sig_atomic_t interrupted;

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
    (void)signal_number;
    handle_signals(SIG_DFL);
    interrupted = 1;
    ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
    (void)written;
}

static bool was_interrupted(void *user)
{
    (void)user;
    return interrupted != 0;
}

static bool take_output(struct job *job, const char *path)
{
    if (!output_is_writable_format(path)) {
        fprintf(stderr, "psplat: error: --output: '%s' ends neither in .exr nor in .png\n", path);
        return false;
    }
    if (job->output_count == MOST_OUTPUTS) {
        print_error("--output: too many files");
        return false;
    }
    job->outputs[job->output_count++] = path;
    return true;
}

static bool take_compression(struct job *job, const char *name)
{
    if (image_compression_named(name, &job->format.compression))
        return true;
    fprintf(stderr,
            "psplat: error: --compression: expected one of " IMAGE_COMPRESSIONS ", got '%s'\n",
            name);
    return false;
}

static bool take_option(struct job *job, const struct argument *argument)
{
    const char *name = argument->option->name, *value = argument->value;
    if (strcmp(name, "output") == 0)
        return take_output(job, value);
    if (strcmp(name, "layers") == 0) {
        job->layers = value;
        return layers_check(value);
    }
    if (strcmp(name, "compression") == 0)
        return take_compression(job, value);
    if (strcmp(name, "stats") == 0)
        job->stats_path = value;
    else if (strcmp(name, "passes") == 0)
        return parse_whole_number(name, value, 1, 1e6, &job->passes);
    return true;
}

static bool take_arguments(struct job *job, const struct argument *arguments, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option) {
            if (!take_option(job, &arguments[i]))
                return false;
        } else if (job->options.scene_path) {
            fprintf(stderr, "psplat: error: one scene at a time: '%s' after '%s'\n",
                    arguments[i].value, job->options.scene_path);
            return false;
        } else {
            job->options.scene_path = arguments[i].value;
        }
    }
    if (!job->options.scene_path)
        print_error("which scene? Try 'psplat --help'.");
    return job->options.scene_path != NULL;
}

/* Without --output: the scene's name with both suffixes. */
static bool choose_outputs(struct job *job)
{
    static const char *const suffixes[2] = {".exr", ".png"};
    if (job->output_count > 0)
        return true;
    for (int i = 0; i < 2; i++) {
        job->default_outputs[i] = output_default_path(job->options.scene_path, suffixes[i]);
        if (!job->default_outputs[i]) {
            print_error("out of memory");
            return false;
        }
        job->outputs[job->output_count++] = job->default_outputs[i];
    }
    return true;
}

/* Finds out before the render what can be told by then. */
static bool check_outputs(const struct job *job)
{
    struct error error;
    bool good = true;
    for (size_t i = 0; i < job->output_count && good; i++)
        good = output_check(job->outputs[i], &error);
    if (good && job->stats_path)
        good = output_check(job->stats_path, &error);
    if (!good)
        print_error(error.text);
    return good;
}

/* Pixels that look black, or ambient, for want of splats. */
static void tell_of_dark_pixels(const struct job *job, const struct statistics *statistics)
{
    double dark = statistics_counter(statistics, "pixels without weight");
    if (dark > 0.0 && !job->options.quiet)
        fprintf(stderr, "psplat: no indirect light reached %.0f pixel%s\n", dark,
                dark == 1.0 ? "" : "s");
}

/* Writes all that can be written; the error is the first one's. */
static ps_result write_files(struct job *job, const struct image *image, struct workers *workers,
                             struct statistics *statistics, struct error *error)
{
    double start = clock_seconds();
    ps_result first = PS_OK;
    for (size_t i = 0; i < job->output_count; i++) {
        struct error reason;
        ps_result result = output_write(image, job->outputs[i], &job->format, workers, &reason);
        if (result == PS_OK && !job->options.quiet)
            fprintf(stderr, "psplat: wrote %s\n", job->outputs[i]);
        if (result != PS_OK && first == PS_OK) {
            first = result;
            *error = reason;
        }
    }
    if (first != PS_OK)
        return first;
    statistics_add_seconds(statistics, "write", clock_seconds() - start);
    statistics_add_seconds(statistics, "total", clock_seconds() - job->progress.start);
    return job->stats_path ? statistics_write(statistics, job->stats_path, error) : PS_OK;
}

static ps_result render_and_write(struct job *job, const struct scene_description *description,
                                  const struct scene *scene, struct render_settings *settings,
                                  struct statistics *statistics, struct error *error)
{
    struct render_callbacks callbacks = progress_callbacks(&job->progress);
    callbacks.cancelled = was_interrupted;
    struct image image = {0};
    handle_signals(interrupt);
    ps_result result = render_run(scene, settings, &callbacks, statistics, NULL, &image, error);
    progress_clear(&job->progress);
    if (image.width == 0)
        return result;
    tell_of_dark_pixels(job, statistics);
    /* An interrupted render is repeated by asking for the passes that were done. */
    double passes = statistics_counter(statistics, "passes");
    settings->passes = (uint32_t)passes;
    ps_result written = output_describe(&image, description->path, &job->options.scene, settings,
                                        description->image.exposure, error);
    layers_keep(&image, job->layers);
    job->format.exposure = description->image.exposure;
    if (written == PS_OK)
        written = write_files(job, &image, settings->workers, statistics, error);
    image_release(&image);
    if (written == PS_OK && result == PS_CANCELLED)
        return error_set(error, PS_CANCELLED,
                         "interrupted: the picture holds what was done by then");
    return written == PS_OK ? result : written;
}

static int render_job(struct job *job, struct scene_input *input, struct render_settings *settings)
{
    const struct scene_description *description = &input->description;
    struct scene scene;
    struct statistics statistics;
    struct error error;
    statistics_init(&statistics);
    double start = clock_seconds();
    statistics_add_seconds(&statistics, "load", start - job->progress.start);
    ps_result result = scene_input_build_to_render(input, &scene, &error);
    statistics_add_seconds(&statistics, "scene", clock_seconds() - start);
    if (result == PS_OK) {
        result = render_and_write(job, description, &scene, settings, &statistics, &error);
        scene_release(&scene);
    }
    statistics_destroy(&statistics);
    if (result == PS_OK)
        return STATUS_OK;
    if (error.text[0])
        print_error(error.text);
    return result == PS_ERROR_INVALID ? STATUS_USAGE : STATUS_FAILED;
}

static bool wants_layers(const struct job *job)
{
    bool wanted = false;
    for (size_t i = 0; i < job->output_count; i++)
        wanted |= output_holds_layers(job->outputs[i]);
    return wanted && strcmp(job->layers, "none") != 0;
}

static bool denoiser_makes_layers(const struct job *job, const struct render_settings *settings)
{
    const struct strategy_type *denoiser = settings->strategies[PS_DENOISER].type;
    if (!layers_name(job->layers, "error") || denoiser->table.denoiser.flags & PS_DENOISER_ERROR)
        return true;
    fprintf(stderr,
            "psplat: error: --layers: denoiser '%s' does not estimate its error; "
            "denoiser=regression does\n",
            denoiser->name);
    return false;
}

static int load_and_render(struct job *job)
{
    struct scene_input input;
    struct render_settings settings;
    int status = STATUS_USAGE;
    if (render_options_load(&job->options, &input, &settings)) {
        if (job->passes > 0)
            settings.passes = (uint32_t)job->passes;
        settings.picture_alone = !wants_layers(job);
        settings.no_error_layer =
            strcmp(job->layers, "all") != 0 && !layers_name(job->layers, "error");
        if (denoiser_makes_layers(job, &settings))
            status = render_job(job, &input, &settings);
        settings_release(&settings);
    }
    scene_input_release(&input);
    return status;
}

static int run_arguments(const struct argument *arguments, size_t count)
{
    struct job job = {.layers = "all", .passes = -1};
    int status = STATUS_USAGE;
    if (render_options_take(&job.options, arguments, count) &&
        take_arguments(&job, arguments, count)) {
        status = STATUS_FAILED;
        progress_start(&job.progress, job.options.quiet);
        if (choose_outputs(&job) && check_outputs(&job))
            status = load_and_render(&job);
    }
    render_options_release(&job.options);
    free(job.default_outputs[0]);
    free(job.default_outputs[1]);
    return status;
}

static int run(const struct argument *arguments, size_t count)
{
    size_t expanded_count;
    struct argument *expanded = preview_expand(arguments, count, &expanded_count);
    int status = expanded ? run_arguments(expanded, expanded_count) : STATUS_FAILED;
    free(expanded);
    return status;
}

const struct command command_render = {
    .name = "render",
    .operands = "SCENE.psd",
    .summary = "renders a scene; the command when none is named",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
