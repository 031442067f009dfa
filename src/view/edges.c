#include "view/edges.h"

#include "base/sample.h"
#include "view/pixel_filter.h"
#include "view/view.h"
#include <assert.h>
#include <psplat/host.h>
#include <psplat/tile.h>
#include <string.h>

/* Pixels up to so far to each side know of the indirect light at a sample. */
#define NEIGHBOURHOOD 2
#define NEIGHBOURS 32 /* (2 * NEIGHBOURHOOD + 1)^2, and up to whole vectors */

/* Where chance decides what is looked at, so many must know of it, or all of the tile are asked: elsewhere, one. */
#define FEW 6.0f

/* Seeds of scenes end before: random numbers of samples at edges are no pixel's. */
#define EDGE_SEED ((uint64_t)1 << 63)

/* Samples under way: one tile of a picture of its own. */
struct looks {
    _Alignas(64) ps_tile tile;
    ps_rgb direct[PS_TILE_PIXELS], direct_half[PS_TILE_PIXELS], emitted[PS_TILE_PIXELS];
    ps_rgb hard[PS_TILE_PIXELS], hard_half[PS_TILE_PIXELS];
    bool by_chance[PS_TILE_PIXELS];
    struct glossy_tile glossy;
    float radiance[3 * PS_TILE_PIXELS];
    struct view_points points;
    uint32_t x[PS_TILE_PIXELS], y[PS_TILE_PIXELS]; /* their pixels */
    struct light_runs light_runs;
    float pattern[MOST_AA_SAMPLES][2]; /* where in each pixel they look */
};

static void draw_pattern(const struct edge_pass *pass, struct looks *looks)
{
    uint32_t key = sample_key(pass->seed | EDGE_SEED, PS_STREAM_PIXEL, 0);
    for (uint32_t sample = 0; sample < pass->samples; sample++) {
        float numbers[4];
        sample_point(key, (uint64_t)pass->number * pass->samples + sample, numbers);
        pixel_filter_point(pass->lighting->scene->pixel_filter, numbers, looks->pattern[sample]);
    }
}

/* Shadow rays of a sample: all samples together have no fewer than a pixel elsewhere; two make halves. */
static uint32_t light_samples_of(const struct edge_pass *pass)
{
    uint32_t wanted = (pass->lighting->scene->light_samples + pass->samples - 1) / pass->samples;
    uint32_t least = pass->gbuffer->direct_half ? 2 : 1;
    return wanted > least ? wanted : least;
}

static void add_look(const struct edge_pass *pass, uint32_t tile, uint32_t lane, uint32_t sample,
                     struct looks *looks)
{
    uint32_t to = (uint32_t)looks->points.count++;
    uint64_t block = ps_sample_block(gbuffer_number(pass->gbuffer, tile), lane);
    uint64_t number = (uint64_t)pass->number * pass->samples + sample;
    gbuffer_pixel(pass->gbuffer, tile, lane, &looks->x[to], &looks->y[to]);
    looks->points.lanes[to] = to;
    looks->points.x[to] = (float)looks->x[to] + looks->pattern[sample][0];
    looks->points.y[to] = (float)looks->y[to] + looks->pattern[sample][1];
    looks->points.indices[to] = block + number;
    looks->light_runs.first[to] = block + number * light_samples_of(pass);
    looks->light_runs.of_lane[to] = (uint8_t)to;
}

/* How like what a neighbour sees is to what a sample sees. */
enum { NO_SURFACE, ANOTHER_OBJECT, SAME_OBJECT, SAME_SURFACE };

/* The pixels around one, which all of its samples look at. */
struct neighbours {
    uint32_t object[NEIGHBOURS]; /* PS_NO_OBJECT: sees no surface, or there is no pixel */
    float x[NEIGHBOURS], y[NEIGHBOURS], z[NEIGHBOURS];
    float normal_x[NEIGHBOURS], normal_y[NEIGHBOURS], normal_z[NEIGHBOURS];
    float r[NEIGHBOURS], g[NEIGHBOURS], b[NEIGHBOURS], weight[NEIGHBOURS]; /* indirect light */
    float radiance_r[NEIGHBOURS], radiance_g[NEIGHBOURS], radiance_b[NEIGHBOURS];
};

static void set_neighbour(const ps_tile *tile, uint32_t lane, struct neighbours *neighbours, int i)
{
    neighbours->object[i] = tile->object[lane];
    neighbours->x[i] = tile->position_x[lane];
    neighbours->y[i] = tile->position_y[lane];
    neighbours->z[i] = tile->position_z[lane];
    neighbours->normal_x[i] = tile->normal_x[lane];
    neighbours->normal_y[i] = tile->normal_y[lane];
    neighbours->normal_z[i] = tile->normal_z[lane];
    neighbours->r[i] = tile->irradiance_r[lane];
    neighbours->g[i] = tile->irradiance_g[lane];
    neighbours->b[i] = tile->irradiance_b[lane];
    neighbours->weight[i] = tile->weight[lane];
    if (!tile->radiance_r)
        return;
    neighbours->radiance_r[i] = tile->radiance_r[lane];
    neighbours->radiance_g[i] = tile->radiance_g[lane];
    neighbours->radiance_b[i] = tile->radiance_b[lane];
}

