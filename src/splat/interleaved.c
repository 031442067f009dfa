#include "splat/interleaved.h"

#include "base/parallel.h"
#include "film/apron.h"
#include <assert.h>
#include <psplat/tile.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK_SIDE 4
#define BLOCKS_ACROSS (PS_TILE_SIZE / BLOCK_SIDE)

struct interleaved interleaved_layout(const struct gbuffer *gbuffer, uint32_t interleave)
{
    uint32_t side = interleave * PS_TILE_SIZE;
    struct rectangle window = gbuffer_window(gbuffer);
    struct interleaved interleaved = {
        .interleave = interleave,
        .subsets = interleave * interleave,
        .tiles_across = (uint32_t)((window.x % interleave + window.width + side - 1) / side),
        .tiles_down = (uint32_t)((window.y % interleave + window.height + side - 1) / side),
        .left = (uint32_t)window.x,
        .top = (uint32_t)window.y,
        .width = window.x + window.width,
        .height = window.y + window.height,
        .has_geometric_normals = gbuffer->geometric_normals != NULL,
    };
    interleaved.tile_count =
        interleaved.subsets * interleaved.tiles_across * interleaved.tiles_down;
    return interleaved;
}

ps_result interleaved_create(struct interleaved layout, struct interleaved *interleaved,
                             struct error *error)
{
    assert(layout.interleave >= 1 && layout.interleave <= PS_MOST_INTERLEAVE);
    *interleaved = layout;
    size_t count = layout.tile_count;
    interleaved->tiles = aligned_alloc(64, count * sizeof *interleaved->tiles);
    if (layout.has_geometric_normals)
        interleaved->geometric_normals =
            aligned_alloc(64, count * sizeof *interleaved->geometric_normals);
    if (!interleaved->tiles || (layout.has_geometric_normals && !interleaved->geometric_normals)) {
        size_t bytes = interleaved_bytes(interleaved);
        interleaved_release(interleaved);
        return error_memory(error, bytes, "what splats light");
    }
    for (size_t i = 0; i < count; i++)
        interleaved->tiles[i].geometric =
            interleaved->geometric_normals ? &interleaved->geometric_normals[i] : NULL;
    return PS_OK;
}

void interleaved_release(struct interleaved *interleaved)
{
    free(interleaved->tiles);
    free(interleaved->geometric_normals);
    *interleaved = (struct interleaved){.tiles = NULL};
}

size_t interleaved_bytes(const struct interleaved *interleaved)
{
    size_t normals =
        interleaved->has_geometric_normals ? sizeof *interleaved->geometric_normals : 0;
    return interleaved->tile_count * (sizeof *interleaved->tiles + normals);
}

/* Lane of a tile's pixel (x, y), and back. */
static uint32_t lane_of(uint32_t x, uint32_t y)
{
    uint32_t block = y / BLOCK_SIDE * BLOCKS_ACROSS + x / BLOCK_SIDE;
    return block * INTERLEAVED_BLOCK + y % BLOCK_SIDE * BLOCK_SIDE + x % BLOCK_SIDE;
}

static void lane_place(uint32_t lane, uint32_t *x, uint32_t *y)
{
    uint32_t by_rows = gbuffer_block_lane(lane);
    *x = by_rows % PS_TILE_SIZE;
    *y = by_rows / PS_TILE_SIZE;
}

/* The last column or row before `line` at which the pattern of subsets begins: a pixel's subset is
 * that of the whole picture. */
static uint32_t pattern_start(uint32_t line, uint32_t interleave)
{
    return line - line % interleave;
}

/* Column and row of a tile's first pixel; the next ones lie `interleave` further. */
struct corner {
    uint32_t x, y;
};

static struct corner corner_of(const struct interleaved *interleaved, uint32_t tile)
{
    uint32_t each = interleaved->tiles_across * interleaved->tiles_down;
    uint32_t subset = tile / each, place = tile % each,
             side = PS_TILE_SIZE * interleaved->interleave;
    uint32_t n = interleaved->interleave;
    return (struct corner){
        pattern_start(interleaved->left, n) + place % interleaved->tiles_across * side + subset % n,
        pattern_start(interleaved->top, n) + place / interleaved->tiles_across * side + subset / n,
    };
}

