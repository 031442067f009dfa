/* settings.h: the strategies and numbers of a render, checked.
 *
 * A scene file and the command line both speak through a render description; here its names become
 * loaded plugins and its texts values. Every problem is reported with where it was written, several
 * in one go.
 */
#ifndef RENDER_SETTINGS_H
#define RENDER_SETTINGS_H

#include "base/parallel.h"
#include "base/rectangle.h"
#include "plugin/strategy.h"
#include "scene/description.h"

struct kernel_variant;
struct trace;

struct render_settings {
    struct strategy strategies[PS_KINDS];
    uint32_t first_pass, passes; /* numbers: from the first to before `passes` */
    uint32_t bounces;            /* see ps_pass */
    bool discontinuity_buffer;   /* see discontinuity_buffer.h */
    uint32_t aa_samples;         /* of a pixel at an edge, in each pass; 1: as everywhere */
    uint64_t seed;
    double memory_limit;   /* bytes; 0: what the machine lends */
    struct rectangle crop; /* the part of the picture that is rendered; no width: all of it */
    uint32_t tile;         /* side of the parts that it is rendered in, one by one; 0: it is one */
    struct workers *workers; /* owned */
    struct trace *trace; /* over the scene, for this `isa`, borrowed; NULL: a render builds one */
    const char *isa; /* instruction set, a name of kernel.h, borrowed; NULL: the best there is */
    size_t batch;    /* splats at a time; changes memory, not the picture */
    enum direct_light direct;
    uint32_t direct_resolution; /* pixels along the side of each map of DIRECT_SHADOWMAP */
    bool picture_alone;         /* nobody wants its layers: those of surfaces may be missing */
    bool no_error_layer;        /* nobody wants the layer `error` */
    bool display;               /* somebody wants the layer `display` */
    double exposure;            /* of that layer, in stops, beside that of the tone map */
    double indirect_exposure;
    ps_rgb ambient;
};

static inline uint32_t settings_pass_count(const struct render_settings *settings)
{
    return settings->passes - settings->first_pass;
}

/* The kernel of the instruction set that is asked for, or of the best. PS_ERROR_INVALID where this
 * processor lacks it. */
ps_result settings_choose_kernel(const struct render_settings *settings,
                                 struct kernel_variant *kernel, struct error *error);

/* Whether this processor has an instruction set of that name: PS_ERROR_INVALID. */
ps_result settings_check_isa(const char *isa, struct error *error);

/* Called for each problem; `origin` has line 0 where it came from the command line. */
typedef void (*settings_report)(void *user, const struct origin *origin, const char *message);

/* Loads and fills the strategies and starts `threads` workers. After reports it returns the result
 * of the first; settings are released then. */
ps_result settings_resolve(struct loader *loader, const struct render_description *description,
                           uint32_t threads, size_t batch, settings_report report, void *user,
                           struct render_settings *settings);
void settings_release(struct render_settings *settings);

/* Lays a choice over another of the same kind: another strategy replaces it, the same one keeps the
 * parameters that the new choice does not name. Takes over what `choice` owns. */
ps_result settings_override(struct strategy_choice *base, struct strategy_choice *choice,
                            struct error *error);

/* Reads "name:key=value,key=[1, 2, 3]" into a choice that the caller releases. */
ps_result settings_parse_choice(const char *text, struct strategy_choice *choice,
                                struct error *error);

#endif
