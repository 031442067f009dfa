#include "render_job/long_job.h"

#include "base/clock.h"
#include "job/error_estimate.h"
#include "job/facts.h"
#include "job/film_file.h"
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

#define CHECKPOINT_EVERY 60.0

void long_job_init(struct long_job *job, double start)
{
    const struct job_options *options = &job->options->job;
    bool is_given = options->checkpoint_every > 0.0,
         has_files = job->options->output.paths.count > 0;
    double every = is_given ? options->checkpoint_every : CHECKPOINT_EVERY;
    job->lock = (struct lock_file){.descriptor = -1};
    job->schedule = (struct schedule){
        .seconds = options->seconds,
        .error = options->error,
        .write_every = has_files ? options->write_every : INFINITY,
        .checkpoint_every = options->checkpoint ? every : INFINITY,
        .checkpoints_are_cheap = options->checkpoint && !is_given,
        .shows = job->shows,
    };
    schedule_start(&job->schedule, start);
}

void long_job_release(struct long_job *job)
{
    struct error error;
    /* Where a render did not come so far. */
    long_job_end_passes(job, PS_ERROR_INVALID, &error);
    film_sum_release(&job->film);
    image_release(&job->facts);
    lock_file_release(&job->lock);
}

/* By its layer, or, where nothing is denoised, by the variance of passes. */
static bool tells_error(const struct render_settings *settings)
{
    const ps_denoiser_vtable *table = &settings->strategies[PS_DENOISER].type->table.denoiser;
    return !table->filter || table->flags & PS_DENOISER_ERROR;
}

ps_result long_job_set_passes(const struct long_job *job, struct render_settings *settings,
                              struct error *error)
{
    const struct render_options *options = job->options;
    if (!options->passes.is_given && job_options_have_budget(&options->job))
        settings->passes = MOST_PASSES;
    if (options->job.error > 0.0 && !tells_error(settings))
        return error_set(error, PS_ERROR_INVALID,
                         "--error: denoiser '%s' does not estimate its error; "
                         "denoiser=regression and denoiser=none do",
                         settings->strategies[PS_DENOISER].type->name);
    if (options->job.error > 0.0 && settings->crop.width > 0)
        job->log(job->user, PS_LOG_WARNING,
                 "--crop: --error sees this part alone: others may get another number of "
                 "passes, and then differ");
    return PS_OK;
}

/* --- processes
 * -------------------------------------------------------------------------------------- */

static bool is_first(const struct long_job *job)
{
    return processes_is_first(job->processes);
}

bool long_job_was_stopped(const struct long_job *job)
{
    return job->team && is_first(job) && team_was_stopped(job->team);
}

uint32_t long_job_passes_done(const struct long_job *job)
{
    return job->team && is_first(job) ? team_passes_done(job->team) : job->passes_seen;
}

bool long_job_has_run(const struct long_job *job, uint32_t first, uint32_t passes)
{
    const struct pass_set *set = &job->film.passes;
    return set->count == 0 ||
           (set->count == 1 && set->runs[0].first == first && set->runs[0].end == first + passes);
}

/* --- films
 * ------------------------------------------------------------------------------------------ */

static ps_result resume(struct long_job *job, struct error *error)
{
    char difference[1200], message[1200];
    struct image facts;
    const char *path = job->options->job.checkpoint;
    ps_result result = film_file_read(path, &job->film, &facts, error);
    if (result != PS_OK)
        return result;
    if (!facts_agree(&facts, &job->facts, difference, sizeof difference))
        result = error_set(error, PS_ERROR_INVALID,
                           "can't go on with '%s': it is of another job, which differs in %s", path,
                           difference);
    image_release(&facts);
    job->passes_before = pass_set_size(&job->film.passes);
    if (result != PS_OK)
        return result;
    snprintf(message, sizeof message, "goes on with %.1000s: %u passes", path, job->passes_before);
    job->log(job->user, PS_LOG_INFO, message);
    return PS_OK;
}

/* What is the first process's to do. */
static ps_result open_checkpoint(struct long_job *job, struct error *error)
{
    const char *path = job->options->job.checkpoint;
    struct stat status;
    if (!path || !is_first(job))
        return PS_OK;
    ps_result result = lock_file_take(&job->lock, path, error);
    if (result != PS_OK || stat(path, &status) != 0)
        return result;
    if (job->options->job.resume)
        return resume(job, error);
    return error_set(error, PS_ERROR_INVALID,
                     "--checkpoint: '%s' is there already; --resume goes on with it", path);
}

