#include "view/fireflies.h"

#include <psplat/tile.h>
#include <stdbool.h>
#include <stdint.h>

/* t of the limit. */
#define TIMES_STOCHASTIC 2.0f
#define TIMES 4.0f
#define FEWEST 8.0f /* other pixels of the surface */

/* What a tile's fireflies share out. */
struct shares {
    float bright[PS_TILE_PIXELS]; /* before that: sum of the colours */
    float keep[PS_TILE_PIXELS];   /* of their own light */
    float r[PS_TILE_PIXELS], g[PS_TILE_PIXELS], b[PS_TILE_PIXELS]; /* what is added to each pixel */
};

static void begin(const ps_tile *tile, struct shares *shares)
{
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        shares->bright[i] = tile->irradiance_r[i] + tile->irradiance_g[i] + tile->irradiance_b[i];
        shares->keep[i] = 1.0f;
        shares->r[i] = shares->g[i] = shares->b[i] = 0.0f;
    }
}

/* Those that show the surface of a pixel: 1 for each, and 0 for itself. Returns how many. */
static float find_others(const ps_tile *tile, uint32_t lane, float others[PS_TILE_PIXELS])
{
    float count = gbuffer_alike(tile, ps_tile_position(tile, lane), ps_tile_normal(tile, lane),
                                tile->object[lane], others);
    count -= others[lane];
    others[lane] = 0.0f;
    return count;
}

/* The mean of the others, or that by their nearness if it is larger: light that is bright in a part
 * of a surface is no firefly. */
static float mean_of_others(const ps_tile *tile, uint32_t lane, const float others[PS_TILE_PIXELS],
                            float count, const struct shares *shares)
{
    ps_vec3 position = ps_tile_position(tile, lane);
    float sum = 0.0f, nearby = 0.0f, weight = 0.0f;
#pragma omp simd reduction(+ : sum, nearby, weight)
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 way = ps_subtract(ps_tile_position(tile, i), position);
        float near = others[i] * gbuffer_nearness(way);
        sum += others[i] * shares->bright[i];
        nearby += near * shares->bright[i];
        weight += near;
    }
    return ps_max(sum / count, nearby / weight);
}

/* If a pixel exceeds `times` the mean of the others, notes what it keeps and what these get.
 * Returns whether it does. */
static bool share_out(const ps_tile *tile, uint32_t lane, float times, struct shares *shares)
{
    float others[PS_TILE_PIXELS], count = find_others(tile, lane, others);
    if (count < FEWEST)
        return false;
    float bright = shares->bright[lane];
    float limit = times * mean_of_others(tile, lane, others, count, shares);
    if (!(bright > limit))
        return false;
    shares->keep[lane] = limit / bright;
    float each = (1.0f - shares->keep[lane]) / count;
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        shares->r[i] += others[i] * each * tile->irradiance_r[lane];
        shares->g[i] += others[i] * each * tile->irradiance_g[lane];
        shares->b[i] += others[i] * each * tile->irradiance_b[lane];
    }
    return true;
}

/* A cheap first test: whether at least two of the four neighbours in the tile are darker by that
 * factor (the second darkest one, by minima and maxima). Neighbours outside of the tile count as
 * equally bright. */
static bool stands_out(const float bright[PS_TILE_PIXELS], uint32_t lane, float times)
{
    uint32_t x = lane % PS_TILE_SIZE, y = lane / PS_TILE_SIZE, last = PS_TILE_SIZE - 1;
    float own = bright[lane];
    float left = x > 0 ? bright[lane - 1] : own, right = x < last ? bright[lane + 1] : own;
    float above = y > 0 ? bright[lane - PS_TILE_SIZE] : own;
    float below = y < last ? bright[lane + PS_TILE_SIZE] : own;
    float darker = ps_max(ps_min(left, right), ps_min(above, below));
    return own > times * ps_min(darker, ps_min(ps_max(left, right), ps_max(above, below)));
}

static void add(float *irradiance, const float *keep, const float *more)
{
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++)
        irradiance[i] = keep[i] * irradiance[i] + more[i];
}

void fireflies_spread(struct gbuffer *gbuffer, uint32_t index)
{
    ps_tile *tile = &gbuffer->tiles[index];
    const uint8_t *choice = &gbuffer->choice[(size_t)index * PS_TILE_PIXELS];
    struct shares shares;
    bool any = false;
    begin(tile, &shares);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        float times = choice[lane] ? TIMES_STOCHASTIC : TIMES;
        if (tile->object[lane] != PS_NO_OBJECT && stands_out(shares.bright, lane, times))
            any |= share_out(tile, lane, times, &shares);
    }
    if (!any)
        return;
    add(tile->irradiance_r, shares.keep, shares.r);
    add(tile->irradiance_g, shares.keep, shares.g);
    add(tile->irradiance_b, shares.keep, shares.b);
}
