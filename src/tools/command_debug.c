/* command_debug.c: psplat debug: pictures of what goes on inside of a render. */
#include "cli/command.h"
#include "cli/default_path.h"
#include "debug/debug.h"
#include "tools/option_parse.h"
#include "tools/progress_callbacks.h"
#include "tools/render_arguments.h"

#include "base/text.h"
#include "job/facts.h"
#include "session/output.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct option options[] = {
    {'o', "output", "FILE.png", "default: the scene's name, the view's, and .png"},
    {0, "count", "N", "photons: dots at most (20000); maps: splats (12); pixel: photons (200)"},
    {0, "pixel", "X,Y", "pixel: its column and row, from 0; default: the middle"},
    {0, "resolution", "N", "voxels: cells across the scene, not the stratification's own"},
    {0, "top", "NUMBER",
     "photons, overlap, pixel: the scale's upper end; default: by what there is"},
    {0, "color", "power|bounce", "photons: what the dots' colours tell; default: power"},
    RENDER_OPTIONS,
};

struct job {
    struct render_arguments taken;
    struct debug_request request;
    const char *view;
    const char *output;
    char *default_output; /* owned */
    struct progress progress;
};

static bool take_output(struct job *job, const char *path)
{
    size_t length = strlen(path);
    job->output = path;
    if (length > 4 && strcmp(path + length - 4, ".png") == 0)
        return true;
    fprintf(stderr, "psplat: error: --output: '%s' does not end in .png\n", path);
    return false;
}

static bool parse_top(const char *text, double *top)
{
    if (text_to_number(text, top) && *top > 0.0)
        return true;
    fprintf(stderr, "psplat: error: --top: expected a number above 0, got '%s'\n", text);
    return false;
}

static bool parse_color(const char *text, bool *by_bounce)
{
    *by_bounce = strcmp(text, "bounce") == 0;
    if (*by_bounce || strcmp(text, "power") == 0)
        return true;
    fprintf(stderr, "psplat: error: --color: expected power or bounce, got '%s'\n", text);
    return false;
}

static bool parse_pixel(const char *text, struct debug_options *chosen)
{
    const char *comma = strchr(text, ',');
    double column, row;
    chosen->has_pixel = comma && text_part_to_number(text, (size_t)(comma - text), &column) &&
                        text_to_number(comma + 1, &row) && column >= 0 && row >= 0 &&
                        column < 1e6 && row < 1e6 && floor(column) == column && floor(row) == row;
    if (chosen->has_pixel) {
        chosen->pixel[0] = (uint32_t)column;
        chosen->pixel[1] = (uint32_t)row;
        return true;
    }
    fprintf(stderr, "psplat: error: --pixel: expected a column and a row, as 120,80, got '%s'\n",
            text);
    return false;
}

static bool parse_count(const struct argument *argument, double most, uint32_t *count)
{
    double number;
    if (!parse_whole_number(argument->option->name, argument->value, 1, most, &number))
        return false;
    *count = (uint32_t)number;
    return true;
}

static bool take_option(struct job *job, const struct argument *argument)
{
    const char *name = argument->option->name, *value = argument->value;
    struct debug_options *chosen = &job->request.options;
    if (strcmp(name, "output") == 0)
        return take_output(job, value);
    if (strcmp(name, "count") == 0)
        return parse_count(argument, 1e7, &chosen->count);
    else if (strcmp(name, "resolution") == 0)
        return parse_count(argument, 1e5, &chosen->resolution);
    else if (strcmp(name, "top") == 0)
        return parse_top(value, &chosen->top);
    else if (strcmp(name, "color") == 0)
        return parse_color(value, &chosen->by_bounce);
    else if (strcmp(name, "pixel") == 0)
        return parse_pixel(value, chosen);
    return true;
}

static bool take_arguments(struct job *job, const struct argument *arguments, size_t count)
{
    size_t operands = 0;
    for (size_t i = 0; i < count; i++) {
        if (arguments[i].option) {
            if (!take_option(job, &arguments[i]))
                return false;
        } else if (operands++ == 0) {
            job->view = arguments[i].value;
        } else {
            job->taken.scene_path = arguments[i].value;
        }
    }
    if (operands != 2)
        print_error("debug: expected a view and a scene. Try 'psplat debug --help'.");
    return operands == 2;
}

