#include "splat/splatter.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "placement/footprint.h"
#include "splat/exact.h"
#include <math.h>
#include <stdlib.h>

#define MAP_BUDGET ((size_t)16 << 20) /* bytes of depth maps at a time */
#define MAP_CHUNK 16                  /* splats that one call of a visibility fills maps for */

/* The map of a splat without visibility: nothing is ever in the way. */
static const float open_map[1] = {INFINITY};

/* Texels of one depth map; 0 without visibility. */
static size_t map_texels(const struct splatter *splatter)
{
    return (size_t)splatter->resolution * splatter->resolution;
}

static size_t batch_size(const struct splatter *splatter)
{
    size_t texels = map_texels(splatter), wanted = splatter->settings.batch;
    size_t fits = texels ? MAP_BUDGET / (texels * sizeof(float)) : wanted;
    return wanted < fits ? wanted : fits;
}

ps_result splatter_create(struct splatter *splatter, struct interleaved layout,
                          const struct splatter_settings *settings, struct error *error)
{
    const ps_visibility_vtable *visibility = settings->visibility;
    *splatter = (struct splatter){
        .settings = *settings,
        .resolution = visibility->depth_maps ? settings->resolution : 0,
    };
    splatter->settings.batch = batch_size(splatter);
    size_t map_bytes = splatter->settings.batch * map_texels(splatter) * sizeof(float);
    splatter->depths = malloc(map_bytes > 0 ? map_bytes : 1);
    splatter->prepared = malloc(splatter->settings.batch * sizeof *splatter->prepared);
    ps_result result = splatter->depths && splatter->prepared
                           ? interleaved_create(layout, &splatter->lit, error)
                           : error_memory(error, map_bytes, "depth maps");
    if (result == PS_OK)
        result = pyramid_create(&splatter->lit, &splatter->pyramid, error);
    if (result == PS_OK)
        result = bins_create(splatter->lit.tile_count, &splatter->bins, error);
    if (result != PS_OK)
        splatter_release(splatter);
    return result;
}

void splatter_release(struct splatter *splatter)
{
    interleaved_release(&splatter->lit);
    pyramid_release(&splatter->pyramid);
    bins_release(&splatter->bins);
    free(splatter->depths);
    free(splatter->prepared);
    *splatter = (struct splatter){.resolution = 0};
}

size_t splatter_bytes(const struct splatter *splatter)
{
    size_t map = map_texels(splatter) * sizeof(float);
    return splatter->settings.batch * (map + sizeof *splatter->prepared) +
           bins_bytes(&splatter->bins) + pyramid_bytes(&splatter->pyramid);
}

void splatter_begin_pass(struct splatter *splatter, struct splatter_pass pass)
{
    splatter->pass = pass;
    splatter->unseen.many = false;
    splatter->unseen.batches = 0;
    pyramid_build(&splatter->pyramid, &splatter->lit, splatter->settings.workers);
}

void splatter_end_pass(struct splatter *splatter, struct gbuffer *gbuffer)
{
    double start = clock_seconds();
    interleaved_join(&splatter->lit, gbuffer, splatter->settings.workers);
    splatter->join_seconds += clock_seconds() - start;
}

/* The subset that a path's splats light. Runs of paths that follow each other share one: any part
 * of a low-discrepancy sequence without gaps is one itself, while every n-th point is not. Passes
 * go round, so that no pixel always belongs to the same part. */
static uint32_t subset_of(const struct splatter *splatter, uint64_t path)
{
    const struct splatter_pass *pass = &splatter->pass;
    uint64_t subsets = splatter->lit.subsets;
    uint64_t count = pass->path_count > 0 ? pass->path_count : 1;
    return (uint32_t)((path % count * subsets / count + pass->number) % subsets);
}

struct batch {
    struct splatter *splatter;
    struct splat *splats;
    size_t n;
    struct kernel_count *counts; /* per tile */
};

static bool judges_points(const struct splatter *splatter)
{
    return splatter->settings.visibility->visible && splatter->resolution == 0;
}

static struct kernel_splat prepare(const struct splatter *splatter, const struct splat *splat,
                                   const float *map)
{
    if (!(splat->bundle.radius > 0.0f))
        return (struct kernel_splat){.kernel_scale = 0.0f};
    struct kernel_splat prepared = kernel_prepare(splat, &splatter->settings.profile, map);
    prepared.subset = subset_of(splatter, splat->path);
    prepared.kernel_scale *= (float)splatter->lit.subsets;
    return prepared;
}

struct touch {
    const struct splatter *splatter;
    struct kernel_splat splat;
};

/* Goes on while nothing was touched. */
static bool touches_none(void *user, uint32_t tile)
{
    const struct touch *touch = user;
    const struct splatter *splatter = touch->splatter;
    return !splatter->settings.kernel.touch(&splatter->lit.tiles[tile].blocks, &touch->splat);
}

bool splatter_touches(const struct splatter *splatter, const struct splat *splat)
{
    struct touch touch = {splatter, prepare(splatter, splat, open_map)};
    return touch.splat.kernel_scale > 0.0f &&
           !pyramid_visit(&splatter->pyramid, &splatter->settings.kernel, &touch.splat,
                          touches_none, &touch);
}

