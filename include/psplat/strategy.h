/* strategy.h: what each kind of strategy does, as a table of functions.
 *
 * The pipeline (Hoet 2014, chapter 3):
 *
 *     injection -> stratification -> estimator(visibility, filter)
 *               -> film -> normalization -> denoiser
 *
 * and, for display alone: bloom -> tonemap
 *
 * Callbacks work on batches. [worker]: called on several threads at once, so `state` is const and
 * results may depend only on the arguments; [main thread]: called once at a time. Arrays are
 * borrowed for the call. A function that can fail returns a ps_result, and tells why by host->fail.
 *
 * Each table begins with its own size, by which psplat knows which members a module was built with:
 * a member that it does not have counts as 0. "Optional": may be NULL.
 */
#ifndef PSPLAT_STRATEGY_H
#define PSPLAT_STRATEGY_H

#include <psplat/host.h>
#include <psplat/param.h>

/* --- injection ------------------------------------------------------------------------------- */

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
    /* Optional. Makes what emit needs in this pass and keeps it in the state, which no other
     * callback uses meanwhile. Before path_count and emit, in each pass whose photons are asked
     * for; passes may not depend on each other. [main thread] */
    ps_result (*prepare)(void *state, const ps_host *host, const ps_pass *pass);
} ps_injection_vtable;

#define PS_PATH_CHUNK 256

/* --- stratification -------------------------------------------------------------------------- */

/* A photon, by its index, under a key by which a stratification sorts. */
typedef struct ps_key_entry {
    uint64_t key;
    uint64_t index;
} ps_key_entry;

/* The strata of a batch of photons: stratum i is entries[starts[i]] to entries[starts[i + 1] - 1].
 * Photons without an entry stay as they are, and each has one entry at most. The memory is the
 * host's; starts[0] is 0, as are all numbers, when the stratification begins to fill them. */
typedef struct ps_strata {
    uint32_t size;
    uint32_t reserved;
    ps_key_entry *entries; /* room for as many as there are photons */
    ps_key_entry *spare;   /* as large, for sorting; it may change places with `entries` */
    size_t entry_count;
    size_t *starts; /* room for one more than there are photons */
    size_t count;
    /* How the photons of a stratum merge: into as many as `per_stratum` (0: as 1) where there are
     * as many, and no more than `most` (0: any number) into one. */
    uint64_t per_stratum, most;
} ps_strata;

#define PS_NO_STRATUM UINT64_MAX

typedef struct ps_stratification_vtable {
    uint32_t size;
    /* 1: stratify sees all photons of a pass at once; 0: batch by batch, which bounds memory. */
    uint32_t whole_pass;
    /* Optional; without, every photon stays. Sorts n photons into strata, which psplat merges: all
     * of a stratum whose normals agree become one, with the power of all. A photon whose
     * `merged` becomes 0 is dropped; nothing else may change. The parameters `representative` and
     * `normal_angle` are psplat's. [main thread] */
    ps_result (*stratify)(const void *state, const ps_host *host, const ps_pass *pass,
                          ps_photon *photons, size_t n, ps_strata *strata);
    /* Optional; without, there are no pictures of strata. The numbers of the strata that `count`
     * points lie in, given the strata that stratify made of a pass; PS_NO_STRATUM where nothing
     * would merge. [main thread] */
    ps_result (*find_strata)(const void *state, const ps_host *host, const ps_strata *strata,
                             const ps_vec3 *points, size_t count, uint64_t *numbers);
} ps_stratification_vtable;

/* --- visibility ------------------------------------------------------------------------------ */

/* Which rays of a bundle pass. A table without functions lights everything inside of a splat's
 * footprint. With depth maps, psplat adds the parameters `resolution` and `bias`; the parameters of
 * the footprint are psplat's for all. */
typedef struct ps_visibility_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Optional. Depth maps of n bundles: texel (i, j), u along i, at depths[(b * resolution + j) *
     * resolution + i]: the depth t at which its ray ends, INFINITY where it meets nothing. The
     * texel's centre is ps_texel_centre. 1 <= resolution <= PS_MOST_TEXELS. [worker] */
    void (*depth_maps)(const void *state, const ps_host *host, const ps_bundle *bundles, size_t n,
                       uint32_t resolution, float *depths);
    /* Optional, instead of depth maps. Whether the bundle lights each of n points inside of the
     * splat's footprint that face the light; lit[i] becomes 1 or 0. The points were moved off their
     * surfaces like origins of rays that leave them, so nothing at the point itself is in the way.
     * Points before the start plane are lit. [worker] */
    void (*visible)(const void *state, const ps_host *host, const ps_bundle *bundle,
                    const ps_vec3 *points, size_t n, uint8_t *lit);
} ps_visibility_vtable;

#define PS_MOST_TEXELS 64

