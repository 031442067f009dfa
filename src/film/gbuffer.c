#include "film/gbuffer.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What the film's pixels depend on, and how far that reaches, in pixels:
 *
 *     EDGE_REACH  samples at edges: edges, and the indirect light around (view/edges.h)
 *     MEAN_REACH  means of that light: of interleaved subsets, of short-range light, of direct
 *                 light (a discontinuity buffer); flat tiles are averaged in one
 *     MEAN_REACH  again, for rays of that light: shared out by how many pixels are averaged, in
 *                 blocks of 4 x 4 pixels that lie on the same surface
 *
 * Means go tile by tile, so that the first is of pixels and the others are of its tiles. Any
 * estimator may splat. */
#define EDGE_REACH 2
#define MEAN_REACH (PS_MOST_INTERLEAVE / 2)

struct gbuffer gbuffer_layout(size_t width, size_t height)
{
    uint32_t across = (uint32_t)((width + PS_TILE_SIZE - 1) / PS_TILE_SIZE);
    uint32_t down = (uint32_t)((height + PS_TILE_SIZE - 1) / PS_TILE_SIZE);
    return (struct gbuffer){
        .width = width,
        .height = height,
        .picture_across = across,
        .tiles_across = across,
        .tiles_down = down,
        .tile_count = across * down,
    };
}

/* Tiles from `first` to before `end`, along one axis. */
struct tile_range {
    uint32_t first, end;
};

static struct tile_range grow(struct tile_range range, uint32_t pixels, uint32_t tiles)
{
    uint32_t more = (pixels + PS_TILE_SIZE - 1) / PS_TILE_SIZE;
    return (struct tile_range){range.first > more ? range.first - more : 0,
                               tiles - range.end > more ? range.end + more : tiles};
}

/* The tiles that `length` pixels from `first` on need, of a picture of so many pixels. */
static struct tile_range tiles_around(size_t first, size_t length, size_t reach, size_t pixels)
{
    size_t end = first + length + reach;
    uint32_t tiles = (uint32_t)((pixels + PS_TILE_SIZE - 1) / PS_TILE_SIZE);
    struct tile_range range = {
        (uint32_t)((first > reach ? first - reach : 0) / PS_TILE_SIZE),
        (uint32_t)(((end < pixels ? end : pixels) + PS_TILE_SIZE - 1) / PS_TILE_SIZE)};
    return grow(range, 2 * MEAN_REACH, tiles);
}

struct gbuffer gbuffer_layout_around(struct rectangle part, bool smooth_edges, size_t width,
                                     size_t height)
{
    size_t reach = smooth_edges ? EDGE_REACH : 0;
    struct gbuffer gbuffer = gbuffer_layout(width, height);
    struct tile_range columns = tiles_around(part.x, part.width, reach, width);
    struct tile_range rows = tiles_around(part.y, part.height, reach, height);
    assert(rectangle_fits(part, width, height));
    gbuffer.first_column = columns.first;
    gbuffer.first_row = rows.first;
    gbuffer.tiles_across = columns.end - columns.first;
    gbuffer.tiles_down = rows.end - rows.first;
    gbuffer.tile_count = gbuffer.tiles_across * gbuffer.tiles_down;
    return gbuffer;
}

struct rectangle gbuffer_window(const struct gbuffer *gbuffer)
{
    size_t left = (size_t)gbuffer->first_column * PS_TILE_SIZE;
    size_t top = (size_t)gbuffer->first_row * PS_TILE_SIZE;
    size_t right = left + (size_t)gbuffer->tiles_across * PS_TILE_SIZE;
    size_t bottom = top + (size_t)gbuffer->tiles_down * PS_TILE_SIZE;
    return (struct rectangle){
        left,
        top,
        (right < gbuffer->width ? right : gbuffer->width) - left,
        (bottom < gbuffer->height ? bottom : gbuffer->height) - top,
    };
}

