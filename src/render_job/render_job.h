/* render_job.h: one render, from options and a scene to the picture and the files that were asked
 * for.
 *
 *     first pictures -> passes, and between them what is due -> picture -> files
 *
 * What is done by then is written also where the render is cancelled, or fails.
 */
#ifndef RENDER_JOB_RENDER_JOB_H
#define RENDER_JOB_RENDER_JOB_H

#include "render_job/long_job.h"

/* How a job talks to its user. Where nothing else is said, NULL or a function, which the calling
 * thread calls. */
struct render_job_callbacks {
    void *user;
    /* Of the whole render, 0..1; passes that are done; the error of indirect light by estimate,
     * negative: not known. */
    void (*progress)(void *user, const char *stage, double fraction, uint32_t passes, double error);
    void (*log)(void *user, ps_log_level level, const char *message); /* any thread; not NULL */
    bool (*cancelled)(void *user);                                    /* any thread; not NULL */
    bool (*write_now)(void *user); /* between passes: whether to write what there is; not NULL */
    void (*pass)(void *user, struct render *render, uint32_t passes);
    void (*show)(void *user, struct image *image, uint32_t passes);
    ps_result (*tile)(void *user, struct rectangle tile, struct image *part, struct error *error);
};

struct render_job {
    /* Of the caller, borrowed. */
    const struct render_options *options; /* of a process beside the first, without files */
    const struct scene_description *description;
    const struct scene *scene;
    struct processes *processes; /* NULL: this one is alone */
    const struct render_job_callbacks *callbacks;
    struct render_settings *settings; /* made of the options, with the trace */
    struct statistics *statistics;
    double start;       /* when the time of the budget began, clock.h */
    bool is_text;       /* the scene is no file, so that no command repeats the picture */
    bool wants_picture; /* the caller, beside files */
    /* While it runs. */
    struct long_job passes;
    bool has_stopped; /* passes were cancelled; their picture is made all the same */
};

/* Lays over the settings what of a picture is made for others to see. */
void render_job_set_wishes(const struct render_job *job, struct render_settings *settings);

/* Renders. The picture, which is 0 x 0 where there is none, is the caller's; of a tiled render
 * there is none. `passes`: how many it has. Results are those of render_run, and of the files. */
ps_result render_job_run(struct render_job *job, struct image *image, uint32_t *passes,
                         struct error *error);

/* --- for its own parts
 * ------------------------------------------------------------------------------- */

/* Renders tile by tile, straight into the files: those appear where there is a tile and they can be
 * written. */
ps_result render_job_tiled(struct render_job *job, const struct render_callbacks *callbacks,
                           struct error *error);

/* What render_run makes, with pictures before it where they are wanted. */
ps_result render_job_progressively(struct render_job *job, const struct render_callbacks *callbacks,
                                   struct image *image, struct error *error);

#endif
