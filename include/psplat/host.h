/* host.h: the services that psplat gives to plugins.
 *
 * A plugin links neither Embree nor OpenMP nor anything of psplat: everything it needs comes
 * through this table. Words used below. [main thread]: the thread that drives the render; [any
 * thread]: also from inside a parallel_for body or a callback that is marked [worker]. "Borrowed
 * until X": the host owns it. [estimator]: for estimators, inside of accumulate. [tiles]: for
 * estimators, from begin to end. A call out of place, or with an index that does not exist, does
 * nothing but make the callback that it comes from fail, with a message that names the service.
 */
#ifndef PSPLAT_HOST_H
#define PSPLAT_HOST_H

#include <psplat/types.h>

typedef struct ps_host ps_host;

typedef enum ps_log_level { PS_LOG_DEBUG = 0, PS_LOG_INFO = 1, PS_LOG_WARNING = 2 } ps_log_level;

/* Streams of random numbers, independent of each other. The first ones have a purpose; from
 * PS_STREAM_PLUGIN upwards each kind of strategy has streams of its own, so that plugins cannot
 * share one by chance. */
typedef enum ps_stream {
    PS_STREAM_PIXEL = 0, /* jitter of a pixel */
    PS_STREAM_EMISSION = 1,
    PS_STREAM_BOUNCE = 2,
    PS_STREAM_SPLAT = 3,      /* rotation of a splat's frame */
    PS_STREAM_PATH = 4,       /* path tracing */
    PS_STREAM_VIEW = 5,       /* mirrors and glass between camera and surface */
    PS_STREAM_LIGHT = 6,      /* points of area lights */
    PS_STREAM_ESTIMATOR = 64, /* choices of the estimator */
    PS_STREAM_MERGE = 80,     /* which photon of a stratum stays */
    PS_STREAM_PLUGIN = 1024
} ps_stream;

/* What a strategy works on in one pass. */
typedef struct ps_pass {
    uint32_t size;
    uint32_t number;        /* from 0 */
    uint64_t seed;          /* of the render */
    uint32_t passes;        /* of the render, at most: a budget may end it sooner */
    uint32_t tile_count;    /* tiles of the picture (PS_ESTIMATOR_CROPS) */
    uint32_t width, height; /* of the picture */
    uint32_t thread_count;
    float surface_offset;   /* how far to move a ray's origin off the surface it leaves, along the
                             normal */
    uint32_t specular;      /* 1: some surface mirrors, reflects glossily or refracts */
    uint32_t shares_places; /* 1: several photons may leave one place without much harm */
    uint32_t bounces;       /* diffuse surfaces that light may meet before the one that is seen: at
                               least 1; PS_ALL_BOUNCES: as many as it likes */
    /* Since 1.9: of so many parts of the picture, rendered one after the other with all of their
     * passes between begin and end, this is number `part`. What goes by the whole picture may be
     * kept for the same pass of the next part. */
    uint32_t part, parts;
} ps_pass;

#define PS_ALL_BOUNCES UINT32_MAX

#define PS_MOST_INTERLEAVE 8

/* A body of parallel_for: item `index`, on worker `worker` < thread_count. */
typedef void (*ps_body)(void *user, uint64_t index, uint32_t worker);

struct ps_host {
    uint32_t size;      /* sizeof(ps_host) of the running psplat */
    uint32_t abi_minor; /* of the running psplat */
    void *core;         /* the host's own */

    /* --- the plugin itself --- */

    /* A table of optional services by its name, such as PS_CELLS_EXTENSION, or NULL where this
     * psplat has none of that name. Its header states the type. Borrowed for ever. [any thread] */
    const void *(*extension)(const ps_host *host, const char *name);

    /* Why a callback fails, or must be taken to have failed if it has no result: one line, which
     * the user sees after the plugin's kind and name. The first one counts. Returns `result`, or
     * PS_ERROR_INVALID in place of PS_OK. [any thread] */
    ps_result (*fail)(const ps_host *host, ps_result result, const char *why);

    /* Memory, 64-byte aligned, not zeroed, counted in the statistics under `what` (a literal). NULL
     * when out of memory. release takes what allocate gave, or NULL. [any thread] */
    void *(*allocate)(const ps_host *host, size_t bytes, const char *what);
    void (*release)(const ps_host *host, void *memory);

    /* One line, no newline. [any thread] */
    void (*log)(const ps_host *host, ps_log_level level, const char *message);

    /* Adds to a named counter (a literal) of the statistics. [main thread] */
    void (*count)(const ps_host *host, const char *counter, double amount);

    /* Tells how much of the pass's estimate is done, 0..1. [main thread] */
    void (*progress)(const ps_host *host, double fraction);

