#include "film/apron.h"

#include <math.h>
#include <psplat/math.h>

/* How far pixels may lie off the plane, in parts of the distance between neighbours, which is
 * squared: far less than gbuffer_same_surface allows. */
#define MOST_OFF2 (0.005f * 0.005f)

static bool has_one_normal(const struct apron_surfaces *at, int first, int end)
{
    float nx = at->normal_x[APRON_MARGIN][APRON_MARGIN],
          ny = at->normal_y[APRON_MARGIN][APRON_MARGIN],
          nz = at->normal_z[APRON_MARGIN][APRON_MARGIN];
    int others = 0;
    for (int row = first; row < end; row++)
        for (int i = first; i < end; i++)
            others += (at->normal_x[row][i] != nx) | (at->normal_y[row][i] != ny) |
                      (at->normal_z[row][i] != nz);
    return others == 0 && nx * nx + ny * ny + nz * nz > 0.5f;
}

/* Squared: how far pixels lie off the plane of the tile's first one at most. */
static float most_off(const struct apron_surfaces *at, int first, int end)
{
    const int m = APRON_MARGIN;
    float nx = at->normal_x[m][m], ny = at->normal_y[m][m], nz = at->normal_z[m][m], most = 0.0f;
    for (int row = first; row < end; row++)
        for (int i = first; i < end; i++) {
            float off = nx * (at->position_x[row][i] - at->position_x[m][m]) +
                        ny * (at->position_y[row][i] - at->position_y[m][m]) +
                        nz * (at->position_z[row][i] - at->position_z[m][m]);
            most = ps_max(most, off * off);
        }
    return most;
}

/* Squared: how far apart pixels are at least that lie beside each other. */
static float least_spacing(const struct apron_surfaces *at, int first, int end, int down, int right)
{
    float least = INFINITY;
    for (int row = first; row < end - down; row++)
        for (int i = first; i < end - right; i++) {
            float x = at->position_x[row + down][i + right] - at->position_x[row][i];
            float y = at->position_y[row + down][i + right] - at->position_y[row][i];
            float z = at->position_z[row + down][i + right] - at->position_z[row][i];
            least = ps_min(least, x * x + y * y + z * z);
        }
    return least;
}

bool apron_is_flat(const struct apron_surfaces *at, int radius)
{
    int first = APRON_MARGIN - radius, end = APRON_MARGIN + PS_TILE_SIZE + radius;
    if (!has_one_normal(at, first, end))
        return false;
    float spacing =
        ps_min(least_spacing(at, first, end, 0, 1), least_spacing(at, first, end, 1, 0));
    return most_off(at, first, end) <= MOST_OFF2 * spacing;
}

void apron_sum(const float from[APRON_SIDE][APRON_SIDE], int radius, float border,
               float to[PS_TILE_SIZE][PS_TILE_SIZE])
{
    for (int row = 0; row < PS_TILE_SIZE; row++) {
        float columns[APRON_SIDE] = {0}, sums[PS_TILE_SIZE] = {0};
        for (int dy = -radius; dy <= radius; dy++) {
            float share = dy == -radius || dy == radius ? border : 1.0f;
            for (int i = 0; i < APRON_SIDE; i++)
                columns[i] += share * from[APRON_MARGIN + row + dy][i];
        }
        for (int dx = -radius; dx <= radius; dx++) {
            float share = dx == -radius || dx == radius ? border : 1.0f;
            for (int i = 0; i < PS_TILE_SIZE; i++)
                sums[i] += share * columns[APRON_MARGIN + i + dx];
        }
        for (int i = 0; i < PS_TILE_SIZE; i++)
            to[row][i] = sums[i];
    }
}
