/* surfels.h: a cache of irradiance where gather rays land.
 *
 * Surfels are points that rays from the pixels found: so they lie where the next rays will land, as densely as
 * these will. Photons are splatted onto them. A lookup asks a hash table for the cube of space that a point lies in,
 * with surfaces of like normal, and gets the mean of the surfels there (after Binder et al. 2019, "Massively parallel
 * path space filtering"). Cubes have a side in proportion to the length of the ray, as wide as neighbouring rays are apart
 * there, in powers of two; where one is empty, the next larger ones are asked. The point is moved by lot within
 * a cube, which turns steps between cubes into noise.
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_SURFELS_H
#define PSPLAT_ESTIMATOR_GATHER_SURFELS_H

#include "../shared/gather_rays.h"
#include <psplat/plugin.h>
#include <stdbool.h>

#define MOST_SURFELS (1 << 18)

struct surfel_cell;

struct surfels {
    const ps_host *host;
    size_t count;
    ps_vec3 *positions, *normals;
    float *lengths;     /* of the rays that found them */
    ps_rgb *irradiance; /* W/m^2, of light that met other surfaces before; set by the caller */
    ps_rgb *sky;    /* of light straight from soft skies (skylight.h); NULL: lookups know none */
    ps_vec3 origin; /* of the cubes */
    float largest;  /* side of the largest cubes */
    struct surfel_cell *cells;
    size_t capacity; /* of the table, a power of two */
};

/* Finds surfels with so many rays from each tile of the pass, or of some where the picture is large: there are at most
 * about MOST_SURFELS. What a surfel stands for is told by the rays' lengths, so more pixels do not need more. PS_ERROR_MEMORY or PS_CANCELLED: release all the same. */
ps_result surfels_find(const ps_host *host, const ps_pass *pass, uint32_t rays,
                       struct surfels *surfels);

/* Surfels that are corrected together. */
enum { SURFELS_GROUP = 64 };

/* Corrects the surfels' irradiance, which is that of splats: smooth, but blotched, and a few percent too dark or too
 * bright where kernels are wide. `traced` is right on average, with noise: the irradiance by paths; `half` is that by the
 * first half of each surfel's paths, which tells the noise. PS_ERROR_MEMORY: nothing happened. */
ps_result surfels_correct(struct surfels *surfels, const ps_rgb *traced, const ps_rgb *half);

/* Makes the table, when the irradiance is set. */
ps_result surfels_build(struct surfels *surfels);

void surfels_release(struct surfels *surfels);

/* As a gather_lookup (shared/gather_rays.h); `surfels` is a struct surfels. */
bool surfels_lookup(const void *surfels, ps_vec3 position, ps_vec3 normal, float length,
                    const float numbers[2], struct gather_known *known);

#endif
