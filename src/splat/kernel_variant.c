/* kernel_variant.c: the loop of kernel.h, compiled once for each instruction set with KERNEL_FUNCTION
 * naming the result. Conditions are masks (0 or 1 joined by &), and indices are clamped, so that every
 * lane may run every step. */
#include "splat/box.h"
#include "splat/kernel.h"

#include <math.h>

uint64_t KERNEL_FUNCTION(ps_tile *tile, const struct kernel_splat *splats, const uint32_t *indices,
                         size_t n, uint32_t resolution, const struct kernel_profile *profile);

/* Comparisons become vector minima and maxima; fminf's promise about NaN would cost a call. */
static inline float least(float a, float b)
{
    return a < b ? a : b;
}

static inline float clamp(float x, float low, float high)
{
    float raised = x < low ? low : x;
    return least(raised, high);
}

/* K * V and K * V * cosine of one splat at every pixel; returns how many pixels have weight. The results
 * go to arrays of their own first: then no store can alias the gathers, and any compiler sees it. */
static inline int weigh(const ps_tile *tile, const struct kernel_splat splat, int resolution,
                        const float *weights, float *weight, float *projected)
{
    const float half_resolution = 0.5f * (float)resolution;
    const float last_texel = (float)resolution - 0.5f;
    int useful = 0;
    for (int i = 0; i < PS_TILE_PIXELS; i++) {
        float x = tile->position_x[i] - splat.centre.x;
        float y = tile->position_y[i] - splat.centre.y;
        float z = tile->position_z[i] - splat.centre.z;
        float u = x * splat.u.x + y * splat.u.y + z * splat.u.z;
        float v = x * splat.v.x + y * splat.v.y + z * splat.v.z;
        float t = x * splat.w.x + y * splat.w.y + z * splat.w.z;
        float r2 = u * u + v * v;
        float cosine = -(tile->normal_x[i] * splat.w.x + tile->normal_y[i] * splat.w.y +
                         tile->normal_z[i] * splat.w.z);
        float safe_cosine = clamp(cosine, 1e-3f, 1.0f);
        float slope = sqrtf(1.0f - safe_cosine * safe_cosine) / safe_cosine;
        float bias = splat.bias_constant + splat.bias_slope * least(slope, BOX_STEEPEST);
        int column = (int)clamp((u + 1.0f) * half_resolution, 0.0f, last_texel);
        int row = (int)clamp((v + 1.0f) * half_resolution, 0.0f, last_texel);
        float past = t - splat.depths[row * resolution + column];
        int entry = (int)(clamp(r2, 0.0f, 0.99999f) * (float)KERNEL_PROFILE_SIZE);
        int lit = (r2 < 1.0f) & (cosine > 0.0f) & (t >= splat.near_depth) &
                  (t <= splat.far_depth) & (past <= bias) & (-past <= bias + splat.front);
        /* A product, not a choice: compilers would make the load conditional and the loop scalar. */
        weight[i] = (float)lit * weights[entry] * splat.kernel_scale;
        projected[i] = weight[i] * safe_cosine;
        useful += lit;
    }
    return useful;
}

static inline void add(ps_tile *tile, ps_rgb power, const float *weight, const float *projected)
{
    for (int i = 0; i < PS_TILE_PIXELS; i++) {
        tile->irradiance_r[i] += projected[i] * power.r;
        tile->irradiance_g[i] += projected[i] * power.g;
        tile->irradiance_b[i] += projected[i] * power.b;
        tile->weight[i] += weight[i];
    }
}

uint64_t KERNEL_FUNCTION(ps_tile *tile, const struct kernel_splat *splats, const uint32_t *indices,
                         size_t n, uint32_t resolution, const struct kernel_profile *profile)
{
    _Alignas(64) float weight[PS_TILE_PIXELS], projected[PS_TILE_PIXELS];
    uint64_t useful = 0;
    for (size_t i = 0; i < n; i++) {
        const struct kernel_splat *splat = &splats[indices[i]];
        int lit = weigh(tile, *splat, (int)resolution, profile->weights, weight, projected);
        if (lit)
            add(tile, splat->power, weight, projected);
        useful += (uint64_t)lit;
    }
    return useful;
}
