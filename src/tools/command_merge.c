/* command_merge.c: psplat merge: films of one job become the film of all their passes, and of all
 * parts of the picture. */
#include "cli/command.h"
#include "film/film_parts.h"
#include "job/facts.h"
#include "job/film_file.h"
#include "session/output.h"
#include "tools/option_parse.h"

#include <stdio.h>
#include <stdlib.h>
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

/* Those of each part of the picture, added up. */
struct parts {
    struct labelled_film *films; /* owned */
    size_t count;
};

static void release(struct labelled_film *film)
{
    film_sum_release(&film->sum);
    image_release(&film->facts);
}

static void release_parts(struct parts *parts)
{
    for (size_t i = 0; i < parts->count; i++)
        release(&parts->films[i]);
    free(parts->films);
}

/* Where parts lie is compared apart. */
static ps_result read_film(const char *path, struct labelled_film *film, struct error *error)
{
    *film = (struct labelled_film){.path = path};
    ps_result result = film_file_read(path, &film->sum, &film->facts, error);
    if (result == PS_OK)
        result = facts_set_crop(&film->facts, (struct rectangle){0}, error);
    return result;
}

static ps_result check_job(const struct labelled_film *first, const struct labelled_film *film,
                           struct error *error)
{
    char difference[1200];
    if (!facts_agree(&first->facts, &film->facts, difference, sizeof difference))
        return error_set(error, PS_ERROR_INVALID, "can't add '%s' to '%s': they differ in %s",
                         film->path, first->path, difference);
    if (!film_sum_has_planes_of(&first->sum, &film->sum))
        return error_set(error, PS_ERROR_INVALID,
                         "can't add '%s' to '%s': they do not have the same layers", film->path,
                         first->path);
    return PS_OK;
}

/* --- passes of one part
 * --------------------------------------------------------------------------- */

static ps_result add_passes(const struct job *job, struct labelled_film *part,
                            const struct labelled_film *film, struct error *error)
{
    uint32_t number;
    if (pass_set_meets(&part->sum.passes, &film->sum.passes, &number))
        return error_set(error, PS_ERROR_INVALID,
                         "can't add '%s': the films before it hold pass %u already", film->path,
                         number);
    return film_sum_merge(&part->sum, &film->sum, job->workers, error);
}

/* Takes the film over, or leaves it to the caller where that fails. */
static ps_result add_part(struct parts *parts, struct labelled_film *film, struct error *error)
{
    for (size_t i = 0; i < parts->count; i++)
        if (film_parts_meet(&parts->films[i].sum, &film->sum))
            return error_set(error, PS_ERROR_INVALID,
                             "can't put '%s' beside '%s': they have pixels in common", film->path,
                             parts->films[i].path);
    struct labelled_film *films = realloc(parts->films, (parts->count + 1) * sizeof *films);
    if (!films)
        return error_memory(error, (parts->count + 1) * sizeof *films, "films");
    parts->films = films;
    films[parts->count++] = *film;
    *film = (struct labelled_film){.path = NULL};
    return PS_OK;
}

static ps_result add(const struct job *job, struct parts *parts, const char *path,
                     struct error *error)
{
    struct labelled_film film, *same = NULL;
    ps_result result = read_film(path, &film, error);
    if (result == PS_OK && parts->count > 0)
        result = check_job(&parts->films[0], &film, error);
    for (size_t i = 0; i < parts->count && result == PS_OK && !same; i++)
        if (film_sum_is_alike(&parts->films[i].sum, &film.sum))
            same = &parts->films[i];
    if (result == PS_OK)
        result = same ? add_passes(job, same, &film, error) : add_part(parts, &film, error);
    release(&film);
    return result;
}

/* --- parts of one picture
 * ------------------------------------------------------------------------- */

static ps_result check_passes(const struct parts *parts, struct error *error)
{
    for (size_t i = 1; i < parts->count; i++)
        if (!pass_set_same(&parts->films[0].sum.passes, &parts->films[i].sum.passes))
            return error_set(error, PS_ERROR_INVALID,
                             "can't put '%s' beside '%s': they hold different passes",
                             parts->films[i].path, parts->films[0].path);
    return PS_OK;
}

static ps_result join(const struct parts *parts, const struct film_sum *const sums[],
                      struct film_sum *joined, struct error *error)
{
    struct rectangle around = film_parts_around(sums, parts->count);
    size_t pixels = film_parts_pixels(sums, parts->count);
    if (pixels != around.width * around.height)
        return error_set(
            error, PS_ERROR_INVALID,
            "the films leave %zu pixels of the rectangle around them, %zu,%zu,%zu,%zu, "
            "without light: which part is not there?",
            around.width * around.height - pixels, around.x, around.y, around.width, around.height);
    ps_result result = check_passes(parts, error);
    return result == PS_OK ? film_parts_join(sums, parts->count, joined, error) : result;
}

/* Makes one part of all. */
static ps_result join_parts(struct parts *parts, struct error *error)
{
    const struct film_sum **sums = malloc(parts->count * sizeof *sums);
    struct film_sum joined = {.width = 0};
    ps_result result =
        sums ? PS_OK : error_memory(error, parts->count * sizeof *sums, "parts of a film");
    for (size_t i = 0; i < parts->count && sums; i++)
        sums[i] = &parts->films[i].sum;
    if (result == PS_OK)
        result = join(parts, sums, &joined, error);
    free(sums);
    if (result != PS_OK) {
        film_sum_release(&joined);
        return result;
    }
    for (; parts->count > 1; parts->count--)
        release(&parts->films[parts->count - 1]);
    film_sum_release(&parts->films[0].sum);
    parts->films[0].sum = joined;
    return PS_OK;
}

static ps_result set_crop(struct labelled_film *film, struct error *error)
{
    const struct picture_window *window = &film->sum.window;
    bool is_part = window->picture_width > 0 && (film->sum.width < window->picture_width ||
                                                 film->sum.height < window->picture_height);
    return facts_set_crop(&film->facts,
                          is_part ? film_parts_place(&film->sum) : (struct rectangle){0}, error);
}

static ps_result write_film(const struct job *job, struct labelled_film *film, struct error *error)
{
    ps_result result = set_crop(film, error);
    if (result == PS_OK)
        result = film_file_write(job->output, &film->sum, &film->facts, job->how.compression,
                                 job->workers, error);
    if (result == PS_OK && !job->quiet)
        fprintf(stderr, "psplat: wrote %s: %u passes\n", job->output,
                pass_set_size(&film->sum.passes));
    return result;
}

static ps_result merge(struct job *job, struct error *error)
{
    struct parts parts = {.count = 0};
    uint32_t threads = job->threads > 0 ? (uint32_t)job->threads : parallel_processor_count();
    ps_result result = workers_create(threads, &job->workers, error);
    for (size_t i = 0; i < job->count && result == PS_OK; i++)
        if (!job->arguments[i].option)
            result = add(job, &parts, job->arguments[i].value, error);
    if (result == PS_OK && parts.count > 1)
        result = join_parts(&parts, error);
    if (result == PS_OK && parts.films)
        result = write_film(job, &parts.films[0], error);
    release_parts(&parts);
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
    .summary = "adds films up: passes, and parts of the picture, that were rendered apart",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
