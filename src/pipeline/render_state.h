/* render_state.h: a render in progress; shared by the driver, its host table and its last stages.
 */
#ifndef PIPELINE_RENDER_STATE_H
#define PIPELINE_RENDER_STATE_H

#include "direct/shadow_maps.h"
#include "film/film.h"
#include "gather/gathered_light.h"
#include "pipeline/photons.h"
#include "pipeline/render.h"
#include "splat/splatter.h"
#include <stdatomic.h>

/* Whether it pays to ask which splats light nothing in view (host_place.c). */
struct unseen {
    uint64_t batches; /* placed so far in the pass */
    bool asked;       /* in this batch */
    bool many;        /* of those that were last asked */
    _Atomic(uint64_t) in_batch;
};

struct render {
    const struct scene *scene;
    struct render_settings *settings;
    const struct render_callbacks *callbacks;
    struct statistics *statistics;
    struct trace *trace;
    struct shadow_maps *shadow_maps; /* for the direct light of the picture; NULL: shadow rays */
    struct gbuffer gbuffer;
    struct film film;
    bool *edges; /* pixels that take several samples (edges.h), owned; NULL: none does */
    struct photon_stream photons;
    struct kernel_variant kernel;
    struct splatter splatter; /* made when an estimator first splats */
    bool has_splatter;
    bool splatting; /* in this pass */
    struct unseen unseen;
    struct gathered_light gathered_light;
    uint32_t gather_interleave; /* over so many pixels across and down it is averaged */
    bool
        counts_splats; /* in place of the filter: tiles' weights count the splats that light them */
    ps_pass pass;
    ps_host host;
    struct error error; /* why a host function failed in this pass */
};

/* The render that a host serves. */
static inline struct render *render_of(const ps_host *host)
{
    return host->core;
}

/* Makes all that passes share, and starts the strategies; needs scene, settings, callbacks, statistics and host.
 * Whether it succeeds or not, destroy it. */
ps_result render_create(struct render *render, struct error *error);
void render_destroy(struct render *render);

/* Fills render->host with the services of host.c. */
void host_create(struct render *render);

/* Adds the splatter's counters to the statistics. */
void host_report_splatter(struct render *render);

/* Lets the estimator add the indirect light of the pass under way to the tiles. */
ps_result render_estimate(struct render *render, struct error *error);

/* Looks at a render whose first pass has all but its indirect light: the G-buffer and direct light,
 * in the tiles and, averaged, in the film. May use the host's services as an estimator does. */
typedef ps_result (*render_inspector)(void *user, struct render *render, struct error *error);

/* Starts a render of one pass, lets the inspector look, and ends it; there is no picture. Starts the
 * strategies of `settings`, which may be used once. */
ps_result render_inspect(const struct scene *scene, struct render_settings *settings,
                         const struct render_callbacks *callbacks, struct statistics *statistics,
                         render_inspector inspect, void *user, struct error *error);

/* Of a picture, less the planes that it takes over from the film. */
size_t picture_bytes(size_t width, size_t height);

/* Film to image: normalization, ambient fallback, denoiser, combination. Uses up the film. Where memory runs
 * out there is no image; where a strategy fails or is stopped, the result says so, and there is an image
 * without what it does. */
ps_result resolve_image(struct render *render, struct image *image, struct error *error);

#endif
