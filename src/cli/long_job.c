#include "cli/long_job.h"

#include "base/clock.h"
#include "base/text.h"
#include "job/error_estimate.h"
#include "job/facts.h"
#include "job/film_file.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define MOST_PASSES 1000000
#define CHECKPOINT_EVERY 60.0

/* --- options ---------------------------------------------------------------------------------------- */

/* "90", "90s", "1.5m", "2h", "1d". */
static bool parse_time(const char *option, const char *text, double *seconds)
{
    static const struct {
        char letter;
        double seconds;
    } units[] = {{'s', 1}, {'m', 60}, {'h', 3600}, {'d', 86400}};
    char number[64];
    size_t length = strlen(text);
    double unit = 1.0;
    for (size_t i = 0; i < sizeof units / sizeof units[0] && length > 1; i++)
        if (text[length - 1] == units[i].letter) {
            unit = units[i].seconds;
            length--;
            break;
        }
    snprintf(number, sizeof number, "%.*s", (int)(length < 63 ? length : 63), text);
    if (text_to_number(number, seconds) && *seconds > 0.0) {
        *seconds *= unit;
        return true;
    }
    fprintf(stderr, "psplat: error: --%s: expected a time such as 90s, 10m or 2h, got '%s'\n",
            option, text);
    return false;
}

static bool parse_percent(const char *text, double *share)
{
    char number[64];
    size_t length = strlen(text);
    length -= length > 1 && text[length - 1] == '%';
    snprintf(number, sizeof number, "%.*s", (int)(length < 63 ? length : 63), text);
    if (text_to_number(number, share) && *share > 0.0 && *share <= 100.0) {
        *share *= 0.01;
        return true;
    }
    fprintf(stderr, "psplat: error: --error: expected percent such as 2%%, got '%s'\n", text);
    return false;
}

/* "N" or "A:B". */
static bool parse_passes(struct long_job *job, const char *text)
{
    const char *colon = strchr(text, ':');
    char before[32];
    double first = 0, end = 0;
    job->has_passes = true;
    job->is_shard = colon != NULL;
    if (colon) {
        snprintf(before, sizeof before, "%.*s", (int)(colon - text < 31 ? colon - text : 31), text);
        if (!parse_whole_number("passes", before, 0, MOST_PASSES - 1, &first))
            return false;
    }
    if (!parse_whole_number("passes", colon ? colon + 1 : text, first + 1, MOST_PASSES, &end))
        return false;
    job->first = (uint32_t)first;
    job->end = (uint32_t)end;
    return true;
}

static bool take_option(struct long_job *job, const struct argument *argument)
{
    const char *value = argument->value;
    if (argument_is(argument, "passes"))
        return parse_passes(job, value);
    if (argument_is(argument, "time"))
        return parse_time("time", value, &job->schedule.seconds);
    if (argument_is(argument, "error"))
        return parse_percent(value, &job->schedule.error);
    if (argument_is(argument, "write-every"))
        return parse_time("write-every", value, &job->schedule.write_every);
    if (argument_is(argument, "checkpoint-every"))
        return parse_time("checkpoint-every", value, &job->schedule.checkpoint_every);
    if (argument_is(argument, "checkpoint"))
        job->checkpoint = value;
    else if (argument_is(argument, "resume"))
        job->resume = true;
    return true; /* another's */
}

static bool goes_together(const struct long_job *job)
{
    const char *wrong = NULL;
    if (job->resume && !job->checkpoint)
        wrong = "--resume: which film? Name it with --checkpoint.";
    else if (job->schedule.checkpoint_every < INFINITY && !job->checkpoint)
        wrong = "--checkpoint-every: which film? Name it with --checkpoint.";
    else if (job->checkpoint && !output_holds_layers(job->checkpoint))
        wrong = "--checkpoint: a film needs a name that ends in .exr";
    if (wrong)
        print_error(wrong);
    return !wrong;
}

bool long_job_take(struct long_job *job, const struct argument *arguments, size_t count)
{
    *job = (struct long_job){
        .schedule = {.seconds = INFINITY, .write_every = INFINITY, .checkpoint_every = INFINITY},
        .lock = {.descriptor = -1},
    };
    for (size_t i = 0; i < count; i++)
        if (arguments[i].option && !take_option(job, &arguments[i]))
            return false;
    if (!goes_together(job))
        return false;
    if (job->checkpoint && !(job->schedule.checkpoint_every < INFINITY)) {
        job->schedule.checkpoint_every = CHECKPOINT_EVERY;
        job->schedule.checkpoints_are_cheap = true;
    }
    return true;
}

bool long_job_has_budget(const struct long_job *job)
{
    return job->schedule.seconds < INFINITY || job->schedule.error > 0.0;
}

/* By its layer, or, where nothing is denoised, by the variance of passes. */
static bool tells_error(const struct render_settings *settings)
{
    const ps_denoiser_vtable *table = &settings->strategies[PS_DENOISER].type->table.denoiser;
    return !table->filter || table->flags & PS_DENOISER_ERROR;
}

