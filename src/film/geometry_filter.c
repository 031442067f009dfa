#include "film/geometry_filter.h"

#include "base/parallel.h"
#include "film/apron.h"
#include <string.h>

/* Cosine between normals of what counts as flat: 3.6 degrees. */
#define SAME_NORMAL_COSINE 0.998f

#define SIDE PS_TILE_SIZE

/* A tile and what lies around it. */
struct apron {
    struct apron_surfaces at;
    float r[APRON_SIDE][APRON_SIDE], g[APRON_SIDE][APRON_SIDE], b[APRON_SIDE][APRON_SIDE];
    uint64_t occlusion[APRON_SIDE][APRON_SIDE];
};

/* What a row of pixels has gathered. */
struct row_sums {
    float r[SIDE], g[SIDE], b[SIDE], count[SIDE];
};

/* `count` pixels beside each other in one row of a tile. */
static void load_run(const struct geometry_filter *mean, uint32_t tile, uint32_t lane, int count,
                     int row, int column, struct apron *apron)
{
    const ps_tile *from = &mean->gbuffer->tiles[tile];
    size_t first = (size_t)tile * PS_TILE_PIXELS + lane, floats = (size_t)count * sizeof(float);
    memcpy(&apron->at.position_x[row][column], &from->position_x[lane], floats);
    memcpy(&apron->at.position_y[row][column], &from->position_y[lane], floats);
    memcpy(&apron->at.position_z[row][column], &from->position_z[lane], floats);
    memcpy(&apron->at.normal_x[row][column], &from->normal_x[lane], floats);
    memcpy(&apron->at.normal_y[row][column], &from->normal_y[lane], floats);
    memcpy(&apron->at.normal_z[row][column], &from->normal_z[lane], floats);
    if (mean->occlusion)
        memcpy(&apron->occlusion[row][column], &mean->occlusion[first],
               (size_t)count * sizeof *mean->occlusion);
    for (int i = 0; i < count && mean->from; i++) {
        apron->r[row][column + i] = mean->from[first + (size_t)i].r;
        apron->g[row][column + i] = mean->from[first + (size_t)i].g;
        apron->b[row][column + i] = mean->from[first + (size_t)i].b;
    }
}

/* What lies outside of the window stays as it is. */
static void load_row(const struct geometry_filter *mean, int64_t left, int64_t y, int row,
                     struct apron *apron)
{
    int first = APRON_MARGIN - mean->radius, end = APRON_MARGIN + SIDE + mean->radius;
    for (int column = first, next; column < end; column = next) {
        int64_t x = left + column;
        next = column < APRON_MARGIN ? APRON_MARGIN : column + SIDE;
        next = next < end ? next : end;
        int64_t there = (int64_t)mean->gbuffer->width - x;
        int count = there < next - column ? (int)there : next - column;
        uint32_t tile, lane;
        if (gbuffer_find(mean->gbuffer, x, y, &tile, &lane))
            load_run(mean, tile, lane, count, row, column, apron);
    }
}

static void load_apron(const struct geometry_filter *mean, uint32_t tile, struct apron *apron)
{
    uint32_t x, y;
    gbuffer_pixel(mean->gbuffer, tile, 0, &x, &y);
    int64_t left = (int64_t)x - APRON_MARGIN, top = (int64_t)y - APRON_MARGIN;
    int first = APRON_MARGIN - mean->radius, end = APRON_MARGIN + SIDE + mean->radius;
    for (int row = first; row < end; row++)
        load_row(mean, left, top + row, row, apron);
}

/* Which pixels of a row are like their neighbours at (dx, dy): 1 or 0. */
static void find_alike(const struct geometry_filter *mean, const struct apron *apron, int row,
                       int dx, int dy, int *alike)
{
    int here = APRON_MARGIN + row, there = here + dy;
    apron_find_same(&apron->at, row, dx, dy, SAME_NORMAL_COSINE, alike);
    for (int i = 0; i < SIDE && mean->occlusion; i++)
        alike[i] &= gbuffer_occlusion_alike(apron->occlusion[here][APRON_MARGIN + i],
                                            apron->occlusion[there][APRON_MARGIN + i + dx]);
}

/* Adds to the pixels of a row their neighbours at (dx, dy) and (-dx, -dy), where both are like
 * them. */
