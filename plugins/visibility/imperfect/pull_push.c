#include "pull_push.h"

#include <string.h>

/* Neighbouring texels whose depths are more than so many texels apart see two surfaces. */
#define SAME_SURFACE 4.0f

/* Whether one of the `reach` texels from (x, y) on in a direction is nearer than `limit`. */
static int is_closed(const float *depths, int side, int x, int y, int dx, int dy, int reach,
                     float limit)
{
    for (int i = 0; i < reach; i++) {
        x += dx;
        y += dy;
        if (x < 0 || y < 0 || x >= side || y >= side)
            return 0;
        if (depths[y * side + x] < limit)
            return 1;
    }
    return 0;
}

/* Marks texels that look through a hole between a surface's points: in all four directions there is
 * a surface far in front within `reach` texels. Opens them in place: an opened texel counts as far
 * behind. Where nothing lies behind, texels are open from the start; those that are not closed in
 * are no holes but see past everything. */
static void open_holes(float *depths, int side, int reach, float apart, uint8_t *holes)
{
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            float limit = depths[y * side + x] - apart;
            int hole = is_closed(depths, side, x, y, -1, 0, reach, limit) &&
                       is_closed(depths, side, x, y, 1, 0, reach, limit) &&
                       is_closed(depths, side, x, y, 0, -1, reach, limit) &&
                       is_closed(depths, side, x, y, 0, 1, reach, limit);
            holes[y * side + x] = (uint8_t)hole;
            if (hole)
                depths[y * side + x] = INFINITY;
        }
}

/* Mean depth of the texels of a block of four that lie within `apart` of the nearest: a hole
 * belongs to the surface in front. */
static float pull_block(const float *depths, uint32_t side, uint32_t left, uint32_t top,
                        float apart)
{
    float nearest = INFINITY, sum = 0;
    int count = 0;
    for (uint32_t y = top; y < top + 2 && y < side; y++)
        for (uint32_t x = left; x < left + 2 && x < side; x++)
            nearest = fminf(nearest, depths[y * side + x]);
    for (uint32_t y = top; y < top + 2 && y < side; y++)
        for (uint32_t x = left; x < left + 2 && x < side; x++)
            if (depths[y * side + x] < INFINITY && depths[y * side + x] <= nearest + apart) {
                sum += depths[y * side + x];
                count++;
            }
    return count ? sum / (float)count : INFINITY;
}

/* The depth of a flat surface at an open texel, from two texels on opposite sides that lie on one
 * surface; INFINITY if there are none. */
static float bridge(const float *depths, uint32_t side, uint32_t x, uint32_t y, float apart)
{
    const float *at = &depths[y * side + x];
    float best = INFINITY;
    if (x > 0 && x + 1 < side && fabsf(at[-1] - at[1]) <= apart)
        best = 0.5f * (at[-1] + at[1]);
    if (y > 0 && y + 1 < side && fabsf(at[-(int)side] - at[side]) <= apart)
        best = fminf(best, 0.5f * (at[-(int)side] + at[side]));
    return best;
}

/* Fills open texels from what is beside them, or from the level above, which is filled first. */
static void pull_push(float *depths, uint32_t side, int64_t levels, float apart)
{
    float above[PS_MOST_TEXELS / 2 * PS_MOST_TEXELS / 2];
    uint32_t half = (side + 1) / 2;
    if (levels == 0 || side < 2)
        return;
    for (uint32_t y = 0; y < side; y += 2)
        for (uint32_t x = 0; x < side; x += 2)
            above[y / 2 * half + x / 2] = pull_block(depths, side, x, y, apart);
    pull_push(above, half, levels - 1, 2.0f * apart);
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side; x++) {
            float *depth = &depths[y * side + x];
            if (*depth < INFINITY)
                continue;
            float between = bridge(depths, side, x, y, 2.0f * apart);
            *depth = between < INFINITY ? between : above[y / 2 * half + x / 2];
        }
}

void imperfect_fill_holes(float *depths, uint32_t side, int64_t levels, float texel)
{
    float filled[PS_MOST_TEXELS * PS_MOST_TEXELS];
    uint8_t holes[PS_MOST_TEXELS * PS_MOST_TEXELS] = {0};
    if (levels == 0)
        return;
    open_holes(depths, (int)side, 1 << (levels - 1), SAME_SURFACE * texel, holes);
    memcpy(filled, depths, side * side * sizeof *filled);
    pull_push(filled, side, levels, SAME_SURFACE * texel);
    for (uint32_t i = 0; i < side * side; i++)
        depths[i] = holes[i] ? filled[i] : depths[i];
}
