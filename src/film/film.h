/* film.h: what a pass gives, or several passes do (film_sum.h).
 *
 * Planes of float, row-major, top row first. Normalization and averaging happen when the film is
 * resolved.
 */
#ifndef FILM_FILM_H
#define FILM_FILM_H

#include "film/gbuffer.h"

enum film_plane {
    FILM_DIRECT_R,
    FILM_DIRECT_G,
    FILM_DIRECT_B, /* emitted radiance and reflected direct light, W/(m^2 sr) */
    FILM_COLOR_R,
    FILM_COLOR_G,
    FILM_COLOR_B, /* reflected indirect radiance */
    FILM_WEIGHT,  /* what the estimator weighed the indirect light with */
    FILM_ALBEDO_R,
    FILM_ALBEDO_G,
    FILM_ALBEDO_B,
    FILM_NORMAL_X,
    FILM_NORMAL_Y,
    FILM_NORMAL_Z,
    FILM_POSITION_X,
    FILM_POSITION_Y,
    FILM_POSITION_Z,
    FILM_DEPTH,
    FILM_VISIBLE,  /* sum of presence() (film_add.c): how often albedo to depth have been added */
    FILM_COVERAGE, /* passes, or shares of them, in which the camera path ended at a surface */
    /* From here on NULL where nobody asks. */
    FILM_ON_REQUEST,
    FILM_REFLECTED_R = FILM_ON_REQUEST,
    FILM_REFLECTED_G,
    FILM_REFLECTED_B, /* direct light that is reflected, or that gloss mirrors: what has noise */
    /* Direct light of lights that cast hard shadows, where these are denoised separately
     * (scene_has_hard_shadows_apart): then it is not in FILM_REFLECTED. */
    FILM_HARD_R,
    FILM_HARD_G,
    FILM_HARD_B,
    FILM_GLOSS, /* share of the albedo that is not diffuse */
    FILM_SPLATTED_R,
    FILM_SPLATTED_G,
    FILM_SPLATTED_B, /* what of FILM_COLOR was splatted, where that is known apart */
    FILM_VARIANCE, /* sum over passes of that of the irradiance, as far as the estimator knows it */
    FILM_PLANES
};

struct film {
    size_t width, height;
    struct picture_window window; /* where in the picture it lies */
    uint32_t passes;              /* that it holds */
    uint32_t number;              /* of the pass that is being added, or was last */
    float *planes[FILM_PLANES];   /* each width * height, owned */
    bool has[FILM_PLANES];        /* which of them it has, or had before they were taken */
    uint32_t *object, *material;  /* what pixels see in pass 0; owned, NULL where nobody asks */
    /* Parts of the film, owned, or NULL: `odd`, the odd passes alone; `half`, direct light by the
     * second half of each pass's shadow rays or, in gloss, of its camera samples. Their difference
     * from the whole tells the noise. */
    struct film *odd, *half;
    bool is_half; /* this is such a half */
};

/* Makes an empty film of the whole picture. To film a window, set `window` before adding tiles.
 * Without `surfaces` it keeps the light alone: planes from FILM_ALBEDO_R to FILM_DEPTH stay
 * NULL. */
ps_result film_create(size_t width, size_t height, bool surfaces, struct film *film,
                      struct error *error);
/* Makes room for objects and materials. */
ps_result film_add_ids(struct film *film, struct error *error);

/* Lets the film keep the indirect light of its odd passes apart as well. */
ps_result film_add_halves(struct film *film, struct error *error);

/* Lets it keep the direct light that is reflected apart from what is emitted. With `hard_apart`,
 * that of lights that cast hard shadows as well. */
ps_result film_add_reflected(struct film *film, bool hard_apart, struct error *error);
/* And half of that: of each pass, or of the passes (the odd ones). */
ps_result film_add_half_of_reflected(struct film *film, bool of_pass, struct error *error);

/* Lets it keep a plane that it lacks: FILM_GLOSS, FILM_SPLATTED_R to _B, or FILM_VARIANCE. */
ps_result film_add_plane(struct film *film, enum film_plane plane, struct error *error);

/* Empties the film for a pass, and makes the planes anew that were taken out of it. */
ps_result film_begin_pass(struct film *film, uint32_t number, struct error *error);

/* Whether a pixel of the picture, or any of a tile, lies in the film. */
bool film_has_pixel(const struct film *film, size_t x, size_t y);
bool film_has_tile(const struct film *film, const struct gbuffer *gbuffer, uint32_t tile);

void film_release(struct film *film);
size_t film_bytes(const struct film *film);

/* Adds what the pixels of one tile of the pass that lie in the film gathered, but for the lanes
 * that are `left_out` (NULL: none); call for every tile, then end the pass. Tiles may be added by
 * different threads at once: they touch different pixels. */
void film_add_tile(struct film *film, const struct gbuffer *gbuffer, uint32_t tile,
                   const uint8_t left_out[PS_TILE_PIXELS]);

/* Adds `share` of what each of `count` lanes of a G-buffer's only tile gathered, from lane `first`
 * on, to pixel (x, y) of the picture, whose own lane was left out. They are all of that pixel's,
 * which lies in the film. */
void film_add_samples(struct film *film, const struct gbuffer *gbuffer, uint32_t first,
                      uint32_t count, float share, size_t x, size_t y);
void film_end_pass(struct film *film);

/* Keeps which objects and materials the lanes of a tile see, where the film asks. */
void film_keep_ids(struct film *film, const struct gbuffer *gbuffer, uint32_t tile);

/* Turns the sums of geometry and direct light into means: per pass for light, per covered pass for
 * geometry. A pixel that never saw a surface gets depth INFINITY and zeros. */
void film_average(struct film *film);

#endif
