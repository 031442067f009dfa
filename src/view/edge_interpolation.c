#include "view/edge_interpolation.h"

#include <psplat/math.h>
#include <psplat/tile.h>
#include <string.h>

#define RADIUS 2 /* pixels around, to each side */

/* A stochastic sample needs so many pixels around that see its surface; another one needs one. Or
 * the whole tile is used. */
#define FEWEST_STOCHASTIC 6.0f

/* How closely what a neighbour sees matches what a sample sees. */
enum { NO_SURFACE, ANOTHER_OBJECT, SAME_OBJECT, SAME_SURFACE };

static void set_neighbour(const struct gbuffer *gbuffer, uint32_t index, uint32_t lane,
                          struct edge_neighbours *neighbours, int i)
{
    const ps_tile *tile = &gbuffer->tiles[index];
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
    for (int c = 0; c < 3 && gbuffer->splatted; c++)
        neighbours->splatted[c][i] = gbuffer_splatted(gbuffer, index, c)[lane];
    if (!tile->radiance_r)
        return;
    neighbours->radiance_r[i] = tile->radiance_r[lane];
    neighbours->radiance_g[i] = tile->radiance_g[lane];
    neighbours->radiance_b[i] = tile->radiance_b[lane];
}

void edge_neighbours_find(const struct gbuffer *gbuffer, uint32_t x, uint32_t y,
                          struct edge_neighbours *neighbours)
{
    memset(neighbours, 0, sizeof *neighbours);
    for (int i = 0; i < EDGE_NEIGHBOURS; i++)
        neighbours->object[i] = PS_NO_OBJECT;
    int next = 0;
    for (int dy = -RADIUS; dy <= RADIUS; dy++)
        for (int dx = -RADIUS; dx <= RADIUS; dx++) {
            uint32_t tile, lane;
            if (gbuffer_find(gbuffer, (int64_t)x + dx, (int64_t)y + dy, &tile, &lane))
                set_neighbour(gbuffer, tile, lane, neighbours, next++);
        }
}

static inline ps_vec3 way_to(const struct edge_neighbours *neighbours, int i, ps_vec3 position)
{
    return (ps_vec3){neighbours->x[i] - position.x, neighbours->y[i] - position.y,
                     neighbours->z[i] - position.z};
}

/* Compares a sample with all neighbours. Returns the best match. */
static int compare(const struct edge_neighbours *neighbours, const ps_tile *tile, uint32_t lane,
                   int match[EDGE_NEIGHBOURS])
{
    ps_vec3 position = ps_tile_position(tile, lane), normal = ps_tile_normal(tile, lane);
    uint32_t object = tile->object[lane];
    int best = ANOTHER_OBJECT;
#pragma omp simd reduction(max : best)
    for (int i = 0; i < EDGE_NEIGHBOURS; i++) {
        ps_vec3 other_normal = {neighbours->normal_x[i], neighbours->normal_y[i],
                                neighbours->normal_z[i]};
        int same_surface =
            gbuffer_same_surface(normal, other_normal, way_to(neighbours, i, position));
        int any = neighbours->object[i] != PS_NO_OBJECT;
        int same_object = any & (neighbours->object[i] == object);
        match[i] = any + same_object + (same_object & same_surface);
        best = match[i] > best ? match[i] : best;
    }
    return best;
}

/* Weights of the neighbours: the inverse squared distance for those that match best, 0 for the
 * others. Returns how many see the sample's surface. */
static float find_weights(const struct edge_neighbours *neighbours, const ps_tile *tile,
                          uint32_t lane, float weights[EDGE_NEIGHBOURS])
{
    int match[EDGE_NEIGHBOURS];
    int best = compare(neighbours, tile, lane, match);
    ps_vec3 position = ps_tile_position(tile, lane);
    float count = 0.0f;
#pragma omp simd reduction(+ : count)
    for (int i = 0; i < EDGE_NEIGHBOURS; i++) {
        float nearness = gbuffer_nearness(way_to(neighbours, i, position));
        weights[i] = match[i] == best ? nearness : 0.0f;
        count += match[i] == SAME_SURFACE ? 1.0f : 0.0f;
    }
    return count;
}