static bool pixel_from(const struct interleaved *interleaved, struct corner corner, uint32_t lane,
                       uint32_t *x, uint32_t *y)
{
    uint32_t column, row;
    lane_place(lane, &column, &row);
    *x = corner.x + column * interleaved->interleave;
    *y = corner.y + row * interleaved->interleave;
    return *x >= interleaved->left && *y >= interleaved->top && *x < interleaved->width &&
           *y < interleaved->height;
}

bool interleaved_pixel(const struct interleaved *interleaved, uint32_t tile, uint32_t lane,
                       uint32_t *x, uint32_t *y)
{
    return pixel_from(interleaved, corner_of(interleaved, tile), lane, x, y);
}

struct work {
    const struct interleaved *interleaved;
    const struct gbuffer *gbuffer;
};

void interleaved_set_lane(struct interleaved_tile *tile, uint32_t lane, ps_vec3 position,
                          ps_vec3 normal)
{
    tile->position_x[lane] = position.x;
    tile->position_y[lane] = position.y;
    tile->position_z[lane] = position.z;
    tile->normal_x[lane] = normal.x;
    tile->normal_y[lane] = normal.y;
    tile->normal_z[lane] = normal.z;
}

static void set_geometric(struct interleaved_tile *tile, uint32_t lane, ps_vec3 normal)
{
    if (!tile->geometric)
        return;
    tile->geometric->x[lane] = normal.x;
    tile->geometric->y[lane] = normal.y;
    tile->geometric->z[lane] = normal.z;
}

void interleaved_clear_lane(struct interleaved_tile *tile, uint32_t lane)
{
    set_geometric(tile, lane, (ps_vec3){0, 0, 0});
    tile->position_x[lane] = tile->position_y[lane] = tile->position_z[lane] = BOUNDS_NOWHERE;
    tile->normal_x[lane] = tile->normal_y[lane] = tile->normal_z[lane] = 0.0f;
}

static void bound_block(struct interleaved_tile *tile, uint32_t block)
{
    struct bound bound = bound_empty();
    for (uint32_t i = 0; i < INTERLEAVED_BLOCK; i++) {
        uint32_t lane = block * INTERLEAVED_BLOCK + i;
        ps_vec3 position = {tile->position_x[lane], tile->position_y[lane], tile->position_z[lane]};
        ps_vec3 normal = {tile->normal_x[lane], tile->normal_y[lane], tile->normal_z[lane]};
        if (position.x < BOUNDS_NOWHERE)
            bound_add_point(&bound, position, normal);
    }
    bounds_set(&tile->blocks, block, &bound);
}

void interleaved_begin_tile(struct interleaved_tile *tile)
{
    memset(tile->irradiance_r, 0, sizeof tile->irradiance_r);
    memset(tile->irradiance_g, 0, sizeof tile->irradiance_g);
    memset(tile->irradiance_b, 0, sizeof tile->irradiance_b);
    memset(tile->weight, 0, sizeof tile->weight);
    for (uint32_t block = 0; block < BOUNDS_WIDTH; block++)
        bound_block(tile, block);
}

static void fill_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const struct gbuffer *gbuffer = work->gbuffer;
    struct interleaved_tile *tile = &work->interleaved->tiles[index];
    struct corner corner = corner_of(work->interleaved, (uint32_t)index);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        uint32_t x, y, photon;
        if (pixel_from(work->interleaved, corner, lane, &x, &y)) {
            uint32_t from = gbuffer_tile_of(gbuffer, x, y, &photon);
            interleaved_set_lane(tile, lane, ps_tile_position(&gbuffer->tiles[from], photon),
                                 ps_tile_normal(&gbuffer->tiles[from], photon));
            if (tile->geometric)
                set_geometric(tile, lane,
                              gbuffer->geometric_normals[(size_t)from * PS_TILE_PIXELS + photon]);
        } else {
            interleaved_clear_lane(tile, lane);
        }
    }
    interleaved_begin_tile(tile);
}

