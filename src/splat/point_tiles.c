#include "splat/point_tiles.h"

#include "splat/pyramid.h"
#include <assert.h>

struct interleaved point_tiles_layout(size_t n)
{
    size_t count = (n + PS_TILE_PIXELS - 1) / PS_TILE_PIXELS;
    uint32_t side = 1; /* of a full square */
    while ((size_t)side * side * PYRAMID_GROUP * PYRAMID_GROUP < count)
        side *= PYRAMID_GROUP;
    /* A part of the next larger square: lines of full ones, of which the last is all there. */
    uint32_t squares = (uint32_t)((count + (size_t)side * side - 1) / ((size_t)side * side));
    uint32_t across = squares < PYRAMID_GROUP ? squares : PYRAMID_GROUP;
    struct interleaved tiles = {
        .interleave = 1,
        .subsets = 1,
        .tiles_across = across * side,
        .tiles_down = (squares + PYRAMID_GROUP - 1) / PYRAMID_GROUP * side,
        .width = n,
        .height = 1,
    };
    assert(n > 0);
    tiles.tile_count = tiles.tiles_across * tiles.tiles_down;
    return tiles;
}

/* The number of a tile, in the order of points, by its place in the grid. */
static size_t number_of(const struct interleaved *tiles, uint32_t tile)
{
    uint32_t x = tile % tiles->tiles_across, y = tile / tiles->tiles_across;
    size_t number = 0, digit = 1;
    for (; x > 0 || y > 0; x /= PYRAMID_GROUP, y /= PYRAMID_GROUP) {
        number += digit * (y % PYRAMID_GROUP * PYRAMID_GROUP + x % PYRAMID_GROUP);
        digit *= (size_t)PYRAMID_GROUP * PYRAMID_GROUP;
    }
    return number;
}

struct filling {
    struct interleaved *tiles;
    const ps_vec3 *positions, *normals;
};

static void fill_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct filling *work = user;
    struct interleaved_tile *tile = &work->tiles->tiles[index];
    size_t first = number_of(work->tiles, (uint32_t)index) * PS_TILE_PIXELS;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        if (first + lane < work->tiles->width)
            interleaved_set_lane(tile, lane, work->positions[first + lane],
                                 work->normals[first + lane]);
        else
            interleaved_clear_lane(tile, lane);
    }
    interleaved_begin_tile(tile);
}

void point_tiles_fill(struct interleaved *tiles, const ps_vec3 *positions, const ps_vec3 *normals,
                      struct workers *workers)
{
    struct filling work = {tiles, positions, normals};
    parallel_for(workers, tiles->tile_count, fill_tile, &work);
}

void point_tiles_read(const struct interleaved *tiles, ps_rgb *irradiance)
{
    for (uint32_t i = 0; i < tiles->tile_count; i++) {
        const struct interleaved_tile *tile = &tiles->tiles[i];
        size_t first = number_of(tiles, i) * PS_TILE_PIXELS;
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS && first + lane < tiles->width; lane++)
            irradiance[first + lane] = (ps_rgb){tile->irradiance_r[lane], tile->irradiance_g[lane],
                                                tile->irradiance_b[lane]};
    }
}
