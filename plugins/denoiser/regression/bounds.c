#include "bounds.h"

#include "fit.h"

_Static_assert(sizeof(struct regression_bounds) <=
                   (size_t)REGRESSION_BOUNDS_PIXEL * (size_t)REGRESSION_LANES,
               "bounds of a run");

/* Of one plane, over the pixels of a run that show a surface. */
static void find_extent(const float *plane, const float *size, float *centre, float *extent)
{
    float least = INFINITY, most = -INFINITY;
    for (int i = 0; i < REGRESSION_LANES; i++)
        if (size[i] > 0.0f) {
            least = ps_min(least, plane[i]);
            most = ps_max(most, plane[i]);
        }
    *centre = least <= most ? 0.5f * (least + most) : 0.0f;
    *extent = least <= most ? ps_max(most - *centre, *centre - least) : 0.0f;
}

static void find_bounds_of_row(void *user, uint64_t row, uint32_t worker)
{
    (void)worker;
    const struct regression *of = user;
    int end = (int)of->width + REGRESSION_MARGIN;
    for (int x = -REGRESSION_MARGIN; x < end; x += REGRESSION_LANES) {
        size_t at = regression_at(of, x, (int)row);
        struct regression_bounds *bounds = &of->bounds[at / of->runs_apart];
        const float *size = of->size + at;
        for (int i = 0; i < 3; i++) {
            find_extent(of->normal[i] + at, size, &bounds->normal[i], &bounds->normal_extent[i]);
            find_extent(of->position[i] + at, size, &bounds->position[i],
                        &bounds->position_extent[i]);
        }
        find_extent(of->gloss + at, size, &bounds->gloss, &bounds->gloss_extent);
    }
}

size_t regression_bounds_bytes(size_t width, size_t height)
{
    return regression_runs(width, height) * sizeof(struct regression_bounds);
}

void regression_bounds_find(const struct regression *regression)
{
    struct regression of = *regression;
    of.host->parallel_for(of.host, of.height, find_bounds_of_row, &of);
}