static bool find_view(struct job *job)
{
    struct error error;
    if (debug_find(job->view, &job->request, &error) == PS_OK)
        return true;
    print_error(error.text);
    return false;
}

/* Without --output: cornell-gbuffer-normal.png for gbuffer:normal of cornell.psd. */
static bool choose_output(struct job *job)
{
    char suffix[128];
    struct error error;
    if (!job->output) {
        int length = snprintf(suffix, sizeof suffix, "-%s.png", job->view);
        for (int i = 0; i < length && i < (int)sizeof suffix; i++)
            if (suffix[i] == ':')
                suffix[i] = '-';
        job->default_output = default_path(job->taken.scene_path, suffix);
        job->output = job->default_output;
    }
    if (!job->output)
        return false;
    if (output_check(job->output, &error))
        return true;
    print_error(error.text);
    return false;
}

/* The picture says what it shows and with which settings. */
static ps_result write_canvas(const struct job *job, const struct canvas *canvas,
                              const struct render_settings *settings, struct error *error)
{
    struct image facts = {0};
    ps_result result = facts_of_settings(&facts, job->taken.scene_path, settings, error);
    if (result == PS_OK)
        result = image_set_attribute(&facts, "psplat.debug", job->view, error);
    if (result == PS_OK)
        result = image_write_png(job->output, canvas->width, canvas->height, canvas->rgb,
                                 facts.attributes, facts.attribute_count, error);
    image_release(&facts);
    if (result == PS_OK && !job->taken.quiet)
        fprintf(stderr, "psplat: wrote %s\n", job->output);
    return result;
}

static ps_result draw_and_write(struct job *job, const struct scene *scene,
                                struct render_settings *settings, struct error *error)
{
    struct render_callbacks callbacks = progress_callbacks(&job->progress);
    struct statistics statistics;
    struct canvas canvas;
    statistics_init(&statistics);
    ps_result result =
        debug_draw(&job->request, scene, settings, &callbacks, &statistics, &canvas, error);
    progress_clear(&job->progress);
    if (result == PS_OK) {
        result = write_canvas(job, &canvas, settings, error);
        canvas_release(&canvas);
    }
    statistics_destroy(&statistics);
    return result;
}

static int draw_job(struct job *job, struct scene_input *input, struct render_settings *settings)
{
    struct scene scene;
    struct error error = {.text = ""};
    job->request.options.exposure = input->description.image.exposure;
    const struct image_description *image = &input->description.image;
    ps_result result =
        render_check_memory(settings, (size_t)image->width, (size_t)image->height, false, &error);
    if (result == PS_OK)
        result = scene_input_build(input, &scene);
    print_problems(input);
    if (result == PS_OK) {
        result = draw_and_write(job, &scene, settings, &error);
        scene_release(&scene);
    }
    if (result == PS_OK)
        return STATUS_OK;
    if (error.text[0])
        print_error(error.text);
    return result == PS_ERROR_INVALID ? STATUS_USAGE : STATUS_FAILED;
}

static int load_and_draw(struct job *job)
{
    struct scene_input input;
    struct render_settings settings;
    struct error error;
    int status = STATUS_USAGE;
    if (render_arguments_load(&job->taken, &input, &settings)) {
        if (output_check_not_input(job->output, "--output", &input.description, &error))
            status = draw_job(job, &input, &settings);
        else
            print_error(error.text);
        settings_release(&settings);
    }
    scene_input_release(&input);
    return status;
}

static int run(const struct argument *arguments, size_t count)
{
    struct job job = {.view = NULL};
    int status = STATUS_USAGE;
    if (render_arguments_take(&job.taken, arguments, count) &&
        take_arguments(&job, arguments, count) && find_view(&job)) {
        status = STATUS_FAILED;
        progress_start(&job.progress, PROGRESS_AUTO, job.taken.quiet);
        if (choose_output(&job))
            status = load_and_draw(&job);
    }
    render_arguments_release(&job.taken);
    free(job.default_output);
    return status;
}

const struct command command_debug = {
    .name = "debug",
    .operands = "photons|voxels|gbuffer[:LAYER]|maps|overlap|pixel SCENE.psd|MODEL",
    .summary = "draws what goes on inside of a render",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
