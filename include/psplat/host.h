/* host.h: the services that psplat gives to plugins.
 *
 * A plugin links neither Embree nor OpenMP nor anything of psplat: everything it needs comes through this
 * table. Words used below. [main thread]: the thread that drives the render; [any thread]: also
 * from inside a parallel_for body or a callback that is marked [worker]. "Borrowed until X": the
 * host owns it.
 */
#ifndef PSPLAT_HOST_H
#define PSPLAT_HOST_H

#include <psplat/types.h>

typedef struct ps_host ps_host;

typedef enum ps_log_level { PS_LOG_DEBUG = 0, PS_LOG_INFO = 1, PS_LOG_WARNING = 2 } ps_log_level;

/* One stream of random numbers for each purpose; streams are independent. A plugin takes purposes
 * from PS_STREAM_PLUGIN upwards for needs of its own. */
typedef enum ps_stream {
    PS_STREAM_PIXEL = 0, /* jitter of a pixel */
    PS_STREAM_EMISSION = 1,
    PS_STREAM_BOUNCE = 2,
    PS_STREAM_SPLAT = 3, /* rotation of a splat's frame */
    PS_STREAM_PATH = 4,  /* path tracing */
    PS_STREAM_VIEW = 5,  /* mirrors and glass between camera and surface */
    PS_STREAM_LIGHT = 6, /* points of area lights */
    PS_STREAM_PLUGIN = 64
} ps_stream;

/* How large a splat is and where its box begins: the parameters that every visibility shares
 * (PS_FOOTPRINT_PARAMS in strategy.h gives the rows). Scene units. */
typedef struct ps_footprint_settings {
    double
        radius; /* R, half the side of the box; 0: automatic, by the scene, its light and the paths */
    double
        bandwidth_scale; /* R is at most bandwidth_scale * distance travelled, or 0.3 * radius (0.6 *
                               radius after the first bounce), or the interleaved pixels, whichever is
                               largest; 0: no limit. Pixels of a full bundle choose for themselves: see
                               ps_splat */
    double depth;        /* how far the box reaches past the first hit; 0: R tan(theta) + R */
    double step_back;    /* see step_back_rule */
    int32_t step_back_rule; /* 0: auto, min(d, R tan(theta) + R/2); 1: full, from the photon; -1:
                               step_back */
    int32_t
        boundary_correction; /* 1: full bundles make up for what walls beside their photon keep back */
    double max_merge_scale; /* where photons were merged, R is multiplied by min(sqrt(merged),
                               max_merge_scale); at most 1: not at all */
} ps_footprint_settings;

/* What the estimator works on in one pass. */
typedef struct ps_pass {
    uint32_t size;
    uint32_t number;     /* from 0 */
    uint64_t seed;       /* of the render */
    uint32_t tile_count; /* tiles of the G-buffer */
    uint32_t thread_count;
    float surface_offset;   /* how far to move a ray's origin off the surface it leaves, along the
                             normal */
    uint32_t specular;      /* 1: some surface mirrors, shines by gloss or refracts */
    uint32_t shares_places; /* 1: several photons may leave one place without much harm */
    uint32_t bounces;       /* diffuse surfaces that light may meet before the one that is seen: at
                               least 1; PS_ALL_BOUNCES: as many as it likes */
} ps_pass;

#define PS_ALL_BOUNCES UINT32_MAX

#define PS_MOST_INTERLEAVE 8

/* A body of parallel_for: item `index`, on worker `worker` < thread_count. */
typedef void (*ps_body)(void *user, uint64_t index, uint32_t worker);

struct ps_host {
    uint32_t size;      /* sizeof(ps_host) of the running psplat */
    uint32_t abi_minor; /* of the running psplat */
    void *core;         /* the host's own */

    /* Memory, 64-byte aligned, not zeroed, counted in the statistics under `what` (a literal). NULL
     * when out of memory. release takes what allocate gave, or NULL. [any thread] */
    void *(*allocate)(const ps_host *host, size_t bytes, const char *what);
    void (*release)(const ps_host *host, void *memory);