void interleaved_fill(struct interleaved *interleaved, const struct gbuffer *gbuffer,
                      struct workers *workers)
{
    struct work work = {interleaved, gbuffer};
    parallel_for(workers, interleaved->tile_count, fill_tile, &work);
}

/* --- joining
 * ------------------------------------------------------------------------------------ */

/* A tile of the G-buffer and what lies around it. */
struct apron {
    struct apron_surfaces at;
    float irradiance_r[APRON_SIDE][APRON_SIDE], irradiance_g[APRON_SIDE][APRON_SIDE],
        irradiance_b[APRON_SIDE][APRON_SIDE];
    float weight[APRON_SIDE][APRON_SIDE];
};

/* Where the subsets keep a column or a row of the picture. */
struct line_place {
    uint32_t subset, tile, lane; /* lane: 0..PS_TILE_SIZE - 1 */
    bool there;                  /* within the window */
};

static struct line_place place_line(int64_t line, uint32_t first, size_t end, uint32_t n)
{
    if (line < (int64_t)first || line >= (int64_t)end)
        return (struct line_place){.there = false};
    uint32_t own = ((uint32_t)line - pattern_start(first, n)) / n;
    return (struct line_place){(uint32_t)line % n, own / PS_TILE_SIZE, own % PS_TILE_SIZE, true};
}

static void load_pixel(const struct interleaved *interleaved, const struct line_place *x,
                       const struct line_place *y, struct apron *apron, int column, int row)
{
    static const struct interleaved_tile nothing = {.position_x = {BOUNDS_NOWHERE}};
    const struct interleaved_tile *tile = &nothing;
    uint32_t lane = 0;
    if (x->there && y->there) {
        uint32_t subset = y->subset * interleaved->interleave + x->subset;
        tile =
            &interleaved
                 ->tiles[(subset * interleaved->tiles_down + y->tile) * interleaved->tiles_across +
                         x->tile];
        lane = lane_of(x->lane, y->lane);
    }
    apron->at.position_x[row][column] = tile->position_x[lane];
    apron->at.position_y[row][column] = tile->position_y[lane];
    apron->at.position_z[row][column] = tile->position_z[lane];
    apron->at.normal_x[row][column] = tile->normal_x[lane];
    apron->at.normal_y[row][column] = tile->normal_y[lane];
    apron->at.normal_z[row][column] = tile->normal_z[lane];
    apron->irradiance_r[row][column] = tile->irradiance_r[lane];
    apron->irradiance_g[row][column] = tile->irradiance_g[lane];
    apron->irradiance_b[row][column] = tile->irradiance_b[lane];
    apron->weight[row][column] = tile->weight[lane];
}

/* The tile whose first pixel is (left, top), and `reach` pixels around it. */
static void load_apron(const struct interleaved *interleaved, int64_t left, int64_t top, int reach,
                       struct apron *apron)
{
    struct line_place columns[APRON_SIDE], rows[APRON_SIDE];
    int first = APRON_MARGIN - reach, end = APRON_MARGIN + PS_TILE_SIZE + reach;
    for (int i = first; i < end; i++) {
        columns[i] = place_line(left + i - APRON_MARGIN, interleaved->left, interleaved->width,
                                interleaved->interleave);
        rows[i] = place_line(top + i - APRON_MARGIN, interleaved->top, interleaved->height,
                             interleaved->interleave);
    }
    for (int row = first; row < end; row++)
        for (int column = first; column < end; column++)
            load_pixel(interleaved, &columns[column], &rows[row], apron, column, row);
}

/* What a row of pixels has gathered from its windows. */
struct row_sums {
    float total[PS_TILE_SIZE];
    float r[PS_TILE_SIZE], g[PS_TILE_SIZE], b[PS_TILE_SIZE], weight[PS_TILE_SIZE];
};

/* Adds to each pixel of a row its neighbour at (dx, dy), `share` times, where that lies on the same
 * surface. */
