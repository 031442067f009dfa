/* command_resolve.c: psplat resolve: a film becomes a picture, without rendering. */
#include "base/param.h"
#include "base/text.h"
#include "cli/command.h"
#include "cli/option_rows.h"
#include "job/facts.h"
#include "job/film_file.h"
#include "parser/schema/schema.h"
#include "plugin/kind.h"
#include "session/layers.h"
#include "session/output_list.h"
#include "tools/last_stages.h"
#include "tools/option_parse.h"
#include "tools/progress_callbacks.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const struct option options[] = {
    OUTPUT_OPTIONS,
    {'p', "plugin", "KIND=NAME[:KEY=VALUE,...]",
     "another normalization, denoiser, bloom or tone map, or other parameters"},
    {0, "exposure", "STOPS", "brightness of what is shown: a factor of 2^STOPS"},
    {'t', "threads", "N", "threads; the picture does not depend on them"},
    {'q', "quiet", NULL, "print only warnings and errors"},
};

struct job {
    const char *film_path;
    struct output_list outputs;
    const struct argument *arguments;
    size_t count;
    double threads; /* negative: not given */
    double exposure;
    bool has_exposure, quiet;
    struct film_sum film;
    struct image facts;
    struct last_stages stages;
};

/* Options of the picture's files. False, printed, where one is wrong. */
static bool take_output(struct output_list *outputs, const struct argument *argument)
{
    const char *name = argument->option->name;
    struct error error;
    ps_result result = PS_OK;
    if (strcmp(name, "output") == 0)
        result = output_list_add(outputs, argument->value, &error);
    else if (output_options_has(name))
        result = output_options_set(&outputs->options, name, argument->value, &error);
    if (result != PS_OK)
        print_error(error.text);
    return result == PS_OK;
}

static bool take_option(struct job *job, const struct argument *argument)
{
    if (!take_output(&job->outputs, argument))
        return false;
    if (argument_is(argument, "quiet"))
        job->quiet = true;
    else if (argument_is(argument, "threads"))
        return parse_whole_number("threads", argument->value, 1, 1024, &job->threads);
    else if (argument_is(argument, "exposure"))
        return job->has_exposure = parse_exposure(argument->value, &job->exposure);
    return true;
}

static bool take_arguments(struct job *job)
{
    for (size_t i = 0; i < job->count; i++) {
        const struct argument *argument = &job->arguments[i];
        if (argument->option && !take_option(job, argument))
            return false;
        if (!argument->option && job->film_path) {
            fprintf(stderr, "psplat: error: one film at a time: '%s' after '%s'\n", argument->value,
                    job->film_path);
            return false;
        }
        if (!argument->option)
            job->film_path = argument->value;
    }
    if (!job->film_path)
        print_error("which film? Try 'psplat resolve --help'.");
    else if (job->outputs.paths.count == 0)
        print_error("where to? Name the picture with --output.");
    return job->film_path && job->outputs.paths.count > 0;
}

/* A picture in place of its film would be a loss. */
static bool spares_film(const struct job *job)
{
    struct stat film, output;
    for (size_t i = 0; i < job->outputs.paths.count; i++) {
        const char *path = job->outputs.paths.words[i];
        if (stat(job->film_path, &film) == 0 && stat(path, &output) == 0 &&
            film.st_dev == output.st_dev && film.st_ino == output.st_ino) {
            fprintf(stderr, "psplat: error: --output: '%s' is the film itself\n", path);
            return false;
        }
    }
    return true;
}

/* --- settings
 * --------------------------------------------------------------------------------------- */

static ps_result set_number(struct render_description *render, const char *key, const char *text,
                            struct error *error)
{
    struct param_table table = schema_table(schema_only("render"));
    return text ? param_set(param_find(&table, key), render, text, error) : PS_OK;
}

static bool names_path(const char *choice)
{
    return memchr(choice, '/', strcspn(choice, ":")) != NULL;
}

/* Whether --plugin says what strategy of that kind to use. */
static bool is_overridden(const struct job *job, ps_kind kind)
{
    const char *name;
    for (size_t i = 0; i < job->count; i++)
        if (argument_is(&job->arguments[i], "plugin") &&
            kind_parse(job->arguments[i].value, &name) == kind)
            return true;
    return false;
}

/* The strategy that the film's job had chosen. Who opens a film does not ask for programs that it
 * names. */
static ps_result take_strategy(struct job *job, ps_kind kind, struct error *error)
{
    char key[64];
    snprintf(key, sizeof key, "psplat.%s", kinds[kind].name);
    const char *choice = image_attribute(&job->facts, key);
    if (!choice)
        return PS_OK;
    if (names_path(choice) && !is_overridden(job, kind))
        return error_set(
            error, PS_ERROR_INVALID,
            "the film's job had %s '%.200s', a plugin that it named by its path: say by "
            "--plugin %s=... that it may run, or choose another one",
            kinds[kind].name, choice, kinds[kind].name);
    return last_stages_choose(&job->stages, kind, choice, error);
}

/* The first kind that has nothing to do. */
static ps_kind end_of_stages(const struct job *job)
{
    return output_list_wants_display(&job->outputs) ? PS_KINDS : PS_BLOOM;
}