    /* Calls body for every index in [0, count), in any order on the render's threads, and returns
     * when all are done. Results must not depend on the worker. Not to be nested. [main thread] */
    void (*parallel_for)(const ps_host *host, uint64_t count, ps_body body, void *user);

    /* Calls body for every tile (index < pass's tile_count), like parallel_for, telling the
     * progress. PS_CANCELLED, with tiles left out, when the user wants to stop. [main thread,
     * inside accumulate] */
    ps_result (*for_each_tile)(const ps_host *host, ps_body body, void *user);

    /* First hit of each ray, with the surface's diffuse reflectance. [any thread] */
    void (*intersect)(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits);

    /* Whether something lies on each ray between tnear and tfar: 1 or 0. [any thread] */
    void (*occluded)(const ps_host *host, const ps_ray *rays, size_t n, uint8_t *blocked);

    /* Traces packets; see ps_packet. The fastest way where 16 rays run close together and side by side, in
     * 4x4 blocks rather than rows: `coherent` then is 1. Where they run apart, 0 is faster; either
     * gives the same. [any thread] */
    void (*intersect_packets)(const ps_host *host, ps_packet *packets, size_t n, int coherent);

    /* Four numbers in [0,1) for each index, from the Owen-scrambled Sobol sequence of `stream`
     * (values of ps_stream); `set` chooses independent groups of four dimensions, for example the
     * bounce. A pure function of (seed, stream, set, index): the pass belongs into the index. [any
     * thread] */
    void (*samples)(const ps_host *host, uint32_t stream, uint32_t set, const uint64_t *indices,
                    size_t n, float (*samples)[4]);

    /* Starts light paths: chooses lights by power, and for each gives the ray and the power (W)
     * that it would carry if it were the only one; divide by the number of paths. The first two
     * numbers choose the direction, the others the light and the point on it. Zero power where there
     * are no lights. [any thread] */
    void (*emit_light)(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                       ps_rgb *power);

    /* How each surface that was met sends light on, or takes it from: by the surface's own
     * distribution, with four numbers each. Only for hits at finite distance. [any thread] */
    void (*scatter)(const ps_host *host, ps_direction direction, const ps_ray *rays,
                    const ps_hit *hits, const float (*samples)[4], size_t n,
                    ps_bsdf_sample *scattered);

    /* Radiance (W/(m^2 sr)) that the lights' light, reflected once by what each ray met, sends back
     * along the ray; shadow rays included, mirrors and glass left out: what they show is emission.
     * `stream`, `set` and `indices` as for samples, drawn only where lights have a size. [any
     * thread] */
    void (*direct_radiance)(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                            uint32_t stream, uint32_t set, const uint64_t *indices, size_t n,
                            ps_rgb *radiance);

    /* Radiance (W/(m^2 sr)) that what each ray met, be it the sky, emits along it. `pdfs`: those of
     * the scatterings that the rays come from; where a pdf is not 0, the radiance is weighed against
     * direct_radiance's own sampling at the ray's origin (Veach and Guibas 1995). [any thread] */
    void (*emitted_radiance)(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                             const float *pdfs, size_t n, ps_rgb *radiance);

    /* Centre and radius of the sphere around the scene. [any thread] */
    void (*scene_bounds)(const ps_host *host, ps_vec3 *center, float *radius);

    /* Boxes around the first hits of photons: the geometry that every visibility shares (frame,
     * size that follows distance or, of full bundles, holds what all pixels take, step-back, walls
     * beside the photon). Automatic sizes go by the pass's number of paths and by where the lights' light
     * lands, which begin_splats or next_photons finds out. A hit at INFINITY gives half_width 0, unless a
     * full bundle meets something beside its axis. After begin_splats, those that may light nothing in view
     * get half_width 0 too. [any thread] */
    void (*place_footprints)(const ps_host *host, const ps_footprint_settings *settings,
                             const ps_photon *photons, const ps_hit *hits, size_t n,
                             ps_splat *splats);

    /* The pass's next batch of photons, injected and stratified, in the order of emission; n is 0 after
     * the last. `progress` becomes the share of the pass's paths that are done, 0..1. Borrowed until
     * the next call. [main thread, inside accumulate] */
    ps_result (*next_photons)(const ps_host *host, const ps_photon **photons, size_t *n,
                              double *progress);

