#include "film/pair_mean.h"

#include "base/parallel.h"

/* Cosine between normals of what counts as flat: 3.6 degrees. */
#define LEAST_COSINE 0.998f

#define SIDE PS_TILE_SIZE
#define APRON (SIDE + 2 * PAIR_MEAN_MOST_REACH)

/* A tile and what lies around it, row by row; what lies outside of the picture has no normal. */
struct apron {
    float position_x[APRON][APRON], position_y[APRON][APRON], position_z[APRON][APRON];
    float normal_x[APRON][APRON], normal_y[APRON][APRON], normal_z[APRON][APRON];
    float r[APRON][APRON], g[APRON][APRON], b[APRON][APRON];
    uint64_t met[APRON][APRON];
};

/* What a row of pixels has gathered. */
struct row_sums {
    float r[SIDE], g[SIDE], b[SIDE], count[SIDE];
};

static void load_pixel(const struct pair_mean *mean, int64_t x, int64_t y, int row, int column,
                       struct apron *apron)
{
    uint32_t tile, lane;
    if (!gbuffer_find(mean->gbuffer, x, y, &tile, &lane)) {
        apron->normal_x[row][column] = apron->normal_y[row][column] = apron->normal_z[row][column] =
            0.0f;
        return;
    }
    const ps_tile *from = &mean->gbuffer->tiles[tile];
    size_t index = (size_t)tile * PS_TILE_PIXELS + lane;
    apron->position_x[row][column] = from->position_x[lane];
    apron->position_y[row][column] = from->position_y[lane];
    apron->position_z[row][column] = from->position_z[lane];
    apron->normal_x[row][column] = from->normal_x[lane];
    apron->normal_y[row][column] = from->normal_y[lane];
    apron->normal_z[row][column] = from->normal_z[lane];
    apron->r[row][column] = mean->from[index].r;
    apron->g[row][column] = mean->from[index].g;
    apron->b[row][column] = mean->from[index].b;
    apron->met[row][column] = mean->met ? mean->met[index] : 0;
}

static void load_apron(const struct pair_mean *mean, uint32_t tile, struct apron *apron)
{
    int64_t left = (int64_t)(tile % mean->gbuffer->tiles_across) * SIDE - mean->reach;
    int64_t top = (int64_t)(tile / mean->gbuffer->tiles_across) * SIDE - mean->reach;
    int side = SIDE + 2 * mean->reach;
    for (int row = 0; row < side; row++)
        for (int column = 0; column < side; column++)
            load_pixel(mean, left + column, top + row, row, column, apron);
}

/* Which pixels of a row are like their neighbours at (dx, dy): 1 or 0. Compilers make vectors of it. */
static void find_alike(const struct apron *apron, int reach, int row, int dx, int dy, int *alike)
{
    int here_row = row + reach, there_row = here_row + dy;
    for (int i = 0; i < SIDE; i++) {
        int here = i + reach, there = here + dx;
        float nx = apron->normal_x[here_row][here], ny = apron->normal_y[here_row][here],
              nz = apron->normal_z[here_row][here];
        float x = apron->position_x[there_row][there] - apron->position_x[here_row][here];
        float y = apron->position_y[there_row][there] - apron->position_y[here_row][here];
        float z = apron->position_z[there_row][there] - apron->position_z[here_row][here];
        float cosine = nx * apron->normal_x[there_row][there] +
                       ny * apron->normal_y[there_row][there] +
                       nz * apron->normal_z[there_row][there];
        float off = nx * x + ny * y + nz * z;
        alike[i] =
            (cosine > LEAST_COSINE) & gbuffer_same_surface(cosine, off, x * x + y * y + z * z);
    }
}

static void drop_unlike_met(const struct apron *apron, int reach, int row, int dx, int dy,
                            int *alike)
{
    for (int i = 0; i < SIDE; i++)
        alike[i] &= gbuffer_met_alike(apron->met[row + reach][i + reach],
                                      apron->met[row + reach + dy][i + reach + dx]);
}

/* Adds to the pixels of a row their neighbours at (dx, dy) and (-dx, -dy), where both are like them. */
static void add_pairs(const struct pair_mean *mean, const struct apron *apron, int row, int dx,
                      int dy, struct row_sums *restrict sums)
{
    int reach = mean->reach, one[SIDE], other[SIDE];
    find_alike(apron, reach, row, dx, dy, one);
    find_alike(apron, reach, row, -dx, -dy, other);
    if (mean->met) {
        drop_unlike_met(apron, reach, row, dx, dy, one);
        drop_unlike_met(apron, reach, row, -dx, -dy, other);
    }
    int a = row + reach + dy, b = row + reach - dy;
    for (int i = 0; i < SIDE; i++) {
        int there = i + reach + dx, opposite = i + reach - dx;
        float both = (float)(one[i] & other[i]);
        sums->r[i] += both * (apron->r[a][there] + apron->r[b][opposite]);
        sums->g[i] += both * (apron->g[a][there] + apron->g[b][opposite]);
        sums->b[i] += both * (apron->b[a][there] + apron->b[b][opposite]);
        sums->count[i] += 2.0f * both;
    }
}

static void mean_of_row(const struct pair_mean *mean, const struct apron *apron, int row,
                        ps_rgb *to)
{
    struct row_sums sums;
    int reach = mean->reach;
    for (int i = 0; i < SIDE; i++) {
        sums.r[i] = apron->r[row + reach][i + reach];
        sums.g[i] = apron->g[row + reach][i + reach];
        sums.b[i] = apron->b[row + reach][i + reach];
        sums.count[i] = 1.0f;
    }
    for (int dy = 0; dy <= reach; dy++)
        for (int dx = dy == 0 ? 1 : -reach; dx <= reach; dx++)
            add_pairs(mean, apron, row, dx, dy, &sums);
    for (int i = 0; i < SIDE; i++)
        to[i] = ps_rgb_scale((ps_rgb){sums.r[i], sums.g[i], sums.b[i]}, 1.0f / sums.count[i]);
}

static void mean_of_tile(void *user, uint64_t tile, uint32_t worker)
{
    (void)worker;
    const struct pair_mean *mean = user;
    struct apron apron = {0};
    load_apron(mean, (uint32_t)tile, &apron);
    for (int row = 0; row < SIDE; row++)
        mean_of_row(mean, &apron, row, &mean->to[tile * PS_TILE_PIXELS + (size_t)(row * SIDE)]);
}

void pair_mean_take(struct pair_mean *mean, uint32_t threads)
{
    parallel_for(threads, mean->gbuffer->tile_count, mean_of_tile, mean);
}
