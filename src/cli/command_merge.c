/* command_merge.c: psplat merge: films of one job become the film of all their passes. */
#include "cli/command.h"
#include "job/facts.h"
#include "job/film_file.h"
#include "session/output.h"

#include <stdio.h>
#include <string.h>

static const struct option options[] = {
    {'o', "output", "FILE.exr", "the film to write; required"},
    {0, "compression", "NAME",
     "compression of the film, lossless: " IMAGE_COMPRESSIONS "; default: zip"},
    {'t', "threads", "N", "threads; the film does not depend on them"},
    {'q', "quiet", NULL, "print nothing but errors"},
};

struct job {
    const char *output;
    const struct argument *arguments;
    size_t count;
    struct output_options how;
    double threads; /* negative: not given */
    bool quiet;
    struct workers *workers;
};

static bool take_option(struct job *job, const struct argument *argument)
{
    const char *name = argument->option->name, *value = argument->value;
    struct error error;
    if (strcmp(name, "output") == 0)
        job->output = value;
    else if (strcmp(name, "quiet") == 0)
        job->quiet = true;
    else if (strcmp(name, "threads") == 0)
        return parse_whole_number(name, value, 1, 1024, &job->threads);
    else if (output_options_set(&job->how, name, value, &error) != PS_OK) {
        print_error(error.text);
        return false;
    }
    return true;
}

static bool take_arguments(struct job *job)
{
    size_t films = 0;
    for (size_t i = 0; i < job->count; i++) {
        films += job->arguments[i].option == NULL;
        if (job->arguments[i].option && !take_option(job, &job->arguments[i]))
            return false;
    }
    if (films == 0)
        print_error("which films? Try 'psplat merge --help'.");
    else if (!job->output || !output_holds_layers(job->output))
        print_error("--output: a film needs a name that ends in .exr");
    return films > 0 && job->output && output_holds_layers(job->output);
}

/* A film with what it was made with. */
struct labelled_film {
    const char *path; /* borrowed */
    struct film_sum sum;
    struct image facts;
};

static void release(struct labelled_film *film)
{
    film_sum_release(&film->sum);
    image_release(&film->facts);
}

static ps_result check_addition(const struct labelled_film *all, const struct labelled_film *film,
                                struct error *error)
{
    char difference[1200];
    uint32_t number;
    if (!facts_agree(&all->facts, &film->facts, difference, sizeof difference))
        return error_set(error, PS_ERROR_INVALID, "can't add '%s' to '%s': they differ in %s",
                         film->path, all->path, difference);
    if (!film_sum_is_alike(&all->sum, &film->sum))
        return error_set(error, PS_ERROR_INVALID,
                         "can't add '%s' to '%s': they do not have the same layers", film->path,
                         all->path);
    if (pass_set_meets(&all->sum.passes, &film->sum.passes, &number))
        return error_set(error, PS_ERROR_INVALID,
                         "can't add '%s': the films before it hold pass %u already", film->path,
                         number);
    return PS_OK;
}

static ps_result add(const struct job *job, struct labelled_film *all, const char *path,
                     struct error *error)
{
    struct labelled_film film = {.path = path};
    ps_result result = film_file_read(path, &film.sum, &film.facts, error);
    if (result == PS_OK && !all->path) {
        *all = film;
        return PS_OK;
    }
    if (result == PS_OK)
        result = check_addition(all, &film, error);
    if (result == PS_OK)
        result = film_sum_merge(&all->sum, &film.sum, job->workers, error);
    release(&film);
    return result;
}

static ps_result merge(struct job *job, struct error *error)
{
    struct labelled_film all = {.path = NULL};
    uint32_t threads = job->threads > 0 ? (uint32_t)job->threads : parallel_processor_count();
    ps_result result = workers_create(threads, &job->workers, error);
    for (size_t i = 0; i < job->count && result == PS_OK; i++)
        if (!job->arguments[i].option)
            result = add(job, &all, job->arguments[i].value, error);
    if (result == PS_OK)
        result = film_file_write(job->output, &all.sum, &all.facts, job->how.compression,
                                 job->workers, error);
    if (result == PS_OK && !job->quiet)
        fprintf(stderr, "psplat: wrote %s: %u passes\n", job->output,
                pass_set_size(&all.sum.passes));
    release(&all);
    workers_destroy(job->workers);
    return result;
}

static int run(const struct argument *arguments, size_t count)
{
    struct job job = {.arguments = arguments, .count = count, .threads = -1};
    struct error error;
    if (!take_arguments(&job))
        return STATUS_USAGE;
    ps_result result = output_check(job.output, &error) ? merge(&job, &error) : PS_ERROR_IO;
    if (result != PS_OK)
        print_error(error.text);
    return status_of(result);
}

const struct command command_merge = {
    .name = "merge",
    .operands = "FILM.exr ...",
    .summary = "adds films up: passes that were rendered apart",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
