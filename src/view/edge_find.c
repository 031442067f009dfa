/* edge_find.c: which pixels are edges; see edges.h.
 *
 * A tile and the pixels around it lie in plain arrays, so that compilers make vectors of the loop over a row.
 */
#include "view/edges.h"

#include <math.h>
#include <psplat/math.h>
#include <psplat/tile.h>
#include <string.h>

/* Radiance and albedo differ where they do by more than this share of the larger one. */
#define CONTRAST 0.25f

/* Neighbours that lie off each other's plane by more than this part of their distance (squared) are a
 * step; less may be a normal that is bent or smoothed. */
#define STEP2 0.25f

/* Radiance whose halves tell its noise differs where it does by more than three times as much. */
#define NOISE2 9.0f

#define LEAST_COSINE 0.9f /* between normals of one surface */

#define SIDE (PS_TILE_SIZE + 2)

struct sights {
    int there[SIDE][SIDE]; /* 0: outside of the picture */
    uint32_t object[SIDE][SIDE];
    float x[SIDE][SIDE], y[SIDE][SIDE], z[SIDE][SIDE];
    float normal_x[SIDE][SIDE], normal_y[SIDE][SIDE], normal_z[SIDE][SIDE];
    float albedo[3][SIDE][SIDE], radiance[3][SIDE][SIDE];
    float variance[3][SIDE][SIDE]; /* of that radiance */
};

/* Half of the shadow rays find `half`, all of them the mean of that and the other half, which is as far off. Lights that
 * cast hard shadows, where they are apart, have noise at their edges alone, which shall be found. */
static void load_variance(const struct gbuffer *gbuffer, size_t pixel, ps_rgb albedo, int row,
                          int column, struct sights *sights)
{
    if (!gbuffer->direct_half)
        return;
    ps_rgb half = gbuffer->direct_half[pixel];
    ps_rgb off = ps_rgb_add(gbuffer->direct[pixel], ps_rgb_scale(half, -1.0f));
    if (gbuffer->hard_half) {
        ps_rgb hard = ps_rgb_scale(gbuffer->hard[pixel], -1.0f);
        off = ps_rgb_add(off, ps_rgb_add(hard, gbuffer->hard_half[pixel]));
    }
    ps_rgb noise = ps_rgb_scale(ps_rgb_multiply(albedo, off), 1.0f / PS_PI);
    sights->variance[0][row][column] = noise.r * noise.r;
    sights->variance[1][row][column] = noise.g * noise.g;
    sights->variance[2][row][column] = noise.b * noise.b;
}

static void load_pixel(const struct gbuffer *gbuffer, int64_t x, int64_t y, int row, int column,
                       struct sights *sights)
{
    uint32_t number, lane;
    if (!gbuffer_find(gbuffer, x, y, &number, &lane))
        return;
    const ps_tile *tile = &gbuffer->tiles[number];
    size_t pixel = (size_t)number * PS_TILE_PIXELS + lane;
    ps_rgb albedo = ps_tile_reflectance(tile, lane);
    ps_rgb reflected = ps_rgb_scale(ps_rgb_multiply(albedo, gbuffer->direct[pixel]), 1.0f / PS_PI);
    ps_rgb radiance = ps_rgb_add(gbuffer->emitted[pixel], reflected);
    sights->there[row][column] = 1;
    sights->object[row][column] = tile->object[lane];
    sights->x[row][column] = tile->position_x[lane];
    sights->y[row][column] = tile->position_y[lane];
    sights->z[row][column] = tile->position_z[lane];
    sights->normal_x[row][column] = tile->normal_x[lane];
    sights->normal_y[row][column] = tile->normal_y[lane];
    sights->normal_z[row][column] = tile->normal_z[lane];
    sights->albedo[0][row][column] = albedo.r;
    sights->albedo[1][row][column] = albedo.g;
    sights->albedo[2][row][column] = albedo.b;
    sights->radiance[0][row][column] = radiance.r;
    sights->radiance[1][row][column] = radiance.g;
    sights->radiance[2][row][column] = radiance.b;
    load_variance(gbuffer, pixel, albedo, row, column, sights);
}

