#include "cli/long_job.h"

#include "base/clock.h"
#include "job/error_estimate.h"
#include "job/facts.h"
#include "job/film_file.h"
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

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
    if (!job->range.is_given && long_job_has_budget(job))
        settings->passes = MOST_PASSES;
    if (job->schedule.error > 0.0 && !tells_error(settings)) {
        fprintf(stderr,
                "psplat: error: --error: denoiser '%s' does not estimate its error; "
                "denoiser=regression and denoiser=none do\n",
                settings->strategies[PS_DENOISER].type->name);
        return false;
    }
    if (job->schedule.error > 0.0 && settings->crop.width > 0)
        print_warning("--crop: --error sees this part alone: others may get another number of "
                      "passes, and then differ");
    return true;
}

/* --- processes -------------------------------------------------------------------------------------- */

bool long_job_is_first(const struct long_job *job)
{
    return job->transport.rank == 0;
}

bool long_job_keeps_film(const struct long_job *job)
{
    return job->checkpoint || job->transport.size > 0;
}

/* What is wrong with a scene is told by the first process alone. */
static void mute(struct long_job *job)
{
    int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    job->muted = null >= 0 ? fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1) : -1;
    if (job->muted >= 0)
        dup2(null, STDERR_FILENO);
    if (null >= 0)
        close(null);
}

static void unmute(struct long_job *job)
{
    if (job->muted < 0)
        return;
    dup2(job->muted, STDERR_FILENO);
    close(job->muted);
    job->muted = -1;
}

bool long_job_join(struct long_job *job)
{
    struct error error;
    if (job->wants_mpi && transport_load_mpi(&job->transport, &error) != PS_OK) {
        print_error(error.text);
        return false;
    }
    if (!long_job_is_first(job))
        mute(job);
    return true;
}

#define NO_JOB 0 /* digest of a process that failed before it had one */

/* Rank 0 tells what is wrong, unless it failed itself. */
static ps_result agree(struct long_job *job, uint64_t digest, struct error *error)
{
    int odd_rank;
    job->has_agreed = true;
    bool agreed = team_agrees(&job->transport, digest, &odd_rank);
    unmute(job);
    if (agreed)
        return PS_OK;
    if (digest == NO_JOB)
        return PS_ERROR_INVALID;
    if (job->transport.rank > 0)
        error->text[0] = '\0';
    else
        error_set(error, PS_ERROR_INVALID,
                  "--mpi: process %d can't load the scene, or has another scene, other settings or "
                  "another instruction set (see --isa)",
                  odd_rank);
    return PS_ERROR_INVALID;
}

bool long_job_was_stopped(const struct long_job *job)
{
    return job->team && long_job_is_first(job) && team_was_stopped(job->team);
}

uint32_t long_job_passes_done(const struct long_job *job)
{
    return job->team && long_job_is_first(job) ? team_passes_done(job->team) : job->passes_seen;
}

bool long_job_has_run(const struct long_job *job, uint32_t first, uint32_t passes)
{
    const struct pass_set *set = &job->film.passes;
    return set->count == 0 ||
           (set->count == 1 && set->runs[0].first == first && set->runs[0].end == first + passes);
}

void long_job_leave(struct long_job *job)
{
    struct error error;
    if (job->transport.size == 0)
        return;
    if (!job->has_agreed)
        agree(job, NO_JOB, &error);
    long_job_end_passes(job, PS_ERROR_INVALID, &error); /* where a render did not come so far */
    job->transport.end();
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

/* What is rank 0's to do. */
static ps_result open_checkpoint(struct long_job *job, struct error *error)
{
    struct stat status;
    if (!job->checkpoint || !long_job_is_first(job))
        return PS_OK;
    ps_result result = lock_file_take(&job->lock, job->checkpoint, error);
    if (result != PS_OK || stat(job->checkpoint, &status) != 0)
        return result;
    if (job->resume)
        return resume(job, error);
    return error_set(error, PS_ERROR_INVALID,
                     "--checkpoint: '%s' is there already; --resume goes on with it",
                     job->checkpoint);
}

ps_result long_job_begin(struct long_job *job, const struct scene_description *description,
                         const struct scene *scene, const struct render_settings *settings,
                         struct error *error)
{
    schedule_start(&job->schedule, job->schedule.start);
    if (!long_job_keeps_film(job))
        return PS_OK;
    ps_result result = facts_of_job(&job->facts, description, scene, settings, error);
    if (result == PS_OK)
        result = open_checkpoint(job, error);
    if (job->transport.size == 0)
        return result;
    ps_result agreed = agree(job, result == PS_OK ? facts_digest(&job->facts) : NO_JOB, error);
    result = result == PS_OK ? agreed : result;
    return result == PS_OK ? team_create(&job->transport, &job->film, settings->first_pass,
                                         settings->passes, &job->team, error)
                           : result;
}

ps_result long_job_write_film(struct long_job *job, struct error *error)
{
    if (!job->checkpoint || job->film.passes.count == 0)
        return PS_OK;
    return film_file_write(job->checkpoint, &job->film, &job->facts, job->compression, job->workers,
                           error);
}

/* On the way, since `start`, with what made it ready; a disk that is full now may have room later. */
static void write_checkpoint(struct long_job *job, double start)
{
    struct error error;
    if (film_file_write(job->checkpoint, &job->film, &job->facts, IMAGE_UNCOMPRESSED, job->workers,
                        &error) != PS_OK &&
        !job->film_failed) {
        print_warning(error.text);
        job->film_failed = true;
    }
    schedule_note_checkpoint(&job->schedule, start, clock_seconds());
}

/* --- between passes --------------------------------------------------------------------------------- */

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
    if (show && image.width > 0)
        job->show_picture(job->user, &image);
    if (write && image.width > 0)
        result = job->write_picture(job->user, &image, passes, &error);
    if (result != PS_OK && result != PS_CANCELLED)
        print_warning(error.text);
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
    bool now_wanted = *job->write_now != 0;
    bool write = now_wanted || schedule_wants_picture(&job->schedule, now);
    bool show = schedule_wants_show(&job->schedule, now);
    bool look = write || show || schedule_wants_error(&job->schedule, passes);
    bool keep = job->checkpoint && (now_wanted || schedule_wants_checkpoint(&job->schedule, now));
    *job->write_now = 0;
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
        return (!long_job_is_first(job) || goes_on(job, render)) &&
               team_next_pass(job->team, number);
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

void long_job_release(struct long_job *job)
{
    film_sum_release(&job->film);
    image_release(&job->facts);
    lock_file_release(&job->lock);
}
