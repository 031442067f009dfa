#include "sample_factors.h"

#include <stdbool.h>

/* A point is compared with others of its tile in a square around it, every second one in either
 * direction. */
#define REACH 8
#define STEP 2

#define SAME_FACING 0.87f /* cosine of two normals of one surface */
#define SAME_PLANE 0.22f  /* sine between such a surface and the way from one point to the other */
#define FLAT 1e-3f        /* such a sine, within which a surface is flat */

struct comparison {
    const ps_points *points;
    int32_t at[PS_TILE_SIZE][PS_TILE_SIZE];              /* which point is there; NO_POINT: none */
    uint32_t all[PS_TILE_PIXELS], alike[PS_TILE_PIXELS]; /* for each point */
};

#define NO_POINT (-1)

static bool are_alike(const ps_points *points, int32_t a, int32_t b)
{
    ps_vec3 n = points->normals[a], m = points->normals[b];
    ps_vec3 way = ps_subtract(points->positions[b], points->positions[a]);
    float height = 0.5f * ps_dot(ps_add(n, m), way);
    return ps_dot(n, m) > SAME_FACING &&
           height * height <= SAME_PLANE * SAME_PLANE * ps_dot(way, way);
}

/* Whether all lie in one plane, and so are alike: as in most tiles of a room. */
static bool are_flat(const ps_points *points)
{
    ps_vec3 n = points->normals[0];
    for (size_t i = 1; i < points->count; i++) {
        ps_vec3 way = ps_subtract(points->positions[i], points->positions[0]);
        float height = ps_dot(n, way);
        if (!ps_same(points->normals[i], n) || height * height > FLAT * FLAT * ps_dot(way, way))
            return false;
    }
    return points->count == PS_TILE_PIXELS;
}

static void count(struct comparison *comparison, int32_t point, bool is_alike)
{
    if (point == NO_POINT)
        return;
    comparison->all[point]++;
    comparison->alike[point] += is_alike;
}

/* Compares each point with the one that is so far away. */
static void compare(struct comparison *comparison, int dx, int dy)
{
    int first = dx < 0 ? -dx : 0, end = dx < 0 ? PS_TILE_SIZE : PS_TILE_SIZE - dx;
    for (int y = 0; y < PS_TILE_SIZE - dy; y++)
        for (int x = first; x < end; x++) {
            int32_t a = comparison->at[y][x], b = comparison->at[y + dy][x + dx];
            bool is_alike = a != NO_POINT && b != NO_POINT && are_alike(comparison->points, a, b);
            count(comparison, a, is_alike);
            count(comparison, b, is_alike);
        }
}

static void compare_all(const ps_points *points, float *factors)
{
    struct comparison comparison = {.points = points};
    for (int y = 0; y < PS_TILE_SIZE; y++)
        for (int x = 0; x < PS_TILE_SIZE; x++)
            comparison.at[y][x] = NO_POINT;
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        comparison.at[lane / PS_TILE_SIZE][lane % PS_TILE_SIZE] = (int32_t)i;
        comparison.all[i] = comparison.alike[i] = 1;
    }
    for (int dy = 0; dy <= REACH; dy += STEP)
        for (int dx = dy > 0 ? -REACH : STEP; dx <= REACH; dx += STEP)
            compare(&comparison, dx, dy);
    for (size_t i = 0; i < points->count; i++) {
        float share = (float)comparison.alike[i] / (float)comparison.all[i];
        factors[i] = ps_min(sqrtf(1.0f / share), SAMPLE_FACTOR_MOST);
    }
}

void sample_factors(const ps_points *points, float *factors)
{
    if (!are_flat(points)) {
        compare_all(points, factors);
        return;
    }
    for (size_t i = 0; i < points->count; i++)
        factors[i] = 1.0f;
}