/* Becomes the mean over the pixels around: of a few rays, both halves often agree by chance. */
static void smooth_variance(float variance[SIDE][SIDE])
{
    float rows[SIDE][SIDE];
    for (int row = 0; row < SIDE; row++)
        for (int i = 0; i < SIDE; i++) {
            int left = i > 0 ? i - 1 : i, right = i + 1 < SIDE ? i + 1 : i;
            rows[row][i] = variance[row][left] + variance[row][i] + variance[row][right];
        }
    for (int row = 0; row < SIDE; row++)
        for (int i = 0; i < SIDE; i++) {
            int above = row > 0 ? row - 1 : row, below = row + 1 < SIDE ? row + 1 : row;
            variance[row][i] = (rows[above][i] + rows[row][i] + rows[below][i]) * (1.0f / 9.0f);
        }
}

static inline int contrast(float a, float b)
{
    return fabsf(a - b) > CONTRAST * ps_max(a, b);
}

/* Whether two differ by more than the variance of their difference lets chance do. */
static inline int exceeds(float a, float b, float variance)
{
    return (a - b) * (a - b) > NOISE2 * variance;
}

/* Marks the pixels of a row whose neighbours at (dx, dy) see another surface, or another colour of it or from it. */
static void compare_row(const struct sights *sights, int row, int dx, int dy,
                        int differs[PS_TILE_SIZE])
{
    int here_row = row + 1, there_row = here_row + dy;
#pragma omp simd
    for (int i = 0; i < PS_TILE_SIZE; i++) {
        int here = i + 1, there = here + dx;
        float normal_x = sights->normal_x[here_row][here],
              normal_y = sights->normal_y[here_row][here],
              normal_z = sights->normal_z[here_row][here];
        float x = sights->x[there_row][there] - sights->x[here_row][here];
        float y = sights->y[there_row][there] - sights->y[here_row][here];
        float z = sights->z[there_row][there] - sights->z[here_row][here];
        float off_plane = normal_x * x + normal_y * y + normal_z * z;
        float cosine = normal_x * sights->normal_x[there_row][there] +
                       normal_y * sights->normal_y[there_row][there] +
                       normal_z * sights->normal_z[there_row][there];
        int bent =
            (cosine < LEAST_COSINE) | (off_plane * off_plane > STEP2 * (x * x + y * y + z * z));
        uint32_t object = sights->object[here_row][here];
        int other =
            (object != sights->object[there_row][there]) | ((object != PS_NO_OBJECT) & bent);
        for (int k = 0; k < 3; k++) {
            float own = sights->radiance[k][here_row][here];
            float radiance = sights->radiance[k][there_row][there];
            float variance =
                sights->variance[k][here_row][here] + sights->variance[k][there_row][there];
            other |=
                contrast(sights->albedo[k][here_row][here], sights->albedo[k][there_row][there]) |
                (contrast(own, radiance) & exceeds(own, radiance, variance));
        }
        differs[i] |= other & sights->there[there_row][there];
    }
}

void edges_find(const struct gbuffer *gbuffer, uint32_t tile, bool edges[PS_TILE_PIXELS])
{
    static const int around[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    struct sights sights;
    uint32_t left, top;
    gbuffer_pixel(gbuffer, tile, 0, &left, &top);
    memset(&sights, 0, sizeof sights);
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++)
            load_pixel(gbuffer, (int64_t)left + column - 1, (int64_t)top + row - 1, row, column,
                       &sights);
    for (int k = 0; k < 3 && gbuffer->direct_half; k++)
        smooth_variance(sights.variance[k]);
    for (int row = 0; row < PS_TILE_SIZE; row++) {
        int differs[PS_TILE_SIZE] = {0};
        for (int i = 0; i < 4; i++)
            compare_row(&sights, row, around[i][0], around[i][1], differs);
        for (int i = 0; i < PS_TILE_SIZE; i++) {
            int lane = row * PS_TILE_SIZE + i;
            bool by_chance = gbuffer->by_chance[(size_t)tile * PS_TILE_PIXELS + (size_t)lane];
            edges[lane] = sights.there[row + 1][i + 1] && (differs[i] || by_chance);
        }
    }
}
