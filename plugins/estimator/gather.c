/* gather.c: a final gather over surfels that photons were splatted onto.
 *
 * Photons find light that is hard to find, but splats are expensive, and their blur and
 * low-frequency noise are visible. Paths are cheap and their noise can be denoised, but most of
 * their segments go to light that has been reflected many times. A final gather has the best of
 * both (Reichert 1992; Jensen 1996; Christensen 1999): rays from the pixels' points find the last
 * surface,
 *
 *     E(x) = integral of (L_direct(y) + albedo(y) / pi * E(y)) cos(theta) dw,   y = y(x, w)
 *
 * with L_direct by next-event estimation and E(y), light that met other surfaces before, from a
 * cache. Here the cache is photon splatting: surfels where such rays land take the place of pixels
 * (surfels.h), so that injection, stratification, visibility and filter are the plugins chosen. The
 * cache also has what skies give to y, which next-event estimation seldom finds in a room
 * (skylight.h). Where the cache knows nothing, and where a ray is too short for it, the path goes
 * on by another segment. Mirrors, glass and gloss on the way are as path tracing has them
 * (paths.h).
 *
 * Caustics at x, light from a source by mirrors, glass and smooth gloss alone, are left to photons,
 * which are splatted onto the pixels: gather rays would hit the source by chance only. What rough
 * gloss reflects (PS_ROUGH_GLOSS) is wide and faint: next-event estimation finds it where rays end,
 * without the blotches of few photons.
 *
 * Rays are drawn where those before them found light (guide.h), the first ones where photons came
 * from, if that is a small part of the hemisphere (photon_guide.h); in rounds, and more of them in
 * tiles whose first round asks for it (allocation.h). A tile's rays of a round share a run of the
 * Sobol sequence along a Z curve, as in pathtrace.c.
 */
#include "gather/skylight.h"
#include "gather/surfel_paths.h"
#include "gather/surfel_table.h"
#include "shared/gather_picture.h"
#include "shared/photons.h"
#include <string.h>

#define MOST_PATHS 32       /* of a surfel, by default */
#define FEWEST_SURFELS 2000 /* of a picture */
#define THINNED_TOGETHER 4  /* paths */

#define MOST_CACHED_PASSES 4 /* passes */

#define SURFEL_SHARE 0.2 /* of a pass's time, about */

/* What a pass found of the whole picture, for the next part of it. */
struct pass_cache {
    bool is_taken;
    uint32_t pass;
    bool has_surfels; /* they were looked for, and there may be none */
    struct surfels surfels;
    struct photon_guide photons; /* by which first rays are guided */
    struct gather_allocation allocation;
};

struct state {
    int64_t samples;
    int64_t surfels;
    int64_t thinning;
    ps_number_or_choice paths;
    int64_t roulette;
    int32_t adaptive;
    struct pass_cache caches[MOST_CACHED_PASSES]; /* of the passes of a picture in parts */
};

struct work {
    const struct state *state;
    struct gather_setting setting;
    struct pass_cache *cache;
};

/* --- photons --- */

/* Which photons are splatted where. Photons for the surfels whose light came through mirrors, glass
 * or smooth gloss are collected, and splatted after the correction by paths: paths find a light
 * behind glass seldom, and then with far too much weight. What rough gloss reflects is left to
 * paths there, too: few photons with all of that light would make blotches. */
struct splatting {
    const ps_host *host;
    struct virtual_lights *lights; /* by which first rays are guided; NULL: they are known */
    bool onto_pixels, onto_surfels;
    uint32_t most_bounces; /* of those onto surfels, which are one surface on */
    uint64_t thinning;
    ps_photon *specular; /* with the power of all that they stand for */
    size_t specular_count, specular_capacity;
};

static bool belongs_on_pixels(const void *opaque, const ps_photon *photon)
{
    (void)opaque;
    return photon->bounce == 0 && photon->specular == PS_SHARP_GLOSS;
}

/* Paths that share places (ps_pass.shares_places) follow one another, and are better taken
 * together. */