/* The weighted mean; exactly 1 where all values are 1, 0 where all weights are 0. */
static float weighted_mean(const float *weights, const float *values, int n)
{
    float sum = 0.0f, weight = 0.0f;
#pragma omp simd reduction(+ : sum, weight)
    for (int i = 0; i < n; i++) {
        sum += weights[i] * values[i];
        weight += weights[i];
    }
    return weight > 0.0f ? sum / weight : 0.0f;
}

/* Returns how many of the neighbours see the sample's surface. */
static float interpolate_from_neighbours(const struct edge_neighbours *neighbours,
                                         const struct gbuffer *samples, uint32_t lane)
{
    ps_tile *tile = samples->tiles;
    float weights[EDGE_NEIGHBOURS];
    float count = find_weights(neighbours, tile, lane, weights);
    tile->irradiance_r[lane] = weighted_mean(weights, neighbours->r, EDGE_NEIGHBOURS);
    tile->irradiance_g[lane] = weighted_mean(weights, neighbours->g, EDGE_NEIGHBOURS);
    tile->irradiance_b[lane] = weighted_mean(weights, neighbours->b, EDGE_NEIGHBOURS);
    tile->weight[lane] = weighted_mean(weights, neighbours->weight, EDGE_NEIGHBOURS);
    for (int c = 0; c < 3 && samples->splatted; c++)
        gbuffer_splatted(samples, 0, c)[lane] =
            weighted_mean(weights, neighbours->splatted[c], EDGE_NEIGHBOURS);
    if (!tile->radiance_r)
        return count;
    tile->radiance_r[lane] = weighted_mean(weights, neighbours->radiance_r, EDGE_NEIGHBOURS);
    tile->radiance_g[lane] = weighted_mean(weights, neighbours->radiance_g, EDGE_NEIGHBOURS);
    tile->radiance_b[lane] = weighted_mean(weights, neighbours->radiance_b, EDGE_NEIGHBOURS);
    return count;
}

/* From the lanes of a tile that see the sample's surface, if they are more than `count`. */
static void interpolate_from_tile(const struct gbuffer *gbuffer, uint32_t index, float count,
                                  const struct gbuffer *samples, uint32_t lane)
{
    const ps_tile *from = &gbuffer->tiles[index];
    ps_tile *tile = samples->tiles;
    float alike[PS_TILE_PIXELS], weights[PS_TILE_PIXELS];
    ps_vec3 position = ps_tile_position(tile, lane);
    float found =
        gbuffer_alike(from, position, ps_tile_normal(tile, lane), tile->object[lane], alike);
    if (!(found > count))
        return;
    float total = 0.0f;
#pragma omp simd reduction(+ : total)
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 way = ps_subtract(ps_tile_position(from, i), position);
        weights[i] = alike[i] * gbuffer_nearness(way);
        total += weights[i];
    }
#pragma omp simd
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) { /* in proportion, as squares might overflow */
        float near = weights[i] / total;
        weights[i] = near * near;
    }
    tile->irradiance_r[lane] = weighted_mean(weights, from->irradiance_r, PS_TILE_PIXELS);
    tile->irradiance_g[lane] = weighted_mean(weights, from->irradiance_g, PS_TILE_PIXELS);
    tile->irradiance_b[lane] = weighted_mean(weights, from->irradiance_b, PS_TILE_PIXELS);
    for (int c = 0; c < 3 && samples->splatted; c++)
        gbuffer_splatted(samples, 0, c)[lane] =
            weighted_mean(weights, gbuffer_splatted(gbuffer, index, c), PS_TILE_PIXELS);
}

/* Few of the pixels around see the same reflection in gloss; with one of them, its noise would be
 * that of all samples. */
void edge_interpolate(const struct gbuffer *gbuffer, const struct edge_neighbours *neighbours,
                      uint32_t x, uint32_t y, bool stochastic, const struct gbuffer *samples,
                      uint32_t lane)
{
    uint32_t own_lane, own_tile = gbuffer_tile_of(gbuffer, x, y, &own_lane);
    float count = interpolate_from_neighbours(neighbours, samples, lane);
    if (count < (stochastic ? FEWEST_STOCHASTIC : 1.0f))
        interpolate_from_tile(gbuffer, own_tile, count, samples, lane);
}
