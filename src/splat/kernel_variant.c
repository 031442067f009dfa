/* kernel_variant.c: the loops of kernel.h, compiled once for each instruction set with
 * KERNEL_VARIANT naming it. Conditions are joined by &, not &&, and indices stay in their tables,
 * so that every lane may run every step. Loops over lanes are marked `omp simd`, and results go to
 * arrays that no gather may alias: where compilers have doubts they leave a loop scalar without a
 * word (tests/cli/test_vectors.sh).
 *
 * Splats are taken a few at a time: first each is tried on the sixteen blocks' bounds, which gives
 * every block a list; then block after block runs through its list, so that its pixels stay at
 * hand.
 */
#include "placement/footprint.h"
#include "splat/kernel.h"
#include "splat/lanes.h"

#include <math.h>

#define JOIN_NAMES(a, b) a##b
#define NAME_OF(function, variant) JOIN_NAMES(function, variant)
#define KERNEL_ACCUMULATE NAME_OF(kernel_accumulate_, KERNEL_VARIANT)
#define KERNEL_WEIGH NAME_OF(kernel_weigh_, KERNEL_VARIANT)
#define KERNEL_TOUCH NAME_OF(kernel_touch_, KERNEL_VARIANT)

struct kernel_count KERNEL_ACCUMULATE(struct interleaved_tile *tile,
                                      const struct kernel_splat *splats, const uint32_t *indices,
                                      size_t n, uint32_t resolution,
                                      const struct kernel_profile *profile);
uint32_t KERNEL_WEIGH(const struct interleaved_tile *tile, const struct kernel_splat *splat,
                      const struct kernel_profile *profile, struct kernel_weighed *weighed);
uint32_t KERNEL_TOUCH(const struct bounds *bounds, const struct kernel_splat *splat);

_Static_assert(LANES == INTERLEAVED_BLOCK, "pixels of a block");
_Static_assert(LANES == BOUNDS_WIDTH, "blocks of a tile");
#define AT_A_TIME 64 /* splats */

static inline float clamp(float x, float low, float high)
{
    return ps_min(ps_max(x, low), high);
}

static inline uint32_t touch(const struct bounds *bounds, const struct kernel_splat *splat)
{
    const ps_vec3 u = splat->u, v = splat->v, w = splat->w;
    _Alignas(64) int32_t touches[LANES];
#pragma omp simd
    for (int i = 0; i < BOUNDS_WIDTH; i++) {
        float x = bounds->center_x[i] - splat->centre.x;
        float y = bounds->center_y[i] - splat->centre.y;
        float z = bounds->center_z[i] - splat->centre.z;
        float ex = bounds->extent_x[i], ey = bounds->extent_y[i], ez = bounds->extent_z[i];
        float along_u = fabsf(x * u.x + y * u.y + z * u.z) -
                        (ex * fabsf(u.x) + ey * fabsf(u.y) + ez * fabsf(u.z));
        float along_v = fabsf(x * v.x + y * v.y + z * v.z) -
                        (ex * fabsf(v.x) + ey * fabsf(v.y) + ez * fabsf(v.z));
        float depth = x * w.x + y * w.y + z * w.z;
        float reach = ex * fabsf(w.x) + ey * fabsf(w.y) + ez * fabsf(w.z);
        float off_u = ps_max(along_u, 0.0f), off_v = ps_max(along_v, 0.0f);
        /* The lowest that n.W may be. */
        float facing = ps_min(bounds->normal_low_x[i] * w.x, bounds->normal_high_x[i] * w.x) +
                       ps_min(bounds->normal_low_y[i] * w.y, bounds->normal_high_y[i] * w.y) +
                       ps_min(bounds->normal_low_z[i] * w.z, bounds->normal_high_z[i] * w.z);
        touches[i] = -((off_u * off_u + off_v * off_v < 1.0f) & (facing < 0.0f) &
                       (depth - reach <= splat->far_depth) & (depth + reach >= splat->near_depth));
    }
    return lanes_mask(touches);
}

uint32_t KERNEL_TOUCH(const struct bounds *bounds, const struct kernel_splat *splat)
{
    return touch(bounds, splat);
}

