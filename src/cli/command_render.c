/* command_render.c: psplat render: a scene becomes a picture. */
#include "cli/render_job.h"
#include "session/output.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

static bool take_option(struct render_job *job, const struct argument *argument)
{
    if (argument_is(argument, "stats"))
        job->stats_path = argument->value;
    else if (argument_is(argument, "display"))
        return viewer_parse(job->display = argument->value, &job->display_address);
    else if (argument_is(argument, "progress"))
        return progress_parse_mode(argument->value, &job->progress_mode);
    return true; /* another's */
}

static bool take_arguments(struct render_job *job, const struct argument *arguments, size_t count)
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
static bool suits_tiles(const struct render_job *job)
{
    const struct long_job *passes = &job->passes;
    const char *other = passes->checkpoint                       ? "--checkpoint"
                        : passes->wants_mpi                      ? "--mpi"
                        : long_job_has_budget(passes)            ? "--time and --error"
                        : isfinite(passes->schedule.write_every) ? "--write-every"
                        : job->display                           ? "--display"
                                                                 : NULL;
    if (job->taken.options.tile > 0 && other)
        fprintf(stderr, "psplat: error: --tile does not go with %s\n", other);
    return job->taken.options.tile == 0 || !other;
}

/* Part of the passes makes no picture that anybody waits for, unless it is named. */
static bool choose_outputs(struct render_job *job)
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
static bool check_outputs(const struct render_job *job)
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

/* A checkpoint that is there already is not replaced, or is a film. */
static bool spares_scene(const struct render_job *job)
{
    struct error error;
    if (!output_list_spares(&job->outputs, job->description))
        return false;
    if (!job->stats_path || output_spares(job->stats_path, "--stats", job->description, &error))
        return true;
    print_error(error.text);
    return false;
}

static int load_and_render(struct render_job *job)
{
    struct scene_input input;
    struct render_settings settings;
    /* Where it has no scene, or fails to load what that names, the first process tells. */
    int status = long_job_is_first(&job->passes) ? STATUS_USAGE : STATUS_OK;
    if (render_arguments_load(&job->taken, &input, &settings)) {
        job->settings = &settings;
        job->description = &input.description;
        job->sink = input.sink;
        render_job_set_wishes(job, &settings);
        if (spares_scene(job) && output_list_suits(&job->outputs, &settings) &&
            long_job_set_passes(&job->passes, &settings))
            status = render_job_run(job, &input);
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
static void write_nothing(struct render_job *job)
{
    job->outputs.count = 0;
    job->stats_path = job->display = NULL;
    job->taken.quiet = true;
    job->progress_mode = PROGRESS_NONE;
}

static int run_job(struct render_job *job)
{
    if (!long_job_is_first(&job->passes))
        write_nothing(job);
    progress_start(&job->progress, job->progress_mode, job->taken.quiet);
    job->passes.schedule.start = job->progress.start;
    job->passes.schedule.shows = job->display != NULL;
    job->passes.compression = job->outputs.options.compression;
    job->passes.quiet = job->taken.quiet;
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
    struct render_job job = {.stats_path = NULL};
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
