/* long_job.h: what a render does between its passes: budgets, pictures and films on the way, what it resumes. */
#ifndef CLI_LONG_JOB_H
#define CLI_LONG_JOB_H

#include "base/lock_file.h"
#include "cli/command.h"
#include "cli/output_list.h"
#include "film/film_sum.h"
#include "job/schedule.h"
#include "job/team.h"
#include "pipeline/render.h"
#include "session/pass_range.h"
#include <signal.h>

/* Rows for a command's table. */
#define LONG_JOB_OPTIONS                                                                           \
    {0, "passes", "N|A:B",                                                                         \
     "number of passes, which smooth edges and lessen noise; or those from A to before B"},        \
        {0, "time", "TIME", "passes until so much time is used up: 90, 90s, 10m, 2h"},             \
        {0, "error", "PERCENT", "passes until the indirect light is no farther off, by estimate"}, \
        {0, "write-every", "TIME",                                                                 \
         "write the picture so far after the first pass, then so often"},                          \
        {0, "checkpoint", "FILE.exr", "keep the film in FILE, to resume, merge or resolve"},       \
        {0, "checkpoint-every", "TIME", "how often, beside the end; default: 60s"},                \
        {0, "resume", NULL, "go on with the film of --checkpoint, where there is one"},            \
    {                                                                                              \
        0, "mpi", NULL, "share the passes with the other processes that mpirun started"            \
    }

struct long_job {
    struct pass_range range; /* --passes */
    const char *checkpoint;  /* NULL: no film is kept */
    bool resume;
    bool wants_mpi;
    struct schedule schedule;
    /* While it runs. */
    struct transport transport; /* size 0: none */
    struct team *team;          /* NULL: this process is alone, or the team has ended */
    bool has_agreed;            /* or disagreed, with the others */
    int muted;                  /* standard error, while it leads nowhere; negative: it does not */
    struct film_sum film;       /* with `checkpoint`, or others */
    struct image facts;         /* of the film */
    struct lock_file lock;      /* on the checkpoint */
    uint32_t passes_before;     /* in the film that was resumed */
    uint32_t passes_seen;       /* when the schedule last looked */
    bool film_failed;           /* a checkpoint could not be written, and that was said */
    enum image_compression compression;
    struct workers *workers; /* borrowed, as those that follow */
    bool quiet;
    volatile sig_atomic_t *write_now; /* set by a signal */
    ps_result (*write_picture)(void *user, struct image *image, uint32_t passes,
                               struct error *error);
    void (*show_picture)(void *user, const struct image *image); /* where the schedule shows */
    void *user;
};

/* Takes those of the arguments that are its options; --passes is taken already. False, printed, where one is wrong, or
 * they do not go together. */
bool long_job_take(struct long_job *job, const struct argument *arguments, size_t count,
                   const struct pass_range *passes);

/* Whether passes go on until a budget is used up. */
bool long_job_has_budget(const struct long_job *job);

/* Lays a budget's passes over the settings. False, printed, where the denoiser does not tell the error that is asked
 * for. */
bool long_job_set_passes(const struct long_job *job, struct render_settings *settings);

/* Whether this process writes files and shows how far the job is. */
bool long_job_is_first(const struct long_job *job);

/* Joins the other processes, where --mpi asks for it. False, printed, where that fails. */
bool long_job_join(struct long_job *job);

/* Whether the render needs the job's film. */
bool long_job_keeps_film(const struct long_job *job);

/* Locks the checkpoint, and reads it where it is to be resumed; sees to it that all processes have the same job. An
 * error without a text is another process's to tell. */
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

/* Parts from the other processes, whatever became of the job; after all else. */
void long_job_leave(struct long_job *job);

/* Writes the film where one is kept and has a pass. */
ps_result long_job_write_film(struct long_job *job, struct error *error);

void long_job_release(struct long_job *job);

#endif