    /* Carries photons to the surfaces they light, by the chosen visibility. [main thread, inside
     * accumulate] */
    ps_result (*place_splats)(const ps_host *host, const ps_photon *photons, size_t n,
                              ps_splat *splats);

    /* Prepares the pass's splatting; before its first place_splats. A splat will light only the pixels
     * of one of n x n interleaved subsets, n^2 times as strongly, and what neighbouring pixels learned
     * is joined at the end of the pass; n <= PS_MOST_INTERLEAVE, 0: by the picture's size and the number of
     * paths. The n of the render's first pass holds for all. [main thread, inside accumulate] */
    ps_result (*begin_splats)(const ps_host *host, uint32_t n);

    /* After begin_splats: adds the light of splats to the tiles: depth maps by the chosen visibility,
     * weights by the chosen filter. Irradiance += power * K * V * max(0, -n.w), weight += merged * K *
     * V, which the tiles have when the pass ends; bitwise the same for any number of threads and any
     * batching. Cuts the splats' depth ranges. [main thread, inside accumulate] */
    ps_result (*splat)(const ps_host *host, ps_splat *splats, size_t n);

    /* Tile `index` of the pass; one worker at a time may write to it. Borrowed until the pass ends.
     * [any thread] */
    ps_tile *(*tile)(const ps_host *host, uint32_t index);

    /* The picture's column and row of lane `lane` of tile `tile`; 0 if it lies outside. [any
     * thread] */
    int32_t (*pixel)(const ps_host *host, uint32_t tile, uint32_t lane, uint32_t *x, uint32_t *y);

    /* One line, no newline. [any thread] */
    void (*log)(const ps_host *host, ps_log_level level, const char *message);

    /* Adds to a named counter (a literal) of the statistics. [main thread] */
    void (*count)(const ps_host *host, const char *counter, double amount);

    /* Tells how much of the pass's estimate is done, 0..1. [main thread] */
    void (*progress)(const ps_host *host, double fraction);

    /* Non-zero when the user wants to stop: return PS_CANCELLED soon. [any thread] */
    int32_t (*cancelled)(const ps_host *host);

    /* Where the camera stands, and the direction of the middle of its picture. [any thread] */
    void (*camera)(const ps_host *host, ps_vec3 *position, ps_vec3 *direction);

    /* How many lights there are; below they go by their index. They are the same in all passes.
     * [any thread] */
    uint32_t (*light_count)(const ps_host *host);

    /* Describes a light. [any thread] */
    void (*light)(const ps_host *host, uint32_t index, ps_light *light);

    /* Intensity (W/sr) of a PS_LIGHT_POINT in n unit directions away from it; black for the other
     * kinds. [any thread] */
    void (*light_intensity)(const ps_host *host, uint32_t index, const ps_vec3 *directions,
                            size_t n, ps_rgb *intensity);

    /* Like emit_light for one light: rays that leave it, and the power (W) that each would carry if
     * it were the only one. The first two of the four numbers choose the direction, the others the
     * point on the light; of sun and sky, the point on a disc that is as large as the scene, in
     * equal areas. [any thread] */
    void (*emit_from)(const ps_host *host, uint32_t index, const float (*samples)[4], size_t n,
                      ps_ray *rays, ps_rgb *power);

    /* From now on in this pass place_footprints leaves short-range light out, by ps_splat.blend_distance: what surfaces that
     * lights shine on reflect, diffusely and only once, over less than two and a half half-widths of the
     * boxes, automatic or given, which splats would blur; the less of it, the farther it comes from. It is
     * found by short rays instead, so many for a pixel in the middle of a surface and those that it is
     * averaged with; 0: as many as find it about as well as the pass's splats find the rest. When the
     * pass ends it is added to the tiles, without weight. Does nothing where bundles don't start at their
     * photons and follow the distance. After begin_splats, before place_splats. [main thread, inside
     * accumulate] */
    ps_result (*gather_short_range)(const ps_host *host, double rays);
};

#endif
