/* sampled_tiles.h: some tiles that stand for all of the picture.
 *
 * What goes by the whole picture must be the same for whatever part of it is rendered, and must not
 * cost more as the picture grows. So it goes by all tiles of a small picture, and by some of a
 * large one, which are spread over it as by lot.
 */
#ifndef PSPLAT_ESTIMATOR_SAMPLED_TILES_H
#define PSPLAT_ESTIMATOR_SAMPLED_TILES_H

#include <stdbool.h>
#include <stdint.h>

/* Whether a tile of a picture of `count` is one of those, which are about `most`, or all where
 * there are no more. */
static inline bool tile_is_sampled(uint32_t tile, uint32_t count, uint32_t most)
{
    uint64_t one_of = ((uint64_t)count + most - 1) / most, key = tile;
    if (one_of <= 1)
        return true;
    key = (key + UINT64_C(0x9e3779b97f4a7c15)) * UINT64_C(0xbf58476d1ce4e5b9);
    key = (key ^ (key >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (key ^ (key >> 31)) % one_of == 0;
}

#endif