/* The splats, of AT_A_TIME, that may light each block. */
struct block_lists {
    uint32_t count[BOUNDS_WIDTH];
    uint32_t splats[BOUNDS_WIDTH][AT_A_TIME];
};

static inline void list_by_block(const struct bounds *blocks, const struct kernel_splat *splats,
                                 const uint32_t *indices, size_t n, struct block_lists *lists)
{
    for (int block = 0; block < BOUNDS_WIDTH; block++)
        lists->count[block] = 0;
    for (size_t i = 0; i < n; i++)
        for (uint32_t mask = touch(blocks, &splats[indices[i]]); mask; mask &= mask - 1) {
            int block = lanes_first(mask);
            lists->splats[block][lists->count[block]++] = indices[i];
        }
}

/* Where the pixels of a block lie in a splat's box. */
struct placed_block {
    float u[LANES], v[LANES];     /* across it, in radii */
    float t[LANES], above[LANES]; /* along it, from the centre and from the photon's plane */
    float facing[LANES]; /* cosine under which the light meets the surface; negative from behind */
    float geometric_facing[LANES]; /* where the geometric normal is another; set by face_surfaces */
    float width[LANES], inverse_width[LANES]; /* h and 1 / h; set by choose_widths */
};

/* What a block's pixels get from one splat. */
struct block_light {
    float weight[LANES], projected[LANES]; /* K * V, and that times the cosine */
};

/* Whether some pixel of the block lies inside of the box and faces the light: half of the blocks
 * whose bounds a box touches have none. */
static inline int place_block(const struct interleaved_tile *tile, int first,
                              const struct kernel_splat *splat, struct placed_block *placed)
{
    _Alignas(64) int32_t inside[LANES];
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float x = tile->position_x[first + i] - splat->centre.x;
        float y = tile->position_y[first + i] - splat->centre.y;
        float z = tile->position_z[first + i] - splat->centre.z;
        float u = x * splat->u.x + y * splat->u.y + z * splat->u.z;
        float v = x * splat->v.x + y * splat->v.y + z * splat->v.z;
        float t = x * splat->w.x + y * splat->w.y + z * splat->w.z;
        float above = kernel_above(splat, u, v, t);
        float facing =
            -(tile->normal_x[first + i] * splat->w.x + tile->normal_y[first + i] * splat->w.y +
              tile->normal_z[first + i] * splat->w.z);
        placed->u[i] = u;
        placed->v[i] = v;
        placed->t[i] = t;
        placed->above[i] = above;
        placed->facing[i] = facing;
        inside[i] =
            -((u * u + v * v < 1.0f) & (facing > 0.0f) & (t <= splat->far_depth) & (above >= 0.0f));
    }
    return lanes_mask(inside) != 0;
}

/* The parts of the disc that pixels take; whether some pixel lies in its own. */
static inline int choose_widths(const struct interleaved_tile *tile, int first,
                                const struct kernel_splat *splat, struct placed_block *placed)
{
    _Alignas(64) int32_t inside[LANES];
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float x = tile->normal_x[first + i], y = tile->normal_y[first + i],
              z = tile->normal_z[first + i];
        float width = bandwidth_at(&splat->width, placed->above[i], placed->facing[i],
                                   x * splat->u.x + y * splat->u.y + z * splat->u.z,
                                   x * splat->v.x + y * splat->v.y + z * splat->v.z);
        placed->width[i] = width;
        placed->inverse_width[i] = 1.0f / width;
        inside[i] = -(placed->u[i] * placed->u[i] + placed->v[i] * placed->v[i] < width * width);
    }
    return lanes_mask(inside) != 0;
}

/* Cosines under which the light meets the surfaces themselves. */
static inline const float *face_surfaces(const struct interleaved_tile *tile, int first,
                                         const struct kernel_splat *splat,
                                         struct placed_block *placed)
{
    const struct geometric_normals *normals = tile->geometric;
    if (!normals)
        return placed->facing;
#pragma omp simd
    for (int i = 0; i < LANES; i++)
        placed->geometric_facing[i] =
            -(normals->x[first + i] * splat->w.x + normals->y[first + i] * splat->w.y +
              normals->z[first + i] * splat->w.z);
    return placed->geometric_facing;
}

