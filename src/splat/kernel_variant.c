/* kernel_variant.c: the loop of kernel.h, compiled once for each instruction set with
 * KERNEL_FUNCTION naming the result. Conditions are masks (0 or 1 joined by &), and indices are
 * clamped, so that every lane may run every step. Results go to small arrays of their own, so that
 * no store can alias a gather and any compiler sees it. A row of 16 pixels is the unit: most rows
 * lie outside of a splat, and are left early. */
#include "splat/box.h"
#include "splat/kernel.h"

#include <math.h>

uint64_t KERNEL_FUNCTION(ps_tile *tile, const struct kernel_splat *splats, const uint32_t *indices,
                         size_t n, uint32_t resolution, const struct kernel_profile *profile);

#define ROW PS_TILE_SIZE

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

/* Where the pixels of one row of a tile lie in a splat's box. */
struct row {
    float u[ROW], v[ROW], t[ROW], r2[ROW], cosine[ROW];
    int inside[ROW];
};

/* Fills the row; 0 if no pixel of it is inside of the box and faces the light, which most rows are
 * not. */
static inline int locate(const ps_tile *tile, int first, const struct kernel_splat *splat,
                         struct row *row)
{
    int any = 0;
    for (int i = 0; i < ROW; i++) {
        float x = tile->position_x[first + i] - splat->centre.x;
        float y = tile->position_y[first + i] - splat->centre.y;
        float z = tile->position_z[first + i] - splat->centre.z;
        float u = x * splat->u.x + y * splat->u.y + z * splat->u.z;
        float v = x * splat->v.x + y * splat->v.y + z * splat->v.z;
        float t = x * splat->w.x + y * splat->w.y + z * splat->w.z;
        float r2 = u * u + v * v;
        float cosine =
            -(tile->normal_x[first + i] * splat->w.x + tile->normal_y[first + i] * splat->w.y +
              tile->normal_z[first + i] * splat->w.z);
        float start = splat->start_depth + u * splat->start_u + v * splat->start_v;
        int inside = (r2 < 1.0f) & (cosine > 0.0f) & (t >= splat->near_depth) &
                     (t <= splat->far_depth) & (t >= start);
        row->u[i] = u;
        row->v[i] = v;
        row->t[i] = t;
        row->r2[i] = r2;
        row->cosine[i] = cosine;
        row->inside[i] = inside;
        any |= inside;
    }
    return any;
}

/* K * V of the row's pixels; returns how many have weight. */
static inline int weigh(const struct row *row, const struct kernel_splat *splat, int resolution,
                        const float *profile, float weight[ROW])
{
    const float half_resolution = 0.5f * (float)resolution;
    const float last_texel = (float)resolution - 0.5f;
    const float *depths = splat->depths;
    int useful = 0;
    for (int i = 0; i < ROW; i++) {
        float cosine = clamp(row->cosine[i], 1e-3f, 1.0f);
        float slope = sqrtf(1.0f - cosine * cosine) / cosine;
        float bias = splat->bias_constant + splat->bias_slope * least(slope, BOX_STEEPEST);
        int column = (int)clamp((row->u[i] + 1.0f) * half_resolution, 0.0f, last_texel);
        int line = (int)clamp((row->v[i] + 1.0f) * half_resolution, 0.0f, last_texel);
        float past = row->t[i] - depths[line * resolution + column];
        int entry = (int)(clamp(row->r2[i], 0.0f, 0.99999f) * (float)KERNEL_PROFILE_SIZE);
        int lit = row->inside[i] & (past <= bias) & (-past <= bias + splat->front);
        /* A product, not a choice: compilers would make the load conditional and the loop scalar.
         */
        weight[i] = (float)lit * profile[entry] * splat->kernel_scale;
        useful += lit;
    }
    return useful;
}

static inline void add(ps_tile *tile, int first, ps_rgb power, const struct row *row,
                       const float weight[ROW])
{
    for (int i = 0; i < ROW; i++) {
        float projected = weight[i] * row->cosine[i];
        tile->irradiance_r[first + i] += projected * power.r;
        tile->irradiance_g[first + i] += projected * power.g;
        tile->irradiance_b[first + i] += projected * power.b;
        tile->weight[first + i] += weight[i];
    }
}

uint64_t KERNEL_FUNCTION(ps_tile *tile, const struct kernel_splat *splats, const uint32_t *indices,
                         size_t n, uint32_t resolution, const struct kernel_profile *profile)
{
    uint64_t useful = 0;
    for (size_t i = 0; i < n; i++) {
        const struct kernel_splat *splat = &splats[indices[i]];
        for (int first = 0; first < PS_TILE_PIXELS; first += ROW) {
            _Alignas(64) struct row row;
            _Alignas(64) float weight[ROW];
            if (!locate(tile, first, splat, &row))
                continue;
            useful += (uint64_t)weigh(&row, splat, (int)resolution, profile->weights, weight);
            add(tile, first, splat->power, &row, weight);
        }
    }
    return useful;
}
