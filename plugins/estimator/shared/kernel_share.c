#include "kernel_share.h"

#include "photon_map.h"

#define POINTS 8        /* of a disc */
#define LIFT 0.125f     /* radii above the surface at which rays run along it */
#define TURN 2.3999632f /* the golden angle */

/* So that the points have the density of the kernel, (1 - s) s over the radius: the inverse of 3
 * s^2 - 2 s^3. */
static float radius_at(float u)
{
    return 0.5f - sinf(asinf(1.0f - 2.0f * u) / 3.0f);
}

static float first_turn(uint64_t key)
{
    uint64_t bits = (key ^ (key >> 31)) * UINT64_C(0x9e3779b97f4a7c15);
    return 2.0f * PS_PI * (float)(bits >> 40) * 0x1p-24f;
}

/* From a point to one of its disc, above the surface. */
static ps_ray ray_along(ps_vec3 position, ps_vec3 normal, float radius, float turn, float distance)
{
    ps_vec3 u, v;
    ps_frame(normal, &u, &v);
    ps_vec3 direction = ps_add_scaled(ps_scale(u, cosf(turn)), sinf(turn), v);
    return (ps_ray){ps_add_scaled(position, LIFT * radius, normal), 0.0f, direction,
                    distance * radius};
}

/* From where such a ray ends, down to the surface. */
static ps_ray ray_down(ps_ray along, ps_vec3 normal, float radius)
{
    return (ps_ray){ps_add_scaled(along.origin, along.tfar, along.direction), 0.0f,
                    ps_scale(normal, -1.0f), (LIFT + PHOTON_MAP_FLATNESS) * radius};
}

void kernel_shares(const ps_host *host, const ps_vec3 *positions, const ps_vec3 *normals,
                   const float *radii, size_t n, uint64_t key, float *shares)
{
    ps_ray along[PS_TILE_PIXELS], down[PS_TILE_PIXELS];
    ps_hit walls[PS_TILE_PIXELS], grounds[PS_TILE_PIXELS];
    float turns[PS_TILE_PIXELS];
    uint32_t counts[PS_TILE_PIXELS] = {0};
    for (size_t i = 0; i < n; i++)
        turns[i] = first_turn(key + i);
    for (uint32_t k = 0; k < POINTS; k++) {
        float distance = radius_at(((float)k + 0.5f) / POINTS);
        for (size_t i = 0; i < n; i++) {
            along[i] =
                ray_along(positions[i], normals[i], radii[i], turns[i] + (float)k * TURN, distance);
            down[i] = ray_down(along[i], normals[i], radii[i]);
        }
        host->intersect(host, along, n, walls);
        host->intersect(host, down, n, grounds);
        for (size_t i = 0; i < n; i++)
            counts[i] += !(walls[i].distance < INFINITY) && grounds[i].distance < INFINITY;
    }
    for (size_t i = 0; i < n; i++)
        shares[i] = (float)(counts[i] > 0 ? counts[i] : 1) / POINTS;
}
