#include "short_range/short_range_rays.h"

#include "placement/gather_share.h"
#include <math.h>
#include <psplat/path.h>

#define TILES_AT_A_TIME 256 /* until the user may stop */

/* Shoots one ray from each point, and moves what they meet to the front; returns how many.
 * targets[i]: the point of hit i. */
static size_t look(const struct gather_rays *pass_rays, const ps_points *points, uint32_t set,
                   const uint64_t *indices, ps_ray *rays, ps_hit *hits, uint32_t *targets)
{
    const ps_host *host = pass_rays->host;
    float offset = pass_rays->pass->surface_offset;
    float numbers[PS_TILE_PIXELS][4], spreads[PS_TILE_PIXELS];
    size_t met = 0;
    host->samples(host, PS_STREAM_PATH, set, indices, points->count, numbers);
    for (uint32_t i = 0; i < points->count; i++) {
        ps_vec3 normal = points->normals[i];
        rays[i] =
            ps_leave_surface(points->positions[i], normal,
                             ps_cosine_direction(normal, numbers[i][0], numbers[i][1]), offset);
        rays[i].tfar = pass_rays->near->distance;
        spreads[i] = PS_DIFFUSE_SPREAD;
        targets[i] = i;
    }
    host->intersect_cones(host, rays, spreads, points->count, hits);
    ps_forget_own_surface(points, targets, points->count, offset, hits);
    for (uint32_t i = 0; i < points->count; i++) {
        if (!(hits[i].distance < INFINITY))
            continue;
        targets[met] = i;
        rays[met] = rays[i];
        hits[met] = hits[i];
        hits[met++].flags &= ~PS_HIT_SPECULAR; /* gloss is splatted */
    }
    return met;
}

size_t gather_rays_shoot(const struct gather_rays *pass_rays, const ps_points *points,
                         struct gather_streams numbers, uint64_t *indices, uint32_t *targets,
                         ps_rgb *radiance)
{
    const ps_host *host = pass_rays->host;
    ps_ray rays[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    size_t met = look(pass_rays, points, numbers.directions, indices, rays, hits, targets);
    for (size_t i = 0; i < met; i++)
        indices[i] = indices[targets[i]]; /* targets[i] >= i */
    host->direct_radiance(host, rays, hits, PS_STREAM_PATH, numbers.lights, indices, met, radiance);
    struct gather_share share = gather_share_until(pass_rays->near->distance);
    for (size_t i = 0; i < met; i++) {
        float left = 1.0f - gather_share_of_splats(share, hits[i].distance);
        radiance[i] = ps_rgb_scale(radiance[i], left);
    }
    return met;
}

void gather_rays_move(ps_points *points, size_t from, size_t to)
{
    points->positions[to] = points->positions[from];
    points->normals[to] = points->normals[from];
    points->lanes[to] = points->lanes[from];
}

ps_result gather_rays_over_tiles(struct gather_rays *rays, uint32_t tiles, ps_body body, void *user)
{
    for (rays->first_tile = 0; rays->first_tile < tiles; rays->first_tile += TILES_AT_A_TIME) {
        uint64_t left = tiles - rays->first_tile;
        if (rays->host->cancelled(rays->host))
            return PS_CANCELLED;
        rays->host->parallel_for(rays->host, left < TILES_AT_A_TIME ? left : TILES_AT_A_TIME, body,
                                 user);
    }
    return PS_OK;
}