/* What the film was to be resolved with. */
static ps_result take_facts(struct job *job, struct error *error)
{
    const struct image *facts = &job->facts;
    struct render_description *description = &job->stages.description;
    const char *exposure = image_attribute(facts, "psplat.exposure");
    ps_result result = PS_OK;
    for (int kind = PS_NORMALIZATION; kind < (int)end_of_stages(job) && result == PS_OK; kind++)
        result = take_strategy(job, (ps_kind)kind, error);
    if (result == PS_OK)
        result = set_number(description, "indirect_exposure",
                            image_attribute(facts, "psplat.indirect_exposure"), error);
    if (result == PS_OK)
        result =
            set_number(description, "ambient", image_attribute(facts, "psplat.ambient"), error);
    if (!job->has_exposure && exposure)
        text_to_number(exposure, &job->exposure);
    return result;
}

/* Errors that were printed leave no text. */
static ps_result load_settings(struct job *job, struct render_settings *settings,
                               struct error *error)
{
    uint32_t threads = job->threads > 0 ? (uint32_t)job->threads : parallel_processor_count();
    ps_result result = last_stages_create(&job->stages, error);
    if (result == PS_OK)
        result = take_facts(job, error);
    for (size_t i = 0; i < job->count && result == PS_OK; i++)
        if (argument_is(&job->arguments[i], "plugin"))
            result = last_stages_override(&job->stages, PS_NORMALIZATION, job->arguments[i].value,
                                          error);
    return result == PS_OK ? last_stages_resolve(&job->stages, threads, settings, error) : result;
}

/* --- picture
 * ---------------------------------------------------------------------------------------- */

static ps_result describe(const struct job *job, const struct render_settings *settings,
                          struct image *image, struct error *error)
{
    ps_result result = PS_OK;
    char passes[32], exposure[32];
    for (size_t i = 0; i < job->facts.attribute_count && result == PS_OK; i++) {
        const struct image_attribute *fact = &job->facts.attributes[i];
        if (strcmp(fact->name, "psplat.film") != 0)
            result = image_set_attribute(image, fact->name, fact->value, error);
    }
    for (int kind = PS_NORMALIZATION; kind < (int)end_of_stages(job) && result == PS_OK; kind++)
        result = facts_set_strategy(image, &settings->strategies[kind], error);
    text_from_number(job->exposure, exposure, sizeof exposure);
    snprintf(passes, sizeof passes, "%" PRIu32, pass_set_size(&job->film.passes));
    if (result == PS_OK)
        result = image_set_attribute(image, "psplat.exposure", exposure, error);
    return result == PS_OK ? image_set_attribute(image, "psplat.passes", passes, error) : result;
}

static void tell_of_file(void *user, const char *path)
{
    const struct job *job = user;
    if (!job->quiet)
        fprintf(stderr, "psplat: wrote %s\n", path);
}

static ps_result resolve_with(struct job *job, struct render_settings *settings,
                              struct error *error)
{
    struct progress progress;
    struct statistics statistics;
    struct image image;
    struct scene scene = {.width = 0};
    struct error reason;
    ps_result result = facts_view(&job->facts, &scene, &settings->aa_samples, error);
    if (result != PS_OK)
        return result;
    progress_start(&progress, PROGRESS_AUTO, job->quiet);
    struct render_callbacks callbacks = progress_callbacks(&progress);
    statistics_init(&statistics);
    result = render_resolve(&job->film, &scene, settings, &callbacks, &statistics, &image, error);
    progress_clear(&progress);
    if (image.width > 0) {
        ps_result written = describe(job, settings, &image, &reason);
        if (written == PS_OK)
            written = output_list_write(&job->outputs, &image, settings->workers, tell_of_file, job,
                                        &reason);
        if (written != PS_OK && result == PS_OK) {
            result = written;
            *error = reason;
        }
    }
    image_release(&image);
    statistics_destroy(&statistics);
    return result;
}

static ps_result resolve(struct job *job, struct error *error)
{
    struct render_settings settings;
    ps_result result = film_file_read(job->film_path, &job->film, &job->facts, error);
    if (result == PS_OK)
        result = load_settings(job, &settings, error);
    if (result != PS_OK)
        return result;
    settings.picture_alone = !output_list_wants_layers(&job->outputs);
    settings.no_error_layer = !output_list_wants_error(&job->outputs);
    settings.display = output_list_wants_display(&job->outputs);
    settings.exposure = job->exposure;
    result = layers_check_denoiser(output_options_layers(&job->outputs.options), &settings, error);
    if (result == PS_OK)
        result = resolve_with(job, &settings, error);
    settings_release(&settings);
    return result;
}

static void release(struct job *job)
{
    film_sum_release(&job->film);
    image_release(&job->facts);
    last_stages_release(&job->stages);
    output_list_release(&job->outputs);
}

static int run(const struct argument *arguments, size_t count)
{
    struct job job = {.arguments = arguments, .count = count, .threads = -1};
    struct error error = {.text = ""};
    int status = STATUS_USAGE;
    if (take_arguments(&job) && spares_film(&job)) {
        ps_result result = output_list_check(&job.outputs, &error);
        if (result == PS_OK)
            result = resolve(&job, &error);
        if (result != PS_OK && error.text[0])
            print_error(error.text);
        status = status_of(result);
    }
    release(&job);
    return status;
}

const struct command command_resolve = {
    .name = "resolve",
    .operands = "FILM.exr",
    .summary = "makes a picture of a film, without rendering again",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
