/* strategy.h: what each kind of strategy does, as a table of functions.
 *
 * The pipeline (Hoet 2014, chapter 3):
 *
 *     injection -> stratification -> estimator(visibility, filter)
 *               -> film -> normalization -> denoiser
 *
 * Callbacks work on batches. [worker]: called on several threads at once, so `state` is const and
 * results may depend only on the arguments; [main thread]: called once at a time. Arrays are
 * borrowed for the call.
 */
#ifndef PSPLAT_STRATEGY_H
#define PSPLAT_STRATEGY_H

#include <psplat/host.h>
#include <psplat/param.h>

/* Takes the photons that an injection makes; copies them. Returns PS_OK or PS_ERROR_MEMORY. */
typedef struct ps_photon_sink {
    void *core;
    ps_result (*append)(void *core, const ps_photon *photons, size_t n);
} ps_photon_sink;

typedef struct ps_injection_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Light paths in a pass; automatic sizes go by it. [main thread] */
    uint64_t (*path_count)(const void *state);
    /* Makes the photons of paths [first, first + n), n <= PS_PATH_CHUNK, of the pass, in an order
     * that depends on these alone. Any run of paths has to be a fair part of the pass: runs share
     * out the pixels (host->begin_splats). [worker] */
    ps_result (*emit)(const void *state, const ps_host *host, const ps_pass *pass, uint64_t first,
                      size_t n, const ps_photon_sink *sink);
    /* Makes what emit needs in this pass and keeps it in the state, which no other callback uses
     * meanwhile. Before path_count and emit, in each pass whose photons are asked for; passes may
     * not depend on each other. May be NULL. [main thread] */
    ps_result (*prepare)(void *state, const ps_host *host, const ps_pass *pass);
} ps_injection_vtable;

#define PS_PATH_CHUNK 256

typedef struct ps_stratification_vtable {
    uint32_t size;
    /* 1: combine sees all photons of a pass at once; 0: batch by batch, which bounds memory. */
    uint32_t whole_pass;
    /* Combines neighbours in place: the first *n entries of `photons` become the result, *n
     * shrinks. The sum of powers must stay. [main thread] */
    ps_result (*combine)(const void *state, const ps_host *host, const ps_pass *pass,
                         ps_photon *photons, size_t *n);
    /* Numbers the cells that `count` points lie in, for pictures of them: photons of the same number
     * are those that combine would make one, given these n of the pass, but for their normals and for
     * limits on how many; PS_NO_CELL where it would merge none. May be NULL: there are no cells.
     * [main thread] */
    ps_result (*cells)(const void *state, const ps_host *host, const ps_pass *pass,
                       const ps_photon *photons, size_t n, const ps_vec3 *points, size_t count,
                       uint64_t *numbers);
    uint32_t keeps_all; /* 1: combine leaves all as it is; see ps_pass.shares_places */
    uint32_t reserved;
} ps_stratification_vtable;

#define PS_NO_CELL UINT64_MAX

typedef struct ps_visibility_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Texels along the side of a depth map, 1..64; 0: no maps. [main thread] */
    uint32_t (*resolution)(const void *state);
    /* Boxes of photons whose first hits are known; usually host->place_footprints. [worker] */
    void (*place)(const void *state, const ps_host *host, const ps_photon *photons,
                  const ps_hit *hits, size_t n, ps_splat *splats);
    /* Depth maps of n splats: texel (i, j), u along i, at depths[(s * resolution + j) * resolution
     * + i]; the depth along axis_w relative to the centre, INFINITY where nothing was hit. NULL
     * where resolution is 0. [worker] */
    void (*depth_maps)(const void *state, const ps_host *host, const ps_splat *splats, size_t n,
                       float *depths);
    /* For a visibility of resolution 0: whether the bundle lights each of n points inside of the
     * splat's box that face the light; lit[i] becomes 1 or 0. The points were moved off their
     * surfaces like origins of rays that leave them, so nothing at the point itself is in the way.
     * What lies before the start plane, but was not left out by the core, is lit.
     * NULL where depth maps decide, or everything inside a box is lit. [worker] */
    void (*visible)(const void *state, const ps_host *host, const ps_splat *splat,
                    const ps_vec3 *points, size_t n, uint8_t *lit);
    /* The settings by which all boxes are placed with host->place_footprints. NULL: they are placed otherwise;
     * then splats leave out no short-range light. [main thread] */
    ps_footprint_settings (*boxes)(const void *state);
} ps_visibility_vtable;

typedef struct ps_filter_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Radial weight for squared radii r2 in [0, 1), any scale, >= 0: the core tabulates and
     * normalizes it. [main thread] */
    void (*weigh)(const void *state, const float *r2, float *weights, size_t n);
} ps_filter_vtable;