static void find_neighbours(const struct gbuffer *gbuffer, uint32_t x, uint32_t y,
                            struct neighbours *neighbours)
{
    memset(neighbours, 0, sizeof *neighbours);
    for (int i = 0; i < NEIGHBOURS; i++)
        neighbours->object[i] = PS_NO_OBJECT;
    int next = 0;
    for (int dy = -NEIGHBOURHOOD; dy <= NEIGHBOURHOOD; dy++)
        for (int dx = -NEIGHBOURHOOD; dx <= NEIGHBOURHOOD; dx++) {
            uint32_t tile, lane;
            if (gbuffer_find(gbuffer, (int64_t)x + dx, (int64_t)y + dy, &tile, &lane))
                set_neighbour(&gbuffer->tiles[tile], lane, neighbours, next++);
        }
}

static inline ps_vec3 way_to(const struct neighbours *neighbours, int i, ps_vec3 position)
{
    return (ps_vec3){neighbours->x[i] - position.x, neighbours->y[i] - position.y,
                     neighbours->z[i] - position.z};
}

/* How like each neighbour is to what a sample sees. Returns the most of that. */
static int compare(const struct neighbours *neighbours, const ps_tile *tile, uint32_t lane,
                   int likeness[NEIGHBOURS])
{
    ps_vec3 position = ps_tile_position(tile, lane), normal = ps_tile_normal(tile, lane);
    uint32_t object = tile->object[lane];
    int most = ANOTHER_OBJECT;
#pragma omp simd reduction(max : most)
    for (int i = 0; i < NEIGHBOURS; i++) {
        ps_vec3 other_normal = {neighbours->normal_x[i], neighbours->normal_y[i],
                                neighbours->normal_z[i]};
        int same_surface =
            gbuffer_same_surface(normal, other_normal, way_to(neighbours, i, position));
        int any = neighbours->object[i] != PS_NO_OBJECT;
        int same_object = any & (neighbours->object[i] == object);
        likeness[i] = any + same_object + (same_object & same_surface);
        most = likeness[i] > most ? likeness[i] : most;
    }
    return most;
}

/* What each neighbour counts for a sample: those that are most like it, by their nearness. Returns how many of them see its surface. */
static float find_weights(const struct neighbours *neighbours, const ps_tile *tile, uint32_t lane,
                          float weights[NEIGHBOURS])
{
    int likeness[NEIGHBOURS];
    int most = compare(neighbours, tile, lane, likeness);
    ps_vec3 position = ps_tile_position(tile, lane);
    float count = 0.0f;
#pragma omp simd reduction(+ : count)
    for (int i = 0; i < NEIGHBOURS; i++) {
        float nearness = gbuffer_nearness(way_to(neighbours, i, position));
        weights[i] = likeness[i] == most ? nearness : 0.0f;
        count += likeness[i] == SAME_SURFACE ? 1.0f : 0.0f;
    }
    return count;
}

/* The mean by weights: of values that are 1, 1 to the bit. 0 where nothing has weight. */
static float mean_by(const float *weights, const float *values, int n)
{
    float sum = 0.0f, weight = 0.0f;
#pragma omp simd reduction(+ : sum, weight)
    for (int i = 0; i < n; i++) {
        sum += weights[i] * values[i];
        weight += weights[i];
    }
    return weight > 0.0f ? sum / weight : 0.0f;
}

/* Gives a sample the indirect light that the pixels around found. Returns how many of them see its surface. */
static float borrow_from_neighbours(const struct neighbours *neighbours, ps_tile *tile,
                                    uint32_t lane)
{
    float weights[NEIGHBOURS];
    float count = find_weights(neighbours, tile, lane, weights);
    tile->irradiance_r[lane] = mean_by(weights, neighbours->r, NEIGHBOURS);
    tile->irradiance_g[lane] = mean_by(weights, neighbours->g, NEIGHBOURS);
    tile->irradiance_b[lane] = mean_by(weights, neighbours->b, NEIGHBOURS);
    tile->weight[lane] = mean_by(weights, neighbours->weight, NEIGHBOURS);
    if (!tile->radiance_r)
        return count;
    tile->radiance_r[lane] = mean_by(weights, neighbours->radiance_r, NEIGHBOURS);
    tile->radiance_g[lane] = mean_by(weights, neighbours->radiance_g, NEIGHBOURS);
    tile->radiance_b[lane] = mean_by(weights, neighbours->radiance_b, NEIGHBOURS);
    return count;
}

