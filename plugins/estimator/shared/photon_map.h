/* photon_map.h: photons where they arrive or leave, and the irradiance that the nearest of them
 * give.
 *
 * Jensen 1996. The k nearest photons estimate the irradiance, with r the distance of the k-th:
 *
 *     E(p) = sum over photons nearer than r of Phi * w(d / r) / (pi r^2 W)
 *     W    = 2 * integral of w(s) s ds over 0..1
 *
 * No cosine: the photons' density in the surface already falls with the slope of the light, unlike
 * a splat's kernel, which lies across the bundle. The k-th photon sets r and is not counted itself,
 * or the estimate would be k / (k - 1) too large. Neighbourhoods are discs: photons off the tangent
 * plane weigh less, and those that arrive from behind the surface nothing.
 *
 * FLANN's single kd-tree is exact and deterministic; its default parameters are neither. Its
 * searches only read the index, and the one global that a call touches is the log level, always
 * with the same value, so tiles are searched on all threads at once.
 */
#ifndef PSPLAT_ESTIMATOR_PHOTON_MAP_H
#define PSPLAT_ESTIMATOR_PHOTON_MAP_H

#include <psplat/plugin.h>

#include <flann/flann.h>

enum photon_filter { PHOTON_FILTER_BOX, PHOTON_FILTER_CONE, PHOTON_FILTER_GAUSSIAN };

struct stored_photon;

struct photon_map {
    const ps_host *host;
    float *positions; /* three for each photon: what FLANN searches */
    struct stored_photon *photons;
    size_t count, capacity;
    flann_index_t index;
    struct FLANNParameters parameters;
    int neighbours;   /* that are searched, at most `count` */
    int *indices;     /* room for the neighbours of a tile's points, for each worker */
    float *distances; /* squared */
};

/* Photons higher above the tangent plane than this times r do not count. */
#define PHOTON_MAP_FLATNESS 0.25f

/* How photons near a point become irradiance. */
struct photon_estimate {
    int32_t filter;   /* enum photon_filter */
    float max_radius; /* photons farther away do not count; INFINITY: all do */
    float shrink;     /* r is so many times the distance of the k-th photon, 0..1 */
};

/* Which end of the photons' ways is stored. */
enum photon_end {
    PHOTONS_ARRIVE, /* where their light lands */
    /* Where it leaves diffuse surfaces, with the power that leaves: for final gathering. */
    PHOTONS_LEAVE
};

/* Begins a map of no photons. Release it, whatever comes of it. */
void photon_map_begin(const ps_host *host, struct photon_map *map);
void photon_map_release(struct photon_map *map);

ps_result photon_map_add(struct photon_map *map, const ps_pass *pass, enum photon_end end,
                         const ps_photon *photons, size_t n);

/* Ends it, for `neighbours` photons to an estimate. A map of fewer than two photons, which can't
 * tell a density, has no estimate: its `index` is NULL. */
ps_result photon_map_build(struct photon_map *map, const ps_pass *pass, int64_t neighbours);

/* All of this with all photons of the pass; warns where there are fewer than two. */
ps_result photon_map_create(const ps_host *host, const ps_pass *pass, enum photon_end end,
                            int64_t neighbours, struct photon_map *map);

/* Where photon i lies, and the normal of the surface there. */
ps_vec3 photon_map_position(const struct photon_map *map, size_t i);
ps_vec3 photon_map_normal(const struct photon_map *map, size_t i);

/* The `n` photons next to a point, nearest first; n is at most the map's `neighbours`. Any
 * thread. */
void photon_map_nearest(const struct photon_map *map, ps_vec3 position, int n, int *indices);

/* Irradiance, or exitance where photons leave, in W/m^2, at up to PS_TILE_PIXELS points; and r of
 * each, where `radii` is not NULL. */
void photon_map_estimate(const struct photon_map *map, const struct photon_estimate *how,
                         uint32_t worker, const ps_vec3 *positions, const ps_vec3 *normals,
                         size_t n, ps_rgb *irradiance, float *radii);

/* Adds the irradiance at all pixels. */
ps_result photon_map_light_pixels(const struct photon_map *map, const struct photon_estimate *how);

#endif