typedef struct ps_estimator_vtable {
    uint32_t size;
    uint32_t shares_places; /* see ps_pass */
    /* Adds the pass's indirect irradiance and weight to the tiles. [main thread] */
    ps_result (*accumulate)(const void *state, const ps_host *host, const ps_pass *pass);
} ps_estimator_vtable;

/* The sums of a render's passes, a value for each pixel, row-major. */
typedef struct ps_film_view {
    uint32_t size;
    uint32_t passes;
    uint64_t pixel_count;
    const float *color_r, *color_g,
        *color_b; /* reflected indirect radiance: albedo / pi * irradiance */
    const float *weight;
    const float *coverage; /* passes in which the pixel saw a surface */
} ps_film_view;

typedef struct ps_normalization_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Indirect radiance of every pixel; anything where the weight is 0. [main thread] */
    ps_result (*resolve)(const void *state, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b);
} ps_normalization_vtable;

/* An image with the averaged G-buffer beside it, row-major. */
typedef struct ps_image_view {
    uint32_t size;
    uint32_t width, height;
    uint32_t reserved;
    float *r, *g, *b; /* indirect radiance, to change in place */
    const float *albedo_r, *albedo_g, *albedo_b;
    const float *normal_x, *normal_y, *normal_z;
    const float *position_x, *position_y, *position_z;
    const float *depth; /* INFINITY where nothing is seen */
} ps_image_view;

typedef struct ps_denoiser_vtable {
    uint32_t size;
    uint32_t keeps_all; /* 1: filter leaves all as it is, and may miss planes of surfaces */
    /* Filters in place. [main thread] */
    ps_result (*filter)(const void *state, const ps_host *host, const ps_image_view *image);
} ps_denoiser_vtable;

/* The rows that every visibility shares; the plugin's state holds PS_FOOTPRINT_MEMBERS. */
#define PS_FOOTPRINT_MEMBERS                                                                       \
    ps_number_or_choice radius;                                                                    \
    double bandwidth_scale;                                                                        \
    ps_number_or_choice depth;                                                                     \
    ps_number_or_choice step_back;                                                                 \
    double max_merge_scale;                                                                        \
    int32_t boundary_correction;

#define PS_FOOTPRINT_CHOICES                                                                       \
    static const char *const box_auto[] = {"auto", NULL};                                          \
    static const char *const box_step_back[] = {"auto", "full", NULL};

#define PS_FOOTPRINT_PARAMS(state, step_back_default, boundary_correction_default)                 \
    PS_NUMBER_OR(                                                                                  \
        state, radius, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN, box_auto, "scene units",            \
        "radius of a splat; auto: by the scene, its light and the number of light paths"),         \
        PS_NUMBER(state, bandwidth_scale, "0.6", 0, INFINITY, PS_PARAM_EXPERT, "",                 \
                  "limit of the radius, down to a part of it or to the interleaved pixels, as a "  \
                  "fraction of "                                                                   \
                  "the distance travelled; 0: none"),                                              \
        PS_NUMBER_OR(state, depth, "auto", 0, INFINITY, PS_PARAM_OPEN_MIN | PS_PARAM_EXPERT,       \
                     box_auto, "scene units",                                                      \
                     "reach of the box past the first hit; auto: what the hit's slope needs"),     \
        PS_NUMBER_OR(                                                                              \
            state, step_back, step_back_default, 0, INFINITY, PS_PARAM_EXPERT, box_step_back,      \
            "scene units",                                                                         \
            "start of the box before the first hit; auto: by its slope, full: the photon"),        \
        PS_NUMBER(state, max_merge_scale, "1.5", 1, INFINITY, PS_PARAM_EXPERT, "",                 \
                  "limit of the growth of the radius, sqrt(photons merged into one); 1: none"),    \
        PS_ROW(state, boundary_correction, PS_PARAM_BOOL, boundary_correction_default, 0, 1,       \
               PS_PARAM_EXPERT, NULL, "",                                                          \
               "full bundles make up for the part that walls beside their photon keep back")

/* The parameters as host->place_footprints wants them. */
#define PS_FOOTPRINT_SETTINGS(state)                                                               \
    (ps_footprint_settings)                                                                        \
    {                                                                                              \
        .radius = (state)->radius.number, .bandwidth_scale = (state)->bandwidth_scale,             \
        .depth = (state)->depth.number, .step_back = (state)->step_back.number,                    \
        .step_back_rule = (state)->step_back.choice, .max_merge_scale = (state)->max_merge_scale,  \
        .boundary_correction = (state)->boundary_correction                                        \
    }

#endif