/* The irradiance of those in a tile that see the sample's surface, if they are more than `count`. */
static void borrow_from_tile(const ps_tile *from, float count, ps_tile *tile, uint32_t lane)
{
    float alike[PS_TILE_PIXELS], weights[PS_TILE_PIXELS];
    ps_vec3 position = ps_tile_position(tile, lane);
    float found =
        gbuffer_alike(from, position, ps_tile_normal(tile, lane), tile->object[lane], alike);
    if (!(found > count))
        return;
#pragma omp simd
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++)
        weights[i] = alike[i] * gbuffer_nearness(ps_subtract(ps_tile_position(from, i), position));
    tile->irradiance_r[lane] = mean_by(weights, from->irradiance_r, PS_TILE_PIXELS);
    tile->irradiance_g[lane] = mean_by(weights, from->irradiance_g, PS_TILE_PIXELS);
    tile->irradiance_b[lane] = mean_by(weights, from->irradiance_b, PS_TILE_PIXELS);
}

/* What gloss mirrors is seen by few of the pixels around, each by chance, and the noise of one would be that of all. */
static void light_look(const struct edge_pass *pass, const struct neighbours *neighbours,
                       struct looks *looks, uint32_t look)
{
    uint32_t lane;
    float count = borrow_from_neighbours(neighbours, &looks->tile, look);
    if (count >= (looks->by_chance[look] ? FEW : 1.0f))
        return;
    uint32_t tile = gbuffer_tile_of(pass->gbuffer, looks->x[look], looks->y[look], &lane);
    borrow_from_tile(&pass->gbuffer->tiles[tile], count, &looks->tile, look);
}

static bool same_pixel(const struct looks *looks, uint32_t i, uint32_t j)
{
    return looks->x[i] == looks->x[j] && looks->y[i] == looks->y[j];
}

/* Those of a pixel lie one after the other. */
static void add_looks(const struct edge_pass *pass, const struct gbuffer *samples,
                      struct looks *looks, struct film *film)
{
    uint32_t count = (uint32_t)looks->points.count;
    for (uint32_t first = 0, end; first < count; first = end) {
        struct neighbours neighbours;
        find_neighbours(pass->gbuffer, looks->x[first], looks->y[first], &neighbours);
        for (end = first; end < count && same_pixel(looks, first, end); end++)
            light_look(pass, &neighbours, looks, end);
        if (film_has_pixel(film, looks->x[first], looks->y[first]))
            film_add_samples(film, samples, first, end - first, 1.0f / (float)pass->samples,
                             looks->x[first], looks->y[first]);
    }
}

/* Traces the samples, adds them to their pixels and forgets them. */
static void finish_looks(const struct edge_pass *pass, struct looks *looks, struct film *film)
{
    const struct lighting *lighting = pass->lighting;
    struct gbuffer gbuffer = {
        .width = PS_TILE_SIZE,
        .height = PS_TILE_SIZE,
        .picture_across = 1,
        .tiles_across = 1,
        .tiles_down = 1,
        .tile_count = 1,
        .tiles = &looks->tile,
        .direct = looks->direct,
        .direct_half = pass->gbuffer->direct_half ? looks->direct_half : NULL,
        .hard = pass->gbuffer->hard ? looks->hard : NULL,
        .hard_half = pass->gbuffer->hard_half ? looks->hard_half : NULL,
        .emitted = looks->emitted,
        .by_chance = looks->by_chance,
        .glossy = pass->gbuffer->glossy ? &looks->glossy : NULL,
        .radiance = pass->gbuffer->radiance ? looks->radiance : NULL,
    };
    struct view_pass view = {
        .lighting = *lighting,
        .gbuffer = &gbuffer,
        .seed = pass->seed | EDGE_SEED,
    };
    view_trace(&view, &looks->points, 0);
    looks->light_runs.count = looks->points.count;
    direct_light_tile(lighting, &gbuffer, 0, view.seed, &looks->light_runs, light_samples_of(pass));
    add_looks(pass, &gbuffer, looks, film);
    looks->points.count = 0;
}

static bool has_edges(const bool edges[PS_TILE_PIXELS])
{
    bool any = false;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
        any |= edges[lane];
    return any;
}

static void look_again(const struct edge_pass *pass, uint32_t tile, const bool *edges,
                       struct film *film)
{
    struct looks looks;
    draw_pattern(pass, &looks);
    looks.points.count = 0;
    looks.points.of_pixel = pass->samples;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        if (!edges[lane])
            continue;
        if (looks.points.count > 0 && looks.points.count + pass->samples > PS_TILE_PIXELS)
            finish_looks(pass, &looks, film);
        for (uint32_t sample = 0; sample < pass->samples; sample++) {
            add_look(pass, tile, lane, sample, &looks);
            if (looks.points.count == PS_TILE_PIXELS)
                finish_looks(pass, &looks, film);
        }
    }
    if (looks.points.count > 0)
        finish_looks(pass, &looks, film);
}

void edges_add_tile(const struct edge_pass *pass, uint32_t tile, struct film *film)
{
    assert(tile < pass->gbuffer->tile_count);
    const bool *edges = &pass->edges[(size_t)tile * PS_TILE_PIXELS];
    if (film_has_tile(film, pass->gbuffer, tile) && has_edges(edges))
        look_again(pass, tile, edges, film);
}
