/* final_gather.c: a final gather over a photon map, the classic way to the same picture as
 * gather.c.
 *
 * Jensen 1996: rays from the pixels' points find the last surface, and a photon map knows the light
 * that it got from others. Christensen 1999: that irradiance is computed beforehand at one photon
 * of four, and a ray takes that of the nearest one on a surface that faces alike, which costs a
 * search for few neighbours in place of many. Where a ray is shorter than the photons' estimate is
 * wide, in corners, the blur would be seen: the path goes on by another ray.
 *
 * The photons at which irradiance is computed are those of light paths of their own, which the
 * estimates leave out. Where they count themselves, estimates are too bright; where they only leave
 * themselves out, too dark, since places that are far from others, by chance, are the nearest ones
 * to more points. What estimates lose at walls and edges is given back (kernel_share.h).
 *
 * Direct light where rays land is by shadow rays, and rays are drawn and shared out as those of
 * gather.c, so that both differ by what they look up alone. Caustics, which rays would find by
 * chance, have a map of their own that is looked at directly, with a cone filter.
 */
#include "shared/gather_picture.h"
#include "shared/kernel_share.h"
#include "shared/photon_map.h"
#include "shared/photons.h"

#define SPACING 4    /* light paths, of which one's photons are places of the cache */
#define CANDIDATES 4 /* nearest places, among which one must face alike */
#define FACING 0.8f  /* cosine from which on two surfaces do */

struct state {
    int64_t samples;
    int64_t neighbours;
    int64_t roulette;
    int32_t adaptive;
};

/* Irradiance at some places. */
struct cache {
    struct photon_map places;
    ps_rgb *irradiance;
    float *radii; /* of the estimates */
};

struct work {
    const ps_host *host;
    const ps_pass *pass;
    struct photon_map all, caustics;
    struct photon_estimate how;
    struct cache cache;
};

/* --- photons --- */

static bool is_place(const ps_photon *photon)
{
    return photon->path % SPACING == 0;
}

/* A map, and the work that it is a part of. */
struct part {
    const struct work *work;
    struct photon_map *map;
};

/* Photons that are one surface on, or places, or caustics of the pixels. */
static bool belongs_to(const void *opaque, const ps_photon *photon)
{
    const struct part *part = opaque;
    const struct work *work = part->work;
    if (part->map == &work->caustics)
        return photon->bounce == 0;
    return photon->bounce < work->pass->bounces &&
           is_place(photon) == (part->map == &work->cache.places);
}

/* Adds those of n photons that belong to a map, with `scale` times their power; `chosen` is room
 * for n. */
static ps_result add_chosen(const struct work *work, struct photon_map *map, float scale,
                            const ps_photon *photons, size_t n, ps_photon *chosen)
{
    const struct part part = {work, map};
    size_t count = photons_choose(photons, n, belongs_to, &part, scale, chosen);
    return photon_map_add(map, work->pass, PHOTONS_ARRIVE, chosen, count);
}

/* A photons_take. */
static ps_result store_batch(void *opaque, const ps_photon *photons, size_t n)
{
    struct work *work = opaque;
    const ps_host *host = work->host;
    const float share = (float)SPACING / (SPACING - 1); /* of the paths that are no places */
    ps_photon *chosen = host->allocate(host, n * sizeof *chosen, "photons chosen");
    ps_result result = chosen ? PS_OK : PS_ERROR_MEMORY;
    if (result == PS_OK && work->pass->bounces > 1)
        result = add_chosen(work, &work->all, share, photons, n, chosen);
    if (result == PS_OK && work->pass->bounces > 1)
        result = add_chosen(work, &work->cache.places, 1.0f, photons, n, chosen);
    if (result == PS_OK && work->pass->specular)
        result = add_chosen(work, &work->caustics, 1.0f, photons, n, chosen);
    host->release(host, chosen);
    return result;
}

static ps_result store_photons(struct work *work, int64_t neighbours)
{
    ps_result result = photons_for_each_batch(work->host, store_batch, work);
    if (result == PS_OK)
        result = photon_map_build(&work->all, work->pass, neighbours);
    if (result == PS_OK)
        result = photon_map_build(&work->cache.places, work->pass, CANDIDATES);
    return result == PS_OK ? photon_map_build(&work->caustics, work->pass, neighbours) : result;
}

/* --- the cache --- */

static void estimate_group(void *user, uint64_t group, uint32_t worker)
{
    const struct work *work = user;
    const struct cache *cache = &work->cache;
    size_t first = (size_t)group * PS_TILE_PIXELS, n = 0;
    ps_vec3 positions[PS_TILE_PIXELS], normals[PS_TILE_PIXELS];
    float shares[PS_TILE_PIXELS];
    for (; n < PS_TILE_PIXELS && first + n < cache->places.count; n++) {
        positions[n] = photon_map_position(&cache->places, first + n);
        normals[n] = photon_map_normal(&cache->places, first + n);
    }
    photon_map_estimate(&work->all, &work->how, worker, positions, normals, n,
                        cache->irradiance + first, cache->radii + first);
    kernel_shares(work->host, positions, normals, cache->radii + first, n, first, shares);
    for (size_t i = 0; i < n; i++)
        cache->irradiance[first + i] = ps_rgb_scale(cache->irradiance[first + i], 1.0f / shares[i]);
}

