#include "view/fireflies.h"

#include <psplat/tile.h>
#include <stdbool.h>
#include <stdint.h>

#define TOO_BRIGHT 2.0f /* times the mean of the others, and that of those nearby */
#define FEWEST 8.0f     /* of which there must be so many */

/* What a tile's fireflies share out. */
struct shares {
    float keep[PS_TILE_PIXELS];                                    /* of their own light */
    float r[PS_TILE_PIXELS], g[PS_TILE_PIXELS], b[PS_TILE_PIXELS]; /* what is added to each pixel */
};

static float brightness(const ps_tile *tile, uint32_t lane)
{
    return tile->irradiance_r[lane] + tile->irradiance_g[lane] + tile->irradiance_b[lane];
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

/* The mean of the others, or that by their nearness if it is larger: light that is bright in a part of a surface is no firefly. */
static float mean_brightness(const ps_tile *tile, uint32_t lane, const float others[PS_TILE_PIXELS],
                             float count)
{
    ps_vec3 position = ps_tile_position(tile, lane);
    float sum = 0.0f, nearby = 0.0f, weight = 0.0f;
#pragma omp simd reduction(+ : sum, nearby, weight)
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 way = ps_subtract(ps_tile_position(tile, i), position);
        float near = others[i] * gbuffer_nearness(way), bright = brightness(tile, i);
        sum += others[i] * bright;
        nearby += near * bright;
        weight += near;
    }
    return ps_max(sum / count, nearby / weight);
}

/* Whether a pixel is one: then it gives. */
static bool share_out(const ps_tile *tile, uint32_t lane, struct shares *shares)
{
    float others[PS_TILE_PIXELS], count = find_others(tile, lane, others);
    if (count < FEWEST)
        return false;
    float bright = brightness(tile, lane);
    float limit = TOO_BRIGHT * mean_brightness(tile, lane, others, count);
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

static void add(float *irradiance, const float *keep, const float *more)
{
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++)
        irradiance[i] = keep[i] * irradiance[i] + more[i];
}

void fireflies_spread(struct gbuffer *gbuffer, uint32_t index)
{
    ps_tile *tile = &gbuffer->tiles[index];
    const bool *by_chance = &gbuffer->by_chance[(size_t)index * PS_TILE_PIXELS];
    struct shares shares = {.keep = {0.0f}};
    bool any = false;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        shares.keep[lane] = 1.0f;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        if (by_chance[lane] && tile->object[lane] != PS_NO_OBJECT)
            any |= share_out(tile, lane, &shares);
    if (!any)
        return;
    add(tile->irradiance_r, shares.keep, shares.r);
    add(tile->irradiance_g, shares.keep, shares.g);
    add(tile->irradiance_b, shares.keep, shares.b);
}
