/* render_job.h: one run of psplat render: a scene as it was read becomes the files that were asked for. */
#ifndef CLI_RENDER_JOB_H
#define CLI_RENDER_JOB_H

#include "cli/long_job.h"
#include "cli/output_list.h"
#include "cli/progress.h"
#include "cli/render_arguments.h"
#include "cli/viewer.h"

struct render_job {
    struct render_arguments taken;
    struct output_list outputs;
    struct long_job passes;
    const char *stats_path;
    const char *display; /* NULL: no viewer */
    struct tev_address display_address;
    struct viewer *viewer; /* while it renders */
    enum progress_mode progress_mode;
    struct progress progress;
    bool has_stopped; /* passes ended by a signal; their picture is made all the same */
    const struct scene_description *description; /* while it renders, as those that follow */
    struct diagnostics *sink;
    struct render_settings *settings;
};

/* Lays over the settings what of a picture is made for others to see. */
void render_job_set_wishes(const struct render_job *job, struct render_settings *settings);

/* Shows the picture in the viewer. */
void render_job_show(const struct render_job *job, const struct image *image, bool is_last);

/* Renders tile by tile, straight into the files: those appear where there is a tile and they can be written. */
ps_result render_job_tiled(struct render_job *job, const struct scene *scene,
                           const struct render_callbacks *callbacks, struct statistics *statistics,
                           struct error *error);

/* What render_run makes, with pictures before it where they are wanted. */
ps_result render_job_progressively(struct render_job *job, const struct scene *scene,
                                   const struct render_callbacks *callbacks,
                                   struct statistics *statistics, struct image *image,
                                   struct error *error);

/* Renders the scene, and writes what was asked for. Returns the command's status. */
int render_job_run(struct render_job *job, struct scene_input *input);

#endif