    /* Non-zero when the user wants to stop: return PS_CANCELLED soon. [any thread] */
    int32_t (*cancelled)(const ps_host *host);

    /* Calls body for every index in [0, count), in any order on the render's threads, and returns
     * when all are done. Results must not depend on the worker. Not to be nested. [main thread] */
    void (*parallel_for)(const ps_host *host, uint64_t count, ps_body body, void *user);

    /* Four numbers in [0,1) for each index, from the Owen-scrambled Sobol sequence of `stream`
     * (values of ps_stream); `set` chooses independent groups of four dimensions, for example the
     * bounce. A pure function of (seed, stream, set, index): the caller makes the pass number part
     * of the index. [any thread] */
    void (*samples)(const ps_host *host, uint32_t stream, uint32_t set, const uint64_t *indices,
                    size_t n, float (*samples)[4]);

    /* --- rays --- */

    /* First hit of each ray, with the surface's diffuse reflectance. A ray with a member that is no
     * number meets nothing, and is counted. [any thread] */
    void (*intersect)(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits);

    /* Whether something lies on each ray between tnear and tfar: 1 or 0. [any thread] */
    void (*occluded)(const ps_host *host, const ps_ray *rays, size_t n, uint8_t *blocked);

    /* Shortens tfar of each ray to its first hit. The fastest way where 16 rays run close together
     * and side by side, in 4x4 blocks rather than rows: `coherent` then is 1. Where they run apart,
     * 0 is faster; either gives the same. [any thread] */
    void (*intersect_packets)(const ps_host *host, ps_ray_packet *packets, size_t n, int coherent);

    /* --- surfaces --- */

    /* How each surface that was met sends light on, or takes it from: by the surface's own
     * distribution, with four numbers each. Only for hits at finite distance, as intersect() set
     * them: what they reflect diffusely towards the ray is their albedo. [any thread] */
    void (*sample_bsdf)(const ps_host *host, ps_direction direction, const ps_ray *rays,
                        const ps_hit *hits, const float (*samples)[4], size_t n,
                        ps_bsdf_sample *sampled);

    /* What each surface that was met scatters from a direction away from it into the one that its
     * ray came out of: the light runs backwards along the ray (PS_FROM_CAMERA), or along the ray
     * and on in that direction (PS_FROM_LIGHT). Hits as for sample_bsdf. [any thread] */
    void (*evaluate_bsdf)(const ps_host *host, ps_direction direction, const ps_ray *rays,
                          const ps_hit *hits, const ps_vec3 *directions, size_t n,
                          ps_bsdf_value *values);

    /* Radiance (W/(m^2 sr)) that the lights' light, reflected once by what each ray met, sends back
     * along the ray; shadow rays included, mirrors and glass left out: what they show is emission.
     * `stream`, `set` and `indices` as for samples, drawn only where there are area lights. [any
     * thread] */
    void (*direct_radiance)(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                            uint32_t stream, uint32_t set, const uint64_t *indices, size_t n,
                            ps_rgb *radiance);

    /* Radiance (W/(m^2 sr)) that what each ray met, be it the sky, emits along it. `pdfs`: those of
     * the scatterings that the rays come from; where a pdf is not 0, the radiance is weighed
     * against direct_radiance's own sampling at the ray's origin (Veach and Guibas 1995). [any
     * thread] */
    void (*emitted_radiance)(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                             const float *pdfs, size_t n, ps_rgb *radiance);

    /* --- lights --- */

    /* Starts light paths. A light is chosen by its power or, where a pilot of camera paths has run,
     * also by its contribution to the picture. Each ray carries the power (W) that it would have if
     * it were the only one: divide by the number of paths. The first two numbers choose the
     * direction, the others the light and the point on it. Zero power where there are no lights.
     * [any thread] */
    void (*emit_light)(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                       ps_rgb *power);

    /* How many lights there are; below they go by their index. They are the same in all passes.
     * [any thread] */
    uint32_t (*light_count)(const ps_host *host);

    /* Describes a light; light->size is set by the caller. [any thread] */
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

    /* For each of n places, a light chosen with the third of four numbers, and a point of it by the
     * first two, as seen from there; nothing is traced. Few lights are chosen by power, many by the
     * light BVH, from bounds on their contribution at the place (suns and skies by power). With
     * many lights `irradiance` is divided by the exact probabilities of that choice; `probability`
     * and `pdf` are then stand-ins that only MIS weights may use (light_densities). Irradiance 0
     * where there is no light, or the point does not shine there. [any thread] */
    void (*sample_light)(const ps_host *host, const ps_vec3 *places, const float (*samples)[4],
                         size_t n, ps_light_sample *sampled);

    /* --- the scene and its picture --- */