static void add_pairs(const struct geometry_filter *mean, const struct apron *apron, int row,
                      int dx, int dy, struct row_sums *restrict sums)
{
    int one[SIDE], other[SIDE];
    find_alike(mean, apron, row, dx, dy, one);
    find_alike(mean, apron, row, -dx, -dy, other);
    int a = APRON_MARGIN + row + dy, b = APRON_MARGIN + row - dy;
    for (int i = 0; i < SIDE; i++) {
        int there = APRON_MARGIN + i + dx, opposite = APRON_MARGIN + i - dx;
        float both = (float)(one[i] & other[i]);
        sums->r[i] += both * (apron->r[a][there] + apron->r[b][opposite]);
        sums->g[i] += both * (apron->g[a][there] + apron->g[b][opposite]);
        sums->b[i] += both * (apron->b[a][there] + apron->b[b][opposite]);
        sums->count[i] += 2.0f * both;
    }
}

static void mean_of_row(const struct geometry_filter *mean, const struct apron *apron, int row,
                        size_t first)
{
    struct row_sums sums;
    int radius = mean->radius, here = APRON_MARGIN + row;
    for (int i = 0; i < SIDE; i++) {
        sums.r[i] = apron->r[here][APRON_MARGIN + i];
        sums.g[i] = apron->g[here][APRON_MARGIN + i];
        sums.b[i] = apron->b[here][APRON_MARGIN + i];
        sums.count[i] = 1.0f;
    }
    for (int dy = 0; dy <= radius; dy++)
        for (int dx = dy == 0 ? 1 : -radius; dx <= radius; dx++)
            add_pairs(mean, apron, row, dx, dy, &sums);
    for (size_t i = 0; i < SIDE && mean->to; i++)
        mean->to[first + i] =
            ps_rgb_scale((ps_rgb){sums.r[i], sums.g[i], sums.b[i]}, 1.0f / sums.count[i]);
    for (size_t i = 0; i < SIDE && mean->counts; i++)
        mean->counts[first + i] = (uint8_t)sums.count[i];
}

static void keep_tile(const struct geometry_filter *mean, size_t first)
{
    if (mean->counts)
        memset(&mean->counts[first], 1, PS_TILE_PIXELS);
    if (mean->to)
        memcpy(&mean->to[first], &mean->from[first], PS_TILE_PIXELS * sizeof *mean->to);
}

static bool all_occluded_alike(const struct geometry_filter *mean, const struct apron *apron)
{
    uint64_t mask = apron->occlusion[APRON_MARGIN][APRON_MARGIN];
    int others = 0, first = APRON_MARGIN - mean->radius, end = APRON_MARGIN + SIDE + mean->radius;
    for (int row = first; row < end; row++)
        for (int i = first; i < end; i++)
            others += apron->occlusion[row][i] != mask;
    return others == 0 && gbuffer_occlusion_alike(mask, mask);
}

/* Where all pixels are alike. */
static void mean_of_flat(const struct geometry_filter *mean, const struct apron *apron,
                         size_t first)
{
    float r[SIDE][SIDE], g[SIDE][SIDE], b[SIDE][SIDE];
    int window = geometry_filter_window(mean->radius);
    if (mean->counts)
        memset(&mean->counts[first], window, PS_TILE_PIXELS);
    if (!mean->to)
        return;
    apron_sum(apron->r, mean->radius, 1.0f, r);
    apron_sum(apron->g, mean->radius, 1.0f, g);
    apron_sum(apron->b, mean->radius, 1.0f, b);
    for (int row = 0; row < SIDE; row++)
        for (int i = 0; i < SIDE; i++)
            mean->to[first + (size_t)(row * SIDE + i)] =
                ps_rgb_scale((ps_rgb){r[row][i], g[row][i], b[row][i]}, 1.0f / (float)window);
}

static void mean_of_tile(void *user, uint64_t tile, uint32_t worker)
{
    (void)worker;
    const struct geometry_filter *mean = user;
    if (gbuffer_sees_nothing(&mean->gbuffer->tiles[tile])) {
        keep_tile(mean, tile * PS_TILE_PIXELS);
        return;
    }
    struct apron apron = {0};
    load_apron(mean, (uint32_t)tile, &apron);
    if (apron_is_flat(&apron.at, mean->radius) &&
        (!mean->occlusion || all_occluded_alike(mean, &apron))) {
        mean_of_flat(mean, &apron, tile * PS_TILE_PIXELS);
        return;
    }
    for (int row = 0; row < SIDE; row++)
        mean_of_row(mean, &apron, row, tile * PS_TILE_PIXELS + (size_t)(row * SIDE));
}

void geometry_filter_apply(struct geometry_filter *mean, struct workers *workers)
{
    parallel_for(workers, mean->gbuffer->tile_count, mean_of_tile, mean);
}