/* --- filter ---------------------------------------------------------------------------------- */

typedef struct ps_filter_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Radial weight for squared radii r2 in [0, 1), any scale, >= 0: the core tabulates and
     * normalizes it. [main thread] */
    void (*weigh)(const void *state, const float *r2, float *weights, size_t n);
} ps_filter_vtable;

/* --- estimator ------------------------------------------------------------------------------- */

#define PS_ESTIMATOR_SHARES_PLACES 1u /* see ps_pass.shares_places */
#define PS_ESTIMATOR_RADIANCE 2u      /* ps_tile.radiance_r, radiance_g and radiance_b are there */
/* Since 1.7: what a tile gets is the same where the others are not there; so that a part of the
 * picture may be rendered alone. Without, --crop is refused. What depends on all of the picture is
 * had by for_each_picture_tile and tile_surfaces. */
#define PS_ESTIMATOR_CROPS 4u
/* Since 1.8: it splats onto the picture in every scene, so that there has to be memory for what
 * splats light. What others splat is taken for caustics, and is kept from denoisers in pictures of
 * one pass. */
#define PS_ESTIMATOR_SPLATS 8u
#define PS_ESTIMATOR_VARIANCE 16u /* since 1.17: it sets ps_tile.variance */

typedef struct ps_estimator_vtable {
    uint32_t size;
    uint32_t flags; /* PS_ESTIMATOR_... */
    /* Adds the pass's indirect light and its weight to the tiles. The result must depend on this
     * pass alone: other passes may be rendered on other machines, or in another order. What is kept
     * in the state lasts through the render. [main thread] */
    ps_result (*accumulate)(void *state, const ps_host *host, const ps_pass *pass);
    /* Optional. Once, before the first pass; `pass` describes it. [main thread] */
    ps_result (*begin)(void *state, const ps_host *host, const ps_pass *pass);
    /* Optional. After each pass that was accumulated; the tiles hold its light, short-range light
     * and all. [main thread] */
    ps_result (*end_pass)(void *state, const ps_host *host, const ps_pass *pass);
    /* Optional. Once, after the last pass, if begin was called and succeeded. [main thread] */
    void (*end)(void *state, const ps_host *host);
    /* Since 1.8: bytes that accumulate() allocates at a time, for each pixel; see
     * ps_denoiser_vtable. */
    uint64_t pixel_bytes;
} ps_estimator_vtable;

/* --- normalization --------------------------------------------------------------------------- */

/* The sums of a render's passes, or of half of them, a value for each pixel, row-major. */
typedef struct ps_film_view {
    uint32_t size;
    uint32_t passes;
    uint64_t pixel_count;
    const float *color_r, *color_g,
        *color_b; /* indirect radiance: albedo / pi * irradiance, and what was added as radiance */
    const float *weight;
    const float *coverage; /* passes in which the pixel saw a surface */
} ps_film_view;

#define PS_NORMALIZATION_CROPS 1u /* since 1.7: what a pixel gets depends on its own sums alone */

typedef struct ps_normalization_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Indirect radiance of every pixel; anything where the weight is 0. [main thread] */
    ps_result (*resolve)(const void *state, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b);
    uint64_t flags; /* since 1.7: PS_NORMALIZATION_... */
} ps_normalization_vtable;

/* --- denoiser -------------------------------------------------------------------------------- */

/* An image with the averaged G-buffer beside it, row-major. */
typedef struct ps_image_view {
    uint32_t size;
    uint32_t width, height;
    uint32_t passes;
    float *r, *g, *b; /* indirect radiance, or direct (PS_DENOISER_DIRECT), to change in place */
    /* radiance = albedo / pi * irradiance: the diffuse reflectance times the throughput of mirrors
     * and glass before it. Where the path met a glossy or partly mirroring surface: that surface's
     * reflectance over all lobes, and its normal, position and depth, since what it mirrors differs
     * from sample to sample. */
    const float *albedo_r, *albedo_g, *albedo_b;
    const float *normal_x, *normal_y, *normal_z;
    const float *position_x, *position_y, *position_z;
    const float *depth;  /* INFINITY where nothing is seen */
    const float *weight; /* sum over the passes of what the estimator weighed the light with */
    /* Passes in which a surface was seen, at the end of the way by mirrors and glass. */
    const float *coverage;
    /* Where the table asks for them, else NULL: object and material of the first pass, PS_NO_OBJECT
     * where nothing is seen; and the indirect radiance of the even and of the odd passes alone,
     * whose difference tells the noise: NULL, too, where there is one pass. Of direct light they
     * are by halves of the shadow rays of each pass, or by even and odd passes; see
     * PS_DENOISER_DIRECT. */
    const uint32_t *object, *material;
    const float *even_r, *even_g, *even_b, *odd_r, *odd_g, *odd_b;
    /* Since 1.3: the share of the albedo that is not diffuse, but gloss that mirrors by chance.
     * NULL: none anywhere. */
    const float *gloss;
    /* Since 1.3: to be filled in where it is not NULL, which takes PS_DENOISER_ERROR: how far the
     * mean of a pixel's three channels is likely to be off, noise and blur together, in W/(m^2 sr).
     * It is 0 before. */
    float *error;
    float odd_share; /* since 1.4: of the samples, how many are in odd_r, _g, _b: 0..1 */
    /* Since 1.13: camera samples of a pixel at an edge, in each pass. Where there are several,
     * their indirect light is the mean of what the pixels around, up to two away, found on the same
     * surfaces: its noise is not a pixel's own. */
    uint32_t edge_samples;
    /* Since 1.17, where the table asks for it: the variance of the mean of the three channels of
     * the indirect irradiance, (W/m^2)^2, which tells the noise of some pixels in a single pass; 0:
     * it is not known. NULL where the estimator tells none, and where there are several passes. */
    const float *variance;
} ps_image_view;

