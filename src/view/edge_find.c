/* edge_find.c: which pixels are edges; see edges.h.
 *
 * A tile and the pixels around it lie in plain arrays, so that compilers make vectors of the loop
 * over a row.
 */
#include "view/edges.h"

#include <math.h>
#include <psplat/math.h>
#include <psplat/tile.h>
#include <string.h>

/* Radiance and albedo differ if |a - b| exceeds this fraction of the larger one. */
#define CONTRAST 0.25f

/* A neighbour whose squared distance from the pixel's tangent plane exceeds this fraction of their
 * squared distance lies beyond a step; less may be a normal that is bent or smoothed. */
#define STEP2 0.25f

/* Radiance differs if the squared difference exceeds this many times its variance: three standard
 * deviations. */
#define NOISE2 9.0f

#define LEAST_COSINE 0.9f /* between normals of one surface */

#define SIDE (PS_TILE_SIZE + 2)

struct neighbourhood {
    int there[SIDE][SIDE];      /* 0: outside of the picture */
    uint8_t choice[SIDE][SIDE]; /* enum path_choice */
    uint32_t object[SIDE][SIDE];
    float x[SIDE][SIDE], y[SIDE][SIDE], z[SIDE][SIDE];
    float normal_x[SIDE][SIDE], normal_y[SIDE][SIDE], normal_z[SIDE][SIDE];
    float albedo[3][SIDE][SIDE], radiance[3][SIDE][SIDE];
    float variance[3][SIDE][SIDE]; /* of that radiance */
};

/* The variance of direct light: `direct` is the mean of two halves of the shadow rays, and its
 * difference from one of them estimates its standard deviation. Light of lights that cast hard
 * shadows, where it is kept apart, is taken out: it has noise only at edges, which must be
 * found. */
static void load_variance(const struct gbuffer *gbuffer, size_t pixel, ps_rgb albedo, int row,
                          int column, struct neighbourhood *around)
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
    around->variance[0][row][column] = noise.r * noise.r;
    around->variance[1][row][column] = noise.g * noise.g;
    around->variance[2][row][column] = noise.b * noise.b;
}

static void load_pixel(const struct gbuffer *gbuffer, int64_t x, int64_t y, int row, int column,
                       struct neighbourhood *around)
{
    uint32_t number, lane;
    if (!gbuffer_find(gbuffer, x, y, &number, &lane))
        return;
    const ps_tile *tile = &gbuffer->tiles[number];
    size_t pixel = (size_t)number * PS_TILE_PIXELS + lane;
    ps_rgb albedo = ps_tile_reflectance(tile, lane);
    ps_rgb reflected = ps_rgb_scale(ps_rgb_multiply(albedo, gbuffer->direct[pixel]), 1.0f / PS_PI);
    ps_rgb radiance = ps_rgb_add(gbuffer->emitted[pixel], reflected);
    around->there[row][column] = 1;
    around->choice[row][column] = gbuffer->choice[pixel];
    around->object[row][column] = tile->object[lane];
    around->x[row][column] = tile->position_x[lane];
    around->y[row][column] = tile->position_y[lane];
    around->z[row][column] = tile->position_z[lane];
    around->normal_x[row][column] = tile->normal_x[lane];
    around->normal_y[row][column] = tile->normal_y[lane];
    around->normal_z[row][column] = tile->normal_z[lane];
    around->albedo[0][row][column] = albedo.r;
    around->albedo[1][row][column] = albedo.g;
    around->albedo[2][row][column] = albedo.b;
    around->radiance[0][row][column] = radiance.r;
    around->radiance[1][row][column] = radiance.g;
    around->radiance[2][row][column] = radiance.b;
    load_variance(gbuffer, pixel, albedo, row, column, around);
}

/* Replaces the variance by its mean over 3x3 pixels: with few rays, both halves often agree by
 * chance. */
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

/* Whether two differ significantly, given the variance of their difference. */
static inline int exceeds(float a, float b, float variance)
{
    return (a - b) * (a - b) > NOISE2 * variance;
}

/* Marks the pixels of a row whose neighbours at (dx, dy) see another surface, or another colour of
 * it or from it. */
static void compare_row(const struct neighbourhood *around, int row, int dx, int dy,
                        int differs[PS_TILE_SIZE])
{
    int here_row = row + 1, there_row = here_row + dy;
#pragma omp simd
    for (int i = 0; i < PS_TILE_SIZE; i++) {
        int here = i + 1, there = here + dx;
        float normal_x = around->normal_x[here_row][here],
              normal_y = around->normal_y[here_row][here],
              normal_z = around->normal_z[here_row][here];
        float x = around->x[there_row][there] - around->x[here_row][here];
        float y = around->y[there_row][there] - around->y[here_row][here];
        float z = around->z[there_row][there] - around->z[here_row][here];
        float off_plane = normal_x * x + normal_y * y + normal_z * z;
        float cosine = normal_x * around->normal_x[there_row][there] +
                       normal_y * around->normal_y[there_row][there] +
                       normal_z * around->normal_z[there_row][there];
        int bent =
            (cosine < LEAST_COSINE) | (off_plane * off_plane > STEP2 * (x * x + y * y + z * z));
        uint32_t object = around->object[here_row][here];
        int other =
            (object != around->object[there_row][there]) | ((object != PS_NO_OBJECT) & bent);
        for (int k = 0; k < 3; k++) {
            float own = around->radiance[k][here_row][here];
            float radiance = around->radiance[k][there_row][there];
            float variance =
                around->variance[k][here_row][here] + around->variance[k][there_row][there];
            other |=
                contrast(around->albedo[k][here_row][here], around->albedo[k][there_row][there]) |
                (contrast(own, radiance) & exceeds(own, radiance, variance));
        }
        differs[i] |= other & around->there[there_row][there];
    }
}

static const int neighbours[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};

/* Whether it sees glass, or one of its neighbours does. */
static bool is_near_glass(const struct neighbourhood *around, int row, int column)
{
    bool glass = around->choice[row][column] == CHOSEN_BY_GLASS;
    for (int i = 0; i < 4; i++)
        glass |=
            around->choice[row + neighbours[i][1]][column + neighbours[i][0]] == CHOSEN_BY_GLASS;
    return glass;
}

static enum edge_kind kind_of(const struct neighbourhood *around, int row, int column, bool differs)
{
    bool by_chance = around->choice[row][column] != CHOSEN_BY_NOTHING;
    if (!around->there[row][column] || !(differs || by_chance))
        return NO_EDGE;
    return is_near_glass(around, row, column) ? GLASS_EDGE : EDGE;
}

void edges_find(const struct gbuffer *gbuffer, uint32_t tile, uint8_t edges[PS_TILE_PIXELS])
{
    struct neighbourhood around;
    uint32_t left, top;
    gbuffer_pixel(gbuffer, tile, 0, &left, &top);
    memset(&around, 0, sizeof around);
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++)
            load_pixel(gbuffer, (int64_t)left + column - 1, (int64_t)top + row - 1, row, column,
                       &around);
    for (int k = 0; k < 3 && gbuffer->direct_half; k++)
        smooth_variance(around.variance[k]);
    for (int row = 0; row < PS_TILE_SIZE; row++) {
        int differs[PS_TILE_SIZE] = {0};
        for (int i = 0; i < 4; i++)
            compare_row(&around, row, neighbours[i][0], neighbours[i][1], differs);
        for (int i = 0; i < PS_TILE_SIZE; i++)
            edges[row * PS_TILE_SIZE + i] =
                (uint8_t)kind_of(&around, row + 1, i + 1, differs[i] != 0);
    }
}
