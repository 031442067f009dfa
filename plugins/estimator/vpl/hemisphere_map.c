#include "hemisphere_map.h"

#define RAYS 256 /* at a time */

/* How far behind a plane is still on it, in distances from the light: smoothed normals and
 * rounding. */
#define TOLERANCE 0.005f

/* The direction through a cell's centre. */
static ps_vec3 cell_direction(const struct hemisphere_map *map, uint32_t cell)
{
    uint32_t column = cell % map->resolution, row = cell / map->resolution;
    float step = 2.0f / (float)map->resolution;
    float a = ((float)column + 0.5f) * step - 1.0f, b = ((float)row + 0.5f) * step - 1.0f;
    float x = 0.5f * (a + b), y = 0.5f * (a - b), z = 1.0f - fabsf(x) - fabsf(y);
    ps_vec3 in_plane = ps_add_scaled(ps_scale(map->axis_u, x), y, map->axis_v);
    return ps_normalize(ps_add_scaled(in_plane, z, map->axis_w));
}

/* The cells that points lie in; those below the light's surface lie in any. */
static void find_cells(const struct hemisphere_map *map, const float *restrict x,
                       const float *restrict y, const float *restrict z, int32_t *restrict cells)
{
    const ps_vec3 axis_u = map->axis_u, axis_v = map->axis_v, axis_w = map->axis_w;
    const int32_t resolution = (int32_t)map->resolution;
    const float half = 0.5f * (float)resolution, last = (float)resolution - 1.0f;
#pragma omp simd
    for (size_t i = 0; i < PS_TILE_PIXELS; i++) {
        float u = x[i] * axis_u.x + y[i] * axis_u.y + z[i] * axis_u.z;
        float v = x[i] * axis_v.x + y[i] * axis_v.y + z[i] * axis_v.z;
        float w = x[i] * axis_w.x + y[i] * axis_w.y + z[i] * axis_w.z;
        float scale = half / (fabsf(u) + fabsf(v) + fabsf(w));
        float column = ps_max(ps_min((u + v) * scale + half, last), 0.0f);
        float row = ps_max(ps_min((u - v) * scale + half, last), 0.0f);
        cells[i] = (int32_t)row * resolution + (int32_t)column;
    }
}

static struct hemisphere_hit keep(const ps_hit *hit, ps_vec3 origin)
{
    if (!(hit->distance < INFINITY))
        return (struct hemisphere_hit){{0, 0, 0}, {0, 0, 0}};
    return (struct hemisphere_hit){ps_subtract(hit->position, origin), hit->geometric_normal};
}

void hemisphere_map_cast(const ps_host *host, ps_vec3 origin, ps_vec3 normal, float turn,
                         struct hemisphere_map *map)
{
    ps_vec3 u, v;
    float angle = 2.0f * PS_PI * turn;
    ps_frame(normal, &u, &v);
    map->axis_u = ps_add_scaled(ps_scale(u, cosf(angle)), sinf(angle), v);
    map->axis_v = ps_add_scaled(ps_scale(v, cosf(angle)), -sinf(angle), u);
    map->axis_w = normal;
    uint32_t count = map->resolution * map->resolution;
    for (uint32_t first = 0; first < count; first += RAYS) {
        ps_ray rays[RAYS];
        ps_hit hits[RAYS];
        uint32_t n = count - first < RAYS ? count - first : RAYS;
        for (uint32_t i = 0; i < n; i++)
            rays[i] = (ps_ray){origin, 0.0f, cell_direction(map, first + i), INFINITY};
        host->intersect(host, rays, n, hits);
        for (uint32_t i = 0; i < n; i++)
            map->cells[first + i] = keep(&hits[i], origin);
    }
}

void hemisphere_map_occlude(const struct hemisphere_map *map,
                            const struct hemisphere_points *points, float *carried)
{
    int32_t cells[PS_TILE_PIXELS];
    find_cells(map, points->x, points->y, points->z, cells);
    for (size_t i = 0; i < PS_TILE_PIXELS; i++) {
        const struct hemisphere_hit *hit = &map->cells[cells[i]];
        ps_vec3 point = {points->x[i], points->y[i], points->z[i]};
        ps_vec3 normal = {points->normal_x[i], points->normal_y[i], points->normal_z[i]};
        ps_vec3 from_point = ps_subtract(hit->position, point);
        float behind = ps_dot(from_point, hit->normal), before = ps_dot(from_point, normal);
        float tolerated2 = TOLERANCE * TOLERANCE * ps_dot(point, point);
        if (behind > 0.0f && before > 0.0f && behind * behind > tolerated2)
            carried[i] = 0.0f;
    }
}
