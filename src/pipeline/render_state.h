/* render_state.h: a render in progress; shared by the driver, its host table and its last stages.
 */
#ifndef PIPELINE_RENDER_STATE_H
#define PIPELINE_RENDER_STATE_H

#include "film/film.h"
#include "pipeline/render.h"
#include "pipeline/sources.h"
#include "splat/splatter.h"

struct render {
    const struct scene *scene;
    struct render_settings *settings;
    const struct render_callbacks *callbacks;
    struct statistics *statistics;
    struct trace *trace;
    struct gbuffer gbuffer;
    struct film film;
    struct source_stream sources;
    struct kernel_variant kernel;
    struct splatter splatter; /* made when an estimator first splats */
    bool has_splatter;
    ps_pass pass;
    ps_host host;
    struct error error; /* why a host function failed in this pass */
};

/* Fills render->host with the services of host.c. */
void host_create(struct render *render);

/* Adds the splatter's counters to the statistics. */
void host_report_splatter(struct render *render);

/* Of a picture with all layers. */
size_t picture_bytes(size_t width, size_t height);

/* Film to image: normalization, ambient fallback, denoiser, combination. Uses up the film. */
ps_result resolve_image(struct render *render, struct image *image, struct error *error);

#endif
