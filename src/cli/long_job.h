/* long_job.h: what a render does between its passes: budgets, pictures and films on the way, what it resumes. */
#ifndef CLI_LONG_JOB_H
#define CLI_LONG_JOB_H

#include "base/lock_file.h"
#include "cli/command.h"
#include "cli/output_list.h"
#include "film/film_sum.h"
#include "job/schedule.h"
#include "pipeline/render.h"
#include <signal.h>

/* Rows for a command's table. */
#define LONG_JOB_OPTIONS                                                                           \
    {0, "passes", "N|A:B",                                                                         \
     "number of passes, which smooth edges and lessen noise; or those from A to before B"},        \
        {0, "time", "TIME", "passes until so much time is used up: 90, 90s, 10m, 2h"},             \
        {0, "error", "PERCENT", "passes until the indirect light is no farther off, by estimate"}, \
        {0, "write-every", "TIME", "write the picture so far after the first pass, then so often"}, \
        {0, "checkpoint", "FILE.exr", "keep the film in FILE, to resume, merge or resolve"},       \
        {0, "checkpoint-every", "TIME", "how often, beside the end; default: 60s"},                \
    {                                                                                              \
        0, "resume", NULL, "go on with the film of --checkpoint, where there is one"               \
    }

struct long_job {
    bool has_passes, is_shard; /* --passes; A:B */
    uint32_t first, end;       /* of --passes */
    const char *checkpoint;    /* NULL: no film is kept */
    bool resume;
    struct schedule schedule;
    /* While it runs. */
    struct film_sum film;   /* with `checkpoint` */
    struct image facts;     /* of the film */
    struct lock_file lock;  /* on the checkpoint */
    uint32_t passes_before; /* in the film that was resumed */
    uint32_t passes_seen;   /* when the schedule last looked */
    bool film_failed;       /* a checkpoint could not be written, and that was said */
    enum image_compression compression;
    struct workers *workers; /* borrowed, as those that follow */
    bool quiet;
    volatile sig_atomic_t *write_now; /* set by a signal */
    ps_result (*write_picture)(void *user, struct image *image, struct error *error);
    void *user;
};

/* Takes those of the arguments that are its options. False, printed, where one is wrong, or they do not go
 * together. */
bool long_job_take(struct long_job *job, const struct argument *arguments, size_t count);

/* Whether passes go on until a budget is used up. */
bool long_job_has_budget(const struct long_job *job);

/* Lays the passes over the settings. False, printed, where the denoiser does not tell the error that is asked
 * for. */
bool long_job_set_passes(const struct long_job *job, struct render_settings *settings);

/* Locks the checkpoint, and reads it where it is to be resumed. */
ps_result long_job_begin(struct long_job *job, const struct scene_description *description,
                         const struct scene *scene, const struct render_settings *settings,
                         struct error *error);

/* See render_callbacks.go_on. */
bool long_job_goes_on(struct long_job *job, struct render *render);

/* Writes the film where one is kept and has a pass. */
ps_result long_job_write_film(struct long_job *job, struct error *error);

void long_job_release(struct long_job *job);

#endif