static bool belongs_on_surfels(const void *opaque, const ps_photon *photon)
{
    const struct splatting *splatting = opaque;
    return photon->bounce <= splatting->most_bounces &&
           photon->path / THINNED_TOGETHER % splatting->thinning == 0;
}

static bool is_diffuse_on_surfels(const void *opaque, const ps_photon *photon)
{
    return !photon->specular && belongs_on_surfels(opaque, photon);
}

static bool is_specular_on_surfels(const void *opaque, const ps_photon *photon)
{
    return photon->specular == PS_SHARP_GLOSS && belongs_on_surfels(opaque, photon);
}

static ps_result collect_specular(struct splatting *splatting, const ps_photon *photons, size_t n)
{
    const ps_host *host = splatting->host;
    if (splatting->specular_count + n > splatting->specular_capacity) {
        size_t capacity = 2 * (splatting->specular_count + n);
        ps_photon *larger = host->allocate(host, capacity * sizeof *larger, "specular photons");
        if (!larger)
            return PS_ERROR_MEMORY;
        if (splatting->specular_count > 0)
            memcpy(larger, splatting->specular, splatting->specular_count * sizeof *larger);
        host->release(host, splatting->specular);
        splatting->specular = larger;
        splatting->specular_capacity = capacity;
    }
    splatting->specular_count +=
        photons_choose(photons, n, is_specular_on_surfels, splatting, (float)splatting->thinning,
                       splatting->specular + splatting->specular_count);
    return PS_OK;
}

/* A photons_take. */
static ps_result splat_batch(void *opaque, const ps_photon *photons, size_t n)
{
    struct splatting *splatting = opaque;
    const ps_host *host = splatting->host;
    if (splatting->lights)
        virtual_lights_take(splatting->lights, photons, n);
    ps_result result = PS_OK;
    if (splatting->onto_surfels)
        result = photons_splat(host, host->splat_points, photons, n, is_diffuse_on_surfels,
                               splatting, (float)splatting->thinning);
    if (result == PS_OK && splatting->onto_surfels)
        result = collect_specular(splatting, photons, n);
    if (result == PS_OK && splatting->onto_pixels)
        result = photons_splat(host, host->splat, photons, n, belongs_on_pixels, splatting, 1.0f);
    return result;
}

/* --- the cache --- */

/* By default a part of the work that the gather is. */
static uint64_t paths_of_surfel(const struct state *state)
{
    if (state->paths.choice < 0)
        return (uint64_t)state->paths.number;
    return state->samples < MOST_PATHS / 2 ? 2 * (uint64_t)state->samples : MOST_PATHS;
}

/* Adds the light of the photons that were collected to the surfels. */
static ps_result splat_specular(const struct splatting *splatting, struct surfels *surfels)
{
    const ps_host *host = splatting->host;
    if (splatting->specular_count == 0)
        return PS_OK;
    ps_rgb *more = host->allocate(host, surfels->count * sizeof *more, "surfels");
    ps_result result = more ? PS_OK : PS_ERROR_MEMORY;
    if (result == PS_OK)
        result = host->begin_points(host, surfels->positions, surfels->normals, surfels->count);
    if (result == PS_OK)
        result = host->splat_points(host, splatting->specular, splatting->specular_count);
    if (result == PS_OK)
        result = host->end_points(host, more);
    for (size_t i = 0; result == PS_OK && i < surfels->count; i++)
        surfels->irradiance[i] = ps_rgb_add(surfels->irradiance[i], more[i]);
    host->release(host, more);
    return result;
}

/* Finds the surfels' indirect light by what photons have brought. */
static ps_result light_surfels(struct work *work, const struct splatting *splatting)
{
    const struct paths_setting *setting = &work->setting.paths;
    const ps_host *host = setting->host;
    struct surfels *surfels = &work->cache->surfels;
    uint64_t paths = paths_of_surfel(work->state);
    ps_result result = host->end_points(host, surfels->irradiance);
    if (result == PS_OK && paths > 0)
        result = surfel_paths_correct(setting->pass, setting->roulette, paths, surfels);
    return result == PS_OK ? splat_specular(splatting, surfels) : result;
}