ps_result long_job_begin(struct long_job *job, const struct scene_description *description,
                         const struct scene *scene, const struct render_settings *settings,
                         struct error *error)
{
    struct processes *processes = job->processes;
    if (!render_options_keep_film(job->options))
        return PS_OK;
    ps_result result = facts_of_job(&job->facts, description, scene, settings, error);
    if (result == PS_OK)
        result = open_checkpoint(job, error);
    if (!processes)
        return result;
    ps_result agreed =
        processes_agree(processes, result == PS_OK ? facts_digest(&job->facts) : NO_JOB, error);
    result = result == PS_OK ? agreed : result;
    return result == PS_OK ? team_create(&processes->transport, &job->film, settings->first_pass,
                                         settings->passes, &job->team, error)
                           : result;
}

static ps_result write_film(const struct long_job *job, enum image_compression compression,
                            struct error *error)
{
    return film_file_write(job->options->job.checkpoint, &job->film, &job->facts, compression,
                           job->workers, error);
}

ps_result long_job_write_film(struct long_job *job, struct error *error)
{
    if (!job->options->job.checkpoint || !is_first(job) || job->film.passes.count == 0)
        return PS_OK;
    return write_film(job, job->options->output.options.compression, error);
}

/* On the way, since `start`, with what made it ready; a disk that is full now may have room
 * later. */
static void write_checkpoint(struct long_job *job, double start)
{
    struct error error;
    if (write_film(job, IMAGE_UNCOMPRESSED, &error) != PS_OK && !job->film_failed) {
        job->log(job->user, PS_LOG_WARNING, error.text);
        job->film_failed = true;
    }
    schedule_note_checkpoint(&job->schedule, start, clock_seconds());
}

/* --- between passes
 * --------------------------------------------------------------------------------- */

static void look_at_picture(struct long_job *job, struct render *render, bool write, bool show)
{
    struct schedule *schedule = &job->schedule;
    struct image image;
    struct error error;
    double start = clock_seconds();
    uint32_t passes = pass_set_size(&render_film(render)->passes);
    ps_result result = render_picture(render, write || show, &image, &error);
    if (schedule->error > 0.0) {
        double estimate = error_estimate_of_picture(&image);
        if (estimate < 0.0)
            estimate = error_estimate_of_film(render_film(render));
        schedule_note_error(schedule, passes, estimate, clock_seconds() - start);
    }
    if (write && image.width > 0)
        result = job->write_picture(job->user, &image, passes, &error);
    if (result != PS_OK && result != PS_CANCELLED)
        job->log(job->user, PS_LOG_WARNING, error.text);
    if (show && image.width > 0)
        job->show_picture(job->user, &image);
    else
        image_release(&image);
    if (write)
        schedule_note_picture(schedule, start, clock_seconds());
    if (show)
        schedule_note_show(schedule, start, clock_seconds());
}

static void do_what_is_due(struct long_job *job, struct render *render, uint32_t passes)
{
    double now = clock_seconds();
    struct error error;
    bool now_wanted = job->write_now(job->user);
    bool write = schedule_wants_picture(&job->schedule, now) ||
                 (now_wanted && job->options->output.paths.count > 0);
    bool show = schedule_wants_show(&job->schedule, now);
    bool look = write || show || schedule_wants_error(&job->schedule, passes);
    bool keep = job->options->job.checkpoint &&
                (now_wanted || schedule_wants_checkpoint(&job->schedule, now));
    if ((look || keep) && job->team && team_gather(job->team, &error) != PS_OK)
        return; /* the film is lost, which team_end tells */
    double gathering = clock_seconds() - now;
    if (look)
        look_at_picture(job, render, write, show);
    if (keep)
        write_checkpoint(job, clock_seconds() - gathering);
}

/* Where no budget is used up. */
static bool goes_on(struct long_job *job, struct render *render)
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

bool long_job_next_pass(struct long_job *job, struct render *render, uint32_t *number)
{
    if (job->team)
        return (!is_first(job) || goes_on(job, render)) && team_next_pass(job->team, number);
    return render_missing_pass(render, number) && goes_on(job, render);
}

ps_result long_job_end_passes(struct long_job *job, ps_result result, struct error *error)
{
    if (!job->team)
        return PS_OK;
    ps_result ended = team_end(job->team, result != PS_OK, error);
    if (ended == PS_OK && long_job_was_stopped(job))
        ended = error_set(error, PS_CANCELLED, "another process was told to stop, or failed");
    team_destroy(job->team);
    job->team = NULL;
    return ended;
}