bool long_job_set_passes(const struct long_job *job, struct render_settings *settings)
{
    if (job->has_passes) {
        settings->first_pass = job->first;
        settings->passes = job->end;
    } else if (long_job_has_budget(job)) {
        settings->passes = MOST_PASSES;
    }
    if (job->schedule.error > 0.0 && !tells_error(settings)) {
        fprintf(stderr,
                "psplat: error: --error: denoiser '%s' does not estimate its error; "
                "denoiser=regression and denoiser=none do\n",
                settings->strategies[PS_DENOISER].type->name);
        return false;
    }
    return true;
}

/* --- films ------------------------------------------------------------------------------------------ */

static ps_result resume(struct long_job *job, struct error *error)
{
    char difference[1200];
    struct image facts;
    ps_result result = film_file_read(job->checkpoint, &job->film, &facts, error);
    if (result != PS_OK)
        return result;
    if (!facts_agree(&facts, &job->facts, difference, sizeof difference))
        result = error_set(error, PS_ERROR_INVALID,
                           "can't go on with '%s': it is of another job, which differs in %s",
                           job->checkpoint, difference);
    image_release(&facts);
    job->passes_before = pass_set_size(&job->film.passes);
    if (result == PS_OK && !job->quiet)
        fprintf(stderr, "psplat: goes on with %s: %u passes\n", job->checkpoint,
                job->passes_before);
    return result;
}

ps_result long_job_begin(struct long_job *job, const struct scene_description *description,
                         const struct scene *scene, const struct render_settings *settings,
                         struct error *error)
{
    struct stat status;
    schedule_start(&job->schedule, job->schedule.start);
    if (!job->checkpoint)
        return PS_OK;
    ps_result result = facts_of_job(&job->facts, description, scene, settings, error);
    if (result == PS_OK)
        result = lock_file_take(&job->lock, job->checkpoint, error);
    if (result != PS_OK || stat(job->checkpoint, &status) != 0)
        return result;
    if (job->resume)
        return resume(job, error);
    return error_set(error, PS_ERROR_INVALID,
                     "--checkpoint: '%s' is there already; --resume goes on with it",
                     job->checkpoint);
}

ps_result long_job_write_film(struct long_job *job, struct error *error)
{
    if (!job->checkpoint || job->film.passes.count == 0)
        return PS_OK;
    return film_file_write(job->checkpoint, &job->film, &job->facts, job->compression,
                           job->workers, error);
}

/* On the way; a disk that is full now may have room later. */
static void write_checkpoint(struct long_job *job)
{
    struct error error;
    double start = clock_seconds();
    if (film_file_write(job->checkpoint, &job->film, &job->facts, IMAGE_UNCOMPRESSED, job->workers,
                        &error) != PS_OK &&
        !job->film_failed) {
        print_warning(error.text);
        job->film_failed = true;
    }
    schedule_note_checkpoint(&job->schedule, start, clock_seconds());
}

/* --- between passes --------------------------------------------------------------------------------- */

static void look_at_picture(struct long_job *job, struct render *render, bool write)
{
    struct schedule *schedule = &job->schedule;
    struct image image;
    struct error error;
    double start = clock_seconds();
    uint32_t passes = pass_set_size(&render_film(render)->passes);
    ps_result result = render_picture(render, &image, &error);
    if (schedule->error > 0.0) {
        double estimate = error_estimate_of_picture(&image);
        if (estimate < 0.0)
            estimate = error_estimate_of_film(render_film(render));
        schedule_note_error(schedule, passes, estimate, clock_seconds() - start);
    }
    if (write && image.width > 0)
        result = job->write_picture(job->user, &image, &error);
    if (result != PS_OK && result != PS_CANCELLED)
        print_warning(error.text);
    image_release(&image);
    if (write)
        schedule_note_picture(schedule, start, clock_seconds());
}

static void do_what_is_due(struct long_job *job, struct render *render, uint32_t passes)
{
    double now = clock_seconds();
    bool now_wanted = *job->write_now != 0;
    bool write = now_wanted || schedule_wants_picture(&job->schedule, now);
    *job->write_now = 0;
    if (write || schedule_wants_error(&job->schedule, passes))
        look_at_picture(job, render, write);
    if (job->checkpoint && (now_wanted || schedule_wants_checkpoint(&job->schedule, now)))
        write_checkpoint(job);
}

bool long_job_goes_on(struct long_job *job, struct render *render)
{
    const struct film_sum *film = render_film(render);
    uint32_t passes = film ? pass_set_size(&film->passes) : 0;
    if (passes > job->passes_seen)
        schedule_end_pass(&job->schedule, clock_seconds());
    bool has_new = passes > job->passes_before;
    job->passes_seen = passes;
    if (passes > 0)
        do_what_is_due(job, render, passes);
    double now = clock_seconds();
    bool goes_on = !schedule_is_good_enough(&job->schedule) &&
                   (!has_new || schedule_has_time(&job->schedule, now));
    schedule_begin_pass(&job->schedule, now);
    return goes_on;
}

void long_job_release(struct long_job *job)
{
    film_sum_release(&job->film);
    image_release(&job->facts);
    lock_file_release(&job->lock);
}