static ps_result fill_cache(struct work *work)
{
    const ps_host *host = work->host;
    struct cache *cache = &work->cache;
    size_t count = cache->places.count;
    cache->irradiance = host->allocate(host, count * sizeof *cache->irradiance, "irradiance");
    cache->radii = host->allocate(host, count * sizeof *cache->radii, "irradiance");
    if (!cache->irradiance || !cache->radii)
        return PS_ERROR_MEMORY;
    host->parallel_for(host, (count + PS_TILE_PIXELS - 1) / PS_TILE_PIXELS, estimate_group, work);
    return host->cancelled(host) ? PS_CANCELLED : PS_OK;
}

static bool look_up_one(const struct cache *cache, const struct gather_landing *landing,
                        struct cached_irradiance *known)
{
    int nearest[CANDIDATES], n = cache->places.neighbours;
    n = n < CANDIDATES ? n : CANDIDATES;
    photon_map_nearest(&cache->places, landing->position, n, nearest);
    for (int i = 0; i < n; i++) {
        if (ps_dot(photon_map_normal(&cache->places, (size_t)nearest[i]), landing->normal) < FACING)
            continue;
        *known = (struct cached_irradiance){.indirect = cache->irradiance[nearest[i]]};
        return landing->length > cache->radii[nearest[i]];
    }
    return false;
}

/* A gather_lookup. */
static void look_up(const void *cache, const struct gather_landing *landings, size_t n,
                    struct cached_irradiance *known, bool *is_known)
{
    for (size_t i = 0; i < n; i++) {
        uint32_t path = landings[i].path;
        is_known[path] = look_up_one(cache, &landings[i], &known[path]);
    }
}

/* --- the picture --- */

static ps_result gather(const struct state *state, struct work *work)
{
    const struct gather_setting setting = {
        .paths = {.host = work->host,
                  .pass = work->pass,
                  .roulette = (uint32_t)state->roulette,
                  .caustics_below = work->pass->specular ? PATHS_ALL_CAUSTICS : 0.0f},
        .samples = (uint64_t)state->samples,
        .first = gather_first_of((uint64_t)state->samples),
        .most = GATHER_MOST_OF_SAMPLES * (uint64_t)state->samples,
        .lookup = work->cache.irradiance ? look_up : NULL,
        .cache = &work->cache,
        .cache_has_indirect = true,
    };
    struct gather_allocation allocation = {.is_known = false};
    ps_result result = gather_picture(&setting, state->adaptive, &allocation);
    if (result == PS_OK && work->caustics.index)
        result = photon_map_light_pixels(&work->caustics, &work->how);
    return result;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    struct work work = {
        .host = host,
        .pass = pass,
        .how = {.filter = PHOTON_FILTER_CONE, .max_radius = INFINITY, .shrink = 1.0f},
    };
    photon_map_begin(host, &work.all);
    photon_map_begin(host, &work.caustics);
    photon_map_begin(host, &work.cache.places);
    ps_result result = PS_OK;
    if (pass->bounces > 1 || pass->specular)
        result = store_photons(&work, state->neighbours);
    if (result == PS_OK && work.all.index && work.cache.places.index)
        result = fill_cache(&work);
    if (result == PS_OK)
        result = gather(state, &work);
    host->release(host, work.cache.irradiance);
    host->release(host, work.cache.radii);
    photon_map_release(&work.cache.places);
    photon_map_release(&work.caustics);
    photon_map_release(&work.all);
    return result;
}

static const ps_param params[] = {
    PS_ROW(struct state, samples, PS_PARAM_INT, "8", 1, 1 << 16, PS_PARAM_QUALITY, NULL, "rays",
           "gather rays for each pixel and pass, on average"),
    PS_INT(struct state, neighbours, "50", 2, 100000, "photons",
           "photons that an estimate of the map is made of"),
    PS_ROW(struct state, roulette, PS_PARAM_INT, "3", 1, 1000, PS_PARAM_EXPERT, NULL, "bounces",
           "bounce from which on Russian roulette may end a path"),
    PS_ROW(struct state, adaptive, PS_PARAM_BOOL, "yes", 0, 1, PS_PARAM_EXPERT, NULL, "",
           "give more samples to tiles and pixels that seem to need them"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS | PS_ESTIMATOR_VARIANCE,
    .pixel_bytes = GATHER_PIXEL_BYTES,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "final_gather",
    .version = "1.0",
    .summary = "final gather over a photon map whose irradiance is computed beforehand",
    .paper = "Jensen 1996, Global illumination using photon maps; Christensen 1999, Faster photon "
             "map global illumination",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, final_gather, &descriptor)