/* How deep the map sees at the texel that each pixel lies in, or the nearest one. */
static inline void look_into_map(const struct placed_block *placed, const float *depths,
                                 int resolution, float *restrict seen)
{
    const float half_resolution = 0.5f * (float)resolution;
    const float last_texel = (float)resolution - 0.5f;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        int column = (int)clamp((placed->u[i] + 1.0f) * half_resolution, 0.0f, last_texel);
        int line = (int)clamp((placed->v[i] + 1.0f) * half_resolution, 0.0f, last_texel);
        seen[i] = depths[line * resolution + column];
    }
}

/* The profile at each pixel, and the squared radius there, 1e6 at most (LEAST_WIDTH). Past 1 any
 * entry will do, and must not be chosen: compilers then choose between addresses, and gather
 * slowly. */
static inline void look_into_profile(const struct placed_block *placed, const float *profile,
                                     float *restrict radius2, float *restrict values)
{
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float u = placed->u[i], v = placed->v[i], inverse_width = placed->inverse_width[i];
        radius2[i] = ps_min(u * u + v * v, 1.0f) * inverse_width * inverse_width;
        values[i] =
            profile[(int)(radius2[i] * (float)KERNEL_PROFILE_SIZE) & (KERNEL_PROFILE_SIZE - 1)];
    }
}

#define LEAST_COSINE (1.0f / sqrtf(1.0f + FOOTPRINT_STEEPEST * FOOTPRINT_STEEPEST))

/* Returns how many pixels have weight. A pixel may lie past the map by the bias, c + s * tangent of
 * the angle under which the light meets the surface itself; both sides times the cosine need no
 * root. */
static inline int weigh(const struct placed_block *placed, const float *surface_facing,
                        const struct kernel_splat *splat, int resolution, const float *profile,
                        struct block_light *restrict light)
{
    const float slope2 = splat->bias_slope * splat->bias_slope;
    _Alignas(64) float seen[LANES];
    _Alignas(64) float radius2[LANES];
    _Alignas(64) float height[LANES];
    _Alignas(64) int32_t lit[LANES];
    look_into_map(placed, splat->depths, resolution, seen);
    look_into_profile(placed, profile, radius2, height);
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float u = placed->u[i], v = placed->v[i], t = placed->t[i], facing = placed->facing[i];
        float inverse_width = placed->inverse_width[i];
        float least_above = splat->clearance * ps_min(placed->width[i], 1.0f);
        float cosine = clamp(surface_facing[i], LEAST_COSINE, 1.0f);
        float past = ps_max(0.0f, t - seen[i] - splat->bias_constant) * cosine;
        int is_lit = (u * u + v * v < 1.0f) & (radius2[i] < 1.0f) & (facing > 0.0f) &
                     (surface_facing[i] > 0.0f) & (t >= splat->near_depth) &
                     (t <= splat->far_depth) & (placed->above[i] >= least_above) &
                     (past * past <= slope2 * (1.0f - cosine * cosine));
        float narrowing = 1.0f + splat->by_width * (inverse_width * inverse_width - 1.0f);
        /* A product, not a choice, which would make the loop scalar. */
        float weight = (float)is_lit * height[i] * splat->kernel_scale * narrowing;
        light->weight[i] = weight;
        light->projected[i] =
            gather_share_of_splats(splat->near, placed->above[i]) * weight * facing;
        lit[i] = -is_lit;
    }
    return lanes_count(lanes_mask(lit));
}

/* The part of the kernel around each pixel's start that lies beyond a wall, or KERNEL_BEHIND. (Here
 * the entry is chosen, at both ends: the table's length is no power of two.) */
static inline void look_beyond(const struct placed_block *placed, const ps_boundary *wall,
                               const float *beyond, float *restrict parts)
{
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float distance =
            wall->distance - (placed->u[i] * wall->normal_u + placed->v[i] * wall->normal_v);
        float within = clamp(distance * placed->inverse_width[i], 0.0f, 1.0f);
        float part = beyond[(int)(within * (float)(KERNEL_BOUNDARY_SIZE - 1))];
        parts[i] = distance > 0.0f ? part : KERNEL_BEHIND;
    }
}

