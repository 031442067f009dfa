/* placement.c: the order in which radius, extent, footprint and boundaries are found. */
#include "placement/placement.h"

#include "placement/boundary.h"
#include "placement/footprint.h"
#include "placement/radius.h"
#include <assert.h>
#include <math.h>
#include <string.h>

/* n photons under way. */
struct placing {
    const struct placement *placement;
    const ps_photon *photons;
    ps_hit *hits;
    size_t n;
    float largest[PS_PATH_CHUNK]; /* radii */
    float radii[PS_PATH_CHUNK];   /* 0: lights nothing */
};

static void place_footprints(const struct placing *placing, const ps_hit *hits,
                             struct splat *splats)
{
    const struct placement *placement = placing->placement;
    for (size_t i = 0; i < placing->n; i++)
        splats[i] = footprint_place(&placement->scene, placement->settings, &placing->photons[i],
                                    &hits[i], placing->largest[i], placing->radii[i]);
}

/* What lies past the first hit counts, since part of a bundle may pass beside it. */
static uint32_t drop_unseen(const struct placing *placing, struct splat *splats)
{
    const struct placement *placement = placing->placement;
    uint32_t dropped = 0;
    for (size_t i = 0; placement->may_light && i < placing->n; i++) {
        struct splat open = splats[i];
        open.bundle.far_depth = INFINITY;
        if (placement->may_light(placement->user, &open))
            continue;
        splats[i].bundle.radius = 0.0f;
        dropped++;
    }
    return dropped;
}

/* The largest that bundles may be shows whether they are seen at all. */
static uint32_t drop_unseen_full(struct placing *placing, struct splat *splats)
{
    ps_hit stand_ins[PS_PATH_CHUNK];
    memcpy(stand_ins, placing->hits, placing->n * sizeof *stand_ins);
    for (size_t i = 0; i < placing->n; i++)
        if (!(placing->hits[i].distance < INFINITY))
            footprint_stand_in(&placing->photons[i], placing->radii[i], &stand_ins[i]);
    place_footprints(placing, stand_ins, splats);
    uint32_t dropped = drop_unseen(placing, splats);
    for (size_t i = 0; i < placing->n; i++)
        placing->radii[i] = splats[i].bundle.radius;
    return dropped;
}

/* Bundles that start at their photons. */
static uint32_t place_full(struct placing *placing, struct splat *splats)
{
    const struct placement *placement = placing->placement;
    uint32_t dropped = 0;
    memcpy(placing->radii, placing->largest, placing->n * sizeof *placing->radii);
    if (placement->may_light)
        dropped = drop_unseen_full(placing, splats);
    footprint_find_extents(placement, placing->photons, placing->n, placing->hits, placing->radii);
    place_footprints(placing, placing->hits, splats);
    if (placement->settings->boundary_correction)
        boundary_find(placement->host, placement->scene.surface_offset, placing->photons,
                      placing->n, splats);
    return dropped;
}

static uint32_t place_others(struct placing *placing, struct splat *splats)
{
    const struct placement *placement = placing->placement;
    for (size_t i = 0; i < placing->n; i++)
        placing->radii[i] = radius_at(&placement->scene, placement->settings, &placing->photons[i],
                                      placing->largest[i], placing->hits[i].distance);
    place_footprints(placing, placing->hits, splats);
    return drop_unseen(placing, splats);
}

uint32_t placement_place(const struct placement *placement, const ps_photon *photons, ps_hit *hits,
                         size_t n, struct splat *splats)
{
    assert(n <= PS_PATH_CHUNK);
    struct placing placing = {.placement = placement, .photons = photons, .hits = hits, .n = n};
    for (size_t i = 0; i < n; i++)
        placing.largest[i] =
            radius_largest(&placement->scene, placement->settings, &photons[i], &hits[i]);
    uint32_t dropped = placement->settings->step_back.choice == STEP_BACK_FULL
                           ? place_full(&placing, splats)
                           : place_others(&placing, splats);
    if (placement->follows_rays)
        footprint_open(placement->settings, splats, n);
    if (placement->has_maps)
        footprint_set_bias(placement->settings, splats, n);
    return dropped;
}