/* Splats the pass's photons onto pixels, and onto surfels that lack their light; and chooses those
 * that guide rays, for this part of the picture and the next ones. */
static ps_result splat(struct work *work, bool onto_surfels)
{
    const ps_host *host = work->setting.paths.host;
    const ps_pass *pass = work->setting.paths.pass;
    struct surfels *surfels = &work->cache->surfels;
    struct photon_guide *guide = &work->cache->photons;
    struct virtual_lights lights = {.host = host};
    bool chooses = !photon_guide_is_there(guide);
    struct splatting splatting = {
        .host = host,
        .lights = chooses ? &lights : NULL,
        .onto_pixels = pass->specular,
        .onto_surfels = onto_surfels && surfels->count > 0,
        .most_bounces = pass->bounces - 1,
        .thinning = (uint64_t)work->state->thinning,
    };
    ps_result result = PS_OK;
    if (chooses)
        result = virtual_lights_begin(host, pass, PHOTON_GUIDE_LIGHTS, true, &lights);
    if (result == PS_OK && splatting.onto_pixels)
        result = host->begin_splats(host, 0);
    if (result == PS_OK && splatting.onto_surfels)
        result = host->begin_points(host, surfels->positions, surfels->normals, surfels->count);
    if (result == PS_OK && (chooses || splatting.onto_pixels || splatting.onto_surfels))
        result = photons_for_each_batch(host, splat_batch, &splatting);
    virtual_lights_end(&lights);
    if (result == PS_OK && chooses)
        result = photon_guide_create(&lights, guide);
    if (result == PS_OK && splatting.onto_surfels)
        result = light_surfels(work, &splatting);
    host->release(host, splatting.specular);
    virtual_lights_release(&lights);
    return result;
}

/* A small picture needs as many as a scene has places. */
static uint32_t surfels_of_tile(const struct state *state, const ps_pass *pass)
{
    uint64_t wanted = (uint64_t)state->surfels, least = FEWEST_SURFELS / pass->tile_count + 1;
    uint64_t rays = wanted > least ? wanted : least;
    return (uint32_t)(rays < PS_TILE_PIXELS ? rays : PS_TILE_PIXELS);
}

static void clear_cache(struct pass_cache *cache)
{
    const ps_host *host = cache->surfels.host;
    surfels_release(&cache->surfels);
    photon_guide_release(&cache->photons);
    *cache = (struct pass_cache){.surfels = {.host = host}, .photons = {.host = host}};
}

/* What is known of a pass's whole picture, or room for it: in the state where another part may ask
 * for it. */
static struct pass_cache *cache_of_pass(struct state *state, const ps_pass *pass,
                                        struct pass_cache *own)
{
    struct pass_cache *room = own;
    for (int i = 0; pass->parts > 1 && i < MOST_CACHED_PASSES; i++) {
        if (state->caches[i].is_taken && state->caches[i].pass == pass->number)
            return &state->caches[i];
        if (!state->caches[i].is_taken && room == own)
            room = &state->caches[i];
    }
    room->is_taken = true;
    room->pass = pass->number;
    return room;
}