/* The depth maps of up to MAP_CHUNK splats; those of splats that light nothing are left as they
 * are. */
static void fill_maps(const struct splatter *splatter, const struct splat *splats, size_t n,
                      float *depths)
{
    const struct splatter_settings *settings = &splatter->settings;
    ps_bundle bundles[MAP_CHUNK];
    size_t texels = map_texels(splatter), first = 0;
    while (first < n) {
        size_t count = 0;
        while (first + count < n && splats[first + count].bundle.radius > 0.0f) {
            bundles[count] = splats[first + count].bundle;
            count++;
        }
        if (count > 0)
            settings->visibility->depth_maps(settings->visibility_state, settings->host, bundles,
                                             count, splatter->resolution, depths + first * texels);
        first += count + 1;
    }
}

/* Fills the maps of up to MAP_CHUNK splats, cuts the splats to them, and prepares the kernel's
 * input. */
static void map_chunk(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct batch *batch = user;
    struct splatter *splatter = batch->splatter;
    size_t first = index * MAP_CHUNK;
    size_t n = batch->n - first < MAP_CHUNK ? batch->n - first : MAP_CHUNK;
    size_t texels = map_texels(splatter);
    float *depths = splatter->depths + first * texels;
    if (texels)
        fill_maps(splatter, batch->splats + first, n, depths);
    for (size_t i = 0; i < n; i++) {
        struct splat *splat = &batch->splats[first + i];
        const float *map = texels ? depths + i * texels : open_map;
        if (texels && splat->bundle.radius > 0.0f)
            footprint_cut(splat, map, splatter->resolution);
        splatter->prepared[first + i] = prepare(splatter, splat, map);
    }
}

static struct kernel_count splat_exactly(const struct batch *batch, struct interleaved_tile *tile,
                                         const uint32_t *indices, size_t n)
{
    const struct splatter *splatter = batch->splatter;
    const struct splatter_settings *settings = &splatter->settings;
    struct exact_test test = {&settings->kernel, settings->visibility, settings->visibility_state,
                              settings->host, settings->surface_offset};
    return exact_accumulate(tile, &test, batch->splats, splatter->prepared, indices, n,
                            &settings->profile);
}

static void splat_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct batch *batch = user;
    const struct splatter *splatter = batch->splatter;
    const struct bins *bins = &splatter->bins;
    size_t number = bins->first_tile + index;
    const uint32_t *indices = bins->indices + bins->offsets[number];
    size_t n = bins->offsets[number + 1] - bins->offsets[number];
    struct interleaved_tile *tile = &splatter->lit.tiles[number];
    if (n == 0)
        return;
    struct kernel_count count =
        judges_points(splatter)
            ? splat_exactly(batch, tile, indices, n)
            : splatter->settings.kernel.accumulate(tile, splatter->prepared, indices, n,
                                                   splatter->resolution ? splatter->resolution : 1,
                                                   &splatter->settings.profile);
    batch->counts[number].tests += count.tests;
    batch->counts[number].lit += count.lit;
}

static ps_result add_batch(const struct batch *batch, struct error *error)
{
    struct splatter *splatter = batch->splatter;
    const struct splatter_settings *settings = &splatter->settings;
    struct batch work = *batch;
    double start = clock_seconds();
    parallel_for(settings->workers, (work.n + MAP_CHUNK - 1) / MAP_CHUNK, map_chunk, &work);
    double mapped = clock_seconds();
    ps_result result = bins_sort(&splatter->bins, &splatter->pyramid, &settings->kernel,
                                 splatter->prepared, work.n, settings->workers, error);
    double binned = clock_seconds();
    if (result != PS_OK)
        return result;
    parallel_for(settings->workers, splatter->bins.end_tile - splatter->bins.first_tile, splat_tile,
                 &work);
    splatter->map_seconds += mapped - start;
    splatter->bin_seconds += binned - mapped;
    splatter->kernel_seconds += clock_seconds() - binned;
    splatter->map_rays += splatter->bins.lighting * map_texels(splatter); /* others have no map */
    splatter->splats += work.n;
    return PS_OK;
}

static void add_counts(struct splatter *splatter, const struct kernel_count *counts)
{
    for (uint32_t i = 0; i < splatter->lit.tile_count; i++) {
        splatter->useful_tests += counts[i].lit;
        if (judges_points(splatter))
            splatter->exact_tests += counts[i].tests;
        else
            splatter->tests += counts[i].tests;
    }
}

ps_result splatter_add(struct splatter *splatter, struct splat *splats, size_t n,
                       struct error *error)
{
    size_t tiles = splatter->lit.tile_count, most = splatter->settings.batch;
    struct kernel_count *counts = calloc(tiles, sizeof *counts);
    if (!counts)
        return error_memory(error, tiles * sizeof *counts, "statistics");
    ps_result result = PS_OK;
    for (size_t first = 0; first < n && result == PS_OK; first += most) {
        size_t count = n - first < most ? n - first : most;
        struct batch batch = {splatter, splats + first, count, counts};
        result = add_batch(&batch, error);
    }
    add_counts(splatter, counts);
    free(counts);
    return result;
}
