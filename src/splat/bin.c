#include "splat/bin.h"

#include "base/parallel.h"
#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define CHUNKS 32 /* parts of a batch that are binned in parallel; fixed, so the order is */

/* One part's pairs, in splat order, and how many of them fall into each tile. */
struct bin_chunk {
    uint32_t *tiles, *splats; /* pairs */
    size_t count, capacity;
    uint32_t *counts; /* per tile; becomes the place of the next pair */
    bool failed;
    uint32_t first_subset, end_subset; /* what its splats light lies between */
    size_t lighting;                   /* how many light anything */
};

ps_result bins_create(uint32_t tile_count, struct bins *bins, struct error *error)
{
    *bins = (struct bins){.tile_count = tile_count};
    bins->offsets = calloc((size_t)tile_count + 1, sizeof *bins->offsets);
    bins->chunks = calloc(CHUNKS, sizeof *bins->chunks);
    bool whole = bins->offsets && bins->chunks;
    for (int i = 0; i < CHUNKS && whole; i++) {
        bins->chunks[i].counts = calloc(tile_count, sizeof *bins->chunks[i].counts);
        whole = bins->chunks[i].counts != NULL;
    }
    if (whole)
        return PS_OK;
    bins_release(bins);
    return error_memory(error, (size_t)tile_count * CHUNKS * sizeof(uint32_t), "bins");
}

void bins_release(struct bins *bins)
{
    for (int i = 0; i < CHUNKS && bins->chunks; i++) {
        free(bins->chunks[i].tiles);
        free(bins->chunks[i].splats);
        free(bins->chunks[i].counts);
    }
    free(bins->chunks);
    free(bins->offsets);
    free(bins->indices);
    *bins = (struct bins){.tile_count = 0};
}

size_t bins_bytes(const struct bins *bins)
{
    size_t bytes = ((size_t)bins->tile_count * (CHUNKS + 1) + bins->capacity) * sizeof(uint32_t);
    for (int i = 0; i < CHUNKS; i++)
        bytes += bins->chunks[i].capacity * 2 * sizeof(uint32_t);
    return bytes;
}

static bool reserve_pair(struct bin_chunk *chunk)
{
    if (chunk->count < chunk->capacity)
        return true;
    size_t capacity = chunk->capacity ? 2 * chunk->capacity : 1024;
    uint32_t *tiles = realloc(chunk->tiles, capacity * sizeof *tiles);
    if (tiles)
        chunk->tiles = tiles;
    uint32_t *splats = realloc(chunk->splats, capacity * sizeof *splats);
    if (splats)
        chunk->splats = splats;
    if (!tiles || !splats)
        return false;
    chunk->capacity = capacity;
    return true;
}

static void add_pair(struct bin_chunk *chunk, uint32_t tile, uint32_t splat)
{
    if (!reserve_pair(chunk)) {
        chunk->failed = true;
        return;
    }
    assert(chunk->count < chunk->capacity);
    chunk->tiles[chunk->count] = tile;
    chunk->splats[chunk->count++] = splat;
    chunk->counts[tile]++;
}

struct sort {
    struct bins *bins;
    const struct pyramid *pyramid;
    const struct kernel_variant *kernel;
    const struct kernel_splat *splats;
    size_t n;
};

static size_t first_of_part(const struct sort *sort, uint64_t index)
{
    return sort->n * index / CHUNKS;
}

/* The splat that is being binned, and where its pairs go. */
struct binning {
    struct bin_chunk *chunk;
    uint32_t splat;
};

static bool visit(void *user, uint32_t tile)
{
    const struct binning *binning = user;
    add_pair(binning->chunk, tile, binning->splat);
    return true;
}

static void bin_part(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct sort *sort = user;
    struct bin_chunk *chunk = &sort->bins->chunks[index];
    chunk->count = 0;
    chunk->failed = false;
    const struct bins *bins = sort->bins;
    memset(chunk->counts + bins->first_tile, 0,
           (bins->end_tile - bins->first_tile) * sizeof *chunk->counts);
    for (size_t i = first_of_part(sort, index); i < first_of_part(sort, index + 1); i++) {
        struct binning binning = {chunk, (uint32_t)i};
        if (sort->splats[i].kernel_scale > 0.0f)
            pyramid_visit(sort->pyramid, sort->kernel, &sort->splats[i], visit, &binning);
    }
}

