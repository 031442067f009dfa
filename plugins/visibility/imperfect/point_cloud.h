/* point_cloud.h: points that stand for the scene's surfaces, in a grid.
 *
 * A plugin gets rays, not triangles, so points come from random lines (Cauchy-Crofton): a line that
 * is uniform over the lines through the scene's sphere meets a surface of area A
 *
 *     A / (2 pi r^2)
 *
 * times on average, whatever its shape and however it is hidden, so all crossings of such lines are
 * points uniform over all area; and how many lines it took tells the area that each stands for.
 */
#ifndef PSPLAT_VISIBILITY_IMPERFECT_POINT_CLOUD_H
#define PSPLAT_VISIBILITY_IMPERFECT_POINT_CLOUD_H

#include <psplat/plugin.h>
#include <stdbool.h>

struct point {
    ps_vec3 position, normal;
};

struct point_cloud {
    struct point *points; /* cell by cell; owned */
    uint32_t *cells;      /* cells[c]..cells[c + 1]: points of cell c; owned */
    size_t count;
    float disc;  /* radius of a point */
    ps_vec3 low; /* corner of the grid */
    float cell;  /* side of a cell */
    int across;  /* cells along each axis */
};

/* Of `wanted` points, or fewer where there are hardly any surfaces. False where there is no memory:
 * it then holds nothing. To be released. */
bool imperfect_cloud_create(const ps_host *host, size_t wanted, struct point_cloud *cloud);
void imperfect_cloud_release(const ps_host *host, struct point_cloud *cloud);

/* The cell at x, in cells; what lies outside counts to the cells at the border. */
static inline int cell_at(const struct point_cloud *cloud, float x)
{
    return (int)fminf(fmaxf(x, 0.0f), (float)(cloud->across - 1));
}

static inline size_t cell_index(const struct point_cloud *cloud, int x, int y, int z)
{
    size_t across = (size_t)cloud->across;
    return ((size_t)z * across + (size_t)y) * across + (size_t)x;
}

#endif
