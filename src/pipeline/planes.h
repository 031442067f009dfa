/* planes.h: what a render keeps of each pixel, in the G-buffer, the film and the sums of its
 * passes.
 *
 * What nobody looks at costs memory, and time in each pass; so it depends on the strategies, on the
 * scene and on who wants the result. The driver makes what this says (render_create.c), and knows
 * what that takes beforehand (memory.c).
 */
#ifndef PIPELINE_PLANES_H
#define PIPELINE_PLANES_H

#include "film/gbuffer.h"
#include "render/settings.h"
#include "scene/scene.h"

struct planes {
    bool sums;                 /* of several passes, or of the caller's film */
    bool surfaces;             /* film: FILM_ALBEDO_R to FILM_VISIBLE */
    bool gloss;                /* the first glossy surfaces, and FILM_GLOSS */
    bool discontinuity_buffer; /* G-buffer: room for it */
    bool edges;                /* pixels that take several samples */
    bool splats;               /* what pixels get by splats, with short-range light */
    bool caustics;             /* what they get by splats of caustics alone; G-buffer: apart */
    bool geometric;   /* G-buffer: geometric normals beside smoothed or bent ones, for splats */
    bool direct_half; /* G-buffer: direct light by half of the shadow rays */
    bool hard;        /* G-buffer: light that casts hard shadows */
    bool radiance;    /* G-buffer: indirect radiance */
    bool ids;         /* film: objects and materials */
    bool odd;         /* film: indirect light of the odd passes */
    bool variance;    /* film: variance of the irradiance */
    bool splatted;    /* film: light of these splats apart, too */
    /* Film: direct light that is reflected, with that of hard shadows apart, and its halves: of
     * each pass, and of the passes (the odd ones). */
    bool reflected, reflected_hard, halves_of_pass, halves_of_passes;
};

/* `sums`: the render sums passes; `keeps_film`: for the caller, whose film has what any denoiser
 * asks for. Without a scene only what any scene needs. */
struct planes planes_wanted(const struct render_settings *settings, const struct scene *scene,
                            bool sums, bool keeps_film);

/* The tiles of the picture, or of those around the part that is rendered. */
struct gbuffer planes_layout(const struct render_settings *settings, size_t width, size_t height);

/* The picture, or the part. */
struct rectangle planes_window(const struct render_settings *settings, size_t width, size_t height);

#endif
