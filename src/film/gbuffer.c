#include "film/gbuffer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Outside of any scene, yet its square is finite. */
#define NOWHERE 1e18f

ps_result gbuffer_create(size_t width, size_t height, struct gbuffer *gbuffer, struct error *error)
{
    uint32_t across = (uint32_t)((width + PS_TILE_SIZE - 1) / PS_TILE_SIZE);
    uint32_t down = (uint32_t)((height + PS_TILE_SIZE - 1) / PS_TILE_SIZE);
    *gbuffer = (struct gbuffer){
        .width = width,
        .height = height,
        .tiles_across = across,
        .tiles_down = down,
        .tile_count = across * down,
    };
    gbuffer->tiles = aligned_alloc(64, gbuffer->tile_count * sizeof(ps_tile));
    gbuffer->direct = malloc((size_t)gbuffer->tile_count * PS_TILE_PIXELS * sizeof(ps_rgb));
    if (gbuffer->tiles && gbuffer->direct)
        return PS_OK;
    size_t bytes = gbuffer_bytes(gbuffer);
    gbuffer_release(gbuffer);
    return error_memory(error, bytes, "the G-buffer");
}

void gbuffer_release(struct gbuffer *gbuffer)
{
    free(gbuffer->tiles);
    free(gbuffer->direct);
    *gbuffer = (struct gbuffer){.tiles = NULL};
}

size_t gbuffer_bytes(const struct gbuffer *gbuffer)
{
    return gbuffer->tile_count * (sizeof(ps_tile) + PS_TILE_PIXELS * sizeof(ps_rgb));
}

bool gbuffer_pixel(const struct gbuffer *gbuffer, uint32_t tile, uint32_t lane, uint32_t *x,
                   uint32_t *y)
{
    *x = tile % gbuffer->tiles_across * PS_TILE_SIZE + lane % PS_TILE_SIZE;
    *y = tile / gbuffer->tiles_across * PS_TILE_SIZE + lane / PS_TILE_SIZE;
    return *x < gbuffer->width && *y < gbuffer->height;
}

static void store_hit(ps_tile *tile, uint32_t lane, const ps_hit *hit)
{
    bool seen = hit->distance < INFINITY;
    ps_vec3 position = seen ? hit->position : (ps_vec3){NOWHERE, NOWHERE, NOWHERE};
    ps_vec3 normal = seen ? hit->normal : (ps_vec3){0, 0, 0};
    ps_rgb albedo = seen ? hit->albedo : (ps_rgb){0, 0, 0};
    tile->position_x[lane] = position.x;
    tile->position_y[lane] = position.y;
    tile->position_z[lane] = position.z;
    tile->normal_x[lane] = normal.x;
    tile->normal_y[lane] = normal.y;
    tile->normal_z[lane] = normal.z;
    tile->albedo_r[lane] = albedo.r;
    tile->albedo_g[lane] = albedo.g;
    tile->albedo_b[lane] = albedo.b;
    tile->depth[lane] = hit->distance;
    tile->object[lane] = seen ? hit->object : PS_NO_OBJECT;
    tile->material[lane] = seen ? hit->material : PS_NO_OBJECT;
}

/* Lane of number i when a tile is walked in 4x4 blocks, so that each packet of 16 rays is compact.
 */
static uint32_t block_lane(uint32_t i)
{
    uint32_t block = i / 16, inside = i % 16;
    uint32_t x = block % 4 * 4 + inside % 4, y = block / 4 * 4 + inside / 4;
    return y * PS_TILE_SIZE + x;
}

void gbuffer_trace_tile(struct gbuffer *gbuffer, const struct trace *trace,
                        const struct camera *camera, uint32_t index, float jitter_x, float jitter_y)
{
    ps_tile *tile = &gbuffer->tiles[index];
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        uint32_t x, y;
        gbuffer_pixel(gbuffer, index, block_lane(i), &x, &y);
        rays[i] = camera_ray(camera, (float)x + jitter_x, (float)y + jitter_y);
    }
    trace_intersect(trace, RAYS_COHERENT, rays, PS_TILE_PIXELS, hits);
    memset(tile, 0, sizeof *tile);
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        uint32_t x, y, lane = block_lane(i);
        static const ps_hit outside = {.distance = INFINITY};
        bool inside = gbuffer_pixel(gbuffer, index, lane, &x, &y);
        store_hit(tile, lane, inside ? &hits[i] : &outside);
    }
}

void gbuffer_clear_indirect(struct gbuffer *gbuffer)
{
    for (uint32_t i = 0; i < gbuffer->tile_count; i++) {
        ps_tile *tile = &gbuffer->tiles[i];
        memset(tile->irradiance_r, 0, sizeof tile->irradiance_r);
        memset(tile->irradiance_g, 0, sizeof tile->irradiance_g);
        memset(tile->irradiance_b, 0, sizeof tile->irradiance_b);
        memset(tile->weight, 0, sizeof tile->weight);
    }
}