/* Turns counts into places: tile by tile, and within a tile part by part. Returns the number of
 * pairs. */
static uint64_t place_counts(struct bins *bins)
{
    uint64_t place = 0;
    for (uint32_t tile = bins->first_tile; tile < bins->end_tile; tile++) {
        bins->offsets[tile] = (uint32_t)place;
        for (int part = 0; part < CHUNKS; part++) {
            uint32_t count = bins->chunks[part].counts[tile];
            bins->chunks[part].counts[tile] = (uint32_t)place;
            place += count;
        }
    }
    bins->offsets[bins->end_tile] = (uint32_t)place;
    return place;
}

static void scatter_part(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct sort *sort = user;
    struct bin_chunk *chunk = &sort->bins->chunks[index];
    for (size_t i = 0; i < chunk->count; i++)
        sort->bins->indices[chunk->counts[chunk->tiles[i]]++] = chunk->splats[i];
}

static ps_result reserve_indices(struct bins *bins, uint64_t pairs, struct error *error)
{
    if (pairs > UINT32_MAX)
        return error_set(error, PS_ERROR_INVALID,
                         "splats this large touch too many tiles at once; try a smaller --batch");
    if (pairs <= bins->capacity)
        return PS_OK;
    size_t capacity = pairs + pairs / 2;
    uint32_t *indices = malloc(capacity * sizeof *indices);
    if (!indices)
        return error_memory(error, capacity * sizeof *indices, "bins");
    free(bins->indices);
    bins->indices = indices;
    bins->capacity = capacity;
    return PS_OK;
}

static void look_at_part(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct sort *sort = user;
    struct bin_chunk *chunk = &sort->bins->chunks[index];
    chunk->first_subset = sort->pyramid->subsets;
    chunk->end_subset = 0;
    chunk->lighting = 0;
    for (size_t i = first_of_part(sort, index); i < first_of_part(sort, index + 1); i++) {
        const struct kernel_splat *splat = &sort->splats[i];
        if (!(splat->kernel_scale > 0.0f))
            continue;
        uint32_t subset = splat->subset;
        chunk->lighting++;
        chunk->first_subset = subset < chunk->first_subset ? subset : chunk->first_subset;
        chunk->end_subset = subset >= chunk->end_subset ? subset + 1 : chunk->end_subset;
    }
}

static void find_range(struct sort *sort, struct workers *workers)
{
    struct bins *bins = sort->bins;
    uint32_t each = sort->pyramid->tiles_across * sort->pyramid->tiles_down;
    uint32_t first = sort->pyramid->subsets, end = 0;
    parallel_for(workers, CHUNKS, look_at_part, sort);
    bins->lighting = 0;
    for (int i = 0; i < CHUNKS; i++) {
        const struct bin_chunk *chunk = &bins->chunks[i];
        bins->lighting += chunk->lighting;
        first = chunk->first_subset < first ? chunk->first_subset : first;
        end = chunk->end_subset > end ? chunk->end_subset : end;
    }
    bins->first_tile = first < end ? first * each : 0;
    bins->end_tile = end * each;
}

ps_result bins_sort(struct bins *bins, const struct pyramid *pyramid,
                    const struct kernel_variant *kernel, const struct kernel_splat *splats,
                    size_t n, struct workers *workers, struct error *error)
{
    struct sort sort = {bins, pyramid, kernel, splats, n};
    find_range(&sort, workers);
    parallel_for(workers, CHUNKS, bin_part, &sort);
    for (int i = 0; i < CHUNKS; i++)
        if (bins->chunks[i].failed)
            return error_memory(error, bins->chunks[i].capacity * 2 * sizeof(uint32_t), "bins");
    ps_result result = reserve_indices(bins, place_counts(bins), error);
    if (result == PS_OK)
        parallel_for(workers, CHUNKS, scatter_part, &sort);
    return result;
}
