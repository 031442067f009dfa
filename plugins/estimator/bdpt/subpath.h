/* subpath.h: paths from the lights and from the pixels of a tile, which advance together, and their
 * partial weights.
 *
 * A whole path can be made in as many ways as it has edges, by the number of its vertices that come
 * from the light. The power heuristic (Veach 1997, section 9.2.4) weighs each way by the squares of
 * their densities. Their ratios are products along the path, so a subpath carries two sums of them
 * from vertex to vertex (van Antwerpen 2011, "A survey of importance sampling applications in
 * unbiased physically based rendering"; Georgiev 2012, "Implementing vertex connection and
 * merging"), here named as there:
 *
 *     dVCM = (p' / p)^2         p: density by area of the last vertex, p': by which the vertex
 *                               before could be connected
 *     dVC                       the same for all vertices before, over the density by solid angle
 *                               of going back
 *
 * No table over pairs of vertices is needed. A scattering by a mirror or by glass, whose densities
 * both ways are the same, cancels: no connection ends there. Russian roulette is left out of the
 * densities, on all ways alike.
 *
 * Densities that are seen from two sides have to be equal, or weights do not add up to 1: those of
 * scattering are of all lobes together (ps_bsdf_value), and areas are measured by geometric
 * normals.
 */
#ifndef PSPLAT_ESTIMATOR_SUBPATH_H
#define PSPLAT_ESTIMATOR_SUBPATH_H

#include <psplat/plugin.h>

/* What a pixel's point has to do with light tracing. */
struct sight {
    ps_vec3 normal; /* geometric */
    /* The density of the point by area as the camera draws it, over the number of light paths; 0:
     * none can be connected to the camera so that it lands there. */
    float density;
    /* Of the pixel's area, what shows surfaces that light tracing lights, 0..1; > 0 where the
     * density is. */
    float share;
};

enum bdpt_strategies { STRATEGIES_ALL, STRATEGIES_CAMERA, STRATEGIES_LIGHT };

/* A pass. */
struct bdpt {
    const ps_host *host;
    const ps_pass *pass;
    uint32_t roulette; /* bounce from which on subpaths may be ended */
    int strategies;    /* bdpt_strategies */
    float light_paths; /* for each sample of all pixels: one a pixel */
    /* Unit of areas in weights: the square of the scene's radius, so that numbers stay small. */
    float area;
    ps_camera camera;
    struct sight *sights; /* of each tile's pixels, owned */
    float jitter[2];      /* where in its square of the picture each pixel looks, 0..1 */
};

/* A subpath's end. */
struct subpath {
    /* From a light: power, W; from a pixel: what radiance is multiplied by to be its irradiance. */
    ps_rgb throughput;
    float start; /* the largest component of throughput at the start */
    /* dVCM and dVC; on the way to a vertex, what these are but for the distance and cosine
     * there. */
    float vcm, vc;
    uint32_t lane;
    uint32_t bounces; /* diffuse scatterings; that at a pixel's point does not count */
    uint32_t chain;   /* others since the last one */
};

/* Subpaths of a tile under way: ends, the rays that leave them, and what these meet. */
struct walk {
    size_t count;
    struct subpath ends[PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
};

/* A surface that a subpath met, and the ray that met it. */
struct vertex {
    struct subpath end;
    ps_ray ray;
    ps_hit hit;
};

static inline float bdpt_square(float x)
{
    return x * x;
}

/* The heuristic's weight, given the squared densities of all other ways over that of this one.
 * Where single precision does not hold them, as lengths are measured by the scene, this way is all
 * but impossible. */
static inline float bdpt_weight(float others)
{
    return others < INFINITY ? 1.0f / (1.0f + others) : 0.0f;
}

/* Whether subpaths from the lights are connected with those from pixels. */
static inline int bdpt_connects(const struct bdpt *bdpt)
{
    return bdpt->strategies == STRATEGIES_ALL;
}

/* How many more diffuse scatterings a path may have that has so many, at most 2. */
static inline uint32_t bdpt_room(const struct bdpt *bdpt, uint32_t bounces)
{
    uint32_t limit = bdpt->pass->bounces, room = bounces < limit ? limit - bounces : 0;
    return room < 2 ? room : 2;
}

/* What two surfaces scatter along a connection, and the diffuse part of each. */
struct scattering {
    ps_rgb all, diffuse;
};

/* That of a surface that a pixel's path met, given what bdpt_evaluate says of the direction. */
struct scattering bdpt_scattering(const ps_hit *hit, ps_vec3 direction, const ps_bsdf_value *value);

/* The product of both, but for what takes more diffuse scatterings than there is room for. */
ps_rgb bdpt_scattered(uint32_t room, const struct scattering *a, const struct scattering *b);

/* Where a surface is left, off it, on the side that it was met from. */
static inline ps_vec3 bdpt_origin(const struct bdpt *bdpt, const ps_hit *hit)
{
    return ps_add_scaled(hit->position, bdpt->pass->surface_offset, hit->geometric_normal);
}

/* As host->evaluate_bsdf, of a diffuse surface. What smoothed normals change of light paths (Veach
 * 1997, section 5.3) is in the value. */
ps_bsdf_value bdpt_evaluate_diffuse(ps_direction direction, const ps_ray *ray, const ps_hit *hit,
                                    ps_vec3 away);

/* As host->evaluate_bsdf, sooner where all of the surfaces are diffuse. */
void bdpt_evaluate(const struct bdpt *bdpt, ps_direction direction, const ps_ray *rays,
                   const ps_hit *hits, const ps_vec3 *directions, size_t n, ps_bsdf_value *values);

/* Diffuse reflectance towards a direction of a surface that was met from another one. */
ps_rgb bdpt_albedo_towards(const struct bdpt *bdpt, const ps_hit *hit, ps_vec3 direction);

/* Partial weights of an end that is left by a direction of that density, which the reverse way has
 * with `reverse_pdf`; pdf 0: by a mirror or glass. `cosine`: of the direction to the geometric
 * normal. */
void subpath_leave(struct subpath *end, float cosine, float pdf, float reverse_pdf);

/* Keeps a subpath in another place. */
void walk_move(struct walk *walk, size_t from, size_t to);

/* Drops subpaths that met nothing. */
void walk_drop_lost(struct walk *walk);

/* Partial weights of surfaces that were met, all but those that a light's own rays meet. */
void walk_arrive(const struct bdpt *bdpt, struct walk *walk);

/* Sends subpaths on from their hits, or ends them. `samples`: the index of each lane's random
 * numbers. */
void walk_scatter(const struct bdpt *bdpt, ps_direction direction, uint32_t stream, uint32_t set,
                  const uint64_t *samples, struct walk *walk);

#endif