/* Divides by the part of the kernel that the boundaries beside the photon leave; behind them there
 * is no such photon. */
static inline void make_up(const struct placed_block *placed, const struct kernel_splat *splat,
                           const float *beyond, struct block_light *light)
{
    _Alignas(64) float one[LANES], other[LANES] = {0};
    look_beyond(placed, &splat->boundaries[0], beyond, one);
    if (splat->boundary_count > 1)
        look_beyond(placed, &splat->boundaries[1], beyond, other);
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float in_front = (float)((one[i] < KERNEL_BEHIND) & (other[i] < KERNEL_BEHIND));
        float share = in_front / kernel_left(one[i], other[i], splat->boundaries_likeness);
        light->weight[i] *= share;
        light->projected[i] *= share;
    }
}

static inline void add(struct interleaved_tile *tile, int first, ps_rgb power,
                       const struct block_light *light)
{
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        tile->irradiance_r[first + i] += light->projected[i] * power.r;
        tile->irradiance_g[first + i] += light->projected[i] * power.g;
        tile->irradiance_b[first + i] += light->projected[i] * power.b;
        tile->weight[first + i] += light->weight[i];
    }
}

/* What a splat gives to a block; returns how many pixels get something. */
static inline int weigh_block(const struct interleaved_tile *tile, int first,
                              const struct kernel_splat *splat, int resolution,
                              const struct kernel_profile *profile, struct block_light *light)
{
    _Alignas(64) struct placed_block placed;
    if (!place_block(tile, first, splat, &placed) || !choose_widths(tile, first, splat, &placed))
        return 0;
    int lit = weigh(&placed, face_surfaces(tile, first, splat, &placed), splat, resolution,
                    profile->weights, light);
    if (lit > 0 && splat->boundary_count > 0)
        make_up(&placed, splat, profile->beyond, light);
    return lit;
}

/* Adds a splat to a block; returns how many pixels got something. */
static inline int light_block(struct interleaved_tile *tile, int first,
                              const struct kernel_splat *splat, int resolution,
                              const struct kernel_profile *profile)
{
    _Alignas(64) struct block_light light;
    int lit = weigh_block(tile, first, splat, resolution, profile, &light);
    if (lit > 0)
        add(tile, first, splat->power, &light);
    return lit;
}

uint32_t KERNEL_WEIGH(const struct interleaved_tile *tile, const struct kernel_splat *splat,
                      const struct kernel_profile *profile, struct kernel_weighed *weighed)
{
    _Alignas(64) struct block_light light;
    uint32_t count = 0;
    for (uint32_t mask = touch(&tile->blocks, splat); mask; mask &= mask - 1) {
        uint32_t first = (uint32_t)lanes_first(mask) * LANES;
        if (weigh_block(tile, (int)first, splat, 1, profile, &light) == 0)
            continue;
        for (uint32_t i = 0; i < LANES; i++) {
            if (!(light.weight[i] > 0.0f))
                continue;
            weighed->lanes[count] = first + i;
            weighed->weight[count] = light.weight[i];
            weighed->projected[count++] = light.projected[i];
        }
    }
    return count;
}

struct kernel_count KERNEL_ACCUMULATE(struct interleaved_tile *tile,
                                      const struct kernel_splat *splats, const uint32_t *indices,
                                      size_t n, uint32_t resolution,
                                      const struct kernel_profile *profile) {
    struct kernel_count count = {0, 0};
    struct block_lists lists;
    for (size_t first = 0; first < n; first += AT_A_TIME) {
        size_t some = n - first < AT_A_TIME ? n - first : AT_A_TIME;
        list_by_block(&tile->blocks, splats, indices + first, some, &lists);
        for (int block = 0; block < BOUNDS_WIDTH; block++) {
            count.tests += (uint64_t)lists.count[block] * LANES;
            for (uint32_t i = 0; i < lists.count[block]; i++)
                count.lit += (uint64_t)light_block(
                    tile, block * LANES, &splats[lists.splats[block][i]], (int)resolution, profile);
        }
    }
    return count;
}