ps_result gbuffer_create(struct gbuffer layout, struct gbuffer *gbuffer, struct error *error)
{
    *gbuffer = layout;
    gbuffer->tiles = aligned_alloc(64, gbuffer->tile_count * sizeof(ps_tile));
    gbuffer->direct = malloc((size_t)gbuffer->tile_count * PS_TILE_PIXELS * sizeof(ps_rgb));
    gbuffer->emitted = malloc((size_t)gbuffer->tile_count * PS_TILE_PIXELS * sizeof(ps_rgb));
    gbuffer->choice = malloc((size_t)gbuffer->tile_count * PS_TILE_PIXELS);
    if (gbuffer->tiles && gbuffer->direct && gbuffer->emitted && gbuffer->choice)
        return PS_OK;
    size_t bytes = gbuffer_bytes(gbuffer);
    gbuffer_release(gbuffer);
    return error_memory(error, bytes, "the G-buffer");
}

/* An array that is there, or a new one of zeros. */
static void *old_or_new(void *array, size_t count, size_t size)
{
    return array ? array : calloc(count, size);
}

static ps_result check(const void *array, size_t bytes, const char *what, struct error *error)
{
    return array ? PS_OK : error_memory(error, bytes, what);
}

static size_t lanes_of(const struct gbuffer *gbuffer)
{
    return (size_t)gbuffer->tile_count * PS_TILE_PIXELS;
}

ps_result gbuffer_prepare_discontinuity_buffer(struct gbuffer *gbuffer, struct error *error)
{
    size_t count = lanes_of(gbuffer);
    gbuffer->occlusion = old_or_new(gbuffer->occlusion, count, sizeof *gbuffer->occlusion);
    gbuffer->direct_scratch =
        old_or_new(gbuffer->direct_scratch, count, sizeof *gbuffer->direct_scratch);
    size_t bytes = count * (sizeof *gbuffer->occlusion + sizeof *gbuffer->direct_scratch);
    return check(gbuffer->occlusion ? gbuffer->direct_scratch : NULL, bytes, "direct light", error);
}

ps_result gbuffer_prepare_direct_half(struct gbuffer *gbuffer, struct error *error)
{
    size_t count = lanes_of(gbuffer);
    gbuffer->direct_half = old_or_new(gbuffer->direct_half, count, sizeof *gbuffer->direct_half);
    return check(gbuffer->direct_half, count * sizeof *gbuffer->direct_half, "direct light", error);
}

ps_result gbuffer_prepare_hard(struct gbuffer *gbuffer, struct error *error)
{
    size_t count = lanes_of(gbuffer), bytes = count * sizeof *gbuffer->hard;
    gbuffer->hard = old_or_new(gbuffer->hard, count, sizeof *gbuffer->hard);
    if (!gbuffer->direct_half)
        return check(gbuffer->hard, bytes, "direct light", error);
    gbuffer->hard_half = old_or_new(gbuffer->hard_half, count, sizeof *gbuffer->hard_half);
    return check(gbuffer->hard ? gbuffer->hard_half : NULL, 2 * bytes, "direct light", error);
}

ps_result gbuffer_prepare_glossy(struct gbuffer *gbuffer, struct error *error)
{
    size_t count = gbuffer->tile_count;
    gbuffer->glossy = old_or_new(gbuffer->glossy, count, sizeof *gbuffer->glossy);
    return check(gbuffer->glossy, count * sizeof *gbuffer->glossy, "glossy surfaces", error);
}

ps_result gbuffer_prepare_geometric_normals(struct gbuffer *gbuffer, struct error *error)
{
    size_t count = lanes_of(gbuffer);
    gbuffer->geometric_normals =
        old_or_new(gbuffer->geometric_normals, count, sizeof *gbuffer->geometric_normals);
    return check(gbuffer->geometric_normals, count * sizeof *gbuffer->geometric_normals, "normals",
                 error);
}

ps_result gbuffer_prepare_radiance(struct gbuffer *gbuffer, struct error *error)
{
    size_t count = 3 * lanes_of(gbuffer);
    gbuffer->radiance = old_or_new(gbuffer->radiance, count, sizeof *gbuffer->radiance);
    return check(gbuffer->radiance, count * sizeof *gbuffer->radiance, "indirect radiance", error);
}

