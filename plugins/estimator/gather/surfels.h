/* surfels.h: a cache of irradiance where gather rays land.
 *
 * Surfels are points that rays from the pixels found: so they lie where the next rays will land, as
 * densely as these will. Photons are splatted onto them, and they ask for the light of skies
 * (skylight.h). What lies around a ray's end is looked up in a table (surfel_table.h).
 */
#ifndef PSPLAT_ESTIMATOR_GATHER_SURFELS_H
#define PSPLAT_ESTIMATOR_GATHER_SURFELS_H

#include <psplat/cells.h>
#include <psplat/plugin.h>
#include <stdbool.h>

#define MOST_SURFELS (1 << 18)

struct surfel_cell;

struct surfels {
    const ps_host *host;
    const ps_cells *extension; /* by which they are sorted */
    size_t count;
    ps_vec3 *positions, *normals;
    uint32_t *materials;
    float *lengths;     /* of the rays that found them (surfel_length()), in scene units */
    ps_rgb *irradiance; /* W/m^2, of light that met other surfaces before; set by the caller */
    ps_rgb *sky;        /* of light straight from soft skies; NULL: lookups know none */
    /* The table's cubes begin at `origin`; `largest` is the side of the largest ones. */
    ps_vec3 origin;
    float largest;
    struct surfel_cell *cells; /* a hash table of `capacity`, a power of two; NULL: not made yet */
    size_t capacity;
};

/* Finds surfels with so many rays from each tile of the pass, or from a random subset of the tiles
 * if the picture is large: there are at most about MOST_SURFELS. What a surfel stands for is told
 * by the rays' lengths, so more pixels do not need more. PS_ERROR_MEMORY or PS_CANCELLED: release
 * all the same. */
ps_result surfels_find(const ps_host *host, const ps_pass *pass, uint32_t rays,
                       struct surfels *surfels);

/* Surfels whose rays are traced together. */
enum { SURFELS_GROUP = 64 };

/* Those of a group: n from `first` on. */
struct surfel_group {
    size_t first, n;
};

/* All surfels in groups of `size`, but for the last one. */
static inline size_t surfels_group_count(const struct surfels *surfels, size_t size)
{
    return (surfels->count + size - 1) / size;
}

static inline struct surfel_group surfels_group(const struct surfels *surfels, size_t size,
                                                size_t index)
{
    size_t first = index * size, left = surfels->count - first;
    return (struct surfel_group){first, left < size ? left : size};
}

void surfels_release(struct surfels *surfels);

/* Curved mirrors and glass may focus rays: what lies around their ends is told as for rays of this
 * part of their length. */
#define SURFEL_FOCUS 0.25f

static inline float surfel_length(float length, bool is_focused)
{
    return is_focused ? SURFEL_FOCUS * length : length;
}

/* Which way a surface faces: an axis, and the side, 0 to 5. */
static inline uint32_t surfel_facing(ps_vec3 n)
{
    float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    uint32_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    float along = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    return 2 * axis + !(along < 0.0f);
}

#endif
