/* edge_find.c: which pixels are edges; see edges.h. */
#include "pipeline/edges.h"

#include <psplat/tile.h>

/* Radiance and albedo differ where they do by more than this share of the larger one. */
#define CONTRAST 0.25f

/* Neighbours that lie off each other's plane by more than this part of their distance (squared) are a
 * step; less may be a normal that is bent or smoothed. */
#define STEP2 0.25f

/* A pixel of the G-buffer. */
struct place {
    const ps_tile *tile; /* NULL: outside of the picture */
    uint32_t lane;
    ps_rgb albedo, radiance;
};

static ps_rgb albedo_of(const ps_tile *tile, uint32_t lane)
{
    return (ps_rgb){tile->albedo_r[lane] * tile->throughput_r[lane],
                    tile->albedo_g[lane] * tile->throughput_g[lane],
                    tile->albedo_b[lane] * tile->throughput_b[lane]};
}

static struct place place_of(const struct gbuffer *gbuffer, int64_t x, int64_t y)
{
    uint32_t tile, lane;
    if (!gbuffer_find(gbuffer, x, y, &tile, &lane))
        return (struct place){.tile = NULL};
    size_t pixel = (size_t)tile * PS_TILE_PIXELS + lane;
    ps_rgb albedo = albedo_of(&gbuffer->tiles[tile], lane);
    ps_rgb reflected = ps_rgb_multiply(albedo, gbuffer->direct[pixel]);
    return (struct place){
        &gbuffer->tiles[tile], lane, albedo,
        ps_rgb_add(gbuffer->emitted[pixel], ps_rgb_scale(reflected, 1.0f / PS_PI))};
}

static bool sees_surface(const struct place *place)
{
    return place->tile->object[place->lane] != PS_NO_OBJECT;
}

static bool same_object(const struct place *a, const struct place *b)
{
    return a->tile->object[a->lane] == b->tile->object[b->lane];
}

/* How far b lies off the plane of a, how far away (squared), and the cosine between both normals. */
struct offset {
    float off_plane, distance2, cosine;
};

static struct offset offset_of(const struct place *a, const struct place *b)
{
    ps_vec3 normal = ps_tile_normal(a->tile, a->lane);
    ps_vec3 way =
        ps_subtract(ps_tile_position(b->tile, b->lane), ps_tile_position(a->tile, a->lane));
    return (struct offset){ps_dot(normal, way), ps_dot(way, way),
                           ps_dot(normal, ps_tile_normal(b->tile, b->lane))};
}

static bool surfaces_differ(const struct place *a, const struct place *b)
{
    struct offset offset = offset_of(a, b);
    return !same_object(a, b) || offset.cosine < 0.9f ||
           offset.off_plane * offset.off_plane > STEP2 * offset.distance2;
}

static bool numbers_differ(float a, float b)
{
    return fabsf(a - b) > CONTRAST * fmaxf(a, b);
}

static bool colors_differ(ps_rgb a, ps_rgb b)
{
    return numbers_differ(a.r, b.r) || numbers_differ(a.g, b.g) || numbers_differ(a.b, b.b);
}

static bool places_differ(const struct place *a, const struct place *b)
{
    if (sees_surface(a) != sees_surface(b))
        return true;
    if (sees_surface(a) && surfaces_differ(a, b))
        return true;
    return colors_differ(a->albedo, b->albedo) || colors_differ(a->radiance, b->radiance);
}

#define SIDE (PS_TILE_SIZE + 2) /* of a tile and the pixels around it */

/* One of SIDE x SIDE places, and not at their rim. */
static bool differs_from_around(const struct place *here)
{
    const struct place *around[4] = {here - 1, here + 1, here - SIDE, here + SIDE};
    for (int i = 0; i < 4; i++)
        if (around[i]->tile && places_differ(here, around[i]))
            return true;
    return false;
}

void edges_find(const struct gbuffer *gbuffer, uint32_t tile, bool edges[PS_TILE_PIXELS])
{
    struct place places[SIDE][SIDE];
    int64_t left = (int64_t)(tile % gbuffer->tiles_across) * PS_TILE_SIZE - 1;
    int64_t top = (int64_t)(tile / gbuffer->tiles_across) * PS_TILE_SIZE - 1;
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++)
            places[row][column] = place_of(gbuffer, left + column, top + row);
    const bool *by_chance = &gbuffer->by_chance[(size_t)tile * PS_TILE_PIXELS];
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t row = lane / PS_TILE_SIZE + 1, column = lane % PS_TILE_SIZE + 1;
        const struct place *here = &places[row][column];
        edges[lane] = here->tile && (by_chance[lane] || differs_from_around(here));
    }
}