    /* Centre and radius of the sphere around the scene. [any thread] */
    void (*scene_bounds)(const ps_host *host, ps_vec3 *center, float *radius);

    /* How many triangles the scene has in world space: meshes, instances one by one, and for each
     * sphere PS_SPHERE_TRIANGLES of about its area. [any thread] */
    uint64_t (*triangle_count)(const ps_host *host);

    /* Triangles `first` and on, in a fixed order; returns how many of n there were. [any thread] */
    size_t (*triangles)(const ps_host *host, uint64_t first, size_t n, ps_triangle *triangles);

    /* The camera; camera->size is set by the caller. [any thread] */
    void (*camera)(const ps_host *host, ps_camera *camera);

    /* Where in the picture points show, in pixels from its upper left corner, be it outside of the
     * picture or behind something; NAN behind the camera. [any thread] */
    void (*project)(const ps_host *host, const ps_vec3 *points, size_t n, float (*pixels)[2]);

    /* The picture's column and row of lane `lane` of tile `tile`; 0 if it lies outside. [any
     * thread, tiles] */
    int32_t (*pixel)(const ps_host *host, uint32_t tile, uint32_t lane, uint32_t *x, uint32_t *y);

    /* The other way: tile and lane of a pixel; 0 if it lies outside, or its tile is not there. [any
     * thread, tiles] */
    int32_t (*tile_of)(const ps_host *host, uint32_t x, uint32_t y, uint32_t *tile, uint32_t *lane);

    /* Tile `index` of the picture; one worker at a time may write to it. Borrowed until the pass
     * ends. Where a part of the picture is rendered, those that are not there are all one, which
     * sees nothing: never write to it. [any thread, tiles] */
    ps_tile *(*tile)(const ps_host *host, uint32_t index);

    /* The surfaces that the pixels of a tile show, as intersect tells them, PS_TILE_PIXELS each,
     * and the rays that met them, behind mirrors and glass: view directions are those of the rays,
     * backwards. Lanes that see nothing have a hit without an object. The paths from the camera are
     * traced again, also those of tiles that are not there. [any thread, estimator] */
    void (*tile_hits)(const ps_host *host, uint32_t index, ps_ray *rays, ps_hit *hits);

    /* Calls body for every tile that is there (index < pass's tile_count), like parallel_for,
     * telling the progress. PS_CANCELLED, with tiles left out, when the user wants to stop. [main
     * thread, estimator] */
    ps_result (*for_each_tile)(const ps_host *host, ps_body body, void *user);

    /* --- photons and splats --- */

    /* The light paths of the pass, which the injection prepares if it has not yet. [main thread,
     * estimator] */
    ps_result (*path_count)(const ps_host *host, uint64_t *paths);

    /* The pass's next batch of photons, injected and stratified, in the order of emission; n is 0
     * after the last. `progress` becomes the share of the pass's paths that are done, 0..1.
     * Borrowed until the next call. [main thread, estimator] */
    ps_result (*next_photons)(const ps_host *host, const ps_photon **photons, size_t *n,
                              double *progress);

    /* Prepares the pass's splatting; before its first splat. A splat will light only the pixels of
     * one of n x n interleaved subsets, n^2 times as strongly, and what neighbouring pixels learned
     * is joined at the end of the pass; n <= PS_MOST_INTERLEAVE, 0: by the picture's size and the
     * number of paths. The n of the render's first pass holds for all. [main thread, estimator] */
    ps_result (*begin_splats)(const ps_host *host, uint32_t n);

    /* After begin_splats: carries photons to the surfaces that they light, and adds their light to
     * the tiles there, by the chosen visibility and filter. Irradiance += power * K * V * max(0,
     * -n.w), weight += merged * K * V, which the tiles have when the pass ends; bitwise the same
     * for any number of threads and any batching. [main thread, estimator] */
    ps_result (*splat)(const ps_host *host, const ps_photon *photons, size_t n);

    /* From now on in this pass splats leave short-range light out: what surfaces that lights shine
     * on reflect, diffusely and only once, over less than two and a half radii of the splats,
     * automatic or given, which splats would blur; the less of it, the farther it comes from. It is
     * found by short rays instead, so many for a pixel in the middle of a surface and those that it
     * is averaged with; 0: as many as find it about as well as the pass's splats find the rest.
     * When the pass ends it is added to the tiles, without weight. Does nothing where bundles don't
     * start at their photons and follow the distance. After begin_splats, before splat. [main
     * thread, estimator] */
    ps_result (*gather_short_range)(const ps_host *host, double rays);

    /* Since 1.2: splats onto n > 0 points that are no pixels, such as surfels of a cache. Normals
     * have length 1 and lie on the side that is lit. Fastest where points that follow each other
     * lie close together; see ps_cells.key. Until end_points, which has to be called before the
     * next begin_points; a pass that ends earlier forgets them. [main thread, estimator] */
    ps_result (*begin_points)(const ps_host *host, const ps_vec3 *positions, const ps_vec3 *normals,
                              size_t n);

