/* state.h: a render in progress: what the driver, the services to plugins and the debug views
 * share. */
#ifndef RENDER_STATE_H
#define RENDER_STATE_H

#include "base/statistics.h"
#include "direct/shadow_maps.h"
#include "film/film_sum.h"
#include "importance/importance.h"
#include "render/callbacks.h"
#include "render/photons.h"
#include "render/settings.h"
#include "short_range/short_range_light.h"
#include "splat/splatter.h"
#include "view/view.h"
#include <stdatomic.h>

/* The services as one strategy has them. */
struct strategy_host {
    ps_host host;
    struct render *render;
    ps_kind kind;            /* PS_KINDS: psplat itself */
    _Atomic(int64_t) blocks; /* of memory that it has now */
};

/* Why the callback under way fails; the first reason counts. */
struct failure {
    bool named;        /* whose fault it is stands in `why` */
    atomic_flag taken; /* set by whoever writes the reason */
    _Atomic(bool) there;
    ps_result result;
    char why[1024];
};

/* What strategies made that is no number, or negative, and was left out. */
struct refused {
    _Atomic(uint64_t) rays[PS_KINDS + 1]; /* by who asked for them */
    uint64_t photons[2];                  /* of the injection, and of the stratification */
    uint64_t pixels[5]; /* of estimator, normalization, denoiser, bloom, tone map */
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
    /* Of the passes; NULL where there is one pass, which the film itself holds. */
    struct film_sum *sum;
    struct film_sum own_sum; /* where the caller has none; owned */
    bool unfinished; /* the film holds a pass without its indirect light, or without smooth edges */
    double dark_pixels;   /* of the last picture: without weight */
    uint8_t *edges;       /* pixels that take several samples (edges.h), owned; NULL: none does */
    uint32_t part, parts; /* see ps_pass */
    struct photon_stream photons;
    /* Made when light paths are first asked for, or before, where pixels need it. */
    struct importance importance;
    bool has_importance;
    struct kernel_variant kernel;
    struct splatter splatter; /* onto pixels; made when an estimator first splats */
    struct splatter points;   /* onto points, from begin_points to end_points */
    struct splat *placed;     /* room for a batch of splats; owned, as the splatters */
    bool has_splatter, has_points;
    bool splatting; /* onto pixels in this pass */
    struct gathered_light gathered_light;
    uint32_t gather_interleave; /* over so many pixels across and down it is averaged */
    /* In place of the filter: tiles' weights count the splats that light them. */
    bool counts_splats;
    ps_pass pass;
    float jitter[2]; /* where in its pixels the pass looks */
    struct strategy_host hosts[PS_KINDS + 1];
    ps_tile nowhere; /* what a plugin gets in place of a tile that is not there */
    float nowhere_radiance[3][PS_TILE_PIXELS];
    /* Which services are in place. */
    bool has_tiles, estimating;
    double progress_from, progress_to; /* see ps_host.progress_part */
    _Atomic(bool) looping;             /* in a parallel_for */
    bool has_begun;                    /* the estimator */
    struct failure failure;
    struct refused refused;
};

/* The render that a host serves. */
static inline struct render *render_of(const ps_host *host)
{
    return ((const struct strategy_host *)host->core)->render;
}

static inline ps_kind kind_of(const ps_host *host)
{
    return ((const struct strategy_host *)host->core)->kind;
}

/* psplat's own. */
static inline const ps_host *own_host(const struct render *render)
{
    return &render->hosts[PS_KINDS].host;
}

static inline struct strategy *strategy_in(const struct render *render, ps_kind kind)
{
    return &render->settings->strategies[kind];
}

/* Share of the render that is done, with so much of the pass under way. */
double render_fraction(const struct render *render, double of_pass);

/* How many passes the sum or the film holds. */
uint32_t render_passes_done(const struct render *render);

/* Takes the first reason why the callback under way fails; any thread. Returns `result`, or
 * PS_ERROR_INVALID in place of PS_OK. */
ps_result render_fail(struct render *render, ps_result result, const char *why);

/* The same where a service that the callback uses fails, as the error tells; user's wish to stop is
 * none. Returns `result`. */
ps_result render_pass_on(struct render *render, ps_result result, const struct error *error);

/* What became of a callback of a strategy: its result, unless it failed all the same. The error
 * then names the strategy. */
ps_result render_judge(struct render *render, ps_kind kind, ps_result result, struct error *error);

/* Makes render->importance, once a render; render->pass must be there. */
ps_result render_find_importance(struct render *render, struct error *error);

/* Adds a splatter's counters to the statistics. */
void render_report_splatter(struct statistics *statistics, const struct splatter *splatter);

/* Says what strategies made that had to be left out. */
void render_report_refused(const struct render *render);

/* Says which strategies kept memory; after they were stopped. */
void render_report_kept(const struct render *render);

#endif
