/* long_job.h: what a render does between its passes: budgets, pictures and films on the way, what
 * it resumes. */
#ifndef RENDER_JOB_LONG_JOB_H
#define RENDER_JOB_LONG_JOB_H

#include "base/lock_file.h"
#include "film/film_sum.h"
#include "job/schedule.h"
#include "job/team.h"
#include "pipeline/render.h"
#include "render_job/processes.h"
#include "session/render_options.h"

struct long_job {
    /* Of the job, borrowed. */
    const struct render_options *options;
    struct processes *processes; /* NULL: this one is alone */
    struct workers *workers;
    bool shows; /* pictures on the way to somebody */
    void (*log)(void *user, ps_log_level level, const char *message);
    bool (*write_now)(
        void *user); /* whether picture and film are to be written, whatever the schedule says */
    ps_result (*write_picture)(void *user, struct image *image, uint32_t passes,
                               struct error *error);
    void (*show_picture)(void *user, struct image *image); /* takes it over */
    void *user;
    /* While it runs. */
    struct schedule schedule;
    struct team *team;      /* NULL: this process is alone, or the team has ended */
    struct film_sum film;   /* with a checkpoint, or other processes */
    struct image facts;     /* of the film */
    struct lock_file lock;  /* on the checkpoint */
    uint32_t passes_before; /* in the film that was resumed */
    uint32_t passes_seen;   /* when the schedule last looked */
    bool film_failed;       /* a checkpoint could not be written, and that was said */
};

/* Makes it ready; what the job lends is there. `start`: when the time of the budget began. To be
 * released in any case. */
void long_job_init(struct long_job *job, double start);
void long_job_release(struct long_job *job);

/* Lays a budget's passes over the settings. PS_ERROR_INVALID where the denoiser does not tell the
 * error that is asked for. */
ps_result long_job_set_passes(const struct long_job *job, struct render_settings *settings,
                              struct error *error);

/* Locks the checkpoint, and reads it where it is to be resumed; sees to it that all processes have
 * the same job. An error without a text is another process's to tell. */
ps_result long_job_begin(struct long_job *job, const struct scene_description *description,
                         const struct scene *scene, const struct render_settings *settings,
                         struct error *error);

/* Does what is due between passes. See render_callbacks.next_pass and end_passes. */
bool long_job_next_pass(struct long_job *job, struct render *render, uint32_t *number);
ps_result long_job_end_passes(struct long_job *job, ps_result result, struct error *error);

/* Whether another process was told to stop, or failed. */
bool long_job_was_stopped(const struct long_job *job);

/* Passes that are done in all processes. */
uint32_t long_job_passes_done(const struct long_job *job);

/* Whether the passes that are done are so many from `first` on; known where a film is kept. */
bool long_job_has_run(const struct long_job *job, uint32_t first, uint32_t passes);

/* Writes the film where one is kept and has a pass. */
ps_result long_job_write_film(struct long_job *job, struct error *error);

#endif
