#include "camera.h"

float camera_ray_to(const struct bdpt *bdpt, ps_vec3 position, ps_vec3 geometric_normal,
                    ps_ray *ray)
{
    const ps_camera *camera = &bdpt->camera;
    ps_vec3 origin = ps_add_scaled(position, bdpt->pass->surface_offset, geometric_normal);
    ps_vec3 away = ps_subtract(camera->position, origin);
    float depth = -ps_dot(away, camera->forward), distance = ps_length(away);
    float area = ps_length(camera->across) * ps_length(camera->down);
    if (!(depth > 0.0f) || camera->aperture > 0.0f)
        return 0.0f;
    if (camera->projection == PS_ORTHOGRAPHIC) {
        *ray = (ps_ray){origin, 0.0f, ps_scale(camera->forward, -1.0f), depth};
    } else {
        float cosine = depth / distance;
        *ray = (ps_ray){origin, 0.0f, ps_scale(away, 1.0f / distance), distance};
        area *= distance * distance * cosine * cosine * cosine;
    }
    return ps_max(ps_dot(ray->direction, geometric_normal), 0.0f) / area;
}

/* Whether a ray comes from the camera itself, not from a mirror or glass. */
static int is_from_camera(const struct bdpt *bdpt, const ps_ray *ray)
{
    const ps_camera *camera = &bdpt->camera;
    if (camera->projection == PS_PERSPECTIVE)
        return ps_same(ray->origin, camera->position);
    float depth = ps_dot(ps_subtract(ray->origin, camera->position), camera->forward);
    return ps_same(ray->direction, camera->forward) && fabsf(depth) < bdpt->pass->surface_offset;
}

/* A shadow ray as that of a light path that gets there tells what hides the camera from the point:
 * lights that the camera does not show. */
void camera_find_sights(const struct bdpt *bdpt, uint32_t tile)
{
    struct sight *sights = &bdpt->sights[(size_t)tile * PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS], back[PS_TILE_PIXELS];
    ps_hit hits[PS_TILE_PIXELS];
    uint32_t lanes[PS_TILE_PIXELS];
    uint8_t blocked[PS_TILE_PIXELS];
    size_t count = 0;
    bdpt->host->tile_hits(bdpt->host, tile, rays, hits);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        sights[lane] = (struct sight){.density = 0.0f};
        if (hits[lane].object == PS_NO_OBJECT)
            continue;
        sights[lane].normal = hits[lane].geometric_normal;
        if (!is_from_camera(bdpt, &rays[lane]))
            continue;
        float density =
            camera_ray_to(bdpt, hits[lane].position, hits[lane].geometric_normal, &back[count]);
        sights[lane].density = density / bdpt->light_paths;
        lanes[count] = lane;
        count += density > 0.0f;
    }
    bdpt->host->occluded(bdpt->host, back, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (blocked[i])
            sights[lanes[i]].density = 0.0f;
}

/* All pixels have the same, which the first one that sees its point directly tells. */
void camera_find_jitter(struct bdpt *bdpt)
{
    const ps_host *host = bdpt->host;
    bdpt->jitter[0] = bdpt->jitter[1] = 0.5f;
    for (uint32_t tile = 0; tile < bdpt->pass->tile_count; tile++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
            uint32_t x, y;
            float place[1][2];
            if (!(bdpt->sights[(size_t)tile * PS_TILE_PIXELS + lane].density > 0.0f))
                continue;
            ps_vec3 position = ps_tile_position(host->tile(host, tile), lane);
            host->project(host, &position, 1, place);
            host->pixel(host, tile, lane, &x, &y);
            bdpt->jitter[0] = place[0][0] - (float)x;
            bdpt->jitter[1] = place[0][1] - (float)y;
            return;
        }
}

int camera_pixel_at(const struct bdpt *bdpt, const float place[2], uint32_t *tile, uint32_t *lane)
{
    float x = floorf(place[0] - bdpt->jitter[0] + 0.5f);
    float y = floorf(place[1] - bdpt->jitter[1] + 0.5f);
    if (!(x >= 0.0f && y >= 0.0f && x < (float)bdpt->pass->width && y < (float)bdpt->pass->height))
        return 0;
    return bdpt->host->tile_of(bdpt->host, (uint32_t)x, (uint32_t)y, tile, lane);
}

/* Whether light tracing lands on all pixels around. */
static int is_inside(const struct bdpt *bdpt, uint32_t x, uint32_t y)
{
    for (uint32_t i = 0; i < 9; i++) {
        uint32_t tile, lane;
        if (!bdpt->host->tile_of(bdpt->host, x + i % 3 - 1, y + i / 3 - 1, &tile, &lane))
            continue; /* outside of the picture */
        if (!(bdpt->sights[(size_t)tile * PS_TILE_PIXELS + lane].density > 0.0f))
            return 0;
    }
    return 1;
}

static ps_ray ray_through(const struct bdpt *bdpt, float x, float y)
{
    const ps_camera *camera = &bdpt->camera;
    ps_vec3 to = ps_add_scaled(ps_add_scaled(camera->corner, x, camera->across), y, camera->down);
    if (camera->projection == PS_PERSPECTIVE)
        return (ps_ray){camera->position, 0.0f, ps_normalize(to), INFINITY};
    ps_vec3 origin = ps_add(camera->position, ps_subtract(to, camera->forward));
    return (ps_ray){origin, 0.0f, camera->forward, INFINITY};
}

/* Rays through the square of a pixel; the middle one meets the pixel's own point. */
#define SHARE_SIDE 5

static float share_at(const struct bdpt *bdpt, uint32_t x, uint32_t y)
{
    ps_ray rays[SHARE_SIDE * SHARE_SIDE];
    ps_hit hits[SHARE_SIDE * SHARE_SIDE];
    int lit = 0;
    for (int i = 0; i < SHARE_SIDE * SHARE_SIDE; i++) {
        int column = i % SHARE_SIDE - SHARE_SIDE / 2, row = i / SHARE_SIDE - SHARE_SIDE / 2;
        float right = (float)column / SHARE_SIDE, down = (float)row / SHARE_SIDE;
        rays[i] = ray_through(bdpt, (float)x + bdpt->jitter[0] + right,
                              (float)y + bdpt->jitter[1] + down);
    }
    bdpt->host->intersect(bdpt->host, rays, SHARE_SIDE * SHARE_SIDE, hits);
    for (int i = 0; i < SHARE_SIDE * SHARE_SIDE; i++)
        lit += i == SHARE_SIDE * SHARE_SIDE / 2 ||
               (hits[i].distance < INFINITY && ps_rgb_maximum(hits[i].albedo) > 0.0f &&
                bdpt->host->is_shown(bdpt->host, hits[i].object));
    return (float)lit / (SHARE_SIDE * SHARE_SIDE);
}

void camera_find_shares(const struct bdpt *bdpt, uint32_t tile)
{
    struct sight *sights = &bdpt->sights[(size_t)tile * PS_TILE_PIXELS];
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y;
        if (sights[lane].density > 0.0f && bdpt->host->pixel(bdpt->host, tile, lane, &x, &y))
            sights[lane].share = is_inside(bdpt, x, y) ? 1.0f : share_at(bdpt, x, y);
    }
}