ps_result gbuffer_prepare_splatted(struct gbuffer *gbuffer, struct error *error)
{
    size_t count = 3 * lanes_of(gbuffer);
    gbuffer->splatted = old_or_new(gbuffer->splatted, count, sizeof *gbuffer->splatted);
    return check(gbuffer->splatted, count * sizeof *gbuffer->splatted, "splats", error);
}

void gbuffer_release(struct gbuffer *gbuffer)
{
    free(gbuffer->occlusion);
    free(gbuffer->direct_scratch);
    free(gbuffer->radiance);
    free(gbuffer->splatted);
    free(gbuffer->tiles);
    free(gbuffer->direct);
    free(gbuffer->direct_half);
    free(gbuffer->hard);
    free(gbuffer->hard_half);
    free(gbuffer->emitted);
    free(gbuffer->choice);
    free(gbuffer->glossy);
    free(gbuffer->geometric_normals);
    *gbuffer = (struct gbuffer){.tiles = NULL};
}

size_t gbuffer_bytes_with(const struct gbuffer *layout, struct gbuffer_parts parts)
{
    size_t lane = sizeof *layout->direct + sizeof *layout->emitted + sizeof *layout->choice;
    if (parts.discontinuity_buffer)
        lane += sizeof *layout->occlusion + sizeof *layout->direct_scratch;
    if (parts.direct_half)
        lane += sizeof *layout->direct_half;
    if (parts.hard)
        lane += sizeof *layout->hard + (parts.direct_half ? sizeof *layout->hard_half : 0);
    if (parts.geometric_normals)
        lane += sizeof *layout->geometric_normals;
    if (parts.radiance)
        lane += 3 * sizeof *layout->radiance;
    if (parts.splatted)
        lane += 3 * sizeof *layout->splatted;
    size_t glossy = parts.glossy ? sizeof *layout->glossy : 0;
    return layout->tile_count * (sizeof(ps_tile) + glossy + PS_TILE_PIXELS * lane);
}

size_t gbuffer_bytes(const struct gbuffer *gbuffer)
{
    return gbuffer_bytes_with(gbuffer, (struct gbuffer_parts){
                                           .discontinuity_buffer = gbuffer->direct_scratch != NULL,
                                           .direct_half = gbuffer->direct_half != NULL,
                                           .hard = gbuffer->hard != NULL,
                                           .glossy = gbuffer->glossy != NULL,
                                           .geometric_normals = gbuffer->geometric_normals != NULL,
                                           .radiance = gbuffer->radiance != NULL,
                                           .splatted = gbuffer->splatted != NULL,
                                       });
}

bool gbuffer_tile_numbered(const struct gbuffer *gbuffer, uint32_t number, uint32_t *tile)
{
    uint32_t column = number % gbuffer->picture_across - gbuffer->first_column;
    uint32_t row = number / gbuffer->picture_across - gbuffer->first_row;
    if (column >= gbuffer->tiles_across || row >= gbuffer->tiles_down)
        return false; /* what lies before the window wraps around */
    *tile = row * gbuffer->tiles_across + column;
    return true;
}

bool gbuffer_pixel(const struct gbuffer *gbuffer, uint32_t tile, uint32_t lane, uint32_t *x,
                   uint32_t *y)
{
    *x =
        (gbuffer->first_column + tile % gbuffer->tiles_across) * PS_TILE_SIZE + lane % PS_TILE_SIZE;
    *y = (gbuffer->first_row + tile / gbuffer->tiles_across) * PS_TILE_SIZE + lane / PS_TILE_SIZE;
    return *x < gbuffer->width && *y < gbuffer->height;
}

bool gbuffer_picture_pixel(const struct gbuffer *gbuffer, uint32_t number, uint32_t lane,
                           uint32_t *x, uint32_t *y)
{
    *x = number % gbuffer->picture_across * PS_TILE_SIZE + lane % PS_TILE_SIZE;
    *y = number / gbuffer->picture_across * PS_TILE_SIZE + lane / PS_TILE_SIZE;
    return *x < gbuffer->width && *y < gbuffer->height;
}

