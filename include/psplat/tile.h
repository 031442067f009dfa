/* tile.h: the pixels of a tile as lists, for estimators that work point by point. */
#ifndef PSPLAT_TILE_H
#define PSPLAT_TILE_H

#include <psplat/math.h>

/* Where a pixel of a tile looks, and its normal there. */
static inline ps_vec3 ps_tile_position(const ps_tile *tile, uint32_t lane)
{
    return (ps_vec3){tile->position_x[lane], tile->position_y[lane], tile->position_z[lane]};
}

static inline ps_vec3 ps_tile_normal(const ps_tile *tile, uint32_t lane)
{
    return (ps_vec3){tile->normal_x[lane], tile->normal_y[lane], tile->normal_z[lane]};
}

/* albedo * throughput: the radiance in the picture is this * irradiance / pi. */
static inline ps_rgb ps_tile_reflectance(const ps_tile *tile, uint32_t lane)
{
    return (ps_rgb){tile->albedo_r[lane] * tile->throughput_r[lane],
                    tile->albedo_g[lane] * tile->throughput_g[lane],
                    tile->albedo_b[lane] * tile->throughput_b[lane]};
}

/* How wide a pixel is at a depth, in the scene's units. */
static inline float ps_pixel_size(const ps_camera *camera, float depth)
{
    float across = ps_length(camera->across);
    return camera->projection == PS_ORTHOGRAPHIC
               ? across
               : depth * across / ps_dot(camera->forward, camera->corner);
}

/* The pixels of a tile that see a surface. */
typedef struct ps_points {
    size_t count;
    ps_vec3 positions[PS_TILE_PIXELS], normals[PS_TILE_PIXELS];
    uint32_t lanes[PS_TILE_PIXELS]; /* where in the tile each point is */
} ps_points;

static inline void ps_collect_points(const ps_tile *tile, ps_points *points)
{
    points->count = 0;
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        if (tile->object[lane] == PS_NO_OBJECT)
            continue;
        size_t i = points->count++;
        points->positions[i] = ps_tile_position(tile, lane);
        points->normals[i] = ps_tile_normal(tile, lane);
        points->lanes[i] = lane;
    }
}

/* Of two normals of one surface, one of them bent, the least cosine: 75 degrees. */
#define PS_OWN_SURFACE_COSINE 0.25f

/* Forgets the hits of rays that left points by a smoothed or bent normal, but into their own
 * surface: nothing shines on a point of its plane. A point in a crease lies in the planes of two
 * surfaces; hits of the other one stay, and their normals tell them. Ray i left point targets[i].
 * `offset`: that of the rays (ps_pass.surface_offset). */
static inline void ps_forget_own_surface(const ps_points *points, const uint32_t *targets, size_t n,
                                         float offset, ps_hit *hits)
{
    for (size_t i = 0; i < n; i++) {
        ps_vec3 normal = points->normals[targets[i]], plane = hits[i].geometric_normal;
        ps_vec3 from_hit = ps_subtract(points->positions[targets[i]], hits[i].position);
        if (hits[i].distance < INFINITY && fabsf(ps_dot(from_hit, plane)) < 2.0f * offset &&
            fabsf(ps_dot(normal, plane)) > PS_OWN_SURFACE_COSINE)
            hits[i].distance = INFINITY;
    }
}

/* Where a pixel's own block of a sample sequence begins: 2^24 aligned indices, so that its first
 * 2^k samples are stratified. */
static inline uint64_t ps_sample_block(uint64_t tile, uint32_t lane)
{
    return (tile * PS_TILE_PIXELS + lane) << 24;
}

/* The place of a lane along a Z curve through its tile (Morton 1966): aligned squares of pixels are
 * runs of it. */
static inline uint32_t ps_lane_along_curve(uint32_t lane)
{
    uint32_t x = lane % PS_TILE_SIZE, y = lane / PS_TILE_SIZE, place = 0;
    for (uint32_t bit = 0; bit < 4; bit++)
        place |= (x >> bit & 1u) << 2 * bit | (y >> bit & 1u) << (2 * bit + 1);
    return place;
}

/* The first of a pixel's `count` samples of a pass. Of the first pass those of a tile are shared
 * out along a Z curve: the samples of any aligned square of pixels are a run of the sequence,
 * and stratified as a whole, best where count is a power of two (Ahmed and Wonka 2020,
 * "Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of
 * pixels"). Further passes take a run of each pixel's own, so that its samples of many passes
 * are stratified instead. */
static inline uint64_t ps_tile_sample(uint64_t tile, uint32_t lane, uint32_t pass, uint64_t count)
{
    if (pass == 0)
        return (tile << 32) + ps_lane_along_curve(lane) * count;
    return ps_sample_block(tile, lane) + (UINT64_C(1) << 23) + pass * count;
}

/* Adds irradiance (W/m^2), and weight 1, to a pixel of a tile. */
static inline void ps_add_irradiance(ps_tile *tile, uint32_t lane, ps_rgb irradiance)
{
    tile->irradiance_r[lane] += irradiance.r;
    tile->irradiance_g[lane] += irradiance.g;
    tile->irradiance_b[lane] += irradiance.b;
    tile->weight[lane] += 1.0f;
}

#endif
