#include "kinds.h"

/* A pixel is compared with 24 others on a grid of STEP pixels, up to REACH steps away. It is THIN
 * if fewer than FEW of them show its surface. */
#define REACH 2
#define STEP 3
#define FEW 6

#define GLOSS 0.125f /* share of the reflectance, above which light is mostly mirrored */

static bool is_thin(const struct regression *guides, int x, int y)
{
    size_t at = regression_at(guides, x, y);
    int like = 0;
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++) {
            size_t other = regression_at(guides, x + STEP * dx, y + STEP * dy);
            if (other == at || !regression_is_like(guides, at, other))
                continue;
            if (++like == FEW)
                return false;
        }
    return true;
}

static enum pixel_kind kind_of(const struct regression *guides, int x, int y)
{
    if (!regression_shows_surface(guides, x, y))
        return NO_KIND;
    if (guides->gloss[regression_at(guides, x, y)] > GLOSS)
        return GLOSSY;
    return is_thin(guides, x, y) ? THIN : BROAD;
}

static void find_kinds_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct denoised_image *image = user;
    for (size_t x = 0; x < image->width; x++)
        image->kind[row * image->width + x] = (float)kind_of(&image->guides, (int)x, (int)row);
}

void regression_kinds_find(struct denoised_images *images)
{
    struct denoised_image *first = &images->of[0]; /* all show the same surfaces */
    first->host->parallel_for(first->host, first->height, find_kinds_of_row, first);
    for (size_t i = 0; i < first->width * first->height; i++)
        images->has[(int)first->kind[i]] = true;
}