uint32_t gbuffer_tile_of(const struct gbuffer *gbuffer, uint32_t x, uint32_t y, uint32_t *lane)
{
    *lane = y % PS_TILE_SIZE * PS_TILE_SIZE + x % PS_TILE_SIZE;
    return (y / PS_TILE_SIZE - gbuffer->first_row) * gbuffer->tiles_across + x / PS_TILE_SIZE -
           gbuffer->first_column;
}

bool gbuffer_find(const struct gbuffer *gbuffer, int64_t x, int64_t y, uint32_t *tile,
                  uint32_t *lane)
{
    int64_t left = (int64_t)gbuffer->first_column * PS_TILE_SIZE;
    int64_t top = (int64_t)gbuffer->first_row * PS_TILE_SIZE;
    if (x < left || y < top || x >= (int64_t)gbuffer->width || y >= (int64_t)gbuffer->height ||
        x >= left + (int64_t)gbuffer->tiles_across * PS_TILE_SIZE ||
        y >= top + (int64_t)gbuffer->tiles_down * PS_TILE_SIZE)
        return false;
    *tile = gbuffer_tile_of(gbuffer, (uint32_t)x, (uint32_t)y, lane);
    return true;
}

bool gbuffer_sees_nothing(const ps_tile *tile)
{
    int seen = 0;
    for (int lane = 0; lane < PS_TILE_PIXELS; lane++)
        seen += tile->object[lane] != PS_NO_OBJECT;
    return seen == 0;
}

void gbuffer_store(ps_tile *tile, uint32_t lane, const ps_hit *hit, ps_rgb throughput,
                   float travelled)
{
    assert(lane < PS_TILE_PIXELS);
    tile->position_x[lane] = hit->position.x;
    tile->position_y[lane] = hit->position.y;
    tile->position_z[lane] = hit->position.z;
    tile->normal_x[lane] = hit->normal.x;
    tile->normal_y[lane] = hit->normal.y;
    tile->normal_z[lane] = hit->normal.z;
    tile->albedo_r[lane] = hit->albedo.r;
    tile->albedo_g[lane] = hit->albedo.g;
    tile->albedo_b[lane] = hit->albedo.b;
    tile->throughput_r[lane] = throughput.r;
    tile->throughput_g[lane] = throughput.g;
    tile->throughput_b[lane] = throughput.b;
    tile->depth[lane] = travelled;
    tile->object[lane] = hit->object;
    tile->material[lane] = hit->material;
}

void gbuffer_store_geometric_normal(struct gbuffer *gbuffer, uint32_t tile, uint32_t lane,
                                    const ps_hit *hit)
{
    assert(lane < PS_TILE_PIXELS);
    if (gbuffer->geometric_normals)
        gbuffer->geometric_normals[(size_t)tile * PS_TILE_PIXELS + lane] = hit->geometric_normal;
}

static void store_first(struct glossy_tile *glossy, uint32_t lane, const ps_hit *hit,
                        ps_rgb reflectance, float travelled)
{
    assert(lane < PS_TILE_PIXELS);
    glossy->reflectance_r[lane] = fminf(reflectance.r, 1.0f);
    glossy->reflectance_g[lane] = fminf(reflectance.g, 1.0f);
    glossy->reflectance_b[lane] = fminf(reflectance.b, 1.0f);
    glossy->normal_x[lane] = hit->normal.x;
    glossy->normal_y[lane] = hit->normal.y;
    glossy->normal_z[lane] = hit->normal.z;
    glossy->position_x[lane] = hit->position.x;
    glossy->position_y[lane] = hit->position.y;
    glossy->position_z[lane] = hit->position.z;
    glossy->depth[lane] = travelled;
}

void gbuffer_store_glossy(struct glossy_tile *glossy, uint32_t lane, const ps_hit *hit,
                          ps_rgb reflectance, float gloss, float travelled)
{
    if (glossy->depth[lane] > 0.0f && !glossy->sharp[lane])
        return;
    store_first(glossy, lane, hit, reflectance, travelled);
    glossy->gloss[lane] = gloss;
    glossy->sharp[lane] = false;
}

void gbuffer_store_mirror(struct glossy_tile *glossy, uint32_t lane, const ps_hit *hit,
                          ps_rgb reflectance, float travelled)
{
    if (glossy->depth[lane] > 0.0f)
        return;
    store_first(glossy, lane, hit, reflectance, travelled);
    glossy->gloss[lane] = 0.0f;
    glossy->sharp[lane] = true;
}