static void add_neighbours(const struct apron *apron, int row, int dx, int dy, float share,
                           struct row_sums *restrict sums)
{
    int same[PS_TILE_SIZE], other = APRON_MARGIN + row + dy;
    apron_find_same(&apron->at, row, dx, dy, 0.0f, same);
    for (int i = 0; i < PS_TILE_SIZE; i++) {
        int there = APRON_MARGIN + i + dx;
        float weight = (float)same[i] * share;
        sums->total[i] += weight;
        sums->r[i] += weight * apron->irradiance_r[other][there];
        sums->g[i] += weight * apron->irradiance_g[other][there];
        sums->b[i] += weight * apron->irradiance_b[other][there];
        sums->weight[i] += weight * apron->weight[other][there];
    }
}

static float border_share(int offset, int reach, uint32_t interleave)
{
    return interleave % 2 == 0 && abs(offset) == reach ? 0.5f : 1.0f;
}

/* Where all lies on one plane: each window has the weight of all subsets, each once. */
static void join_flat(const struct apron *apron, uint32_t interleave, float *const to[4])
{
    float sums[PS_TILE_SIZE][PS_TILE_SIZE];
    const float(*from[])[APRON_SIDE] = {apron->irradiance_r, apron->irradiance_g,
                                        apron->irradiance_b, apron->weight};
    int reach = (int)interleave / 2;
    float scale = 1.0f / (float)(interleave * interleave);
    for (size_t plane = 0; plane < sizeof from / sizeof *from; plane++) {
        apron_sum(from[plane], reach, border_share(reach, reach, interleave), sums);
        for (int lane = 0; lane < PS_TILE_PIXELS; lane++)
            to[plane][lane] += scale * sums[lane / PS_TILE_SIZE][lane % PS_TILE_SIZE];
    }
}

static void join_row(const struct apron *apron, uint32_t interleave, int row, float *const to[4])
{
    struct row_sums sums = {0};
    int reach = (int)interleave / 2;
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++)
            add_neighbours(
                apron, row, dx, dy,
                border_share(dx, reach, interleave) * border_share(dy, reach, interleave), &sums);
    for (int i = 0; i < PS_TILE_SIZE; i++) {
        int lane = row * PS_TILE_SIZE + i;
        float scale = sums.total[i] > 0.0f ? 1.0f / sums.total[i] : 0.0f;
        to[0][lane] += scale * sums.r[i];
        to[1][lane] += scale * sums.g[i];
        to[2][lane] += scale * sums.b[i];
        to[3][lane] += scale * sums.weight[i];
    }
}

static void join_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    const struct interleaved *interleaved = work->interleaved;
    const struct gbuffer *gbuffer = work->gbuffer;
    uint32_t left, top;
    gbuffer_pixel(gbuffer, (uint32_t)index, 0, &left, &top);
    int reach = (int)interleaved->interleave / 2;
    if (gbuffer_sees_nothing(&gbuffer->tiles[index]))
        return;
    ps_tile *tile = &gbuffer->tiles[index];
    bool apart = gbuffer->splatted != NULL;
    float *const to[4] = {
        apart ? gbuffer_splatted(gbuffer, (uint32_t)index, 0) : tile->irradiance_r,
        apart ? gbuffer_splatted(gbuffer, (uint32_t)index, 1) : tile->irradiance_g,
        apart ? gbuffer_splatted(gbuffer, (uint32_t)index, 2) : tile->irradiance_b,
        tile->weight,
    };
    struct apron apron = {0};
    load_apron(interleaved, left, top, reach, &apron);
    if (reach > 0 && apron_is_flat(&apron.at, reach)) {
        join_flat(&apron, interleaved->interleave, to);
        return;
    }
    for (int row = 0; row < PS_TILE_SIZE; row++)
        join_row(&apron, interleaved->interleave, row, to);
}

void interleaved_join(const struct interleaved *interleaved, struct gbuffer *gbuffer,
                      struct workers *workers)
{
    struct work work = {interleaved, gbuffer};
    parallel_for(workers, gbuffer->tile_count, join_tile, &work);
}
