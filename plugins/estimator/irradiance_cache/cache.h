/* cache.h: the records of an irradiance cache, found by position.
 *
 * Ward, Rubinstein and Clear 1988. A tree of boxes around the records' reach (a bounding volume
 * hierarchy, as rays use) in place of their octree: records that are long and thin have tight
 * boxes.
 */
#ifndef PSPLAT_ESTIMATOR_IRRADIANCE_CACHE_H
#define PSPLAT_ESTIMATOR_IRRADIANCE_CACHE_H

#include "record.h"

/* Records are averaged up to this distance, in their radii, so that their borders do not show. */
#define CACHE_REACH 2.0f

struct cache_node; /* cache.c */

struct irradiance_cache {
    const ps_host *host;
    struct record *records; /* owned, as what follows */
    size_t count, room;
    uint32_t *order; /* of records, by the tree's leaves */
    struct cache_node *nodes;
    size_t node_count;
};

void cache_begin(const ps_host *host, struct irradiance_cache *cache);
void cache_release(struct irradiance_cache *cache);

/* Room for n more records, which are not set: NULL when out of memory. */
struct record *cache_add(struct irradiance_cache *cache, size_t n);

/* When the last n records have been made: they can be found from now on. Radii of neighbours are
 * held together (Krivanek et al. 2006, "Making radiance and irradiance caching practical"): a
 * record that missed what its neighbour saw may not reach past it. */
ps_result cache_update(struct irradiance_cache *cache, size_t n);

/* Whether some record is near enough. Any thread. */
bool cache_covers(const struct irradiance_cache *cache, ps_vec3 position, ps_vec3 normal);

/* Irradiance at a point by all records that reach it; where neighbours have shrunk them so that
 * none does, by the nearest one. False where there is none. Any thread. */
bool cache_interpolate(const struct irradiance_cache *cache, ps_vec3 position, ps_vec3 normal,
                       ps_rgb *irradiance);

#endif
