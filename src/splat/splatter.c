#include "splat/splatter.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "splat/box.h"
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

static size_t batch_size(const struct splatter *splatter, size_t wanted)
{
    size_t texels = map_texels(splatter);
    size_t fits = texels ? MAP_BUDGET / (texels * sizeof(float)) : wanted;
    return wanted < fits ? wanted : fits;
}

ps_result splatter_create(struct splatter *splatter, struct gbuffer *gbuffer, const ps_host *host,
                          struct splatter_visibility visibility,
                          const struct kernel_profile *profile, kernel_function accumulate,
                          uint32_t threads, size_t batch, struct error *error)
{
    *splatter = (struct splatter){
        .gbuffer = gbuffer,
        .host = host,
        .visibility = visibility,
        .profile = *profile,
        .accumulate = accumulate,
        .resolution = visibility.vtable->resolution(visibility.state),
        .threads = threads,
    };
    if (splatter->resolution > 64 || (splatter->resolution && !visibility.vtable->depth_maps))
        return error_set(error, PS_ERROR_INVALID,
                         "the visibility has no depth maps of resolution %u", splatter->resolution);
    splatter->batch = batch_size(splatter, batch);
    size_t map_bytes = splatter->batch * map_texels(splatter) * sizeof(float);
    splatter->depths = malloc(map_bytes > 0 ? map_bytes : 1);
    splatter->prepared = malloc(splatter->batch * sizeof *splatter->prepared);
    ps_result result = splatter->depths && splatter->prepared
                           ? pyramid_create(gbuffer, &splatter->pyramid, error)
                           : error_memory(error, map_bytes, "depth maps");
    if (result == PS_OK)
        result = bins_create(gbuffer->tile_count, &splatter->bins, error);
    if (result != PS_OK)
        splatter_release(splatter);
    return result;
}

void splatter_release(struct splatter *splatter)
{
    pyramid_release(&splatter->pyramid);
    bins_release(&splatter->bins);
    free(splatter->depths);
    free(splatter->prepared);
    *splatter = (struct splatter){.threads = 0};
}

size_t splatter_bytes(const struct splatter *splatter)
{
    size_t map = map_texels(splatter) * sizeof(float);
    return splatter->batch * (map + sizeof *splatter->prepared) + bins_bytes(&splatter->bins);
}

void splatter_begin_pass(struct splatter *splatter)
{
    pyramid_build(&splatter->pyramid, splatter->gbuffer, splatter->threads);
}

struct batch {
    struct splatter *splatter;
    ps_splat *splats;
    size_t n;
    struct exact_count *counts; /* per tile; `asked` only where the visibility judges points */
};

static bool judges_points(const struct splatter *splatter)
{
    return splatter->visibility.vtable->visible && splatter->resolution == 0;
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
        splatter->visibility.vtable->depth_maps(splatter->visibility.state, splatter->host,
                                                batch->splats + first, n, depths);
    for (size_t i = 0; i < n; i++) {
        ps_splat *splat = &batch->splats[first + i];
        const float *map = texels ? depths + i * texels : open_map;
        if (!(splat->half_width > 0.0f))
            continue;
        if (texels)
            box_cut(splat, map, splatter->resolution);
        else
            splat->two_sided = 0;
        splatter->prepared[first + i] = kernel_prepare(splat, &splatter->profile, map);
    }
}

static struct exact_count splat_exactly(const struct batch *batch, ps_tile *tile,
                                        const uint32_t *indices, size_t n)
{
    const struct splatter *splatter = batch->splatter;
    struct exact_test test = {splatter->visibility.vtable, splatter->visibility.state,
                              splatter->host, splatter->visibility.surface_offset};
    return exact_accumulate(tile, &test, batch->splats, splatter->prepared, indices, n,
                            &splatter->profile);
}

static void splat_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct batch *batch = user;
    const struct splatter *splatter = batch->splatter;
    const struct bins *bins = &splatter->bins;
    const uint32_t *indices = bins->indices + bins->offsets[index];
    size_t n = bins->offsets[index + 1] - bins->offsets[index];
    ps_tile *tile = &splatter->gbuffer->tiles[index];
    struct exact_count count = {0, 0};
    if (judges_points(splatter))
        count = splat_exactly(batch, tile, indices, n);
    else
        count.lit = splatter->accumulate(tile, splatter->prepared, indices, n,
                                         splatter->resolution ? splatter->resolution : 1,
                                         &splatter->profile);
    batch->counts[index].asked += count.asked;
    batch->counts[index].lit += count.lit;
}

static ps_result add_batch(const struct batch *batch, struct error *error)
{
    struct splatter *splatter = batch->splatter;
    struct batch work = *batch;
    double start = clock_seconds();
    parallel_for(splatter->threads, (work.n + MAP_CHUNK - 1) / MAP_CHUNK, map_chunk, &work);
    double mapped = clock_seconds();
    ps_result result = bins_sort(&splatter->bins, &splatter->pyramid, work.splats, work.n,
                                 splatter->threads, error);
    double binned = clock_seconds();
    if (result != PS_OK)
        return result;
    parallel_for(splatter->threads, splatter->gbuffer->tile_count, splat_tile, &work);
    splatter->map_seconds += mapped - start;
    splatter->bin_seconds += binned - mapped;
    splatter->kernel_seconds += clock_seconds() - binned;
    uint32_t pairs = splatter->bins.offsets[splatter->bins.tile_count];
    splatter->tests += (uint64_t)pairs * PS_TILE_PIXELS;
    splatter->map_rays += (uint64_t)work.n * map_texels(splatter);
    splatter->splats += work.n;
    return PS_OK;
}

ps_result splatter_add(struct splatter *splatter, ps_splat *splats, size_t n, struct error *error)
{
    size_t tiles = splatter->gbuffer->tile_count;
    struct exact_count *counts = calloc(tiles, sizeof *counts);
    if (!counts)
        return error_memory(error, tiles * sizeof *counts, "statistics");
    ps_result result = PS_OK;
    for (size_t first = 0; first < n && result == PS_OK; first += splatter->batch) {
        size_t count = n - first < splatter->batch ? n - first : splatter->batch;
        struct batch batch = {splatter, splats + first, count, counts};
        result = add_batch(&batch, error);
    }
    for (size_t i = 0; i < tiles; i++) {
        splatter->useful_tests += counts[i].lit;
        splatter->exact_tests += counts[i].asked;
    }
    free(counts);
    return result;
}