/* Whether a pixel has light to denoise: false where nothing is seen, or a mirror alone with nothing
 * behind. Of such a mirror albedo, normal, position and depth are told, but what it shows has no
 * noise. */
static inline int ps_image_has_surface(const ps_image_view *image, size_t pixel)
{
    return image->depth[pixel] < INFINITY &&
           (image->coverage[pixel] > 0.0f || (image->gloss && image->gloss[pixel] > 0.0f));
}

#define PS_DENOISER_IDS 1u    /* ps_image_view.object and material are there */
#define PS_DENOISER_HALVES 2u /* ps_image_view.even_r to odd_b are there */
/* Since 1.1. filter() is called a second time, for the direct light that surfaces reflect, with
 * halves of it: of the shadow rays of each pass, or of the passes where there is but one ray; and
 * for all direct light that gloss mirrors, with halves of a pixel's camera samples, or of the
 * passes. Not where neither has noise, nor where the scene asks for one ray and one pass, or for
 * the discontinuity buffer. */
#define PS_DENOISER_DIRECT 4u

#define PS_DENOISER_ERROR 8u /* since 1.3: filter() fills in ps_image_view.error */

#define PS_DENOISER_VARIANCE 16u /* since 1.17: ps_image_view.variance is there */

typedef struct ps_denoiser_vtable {
    uint32_t size;
    uint32_t flags; /* PS_DENOISER_... */
    /* Optional; without, the picture stays as it is. Filters in place. `psplat resolve` calls it
     * without a scene: of the services, camera and project know what they did, rays meet nothing,
     * and there are no lights. [main thread] */
    ps_result (*filter)(const void *state, const ps_host *host, const ps_image_view *image);
    /* Since 1.8: bytes that filter() allocates at a time, for each pixel. Where they are not there,
     * the render is refused before it begins. */
    uint64_t pixel_bytes;
    /* Since 1.11. Optional, beside filter(): filters several images of one picture, at most
     * PS_DENOISER_IMAGES, which differ in their light, its halves and `error` alone. Results are
     * those of filter() for each. [main thread] */
    ps_result (*filter_all)(const void *state, const ps_host *host, const ps_image_view *images,
                            uint32_t count);
    /* Since 1.11: that it allocates for each pixel of each image beside the first. */
    uint64_t image_bytes;
} ps_denoiser_vtable;

#define PS_DENOISER_IMAGES 3u

/* --- bloom and tonemap ----------------------------------------------------------------------- */

/* Since 1.5. A copy of the picture on its way to a display, row-major, to change in place: linear,
 * with the primaries of Rec. 709. Radiance times 2 to the power of the exposure, so that 1 is the
 * brightest that the display shows; not negative, and at most 1e15. No layer of radiance is made of
 * it. */
typedef struct ps_display_view {
    uint32_t size;
    uint32_t width, height;
    uint32_t reserved;
    float *r, *g, *b;
} ps_display_view;

/* `psplat view` calls these tables without a scene: rays meet nothing, there are no lights, and the
 * camera is none. */

typedef struct ps_bloom_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Optional; without, the picture stays as it is. Spreads light, before the tone map; makes
     * none. [main thread] */
    ps_result (*spread)(const void *state, const ps_host *host, const ps_display_view *picture);
} ps_bloom_vtable;

/* The parameter `exposure` is psplat's. */
typedef struct ps_tonemap_vtable {
    uint32_t size;
    uint32_t reserved;
    /* Optional; without, values stay as they are. Brings them to 0..1; psplat takes what is above
     * as 1, and applies the sRGB transfer function of PNG pictures. [main thread] */
    ps_result (*map)(const void *state, const ps_host *host, const ps_display_view *picture);
} ps_tonemap_vtable;

#endif