void gbuffer_forget_mirror(struct glossy_tile *glossy, uint32_t lane)
{
    assert(lane < PS_TILE_PIXELS);
    if (glossy->sharp[lane])
        glossy->depth[lane] = 0.0f;
    glossy->sharp[lane] = false;
}

/* Zeroes a tile's radiance, and tells the tile where it is. */
static void clear_radiance(struct gbuffer *gbuffer, uint32_t index)
{
    ps_tile *tile = &gbuffer->tiles[index];
    if (!gbuffer->radiance)
        return;
    tile->radiance_r = gbuffer->radiance + 3 * (size_t)index * PS_TILE_PIXELS;
    tile->radiance_g = tile->radiance_r + PS_TILE_PIXELS;
    tile->radiance_b = tile->radiance_g + PS_TILE_PIXELS;
    memset(tile->radiance_r, 0, 3 * PS_TILE_PIXELS * sizeof(float));
}

static void clear_splatted(struct gbuffer *gbuffer, uint32_t index)
{
    if (gbuffer->splatted)
        memset(gbuffer_splatted(gbuffer, index, 0), 0, 3 * PS_TILE_PIXELS * sizeof(float));
}

void gbuffer_clear_tile(struct gbuffer *gbuffer, uint32_t index)
{
    assert(index < gbuffer->tile_count);
    ps_tile *tile = &gbuffer->tiles[index];
    memset(tile, 0, sizeof *tile);
    clear_radiance(gbuffer, index);
    clear_splatted(gbuffer, index);
    memset(&gbuffer->emitted[(size_t)index * PS_TILE_PIXELS], 0, PS_TILE_PIXELS * sizeof(ps_rgb));
    memset(&gbuffer->choice[(size_t)index * PS_TILE_PIXELS], CHOSEN_BY_NOTHING, PS_TILE_PIXELS);
    if (gbuffer->glossy) {
        memset(gbuffer->glossy[index].depth, 0, sizeof gbuffer->glossy[index].depth);
        memset(gbuffer->glossy[index].sharp, 0, sizeof gbuffer->glossy[index].sharp);
    }
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        tile->position_x[lane] = tile->position_y[lane] = tile->position_z[lane] = GBUFFER_NOWHERE;
        tile->depth[lane] = INFINITY;
        tile->object[lane] = tile->material[lane] = PS_NO_OBJECT;
    }
}

uint32_t gbuffer_block_lane(uint32_t i)
{
    uint32_t block = i / 16, inside = i % 16;
    uint32_t x = block % 4 * 4 + inside % 4, y = block / 4 * 4 + inside / 4;
    return y * PS_TILE_SIZE + x;
}

void gbuffer_clear_indirect(struct gbuffer *gbuffer)
{
    for (uint32_t i = 0; i < gbuffer->tile_count; i++) {
        ps_tile *tile = &gbuffer->tiles[i];
        memset(tile->irradiance_r, 0, sizeof tile->irradiance_r);
        memset(tile->irradiance_g, 0, sizeof tile->irradiance_g);
        memset(tile->irradiance_b, 0, sizeof tile->irradiance_b);
        memset(tile->weight, 0, sizeof tile->weight);
        memset(tile->variance, 0, sizeof tile->variance);
        clear_radiance(gbuffer, i);
        clear_splatted(gbuffer, i);
    }
}

float gbuffer_alike(const ps_tile *tile, ps_vec3 position, ps_vec3 normal, uint32_t object,
                    float alike[PS_TILE_PIXELS])
{
    float count = 0.0f;
#pragma omp simd reduction(+ : count)
    for (int i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 way = {tile->position_x[i] - position.x, tile->position_y[i] - position.y,
                       tile->position_z[i] - position.z};
        ps_vec3 other_normal = {tile->normal_x[i], tile->normal_y[i], tile->normal_z[i]};
        int same = (tile->object[i] == object) & gbuffer_same_surface(normal, other_normal, way);
        alike[i] = (float)same;
        count += alike[i];
    }
    return count;
}
