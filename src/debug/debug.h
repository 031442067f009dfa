/* debug.h: pictures of what goes on inside of a render, after the figures of Hoet 2014.
 *
 * Each view looks at the first pass, through the centres of the pixels, with the strategies that
 * the render would use; the driver does the work, and a view only looks (render_inspect).
 */
#ifndef DEBUG_DEBUG_H
#define DEBUG_DEBUG_H

#include "debug/canvas.h"
#include "render/state.h"

struct debug_options {
    double exposure;     /* of what shows light, in stops */
    uint32_t count;      /* photons, maps or sources at most; 0: the view's default */
    uint32_t resolution; /* cells across the scene; 0: the view's default */
    double top;          /* upper end of a scale; 0: by what there is */
    bool by_bounce;      /* photons coloured by bounce, not by power */
    bool has_pixel;      /* else that in the middle of the picture */
    uint32_t pixel[2];   /* column and row, whose light is explained */
};

struct debug_view {
    const char *name;
    const char *const *parts; /* names of single pictures, up to a NULL; NULL: none */
    /* Creates the canvas and draws; `part` is an index into parts, or -1. */
    ps_result (*draw)(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error);
};

/* What was asked for: "VIEW" or "VIEW:PART". */
struct debug_request {
    const struct debug_view *view;
    int part; /* -1: all */
    struct debug_options options;
};

/* Fills in view and part; PS_ERROR_INVALID, and what there is, for a name that is none. */
ps_result debug_find(const char *name, struct debug_request *request, struct error *error);

/* Draws into `canvas`, which the caller releases; empty on an error. The rest as in
 * render_inspect. */
ps_result debug_draw(const struct debug_request *request, const struct scene *scene,
                     struct render_settings *settings, const struct render_callbacks *callbacks,
                     struct statistics *statistics, struct canvas *canvas, struct error *error);

extern const struct debug_view debug_photons, debug_voxels, debug_gbuffer, debug_maps,
    debug_overlap, debug_pixel;

#endif