/* The cache, where it is wanted, and the light that rays do not find. */
static ps_result splat_pass(struct work *work, struct pass_cache *cache)
{
    const ps_pass *pass = work->setting.paths.pass;
    const ps_host *host = work->setting.paths.host;
    const struct state *state = work->state;
    struct surfels *surfels = &cache->surfels;
    uint64_t paths = paths_of_surfel(state);
    bool for_indirect = pass->bounces > 1, is_missing = state->surfels > 0 && !cache->has_surfels;
    bool for_sky = is_missing && paths > 0 && skylight_is_there(host);
    bool finds = is_missing && (for_indirect || for_sky);
    ps_result result = PS_OK;
    if (finds)
        result = surfels_find(host, pass, surfels_of_tile(state, pass), surfels);
    if (result == PS_OK && for_sky)
        result = skylight_find(pass, paths, surfels);
    if (result == PS_OK)
        result = splat(work, finds && for_indirect);
    if (result == PS_OK && finds && surfels->count > 0)
        result = surfel_table_build(surfels);
    cache->has_surfels |= finds;
    work->setting.photons = &cache->photons;
    if (surfels->count > 0) {
        work->setting.lookup = surfel_table_lookup;
        work->setting.cache = surfels;
        work->setting.cache_has_indirect = for_indirect;
        work->setting.cache_has_sky = surfels->sky != NULL;
    }
    return result;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    struct pass_cache own = {0}, *cache = cache_of_pass(state, pass, &own);
    cache->surfels.host = cache->photons.host = host;
    struct work work = {
        .state = state,
        .setting = {.paths = {.host = host,
                              .pass = pass,
                              .roulette = (uint32_t)state->roulette,
                              .caustics_below = pass->specular ? PS_ROUGH_GLOSS : 0.0f},
                    .samples = (uint64_t)state->samples,
                    .first = gather_first_of((uint64_t)state->samples),
                    .most = GATHER_MOST_OF_SAMPLES * (uint64_t)state->samples,
                    .share_before = SURFEL_SHARE},
        .cache = cache,
    };
    host->progress_part(host, 0.0, SURFEL_SHARE);
    ps_result result = splat_pass(&work, cache);
    host->count(host, "surfels", (double)cache->surfels.count);
    if (result == PS_OK)
        result = gather_picture(&work.setting, state->adaptive, &cache->allocation);
    if (cache == &own || result != PS_OK)
        clear_cache(cache);
    return result;
}

static void destroy(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    for (int i = 0; i < MOST_CACHED_PASSES; i++) {
        state->caches[i].surfels.host = state->caches[i].photons.host = host;
        clear_cache(&state->caches[i]);
    }
}

/* --- the strategy --- */

static const char *const automatic_choice[] = {"auto", NULL};

static const ps_param params[] = {
    PS_ROW(struct state, samples, PS_PARAM_INT, "8", 1, 1 << 16, PS_PARAM_QUALITY, NULL, "rays",
           "gather rays for each pixel and pass, on average"),
    PS_ROW(struct state, surfels, PS_PARAM_INT, "32", 0, PS_TILE_PIXELS, PS_PARAM_EXPERT, NULL,
           "surfels",
           "surfels of the cache for each tile of 16x16 pixels; 0: none, as path tracing"),
    PS_ROW(struct state, thinning, PS_PARAM_INT, "8", 1, 1000, PS_PARAM_EXPERT, NULL, "paths",
           "of so many light paths one is splatted onto the surfels, with the power of all"),
    PS_NUMBER_OR(struct state, paths, "auto", 0, 1 << 16, PS_PARAM_EXPERT | PS_PARAM_WHOLE,
                 automatic_choice, "paths",
                 "paths from each surfel, by which its light is corrected, and rays to a soft sky; "
                 "auto: twice the samples, at most 32; 0: none"),
    PS_ROW(struct state, roulette, PS_PARAM_INT, "3", 1, 1000, PS_PARAM_EXPERT, NULL, "bounces",
           "bounce from which on Russian roulette may end a path"),
    PS_ROW(struct state, adaptive, PS_PARAM_BOOL, "yes", 0, 1, PS_PARAM_EXPERT, NULL, "",
           "give more samples to tiles and pixels that seem to need them"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_SHARES_PLACES | PS_ESTIMATOR_CROPS | PS_ESTIMATOR_VARIANCE,
    .pixel_bytes = GATHER_PIXEL_BYTES,
    .accumulate = accumulate,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "gather",
    .version = "1.0",
    .summary = "final gather over surfels that photons are splatted onto",
    .paper = "Jensen 1996, Global illumination using photon maps; Hoet 2014",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .destroy = destroy,
    .vtable = &vtable,
};

PS_MODULE(estimator, gather, &descriptor)
