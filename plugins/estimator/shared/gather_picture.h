/* gather_picture.h: the final gather of a pass's pixels, with more samples in tiles that need them
 * (allocation.h). */
#ifndef PSPLAT_ESTIMATOR_GATHER_PICTURE_H
#define PSPLAT_ESTIMATOR_GATHER_PICTURE_H

#include "allocation.h"
#include "gather_rays.h"
#include <stdbool.h>

enum {
    GATHER_MOST_OF_SAMPLES = 4
}; /* times the samples, that a tile takes at most: setting->most */

/* What gather_picture() allocates for each pixel, when it is adaptive. */
#define GATHER_PIXEL_BYTES (sizeof(struct gather_first) / PS_TILE_PIXELS)

/* How the samples of a pass are allocated to the picture's tiles. */
struct gather_allocation {
    bool is_known; /* by an earlier part of the picture */
    struct allocation by_error;
};

/* Adds what setting->samples of each pixel find. `adaptive`: so many on average, more where they
 * are needed, by `allocation`, which is found where it is not known. PS_ERROR_MEMORY or
 * PS_CANCELLED. */
ps_result gather_picture(const struct gather_setting *setting, bool adaptive,
                         struct gather_allocation *allocation);

#endif