    /* After begin_points: like splat, but what the photons light are the points, and all of the
     * light comes by splats. [main thread, estimator] */
    ps_result (*splat_points)(const ps_host *host, const ps_photon *photons, size_t n);

    /* Writes the irradiance (W/m^2) of each of the points, in their order. [main thread,
     * estimator] */
    ps_result (*end_points)(const ps_host *host, ps_rgb *irradiance);

    /* --- densities of light paths --- */

    /* Since 1.5: as emit_light, and tells where the rays start: position, normal, light and
     * probability of each point; its distance is INFINITY for sun and sky, and its other members
     * are 0. [any thread] */
    void (*emit_points)(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                        ps_rgb *power, ps_light_sample *points);

    /* Since 1.5: the light that an object is; PS_NO_LIGHT: it does not shine. [any thread] */
    uint32_t (*light_of_object)(const ps_host *host, uint32_t object);

    /* Since 1.5: 1 where the camera sees an object if nothing is in between; 0: the scene hides it
     * from the camera. [any thread] */
    int32_t (*is_shown)(const ps_host *host, uint32_t object);

    /* Since 1.5: the densities of points of lights, as each is seen from its place. Of the
     * points, direction, distance, normal (on the side that is seen) and light count. At
     * distance INFINITY the densities of all that shine from that direction are summed, and the
     * light may be PS_NO_LIGHT, but for a sun without an angle. 0 for a light that does not
     * exist. [any thread] */
    void (*light_densities)(const ps_host *host, const ps_vec3 *places,
                            const ps_light_sample *points, size_t n, ps_light_density *densities);

    /* --- points of surfaces --- */

    /* Since 1.6: the surfaces at points of triangles, as intersect tells them, and rays at right
     * angles to the triangles that meet them there; of a sphere, where it lies above or below its
     * triangle. Object PS_NO_OBJECT, at distance INFINITY, where the surface has a hole, or there
     * is no such triangle. [any thread] */
    void (*surface_points)(const ps_host *host, const ps_surface_point *points, size_t n,
                           ps_ray *rays, ps_hit *hits);

    /* --- the whole picture, where a part of it is rendered (PS_ESTIMATOR_CROPS) --- */

    /* Since 1.7: like for_each_tile, for every tile of the picture, be it there or not. [main
     * thread, estimator] */
    ps_result (*for_each_picture_tile)(const ps_host *host, ps_body body, void *user);

    /* Since 1.7: `tile`, of `size` bytes as the caller knows it, becomes what the pixels of tile
     * `index` of the picture see, be it there or not, without light; its radiance is NULL. The
     * paths from the camera are traced where it is not there. [any thread, estimator] */
    void (*tile_surfaces)(const ps_host *host, uint32_t index, size_t size, ps_tile *tile);

    /* --- several walks over the picture --- */

    /* Since 1.10: what `progress` and the walks over tiles tell from now on, as 0..1 each, is the
     * part from `from` to `to` of the pass's estimate. All of it, 0 to 1, as each pass begins.
     * [main thread, estimator] */
    void (*progress_part)(const ps_host *host, double from, double to);

    /* --- cones --- */

    /* Since 1.12: as intersect, where each ray stands for a cone around it: what it meets has the
     * mean colours of pictures and of noise over the width of the cone, `spreads` times the
     * distance. 0 is the ray alone; ps_cone_spread says how much a direction drawn by a density
     * stands for. [any thread] */
    void (*intersect_cones)(const ps_host *host, const ps_ray *rays, const float *spreads, size_t n,
                            ps_hit *hits);

    /* --- light of some lights --- */

    /* Since 1.14: as direct_radiance, of the lights of some groups alone: `groups`, bits of
     * ps_light_group, for each ray; NULL: of all. Those of one hit draw the same numbers, whatever
     * groups are asked for. [any thread] */
    void (*direct_radiance_of)(const ps_host *host, const ps_ray *rays, const ps_hit *hits,
                               const uint8_t *groups, uint32_t stream, uint32_t set,
                               const uint64_t *indices, size_t n, ps_rgb *radiance);

    /* --- mirrors, glass and gloss --- */

    /* Since 1.16: as intersect, for paths that end at a surface that is diffuse alone: a ray that
     * meets one first, one without PS_HIT_SPECULAR, comes back as if it met nothing, which is
     * quicker. [any thread] */
    void (*intersect_specular)(const ps_host *host, const ps_ray *rays, size_t n, ps_hit *hits);
};

#define PS_SPHERE_TRIANGLES 512u

#endif
